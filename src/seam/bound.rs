//! How good a two-piece seam is: branch and bound over matchings.
//!
//! The folds of a two-piece seam are a perfect matching, so none has less than the least one. Where
//! that leaves several closed seams, take the shortest: of the folds that leave its vertices at
//! least one must become seam, since else it stays closed for ever. Forbidding each of them in turn,
//! and forcing those before, divides all two-piece seams among children whose least matchings bound
//! them; the smallest of all open bounds holds for every two-piece seam (Land and Doig 1960).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::error::SeamError;
use super::factor::seam_cycles;
use super::least::least_matching_by;
use super::weight::{fold_sum, fold_weight};
use crate::mesh::{EdgeId, EdgeMap, Mesh, VertexMap};
use crate::progress::Progress;

/// Work that may be done, in matchings times vertices.
const WORK: usize = 20_000;
/// Matchings at most, and at least.
const MATCHINGS: [usize; 2] = [400, 8];
/// Sums nearer to one another, as a share, are equal.
const EQUAL: f64 = 1e-9;

/// What is known of the least fold sum of all two-piece seams.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPieceBound {
    /// No two-piece seam has a smaller fold sum, in rad·mm.
    pub lower: f64,
    /// Folds with that sum, where they were found: the best of all.
    pub best: Option<Vec<EdgeId>>,
}

/// A part of all choices, with its least matching.
struct Node {
    sum: f64,
    /// For equal sums: the order of their birth, so that the result is always the same.
    birth: usize,
    folds: Vec<EdgeId>,
    forbidden: Vec<EdgeId>,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Node {
    /// The least sum is the greatest of a heap.
    fn cmp(&self, other: &Self) -> Ordering {
        other.sum.total_cmp(&self.sum).then(other.birth.cmp(&self.birth))
    }
}

/// A lower bound on the fold sum of all two-piece seams of a closed 3-valent mesh, and the best seam
/// where a fixed amount of work proves one. `known` is a two-piece seam that was found already.
///
/// # Errors
/// As [`super::least_matching`]. Stopped early, it returns the bound so far.
pub fn two_piece_bound(
    mesh: &Mesh,
    known: &[EdgeId],
    progress: &dyn Progress,
) -> Result<TwoPieceBound, SeamError> {
    let upper = fold_sum(mesh, known);
    let is_best = |lower: f64| (lower >= upper * (1.0 - EQUAL)).then(|| known.to_vec());
    let [most, fewest] = MATCHINGS;
    let budget = (WORK / mesh.vertex_count().max(1)).clamp(fewest, most);
    let mut search = Branches { mesh, open: BinaryHeap::new(), born: 0 };
    search.push(Vec::new(), progress)?;
    let mut lower = 0.0_f64;
    while let Some(node) = search.open.pop() {
        lower = lower.max(node.sum.min(upper));
        let cycles = seam_cycles(mesh, &node.folds);
        if cycles.len() == 1 {
            return Ok(TwoPieceBound { lower, best: Some(node.folds) });
        }
        let is_spent = search.born >= budget || progress.is_cancelled();
        if is_spent || node.sum >= upper * (1.0 - EQUAL) {
            return Ok(TwoPieceBound { lower, best: is_best(lower) });
        }
        progress.report("bounding the fold sum", search.born, budget);
        let Some(shortest) = cycles.iter().min_by_key(|cycle| cycle.len()) else { break };
        let mut is_on = VertexMap::filled(mesh.vertex_slots(), false);
        shortest.iter().for_each(|&h| is_on[mesh.origin(h)] = true);
        let leaving: Vec<EdgeId> = node
            .folds
            .iter()
            .copied()
            .filter(|&e| {
                mesh.edge_vertices(e).map(|v| is_on[v]).iter().filter(|on| **on).count() == 1
            })
            .collect();
        for (i, &e) in leaving.iter().enumerate() {
            let mut forbidden = node.forbidden.clone();
            forbidden.push(e);
            forbidden.extend(leaving[..i].iter().flat_map(|&kept| beside(mesh, kept)));
            match search.push(forbidden, progress) {
                Err(SeamError::Cancelled) => {
                    return Ok(TwoPieceBound { lower, best: is_best(lower) });
                }
                result => result?,
            }
        }
    }
    // Every branch has closed: nothing is better than what was known.
    Ok(TwoPieceBound { lower: upper, best: Some(known.to_vec()) })
}

/// The other edges at the ends of an edge: without them it has to fold.
fn beside(mesh: &Mesh, e: EdgeId) -> Vec<EdgeId> {
    let around = mesh.edge_vertices(e).into_iter().flat_map(|v| mesh.outgoing(v));
    around.map(|h| h.edge()).filter(|&other| other != e).collect()
}

struct Branches<'a> {
    mesh: &'a Mesh,
    open: BinaryHeap<Node>,
    born: usize,
}

impl Branches<'_> {
    /// Adds the part of all choices without these folds, unless it is empty.
    fn push(&mut self, forbidden: Vec<EdgeId>, progress: &dyn Progress) -> Result<(), SeamError> {
        let mesh = self.mesh;
        let mut is_forbidden = EdgeMap::filled(mesh.edge_slots(), false);
        forbidden.iter().for_each(|&e| is_forbidden[e] = true);
        // Heavier than any choice without one.
        let heavy = 1.0 + 2.0 * mesh.edges().map(|e| fold_weight(mesh, e)).sum::<f64>();
        let weight = |e| if is_forbidden[e] { heavy } else { fold_weight(mesh, e) };
        let folds = least_matching_by(mesh, weight, progress)?;
        self.born += 1;
        if !folds.iter().any(|&e| is_forbidden[e]) {
            let sum = fold_sum(mesh, &folds);
            self.open.push(Node { sum, birth: self.born, folds, forbidden });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MATCHING_LIMIT, fixtures, hamiltonian_folds, least_matching, table};
    use super::*;
    use crate::progress::Silent;

    /// Against the list of all choices.
    #[test]
    fn the_bound_of_small_meshes_is_the_least_of_all() {
        let random = (0..6).map(|seed| fixtures::random_convex(14, seed));
        let solids = [fixtures::cube(), fixtures::dodecahedron()];
        let mut above_the_least = 0;
        for mesh in solids.into_iter().chain(random) {
            let rows = table(&mesh, MATCHING_LIMIT, &Silent).expect("rows");
            let two = rows.iter().filter(|row| row.seam_cycles == 1);
            let least = two.map(|row| row.fold_sum).min_by(f64::total_cmp).expect("two pieces");
            let worst = rows.iter().filter(|row| row.seam_cycles == 1);
            let worst = worst.max_by(|a, b| a.fold_sum.total_cmp(&b.fold_sum)).expect("two pieces");
            let bound = two_piece_bound(&mesh, &worst.folds, &Silent).expect("a bound");
            assert!((bound.lower - least).abs() < 1e-9 * least, "{} {least}", bound.lower);
            let best = bound.best.expect("proved");
            assert_eq!(seam_cycles(&mesh, &best).len(), 1);
            assert!((fold_sum(&mesh, &best) - least).abs() < 1e-9 * least);
            let matching = least_matching(&mesh, &Silent).expect("a matching");
            above_the_least += usize::from(fold_sum(&mesh, &matching) < least * 0.999);
        }
        assert!(above_the_least > 0, "the least matching was always the answer");
    }

    #[test]
    fn the_bound_of_a_larger_mesh_lies_between() {
        let mesh = fixtures::random_convex(60, 3);
        let known = hamiltonian_folds(&mesh, &Silent).expect("two pieces");
        let bound = two_piece_bound(&mesh, &known, &Silent).expect("a bound");
        let least = fold_sum(&mesh, &least_matching(&mesh, &Silent).expect("a matching"));
        assert!(bound.lower >= least * (1.0 - 1e-9), "{} {least}", bound.lower);
        assert!(bound.lower <= fold_sum(&mesh, &known) * (1.0 + 1e-9));
        assert_eq!(two_piece_bound(&mesh, &known, &Silent), Ok(bound));
    }
}
