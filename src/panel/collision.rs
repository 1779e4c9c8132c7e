//! Sides of a plate that run past each other, and the thickness at which they begin to.
//!
//! With the gap fixed, all corners move in straight lines while the thicknesses grow together, so a
//! side vanishes at a thickness that is solved for. Sides that cross without being neighbours are
//! found by looking, and their thickness by halving.

use glam::DVec2;

use super::cut::{Cutter, rounding};
use super::error::Collision;
use super::outline::FlatFace;
use crate::geom::polygon::{segments_cross, signed_area};
use crate::mesh::HalfEdgeId;

/// Halvings of the interval in which crossing begins: more digits than anybody reads.
const HALVINGS: usize = 40;

/// What is wrong with the front or back of a plate.
pub(super) fn collisions(face: &FlatFace, cutter: &Cutter<'_>) -> Vec<Collision> {
    let thickness = cutter.thickness[face.face];
    let mut found = Vec::new();
    let full = lengths(face, cutter, 1.0);
    // A side within rounding of nothing is nothing: no other program would take such a plate.
    let least = rounding(&cutter.mesh.face_positions(face.face));
    if full.iter().any(|&[front, back]| front <= least || back <= least) {
        let thin = lengths(face, cutter, 0.0);
        for (i, (full, thin)) in full.iter().zip(&thin).enumerate() {
            let share = (0..2)
                .filter(|&s| full[s] <= least)
                .map(|s| (thin[s] / (thin[s] - full[s])).max(0.0));
            if let Some(share) = share.reduce(f64::min) {
                let edge = Some(face.half_edges[i].edge());
                found.push(Collision {
                    face: face.face,
                    edge,
                    thickness,
                    largest: share * thickness,
                });
            }
        }
    }
    if found.is_empty() && !is_simple_at(face, cutter, 1.0) {
        let (mut good, mut bad) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = good + (bad - good) / 2.0;
            *(if is_simple_at(face, cutter, middle) { &mut good } else { &mut bad }) = middle;
        }
        found.push(Collision { face: face.face, edge: None, thickness, largest: good * thickness });
    }
    found
}

/// The signed lengths of all sides at front and back, positive where they run as on the mesh.
fn lengths(face: &FlatFace, cutter: &Cutter<'_>, scale: f64) -> Vec<[f64; 2]> {
    let [front, back] = outlines(face, cutter, scale);
    let n = face.len();
    let along =
        |polygon: &[DVec2], i: usize| (polygon[(i + 1) % n] - polygon[i]).dot(face.along[i]);
    (0..n).map(|i| [along(&front, i), along(&back, i)]).collect()
}

fn outlines(face: &FlatFace, cutter: &Cutter<'_>, scale: f64) -> [Vec<DVec2>; 2] {
    let inset = |&h: &HalfEdgeId| cutter.inset(h, scale);
    let insets: Vec<_> = face.half_edges.iter().map(inset).collect();
    let [front, back]: [Vec<f64>; 2] =
        [insets.iter().map(|i| i.front).collect(), insets.iter().map(|i| i.back).collect()];
    [face.moved(&front), face.moved(&back)]
}

fn is_simple_at(face: &FlatFace, cutter: &Cutter<'_>, scale: f64) -> bool {
    outlines(face, cutter, scale).iter().all(|polygon| is_simple(polygon))
}

/// Whether a polygon runs counter-clockwise and no two of its sides cross.
pub(super) fn is_simple(polygon: &[DVec2]) -> bool {
    crossing(polygon).is_none() && signed_area(polygon) > 0.0
}

/// Two sides that cross: of all that do those with the lowest numbers. A sweep along x, so that
/// outlines with many fingers take little more time than their length.
pub(super) fn crossing(polygon: &[DVec2]) -> Option<(usize, usize)> {
    let n = polygon.len();
    let side = |i: usize| (polygon[i], polygon[(i + 1) % n]);
    let boxes: Vec<(DVec2, DVec2)> =
        (0..n).map(|i| (side(i).0.min(side(i).1), side(i).0.max(side(i).1))).collect();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| boxes[i].0.x.total_cmp(&boxes[j].0.x));
    let mut lowest = None;
    for (at, &i) in order.iter().enumerate() {
        let reached = order[at + 1..].iter().take_while(|&&j| boxes[j].0.x <= boxes[i].1.x);
        for &j in reached {
            let apart = boxes[i].0.y > boxes[j].1.y || boxes[j].0.y > boxes[i].1.y;
            let ((a, b), (c, d)) = (side(i), side(j));
            if !apart && segments_cross(a, b, c, d) {
                let found = (i.max(j), i.min(j));
                lowest = Some(lowest.map_or(found, |known: (usize, usize)| known.min(found)));
            }
        }
    }
    lowest.map(|(later, earlier)| (earlier, later))
}
