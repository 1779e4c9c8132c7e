//! Layouts of pieces that lie side to side.
//!
//! Moving pieces apart, as the usual search does, would lose the touch; instead everything is laid
//! again and again in other orders while there is work left, and the best layout is kept.

use super::collision_field::{CollisionField, Spot};
use super::start::{Bins, Start};
use super::{Effort, NoPlace, Problem};
use crate::progress::Progress;
use crate::random::Rng;

/// How much an area may count for more than it is, when the order is changed.
const SHAKE: f64 = 0.5;

/// A layout in which pieces touch.
pub(super) struct Abutting {
    pub spots: Vec<Spot>,
    /// Bins in use, and how much of the last one.
    bins: usize,
    used: f64,
}

/// Lays everything side to side, in several orders.
pub(super) fn lay_abutting(
    (problem, shapes): (&Problem, &[super::shape::Shape]),
    effort: Effort,
    progress: &dyn Progress,
) -> Result<Vec<Spot>, NoPlace> {
    let mut best: Option<Abutting> = None;
    let mut rng = Rng::new(effort.seed);
    let mut work = 0;
    loop {
        let mut field = CollisionField::new(shapes, problem.spacing);
        let mut bins = Bins::new(problem);
        let shake = if best.is_some() { SHAKE } else { 0.0 };
        let mut start = Start {
            field: &mut field,
            rng: &mut rng,
            bins: &mut bins,
            trials: 60,
            shake,
            progress,
        };
        match (start.lay_all(), &best) {
            (Err(no_place), None) => return Err(no_place),
            (Err(_), Some(_)) => {}
            (Ok(()), _) => {
                let found = laid(&field, &bins);
                if best.as_ref().is_none_or(|b| (found.bins, found.used) < (b.bins, b.used)) {
                    best = Some(found);
                }
            }
        }
        work += field.work;
        progress.report(
            "nesting: per cent of the effort",
            (100 * work / effort.work.max(1)).min(100) as usize,
            100,
        );
        if work >= effort.work || progress.is_cancelled() {
            return Ok(best.map(|b| b.spots).unwrap_or_default());
        }
    }
}

fn laid(field: &CollisionField<'_>, bins: &Bins<'_>) -> Abutting {
    let spots = field.spots[..field.pieces].to_vec();
    let count = spots.iter().map(|s| s.bin + 1).max().unwrap_or(0);
    let mut used: f64 = 0.0;
    for (i, spot) in spots.iter().enumerate().filter(|(_, s)| s.bin + 1 == count) {
        let bin = bins.get(spot.bin);
        used = used.max(bin.axis().of(spot.at + field.posed[i].high - bin.low));
    }
    Abutting { spots, bins: count, used }
}
