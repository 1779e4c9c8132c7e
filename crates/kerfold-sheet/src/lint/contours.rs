//! Which closed cut lies in which: outlines and holes, whatever the layers say.

use std::cell::OnceCell;
use std::ops::ControlFlow;

use glam::DVec2;

use super::lines::Line;
use super::work::{LintError, Work, ended, flow};
use crate::geom::polygon::{Location, bounds, locate, on_segment, signed_area};
use crate::geom::predicate::orient2d;
use crate::geom::segments::{Segment, SegmentTree};

/// Contours with fewer points are walked around; others are searched in a tree.
const FEW: usize = 48;

/// Points of a line that are asked whether they are inside a contour, at most.
const MOST_VOTES: usize = 64;

/// How much clearer one answer must be than the other to be taken.
const CLEAR: i32 = 5;

/// The closed cuts and how they contain one another.
pub(super) struct Contours {
    /// For every line that is cut: the smallest closed cut around it.
    pub parent: Vec<Option<usize>>,
    /// For every line that is cut: how many closed cuts are around it.
    depth: Vec<usize>,
    rings: Vec<Option<Ring>>,
}

/// A closed cut.
struct Ring {
    points: Vec<DVec2>,
    area: f64,
    low: DVec2,
    high: DVec2,
    tree: OnceCell<SegmentTree>,
}

impl Contours {
    pub fn of(lines: &[Line], gap: f64, work: &mut Work) -> Result<Self, LintError> {
        let rings: Vec<Option<Ring>> = lines.iter().map(Ring::of).collect();
        let mut found =
            Self { parent: vec![None; lines.len()], depth: vec![0; lines.len()], rings };
        let numbers: Vec<usize> = (0..lines.len()).filter(|&i| found.rings[i].is_some()).collect();
        let boxes = found.rings.iter().flatten();
        let boxes = boxes.map(|r| Segment { ends: [r.low, r.high], reach: gap, kind: 0 });
        let boxes = SegmentTree::new(boxes.collect());
        for (i, line) in lines.iter().enumerate().filter(|(_, l)| l.operation.is_cut()) {
            let around = found.around(i, line, (&boxes, &numbers), gap, work)?;
            let area = |&r: &usize| found.rings[r].as_ref().map_or(f64::INFINITY, |r| r.area);
            found.depth[i] = around.len();
            found.parent[i] =
                around.into_iter().min_by(|a, b| area(a).total_cmp(&area(b)).then(a.cmp(b)));
        }
        Ok(found)
    }

    /// The closed cuts around a line.
    fn around(
        &self,
        i: usize,
        line: &Line,
        (boxes, numbers): (&SegmentTree, &[usize]),
        gap: f64,
        work: &mut Work,
    ) -> Result<Vec<usize>, LintError> {
        let Some((low, high)) = bounds(&line.points) else { return Ok(Vec::new()) };
        let own_area = self.rings[i].as_ref().map_or(0.0, |r| r.area);
        let slack = DVec2::splat(gap);
        let mut candidates = Vec::new();
        let middle = low.midpoint(high);
        ended(boxes.boxes_around(middle, |b| {
            candidates.push(numbers[b]);
            flow(work.compare(1))
        }))?;
        candidates.sort_unstable();
        let mut around = Vec::new();
        for c in candidates.into_iter().filter(|&c| c != i) {
            let Some(ring) = &self.rings[c] else { continue };
            let is_larger = ring.area > own_area || (ring.area == own_area && c > i);
            let holds_box =
                ring.low.cmple(low + slack).all() && ring.high.cmpge(high - slack).all();
            if is_larger && holds_box && ring.holds(line, work)? {
                around.push(c);
            }
        }
        Ok(around)
    }

    /// Whether a closed cut takes material away instead of bounding a part.
    pub fn is_hole(&self, i: usize) -> bool {
        self.depth[i] % 2 == 1
    }

    /// Whether material of one part lies between two closed cuts: a hole and its outline, or two
    /// holes of one outline.
    pub fn share_material(&self, i: usize, j: usize) -> bool {
        let (hole, other) = if self.is_hole(i) { (i, j) } else { (j, i) };
        self.is_hole(hole)
            && (self.parent[hole] == Some(other)
                || (self.is_hole(other) && self.parent[other] == self.parent[hole]))
    }

    /// Whether a point lies in the material beside a closed cut: within an outline, without a hole.
    pub fn is_material(&self, i: usize, p: DVec2, work: &mut Work) -> Result<bool, LintError> {
        let Some(ring) = &self.rings[i] else { return Ok(false) };
        let wanted = if self.is_hole(i) { Location::Outside } else { Location::Inside };
        Ok(ring.locate(p, work)? == wanted)
    }

    /// Calls `visit` for the segments of a closed cut in a box, by their numbers along it.
    pub fn segments_in_box(
        &self,
        i: usize,
        (low, high): (DVec2, DVec2),
        mut visit: impl FnMut(usize, [DVec2; 2]),
        work: &mut Work,
    ) -> Result<(), LintError> {
        let Some(ring) = &self.rings[i] else { return Ok(()) };
        let tree = ring.tree();
        ended(tree.in_box(low, high, |s| {
            visit(s, tree.segments()[s].ends);
            flow(work.compare(1))
        }))
    }
}

impl Ring {
    fn of(line: &Line) -> Option<Self> {
        if !line.closed || !line.operation.is_cut() {
            return None;
        }
        let (low, high) = bounds(&line.points)?;
        let area = signed_area(&line.points).abs();
        Some(Self { points: line.points.clone(), area, low, high, tree: OnceCell::new() })
    }

    /// Its segments in their order.
    fn tree(&self) -> &SegmentTree {
        self.tree.get_or_init(|| {
            let n = self.points.len();
            let side = |i: usize| Segment {
                ends: [self.points[i], self.points[(i + 1) % n]],
                reach: 0.0,
                kind: 0,
            };
            SegmentTree::new((0..n).map(side).collect())
        })
    }

    /// Where a point lies, by the even-odd rule and with exact signs, as [`locate`] does.
    fn locate(&self, p: DVec2, work: &mut Work) -> Result<Location, LintError> {
        if self.points.len() < FEW {
            work.compare(self.points.len())?;
            return Ok(locate(&self.points, p));
        }
        let tree = self.tree();
        let (mut is_on, mut is_inside) = (false, false);
        // All segments that a ray to the right may meet.
        let end = tree.in_box(p, DVec2::new(f64::INFINITY, p.y), |s| {
            let [a, b] = tree.segments()[s].ends;
            is_on |= on_segment(a, b, p);
            if (a.y > p.y) != (b.y > p.y) {
                let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
                is_inside ^= orient2d(low, high, p) > 0.0;
            }
            match work.compare(1) {
                Ok(()) if is_on => ControlFlow::Break(Ok(())),
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => ControlFlow::Break(Err(error)),
            }
        });
        if let ControlFlow::Break(result) = end {
            result?;
        }
        Ok(match (is_on, is_inside) {
            (true, _) => Location::Boundary,
            (false, true) => Location::Inside,
            (false, false) => Location::Outside,
        })
    }

    /// Whether most of a line's points and middles are inside; points on the contour do not count.
    fn holds(&self, line: &Line, work: &mut Work) -> Result<bool, LintError> {
        let n = line.points.len();
        let step = n.div_ceil(MOST_VOTES / 2);
        let mut votes = 0_i32;
        for i in (0..n).step_by(step) {
            let next = line.points[(i + 1) % n];
            for p in [line.points[i], line.points[i].midpoint(next)] {
                votes += match self.locate(p, work)? {
                    Location::Inside => 1,
                    Location::Outside => -1,
                    Location::Boundary => 0,
                };
            }
            if votes.abs() >= CLEAR {
                break;
            }
        }
        Ok(votes > 0)
    }
}
