//! Planarize: moves vertices as little as possible until every face is planar.
//!
//! Source: our own arrangement of known parts. Sequential quadratic programming (Nocedal, Wright
//! 2006, 18.1) on the constraint that the heights of a face's corners over its least-squares plane
//! are those of a plane; the goal is least movement, after the closeness terms of Liu, Pottmann,
//! Wallner, Yang, Wang 2006 ("Geometric modeling with conical meshes and developable surfaces"),
//! and a fairness term that lets neighbours move alike. Each round solves one sparse linear system,
//! one unknown for each side above three of each face.
//!
//! Needs: faces whose corners are not all fixed. Keeps: V, E, F, genus, groups, seams. Changes:
//! positions, so that faces are planar to the profile. Degenerate: a flat patch of hexagons has too
//! few ways to bend; it is already planar, and the shift of the system (Levenberg 1944) keeps its
//! steps small. What does not come to an end within the rounds is reported, with the worst face.

mod constraints;
mod damage;
mod report;

#[cfg(test)]
mod tests;

use glam::DVec3;
use serde::Deserialize;

pub use self::report::{FarMove, Needle, PlanarizeReport};

use self::constraints::Constraints;
use super::{OpContext, OpError};
use crate::check::{Limits, Profile};
use crate::geom::{RoundingBound, fit_plane};
use crate::measure::{planarity, self_contact};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::select::Selection;

/// The most rounds that may be asked for.
const MOST_ROUNDS: u32 = 10_000;
/// A step moves no vertex by more than this share of its shortest edge, so that the linear model of
/// the round still holds.
const LONGEST_STEP: f64 = 0.25;
/// The search for the least movement ends when a round lowers it by less than this share.
const SETTLED: f64 = 1e-3;
/// Limits are kept with this much to spare, so that a file's rounding does not break them again.
const MARGIN: f64 = 0.5;
/// The shifts of the linear system, relative to its diagonal.
const SHIFTS: [f64; 2] = [1e-12, 1e-3];

/// Whether vertices on a rim may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RimRule {
    /// They move like all others.
    #[default]
    Free,
    /// They stay where they are.
    Fixed,
}

/// How to planarize. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct PlanarizeParams {
    /// How planar is enough: the limits of `check`. `exact` is planar up to rounding.
    #[arg(long, value_enum, default_value_t = Profile::Exact)]
    #[serde(default = "default_profile")]
    pub profile: Profile,
    /// Weight of staying close to where the vertices were, above 0.
    #[arg(long, default_value_t = 1.0, value_parser = crate::units::parse_number)]
    #[serde(default = "default_closeness")]
    pub closeness: f64,
    /// Weight of neighbours moving alike, 0 or more, against the closeness: 10 gives long smooth
    /// movements instead of short local ones.
    #[arg(long, default_value_t = 0.0, value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub fairness: f64,
    /// Vertices that stay where they are, in the selection language.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub fix: Option<Selection>,
    /// Whether vertices on a rim may move.
    #[arg(long, value_enum, default_value_t = RimRule::Free)]
    #[serde(default)]
    pub rim: RimRule,
    /// The most rounds, 1 to 10000. Good models need 5 to 30.
    #[arg(long, default_value_t = default_rounds())]
    #[serde(default = "default_rounds")]
    pub rounds: u32,
}

fn default_profile() -> Profile {
    Profile::Exact
}

fn default_closeness() -> f64 {
    1.0
}

fn default_rounds() -> u32 {
    200
}

impl Default for PlanarizeParams {
    fn default() -> Self {
        Self {
            profile: default_profile(),
            closeness: default_closeness(),
            fairness: 0.0,
            fix: None,
            rim: RimRule::default(),
            rounds: default_rounds(),
        }
    }
}

/// Moves vertices as little as possible until every face is planar to the profile. Where the rounds
/// do not suffice the best so far is returned, and the report says so; it names the faces whose
/// sides cross for the movement, too.
///
/// # Errors
/// [`OpError::WeightOutOfRange`], [`OpError::RepeatOutOfRange`], [`OpError::Select`] for an empty
/// selection of fixed vertices, [`OpError::AllCornersFixed`] when a face that is not planar has
/// fewer than one free corner, [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use glam::DVec3;
///
/// let mut cube = kerfold::shape::cube(100.0);
/// let first = cube.vertices().next().expect("a cube has vertices");
/// cube.set_position(first, cube.position(first) + DVec3::splat(1.0), true);
/// let (flat, _) = planarize(&cube, &PlanarizeParams::default(), &OpContext::default())?;
/// assert!(check(&flat, &CheckParams::default())?.findings.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn planarize(
    mesh: &Mesh,
    params: &PlanarizeParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, PlanarizeReport), OpError> {
    check_numbers(params)?;
    let is_fixed = fixed_vertices(mesh, params, context)?;
    let limits = params.profile.limits();
    refuse_fixed_faces(mesh, &limits, &is_fixed)?;
    let mut work = Work {
        constraints: Constraints::new(mesh),
        start: mesh.vertices().map(|v| (v, mesh.position(v))).collect(),
        mesh: mesh.clone(),
        params,
        limits,
        is_fixed,
        shift: SHIFTS[0],
    };
    let before_mm = work.worst().2;
    let rounds = work.run(context)?;
    let (made, mut report) = work.finish(rounds, before_mm);
    let crosses =
        |f: &FaceId| self_contact(&made, *f).is_some() && self_contact(mesh, *f).is_none();
    report.crossing = made.faces().filter(crosses).collect();
    report.needles = damage::needles(mesh, &made);
    report.sharp = damage::sharp(mesh, &made);
    report.concave = damage::concave(mesh, &made);
    report.far = damage::far_moves(mesh, &made);
    report.is_quads = damage::is_quads(mesh);
    Ok((made, report))
}

fn check_numbers(params: &PlanarizeParams) -> Result<(), OpError> {
    let PlanarizeParams { closeness, fairness, rounds, .. } = *params;
    if !(closeness > 0.0 && closeness.is_finite()) {
        return Err(OpError::WeightOutOfRange {
            what: "closeness",
            weight: closeness,
            least: "above 0",
        });
    }
    if !(fairness >= 0.0 && fairness.is_finite()) {
        return Err(OpError::WeightOutOfRange {
            what: "fairness",
            weight: fairness,
            least: "0 or more",
        });
    }
    if !(1..=MOST_ROUNDS).contains(&rounds) {
        return Err(OpError::RepeatOutOfRange { repeat: rounds, limit: MOST_ROUNDS });
    }
    Ok(())
}

fn fixed_vertices(
    mesh: &Mesh,
    params: &PlanarizeParams,
    context: &OpContext<'_>,
) -> Result<Vec<bool>, OpError> {
    let mut is_fixed = vec![false; mesh.vertex_slots()];
    if let Some(fix) = &params.fix {
        fix.vertices(&context.select(mesh))?.iter().for_each(|v| is_fixed[v.index()] = true);
    }
    if params.rim == RimRule::Fixed {
        mesh.vertices().filter(|&v| mesh.is_rim_vertex(v)).for_each(|v| is_fixed[v.index()] = true);
    }
    Ok(is_fixed)
}

fn refuse_fixed_faces(mesh: &Mesh, limits: &Limits, is_fixed: &[bool]) -> Result<(), OpError> {
    let is_stuck = |f: &FaceId| {
        mesh.face_vertices(*f).all(|v| is_fixed[v.index()]) && !limits.allow(&planarity(mesh, *f))
    };
    let stuck: Vec<usize> = mesh.faces().filter(is_stuck).map(FaceId::index).collect();
    if stuck.is_empty() { Ok(()) } else { Err(OpError::AllCornersFixed { faces: stuck }) }
}

struct Work<'a> {
    mesh: Mesh,
    start: Vec<(VertexId, DVec3)>,
    constraints: Constraints,
    params: &'a PlanarizeParams,
    limits: Limits,
    is_fixed: Vec<bool>,
    shift: f64,
}

impl Work<'_> {
    /// First the least movement, then, without any other wish, the planes. Returns the number of
    /// rounds.
    fn run(&mut self, context: &OpContext<'_>) -> Result<u32, OpError> {
        let (mut cost, mut is_settled) = (f64::INFINITY, false);
        for round in 0..self.params.rounds {
            if context.progress.is_cancelled() {
                return Err(OpError::Cancelled);
            }
            context.progress.report("planarizing", round as usize, 0);
            let share = self.worst().1;
            let now = self.cost();
            if share <= MARGIN {
                if is_settled || now == 0.0 || (cost - now).abs() <= SETTLED * now {
                    return Ok(round);
                }
                cost = now;
            }
            // The last rounds are for the planes alone.
            is_settled |= round + self.params.rounds.min(20) >= self.params.rounds;
            self.step(is_settled);
        }
        Ok(self.params.rounds)
    }

    /// One round: solve, then walk as far as the linear model holds.
    fn step(&mut self, planes_only: bool) {
        let (wish, mobility) = self.wish(planes_only);
        self.constraints.measure(&self.mesh);
        let Some(mut steps) = self.constraints.solve(&wish, &mobility, self.shift) else {
            self.shift = (self.shift * 100.0).min(SHIFTS[1]);
            return;
        };
        let share = self.longest_share(&steps);
        let part = if share > LONGEST_STEP { LONGEST_STEP / share } else { 1.0 };
        self.shift = if part < 1.0 { self.shift * 10.0 } else { self.shift / 10.0 }
            .clamp(SHIFTS[0], SHIFTS[1]);
        for (&(v, _), step) in self.start.iter().zip(&mut steps) {
            if !self.is_fixed[v.index()] {
                self.mesh.set_position(v, self.mesh.position(v) + *step * part, false);
            }
        }
    }

    /// For each vertex the step that the goal alone would take, and how readily it moves: the
    /// inverse of a diagonal that majorises the goal's second derivative, so that the step never
    /// raises the goal.
    fn wish(&self, planes_only: bool) -> (Vec<DVec3>, Vec<f64>) {
        let PlanarizeParams { closeness, fairness, .. } = *self.params;
        let moved = self.moved();
        let each = |&(v, _): &(VertexId, DVec3)| {
            if self.is_fixed[v.index()] {
                return (DVec3::ZERO, 0.0);
            }
            let (mut slope, mut count) = (closeness * moved[v.index()], 0);
            for u in self.mesh.neighbours(v) {
                slope += fairness * (moved[v.index()] - moved[u.index()]);
                count += 1;
            }
            let mobility = 1.0 / (closeness + 2.0 * fairness * f64::from(count));
            (if planes_only { DVec3::ZERO } else { -slope * mobility }, mobility * closeness)
        };
        self.start.iter().map(each).unzip()
    }

    fn moved(&self) -> Vec<DVec3> {
        let mut moved = vec![DVec3::ZERO; self.mesh.vertex_slots()];
        self.start
            .iter()
            .for_each(|&(v, before)| moved[v.index()] = self.mesh.position(v) - before);
        moved
    }

    /// The goal, without its constant factor.
    fn cost(&self) -> f64 {
        let moved = self.moved();
        let close: f64 = moved.iter().map(|d| d.length_squared()).sum();
        let ends = self.mesh.edges().map(|e| self.mesh.edge_vertices(e));
        let fair: f64 =
            ends.map(|[u, v]| moved[u.index()].distance_squared(moved[v.index()])).sum();
        self.params.closeness * close + self.params.fairness * fair
    }

    /// The largest step over the shortest edge at its vertex.
    fn longest_share(&self, steps: &[DVec3]) -> f64 {
        let share = |(&(v, here), step): (&(VertexId, DVec3), &DVec3)| {
            let here = if self.is_fixed[v.index()] { here } else { self.mesh.position(v) };
            let shortest = self
                .mesh
                .neighbours(v)
                .map(|u| self.mesh.position(u).distance(here))
                .fold(f64::MAX, f64::min);
            if step.length() == 0.0 { 0.0 } else { step.length() / shortest }
        };
        self.start.iter().zip(steps).map(share).fold(0.0, f64::max)
    }

    /// The face that uses most of its limit, how much of it, and the largest distance of a corner
    /// from a face's plane.
    fn worst(&self) -> (Option<FaceId>, f64, f64) {
        let mut worst = (None, 0.0, 0.0_f64);
        for f in self.mesh.faces().filter(|&f| self.mesh.sides(f) > 3) {
            let measured = planarity(&self.mesh, f);
            let share = self.limits.share(&measured);
            if share > worst.1 {
                (worst.0, worst.1) = (Some(f), share);
            }
            worst.2 = worst.2.max(measured.mm);
        }
        worst
    }

    fn finish(mut self, rounds: u32, before_mm: f64) -> (Mesh, PlanarizeReport) {
        self.carry_planes();
        let (worst, share, after_mm) = self.worst();
        let ways: Vec<f64> =
            self.start.iter().map(|&(v, p)| self.mesh.position(v).distance(p)).collect();
        let farthest =
            (0..ways.len()).max_by(|&i, &j| ways[i].total_cmp(&ways[j])).filter(|&i| ways[i] > 0.0);
        let report = PlanarizeReport {
            rounds,
            is_planar: share <= 1.0,
            worst,
            before_mm,
            after_mm,
            largest_movement_mm: farthest.map_or(0.0, |i| ways[i]),
            mean_movement_mm: if ways.is_empty() {
                0.0
            } else {
                ways.iter().sum::<f64>() / ways.len() as f64
            },
            farthest: farthest.map(|i| self.start[i].0),
            crossing: Vec::new(),
            needles: Vec::new(),
            sharp: Vec::new(),
            concave: Vec::new(),
            far: Vec::new(),
            is_quads: false,
        };
        (self.mesh, report)
    }

    /// Faces that are planar up to rounding carry their plane from here on.
    fn carry_planes(&mut self) {
        let (low, high) = self.mesh.bounds().unwrap_or_default();
        let bound = RoundingBound::of_box(low, high).length();
        self.mesh.clear_planes();
        let faces: Vec<FaceId> = self.mesh.faces().collect();
        for f in faces {
            let corners = self.mesh.face_positions(f);
            let plane = self.mesh.plane(f).and_then(|newell| Some((newell, fit_plane(&corners)?)));
            let Some((newell, fitted)) = plane else { continue };
            let fitted =
                if fitted.normal().dot(newell.normal()) < 0.0 { fitted.flipped() } else { fitted };
            if corners.iter().all(|&p| fitted.signed_distance(p).abs() <= bound) {
                self.mesh.set_plane(f, fitted);
            }
        }
    }
}
