//! Rows of holes along edges: for stitches and for hinges, the same in both plates.

use glam::DVec2;

use super::cut::Cutter;
use super::error::PanelError;
use super::outline::FlatFace;
use super::plate::{Hole, Plate, Plates};
use super::rule::EdgeKind;
use crate::geom::polygon::{Location, locate};
use crate::mesh::{FaceMap, HalfEdgeId};
use crate::progress::Progress;

/// Holes that are tried between two looks at whether to stop.
const STRIDE: usize = 256;

/// Drills the holes of all stitched and hinged edges; a pair of which one has no room is left out.
///
/// # Errors
/// [`PanelError::Cancelled`].
pub(super) fn drill(
    made: &mut Plates,
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &Cutter<'_>,
    progress: &dyn Progress,
) -> Result<(), PanelError> {
    let (mesh, hardware) = (cutter.mesh, &cutter.params.hardware);
    let (spacing, radius) = (hardware.spacing(), hardware.diameter() / 2.0);
    for e in mesh.edges().filter(|&e| matches!(cutter.kind(e), EdgeKind::Stitch | EdgeKind::Hinge))
    {
        let sides = e.half_edges();
        let plates = sides.map(|h| flat[mesh.face(h)]);
        let length =
            side_of(&faces[plates[0]], sides[0]).map_or(0.0, |i| faces[plates[0]].length(i));
        let count = (length / spacing).floor();
        for k in 0..count as usize {
            if k.is_multiple_of(STRIDE) && progress.is_cancelled() {
                return Err(PanelError::Cancelled);
            }
            // Centred on the middle of the edge.
            let at = length / 2.0 + (k as f64 - (count - 1.0) / 2.0) * spacing;
            let hole = |s: usize| {
                let face = &faces[plates[s]];
                let along = if s == 0 { at } else { length - at };
                let inset = cutter.inset(sides[s], 1.0).inner() + hardware.inset();
                side_of(face, sides[s]).map(|i| Hole {
                    centre: face.at(i, along, inset),
                    radius,
                    edge: e,
                })
            };
            let pair = [hole(0), hole(1)];
            let fits =
                |s: usize| pair[s].is_some_and(|hole| has_room(&made.plates[plates[s]], &hole));
            if fits(0) && fits(1) {
                made.hole_pairs += 1;
                (0..2).for_each(|s| made.plates[plates[s]].holes.extend(pair[s]));
            } else {
                made.lost_hole_pairs += 1;
            }
        }
    }
    Ok(())
}

fn side_of(face: &FlatFace, h: HalfEdgeId) -> Option<usize> {
    face.half_edges.iter().position(|&g| g == h)
}

/// Whether a hole keeps its own radius as distance from the sides of its plate and from the other
/// holes.
fn has_room(plate: &Plate, hole: &Hole) -> bool {
    let clear = 2.0 * hole.radius;
    let keeps = |outline: &[DVec2]| {
        let n = outline.len();
        let is_far = |i: usize| distance(outline[i], outline[(i + 1) % n], hole.centre) >= clear;
        locate(outline, hole.centre) == Location::Inside && (0..n).all(is_far)
    };
    let is_apart = |other: &Hole| other.centre.distance(hole.centre) >= other.radius + clear;
    keeps(&plate.front) && keeps(&plate.back) && plate.holes.iter().all(is_apart)
}

fn distance(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t)
}
