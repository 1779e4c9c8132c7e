//! Dividing what cannot lie flat in one piece, and joining what can.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::dual::{Dual, NONE};
use super::forest::Forest;
use super::layout::Layout;

/// A fold that may open, the best one greatest: last those that must stay, then by how many
/// overlapping pairs it would part, then by least cost, then by lowest face.
#[derive(PartialEq)]
struct Candidate {
    is_free: bool,
    parted: u32,
    cost: f64,
    face: u32,
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_count = (self.is_free, self.parted).cmp(&(other.is_free, other.parted));
        by_count
            .then_with(|| other.cost.total_cmp(&self.cost))
            .then_with(|| other.face.cmp(&self.face))
    }
}

/// Opens folds until nothing overlaps: each time the fold that parts the most overlapping pairs, of
/// equal ones the cheapest to open (least fold angle × length), then the lowest.
///
/// A fold can only lose pairs to others, so the heap holds what each parted at some time before,
/// and one that comes up with too many goes back with what is left. Every pair is taken off the
/// folds between its faces once, and every split walks the smaller part alone: the whole costs
/// little more than finding the pairs did.
pub(super) fn split_overlaps(layout: &mut Layout) {
    let dual = layout.dual;
    let mut parted = count_parted(layout);
    let forest = &layout.forest;
    let candidate = |c: u32, parted: u32| Candidate {
        is_free: !forest.must_keep(dual, c),
        parted,
        cost: fold_cost(dual, forest, c),
        face: c,
    };
    let folds = (0..dual.face_count() as u32).filter(|&c| forest.parent_side[c as usize] != NONE);
    let parting = folds.map(|c| candidate(c, parted[c as usize])).filter(|fold| fold.parted > 0);
    let mut heap: BinaryHeap<Candidate> = parting.collect();
    let (mut left, mut pairs, mut path) = (layout.overlaps.len(), Vec::new(), Vec::new());
    while left > 0 {
        let best = heap.pop().expect("two faces that overlap are connected by folds");
        let now = parted[best.face as usize];
        if now < best.parted {
            if now > 0 {
                heap.push(Candidate { parted: now, ..best });
            }
            continue;
        }
        let part = layout.forest.smaller_part_by_walk(dual, best.face);
        layout.pairs_parted_by(&part, &mut pairs);
        for &(f, g) in &pairs {
            layout.forest.path(dual, f, g, &mut path);
            path.iter().for_each(|&c| parted[c as usize] -= 1);
        }
        left -= pairs.len();
        layout.open(best.face, &part);
    }
    layout.settle_opened();
}

/// Face → number of overlapping pairs that opening the fold above it would part.
fn count_parted(layout: &Layout) -> Vec<u32> {
    let (dual, forest) = (layout.dual, &layout.forest);
    let mut parted = vec![0_u32; dual.face_count()];
    // What the lower faces add is there before the common face above them takes it off.
    let mut met = vec![0_u32; dual.face_count()];
    for &(f, g) in &layout.overlaps {
        parted[f as usize] += 1;
        parted[g as usize] += 1;
        met[forest.meeting(dual, f, g) as usize] += 2;
    }
    for &f in forest.order().iter().rev() {
        parted[f as usize] -= met[f as usize];
        let parent = forest.parent(dual, f);
        if parent != NONE {
            parted[parent as usize] += parted[f as usize];
        }
    }
    parted
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use crate::unfold::start::{Rule, forest};
    use crate::unfold::{Seams, dual::Dual};

    /// The rule by comparing all folds each time.
    fn split_by_comparing(layout: &mut Layout) {
        while !layout.overlaps.is_empty() {
            let parted = count_parted(layout);
            let (dual, forest) = (layout.dual, &layout.forest);
            let folds =
                (0..dual.face_count() as u32).filter(|&c| forest.parent_side[c as usize] != NONE);
            let best = folds.filter(|&c| parted[c as usize] > 0).max_by(|&a, &b| {
                let key = |c: u32| (!forest.must_keep(dual, c), parted[c as usize]);
                let cost = |c: u32| fold_cost(dual, forest, c);
                key(a).cmp(&key(b)).then(cost(b).total_cmp(&cost(a))).then(b.cmp(&a))
            });
            layout.split(best.expect("overlaps are parted by folds"));
        }
    }

    #[test]
    fn the_folds_open_that_comparing_all_would_open() {
        let mesh = crate::shape::random_tangent_polytope(400, 5);
        let dual = Dual::new(&mesh, &Seams::Free).expect("planar faces");
        let mut opened = 0;
        for seed in 0..12 {
            let mut rng = Rng::new(seed);
            let rule = Rule::of_turn(seed as usize, &mut rng);
            let start = forest(&dual, &mesh, rule, &mut rng);
            let mut fast = Layout::new(&dual, start, usize::MAX).expect("no limit");
            let mut slow = fast.clone();
            split_overlaps(&mut fast);
            split_by_comparing(&mut slow);
            assert_eq!(fast.forest.parent_side, slow.forest.parent_side, "seed {seed}");
            assert!(fast.overlaps.is_empty());
            opened += fast.forest.roots().len() - 1;
        }
        assert!(opened > 12, "{opened} folds opened: too few to tell");
    }
}
