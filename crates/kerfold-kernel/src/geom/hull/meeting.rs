//! Where three planes meet, from their dual points.

use glam::DVec3;

/// The first point, the one farthest from it, and the one farthest from the line of the two;
/// counter-clockwise order is not kept.
pub(super) fn widest_triple(points: &[DVec3]) -> [DVec3; 3] {
    let far = |measure: &dyn Fn(DVec3) -> f64| {
        points
            .iter()
            .copied()
            .max_by(|&p, &q| measure(p).total_cmp(&measure(q)))
            .unwrap_or_default()
    };
    let a = points.first().copied().unwrap_or_default();
    let b = far(&|p| p.distance_squared(a));
    let c = far(&|p| (b - a).cross(p - a).length_squared());
    [a, b, c]
}

/// Terms of this size leave no more to gain.
pub(super) const SETTLED: f64 = 2.0 * f64::EPSILON;

/// Where q·y = 1 for three dual points, with the residuals solved for again: y lies on the planes
/// to rounding, however flat they meet.
#[inline(never)]
pub(super) fn meeting_point([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let inverse = 1.0 / normal.dot(a);
    let mut best = normal * inverse;
    for _ in 0..3 {
        let residuals = DVec3::new(1.0 - a.dot(best), 1.0 - b.dot(best), 1.0 - c.dot(best));
        if residuals.abs().max_element() <= SETTLED {
            break;
        }
        let [x, y, z] = residuals.to_array();
        let turned = normal * x + ac.cross(a) * (y - x) + a.cross(ab) * (z - x);
        let better = best + turned * inverse;
        if !better.is_finite() {
            break;
        }
        best = better;
    }
    best
}
