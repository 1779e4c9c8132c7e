//! Where a flat frame lies in space.

use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::geom::Plane;

/// A rigid placing: a point p goes to `rotation` · p + `translation`, in mm. Flat points have z =
/// 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Of unit length.
    pub rotation: DQuat,
    /// Where the origin goes.
    pub translation: DVec3,
}

impl Pose {
    /// Everything where it is.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// Where a flat point goes.
    pub fn lift(&self, p: DVec2) -> DVec3 {
        self.transform(p.extend(0.0))
    }

    /// Where a point goes.
    pub fn transform(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * p
    }

    /// First `inner`, then this.
    pub fn compose(&self, inner: &Self) -> Self {
        let rotation = (self.rotation * inner.rotation).normalize();
        Self { rotation, translation: self.transform(inner.translation) }
    }

    /// The way back.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// Between two placings of a body around its point `middle`: the point goes straight, the body
    /// turns evenly by the shorter way. A share of 0 is `from`, 1 is `to`.
    pub fn interpolate(from: &Self, to: &Self, middle: DVec3, share: f64) -> Self {
        if share <= 0.0 {
            return *from;
        }
        if share >= 1.0 {
            return *to;
        }
        let rotation = from.rotation.slerp(to.rotation, share).normalize();
        let at = from.transform(middle).lerp(to.transform(middle), share);
        Self { rotation, translation: at - rotation * middle }
    }

    /// The placing that lays a flat polygon onto points in space, corner by corner as well as it
    /// can be, seen from outside; `None` for points without area or of another number.
    pub fn fit(polygon: &[DVec2], points: &[DVec3]) -> Option<Self> {
        if polygon.len() != points.len() {
            return None;
        }
        let normal = Plane::newell(points)?.normal();
        let count = points.len() as f64;
        let (flat, space) =
            (polygon.iter().sum::<DVec2>() / count, points.iter().sum::<DVec3>() / count);
        let x = normal.any_orthonormal_vector();
        let y = normal.cross(x);
        let (mut dot, mut cross) = (0.0, 0.0);
        for (&p, &q) in polygon.iter().zip(points) {
            let (p, q) = (p - flat, q - space);
            let q = DVec2::new(q.dot(x), q.dot(y));
            (dot, cross) = (dot + p.dot(q), cross + p.perp_dot(q));
        }
        let (sin, cos) = cross.atan2(dot).sin_cos();
        let rotation =
            DQuat::from_mat3(&DMat3::from_cols(x * cos + y * sin, y * cos - x * sin, normal))
                .normalize();
        Some(Self { rotation, translation: space - rotation * flat.extend(0.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_chain_undo_and_lie_where_they_were_laid() {
        let pose = Pose {
            rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0),
            translation: DVec3::new(5.0, -7.0, 11.0),
        };
        let back = pose.inverse().compose(&pose);
        assert!(
            back.translation.length() < 1e-14
                && back.rotation.angle_between(DQuat::IDENTITY) < 1e-7
        );
        let flat = [(0.0, 0.0), (40.0, 0.0), (50.0, 30.0), (0.0, 20.0)].map(DVec2::from);
        let space = flat.map(|p| pose.lift(p));
        let found = Pose::fit(&flat, &space).expect("a quad has area");
        for (p, q) in flat.iter().zip(space) {
            assert!(found.lift(*p).distance(q) < 1e-13 * 60.0, "{p} {q}");
        }
        assert_eq!(Pose::fit(&flat, &space[..3]), None);
        assert_eq!(Pose::fit(&flat[..3], &[DVec3::ZERO; 3]), None);
    }

    #[test]
    fn half_way_is_half_way() {
        let to = Pose { rotation: DQuat::from_rotation_z(1.0), translation: DVec3::X };
        let half = Pose::interpolate(&Pose::IDENTITY, &to, DVec3::ZERO, 0.5);
        assert!((half.translation - DVec3::X / 2.0).length() < 1e-15);
        assert!((half.rotation.to_axis_angle().1 - 0.5).abs() < 1e-12);
        assert_eq!(Pose::interpolate(&Pose::IDENTITY, &to, DVec3::Y, 1.0), to);
    }
}
