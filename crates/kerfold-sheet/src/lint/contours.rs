//! Which closed cut lies in which: outlines and holes, whatever the layers say.

use glam::DVec2;

use super::lines::Line;
use crate::geom::polygon::{Location, bounds, locate, signed_area};

/// The closed cuts and how they contain one another.
pub(super) struct Contours {
    /// For every line: the smallest closed cut around it.
    pub parent: Vec<Option<usize>>,
    /// For every line: how many closed cuts are around it.
    pub depth: Vec<usize>,
}

impl Contours {
    pub fn of(lines: &[Line], gap: f64) -> Self {
        let mut closed: Vec<(f64, usize, DVec2, DVec2)> = lines
            .iter()
            .enumerate()
            .filter(|(_, l)| l.closed && l.operation.is_cut())
            .filter_map(|(i, l)| {
                bounds(&l.points).map(|(low, high)| (signed_area(&l.points).abs(), i, low, high))
            })
            .collect();
        closed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let around = |i: usize| -> Vec<usize> {
            let line = &lines[i];
            let area = if line.closed { signed_area(&line.points).abs() } else { 0.0 };
            let Some((low, high)) = bounds(&line.points) else { return Vec::new() };
            let holds = |c: &&(f64, usize, DVec2, DVec2)| {
                c.1 != i
                    && (c.0 > area || (c.0 == area && c.1 > i))
                    && c.2.cmple(low + DVec2::splat(gap)).all()
                    && c.3.cmpge(high - DVec2::splat(gap)).all()
                    && is_inside(&line.points, &lines[c.1].points)
            };
            closed.iter().filter(holds).map(|c| c.1).collect()
        };
        let all: Vec<Vec<usize>> = (0..lines.len()).map(around).collect();
        Self {
            parent: all.iter().map(|a| a.first().copied()).collect(),
            depth: all.iter().map(Vec::len).collect(),
        }
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
}

/// Whether most of a line's points and middles are inside a contour; points on it do not count.
fn is_inside(line: &[DVec2], contour: &[DVec2]) -> bool {
    let middles = line.windows(2).map(|w| w[0].midpoint(w[1]));
    let mut votes = 0_i32;
    for p in line.iter().copied().chain(middles).take(64) {
        votes += match locate(contour, p) {
            Location::Inside => 1,
            Location::Outside => -1,
            Location::Boundary => 0,
        };
    }
    votes > 0
}
