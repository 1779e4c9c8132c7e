//! The given surface as a fine triangle mesh, in units of the panel size.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use super::refine::Triangles;
use crate::geom::{Frame, Plane, triangulate};
use crate::mesh::Mesh;

/// Edges are at most so long, in panel sizes.
pub(super) const SPACING: f64 = 1.0 / 6.0;
/// The rim has a corner where it turns by more, in degrees.
pub(super) const CORNER_TURN: f64 = 40.0;
/// More triangles are refused before they are made.
pub(super) const MOST_TRIANGLES: usize = 3_000_000;
/// The area of a panel of size 1: that of a hexagon in the regular lattice.
pub(super) const PANEL_AREA: f64 = 0.866_025_403_784_438_6;
/// No vertex.
pub(super) const NONE: usize = usize::MAX;

/// A fine triangle mesh with what all steps ask of it.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
    /// Every edge once, the lower vertex first, ascending.
    pub edges: Vec<[usize; 2]>,
    pub links: Links,
    /// Of each vertex: a third of the area of its triangles.
    pub areas: Vec<f64>,
    /// Of each vertex: the mean normal of its triangles.
    pub normals: Vec<DVec3>,
    /// Of each vertex on a rim the next one, with the surface on the left; else [`NONE`].
    pub rim_next: Vec<usize>,
    /// Of each vertex on a rim the one before.
    pub rim_before: Vec<usize>,
    /// Vertices at which the rim turns sharply.
    pub is_corner: Vec<bool>,
    /// Where it was cut open along creases.
    pub creases: Creases,
    /// Panels whose place is settled.
    pub pins: Pins,
    /// Of the part on one side of mirror planes, for each vertex those that it lies on: a bit for each
    /// axis. Empty for others.
    pub masks: Vec<u8>,
}

/// Panels whose place is settled before the others are laid out: they come first among all, and
/// are neither moved nor dropped. All lists are empty when there are none.
#[derive(Debug, Clone, Default)]
pub(super) struct Pins {
    /// The vertex in the middle of each.
    pub sites: Vec<usize>,
    /// For each vertex of the surface the pin whose panel consists of it and others like it;
    /// [`NONE`] for vertices that go to whichever panel is nearest.
    pub owners: Vec<usize>,
    /// Vertices that are too near to such a panel to be the middle of another.
    pub is_shadow: Vec<bool>,
    /// The area of each that consists of given vertices, over that of a regular hexagon.
    pub areas: Vec<Option<f64>>,
}

impl Pins {
    /// The pin whose panel a vertex is part of.
    pub(super) fn owner(&self, v: usize) -> Option<usize> {
        self.owners.get(v).copied().filter(|&k| k != NONE)
    }
}

/// What is known of creases, by the vertices of the surface that was cut open along them; all lists
/// are empty when there are none.
#[derive(Debug, Clone, Default)]
pub(super) struct Creases {
    /// A number that both sides of a vertex on a crease share; [`NONE`] for others.
    pub names: Vec<usize>,
    /// Of each vertex from which the rim runs along a crease: where the same edge begins on the
    /// other side; [`NONE`] for others.
    pub across: Vec<usize>,
    /// Vertices past which corners do not slide.
    pub stops: Vec<bool>,
    /// Vertices that stay corners of panels.
    pub kept: Vec<bool>,
    /// Whether vertices on creases lie on the outer rim, too.
    pub outer: Vec<bool>,
    /// Whether the outer rim turns sharply there.
    pub turns: Vec<bool>,
    /// The planes that hold corners on the edge that begins at a vertex.
    pub held: Vec<[Held; 2]>,
    /// The connected part that each vertex belongs to.
    pub parts: Vec<usize>,
}

/// A plane through an edge of a crease.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Held {
    pub normal: DVec3,
    /// Whether corners lie in it exactly.
    pub is_hard: bool,
}

impl Creases {
    /// Whether the rim that begins at a vertex runs along a crease.
    pub(super) fn has_edge(&self, v: usize) -> bool {
        self.across.get(v).is_some_and(|&other| other != NONE)
    }

    /// The number that all sides of a vertex on a crease share.
    pub(super) fn name(&self, v: usize) -> Option<usize> {
        self.names.get(v).copied().filter(|&name| name != NONE)
    }

    /// Whether two vertices are known to lie on parts that do not hang together.
    pub(super) fn are_apart(&self, u: usize, v: usize) -> bool {
        self.parts.get(u) != self.parts.get(v)
    }
}

/// For each vertex a list of others.
#[derive(Debug, Clone, Default)]
pub(super) struct Links {
    starts: Vec<usize>,
    others: Vec<usize>,
}

impl Links {
    /// Both ways of each pair.
    pub(super) fn of_edges(count: usize, edges: &[[usize; 2]]) -> Self {
        Self::of_pairs(count, edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]))
    }

    /// The second of each pair with the first, in the order of the pairs.
    pub(super) fn of_pairs(count: usize, pairs: impl Iterator<Item = [usize; 2]> + Clone) -> Self {
        let mut starts = vec![0; count + 1];
        pairs.clone().for_each(|[a, _]| starts[a + 1] += 1);
        (0..count).for_each(|i| starts[i + 1] += starts[i]);
        let mut next = starts.clone();
        let mut others = vec![0; starts[count]];
        for [a, b] in pairs {
            others[next[a]] = b;
            next[a] += 1;
        }
        Self { starts, others }
    }

    /// What is listed with a vertex.
    pub(super) fn of(&self, vertex: usize) -> &[usize] {
        &self.others[self.range(vertex)]
    }

    /// Where the list of a vertex stands among all lists.
    pub(super) fn range(&self, vertex: usize) -> std::ops::Range<usize> {
        self.starts[vertex]..self.starts[vertex + 1]
    }
}

/// The triangles of a mesh of polygons, each divided in its own plane, as they stand.
pub(super) fn triangles_of(mesh: &Mesh) -> Triangles {
    let mut number = vec![NONE; mesh.vertex_slots()];
    let mut points = Vec::with_capacity(mesh.vertex_count());
    for v in mesh.vertices() {
        number[v.index()] = points.len();
        points.push(mesh.position(v));
    }
    let mut corners = Vec::with_capacity(2 * mesh.face_count());
    for f in mesh.faces() {
        let face: Vec<usize> = mesh.face_vertices(f).map(|v| number[v.index()]).collect();
        corners.extend(divide(&mesh.face_positions(f)).into_iter().map(|t| t.map(|i| face[i])));
    }
    Triangles { points, corners, creases: BTreeSet::new() }
}

/// The triangles of one polygon.
fn divide(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let fan = || (1..corners.len() - 1).map(|i| [0, i, i + 1]).collect();
    let plane = match (corners.len(), Plane::newell(corners)) {
        (4.., Some(plane)) => plane,
        _ => return fan(),
    };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = corners.iter().map(|&p| frame.flatten(p)).collect();
    let divided = triangulate(&flat);
    if divided.len() + 2 == corners.len() { divided } else { fan() }
}

impl Surface {
    /// The surface of triangles that are fine enough; vertices without a triangle are left out.
    pub(super) fn new(triangles: Triangles) -> Self {
        let Triangles { points, corners: triangles, .. } = compacted(triangles);
        let count = points.len();
        let mut sides: Vec<[usize; 2]> =
            triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let (mut areas, mut normals) = (vec![0.0; count], vec![DVec3::ZERO; count]);
        for t in &triangles {
            let [a, b, c] = t.map(|i| points[i]);
            let normal = (b - a).cross(c - a) / 2.0;
            for &i in t {
                normals[i] += normal;
                areas[i] += normal.length() / 3.0;
            }
        }
        normals.iter_mut().for_each(|n| *n = n.normalize_or(DVec3::Z));
        let (mut rim_next, mut rim_before) = (vec![NONE; count], vec![NONE; count]);
        sides.sort_unstable();
        for &[a, b] in &sides {
            if sides.binary_search(&[b, a]).is_err() {
                (rim_next[a], rim_before[b]) = (b, a);
            }
        }
        let mut edges: Vec<[usize; 2]> = sides.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let links = Links::of_edges(count, &edges);
        let is_corner = Vec::new();
        let mut made = Self {
            points,
            triangles,
            edges,
            links,
            areas,
            normals,
            rim_next,
            rim_before,
            is_corner,
            creases: Creases::default(),
            pins: Pins::default(),
            masks: Vec::new(),
        };
        made.is_corner = (0..count).map(|v| made.turns_at(v)).collect();
        made
    }

    fn turns_at(&self, v: usize) -> bool {
        let (before, next) = (self.rim_before[v], self.rim_next[v]);
        if before == NONE || next == NONE {
            return false;
        }
        let (a, b) = (self.points[v] - self.points[before], self.points[next] - self.points[v]);
        a.dot(b) < CORNER_TURN.to_radians().cos() * a.length() * b.length()
    }

    /// Whether a vertex lies on a rim.
    pub(super) fn is_rim(&self, v: usize) -> bool {
        self.rim_next[v] != NONE
    }

    /// The area, in squared panel sizes.
    pub(super) fn area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// The mirror planes that a vertex lies on.
    pub(super) fn mask(&self, v: usize) -> u8 {
        self.masks.get(v).copied().unwrap_or(0)
    }

    /// How much of a panel in the middle of a vertex there is: the rest lies across mirror planes.
    pub(super) fn share(&self, v: usize) -> f64 {
        0.5_f64.powi(self.mask(v).count_ones() as i32)
    }

    /// Whether a vertex lies on a rim that is no mirror plane.
    pub(super) fn is_outer_rim(&self, v: usize) -> bool {
        self.is_rim(v) && self.mask(v) == 0
    }

    /// A vertex, or one on the mirror planes that it is within `reach` of.
    pub(super) fn snapped(&self, v: usize, reach: f64) -> usize {
        let place = self.points[v];
        let planes = self.masks.iter().fold(0, |all, mask| all | mask);
        let is_near = |axis: &usize| planes >> axis & 1 == 1 && place[*axis] < reach;
        let wanted = (0..3).filter(is_near).fold(self.mask(v), |mask, axis| mask | 1 << axis);
        if wanted == self.mask(v) { v } else { self.nearest_with(wanted, place).unwrap_or(v) }
    }

    /// The vertex on some mirror planes that is nearest to a place.
    pub(super) fn nearest_with(&self, mask: u8, place: DVec3) -> Option<usize> {
        let off = |v: usize| self.points[v].distance_squared(place);
        let on = (0..self.masks.len()).filter(|&v| self.masks[v] & mask == mask);
        on.min_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)))
    }

    /// For how many panels there is room, those of given size counted as one.
    pub(super) fn room(&self) -> f64 {
        let whole = self.area() / PANEL_AREA;
        self.pins.areas.iter().flatten().fold(whole, |room, area| room - area + 1.0)
    }

    /// The unit direction of the rim at a vertex on it: from the vertex before to the next.
    pub(super) fn rim_direction(&self, v: usize) -> DVec3 {
        (self.points[self.rim_next[v]] - self.points[self.rim_before[v]]).normalize_or_zero()
    }

    /// The vertex nearest to a place, by walking downhill from a vertex near it. Walking keeps to
    /// the sheet of the surface on which it starts.
    pub(super) fn nearest(&self, place: DVec3, from: usize) -> usize {
        let (mut best, mut least) = (from, self.points[from].distance_squared(place));
        loop {
            let before = best;
            // Needles may hide a way down that is two edges long.
            let ring = self.links.of(before);
            let nearest = |best: (usize, f64), &v: &usize| {
                let distance = self.points[v].distance_squared(place);
                if distance < best.1 { (v, distance) } else { best }
            };
            (best, least) = ring.iter().fold((best, least), nearest);
            if best == before {
                let wider = ring.iter().flat_map(|&v| self.links.of(v));
                (best, least) = wider.fold((best, least), nearest);
            }
            if best == before {
                return best;
            }
        }
    }

    /// The vertices on each rim, in order, one list for each.
    pub(super) fn rims(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.points.len()];
        let mut rims = Vec::new();
        for start in 0..self.points.len() {
            let (mut rim, mut v) = (Vec::new(), start);
            while v != NONE && self.is_rim(v) && !seen[v] {
                seen[v] = true;
                rim.push(v);
                v = self.rim_next[v];
            }
            if !rim.is_empty() {
                rims.push(rim);
            }
        }
        rims
    }
}

/// Without the points that no triangle uses.
fn compacted(triangles: Triangles) -> Triangles {
    let mut number = vec![NONE; triangles.points.len()];
    triangles.corners.iter().flatten().for_each(|&i| number[i] = 0);
    let mut points = Vec::new();
    for (i, &p) in triangles.points.iter().enumerate() {
        if number[i] == 0 {
            number[i] = points.len();
            points.push(p);
        }
    }
    let corners = triangles.corners.iter().map(|t| t.map(|i| number[i])).collect();
    Triangles { points, corners, creases: BTreeSet::new() }
}
