//! Flat polygons cut into triangles between their own corners.

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::polygon::{Location, locate, signed_area};
use super::predicate::orient2d;

/// Cuts a polygon into triangles between its corners, which are named by their places in `polygon`.
///
/// The polygon may be concave and may have corners on straight sides; the triangles run the way the
/// polygon runs and none of them is flat, n − 2 of them for n corners. When the polygon touches or
/// crosses itself, n − 2 triangles come all the same, by clipping ears as well as they can be
/// found; some of them may be flat or overlap. Fewer than three corners give none.
///
/// The same polygon always gives the same triangles. Simple polygons go through a constrained
/// Delaunay triangulation (Chew 1989, by the `spade` crate), which avoids slivers where it can.
///
/// # Example
/// ```
/// use glam::DVec2;
/// use kerfold_kernel::geom::triangulate;
///
/// let ell = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
/// let ell = ell.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
/// assert_eq!(triangulate(&ell).len(), 4);
/// ```
pub fn triangulate(polygon: &[DVec2]) -> Vec<[usize; 3]> {
    let Some(polygon) = scaled(polygon) else { return fan(polygon.len()) };
    match polygon.len() {
        0..=3 => fan(polygon.len()),
        4 if is_convex_quad(&polygon) => {
            let diagonals =
                [polygon[0].distance_squared(polygon[2]), polygon[1].distance_squared(polygon[3])];
            if diagonals[0] <= diagonals[1] {
                vec![[0, 1, 2], [0, 2, 3]]
            } else {
                vec![[0, 1, 3], [1, 2, 3]]
            }
        }
        _ => by_delaunay(&polygon).unwrap_or_else(|| by_ears(&polygon)),
    }
}

fn fan(corners: usize) -> Vec<[usize; 3]> {
    (2..corners).map(|i| [0, i - 1, i]).collect()
}

/// The corners scaled by a power of two to a size near 1, so that no predicate over- or underflows
/// and spade accepts them. That changes no digit, save that coordinates forty orders of magnitude
/// below the largest become zero. `None` when a corner is not finite.
fn scaled(polygon: &[DVec2]) -> Option<Vec<DVec2>> {
    if !polygon.iter().all(|p| p.is_finite()) {
        return None;
    }
    let largest = polygon.iter().map(|p| p.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let exponent = -(largest.log2().floor() as i32);
    // In two halves, so that neither factor overflows.
    let (half, rest) = (2f64.powi(exponent / 2), 2f64.powi(exponent - exponent / 2));
    let place = |x: f64| if (x * half * rest).abs() < 1e-40 { 0.0 } else { x * half * rest };
    Some(polygon.iter().map(|p| DVec2::new(place(p.x), place(p.y))).collect())
}

/// Whether all four corners turn the same way. A quad cannot wind twice, so it is convex then.
fn is_convex_quad(quad: &[DVec2]) -> bool {
    let turns = [0, 1, 2, 3].map(|i| orient2d(quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]));
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
}

/// `None` when the polygon is not simple.
fn by_delaunay(polygon: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let n = polygon.len();
    let is_clockwise = turn_at_lowest(polygon)? < 0.0;
    let mut net = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = Vec::with_capacity(n);
    for (i, p) in polygon.iter().enumerate() {
        let handle = net.insert(Point2::new(p.x, p.y)).ok()?;
        // A second corner at the same point gets the handle of the first.
        if handle.index() != i {
            return None;
        }
        handles.push(handle);
    }
    for (i, &from) in handles.iter().enumerate() {
        let to = handles[(i + 1) % n];
        if !net.can_add_constraint(from, to) {
            return None;
        }
        net.add_constraint(from, to);
    }
    let outside = outside_faces(&net);
    let mut triangles: Vec<[usize; 3]> = net
        .inner_faces()
        .filter(|face| !outside[face.fix().index()])
        .map(|face| lowest_first(face.vertices().map(|v| v.fix().index())))
        .collect();
    triangles.sort_unstable();
    if is_clockwise {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    // A corner that lies on another side splits it; then the count is off.
    (triangles.len() == n - 2).then_some(triangles)
}

/// Cuts the area between an outline and its holes into triangles: the corners, those at one point
/// being one, and the triangles, counter-clockwise, by places in that list. What lies inside an odd
/// number of contours is kept.
///
/// `None` when sides cross, when a number is not finite, or when there is no area.
pub fn triangulate_region(contours: &[&[DVec2]]) -> Option<(Vec<DVec2>, Vec<[usize; 3]>)> {
    triangulate_region_through(contours, &[])
}

/// A triangle is flat when its height is below this share of its longest side.
const FLAT: f64 = 1e-10;

/// The same with further points, which become corners of triangles, after those of the contours.
/// Points on a side divide it, and those outside are corners of no triangle.
///
/// # Example
/// ```
/// use glam::DVec2;
/// use kerfold_kernel::geom::triangulate_region_through;
///
/// let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
/// let made = triangulate_region_through(&[&square], &[DVec2::splat(0.5)]);
/// assert_eq!(made.map(|(corners, triangles)| (corners.len(), triangles.len())), Some((5, 4)));
/// ```
pub fn triangulate_region_through(
    contours: &[&[DVec2]],
    points: &[DVec2],
) -> Option<(Vec<DVec2>, Vec<[usize; 3]>)> {
    let all: Vec<DVec2> = contours.iter().copied().flatten().chain(points).copied().collect();
    let all = scaled(&all)?;
    let mut net = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut corners = Vec::new();
    let mut rest = all.as_slice();
    for contour in contours {
        let (here, after) = rest.split_at(contour.len());
        rest = after;
        let mut handles = Vec::with_capacity(here.len());
        for (p, &given) in here.iter().zip(*contour) {
            let handle = net.insert(Point2::new(p.x, p.y)).ok()?;
            if handle.index() == corners.len() {
                corners.push(given);
            }
            handles.push(handle);
        }
        for (i, &from) in handles.iter().enumerate() {
            let to = handles[(i + 1) % handles.len()];
            if from == to {
                continue;
            }
            if !net.can_add_constraint(from, to) {
                return None;
            }
            net.add_constraint(from, to);
        }
    }
    for (p, &given) in rest.iter().zip(points) {
        let handle = net.insert(Point2::new(p.x, p.y)).ok()?;
        if handle.index() == corners.len() {
            corners.push(given);
        }
    }
    let is_inside = |triangle: [usize; 3]| {
        let middle = triangle.iter().map(|&i| corners[i]).sum::<DVec2>() / 3.0;
        contours.iter().filter(|c| locate(c, middle) == Location::Inside).count() % 2 == 1
    };
    // Points along a straight side are off it by rounding, and what is left between them and the
    // side has its middle anywhere. It has no area and stays outside.
    let is_flat = |triangle: [usize; 3]| {
        let [a, b, c] = triangle.map(|i| corners[i]);
        let longest = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
        (b - a).perp_dot(c - a).abs() <= FLAT * longest.into_iter().fold(0.0, f64::max)
    };
    let faces = net.inner_faces().map(|face| {
        let sides = face.adjacent_edges().into_iter().filter(|e| e.is_constraint_edge()).count();
        (sides, lowest_first(face.vertices().map(|v| v.fix().index())))
    });
    let kept = faces.filter(|&(sides, t)| is_inside(t) && (sides < 2 || !is_flat(t)));
    let mut triangles: Vec<[usize; 3]> = kept.map(|(_, t)| t).collect();
    triangles.sort_unstable();
    (!triangles.is_empty()).then_some((corners, triangles))
}

/// The turn at the lowest of the leftmost corners: its sign is the sense of a simple polygon.
/// `None` when it is flat, which no simple polygon is there.
fn turn_at_lowest(polygon: &[DVec2]) -> Option<f64> {
    let n = polygon.len();
    let key = |i: usize| (polygon[i].x, polygon[i].y);
    let lowest = (1..n).fold(0, |best, i| if key(i) < key(best) { i } else { best });
    let turn = orient2d(polygon[(lowest + n - 1) % n], polygon[lowest], polygon[(lowest + 1) % n]);
    (turn != 0.0).then_some(turn)
}

/// For each face whether it can be reached from outside without crossing a side of the polygon.
fn outside_faces(net: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<bool> {
    let mut outside = vec![false; net.num_all_faces()];
    let mut open = vec![net.outer_face().fix()];
    outside[open[0].index()] = true;
    // The outer face may have no edges of its own to walk along, so its neighbours come from the
    // hull.
    let hull: Vec<_> = net.convex_hull().filter(|e| !e.is_constraint_edge()).collect();
    for edge in hull {
        for face in [edge.face(), edge.rev().face()] {
            if !std::mem::replace(&mut outside[face.fix().index()], true) {
                open.push(face.fix());
            }
        }
    }
    while let Some(face) = open.pop() {
        let Some(face) = net.face(face).as_inner() else { continue };
        for edge in face.adjacent_edges() {
            let next = edge.rev().face().fix();
            if !edge.is_constraint_edge() && !std::mem::replace(&mut outside[next.index()], true) {
                open.push(next);
            }
        }
    }
    outside
}

/// The same with the triangles' corners numbered in the contours one after another. All corners
/// count, those that stand in a line up to rounding, too: every side of a contour is a side of
/// exactly one triangle.
///
/// `None` where contours touch or cross themselves or each other, when a number is not finite, or
/// when there is no area.
pub fn triangulate_contours(contours: &[Vec<DVec2>]) -> Option<Vec<[usize; 3]>> {
    let corners: Vec<DVec2> = contours.iter().flatten().copied().collect();
    let mut net = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    for (i, p) in scaled(&corners)?.into_iter().enumerate() {
        // A second corner at the same point gets the handle of the first.
        let handle = net.insert(Point2::new(p.x, p.y)).ok()?;
        if handle.index() != i {
            return None;
        }
    }
    let handles: Vec<_> = net.fixed_vertices().collect();
    let mut start = 0;
    for contour in contours {
        for i in 0..contour.len() {
            let [from, to] = [i, (i + 1) % contour.len()].map(|i| handles[start + i]);
            if !net.can_add_constraint(from, to) {
                return None;
            }
            net.add_constraint(from, to);
        }
        start += contour.len();
    }
    let depth = contours_around(&net);
    let inside = net.inner_faces().filter(|face| depth[face.fix().index()] % 2 == 1);
    let mut triangles: Vec<[usize; 3]> =
        inside.map(|face| lowest_first(face.vertices().map(|v| v.fix().index()))).collect();
    triangles.sort_unstable();
    // Every hole adds its corners and two triangles more; a corner on another contour's side leaves
    // another number.
    let is_whole = triangles.len() + 4 == corners.len() + 2 * contours.len();
    is_whole.then_some(triangles)
}

/// For each face how many contours lie between it and the outside: counted along ways from face to
/// face, so no rounded point is ever judged.
fn contours_around(net: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<u32> {
    const UNKNOWN: u32 = u32::MAX;
    let mut depth = vec![UNKNOWN; net.num_all_faces()];
    // The outer face may have no edges of its own to walk along, so its neighbours come from the
    // hull.
    depth[net.outer_face().fix().index()] = 0;
    let mut open = std::collections::VecDeque::new();
    for edge in net.convex_hull() {
        for face in [edge.face(), edge.rev().face()] {
            if depth[face.fix().index()] == UNKNOWN {
                depth[face.fix().index()] = u32::from(edge.is_constraint_edge());
                open.push_back(face.fix());
            }
        }
    }
    while let Some(face) = open.pop_front() {
        let Some(inner) = net.face(face).as_inner() else { continue };
        for edge in inner.adjacent_edges() {
            let next = edge.rev().face().fix();
            if depth[next.index()] == UNKNOWN {
                depth[next.index()] = depth[face.index()] + u32::from(edge.is_constraint_edge());
                open.push_back(next);
            }
        }
    }
    depth
}

fn lowest_first([a, b, c]: [usize; 3]) -> [usize; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Beyond this many corners a polygon that is not simple gets a plain fan: clipping takes cubic
/// time.
const MOST_EARS: usize = 500;

/// Clips ears; good for polygons that touch themselves, such as one with a slit to its hole.
fn by_ears(polygon: &[DVec2]) -> Vec<[usize; 3]> {
    if polygon.len() > MOST_EARS {
        return fan(polygon.len());
    }
    let is_clockwise = signed_area(polygon) < 0.0;
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    if is_clockwise {
        left.reverse();
    }
    let mut triangles = Vec::with_capacity(polygon.len() - 2);
    while left.len() > 2 {
        let at = (0..left.len()).find(|&i| is_ear(polygon, &left, i)).unwrap_or(0);
        let [a, b, c] = around(&left, at);
        triangles.push(if is_clockwise { [c, b, a] } else { [a, b, c] });
        left.remove(at);
    }
    triangles
}

fn around(left: &[usize], at: usize) -> [usize; 3] {
    let n = left.len();
    [left[(at + n - 1) % n], left[at], left[(at + 1) % n]]
}

/// Whether the corner turns left and no other corner lies in its triangle, save those at one point
/// with its own.
fn is_ear(polygon: &[DVec2], left: &[usize], at: usize) -> bool {
    let [a, b, c] = around(left, at).map(|i| polygon[i]);
    let is_inside = |p: DVec2| {
        p != a
            && p != b
            && p != c
            && orient2d(a, b, p) >= 0.0
            && orient2d(b, c, p) >= 0.0
            && orient2d(c, a, p) >= 0.0
    };
    orient2d(a, b, c) > 0.0 && !left.iter().any(|&i| is_inside(polygon[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    /// Asserts n − 2 triangles that turn as the polygon does and cover its area.
    fn assert_covers(corners: &[DVec2]) {
        let triangles = triangulate(corners);
        assert_eq!(triangles.len(), corners.len() - 2, "{corners:?}");
        let area = signed_area(corners);
        let areas: Vec<f64> = triangles
            .iter()
            .map(|t| orient2d(corners[t[0]], corners[t[1]], corners[t[2]]))
            .collect();
        assert!(areas.iter().all(|a| a * area.signum() > 0.0), "{corners:?}: {triangles:?}");
        let sum: f64 = areas.iter().sum::<f64>() / 2.0;
        assert!((sum - area).abs() <= 1e-9 * area.abs(), "{sum} is not {area}");
    }

    #[test]
    fn concave_polygons_with_corners_on_straight_sides_are_covered() {
        let comb = polygon(&[
            (0., 0.),
            (1., 0.),
            (2., 0.),
            (4., 0.),
            (4., 3.),
            (3., 1.),
            (2., 3.),
            (1., 1.),
            (0., 3.),
        ]);
        for scale in [1e-200, 1e-3, 1.0, 1e5, 1e200] {
            let scaled: Vec<DVec2> = comb.iter().map(|&p| p * scale).collect();
            assert_eq!(triangulate(&scaled), triangulate(&comb), "{scale}");
        }
        assert_covers(&comb);
        assert_covers(&comb.iter().copied().rev().collect::<Vec<_>>());
        let dart = polygon(&[(0., 0.), (2., 1.), (0., 2.), (1., 1.)]);
        assert_covers(&dart);
        assert_eq!(triangulate(&dart), [[0, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn a_slit_to_a_hole_is_walked_around() {
        let slit = polygon(&[
            (0., 0.),
            (4., 0.),
            (4., 4.),
            (0., 4.),
            (0., 0.),
            (1., 1.),
            (1., 3.),
            (3., 3.),
            (3., 1.),
            (1., 1.),
        ]);
        let triangles = triangulate(&slit);
        assert_eq!(triangles.len(), 8);
        let areas = triangles.iter().map(|t| orient2d(slit[t[0]], slit[t[1]], slit[t[2]]) / 2.0);
        assert_eq!(areas.inspect(|&a| assert!(a >= 0.0)).sum::<f64>(), 12.0);
    }

    #[test]
    fn regions_leave_their_holes_free() {
        let square =
            |low: f64, high: f64| polygon(&[(low, low), (high, low), (high, high), (low, high)]);
        let mut turned = square(6.0, 7.0);
        turned.reverse();
        let contours = [square(0.0, 10.0), square(1.0, 3.0), turned];
        let corners = contours.concat();
        let triangles = triangulate_contours(&contours).expect("contours apart");
        assert_eq!(triangles.len(), 12 + 2 * 2 - 2);
        let areas =
            triangles.iter().map(|t| orient2d(corners[t[0]], corners[t[1]], corners[t[2]]) / 2.0);
        assert_eq!(areas.inspect(|&a| assert!(a > 0.0)).sum::<f64>(), 95.0);
        // A hole that reaches out of its outline, or touches it, is no region.
        assert_eq!(triangulate_contours(&[square(0.0, 10.0), square(5.0, 15.0)]), None);
        assert_eq!(triangulate_contours(&[square(0.0, 10.0), square(0.0, 5.0)]), None);
        assert_eq!(triangulate_contours(&[]), None);
    }

    #[test]
    fn nothing_panics_on_nonsense() {
        let bow = polygon(&[(0., 0.), (1., 1.), (1., 0.), (0., 1.)]);
        let line = polygon(&[(0., 0.), (1., 0.), (2., 0.), (3., 0.), (1.5, 0.)]);
        let point = vec![DVec2::ONE; 5];
        let nan = vec![DVec2::NAN; 5];
        let large = vec![DVec2::ONE; 1000];
        for nonsense in [bow, line, point, nan, large] {
            assert_eq!(triangulate(&nonsense).len(), nonsense.len() - 2);
        }
        assert!(triangulate(&[DVec2::ZERO, DVec2::X]).is_empty());
    }

    proptest! {
        #[test]
        fn stars_are_covered(radii in prop::collection::vec(0.1_f64..10.0, 4..40), far in -1e4_f64..1e4) {
            let n = radii.len() as f64;
            let corner = |(i, r): (usize, &f64)| DVec2::from_angle(i as f64 / n * std::f64::consts::TAU) * *r + DVec2::splat(far);
            let star: Vec<DVec2> = radii.iter().enumerate().map(corner).collect();
            assert_covers(&star);
        }
    }
}
