//! The folds of a D-form that nobody named: the flat edges of a closed 3-valent mesh.
//!
//! Everywhere an edge's angle alone decides. With the length as a factor, short sharp edges would
//! be lighter than the long flat folds of a strip: on a carved D-form 60° × 1 mm is less than 4° ×
//! 85 mm, though a maker folds the latter.

use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::progress::Progress;
use crate::seam::{flattest_matching, piece_count};

/// A D-form folds far less than it is seamed: the mean seam must turn at least this many times as
/// much as the mean fold.
const CONTRAST: f64 = 4.0;
/// The share of vertices that must have exactly one flat edge. Where cuts overlap it is not all of
/// them.
const ONE_DULL_EDGE: f64 = 0.8;

/// The folds of a D-form, or `None` when the mesh is none. Of two ways the one with fewer pieces:
/// the flattest perfect matching, and all edges below the angle that gives the most vertices
/// exactly one flat edge.
pub(super) fn folds(mesh: &Mesh, progress: &dyn Progress) -> Option<Vec<EdgeId>> {
    if !mesh.is_closed() || mesh.vertices().any(|v| mesh.valence(v) != 3) {
        return None;
    }
    let angle = |e: EdgeId| fold_angle(mesh, e).unwrap_or(0.0).abs();
    let matching = flattest_matching(mesh, progress).ok();
    let found = matching
        .into_iter()
        .chain(flat_edges(mesh, angle))
        .filter(|folds| contrast(mesh, folds) > CONTRAST);
    found.min_by_key(|folds| piece_count(mesh, folds))
}

/// How many times as much the mean seam turns as the mean fold, by length.
fn contrast(mesh: &Mesh, folds: &[EdgeId]) -> f64 {
    let mut is_fold = EdgeMap::filled(mesh.edge_slots(), false);
    folds.iter().for_each(|&e| is_fold[e] = true);
    let mean = |wanted: bool| {
        let edges = mesh.edges().filter(|&e| is_fold[e] == wanted);
        let (turn, length) = edges.fold((0.0, 0.0), |(turn, length), e| {
            let l = edge_length(mesh, e);
            (turn + l * fold_angle(mesh, e).unwrap_or(0.0).abs(), length + l)
        });
        turn / length
    };
    mean(false) / mean(true)
}

/// The edges below the best angle.
fn flat_edges(mesh: &Mesh, angle: impl Fn(EdgeId) -> f64) -> Option<Vec<EdgeId>> {
    let mut edges: Vec<EdgeId> = mesh.edges().collect();
    edges.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)).then(a.cmp(&b)));
    let mut flat = crate::mesh::VertexMap::filled(mesh.vertex_slots(), 0_u8);
    let (mut with_one, mut best, mut most) = (0_usize, 0, 0);
    for (i, &e) in edges.iter().enumerate() {
        for v in mesh.edge_vertices(e) {
            flat[v] += 1;
            match flat[v] {
                1 => with_one += 1,
                2 => with_one -= 1,
                _ => {}
            }
        }
        if with_one > most {
            (best, most) = (i + 1, with_one);
        }
    }
    let enough = most as f64 >= ONE_DULL_EDGE * mesh.vertex_count() as f64;
    enough.then(|| {
        edges.truncate(best);
        edges.sort_unstable();
        edges
    })
}
