//! Living hinges: many straight dashes side by side that let a plate bend. They are cuts that close
//! nothing, narrow holes, and little material stands between them, all on purpose.

use glam::DVec2;

use super::contours::Contours;
use super::holes::Extent;
use super::lines::Line;
use super::params::LintParams;
use super::work::{LintError, Work};
use crate::geom::polygon::bounds;

/// A hinge has at least that many dashes.
const FEWEST: usize = 4;

/// A dash is at most that share of its length wide.
const SLENDER: f64 = 0.125;

/// Dashes of a hinge turn at most that much against one another, in radians.
const PARALLEL: f64 = 0.02;

/// Dashes side by side are at most that share of the shorter one's length apart.
const BESIDE: f64 = 0.35;

/// Of the dashes sorted across their direction that many are compared with each.
const WINDOW: usize = 32;

/// A straight cut within a part.
struct Dash {
    line: usize,
    middle: DVec2,
    along: DVec2,
    length: f64,
}

/// For every line whether it is a dash of a living hinge.
pub(super) fn dashes(
    lines: &[Line],
    contours: &Contours,
    params: &LintParams,
    work: &mut Work,
) -> Result<Vec<bool>, LintError> {
    let gap = params.gap.mm();
    let mut straight: Vec<Dash> = lines
        .iter()
        .enumerate()
        .filter(|(i, line)| line.operation.is_cut() && contours.parent[*i].is_some())
        .filter_map(|(i, line)| Dash::of(i, line, gap))
        .collect();
    straight.sort_by(|a, b| a.turn().total_cmp(&b.turn()));
    let mut families = Families::new(straight.len());
    let mut from = 0;
    while from < straight.len() {
        let count = 1 + straight[from..]
            .windows(2)
            .take_while(|w| w[1].turn() - w[0].turn() <= PARALLEL)
            .count();
        join_neighbours(&straight, from..from + count, &mut families, gap, work)?;
        from += count;
    }
    let mut is_dash = vec![false; lines.len()];
    for (k, dash) in straight.iter().enumerate() {
        is_dash[dash.line] = families.size(k) >= FEWEST;
    }
    Ok(is_dash)
}

/// Puts dashes of one direction that lie side by side into one family.
fn join_neighbours(
    dashes: &[Dash],
    range: std::ops::Range<usize>,
    families: &mut Families,
    gap: f64,
    work: &mut Work,
) -> Result<(), LintError> {
    let across = dashes[range.start].along.perp();
    let mut order: Vec<usize> = range.collect();
    let place = |k: usize| across.dot(dashes[k].middle);
    order.sort_by(|&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
    for (n, &a) in order.iter().enumerate() {
        let next = order[n + 1..].iter().take(WINDOW);
        work.compare(next.len())?;
        for &b in next {
            if dashes[a].is_beside(&dashes[b], gap) {
                families.join(a, b);
            }
        }
    }
    Ok(())
}

impl Dash {
    fn of(line: usize, drawn: &Line, gap: f64) -> Option<Self> {
        let (low, high) = bounds(&drawn.points)?;
        let extent = match drawn.points.as_slice() {
            &[a, b] => {
                Extent { width: 0.0, length: a.distance(b), along: (b - a).normalize_or_zero() }
            }
            points => Extent::of(points)?,
        };
        if extent.width > SLENDER * extent.length || extent.length <= gap {
            return None;
        }
        // Whichever way it is drawn.
        let is_turned = extent.along.x < 0.0 || (extent.along.x == 0.0 && extent.along.y < 0.0);
        let along = if is_turned { -extent.along } else { extent.along };
        Some(Self { line, middle: low.midpoint(high), along, length: extent.length })
    }

    /// From −π/2 to π/2.
    fn turn(&self) -> f64 {
        self.along.to_angle()
    }

    fn is_beside(&self, other: &Self, gap: f64) -> bool {
        let shorter = self.length.min(other.length);
        let between = other.middle - self.middle;
        let apart = self.along.perp_dot(between).abs();
        let common = (self.length + other.length) / 2.0 - self.along.dot(between).abs();
        self.along.perp_dot(other.along).abs() <= PARALLEL
            && apart > gap
            && apart <= BESIDE * shorter
            && common >= 0.25 * shorter
    }
}

/// Disjoint sets with their sizes.
struct Families {
    parent: Vec<usize>,
    size: Vec<usize>,
}

impl Families {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), size: vec![1; count] }
    }

    fn root(&mut self, mut k: usize) -> usize {
        while self.parent[k] != k {
            self.parent[k] = self.parent[self.parent[k]];
            k = self.parent[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (mut a, mut b) = (self.root(a), self.root(b));
        if a == b {
            return;
        }
        if self.size[a] < self.size[b] {
            std::mem::swap(&mut a, &mut b);
        }
        self.parent[b] = a;
        self.size[a] += self.size[b];
    }

    fn size(&mut self, k: usize) -> usize {
        let root = self.root(k);
        self.size[root]
    }
}
