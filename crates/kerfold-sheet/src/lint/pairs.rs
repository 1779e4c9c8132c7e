//! Which lines come near one another, and what each pair has in common.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::DVec2;

use super::artwork::Operation;
use super::distance::distance;
use super::lines::{Line, Strokes};
use super::work::{LintError, Work, ended, flow};
use crate::geom::polygon::segments_cross;
use crate::geom::segments::PairOfGroups;

/// What two lines, or one line with itself, have in common.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Common {
    /// Length along which they run on one another, and a place there.
    pub overlap: Option<(f64, DVec2)>,
    /// A place where they cross.
    pub crossing: Option<DVec2>,
    /// A place where they cross while they run along one another.
    pub flat_crossing: Option<DVec2>,
    /// The least distance of two closed cuts, where it is below the reach, and its place; 0 where
    /// they touch.
    pub nearest: Option<(f64, DVec2)>,
}

/// All pairs of lines that come near one another, the smaller index first; a line with itself for
/// its own segments.
pub(super) struct Pairs {
    pub common: BTreeMap<(usize, usize), Common>,
}

/// What a group of segments in the tree may hold.
mod kind {
    /// Engraved: only lines along one another matter there.
    pub const ENGRAVED: u8 = 1;
    /// Anything else.
    pub const OTHER: u8 = 2;
}

/// Lines that turn less than that against one another, in radians, may run along one another.
const SLIGHT: f64 = 0.11;

/// Stretches shorter than that many gaps are where two ends meet at a flat angle.
const SHORTEST: f64 = 20.0;

impl Pairs {
    /// `gap` is how near lines count as one, `reach` how far apart closed cuts may be to be kept.
    pub fn of(lines: &[Line], gap: f64, reach: f64, work: &mut Work) -> Result<Self, LintError> {
        let strokes = Strokes::of(lines, |line| match line.operation {
            Operation::Info => None,
            Operation::Engrave => Some((gap / 2.0, kind::ENGRAVED)),
            _ if line.closed && line.operation.is_cut() => {
                Some((reach.max(gap) / 2.0, kind::OTHER))
            }
            _ => Some((gap / 2.0, kind::OTHER)),
        });
        let wants = |groups: PairOfGroups| {
            let all = groups.kinds[0] | groups.kinds[1];
            all != kind::ENGRAVED || groups.angle <= SLIGHT
        };
        let mut common: BTreeMap<(usize, usize), Common> = BTreeMap::new();
        let meet = |i: usize, j: usize| {
            let [a, b] = [i, j].map(|s| {
                let (line, index) = strokes.owner(s);
                Stroke { line, index, ends: strokes.tree.segments()[s].ends }
            });
            flow(work.compare(1).and_then(|()| match compare(&a, &b, lines, gap, reach) {
                Some(found) => keep(&mut common, (a.line, b.line), &found, work),
                None => Ok(()),
            }))
        };
        ended(strokes.tree.pairs(wants, meet))?;
        common.values_mut().for_each(|c| c.settle(gap));
        Ok(Self { common })
    }
}

fn keep(
    common: &mut BTreeMap<(usize, usize), Common>,
    pair: (usize, usize),
    found: &Common,
    work: &mut Work,
) -> Result<(), LintError> {
    match common.entry(pair) {
        Entry::Occupied(mut known) => known.get_mut().add(found),
        Entry::Vacant(place) => {
            work.keep_pair()?;
            place.insert(*found);
        }
    }
    Ok(())
}

impl Common {
    fn add(&mut self, other: &Self) {
        self.overlap = match (self.overlap, other.overlap) {
            (Some((a, at)), Some((b, _))) => Some((a + b, at)),
            (a, b) => a.or(b),
        };
        self.crossing = self.crossing.or(other.crossing);
        self.flat_crossing = self.flat_crossing.or(other.flat_crossing);
        let nearer = |a: (f64, DVec2), b: (f64, DVec2)| if b.0 < a.0 { b } else { a };
        self.nearest = match (self.nearest, other.nearest) {
            (Some(a), Some(b)) => Some(nearer(a, b)),
            (a, b) => a.or(b),
        };
    }

    /// Once all is added: stretches too short in all are where the lines touch, and then a crossing
    /// at a flat angle is one.
    fn settle(&mut self, gap: f64) {
        self.overlap = self.overlap.filter(|o| o.0 > SHORTEST * gap);
        if self.overlap.is_none() {
            self.crossing = self.crossing.or(self.flat_crossing);
        }
    }
}

/// A segment with the line that it belongs to.
struct Stroke {
    line: usize,
    index: usize,
    ends: [DVec2; 2],
}

fn compare(a: &Stroke, b: &Stroke, lines: &[Line], gap: f64, reach: f64) -> Option<Common> {
    // Within a line the earlier segment comes first.
    let (a, b) = if (a.line, a.index) <= (b.line, b.index) { (a, b) } else { (b, a) };
    let is_own = a.line == b.line;
    let count = lines[a.line].points.len();
    let closes = lines[a.line].closed && a.index == 0 && b.index + 1 == count;
    let is_neighbour = is_own && (a.index + 1 == b.index || closes);
    // Two curves that are one, cut into pieces at other places, have short stretches in common.
    let shortest = if is_own { SHORTEST * gap } else { 0.0 };
    let mut found = Common { overlap: overlap(a.ends, b.ends, gap, shortest), ..Common::default() };
    let [p, q] = a.ends;
    let [r, s] = b.ends;
    if !is_neighbour && segments_cross(p, q, r, s) && !is_touch(a.ends, b.ends, gap) {
        let at = Some(crossing_point(a.ends, b.ends));
        match found.overlap {
            None => found.crossing = at,
            Some(_) => found.flat_crossing = at,
        }
    }
    let is_contour = |s: &Stroke| lines[s.line].closed && lines[s.line].operation.is_cut();
    if !is_own && is_contour(a) && is_contour(b) {
        let (distance, at) = nearest(a.ends, b.ends);
        found.nearest = (distance < reach).then_some((distance, at));
    }
    let is_any = found.overlap.is_some() || found.crossing.is_some() || found.nearest.is_some();
    is_any.then_some(found)
}

/// The length along which two segments run on one another, and its middle. Ends that only meet are
/// no overlap.
fn overlap(a: [DVec2; 2], b: [DVec2; 2], gap: f64, shortest: f64) -> Option<(f64, DVec2)> {
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
    let rise = beside(short[1]) - beside(short[0]);
    let side = |t: f64| {
        let share = ((t - from) / (to - from)).clamp(0.0, 1.0);
        beside(short[0]) + share * rise
    };
    let is_near = common > 0.0 && side(first).abs() <= gap && side(last).abs() <= gap;
    let is_along = rise.abs() <= SLIGHT * span;
    (is_near && is_along && common > shortest && span > gap)
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
