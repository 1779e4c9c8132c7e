//! A cut of a whole closed mesh: vertices and edges are gone through in the order of their ids,
//! once each.
//!
//! The walk of `cutter.rs` visits what lies in front of the plane from neighbour to neighbour,
//! which is right for a local cut; for half of a large mesh the same is found faster in the order
//! in which it lies in memory. Faces are divided and flat faces judged by the same rules.

use super::cutter::{Cutter, SlicingPlane};
use super::section::pair_by_material;
use crate::geom::{Frame, Side};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Region, VertexId};

/// Below this share of the vertices in front a sweep over all edges is not worth it.
const SMALL_SHARE: usize = 16;

/// What the sweep over the edges found.
#[derive(Default)]
struct Found {
    /// Edges with an end in front and none behind.
    in_front: Vec<EdgeId>,
    /// Edges with one end in front, one behind.
    crossing: Vec<EdgeId>,
    /// Edges of which one end is in front and one on the plane.
    ending: Vec<EdgeId>,
    /// Edges in the plane.
    on: Vec<EdgeId>,
}

impl Cutter {
    /// Cuts a mesh without rims with one plane. Returns `false`, with nothing done but the sides
    /// known, when so little lies in front that walking there from neighbour to neighbour costs
    /// less than a sweep.
    pub(super) fn cut_whole(&mut self, plane: &SlicingPlane) -> bool {
        let (in_front, on) = self.sweep_vertices(plane);
        if in_front.is_empty() {
            self.done.is_miss = true;
            return true;
        }
        if let ([v], []) = (&in_front[..], &on[..])
            && self.cut_corner(plane, *v)
        {
            return true;
        }
        let is_much = in_front.len() >= self.mesh.vertex_count() / SMALL_SHARE;
        if is_much {
            self.cut_by_sweep(plane, in_front, on);
        }
        is_much
    }

    fn cut_by_sweep(&mut self, plane: &SlicingPlane, in_front: Vec<VertexId>, on: Vec<VertexId>) {
        let mut found = self.sweep_edges();
        self.divide_by_sweep(plane, &found);
        self.doom_lone_of(&in_front);
        self.decide_flat_faces_of(plane, &found.on);
        self.gather_region();
        self.describe_sweep(&in_front);
        let region = self.region_by_sweep(in_front, on, &mut found);
        let frame = Frame::on_plane(&plane.plane);
        let mut touches_itself = false;
        let starts = self.mesh.replace_region_of(&region, |mesh, passes| {
            touches_itself = true;
            pair_by_material(mesh, &frame, passes);
        });
        self.region = region.faces;
        self.cap_walks(plane, &starts, &[], touches_itself);
        self.describe_touches();
    }

    /// Sorts the edges by the sides of their ends. Marks the faces of those in front as doomed;
    /// dividing takes back what is too much.
    fn sweep_edges(&mut self) -> Found {
        let mut found = Found::default();
        for e in (0..self.mesh.edge_slots()).map(EdgeId::new) {
            if !self.mesh.has_edge(e) {
                continue;
            }
            let [h, t] = e.half_edges();
            let sides =
                (self.known_side(self.mesh.origin(h)), self.known_side(self.mesh.origin(t)));
            match sides {
                (Side::Reverse, Side::Reverse | Side::On) | (Side::On, Side::Reverse) => continue,
                (Side::On, Side::On) => {
                    found.on.push(e);
                    continue;
                }
                (Side::Normal, Side::Reverse) | (Side::Reverse, Side::Normal) => {
                    found.crossing.push(e)
                }
                (Side::Normal, Side::On) | (Side::On, Side::Normal) => {
                    found.in_front.push(e);
                    found.ending.push(e);
                }
                (Side::Normal, Side::Normal) => found.in_front.push(e),
            }
            for side in [h, t] {
                let f = self.mesh.face(side);
                self.doomed[f.index()] = self.cut;
            }
        }
        found
    }

    /// Divides the faces that lie on both sides; of their parts those with a corner in front are
    /// doomed.
    fn divide_by_sweep(&mut self, plane: &SlicingPlane, found: &Found) {
        let mut faces: Vec<FaceId> = found
            .crossing
            .iter()
            .chain(&found.ending)
            .flat_map(|&e| self.mesh.edge_faces(e))
            .collect();
        faces.sort_unstable();
        faces.dedup();
        for &f in &faces {
            self.doomed[f.index()] = 0;
            self.divide_face(plane, f);
        }
        let parts = self.chords.iter().flat_map(|&e| self.mesh.edge_faces(e));
        faces.extend(parts);
        for f in faces {
            let is_in_front =
                self.mesh.face_vertices(f).any(|v| self.known_side(v) == Side::Normal);
            if is_in_front {
                self.doomed[f.index()] = self.cut;
            }
        }
    }

    fn doom_lone_of(&mut self, in_front: &[VertexId]) {
        for &v in in_front {
            if let Some(f) = self.mesh.lone_face(v) {
                self.doomed[f.index()] = self.cut;
            }
        }
    }

    /// As `decide_flat_faces`, with every face that has an edge in the plane as a candidate: first
    /// those next to what is doomed, then the ceilings of hollows.
    fn decide_flat_faces_of(&mut self, plane: &SlicingPlane, on: &[EdgeId]) {
        let mut candidates: Vec<FaceId> =
            on.iter().flat_map(|&e| self.mesh.edge_faces(e)).collect();
        candidates.sort_unstable();
        candidates.dedup();
        for &f in &candidates {
            let is_next_to_doomed = |c: &Self| {
                c.mesh.face_half_edges(f).any(|h| c.doomed[c.mesh.face(h.twin()).index()] == c.cut)
            };
            if self.is_undecided(f) && self.is_flat(plane, f) && is_next_to_doomed(self) {
                self.decide_patch(plane, f);
            }
        }
        for f in candidates {
            if self.is_undecided(f) && self.is_flat(plane, f) && !self.looks_along(plane, f) {
                self.decide_patch(plane, f);
            }
        }
    }

    fn gather_region(&mut self) {
        let doomed =
            (0..self.mesh.face_slots()).filter(|&f| self.doomed[f] == self.cut).map(FaceId::new);
        self.region.clear();
        self.region.extend(doomed);
    }

    fn describe_sweep(&mut self, in_front: &[VertexId]) {
        if self.cut > 1 {
            let mut met: Vec<usize> =
                self.region.iter().filter_map(|&f| self.cut_of_cap(f)).collect();
            met.extend(in_front.iter().filter_map(|&v| self.cut_of_vertex(v)));
            met.sort_unstable();
            met.dedup();
            self.done.met = met;
        }
        self.done.removed.extend(in_front.iter().filter(|v| self.born[v.index()] == 0));
    }

    /// The region with everything that goes with it: edges with an end in front lie inside, the
    /// others that the region can have run in the plane.
    fn region_by_sweep(
        &mut self,
        in_front: Vec<VertexId>,
        mut on: Vec<VertexId>,
        found: &mut Found,
    ) -> Region {
        let is_doomed = |c: &Self, h: HalfEdgeId| c.doomed[c.mesh.face(h).index()] == c.cut;
        let mut region = Region {
            faces: std::mem::take(&mut self.region),
            inner_edges: std::mem::take(&mut found.in_front),
            inner_vertices: in_front,
            ..Region::default()
        };
        on.extend(&self.splits);
        for &m in &self.splits {
            let leads_to_front =
                |h: &HalfEdgeId| self.known_side(self.mesh.target(*h)) == Side::Normal;
            region
                .inner_edges
                .extend(self.mesh.outgoing(m).filter(leads_to_front).map(HalfEdgeId::edge));
        }
        for e in found.on.iter().chain(&self.chords).copied() {
            let [h, t] = e.half_edges();
            match [h, t].map(|side| is_doomed(self, side)) {
                [true, true] => region.inner_edges.push(e),
                [true, false] => region.boundary.push(h),
                [false, true] => region.boundary.push(t),
                [false, false] => {}
            }
        }
        let is_inner = |v: &VertexId| {
            let mut around = self.mesh.outgoing(*v).peekable();
            around.peek().is_some() && around.all(|h| is_doomed(self, h))
        };
        region.inner_vertices.extend(on.into_iter().filter(is_inner));
        region
    }
}
