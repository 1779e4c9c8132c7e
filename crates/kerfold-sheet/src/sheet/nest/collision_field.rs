//! The field of the search: bins with what lies in them, and how much a piece at some place is too
//! near to others.
//!
//! Parts are found through a grid in every bin. A pair is counted in one cell only, the one that
//! holds the lower left corner of what the two boxes share.

use glam::DVec2;

use super::shape::{Part, Posed, Shape};

/// A bin: the box in which pieces may lie.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Room {
    pub low: DVec2,
    pub high: DVec2,
}

/// What a shortage counts: a little more than in proportion, so that one large one is worse than
/// several small ones.
fn penalty(shortage: f64) -> f64 {
    shortage * shortage.sqrt().sqrt()
}

/// Where a piece lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    pub bin: usize,
    pub at: DVec2,
    pub angle: f64,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    who: u32,
    part: u32,
}

/// The cells of one bin.
#[derive(Debug, Clone)]
struct Grid {
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Entry>>,
}

impl Grid {
    fn new(room: &Room, cell: f64) -> Self {
        let size = (room.high - room.low) / cell;
        let (columns, rows) = ((size.x.ceil() as usize).max(1), (size.y.ceil() as usize).max(1));
        Self { low: room.low, cell, columns, rows, cells: vec![Vec::new(); columns * rows] }
    }

    fn column(&self, x: f64) -> usize {
        // A negative number becomes 0.
        (((x - self.low.x) / self.cell) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.cell) as usize).min(self.rows - 1)
    }

    fn range(&self, low: DVec2, high: DVec2) -> [usize; 4] {
        [self.column(low.x), self.column(high.x), self.row(low.y), self.row(high.y)]
    }
}

/// What has been tried so often that it weighs more: for a piece, others with their weight above 1.
type Weights = Vec<(u32, f64)>;

/// Bins, pieces and obstacles.
#[derive(Debug)]
pub(super) struct CollisionField<'a> {
    pub shapes: &'a [Shape],
    /// Where every piece lies; obstacles come after the pieces.
    pub spots: Vec<Spot>,
    pub posed: Vec<Posed>,
    pub rooms: Vec<Room>,
    /// Distance that pieces keep from each other.
    spacing: f64,
    /// The largest distance that a piece keeps from anything.
    reach: f64,
    /// Number of pieces; what has a higher number is an obstacle.
    pub pieces: usize,
    /// Distance that pieces keep from each obstacle.
    clearances: Vec<f64>,
    cell: f64,
    grids: Vec<Grid>,
    weights: Vec<Weights>,
    is_in: Vec<bool>,
    /// Work done so far: parts measured.
    pub work: u64,
}

/// Something in a bin that pieces keep away from: its shape, whose origin lies where its frame
/// says, and how far.
#[derive(Debug, Clone)]
pub(super) struct Obstacle {
    pub shape: Shape,
    pub clearance: f64,
}

impl<'a> CollisionField<'a> {
    /// Pieces without bins.
    pub fn new(shapes: &'a [Shape], spacing: f64) -> Self {
        let mut extents: Vec<f64> = shapes.iter().flat_map(Shape::extents).collect();
        extents.sort_by(f64::total_cmp);
        let typical = extents.get(extents.len() / 2).copied().unwrap_or(1.0);
        let nowhere = Spot { bin: 0, at: DVec2::ZERO, angle: 0.0 };
        Self {
            shapes,
            spots: vec![nowhere; shapes.len()],
            posed: vec![Posed::default(); shapes.len()],
            rooms: Vec::new(),
            spacing,
            reach: spacing,
            pieces: shapes.len(),
            clearances: Vec::new(),
            cell: 0.7 * typical + spacing,
            grids: Vec::new(),
            weights: vec![Vec::new(); shapes.len()],
            is_in: vec![false; shapes.len()],
            work: 0,
        }
    }

    /// Adds a bin with its obstacles.
    pub fn add_bin(&mut self, room: Room, obstacles: &[Obstacle]) {
        let bin = self.rooms.len();
        let widest = (room.high - room.low).max_element();
        self.grids.push(Grid::new(&room, self.cell.max(widest / 200.0)));
        self.rooms.push(room);
        for obstacle in obstacles {
            let i = self.spots.len();
            let mut posed = Posed::default();
            posed.turn(&obstacle.shape, 0.0);
            self.posed.push(posed);
            self.clearances.push(obstacle.clearance);
            self.reach = self.reach.max(obstacle.clearance);
            self.weights.push(Vec::new());
            self.is_in.push(true);
            let spot = Spot { bin, at: obstacle.shape.origin, angle: 0.0 };
            self.spots.push(spot);
            self.enter(i, spot);
        }
    }

    fn apart(&self, other: usize) -> f64 {
        if other < self.pieces { self.spacing } else { self.clearances[other - self.pieces] }
    }

    /// Where the origin of a turned shape may be in a bin; the low is above the high where it does
    /// not fit.
    pub fn range(&self, posed: &Posed, bin: usize) -> (DVec2, DVec2) {
        (self.rooms[bin].low - posed.low, self.rooms[bin].high - posed.high)
    }

    /// Takes a piece out.
    pub fn take(&mut self, i: usize) {
        if !std::mem::replace(&mut self.is_in[i], false) {
            return;
        }
        let Spot { bin, at, .. } = self.spots[i];
        let grid = &mut self.grids[bin];
        for part in &self.posed[i].parts {
            let [x0, x1, y0, y1] = grid.range(part.low + at, part.high + at);
            for y in y0..=y1 {
                for x in x0..=x1 {
                    grid.cells[y * grid.columns + x].retain(|e| e.who != i as u32);
                }
            }
        }
    }

    /// Puts a piece at a place, from wherever it was.
    pub fn put(&mut self, i: usize, spot: Spot) {
        self.take(i);
        if self.posed[i].parts.is_empty() || self.posed[i].angle != spot.angle {
            self.posed[i].turn(&self.shapes[i], spot.angle);
        }
        self.spots[i] = spot;
        self.is_in[i] = true;
        self.enter(i, spot);
    }

    fn enter(&mut self, i: usize, spot: Spot) {
        let grid = &mut self.grids[spot.bin];
        for (p, part) in self.posed[i].parts.iter().enumerate() {
            let [x0, x1, y0, y1] = grid.range(part.low + spot.at, part.high + spot.at);
            for y in y0..=y1 {
                for x in x0..=x1 {
                    grid.cells[y * grid.columns + x].push(Entry { who: i as u32, part: p as u32 });
                }
            }
        }
    }

    /// Whether a piece has been put.
    pub fn is_in(&self, i: usize) -> bool {
        self.is_in[i]
    }

    /// Boxes of the holes of the pieces in a bin.
    pub fn holes(&self, bin: usize) -> impl Iterator<Item = (DVec2, DVec2)> {
        let here = (0..self.pieces).filter(move |&i| self.is_in[i] && self.spots[i].bin == bin);
        here.flat_map(move |i| {
            let turn = super::super::layout::Turn::degrees(self.posed[i].angle);
            let at = self.spots[i].at;
            self.shapes[i].holes.iter().map(move |&(low, high)| {
                let (middle, half) = (low.midpoint(high), (high - low) / 2.0);
                // Turned, the box of a hole is no box: what is inside for sure is the square in the
                // middle.
                let half = if turn.apply(DVec2::X).abs().max_element() > 0.999 {
                    turn.apply(half).abs()
                } else {
                    DVec2::splat(half.max_element())
                };
                let middle = turn.apply(middle) + at;
                (middle - half, middle + half)
            })
        })
    }

    /// Calls `found` with every other that piece `i`, turned so and at `at`, is too near to, part
    /// by part: number and shortage. Stops when it returns false.
    fn shortages(
        &self,
        i: usize,
        posed: &Posed,
        bin: usize,
        at: DVec2,
        mut found: impl FnMut(usize, f64) -> bool,
    ) -> u64 {
        let grid = &self.grids[bin];
        let reach = DVec2::splat(self.reach);
        let mut work = 1;
        for part in &posed.parts {
            let (low, high) = (part.low + at - reach, part.high + at + reach);
            let [x0, x1, y0, y1] = grid.range(low, high);
            for y in y0..=y1 {
                for x in x0..=x1 {
                    for entry in &grid.cells[y * grid.columns + x] {
                        let other = entry.who as usize;
                        if other == i {
                            continue;
                        }
                        let (theirs, there) = (&self.posed[other], self.spots[other].at);
                        let second: &Part = &theirs.parts[entry.part as usize];
                        let (second_low, second_high) = (second.low + there, second.high + there);
                        let is_far = second_low.cmpgt(high) | second_high.cmplt(low);
                        let shared = low.max(second_low);
                        if is_far.any() || grid.column(shared.x) != x || grid.row(shared.y) != y {
                            continue;
                        }
                        work += 1;
                        let shortage =
                            posed.shortage(part, theirs, second, there - at, self.apart(other));
                        if shortage > 0.0 && !found(other, shortage) {
                            return work;
                        }
                    }
                }
            }
        }
        work
    }

    /// The weighted shortages of a piece at a place; at least `most` when they reach that.
    pub fn loss(&mut self, i: usize, posed: &Posed, bin: usize, at: DVec2, most: f64) -> f64 {
        let mut sum = 0.0;
        let weights = &self.weights[i];
        let work = self.shortages(i, posed, bin, at, |other, shortage| {
            let weight =
                weights.iter().find(|(w, _)| *w == other as u32).map_or(1.0, |(_, weight)| *weight);
            sum += weight * penalty(shortage);
            sum < most
        });
        self.work += work;
        sum
    }

    /// The pieces that a piece at a place touches, up to a tolerance; nothing where it overlaps
    /// one, or is too near to one that it does not touch, or to an obstacle.
    pub fn touched(
        &mut self,
        i: usize,
        posed: &Posed,
        spot: Spot,
        tolerance: f64,
    ) -> Option<Vec<usize>> {
        let mut most: Vec<(usize, f64)> = Vec::new();
        let work = self.shortages(i, posed, spot.bin, spot.at, |other, shortage| {
            match most.iter_mut().find(|m| m.0 == other) {
                Some((_, worst)) => *worst = worst.max(shortage),
                None => most.push((other, shortage)),
            }
            let may_touch = other < self.pieces;
            shortage <= tolerance + if may_touch { self.spacing } else { 0.0 }
        });
        self.work += work;
        most.retain(|m| m.1 > tolerance);
        let touches =
            |m: &(usize, f64)| m.0 < self.pieces && (m.1 - self.spacing).abs() <= tolerance;
        most.iter().all(touches).then(|| most.into_iter().map(|m| m.0).collect())
    }

    /// The weighted shortages of a piece where it lies.
    pub fn loss_here(&mut self, i: usize) -> f64 {
        let Spot { bin, at, .. } = self.spots[i];
        let posed = std::mem::take(&mut self.posed[i]);
        let loss = self.loss(i, &posed, bin, at, f64::INFINITY);
        self.posed[i] = posed;
        loss
    }

    /// For every pair too near, the lower number first, its shortages together; ascending.
    pub fn collisions(&mut self) -> Vec<(u32, u32, f64)> {
        let mut all = Vec::new();
        let mut mine: Vec<(u32, f64)> = Vec::new();
        for i in (0..self.pieces).filter(|&i| self.is_in[i]) {
            mine.clear();
            let Spot { bin, at, .. } = self.spots[i];
            let work = self.shortages(i, &self.posed[i], bin, at, |other, shortage| {
                if other > i {
                    match mine.iter_mut().find(|(o, _)| *o == other as u32) {
                        Some((_, sum)) => *sum += shortage,
                        None => mine.push((other as u32, shortage)),
                    }
                }
                true
            });
            self.work += work;
            mine.sort_unstable_by_key(|m| m.0);
            all.extend(mine.iter().map(|&(other, sum)| (i as u32, other, sum)));
        }
        all
    }

    /// Makes pairs that are too near weigh more, the worst most, and all others less.
    pub fn reweigh(&mut self, collisions: &[(u32, u32, f64)]) {
        const LEAST_RISE: f64 = 1.2;
        const MOST_RISE: f64 = 2.0;
        const FALL: f64 = 0.95;
        let worst = collisions.iter().map(|c| c.2).fold(f64::MIN_POSITIVE, f64::max);
        for weights in &mut self.weights {
            weights.iter_mut().for_each(|(_, weight)| *weight *= FALL);
            weights.retain(|(_, weight)| *weight > 1.0);
        }
        for &(a, b, shortage) in collisions {
            let rise = LEAST_RISE + (MOST_RISE - LEAST_RISE) * shortage / worst;
            for (i, other) in [(a, b), (b, a)] {
                let weights = &mut self.weights[i as usize];
                match weights.iter_mut().find(|(w, _)| *w == other) {
                    Some((_, weight)) => *weight = (*weight / FALL * rise).min(1e12),
                    None => weights.push((other, rise)),
                }
            }
        }
    }

    /// Forgets all weights.
    pub fn forget(&mut self) {
        self.weights.iter_mut().for_each(Vec::clear);
    }
}
