//! Gauss–Newton on corners and planes together.
//!
//! Corners *and* planes are unknowns (after Tang, Sun, Gomes, Wallner, Pottmann 2014, "Form-finding
//! with polyhedral meshes made simple"): where the surface is developable, neighbouring planes
//! hardly meet in points, while corners that are wanted to lie in planes always do. A plane is
//! coupled with its own corners only, so it is eliminated face by face, and what is solved for is
//! the corners alone. The terms stand in `terms`, what one face adds to the system in
//! `element`.

mod element;
mod lengths;
mod planes;
mod rim;
mod symmetry;
mod terms;

use glam::{DMat3, DVec3};

use self::element::Element;
use self::lengths::Wanted;
pub(super) use self::lengths::wanted_lengths;
pub(super) use self::planes::FacePlane;
pub(super) use self::rim::{RimRow, RimRule, rim_plane_without_rim};
pub(super) use self::symmetry::Symmetry;
pub(super) use self::terms::{Limits, Weights};
use super::curvature::{Height, Quadric};
use super::regions::{Kind, Panels};
use super::surface::{NONE, Surface};
use crate::geom::fronts::{BlockMatrix, FrontFactor, Fronts};

/// No corner goes farther in one round, in panel sizes.
const LONGEST_STEP: f64 = 0.3;
/// The least shift of Levenberg's.
const LEAST_SHIFT: f64 = 1e-6;
/// Families weigh so much of their weight in the first round.
const SOFT_FAMILY: f64 = 0.01;
/// The shift with which lengths of families are made alike: more than rounding, since they need not
/// all be possible.
const FAMILY_SHIFT: f64 = 1e-5;
/// Shifts that are tried in a round.
const SHIFTS: usize = 5;

/// What does not change while panels are solved for.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub surface: &'a Surface,
    pub quadrics: &'a [Quadric],
    pub limits: &'a Limits,
    pub rule: &'a RimRule,
    /// The planes of the first faces, which are given.
    pub fixed: &'a [FacePlane],
}

/// The panels with their planes, and what is known of them between rounds.
#[derive(Clone)]
pub(super) struct State {
    pub panels: Panels,
    pub planes: Vec<FacePlane>,
    /// The planes of the first faces, if they are given: they are no unknowns.
    pub fixed: Vec<FacePlane>,
    /// The area that each face should have.
    pub areas: Vec<f64>,
    /// Faces whose hinges were broken for long weigh more.
    pub stress: Vec<f64>,
    /// The faces at each corner.
    pub fans: Vec<Vec<usize>>,
    /// For each face its neighbour across each side; [`NONE`] at a rim.
    pub across: Vec<Vec<usize>>,
    /// Corners that are images of each other.
    pub symmetry: Option<Symmetry>,
    /// For each corner the face that carries its own terms.
    owners: Vec<usize>,
    shift: f64,
}

/// What the terms of a round look at besides the panels.
struct Round<'a> {
    /// Where the corners were at the start.
    start: &'a [DVec3],
    rim: Vec<RimRow>,
    /// For each corner the node there, if its plates reach too far.
    nodes: Vec<Option<terms::Node>>,
    /// The lengths that edges are drawn to; empty when they are free.
    lengths: Wanted,
}

/// Which unknowns a run solves for.
struct Unknowns {
    /// The node of each corner; [`NONE`] where it stays.
    node: Vec<usize>,
    corners: Vec<usize>,
    /// The faces with a corner that moves.
    faces: Vec<usize>,
    fronts: Fronts,
}

impl State {
    /// The state of some panels; `areas` as in [`Self::areas`].
    pub(super) fn new(
        panels: Panels,
        areas: Vec<f64>,
        symmetry: Option<Symmetry>,
        scene: Scene<'_>,
    ) -> Self {
        let stress = vec![1.0; panels.faces.len()];
        let (fans, across, planes, owners) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (shift, fixed) = (LEAST_SHIFT, scene.fixed.to_vec());
        let mut made =
            Self { panels, planes, fixed, areas, stress, fans, across, symmetry, owners, shift };
        if let Some(symmetry) = &made.symmetry {
            symmetry.spread(&mut made.panels.points);
        }
        made.link();
        made.fit_planes(scene);
        made
    }

    /// Looks up fans and neighbours again after faces changed.
    pub(super) fn link(&mut self) {
        self.fans = self.panels.fans();
        self.owners = match &self.symmetry {
            Some(symmetry) => symmetry.owners(&self.panels.faces),
            None => self.fans.iter().map(|fan| fan.first().copied().unwrap_or(NONE)).collect(),
        };
        self.across = (0..self.panels.faces.len())
            .map(|f| {
                let face = &self.panels.faces[f];
                (0..face.len())
                    .map(|i| self.other_side(f, face[i], face[(i + 1) % face.len()]))
                    .collect()
            })
            .collect();
    }

    /// The face that runs along an edge from v to u, where f runs from u to v.
    fn other_side(&self, f: usize, u: usize, v: usize) -> usize {
        let runs = |&g: &usize| {
            let face = &self.panels.faces[g];
            (0..face.len()).any(|i| face[i] == v && face[(i + 1) % face.len()] == u)
        };
        self.fans[u].iter().copied().find(|g| *g != f && runs(g)).unwrap_or(NONE)
    }

    /// Whether the face does not touch the rim.
    fn is_inner_face(&self, f: usize) -> bool {
        !self.panels.is_rim_face(f)
    }

    /// The surface at a place near a corner.
    fn height(&self, scene: Scene<'_>, place: DVec3, hint: usize) -> Height {
        scene.quadrics[scene.surface.nearest(place, hint)].height(place)
    }

    /// Fits the plane of every face to its corners, on the side of the surface.
    pub(super) fn fit_planes(&mut self, scene: Scene<'_>) {
        self.planes = (0..self.panels.faces.len())
            .map(|f| {
                let centre = self.panels.centre(f);
                let hint = self.panels.hint(f);
                let up = self.height(scene, centre, hint).normal;
                match self.fixed.get_mut(f) {
                    None => FacePlane::fit(&self.panels, f, up),
                    Some(fixed) => {
                        *fixed = fixed.facing(up);
                        fixed.moved_to(centre)
                    }
                }
            })
            .collect();
    }

    /// What takes the place that is solved for to a corner.
    fn image(&self, v: usize) -> DMat3 {
        self.symmetry.as_ref().map_or(DMat3::IDENTITY, |symmetry| symmetry.image[v])
    }

    /// Whether a face is the first of its kind, and its terms are summed up.
    fn is_first_face(&self, f: usize) -> bool {
        self.symmetry.as_ref().is_none_or(|symmetry| symmetry.is_first_face[f])
    }

    /// Whether a face carries the terms of an edge, of the two faces there.
    fn carries_edge(&self, f: usize, other: usize) -> bool {
        other == NONE || other > f || !self.is_first_face(other)
    }

    /// Puts images where the corners that are solved for say.
    pub(super) fn spread(&mut self) {
        if let Some(symmetry) = &self.symmetry {
            symmetry.spread(&mut self.panels.points);
        }
    }

    /// Moves images after those that were solved for, and their planes.
    fn follow_firsts(&mut self) {
        let Some(symmetry) = &self.symmetry else { return };
        symmetry.spread(&mut self.panels.points);
        for f in 0..self.planes.len() {
            if !symmetry.is_first_face[f] {
                self.planes[f] = FacePlane::fit(&self.panels, f, self.planes[f].normal);
            }
        }
    }

    /// Runs so many rounds; corners with a face where `active` is false stay. `from` and `to` are
    /// the weights of planarity at the beginning and the end. Ends early when `stop` says so.
    pub(super) fn run(
        &mut self,
        scene: Scene<'_>,
        run: Run<'_>,
        mut stop: impl FnMut(usize) -> bool,
    ) {
        let Some(unknowns) = self.unknowns(run.active) else { return };
        let start = self.panels.points.clone();
        for round in 0..run.rounds {
            if stop(round) {
                return;
            }
            let share = (round as f64 / (0.7 * run.rounds as f64).max(1.0)).min(1.0);
            let planarity = run.from * (run.to / run.from).powf(share);
            // Families are asked for softly first, so that edges find the nearest.
            let family = run.weights.family * SOFT_FAMILY.powf(1.0 - share);
            let weights = Weights { planarity, family, ..run.weights };
            let lengths = run.families.map(|count| wanted_lengths(&self.panels, count));
            let lengths = lengths.unwrap_or_default();
            self.round(scene, &unknowns, &weights, (&start, round, lengths));
        }
    }

    /// One round: sum up the terms, solve, step.
    fn round(
        &mut self,
        scene: Scene<'_>,
        unknowns: &Unknowns,
        weights: &Weights,
        (start, round, lengths): (&[DVec3], usize, Wanted),
    ) {
        self.follow_surface(scene, unknowns);
        let (rim, nodes) = (RimRow::all(scene, &self.panels), self.far_nodes());
        let terms = Round { start, rim, nodes, lengths };
        let mut elements: Vec<Element> =
            unknowns.faces.iter().map(|&f| self.element(scene, f, weights, &terms)).collect();
        if round % 4 == 3 {
            self.adapt_stress(unknowns, scene.limits);
        }
        self.shift = (self.shift * 0.3).max(LEAST_SHIFT);
        for attempt in 1..=SHIFTS {
            let Some(steps) = self.solve(unknowns, &mut elements) else {
                self.shift = (self.shift * 10.0).max(1e-4);
                continue;
            };
            let largest = steps.iter().map(|s| s.abs().max_element()).fold(0.0, f64::max);
            if largest < 2.0 * LONGEST_STEP || attempt == SHIFTS {
                self.step(unknowns, &elements, &steps);
                return;
            }
            self.shift = (self.shift * 10.0).max(1e-4);
        }
    }

    /// The steps of the corners at the present shift.
    fn solve(&self, unknowns: &Unknowns, elements: &mut [Element]) -> Option<Vec<DVec3>> {
        let mut matrix = unknowns.fronts.zeros();
        let mut right = vec![0.0; 3 * unknowns.corners.len()];
        for (clique, element) in elements.iter_mut().enumerate() {
            let face = &self.panels.faces[unknowns.faces[clique]];
            element.eliminate_plane(self.shift)?;
            let local: Vec<usize> =
                (0..face.len()).filter(|&i| unknowns.node[face[i]] != NONE).collect();
            if self.symmetry.is_some() {
                let image = |i: usize| (i, unknowns.node[face[i]], self.image(face[i]));
                let images: Vec<(usize, usize, DMat3)> = local.into_iter().map(image).collect();
                add_images(unknowns, clique, element, &images, &mut matrix);
                for (i, node, image) in images {
                    let slope = DVec3::from_slice(&element.slope[3 * i..]);
                    let slope = (image.transpose() * slope).to_array();
                    (0..3).for_each(|a| right[3 * node + a] -= slope[a]);
                }
                continue;
            }
            add_element(unknowns, clique, element, &local, &mut matrix);
            for &i in &local {
                let node = unknowns.node[face[i]];
                (0..3).for_each(|a| right[3 * node + a] -= element.slope[3 * i + a]);
            }
        }
        let factor: FrontFactor<'_> = unknowns.fronts.factor(matrix, self.shift)?;
        let solved = factor.solve(&right);
        let steps: Vec<DVec3> = solved.chunks_exact(3).map(DVec3::from_slice).collect();
        steps.iter().all(|s| s.is_finite()).then_some(steps)
    }

    /// Moves corners and planes, none of them too far.
    fn step(&mut self, unknowns: &Unknowns, elements: &[Element], steps: &[DVec3]) {
        for (&f, element) in unknowns.faces.iter().zip(elements) {
            let moved: Vec<DVec3> = self.panels.faces[f]
                .iter()
                .map(|&v| match unknowns.node[v] {
                    NONE => DVec3::ZERO,
                    node => self.image(v) * steps[node],
                })
                .collect();
            let step = element.plane_step(&moved).clamp_length_max(LONGEST_STEP);
            self.planes[f] = self.planes[f].stepped(step);
        }
        for (&v, step) in unknowns.corners.iter().zip(steps) {
            self.panels.points[v] += step.clamp_length_max(LONGEST_STEP);
        }
        self.follow_firsts();
        for &f in &unknowns.faces {
            // A given plane is never written anew, so it stays to the last digit.
            let plane = self.fixed.get(f).unwrap_or(&self.planes[f]);
            self.planes[f] = plane.moved_to(self.panels.centre(f));
        }
    }

    /// Keeps the hint of each corner at the vertex of the surface that is nearest now.
    fn follow_surface(&mut self, scene: Scene<'_>, unknowns: &Unknowns) {
        for v in (0..self.panels.points.len()).filter(|&v| unknowns.node[v] != NONE) {
            let Panels { points, hints, kinds, .. } = &mut self.panels;
            hints[v] = match kinds[v] {
                Kind::Inner => scene.surface.nearest(points[v], hints[v]),
                Kind::Rim => rim::nearest_on_rim(scene.surface, points[v], hints[v]),
                Kind::Crease => rim::nearest_on_crease(scene.surface, points[v], hints[v]),
                Kind::Corner | Kind::Kept => hints[v],
            };
        }
    }

    /// Corners that move, the faces at them, and the pattern of the system; `None` without any.
    fn unknowns(&self, active: Option<&[bool]>) -> Option<Unknowns> {
        let moves = |v: usize| {
            !self.fans[v].is_empty()
                && !self.panels.held.contains_key(&v)
                && self.fans[v].iter().all(|&f| active.is_none_or(|a| a[f]))
        };
        let is_first = |v: usize| self.symmetry.as_ref().is_none_or(|s| s.first[v] == v);
        let corners = (0..self.panels.points.len()).filter(|&v| moves(v) && is_first(v));
        let corners: Vec<usize> = corners.collect();
        let mut node = vec![NONE; self.panels.points.len()];
        corners.iter().enumerate().for_each(|(i, &v)| node[v] = i);
        if let Some(symmetry) = &self.symmetry {
            node = symmetry.first.iter().map(|&v| node[v]).collect();
        }
        let nodes = |f: usize| -> Vec<usize> {
            let nodes = self.panels.faces[f].iter().map(|&v| node[v]).filter(|&n| n != NONE);
            if self.symmetry.is_some() { without_repeats(nodes) } else { nodes.collect() }
        };
        let faces: Vec<usize> = (0..self.panels.faces.len())
            .filter(|&f| self.is_first_face(f) && !nodes(f).is_empty())
            .collect();
        if faces.is_empty() {
            return None;
        }
        let places: Vec<DVec3> = corners.iter().map(|&v| self.panels.points[v]).collect();
        let cliques = faces.iter().map(|&f| nodes(f)).collect();
        Some(Unknowns { node, corners, faces, fronts: Fronts::new(&places, cliques, 3) })
    }

    /// The last rounds: nothing but planarity and hard rims, each step the least that keeps them to
    /// first order. Returns how far the corners are from their planes then, in panel sizes.
    pub(super) fn polish(&mut self, scene: Scene<'_>, rounds: usize) -> f64 {
        let Some(unknowns) = self.unknowns(None) else { return 0.0 };
        let shift = std::mem::replace(&mut self.shift, 1e-10);
        let mut best: Option<(f64, Self)> = None;
        let free = Wanted::new();
        for _ in 0..rounds {
            let rim = RimRow::all(scene, &self.panels);
            let mut elements: Vec<Element> =
                unknowns.faces.iter().map(|&f| self.polish_element(f, &rim, &free)).collect();
            let Some(steps) = self.solve(&unknowns, &mut elements) else { break };
            self.step(&unknowns, &elements, &steps);
            let lack = self.lack(scene);
            if best.as_ref().is_none_or(|(least, _)| lack < *least) {
                best = Some((lack, self.clone()));
            }
            if lack < 1e-15 {
                break;
            }
        }
        let lack = best.map_or(f64::INFINITY, |(lack, state)| {
            *self = state;
            lack
        });
        self.shift = shift;
        lack
    }

    /// Rounds of nothing but planarity, hard rims and the lengths of so many families, by the least
    /// steps, as long as they come nearer.
    pub(super) fn polish_families(&mut self, scene: Scene<'_>, rounds: usize, count: usize) {
        let Some(unknowns) = self.unknowns(None) else { return };
        let shift = std::mem::replace(&mut self.shift, FAMILY_SHIFT);
        let wanted = wanted_lengths(&self.panels, count);
        let off = |state: &Self| {
            let ends =
                |&[u, v]: &[usize; 2]| state.panels.points[u].distance(state.panels.points[v]);
            let lengths = wanted.iter().map(|(edge, length)| (ends(edge) - length).powi(2));
            lengths.sum::<f64>().sqrt() + state.lack(scene)
        };
        let (mut least, mut best) = (off(self), self.clone());
        for _ in 0..rounds {
            let rim = RimRow::all(scene, &self.panels);
            let mut elements: Vec<Element> =
                unknowns.faces.iter().map(|&f| self.polish_element(f, &rim, &wanted)).collect();
            let Some(steps) = self.solve(&unknowns, &mut elements) else { break };
            self.step(&unknowns, &elements, &steps);
            let now = off(self);
            if now >= least {
                break;
            }
            (least, best) = (now, self.clone());
        }
        *self = best;
        self.shift = shift;
    }

    /// The largest distance of a corner from one of its planes or from a hard rim.
    fn lack(&self, scene: Scene<'_>) -> f64 {
        let faces = self.panels.faces.iter().zip(&self.planes);
        let planes = faces.flat_map(|(face, plane)| {
            face.iter().map(|&v| plane.distance(self.panels.points[v]).abs())
        });
        let rims = RimRow::all(scene, &self.panels);
        let rims = rims.iter().filter(|row| row.is_hard);
        let rims = rims.map(|row| row.distance(self.panels.points[row.corner]).abs());
        planes.chain(rims).fold(0.0, f64::max)
    }
}

/// One run of rounds.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub rounds: usize,
    /// The weight of planarity in the first round and at the end.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    pub weights: Weights,
    /// Faces whose corners may move; all without it.
    pub active: Option<&'a [bool]>,
    /// Into how many families of one length edges are drawn; none without it.
    pub families: Option<usize>,
}

/// Adds the part of an element that belongs to corners that move.
fn add_element(
    unknowns: &Unknowns,
    clique: usize,
    element: &Element,
    local: &[usize],
    matrix: &mut BlockMatrix,
) {
    let size = 3 * local.len();
    let mut block = vec![0.0; size * size];
    for (i, &li) in local.iter().enumerate() {
        for (j, &lj) in local.iter().enumerate() {
            for a in 0..3 {
                for b in 0..3 {
                    block[(3 * i + a) * size + 3 * j + b] = element.reduced(3 * li + a, 3 * lj + b);
                }
            }
        }
    }
    unknowns.fronts.add(matrix, clique, &block);
}

/// Each of some numbers once, in the order in which they come first.
fn without_repeats(all: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut kept = Vec::new();
    for one in all {
        if !kept.contains(&one) {
            kept.push(one);
        }
    }
    kept
}

/// Adds an element of which several corners may be images of one place: each by its number in the
/// face, its node and what takes that to it.
fn add_images(
    unknowns: &Unknowns,
    clique: usize,
    element: &Element,
    images: &[(usize, usize, DMat3)],
    matrix: &mut BlockMatrix,
) {
    let nodes = without_repeats(images.iter().map(|&(_, node, _)| node));
    let place = |node: usize| nodes.iter().position(|&n| n == node).unwrap_or(0);
    let size = 3 * nodes.len();
    let mut block = vec![0.0; size * size];
    for &(i, node_i, image_i) in images {
        for &(j, node_j, image_j) in images {
            let column = |b: usize| [0, 1, 2].map(|a| element.reduced(3 * i + a, 3 * j + b));
            let own = DMat3::from_cols_array_2d(&[0, 1, 2].map(column));
            let mut own = image_i.transpose() * own * image_j;
            if i == j {
                // Ways that are not open to a place are settled: it does not go them.
                own += DMat3::IDENTITY - image_i.transpose() * image_i;
            }
            let (row, col) = (3 * place(node_i), 3 * place(node_j));
            for a in 0..3 {
                for b in 0..3 {
                    block[(row + a) * size + col + b] += own.col(b)[a];
                }
            }
        }
    }
    unknowns.fronts.add(matrix, clique, &block);
}
