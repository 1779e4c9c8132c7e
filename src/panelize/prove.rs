//! What was reached, measured on the result by code that shares nothing with the solver.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

use super::curvature::Quadric;
use super::refine::edge;
use super::regions::{Kind, Panels};
use super::surface::PANEL_AREA;
use super::surface::{Links, NONE, Surface};
use crate::geom::polygon::{convex_hull, segments_meet, signed_area, smallest_rectangle};
use crate::geom::{Frame, Grid, Plane, nearest_on_segment, nearest_on_triangle};

/// What was measured of one panel. Lengths in panel sizes, angles in degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// Whether its outline neither crosses nor touches itself and runs as the surface does.
    pub is_sound: bool,
    /// Its area over that of a regular hexagon.
    pub area: f64,
    pub shortest: f64,
    pub least_angle: f64,
    pub largest_angle: f64,
    /// The largest distance of its corners, the middles of its sides and its own middle from the
    /// surface.
    pub deviation: f64,
    /// Corners where it is concave.
    pub concave: usize,
    /// How deep they lie within its convex hull, at most.
    pub hollow: f64,
    /// The normal of its plane.
    pub normal: DVec3,
    /// The largest angle by which it folds against a neighbour.
    pub fold: f64,
    pub diameter: f64,
    /// The sides of the smallest box around it, the longer first.
    pub extent: [f64; 2],
    pub is_rim: bool,
    pub sides: usize,
}

/// Measures every panel.
pub(super) fn measure(surface: &Surface, quadrics: &[Quadric], panels: &Panels) -> Vec<Measured> {
    let around = triangles_around(surface);
    let count = panels.faces.len();
    let mut made: Vec<Measured> =
        (0..count).map(|f| measure_one(surface, quadrics, &around, panels, f)).collect();
    let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (f, face) in panels.faces.iter().enumerate() {
        for i in 0..face.len() {
            let ends = edge(face[i], face[(i + 1) % face.len()]);
            if let Some(&g) = sides.get(&ends) {
                let (n, m) = (made[f].normal, made[g].normal);
                let fold = n.cross(m).length().atan2(n.dot(m)).to_degrees();
                [f, g].iter().for_each(|&f| made[f].fold = made[f].fold.max(fold));
            }
            sides.insert(ends, f);
        }
    }
    made
}

fn measure_one(
    surface: &Surface,
    quadrics: &[Quadric],
    around: &Links,
    panels: &Panels,
    f: usize,
) -> Measured {
    let face = &panels.faces[f];
    let corners: Vec<DVec3> = face.iter().map(|&v| panels.points[v]).collect();
    let centre = panels.centre(f);
    let hint = surface.nearest(centre, panels.hint(f));
    let up = quadrics[hint].normal;
    let newell = Plane::newell(&corners).map_or(up, |plane| plane.normal());
    // A figure of eight may have a Newell vector that says little.
    let normal = crate::geom::fit_plane(&corners).map_or(newell, |plane| plane.normal());
    let normal = if normal.dot(up) < 0.0 { -normal } else { normal };
    let flat = flattened(&corners, normal, centre);
    let count = flat.len();
    let angles: Vec<f64> = (0..count)
        .map(|i| {
            let (a, b) = (flat[(i + count - 1) % count] - flat[i], flat[(i + 1) % count] - flat[i]);
            b.perp_dot(a).atan2(b.dot(a)).rem_euclid(TAU).to_degrees()
        })
        .collect();
    let lengths = (0..count).map(|i| flat[i].distance(flat[(i + 1) % count]));
    let middles = (0..count).map(|i| corners[i].midpoint(corners[(i + 1) % count]));
    let samples = corners.iter().copied().chain(middles).chain([centre]);
    let off = |place| distance(surface, around, place, hint);
    let apart = |i: usize| flat.iter().map(|q| q.distance(flat[i])).fold(0.0, f64::max);
    Measured {
        is_sound: is_simple(&flat) && signed_area(&flat) > 0.0,
        area: signed_area(&flat) / PANEL_AREA,
        shortest: lengths.fold(f64::INFINITY, f64::min),
        least_angle: angles.iter().copied().fold(f64::INFINITY, f64::min),
        largest_angle: angles.iter().copied().fold(0.0, f64::max),
        deviation: samples.map(off).fold(0.0, f64::max),
        concave: angles.iter().filter(|&&a| a > 180.5).count(),
        hollow: hollow(&flat),
        normal,
        fold: 0.0,
        diameter: (0..count).map(apart).fold(0.0, f64::max),
        extent: smallest_rectangle(&flat),
        is_rim: face.iter().any(|&v| panels.kinds[v] != Kind::Inner),
        sides: count,
    }
}

/// Corners in the plane with a normal, seen from its side.
fn flattened(corners: &[DVec3], normal: DVec3, centre: DVec3) -> Vec<DVec2> {
    let Some(plane) = Plane::new(normal, centre) else { return vec![DVec2::ZERO; corners.len()] };
    let frame = Frame::on_plane(&plane);
    corners.iter().map(|&p| frame.flatten(p)).collect()
}

/// How deep corners lie within the convex hull, at most.
fn hollow(flat: &[DVec2]) -> f64 {
    let hull = convex_hull(flat);
    let inside = |&q: &DVec2| {
        let side = |i: usize| {
            let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
            ((b - a).normalize_or_zero().perp_dot(q - a)).abs()
        };
        (0..hull.len()).map(side).fold(f64::INFINITY, f64::min)
    };
    let depth = flat.iter().map(inside).fold(0.0, f64::max);
    if depth.is_finite() { depth } else { 0.0 }
}

/// Whether sides that do not follow each other have nothing in common.
fn is_simple(flat: &[DVec2]) -> bool {
    let count = flat.len();
    let side = |i: usize| (flat[i], flat[(i + 1) % count]);
    (0..count).all(|i| {
        (i + 2..count).filter(|&j| i > 0 || j + 1 < count).all(|j| {
            let ((a, b), (c, d)) = (side(i), side(j));
            !segments_meet(a, b, c, d)
        })
    })
}

/// The triangles at each vertex of the surface.
fn triangles_around(surface: &Surface) -> Links {
    let pairs = surface.triangles.iter().enumerate().flat_map(|(k, t)| t.map(|v| [v, k]));
    Links::of_pairs(surface.points.len(), pairs)
}

/// The distance of a place from the triangles near the vertex that is nearest to it.
fn distance(surface: &Surface, around: &Links, place: DVec3, hint: usize) -> f64 {
    let v = surface.nearest(place, hint);
    let near = surface.links.of(v).iter().chain([&v]).flat_map(|&u| around.of(u));
    let corners = |t: usize| surface.triangles[t].map(|i| surface.points[i]);
    near.map(|&t| nearest_on_triangle(place, corners(t)).distance(place))
        .fold(f64::INFINITY, f64::min)
}

/// How far the corner of a plate lies from its node for each thickness: the length of the shortest
/// vector that has the product 1 with all three normals.
pub(super) fn node_reach(normals: [DVec3; 3]) -> f64 {
    let rows = DMat3::from_cols(normals[0], normals[1], normals[2]);
    // Asked for is only what the mean normal lacks: where planes hardly differ that is next to
    // nothing, and rounding does not count. The shift leaves out what is not settled.
    let mean = (normals[0] + normals[1] + normals[2]).normalize_or_zero();
    let lack = DVec3::from_array(normals.map(|n| n.distance_squared(mean) / 2.0));
    let gram = rows.transpose() * rows + DMat3::from_diagonal(DVec3::splat(1e-10));
    (mean + rows * (gram.inverse() * lack)).length()
}

/// Places on folds, and on edges of panels, are so far apart, in panel sizes.
const STEP: f64 = 0.1;
/// Edges of panels are looked for within so much of a place.
const NEAR: f64 = 0.5;

/// How far each of some folds goes from the panels at most: from their edges when it is to be one,
/// else from their faces; and the panel that is nearest there. Folds are looked at all along, so a
/// crease without a panel's edge is seen, too.
pub(super) fn off_folds(
    panels: &Panels,
    folds: impl Iterator<Item = [DVec3; 2]>,
    is_kept: bool,
) -> Vec<(f64, usize)> {
    let faces = panels.faces.iter().enumerate();
    let sides = faces.flat_map(|(f, face)| {
        let side = move |i: usize| (f, [face[i], face[(i + 1) % face.len()]]);
        (0..face.len()).map(side)
    });
    let mut grid = Grid::new([0.0; 3], NEAR);
    let mut owners: Vec<(usize, [DVec3; 2])> = Vec::new();
    for (f, side) in sides {
        let ends = side.map(|v| panels.points[v]);
        for place in steps(ends) {
            grid.insert(place.to_array());
            owners.push((f, ends));
        }
    }
    let off = |place: DVec3| {
        let near = grid.around(place.to_array()).map(|k| owners[k as usize]);
        let distance = |(f, ends): (usize, [DVec3; 2])| {
            let on_face = |i: usize| {
                let [a, b] = [0, 1].map(|k| panels.faces[f][(i + k) % panels.faces[f].len()]);
                let corners = [panels.centre(f), panels.points[a], panels.points[b]];
                nearest_on_triangle(place, corners).distance(place)
            };
            let distance = if is_kept {
                nearest_on_segment(place, ends).distance(place)
            } else {
                (0..panels.faces[f].len()).map(on_face).fold(f64::INFINITY, f64::min)
            };
            (distance, f)
        };
        near.map(distance).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((NEAR, NONE))
    };
    folds.map(|ends| worst(steps(ends).map(off))).collect()
}

/// Places along a line, both ends among them.
fn steps([a, b]: [DVec3; 2]) -> impl Iterator<Item = DVec3> {
    let count = (a.distance(b) / STEP).ceil().max(1.0) as usize;
    (0..=count).map(move |i| a.lerp(b, i as f64 / count as f64))
}

fn worst(all: impl Iterator<Item = (f64, usize)>) -> (f64, usize) {
    all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, NONE))
}
