//! Where an edge meets the plane of a cut.

use glam::DVec3;

use super::{Cutter, SlicingPlane};
use crate::geom::{Plane, meet_three};
use crate::mesh::{HalfEdgeId, VertexId};

/// An end of an edge that is cut.
#[derive(Debug, Clone, Copy)]
pub(in crate::op) struct End {
    pub(in crate::op) position: DVec3,
    /// Its signed distance from the plane.
    pub(in crate::op) distance: f64,
    /// Whether its numbers are given, not computed.
    pub(in crate::op) is_given: bool,
}

impl End {
    fn is_at(&self, p: DVec3) -> bool {
        self.position == p
    }
}

impl Cutter {
    /// The point where the edge of `h` meets the plane.
    pub(super) fn crossing(&self, plane: &SlicingPlane, h: HalfEdgeId) -> DVec3 {
        let [f, g] = [h, h.twin()].map(|side| self.mesh.carried_plane(self.mesh.face(side)));
        let ends = [h, h.twin()].map(|side| self.end(&plane.plane, self.mesh.origin(side)));
        self.crossing_between(&plane.plane, ends, [f.as_ref(), g.as_ref()])
    }

    pub(in crate::op) fn end(&self, plane: &Plane, v: VertexId) -> End {
        let position = self.mesh.position(v);
        End { position, distance: plane.signed_distance(position), is_given: self.mesh.is_given(v) }
    }

    /// The point where an edge meets the plane, given its ends and what planes its faces carry: on
    /// the edge, and, where an end was constructed itself, moved onto the planes of the faces as
    /// far as rounding explains (the meeting point of three planes, solved on residuals), so that
    /// errors do not add up from cut to cut. An edge between given vertices is true as it is, while
    /// the planes of its faces are not: those of a needle lean by many digits.
    #[inline]
    pub(in crate::op) fn crossing_between(
        &self,
        plane: &Plane,
        ends: [End; 2],
        carried: [Option<&Plane>; 2],
    ) -> DVec3 {
        let on_edge = point_on_edge(ends);
        let [Some(f), Some(g)] = carried else { return on_edge };
        if ends[0].is_given && ends[1].is_given {
            return on_edge;
        }
        // Squares, since a root would be waited for.
        let is_near = |met: DVec3| met.distance_squared(on_edge) <= self.bound * self.bound;
        match meet_three([f, g, plane], on_edge) {
            Some(met) if is_near(met) && !ends[0].is_at(met) && !ends[1].is_at(met) => met,
            _ => on_edge,
        }
    }
}

/// The point of an edge that divides it in the ratio of its ends' distances from the plane.
#[inline]
fn point_on_edge([a, b]: [End; 2]) -> DVec3 {
    // From the nearer end, so that the error is relative to the short way. Exact signs may differ
    // from rounded distances in the last digit, hence the clamp.
    let (start, end) = if a.distance.abs() <= b.distance.abs() { (a, b) } else { (b, a) };
    let t = (start.distance / (start.distance - end.distance)).clamp(0.0, 1.0);
    if t.is_finite() {
        start.position + (end.position - start.position) * t
    } else {
        start.position
    }
}
