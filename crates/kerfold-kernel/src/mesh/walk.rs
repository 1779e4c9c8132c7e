//! Reading a mesh: circulators, and the few questions that everybody asks.

use glam::DVec3;

use super::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::geom::Plane;

/// One connected part of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Its vertices, ascending.
    pub vertices: Vec<VertexId>,
    /// Its faces without the holes, ascending. Empty for a stray vertex.
    pub faces: Vec<FaceId>,
    /// Number of edges.
    pub edges: usize,
    /// Number of holes (rims).
    pub holes: usize,
    /// Number of handles. Rims are closed by discs for the count: (2 − V + E − F − rims) / 2.
    pub genus: usize,
}

impl Mesh {
    /// All vertices, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0..self.vertex_slots() as u32).map(VertexId).filter(|&v| self.has_vertex(v))
    }

    /// All edges, ascending.
    pub fn edges(&self) -> impl Iterator<Item = EdgeId> + '_ {
        (0..self.edge_slots() as u32).map(EdgeId).filter(|&e| self.has_edge(e))
    }

    /// All half-edges, ascending.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        self.edges().flat_map(EdgeId::half_edges)
    }

    /// All faces that are not holes, ascending. The faces of point spheres are among them.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.faces_and_holes().filter(|&f| !self.is_hole(f))
    }

    /// All holes, ascending.
    pub fn holes(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.faces_and_holes().filter(|&f| self.is_hole(f))
    }

    /// All faces and holes, ascending.
    pub fn faces_and_holes(&self) -> impl Iterator<Item = FaceId> + '_ {
        (0..self.face_slots() as u32).map(FaceId).filter(|&f| self.has_face(f))
    }

    /// The half-edges around a face (or hole), counter-clockwise seen from outside. None for a
    /// point sphere's face.
    #[inline]
    pub fn face_half_edges(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let start = self.face_start(f);
        std::iter::successors(start, move |&h| Some(self.next(h)).filter(|&n| Some(n) != start))
    }

    /// The vertices around a face, counter-clockwise seen from outside.
    #[inline]
    pub fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> + '_ {
        self.face_half_edges(f).map(|h| self.origin(h)).chain(self.lone_vertex(f))
    }

    /// The positions around a face, in the order of [`Self::face_vertices`].
    pub fn face_positions(&self, f: FaceId) -> Vec<DVec3> {
        self.face_vertices(f).map(|v| self.position(v)).collect()
    }

    /// The half-edges that leave a vertex, clockwise seen from outside. None for a point sphere.
    #[inline]
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let start = self.vertex_start(v);
        std::iter::successors(start, move |&h| {
            Some(self.next(h.twin())).filter(|&n| Some(n) != start)
        })
    }

    /// The vertices at the other ends of a vertex's edges; one for each edge end, so a self-loop
    /// gives the vertex twice.
    #[inline]
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.outgoing(v).map(|h| self.target(h))
    }

    /// The faces around a vertex, holes left out; a face that touches the vertex twice comes twice.
    pub fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> + '_ {
        self.outgoing(v).map(|h| self.face(h)).filter(|&f| !self.is_hole(f))
    }

    /// Number of edge ends at a vertex; a self-loop counts twice.
    pub fn valence(&self, v: VertexId) -> usize {
        self.outgoing(v).count()
    }

    /// Number of sides of a face.
    pub fn sides(&self, f: FaceId) -> usize {
        self.face_half_edges(f).count()
    }

    /// The two end vertices of an edge: origin and target of its first half-edge.
    #[inline]
    pub fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        e.half_edges().map(|h| self.origin(h))
    }

    /// The positions of the two ends of an edge.
    pub fn edge_positions(&self, e: EdgeId) -> [DVec3; 2] {
        self.edge_vertices(e).map(|v| self.position(v))
    }

    /// The faces (or holes) on the two sides of an edge.
    #[inline]
    pub fn edge_faces(&self, e: EdgeId) -> [FaceId; 2] {
        e.half_edges().map(|h| self.face(h))
    }

    /// The edge between two vertices, if there is one.
    pub fn edge_between(&self, u: VertexId, v: VertexId) -> Option<EdgeId> {
        self.outgoing(u).find(|&h| self.target(h) == v).map(HalfEdgeId::edge)
    }

    /// Whether one side of the edge is a hole.
    pub fn is_rim(&self, e: EdgeId) -> bool {
        self.edge_faces(e).into_iter().any(|f| self.is_hole(f))
    }

    /// Whether the vertex touches a hole.
    pub fn is_rim_vertex(&self, v: VertexId) -> bool {
        self.outgoing(v).any(|h| self.is_hole(self.face(h)))
    }

    /// Whether no face is missing: the mesh has no rim.
    #[inline]
    pub fn is_closed(&self) -> bool {
        self.hole_count() == 0
    }

    /// The plane of a face: the one it carries, else the Newell plane of its corners. `None` for a
    /// face without area.
    pub fn plane(&self, f: FaceId) -> Option<Plane> {
        self.carried_plane(f).or_else(|| Plane::newell(&self.face_positions(f)))
    }

    /// The lowest and highest coordinates; `None` without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut points = self.vertices().map(|v| self.position(v));
        let first = points.next()?;
        Some(points.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    }

    /// The connected parts, ordered by their lowest vertex.
    pub fn components(&self) -> Vec<Component> {
        let mut seen = super::VertexMap::filled(self.vertex_slots(), false);
        let mut components = Vec::new();
        let mut face_seen = super::FaceMap::filled(self.face_slots(), false);
        for seed in self.vertices() {
            if seen[seed] {
                continue;
            }
            seen[seed] = true;
            let mut vertices = vec![seed];
            let mut next = 0;
            while let Some(&v) = vertices.get(next) {
                next += 1;
                for u in self.neighbours(v) {
                    if !std::mem::replace(&mut seen[u], true) {
                        vertices.push(u);
                    }
                }
            }
            components.push(self.component_of(vertices, &mut face_seen));
        }
        components
    }

    /// How many connected parts there are, a stray vertex among them: the number of
    /// [`Mesh::components`], found in one pass over the edges as they lie in memory.
    ///
    /// ```
    /// use glam::DVec3;
    /// use kerfold_kernel::mesh::Mesh;
    ///
    /// let corners = (0..6).map(|i| DVec3::new(f64::from(i % 3), f64::from(i * i), f64::from(i / 3)));
    /// let two = Mesh::from_faces(corners, [[0, 1, 2], [3, 4, 5]])?;
    /// assert_eq!((two.component_count(), two.components().len()), (2, 2));
    /// # Ok::<(), kerfold_kernel::mesh::BuildError>(())
    /// ```
    pub fn component_count(&self) -> usize {
        let mut leader: Vec<u32> = (0..self.vertex_slots() as u32).collect();
        let mut parts = self.vertex_count();
        for e in self.edges() {
            let [a, b] = self.edge_vertices(e).map(|v| leader_of(&mut leader, v.0));
            if a != b {
                // The lower one leads: neighbours lie near each other, so ways stay short.
                leader[a.max(b) as usize] = a.min(b);
                parts -= 1;
            }
        }
        parts
    }

    fn component_of(
        &self,
        mut vertices: Vec<VertexId>,
        face_seen: &mut super::FaceMap<bool>,
    ) -> Component {
        vertices.sort_unstable();
        let (mut faces, mut holes, mut edge_ends) = (Vec::new(), 0, 0);
        for &v in &vertices {
            edge_ends += self.valence(v);
            for h in self.outgoing(v) {
                let f = self.face(h);
                if !std::mem::replace(&mut face_seen[f], true) {
                    if self.is_hole(f) { holes += 1 } else { faces.push(f) }
                }
            }
        }
        faces.sort_unstable();
        let edges = edge_ends / 2;
        // A stray vertex is a point sphere, whose one face is not listed.
        let closed_faces = if edges == 0 { 1 } else { faces.len() + holes };
        let genus = (2 + edges).saturating_sub(vertices.len() + closed_faces) / 2;
        Component { vertices, faces, edges, holes, genus }
    }
}

/// The vertex that stands for the part of another one so far; halves the way there.
fn leader_of(leader: &mut [u32], mut v: u32) -> u32 {
    while leader[v as usize] != v {
        leader[v as usize] = leader[leader[v as usize] as usize];
        v = leader[v as usize];
    }
    v
}
