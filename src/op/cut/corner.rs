//! The most frequent local cut: one corner comes off, and nothing else lies in front of the plane.
//!
//! Where every neighbour of the corner lies behind the plane and every face around it is convex,
//! the section is known without looking farther: one new vertex on each edge of the corner, one
//! cap. Nothing is divided that would be removed again, so the cut costs as much as the corner has
//! edges, whatever the sizes of its faces and of the mesh.

use super::cutter::{Capping, CornerWork, Cutter, End, SlicingPlane};
use crate::geom::{Plane, Side};
use crate::mesh::{FaceKind, VertexId};

impl Cutter {
    /// Cuts off the corner `v` if it is the simple case; else returns `false` and has changed
    /// nothing.
    pub(super) fn cut_corner(&mut self, plane: &SlicingPlane, v: VertexId) -> bool {
        if plane.given.is_some() || !self.mesh.has_vertex(v) {
            return false;
        }
        let here = self.end(&plane.plane, v);
        if self.side_at(v, here.distance) != Side::Normal {
            return false;
        }
        let mut work = std::mem::take(&mut self.corner);
        let is_simple = self.look_at_corner(&plane.plane, v, here, &mut work);
        if is_simple {
            self.remove_corner(plane, v, &mut work);
        }
        self.corner = work;
        is_simple
    }

    /// Collects the edges, planes and new places; says whether the corner is the simple case.
    fn look_at_corner(
        &mut self,
        plane: &Plane,
        v: VertexId,
        here: End,
        work: &mut CornerWork,
    ) -> bool {
        let CornerWork { outgoing, planes, ends, places, .. } = work;
        outgoing.clear();
        outgoing.extend(self.mesh.outgoing(v));
        if outgoing.len() < 3 {
            return false;
        }
        planes.clear();
        ends.clear();
        for &h in &*outgoing {
            let end = self.end(plane, self.mesh.target(h));
            if self.side_at(self.mesh.target(h), end.distance) != Side::Reverse {
                return false;
            }
            ends.push(end);
            let f = self.mesh.face(h);
            if !self.is_convex(f) {
                return false;
            }
            planes.push(self.mesh.carried_plane(f).or_else(|| {
                self.ensure_plane(f);
                self.mesh.carried_plane(f)
            }));
        }
        places.clear();
        let k = outgoing.len();
        for (i, &end) in ends.iter().enumerate() {
            // The other face of an edge is that of the next edge around the vertex.
            let faces = [planes[i].as_ref(), planes[(i + 1) % k].as_ref()];
            let place = self.crossing_between(plane, [here, end], faces);
            let is_end = place == here.position || place == end.position;
            if is_end || places.last() == Some(&place) || (i + 1 == k && place == places[0]) {
                return false;
            }
            places.push(place);
        }
        true
    }

    fn remove_corner(&mut self, plane: &SlicingPlane, v: VertexId, work: &mut CornerWork) {
        for &h in &work.outgoing {
            self.done.met.extend(self.cut_of_cap(self.mesh.face(h)));
        }
        match self.cut_of_vertex(v) {
            Some(cut) => self.done.met.push(cut),
            None => self.done.removed.push(v),
        }
        self.done.met.sort_unstable();
        self.done.met.dedup();
        work.corners.clear();
        let cap = self.mesh.replace_vertex(v, &work.outgoing, &work.places, &mut work.corners);
        for &corner in &work.corners {
            self.register_vertex(corner, v);
        }
        let stays_open = match self.capping {
            Capping::Auto => self.is_open_at(v),
            Capping::Always => false,
            Capping::Never => true,
        };
        self.register_cap(
            cap,
            if stays_open { FaceKind::Hole } else { FaceKind::Solid },
            &plane.plane,
        );
        self.done.caps.extend((!stays_open).then_some(cap));
    }
}
