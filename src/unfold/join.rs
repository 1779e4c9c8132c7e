//! Fewer pieces: a small piece is hung on another although a few faces overlap there, and the
//! overlaps are repaired.

use super::dual::NONE;
use super::layout::Layout;
use super::repair::Repair;
use crate::progress::Progress;
use crate::random::Rng;

/// Edges by which one try hangs on a piece; the one with the fewest overlaps is taken.
const HINGES: usize = 24;
/// Overlaps that are worth repairing.
const OVERLAPS: usize = 40;
/// How often each piece is tried before the search gives up.
const TURNS: usize = 40;
/// What one repair may cost, in times that every face is laid.
const REPAIR: u64 = 12;

/// The search with its best layout, which never has overlaps.
pub(super) struct Joiner<'a> {
    /// The layout with the fewest pieces so far.
    pub layout: Layout<'a>,
    /// Joins that were tried.
    pub joins: usize,
    /// Moves that their repairs looked for.
    pub moves: u64,
    rng: Rng,
    budget: u64,
}

impl<'a> Joiner<'a> {
    /// A search from a layout without overlaps that lays at most about `budget` faces.
    pub fn new(layout: Layout<'a>, rng: &mut Rng, budget: u64) -> Self {
        Self { layout, joins: 0, moves: 0, rng: Rng::new(rng.bits()), budget }
    }

    /// Joins pieces until there are as few as can be, every one was tried `TURNS` times in vain, or
    /// the budget is spent. Small pieces come first, then by turns. Returns how many faces were
    /// laid.
    pub fn run(&mut self, progress: &dyn Progress) -> u64 {
        let least = self.layout.dual.least_pieces();
        let (start, mut turn) = (self.budget, 0);
        loop {
            let mut roots = self.layout.forest.roots();
            let is_stuck = roots.len() <= least || turn >= TURNS * (roots.len() - 1);
            if is_stuck || self.budget == 0 || progress.is_cancelled() {
                return start - self.budget;
            }
            roots.sort_by_key(|&root| self.layout.forest.size(root));
            progress.report("joining pieces", self.joins, 0);
            // The larger of two pieces never needs to move.
            if self.try_join(roots[turn % (roots.len() - 1)], progress) {
                turn = 0;
            } else {
                turn += 1;
            }
        }
    }

    /// Hangs the piece of `root` on another and repairs; goes back when overlaps are left.
    fn try_join(&mut self, root: u32, progress: &dyn Progress) -> bool {
        self.joins += 1;
        self.budget = self.budget.saturating_sub(1);
        let Some(joined) = self.joined(root) else { return false };
        let limit = self.budget.min(REPAIR * joined.dual.face_count() as u64);
        let mut repair = Repair::new(joined, self.rng.bits());
        let repaired = repair.run(limit, progress);
        let (moves, work) = repair.effort();
        self.moves += u64::from(moves);
        self.budget = self.budget.saturating_sub(work);
        let is_flat = repaired.overlaps.is_empty();
        if is_flat {
            self.layout = repaired;
        }
        is_flat
    }

    /// The layout with the piece of `root` hung on another by the best of some edges.
    fn joined(&mut self, root: u32) -> Option<Layout<'a>> {
        let mut layout = self.layout.clone();
        let dual = layout.dual;
        let faces = layout.forest.subtree(root).to_vec();
        layout.mark(&faces);
        let leads_out =
            |&s: &u32| dual.hinge[s as usize] != NONE && !layout.is_marked(dual.neighbour(s));
        let mut hinges: Vec<u32> =
            faces.iter().flat_map(|&f| dual.sides(f)).filter(leads_out).collect();
        self.rng.shuffle_front(&mut hinges, HINGES);
        let (mut best, mut limit, mut found) = (None, OVERLAPS, Vec::new());
        for &s in hinges.iter().take(HINGES) {
            let motion = layout.motion(s);
            let piece = layout.piece[dual.neighbour(s) as usize];
            let work = layout.try_motion(&faces, motion, piece, limit, &mut found);
            self.budget = self.budget.saturating_sub(work as u64);
            if found.len() <= limit {
                limit = found.len().saturating_sub(1);
                best = Some((s, motion, found.clone()));
                if found.is_empty() {
                    break;
                }
            }
        }
        let (s, motion, found) = best?;
        layout.carry_out(&faces, NONE, s, motion, &found);
        Some(layout)
    }
}
