//! An orthonormal frame on a plane: the door between space and the flat.

use glam::{DVec2, DVec3};

use super::Plane;

/// A right-handed orthonormal frame: `x` and `y` span a plane, `normal` is x × y.
///
/// Seen from the normal side, x points right and y up, so counter-clockwise in space stays
/// counter-clockwise in the flat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The point that maps to (0, 0).
    pub origin: DVec3,
    /// Unit vector of the first flat coordinate.
    pub x: DVec3,
    /// Unit vector of the second flat coordinate.
    pub y: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

impl Frame {
    /// A frame on `plane` with its origin at the plane's point; the directions in the plane are
    /// arbitrary but deterministic.
    pub fn on_plane(plane: &Plane) -> Self {
        let normal = plane.normal();
        let x = normal.any_orthonormal_vector();
        Self { origin: plane.point(), x, y: normal.cross(x), normal }
    }

    /// A frame with its origin at `origin` and x along `direction` projected into the plane of
    /// `normal` (unit length). `None` when the direction is zero or parallel to the normal.
    pub fn along(origin: DVec3, direction: DVec3, normal: DVec3) -> Option<Self> {
        let x = (direction - normal * direction.dot(normal)).try_normalize()?;
        Some(Self { origin, x, y: normal.cross(x), normal })
    }

    /// The flat coordinates of the foot of `p` on the plane of the frame.
    pub fn flatten(&self, p: DVec3) -> DVec2 {
        let q = p - self.origin;
        DVec2::new(q.dot(self.x), q.dot(self.y))
    }

    /// The point of space at flat coordinates `q`.
    pub fn lift(&self, q: DVec2) -> DVec3 {
        self.origin + self.x * q.x + self.y * q.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lift_undoes_flatten() {
        let plane =
            Plane::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, -1.0, 0.5)).expect("a plane");
        let frame = Frame::on_plane(&plane);
        let p = frame.lift(DVec2::new(0.3, -0.7));
        assert!((frame.flatten(p) - DVec2::new(0.3, -0.7)).length() < 1e-15);
        assert!((frame.x.cross(frame.y) - frame.normal).length() < 1e-15);
        assert!(plane.signed_distance(p).abs() < 1e-15);
    }
}
