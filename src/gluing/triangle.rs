//! Triangles of which only the sides are known.

use glam::DVec2;

/// A rim that turns by less, in radians, is straight there.
pub(super) const STRAIGHT: f64 = 1e-11;

/// Where the third corner lies when the side `base` runs along x from the origin: `left` is its
/// distance from the origin, `right` from the other end. Never below the side.
pub(super) fn third_corner(base: f64, left: f64, right: f64) -> DVec2 {
    let x = (base * base + (left - right) * (left + right)) / (2.0 * base);
    DVec2::new(x, 2.0 * area(base, left, right) / base)
}

/// Area from three sides without losing digits of thin triangles (Kahan 2014, "Miscalculating area
/// and angles of a needle-like triangle").
pub(super) fn area(a: f64, b: f64, c: f64) -> f64 {
    let mut s = [a, b, c];
    s.sort_by(f64::total_cmp);
    let [c, b, a] = s;
    let squared = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    squared.max(0.0).sqrt() / 4.0
}

/// The angle between the sides `left` and `right`, opposite `far`.
pub(super) fn angle(left: f64, right: f64, far: f64) -> f64 {
    let doubled_cosine = left * left + (right - far) * (right + far);
    (4.0 * area(left, right, far)).atan2(doubled_cosine)
}

/// How far one direction is turned to the left to become another, in (-π, π]; exact near zero,
/// where an arc cosine is not.
pub(super) fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}
