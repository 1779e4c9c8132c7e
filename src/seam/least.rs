//! The folds that bend least: the least perfect matching, exactly.

use super::SeamError;
use super::blossom::least_perfect_matching;
use super::graph::Graph;
use super::weight::{fold_weight, quantised};
use crate::mesh::{EdgeId, Mesh};

/// The folds with the least sum of |fold angle| × length among all that meet every vertex of a closed 3-valent mesh
/// exactly once, ascending: dull edges become folds, sharp ones seams.
///
/// Exact up to the rounding of the weights to integers: the sum is at most vertices × 10⁻¹² × the largest weight above the
/// true least sum. Of several least choices always the same one is given. The method is Edmonds' (1965); 100 000 edges
/// take well under a second.
///
/// # Errors
/// [`SeamError::Empty`], [`SeamError::Open`], [`SeamError::Valence`], and [`SeamError::NoMatching`] with a proof.
pub fn least_matching(mesh: &Mesh) -> Result<Vec<EdgeId>, SeamError> {
    let graph = Graph::cubic(mesh)?;
    least(&graph, |e| fold_weight(mesh, e))
}

/// The perfect matching with the least sum of given weights, ascending, for any mesh: open or closed, any valence.
/// Weights may be negative; one that is not finite counts as zero. Exact as [`least_matching`].
///
/// # Errors
/// [`SeamError::Empty`], and [`SeamError::NoMatching`] with a proof.
pub fn least_matching_by(mesh: &Mesh, weight: impl Fn(EdgeId) -> f64) -> Result<Vec<EdgeId>, SeamError> {
    if mesh.edge_count() == 0 {
        return Err(SeamError::Empty);
    }
    least(&Graph::new(mesh), weight)
}

fn least(graph: &Graph, weight: impl Fn(EdgeId) -> f64) -> Result<Vec<EdgeId>, SeamError> {
    let weights: Vec<f64> = graph.edge_ids.iter().map(|&e| weight(e)).collect();
    let weights = quantised(&weights, graph.vertex_ids.len());
    match least_perfect_matching(graph, &weights) {
        Ok(folds) => Ok(graph.ids(folds)),
        Err(barrier) => {
            let odd_parts = barrier.odd_parts;
            let mut barrier: Vec<_> = barrier.vertices.iter().map(|&v| graph.vertex_ids[v as usize]).collect();
            barrier.sort_unstable();
            Err(SeamError::NoMatching { barrier, odd_parts })
        }
    }
}
