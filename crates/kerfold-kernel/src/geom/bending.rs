//! The ways in which a polygon in space can be out of plane.

use glam::DVec2;

/// An orthonormal basis of the patterns of corner heights that no plane has: k − 3 lists of k
/// numbers for k ≥ 3 corners, whose places in the plane of the polygon are `flat`. Heights h over
/// that plane are those of a plane exactly when every pattern's product with h is zero.
///
/// The patterns are the last columns of the orthogonal factor of the k × 3 matrix [1 x y], by
/// Householder reflections (Golub, Van Loan 2013, 5.2). Corners on one line leave it without full
/// rank; the patterns are then still orthonormal, but one pattern of a plane may be among them.
pub fn bending_patterns(flat: &[DVec2]) -> Vec<Vec<f64>> {
    let count = flat.len();
    if count <= 3 {
        return Vec::new();
    }
    let centre = flat.iter().sum::<DVec2>() / count as f64;
    let columns = [
        vec![1.0; count],
        flat.iter().map(|p| p.x - centre.x).collect::<Vec<f64>>(),
        flat.iter().map(|p| p.y - centre.y).collect(),
    ];
    let mut reflections: Vec<Vec<f64>> = Vec::new();
    for (i, mut column) in columns.into_iter().enumerate() {
        reflections.iter().for_each(|r| reflect(r, &mut column));
        column[..i].fill(0.0);
        let length = norm(&column);
        // The sign that avoids cancellation.
        column[i] += length.copysign(column[i]);
        let length = norm(&column);
        if length > 0.0 {
            column.iter_mut().for_each(|x| *x /= length);
            reflections.push(column);
        }
    }
    let pattern = |j: usize| {
        let mut unit = vec![0.0; count];
        unit[j] = 1.0;
        reflections.iter().rev().for_each(|r| reflect(r, &mut unit));
        unit
    };
    (3..count).map(pattern).collect()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Mirrors x in the plane through the origin with unit normal r.
fn reflect(r: &[f64], x: &mut [f64]) {
    let along = 2.0 * r.iter().zip(x.iter()).map(|(r, x)| r * x).sum::<f64>();
    x.iter_mut().zip(r).for_each(|(x, r)| *x -= along * r);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn planes_have_none_of_the_patterns_and_the_patterns_are_orthonormal() {
        let shapes: [&[(f64, f64)]; 3] = [
            &[(0.0, 0.0), (4.0, 0.0), (3.0, 2.0), (0.0, 1.0)],
            &[
                (1e5, 1e5),
                (1e5 + 1.0, 1e5),
                (1e5 + 2.0, 1e5 + 1.0),
                (1e5 + 1.0, 1e5 + 3.0),
                (1e5, 1e5 + 2.0),
            ],
            &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)],
        ];
        for shape in shapes {
            let flat: Vec<DVec2> = shape.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            let patterns = bending_patterns(&flat);
            assert_eq!(patterns.len(), flat.len() - 3);
            let origin = flat[0];
            let plane: Vec<f64> =
                flat.iter().map(|&p| 0.3 + 0.7 * (p - origin).x - 1.1 * (p - origin).y).collect();
            for (i, a) in patterns.iter().enumerate() {
                assert!(dot(a, &plane).abs() < 1e-11);
                for (j, b) in patterns.iter().enumerate() {
                    assert!((dot(a, b) - f64::from(u8::from(i == j))).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn a_square_bends_with_alternating_corners() {
        let square =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        let pattern = &bending_patterns(&square)[0];
        assert!(pattern.iter().all(|x| (x.abs() - 0.5).abs() < 1e-15));
        assert!(pattern.windows(2).all(|w| w[0] * w[1] < 0.0));
    }

    #[test]
    fn corners_on_a_line_and_triangles_do_no_harm() {
        let line: Vec<DVec2> = (0..5).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        assert!(bending_patterns(&line).iter().flatten().all(|x| x.is_finite()));
        assert!(bending_patterns(&line[..3]).is_empty());
    }
}
