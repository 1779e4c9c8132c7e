//! Distances between points, segments and closed contours.

use glam::DVec2;

use crate::geom::polygon::segments_cross;

/// The least distance between two closed contours; 0 when they cross.
pub(crate) fn contour_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    let crossing = edges(a).any(|(p, q)| edges(b).any(|(r, s)| segments_cross(p, q, r, s)));
    if crossing {
        return 0.0;
    }
    // Without a crossing the least distance is at a corner of one of them.
    let from_a = a.iter().map(|&p| distance_to_contour(p, b));
    let from_b = b.iter().map(|&p| distance_to_contour(p, a));
    from_a.chain(from_b).fold(f64::INFINITY, f64::min)
}

/// The distance from a point to a closed contour.
pub(crate) fn distance_to_contour(p: DVec2, contour: &[DVec2]) -> f64 {
    edges(contour).map(|(a, b)| distance_to_segment(p, a, b)).fold(f64::INFINITY, f64::min)
}

/// The distance from a point to a closed segment.
pub(crate) fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    p.distance(nearest_on_segment(p, a, b))
}

/// The point of a closed segment that is nearest to another point.
pub(crate) fn nearest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let along = b - a;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    a + along * t
}

/// The edges of a closed contour.
pub(crate) fn edges(contour: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    contour.iter().zip(contour.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}
