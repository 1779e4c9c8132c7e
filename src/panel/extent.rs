//! The smallest box around an outline: what a panel needs of its stock.

use glam::DVec2;

use crate::geom::polygon::convex_hull;

/// Length and width of the rectangle of least area around points, the longer one first. One of its
/// sides lies along a side of the convex hull (Freeman and Shapira 1975).
pub(super) fn smallest_box(points: &[DVec2]) -> [f64; 2] {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_box_of_a_turned_ell() {
        let turn = DVec2::from_angle(0.7);
        let ell = [(0.0, 0.0), (50.0, 0.0), (50.0, 20.0), (20.0, 20.0), (20.0, 40.0), (0.0, 40.0)];
        let turned: Vec<DVec2> = ell.iter().map(|&p| turn.rotate(p.into())).collect();
        let [length, width] = smallest_box(&turned);
        assert!((length - 50.0).abs() < 1e-12 && (width - 40.0).abs() < 1e-12, "{length} {width}");
        assert_eq!(smallest_box(&[]), [0.0; 2]);
    }
}
