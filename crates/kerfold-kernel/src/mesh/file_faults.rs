//! What a mesh has that no file of polygons can hold: a file knows an edge by its two vertices
//! alone, a face by its corners.
//!
//! Self-loops and faces with fewer than three different corners are legal in memory and left out of
//! files, so they are no fault here.

use std::fmt;

use super::build::{first_repeated, is_collinear};
use super::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};

/// Something that every reader of polygons would refuse, or would read as something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileFault {
    /// No face is left that a file could hold.
    NoFaces,
    /// A coordinate is no finite number.
    NotFinite(VertexId),
    /// A face comes twice to one vertex.
    RepeatedCorner {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Both ends of an edge lie at one point.
    ZeroLengthEdge(EdgeId),
    /// All corners of a face lie exactly on one line.
    NoArea(FaceId),
    /// Two edges join the same two vertices.
    ParallelEdges(EdgeId, EdgeId),
}

impl fmt::Display for FileFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoFaces => f.write_str("no face has three corners"),
            Self::NotFinite(v) => write!(f, "vertex {v} has a coordinate that is not finite"),
            Self::RepeatedCorner { face, vertex } => {
                write!(f, "face {face} comes twice to vertex {vertex}")
            }
            Self::ZeroLengthEdge(e) => write!(f, "both ends of edge {e} lie at one point"),
            Self::NoArea(face) => write!(f, "the corners of face {face} lie on one line"),
            Self::ParallelEdges(a, b) => {
                write!(f, "edges {a} and {b} join the same two vertices")
            }
        }
    }
}

impl Mesh {
    /// Everything in the mesh that keeps it from being written to a file of polygons and read again
    /// as it is. Linear in the size of the mesh, but for vertices with very many edges, which are
    /// sorted.
    pub fn file_faults(&self) -> Vec<FileFault> {
        let mut faults: Vec<FileFault> = self
            .vertices()
            .filter(|&v| !self.position(v).is_finite())
            .map(FileFault::NotFinite)
            .collect();
        let mut sides = Sides::of(self);
        let mut walk: Vec<HalfEdgeId> = Vec::new();
        for f in self.faces() {
            walk.clear();
            walk.extend(self.face_half_edges(f).filter(|&h| self.origin(h) != self.target(h)));
            if self.is_in_files(&walk) {
                self.faults_of_face(f, &walk, &mut faults);
                walk.iter().for_each(|&h| sides.is_written[h.index()] = true);
            }
        }
        if !sides.is_written.contains(&true) {
            faults.push(FileFault::NoFaces);
        }
        sides.parallels(&mut faults);
        faults
    }

    /// The same of the faces at some vertices only, but for edges that join the same two vertices.
    pub fn file_faults_at(&self, vertices: &[VertexId]) -> Vec<FileFault> {
        let all = vertices.iter().flat_map(|&v| self.vertex_faces(v));
        let mut faces: Vec<FaceId> = all.filter(|&f| !self.is_hole(f)).collect();
        faces.sort_unstable();
        faces.dedup();
        let mut faults = Vec::new();
        for f in faces {
            let sides = self.face_half_edges(f);
            let walk: Vec<HalfEdgeId> =
                sides.filter(|&h| self.origin(h) != self.target(h)).collect();
            if self.is_in_files(&walk) {
                self.faults_of_face(f, &walk, &mut faults);
            }
        }
        faults
    }

    /// Whether a face with these sides, self-loops left out, has three different corners.
    fn is_in_files(&self, walk: &[HalfEdgeId]) -> bool {
        let Some(&first) = walk.first() else { return false };
        let [a, b] = [self.origin(first), self.target(first)];
        walk.iter().any(|&h| self.origin(h) != a && self.origin(h) != b)
    }

    fn faults_of_face(&self, f: FaceId, walk: &[HalfEdgeId], faults: &mut Vec<FileFault>) {
        let corners: Vec<u32> = walk.iter().map(|&h| self.origin(h).0).collect();
        if let Some(v) = first_repeated(&corners) {
            faults.push(FileFault::RepeatedCorner { face: f, vertex: VertexId(v) });
        }
        let mut has_length = true;
        for h in walk {
            let [a, b] = self.edge_positions(h.edge());
            if a == b {
                has_length = false;
                // Each edge is reported once, by its first half-edge where that is in a file.
                if *h == h.edge().half_edge() || self.is_hole(self.face(h.twin())) {
                    faults.push(FileFault::ZeroLengthEdge(h.edge()));
                }
            }
        }
        let place = |i: usize| self.position(self.origin(walk[i]));
        if has_length && is_collinear(walk.len(), place) {
            faults.push(FileFault::NoArea(f));
        }
    }
}

/// The half-edges that a file would hold.
struct Sides<'a> {
    mesh: &'a Mesh,
    is_written: Vec<bool>,
}

/// A written half-edge at the lower of its two vertices.
struct Spoke {
    to: VertexId,
    side: HalfEdgeId,
}

impl<'a> Sides<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        Self { mesh, is_written: vec![false; mesh.half_edge_slots()] }
    }

    /// Half-edges that a reader would take for sides of one edge, though they are none.
    fn parallels(&self, faults: &mut Vec<FileFault>) {
        let mesh = self.mesh;
        let mut spokes: Vec<Spoke> = Vec::new();
        for v in mesh.vertices() {
            spokes.clear();
            let higher = |h: &HalfEdgeId| mesh.target(*h) > v;
            for h in mesh.outgoing(v).filter(higher) {
                let written = [h, h.twin()].into_iter().filter(|h| self.is_written[h.index()]);
                spokes.extend(written.map(|side| Spoke { to: mesh.target(h), side }));
            }
            spokes.sort_unstable_by_key(|spoke| (spoke.to, spoke.side));
            for group in spokes.chunk_by(|a, b| a.to == b.to) {
                self.judge(group, faults);
            }
        }
    }

    /// At most two sides may join two vertices, one in each direction, with nothing between them
    /// but faces that no file holds.
    fn judge(&self, group: &[Spoke], faults: &mut Vec<FileFault>) {
        let first = group[0].side.edge();
        let is_one_edge = match group {
            [_] => true,
            [a, b] => a.side.twin() == b.side || self.leads_to(a.side, b.side),
            _ => false,
        };
        if is_one_edge {
            return;
        }
        let mut others: Vec<EdgeId> =
            group.iter().map(|s| s.side.edge()).filter(|&e| e != first).collect();
        others.dedup();
        faults.extend(others.into_iter().map(|e| FileFault::ParallelEdges(first, e)));
    }

    /// Whether the way from one side across 2-gons and their like ends at the other.
    fn leads_to(&self, from: HalfEdgeId, to: HalfEdgeId) -> bool {
        let mesh = self.mesh;
        let mut h = from.twin();
        // A ring of 2-gons comes back to where it began.
        while h != to && h != from {
            let f = mesh.face(h);
            if mesh.is_hole(f) || self.is_written[h.index()] {
                return false;
            }
            let is_straight = |s: &HalfEdgeId| mesh.origin(*s) != mesh.target(*s);
            let mut rest = mesh.face_half_edges(f).filter(|&s| s != h).filter(is_straight);
            let (Some(other), None) = (rest.next(), rest.next()) else { return false };
            h = other.twin();
        }
        h == to
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn cube() -> Mesh {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Mesh::from_faces((0..8).map(corner), faces).expect("a cube")
    }

    #[test]
    fn what_a_reader_takes_has_no_fault() {
        assert_eq!(cube().file_faults(), []);
        assert_eq!(Mesh::new().file_faults(), [FileFault::NoFaces]);
    }

    #[test]
    fn every_fault_is_found() {
        let mut mesh = cube();
        let v = VertexId::new(0);
        mesh.set_position(v, DVec3::NAN, true);
        assert_eq!(mesh.file_faults(), [FileFault::NotFinite(v)]);
        let mut mesh = cube();
        let e = EdgeId::new(0);
        let [a, b] = mesh.edge_vertices(e);
        mesh.set_position(a, mesh.position(b), true);
        assert_eq!(mesh.file_faults(), [FileFault::ZeroLengthEdge(e)]);
        // All corners of one face on a line.
        let mut mesh = cube();
        let f = FaceId::new(0);
        for (i, v) in mesh.face_vertices(f).collect::<Vec<_>>().into_iter().enumerate() {
            mesh.set_position(v, DVec3::new(i as f64, 0.0, -1.0), true);
        }
        assert_eq!(mesh.file_faults(), [FileFault::NoArea(f)]);
    }

    /// A 2-gon is left out of a file and its two sides become one edge; with a triangle between
    /// them they do not.
    #[test]
    fn parallel_edges_are_one_only_with_nothing_between() {
        let mut mesh = cube();
        let h = mesh.face_start(FaceId::new(0)).expect("a side");
        let next = mesh.next(h);
        mesh.insert_edge(crate::mesh::Corner::At(h), crate::mesh::Corner::At(next))
            .expect("two corners of one face");
        assert_eq!(mesh.faces().filter(|&f| mesh.sides(f) == 2).count(), 1);
        assert_eq!(mesh.file_faults(), []);
        let (gon, _) = (mesh.faces().find(|&f| mesh.sides(f) == 2).expect("a 2-gon"), ());
        mesh.set_kind(gon, crate::mesh::FaceKind::Hole);
        assert!(matches!(mesh.file_faults()[..], [FileFault::ParallelEdges(..)]));
    }
}
