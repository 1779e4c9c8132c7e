//! Half-spaces.

use glam::DVec3;

use super::determinant::excess;
use super::scale::inverse_power_of_two;

/// Entries of a normal below this share of its largest are zero: products of three would leave the
/// range of doubles, and no coordinate shows the difference.
const NEGLIGIBLE: f64 = 1e-90;

/// A half-space: all x with normal · x ≤ offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// The outward normal, of any length but zero.
    pub normal: DVec3,
    /// normal · x on the plane.
    pub offset: f64,
}

impl HalfSpace {
    /// How far inside `x` lies, in units of the normal's length: right to an ulp even where the
    /// terms cancel.
    pub fn slack(&self, x: DVec3) -> f64 {
        if x == DVec3::ZERO {
            self.offset
        } else {
            -excess(self.normal.to_array(), x.to_array(), self.offset)
        }
    }

    /// Normal and offset, scaled by a power of two so that the largest entry of the normal is about
    /// 1, which changes no sign.
    pub(super) fn row(&self) -> [f64; 4] {
        let scale = inverse_power_of_two(self.normal.abs().max_element());
        let entry = |x: f64| if x.abs() < NEGLIGIBLE { 0.0 } else { x };
        let [x, y, z] = (self.normal * scale).to_array().map(entry);
        [x, y, z, self.offset * scale]
    }
}
