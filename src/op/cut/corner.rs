//! The most frequent local cut: one corner comes off, and nothing else lies in front of the plane.
//!
//! Where every neighbour of the corner lies behind the plane and every face around it is convex,
//! the section is known without looking farther: one new vertex on each edge of the corner, one
//! cap. Nothing is divided that would be removed again, so the cut costs as much as the corner has
//! edges, whatever the sizes of its faces and of the mesh.

use super::cutter::{Capping, Cutter, End, SlicingPlane};
use crate::geom::{Plane, Side};
use crate::mesh::{FaceId, FaceKind, HalfEdgeId, VertexId};

/// A face about whose shape nothing is known; zero, so that a new table costs nothing.
const UNKNOWN: u8 = 0;
/// A face that every line meets in one piece.
const CONVEX: u8 = 1;
/// Any other face.
const OTHER: u8 = 2;

/// What a cut of one corner needs to look at, kept from cut to cut.
#[derive(Clone, Default)]
pub(super) struct CornerWork {
    outgoing: Vec<HalfEdgeId>,
    planes: Vec<Option<Plane>>,
    /// The far ends of the edges.
    ends: Vec<End>,
    places: Vec<glam::DVec3>,
    corners: Vec<VertexId>,
}

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

    /// Collects the edges, planes and new places; tells whether the corner is the simple case.
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

    /// Whether every line meets the face in one piece. Asked once for each face; a cut leaves
    /// convex faces convex.
    #[inline]
    pub(super) fn is_convex(&mut self, f: FaceId) -> bool {
        if self.shapes[f.index()] == UNKNOWN {
            self.shapes[f.index()] = if self.finds_convex(f) { CONVEX } else { OTHER };
        }
        self.shapes[f.index()] == CONVEX
    }

    /// A part of a face that was divided or merged: only convexity lasts.
    pub(super) fn forget_shape_unless_convex(&mut self, f: FaceId) {
        if self.shapes[f.index()] != CONVEX {
            self.shapes[f.index()] = UNKNOWN;
        }
    }

    fn finds_convex(&mut self, f: FaceId) -> bool {
        let Some(first) = self.mesh.face_start(f).filter(|_| !self.mesh.is_hole(f)) else {
            return false;
        };
        let (second, third) = (self.mesh.next(first), self.mesh.next(self.mesh.next(first)));
        if self.mesh.next(third) == first {
            let [a, b, c] = [first, second, third].map(|h| self.mesh.origin(h));
            return a != b && b != c && c != a;
        }
        self.ensure_plane(f);
        let Some(normal) = self.mesh.carried_plane(f).map(|p| p.normal()) else { return false };
        let corner = |h: HalfEdgeId| self.mesh.position(self.mesh.origin(h));
        let origin = corner(first);
        let mut h = second;
        // It turns left everywhere, and it does so once: seen from its first corner it never turns
        // back.
        while h != first {
            let (before, here, after) =
                (corner(self.mesh.prev(h)), corner(h), corner(self.mesh.next(h)));
            let turns_left = normal.dot((here - before).cross(after - here)) >= 0.0;
            if !turns_left || normal.dot((here - origin).cross(after - origin)) < 0.0 {
                return false;
            }
            h = self.mesh.next(h);
        }
        let before = corner(self.mesh.prev(first));
        normal.dot((origin - before).cross(corner(second) - origin)) >= 0.0
    }
}
