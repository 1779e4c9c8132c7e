//! What a choice of folds means: closed seams and pieces.

use crate::mesh::{EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, Mesh, VertexId, VertexMap};

/// Whether the folds meet every vertex exactly once. An edge that is named twice, does not exist or is a loop makes it
/// false.
pub fn is_perfect_matching(mesh: &Mesh, folds: &[EdgeId]) -> bool {
    let mut met = VertexMap::filled(mesh.vertex_slots(), false);
    let meets_once = |&e: &EdgeId| {
        mesh.has_edge(e) && mesh.edge_vertices(e).into_iter().all(|v| !std::mem::replace(&mut met[v], true))
    };
    // Every fold meets two new vertices, so the right number of them meets all.
    folds.iter().all(meets_once) && 2 * folds.len() == mesh.vertex_count()
}

/// The closed seams that are left when the folds are kept: for each, its half-edges in order. A seam starts at its lowest
/// vertex, runs along the lower of the two half-edges there, and seams come in the order of these vertices.
///
/// When the folds are a perfect matching of a 3-valent mesh, every seam is closed. Otherwise only the seams are listed
/// whose vertices all have exactly two seam edges.
pub fn seam_cycles(mesh: &Mesh, folds: &[EdgeId]) -> Vec<Vec<HalfEdgeId>> {
    let is_fold = marked(mesh, folds);
    let mut visited = VertexMap::filled(mesh.vertex_slots(), false);
    mesh.vertices().filter_map(|v| seam_cycle(mesh, &is_fold, &mut visited, v)).collect()
}

/// The number of connected pieces that the faces make when exactly the folds are kept; holes are no pieces.
pub fn piece_count(mesh: &Mesh, folds: &[EdgeId]) -> usize {
    let is_fold = marked(mesh, folds);
    let mut seen = FaceMap::filled(mesh.face_slots(), false);
    let mut stack: Vec<FaceId> = Vec::new();
    let mut pieces = 0;
    for seed in mesh.faces() {
        if std::mem::replace(&mut seen[seed], true) {
            continue;
        }
        pieces += 1;
        stack.push(seed);
        while let Some(f) = stack.pop() {
            for h in mesh.face_half_edges(f).filter(|h| is_fold[h.edge()]) {
                let g = mesh.face(h.twin());
                if !mesh.is_hole(g) && !std::mem::replace(&mut seen[g], true) {
                    stack.push(g);
                }
            }
        }
    }
    pieces
}

fn marked(mesh: &Mesh, folds: &[EdgeId]) -> EdgeMap<bool> {
    let mut is_fold = EdgeMap::filled(mesh.edge_slots(), false);
    for &e in folds.iter().filter(|&&e| mesh.has_edge(e)) {
        is_fold[e] = true;
    }
    is_fold
}

/// The two seam half-edges that leave a vertex, lower first; `None` when there are fewer or more.
fn seams_at(mesh: &Mesh, is_fold: &EdgeMap<bool>, v: VertexId) -> Option<[HalfEdgeId; 2]> {
    let mut seams = mesh.outgoing(v).filter(|h| !is_fold[h.edge()]);
    let pair = [seams.next()?, seams.next()?];
    seams.next().is_none().then(|| [pair[0].min(pair[1]), pair[0].max(pair[1])])
}

fn seam_cycle(
    mesh: &Mesh,
    is_fold: &EdgeMap<bool>,
    visited: &mut VertexMap<bool>,
    start: VertexId,
) -> Option<Vec<HalfEdgeId>> {
    if visited[start] {
        return None;
    }
    let [mut h, _] = seams_at(mesh, is_fold, start)?;
    let mut cycle = Vec::new();
    loop {
        cycle.push(h);
        visited[mesh.origin(h)] = true;
        let v = mesh.target(h);
        if v == start {
            return Some(cycle);
        }
        let [a, b] = seams_at(mesh, is_fold, v)?;
        h = if a == h.twin() { b } else { a };
    }
}
