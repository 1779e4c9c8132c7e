//! Dividing what cannot lie flat in one piece, and joining what can.

use super::dual::{Dual, NONE};
use super::forest::Forest;
use super::layout::Layout;

/// Opens folds until nothing overlaps: each time the fold that parts the most overlapping pairs, of
/// equal ones the cheapest to open (least fold angle × length), then the lowest.
pub(super) fn split_overlaps(layout: &mut Layout) {
    let mut parted = vec![0_i64; layout.dual.face_count()];
    while !layout.overlaps.is_empty() {
        count_parted(layout, &mut parted);
        let dual = layout.dual;
        let forest = &layout.forest;
        let cost = |c: u32| fold_cost(dual, forest, c);
        let folds =
            (0..dual.face_count() as u32).filter(|&c| forest.parent_side[c as usize] != NONE);
        let best = folds.min_by(|&a, &b| {
            let by_count = parted[b as usize].cmp(&parted[a as usize]);
            let keeps = |c: u32| parted[c as usize] == 0 || forest.must_keep(dual, c);
            keeps(a)
                .cmp(&keeps(b))
                .then(by_count)
                .then_with(|| cost(a).total_cmp(&cost(b)))
                .then(a.cmp(&b))
        });
        layout.split(best.expect("two faces that overlap are connected by folds"));
    }
}

/// Face → number of overlapping pairs that opening the fold above it would part.
fn count_parted(layout: &Layout, parted: &mut [i64]) {
    let (dual, forest) = (layout.dual, &layout.forest);
    parted.fill(0);
    for &(f, g) in &layout.overlaps {
        parted[f as usize] += 1;
        parted[g as usize] += 1;
        parted[forest.meeting(dual, f, g) as usize] -= 2;
    }
    for &f in forest.order().iter().rev() {
        let parent = forest.parent(dual, f);
        if parent != NONE {
            parted[parent as usize] += parted[f as usize];
        }
    }
}

fn fold_cost(dual: &Dual, forest: &Forest, c: u32) -> f64 {
    let hinge = dual.hinges[dual.hinge[forest.parent_side[c as usize] as usize] as usize];
    hinge.fold * hinge.length
}

/// Hangs pieces on each other by any edge between them that makes no overlap, until no edge will
/// do. `keep_going` is asked before each piece is tried.
pub(super) fn join_pieces(layout: &mut Layout, keep_going: impl Fn() -> bool) {
    let dual = layout.dual;
    let mut found = Vec::new();
    let mut joined = true;
    while std::mem::take(&mut joined) {
        for hinge in &dual.hinges {
            let [s, t] = hinge.sides;
            let [f, g] = [s, t].map(|s| dual.owner[s as usize]);
            if layout.piece[f as usize] == layout.piece[g as usize] {
                continue;
            }
            if !keep_going() {
                return;
            }
            let size = |f: u32| layout.forest.size(layout.forest.root(f));
            let (s, f, g) = if size(f) <= size(g) { (s, f, g) } else { (t, g, f) };
            let faces = layout.forest.subtree(layout.forest.root(f)).to_vec();
            layout.mark(&faces);
            let motion = layout.motion(s);
            layout.try_motion(&faces, motion, layout.piece[g as usize], 0, &mut found);
            if found.is_empty() {
                layout.carry_out(&faces, NONE, s, motion, &[]);
                joined = true;
            }
        }
    }
}

/// Opens folds until there are `count` pieces: each time the one that halves the largest piece
/// best.
pub(super) fn split_to_count(layout: &mut Layout, count: usize) {
    while layout.forest.roots().len() < count {
        let forest = &layout.forest;
        let folds = (0..layout.dual.face_count() as u32)
            .filter(|&c| forest.parent_side[c as usize] != NONE);
        let keeps = |c: u32| forest.must_keep(layout.dual, c);
        let best = folds.max_by_key(|&c| {
            (!keeps(c), forest.size(forest.root(c)), forest.smaller_size(c), std::cmp::Reverse(c))
        });
        layout.split(best.expect("fewer pieces than faces leave a fold"));
    }
}
