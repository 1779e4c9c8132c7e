//! What a reader of polygons makes of a mesh, worked out from the corners of its faces alone: files
//! know neither links nor self-loops.

use super::build::first_repeated;
use super::{Mesh, VertexId};

/// The elements of a mesh, as a file of polygons has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileCounts {
    /// Vertices, counting one for each fan of faces.
    pub vertices: usize,
    /// Pairs of vertices that faces join.
    pub edges: usize,
    /// Faces with three different corners.
    pub faces: usize,
    /// Rims.
    pub rims: usize,
    /// Connected parts.
    pub components: usize,
}

impl FileCounts {
    /// V − E + F, with a disc in each rim: 2 for each part, less 2 for each handle.
    pub fn euler(&self) -> isize {
        (self.vertices + self.faces + self.rims) as isize - self.edges as isize
    }
}

impl std::fmt::Display for FileCounts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counted = |count: usize, one: &str, many: &str| {
            format!("{count} {}", if count == 1 { one } else { many })
        };
        write!(
            f,
            "{}, {}, {}, {}, {}",
            counted(self.vertices, "vertex", "vertices"),
            counted(self.edges, "edge", "edges"),
            counted(self.faces, "face", "faces"),
            counted(self.rims, "rim", "rims"),
            counted(self.components, "part", "parts"),
        )
    }
}

impl Mesh {
    /// The elements in memory, in the form of those of a file.
    pub fn counts(&self) -> FileCounts {
        FileCounts {
            vertices: self.vertex_count(),
            edges: self.edge_count(),
            faces: self.face_count(),
            rims: self.hole_count(),
            components: self.component_count(),
        }
    }

    /// The elements that a reader finds in a file of this mesh; `None` when it would refuse the
    /// file, since a face repeats a corner or more than two run along an edge. Differs from
    /// [`Mesh::counts`] where self-loops or faces of two sides hold the mesh together, and where
    /// several rims run through a vertex. Linear in the size of the mesh, but for vertices with
    /// very many edges.
    pub fn file_counts(&self) -> Option<FileCounts> {
        let mut polygons = Polygons::default();
        for f in self.faces() {
            polygons.push(self.face_vertices(f));
        }
        polygons.counts(self.vertex_slots())
    }
}

/// Faces as the numbers of their corners, one after the other.
#[derive(Default)]
struct Polygons {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

/// Stands for a side that has no other beside it.
const ALONE: u32 = u32::MAX;

impl Polygons {
    /// Adds a face without corners that repeat the one before, if three different ones are left.
    fn push(&mut self, vertices: impl Iterator<Item = VertexId>) {
        let start = self.corners.len();
        for v in vertices {
            if self.corners[start..].last() != Some(&v.0) {
                self.corners.push(v.0);
            }
        }
        while self.corners.len() > start + 1 && self.corners.last() == Some(&self.corners[start]) {
            self.corners.pop();
        }
        let face = &self.corners[start..];
        let other = face.iter().find(|&v| *v != face[0]);
        if face.iter().any(|v| *v != face[0] && Some(v) != other) {
            self.ends.push(self.corners.len());
        } else {
            self.corners.truncate(start);
        }
    }

    fn counts(&self, vertices: usize) -> Option<FileCounts> {
        // Side i runs from corner i to corner after[i].
        let mut after = vec![0; self.corners.len()];
        let mut start = 0;
        for &end in &self.ends {
            if first_repeated(&self.corners[start..end]).is_some() {
                return None;
            }
            (start..end).for_each(|i| after[i] = if i + 1 < end { i + 1 } else { start });
            start = end;
        }
        let (partner, edges) = self.paired(&after, vertices)?;
        // What is at one vertex, and what hangs together.
        let mut fans = Sets::new(after.len());
        let mut parts = Sets::new(after.len());
        for (i, &other) in partner.iter().enumerate() {
            parts.unite(i, after[i]);
            if other != ALONE {
                let other = other as usize;
                fans.unite(i, after[other]);
                fans.unite(after[i], other);
                parts.unite(i, other);
            }
        }
        let (vertices, components) = (fans.count, parts.count);
        let lone: Vec<usize> = (0..partner.len()).filter(|&i| partner[i] == ALONE).collect();
        // Each fan at a rim has one side that comes and one that goes.
        let before = fans.count;
        lone.iter().for_each(|&i| fans.unite(i, after[i]));
        let rims = lone.len() - (before - fans.count);
        Some(FileCounts { vertices, edges, faces: self.ends.len(), rims, components })
    }

    /// The side that runs the other way between the same corners, for each, and how many edges that
    /// makes; `None` when there are several.
    fn paired(&self, after: &[usize], vertices: usize) -> Option<(Vec<u32>, usize)> {
        // For each vertex a chain of the sides whose lower corner it is.
        let mut first = vec![ALONE; vertices];
        let mut next = vec![ALONE; after.len()];
        let mut partner = vec![ALONE; after.len()];
        let mut edges = 0;
        let ends = |i: usize| [self.corners[i], self.corners[after[i]]];
        for i in 0..after.len() {
            let [a, b] = ends(i);
            let low = a.min(b) as usize;
            let mut at = first[low];
            while at != ALONE {
                let other = at as usize;
                if ends(other) == [a, b] || (ends(other) == [b, a] && partner[other] != ALONE) {
                    return None;
                }
                if ends(other) == [b, a] {
                    (partner[other], partner[i]) = (i as u32, at);
                    break;
                }
                at = next[other];
            }
            if at == ALONE {
                edges += 1;
                next[i] = first[low];
                first[low] = i as u32;
            }
        }
        Some((partner, edges))
    }
}

/// Disjoint sets of numbers.
struct Sets {
    parent: Vec<u32>,
    count: usize,
}

impl Sets {
    fn new(size: usize) -> Self {
        Self { parent: (0..size as u32).collect(), count: size }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] as usize != i {
            let up = self.parent[self.parent[i] as usize];
            self.parent[i] = up;
            i = up as usize;
        }
        i
    }

    fn unite(&mut self, i: usize, j: usize) {
        let (a, b) = (self.root(i), self.root(j));
        if a != b {
            // The lower number stays, so that ways are short where neighbours have near numbers.
            self.parent[a.max(b)] = a.min(b) as u32;
            self.count -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::mesh::{Corner, FaceId, FaceKind, Mesh};

    fn points(count: usize) -> impl Iterator<Item = DVec3> {
        (0..count).map(|i| DVec3::new((i * i) as f64, i as f64, (i * i * i) as f64))
    }

    fn boxed(open: bool) -> Mesh {
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        Mesh::from_faces((0..8).map(corner), faces.into_iter().skip(usize::from(open)))
            .expect("a box")
    }

    #[test]
    fn a_file_has_what_a_simple_mesh_has() {
        for open in [false, true] {
            let mesh = boxed(open);
            assert_eq!(mesh.file_counts(), Some(mesh.counts()));
            assert_eq!(mesh.counts().euler(), 2);
        }
        // A ring of three quads has two rims.
        let ring = [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]];
        let ring = Mesh::from_faces(points(6), ring).expect("a ring");
        assert_eq!((ring.counts().rims, ring.file_counts()), (2, Some(ring.counts())));
        let shown = ring.counts().to_string();
        assert_eq!(shown, "6 vertices, 9 edges, 3 faces, 2 rims, 1 part");
    }

    /// Two holes at opposite corners of a vertex: in memory one vertex, in a file two.
    #[test]
    fn a_vertex_with_two_rims_is_two() {
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        let mut mesh = Mesh::from_faces(points(5), fan).expect("a fan");
        mesh.set_kind(FaceId::new(0), FaceKind::Hole);
        mesh.set_kind(FaceId::new(2), FaceKind::Hole);
        let found = mesh.file_counts().expect("two triangles");
        assert_eq!((mesh.vertex_count(), found.vertices, found.components), (5, 6, 2));
    }

    #[test]
    fn parallel_edges_are_refused_and_two_gons_are_none() {
        let mut mesh = boxed(false);
        let h = mesh.face_start(FaceId::new(0)).expect("a side");
        let next = mesh.next(h);
        mesh.insert_edge(Corner::At(h), Corner::At(next)).expect("two corners of one face");
        assert_eq!(mesh.file_counts(), Some(boxed(false).counts()));
        assert_ne!(mesh.file_counts(), Some(mesh.counts()));
        let gon = mesh.faces().find(|&f| mesh.sides(f) == 2).expect("a 2-gon");
        mesh.set_kind(gon, FaceKind::Hole);
        assert_eq!(mesh.file_counts(), Some(boxed(false).counts()));
        let h = mesh.face_half_edges(gon).next().expect("a side");
        let [a, b] = mesh.edge_positions(h.edge());
        mesh.split_edge(h.edge(), a.midpoint(b));
        assert_eq!(mesh.file_counts(), Some(mesh.counts()));
    }
}
