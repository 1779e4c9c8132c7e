//! Which joints leave too little material beside another cut of their piece.

use glam::DVec2;

use super::super::boundary::{Boundaries, Contour, segment_distance};
use super::super::distance::nearest_on_segment;
use super::params::WEB;
use crate::geom::polygon::{Location, locate, segments_meet, signed_area};
use crate::net::Segment;

/// Corners that turn into the material by less than this, as the sine of the angle, make no neck.
const LEAST_TURN: f64 = 0.2;

/// A neck has at least this many times its width of contour between its two sides; nearer together
/// they are the sides of a tip.
const NECK_WAY: f64 = 4.0;

/// A straight stretch of the cut around a piece.
struct CutLine<'a> {
    contour: &'a Contour,
    edge: usize,
    ends: Segment,
    /// Length of the contour before it, and all around.
    at: f64,
    around: f64,
    /// Whether the cut turns into the material where it begins.
    is_reflex: bool,
}

/// The jointed seams of a piece, those that `is_jointed` names, whose cut comes nearer than `web`
/// to the cut of an edge that is no neighbour, meets any, or leaves a thin neck to a neighbour's.
pub(super) fn in_the_way(
    boundaries: &Boundaries,
    piece: usize,
    web: f64,
    is_jointed: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let lines: Vec<CutLine<'_>> = boundaries.of_piece(piece).flat_map(cut_lines).collect();
    let mut found = Vec::new();
    for (x, a) in lines.iter().enumerate() {
        for b in &lines[..x] {
            let is_close = if a.is_beside(b) {
                a.meets(b) || a.leaves_neck(b) || b.leaves_neck(a)
            } else {
                a.is_nearer(b, web)
            };
            if is_close {
                found.extend(a.seams().chain(b.seams()).filter(|&s| is_jointed(s)));
            }
        }
    }
    for contour in boundaries.of_piece(piece) {
        if signed_area(&contour.path()) * signed_area(&contour.corners) <= 0.0 {
            let seams = contour.sides.iter().flatten().map(|&(s, _)| s);
            found.extend(seams.filter(|&s| is_jointed(s)));
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// The cut along a contour, stretch by stretch.
fn cut_lines(contour: &Contour) -> Vec<CutLine<'_>> {
    let stretches: Vec<(usize, Segment)> = contour.cuts().filter(|(_, [p, q])| p != q).collect();
    let n = stretches.len();
    let around = stretches.iter().map(|(_, [p, q])| p.distance(*q)).sum();
    let mut at = 0.0;
    let mut lines = Vec::with_capacity(n);
    for (i, &(edge, ends)) in stretches.iter().enumerate() {
        let before = stretches[(i + n - 1) % n].1;
        let [into, out] = [before, ends].map(|[p, q]| (q - p).normalize_or_zero());
        let is_reflex = into.perp_dot(out) < -LEAST_TURN;
        lines.push(CutLine { contour, edge, ends, at, around, is_reflex });
        at += ends[0].distance(ends[1]);
    }
    lines
}

impl CutLine<'_> {
    /// Whether two stretches belong to one edge of a contour or to neighbours.
    fn is_beside(&self, other: &Self) -> bool {
        let apart = self.edge.abs_diff(other.edge);
        std::ptr::eq(self.contour, other.contour) && (apart <= 1 || apart + 1 >= self.contour.len())
    }

    /// The seams of its edge and of the one before, which has a part in the corner between them.
    fn seams(&self) -> impl Iterator<Item = usize> {
        let n = self.contour.len();
        let edges = [self.edge, (self.edge + n - 1) % n];
        edges.into_iter().filter_map(|i| self.contour.sides[i]).map(|(s, _)| s)
    }

    /// Whether two stretches meet elsewhere than at a common end.
    fn meets(&self, other: &Self) -> bool {
        let ([p, q], [r, s]) = (self.ends, other.ends);
        !(p == s || q == r || p == r || q == s) && segments_meet(p, q, r, s)
    }

    fn is_nearer(&self, other: &Self, web: f64) -> bool {
        let ([p, q], [r, s]) = (self.ends, other.ends);
        let reach = DVec2::splat(web);
        (p.min(q) - reach).cmple(r.max(s)).all()
            && r.min(s).cmple(p.max(q) + reach).all()
            && segment_distance(self.ends, other.ends) < web
    }

    /// Whether the material between the beginning of this stretch and another one is a thin neck.
    fn leaves_neck(&self, other: &Self) -> bool {
        if !self.is_reflex {
            return false;
        }
        let corner = self.ends[0];
        let foot = nearest_on_segment(corner, other.ends[0], other.ends[1]);
        if corner.distance(foot) >= WEB {
            return false;
        }
        let way = (other.at + other.ends[0].distance(foot) - self.at).abs();
        let is_apart = way.min(self.around - way) > NECK_WAY * WEB;
        let is_outline = signed_area(&self.contour.corners) > 0.0;
        let is_inside = locate(&self.contour.path(), corner.midpoint(foot)) == Location::Inside;
        is_apart && is_inside == is_outline
    }
}
