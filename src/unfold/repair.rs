//! One net without overlaps, by moving branches.
//!
//! For a pair of faces that overlap, one of the folds on the path between them must go. Cutting one
//! leaves two parts; the smaller is hung on again by another edge of its boundary, and a move that
//! lessens the overlaps is kept. An edge that was cut may not fold again for a while (tabu list).
//! After Zawallich 2024 ("Unfolding polyhedra via tabu search"); here only the moved part is laid
//! and tested again, and it may also move to another piece.

use super::dual::NONE;
use super::forest::Forest;
use super::layout::{Layout, Motion};
use crate::progress::Progress;
use crate::random::Rng;

/// Folds of a path that one step tries to cut, those with the smallest parts.
const FOLDS: usize = 8;
/// Edges by which one step tries to hang on a part.
const HINGES: usize = 8;
/// Sides of a part that one step looks at for such edges: of a larger part a random choice.
const LOOKS: usize = 192;
/// What other work costs, as a share of laying a face: gathering a face of a part, keeping one of
/// the forest in order.
const GATHER: u64 = 16;
const REFRESH: u64 = 64;
/// Steps for which an edge that was cut stays open.
const TABU: u32 = 30;
/// How often a move that makes matters worse by one overlap is taken, to get out of dead ends.
const WORSE: f64 = 0.2;

/// A move that was tried: cut the fold above `cut`, hang the smaller part on by `side`.
struct Move {
    cut: u32,
    side: u32,
    motion: Motion,
    faces: Vec<u32>,
    found: Vec<(u32, u32)>,
    /// Overlaps won (negative: lost).
    gain: i64,
}

/// The search and its memory.
pub(super) struct Repair<'a> {
    layout: Layout<'a>,
    rng: Rng,
    /// Side → first step in which its edge may fold again.
    tabu: Vec<u32>,
    step: u32,
    /// Faces laid so far, in moves that were tried: the measure of effort, since time would not be
    /// repeatable.
    work: u64,
    path: Vec<u32>,
    faces: Vec<u32>,
    hinges: Vec<u32>,
    found: Vec<(u32, u32)>,
}

impl<'a> Repair<'a> {
    /// A search that starts from a layout.
    pub fn new(layout: Layout<'a>, seed: u64) -> Self {
        let tabu = vec![0; layout.dual.across.len()];
        Self {
            layout,
            rng: Rng::new(seed),
            tabu,
            step: 0,
            work: 0,
            path: Vec::new(),
            faces: Vec::new(),
            hinges: Vec::new(),
            found: Vec::new(),
        }
    }

    /// How many moves were looked for and how many faces were laid for them.
    pub fn effort(&self) -> (u32, u64) {
        (self.step, self.work)
    }

    /// Moves branches until no overlap is left, `budget` faces have been laid, or a quarter of that
    /// brought nothing better. Returns the best layout on the way.
    pub fn run(&mut self, budget: u64, progress: &dyn Progress) -> Layout<'a> {
        let start = self.layout.overlaps.len();
        let (mut low, mut low_work) = (start, 0);
        let mut best = self.layout.forest.parent_side.clone();
        let is_worth = |work: u64, low_work: u64| work < budget && work - low_work <= budget / 4;
        while !self.layout.overlaps.is_empty()
            && is_worth(self.work, low_work)
            && !progress.is_cancelled()
        {
            self.step();
            let overlaps = self.layout.overlaps.len();
            if overlaps < low {
                (low, low_work) = (overlaps, self.work);
                best.clone_from(&self.layout.forest.parent_side);
                progress.report("removing overlaps", start - low, start);
            }
        }
        if self.layout.overlaps.len() > low {
            let forest = Forest::new(self.layout.dual, best);
            return Layout::new(self.layout.dual, forest, usize::MAX)
                .expect("no limit, no giving up");
        }
        self.layout.clone()
    }

    fn step(&mut self) {
        self.step += 1;
        // A step that finds nothing to try counts too, so that the search ends.
        self.work += 1;
        let (f, g) = self.layout.overlaps[self.rng.below(self.layout.overlaps.len())];
        self.layout.forest.path(self.layout.dual, f, g, &mut self.path);
        let forest = &self.layout.forest;
        self.path.retain(|&c| !forest.must_keep(self.layout.dual, c));
        self.path.sort_by_key(|&c| forest.smaller_size(c));
        self.path.truncate(FOLDS);
        let mut best: Option<Move> = None;
        for i in 0..self.path.len() {
            self.try_cut(self.path[i], &mut best);
            if best.as_ref().is_some_and(|m| m.gain > 0) {
                break;
            }
        }
        if let Some(chosen) = best.filter(|m| m.gain >= 0 || self.rng.unit() < WORSE) {
            self.take(chosen);
        }
    }

    /// Tries to hang on the smaller part of the cut above `cut` by other edges; better moves
    /// replace `best`.
    fn try_cut(&mut self, cut: u32, best: &mut Option<Move>) {
        self.layout.forest.smaller_part(cut, &mut self.faces);
        self.work += self.faces.len() as u64 / GATHER;
        let before = self.layout.mark(&self.faces) as i64;
        self.gather_hinges(cut);
        for &side in &self.hinges {
            // One worse than now is worth a thought, after that only what beats the best so far.
            let Ok(limit) = usize::try_from(before - best.as_ref().map_or(-1, |m| m.gain + 1))
            else {
                return;
            };
            let motion = self.layout.motion(side);
            let piece = self.layout.piece[self.layout.dual.neighbour(side) as usize];
            self.work +=
                self.layout.try_motion(&self.faces, motion, piece, limit, &mut self.found) as u64;
            if self.found.len() > limit {
                continue;
            }
            let gain = before - self.found.len() as i64;
            *best = Some(Move {
                cut,
                side,
                motion,
                faces: self.faces.clone(),
                found: self.found.clone(),
                gain,
            });
            if gain > 0 {
                return;
            }
        }
    }

    /// Some sides of the marked part, on its boundary, by which it may be hung on.
    fn gather_hinges(&mut self, cut: u32) {
        let Self { layout, hinges, faces, tabu, step, rng, .. } = self;
        let dual = layout.dual;
        let above = layout.forest.parent_side[cut as usize];
        let is_open = |s: u32| {
            dual.hinge[s as usize] != NONE
                && !layout.is_marked(dual.neighbour(s))
                && s != above
                && dual.across[s as usize] != above
                && tabu[s as usize] <= *step
        };
        hinges.clear();
        if faces.len() * 3 <= LOOKS {
            hinges.extend(faces.iter().flat_map(|&f| dual.sides(f)).filter(|&s| is_open(s)));
            rng.shuffle_front(hinges, HINGES);
            return hinges.truncate(HINGES);
        }
        for _ in 0..LOOKS {
            let sides = dual.sides(faces[rng.below(faces.len())]);
            let side = sides.start + rng.below(sides.len()) as u32;
            if is_open(side) && !hinges.contains(&side) {
                hinges.push(side);
                if hinges.len() == HINGES {
                    return;
                }
            }
        }
    }

    fn take(&mut self, chosen: Move) {
        let dual = self.layout.dual;
        let opened = self.layout.forest.parent_side[chosen.cut as usize];
        for s in [opened, dual.across[opened as usize]] {
            self.tabu[s as usize] = self.step + TABU;
        }
        self.work += dual.face_count() as u64 / REFRESH;
        // Others may have been marked since the move was tried.
        self.layout.mark(&chosen.faces);
        self.layout.carry_out(&chosen.faces, chosen.cut, chosen.side, chosen.motion, &chosen.found);
    }
}
