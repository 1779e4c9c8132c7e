//! The high-level operators of Srinivasan 2004, III, composed of the fundamental ones.

use glam::DVec3;

use super::{Corner, EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::code::codes;

/// Why a high-level operator refused; the mesh is unchanged then.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OperatorError {
    /// The two corners of a pipe lie on one face.
    #[error("a pipe needs two faces, but both corners lie on face {0}")]
    SameFace(FaceId),
    /// A face manifold needs a polygon.
    #[error("a face needs at least 3 corners; {0} were given")]
    TooFewCorners(usize),
    /// An edge that starts and ends at one vertex cannot be collapsed.
    #[error("edge {0} is a self-loop; delete it instead of collapsing it")]
    SelfLoop(EdgeId),
}

codes!(error OperatorError {
    SameFace = 245,
    TooFewCorners = 246,
    SelfLoop = 247,
});

impl Mesh {
    /// Deletes an edge and the point spheres that it leaves (Srinivasan 2004, III.1).
    pub fn delete_edge_with_cleanup(&mut self, e: EdgeId) {
        let ends = self.edge_vertices(e);
        self.delete_edge(e);
        for v in ends {
            if self.has_vertex(v) && self.lone_face(v).is_some() {
                self.delete_vertex(v).expect("a point sphere can be deleted");
            }
        }
    }

    /// Divides an edge in its middle (Srinivasan 2004, III.2): V + 1, E + 1.
    pub fn subdivide_edge(&mut self, e: EdgeId) -> VertexId {
        let [a, b] = self.edge_positions(e);
        self.split_edge(e, a.midpoint(b)).0
    }

    /// Connects two faces by a pipe (Srinivasan 2004, III.3): corner is joined to corner, starting
    /// with the given pair and running opposite ways around the two faces. E + n, F + n − 2. With
    /// one component the genus grows by one, two components become one. The face with fewer sides
    /// first has its last edges divided until both have n.
    ///
    /// Returns the new faces, one for each pair of sides.
    ///
    /// # Errors
    /// [`OperatorError::SameFace`] when both corners lie on one face.
    pub fn create_pipe(
        &mut self,
        from: HalfEdgeId,
        to: HalfEdgeId,
    ) -> Result<Vec<FaceId>, OperatorError> {
        let (f, g) = (self.face(from), self.face(to));
        if f == g {
            return Err(OperatorError::SameFace(f));
        }
        let sides = self.sides(f).max(self.sides(g));
        self.subdivide_face(from, sides);
        self.subdivide_face_backwards(to, sides);
        let forwards: Vec<HalfEdgeId> = self.face_half_edges(f).collect();
        let start = forwards.iter().position(|&h| h == from).expect("the corner lies on its face");
        let (mut a, mut b) = (from, to);
        let mut rungs = Vec::with_capacity(sides);
        for i in 0..sides {
            let before_b = self.prev(b);
            rungs.push(
                self.insert_edge(Corner::At(a), Corner::At(b))
                    .expect("half-edges are corners")
                    .half_edge(),
            );
            (a, b) = (forwards[(start + i + 1) % sides], before_b);
        }
        // Each rung after the first closed the quad on its left; the first bounds what was left
        // over.
        rungs.rotate_left(1);
        Ok(rungs.into_iter().map(|rung| self.face(rung)).collect())
    }

    /// Divides the edges before the corner until its face has `sides` sides; the later half of each
    /// stays at the corner.
    fn subdivide_face(&mut self, corner: HalfEdgeId, sides: usize) {
        let mut last = self.prev(corner);
        for _ in self.sides(self.face(corner))..sides {
            self.subdivide_edge(last.edge());
            last = self.prev(corner);
        }
    }

    /// The same with the edge after the corner, which a walk the other way reaches last.
    fn subdivide_face_backwards(&mut self, corner: HalfEdgeId, sides: usize) {
        for _ in self.sides(self.face(corner))..sides {
            self.subdivide_edge(corner.edge());
        }
    }

    /// Makes a component of two faces back to back over `corners` (Srinivasan 2004, III.4): V + n,
    /// E + n, F + 2. Returns the front face, whose corners run as given, and the back face.
    ///
    /// # Errors
    /// [`OperatorError::TooFewCorners`] below three corners.
    pub fn create_face_manifold(
        &mut self,
        corners: &[DVec3],
    ) -> Result<(FaceId, FaceId), OperatorError> {
        if corners.len() < 3 {
            return Err(OperatorError::TooFewCorners(corners.len()));
        }
        let vertices: Vec<VertexId> = corners.iter().map(|&p| self.create_vertex(p).0).collect();
        let mut at = Corner::Lone(vertices[0]);
        let mut first = None;
        for &v in &vertices[1..] {
            let e = self.insert_edge(at, Corner::Lone(v)).expect("the vertex was just made");
            first.get_or_insert(e.half_edge());
            at = Corner::At(e.half_edge().twin());
        }
        let start = first.expect("there are at least two vertices");
        let closing = self.insert_edge(at, Corner::At(start)).expect("both are corners");
        Ok((self.face(closing.half_edge()), self.face(closing.half_edge().twin())))
    }

    /// Connects two half-edges by a new face between them (Srinivasan 2004, III.5): E + 2.
    ///
    /// The first edge runs from the start of `a` to the end of `b`, the second from the start of
    /// `b` to the end of `a`. Within one face F + 2; between two faces F stays and a handle is
    /// made. Returns the new face.
    pub fn connect_edges(&mut self, a: HalfEdgeId, b: HalfEdgeId) -> FaceId {
        let (end_of_a, end_of_b) = (self.next(a), self.next(b));
        self.insert_edge(Corner::At(a), Corner::At(end_of_b)).expect("half-edges are corners");
        self.insert_edge(Corner::At(b), Corner::At(end_of_a)).expect("half-edges are corners");
        self.face(a)
    }

    /// Merges the two ends of an edge into one vertex at its middle (Srinivasan 2004, III.6): V −
    /// 1, E − 1.
    ///
    /// Triangles at the edge become 2-gons, as in the thesis. The end at the edge's first half-edge
    /// stays.
    ///
    /// # Errors
    /// [`OperatorError::SelfLoop`] when both ends are one vertex.
    pub fn collapse_edge(&mut self, e: EdgeId) -> Result<VertexId, OperatorError> {
        let [keep, go] = self.edge_vertices(e);
        if keep == go {
            return Err(OperatorError::SelfLoop(e));
        }
        let [a, b] = self.edge_positions(e);
        self.contract_edge(e).expect("the ends differ");
        self.set_position(keep, a.midpoint(b), false);
        Ok(keep)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    fn cube() -> Mesh {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Mesh::from_faces((0..8).map(corner), faces).expect("a cube")
    }

    fn counts(mesh: &Mesh) -> (usize, usize, usize, usize) {
        let genus = mesh.components().iter().map(|c| c.genus).sum();
        (mesh.vertex_count(), mesh.edge_count(), mesh.face_count(), genus)
    }

    fn corner_of(mesh: &Mesh, face: usize) -> HalfEdgeId {
        mesh.face_start(FaceId::new(face)).expect("the face has edges")
    }

    #[test]
    fn collapsing_a_cube_edge_makes_two_triangles() {
        let mut mesh = cube();
        let kept = mesh.collapse_edge(EdgeId::new(0)).expect("no self-loop");
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (7, 11, 6, 0));
        assert_eq!(mesh.valence(kept), 4);
        assert_eq!(mesh.faces().filter(|&f| mesh.sides(f) == 3).count(), 2);
    }

    #[test]
    fn collapsing_every_edge_of_a_tetrahedron_ends_in_a_point_sphere() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mut mesh = Mesh::from_faces(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
            .expect("a tetrahedron");
        loop {
            let Some(e) = mesh.edges().next() else { break };
            if mesh.collapse_edge(e).is_err() {
                mesh.delete_edge_with_cleanup(e);
            }
            assert_sound(&mesh);
        }
        assert!(mesh.vertex_count() <= 1);
    }

    #[test]
    fn subdividing_and_joining_again_changes_nothing() {
        let mut mesh = cube();
        let v = mesh.subdivide_edge(EdgeId::new(3));
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (9, 13, 6, 0));
        mesh.join_edge(v).expect("valence two");
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (8, 12, 6, 0));
        assert!(mesh.join_edge(VertexId::new(0)).is_err());
    }

    #[test]
    fn a_pipe_between_opposite_faces_makes_a_torus() {
        let mut mesh = cube();
        let faces = mesh.create_pipe(corner_of(&mesh, 0), corner_of(&mesh, 1)).expect("two faces");
        assert_sound(&mesh);
        assert_eq!(faces.len(), 4);
        assert!(faces.iter().all(|&f| mesh.sides(f) == 4));
        assert_eq!(counts(&mesh), (8, 16, 8, 1));
        assert!(mesh.create_pipe(corner_of(&mesh, 2), mesh.next(corner_of(&mesh, 2))).is_err());
    }

    #[test]
    fn a_pipe_between_a_triangle_and_a_square_divides_the_triangle_first() {
        for (front, square) in [(true, false), (false, true)] {
            let mut mesh = cube();
            let triangle = [DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + 5.0);
            let (f, _) = mesh.create_face_manifold(&triangle).expect("a triangle");
            assert_sound(&mesh);
            let (a, b) = (mesh.face_start(f).expect("edges"), corner_of(&mesh, 0));
            let (from, to) = if front { (a, b) } else { (b, a) };
            let faces = mesh.create_pipe(from, to).expect("two faces");
            assert_sound(&mesh);
            assert_eq!((faces.len(), mesh.components().len(), square), (4, 1, !front));
            assert_eq!(counts(&mesh), (12, 20, 10, 0));
        }
    }

    #[test]
    fn a_face_manifold_is_a_front_and_a_back() {
        let mut mesh = Mesh::new();
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let (front, back) = mesh.create_face_manifold(&square).expect("four corners");
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (4, 4, 2, 0));
        assert_eq!(mesh.plane(front).expect("a plane").normal(), DVec3::Z);
        assert_eq!(mesh.plane(back).expect("a plane").normal(), -DVec3::Z);
        assert!(mesh.create_face_manifold(&square[..2]).is_err());
    }

    #[test]
    fn connecting_edges_divides_a_face_in_three_or_makes_a_handle() {
        let mut mesh = cube();
        let a = corner_of(&mesh, 0);
        let opposite = mesh.next(mesh.next(a));
        let strip = mesh.connect_edges(a, opposite);
        assert_sound(&mesh);
        assert_eq!((counts(&mesh), mesh.sides(strip)), ((8, 14, 8, 0), 4));
        let mut mesh = cube();
        mesh.connect_edges(corner_of(&mesh, 0), corner_of(&mesh, 1));
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (8, 14, 6, 1));
    }

    #[test]
    fn self_loops_two_gons_and_valence_one_vertices_are_legal() {
        let mut mesh = Mesh::new();
        let (u, _) = mesh.create_vertex(DVec3::ZERO);
        let (v, _) = mesh.create_vertex(DVec3::X);
        assert_sound(&mesh);
        let e = mesh.insert_edge(Corner::Lone(u), Corner::Lone(v)).expect("two point spheres");
        assert_sound(&mesh);
        assert_eq!((counts(&mesh), mesh.valence(u)), ((2, 1, 1, 0), 1));
        let two_gon = mesh
            .insert_edge(Corner::At(e.half_edge()), Corner::At(e.half_edge().twin()))
            .expect("corners");
        assert_sound(&mesh);
        assert_eq!(counts(&mesh), (2, 2, 2, 0));
        let at = Corner::At(two_gon.half_edge());
        let self_loop = mesh.insert_edge(at, at).expect("one corner twice");
        assert_sound(&mesh);
        assert_eq!(
            (counts(&mesh), mesh.sides(mesh.face(self_loop.half_edge()))),
            ((2, 3, 3, 0), 1)
        );
        for e in [self_loop, two_gon, e] {
            mesh.delete_edge(e);
            assert_sound(&mesh);
        }
        assert_eq!((mesh.vertex_count(), mesh.edge_count(), mesh.face_count()), (2, 0, 2));
        assert!(mesh.insert_edge(Corner::Lone(u), Corner::Lone(u)).is_ok());
        assert_sound(&mesh);
        assert!(mesh.delete_vertex(u).is_err());
        mesh.delete_vertex(v).expect("still a point sphere");
        assert_sound(&mesh);
    }

    #[test]
    fn a_region_is_replaced_by_one_cap_for_each_boundary_walk() {
        let mut mesh = cube();
        let caps = mesh.replace_region(&[FaceId::new(0), FaceId::new(2)], |_, _| ());
        assert_sound(&mesh);
        assert_eq!((caps.len(), counts(&mesh)), (1, (8, 11, 5, 0)));
        assert_eq!(mesh.sides(mesh.face(caps[0])), 6);
        let mut mesh = cube();
        let caps = mesh.replace_region(
            &[FaceId::new(2), FaceId::new(3), FaceId::new(4), FaceId::new(5)],
            |_, _| (),
        );
        assert_sound(&mesh);
        assert_eq!((caps.len(), mesh.components().len(), counts(&mesh)), (2, 2, (8, 8, 4, 0)));
        let everything: Vec<FaceId> = mesh.faces().collect();
        assert!(mesh.replace_region(&everything, |_, _| ()).is_empty());
        assert_eq!((mesh.vertex_count(), mesh.edge_count(), mesh.face_count()), (0, 0, 0));
        mesh.compact();
        assert_eq!(mesh.vertex_slots(), 0);
    }

    #[test]
    fn a_vertex_where_a_face_touches_itself_can_be_pulled_apart() {
        // Two tetrahedra glued at a vertex by merging one face of each through that vertex.
        let mut mesh = Mesh::new();
        let (f, _) =
            mesh.create_face_manifold(&[DVec3::ZERO, DVec3::X, DVec3::Y]).expect("a triangle");
        let a = mesh.face_start(f).expect("edges");
        let v = mesh.origin(a);
        let (u, _) = mesh.create_vertex(DVec3::Z);
        let spike = mesh.insert_edge(Corner::At(a), Corner::Lone(u)).expect("corners");
        let corners: Vec<HalfEdgeId> =
            mesh.outgoing(v).filter(|&h| mesh.face(h) == mesh.face(a)).collect();
        assert_eq!(corners.len(), 2);
        let (w, g) = mesh.split_vertex(corners[0], corners[1]).expect("same vertex, same face");
        assert_sound(&mesh);
        assert_eq!((mesh.components().len(), mesh.vertex_count()), (2, 5));
        assert_ne!((v, mesh.face(corners[0])), (w, g));
        assert!(mesh.has_edge(spike));
    }

    mod random_chains {
        use super::*;
        use proptest::prelude::*;

        fn step(mesh: &mut Mesh, code: u8, a: usize, b: usize) {
            let half_edges: Vec<HalfEdgeId> = mesh.half_edges().collect();
            if half_edges.is_empty() {
                let (u, _) = mesh.create_vertex(DVec3::X);
                mesh.insert_edge(Corner::Lone(u), Corner::Lone(u)).expect("a point sphere");
                return;
            }
            let (g, h) = (half_edges[a % half_edges.len()], half_edges[b % half_edges.len()]);
            match code % 10 {
                0 | 1 => drop(mesh.insert_edge(Corner::At(g), Corner::At(h)).expect("corners")),
                2 => mesh.delete_edge(g.edge()),
                3 => mesh.delete_edge_with_cleanup(g.edge()),
                4 => drop(mesh.subdivide_edge(g.edge())),
                5 => drop(mesh.collapse_edge(g.edge())),
                6 => drop(mesh.create_pipe(g, h)),
                7 => drop(mesh.connect_edges(g, h)),
                8 => drop(mesh.join_edge(mesh.origin(g))),
                _ => drop(mesh.compact()),
            }
        }

        proptest! {
            #![proptest_config(ProptestConfig::with_cases(400))]
            #[test]
            fn stay_sound(steps in prop::collection::vec((any::<u8>(), any::<usize>(), any::<usize>()), 1..24)) {
                let mut mesh = cube();
                for (code, a, b) in steps {
                    step(&mut mesh, code, a, b);
                    assert_sound(&mesh);
                }
            }

            #[test]
            fn replacing_any_region_is_sound(chosen in prop::collection::vec(any::<bool>(), 14), seed in any::<u8>()) {
                let mut mesh = cube();
                for i in 0..8 { mesh.connect_edges(corner_of(&mesh, i % 6), mesh.next(mesh.next(corner_of(&mesh, (i * usize::from(seed)) % 6)))); }
                let region: Vec<FaceId> = mesh.faces().zip(&chosen).filter(|(_, c)| **c).map(|(f, _)| f).collect();
                mesh.replace_region(&region, |_, _| ());
                assert_sound(&mesh);
            }
        }
    }
}
