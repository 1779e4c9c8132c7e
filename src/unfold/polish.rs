//! Shorter seams: folds are exchanged for longer ones that do no harm.
//!
//! Closing an open edge of a piece makes a ring of folds, of which another must open. Where that
//! one is shorter, the part that it sets free is laid along the longer edge, if nothing overlaps
//! there: the exchange step of spanning trees, by length, under the condition that the net stays
//! flat. Fewer and longer glued edges are what a maker wants.

use super::dual::{Dual, FLAT, NONE};
use super::layout::Layout;
use crate::progress::Progress;

/// Rounds over all edges at most.
const ROUNDS: usize = 3;

/// Shortens the seams of a layout without overlaps. Lays at most about `budget` faces.
pub(super) fn polish(layout: &mut Layout, mut budget: u64, progress: &dyn Progress) {
    let dual = layout.dual;
    let mut longest_first: Vec<usize> = (0..dual.hinges.len()).collect();
    longest_first.sort_by(|&a, &b| worth(dual, b).total_cmp(&worth(dual, a)).then(a.cmp(&b)));
    for round in 0..ROUNDS {
        let mut changed = false;
        for &hinge in &longest_first {
            if budget == 0 || progress.is_cancelled() {
                return;
            }
            changed |= exchange(layout, hinge, &mut budget);
        }
        progress.report("shortening seams", round + 1, ROUNDS);
        if !changed {
            return;
        }
    }
}

/// How much an edge is wanted as a fold: flat ones above all, then long ones.
fn worth(dual: &Dual, hinge: usize) -> f64 {
    let hinge = dual.hinges[hinge];
    if hinge.fold <= FLAT { f64::INFINITY } else { hinge.length }
}

/// Folds an open edge instead of the least one of the ring that it closes, if that one is shorter
/// and nothing overlaps.
fn exchange(layout: &mut Layout, hinge: usize, budget: &mut u64) -> bool {
    let dual = layout.dual;
    let sides = dual.hinges[hinge].sides;
    let [f, g] = sides.map(|s| dual.owner[s as usize]);
    let forest = &layout.forest;
    if forest.is_fold(dual, sides[0]) || layout.piece[f as usize] != layout.piece[g as usize] {
        return false;
    }
    let mut ring = Vec::new();
    forest.path(dual, f, g, &mut ring);
    *budget = budget.saturating_sub(1 + ring.len() as u64 / 16);
    let of_fold =
        |c: u32| worth(dual, dual.hinge[forest.parent_side[c as usize] as usize] as usize);
    let free = ring.into_iter().filter(|&c| !forest.must_keep(dual, c));
    let least = free.min_by(|&a, &b| of_fold(a).total_cmp(&of_fold(b)).then(a.cmp(&b)));
    let Some(cut) = least.filter(|&c| of_fold(c) < worth(dual, hinge)) else { return false };
    let mut faces = Vec::new();
    forest.smaller_part(cut, &mut faces);
    layout.mark(&faces);
    let Some(side) = sides.into_iter().find(|&s| layout.is_marked(dual.owner[s as usize])) else {
        return false;
    };
    debug_assert!(dual.across[side as usize] != NONE, "hinges have two sides");
    let (motion, piece) = (layout.motion(side), layout.piece[f as usize]);
    let mut found = Vec::new();
    *budget = budget.saturating_sub(layout.try_motion(&faces, motion, piece, 0, &mut found) as u64);
    if !found.is_empty() {
        return false;
    }
    layout.carry_out(&faces, cut, side, motion, &found);
    true
}
