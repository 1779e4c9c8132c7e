//! Flaps: a trapezoid on one side of every seam, that overlaps nothing.
//!
//! A flap must keep a gap to everything else on its piece, and folded over it must lie behind its
//! partner ([`Behind`]), so that it sticks out nowhere. Its ends become as steep as that wants.
//! When it still cannot, it is narrowed; before it gets narrower than half it moves to the partner
//! side; where neither has room for a third of it, the seam stays bare.

use std::f64::consts::TAU;

use glam::DVec2;

use super::super::boundary::{Boundaries, Place, segment_distance};
use super::behind::{Behind, Partner};
use super::params::{Flap, FlapSide};
use super::{FlapFold, JointReport};
use crate::geom::polygon::bounds;
use crate::net::{Net, Segment};

/// Least gap to other cuts, in mm, kerf not counted.
const GAP: f64 = 0.5;

/// Least angle of a notch between a flap and its neighbour, in radians (6°).
const NOTCH: f64 = 0.105;

/// Short edges get steeper flaps, up to this angle (80°) …
const STEEP: f64 = 1.396;

/// … and nothing gets flatter than this (15°).
const FLATTEST: f64 = 0.262;

/// Least width of a flap's outer edge relative to its seam.
const LEAST_TOP: f64 = 0.3;

/// Narrower flaps in mm hold no glue.
const LEAST_WIDTH: f64 = 2.0;

/// Widths that are tried, relative to what was asked for, on the side of the rule (0) and its
/// partner (1).
const TRIALS: [(usize, f64); 8] =
    [(0, 1.0), (0, 0.75), (0, 0.5), (1, 1.0), (1, 0.75), (1, 0.5), (0, 0.3), (1, 0.3)];

/// A flap that was made.
#[derive(Debug, Clone, Copy)]
pub(super) struct NewElements {
    pub seam: usize,
    pub side: usize,
    /// The seam's edge on the piece, the piece on its left.
    pub base: Segment,
    /// The outer edge, beside `base[0]` and `base[1]`.
    pub top: Segment,
}

impl NewElements {
    pub fn fold(&self, net: &Net) -> FlapFold {
        let seam = &net.seams[self.seam];
        FlapFold { piece: seam.sides[self.side].piece, id: seam.id, segment: self.base }
    }
}

/// Adds a flap to every seam that has room for one.
pub(super) fn add_flaps(
    net: &Net,
    boundaries: &mut Boundaries,
    flap: &Flap,
    kerf: f64,
    report: &mut JointReport,
) -> Vec<NewElements> {
    let mut made = Vec::new();
    let behind = Behind::new(net);
    for s in 0..net.seams.len() {
        let first = first_side(net, boundaries, s, flap.side);
        let found = TRIALS.into_iter().find_map(|(other, share)| {
            let side = first ^ other;
            let place = boundaries.places[s][side]?;
            let partner = behind.partner(s, side);
            let room = partner.as_ref().map_or([f64::INFINITY; 2], Partner::angles);
            let (base, top) = trapezoid(boundaries, place, (flap, share), room)?;
            let fits = is_free(boundaries, place, base, top, kerf)
                && partner.is_none_or(|partner| partner.hides(base, top));
            fits.then_some((place, other, share, NewElements { seam: s, side, base, top }))
        });
        let Some((place, other, share, flap)) = found else {
            report.bare_seams.push(net.seams[s].id);
            continue;
        };
        boundaries.contours[place.contour].profiles[place.edge] = flap.top.to_vec();
        report.flaps += 1;
        report.narrowed_flaps += usize::from(share < 1.0);
        report.moved_flaps += other;
        made.push(flap);
    }
    made
}

/// The side that the rule gives the flap to.
fn first_side(net: &Net, boundaries: &Boundaries, s: usize, rule: FlapSide) -> usize {
    let seam = &net.seams[s];
    let key = |k: usize| (seam.sides[k].piece, seam.sides[k].face);
    let lower = usize::from(key(1) < key(0));
    match rule {
        FlapSide::Lower => lower,
        FlapSide::Higher => 1 - lower,
        // Edges of an outline have and have no flap by turns.
        FlapSide::Alternate => lower ^ boundaries.places[s][lower].map_or(0, |p| p.edge % 2),
    }
}

/// The points before and after an edge on what is cut by now.
fn neighbours(boundaries: &Boundaries, place: Place) -> [(DVec2, bool); 2] {
    let contour = &boundaries.contours[place.contour];
    let n = contour.len();
    let (before, after) = ((place.edge + n - 1) % n, (place.edge + 1) % n);
    let p = contour.profiles[before].last().copied().unwrap_or(contour.corners[before]);
    let q = contour.profiles[after].first().copied().unwrap_or(contour.edge(after)[1]);
    // The other side of the same seam needs no flap any more.
    let own = contour.sides[place.edge].map(|(s, _)| s);
    let other = |i: usize| contour.sides[i].map(|(s, _)| s).filter(|&s| Some(s) != own);
    let waits = |i: usize| other(i).is_some() && contour.profiles[i].is_empty();
    [(p, waits(before)), (q, waits(after))]
}

/// The angle from one direction counter-clockwise to another, in [0, 2π).
fn turn(from: DVec2, to: DVec2) -> f64 {
    from.angle_to(to).rem_euclid(TAU)
}

/// The base and the top of a flap of a share of its width. `behind` are the largest angles at its
/// ends with which it lies behind its partner.
fn trapezoid(
    boundaries: &Boundaries,
    place: Place,
    (flap, share): (&Flap, f64),
    behind: [f64; 2],
) -> Option<(Segment, Segment)> {
    let [a, b] = boundaries.contours[place.contour].edge(place.edge);
    let [(before, before_waits), (after, after_waits)] = neighbours(boundaries, place);
    let room = [turn(before - a, b - a), turn(a - b, after - b)];
    // A neighbour that may get its own flap leaves half of the notch.
    let limit = |room: f64, waits: bool| if waits { (room - NOTCH) / 2.0 } else { room - NOTCH };
    let limits =
        [limit(room[0], before_waits).min(behind[0]), limit(room[1], after_waits).min(behind[1])];
    let (length, along) = (a.distance(b), (b - a).normalize_or_zero());
    let width = flap.width * share;
    for asked in [flap.angle, flap.angle.max(STEEP)] {
        let slopes = limits.map(|l| asked.min(l));
        if slopes.iter().any(|&s| s < FLATTEST) {
            return None;
        }
        let [left, right] = slopes.map(|s| 1.0 / s.tan());
        if length - width * (left + right) >= LEAST_TOP * length {
            if width < LEAST_WIDTH.min(0.3 * flap.width) {
                return None;
            }
            let out = -along.perp() * width;
            return Some((
                [a, b],
                [a + along * (width * left) + out, b - along * (width * right) + out],
            ));
        }
    }
    None
}

/// Whether a flap keeps its gap to everything on the piece.
fn is_free(
    boundaries: &Boundaries,
    place: Place,
    [a, b]: Segment,
    [p, q]: Segment,
    kerf: f64,
) -> bool {
    let own = &boundaries.contours[place.contour];
    let [(before, _), (after, _)] = neighbours(boundaries, place);
    let gap = GAP + kerf;
    let Some((low, high)) = bounds(&[a, b, p, q]) else { return false };
    let (low, high) = (low - DVec2::splat(gap), high + DVec2::splat(gap));
    boundaries.cuts(own.piece).all(|(contour, edge, [c, d])| {
        let is_far = c.max(d).cmplt(low).any() || c.min(d).cmpgt(high).any();
        if is_far || (std::ptr::eq(contour, own) && edge == place.edge) {
            return true;
        }
        let starts = std::ptr::eq(contour, own) && c == before && d == a;
        let ends = std::ptr::eq(contour, own) && c == b && d == after;
        // What lies near a corner of the base anyway may do so still.
        let least =
            gap.min(0.5 * segment_distance([c, d], [a, a]).min(segment_distance([c, d], [b, b])));
        let clear = |s: Segment| {
            let d = segment_distance(s, [c, d]);
            d > 0.0 && d >= least
        };
        (starts || clear([a, p]))
            && (ends || clear([q, b]))
            && (clear([p, q]) || (starts || ends) && segment_distance([p, q], [c, d]) > 0.0)
    })
}
