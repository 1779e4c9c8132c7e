//! Where an edge meets the plane of a cut.

use glam::DVec3;

use super::{Cutter, SlicingPlane};
use crate::geom::{Plane, meet_three};
use crate::mesh::HalfEdgeId;

impl Cutter {
    /// The point where the edge of `h` meets the plane: on the edge, and, where an end of the edge was constructed itself, moved
    /// onto the planes of its two faces as far as rounding explains (the meeting point of three planes, solved on residuals), so
    /// that errors do not add up from cut to cut. An edge between given vertices is true as it is, while the planes of its faces
    /// are not: those of a needle lean by many digits.
    pub(super) fn crossing(&self, plane: &SlicingPlane, h: HalfEdgeId) -> DVec3 {
        let carried = [h, h.twin()].map(|side| self.mesh.carried_plane(self.mesh.face(side)));
        self.crossing_between(plane, h, carried)
    }

    /// [`Self::crossing`], given what planes the two faces carry.
    pub(in crate::op) fn crossing_between(
        &self,
        plane: &SlicingPlane,
        h: HalfEdgeId,
        carried: [Option<Plane>; 2],
    ) -> DVec3 {
        let on_edge = self.point_on_edge(plane, h);
        let [Some(f), Some(g)] = carried else { return on_edge };
        if [h, h.twin()].into_iter().all(|side| self.mesh.is_given(self.mesh.origin(side))) {
            return on_edge;
        }
        let is_end = |p: DVec3| [h, h.twin()].into_iter().any(|side| self.mesh.position(self.mesh.origin(side)) == p);
        match meet_three([&f, &g, &plane.plane], on_edge) {
            Some(met) if met.distance(on_edge) <= self.bound && !is_end(met) => met,
            _ => on_edge,
        }
    }

    /// The point of the edge of `h` that divides it in the ratio of its ends' distances from the plane.
    fn point_on_edge(&self, plane: &SlicingPlane, h: HalfEdgeId) -> DVec3 {
        let (a, b) = (self.mesh.position(self.mesh.origin(h)), self.mesh.position(self.mesh.target(h)));
        let (da, db) = (plane.plane.signed_distance(a), plane.plane.signed_distance(b));
        // From the nearer end, so that the error is relative to the short way. Exact signs may differ from rounded
        // distances in the last digit, hence the clamp.
        let (start, end, ds, de) = if da.abs() <= db.abs() { (a, b, da, db) } else { (b, a, db, da) };
        let t = (ds / (ds - de)).clamp(0.0, 1.0);
        if t.is_finite() { start + (end - start) * t } else { start }
    }
}
