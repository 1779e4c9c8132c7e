//! How far one surface lies from another, measured: by triangles, through a tree of boxes.

use glam::DVec3;

use super::face_triangles;
use crate::geom::{AxisBox, BoxTree, nearest_on_triangle};
use crate::mesh::{FaceId, Mesh};

/// A triangle of a face.
struct Piece {
    face: FaceId,
    corners: [DVec3; 3],
}

fn pieces(mesh: &Mesh) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(mesh.face_count());
    for face in mesh.faces() {
        let places = mesh.face_positions(face);
        let of_face = face_triangles(mesh, face).into_iter();
        pieces.extend(of_face.map(|t| Piece { face, corners: t.map(|i| places[i]) }));
    }
    pieces
}

/// The largest distance of a vertex of one mesh from the surface of the other.
pub(super) fn deviation(from: &Mesh, to: &Mesh) -> f64 {
    let points: Vec<DVec3> = from.vertices().map(|v| from.position(v)).collect();
    let pieces = pieces(to);
    nearest(&pieces, &points).into_iter().flatten().map(|(_, d)| d).fold(0.0, f64::max)
}

/// The face of a mesh that is nearest to each point.
pub(super) fn nearest_faces(mesh: &Mesh, points: &[DVec3]) -> Vec<Option<FaceId>> {
    let pieces = pieces(mesh);
    nearest(&pieces, points).into_iter().map(|near| near.map(|(i, _)| pieces[i].face)).collect()
}

fn nearest(pieces: &[Piece], points: &[DVec3]) -> Vec<Option<(usize, f64)>> {
    let boxes: Vec<AxisBox> =
        pieces.iter().filter_map(|piece| AxisBox::of(piece.corners)).collect();
    let tree = BoxTree::new(&boxes);
    points
        .iter()
        .map(|&p| tree.nearest(p, |i| nearest_on_triangle(p, pieces[i].corners).distance(p)))
        .collect()
}
