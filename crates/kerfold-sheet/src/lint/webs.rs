//! Too little material between two cuts: between two contours, or at a neck of one.

use glam::DVec2;

use super::contours::Contours;
use super::distance::distance;
use super::features::short;
use super::lines::Line;
use super::pairs::Pairs;
use super::params::LintParams;
use super::report::{Check, LintReport};
use super::work::{LintError, Work};

/// A stretch of a contour belongs to another part of it where the way along it is that many webs
/// long.
const APART: f64 = 4.0;

/// Two directions count as square when they are off by less, in radians: parallel sides are
/// rounded.
const SQUARE: f64 = 1e-9;

/// Webs between two contours of one part.
pub(super) fn between(
    lines: &[Line],
    contours: &Contours,
    pairs: &Pairs,
    is_dash: &[bool],
    params: &LintParams,
    report: &mut LintReport,
) {
    let is_judged = |i: usize| is_contour(&lines[i]) && !is_dash[i];
    for (&(i, j), common) in &pairs.common {
        let Some((distance, at)) = common.nearest.filter(|_| is_judged(i) && is_judged(j)) else {
            continue;
        };
        let is_apart = common.overlap.is_none() && common.crossing.is_none();
        if i != j && is_apart && contours.share_material(i, j) {
            tell(at, &lines[j].label, distance, &lines[i].label, params, report);
        }
    }
}

/// The thinnest neck of every contour.
pub(super) fn necks(
    lines: &[Line],
    contours: &Contours,
    is_dash: &[bool],
    params: &LintParams,
    report: &mut LintReport,
    work: &mut Work,
) -> Result<(), LintError> {
    for (i, line) in lines.iter().enumerate() {
        if !is_contour(line) || is_dash[i] {
            continue;
        }
        let search = Necks::of(&line.points, params);
        if let Some((distance, at)) = search.thinnest(i, contours, work)? {
            tell(at, &line.label, distance, "itself", params, report);
        }
    }
    Ok(())
}

fn is_contour(line: &Line) -> bool {
    line.closed && line.operation.is_cut()
}

fn tell(
    at: DVec2,
    label: &str,
    distance: f64,
    other: &str,
    params: &LintParams,
    report: &mut LintReport,
) {
    let width = distance - params.kerf();
    let words = format!("{} mm of material are left to {other}", short(width.max(0.0)));
    let numbers = Some((width, params.web()));
    report.measured(Check::ThinWeb, Some(at), label, words, numbers);
}

/// The necks of one contour: where two stretches of it, far apart along it, come nearest one
/// another through the material. The width is least there: going on along either stretch, to
/// either side, it grows or stays. Tips, which get thinner to their end, have no such place.
struct Necks<'a> {
    points: &'a [DVec2],
    /// The way along the contour to every point.
    along: Vec<f64>,
    total: f64,
    web: f64,
    gap: f64,
}

impl<'a> Necks<'a> {
    fn of(points: &'a [DVec2], params: &LintParams) -> Self {
        let n = points.len();
        let mut total = 0.0;
        let mut along = Vec::with_capacity(n);
        for i in 0..n {
            along.push(total);
            total += points[i].distance(points[(i + 1) % n]);
        }
        let web = params.web() + params.kerf();
        Self { points, along, total, web, gap: params.gap.mm() }
    }

    fn thinnest(
        &self,
        contour: usize,
        contours: &Contours,
        work: &mut Work,
    ) -> Result<Option<(f64, DVec2)>, LintError> {
        let mut least: Option<(f64, DVec2)> = None;
        // A contour that is short all around has no two stretches far apart.
        if self.total <= 2.0 * APART * self.web {
            return Ok(None);
        }
        for (i, &p) in self.points.iter().enumerate() {
            let around = (p - DVec2::splat(self.web), p + DVec2::splat(self.web));
            let mut found = Vec::new();
            let visit = |j: usize, side: [DVec2; 2]| {
                let (width, foot) = distance(p, side);
                let limit = least.map_or(self.web, |(w, _)| w);
                if width < limit && width > self.gap && self.is_narrowest(i, j, foot) {
                    found.push((width, p.midpoint(foot)));
                }
            };
            contours.segments_in_box(contour, around, visit, work)?;
            for (width, middle) in found {
                let is_less = least.is_none_or(|(w, _)| width < w);
                if is_less && contours.is_material(contour, middle, work)? {
                    least = Some((width, middle));
                }
            }
        }
        Ok(least)
    }

    /// Whether the way from corner `i` straight to a foot on side `j` is between two stretches, and
    /// shorter than those beside it.
    fn is_narrowest(&self, i: usize, j: usize, foot: DVec2) -> bool {
        let n = self.points.len();
        let p = self.points[i];
        let way = (self.along[j] + self.points[j].distance(foot) - self.along[i]).abs();
        if way.min(self.total - way) <= APART * self.web {
            return false;
        }
        let across = (p - foot).normalize_or_zero();
        let foot_corner = [j, (j + 1) % n].into_iter().find(|&k| self.points[k] == foot);
        self.leaves(i, across) && foot_corner.is_none_or(|k| self.leaves(k, -across))
    }

    /// Whether both sides at a corner lead away in a direction, or square to it.
    fn leaves(&self, corner: usize, away: DVec2) -> bool {
        let n = self.points.len();
        let here = self.points[corner];
        [(corner + 1) % n, (corner + n - 1) % n].into_iter().all(|neighbour| {
            (self.points[neighbour] - here).normalize_or_zero().dot(away) >= -SQUARE
        })
    }
}
