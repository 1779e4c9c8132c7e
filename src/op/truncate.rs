//! What the three truncations share: offsets, scope, rounds. They only choose planes; all cutting is `cutter.rs`.

use serde::Deserialize;

use super::OpError;
use super::cutter::{Cutter, Lineage, Reach, SlicingPlane};
use super::report::{CutReport, RoundMarks, finish};
use crate::geom::Plane;
use crate::mesh::{Mesh, VertexId};
use crate::progress::{Progress, Silent};
use crate::select::{Context, Made};

/// How far a truncation cuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// The whole mesh is cut by each plane; on a convex solid the result is the intersection of half-spaces.
    #[default]
    Global,
    /// Only the part in front of the plane that hangs together with the element is cut off.
    Local,
}

/// What surrounds a call: what the step before made, and whom to tell how far the work is.
#[derive(Clone, Copy)]
pub struct OpContext<'a> {
    /// For the selections `made` and `strip`.
    pub made: Option<&'a Made>,
    /// Progress and Ctrl-C.
    pub progress: &'a dyn Progress,
}

impl Default for OpContext<'_> {
    fn default() -> Self {
        Self { made: None, progress: &Silent }
    }
}

impl OpContext<'_> {
    /// The context of a selection on `mesh`.
    pub(super) fn select<'a>(&'a self, mesh: &'a Mesh) -> Context<'a> {
        Context { mesh, made: self.made }
    }
}

/// Rounds beyond this only make elements smaller than rounding.
const MOST_ROUNDS: u32 = 64;

/// One element to be cut off.
pub(super) struct Element {
    /// Its number, for the report.
    pub id: usize,
    /// Where a local cut begins; also the only vertices that a disjoint cut removes.
    pub vertices: Vec<VertexId>,
    /// The slicing plane.
    pub plane: Plane,
    /// For an edge: the lineage of its two faces, along which the strip runs.
    pub along: Option<[Lineage; 2]>,
}

/// The point at share `t` of the way from a vertex to its neighbour (Gonen 2007, eq. 3.1, read outwards).
pub(super) fn edge_point(mesh: &Mesh, from: VertexId, to: VertexId, t: f64) -> glam::DVec3 {
    mesh.position(from).lerp(mesh.position(to), t)
}

/// Checks the numbers that all truncations share.
pub(super) fn check_ranges(offset: f64, repeat: u32) -> Result<(), OpError> {
    if !(offset > 0.0 && offset <= 2.0) {
        return Err(OpError::OffsetOutOfRange { offset });
    }
    if !(1..=MOST_ROUNDS).contains(&repeat) {
        return Err(OpError::RepeatOutOfRange { repeat, limit: MOST_ROUNDS });
    }
    Ok(())
}

/// Cuts `repeat` rounds. `choose` sets all planes of a round from the mesh as it is before the round; for the rounds after
/// the first it is told what the round before made.
pub(super) fn truncate(
    mesh: &Mesh,
    (offset, scope, repeat): (f64, Scope, u32),
    context: &OpContext<'_>,
    choose: impl Fn(&Cutter, Option<&Made>) -> Result<Vec<Element>, OpError>,
) -> Result<(Mesh, CutReport), OpError> {
    check_ranges(offset, repeat)?;
    let mut cutter = Cutter::new(mesh.clone());
    let mut report = CutReport { is_beyond_far_ends: offset > 1.0, ..CutReport::default() };
    for round in 0..repeat {
        cutter.start_round();
        let made = (round > 0).then_some(&report.made);
        let elements = choose(&cutter, made)?;
        let marks = cut_round(&mut cutter, &elements, scope, &mut report, context.progress)?;
        report.made = marks.collect(&cutter);
    }
    Ok(finish(cutter.mesh, report))
}

fn cut_round(
    cutter: &mut Cutter,
    elements: &[Element],
    scope: Scope,
    report: &mut CutReport,
    progress: &dyn Progress,
) -> Result<RoundMarks, OpError> {
    let mut marks = RoundMarks { caps: Vec::new(), strips: Vec::new() };
    for (i, element) in elements.iter().enumerate() {
        if i % 64 == 0 {
            progress.report("cutting", i, elements.len());
            if progress.is_cancelled() {
                return Err(OpError::Cancelled);
            }
        }
        let plane = SlicingPlane { plane: element.plane, given: None };
        let seeds: Vec<VertexId> = element.vertices.iter().copied().filter(|&v| cutter.is_original(v)).collect();
        let reach = if scope == Scope::Local { Reach::Local(&seeds) } else { Reach::Global };
        let cut = cutter.cut(&plane, reach)?;
        if cutter.mesh.face_count() == 0 {
            return Err(OpError::NothingLeft { cut: i + 1, cuts: elements.len() });
        }
        report.cuts += 1;
        report.missed += usize::from(cut.is_miss);
        let is_own = |v: &VertexId| element.vertices.contains(v);
        if !cut.met.is_empty() || !cut.removed.iter().all(is_own) || cut.removed.len() < element.vertices.len() {
            report.overcut.push(element.id);
            report.overcut.extend(cut.met.iter().map(|&k| elements[k].id));
        }
        let cap = cutter.cap_lineage(i);
        marks.caps.push(cap);
        marks.strips.extend(element.along.map(|along| (cap, along)));
    }
    report.overcut.sort_unstable();
    report.overcut.dedup();
    Ok(marks)
}
