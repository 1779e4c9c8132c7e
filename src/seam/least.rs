//! The folds that bend least: the least perfect matching, exactly.

use super::SeamError;
use super::blossom::{Unmatched, least_perfect_matching};
use super::graph::Graph;
use super::weight::{fold_weight, quantised};
use crate::measure::fold_angle;
use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;

/// The folds with the least sum of |fold angle| × length among all that meet every vertex of a
/// closed 3-valent mesh exactly once, ascending: flat edges become folds, sharp ones seams.
///
/// Exact up to the rounding of the weights to integers: the sum is at most vertices × 10⁻¹² × the
/// largest weight above the true least sum. Of several least choices always the same one is given.
/// The method is Edmonds' (1965); 100 000 edges take well under a second.
///
/// # Errors
/// [`SeamError::Empty`], [`SeamError::Open`], [`SeamError::Valence`], [`SeamError::Cancelled`], and
/// [`SeamError::NoMatching`] with a proof.
pub fn least_matching(mesh: &Mesh, progress: &dyn Progress) -> Result<Vec<EdgeId>, SeamError> {
    let graph = Graph::cubic(mesh)?;
    least(&graph, |e| fold_weight(mesh, e), progress)
}

/// The folds with the least sum of |fold angle| alone, whatever their lengths, among all that meet
/// every vertex of a closed 3-valent mesh exactly once, ascending.
///
/// The one to take on a mesh that was carved already. There the long edges are the flat ones: with
/// the length as a factor, a sharp edge of 60° and 1 mm would be lighter than the fold of 4° and 85
/// mm beside it that a maker folds.
///
/// # Errors
/// As [`least_matching`].
pub fn flattest_matching(mesh: &Mesh, progress: &dyn Progress) -> Result<Vec<EdgeId>, SeamError> {
    let graph = Graph::cubic(mesh)?;
    least(&graph, |e| fold_angle(mesh, e).map_or(0.0, f64::abs), progress)
}

/// The perfect matching with the least sum of given weights, ascending, for any mesh: open or
/// closed, any valence. Weights may be negative; one that is not finite counts as zero. Exact as
/// [`least_matching`].
///
/// # Errors
/// [`SeamError::Empty`], [`SeamError::Cancelled`], and [`SeamError::NoMatching`] with a proof.
pub fn least_matching_by(
    mesh: &Mesh,
    weight: impl Fn(EdgeId) -> f64,
    progress: &dyn Progress,
) -> Result<Vec<EdgeId>, SeamError> {
    if mesh.edge_count() == 0 {
        return Err(SeamError::Empty);
    }
    least(&Graph::new(mesh), weight, progress)
}

fn least(
    graph: &Graph,
    weight: impl Fn(EdgeId) -> f64,
    progress: &dyn Progress,
) -> Result<Vec<EdgeId>, SeamError> {
    let weights: Vec<f64> = graph.edge_ids.iter().map(|&e| weight(e)).collect();
    let weights = quantised(&weights, graph.vertex_ids.len());
    least_folds(graph, &weights, progress).map(|folds| graph.ids(folds))
}

/// The folds of the least perfect matching as edge numbers.
pub(super) fn least_folds(
    graph: &Graph,
    weights: &[i64],
    progress: &dyn Progress,
) -> Result<Vec<u32>, SeamError> {
    least_perfect_matching(graph, weights, progress).map_err(|unmatched| match unmatched {
        Unmatched::Cancelled => SeamError::Cancelled,
        Unmatched::Barrier(barrier) => SeamError::NoMatching {
            odd_parts: barrier.odd_parts,
            barrier: barrier.vertices.iter().map(|&v| graph.vertex_ids[v as usize]).collect(),
        },
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::{fixtures, is_perfect_matching};
    use super::*;
    use crate::mesh::FaceKind;
    use crate::progress::Silent;

    #[test]
    fn flat_edges_become_folds() {
        // A low prism with many sides: the upright edges bend least and are shortest.
        let prism = fixtures::prism(12, 0.1);
        let folds = least_matching(&prism, &Silent).expect("folds");
        let upright = |&e: &EdgeId| {
            let [a, b] = prism.edge_positions(e);
            (a - b).truncate() == glam::DVec2::ZERO
        };
        assert_eq!(folds.len(), 12);
        assert!(folds.iter().all(upright));
    }

    #[test]
    fn the_same_folds_at_any_scale_and_place() {
        let mesh = fixtures::random_convex(200, 11);
        let folds = least_matching(&mesh, &Silent).expect("folds");
        assert!(is_perfect_matching(&mesh, &folds));
        for (scale, shift) in [(1e-3, 0.0), (1e5, 0.0), (1.0, 1e4)] {
            let mut moved = mesh.clone();
            for v in mesh.vertices() {
                moved.set_position(v, mesh.position(v) * scale + DVec3::splat(shift), true);
            }
            assert_eq!(least_matching(&moved, &Silent), Ok(folds.clone()), "{scale} {shift}");
        }
    }

    #[test]
    fn given_weights_and_other_valences() {
        // An octahedron: valence 4, six vertices.
        let points = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
        let faces = [
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ];
        let mesh = Mesh::from_faces(points, faces).expect("an octahedron");
        let error =
            SeamError::Valence { vertex: crate::mesh::VertexId::new(0), valence: 4, count: 6 };
        assert_eq!(least_matching(&mesh, &Silent), Err(error));
        let folds = least_matching_by(&mesh, |e| e.index() as f64, &Silent).expect("folds");
        assert!(is_perfect_matching(&mesh, &folds));
        let dearest = least_matching_by(&mesh, |e| -(e.index() as f64), &Silent).expect("folds");
        let sum = |folds: &[EdgeId]| folds.iter().map(|e| e.index()).sum::<usize>();
        assert!(sum(&folds) < sum(&dearest));
    }

    #[test]
    fn what_cannot_be_is_said_with_ids() {
        assert_eq!(least_matching(&Mesh::new(), &Silent), Err(SeamError::Empty));
        let mut open = fixtures::cube();
        let face = open.faces().next().expect("a face");
        open.set_kind(face, FaceKind::Hole);
        assert!(matches!(least_matching(&open, &Silent), Err(SeamError::Open { holes: 1, .. })));
        // Three odd parts that hang on one vertex.
        let mut ends = Vec::new();
        for part in 0..3u32 {
            let at = |i: u32| 1 + 5 * part + i;
            ends.extend([
                [0, at(0)],
                [at(0), at(1)],
                [at(0), at(2)],
                [at(1), at(3)],
                [at(2), at(4)],
                [at(1), at(4)],
            ]);
            ends.extend([[at(2), at(3)], [at(3), at(4)]]);
        }
        let graph = Graph::of_ends(16, ends);
        let error = least_folds(&graph, &[1; 24], &Silent).expect_err("no perfect matching");
        let barrier = vec![crate::mesh::VertexId::new(0)];
        assert_eq!(error, SeamError::NoMatching { barrier, odd_parts: 3 });
        assert!(error.to_string().contains("1 vertex [0]"), "{error}");
    }
}
