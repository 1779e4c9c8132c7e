//! The one rounding bound of constructed points.

use glam::DVec3;

/// Relative size of the rounding that constructed points and planes may carry (`operators.md` 1).
const RELATIVE: f64 = 1e-12;

/// How many times farther from the origin than its size a model may lie before the coarser spacing
/// of its coordinates widens the bound noticeably.
const FAR: f64 = 256.0;

/// How near a constructed point must be to a plane to count as on it.
///
/// The bound is relative to the model: 1e-12 of its size, widened only where the coordinates
/// themselves are coarser than that because the model lies far from the origin. Given numbers are
/// never compared through it: their signs are exact ([`super::predicate::side_of_plane`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundingBound(f64);

impl RoundingBound {
    /// The bound for points inside the box from `low` to `high`.
    pub fn of_box(low: DVec3, high: DVec3) -> Self {
        let magnitude = low.abs().max(high.abs()).max_element();
        Self(RELATIVE * ((high - low).length() + magnitude / FAR))
    }

    /// The bound as a length in the model's unit.
    pub fn length(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_scales_with_the_model_and_exceeds_the_spacing_of_far_coordinates() {
        let near = RoundingBound::of_box(DVec3::ZERO, DVec3::ONE).length();
        let big = RoundingBound::of_box(DVec3::ZERO, DVec3::ONE * 1e5).length();
        assert!((big / near / 1e5 - 1.0).abs() < 1e-12);
        let far = RoundingBound::of_box(DVec3::splat(1e6), DVec3::splat(1e6 + 1.0)).length();
        assert!(far > 16.0 * 1e6 * f64::EPSILON);
    }
}
