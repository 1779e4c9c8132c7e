//! Nesting by true outline: pieces on sheets, as close as the spacing allows, on as few sheets as
//! possible and as little of the last one.
//!
//! The first layout comes from [`start`]; [`explore`] shortens the last sheet again and again and
//! [`separate`] moves the pieces of all sheets apart each time. Distances are those of convex parts
//! ([`shape`]), found through a grid ([`field`]). All is in f64 and deterministic: the budget is
//! work counted in parts measured, not time.

mod abut;
mod abut_orders;
mod collision_field;
mod explore;
mod guillotine;
mod lay;
mod params;
mod parts;
mod search;
mod separate;
mod shape;
mod simplify;
mod start;
mod stock;

use glam::DVec2;

pub(crate) use self::lay::{Laid, candidates, lay, offcut};
pub use self::params::{
    CommonLine, Corners, DefectList, GroupList, Guillotine, NestParams, Rotation, RotationList,
    StockList,
};
pub(crate) use self::stock::{StockSheet, stock_sheets};

use self::collision_field::{CollisionField, Obstacle};
use self::explore::Explore;
use self::search::Turns;
use self::shape::Shape;
use self::start::{Bins, Start};
use super::bounding_box::rounded;
use super::layout::Turn;
use crate::progress::Progress;
use crate::random::Rng;

/// Along which side a sheet is used up: the longer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
}

impl Axis {
    pub fn of(self, p: DVec2) -> f64 {
        if self == Self::X { p.x } else { p.y }
    }

    pub fn across(self, p: DVec2) -> f64 {
        self.other().of(p)
    }

    fn other(self) -> Self {
        if self == Self::X { Self::Y } else { Self::X }
    }

    fn unit(self) -> DVec2 {
        if self == Self::X { DVec2::X } else { DVec2::Y }
    }

    fn with(self, p: DVec2, value: f64) -> DVec2 {
        if self == Self::X { DVec2::new(value, p.y) } else { DVec2::new(p.x, value) }
    }
}

/// A sheet: the box in which pieces may lie, and what they keep away from in it.
#[derive(Debug, Clone)]
pub(crate) struct Bin {
    low: DVec2,
    high: DVec2,
    obstacles: Vec<Obstacle>,
}

impl Bin {
    pub fn axis(&self) -> Axis {
        let size = self.high - self.low;
        if size.x >= size.y { Axis::X } else { Axis::Y }
    }
}

/// A piece to lay.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    shape: Shape,
    turns: Turns,
    group: Option<usize>,
    /// For each sheet of the stock, whether the piece fits on it.
    fits: Vec<bool>,
}

/// What is to be laid, and on what.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    pieces: Vec<Piece>,
    /// The sheets in the order in which they are used; the last one as often as needed.
    stock: Vec<Bin>,
    spacing: f64,
    common_line: CommonLine,
}

/// Pieces, of one group, for which no place was found on an empty sheet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NoPlace {
    pub pieces: Vec<usize>,
}

/// Where a piece came to lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lying {
    pub bin: usize,
    /// Degrees counter-clockwise, then where the origin of the piece's frame lands.
    pub angle: f64,
    pub at: DVec2,
}

/// How long to search, and which of the many ways.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    pub seed: u64,
    /// Parts to measure.
    pub work: u64,
}

/// Above this number of pieces, fewer places are tried for the first layout.
const FEW_TRIALS: usize = 2000;

/// Lays all pieces.
/// A first layout may be given, without collisions, for the last kind of sheet.
pub(crate) fn nest(
    problem: &Problem,
    start: Option<Vec<Lying>>,
    effort: Effort,
    progress: &dyn Progress,
) -> Result<Vec<Lying>, NoPlace> {
    let shapes: Vec<Shape> = problem.pieces.iter().map(|p| p.shape.clone()).collect();
    let turns: Vec<Turns> = problem.pieces.iter().map(|p| p.turns.clone()).collect();
    let groups: Vec<Option<usize>> = problem.pieces.iter().map(|p| p.group).collect();
    if problem.common_line == CommonLine::On {
        return Ok(lying(
            &abut_orders::lay_abutting((problem, &shapes), effort, progress)?,
            &shapes,
        ));
    }
    let mut field = CollisionField::new(&shapes, problem.spacing);
    let mut rng = Rng::new(effort.seed);
    let mut bins = Bins::new(problem);
    let trials = if problem.pieces.len() > FEW_TRIALS { 60 } else { 200 };
    Start { field: &mut field, rng: &mut rng, bins: &mut bins, trials, shake: 0.0, progress }
        .lay_all()?;
    let mut explore = Explore {
        field: &mut field,
        rng: &mut rng,
        bins: &mut bins,
        turns: &turns,
        groups: &groups,
        work: effort.work,
        progress,
    };
    let mut first = explore.layout();
    if let Some(start) = start {
        let placed = explore.given(&start);
        // The boxes may be better, above all of rectangles.
        if (placed.bins, placed.used) <= (first.bins, first.used) {
            first = placed;
        }
    }
    let layout = explore.run(first);
    Ok(lying(&layout.spots, &shapes))
}

/// Where the frames of the pieces lie.
fn lying(spots: &[collision_field::Spot], shapes: &[Shape]) -> Vec<Lying> {
    let lying = spots.iter().zip(shapes).map(|(spot, shape)| {
        // The angle as the file shows it: far from the origin of its frame a piece would feel the
        // difference.
        let angle = rounded(rounded(spot.angle).rem_euclid(360.0));
        Lying { bin: spot.bin, angle, at: spot.at - Turn::degrees(angle).apply(shape.origin) }
    });
    lying.collect()
}

#[cfg(test)]
mod tests;
