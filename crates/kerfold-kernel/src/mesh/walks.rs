//! The builder for operators that know every link: faces as walks of half-edges, without a search
//! for partners.
//!
//! Self-loops and 2-gons are legal here, unlike in [`super::MeshBuilder`], which reads what people
//! bring.

use glam::DVec3;

use super::build::split_fans;
use super::store::FaceList;
use super::{EdgeId, FaceId, FaceKind, HalfEdgeId, Mesh, VertexId};

/// Collects vertices, edges and faces. Sides of edges that no face uses become holes.
#[derive(Default)]
pub struct WalkBuilder {
    positions: Vec<Option<DVec3>>,
    edges: Vec<(VertexId, VertexId)>,
    list: FaceList,
}

impl WalkBuilder {
    /// A builder with room for so many vertices, edges and faces.
    pub fn with_capacity(vertices: usize, edges: usize, faces: usize) -> Self {
        let list = FaceList::with_capacity(2 * edges, faces);
        Self { positions: Vec::with_capacity(vertices), edges: Vec::with_capacity(edges), list }
    }

    /// Adds a vertex.
    pub fn vertex(&mut self, position: DVec3) -> VertexId {
        self.positions.push(Some(position));
        VertexId::new(self.positions.len() - 1)
    }

    /// Adds an edge and returns its half-edge from `a` to `b`.
    pub fn edge(&mut self, a: VertexId, b: VertexId) -> HalfEdgeId {
        self.edges.push((a, b));
        EdgeId::new(self.edges.len() - 1).half_edge()
    }

    /// Adds a face by its half-edges in order, each of which ends where the next begins.
    pub fn face(&mut self, half_edges: impl IntoIterator<Item = HalfEdgeId>) -> FaceId {
        FaceId::new(self.list.push(half_edges, FaceKind::Solid).expect("a face has sides"))
    }

    /// Builds the mesh; positions count as constructed. Faces that share a vertex only, at a rim,
    /// are pulled apart.
    pub fn build(mut self) -> Mesh {
        if self.list.half_edge_count() < 2 * self.edges.len() {
            self.close_holes();
            split_fans(&self.list, &mut self.edges, &mut self.positions);
        }
        let mut mesh = Mesh::assemble(self.positions, self.edges, &self.list);
        for v in (0..mesh.vertex_slots()).map(VertexId::new) {
            mesh.set_position(v, mesh.position(v), false);
        }
        mesh
    }

    /// Adds a hole for every walk of sides without a face. Around the vertex where such a side ends
    /// the nearest other one follows, so that a vertex with several rims keeps them apart.
    fn close_holes(&mut self) {
        let sides = 2 * self.edges.len();
        let mut prev = vec![HalfEdgeId(u32::MAX); sides];
        let mut is_used = vec![false; sides];
        for (walk, _) in self.list.iter() {
            for (i, &h) in walk.iter().enumerate() {
                prev[walk[(i + 1) % walk.len()].index()] = h;
                is_used[h.index()] = true;
            }
        }
        let successor = |h: HalfEdgeId| {
            let mut out = h.twin();
            while is_used[out.index()] {
                out = prev[out.index()].twin();
            }
            out
        };
        let mut is_done = is_used.clone();
        for start in (0..sides).map(HalfEdgeId::new) {
            let mut next = start;
            let walk = std::iter::from_fn(|| {
                let h = next;
                let is_new = !std::mem::replace(&mut is_done[h.index()], true);
                is_new.then(|| {
                    next = successor(h);
                    h
                })
            });
            self.list.push(walk, FaceKind::Hole);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    #[test]
    fn two_triangles_get_one_rim_and_a_loop_is_no_fault() {
        let mut walks = WalkBuilder::default();
        let v: Vec<VertexId> =
            [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE].map(|p| walks.vertex(p)).to_vec();
        let [ab, bc, ca, bd, dc] =
            [(0, 1), (1, 2), (2, 0), (1, 3), (3, 2)].map(|(a, b)| walks.edge(v[a], v[b]));
        walks.face([ab, bc, ca]);
        walks.face([bd, dc, bc.twin()]);
        let mesh = walks.build();
        assert_sound(&mesh);
        assert_eq!((mesh.face_count(), mesh.hole_count(), mesh.edge_count()), (2, 1, 5));
        assert!(mesh.vertices().all(|v| !mesh.is_given(v)));

        let mut walks = WalkBuilder::default();
        let a = walks.vertex(DVec3::ZERO);
        let ring = walks.edge(a, a);
        walks.face([ring]);
        walks.face([ring.twin()]);
        let mesh = walks.build();
        assert_sound(&mesh);
        assert_eq!((mesh.vertex_count(), mesh.edge_count(), mesh.face_count()), (1, 1, 2));
    }
}
