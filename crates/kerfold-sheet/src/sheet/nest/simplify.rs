//! Fewer corners for the search: an outline with very many is drawn a little larger, a hole a
//! little smaller, never the other way, so that what keeps its distance in the search keeps it in
//! truth.
//!
//! A concave corner is left out, which fills a notch; a convex side is left out by lengthening its
//! neighbours until they meet. The change that adds the least area comes first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::geom::polygon::{bounds, segments_cross};
use crate::geom::predicate::orient2d;

/// Outlines up to this number of corners stay as they are.
const ENOUGH_CORNERS: usize = 24;
/// How far a contour may move outwards, as a part of its size.
const MOST_MOVED: f64 = 1e-3;

/// The outline and its holes with fewer corners.
pub(super) fn simplified(outline: &[DVec2], holes: &[Vec<DVec2>]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let (low, high) = bounds(outline).unwrap_or_default();
    let most = MOST_MOVED * (high - low).length();
    // A hole runs clockwise: the material lies on the same side of every contour, so one rule
    // serves both.
    (fewer(outline, most), holes.iter().map(|h| fewer(h, most)).collect())
}

fn fewer(contour: &[DVec2], most: f64) -> Vec<DVec2> {
    if contour.len() <= ENOUGH_CORNERS {
        return contour.to_vec();
    }
    let mut thinning = Thinning::new(contour, most);
    while thinning.ring.left > ENOUGH_CORNERS && thinning.step() {}
    thinning.ring.contour()
}

/// A contour that loses corners. A side is named by the corner at which it begins.
struct Ring {
    corners: Vec<DVec2>,
    before: Vec<usize>,
    after: Vec<usize>,
    is_left: Vec<bool>,
    left: usize,
}

impl Ring {
    fn new(contour: &[DVec2]) -> Self {
        let n = contour.len();
        Self {
            corners: contour.to_vec(),
            before: (0..n).map(|i| (i + n - 1) % n).collect(),
            after: (0..n).map(|i| (i + 1) % n).collect(),
            is_left: vec![true; n],
            left: n,
        }
    }

    fn contour(&self) -> Vec<DVec2> {
        (0..self.corners.len()).filter(|&i| self.is_left[i]).map(|i| self.corners[i]).collect()
    }

    fn side(&self, i: usize) -> [DVec2; 2] {
        [self.corners[i], self.corners[self.after[i]]]
    }

    fn remove(&mut self, i: usize) {
        let (before, after) = (self.before[i], self.after[i]);
        (self.after[before], self.before[after]) = (after, before);
        self.is_left[i] = false;
        self.left -= 1;
    }

    /// How the corner `i`, or the side that begins there, may go.
    fn change(&self, i: usize, most: f64) -> Option<Change> {
        let next = self.after[i];
        let places = [self.before[i], i, next, self.after[next]];
        let [before, here, next, after] = places.map(|k| self.corners[k]);
        let turn = orient2d(before, here, next);
        if turn <= 0.0 {
            let moved = -turn / before.distance(next);
            let is_near = moved <= most || turn == 0.0;
            return is_near.then_some(Change { instead: None, area: -turn / 2.0 });
        }
        if orient2d(here, next, after) <= 0.0 {
            return None;
        }
        // The lines before → here and next → after meet beyond the side, if the two corners
        // together turn by less than 180°.
        let (d, e) = (here - before, after - next);
        let cross = d.perp_dot(e);
        if cross <= 0.0 {
            return None;
        }
        let corner = here + d * ((next - here).perp_dot(e) / cross);
        let area = orient2d(here, corner, next).abs() / 2.0;
        let moved = 2.0 * area / here.distance(next);
        (corner.is_finite() && moved <= most).then_some(Change { instead: Some(corner), area })
    }
}

/// One way to lose a corner: what is put instead of a side, or nothing instead of a corner, and the
/// area that it adds.
#[derive(Clone, Copy)]
struct Change {
    instead: Option<DVec2>,
    area: f64,
}

/// A change in the heap: the least area first, then the first corner. It is out of date when the
/// corners around it have changed since.
#[derive(Clone, Copy, PartialEq)]
struct Entry {
    area: f64,
    at: usize,
    version: u32,
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.area.total_cmp(&self.area).then(other.at.cmp(&self.at))
    }
}

/// The changes that a ring may make, by the area that they add. One that a side is in the way of
/// waits until that side changes, so no corner is looked at again for nothing.
struct Thinning {
    ring: Ring,
    most: f64,
    versions: Vec<u32>,
    heap: BinaryHeap<Entry>,
    /// Side → the changes that it is in the way of.
    waiting: Vec<Vec<Entry>>,
    cells: Cells,
}

impl Thinning {
    fn new(contour: &[DVec2], most: f64) -> Self {
        let n = contour.len();
        let ring = Ring::new(contour);
        let mut cells = Cells::new(contour);
        (0..n).for_each(|i| cells.add(i, ring.side(i)));
        let (versions, waiting) = (vec![0; n], vec![Vec::new(); n]);
        let mut thinning = Self { ring, most, versions, heap: BinaryHeap::new(), waiting, cells };
        (0..n).for_each(|i| thinning.offer(i));
        thinning
    }

    /// Puts the change of a corner as it is now into the heap.
    fn offer(&mut self, i: usize) {
        self.versions[i] += 1;
        if let Some(change) = self.ring.change(i, self.most) {
            self.heap.push(Entry { area: change.area, at: i, version: self.versions[i] });
        }
    }

    fn is_current(&self, entry: &Entry) -> bool {
        self.ring.is_left[entry.at] && self.versions[entry.at] == entry.version
    }

    /// Makes the best change that is free; `false` when none is.
    fn step(&mut self) -> bool {
        while let Some(entry) = self.heap.pop() {
            if !self.is_current(&entry) {
                continue;
            }
            let Some(change) = self.ring.change(entry.at, self.most) else { continue };
            match self.in_the_way(entry.at, change) {
                Some(side) => self.waiting[side].push(entry),
                None => {
                    self.make(entry.at, change);
                    return true;
                }
            }
        }
        false
    }

    fn make(&mut self, at: usize, change: Change) {
        let (before, next) = (self.ring.before[at], self.ring.after[at]);
        let changed = [before, at, next];
        match change.instead {
            Some(corner) => {
                self.ring.corners[at] = corner;
                self.ring.remove(next);
            }
            None => self.ring.remove(at),
        }
        for side in [before, at].into_iter().filter(|&side| self.ring.is_left[side]) {
            self.cells.add(side, self.ring.side(side));
        }
        // Every corner whose change looks at a corner that moved or went.
        let around = [self.ring.before[before], before, at, next, self.ring.after[next]];
        let around = around.into_iter().filter(|&i| self.ring.is_left[i]).collect::<Vec<_>>();
        around.into_iter().for_each(|i| self.offer(i));
        for side in changed {
            self.heap.extend(std::mem::take(&mut self.waiting[side]));
        }
    }

    /// A side that the new sides of a change would cross.
    fn in_the_way(&self, at: usize, change: Change) -> Option<usize> {
        let ring = &self.ring;
        let (before, next) = (ring.before[at], ring.after[at]);
        let place = |i: usize| ring.corners[i];
        // The sides that go, and those that only become longer, may be touched.
        let (new, near) = match change.instead {
            Some(corner) => (
                vec![[place(before), corner], [corner, place(ring.after[next])]],
                vec![before, at, next],
            ),
            None => (vec![[place(before), place(next)]], vec![before, at]),
        };
        let (low, high) = bounds(new.iter().flatten()).unwrap_or_default();
        self.cells.find(low, high, |side| {
            if !ring.is_left[side] || near.contains(&side) {
                return false;
            }
            let [a, b] = ring.side(side);
            let is_far = a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any();
            !is_far && new.iter().any(|&[s, t]| segments_cross(s, t, a, b))
        })
    }
}

/// Which sides may lie where: a grid of about as many cells as there are sides. A side stays in the
/// cells of its earlier places, which costs a look and does no harm.
struct Cells {
    low: DVec2,
    size: f64,
    count: [usize; 2],
    sides: Vec<Vec<usize>>,
}

impl Cells {
    fn new(contour: &[DVec2]) -> Self {
        let (low, high) = bounds(contour).unwrap_or_default();
        let extent = (high - low).max_element().max(f64::MIN_POSITIVE);
        let size = extent / (contour.len() as f64).sqrt().ceil();
        let count = ((high - low) / size).to_array().map(|x| x as usize + 1);
        Self { low, size, count, sides: vec![Vec::new(); count[0] * count[1]] }
    }

    /// The first and the last cell of an extent in each direction; what lies outside counts to the
    /// cells at the rim.
    fn range(&self, low: DVec2, high: DVec2) -> [[usize; 2]; 2] {
        let cell = |p: DVec2| {
            let place = ((p - self.low) / self.size).to_array();
            [0, 1].map(|axis| (place[axis].max(0.0) as usize).min(self.count[axis] - 1))
        };
        [cell(low), cell(high)]
    }

    fn add(&mut self, side: usize, [a, b]: [DVec2; 2]) {
        let [from, to] = self.range(a.min(b), a.max(b));
        for y in from[1]..=to[1] {
            let row = y * self.count[0];
            self.sides[row + from[0]..=row + to[0]].iter_mut().for_each(|cell| cell.push(side));
        }
    }

    /// The first side in the cells of an extent of which `is_meant` says so.
    fn find(&self, low: DVec2, high: DVec2, is_meant: impl Fn(usize) -> bool) -> Option<usize> {
        let [from, to] = self.range(low, high);
        let rows = (from[1]..=to[1]).map(|y| y * self.count[0]);
        let cells = rows.flat_map(|row| &self.sides[row + from[0]..=row + to[0]]);
        cells.flatten().copied().find(|&side| is_meant(side))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::polygon::{Location, locate, signed_area};

    #[test]
    fn a_circle_with_many_corners_gets_few_and_stays_covered() {
        let circle: Vec<DVec2> =
            (0..720).map(|i| DVec2::from_angle(f64::from(i).to_radians() / 2.0) * 50.0).collect();
        let (fewer, _) = simplified(&circle, &[]);
        assert!(fewer.len() < 80, "{}", fewer.len());
        assert!(circle.iter().all(|&p| locate(&fewer, p) != Location::Outside
            || crate::sheet::distance::distance_to_contour(p, &fewer) < 1e-12));
        assert!(signed_area(&fewer) < signed_area(&circle) * 1.01);
        let hole: Vec<DVec2> = circle.iter().rev().copied().collect();
        let (_, holes) = simplified(&circle, &[hole]);
        assert!(holes[0].iter().all(|&p| p.length() <= 50.0 + 1e-12), "a hole never grows");
    }

    /// The rule by comparing all changes and all sides each time.
    fn by_comparing(contour: &[DVec2], most: f64) -> Vec<DVec2> {
        let mut contour = contour.to_vec();
        while contour.len() > ENOUGH_CORNERS {
            let ring = Ring::new(&contour);
            let n = contour.len();
            let all = (0..n).filter_map(|i| ring.change(i, most).map(|change| (i, change)));
            let mut all: Vec<(usize, Change)> = all.collect();
            all.sort_by(|a, b| a.1.area.total_cmp(&b.1.area).then(a.0.cmp(&b.0)));
            let is_free = |&(i, change): &(usize, Change)| {
                let at = |k: usize| contour[(i + k) % n];
                let (new, gone) = match change.instead {
                    Some(corner) => (vec![[at(n - 1), corner], [corner, at(2)]], 3),
                    None => (vec![[at(n - 1), at(1)]], 2),
                };
                (gone..n)
                    .all(|k| new.iter().all(|&[s, t]| !segments_cross(s, t, at(n - 1 + k), at(k))))
            };
            let Some((i, change)) = all.into_iter().find(is_free) else { break };
            if let Some(corner) = change.instead {
                contour[i] = corner;
                contour.remove((i + 1) % n);
            } else {
                contour.remove(i);
            }
        }
        contour
    }

    #[test]
    fn the_corners_go_that_comparing_all_would_take() {
        for seed in 0..20 {
            let mut rng = crate::random::Rng::new(seed);
            // Rough stars with deep notches: many changes have a side in the way.
            let n = 60 + 10 * seed as usize;
            let star: Vec<DVec2> = (0..n)
                .map(|i| {
                    let angle = std::f64::consts::TAU * i as f64 / n as f64;
                    DVec2::from_angle(angle) * (1.0 - 0.9 * rng.unit() * rng.unit())
                })
                .collect();
            for most in [1e-3, 0.05, 0.5] {
                let expected = by_comparing(&star, most);
                assert_eq!(fewer(&star, most), expected, "seed {seed}, {most}");
            }
        }
    }
}
