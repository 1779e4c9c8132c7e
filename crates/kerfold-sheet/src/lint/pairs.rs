//! Which segments come near one another, found on a grid; and what pairs of lines have in common.

use std::collections::BTreeMap;

use glam::DVec2;

use super::lines::Line;
use crate::geom::polygon::segments_cross;

/// Boxes in the cells of a grid.
pub(super) struct Cells {
    boxes: Vec<(DVec2, DVec2)>,
    low: DVec2,
    cell: DVec2,
    side: usize,
    cells: Vec<Vec<u32>>,
}

impl Cells {
    /// About as many cells as boxes, at most a million.
    pub fn of(boxes: Vec<(DVec2, DVec2)>) -> Self {
        let low = boxes.iter().fold(DVec2::INFINITY, |l, b| l.min(b.0));
        let high = boxes.iter().fold(DVec2::NEG_INFINITY, |h, b| h.max(b.1));
        let side = ((boxes.len() as f64).sqrt() as usize).clamp(1, 1000);
        let cell = ((high - low) / side as f64).max(DVec2::splat(f64::MIN_POSITIVE));
        let mut grid = Self { boxes, low, cell, side, cells: vec![Vec::new(); side * side] };
        for i in 0..grid.boxes.len() {
            let (a, b) = (grid.at(grid.boxes[i].0), grid.at(grid.boxes[i].1));
            for y in a[1]..=b[1] {
                for x in a[0]..=b[0] {
                    grid.cells[y * side + x].push(i as u32);
                }
            }
        }
        grid
    }

    fn at(&self, p: DVec2) -> [usize; 2] {
        // Numbers beyond the grid, and those that are none, go to its border.
        ((p - self.low) / self.cell).to_array().map(|x| (x.max(0.0) as usize).min(self.side - 1))
    }

    /// Calls `meet` once for every pair of boxes that touch, the smaller index first, in a fixed
    /// order.
    pub fn pairs(&self, mut meet: impl FnMut(usize, usize)) {
        for (c, cell) in self.cells.iter().enumerate() {
            let here = [c % self.side, c / self.side];
            for (k, &b) in cell.iter().enumerate() {
                for &a in &cell[..k] {
                    let (p, q) = (self.boxes[a as usize], self.boxes[b as usize]);
                    if p.0.cmpgt(q.1).any() || q.0.cmpgt(p.1).any() {
                        continue;
                    }
                    // A pair that shares several cells counts in the one with the lower left corner
                    // of its common box.
                    if self.at(p.0.max(q.0)) == here {
                        meet(a as usize, b as usize);
                    }
                }
            }
        }
    }
}

/// What two lines, or one line with itself, have in common.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Common {
    /// Length along which they run on one another, and a place there.
    pub overlap: Option<(f64, DVec2)>,
    /// A place where they cross.
    pub crossing: Option<DVec2>,
    /// The least distance, where it is below the reach, and its place; 0 where they touch.
    pub nearest: Option<(f64, DVec2)>,
}

/// All pairs of lines that come near one another, the smaller index first; a line with itself for
/// its own segments.
pub(super) struct Pairs {
    pub common: BTreeMap<(usize, usize), Common>,
}

struct Segment {
    line: usize,
    index: usize,
    ends: [DVec2; 2],
}

impl Pairs {
    /// `gap` is how near lines count as one, `reach` how far apart they may be to be kept.
    pub fn of(lines: &[Line], gap: f64, reach: f64) -> Self {
        let own = |(line, l): (usize, &Line)| {
            l.segments()
                .enumerate()
                .map(|(index, ends)| Segment { line, index, ends })
                .collect::<Vec<_>>()
        };
        let is_judged = |l: &&(usize, &Line)| l.1.operation != super::Operation::Info;
        let segments: Vec<Segment> =
            lines.iter().enumerate().filter(|l| is_judged(&l)).flat_map(own).collect();
        let grow = DVec2::splat(reach.max(gap) / 2.0);
        let boxes = segments
            .iter()
            .map(|s| (s.ends[0].min(s.ends[1]) - grow, s.ends[0].max(s.ends[1]) + grow));
        let mut common: BTreeMap<(usize, usize), Common> = BTreeMap::new();
        Cells::of(boxes.collect()).pairs(|i, j| {
            let (a, b) = (&segments[i], &segments[j]);
            if let Some(found) = compare(a, b, lines, gap, reach) {
                common.entry((a.line, b.line)).or_default().add(&found);
            }
        });
        Self { common }
    }
}

impl Common {
    fn add(&mut self, other: &Self) {
        self.overlap = match (self.overlap, other.overlap) {
            (Some((a, at)), Some((b, _))) => Some((a + b, at)),
            (a, b) => a.or(b),
        };
        self.crossing = self.crossing.or(other.crossing);
        let nearer = |a: (f64, DVec2), b: (f64, DVec2)| if b.0 < a.0 { b } else { a };
        self.nearest = match (self.nearest, other.nearest) {
            (Some(a), Some(b)) => Some(nearer(a, b)),
            (a, b) => a.or(b),
        };
    }
}

fn compare(a: &Segment, b: &Segment, lines: &[Line], gap: f64, reach: f64) -> Option<Common> {
    let is_own = a.line == b.line;
    let count = lines[a.line].points.len();
    let closes = lines[a.line].closed && a.index == 0 && b.index + 1 == count;
    let is_neighbour = is_own && (a.index + 1 == b.index || closes);
    let [p, q] = a.ends;
    let [r, s] = b.ends;
    let mut found = Common { overlap: overlap(a.ends, b.ends, gap), ..Common::default() };
    if found.overlap.is_none()
        && !is_neighbour
        && segments_cross(p, q, r, s)
        && !is_touch(a.ends, b.ends, gap)
    {
        found.crossing = Some(crossing_point(a.ends, b.ends));
    }
    if !is_own {
        let (distance, at) = nearest(a.ends, b.ends);
        if distance < reach {
            found.nearest = Some((distance, at));
        }
    }
    (found.overlap.is_some() || found.crossing.is_some() || found.nearest.is_some())
        .then_some(found)
}

/// The length along which two segments run on one another, and its middle. Ends that only meet are
/// no overlap.
fn overlap(a: [DVec2; 2], b: [DVec2; 2], gap: f64) -> Option<(f64, DVec2)> {
    let (long, short) = if a[0].distance(a[1]) >= b[0].distance(b[1]) { (a, b) } else { (b, a) };
    let length = long[0].distance(long[1]);
    let along = (long[1] - long[0]) / length;
    let beside = |p: DVec2| along.perp_dot(p - long[0]);
    let at = |p: DVec2| along.dot(p - long[0]);
    let (from, to) = (at(short[0]), at(short[1]));
    let (first, last) = (from.min(to).max(0.0), from.max(to).min(length));
    let common = last - first;
    // The stretch of the shorter one beside the longer one must be near it at both ends.
    let span = (to - from).abs().max(f64::MIN_POSITIVE);
    let side = |t: f64| {
        let share = ((t - from) / (to - from)).clamp(0.0, 1.0);
        beside(short[0]) + share * (beside(short[1]) - beside(short[0]))
    };
    let is_near = common > 0.0 && side(first).abs() <= gap && side(last).abs() <= gap;
    // A stretch that is not much longer than the gap is where two ends meet at a flat angle.
    (is_near && common > 20.0 * gap && span > gap)
        .then(|| (common, long[0] + along * (first + last) / 2.0))
}

/// Whether an end of one lies on the other within the gap: they touch and need not cross.
fn is_touch(a: [DVec2; 2], b: [DVec2; 2], gap: f64) -> bool {
    a.iter().any(|&p| distance(p, b).0 <= gap) || b.iter().any(|&p| distance(p, a).0 <= gap)
}

fn crossing_point([p, q]: [DVec2; 2], [r, s]: [DVec2; 2]) -> DVec2 {
    let (u, v) = (q - p, s - r);
    let t = (r - p).perp_dot(v) / u.perp_dot(v);
    if t.is_finite() { p + u * t } else { p.midpoint(q) }
}

/// The distance of a point from a segment, and the nearest point on it.
pub(super) fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> (f64, DVec2) {
    let along = b - a;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let foot = a + along * t;
    (p.distance(foot), foot)
}

/// The least distance of two segments, and the middle between the nearest points.
fn nearest(a: [DVec2; 2], b: [DVec2; 2]) -> (f64, DVec2) {
    if segments_cross(a[0], a[1], b[0], b[1]) {
        return (0.0, crossing_point(a, b));
    }
    let from = |p: DVec2, s: [DVec2; 2]| {
        let (d, foot) = distance(p, s);
        (d, p.midpoint(foot))
    };
    let all = [from(a[0], b), from(a[1], b), from(b[0], a), from(b[1], a)];
    all.into_iter().fold((f64::INFINITY, a[0]), |x, y| if y.0 < x.0 { y } else { x })
}
