//! Panelize: a freeform surface becomes planar panels with three members at every node.
//!
//! The way of a surface: it is refined (`refine`, `delaunay`) and its curvature looked at with
//! the eyes of a panel (`curvature`); rows are laid along the direction in which it bends least
//! (`field`), their sizes adapted so that they run on (`scale`); a lattice along the rows has a
//! point for each panel (`lattice`, `sites`); regions around these become a mesh of polygons
//! with valence 3 (`regions`); its corners start where tangent planes meet (`start`), and all
//! corners and planes are solved for together (`solve`); edges that are in the way are turned
//! (`flip`); the last rounds make planes exact. What was reached is measured by code of its own
//! (`prove`, `report`).
//!
//! Sources: Liu, Pottmann, Wallner, Yang, Wang 2006; Pottmann, Liu, Wallner, Bobenko, Wang 2007;
//! Tang, Sun, Gomes, Wallner, Pottmann 2014 for planar meshes by optimisation; Jakob, Tarini,
//! Panozzo, Sorkine-Hornung 2015 for the lattice. That rows along the direction of smaller
//! curvature do for every sign of the curvature is our own: near a point z = (k₁x² + k₂y²)/2 the
//! planes at a lattice with a row along k₁ meet in hexagons for k₁ = k₂, in bricks for k₁ = 0 and
//! in bow-ties for k₁ = −k₂, without a jump. Inside, all lengths are in units of the panel size.

mod choices;
mod crease;
mod curvature;
mod delaunay;
mod domain;
mod error;
mod families;
mod field;
mod flip;
mod formula;
mod height;
mod held;
mod kinds;
mod lattice;
mod layout;
mod mirror;
mod outcomes;
mod params;
mod pins;
mod prove;
mod refine;
mod regions;
mod report;
mod revolve;
mod ring_plan;
mod rings;
mod scale;
mod sites;
mod size;
mod smooth;
mod solve;
mod start;
mod stays;
mod surface;
mod wishes;
mod words;

#[cfg(test)]
mod tests;

use glam::DVec3;

use self::crease::{Fold, creased, folds, without_short};
use self::curvature::{Quadric, quadrics};
use self::field::RowField;
use self::flip::turn_edges;
use self::held::{HeldPoint, held_points, hold};
use self::kinds::{ALIKE, Kinds, kinds};
use self::layout::{Layout, Rows, layout};
use self::mirror::{Mirror, check_mirrored};
use self::pins::{Asked, Groups, Pin, check_meetings, pinned, pins_of_planes};
use self::prove::{Measured, measure, off_folds};
use self::refine::Triangles;
use self::regions::Panels;
use self::revolve::Revolution;
use self::ring_plan::{RingPlan, ring_plans};
use self::rings::{RingLayout, ring_layout};
use self::scale::scale_field;
use self::size::size_that_fits;
use self::smooth::{Moved, smoothed};
use self::solve::{FacePlane, Limits, RimRule, Run, Scene, State, Symmetry, Weights};
use self::start::start;
use self::surface::{MOST_TRIANGLES, SPACING, Surface, triangles_of};
use self::wishes::{rim_rule, targets};
use crate::geom::Plane;
use crate::measure::crossings;
use crate::mesh::{FaceId, Mesh, MeshBuilder};
use crate::progress::Progress;

pub use choices::{FixChoice, FixedPlane, StayChoice, SymmetryChoice};
pub use domain::Domain;
pub use error::{PanelizeError, PanelizeFinding};
pub use height::{HeightParams, height_field};
pub use outcomes::{FamilyReport, FixedPanel, MirrorReport, Place, StayedPoint};
pub use params::{Align, LayoutChoice, PanelizeParams, RimChoice, SheetSize};
pub use report::{CreaseReport, PanelizeReport};

/// Rounds of solving.
const ROUNDS: usize = 40;
/// Rounds in which planes become exact.
const POLISH: usize = 12;
/// Layouts that are tried while some panels are odd or broken.
const ATTEMPTS: u64 = 6;
/// The same for large surfaces.
const ATTEMPTS_LARGE: u64 = 2;
/// Surfaces with a larger area are large, in squared panel sizes.
const LARGE: f64 = 1500.0;
/// Folds of more are said to be rounded, in radians.
const CREASE: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Another layout is worth a try where plates reach farther from a node, in thicknesses, unless the
/// user allows more.
const FARTHEST_NODE: f64 = 1.5;
/// Corners within this distance of their planes are exact, in panel sizes.
const EXACT: f64 = 1e-13;

/// The surface in units of the panel size, and what is known of it.
struct Model {
    size: f64,
    origin: DVec3,
    surface: Surface,
    /// How far the surface was moved to make it even, where that was asked for.
    moved: Option<Moved>,
    quadrics: Vec<Quadric>,
    way: Way,
    rule: RimRule,
    limits: Limits,
    /// Edges of the input that fold, and whether they are kept.
    folds: Vec<Fold>,
    keeps_creases: bool,
    /// The axes along which it is mirrored.
    mirrors: Vec<usize>,
    /// Panels whose planes are given: the first ones.
    pins: Vec<Pin>,
    fixed: Vec<FacePlane>,
    /// What of that could not be, in words.
    pin_notes: Vec<String>,
    /// Points at which corners are to stand.
    held: Vec<HeldPoint>,
}

/// How panels are laid out.
enum Way {
    /// By a field of rows and the sizes of panels along them.
    /// With mirror planes, on one side of them.
    Free { field: RowField, scale: Vec<f64>, mirror: Option<Box<Mirror>> },
    /// In rings.
    Rings { revolution: Revolution, plans: Vec<RingPlan> },
}

/// A layout that is to be solved: the panels, the areas that they should have, and which of their
/// corners are images of each other.
struct Draft {
    panels: Panels,
    areas: Vec<f64>,
    symmetry: Option<Symmetry>,
    /// The ring of each panel, if they are laid out in rings.
    rings: Vec<usize>,
}

/// Panels of one layout, solved and measured.
struct Solved {
    state: State,
    measured: Vec<Measured>,
    lack: f64,
    /// Pairs of panels of which one goes through the other.
    through: Vec<[usize; 2]>,
    /// How far each fold of the input is from the edges of panels if they are to be kept, from the
    /// panels if not, in panel sizes; and the nearest panel.
    off_folds: Vec<(f64, usize)>,
    kinds: Kinds,
    /// Of panels in rings: the ring of each.
    rings: Vec<usize>,
    was_stopped: bool,
    /// What became of families of lengths.
    families: Option<FamilyReport>,
}

/// Makes planar panels of a surface: a mesh with a face for each panel, planar up to rounding, with
/// three edges at every inner vertex and at those of the rim where two panels meet. What does not
/// come out as it should is in the report.
///
/// # Errors
/// Those of [`PanelizeError`].
pub fn panelize(
    mesh: &Mesh,
    params: &PanelizeParams,
    progress: &dyn Progress,
) -> Result<(Mesh, PanelizeReport), PanelizeError> {
    params.check()?;
    let model = Model::new(mesh, params, progress)?;
    let mut solved = model.solve_best(params, progress).map_err(|error| match error {
        PanelizeError::TooNarrow { size, place, .. } => {
            let fits = size_that_fits(mesh, params, size, progress);
            PanelizeError::TooNarrow { size, fits, place }
        }
        other => other,
    })?;
    if let Some(count) = params.families {
        solved = model.with_families(solved, count as usize, progress);
    }
    let made = model.mesh(&solved)?;
    let report = PanelizeReport::new(&model, &solved, params);
    Ok((made, report))
}

impl Model {
    fn new(
        mesh: &Mesh,
        params: &PanelizeParams,
        progress: &dyn Progress,
    ) -> Result<Self, PanelizeError> {
        progress.report("looking at the surface", 0, 0);
        let mut given = triangles_of(mesh);
        let limit = params.crease.map_or(CREASE, |angle| angle.radians());
        let mut folds = folds(mesh, limit);
        given.keep(&folds, params.crease.is_some());
        let size = size::panel_size(&given, params)?;
        if params.crease.is_some() {
            folds = without_short(folds, size);
            given.keep(&folds, true);
        }
        let (low, high) = mesh.bounds().unwrap_or_default();
        let revolution = revolution(&given, params, size)?;
        let origin = revolution.as_ref().map_or(low.midpoint(high), |found| found.origin);
        let axes = &params.symmetry.0[..];
        let mut surface = fine_surface(&given, (size, origin), axes)?;
        let (mut moved, mut mirror) = (None, None);
        if !axes.is_empty() {
            check_mirrored(&given, axes, (size, origin))?;
            let (whole, made) = Mirror::whole(surface, axes);
            (surface, mirror) = (whole, Some(Box::new(made)));
        }
        if let Some(most) = params.smooth {
            let (even, how_far) = smoothed(surface, most.mm() / size);
            (surface, moved) = (even, Some(how_far));
        }
        if progress.is_cancelled() {
            return Err(PanelizeError::Cancelled);
        }
        let quadrics = match &mirror {
            None => quadrics(&surface),
            Some(mirror) => mirror.quadrics(&surface),
        };
        let (pins, pin_notes) = match &params.fix {
            FixChoice::Planes(planes) => {
                (pins_of_planes(&surface, &quadrics, planes, (size, origin))?, Vec::new())
            }
            fix => Groups::new(mesh, &given, fix)?.pins(&surface, (size, origin), fix)?,
        };
        surface.pins = pinned(&surface, &pins);
        let held = match &params.stay {
            StayChoice::Points(points) => held_points(&surface, points, (size, origin))?,
            _ => Vec::new(),
        };
        progress.report("laying out rows", 0, 0);
        let way = match revolution {
            None => Way::free(&surface, &quadrics, params, (size, origin))?.with(mirror),
            Some(revolution) => Way::rings(&surface, revolution, size)?,
        };
        if progress.is_cancelled() {
            return Err(PanelizeError::Cancelled);
        }
        let rule = rim_rule(&surface, params, (size, origin))?;
        let limits = limits(params, &quadrics);
        let fixed = pins.iter().map(Pin::face_plane).collect();
        Ok(Self {
            size,
            origin,
            surface,
            moved,
            quadrics,
            way,
            rule,
            limits,
            folds,
            keeps_creases: params.crease.is_some(),
            mirrors: params.symmetry.0.clone(),
            pins,
            fixed,
            pin_notes,
            held,
        })
    }

    fn scene(&self) -> Scene<'_> {
        Scene {
            surface: &self.surface,
            quadrics: &self.quadrics,
            limits: &self.limits,
            rule: &self.rule,
            fixed: &self.fixed,
        }
    }

    /// A place in millimetres.
    fn place(&self, p: DVec3) -> DVec3 {
        p * self.size + self.origin
    }

    /// A corner in millimetres: one that stays to the last digit.
    fn vertex(&self, panels: &Panels, v: usize) -> DVec3 {
        let held = panels.held.get(&v).map(|&k| self.held[k].given);
        held.unwrap_or_else(|| self.place(panels.points[v]))
    }

    /// Lays out and solves until nothing is broken, or as often as is worth it; the best of these.
    fn solve_best(
        &self,
        params: &PanelizeParams,
        progress: &dyn Progress,
    ) -> Result<Solved, PanelizeError> {
        let mut best: Option<(f64, Solved)> = None;
        let (mut failed, mut clash) = (None, None);
        for attempt in 0..ATTEMPTS {
            if best.is_none() && progress.is_cancelled() {
                return Err(PanelizeError::Cancelled);
            }
            // Seeds far apart, so that those of neighbouring runs do not repeat.
            let seed = params.seed.wrapping_add(attempt * 1_000_003);
            let solved = match self.draft(attempt, seed) {
                None => break,
                Some(Ok(mut draft)) => {
                    if let Err(error) = self.start(&mut draft.panels) {
                        clash = clash.or(Some(error));
                        continue;
                    }
                    self.solve(draft, progress)
                }
                Some(Err(bad)) => {
                    failed = failed.or(bad.first().copied());
                    continue;
                }
            };
            let bad = self.badness(&solved, params.max_reach.max(FARTHEST_NODE));
            if best.as_ref().is_none_or(|(least, _)| bad < *least) {
                best = Some((bad, solved));
            }
            // Of plans of rings the best is wanted; they are few, and soon solved.
            let is_free = matches!(self.way, Way::Free { .. });
            let is_good = is_free && best.as_ref().is_some_and(|(least, _)| *least < 1.0);
            let is_large = is_free && self.surface.area() > LARGE && best.is_some();
            if is_good || is_large && attempt + 1 >= ATTEMPTS_LARGE || progress.is_cancelled() {
                break;
            }
        }
        let solved = best.map(|(_, solved)| Solved {
            was_stopped: solved.was_stopped || progress.is_cancelled(),
            ..solved
        });
        solved.ok_or_else(|| {
            if let Some(error) = clash {
                return error;
            }
            let group = self.pins.iter().find(|pin| failed.is_some_and(|v| pin.is_group_at(v)));
            if let Some(Asked::Group(name)) = group.map(|pin| pin.asked.clone()) {
                let what = "it has a hole, touches itself, or has too little surface around it";
                return PanelizeError::BadGroup { name, what: what.to_owned() };
            }
            let place = failed.map_or(DVec3::ZERO, |v| self.surface.points[v]);
            PanelizeError::TooNarrow { size: self.size, fits: None, place: self.place(place) }
        })
    }

    /// The layout of an attempt; `None` when there is nothing more to try.
    fn draft(&self, attempt: u64, seed: u64) -> Option<Result<Draft, Vec<usize>>> {
        let (surface, quadrics) = (&self.surface, &self.quadrics[..]);
        match &self.way {
            Way::Free { field, scale, mirror } => {
                let rows = Rows { field, scale };
                let made = layout(surface, quadrics, rows, mirror.as_deref(), seed);
                Some(made.map(|Layout { panels, areas, symmetry }| Draft {
                    panels,
                    areas,
                    symmetry,
                    rings: Vec::new(),
                }))
            }
            Way::Rings { revolution, plans } => {
                let plan = plans.get(usize::try_from(attempt).ok()?)?;
                let made = ring_layout(plan, revolution, self.size, (surface, quadrics));
                let RingLayout { panels, areas, symmetry, rings } = made;
                Some(Ok(Draft { panels, areas, symmetry: Some(symmetry), rings }))
            }
        }
    }

    /// Puts corners where they start, some of them where they stay.
    fn start(&self, panels: &mut Panels) -> Result<(), PanelizeError> {
        check_meetings(panels, &self.pins, (self.size, self.origin))?;
        start(panels, &self.quadrics, &self.surface.pins);
        hold(panels, &self.surface, &self.held, self.size)
    }

    fn solve(&self, draft: Draft, progress: &dyn Progress) -> Solved {
        let scene = self.scene();
        let Draft { panels, areas, symmetry, rings } = draft;
        // What is turned in one panel of a ring would have to be in all of them.
        let may_turn = rings.is_empty();
        let mut state = State::new(panels, areas, symmetry, scene);
        let weights = Weights::default();
        let (active, families) = (None, None);
        let run = Run { rounds: ROUNDS, from: 1.0, to: 300.0, weights, active, families };
        let mut was_stopped = false;
        state.run(scene, run, |round| {
            progress.report("solving for panels", round, ROUNDS);
            was_stopped |= progress.is_cancelled();
            was_stopped
        });
        if !was_stopped && may_turn {
            progress.report("turning edges", 0, 0);
            turn_edges(&mut state, scene, weights, || progress.is_cancelled());
        }
        progress.report("making planes exact", 0, 0);
        self.finish(state, rings, was_stopped)
    }

    /// Planes made exact, and everything measured.
    fn finish(&self, mut state: State, rings: Vec<usize>, was_stopped: bool) -> Solved {
        let lack = state.polish(self.scene(), POLISH);
        let measured = measure(&self.surface, &self.quadrics, &state.panels);
        let folds =
            self.folds.iter().map(|fold| fold.places.map(|p| (p - self.origin) / self.size));
        let off_folds = off_folds(&state.panels, folds, self.keeps_creases);
        let through = self.through(&state, &measured);
        let kinds = kinds(&state.panels, ALIKE);
        let families = None;
        Solved { kinds, rings, state, measured, lack, through, off_folds, was_stopped, families }
    }

    /// Pairs of panels that go through each other, beside those that cross themselves.
    fn through(&self, state: &State, measured: &[Measured]) -> Vec<[usize; 2]> {
        let faces = state.panels.faces.iter().map(|face| face.iter().copied());
        let Ok(mesh) = Mesh::from_faces(state.panels.points.iter().copied(), faces) else {
            return Vec::new();
        };
        let pairs = crossings(&mesh, 1000).into_iter();
        let pairs = pairs.map(|pair| [pair.first.index(), pair.second.index()]);
        pairs.filter(|[a, b]| measured[*a].is_sound && measured[*b].is_sound).collect()
    }

    /// How bad panels are: from 1 on another layout is worth a try, from 100 on panels are broken.
    fn badness(&self, solved: &Solved, reach: f64) -> f64 {
        let m = &solved.measured;
        let broken = m.iter().filter(|m| !m.is_sound).count() + solved.through.len();
        let inexact = usize::from(solved.lack > EXACT);
        let is_lost = |&&(off, _): &&(f64, usize)| off > report::CREASE_OFF;
        let lost = solved.off_folds.iter().filter(is_lost).count();
        let lost = if self.keeps_creases { lost } else { 0 };
        let sag = report::sag(&self.quadrics);
        let room = |f: usize| self.surface.pins.areas.get(f).copied().flatten().unwrap_or(1.0);
        let odd = |&(f, m): &(usize, &Measured)| {
            m.deviation > (2.5 * sag).max(0.05)
                || m.least_angle < 12.0
                || m.largest_angle > 300.0
                || m.area < 0.2
                || m.area > 2.4 * room(f)
        };
        let far = report::far_nodes(self, solved, reach).len();
        let odd = m.iter().enumerate().filter(odd).count() + lost + far;
        let short = m.iter().filter(|m| m.shortest < 0.1).count().saturating_sub(m.len() / 50);
        let deviations: Vec<f64> = m.iter().map(|m| m.deviation).collect();
        let most = report::percentile(&deviations, 0.95);
        let off = usize::from(most > (1.5 * sag).max(0.035));
        let bad = (100 * (broken + inexact) + odd + short + off) as f64;
        let rest = if solved.rings.is_empty() {
            most
        } else {
            // Among plans of rings the one that comes nearest, of panels that are alike in size.
            let areas = [f64::INFINITY, 0.0];
            let [low, high] = m.iter().fold(areas, |[a, b], m| [a.min(m.area), b.max(m.area)]);
            (3.0 * most / sag.max(0.035) + (high / low.max(1e-3)).ln()) / 40.0
        };
        bad + rest.min(0.99)
    }

    /// The panels as a mesh in millimetres.
    fn mesh(&self, solved: &Solved) -> Result<Mesh, PanelizeError> {
        let panels = &solved.state.panels;
        let mut builder = MeshBuilder::new();
        for v in 0..panels.points.len() {
            builder.vertex(self.vertex(panels, v));
        }
        for face in &panels.faces {
            builder.face(face.iter().copied());
        }
        let place = self.place(panels.points.first().copied().unwrap_or_default());
        let (mut mesh, splits) = builder.build().map_err(|_| PanelizeError::NoMesh { place })?;
        if !splits.is_empty() {
            return Err(PanelizeError::NoMesh { place });
        }
        if solved.lack <= EXACT {
            for (f, plane) in solved.state.planes.iter().enumerate() {
                let given =
                    self.pins.get(f).map(|pin| match plane.normal.dot(pin.given.normal()) {
                        ..0.0 => pin.given.flipped(),
                        _ => pin.given,
                    });
                let found = || Plane::new(plane.normal, self.place(plane.point));
                if let Some(plane) = given.or_else(found) {
                    mesh.set_plane(FaceId::new(f), plane);
                }
            }
        }
        Ok(mesh)
    }
}

impl Way {
    fn free(
        surface: &Surface,
        quadrics: &[Quadric],
        params: &PanelizeParams,
        scale: (f64, DVec3),
    ) -> Result<Self, PanelizeError> {
        let follows_curvature = params.align != Align::None;
        let targets = targets(surface, quadrics, params, scale)?;
        let field = RowField::new(surface, quadrics, follows_curvature, &targets)
            .ok_or(PanelizeError::NoField)?;
        let scale = scale_field(surface, quadrics, &field, params.even);
        Ok(Self::Free { field, scale, mirror: None })
    }

    /// The same on one side of mirror planes.
    fn with(self, by: Option<Box<Mirror>>) -> Self {
        match self {
            Self::Free { field, scale, .. } => Self::Free { field, scale, mirror: by },
            rings => rings,
        }
    }

    fn rings(surface: &Surface, revolution: Revolution, size: f64) -> Result<Self, PanelizeError> {
        let wanted = surface.area() / surface::PANEL_AREA;
        let plans = ring_plans(&revolution, size, wanted);
        if plans.is_empty() {
            return Err(PanelizeError::NoRings { size });
        }
        Ok(Self::Rings { revolution, plans })
    }
}

/// The curve that turns about an axis, where panels are laid out in rings.
fn revolution(
    given: &Triangles,
    params: &PanelizeParams,
    size: f64,
) -> Result<Option<Revolution>, PanelizeError> {
    let LayoutChoice::Rings(axis) = params.layout else { return Ok(None) };
    let mut found = Revolution::find(given, axis, size)?;
    // Planes hold each rim by itself.
    found.is_mirrored &= !matches!(params.rim, RimChoice::Planes(_) | RimChoice::Given(_));
    Ok(Some(found))
}

fn limits(params: &PanelizeParams, quadrics: &[Quadric]) -> Limits {
    Limits {
        edge: params.min_edge,
        angle: params.min_angle.radians(),
        deviation: Limits::default().deviation.max(report::sag(quadrics)),
        ..Limits::default()
    }
}

/// The surface in units of the panel size, about the origin, with fine triangles; of a surface with
/// mirror planes the part on the positive side of them.
fn fine_surface(
    given: &Triangles,
    (size, origin): (f64, DVec3),
    mirrors: &[usize],
) -> Result<Surface, PanelizeError> {
    let points = given.points.iter().map(|&p| (p - origin) / size).collect();
    let (corners, creases) = (given.corners.clone(), given.creases.clone());
    let mut triangles = Triangles { points, corners, creases }.one_side(mirrors);
    let area = triangles.area();
    let count = area / surface::PANEL_AREA;
    let too_fine = || PanelizeError::TooFine { size, count: count as usize, limit: MOST_TRIANGLES };
    // A triangle for each thirtieth of a panel is the least that is needed.
    if count * 30.0 > MOST_TRIANGLES as f64 || !triangles.refine(SPACING, MOST_TRIANGLES) {
        return Err(too_fine());
    }
    Ok(creased(triangles))
}
