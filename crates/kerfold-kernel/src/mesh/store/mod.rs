//! The half-edge store: plain vectors, total links, and how to read them. Links are written in
//! `links.rs` alone.
//!
//! The fields of [`Mesh`] are private to this file and its child, so the compiler keeps everybody
//! else from writing them.
//!
//! Links are total: every half-edge has a next, a previous, an origin and a face. A vertex without
//! edges is a *point sphere* with a face of its own; vertex and face then point to each other.
//! Deleted elements leave free slots that later elements reuse; ids of living elements never move
//! until [`Mesh::compact`].

use glam::DVec3;

use super::{EdgeId, FaceId, HalfEdgeId, MAX_ELEMENTS, VertexId};
use crate::geom::Plane;

mod face_list;
mod links;

pub(in crate::mesh) use face_list::FaceList;
pub use links::Region;
pub use links::{LinkError, Renumbering};

/// A polygon mesh: a closed, orientable 2-manifold whose faces may be marked as holes.
#[derive(Debug, Default)]
pub struct Mesh {
    vertices: Vec<Vertex>,
    half_edges: Vec<HalfEdge>,
    faces: Vec<Face>,
    seams: Vec<bool>,
    planes: Vec<Plane>,
    groups: Vec<String>,
    free_vertices: Vec<VertexId>,
    free_edges: Vec<EdgeId>,
    free_faces: Vec<FaceId>,
    holes: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Vertex {
    position: DVec3,
    start: Link,
    is_given: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct HalfEdge {
    next: HalfEdgeId,
    prev: HalfEdgeId,
    origin: VertexId,
    face: FaceId,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    start: Link,
    plane: u32,
    group: u32,
    kind: FaceKind,
}

/// Marks a half-edge slot as free, a face without a plane, a face without a group.
const NONE: u32 = u32::MAX;

/// Where the walk around a vertex or a face begins: at a half-edge, or, for a point sphere, at its
/// only partner. The top bit says which; `NONE` marks a free slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Link(u32);

impl Link {
    const FREE: Self = Self(NONE);

    #[inline]
    fn edge(h: HalfEdgeId) -> Self {
        Self(h.0)
    }

    #[inline]
    fn lone(partner: u32) -> Self {
        Self(partner | MAX_ELEMENTS)
    }

    #[inline]
    fn half_edge(self) -> Option<HalfEdgeId> {
        (self.0 < MAX_ELEMENTS).then_some(HalfEdgeId(self.0))
    }

    #[inline]
    fn partner(self) -> Option<u32> {
        (self.0 >= MAX_ELEMENTS && self.0 != NONE).then_some(self.0 & !MAX_ELEMENTS)
    }
}

/// What a face stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceKind {
    /// Material.
    Solid,
    /// The rim of an open surface: no material, but links are total because it is a face too.
    Hole,
}

/// A corner of a face (Srinivasan 2004, II.5): where an edge can be inserted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Corner {
    /// The corner in the half-edge's face at the half-edge's origin.
    At(HalfEdgeId),
    /// The only corner of a point sphere.
    Lone(VertexId),
}

/// A copy is made to be changed: it has room for a sixteenth more of everything, so that the first
/// cut does not move all of it to larger tables.
impl Clone for Mesh {
    fn clone(&self) -> Self {
        Self {
            vertices: roomy(&self.vertices),
            half_edges: roomy(&self.half_edges),
            faces: roomy(&self.faces),
            seams: roomy(&self.seams),
            planes: roomy(&self.planes),
            groups: self.groups.clone(),
            free_vertices: self.free_vertices.clone(),
            free_edges: self.free_edges.clone(),
            free_faces: self.free_faces.clone(),
            holes: self.holes,
        }
    }
}

fn roomy<T: Copy>(table: &[T]) -> Vec<T> {
    let mut copy = Vec::with_capacity(table.len() + table.len() / 16);
    copy.extend_from_slice(table);
    copy
}

impl Mesh {
    /// A mesh without elements.
    pub fn new() -> Self {
        Self::default()
    }

    // ---- reading --------------------------------------------------------------------------------

    /// The half-edge after `h` around its face.
    #[inline]
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half_edges[h.index()].next
    }

    /// The half-edge before `h` around its face.
    #[inline]
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half_edges[h.index()].prev
    }

    /// The vertex that `h` leaves.
    #[inline]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.half_edges[h.index()].origin
    }

    /// The vertex that `h` enters.
    #[inline]
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.twin())
    }

    /// The face (or hole) on the left of `h`.
    #[inline]
    pub fn face(&self, h: HalfEdgeId) -> FaceId {
        self.half_edges[h.index()].face
    }

    /// The position of a vertex, in the model's unit.
    #[inline]
    pub fn position(&self, v: VertexId) -> DVec3 {
        self.vertices[v.index()].position
    }

    /// Whether the position came with the input, so that its signs are compared exactly, or was
    /// computed by an operator.
    #[inline]
    pub fn is_given(&self, v: VertexId) -> bool {
        self.vertices[v.index()].is_given
    }

    /// One half-edge that leaves `v`; `None` for a point sphere.
    #[inline]
    pub fn vertex_start(&self, v: VertexId) -> Option<HalfEdgeId> {
        self.vertices[v.index()].start.half_edge()
    }

    /// One half-edge of `f`; `None` for the face of a point sphere.
    #[inline]
    pub fn face_start(&self, f: FaceId) -> Option<HalfEdgeId> {
        self.faces[f.index()].start.half_edge()
    }

    /// The vertex of a point sphere's face; `None` when the face has edges.
    pub fn lone_vertex(&self, f: FaceId) -> Option<VertexId> {
        self.faces[f.index()].start.partner().map(VertexId)
    }

    /// The face of a point sphere; `None` when the vertex has edges.
    #[inline]
    pub fn lone_face(&self, v: VertexId) -> Option<FaceId> {
        self.vertices[v.index()].start.partner().map(FaceId)
    }

    /// Whether a face is a hole.
    #[inline]
    pub fn is_hole(&self, f: FaceId) -> bool {
        self.faces[f.index()].kind == FaceKind::Hole
    }

    /// The supporting plane that the face carries, if an operator or a file has fixed one.
    #[inline]
    pub fn carried_plane(&self, f: FaceId) -> Option<Plane> {
        self.planes.get(self.faces[f.index()].plane as usize).copied()
    }

    /// The name of the group that a face belongs to.
    pub fn group(&self, f: FaceId) -> Option<&str> {
        self.groups.get(self.faces[f.index()].group as usize).map(String::as_str)
    }

    /// The names of the face groups, in the order in which they came up.
    pub fn groups(&self) -> &[String] {
        &self.groups
    }

    /// Whether the user marked an edge as a seam.
    pub fn is_seam(&self, e: EdgeId) -> bool {
        self.seams[e.index()]
    }

    /// Whether a vertex exists.
    #[inline]
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.vertices.get(v.index()).is_some_and(|vertex| vertex.start != Link::FREE)
    }

    /// Whether an edge exists.
    #[inline]
    pub fn has_edge(&self, e: EdgeId) -> bool {
        self.half_edges.get(e.half_edge().index()).is_some_and(|h| h.next.0 != NONE)
    }

    /// Whether a face or hole exists.
    #[inline]
    pub fn has_face(&self, f: FaceId) -> bool {
        self.faces.get(f.index()).is_some_and(|face| face.start != Link::FREE)
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len() - self.free_vertices.len()
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.half_edges.len() / 2 - self.free_edges.len()
    }

    /// Number of faces that are not holes.
    pub fn face_count(&self) -> usize {
        self.faces.len() - self.free_faces.len() - self.holes
    }

    /// Number of holes (rims).
    pub fn hole_count(&self) -> usize {
        self.holes
    }

    /// Length of a side table for the vertices.
    pub fn vertex_slots(&self) -> usize {
        self.vertices.len()
    }

    /// Length of a side table for the half-edges.
    pub fn half_edge_slots(&self) -> usize {
        self.half_edges.len()
    }

    /// Length of a side table for the edges.
    pub fn edge_slots(&self) -> usize {
        self.half_edges.len() / 2
    }

    /// Length of a side table for the faces and holes.
    pub fn face_slots(&self) -> usize {
        self.faces.len()
    }

    /// Makes room for so many more vertices, edges and faces, so that adding them does not move the
    /// tables.
    pub fn reserve(&mut self, vertices: usize, edges: usize, faces: usize) {
        self.vertices.reserve(vertices);
        self.half_edges.reserve(2 * edges);
        self.seams.reserve(edges);
        self.faces.reserve(faces);
        self.planes.reserve(faces);
    }

    // ---- attributes -----------------------------------------------------------------------------

    /// Moves a vertex; `is_given` says whether the new position is an input number or a computed
    /// one.
    #[inline]
    pub fn set_position(&mut self, v: VertexId, position: DVec3, is_given: bool) {
        let vertex = &mut self.vertices[v.index()];
        vertex.position = position;
        vertex.is_given = is_given;
    }

    /// Lets a face carry `plane` as its supporting plane.
    #[inline]
    pub fn set_plane(&mut self, f: FaceId, plane: Plane) {
        let slot = self.faces[f.index()].plane as usize;
        if slot < self.planes.len() {
            self.planes[slot] = plane;
        } else {
            self.faces[f.index()].plane = self.planes.len() as u32;
            self.planes.push(plane);
        }
    }

    /// Forgets the planes of all faces, after vertices were moved freely.
    pub fn clear_planes(&mut self) {
        self.planes.clear();
        for face in &mut self.faces {
            face.plane = NONE;
        }
    }

    /// Makes a face a hole or a hole a face.
    #[inline]
    pub fn set_kind(&mut self, f: FaceId, kind: FaceKind) {
        let face = &mut self.faces[f.index()];
        self.holes -= usize::from(face.kind == FaceKind::Hole);
        self.holes += usize::from(kind == FaceKind::Hole);
        face.kind = kind;
    }

    /// Puts a face into the group called `name`, which is made when it is new.
    pub fn set_group(&mut self, f: FaceId, name: &str) {
        let known = self.groups.iter().position(|g| g == name);
        let group = known.unwrap_or_else(|| {
            self.groups.push(name.to_owned());
            self.groups.len() - 1
        });
        self.faces[f.index()].group = group as u32;
    }

    /// Marks an edge as a seam, or not.
    pub fn set_seam(&mut self, e: EdgeId, is_seam: bool) {
        self.seams[e.index()] = is_seam;
    }
}
