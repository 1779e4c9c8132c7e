//! A mesh as the plain polygons that files hold.

use glam::DVec3;

use crate::geom::{Frame, triangulate};
use crate::mesh::{FaceId, Mesh, VertexId, VertexMap};

/// Vertices and faces, numbered densely.
pub(super) struct Polygons {
    pub positions: Vec<DVec3>,
    /// The number of each vertex.
    pub numbers: VertexMap<usize>,
    faces: Vec<(FaceId, usize)>,
    corners: Vec<usize>,
}

impl Polygons {
    /// The living vertices and the faces that are not holes, ascending. Corners that repeat the one
    /// before are left out, and so are faces with fewer than three different corners, which no file
    /// format can hold.
    pub fn of(mesh: &Mesh) -> Self {
        let mut positions = Vec::with_capacity(mesh.vertex_count());
        let mut numbers = VertexMap::filled(mesh.vertex_slots(), usize::MAX);
        for v in mesh.vertices() {
            numbers[v] = positions.len();
            positions.push(mesh.position(v));
        }
        let mut polygons = Self {
            positions,
            numbers,
            faces: Vec::with_capacity(mesh.face_count()),
            corners: Vec::new(),
        };
        for f in mesh.faces() {
            polygons.push_face(f, mesh.face_vertices(f));
        }
        polygons
    }

    fn push_face(&mut self, f: FaceId, vertices: impl Iterator<Item = VertexId>) {
        let start = self.corners.len();
        for v in vertices {
            let number = self.numbers[v];
            if self.corners[start..].last() != Some(&number) {
                self.corners.push(number);
            }
        }
        while self.corners.len() > start + 1 && self.corners.last() == Some(&self.corners[start]) {
            self.corners.pop();
        }
        if has_three_different(&self.corners[start..]) {
            self.faces.push((f, self.corners.len()));
        } else {
            self.corners.truncate(start);
        }
    }

    /// A face as triangles, by the places of their corners in `corners`.
    pub fn triangles(&self, mesh: &Mesh, f: FaceId, corners: &[usize]) -> Vec<[usize; 3]> {
        match mesh.plane(f).map(|plane| Frame::on_plane(&plane)) {
            Some(frame) if corners.len() > 3 => {
                let flat = corners.iter().map(|&c| frame.flatten(self.positions[c]));
                triangulate(&flat.collect::<Vec<_>>())
            }
            _ => (2..corners.len()).map(|i| [0, i - 1, i]).collect(),
        }
    }

    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The faces with the numbers of their corners.
    pub fn faces(&self) -> impl Iterator<Item = (FaceId, &[usize])> {
        let starts = std::iter::once(0).chain(self.faces.iter().map(|&(_, end)| end));
        starts.zip(&self.faces).map(|(start, &(f, end))| (f, &self.corners[start..end]))
    }
}

fn has_three_different(corners: &[usize]) -> bool {
    let Some(&a) = corners.first() else { return false };
    let Some(&b) = corners.iter().find(|&&c| c != a) else { return false };
    corners.iter().any(|&c| c != a && c != b)
}
