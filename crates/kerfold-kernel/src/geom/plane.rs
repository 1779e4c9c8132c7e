//! An oriented plane.

use glam::DVec3;

/// An oriented plane: a unit normal and a point on the plane.
///
/// The normal side (positive distances) is the side that a cut removes. The plane is anchored at a
/// point instead of an offset from the origin, so that distances near the anchor keep full
/// precision however far from the origin the model is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    normal: DVec3,
    point: DVec3,
}

impl Plane {
    /// The plane through `point` with the direction of `normal`, which need not have unit length.
    /// `None` when the normal is zero or anything is not finite.
    #[inline]
    pub fn new(normal: DVec3, point: DVec3) -> Option<Self> {
        // Scaled first, so that neither tiny nor huge normals overflow or vanish when squared.
        let scale = normal.abs().max_element();
        let normal = (normal / scale).try_normalize()?;
        point.is_finite().then_some(Self { normal, point })
    }

    /// The plane of a closed polygon: Newell normal, through the mean of the corners. `None` when
    /// the corners are collinear.
    ///
    /// The normal points to the side from which the corners run counter-clockwise.
    pub fn newell(corners: &[DVec3]) -> Option<Self> {
        let mean = mean(corners)?;
        Self::new(newell_vector(corners, mean), mean)
    }

    /// The unit normal.
    #[inline]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// A point on the plane, near which distances are most precise.
    #[inline]
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// The signed distance of the plane from the origin along its normal: `normal · x = offset` on
    /// the plane.
    pub fn offset(&self) -> f64 {
        self.normal.dot(self.point)
    }

    /// The signed distance of `x`; positive on the normal side.
    #[inline]
    pub fn signed_distance(&self, x: DVec3) -> f64 {
        self.normal.dot(x - self.point)
    }

    /// The foot of the perpendicular from `x`.
    pub fn project(&self, x: DVec3) -> DVec3 {
        x - self.normal * self.signed_distance(x)
    }

    /// The same plane seen from the other side.
    pub fn flipped(&self) -> Self {
        Self { normal: -self.normal, point: self.point }
    }

    /// The parallel plane at `distance` along the normal.
    pub fn moved(&self, distance: f64) -> Self {
        Self { normal: self.normal, point: self.point + self.normal * distance }
    }

    /// The plane through the mean of `points`, with the mean of unit `normals` as its direction
    /// (Gonen 2007, III.B). `None` when there is no point or the normals cancel.
    pub fn through_mean(points: &[DVec3], normals: &[DVec3]) -> Option<Self> {
        let direction: DVec3 = normals.iter().sum();
        // Unit vectors that cancel leave only rounding; a direction out of that would be chance.
        let cancelled = direction.length() <= 8.0 * f64::EPSILON * normals.len() as f64;
        if cancelled { None } else { Self::new(direction, mean(points)?) }
    }
}

/// The mean of `points`, summed relative to the first so that far from the origin no digits are
/// lost.
fn mean(points: &[DVec3]) -> Option<DVec3> {
    let first = *points.first()?;
    let sum: DVec3 = points.iter().map(|&p| p - first).sum();
    Some(first + sum / points.len() as f64)
}

/// Twice the vector area of a closed polygon (Newell), measured from `centre`.
fn newell_vector(corners: &[DVec3], centre: DVec3) -> DVec3 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    pairs.map(|(&a, &b)| (a - centre).cross(b - centre)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newell_points_to_the_counter_clockwise_side() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let plane = Plane::newell(&square).expect("a square has a plane");
        assert_eq!(plane.normal(), DVec3::Z);
        assert_eq!(plane.signed_distance(DVec3::new(5.0, 5.0, 2.0)), 2.0);
        assert!(Plane::newell(&[DVec3::ZERO, DVec3::X, DVec3::X * 2.0]).is_none());
    }

    #[test]
    fn tiny_and_huge_normals_are_normalised() {
        for scale in [1e-200, 1.0, 1e200] {
            let plane =
                Plane::new(DVec3::new(0.0, 3.0, 4.0) * scale, DVec3::ZERO).expect("not zero");
            assert!((plane.normal() - DVec3::new(0.0, 0.6, 0.8)).length() < 1e-15);
        }
        assert!(Plane::new(DVec3::ZERO, DVec3::ZERO).is_none());
        assert!(Plane::new(DVec3::X, DVec3::splat(f64::NAN)).is_none());
    }

    #[test]
    fn normals_that_cancel_give_no_plane() {
        assert!(Plane::through_mean(&[DVec3::ZERO], &[DVec3::X, -DVec3::X]).is_none());
        assert!(Plane::through_mean(&[], &[DVec3::X]).is_none());
    }
}
