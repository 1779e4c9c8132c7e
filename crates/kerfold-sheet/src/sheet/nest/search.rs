//! A better place for one piece: places at random, near and far, the best of them improved step by
//! step.

use glam::DVec2;

use super::collision_field::{CollisionField, Spot};
use super::shape::Posed;
use crate::random::Rng;

/// At which angles a piece may lie.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Turns {
    /// At all. `home` is an angle at which it is known to fit, where not all are.
    Free { home: f64 },
    /// At these, in degrees.
    Some(Vec<f64>),
}

impl Turns {
    fn any(&self, rng: &mut Rng) -> f64 {
        match self {
            // One in eight lies as it is known to fit.
            Self::Free { home } if rng.below(8) == 0 => *home + 90.0 * rng.below(4) as f64,
            Self::Free { .. } => 360.0 * rng.unit(),
            Self::Some(angles) => angles[rng.below(angles.len())],
        }
    }

    fn near(&self, angle: f64, rng: &mut Rng) -> f64 {
        match self {
            Self::Free { .. } => angle + 15.0 * rng.near_zero(),
            Self::Some(_) if rng.below(2) == 0 => angle,
            Self::Some(_) => self.any(rng),
        }
    }
}

/// A place with its loss.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub spot: Spot,
    pub loss: f64,
}

/// How much is tried for one piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trials {
    pub anywhere: usize,
    pub near: usize,
}

/// How many places are improved.
const KEPT: usize = 3;

/// Looks for places of one piece in the bins that are open to it.
pub(super) struct Search<'f, 'a> {
    pub field: &'f mut CollisionField<'a>,
    pub rng: &'f mut Rng,
    pub turns: &'f Turns,
    /// The bins in which it may lie.
    pub bins: &'f [usize],
    pub piece: usize,
    /// The piece as it is turned now; its parts only once they are measured.
    scratch: Posed,
    is_posed: bool,
}

impl<'f, 'a> Search<'f, 'a> {
    pub fn new(
        field: &'f mut CollisionField<'a>,
        rng: &'f mut Rng,
        turns: &'f Turns,
        bins: &'f [usize],
        piece: usize,
    ) -> Self {
        Self { field, rng, turns, bins, piece, scratch: Posed::default(), is_posed: false }
    }

    fn pose(&mut self, angle: f64) {
        if !self.is_posed || self.scratch.angle != angle {
            self.is_posed = true;
            self.field.work += self.scratch.turn_box(&self.field.shapes[self.piece], angle);
        }
    }

    /// The loss of the piece as it is turned now.
    fn measure(&mut self, spot: Spot, most: f64) -> f64 {
        self.field.work += self.scratch.turn_parts(&self.field.shapes[self.piece]);
        self.field.loss(self.piece, &self.scratch, spot.bin, spot.at, most)
    }

    /// The upper right corner of the box of the piece as it is turned now.
    pub fn high(&self) -> DVec2 {
        self.scratch.high
    }

    /// Whether a place inside its bin is free.
    pub fn is_free(&mut self, spot: Spot) -> bool {
        self.pose(spot.angle);
        self.measure(spot, f64::MIN_POSITIVE) == 0.0
    }

    /// Where the holes of pieces in a bin are, large enough for this piece to think of.
    pub fn holes(&self, bin: usize) -> Vec<(DVec2, DVec2)> {
        let area = self.field.shapes[self.piece].area;
        self.field
            .holes(bin)
            .filter(|(low, high)| (high.x - low.x) * (high.y - low.y) > area)
            .collect()
    }

    /// A place at random with the box of the piece inside a box, if it is not too large.
    pub fn within(&mut self, bin: usize, low: DVec2, high: DVec2) -> Spot {
        let angle = self.turns.any(self.rng);
        self.pose(angle);
        let at = self.rng.point(low - self.scratch.low, high - self.scratch.high);
        Spot { bin, at, angle }
    }

    /// The place moved into its bin; none where the piece is larger than the bin.
    pub fn inside(&mut self, mut spot: Spot) -> Option<Spot> {
        self.pose(spot.angle);
        let (low, high) = self.field.range(&self.scratch, spot.bin);
        // What fits exactly may be larger by rounding.
        let slack =
            1e-9 * (self.field.rooms[spot.bin].high - self.field.rooms[spot.bin].low).length();
        if (low - high).max_element() > slack {
            return None;
        }
        spot.at = spot.at.min(high).max(low.min(high));
        Some(spot)
    }

    /// The loss at a place, which is moved into its bin.
    fn try_at(&mut self, spot: Spot, most: f64) -> Option<Found> {
        let spot = self.inside(spot)?;
        let loss = self.measure(spot, most);
        (loss < most).then_some(Found { spot, loss })
    }

    /// The place of least loss that is found, and below `most`.
    pub fn best(&mut self, trials: Trials, here: Option<Spot>, most: f64) -> Option<Found> {
        let mut kept: Vec<Found> = Vec::with_capacity(KEPT + 1);
        let diameter = self.field.shapes[self.piece].diameter;
        let offer = |kept: &mut Vec<Found>, found: Found| {
            let at = kept.partition_point(|k| k.loss <= found.loss);
            kept.insert(at, found);
            kept.truncate(KEPT);
        };
        let worst = |kept: &Vec<Found>| {
            if kept.len() == KEPT { kept[KEPT - 1].loss } else { f64::INFINITY }
        };
        if let Some(spot) = here {
            offer(&mut kept, Found { spot, loss: most });
            for _ in 0..trials.near {
                let angle = self.turns.near(spot.angle, self.rng);
                let by = DVec2::new(self.rng.near_zero(), self.rng.near_zero()) * (0.25 * diameter);
                if let Some(found) =
                    self.try_at(Spot { at: spot.at + by, angle, ..spot }, worst(&kept))
                {
                    offer(&mut kept, found);
                }
            }
        }
        for _ in 0..trials.anywhere {
            let spot = self.anywhere();
            if let Some(found) = self.try_at(spot, worst(&kept)) {
                offer(&mut kept, found);
            }
            if kept.first().is_some_and(|k| k.loss == 0.0) {
                break;
            }
        }
        let mut best: Option<Found> = None;
        for found in kept {
            let found = self.improved(found, 0.1 * diameter, 2e-3 * diameter);
            if best.is_none_or(|b| found.loss < b.loss) {
                best = Some(found);
            }
        }
        let best = best?;
        let best = if best.loss > 0.0 {
            self.improved(best, 2e-3 * diameter, 2e-5 * diameter)
        } else {
            best
        };
        (best.loss < most).then_some(best)
    }

    /// A place at random.
    pub fn anywhere(&mut self) -> Spot {
        let bin = self.bins[self.rng.below(self.bins.len())];
        let angle = self.turns.any(self.rng);
        self.pose(angle);
        let (low, high) = self.field.range(&self.scratch, bin);
        Spot { bin, at: self.rng.point(low, high), angle }
    }

    /// Steps along a random line or about the middle, longer after a success and shorter after
    /// none, until they are shorter than `last`.
    fn improved(&mut self, mut found: Found, first: f64, last: f64) -> Found {
        const LONGER: f64 = 1.3;
        const SHORTER: f64 = 0.5;
        let mut step = first;
        let diameter = self.field.shapes[self.piece].diameter;
        let free = matches!(self.turns, Turns::Free { .. });
        // A turn that moves the rim by about a step.
        let degrees = (2.0 / diameter).to_degrees();
        while step > last && found.loss > 0.0 {
            let way = self.rng.below(if free { 6 } else { 4 });
            let (by, turn) = match way {
                0 => (DVec2::X, 0.0),
                1 => (DVec2::Y, 0.0),
                2 => (DVec2::ONE * 0.707, 0.0),
                3 => (DVec2::new(0.707, -0.707), 0.0),
                _ => (DVec2::ZERO, degrees),
            };
            let mut better = false;
            for sign in [1.0, -1.0] {
                let Found { spot, loss } = found;
                let to = Spot {
                    at: spot.at + by * (step * sign),
                    angle: spot.angle + turn * step * sign,
                    ..spot
                };
                if let Some(next) = self.try_at(to, loss) {
                    (found, better) = (next, true);
                    break;
                }
            }
            step *= if better { LONGER } else { SHORTER };
        }
        found
    }
}
