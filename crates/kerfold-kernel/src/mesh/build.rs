//! The one builder: vertices and faces in, a checked mesh out.

use glam::DVec3;

use super::store::FaceList;
use super::{EdgeId, FaceKind, HalfEdgeId, Mesh, VertexId};
use crate::code::codes;

/// Collects vertices and faces and builds a mesh of them.
///
/// Faces are numbered in the order in which they come, vertices likewise. A vertex that no face
/// uses leaves a gap in the numbering, so that the other ids stay those of the file.
#[derive(Debug, Clone, Default)]
pub struct MeshBuilder {
    positions: Vec<DVec3>,
    corners: Vec<u32>,
    ends: Vec<usize>,
}

/// Why vertices and faces do not make a mesh. Faces and vertices are numbered from 0 in the order
/// of the input.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// No face at all.
    #[error("there are no faces; a mesh needs at least one")]
    NoFaces,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number: {position}")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// What was given.
        position: DVec3,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {count} (0 to {})", count - 1)]
    MissingVertex {
        /// The face.
        face: usize,
        /// The vertex that it names.
        vertex: usize,
        /// Number of vertices.
        count: usize,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has {corners} corners; a face needs at least 3")]
    TooFewCorners {
        /// The face.
        face: usize,
        /// How many it has.
        corners: usize,
    },
    /// A face that visits a vertex twice.
    #[error(
        "face {face} visits vertex {vertex} twice; divide it into faces that visit each vertex once"
    )]
    RepeatedCorner {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
    /// Two corners of a face that follow each other lie at one point.
    #[error(
        "face {face} has an edge of length zero: vertices {a} and {b} both lie at {position}; weld \
        them"
    )]
    ZeroLengthEdge {
        /// The face.
        face: usize,
        /// One end.
        a: usize,
        /// The other end.
        b: usize,
        /// Where both lie.
        position: DVec3,
    },
    /// A face without area: all its corners lie on one line.
    #[error(
        "face {face} has no area: its corners all lie on one line; remove it or weld its \
        neighbours over it"
    )]
    DegenerateFace {
        /// The face.
        face: usize,
    },
    /// Three faces meet at one edge.
    #[error(
        "the edge between vertices {a} and {b} has more than two faces ({}, {} and {}); a surface \
        has at most two, remove the extra ones",
        faces[0], faces[1], faces[2]
    )]
    ThreeFacesAtEdge {
        /// One end.
        a: usize,
        /// The other end.
        b: usize,
        /// The first three faces at the edge.
        faces: [usize; 3],
    },
    /// Two neighbours run along their common edge in the same direction.
    #[error(
        "faces {first} and {second} run along the edge from vertex {a} to vertex {b} in the same \
        direction; turn one of them around"
    )]
    FlippedFace {
        /// The edge's start.
        a: usize,
        /// The edge's end.
        b: usize,
        /// The face that came first.
        first: usize,
        /// The face that came second.
        second: usize,
    },
    /// More elements than the store can number.
    #[error("{count} {what} are more than a mesh can hold (2^30)")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        count: usize,
    },
}

codes!(error BuildError {
    NoFaces = 231,
    NotFinite = 232,
    MissingVertex = 233,
    TooFewCorners = 234,
    RepeatedCorner = 235,
    ZeroLengthEdge = 236,
    DegenerateFace = 237,
    ThreeFacesAtEdge = 238,
    FlippedFace = 239,
    TooMany = 240,
});

/// A vertex at which several fans met: each further fan got a vertex of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SplitVertex {
    /// The vertex of the input.
    pub given: VertexId,
    /// The vertex that was added at the same point.
    pub added: VertexId,
}

impl MeshBuilder {
    /// A builder without elements.
    pub fn new() -> Self {
        Self::default()
    }

    /// A builder without elements that has room for so many vertices, faces and corners of faces.
    pub fn with_room(vertices: usize, faces: usize, corners: usize) -> Self {
        Self {
            positions: Vec::with_capacity(vertices),
            corners: Vec::with_capacity(corners),
            ends: Vec::with_capacity(faces),
        }
    }

    /// Adds a vertex and returns its number.
    pub fn vertex(&mut self, position: DVec3) -> usize {
        self.positions.push(position);
        self.positions.len() - 1
    }

    /// Adds a face by the numbers of its vertices, counter-clockwise seen from outside, and returns
    /// its number. Vertices may be added later; the numbers are checked by [`Self::build`].
    pub fn face(&mut self, vertices: impl IntoIterator<Item = usize>) -> usize {
        // A number beyond u32 cannot exist; the largest u32 never exists either, and build() says
        // so.
        self.corners.extend(vertices.into_iter().map(|v| u32::try_from(v).unwrap_or(u32::MAX)));
        self.ends.push(self.corners.len());
        self.ends.len() - 1
    }

    /// Builds the mesh. Edges with one face are closed by holes; a vertex with several fans is
    /// split.
    ///
    /// # Errors
    /// The first fault of the input in the order vertices, faces, edges; see [`BuildError`].
    pub fn build(self) -> Result<(Mesh, Vec<SplitVertex>), BuildError> {
        self.check_vertices()?;
        let mut used = vec![false; self.positions.len()];
        for face in 0..self.ends.len() {
            self.check_face(face, &mut used)?;
        }
        let mut edges = self.pair_half_edges()?;
        let holes = edges.hole_walks(&self.ends);
        let mut positions: Vec<Option<DVec3>> =
            self.positions.iter().zip(&used).map(|(&p, &used)| used.then_some(p)).collect();
        let mut walks = FaceList::of_faces(std::mem::take(&mut edges.walk), &self.ends);
        for hole in holes {
            walks.push(hole, FaceKind::Hole);
        }
        let splits = split_fans(&walks, &mut edges.ends, &mut positions);
        Ok((Mesh::assemble(positions, edges.ends, &walks), splits))
    }

    fn check_vertices(&self) -> Result<(), BuildError> {
        let limit = 1 << 30;
        for (what, count) in [("vertices", self.positions.len()), ("corners", self.corners.len())] {
            if count >= limit {
                return Err(BuildError::TooMany { what, count });
            }
        }
        if self.ends.is_empty() {
            return Err(BuildError::NoFaces);
        }
        match self.positions.iter().position(|p| !p.is_finite()) {
            Some(vertex) => Err(BuildError::NotFinite { vertex, position: self.positions[vertex] }),
            None => Ok(()),
        }
    }

    fn corners(&self, face: usize) -> &[u32] {
        let start = if face == 0 { 0 } else { self.ends[face - 1] };
        &self.corners[start..self.ends[face]]
    }

    fn check_face(&self, face: usize, used: &mut [bool]) -> Result<(), BuildError> {
        let corners = self.corners(face);
        let count = self.positions.len();
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
            return Err(BuildError::MissingVertex { face, vertex: vertex as usize, count });
        }
        if corners.len() < 3 {
            return Err(BuildError::TooFewCorners { face, corners: corners.len() });
        }
        if let Some(vertex) = first_repeated(corners) {
            return Err(BuildError::RepeatedCorner { face, vertex: vertex as usize });
        }
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let position = self.positions[a as usize];
            if position == self.positions[b as usize] {
                return Err(BuildError::ZeroLengthEdge {
                    face,
                    a: a as usize,
                    b: b as usize,
                    position,
                });
            }
            used[a as usize] = true;
        }
        let place = |i: usize| self.positions[corners[i] as usize];
        if is_collinear(corners.len(), place) {
            Err(BuildError::DegenerateFace { face })
        } else {
            Ok(())
        }
    }

    /// Numbers the edges in the order in which the faces first run along them.
    fn pair_half_edges(&self) -> Result<Edges, BuildError> {
        let mut table = EdgeTable::new(self.positions.len(), self.corners.len());
        let mut edges = Edges {
            ends: Vec::with_capacity(self.corners.len() / 2 + 1),
            walk: Vec::with_capacity(self.corners.len()),
            sides: Vec::new(),
        };
        for face in 0..self.ends.len() {
            let corners = self.corners(face);
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let h = edges
                    .side(&mut table, a, b)
                    .map_err(|SideTaken| self.edge_error(a, b, face))?;
                edges.walk.push(h);
            }
        }
        Ok(edges)
    }

    /// Three faces at an edge, or two that run the same way: says which, with all faces at the
    /// edge.
    fn edge_error(&self, a: u32, b: u32, face: usize) -> BuildError {
        let runs = |f: usize, a: u32, b: u32| {
            let c = self.corners(f);
            (0..c.len()).any(|i| c[i] == a && c[(i + 1) % c.len()] == b)
        };
        let at_edge: Vec<usize> =
            (0..self.ends.len()).filter(|&f| runs(f, a, b) || runs(f, b, a)).take(3).collect();
        let (a, b) = (a as usize, b as usize);
        match at_edge[..] {
            [x, y, z] => BuildError::ThreeFacesAtEdge { a, b, faces: [x, y, z] },
            _ => BuildError::FlippedFace { a, b, first: at_edge[0], second: face },
        }
    }
}

/// Whether all corners of a face lie exactly on one line, seen from the first edge along all three
/// axes.
pub(super) fn is_collinear(count: usize, place: impl Fn(usize) -> DVec3) -> bool {
    let flat = |q: DVec3| [q.truncate(), glam::DVec2::new(q.y, q.z), glam::DVec2::new(q.z, q.x)];
    let (a, b) = (flat(place(0)), flat(place(1)));
    (2..count).all(|i| {
        let c = flat(place(i));
        (0..3).all(|axis| crate::geom::predicate::orient2d(a[axis], b[axis], c[axis]) == 0.0)
    })
}

pub(super) fn first_repeated(corners: &[u32]) -> Option<u32> {
    if corners.len() <= 16 {
        return (1..corners.len())
            .find(|&i| corners[..i].contains(&corners[i]))
            .map(|i| corners[i]);
    }
    let mut seen = std::collections::HashSet::with_capacity(corners.len());
    corners.iter().copied().find(|&v| !seen.insert(v))
}

/// A half-edge was asked for a second time.
struct SideTaken;

/// The edges of the input: their ends, the half-edges of all faces in order, and which sides have a
/// face.
struct Edges {
    ends: Vec<(VertexId, VertexId)>,
    walk: Vec<HalfEdgeId>,
    sides: Vec<bool>,
}

impl Edges {
    fn side(&mut self, table: &mut EdgeTable, a: u32, b: u32) -> Result<HalfEdgeId, SideTaken> {
        let (e, is_new) = table.edge(a, b, self.ends.len() as u32);
        if is_new {
            self.ends.push((VertexId(a), VertexId(b)));
            self.sides.extend([false, false]);
        }
        let first = EdgeId(e).half_edge();
        let h = if self.ends[e as usize].0 == VertexId(a) { first } else { first.twin() };
        let taken = std::mem::replace(&mut self.sides[h.index()], true);
        if taken { Err(SideTaken) } else { Ok(h) }
    }

    /// The walks of the half-edges without a face. At a vertex with several rims the walks take the
    /// nearest one, so that each fan keeps its own rim.
    fn hole_walks(&self, face_ends: &[usize]) -> Vec<Vec<HalfEdgeId>> {
        let rim: Vec<HalfEdgeId> = (0..self.sides.len() as u32)
            .map(HalfEdgeId)
            .filter(|h| !self.sides[h.index()])
            .collect();
        if rim.is_empty() {
            return Vec::new();
        }
        // Around the target of a rim half-edge, against its twin: prev of the twin's face walk,
        // until a rim turns up.
        let prev = self.previous_in_walk(face_ends);
        let successor = |h: HalfEdgeId| {
            let mut out = h.twin();
            loop {
                out = prev[out.index()].twin();
                if !self.sides[out.index()] {
                    return out;
                }
            }
        };
        let mut done = vec![false; self.sides.len()];
        let mut walks = Vec::new();
        for start in rim {
            let mut walk = Vec::new();
            let mut h = start;
            while !std::mem::replace(&mut done[h.index()], true) {
                walk.push(h);
                h = successor(h);
            }
            if !walk.is_empty() {
                walks.push(walk);
            }
        }
        walks
    }

    /// For each half-edge of a face the one before it.
    fn previous_in_walk(&self, face_ends: &[usize]) -> Vec<HalfEdgeId> {
        let mut prev = vec![HalfEdgeId(u32::MAX); self.sides.len()];
        let mut start = 0;
        for &end in face_ends {
            let walk = &self.walk[start..end];
            for (i, &h) in walk.iter().enumerate() {
                prev[walk[(i + 1) % walk.len()].index()] = h;
            }
            start = end;
        }
        prev
    }
}

/// Finds the edge between two vertices: for each vertex a chain of the edges whose lower end it is.
struct EdgeTable {
    first: Vec<u32>,
    next: Vec<(u32, u32)>,
}

impl EdgeTable {
    fn new(vertices: usize, corners: usize) -> Self {
        Self { first: vec![u32::MAX; vertices], next: Vec::with_capacity(corners / 2 + 1) }
    }

    /// The edge between a and b, and whether it was made just now with the number `fresh`.
    fn edge(&mut self, a: u32, b: u32, fresh: u32) -> (u32, bool) {
        let (low, high) = (a.min(b), a.max(b));
        let mut e = self.first[low as usize];
        while e != u32::MAX {
            let (other, next) = self.next[e as usize];
            if other == high {
                return (e, false);
            }
            e = next;
        }
        self.next.push((high, self.first[low as usize]));
        self.first[low as usize] = fresh;
        (fresh, true)
    }
}

/// Gives every fan at a vertex after the first its own vertex at the same point.
pub(super) fn split_fans(
    walks: &FaceList,
    ends: &mut [(VertexId, VertexId)],
    positions: &mut Vec<Option<DVec3>>,
) -> Vec<SplitVertex> {
    let mut next = vec![HalfEdgeId(u32::MAX); 2 * ends.len()];
    for (walk, _) in walks.iter() {
        for (i, &h) in walk.iter().enumerate() {
            next[h.index()] = walk[(i + 1) % walk.len()];
        }
    }
    let mut fan_seen = vec![false; positions.len()];
    let mut done = vec![false; next.len()];
    let mut splits = Vec::new();
    for h in (0..next.len() as u32).map(HalfEdgeId) {
        if done[h.index()] {
            continue;
        }
        let given = origin_of(ends, h);
        let vertex = if std::mem::replace(&mut fan_seen[given.index()], true) {
            positions.push(positions[given.index()]);
            fan_seen.push(true);
            let added = VertexId::new(positions.len() - 1);
            splits.push(SplitVertex { given, added });
            added
        } else {
            given
        };
        let mut out = h;
        while !std::mem::replace(&mut done[out.index()], true) {
            let side = &mut ends[out.edge().index()];
            if out.index() & 1 == 0 {
                side.0 = vertex
            } else {
                side.1 = vertex
            }
            out = next[out.twin().index()];
        }
    }
    splits
}

fn origin_of(ends: &[(VertexId, VertexId)], h: HalfEdgeId) -> VertexId {
    let (a, b) = ends[h.edge().index()];
    if h.index() & 1 == 0 { a } else { b }
}

impl Mesh {
    /// Builds a mesh from positions and faces; a shorthand for [`MeshBuilder`].
    ///
    /// # Errors
    /// As [`MeshBuilder::build`].
    pub fn from_faces<F>(
        positions: impl IntoIterator<Item = DVec3>,
        faces: impl IntoIterator<Item = F>,
    ) -> Result<Self, BuildError>
    where
        F: IntoIterator<Item = usize>,
    {
        let mut builder = MeshBuilder::new();
        for p in positions {
            builder.vertex(p);
        }
        for face in faces {
            builder.face(face);
        }
        builder.build().map(|(mesh, _)| mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    fn points(n: usize) -> Vec<DVec3> {
        (0..n).map(|i| DVec3::new((i * i) as f64, i as f64, (i * i * i) as f64)).collect()
    }

    #[test]
    fn an_open_strip_gets_one_rim() {
        let mesh =
            Mesh::from_faces(points(6), [vec![0, 1, 2, 3], vec![3, 2, 4, 5]]).expect("two quads");
        assert_sound(&mesh);
        assert_eq!(
            (mesh.vertex_count(), mesh.edge_count(), mesh.face_count(), mesh.hole_count()),
            (6, 7, 2, 1)
        );
    }

    #[test]
    fn two_faces_that_share_a_vertex_only_are_pulled_apart() {
        let mut builder = MeshBuilder::new();
        for p in points(5) {
            builder.vertex(p);
        }
        builder.face([0, 1, 2]);
        builder.face([0, 3, 4]);
        let (mesh, splits) = builder.build().expect("a bow tie");
        assert_sound(&mesh);
        assert_eq!(splits, [SplitVertex { given: VertexId(0), added: VertexId(5) }]);
        assert_eq!((mesh.components().len(), mesh.hole_count()), (2, 2));
        assert_eq!(mesh.position(VertexId(5)), mesh.position(VertexId(0)));
    }

    #[test]
    fn unused_vertices_leave_gaps_so_that_ids_stay_those_of_the_file() {
        let mesh = Mesh::from_faces(points(5), [[0, 2, 4]]).expect("a triangle");
        assert_sound(&mesh);
        assert_eq!(mesh.vertices().map(VertexId::index).collect::<Vec<_>>(), [0, 2, 4]);
    }

    #[test]
    fn every_fault_of_the_input_is_named() {
        let build = |n: usize, faces: &[&[usize]]| {
            Mesh::from_faces(points(n), faces.iter().map(|f| f.iter().copied()))
                .expect_err("a fault")
        };
        assert_eq!(build(3, &[]), BuildError::NoFaces);
        assert_eq!(
            build(3, &[&[0, 1, 3]]),
            BuildError::MissingVertex { face: 0, vertex: 3, count: 3 }
        );
        assert_eq!(build(3, &[&[0, 1]]), BuildError::TooFewCorners { face: 0, corners: 2 });
        assert_eq!(build(4, &[&[0, 1, 2, 1]]), BuildError::RepeatedCorner { face: 0, vertex: 1 });
        let three = build(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
        assert_eq!(three, BuildError::ThreeFacesAtEdge { a: 0, b: 1, faces: [0, 1, 2] });
        let flipped = build(4, &[&[0, 1, 2], &[0, 1, 3]]);
        assert_eq!(flipped, BuildError::FlippedFace { a: 0, b: 1, first: 0, second: 1 });
        let line: Vec<DVec3> = (0..3).map(|i| DVec3::splat(f64::from(i))).collect();
        assert_eq!(
            Mesh::from_faces(line, [[0, 1, 2]]).expect_err("a line"),
            BuildError::DegenerateFace { face: 0 }
        );
        let doubled =
            Mesh::from_faces([DVec3::X, DVec3::X, DVec3::Y], [[0, 1, 2]]).expect_err("no length");
        assert_eq!(doubled, BuildError::ZeroLengthEdge { face: 0, a: 0, b: 1, position: DVec3::X });
        let nan = Mesh::from_faces([DVec3::NAN, DVec3::X, DVec3::Y], [[0, 1, 2]]).expect_err("NaN");
        assert!(matches!(nan, BuildError::NotFinite { vertex: 0, .. }));
    }
}
