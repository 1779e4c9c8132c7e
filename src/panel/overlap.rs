//! What two plates take of each other: measured on the finished plates, by code that shares nothing
//! with what made them.
//!
//! Every pair of plates whose boxes meet is looked at, whether they share an edge, a vertex or
//! nothing. Most are parted by the plane of one of their faces. For the others the volume that they
//! share is the sum over all pairs of their convex parts.

use glam::DVec3;
use rayon::prelude::*;

use super::body::{Body, Part, meet};
use super::cell::Cell;
use super::plate::Plate;
use crate::geom::{AxisBox, BoxTree, RoundingBound};
use crate::progress::Progress;

/// Plates that share no more than this part of the smaller one do not overlap.
pub const SHARED: f64 = 1e-9;

/// Two plates that take the same place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shared {
    /// Their indices, the lower one first.
    pub plates: [usize; 2],
    /// In mm³.
    pub volume: f64,
    /// What they share lies inside of these together, measured from [`Shared::about`].
    pub cells: Vec<Cell>,
    /// In mm.
    pub about: DVec3,
}

/// All pairs of plates that overlap, in order; `None` when the user asked to stop.
pub(super) fn overlaps(plates: &[&Plate], progress: &dyn Progress) -> Option<Vec<Shared>> {
    let about = middle(plates);
    let bodies: Vec<Body<'_>> = plates.par_iter().map(|plate| Body::new(plate, about)).collect();
    let one = |pair: [usize; 2]| {
        if progress.is_cancelled() { None } else { shared(&bodies, pair, about, progress) }
    };
    let found: Vec<Option<Shared>> = near_pairs(&bodies).into_par_iter().map(one).collect();
    (!progress.is_cancelled()).then(|| found.into_iter().flatten().collect())
}

/// The middle of the box of all plates.
fn middle(plates: &[&Plate]) -> DVec3 {
    let origins = plates.iter().map(|plate| plate.frame.origin);
    let (low, high) =
        origins.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    if low.is_finite() { low.midpoint(high) } else { DVec3::ZERO }
}

/// All pairs of bodies whose boxes meet, in order.
fn near_pairs(bodies: &[Body<'_>]) -> Vec<[usize; 2]> {
    let boxes: Vec<AxisBox> =
        bodies.iter().map(|body| AxisBox { low: body.low, high: body.high }).collect();
    let mut pairs = Vec::new();
    BoxTree::new(&boxes).pairs(|i, j| {
        pairs.push([i, j]);
        true
    });
    pairs.sort_unstable();
    pairs
}

/// What two bodies share, when it is more than rounding and the user did not ask to stop.
fn shared(
    bodies: &[Body<'_>],
    plates: [usize; 2],
    about: DVec3,
    progress: &dyn Progress,
) -> Option<Shared> {
    let [a, b] = plates.map(|i| &bodies[i]);
    let (low, high) = (a.low.max(b.low), a.high.min(b.high));
    let extent = (high - low).length_squared();
    let rounding = RoundingBound::of_box(a.low.min(b.low) + about, a.high.max(b.high) + about);
    let limit = (SHARED * a.volume.min(b.volume)).max(rounding.length() * extent);
    // What lies between two planes this far apart is less than the limit.
    let slack = limit / (4.0 * extent);
    if extent == 0.0 || a.is_parted_from(b, slack) || b.is_parted_from(a, slack) {
        return None;
    }
    let within = |part: &Part| meet((part.low, part.high), (low, high));
    let parts = |body: &Body<'_>| body.parts().into_iter().filter(within).collect::<Vec<_>>();
    let [ours, theirs] = [parts(a), parts(b)];
    let planes: Vec<_> = theirs.iter().map(|part| part.cell.half_spaces()).collect();
    let (mut volume, mut cells) = (0.0, Vec::new());
    for part in &ours {
        if progress.is_cancelled() {
            return None;
        }
        for (other, planes) in theirs.iter().zip(&planes) {
            if !meet((part.low, part.high), (other.low, other.high)) {
                continue;
            }
            if let Some(cell) = part.cell.within(planes) {
                volume += part.sign * other.sign * cell.volume();
                cells.push(cell);
            }
        }
    }
    // Parts that only touch leave slivers without volume.
    cells.retain(|cell| cell.volume() > limit / (4.0 * ours.len() as f64 * theirs.len() as f64));
    (volume > limit).then_some(Shared { plates, volume, cells, about })
}
