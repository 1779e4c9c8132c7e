//! Least-squares quadrics over a plane.

use nalgebra::{Matrix6, Vector6};

/// A height over a place of the plane, with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSample {
    /// First coordinate in the plane.
    pub x: f64,
    /// Second coordinate in the plane.
    pub y: f64,
    /// The height over the plane.
    pub height: f64,
    /// How much it counts, 0 or more.
    pub weight: f64,
}

/// The numbers (a, b, c, d, e, f) of the quadric a + b x + c y + d x²/2 + e x y + f y²/2 with the
/// least weighted sum of squared distances to the heights. Where the samples do not settle all six
/// (too few, or on a curve of second order), the ones that are left open are small. Coordinates
/// should be of the order of 1.
pub fn fit_quadric(samples: impl IntoIterator<Item = HeightSample>) -> [f64; 6] {
    let (mut matrix, mut right) = (Matrix6::<f64>::zeros(), Vector6::<f64>::zeros());
    for HeightSample { x, y, height, weight } in samples {
        let terms = Vector6::new(1.0, x, y, x * x / 2.0, x * y, y * y / 2.0);
        matrix += terms * (terms * weight).transpose();
        right += terms * (weight * height);
    }
    let shift = 1e-9 * matrix.trace() + f64::MIN_POSITIVE;
    (0..6).for_each(|i| matrix[(i, i)] += shift);
    let found = matrix.cholesky().map_or(Vector6::zeros(), |factor| factor.solve(&right));
    found.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(x: f64, y: f64, quadric: [f64; 6]) -> HeightSample {
        let [a, b, c, d, e, f] = quadric;
        let height = a + b * x + c * y + d * x * x / 2.0 + e * x * y + f * y * y / 2.0;
        HeightSample { x, y, height, weight: 1.0 / (1.0 + x * x) }
    }

    #[test]
    fn a_quadric_is_found_again() {
        let given = [0.3, -0.2, 0.1, 0.9, -0.4, 0.6];
        let points = (0..40).map(|i| (f64::from(i * 7 % 11) / 11.0, f64::from(i * 5 % 13) / 13.0));
        let found = fit_quadric(points.map(|(x, y)| sample(x, y, given)));
        assert!(given.iter().zip(found).all(|(g, f)| (g - f).abs() < 1e-4), "{found:?}");
    }

    #[test]
    fn too_few_samples_give_small_numbers() {
        assert_eq!(fit_quadric([]), [0.0; 6]);
        let line = (0..9).map(|i| sample(f64::from(i) / 9.0, 0.0, [0.1, 0.2, 9.0, 0.3, 9.0, 9.0]));
        let found = fit_quadric(line);
        assert!(found[2].abs() + found[4].abs() + found[5].abs() < 1e-9, "{found:?}");
    }
}
