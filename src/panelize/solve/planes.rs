//! The plane of a panel while it is solved for.

use glam::DVec3;

use super::super::regions::Panels;
use crate::geom::fit_plane;

/// A plane by a unit normal and a point near its face.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct FacePlane {
    pub normal: DVec3,
    pub point: DVec3,
}

impl FacePlane {
    /// The plane nearest to a face's corners, with the normal on the side of `up`.
    pub(super) fn fit(panels: &Panels, f: usize, up: DVec3) -> Self {
        let corners: Vec<DVec3> = panels.faces[f].iter().map(|&v| panels.points[v]).collect();
        let point = panels.centre(f);
        let normal = fit_plane(&corners).map_or(up, |plane| plane.normal());
        Self { normal, point }.facing(up)
    }

    /// The same plane with the normal on the side of `up`.
    pub(super) fn facing(self, up: DVec3) -> Self {
        if self.normal.dot(up) < 0.0 { Self { normal: -self.normal, ..self } } else { self }
    }

    /// Two unit directions in the plane; with the normal a right-handed frame.
    pub(super) fn axes(&self) -> [DVec3; 2] {
        let first = self.normal.any_orthonormal_vector();
        [first, self.normal.cross(first)]
    }

    /// The signed distance of a place.
    pub(in super::super) fn distance(&self, place: DVec3) -> f64 {
        (place - self.point).dot(self.normal)
    }

    /// Tilted along both axes and moved along the normal.
    pub(super) fn stepped(&self, step: DVec3) -> Self {
        let [first, second] = self.axes();
        let normal = (self.normal + first * step.x + second * step.y).normalize();
        Self { normal, point: self.point + self.normal * step.z }
    }

    /// The same plane by the point of it that is nearest to a place.
    pub(in super::super) fn moved_to(&self, place: DVec3) -> Self {
        Self { point: place - self.normal * self.distance(place), ..*self }
    }
}
