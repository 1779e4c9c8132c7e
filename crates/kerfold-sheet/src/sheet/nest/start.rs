//! The first layout: one piece after the other, the largest first, each as far back on the first
//! sheet as a few hundred trials find room for it. Pieces of a group go onto one sheet.

use super::abut::abutting;
use super::collision_field::{CollisionField, Obstacle, Room, Spot};
use super::search::{Search, Trials, Turns};
use super::{Axis, Bin, CommonLine, NoPlace, Problem};
use crate::progress::Progress;
use crate::random::Rng;

/// The bins that have been opened, and which pieces fit in them.
pub(super) struct Bins<'p> {
    problem: &'p Problem,
    pub open: usize,
    /// For each piece, the bins in which it fits, ascending.
    pub of: Vec<Vec<usize>>,
}

impl<'p> Bins<'p> {
    pub fn new(problem: &'p Problem) -> Self {
        Self { problem, open: 0, of: vec![Vec::new(); problem.pieces.len()] }
    }

    pub fn stock(&self, bin: usize) -> usize {
        bin.min(self.problem.stock.len() - 1)
    }

    pub fn get(&self, bin: usize) -> &'p Bin {
        &self.problem.stock[self.stock(bin)]
    }

    /// Opens one more bin: the limited ones first, then the last as often as needed.
    pub fn open_next(&mut self, field: &mut CollisionField<'_>) {
        let stock = self.stock(self.open);
        let bin = self.get(self.open);
        let obstacles: Vec<Obstacle> = bin.obstacles.clone();
        field.add_bin(Room { low: bin.low, high: bin.high }, &obstacles);
        for (i, piece) in self.problem.pieces.iter().enumerate() {
            if piece.fits[stock] {
                self.of[i].push(self.open);
            }
        }
        self.open += 1;
    }
}

/// On so many sheets room is searched for one piece; tens of thousands of large panels take too
/// long otherwise.
const MOST_TRIED: usize = 24;

/// Lays out everything for the first time.
pub(super) struct Start<'s, 'f, 'a, 'p> {
    pub field: &'f mut CollisionField<'a>,
    pub rng: &'f mut Rng,
    pub bins: &'s mut Bins<'p>,
    /// Trials for one piece on one sheet.
    pub trials: usize,
    /// By how much, at most, the area of a piece counts for more than it is when the order is
    /// settled.
    pub shake: f64,
    pub progress: &'s dyn Progress,
}

impl Start<'_, '_, '_, '_> {
    /// Lays every piece somewhere without a collision.
    pub fn lay_all(&mut self) -> Result<(), NoPlace> {
        let units = self.units();
        let total = self.field.pieces;
        let mut done = 0;
        // The area of the smallest piece that found no room on a sheet: larger ones are not tried
        // any more.
        let mut refused: Vec<f64> = Vec::new();
        for unit in units {
            self.progress.report("nesting: first layout", done, total);
            if self.progress.is_cancelled() {
                self.trials = self.trials.min(8);
            }
            let area = self.field.shapes[unit[0]].area;
            let (mut bin, mut tried) = (0, 0);
            loop {
                if tried == MOST_TRIED {
                    // So many sheets have no room: only the newest is still likely to have some.
                    bin = bin.max(self.bins.open - 1);
                }
                let is_new = bin == self.bins.open;
                if is_new {
                    self.bins.open_next(self.field);
                    refused.push(f64::INFINITY);
                }
                if area < refused[bin] {
                    tried += 1;
                    if self.lay_unit(&unit, bin) {
                        break;
                    }
                }
                if is_new && self.bins.stock(bin) + 1 == self.bins.problem.stock.len() {
                    return Err(NoPlace { pieces: unit });
                }
                refused[bin] = refused[bin].min(area);
                bin += 1;
            }
            done += unit.len();
        }
        Ok(())
    }

    /// Groups and single pieces, the one with the largest piece first.
    fn units(&mut self) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.field.pieces).collect();
        let shapes = self.field.shapes;
        let (shake, rng) = (self.shake, &mut *self.rng);
        let mut area = |s: &super::shape::Shape| {
            if shake > 0.0 { s.area * (1.0 + shake * rng.unit()) } else { s.area }
        };
        let areas: Vec<f64> = shapes.iter().map(&mut area).collect();
        order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
        let pieces = &self.bins.problem.pieces;
        let mut units: Vec<Vec<usize>> = Vec::new();
        let mut place: std::collections::BTreeMap<usize, usize> = std::collections::BTreeMap::new();
        for i in order {
            match pieces[i].group {
                Some(group) if place.contains_key(&group) => units[place[&group]].push(i),
                Some(group) => {
                    place.insert(group, units.len());
                    units.push(vec![i]);
                }
                None => units.push(vec![i]),
            }
        }
        units
    }

    fn lay_unit(&mut self, unit: &[usize], bin: usize) -> bool {
        for (k, &i) in unit.iter().enumerate() {
            let fits = self.bins.of[i].binary_search(&bin).is_ok();
            let spot = if fits { self.lowest(i, bin) } else { None };
            let Some(spot) = spot else {
                unit[..k].iter().for_each(|&j| self.field.take(j));
                return false;
            };
            self.field.put(i, spot);
        }
        true
    }

    /// The place furthest back that is found, without a collision.
    fn lowest(&mut self, i: usize, bin: usize) -> Option<Spot> {
        let problem = self.bins.problem;
        let turns = &problem.pieces[i].turns;
        let axis = self.bins.get(bin).axis();
        if problem.common_line == CommonLine::On
            && let Some(spot) = abutting(self.field, turns, axis, (i, bin))
        {
            return Some(spot);
        }
        let only = [bin];
        let search = Search::new(self.field, self.rng, turns, &only, i);
        let mut lowest = Lowest { search, axis, best: None };
        lowest.try_corners(turns, bin);
        lowest.try_anywhere(self.trials, bin);
        if lowest.best.is_none() {
            lowest.escape(self.trials);
        }
        lowest.settled()
    }
}

/// The search for the place furthest back.
struct Lowest<'f, 'a> {
    search: Search<'f, 'a>,
    axis: Axis,
    best: Option<Candidate>,
}

/// A free place, and how far from the back it is.
#[derive(Clone, Copy)]
struct Candidate {
    far: f64,
    spot: Spot,
}

impl Lowest<'_, '_> {
    /// Keeps a place that is better than the best so far; says whether it is.
    fn offer(&mut self, spot: Spot) -> bool {
        let Some(spot) = self.search.inside(spot) else { return false };
        // This is cheap to know before anything is measured.
        let high = spot.at + self.search.high();
        let far = self.axis.of(high) + 0.05 * self.axis.across(high);
        let is_better = self.best.is_none_or(|best| far < best.far) && self.search.is_free(spot);
        if is_better {
            self.best = Some(Candidate { far, spot });
        }
        is_better
    }

    /// As far back as the bin goes, at the angles that are usual.
    fn try_corners(&mut self, turns: &Turns, bin: usize) {
        let (home, all): (f64, Vec<f64>) = match turns {
            Turns::Free { home } => (*home, (0..4).map(|k| home + 90.0 * f64::from(k)).collect()),
            Turns::Some(angles) => (angles[0], angles.clone()),
        };
        for angle in all.into_iter().chain([home]) {
            self.offer(Spot { bin, at: glam::DVec2::NEG_INFINITY, angle });
        }
    }

    /// Anywhere, and in the holes of pieces that lie already.
    fn try_anywhere(&mut self, trials: usize, bin: usize) {
        for _ in 0..trials {
            let spot = self.search.anywhere();
            self.offer(spot);
        }
        for (low, high) in self.search.holes(bin) {
            for _ in 0..4 {
                let spot = self.search.within(bin, low, high);
                self.offer(spot);
            }
        }
    }

    /// Nothing by luck: from the least bad places step by step.
    fn escape(&mut self, trials: usize) {
        let many = Trials { anywhere: trials / 2 + 4, near: 0 };
        let found = self.search.best(many, None, f64::INFINITY).filter(|f| f.loss == 0.0);
        self.best = found.map(|found| Candidate { far: f64::INFINITY, spot: found.spot });
    }

    /// The best place, pushed back as far as it goes.
    fn settled(mut self) -> Option<Spot> {
        let mut spot = self.best?.spot;
        let (axis, other) = (self.axis.unit(), self.axis.other().unit());
        let diameter = self.search.field.shapes[self.search.piece].diameter;
        let mut step = diameter;
        while step > 1e-3 * diameter {
            let moved = [axis + other, axis, other]
                .into_iter()
                .any(|way| self.offer(Spot { at: spot.at - way * step, ..spot }));
            match self.best {
                Some(better) if moved => spot = better.spot,
                _ => step *= 0.5,
            }
        }
        Some(spot)
    }
}
