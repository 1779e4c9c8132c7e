//! Forests to start the search from: spanning trees of the faces by several rules.
//!
//! Every rule gives each edge a weight, and a least spanning forest (Kruskal 1956) keeps the light
//! ones as folds. Flat edges come first whatever the rule, so that plane regions stay whole.
//! Sources: steepest edge by Schlickenrieder 1997 ("Nets of polyhedra", 4.3: for one direction,
//! every vertex opens its steepest edge upwards; on a convex mesh these are a spanning tree of the
//! vertices), longest edges and edges along a direction in the same thesis, 4.2.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use super::dual::{Dual, FLAT, NONE};
use super::forest::Forest;
use super::sets::Sets;
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::random::Rng;

/// The rule that weighs the edges of one start.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rule {
    /// Edges that no vertex opens as its steepest way in a direction stay together.
    Steepest(DVec3),
    /// Long edges stay together; a fifth is chance.
    Longest,
    /// Edges along a direction stay together; a fifth is chance.
    Along(DVec3),
    /// Edges with a large fold angle × length stay together.
    Sharpest,
}

impl Rule {
    /// The rule of the given turn: two of three by steepest edges, the others by turns.
    pub fn of_turn(turn: usize, rng: &mut Rng) -> Self {
        match turn % 6 {
            2 => Self::Longest,
            5 => Self::Along(direction(rng)),
            _ => Self::Steepest(direction(rng)),
        }
    }
}

/// The spanning forest of a rule.
pub(super) fn forest(dual: &Dual, mesh: &Mesh, rule: Rule, rng: &mut Rng) -> Forest {
    let weights = weights(dual, mesh, rule, rng);
    spanning(dual, by_weight(dual, &weights))
}

/// The forest of given folds. A ring of them opens at the least fold angle × length, flat ones
/// last.
pub(super) fn folded(dual: &Dual, is_fold: &EdgeMap<bool>) -> Forest {
    let weights: Vec<f64> = dual.hinges.iter().map(|h| -h.fold * h.length).collect();
    let order = by_weight(dual, &weights);
    spanning(dual, order.into_iter().filter(|&h| is_fold[dual.edge(dual.hinges[h].sides[0])]))
}

/// The spanning forest of hinges in order.
fn spanning(dual: &Dual, order: impl IntoIterator<Item = usize>) -> Forest {
    let mut sets = Sets::new(dual.face_count());
    let mut kept = vec![false; dual.across.len()];
    for hinge in order {
        let sides = dual.hinges[hinge].sides;
        let [f, g] = sides.map(|s| dual.owner[s as usize]);
        if sets.join(f, g) {
            sides.into_iter().for_each(|s| kept[s as usize] = true);
        }
    }
    hang(dual, &kept)
}

/// Chains: every face keeps two folds at most, the flattest first and of nearly equal ones the
/// longest. Every vertex inside the mesh ends up on a seam, since a ring of folds around one would
/// be no chain.
pub(super) fn strips(dual: &Dual) -> Forest {
    /// How much duller a fold must be to come before one that is as much longer as any two edges
    /// can be, in radians.
    const STEP: f64 = 0.02;
    let longest = dual.hinges.iter().map(|h| h.length).fold(f64::MIN_POSITIVE, f64::max);
    let weights: Vec<f64> =
        dual.hinges.iter().map(|h| h.fold - STEP * h.length / longest).collect();
    let mut sets = Sets::new(dual.face_count());
    let mut folds = vec![0_u8; dual.face_count()];
    let mut kept = vec![false; dual.across.len()];
    for hinge in by_weight(dual, &weights) {
        let sides = dual.hinges[hinge].sides;
        let [f, g] = sides.map(|s| dual.owner[s as usize]);
        if folds[f as usize] < 2 && folds[g as usize] < 2 && sets.join(f, g) {
            [f, g].into_iter().for_each(|f| folds[f as usize] += 1);
            sides.into_iter().for_each(|s| kept[s as usize] = true);
        }
    }
    hang(dual, &kept)
}

/// The hinges: those to keep, then flat ones first, then by weight, then by number.
fn by_weight(dual: &Dual, weights: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..dual.hinges.len()).collect();
    let is_bent = |hinge: usize| (!dual.hinges[hinge].is_kept, dual.hinges[hinge].fold > FLAT);
    order.sort_by(|&a, &b| is_bent(a).cmp(&is_bent(b)).then(weights[a].total_cmp(&weights[b])));
    order
}

/// Parent pointers, breadth first from the lowest face of each tree.
fn hang(dual: &Dual, kept: &[bool]) -> Forest {
    let mut parent_side = vec![NONE; dual.face_count()];
    let mut seen = vec![false; dual.face_count()];
    let mut queue = VecDeque::new();
    for root in 0..dual.face_count() as u32 {
        if std::mem::replace(&mut seen[root as usize], true) {
            continue;
        }
        queue.push_back(root);
        while let Some(f) = queue.pop_front() {
            for s in dual.sides(f).filter(|&s| kept[s as usize]) {
                let t = dual.across[s as usize];
                let g = dual.owner[t as usize];
                if !std::mem::replace(&mut seen[g as usize], true) {
                    parent_side[g as usize] = t;
                    queue.push_back(g);
                }
            }
        }
    }
    Forest::new(dual, parent_side)
}

fn weights(dual: &Dual, mesh: &Mesh, rule: Rule, rng: &mut Rng) -> Vec<f64> {
    let longest = dual.hinges.iter().map(|h| h.length).fold(f64::MIN_POSITIVE, f64::max);
    let edge = |sides: [u32; 2]| dual.half_edges[sides[0] as usize].edge();
    match rule {
        Rule::Sharpest => dual.hinges.iter().map(|h| -h.fold * h.length).collect(),
        Rule::Longest => {
            dual.hinges.iter().map(|h| -h.length / longest + 0.2 * rng.unit()).collect()
        }
        Rule::Along(direction) => {
            let slope = |e: EdgeId| {
                let [a, b] = mesh.edge_positions(e);
                (b - a).normalize_or_zero().dot(direction).abs()
            };
            dual.hinges.iter().map(|h| -slope(edge(h.sides)) + 0.2 * rng.unit()).collect()
        }
        Rule::Steepest(direction) => {
            let opened = steepest(mesh, direction);
            dual.hinges
                .iter()
                .map(|h| f64::from(u8::from(opened[edge(h.sides)])) - 0.5 * h.length / longest)
                .collect()
        }
    }
}

/// The edges that some vertex opens: its steepest one upwards.
fn steepest(mesh: &Mesh, direction: DVec3) -> EdgeMap<bool> {
    let mut opened = EdgeMap::filled(mesh.edge_slots(), false);
    for v in mesh.vertices() {
        let from = mesh.position(v);
        let slope = |to: DVec3| (to - from).normalize_or_zero().dot(direction);
        let edges = mesh.outgoing(v).map(|h| (slope(mesh.position(mesh.target(h))), h.edge()));
        let steepest = edges.max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, e)) = steepest.filter(|&(slope, _)| slope > 0.0) {
            opened[e] = true;
        }
    }
    opened
}

/// A direction, uniform on the sphere.
fn direction(rng: &mut Rng) -> DVec3 {
    unit_vector(2.0 * rng.unit() - 1.0, rng.unit() * std::f64::consts::TAU)
}

/// The unit vector with a height and an angle around the vertical; uniform on the sphere when both
/// are uniform.
pub(super) fn unit_vector(height: f64, angle: f64) -> DVec3 {
    let flat = DVec2::from_angle(angle) * (1.0 - height * height).max(0.0).sqrt();
    flat.extend(height)
}
