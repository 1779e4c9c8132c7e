//! Separation: pieces that are too near are moved one by one to where they are less so, and pairs
//! that stay too near weigh more and more, until all keep their distance or nothing improves any
//! more.
//!
//! Sources: guided local search (Voudouris and Tsang 1999) for nesting after Egeblad, Nielsen and
//! Odgaard 2007 and Umetani et al. 2009; the order of moves, the weights and the strikes as
//! Gardeyn, Vanden Berghe and Wauters 2025 describe them.

use super::collision_field::{CollisionField, Spot};
use super::search::{Search, Trials, Turns};
use crate::random::Rng;

/// When separating is given up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patience {
    /// Rounds without a better sum before a strike.
    pub rounds: usize,
    /// Strikes before the end.
    pub strikes: usize,
    /// Work, as the field counts it, at which everything ends.
    pub work: u64,
}

/// How separating ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// All keep their distance.
    Apart,
    /// Nothing improved any more; the field is left as it was at the best sum.
    Stuck,
    /// The work is used up.
    OutOfWork,
}

/// What is the same for all moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules<'r> {
    pub turns: &'r [Turns],
    /// For each piece, its group, if it must share a sheet with others.
    pub groups: &'r [Option<usize>],
    /// For each piece, the bins in which it fits.
    pub bins: &'r [Vec<usize>],
    /// Bins from this one on are closed.
    pub open: usize,
    pub trials: Trials,
}

impl<'r> Rules<'r> {
    /// The open bins in which a piece fits.
    pub fn open_to(&self, i: usize) -> &'r [usize] {
        let bins = &self.bins[i];
        &bins[..bins.partition_point(|&b| b < self.open)]
    }
}

/// Moves pieces until all keep their distance.
pub(super) fn separate(
    field: &mut CollisionField<'_>,
    rules: &Rules<'_>,
    rng: &mut Rng,
    patience: Patience,
    stop: &dyn Fn() -> bool,
) -> End {
    let mut collisions = field.collisions();
    let mut best = (sum(&collisions), field.spots.clone());
    let mut strikes = 0;
    loop {
        let (mut quiet, before) = (0, best.0);
        while quiet < patience.rounds {
            if collisions.is_empty() {
                return End::Apart;
            }
            if field.work >= patience.work || stop() {
                restore(field, &best.1);
                return End::OutOfWork;
            }
            round(field, rules, rng, &collisions);
            collisions = field.collisions();
            field.reweigh(&collisions);
            let now = sum(&collisions);
            quiet = if now < 0.98 * best.0 { 0 } else { quiet + 1 };
            if now < best.0 {
                best = (now, field.spots.clone());
            }
        }
        strikes = if best.0 < 0.98 * before { 0 } else { strikes + 1 };
        restore(field, &best.1);
        if strikes >= patience.strikes {
            return End::Stuck;
        }
        collisions = field.collisions();
    }
}

fn sum(collisions: &[(u32, u32, f64)]) -> f64 {
    collisions.iter().map(|c| c.2).sum()
}

/// Puts every piece back to where it was.
pub(super) fn restore(field: &mut CollisionField<'_>, spots: &[Spot]) {
    for (i, &spot) in spots.iter().enumerate().take(field.pieces) {
        if field.spots[i] != spot || !field.is_in(i) {
            field.put(i, spot);
        }
    }
}

/// Moves every piece that is too near to another once, in random order.
fn round(
    field: &mut CollisionField<'_>,
    rules: &Rules<'_>,
    rng: &mut Rng,
    collisions: &[(u32, u32, f64)],
) {
    let mut is_hit = vec![false; field.spots.len()];
    collisions
        .iter()
        .for_each(|&(a, b, _)| (is_hit[a as usize], is_hit[b as usize]) = (true, true));
    let mut order: Vec<usize> = (0..field.pieces).filter(|&i| is_hit[i]).collect();
    rng.shuffle(&mut order);
    for i in order {
        let loss = field.loss_here(i);
        if loss == 0.0 {
            continue;
        }
        let here = field.spots[i];
        // What belongs to a group stays on the sheet of the group.
        let only = [here.bin];
        let bins: &[usize] = if rules.groups[i].is_some() { &only } else { rules.open_to(i) };
        let mut search = Search::new(field, rng, &rules.turns[i], bins, i);
        if let Some(found) = search.best(rules.trials, Some(here), loss) {
            field.put(i, found.spot);
        }
    }
}
