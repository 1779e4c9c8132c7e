//! Half-spaces.

use glam::DVec3;

use super::determinant::excess;

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
}
