//! Faces that lie in the slicing plane: which of them go and which stay as they are.

use super::cutter::{Cutter, SlicingPlane};
use crate::geom::Side;
use crate::mesh::{FaceId, HalfEdgeId, VertexId};

impl Cutter {
    /// Faces with every corner on the plane: those that look against the plane's normal bound what
    /// is removed and go; those that look along it stay, if anything behind the plane holds them. A
    /// local cut asks only those next to its region.
    pub(super) fn decide_flat_faces(&mut self, plane: &SlicingPlane, is_global: bool) {
        let mut next = 0;
        while next < self.region.len() {
            let f = self.region[next];
            next += 1;
            for h in self.walk_of(f) {
                let g = self.mesh.face(h.twin());
                if self.is_undecided(g) && self.is_flat(plane, g) {
                    self.decide_patch(plane, g);
                }
            }
        }
        if is_global {
            self.open_ceilings(plane);
        }
    }

    /// A hollow may end at the plane with material above: its ceiling has no neighbour in front,
    /// yet the cut opens it.
    fn open_ceilings(&mut self, plane: &SlicingPlane) {
        let on: Vec<VertexId> =
            self.mesh.vertices().filter(|&v| self.known_side(v) == Side::On).collect();
        for v in on.into_iter().filter(|&v| !self.is_open_at(v)).collect::<Vec<_>>() {
            let faces: Vec<FaceId> = self.mesh.vertex_faces(v).collect();
            for f in faces {
                if self.is_undecided(f) && self.is_flat(plane, f) && !self.looks_along(plane, f) {
                    self.decide_patch(plane, f);
                }
            }
        }
    }

    fn walk_of(&self, f: FaceId) -> Vec<HalfEdgeId> {
        self.mesh.face_half_edges(f).collect()
    }

    pub(super) fn is_undecided(&self, f: FaceId) -> bool {
        self.doomed[f.index()] != self.cut && self.decided[f.index()] != self.cut
    }

    pub(super) fn looks_along(&self, plane: &SlicingPlane, f: FaceId) -> bool {
        self.mesh.plane(f).is_some_and(|p| p.normal().dot(plane.plane.normal()) > 0.0)
    }

    pub(super) fn is_flat(&mut self, plane: &SlicingPlane, f: FaceId) -> bool {
        if self.mesh.is_hole(f) {
            return false;
        }
        let start = self.mesh.face_start(f);
        let mut next = start;
        while let Some(h) = next {
            if self.side(plane, self.mesh.origin(h)) != Side::On {
                return false;
            }
            next = Some(self.mesh.next(h)).filter(|&n| Some(n) != start);
        }
        true
    }

    pub(super) fn decide_patch(&mut self, plane: &SlicingPlane, seed: FaceId) {
        let mut patch = vec![seed];
        self.decided[seed.index()] = self.cut;
        let mut is_held = false;
        let mut next = 0;
        while let Some(&f) = patch.get(next) {
            next += 1;
            for h in self.walk_of(f) {
                let g = self.mesh.face(h.twin());
                if !self.is_undecided(g) {
                    continue;
                }
                if self.is_flat(plane, g) {
                    self.decided[g.index()] = self.cut;
                    patch.push(g);
                } else {
                    is_held = true;
                }
            }
        }
        for f in patch {
            if !(is_held && self.looks_along(plane, f)) {
                self.doom(f);
            }
        }
    }
}
