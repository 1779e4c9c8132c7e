//! Least-weight perfect matching in a sparse graph: Edmonds' primal-dual method (1965), exact in
//! integers.
//!
//! Every vertex and every *blossom* (an odd cycle shrunk to a node) carries a dual value; the
//! *radius* of a vertex is the sum of the duals of all nodes that hold it. The *slack* of an edge
//! between two top nodes is its weight less the radii of its ends, never negative; matched edges
//! and tree edges are tight (slack 0). Every top node that is not matched roots a tree of tight
//! edges, in which *outer* nodes (even distance from the root) grow and *inner* nodes shrink, all
//! at the same rate. One clock drives all trees. It jumps from event to event:
//!
//! - an edge between an outer and a *free* node (in no tree) gets tight: the node and its mate join
//!   the tree;
//! - an edge between two trees gets tight: the path between the roots is flipped, both trees
//!   dissolve;
//! - an edge inside a tree gets tight: the odd cycle becomes a blossom;
//! - an inner blossom has shrunk to nothing: it is taken apart.
//!
//! When no event is left although a tree is, its inner vertices prove that there is no perfect
//! matching. The dual values prove the result: [`Certificate`].
//!
//! Cost: an edge sits in the queue once and is looked at again when its time has come and it turns
//! out too early. Which top node holds a vertex is found through *labels*: a new blossom takes over
//! the label of its largest child, so that only the vertices of the smaller children are renamed.

mod node;
mod solver;
mod steps;

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(super) use tests::Random;

use super::graph::Graph;
use crate::progress::Progress;
use solver::Solver;

/// Why there is no perfect matching: without these vertices more odd parts are left than vertices
/// were removed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Barrier {
    /// The removed vertices.
    pub vertices: Vec<u32>,
    /// How many parts with an odd number of vertices are left.
    pub odd_parts: usize,
}

/// Why no matching was returned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Unmatched {
    /// There is none.
    Barrier(Barrier),
    /// The user cancelled; half a matching is of no use.
    Cancelled,
}

/// The edges of the perfect matching with the least sum of weights, in the order of their lower
/// ends.
///
/// # Errors
/// [`Unmatched`].
pub(super) fn least_perfect_matching(
    graph: &Graph,
    weights: &[i64],
    progress: &dyn Progress,
) -> Result<Vec<u32>, Unmatched> {
    let mut solver = Solver::new(graph, weights);
    solver.run(progress)?;
    Ok(solver.matching())
}

/// Dual values that prove a matching to be least: no other can have a smaller sum.
#[cfg(test)]
#[derive(Debug)]
pub(super) struct Certificate {
    /// The dual value of each vertex, in quarters of the weights' unit.
    pub vertices: Vec<i64>,
    /// Each blossom: its vertices, and its dual value in the same unit.
    pub blossoms: Vec<(Vec<u32>, i64)>,
}
