//! What a choice of folds means: closed seams and pieces.

use crate::mesh::{EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, Mesh, VertexId, VertexMap};

/// Whether the folds meet every vertex exactly once. An edge that is named twice, does not exist or
/// is a loop makes it false.
pub fn is_perfect_matching(mesh: &Mesh, folds: &[EdgeId]) -> bool {
    let mut met = VertexMap::filled(mesh.vertex_slots(), false);
    let meets_once = |&e: &EdgeId| {
        mesh.has_edge(e)
            && mesh.edge_vertices(e).into_iter().all(|v| !std::mem::replace(&mut met[v], true))
    };
    // Every fold meets two new vertices, so the right number of them meets all.
    folds.iter().all(meets_once) && 2 * folds.len() == mesh.vertex_count()
}

/// The closed seams that are left when the folds are kept: for each, its half-edges in order. A
/// seam starts at its lowest vertex, runs along the lower of the two half-edges there, and seams
/// come in the order of these vertices.
///
/// When the folds are a perfect matching of a 3-valent mesh, every seam is closed. Otherwise only
/// the seams are listed whose vertices all have exactly two seam edges.
pub fn seam_cycles(mesh: &Mesh, folds: &[EdgeId]) -> Vec<Vec<HalfEdgeId>> {
    let is_fold = marked(mesh, folds);
    let mut visited = VertexMap::filled(mesh.vertex_slots(), false);
    mesh.vertices().filter_map(|v| seam_cycle(mesh, &is_fold, &mut visited, v)).collect()
}

/// The number of connected pieces that the faces make when exactly the folds are kept; holes are no
/// pieces.
pub fn piece_count(mesh: &Mesh, folds: &[EdgeId]) -> usize {
    let pieces = piece_of_faces(mesh, folds);
    mesh.faces().filter_map(|f| pieces[f]).max().map_or(0, |last| last + 1)
}

/// For each face the number of its piece, from 0, when exactly the folds are kept; nothing for
/// holes.
pub fn piece_of_faces(mesh: &Mesh, folds: &[EdgeId]) -> FaceMap<Option<usize>> {
    let is_fold = marked(mesh, folds);
    let mut piece = FaceMap::filled(mesh.face_slots(), None);
    let mut stack: Vec<FaceId> = Vec::new();
    let mut count = 0;
    for seed in mesh.faces() {
        if piece[seed].is_some() {
            continue;
        }
        piece[seed] = Some(count);
        stack.push(seed);
        while let Some(f) = stack.pop() {
            for h in mesh.face_half_edges(f).filter(|h| is_fold[h.edge()]) {
                let g = mesh.face(h.twin());
                if !mesh.is_hole(g) && piece[g].replace(count).is_none() {
                    stack.push(g);
                }
            }
        }
        count += 1;
    }
    piece
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

#[cfg(test)]
mod tests {
    use super::super::fixtures;
    use super::*;

    fn upright(mesh: &Mesh) -> Vec<EdgeId> {
        let is_upright = |&e: &EdgeId| {
            let [a, b] = mesh.edge_positions(e);
            a.z != b.z
        };
        mesh.edges().filter(is_upright).collect()
    }

    #[test]
    fn a_prism_folded_upright_has_two_seams_and_three_pieces() {
        let prism = fixtures::prism(5, 1.0);
        let folds = upright(&prism);
        assert!(is_perfect_matching(&prism, &folds));
        let cycles = seam_cycles(&prism, &folds);
        assert_eq!(cycles.iter().map(Vec::len).collect::<Vec<_>>(), [5, 5]);
        for cycle in &cycles {
            assert!(cycle.windows(2).all(|w| prism.target(w[0]) == prism.origin(w[1])));
            assert_eq!(prism.target(cycle[4]), prism.origin(cycle[0]));
        }
        assert_eq!(piece_count(&prism, &folds), 3);
        assert_eq!(piece_count(&prism, &[]), 7);
        assert_eq!(piece_count(&prism, &prism.edges().collect::<Vec<_>>()), 1);
    }

    #[test]
    fn what_is_no_perfect_matching() {
        let prism = fixtures::prism(5, 1.0);
        let folds = upright(&prism);
        assert!(!is_perfect_matching(&prism, &folds[1..]));
        let doubled: Vec<EdgeId> = folds[1..].iter().copied().chain([folds[1]]).collect();
        assert!(!is_perfect_matching(&prism, &doubled));
        let missing: Vec<EdgeId> = folds[1..].iter().copied().chain([EdgeId::new(500)]).collect();
        assert!(!is_perfect_matching(&prism, &missing));
        // With one fold less its two ends have three seams, and both seams run through them: none
        // is listed.
        assert!(seam_cycles(&prism, &folds[1..]).is_empty());
    }
}
