//! What the three truncations share: offsets, scope, rounds. They only choose planes; all cutting
//! is `cutter.rs`.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::OpError;
use super::cavity::Cavities;
use super::cut::{Cutter, Lineage, Reach, SlicingPlane};
use super::report::{CutReport, Origins, RoundMarks, ShrunkOffset, StripMark, finish};
use super::size::check_size;
use crate::geom::Plane;
use crate::mesh::{Mesh, VertexId};
use crate::progress::{Progress, Silent};
use crate::select::{Context, NewElements};

/// How far a truncation cuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// The whole mesh is cut by each plane; on a convex solid the result is the intersection of
    /// half-spaces.
    #[default]
    Global,
    /// Only the part in front of the plane connected with the element is cut off.
    Local,
}

/// Whether the cuts of a round may meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Disjoint {
    /// They may; the report names the elements.
    #[default]
    No,
    /// The offsets of those elements whose cuts would meet, touch, or reach a vertex that is not
    /// theirs are made smaller, by an eighth at a time, until none does; the report shows how
    /// small.
    Yes,
}

/// What surrounds a call: what the step before made, and whom to tell how far the work is.
#[derive(Clone, Copy)]
pub struct OpContext<'a> {
    /// For the selections `made` and `strip`.
    pub made: Option<&'a NewElements>,
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
        Context { mesh, made: self.made, progress: self.progress }
    }
}

/// Rounds beyond this only make elements smaller than rounding.
const MOST_ROUNDS: u32 = 64;

/// By how much the offset of an element is made smaller when its cut meets another.
const SHRINKAGE: f64 = 0.875;

/// After this many trials an offset is 1/5000 of what was asked for; whatever still meets then has
/// another reason.
const MOST_TRIALS: usize = 64;

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

/// The point at share `t` of the way from a vertex to its neighbour (Gonen 2007, eq. 3.1, read
/// outwards).
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

/// What all truncations are asked for.
pub(super) struct Settings {
    pub offset: f64,
    pub scope: Scope,
    pub repeat: u32,
    pub disjoint: Disjoint,
    pub growth: Growth,
}

/// How a mesh grows with the rounds.
pub(super) struct Growth {
    /// The edges that the first round adds.
    pub first: usize,
    /// How many elements each element leaves for the next round.
    pub multiplies: f64,
}

impl Growth {
    /// The edges after so many rounds.
    fn edges(&self, mesh: &Mesh, rounds: u32) -> f64 {
        let added = |round: u32| self.first as f64 * self.multiplies.powi(round as i32);
        mesh.edge_count() as f64 + (0..rounds).map(added).sum::<f64>()
    }
}

/// The offset of each element of a round.
pub(super) struct Offsets {
    usual: f64,
    shrunk: BTreeMap<usize, f64>,
}

impl Offsets {
    pub(super) fn of(&self, element: usize) -> f64 {
        self.shrunk.get(&element).copied().unwrap_or(self.usual)
    }

    /// The offsets that were made smaller, by element.
    fn used(self) -> impl Iterator<Item = ShrunkOffset> {
        self.shrunk.into_iter().map(|(element, offset)| ShrunkOffset { element, offset })
    }

    fn shrink(&mut self, elements: &[usize]) {
        for &id in elements {
            *self.shrunk.entry(id).or_insert(self.usual) *= SHRINKAGE;
        }
    }
}

/// What the cuts of one round did.
#[derive(Default)]
struct Round {
    marks: RoundMarks,
    cuts: usize,
    missed: usize,
    lids: usize,
    /// Elements whose cut took what was not theirs.
    overcut: Vec<usize>,
    /// Elements whose cut ends where another one does, or at a vertex of the mesh.
    touching: Vec<usize>,
    /// The cut that left nothing.
    emptied_by: Option<usize>,
}

/// Cuts `settings.repeat` rounds. `choose` sets all planes of a round from the mesh as it is before
/// the round; for the rounds after the first it is told what the round before made.
pub(super) fn truncate(
    mesh: &Mesh,
    settings: &Settings,
    context: &OpContext<'_>,
    choose: impl Fn(&Cutter, Option<&NewElements>, &Offsets) -> Result<Vec<Element>, OpError>,
) -> Result<(Mesh, CutReport), OpError> {
    check_ranges(settings.offset, settings.repeat)?;
    check_size("rounds", settings.repeat, |rounds| settings.growth.edges(mesh, rounds))?;
    let cavities = (settings.scope == Scope::Local).then(|| Cavities::of(mesh));
    let mut cutter = Cutter::new(mesh.clone());
    let mut report =
        CutReport { is_beyond_far_ends: settings.offset > 1.0, ..CutReport::default() };
    report.origins = Origins::new(cutter.mesh());
    for round in 0..settings.repeat {
        cutter.start_round();
        let made = (round > 0).then_some(&report.made);
        let mut offsets = Offsets { usual: settings.offset, shrunk: BTreeMap::new() };
        let choose = |offsets: &Offsets| choose(&cutter, made, offsets);
        let done = match settings.disjoint {
            Disjoint::No => {
                let elements = choose(&offsets)?;
                cutter.reserve(elements.len());
                cut_round(&mut cutter, &elements, settings.scope, context.progress)?
            }
            Disjoint::Yes => {
                let (after, done) =
                    cut_disjoint_round(&cutter, &mut offsets, settings.scope, context, choose)?;
                cutter = after;
                done
            }
        };
        if let Some(cut) = done.emptied_by {
            return Err(OpError::NothingLeft { cut: cut + 1, cuts: done.cuts });
        }
        report.cuts += done.cuts;
        report.missed += done.missed;
        report.lids += done.lids;
        report.overcut.extend(done.overcut);
        report.shrunk.extend(offsets.used());
        report.made = done.marks.collect(&cutter);
        report.origins = report.origins.after(&cutter, &done.marks);
    }
    report.overcut.sort_unstable();
    report.overcut.dedup();
    if let Some(cavities) = cavities {
        report.cavities_gone = cavities.settle(&mut cutter)?;
        if cutter.mesh().face_count() == 0 {
            return Err(OpError::NothingLeft { cut: report.cuts, cuts: report.cuts });
        }
    }
    finish(cutter.into_mesh(), report)
}

/// Tries a round, makes the offsets of those elements smaller whose cuts meet, and tries again from
/// the same mesh.
fn cut_disjoint_round(
    before: &Cutter,
    offsets: &mut Offsets,
    scope: Scope,
    context: &OpContext<'_>,
    choose: impl Fn(&Offsets) -> Result<Vec<Element>, OpError>,
) -> Result<(Cutter, Round), OpError> {
    let mut meeting = sharing_vertices(&choose(offsets)?);
    if !meeting.is_empty() {
        return Err(OpError::NotDisjoint { elements: meeting });
    }
    for _ in 0..MOST_TRIALS {
        let elements = choose(offsets)?;
        let mut cutter = before.clone();
        let round = cut_round(&mut cutter, &elements, scope, context.progress)?;
        meeting = round.overcut.iter().chain(&round.touching).copied().collect();
        if round.emptied_by.is_some() {
            meeting = elements.iter().map(|e| e.id).collect();
        }
        meeting.sort_unstable();
        meeting.dedup();
        if meeting.is_empty() {
            return Ok((cutter, round));
        }
        offsets.shrink(&meeting);
    }
    Err(OpError::NotDisjoint { elements: meeting })
}

/// The elements that have a vertex in common with another one, ascending: no offset keeps their
/// cuts apart.
fn sharing_vertices(elements: &[Element]) -> Vec<usize> {
    let mut at: Vec<(VertexId, usize)> =
        elements.iter().flat_map(|e| e.vertices.iter().map(|&v| (v, e.id))).collect();
    at.sort_unstable();
    at.dedup();
    let mut sharing: Vec<usize> = at
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|group| group.len() > 1)
        .flatten()
        .map(|&(_, id)| id)
        .collect();
    sharing.sort_unstable();
    sharing.dedup();
    sharing
}

fn cut_round(
    cutter: &mut Cutter,
    elements: &[Element],
    scope: Scope,
    progress: &dyn Progress,
) -> Result<Round, OpError> {
    let mut round = Round { cuts: elements.len(), ..Round::default() };
    for (i, element) in elements.iter().enumerate() {
        if i % 64 == 0 {
            progress.report("cutting", i, elements.len());
            if progress.is_cancelled() {
                return Err(OpError::Cancelled);
            }
        }
        let plane = SlicingPlane { plane: element.plane, given: None };
        let seeds: Vec<VertexId> =
            element.vertices.iter().copied().filter(|&v| cutter.is_original(v)).collect();
        let reach = if scope == Scope::Local { Reach::Local(&seeds) } else { Reach::Global };
        cutter.cut(&plane, reach);
        if cutter.mesh().face_count() == 0 {
            round.emptied_by = Some(i);
            break;
        }
        let cut = cutter.last_cut();
        round.missed += usize::from(cut.is_miss);
        round.lids += cut.lids;
        let is_own = |v: &VertexId| element.vertices.contains(v);
        if !cut.met.is_empty()
            || !cut.removed.iter().all(is_own)
            || cut.removed.len() < element.vertices.len()
        {
            round.overcut.push(element.id);
            round.overcut.extend(cut.met.iter().map(|&k| elements[k].id));
        }
        if cut.ends_at_vertex || !cut.touched.is_empty() {
            round.touching.push(element.id);
            round.touching.extend(cut.touched.iter().map(|&k| elements[k].id));
        }
        let cap = cutter.cap_lineage(i);
        round.marks.caps.push(cap);
        let strip = element.along.map(|beside| StripMark { cap, beside, origin: beside[0] });
        round.marks.strips.extend(strip);
    }
    Ok(round)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::op::TruncateVertexParams;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        cut: TruncateVertexParams,
    }

    #[test]
    fn disjoint_is_a_flag() {
        let read = |words: &[&str]| {
            let line = ["cut", "--select", "all"].iter().chain(words);
            Line::try_parse_from(line).map(|line| line.cut.disjoint).ok()
        };
        assert_eq!(read(&[]), Some(Disjoint::No));
        assert_eq!(read(&["--disjoint"]), Some(Disjoint::Yes));
        assert_eq!(read(&["--disjoint=no", "--offset", "0.5"]), Some(Disjoint::No));
        assert_eq!(read(&["--disjoint", "--offset", "0.5"]), Some(Disjoint::Yes));
        let recipe: TruncateVertexParams =
            toml::from_str("select = \"all\"\ndisjoint = \"yes\"").expect("a recipe");
        assert_eq!(recipe.disjoint, Disjoint::Yes);
    }
}
