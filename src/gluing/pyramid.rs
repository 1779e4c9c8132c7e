//! The pyramid of a triangle of the surface under the apex.

use glam::DVec2;

use super::surface::Surface;

/// The apex over a triangle: the foot of its height with the half-edge along x, and the squared
/// height.
pub(super) fn apex(surface: &Surface, r: &[f64], h: usize) -> (DVec2, f64) {
    let (base, third) = (surface.length[h], surface.third(h));
    let (i, j) = (surface.origin[h], surface.target(h));
    let k = surface.origin[surface.previous(h)];
    let x = ((r[i] - r[j]) * (r[i] + r[j]) / base + base) / 2.0;
    let to_third = (r[i] - r[k]) * (r[i] + r[k]) + third.length_squared();
    let y = (to_third - 2.0 * x * third.x) / (2.0 * third.y);
    (DVec2::new(x, y), (r[i] - x) * (r[i] + x) - y * y)
}
