//! Where planes meet, in the sense of least squares.

use glam::DVec3;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::Plane;

/// Eigenvalues of the squared system below this share of the largest are rounding: the planes say
/// nothing there. Squaring halves the digits, so normals must open by about 1e-7 rad to count as
/// different.
const RANK: f64 = 64.0 * f64::EPSILON;

/// The point with the least sum of squared distances to `planes`, and its largest distance from any
/// of them.
///
/// Worked out relative to the planes' own points, so that it is accurate however far from the
/// origin they lie. `None` with fewer than three planes, or when their normals do not span space:
/// then no single point is the nearest.
pub fn meet_planes(planes: &[Plane]) -> Option<(DVec3, f64)> {
    let first = planes.first()?.point();
    let anchor =
        first + planes.iter().map(|p| p.point() - first).sum::<DVec3>() / planes.len() as f64;
    let system = System::new(planes, anchor);
    (system.rank() == 3).then(|| system.solve(planes))
}

/// The same, but of all points that serve equally well the one nearest to `near`; so it exists for
/// one plane, for planes through a common line, and for parallel ones too.
pub fn meet_planes_near(planes: &[Plane], near: DVec3) -> (DVec3, f64) {
    System::new(planes, near).solve(planes)
}

/// The normal equations of the distances, with the anchor as origin.
struct System {
    anchor: DVec3,
    values: Vector3<f64>,
    vectors: Matrix3<f64>,
}

impl System {
    fn new(planes: &[Plane], anchor: DVec3) -> Self {
        let squared = planes.iter().fold(Matrix3::zeros(), |sum, plane| {
            let n = vector(plane.normal());
            sum + n * n.transpose()
        });
        let eigen = SymmetricEigen::new(squared);
        Self { anchor, values: eigen.eigenvalues, vectors: eigen.eigenvectors }
    }

    fn spans(&self, axis: usize) -> bool {
        self.values[axis] > RANK * self.values.max()
    }

    fn rank(&self) -> usize {
        (0..3).filter(|&axis| self.spans(axis)).count()
    }

    /// The nearest point and its largest distance. Squaring loses half the digits; solving again
    /// for what is left over wins them back.
    fn solve(&self, planes: &[Plane]) -> (DVec3, f64) {
        let distance =
            |plane: &Plane, x: DVec3| plane.normal().dot(x - (plane.point() - self.anchor));
        let mut x = DVec3::ZERO;
        for _ in 0..3 {
            let pull: DVec3 = planes.iter().map(|plane| plane.normal() * distance(plane, x)).sum();
            x -= self.inverse(pull);
        }
        let residual = planes.iter().map(|plane| distance(plane, x).abs()).fold(0.0, f64::max);
        (self.anchor + x, residual)
    }

    /// Applies the pseudo-inverse.
    fn inverse(&self, pull: DVec3) -> DVec3 {
        let parts = (0..3).filter(|&axis| self.spans(axis)).map(|axis| {
            let direction = self.vectors.column(axis);
            let direction = DVec3::new(direction[0], direction[1], direction[2]);
            direction * (direction.dot(pull) / self.values[axis])
        });
        parts.sum()
    }
}

fn vector(v: DVec3) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(n: [f64; 3], p: DVec3) -> Plane {
        Plane::new(DVec3::from_array(n), p).expect("a plane")
    }

    #[test]
    fn three_planes_meet_in_their_corner_even_far_away() {
        let corner = DVec3::new(1e6, -3e6, 2e6);
        let normals = [[1.0, 0.2, 0.0], [0.1, 1.0, -0.3], [0.0, 0.4, 1.0]];
        let planes = normals.map(|n| {
            let at_corner = plane(n, corner);
            plane(n, corner + at_corner.normal().any_orthonormal_vector() * 7.0)
        });
        let (point, residual) = meet_planes(&planes).expect("they span space");
        assert!(point.distance(corner) < 1e-8, "{}", point.distance(corner));
        assert!(residual < 1e-8);
    }

    #[test]
    fn flat_corners_keep_their_digits() {
        // Normals that open by 1e-4 only: squared, eight digits would be gone.
        let normals = [[1e-4, 0.0, 1.0], [-1e-4, 1e-4, 1.0], [0.0, -1e-4, 1.0]];
        let corner = DVec3::new(0.3, -0.2, 0.1);
        let planes =
            normals.map(|n| plane(n, corner + plane(n, corner).normal().any_orthonormal_vector()));
        let (point, residual) = meet_planes(&planes).expect("they span space");
        assert!(point.distance(corner) < 1e-10, "{}", point.distance(corner));
        assert!(residual < 1e-14);
    }

    #[test]
    fn four_planes_that_miss_each_other_share_the_error() {
        let planes = [
            plane([1.0, 0.0, 0.0], DVec3::ZERO),
            plane([0.0, 1.0, 0.0], DVec3::ZERO),
            plane([0.0, 0.0, 1.0], DVec3::ZERO),
            plane([0.0, 0.0, 1.0], DVec3::Z * 0.5),
        ];
        let (point, residual) = meet_planes(&planes).expect("they span space");
        assert!(point.distance(DVec3::Z * 0.25) < 1e-15);
        assert!((residual - 0.25).abs() < 1e-15);
    }

    #[test]
    fn planes_through_a_line_have_no_point_but_a_nearest_one() {
        let through_z = [plane([1.0, 0.0, 0.0], DVec3::ZERO), plane([1.0, 1.0, 0.0], DVec3::ZERO)];
        assert!(meet_planes(&through_z).is_none());
        assert!(meet_planes(&[]).is_none());
        let (point, residual) = meet_planes_near(&through_z, DVec3::new(3.0, 4.0, 5.0));
        assert!(point.distance(DVec3::Z * 5.0) < 1e-14 && residual < 1e-15);
        assert_eq!(meet_planes_near(&[], DVec3::ONE), (DVec3::ONE, 0.0));
    }
}
