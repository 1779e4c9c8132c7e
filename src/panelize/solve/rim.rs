//! What corners at the rim are held by.

use glam::DVec3;

use super::super::regions::{Kind, Panels};
use super::super::surface::{Held, NONE, SPACING, Surface};
use super::Scene;
use crate::geom::nearest_on_segment;

/// What becomes of the rim.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) enum RimRule {
    /// Corners slide along the rim curve.
    Curve,
    /// Straight stretches of the rim lie in upright walls, exactly; others as in [`Self::Curve`].
    Walls,
    /// Corners near one of some planes lie in it, exactly; others as in [`Self::Curve`].
    Planes(Vec<(DVec3, DVec3)>),
}

/// A plane that a corner at the rim is held to.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct RimRow {
    pub corner: usize,
    pub normal: DVec3,
    pub point: DVec3,
    /// Whether it is kept exactly.
    pub is_hard: bool,
}

/// The direction of a rim turns by less than this between vertices of a straight stretch.
const STRAIGHT: f64 = 1e-4;
/// A plane holds vertices of the rim that are so near, in steps of the fine surface.
const NEAR_RIM: f64 = 0.3;

/// The first of the planes, counted from 0, that no vertex of the rim is near to.
pub(in super::super) fn rim_plane_without_rim(
    surface: &Surface,
    planes: &[(DVec3, DVec3)],
) -> Option<usize> {
    let is_rim = |&v: &usize| surface.rim_next[v] != NONE && !surface.creases.has_edge(v);
    let rim = || (0..surface.points.len()).filter(is_rim);
    let is_near = |&(normal, through): &(DVec3, DVec3)| {
        let off = |v: usize| (surface.points[v] - through).dot(normal).abs();
        rim().any(|v| off(v) < NEAR_RIM * SPACING)
    };
    planes.iter().position(|plane| !is_near(plane))
}

impl RimRow {
    /// How far a place is from the plane.
    pub(super) fn distance(&self, place: DVec3) -> f64 {
        (place - self.point).dot(self.normal)
    }

    /// The planes of all corners at rims that do not stay: one where two panels meet, two where the rim turns.
    pub(super) fn all(scene: Scene<'_>, panels: &Panels) -> Vec<Self> {
        let mut rows = Vec::new();
        let moves = |&(v, _): &(usize, &Kind)| !panels.held.contains_key(&v);
        for (corner, kind) in panels.kinds.iter().enumerate().filter(moves) {
            let hint = panels.hints[corner];
            match kind {
                Kind::Inner => {}
                Kind::Rim => {
                    let v = nearest_on_rim(scene.surface, panels.points[corner], hint);
                    let direction = direction_at(scene.surface, v);
                    rows.push(Self::at(scene, corner, v, direction));
                }
                Kind::Corner => {
                    let (surface, v) = (scene.surface, hint);
                    let ends = [surface.rim_before[v], surface.rim_next[v]];
                    let here = surface.points[v];
                    let directions =
                        [here - surface.points[ends[0]], surface.points[ends[1]] - here];
                    let rows_here =
                        directions.map(|d| Self::at(scene, corner, v, d.normalize_or_zero()));
                    rows.extend(rows_here);
                }
                Kind::Crease => rows.extend(Self::on_crease(scene.surface, corner, hint)),
                Kind::Kept => {
                    let point = scene.surface.points[hint];
                    let row = |normal| Self { corner, normal, point, is_hard: true };
                    rows.extend(DVec3::AXES.map(row));
                }
            }
        }
        rows
    }

    /// The planes that hold a corner on the edge of a crease that begins at a vertex.
    fn on_crease(surface: &Surface, corner: usize, v: usize) -> [Self; 2] {
        let point = surface.points[v];
        let row = |held: Held| Self { corner, normal: held.normal, point, is_hard: held.is_hard };
        surface.creases.held[v].map(row)
    }

    /// The plane along the rim at one of its vertices.
    fn at(scene: Scene<'_>, corner: usize, v: usize, direction: DVec3) -> Self {
        let point = scene.surface.points[v];
        if let RimRule::Planes(planes) = scene.rule {
            let near = |&&(normal, through): &&(DVec3, DVec3)| {
                (point - through).dot(normal).abs() < NEAR_RIM * SPACING
                    && direction.dot(normal).abs() < 0.2
            };
            if let Some(&(normal, point)) = planes.iter().find(near) {
                return Self { corner, normal, point, is_hard: true };
            }
        }
        let wall = direction.cross(DVec3::Z).normalize_or_zero();
        if *scene.rule == RimRule::Walls
            && wall != DVec3::ZERO
            && is_straight(scene.surface, v, wall)
        {
            return Self { corner, normal: wall, point, is_hard: true };
        }
        let normal = direction.cross(scene.quadrics[v].normal).normalize_or_zero();
        Self { corner, normal, point, is_hard: false }
    }
}

/// Whether the rim runs straight in plan at a vertex, up to its corners.
fn is_straight(surface: &Surface, v: usize, wall: DVec3) -> bool {
    let off = |u: usize| {
        let way = surface.points[u] - surface.points[v];
        way.dot(wall).abs() > STRAIGHT * way.length()
    };
    let (next, before) = (off(surface.rim_next[v]), off(surface.rim_before[v]));
    if surface.is_corner[v] { !(next && before) } else { !next && !before }
}

/// The direction of the rim at a vertex; at a corner of the rim that of what comes next.
fn direction_at(surface: &Surface, v: usize) -> DVec3 {
    if surface.is_corner[v] {
        let from = if surface.creases.has_edge(v) { surface.rim_before[v] } else { v };
        return (surface.points[surface.rim_next[from]] - surface.points[from]).normalize_or_zero();
    }
    surface.rim_direction(v)
}

/// The vertex on a rim nearest to a place, by walking along the rim from one of its vertices.
pub(super) fn nearest_on_rim(surface: &Surface, place: DVec3, from: usize) -> usize {
    let mut best = from;
    let distance = |v: usize| surface.points[v].distance_squared(place);
    loop {
        let before = surface.rim_before[best];
        let sides = [
            if surface.creases.has_edge(best) { best } else { surface.rim_next[best] },
            if surface.creases.has_edge(before) { best } else { before },
        ];
        let next = if distance(sides[0]) <= distance(sides[1]) { sides[0] } else { sides[1] };
        if distance(next) >= distance(best) {
            return best;
        }
        best = next;
    }
}

/// The edge of a crease nearest to a place, by the vertex where it begins, by walking from one of
/// its edges; corners at which a crease stops are not passed.
pub(super) fn nearest_on_crease(surface: &Surface, place: DVec3, from: usize) -> usize {
    let mut best = from;
    let distance = |v: usize| {
        let ends = [v, surface.rim_next[v]].map(|v| surface.points[v]);
        nearest_on_segment(place, ends).distance_squared(place)
    };
    loop {
        let next = surface.rim_next[best];
        let next = if surface.creases.stops[next] { best } else { next };
        let before = if surface.creases.stops[best] { best } else { surface.rim_before[best] };
        let step = if distance(next) <= distance(before) { next } else { before };
        if distance(step) >= distance(best) {
            return best;
        }
        best = step;
    }
}
