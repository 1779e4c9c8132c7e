//! Holes that are too small to come out, and slots for tabs, which are not.

use glam::DVec2;

use super::contours::Contours;
use super::features::short;
use super::lines::Line;
use super::params::LintParams;
use super::report::{Check, LintReport};
use crate::geom::polygon::convex_hull;

/// Holes narrower than that many thicknesses are findings.
const LEAST: f64 = 1.5;

/// A slot takes the edge of a plate: its width in thicknesses, from a press fit to a plate that
/// leans: at an angle δ between the plates a slot is (1 + |cos δ|) / sin δ thicknesses wide.
const SLOT_WIDTH: [f64; 2] = [0.9, 1.5];

/// A slot is at least that many times as long as wide.
const SLOT_LENGTH: f64 = 2.0;

/// How large a contour is: its least width between two parallel lines, and its length along them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub width: f64,
    pub length: f64,
    /// The direction of the length, a unit vector.
    pub along: DVec2,
}

impl Extent {
    /// Nothing for points that span no area. The least width is found along an edge of the hull
    /// (Toussaint 1983, rotating calipers).
    pub fn of(points: &[DVec2]) -> Option<Self> {
        let hull = convex_hull(points);
        let n = hull.len();
        if n < 3 {
            return None;
        }
        let mut farthest = 1;
        let mut least: Option<Self> = None;
        for i in 0..n {
            let (a, b) = (hull[i], hull[(i + 1) % n]);
            let along = (b - a).normalize_or_zero();
            let height = |k: usize| along.perp_dot(hull[k % n] - a);
            while height(farthest + 1) > height(farthest) {
                farthest += 1;
            }
            let width = height(farthest);
            if least.is_none_or(|l| width < l.width) {
                least = Some(Self { width, length: 0.0, along });
            }
        }
        least.map(|extent| {
            let spans = hull.iter().map(|p| extent.along.dot(*p - hull[0]));
            let (from, to) = spans.fold((0.0_f64, 0.0_f64), |(l, h), s| (l.min(s), h.max(s)));
            Self { length: to - from, ..extent }
        })
    }
}

pub(super) fn small(
    lines: &[Line],
    contours: &Contours,
    is_dash: &[bool],
    params: &LintParams,
    report: &mut LintReport,
) {
    let Some(thickness) = params.thickness else { return };
    let thickness = thickness.mm();
    let least = LEAST * thickness;
    for (i, line) in lines.iter().enumerate() {
        let is_hole = line.closed && line.operation.is_cut() && contours.is_hole(i);
        if !is_hole || is_dash[i] {
            continue;
        }
        let extent = Extent::of(&line.points);
        let [width, length] =
            extent.map_or([0.0; 2], |e| [e.width, e.length].map(|side| side + params.kerf()));
        if width < least && !is_slot(width, length, thickness) {
            let words = format!(
                "this hole is {} mm wide, at least {} is wanted",
                short(width),
                short(least)
            );
            let at = line.points.first().copied();
            let numbers = Some((width, least));
            report.measured(Check::SmallHole, at, &line.label, words, numbers);
        }
    }
}

/// Whether a hole of this width and length is there to take the edge of a plate.
fn is_slot(width: f64, length: f64, thickness: f64) -> bool {
    // Written sizes have some decimals less than ours.
    let shares = width / thickness;
    let slack = 1e-3;
    (SLOT_WIDTH[0] - slack..=SLOT_WIDTH[1] + slack).contains(&shares)
        && length >= SLOT_LENGTH * width * (1.0 - slack)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_rectangle_has_its_sides() {
        let turn = DVec2::from_angle(0.4);
        let corners = [(0.0, 0.0), (7.0, 0.0), (7.0, 2.0), (3.0, 1.0), (0.0, 2.0)];
        let points: Vec<DVec2> = corners.iter().map(|&c| turn.rotate(c.into())).collect();
        let extent = Extent::of(&points).expect("an area");
        assert!((extent.width - 2.0).abs() < 1e-12 && (extent.length - 7.0).abs() < 1e-12);
        assert!(Extent::of(&points[..2]).is_none());
    }

    #[test]
    fn slots_are_as_wide_as_the_plate_and_longer_than_wide() {
        for (width, length, expected) in [
            (3.0, 12.0, true),
            (2.7, 9.0, true),
            (3.9, 9.0, true),
            (2.6, 9.0, false),
            (4.4, 12.0, true),
            (4.6, 12.0, false),
            (3.0, 5.0, false),
            (3.0, 3.0, false),
        ] {
            assert_eq!(is_slot(width, length, 3.0), expected, "{width} × {length}");
        }
    }
}
