//! How far one surface lies from another, measured: by triangles, through a tree of boxes.

use glam::DVec3;

use super::face_triangles;
use crate::geom::{AxisBox, BoxTree};
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
        .map(|&p| tree.nearest(p, |i| distance_to_triangle(p, pieces[i].corners)))
        .collect()
}

/// The distance of a point from a triangle: to its plane where the point lies above it, else to the
/// nearest side.
pub(super) fn distance_to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)];
    let is_above = |&(from, to): &(DVec3, DVec3)| normal.cross(to - from).dot(p - from) >= 0.0;
    if normal.length_squared() > 0.0 && sides.iter().all(is_above) {
        return (p - a).dot(normal).abs() / normal.length();
    }
    sides.into_iter().map(|(from, to)| distance_to_segment(p, from, to)).fold(f64::MAX, f64::min)
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * share)
}
