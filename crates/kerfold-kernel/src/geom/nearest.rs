//! The nearest points of segments and triangles in space (Ericson 2005, "Real-Time Collision
//! Detection", 5.1).

use glam::DVec3;

/// The point of a segment that is nearest to `p`; of a segment without length, its point.
///
/// # Example
/// ```
/// use glam::DVec3;
/// use kerfold_kernel::geom::nearest_on_segment;
///
/// let near = nearest_on_segment(DVec3::new(2.0, 5.0, 0.0), [DVec3::ZERO, DVec3::X * 3.0]);
/// assert_eq!(near, DVec3::X * 2.0);
/// ```
pub fn nearest_on_segment(p: DVec3, [a, b]: [DVec3; 2]) -> DVec3 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    if share.is_nan() { a } else { a + along * share.clamp(0.0, 1.0) }
}

/// The point of a triangle that is nearest to `p`: the foot of the perpendicular if it lies inside,
/// else the nearest point of a side.
///
/// # Example
/// ```
/// use glam::DVec3;
/// use kerfold_kernel::geom::nearest_on_triangle;
///
/// let corners = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
/// assert_eq!(nearest_on_triangle(DVec3::new(1.0, 1.0, 7.0), corners), DVec3::new(1.0, 1.0, 0.0));
/// assert_eq!(nearest_on_triangle(DVec3::new(-1.0, -1.0, 2.0), corners), DVec3::ZERO);
/// ```
pub fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    let foot = if square > 0.0 { p - normal * ((p - a).dot(normal) / square) } else { p };
    let sides = [[a, b], [b, c], [c, a]];
    if square > 0.0 && sides.iter().all(|&[u, v]| (v - u).cross(foot - u).dot(normal) >= 0.0) {
        return foot;
    }
    let feet = sides.map(|side| nearest_on_segment(p, side));
    feet.into_iter()
        .min_by(|x, y| x.distance_squared(p).total_cmp(&y.distance_squared(p)))
        .unwrap_or(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_without_area_are_their_sides() {
        let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        assert_eq!(nearest_on_triangle(DVec3::new(1.5, 3.0, 0.0), line), DVec3::X * 1.5);
        assert_eq!(nearest_on_triangle(DVec3::Y, [DVec3::ONE; 3]), DVec3::ONE);
        assert_eq!(nearest_on_segment(DVec3::Y, [DVec3::ONE; 2]), DVec3::ONE);
    }

    #[test]
    fn beyond_a_side_the_side_is_nearest() {
        let corners = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        let near = nearest_on_triangle(DVec3::new(3.0, 3.0, 1.0), corners);
        assert!(near.distance(DVec3::new(2.0, 2.0, 0.0)) < 1e-15, "{near}");
    }
}
