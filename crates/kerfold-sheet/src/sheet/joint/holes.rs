//! Holes for thread and rivets: at equal places on the two sides of a seam, both or none.

use std::collections::BTreeMap;

use glam::DVec2;

use super::super::boundary::{Boundaries, Place};
use super::super::distance::{distance_to_contour, distance_to_segment};
use super::super::stretch::Stretch;
use super::flaps::NewElements;
use super::params::Holes;
use super::slots::Slot;
use super::{Hole, JointReport};
use crate::geom::polygon::{Location, locate};
use crate::net::{Net, PieceId, Segment};

/// Holes so far, and what they must keep clear of; lists by the index of the piece.
struct Drill<'a> {
    paths: Vec<Vec<Vec<DVec2>>>,
    folds: Vec<Vec<Segment>>,
    holes: &'a Holes,
    drilled: Vec<Vec<Hole>>,
}

impl<'a> Drill<'a> {
    fn new(net: &Net, boundaries: &Boundaries, holes: &'a Holes, slots: &[Slot]) -> Self {
        let mut paths: Vec<Vec<Vec<DVec2>>> = (0..net.pieces.len())
            .map(|i| boundaries.of_piece(i).map(|c| c.path()).collect())
            .collect();
        slots.iter().for_each(|slot| paths[slot.piece].push(slot.contour.clone()));
        let mut folds: BTreeMap<PieceId, Vec<Segment>> = BTreeMap::new();
        for fold in &net.folds {
            folds.entry(fold.piece).or_default().push(fold.segment);
        }
        let folds = net.pieces.iter().map(|p| folds.remove(&p.id).unwrap_or_default()).collect();
        Self { paths, folds, holes, drilled: vec![Vec::new(); net.pieces.len()] }
    }

    fn all(self) -> Vec<Hole> {
        self.drilled.into_iter().flatten().collect()
    }

    fn is_free(&self, hole: &Hole) -> bool {
        let least = hole.radius + self.holes.web;
        let paths = &self.paths[hole.piece];
        let inside = paths
            .iter()
            .enumerate()
            .all(|(i, c)| (locate(c, hole.centre) == Location::Inside) == (i == 0));
        let others = &self.drilled[hole.piece];
        let folds = &self.folds[hole.piece];
        inside
            && paths.iter().all(|c| distance_to_contour(hole.centre, c) >= least)
            && others.iter().all(|h| h.centre.distance(hole.centre) >= hole.radius + least)
            && folds.iter().all(|&[a, b]| distance_to_segment(hole.centre, a, b) >= least)
    }

    /// Drills both or none.
    fn pair(&mut self, pair: [Hole; 2]) -> bool {
        let [a, b] = pair;
        let apart =
            a.piece != b.piece || a.centre.distance(b.centre) >= 2.0 * a.radius + self.holes.web;
        let is_free = apart && pair.iter().all(|h| self.is_free(h));
        if is_free {
            pair.into_iter().for_each(|hole| self.drilled[hole.piece].push(hole));
        }
        is_free
    }
}

/// Stitch holes along the stretches, on the seams that are wanted, clear of the slots of other
/// seams.
pub(super) fn stitch(
    net: &Net,
    boundaries: &Boundaries,
    stretches: &[Stretch],
    wanted: &[usize],
    (holes, slots): (&Holes, &[Slot]),
    report: &mut JointReport,
) -> Vec<Hole> {
    let mut drill = Drill::new(net, boundaries, holes, slots);
    for stretch in stretches {
        let length = stretch.length(net);
        let count = (length / holes.spacing).floor().max(1.0);
        for i in 0..count as usize {
            let step = length / count;
            // A hole in the way of a fold may move a little along the seam.
            let found = [0.0, 0.15, -0.15, 0.3, -0.3].into_iter().any(|shift| {
                let (seam, side, t) = stretch.at(net, step * (i as f64 + 0.5 + shift));
                let pair =
                    wanted.contains(&seam).then(|| hole_pair(boundaries, seam, side, t, holes));
                pair.flatten().is_some_and(|pair| drill.pair(pair))
            });
            let (seam, ..) = stretch.at(net, step * (i as f64 + 0.5));
            if found {
                report.hole_pairs += 1;
            } else if wanted.contains(&seam) {
                report.lost_hole_pairs += 1;
            }
        }
    }
    drill.all()
}

/// `t` runs along the side `side`; its partner runs the other way.
fn hole_pair(
    boundaries: &Boundaries,
    seam: usize,
    side: usize,
    t: f64,
    holes: &Holes,
) -> Option<[Hole; 2]> {
    let hole = |place: Place, t: f64| {
        let contour = &boundaries.contours[place.contour];
        let [a, b] = contour.edge(place.edge);
        let centre = a.lerp(b, t) + (b - a).normalize_or_zero().perp() * holes.inset;
        Hole { piece: contour.piece, centre, radius: holes.radius }
    };
    let [own, partner] = [side, 1 - side].map(|k| boundaries.places[seam][k]);
    Some([hole(own?, t), hole(partner?, 1.0 - t)])
}

/// Holes in the middle of every flap, and where they come to lie in its partner.
pub(super) fn rivet(
    net: &Net,
    boundaries: &Boundaries,
    flaps: &[NewElements],
    holes: &Holes,
    report: &mut JointReport,
) -> Vec<Hole> {
    let mut drill = Drill::new(net, boundaries, holes, &[]);
    // Flaps are folded, too: their paths lead around them and not along their bases.
    for flap in flaps {
        if let Some(own) = boundaries.places[flap.seam][flap.side] {
            drill.folds[boundaries.contours[own.contour].piece].push(flap.base);
        }
    }
    for flap in flaps {
        let [own, partner] = [flap.side, 1 - flap.side].map(|k| boundaries.places[flap.seam][k]);
        let (Some(own), Some(partner)) = (own, partner) else { continue };
        let [a, b] = flap.base;
        let along = (b - a).normalize_or_zero();
        let width = -(flap.top[0] - a).dot(along.perp());
        let ends = [
            (flap.top[0] - a).dot(along) / 2.0,
            (flap.top[1] - a).dot(along).midpoint(a.distance(b)),
        ];
        let count = ((ends[1] - ends[0]) / holes.spacing).floor().max(1.0);
        let [c, d] = boundaries.contours[partner.contour].edge(partner.edge);
        let back = (d - c).normalize_or_zero();
        for i in 0..count as usize {
            let at = ends[0] + (ends[1] - ends[0]) * (i as f64 + 0.5) / count;
            let hole = |piece, centre| Hole { piece, centre, radius: holes.radius };
            let on_flap = hole(
                boundaries.contours[own.contour].piece,
                a + along * at - along.perp() * (width / 2.0),
            );
            let under = hole(
                boundaries.contours[partner.contour].piece,
                d - back * at + back.perp() * (width / 2.0),
            );
            if drill.pair([on_flap, under]) {
                report.hole_pairs += 1;
            } else {
                report.lost_hole_pairs += 1;
            }
        }
    }
    drill.all()
}
