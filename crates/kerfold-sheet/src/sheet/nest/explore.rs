//! From a first layout to a better one: the last sheet is made shorter and shorter, and after every
//! step all pieces of all sheets are separated again.

use std::collections::BTreeMap;

use glam::DVec2;

use super::super::layout::Turn;
use super::Lying;
use super::collision_field::{CollisionField, Room, Spot};
use super::search::{Search, Trials, Turns};
use super::separate::{End, Patience, Rules, restore, separate};
use super::start::Bins;
use crate::progress::Progress;
use crate::random::Rng;

/// A layout without collisions.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub spots: Vec<Spot>,
    /// Number of bins in use.
    pub bins: usize,
    /// How much of the last one is in use, along its axis.
    pub used: f64,
}

/// Steps as parts of a bin.
const FIRST_STEP: f64 = 0.01;
const MANY_STEP: f64 = 0.04;
const LAST_STEP: f64 = 5e-4;
/// Above this number of pieces a round takes so long that fewer are made.
const MANY: usize = 400;
/// With few pieces, so many failures in a row mean that there is nothing more to find.
const MOST_FAILS: usize = 40;

pub(super) struct Explore<'e, 'f, 'a, 'p> {
    pub field: &'f mut CollisionField<'a>,
    pub rng: &'f mut Rng,
    pub bins: &'e mut Bins<'p>,
    pub turns: &'e [Turns],
    pub groups: &'e [Option<usize>],
    /// Work at which everything ends.
    pub work: u64,
    pub progress: &'e dyn Progress,
}

impl Explore<'_, '_, '_, '_> {
    /// The field as it is, without collisions, as a layout; empty bins at the end do not count.
    pub fn layout(&self) -> Layout {
        let bins =
            self.field.spots[..self.field.pieces].iter().map(|s| s.bin + 1).max().unwrap_or(0);
        let mut used: f64 = 0.0;
        if let Some(last) = bins.checked_sub(1) {
            let axis = self.bins.get(last).axis();
            for i in (0..self.field.pieces).filter(|&i| self.field.spots[i].bin == last) {
                used = used.max(axis.of(self.field.spots[i].at + self.field.posed[i].high));
            }
            used -= axis.of(self.bins.get(last).low);
        }
        Layout { spots: self.field.spots[..self.field.pieces].to_vec(), bins, used }
    }

    /// The layout with the pieces where they are said to lie.
    pub fn given(&mut self, lying: &[Lying]) -> Layout {
        while lying.iter().any(|l| l.bin >= self.bins.open) {
            self.bins.open_next(self.field);
        }
        for (i, l) in lying.iter().enumerate() {
            let at = l.at + Turn::degrees(l.angle).apply(self.field.shapes[i].origin);
            self.field.put(i, Spot { bin: l.bin, at, angle: l.angle });
        }
        self.layout()
    }

    /// Improves a layout for as long as there is work left.
    pub fn run(&mut self, first: Layout) -> Layout {
        let mut best = first;
        let start = self.field.work;
        let total = self.work.saturating_sub(start).max(1);
        let most = if self.field.pieces > MANY { MANY_STEP } else { FIRST_STEP };
        let mut step = most;
        let mut fails = 0_usize;
        while best.bins > 0 && self.field.work < self.work && !self.progress.is_cancelled() {
            let done = 100 * (self.field.work - start) / total;
            self.progress.report("nesting: per cent of the effort", done as usize, 100);
            // A round costs something even where no two pieces come near each other.
            self.field.work += self.field.pieces as u64;
            restore(self.field, &best.spots);
            self.field.forget();
            let Some(shorter) = self.shorter(&best, step) else { break };
            if fails > 0 {
                self.disturb(shorter.0);
            }
            let end = self.separate(shorter.0);
            // A piece that fits at few angles only may stick out of the shortened sheet, apart from
            // all others.
            let is_better = end == End::Apart && self.is_inside();
            let better = is_better
                .then(|| self.layout())
                .filter(|l| (l.bins, l.used) < (best.bins, best.used));
            match (end, better) {
                (_, Some(better)) => {
                    best = better;
                    fails = 0;
                    step = (step * 1.2).min(most);
                }
                (End::OutOfWork, None) => break,
                (End::Apart | End::Stuck, None) => {
                    fails += 1;
                    if fails >= MOST_FAILS && self.field.pieces < 20 {
                        break;
                    }
                    step = (step * 0.5).max(LAST_STEP);
                }
            }
        }
        restore(self.field, &best.spots);
        if self.field.pieces <= MANY && best.bins > 0 {
            best = self.settled(best);
        }
        self.full(best.bins);
        best
    }

    /// Whether every piece lies inside its sheet, as far as that is open.
    fn is_inside(&self) -> bool {
        (0..self.field.pieces).all(|i| {
            let spot = self.field.spots[i];
            let room = &self.field.rooms[spot.bin];
            let slack = 1e-9 * (room.high - room.low).length();
            let (low, high) = self.field.range(&self.field.posed[i], spot.bin);
            (low - spot.at).max_element() <= slack && (spot.at - high).max_element() <= slack
        })
    }

    /// Lays pieces straight where there is room for it, and moves them together; no sheet gets
    /// longer by that.
    fn settled(&mut self, best: Layout) -> Layout {
        let last = best.bins - 1;
        self.full(best.bins);
        let stock = self.bins.get(last);
        let axis = stock.axis();
        self.field.rooms[last].high = axis.with(stock.high, axis.of(stock.low) + best.used);
        // What is nearest to the corner moves first and makes room for the rest.
        let mut order: Vec<usize> = (0..self.field.pieces).collect();
        let key = |s: &Spot| axis.of(s.at) + axis.across(s.at);
        order.sort_by(|&a, &b| key(&best.spots[a]).total_cmp(&key(&best.spots[b])).then(a.cmp(&b)));
        for _ in 0..2 {
            for &i in &order {
                self.settle(i);
            }
        }
        let settled = self.layout();
        // Given boxes may lack some distance by rounding; then what was given stays.
        if self.field.collisions().is_empty() { settled } else { best }
    }

    fn settle(&mut self, i: usize) {
        let mut spot = self.field.spots[i];
        let only = [spot.bin];
        if let Turns::Free { home } = self.turns[i] {
            let quarters = ((spot.angle - home) / 90.0).round();
            let straight = Turns::Some(vec![home + 90.0 * quarters]);
            let trials = Trials { anywhere: 0, near: 8 };
            let is_straight = spot.angle == home + 90.0 * quarters;
            let mut search = Search::new(self.field, self.rng, &straight, &only, i);
            let here = Spot { angle: home + 90.0 * quarters, ..spot };
            let found =
                if is_straight { None } else { search.best(trials, Some(here), f64::INFINITY) };
            if let Some(found) = found.filter(|f| f.loss == 0.0 && search.is_free(f.spot)) {
                spot = found.spot;
                self.field.put(i, spot);
            }
        }
        let axis = self.bins.get(spot.bin).axis();
        let mut step = self.field.shapes[i].diameter;
        let least = 1e-4 * step;
        let mut search = Search::new(self.field, self.rng, &self.turns[i], &only, i);
        while step > least {
            let moved = [axis.unit(), axis.other().unit()].into_iter().find_map(|way| {
                let to = search.inside(Spot { at: spot.at - way * step, ..spot })?;
                (to.at != spot.at && search.is_free(to)).then_some(to)
            });
            match moved {
                Some(to) => spot = to,
                None => step *= 0.5,
            }
        }
        self.field.put(i, spot);
    }

    /// Opens the last bins to their full size.
    fn full(&mut self, open: usize) {
        for bin in 0..open {
            let stock = self.bins.get(bin);
            self.field.rooms[bin] = Room { low: stock.low, high: stock.high };
        }
    }

    /// Closes the last bin, or makes it shorter. Nothing when that cannot be: one bin with pieces
    /// as long as it is.
    fn shorter(&mut self, best: &Layout, step: f64) -> Option<(usize, f64)> {
        let last = best.bins - 1;
        let stock = self.bins.get(last);
        let axis = stock.axis();
        let length = axis.of(stock.high - stock.low);
        let used = best.used - step * length;
        let here: Vec<usize> =
            (0..self.field.pieces).filter(|&i| best.spots[i].bin == last).collect();
        let least = here.iter().map(|&i| self.least(i, axis)).fold(0.0, f64::max);
        self.full(best.bins);
        if used > least {
            self.field.rooms[last].high = axis.with(stock.high, axis.of(stock.low) + used);
            here.into_iter().for_each(|i| self.push_in(i, last));
            Some((best.bins, used))
        } else if last > 0 && self.empty_last(here, last) {
            Some((last, length))
        } else {
            None
        }
    }

    /// Brings a piece into its bin, which became shorter.
    fn push_in(&mut self, i: usize, bin: usize) {
        let spot = self.field.spots[i];
        let (low, high) = self.field.range(&self.field.posed[i], bin);
        if (low - high).max_element() > 0.0 {
            // What belongs to a group stays with it.
            match self.groups[i] {
                Some(_) => self.relocate_to(i, &[bin]),
                None => self.relocate(i, bin + 1),
            }
        } else if spot.at.cmpgt(high).any() {
            self.field.put(i, Spot { at: spot.at.min(high).max(low), ..spot });
        }
    }

    /// Moves the pieces of the last bin to those before it, the largest first and groups together;
    /// says whether all could be.
    fn empty_last(&mut self, mut pieces: Vec<usize>, last: usize) -> bool {
        pieces.sort_by(|&a, &b| {
            self.field.shapes[b].area.total_cmp(&self.field.shapes[a].area).then(a.cmp(&b))
        });
        for &i in &pieces {
            self.field.take(i);
        }
        let mut group_bin: BTreeMap<usize, usize> = BTreeMap::new();
        for i in pieces {
            if self.bins.of[i].first().is_none_or(|&b| b >= last) {
                return false;
            }
            match self.groups[i] {
                None => self.relocate(i, last),
                Some(group) => {
                    let to = *group_bin.entry(group).or_insert_with(|| self.rng.below(last));
                    if self.bins.of[i].binary_search(&to).is_err() {
                        return false;
                    }
                    self.relocate_to(i, &[to]);
                }
            }
        }
        true
    }

    /// A bound on how short a bin may be for a piece: its least extent at the angles that are
    /// allowed.
    fn least(&self, i: usize, axis: super::Axis) -> f64 {
        let mut posed = super::shape::Posed::default();
        let angles: Vec<f64> = match &self.turns[i] {
            Turns::Free { home } => (0..36).map(|k| home + 5.0 * f64::from(k)).collect(),
            Turns::Some(angles) => angles.clone(),
        };
        let extents = angles.into_iter().map(|angle| {
            posed.turn(&self.field.shapes[i], angle);
            axis.of(posed.high - posed.low)
        });
        extents.fold(f64::INFINITY, f64::min)
    }

    fn relocate(&mut self, i: usize, open: usize) {
        let bins = &self.bins.of[i];
        let bins = bins[..bins.partition_point(|&b| b < open)].to_vec();
        self.relocate_to(i, &bins);
    }

    /// Puts a piece where it is least in the way.
    fn relocate_to(&mut self, i: usize, bins: &[usize]) {
        let mut search = Search::new(self.field, self.rng, &self.turns[i], bins, i);
        let trials = Trials { anywhere: 30, near: 0 };
        let found = search.best(trials, None, f64::INFINITY);
        if let Some(found) = found {
            self.field.put(i, found.spot);
        } else if !self.field.is_in(i) {
            // Where it fits at few angles only, it is left where it was said to fit.
            let bin = bins[0];
            let angle = match &self.turns[i] {
                Turns::Free { home } => *home,
                Turns::Some(angles) => angles[0],
            };
            self.field.put(i, Spot { bin, at: DVec2::ZERO, angle });
            let (low, high) = self.field.range(&self.field.posed[i], bin);
            self.field.put(i, Spot { bin, at: low.midpoint(high), angle });
        }
    }

    /// Exchanges two large pieces, so that a field that got stuck gets another chance.
    fn disturb(&mut self, open: usize) {
        let n = self.field.pieces;
        if n < 3 {
            return;
        }
        let mut order: Vec<usize> = (0..n).filter(|&i| self.groups[i].is_none()).collect();
        if order.len() < 3 {
            return;
        }
        order.sort_by(|&a, &b| {
            self.field.shapes[b].area.total_cmp(&self.field.shapes[a].area).then(a.cmp(&b))
        });
        let large = (order.len() / 2).max(2);
        let (i, j) = (order[self.rng.below(large)], order[self.rng.below(large)]);
        let (a, b) = (self.field.spots[i], self.field.spots[j]);
        for (k, to) in [(i, b), (j, a)] {
            if to.bin >= open || self.bins.of[k].binary_search(&to.bin).is_err() {
                continue;
            }
            let angle = self.field.spots[k].angle;
            self.field.put(k, Spot { angle, ..to });
            let (low, high) = self.field.range(&self.field.posed[k], to.bin);
            if (low - high).max_element() > 0.0 {
                self.relocate(k, open);
            } else {
                self.field.put(k, Spot { at: to.at.clamp(low, high), bin: to.bin, angle });
            }
        }
    }

    fn separate(&mut self, open: usize) -> End {
        let rules = Rules {
            turns: self.turns,
            groups: self.groups,
            bins: &self.bins.of,
            open,
            trials: Trials { anywhere: 16, near: 8 },
        };
        let many = self.field.pieces > MANY;
        let patience = Patience { rounds: if many { 20 } else { 80 }, strikes: 2, work: self.work };
        let progress = self.progress;
        separate(self.field, &rules, self.rng, patience, &|| progress.is_cancelled())
    }
}
