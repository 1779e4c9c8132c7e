//! Cutting one corner off, link by link.

use glam::DVec3;

use super::super::{FaceKind, Link, Mesh};
use crate::mesh::{FaceId, HalfEdgeId, VertexId};

impl Mesh {
    /// Replaces a vertex by a face with a corner on each of its edges: V + k − 1, E + k, F + 1 for
    /// k edges.
    ///
    /// `outgoing` are the half-edges that leave `v`, in the order of [`Mesh::outgoing`], and
    /// `places` the positions of the new corners on them. The first new corner keeps the id of `v`;
    /// the others are appended to `corners`. Returns the new face. The same as dividing every edge,
    /// joining the new vertices through the faces and cutting out what is left around `v`, without
    /// making what would go again.
    ///
    /// The caller has seen that `v` has at least two edges and no self-loop.
    pub fn replace_vertex(
        &mut self,
        v: VertexId,
        outgoing: &[HalfEdgeId],
        places: &[DVec3],
        corners: &mut Vec<VertexId>,
    ) -> FaceId {
        debug_assert!(self.outgoing(v).eq(outgoing.iter().copied()) && outgoing.len() >= 2);
        let cap = self.new_face(FaceKind::Solid);
        let first_corner = corners.len();
        corners.push(v);
        self.set_position(v, places[0], false);
        for (&h, &place) in outgoing.iter().zip(places).skip(1) {
            let corner = self.new_vertex(place);
            self.set_origin(h, corner);
            corners.push(corner);
        }
        let k = outgoing.len();
        let (mut first_side, mut last_side) = (None, None);
        for i in 0..k {
            // The face of the next half-edge arrives at v by the twin of this one: its new side
            // leads from here to there.
            let (h, next) = (outgoing[i], outgoing[(i + 1) % k]);
            let (here, there) = (corners[first_corner + i], corners[first_corner + (i + 1) % k]);
            let side = self.new_edge(here, there).half_edge();
            let face = self.face(next);
            self.link(h.twin(), side);
            self.link(side, next);
            self.half_edges[side.index()].face = face;
            self.half_edges[side.twin().index()].face = cap;
            if let Some(last) = last_side {
                self.link(side.twin(), last);
            }
            first_side = first_side.or(Some(side.twin()));
            last_side = Some(side.twin());
            self.vertices[here.index()].start = Link::edge(h);
        }
        if let (Some(first), Some(last)) = (first_side, last_side) {
            self.link(first, last);
            self.faces[cap.index()].start = Link::edge(first);
        }
        cap
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    #[test]
    fn every_corner_of_a_cube_becomes_a_triangle() {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut mesh = Mesh::from_faces((0..8).map(corner), faces).expect("a cube");
        for v in (0..8).map(VertexId::new) {
            let outgoing: Vec<HalfEdgeId> = mesh.outgoing(v).collect();
            let places: Vec<DVec3> = outgoing
                .iter()
                .map(|&h| mesh.position(v).lerp(mesh.position(mesh.target(h)), 0.25))
                .collect();
            let mut corners = Vec::new();
            let cap = mesh.replace_vertex(v, &outgoing, &places, &mut corners);
            assert_sound(&mesh);
            assert_eq!((mesh.sides(cap), corners.len(), corners[0]), (3, 3, v));
            let normal = mesh.plane(cap).expect("a triangle").normal();
            assert!(normal.dot(corner(v.index()) - 0.5) > 0.0, "the new face looks outwards");
        }
        assert_eq!((mesh.vertex_count(), mesh.edge_count(), mesh.face_count()), (24, 36, 14));
    }
}
