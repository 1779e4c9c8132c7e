//! Planarize: moves vertices as little as possible until every face is planar.
//!
//! Source: guided projection (Tang, Sun, Gomes, Wallner, Pottmann 2014, "Form-finding with polyhedral
//! meshes made simple"): Gauss-Newton on corners and planes together, planes eliminated face by face,
//! with the closeness of Liu, Pottmann, Wallner, Yang, Wang 2006 and a fairness that lets neighbours
//! move alike. Ours is how it comes to an end: a small fixed weight of closeness, with which vertices
//! slide to the nearest planar form, then planes alone, where rounds converge quadratically.
//!
//! Needs: faces whose corners are not all fixed. Keeps: V, E, F, genus, groups, seams. Changes:
//! positions, so that faces are planar to the profile. Degenerate: a flat patch of hexagons has too
//! few ways to bend; it is already planar, and the shift of the system (Levenberg 1944) keeps its
//! steps small. What does not come to an end within the rounds is reported, with the worst face.

mod damage;
mod report;
mod system;

#[cfg(test)]
mod tests;

use glam::DVec3;
use serde::Deserialize;

pub use self::report::{FarMove, Needle, PlanarizeReport};

use self::system::{Pull, System};
use super::{OpContext, OpError};
use crate::check::{Limits, Profile};
use crate::geom::{RoundingBound, fit_plane};
use crate::measure::{planarity, self_contact};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::random::Rng;
use crate::select::Selection;

/// The most rounds that may be asked for.
const MOST_ROUNDS: u32 = 10_000;
/// The weight of closeness against planarity, while vertices slide.
const CLOSENESS: f64 = 1e-8;
/// Vertices slide for at most so many rounds.
const SLIDES: u32 = 16;
/// After that it falls to this share of itself with each round.
const FALL: f64 = 0.01;
/// At most so many rounds more to the last digit.
const POLISH: u32 = 3;
/// Faces are kept star-shaped until it has fallen to this share.
const LAST_STARS: f64 = 1e-9;
/// A step moves no vertex by more than this share of its shortest edge, so that the linear model of
/// the round still holds.
const LONGEST_STEP: f64 = 0.3;
/// Edges that have become shorter than this share of what they were do not hold steps back further.
const SHORTEST: f64 = 0.1;
/// The first move, against the shortest edge: a form whose movement is least only among forms of its
/// own symmetry is left at once.
const SHAKE: f64 = 0.02;
/// Sliding ends when a round lowers the movement by less than this share.
const SETTLED: f64 = 1e-3;
/// Limits are kept with this much to spare, so that a file's rounding does not break them again.
const MARGIN: f64 = 0.5;

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
        start: mesh.vertices().map(|v| (v, mesh.position(v))).collect(),
        mesh: mesh.clone(),
        params,
        limits,
    };
    let before_mm = work.worst().2;
    let rounds = work.run(&is_fixed, context)?;
    let (made, mut report) = work.finish(rounds, before_mm);
    let crosses =
        |f: &FaceId| self_contact(&made, *f).is_some() && self_contact(mesh, *f).is_none();
    report.crossing = made.faces().filter(crosses).collect();
    report.needles = damage::needles(mesh, &made);
    report.sharp = damage::sharp(mesh, &made);
    report.concave = damage::concave(mesh, &made);
    report.far = damage::far_moves(mesh, &made);
    report.is_quads = damage::is_quads(mesh);
    (report.faces, report.is_closed) = (mesh.face_count(), mesh.is_closed());
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
    params: &'a PlanarizeParams,
    limits: Limits,
}

impl Work<'_> {
    /// First the least movement, then, without any other wish, the planes. Returns the number of
    /// rounds.
    fn run(&mut self, is_fixed: &[bool], context: &OpContext<'_>) -> Result<u32, OpError> {
        if self.worst().1 <= MARGIN {
            return Ok(0);
        }
        let system = System::new(&self.mesh, is_fixed, self.params.fairness > 0.0);
        let reach = self.reach(system.free());
        self.shake(system.free(), &reach);
        let (mut cost, mut closeness, mut slides) = (f64::INFINITY, CLOSENESS, true);
        // The last rounds are for the planes alone.
        let most = SLIDES.min(self.params.rounds.saturating_sub(10).max(self.params.rounds / 2));
        for round in 0..self.params.rounds {
            if context.progress.is_cancelled() {
                return Err(OpError::Cancelled);
            }
            context.progress.report("planarizing", round as usize, 0);
            let now = self.cost();
            slides &= round < most && (cost - now).abs() > SETTLED * now;
            cost = now;
            if !slides {
                if self.worst().1 <= MARGIN {
                    return Ok(round + self.polish(&system, &reach, closeness));
                }
                closeness *= FALL;
            }
            self.step(&system, &reach, closeness);
        }
        Ok(self.params.rounds)
    }

    /// Rounds to the last digit, where the profile asks for it: within the limit, faces need not be
    /// planar up to rounding yet, and only then they carry their planes. Returns how many helped.
    fn polish(&mut self, system: &System, reach: &[f64], mut closeness: f64) -> u32 {
        if self.params.profile != Profile::Exact {
            return 0;
        }
        for round in 0..POLISH {
            let (before, off) = (self.mesh.clone(), self.worst().2);
            closeness *= FALL;
            self.step(system, reach, closeness);
            if self.worst().2 > off / 2.0 {
                self.mesh = before;
                return round;
            }
        }
        POLISH
    }

    /// How far each free vertex may move in a round, at the start: its shortest edge.
    fn reach(&self, free: &[VertexId]) -> Vec<f64> {
        free.iter().map(|&v| self.shortest_edge(v)).collect()
    }

    /// The shortest edge at a vertex; nothing for one without edges.
    fn shortest_edge(&self, v: VertexId) -> f64 {
        let here = self.mesh.position(v);
        let lengths = self.mesh.neighbours(v).map(|u| self.mesh.position(u).distance(here));
        lengths.reduce(f64::min).unwrap_or(0.0)
    }

    /// Moves every free vertex a little, always the same way.
    fn shake(&mut self, free: &[VertexId], reach: &[f64]) {
        let mut rng = Rng::new(0);
        for (&v, reach) in free.iter().zip(reach) {
            let way = rng.on_sphere() * (SHAKE * reach);
            self.mesh.set_position(v, self.mesh.position(v) + way, false);
        }
    }

    /// One round: solve, then walk as far as the linear model holds.
    fn step(&mut self, system: &System, reach: &[f64], closeness: f64) {
        let PlanarizeParams { closeness: back, fairness, .. } = *self.params;
        // The last rounds come to the planes without any other wish.
        let keeps_stars = closeness > LAST_STARS * CLOSENESS;
        let pull = Pull { back: closeness, alike: closeness * fairness / back, keeps_stars };
        let Some(steps) = system.step(&self.mesh, pull) else { return };
        let lengths: Vec<f64> = system.free().iter().map(|&v| self.shortest_edge(v)).collect();
        for (i, &v) in system.free().iter().enumerate() {
            let longest = LONGEST_STEP * lengths[i].max(SHORTEST * reach[i]);
            let step = steps[i].clamp_length_max(longest);
            self.mesh.set_position(v, self.mesh.position(v) + step, false);
        }
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
            faces: 0,
            is_closed: false,
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
