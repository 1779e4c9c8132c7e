//! Flat polygons: a closed chain of corners, counter-clockwise when it bounds material.

use glam::DVec2;

use super::predicate::orient2d;

/// The signed area: positive when the corners run counter-clockwise.
pub fn signed_area(corners: &[DVec2]) -> f64 {
    let Some(&first) = corners.first() else { return 0.0 };
    let pairs = corners.windows(2);
    pairs.map(|w| (w[0] - first).perp_dot(w[1] - first)).sum::<f64>() / 2.0
}

/// The centroid of the area; the mean of the corners when the area is zero.
pub fn centroid(corners: &[DVec2]) -> DVec2 {
    let Some(&first) = corners.first() else { return DVec2::ZERO };
    let mut moment = DVec2::ZERO;
    let mut doubled = 0.0;
    for w in corners.windows(2) {
        let (a, b) = (w[0] - first, w[1] - first);
        let cross = a.perp_dot(b);
        moment += (a + b) * cross;
        doubled += cross;
    }
    let mean = corners.iter().map(|&p| p - first).sum::<DVec2>() / corners.len() as f64;
    first + if doubled == 0.0 { mean } else { moment / (3.0 * doubled) }
}

/// The lower left and upper right corner of the bounding box; `None` without points.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> Option<(DVec2, DVec2)> {
    let mut points = points.into_iter();
    let &first = points.next()?;
    Some(points.fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
}

/// Where a point lies with respect to a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// In the interior.
    Inside,
    /// On a corner or an edge.
    Boundary,
    /// Outside.
    Outside,
}

/// Locates `p` by the even-odd rule, with exact signs.
pub fn locate(corners: &[DVec2], p: DVec2) -> Location {
    let mut inside = false;
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if on_segment(a, b, p) {
            return Location::Boundary;
        }
        if (a.y > p.y) != (b.y > p.y) {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            if orient2d(low, high, p) > 0.0 {
                inside = !inside;
            }
        }
    }
    if inside { Location::Inside } else { Location::Outside }
}

/// Whether `p` lies on the closed segment from `a` to `b`, exactly.
pub fn on_segment(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all() && orient2d(a, b, p) == 0.0
}

/// Whether the open segments a–b and c–d cross in one interior point of both, exactly. Touching is
/// not crossing.
pub fn segments_cross(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    // Signs, not products: a product of two tiny areas would underflow to zero.
    let opposite = |s: f64, t: f64| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    opposite(orient2d(a, b, c), orient2d(a, b, d)) && opposite(orient2d(c, d, a), orient2d(c, d, b))
}

/// Whether two closed segments share a point, exactly.
pub fn segments_meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    segments_cross(a, b, c, d)
        || on_segment(a, b, c)
        || on_segment(a, b, d)
        || on_segment(c, d, a)
        || on_segment(c, d, b)
}

/// Whether the borders of two polygons touch or cross, exactly.
pub fn borders_meet(a: &[DVec2], b: &[DVec2]) -> bool {
    sides(a).any(|[p, q]| sides(b).any(|[r, s]| segments_meet(p, q, r, s)))
}

/// The sides of a polygon, from each corner to the next.
fn sides(corners: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// Length and width of the rectangle of least area around points, the longer one first, in the unit of
/// the points; both are 0 for no points. One of its sides lies along a side of the convex hull
/// (Freeman and Shapira 1975).
pub fn smallest_rectangle(points: &[DVec2]) -> [f64; 2] {
    let hull = convex_hull(points);
    let n = hull.len();
    let mut best = [f64::INFINITY; 2];
    for i in 0..n {
        let Some(along) = (hull[(i + 1) % n] - hull[i]).try_normalize() else { continue };
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &p in &hull {
            let q = DVec2::new((p - hull[i]).dot(along), (p - hull[i]).dot(along.perp()));
            (low, high) = (low.min(q), high.max(q));
        }
        let size = high - low;
        if size.x * size.y < best[0] * best[1] {
            best = [size.max_element(), size.min_element()];
        }
    }
    if best[0].is_finite() { best } else { [0.0; 2] }
}

/// The convex hull, counter-clockwise, without collinear corners (Andrew 1979, monotone chain,
/// exact signs).
pub fn convex_hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half_hull(sorted.iter().copied());
    hull.extend(half_hull(sorted.iter().rev().copied()));
    hull
}

/// One side of the hull without its last corner.
fn half_hull(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut chain: Vec<DVec2> = Vec::new();
    for p in points {
        while chain.len() > 1 && orient2d(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ell() -> Vec<DVec2> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec()
    }

    #[test]
    fn area_and_centroid_of_an_ell() {
        assert_eq!(signed_area(&ell()), 3.0);
        assert!((centroid(&ell()) - DVec2::splat(5.0 / 6.0)).length() < 1e-15);
        let reversed: Vec<_> = ell().into_iter().rev().collect();
        assert_eq!(signed_area(&reversed), -3.0);
    }

    #[test]
    fn locate_tells_corners_edges_and_the_notch() {
        let ell = ell();
        assert_eq!(locate(&ell, DVec2::new(0.5, 1.5)), Location::Inside);
        assert_eq!(locate(&ell, DVec2::new(1.5, 1.5)), Location::Outside);
        assert_eq!(locate(&ell, DVec2::new(1.0, 1.0)), Location::Boundary);
        assert_eq!(locate(&ell, DVec2::new(1.0, 1.5)), Location::Boundary);
        assert_eq!(locate(&ell, DVec2::new(0.5, 1.0)), Location::Inside);
        assert_eq!(locate(&ell, DVec2::new(-1.0, 1.0)), Location::Outside);
    }

    #[test]
    fn touching_is_not_crossing() {
        let (a, b) = (DVec2::ZERO, DVec2::new(2.0, 0.0));
        assert!(segments_cross(a, b, DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0)));
        assert!(!segments_cross(a, b, DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)));
        assert!(!segments_cross(a, b, DVec2::new(3.0, -1.0), DVec2::new(3.0, 1.0)));
    }

    #[test]
    fn the_smallest_rectangle_of_a_turned_ell() {
        let turn = DVec2::from_angle(0.7);
        let ell = [(0.0, 0.0), (50.0, 0.0), (50.0, 20.0), (20.0, 20.0), (20.0, 40.0), (0.0, 40.0)];
        let turned: Vec<DVec2> = ell.iter().map(|&p| turn.rotate(p.into())).collect();
        let [length, width] = smallest_rectangle(&turned);
        assert!((length - 50.0).abs() < 1e-12 && (width - 40.0).abs() < 1e-12, "{length} {width}");
        assert_eq!(smallest_rectangle(&[]), [0.0; 2]);
    }
}
