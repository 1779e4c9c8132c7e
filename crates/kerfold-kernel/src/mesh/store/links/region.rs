//! Cutting a region of faces out.

use super::super::{FaceKind, Link, Mesh, NONE};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, VertexId};

/// A region of faces with everything that goes with it, for [`Mesh::replace_region_of`].
#[derive(Debug, Clone, Default)]
pub struct Region {
    /// The faces and holes.
    pub faces: Vec<FaceId>,
    /// The edges with a face of the region on both sides, each once.
    pub inner_edges: Vec<EdgeId>,
    /// The vertices around which every face is of the region, each once.
    pub inner_vertices: Vec<VertexId>,
    /// The half-edges of the region whose twins are not of the region, each once.
    pub boundary: Vec<HalfEdgeId>,
}

impl Mesh {
    /// Cuts a region of faces out and closes every boundary walk of it by one new face.
    ///
    /// Edges between two faces of the region and vertices with no edge left go; the edges on the
    /// region's boundary stay. The same as deleting the region's inner edges one by one, in time
    /// proportional to the region, except that a region of any genus and any number of boundary
    /// walks is closed by discs. Returns one half-edge on each new face. A component that lies
    /// wholly in the region disappears.
    ///
    /// Where the boundary passes a vertex several times, `pairing` may choose how the walks go on:
    /// it is given the boundary half-edges that end there, each with its successor around the
    /// region, and may permute the successors. The fans that are no longer connected then get
    /// vertices of their own.
    pub fn replace_region(
        &mut self,
        faces: &[FaceId],
        pairing: impl FnMut(&Self, &mut [(HalfEdgeId, HalfEdgeId)]),
    ) -> Vec<HalfEdgeId> {
        let region = self.region_of(faces);
        self.replace_region_of(&region, pairing)
    }

    /// Everything that goes with a region of distinct faces.
    fn region_of(&mut self, faces: &[FaceId]) -> Region {
        let mut region = Region { faces: faces.to_vec(), ..Region::default() };
        let members: Vec<HalfEdgeId> = faces
            .iter()
            .filter_map(|&f| self.face_start(f))
            .flat_map(|s| self.loop_from(s))
            .collect();
        let mut sorted = faces.to_vec();
        sorted.sort_unstable();
        let is_inside = |f: FaceId| sorted.binary_search(&f).is_ok();
        for &h in &members {
            if !is_inside(self.face(h.twin())) {
                region.boundary.push(h);
            } else if h.edge().half_edge() == h {
                region.inner_edges.push(h.edge());
            }
        }
        let mut staying: Vec<VertexId> =
            region.boundary.iter().flat_map(|&h| [self.origin(h), self.target(h)]).collect();
        staying.sort_unstable();
        let ends = members.iter().map(|&h| self.origin(h));
        region.inner_vertices = ends.filter(|v| staying.binary_search(v).is_err()).collect();
        region.inner_vertices.extend(faces.iter().filter_map(|&f| self.lone_vertex(f)));
        region.inner_vertices.sort_unstable();
        region.inner_vertices.dedup();
        region
    }

    /// [`Self::replace_region`] for a caller that knows all that goes; nothing but that is looked
    /// at.
    pub fn replace_region_of(
        &mut self,
        region: &Region,
        mut pairing: impl FnMut(&Self, &mut [(HalfEdgeId, HalfEdgeId)]),
    ) -> Vec<HalfEdgeId> {
        for &f in &region.faces {
            self.free_face(f);
        }
        let is_inside =
            |mesh: &Self, h: HalfEdgeId| mesh.faces[mesh.face(h).index()].start == Link::FREE;
        let mut boundary: Vec<(HalfEdgeId, HalfEdgeId)> = Vec::with_capacity(region.boundary.len());
        for &h in &region.boundary {
            let mut next = self.next(h);
            while is_inside(self, next.twin()) {
                next = self.next(next.twin());
            }
            boundary.push((h, next));
        }
        let touched = self.pair_at_touched_vertices(&mut boundary, &mut pairing);
        for &(h, next) in &boundary {
            self.link(h, next);
            let v = self.origin(h);
            self.vertices[v.index()].start = Link::edge(h);
        }
        for &e in &region.inner_edges {
            self.free_edge(e);
        }
        for &v in &region.inner_vertices {
            self.free_vertex(v);
        }
        for v in touched {
            self.separate_fans(v, &boundary);
        }
        self.close_loops(&boundary)
    }

    /// Offers the passes of every vertex with more than one of them to `pairing`; returns those
    /// vertices.
    fn pair_at_touched_vertices(
        &self,
        boundary: &mut [(HalfEdgeId, HalfEdgeId)],
        pairing: &mut impl FnMut(&Self, &mut [(HalfEdgeId, HalfEdgeId)]),
    ) -> Vec<VertexId> {
        let mut passes: Vec<(VertexId, usize)> =
            boundary.iter().enumerate().map(|(i, &(h, _))| (self.target(h), i)).collect();
        passes.sort_unstable();
        let mut touched = Vec::new();
        for group in passes.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
            let mut pairs: Vec<_> = group.iter().map(|&(_, i)| boundary[i]).collect();
            pairing(self, &mut pairs);
            for (&(_, i), pair) in group.iter().zip(pairs) {
                boundary[i] = pair;
            }
            touched.push(group[0].0);
        }
        touched
    }

    /// Gives every fan at `v` but the first a vertex of its own, after its links were changed.
    fn separate_fans(&mut self, v: VertexId, boundary: &[(HalfEdgeId, HalfEdgeId)]) {
        let leaving: Vec<HalfEdgeId> =
            boundary.iter().map(|&(_, next)| next).filter(|&h| self.origin(h) == v).collect();
        let mut fans: Vec<Vec<HalfEdgeId>> = Vec::new();
        for start in leaving {
            if !fans.iter().flatten().any(|&h| h == start) {
                let walk = std::iter::successors(Some(start), |&h| {
                    Some(self.next(h.twin())).filter(|&n| n != start)
                });
                fans.push(walk.collect());
            }
        }
        self.vertices[v.index()].start = Link::edge(fans[0][0]);
        for fan in &fans[1..] {
            let split_off = self.new_vertex(self.position(v));
            self.vertices[split_off.index()].is_given = self.is_given(v);
            self.vertices[split_off.index()].start = Link::edge(fan[0]);
            for &h in fan {
                self.set_origin(h, split_off);
            }
        }
    }

    fn close_loops(&mut self, boundary: &[(HalfEdgeId, HalfEdgeId)]) -> Vec<HalfEdgeId> {
        for &(h, _) in boundary {
            self.half_edges[h.index()].face = FaceId(NONE);
        }
        let mut starts = Vec::new();
        for &(h, _) in boundary {
            if self.face(h).0 == NONE {
                let cap = self.new_face(FaceKind::Solid);
                self.assign_loop(h, cap);
                starts.push(h);
            }
        }
        starts
    }
}
