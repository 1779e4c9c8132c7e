//! Least-squares plane through points.

use glam::DVec3;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::Plane;

/// The plane with the least sum of squared distances to `points`, through their mean (total least
/// squares).
///
/// `None` with fewer than three points, or when they are collinear. The side of the normal is
/// arbitrary but deterministic.
pub fn fit_plane(points: &[DVec3]) -> Option<Plane> {
    if points.len() < 3 {
        return None;
    }
    let first = points[0];
    let shift: DVec3 = points.iter().map(|&p| p - first).sum::<DVec3>() / points.len() as f64;
    let centred: Vec<DVec3> = points.iter().map(|&p| (p - first) - shift).collect();
    let scale = centred.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if scale == 0.0 || !scale.is_finite() {
        return None;
    }
    let scaled: Vec<DVec3> = centred.iter().map(|&p| p / scale).collect();
    let normal = least_direction(&scaled)?;
    Plane::new(refined(normal, &scaled), first + shift)
}

/// The unit direction of least variance of centred points; `None` when it is not unique (collinear
/// points).
fn least_direction(points: &[DVec3]) -> Option<DVec3> {
    let covariance = points.iter().fold(Matrix3::zeros(), |sum, p| {
        let v = Vector3::new(p.x, p.y, p.z);
        sum + v * v.transpose()
    });
    let eigen = SymmetricEigen::new(covariance);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [least, middle, most] = order.map(|i| eigen.eigenvalues[i]);
    // The covariance squares lengths: two small eigenvalues at its rounding level are a line, not a
    // plane.
    if middle <= 16.0 * f64::EPSILON * most || least > middle {
        return None;
    }
    let v = eigen.eigenvectors.column(order[0]);
    Some(DVec3::new(v[0], v[1], v[2]))
}

/// The covariance loses half the digits for thin polygons; a few Gauss–Newton steps on the
/// distances win them back.
fn refined(mut normal: DVec3, points: &[DVec3]) -> DVec3 {
    for _ in 0..3 {
        let x = normal.any_orthonormal_vector();
        let y = normal.cross(x);
        let (mut a, mut b, mut c, mut u, mut v) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for &p in points {
            let (px, py, d) = (p.dot(x), p.dot(y), p.dot(normal));
            (a, b, c) = (a + px * px, b + px * py, c + py * py);
            (u, v) = (u + px * d, v + py * d);
        }
        let determinant = a * c - b * b;
        if determinant <= 0.0 {
            break;
        }
        let (tilt_x, tilt_y) = ((c * u - b * v) / determinant, (a * v - b * u) / determinant);
        normal = (normal - x * tilt_x - y * tilt_y).normalize();
    }
    normal
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_plane_of_exact_points_even_when_thin_and_far() {
        let plane =
            Plane::new(DVec3::new(1.0, 2.0, -2.0), DVec3::new(3e4, -1e4, 2e4)).expect("a plane");
        let frame = super::super::Frame::on_plane(&plane);
        let thin = [(0.0, 0.0), (100.0, 0.0), (100.0, 1e-2), (0.0, 1e-2)];
        let points: Vec<_> =
            thin.iter().map(|&(x, y)| frame.lift(glam::DVec2::new(x, y))).collect();
        let fitted = fit_plane(&points).expect("four points of a plane");
        assert!(points.iter().all(|&p| fitted.signed_distance(p).abs() < 1e-10));
    }

    #[test]
    fn a_saddle_lies_half_above_and_half_below() {
        let saddle: Vec<_> =
            [(1.0, 1.0, 0.1), (-1.0, 1.0, -0.1), (-1.0, -1.0, 0.1), (1.0, -1.0, -0.1)]
                .map(|(x, y, z)| DVec3::new(x, y, z))
                .to_vec();
        let fitted = fit_plane(&saddle).expect("a plane");
        assert!(saddle.iter().all(|&p| (fitted.signed_distance(p).abs() - 0.1).abs() < 1e-14));
    }

    #[test]
    fn a_line_has_no_plane() {
        let line: Vec<_> = (0..5).map(|i| DVec3::new(1.0, 2.0, 3.0) * f64::from(i)).collect();
        assert!(fit_plane(&line).is_none());
        assert!(fit_plane(&line[..2]).is_none());
    }
}
