//! The terms that are summed up, each a residual without dimension and its derivatives. All lengths
//! are in panel sizes.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::super::refine::edge;
use super::super::regions::Kind;
use super::super::surface::PANEL_AREA;
use super::element::Element;
use super::lengths::Wanted;
use super::{RimRow, Round, Scene, State, Unknowns};

/// What each term weighs.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Weights {
    /// Corners lie in their planes.
    pub planarity: f64,
    /// Corners lie on the surface.
    pub corner: f64,
    /// The middles of faces lie on the surface; with corners on it, too, faces stand out on both
    /// sides alike.
    pub centre: f64,
    /// Planes are tangent.
    pub tangent: f64,
    /// Neighbouring corners move alike.
    pub smooth: f64,
    /// Corners stay where they start.
    pub anchor: f64,
    /// Inner hexagons are symmetric about their middle.
    pub symmetry: f64,
    /// The middles of inner faces lie amid those of their neighbours.
    pub lattice: f64,
    /// Faces are star-shaped about their middle.
    pub star: f64,
    /// Edges are not too short.
    pub edge: f64,
    /// Areas are within bounds.
    pub area: f64,
    /// Angles are not too sharp.
    pub angle: f64,
    /// Corners and middles of faces are not far from the surface.
    pub far: f64,
    /// Plates do not reach far from their nodes.
    pub node: f64,
    /// Corners at a rim lie on its curve.
    pub rim: f64,
    /// Edges have the length of their family.
    pub family: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self {
            planarity: 1.0,
            corner: 1.0,
            centre: 1.0,
            tangent: 0.05,
            smooth: 0.07,
            anchor: 0.01,
            symmetry: 0.12,
            lattice: 0.06,
            star: 1.0,
            edge: 0.5,
            area: 0.5,
            angle: 0.3,
            far: 2.0,
            node: 0.05,
            rim: 2.0,
            family: 0.0,
        }
    }
}

/// From where on hinges act: terms that are zero on their good side.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Limits {
    /// Twice the least area of the triangle of a side and the middle of its face; 0.289 in a
    /// regular hexagon.
    pub star: f64,
    /// The shortest edge.
    pub edge: f64,
    /// Least and largest area over what it should be, for inner faces.
    pub area: [f64; 2],
    /// The same for faces at a rim.
    pub rim_area: [f64; 2],
    /// The smallest angle, in radians; angles are kept as far from a full turn.
    pub angle: f64,
    /// Farther off the surface, corners and middles of faces count more.
    pub deviation: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            star: 0.06,
            edge: 0.18,
            area: [0.6, 1.45],
            rim_area: [0.4, 1.6],
            angle: 25_f64.to_radians(),
            deviation: 0.025,
        }
    }
}

/// Edges that are very short, and faces that are hardly star-shaped, weigh at most so much more.
const MOST_STRESS: f64 = 40.0;

/// Corners of plates of thickness 1 may stand so far from where a smooth surface would have them.
const NEAR_NODE: f64 = 0.6;

/// A node with plates that reach too far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Where their corner should be, for the thickness 1.
    near: DVec3,
    /// How much the planes differ: the square of the largest angle from their mean.
    spread: f64,
}

/// Where the corner of plates of thickness 1 is: the shortest vector that has the product 1 with
/// all three normals.
fn corner_way(normals: [DVec3; 3]) -> DVec3 {
    let rows = DMat3::from_cols(normals[0], normals[1], normals[2]);
    let gram = rows.transpose() * rows + DMat3::from_diagonal(DVec3::splat(1e-12));
    // n · (mean + w) = 1, where n · mean = 1 − |n − mean|² / 2.
    let mean = (normals[0] + normals[1] + normals[2]).normalize_or_zero();
    let lack = DVec3::from_array(normals.map(|n| n.distance_squared(mean) / 2.0));
    mean + rows * (gram.inverse() * lack)
}

/// A face as its terms see it.
struct View {
    face: usize,
    corners: Vec<usize>,
    places: Vec<DVec3>,
    centre: DVec3,
    normal: DVec3,
}

impl View {
    fn new(state: &State, face: usize) -> Self {
        let corners = state.panels.faces[face].clone();
        let places = corners.iter().map(|&v| state.panels.points[v]).collect();
        let (centre, normal) = (state.panels.centre(face), state.planes[face].normal);
        Self { face, corners, places, centre, normal }
    }

    fn len(&self) -> usize {
        self.corners.len()
    }

    /// Twice the area of the triangle of the i-th side and the middle.
    fn star(&self, i: usize) -> f64 {
        let (a, b) = (self.places[i] - self.centre, self.places[self.next(i)] - self.centre);
        a.cross(b).dot(self.normal)
    }

    fn next(&self, i: usize) -> usize {
        (i + 1) % self.len()
    }

    fn before(&self, i: usize) -> usize {
        (i + self.len() - 1) % self.len()
    }
}

impl State {
    /// All terms of a face.
    pub(super) fn element(
        &self,
        scene: Scene<'_>,
        f: usize,
        weights: &Weights,
        round: &Round<'_>,
    ) -> Element {
        let view = View::new(self, f);
        let mut element = Element::new(view.len(), f < self.fixed.len());
        self.planarity(&view, weights.planarity, &mut element);
        self.closeness(scene, &view, weights, &mut element);
        self.star_shape(&view, scene.limits, weights.star, &mut element);
        self.edges(&view, scene.limits, weights.edge, &mut element);
        self.area(&view, scene.limits, weights.area, &mut element);
        angles(&view, scene.limits, weights.angle, &mut element);
        self.movement(&view, weights, round.start, &mut element);
        self.nodes(&view, weights.node, &round.nodes, &mut element);
        self.lengths(&view, weights.family, &round.lengths, &mut element);
        if self.is_inner_face(f) {
            self.regularity(&view, weights, &mut element);
        }
        for i in self.owned(&view) {
            for row in rows_of(&round.rim, view.corners[i]) {
                let weight = if row.is_hard { weights.planarity } else { weights.rim };
                element.by(i, row.normal).residual(row.distance(view.places[i]), weight);
            }
        }
        element
    }

    /// Planarity and hard rims alone, and lengths if there are any.
    pub(super) fn polish_element(&self, f: usize, rim: &[RimRow], lengths: &Wanted) -> Element {
        let view = View::new(self, f);
        let mut element = Element::new(view.len(), f < self.fixed.len());
        self.planarity(&view, 1.0, &mut element);
        self.lengths(&view, 1.0, lengths, &mut element);
        for i in self.owned(&view) {
            for row in rows_of(rim, view.corners[i]).iter().filter(|row| row.is_hard) {
                element.by(i, row.normal).residual(row.distance(view.places[i]), 1.0);
            }
        }
        element
    }

    /// Corners whose own terms this face carries: those of which it is the first face.
    fn owned(&self, view: &View) -> Vec<usize> {
        (0..view.len()).filter(|&i| self.owners[view.corners[i]] == view.face).collect()
    }

    /// Corners lie in the plane: (x − c) · n. The plane's unknowns are its tilts and its way.
    fn planarity(&self, view: &View, weight: f64, element: &mut Element) {
        let plane = self.planes[view.face];
        let [first, second] = plane.axes();
        for (i, &place) in view.places.iter().enumerate() {
            let way = place - plane.point;
            element.by(i, plane.normal);
            element.by_plane(0, way.dot(first)).by_plane(1, way.dot(second)).by_plane(2, -1.0);
            element.residual(way.dot(plane.normal), weight);
        }
    }

    /// Corners and the middle of the face lie on the surface (Liu, Pottmann, Wallner, Yang, Wang
    /// 2006), and the plane is tangent.
    fn closeness(&self, scene: Scene<'_>, view: &View, weights: &Weights, element: &mut Element) {
        let is_off_creases = |&i: &usize| !self.panels.kinds[view.corners[i]].is_on_crease();
        for i in self.owned(view).into_iter().filter(is_off_creases) {
            let quadric = &scene.quadrics[self.panels.hints[view.corners[i]]];
            let height = quadric.height(view.places[i]);
            element.by(i, height.normal).residual(height.distance, weights.corner);
            let far = beyond(height.distance, scene.limits.deviation);
            if far != 0.0 {
                element.by(i, height.normal).residual(far, weights.far);
            }
        }
        let height = self.height(scene, view.centre, self.panels.hint(view.face));
        let share = 1.0 / view.len() as f64;
        for i in 0..view.len() {
            element.by(i, height.normal * share);
        }
        element.residual(height.distance, weights.centre);
        let far = beyond(height.distance, scene.limits.deviation);
        if far != 0.0 {
            for i in 0..view.len() {
                element.by(i, height.normal * share);
            }
            element.residual(far, weights.far);
        }
        let off = self.planes[view.face].normal - height.normal;
        for (unknown, axis) in self.planes[view.face].axes().into_iter().enumerate() {
            element.by_plane(unknown, 1.0).residual(off.dot(axis), weights.tangent);
        }
    }

    /// Every side turns about the middle with the surface, so that the face is a simple polygon.
    fn star_shape(&self, view: &View, limits: &Limits, weight: f64, element: &mut Element) {
        let share = 1.0 / view.len() as f64;
        for i in 0..view.len() {
            let star = view.star(i);
            if star >= limits.star {
                continue;
            }
            let j = view.next(i);
            let (a, b) = (view.places[i] - view.centre, view.places[j] - view.centre);
            let (by_a, by_b) = (b.cross(view.normal), view.normal.cross(a));
            let by_centre = -(by_a + by_b) * share;
            for k in 0..view.len() {
                let own = if k == i {
                    by_a
                } else if k == j {
                    by_b
                } else {
                    DVec3::ZERO
                };
                element.by(k, own + by_centre);
            }
            element.residual(star - limits.star, weight / limits.star * self.stress[view.face]);
        }
    }

    /// No edge is too short. Of the two faces at an edge the one with the lower number carries it.
    fn edges(&self, view: &View, limits: &Limits, weight: f64, element: &mut Element) {
        for i in 0..view.len() {
            let other = self.across[view.face][i];
            let j = view.next(i);
            let way = view.places[j] - view.places[i];
            let length = way.length();
            if !self.carries_edge(view.face, other) || length >= limits.edge {
                continue;
            }
            let direction = way / length.max(1e-9);
            let stress = (0.6 * limits.edge / length.max(1e-9)).clamp(1.0, MOST_STRESS);
            element.by(j, direction).by(i, -direction);
            element.residual(length - limits.edge, weight / limits.edge * stress.sqrt());
        }
    }

    /// Edges have the length that is wanted of them.
    fn lengths(&self, view: &View, weight: f64, wanted: &Wanted, element: &mut Element) {
        for i in 0..view.len() {
            let (j, other) = (view.next(i), self.across[view.face][i]);
            let ends = edge(view.corners[i], view.corners[j]);
            let Some(length) = wanted.get(&ends) else { continue };
            if self.carries_edge(view.face, other) {
                let way = view.places[j] - view.places[i];
                let direction = way / way.length().max(1e-9);
                element.by(j, direction).by(i, -direction);
                element.residual(way.length() - length, weight);
            }
        }
    }

    /// The area is between bounds.
    fn area(&self, view: &View, limits: &Limits, weight: f64, element: &mut Element) {
        let full = 2.0 * PANEL_AREA * self.areas[view.face];
        let area = (0..view.len()).map(|i| view.star(i)).sum::<f64>() / full;
        let [low, high] = if self.is_inner_face(view.face) { limits.area } else { limits.rim_area };
        let off = (area - low).min(0.0) + (area - high).max(0.0);
        if off == 0.0 {
            return;
        }
        for i in 0..view.len() {
            let chord = view.places[view.next(i)] - view.places[view.before(i)];
            element.by(i, chord.cross(view.normal) / full);
        }
        element.residual(off, weight);
    }

    /// Neighbouring corners move alike against the start, and no corner far.
    fn movement(&self, view: &View, weights: &Weights, start: &[DVec3], element: &mut Element) {
        let moved = |i: usize| view.places[i] - start[view.corners[i]];
        for i in 0..view.len() {
            let other = self.across[view.face][i];
            if !self.carries_edge(view.face, other) {
                continue;
            }
            let j = view.next(i);
            let apart = moved(i) - moved(j);
            for axis in DVec3::AXES {
                element.by(i, axis).by(j, -axis).residual(apart.dot(axis), weights.smooth);
            }
        }
        for i in self.owned(view) {
            for axis in DVec3::AXES {
                element.by(i, axis).residual(moved(i).dot(axis), weights.anchor);
            }
        }
    }

    /// Hexagons are symmetric about their middle, and faces lie amid their neighbours. The
    /// neighbours' middles are those of the round before: else the system would couple faces with
    /// the neighbours of their neighbours, and its factor would be eight times the work.
    fn regularity(&self, view: &View, weights: &Weights, element: &mut Element) {
        let count = view.len();
        let share = 1.0 / count as f64;
        if count == 6 {
            for i in 0..3 {
                let off = view.places[i] + view.places[i + 3] - view.centre * 2.0;
                for axis in DVec3::AXES {
                    for k in 0..6 {
                        let own = if k == i || k == i + 3 { 1.0 } else { 0.0 };
                        element.by(k, axis * (own - 1.0 / 3.0));
                    }
                    element.residual(off.dot(axis), weights.symmetry);
                }
            }
        }
        let amid: DVec3 =
            self.across[view.face].iter().map(|&g| self.panels.centre(g)).sum::<DVec3>() * share;
        for axis in DVec3::AXES {
            (0..count).for_each(|k| {
                element.by(k, axis * share);
            });
            element.residual((view.centre - amid).dot(axis), weights.lattice);
        }
    }

    /// Where plates would reach far from a node, its planes are tilted so that a nearer point will
    /// do for their corner: n · s = 1 with s held near. Such points s of all nodes are a mesh
    /// parallel to this one (Pottmann, Liu, Wallner, Bobenko, Wang 2007). Tilts count against those
    /// that the planes have to each other, however flat they meet.
    fn nodes(&self, view: &View, weight: f64, nodes: &[Option<Node>], element: &mut Element) {
        let plane = self.planes[view.face];
        for node in view.corners.iter().filter_map(|&v| nodes[v]) {
            for (unknown, axis) in plane.axes().into_iter().enumerate() {
                element.by_plane(unknown, node.near.dot(axis));
            }
            element.residual(plane.normal.dot(node.near) - 1.0, weight / node.spread);
        }
    }

    /// The nodes whose plates reach too far; for each corner.
    pub(super) fn far_nodes(&self) -> Vec<Option<Node>> {
        let node = |v: usize| {
            let &[a, b, c] = &self.fans[v][..] else { return None };
            let normals = [a, b, c].map(|f| self.planes[f].normal);
            let mean = (normals[0] + normals[1] + normals[2]).normalize_or_zero();
            let way = corner_way(normals) - mean;
            let spread = normals.iter().map(|n| n.distance_squared(mean)).fold(1e-5, f64::max);
            (way.length() > NEAR_NODE)
                .then(|| Node { near: mean + way.clamp_length_max(0.7 * NEAR_NODE), spread })
        };
        (0..self.panels.points.len()).map(node).collect()
    }

    /// Faces that stay broken weigh more and more, others less and less.
    pub(super) fn adapt_stress(&mut self, unknowns: &Unknowns, limits: &Limits) {
        for &f in &unknowns.faces {
            let least = self.least_star(f);
            let stress = &mut self.stress[f];
            *stress = if least < 0.4 * limits.star {
                (*stress * 2.0).min(MOST_STRESS)
            } else {
                (*stress * 0.7).max(1.0)
            };
        }
    }

    /// The side of a face that turns least about its middle: twice the area of its triangle.
    pub(in super::super) fn least_star(&self, f: usize) -> f64 {
        let view = View::new(self, f);
        (0..view.len()).map(|i| view.star(i)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a corner is not at the rim.
    pub(in super::super) fn is_inner_corner(&self, v: usize) -> bool {
        self.panels.kinds[v] == Kind::Inner
    }
}

/// No corner is a needle, and none is a slit.
fn angles(view: &View, limits: &Limits, weight: f64, element: &mut Element) {
    let least = limits.angle;
    for i in 0..view.len() {
        let (before, next) = (view.before(i), view.next(i));
        let a = view.places[before] - view.places[i];
        let b = view.places[next] - view.places[i];
        let angle = b.cross(a).dot(view.normal).atan2(a.dot(b)).rem_euclid(TAU);
        let off = (angle - least).min(0.0) + (angle - (TAU - least)).max(0.0);
        if off == 0.0 {
            continue;
        }
        let by_a = view.normal.cross(a) / (a.length_squared() + 1e-3);
        let by_b = -view.normal.cross(b) / (b.length_squared() + 1e-3);
        element.by(before, by_a).by(next, by_b).by(i, -(by_a + by_b));
        // Needles weigh more than corners that are only a little sharp.
        let stress = (off.abs() / (0.4 * least)).max(1.0);
        element.residual(off, weight / least * stress);
    }
}

/// By how much a distance is beyond a limit, with its sign.
fn beyond(distance: f64, limit: f64) -> f64 {
    (distance - limit).max(0.0) + (distance + limit).min(0.0)
}

/// The rows of a corner among those of all.
fn rows_of(rows: &[RimRow], corner: usize) -> &[RimRow] {
    let first = rows.partition_point(|row| row.corner < corner);
    let last = rows.partition_point(|row| row.corner <= corner);
    &rows[first..last]
}
