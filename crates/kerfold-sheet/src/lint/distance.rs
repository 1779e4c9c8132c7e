//! How far a point is from a segment.

use glam::DVec2;

/// The distance of a point from a segment, and the nearest point on it.
pub(super) fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> (f64, DVec2) {
    let along = b - a;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let foot = a + along * t;
    (p.distance(foot), foot)
}
