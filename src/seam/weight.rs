//! What a fold costs, and costs as integers, so that sums and comparisons are exact.

use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, Mesh};

/// What it costs to keep an edge as a fold: |fold angle| × length, in radians times the model's
/// unit. Dull and short edges are cheap; a flat edge costs nothing. An edge whose angle is unknown
/// (a rim, a face without area) counts as flat.
pub fn fold_weight(mesh: &Mesh, e: EdgeId) -> f64 {
    fold_angle(mesh, e).map_or(0.0, |angle| angle.abs() * edge_length(mesh, e))
}

/// The sum of [`fold_weight`] over some edges.
pub fn fold_sum(mesh: &Mesh, folds: &[EdgeId]) -> f64 {
    folds.iter().map(|&e| fold_weight(mesh, e)).sum()
}

/// Weights as integers: the largest becomes 2⁴⁰, so each is off by at most 2⁻⁴¹ (5·10⁻¹³) of the
/// largest. Fewer bits are kept above 2¹⁹ vertices, so that the sum over all vertices stays inside
/// 62 bits. Weights that are not finite count as zero, negative weights stay negative.
pub(super) fn quantised(weights: &[f64], vertices: usize) -> Vec<i64> {
    let largest = weights.iter().filter(|w| w.is_finite()).fold(0.0_f64, |a, w| a.max(w.abs()));
    let size_bits = usize::BITS - vertices.leading_zeros();
    let unit = 2f64.powi(40.min(60 - size_bits as i32));
    // A float-to-integer cast turns the NaN of 0/0 and ∞/∞ into zero, which is what is wanted.
    weights.iter().map(|w| (w / largest * unit).round() as i64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_keep_the_ratios_at_any_scale() {
        for scale in [1e-9, 1.0, 1e9] {
            let weights = [1.0, 0.5, 0.25, 0.0].map(|w| w * scale);
            assert_eq!(quantised(&weights, 4), [1 << 40, 1 << 39, 1 << 38, 0]);
        }
        assert_eq!(quantised(&[0.0, 0.0], 4), [0, 0]);
        assert_eq!(quantised(&[1.0], 1 << 30), [1 << 29]);
    }
}
