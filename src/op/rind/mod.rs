//! Rind: a shell of even thickness, with faces punched through or peeled off (Srinivasan 2004, V).
//!
//! The second skin has the links of the first, turned inside out; each of its vertices lies where
//! the planes of its faces meet after each was moved by the thickness: exactly with three planes,
//! in the least-squares sense with more, with the residual reported. A punched face is joined to
//! its partner by a pipe, a quad for each side. Peeling also takes away the walls without thickness
//! between neighbouring openings, the vertices in the midst of peeled faces, and the 2-gons that
//! would be left over. Rims are openings, too, so a sheet becomes a slab.
//!
//! With F_o opened faces, E_o edges and V_o vertices taken away, and b sides of openings that stay:
//!
//! ```text
//!   vertices  2(V − V_o)    edges  2(E − E_o) + b    faces  2(F − F_o) + b    Euler number  2(χ − F_o + E_o − V_o)
//! ```
//!
//! so k openings of which no two are neighbours leave genus 2g + k − 1, and none at all leaves two
//! components. Needs: faces with an area. On a mesh that is a shell already only the openings are
//! made, between partners that are found by geometry (`given`). Keeps: groups, planes, and to the
//! bit the positions of the first skin. A negative thickness grows outwards. Planarity: where three
//! planes meet, or more after a move by the thickness still do, faces of the second skin are as
//! planar as those of the first. Degenerate cases: faces at a vertex that are coplanar, or parallel
//! to one line, move it the shortest way; self-loops and 2-gons are legal. When the thickness is
//! more than the shape allows, the faces are named and the result is marked as not clean.

mod crossing;
mod given;
mod offset;
mod shell;

#[cfg(test)]
mod tests;

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, de};

use super::report::{crossing_note, crossing_pairs, first_few};
use super::simple::{Mended, keep_simple};
use super::size::check_size;
use super::{OpContext, OpError, OpFinding};
use crate::check::short;
use crate::code::Coded;
use crate::geom::RoundingBound;
use crate::measure::{CrossingKind, CrossingPair};
use crate::mesh::{FaceId, FaceMap, Mesh, VertexId};
use crate::progress::Progress;
use crate::select::{NewElements, Selection};
use crate::units::Length;

/// How to make a rind. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct RindParams {
    /// Thickness of the shell, in mm unless a unit is given; inwards, or outwards when negative.
    #[arg(long, allow_negative_numbers = true)]
    pub thickness: Length,
    /// Another thickness for one face group, of the same sign; may be given several times.
    #[arg(long, value_name = "GROUP=LENGTH", allow_hyphen_values = true)]
    #[serde(default)]
    pub thickness_of: Vec<GroupThickness>,
    /// Faces to open, in the selection language; neighbours keep a wall without thickness between
    /// them.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub punch: Option<Selection>,
    /// Faces to open, in the selection language, with the walls to neighbouring openings taken
    /// away.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub peel: Option<Selection>,
    /// Whether the shell is made, or the mesh is one already; then faces are joined to what lies
    /// behind them at most twice the thickness away.
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub shell: ShellSource,
}

/// Where the second skin comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShellSource {
    /// It is made.
    #[default]
    New,
    /// The mesh has one; partners are found by geometry.
    Given,
}

/// The thickness of one face group: `lid=3mm`.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupThickness {
    /// The group.
    pub group: String,
    /// Its thickness.
    pub thickness: Length,
}

impl FromStr for GroupThickness {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (group, length) =
            text.rsplit_once('=').ok_or_else(|| format!("`{text}` is not like lid=3mm"))?;
        let thickness = length.parse().map_err(|e: crate::units::UnitError| e.to_string())?;
        Ok(Self { group: group.trim().to_owned(), thickness })
    }
}

impl fmt::Display for GroupThickness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.group, self.thickness)
    }
}

impl<'de> Deserialize<'de> for GroupThickness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// How a face is opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Opening {
    /// Not at all.
    None,
    /// With all its walls; holes of an open mesh, too.
    Punched,
    /// Without walls to other openings.
    Peeled,
}

/// What a rind came out as.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RindReport {
    /// What was made: the second skin and the walls.
    pub made: NewElements,
    /// How many faces were opened; rims count.
    pub openings: usize,
    /// How many walls without thickness were taken away.
    pub walls_removed: usize,
    /// The genus that the openings must leave, summed over the components.
    pub genus: usize,
    /// Components of the result.
    pub components: usize,
    /// The largest distance of a vertex of the second skin from one of the planes that it should
    /// lie on, in mm.
    pub residual_mm: f64,
    /// Faces, in ids of the mesh before, that the second skin comes nearer to than their thickness,
    /// or whose sides turn round.
    pub crossing: Vec<usize>,
    /// Faces of the result that go through each other, as skins of different parts do; a thousand
    /// pairs at most. The two sides of walls without thickness are not among them.
    pub pairs: Vec<CrossingPair>,
    /// What had to be mended so that files can hold the result.
    pub mended: Mended,
}

impl RindReport {
    /// The report in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![format!(
            "{} openings, {} walls without thickness taken away; {} components, genus {}",
            self.openings, self.walls_removed, self.components, self.genus
        )];
        if self.residual_mm > 0.0 {
            notes.push(format!(
                "vertices of more than three planes: the second skin is up to {} mm off the \
                thickness there",
                short(self.residual_mm)
            ));
        }
        if !self.crossing.is_empty() {
            notes.push(format!(
                "the shell crosses itself at {} faces ({}): the thickness is more than the shape \
                allows there; take less ({})",
                self.crossing.len(),
                first_few(&self.crossing, 8),
                OpFinding::ShellCrosses.code()
            ));
        }
        notes.extend(crossing_note(&self.pairs, OpFinding::ShellCrosses.code()));
        notes.extend(self.mended.notes());
        notes
    }
}

/// Makes a rind.
///
/// # Errors
/// [`OpError::Select`] for an empty selection; [`OpError::DepthTooSmall`] when a thickness is
/// within rounding; [`OpError::Exclude`] for thicknesses of both signs; [`OpError::NoSuchGroup`];
/// [`OpError::NoArea`] for a face without a normal; [`OpError::AllOpened`] when no face would be
/// left; with a given shell [`OpError::NoSuchElement`] for a partner, and [`OpError::Exclude`] for
/// thicknesses of groups; [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use kerfold::measure::volume;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = RindParams {
///     thickness: Length::from_mm(1.0),
///     thickness_of: Vec::new(),
///     punch: None,
///     peel: None,
///     shell: Default::default(),
/// };
/// let (shell, _) = rind(&cube, &params, &OpContext::default())?;
/// assert!((volume(&shell) - (1000.0 - 512.0)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rind(
    mesh: &Mesh,
    params: &RindParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, RindReport), OpError> {
    let skins = 3.0 * mesh.edge_count() as f64;
    check_size("skins", 2, |skins_made| f64::from(skins_made) / 2.0 * skins)?;
    let thickness = thicknesses(mesh, params)?;
    let openings = openings(mesh, params, context)?;
    if mesh.faces().all(|f| openings[f] != Opening::None) {
        return Err(OpError::AllOpened);
    }
    if params.shell == ShellSource::Given {
        if !params.thickness_of.is_empty() {
            return Err(OpError::Exclude {
                first: "a given shell",
                second: "a thickness for a group",
            });
        }
        let (opened, report) = given::open(mesh, &openings, params.thickness.mm().abs())?;
        return finish(mesh, opened, report, context.progress);
    }
    let skin = offset::offset(mesh, &thickness, context.progress)?;
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    let shell = shell::Shell::plan(mesh, &openings);
    let (made_mesh, made) = shell.build(&skin, params.thickness.mm() < 0.0);
    let mut report = RindReport { made, ..shell.report(&made_mesh) };
    // What is below the rounding of the construction is no residual.
    report.residual_mm = mesh.vertices().map(|v| skin.residuals[v]).fold(0.0, f64::max);
    if report.residual_mm <= bound(mesh) {
        report.residual_mm = 0.0;
    }
    report.crossing = crossing::Outer { mesh, openings: &openings, thickness: &thickness }
        .crossing_faces(&skin, context.progress)?;
    finish(mesh, made_mesh, report, context.progress)
}

/// Makes the result one that files can hold, and finds the faces that go through each other.
fn finish(
    before: &Mesh,
    mut shell: Mesh,
    mut report: RindReport,
    progress: &dyn Progress,
) -> Result<(Mesh, RindReport), OpError> {
    let advice = "open faces that touch each other less, or peel instead of punching";
    report.mended = keep_simple(before, &mut shell, &mut report.made, advice)?;
    report.pairs = crossing_pairs(&shell, progress)?;
    report.pairs.retain(|pair| !is_thin_wall(&shell, pair));
    Ok((shell, report))
}

/// Whether two faces are the sides of a wall without thickness, as punching leaves it between
/// neighbours: quads between the same four vertices.
fn is_thin_wall(shell: &Mesh, pair: &CrossingPair) -> bool {
    let others: Vec<VertexId> = shell.face_vertices(pair.second).collect();
    let common = shell.face_vertices(pair.first).filter(|v| others.contains(v)).count();
    pair.kind == CrossingKind::Overlap && common >= 4
}

fn bound(mesh: &Mesh) -> f64 {
    mesh.bounds().map_or(0.0, |(low, high)| RoundingBound::of_box(low, high).length())
}

fn thicknesses(mesh: &Mesh, params: &RindParams) -> Result<FaceMap<f64>, OpError> {
    let usual = params.thickness.mm();
    let least = 8.0 * bound(mesh);
    let check = |mm: f64| {
        let is_enough = mm.abs() > least && mm.is_finite();
        if is_enough { Ok(mm) } else { Err(OpError::DepthTooSmall { depth: mm, least }) }
    };
    let mut thickness = FaceMap::filled(mesh.face_slots(), check(usual)?);
    for special in &params.thickness_of {
        if !mesh.groups().contains(&special.group) {
            return Err(OpError::NoSuchGroup { group: special.group.clone() });
        }
        let mm = check(special.thickness.mm())?;
        if mm.signum() != usual.signum() {
            return Err(OpError::Exclude { first: "a thickness inwards", second: "one outwards" });
        }
        mesh.faces()
            .filter(|&f| mesh.group(f) == Some(&special.group))
            .for_each(|f| thickness[f] = mm);
    }
    Ok(thickness)
}

fn openings(
    mesh: &Mesh,
    params: &RindParams,
    context: &OpContext<'_>,
) -> Result<FaceMap<Opening>, OpError> {
    let mut openings = FaceMap::filled(mesh.face_slots(), Opening::None);
    let mut open =
        |faces: Vec<FaceId>, how: Opening| faces.into_iter().for_each(|f| openings[f] = how);
    open(mesh.holes().collect(), Opening::Punched);
    for (selection, how) in [(&params.punch, Opening::Punched), (&params.peel, Opening::Peeled)] {
        if let Some(selection) = selection {
            open(selection.faces(&context.select(mesh))?, how);
        }
    }
    Ok(openings)
}

impl RindParams {
    /// The faces that are chosen to be opened, without the rims.
    ///
    /// # Errors
    /// [`OpError::Select`] for an empty selection.
    pub(super) fn opened(
        &self,
        mesh: &Mesh,
        context: &OpContext<'_>,
    ) -> Result<Vec<FaceId>, OpError> {
        let mut faces = Vec::new();
        for selection in [&self.punch, &self.peel].into_iter().flatten() {
            faces.extend(selection.faces(&context.select(mesh))?);
        }
        Ok(faces)
    }
}
