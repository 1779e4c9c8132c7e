//! What planarizing cost: vertices that moved far, panels that became concave, corners that became
//! sharp. Planar it may be all the same, but it is not what was drawn.

use super::report::{FarMove, Needle, SHARP, SHARPEST, TENTH};
use crate::measure::{corner_angle, edge_length};
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};

/// A face is concave with a corner this many degrees above 180: less is the rounding of a straight
/// run.
const CONCAVE: f64 = 180.0 + 1e-6;

/// The vertices that moved by more than a tenth of their mean edge before, farthest first.
pub(super) fn far_moves(before: &Mesh, after: &Mesh) -> Vec<FarMove> {
    let mean_edge = |v: VertexId| {
        let edges: Vec<f64> = before.outgoing(v).map(|h| edge_length(before, h.edge())).collect();
        edges.iter().sum::<f64>() / edges.len().max(1) as f64
    };
    let mut moves: Vec<FarMove> = before
        .vertices()
        .map(|vertex| {
            let mm = before.position(vertex).distance(after.position(vertex));
            FarMove { vertex, mm, share: if mm > 0.0 { mm / mean_edge(vertex) } else { 0.0 } }
        })
        .filter(|far| far.share > TENTH)
        .collect();
    moves.sort_by(|a, b| b.share.total_cmp(&a.share).then(a.vertex.cmp(&b.vertex)));
    moves
}

/// The faces that are concave and were not before.
pub(super) fn concave(before: &Mesh, after: &Mesh) -> Vec<FaceId> {
    let is_concave = |mesh: &Mesh, f: FaceId| {
        mesh.face_half_edges(f)
            .any(|h| corner_angle(mesh, h).is_some_and(|angle| angle.to_degrees() > CONCAVE))
    };
    after.faces().filter(|&f| is_concave(after, f) && !is_concave(before, f)).collect()
}

/// The needles of a mesh at corners that were none before, in the order of faces.
pub(super) fn needles(before: &Mesh, after: &Mesh) -> Vec<Needle> {
    let is_needle = |degrees: f64| !(SHARPEST..=360.0 - SHARPEST).contains(&degrees);
    sharpened(before, after, &is_needle)
}

/// The corners that are sharp and no needles, and were not sharp before.
pub(super) fn sharp(before: &Mesh, after: &Mesh) -> Vec<Needle> {
    sharpened(before, after, &|degrees: f64| degrees < SHARP)
        .into_iter()
        .filter(|corner| corner.degrees >= SHARPEST)
        .collect()
}

fn sharpened(before: &Mesh, after: &Mesh, is_bad: &dyn Fn(f64) -> bool) -> Vec<Needle> {
    let angle = |mesh: &Mesh, h: HalfEdgeId| corner_angle(mesh, h).map(f64::to_degrees);
    let corners = after.faces().flat_map(|f| after.face_half_edges(f));
    corners
        .filter_map(|h| {
            let degrees = angle(after, h).filter(|&degrees| is_bad(degrees))?;
            let was_bad = angle(before, h).is_none_or(is_bad);
            let (face, vertex) = (after.face(h), after.origin(h));
            (!was_bad).then_some(Needle { face, vertex, degrees })
        })
        .collect()
}

/// Whether most faces have four sides, and some of them bend into each other both ways: then only
/// special quads are planar.
pub(super) fn is_quads(mesh: &Mesh) -> bool {
    let quads = mesh.faces().filter(|&f| mesh.sides(f) == 4).count();
    2 * quads > mesh.face_count()
}
