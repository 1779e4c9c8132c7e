//! Points that stay: a corner of panels stands at each, and is no unknown.

use std::collections::BTreeMap;

use glam::DVec3;

use super::PanelizeError;
use super::regions::{Kind, Panels};
use super::surface::{NONE, Surface};
use crate::geom::{AxisBox, BoxTree, Grid, nearest_on_segment, nearest_on_triangle};

/// A point is off the surface by at most this, in panel sizes.
const MOST_OFF: f64 = 0.2;
/// Points are at least so far apart: a panel has hardly shorter edges.
const LEAST_APART: f64 = 0.3;
/// A point so near to the rim is on it, and a corner of the rim stands there.
const ON_RIM: f64 = 0.02;
/// A point so near to a place where the rim turns is that place.
const AT_CORNER: f64 = 1e-3;
/// A corner that is moved to a point comes from no farther.
const REACH: f64 = 0.75;
/// Corners around one that is moved go along with it; at this distance by a third.
const SPREAD: f64 = 0.8;
/// Farther ones do not.
const FAR: f64 = 2.0;

/// A point at which a corner is to stand.
#[derive(Debug, Clone)]
pub(super) struct HeldPoint {
    /// In mm.
    pub given: DVec3,
    /// In panel sizes, seen from the origin.
    place: DVec3,
    is_on_rim: bool,
}

impl HeldPoint {
    /// Whether a corner of a kind, so far away, may stand here.
    fn may_be(&self, kind: Kind, off: f64) -> bool {
        match kind {
            Kind::Inner => !self.is_on_rim,
            Kind::Rim => self.is_on_rim,
            Kind::Corner => self.is_on_rim && off < AT_CORNER,
            Kind::Crease | Kind::Kept => false,
        }
    }
}

/// The points in panel sizes.
///
/// # Errors
/// A point that is off the surface; two that are too near to each other.
pub(super) fn held_points(
    surface: &Surface,
    points: &[DVec3],
    (size, origin): (f64, DVec3),
) -> Result<Vec<HeldPoint>, PanelizeError> {
    let corners = |t: &[usize; 3]| t.map(|v| surface.points[v]);
    let triangles: Vec<[DVec3; 3]> = surface.triangles.iter().map(corners).collect();
    let boxes: Vec<AxisBox> = triangles.iter().filter_map(|t| AxisBox::of(*t)).collect();
    let on_rim = |v: &usize| surface.rim_next[*v] != NONE;
    let rim: Vec<[DVec3; 2]> = (0..surface.points.len())
        .filter(on_rim)
        .map(|v| [surface.points[v], surface.points[surface.rim_next[v]]])
        .collect();
    let rim_boxes: Vec<AxisBox> = rim.iter().filter_map(|s| AxisBox::of(*s)).collect();
    let (tree, rim_tree) = (BoxTree::new(&boxes), BoxTree::new(&rim_boxes));
    let mut grid = Grid::new([0.0; 3], LEAST_APART);
    let mut held: Vec<HeldPoint> = Vec::new();
    for (k, &given) in points.iter().enumerate() {
        let place = (given - origin) / size;
        let off = tree.nearest(place, |i| nearest_on_triangle(place, triangles[i]).distance(place));
        let off = off.map_or(f64::INFINITY, |(_, off)| off);
        if off.is_nan() || off > MOST_OFF {
            return Err(PanelizeError::PointOffSurface {
                point: k,
                place: given,
                distance_mm: off * size,
                allowed_mm: MOST_OFF * size,
            });
        }
        let mut near = grid.around(place.to_array()).map(|i| i as usize);
        if let Some(other) = near.find(|&i| held[i].place.distance(place) < LEAST_APART) {
            return Err(PanelizeError::PointsTooNear {
                points: [other, k],
                distance_mm: held[other].given.distance(given),
                allowed_mm: LEAST_APART * size,
            });
        }
        let to_rim = rim_tree.nearest(place, |i| nearest_on_segment(place, rim[i]).distance(place));
        let is_on_rim = to_rim.is_some_and(|(_, off)| off < ON_RIM);
        drop(near);
        grid.insert(place.to_array());
        held.push(HeldPoint { given, place, is_on_rim });
    }
    Ok(held)
}

/// Moves a corner to each point, and those around it along.
///
/// # Errors
/// A point with no corner near that could be moved to it.
pub(super) fn hold(
    panels: &mut Panels,
    surface: &Surface,
    points: &[HeldPoint],
    size: f64,
) -> Result<(), PanelizeError> {
    if points.is_empty() {
        return Ok(());
    }
    let chosen = chosen(panels, points, size)?;
    let mut grid = Grid::new([0.0; 3], FAR);
    let moves: Vec<[DVec3; 2]> = chosen
        .iter()
        .map(|(&v, &k)| {
            let from = panels.points[v];
            grid.insert(from.to_array());
            [from, points[k].place - from]
        })
        .collect();
    for v in 0..panels.points.len() {
        if panels.kinds[v] != Kind::Inner || chosen.contains_key(&v) {
            continue;
        }
        let here = panels.points[v];
        let (mut way, mut sum) = (DVec3::ZERO, 0.0);
        for [from, step] in grid.around(here.to_array()).map(|i| moves[i as usize]) {
            let weight = (-from.distance_squared(here) / (SPREAD * SPREAD)).exp();
            way += step * weight;
            sum += weight;
        }
        panels.points[v] += way / sum.max(1.0);
    }
    for (&v, &k) in &chosen {
        panels.points[v] = points[k].place;
        panels.hints[v] = surface.nearest(points[k].place, panels.hints[v]);
    }
    panels.held = chosen;
    Ok(())
}

/// The nearest corner for each point, each once: the point by its corner.
fn chosen(
    panels: &Panels,
    points: &[HeldPoint],
    size: f64,
) -> Result<BTreeMap<usize, usize>, PanelizeError> {
    let mut grid = Grid::new([0.0; 3], REACH);
    panels.points.iter().for_each(|p| _ = grid.insert(p.to_array()));
    let mut pairs = Vec::new();
    for (k, point) in points.iter().enumerate() {
        for v in grid.around(point.place.to_array()).map(|v| v as usize) {
            let off = panels.points[v].distance(point.place);
            if off < REACH && point.may_be(panels.kinds[v], off) {
                pairs.push((off, k, v));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut has_one = vec![false; points.len()];
    let mut chosen = BTreeMap::new();
    for (_, k, v) in pairs {
        if !has_one[k] && !chosen.contains_key(&v) {
            has_one[k] = true;
            chosen.insert(v, k);
        }
    }
    match has_one.iter().position(|has| !has) {
        None => Ok(chosen),
        Some(point) => {
            Err(PanelizeError::NoCornerThere { point, place: points[point].given, size })
        }
    }
}
