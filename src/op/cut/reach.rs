//! One cut: takes off what lies on the normal side of a plane and closes the wound.
//!
//! Source: Gonen 2007, III.A, made exact and general as `docs/operators.md` says. Three steps for
//! each plane: *reach* (which vertices lie on the normal side and are connected with the chosen
//! element), *divide* (faces that lie on both sides are divided along the plane, `divide.rs`),
//! *close* (the region in front is replaced by caps, `section.rs`).

use super::cutter::{Cutter, Reach, SlicingPlane};
use crate::geom::Side;
use crate::mesh::{FaceId, VertexId};

impl Cutter {
    /// Cuts with one plane; [`Self::last_cut`] says what happened. Whatever the signs and the
    /// positions are, the mesh is sound afterwards.
    pub(in crate::op) fn cut(&mut self, plane: &SlicingPlane, reach: Reach<'_>) {
        self.cut += 1;
        self.done.clear();
        if let Reach::Local(&[v]) = reach
            && self.cut_corner(plane, v)
        {
            return;
        }
        self.region.clear();
        self.reached.clear();
        self.chords.clear();
        self.splits.clear();
        if matches!(reach, Reach::Global) && self.is_all_solid() && self.cut_whole(plane) {
            return;
        }
        self.reach(plane, reach);
        if self.region.is_empty() {
            self.done.is_miss = true;
            return;
        }
        self.decide_flat_faces(plane, matches!(reach, Reach::Global));
        self.describe_removed();
        self.close(plane);
        self.describe_touches();
        self.undo_needless_divisions();
    }

    fn reach(&mut self, plane: &SlicingPlane, reach: Reach<'_>) {
        let mut queue: Vec<VertexId> = match reach {
            Reach::Global => {
                let all: Vec<VertexId> = self.mesh.vertices().collect();
                all.into_iter().filter(|&v| self.side(plane, v) == Side::Normal).collect()
            }
            Reach::Local(seeds) => {
                seeds.iter().copied().filter(|&v| self.side(plane, v) == Side::Normal).collect()
            }
        };
        let (mut corners, mut faces) = (Vec::new(), Vec::new());
        while let Some(v) = queue.pop() {
            corners.clear();
            corners.extend(self.mesh.outgoing(v));
            let is_untouched = |c: &Self, f: FaceId| c.doomed[f.index()] != c.cut;
            for &h in &corners {
                let f = self.mesh.face(h);
                if is_untouched(self, f) && !self.mesh.is_hole(f) {
                    self.divide_face_at(plane, v, h);
                }
            }
            // Dividing may have given the sectors around v new faces; they all lie in front of the
            // plane now.
            faces.clear();
            faces.extend(self.mesh.outgoing(v).map(|h| self.mesh.face(h)));
            for &f in &faces {
                if is_untouched(self, f) {
                    self.doom(f);
                    self.reach_corners(plane, f, &mut queue);
                }
            }
            if faces.is_empty() {
                self.doom_lone(v);
            }
        }
    }

    fn doom_lone(&mut self, v: VertexId) {
        if let Some(f) = self.mesh.lone_face(v).filter(|f| self.doomed[f.index()] != self.cut) {
            self.reached.push(v);
            self.doom(f);
        }
    }

    /// Passes the walk on to the corners of a face in front. A rim is left where it leaves the
    /// front: what is connected only by a rim is not connected.
    fn reach_corners(&mut self, plane: &SlicingPlane, f: FaceId, queue: &mut Vec<VertexId>) {
        if self.mesh.is_hole(f) {
            return;
        }
        let corners: Vec<VertexId> = self.mesh.face_vertices(f).collect();
        for v in corners {
            if self.side(plane, v) == Side::Normal {
                // Asked again through every face; the stamp on the side keeps one visit each.
                self.visit(v, queue);
            }
        }
    }

    fn visit(&mut self, v: VertexId, queue: &mut Vec<VertexId>) {
        let has_unvisited_face =
            self.mesh.outgoing(v).any(|h| self.doomed[self.mesh.face(h).index()] != self.cut);
        if has_unvisited_face {
            queue.push(v);
        }
    }
}
