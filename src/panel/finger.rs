//! Fingers: blocks of one plate that reach through the other, alternately along an edge.
//!
//! Between the corners of the plates an edge is divided into zones of equal width; the plate on the
//! left of the edge's first half-edge has a finger in every even zone, the other plate in every odd
//! one. The zones keep inside of what both plates, at front and back, roots and tips, have free
//! between their neighbouring sides, so a finger never meets a third plate.

use glam::DVec2;

use super::across::Inset;
use super::cut::Cutter;
use super::outline::FlatFace;
use super::rule::EdgeKind;
use crate::mesh::{EdgeId, EdgeMap, FaceMap, HalfEdgeId};

/// The least distance of fingers from the corners, in thicknesses.
const CLEAR: f64 = 0.25;

/// The finger zones of an edge, measured from the first vertex of its first half-edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Comb {
    edge: EdgeId,
    low: f64,
    high: f64,
    zones: usize,
}

/// Divides all fingered edges, or names those that are too short.
pub(super) fn combs(
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &Cutter<'_>,
) -> Result<EdgeMap<Option<Comb>>, Vec<EdgeId>> {
    let mesh = cutter.mesh;
    let mut combs = EdgeMap::filled(mesh.edge_slots(), None);
    let mut short = Vec::new();
    for e in mesh.edges().filter(|&e| cutter.kind(e) == EdgeKind::Finger) {
        let sides = e.half_edges().map(|h| free(&faces[flat[mesh.face(h)]], h, cutter));
        let length = sides[0].length;
        // The partner runs the other way.
        let (low, high) =
            (sides[0].low.max(length - sides[1].high), sides[0].high.min(length - sides[1].low));
        let thickness =
            e.half_edges().map(|h| cutter.thickness[mesh.face(h)]).into_iter().fold(0.0, f64::max);
        let width =
            cutter.params.hardware.finger_width.map_or(3.0 * thickness, |w| w.mm().max(thickness));
        let room = high - low;
        // Fingers narrower than the plate is thick break off.
        let zones = ((room / width).round().max(2.0)).min((room / thickness).floor());
        if zones >= 2.0 {
            combs[e] = Some(Comb { edge: e, low, high, zones: zones as usize });
        } else {
            short.push(e);
        }
    }
    if short.is_empty() { Ok(combs) } else { Err(short) }
}

/// What a plate has free along a side, from the side's first vertex.
struct Free {
    low: f64,
    high: f64,
    length: f64,
}

fn free(face: &FlatFace, h: HalfEdgeId, cutter: &Cutter<'_>) -> Free {
    let i = face.half_edges.iter().position(|&g| g == h).unwrap_or(0);
    let inset = |i: usize| cutter.inset(face.half_edges[i], 1.0);
    let (own, before, after) = (inset(i), inset(face.before(i)), inset((i + 1) % face.len()));
    let levels = [own.front, own.back, own.tip.unwrap_or(own.front)];
    let along = |p: DVec2| (p - face.corners[i]).dot(face.along[i]);
    let mut free = Free { low: f64::NEG_INFINITY, high: f64::INFINITY, length: face.length(i) };
    let next = (i + 1) % face.len();
    for level in levels {
        for other in [before.front, before.back] {
            free.low = face.corner(i, other, level).map_or(free.low, |p| free.low.max(along(p)));
        }
        for other in [after.front, after.back] {
            free.high =
                face.corner(next, level, other).map_or(free.high, |p| free.high.min(along(p)));
        }
        free.low = cut_reach(face, i, i, level, cutter).map_or(free.low, |at| free.low.max(at));
        free.high =
            cut_reach(face, i, next, level, cutter).map_or(free.high, |at| free.high.min(at));
    }
    // The relief takes as much of the side as it is deep where the corner is right-angled; twice
    // that covers the sharper ones. And no finger begins in a corner, where its root would have no
    // length.
    let clear = 2.0 * cutter.params.corner_relief.mm() + CLEAR * cutter.thickness[face.face];
    (free.low, free.high) = (free.low + clear, free.high - clear);
    free
}

/// Where along side `i` the cut through one of its corners meets the line at an inset.
fn cut_reach(
    face: &FlatFace,
    i: usize,
    corner: usize,
    inset: f64,
    cutter: &Cutter<'_>,
) -> Option<f64> {
    let level = cutter.level(face.half_edges[corner])?;
    let inwards = face.bisector(corner);
    Some((level - face.at(i, 0.0, inset).dot(inwards)) / face.along[i].dot(inwards))
}

/// The points that fingers add to side `i` of a plate, in its direction.
pub(super) fn zone_points(face: &FlatFace, i: usize, inset: &Inset, comb: &Comb) -> Vec<DVec2> {
    let Some(tip) = inset.tip else { return Vec::new() };
    let is_first = face.half_edges[i] == comb.edge.half_edge();
    let length = face.length(i);
    let width = (comb.high - comb.low) / comb.zones as f64;
    let parity = usize::from(!is_first);
    let fingers = (0..comb.zones).filter(|zone| zone % 2 == parity).map(|zone| {
        let (from, to) = (comb.low + zone as f64 * width, comb.low + (zone + 1) as f64 * width);
        if is_first { (from, to) } else { (length - to, length - from) }
    });
    let block = |(from, to): (f64, f64)| {
        [(from, inset.front), (from, tip), (to, tip), (to, inset.front)]
            .map(|(at, inset)| face.at(i, at, inset))
    };
    let fingers: Vec<_> = fingers.collect();
    let ordered: Vec<_> = if is_first { fingers } else { fingers.into_iter().rev().collect() };
    ordered.into_iter().flat_map(block).collect()
}
