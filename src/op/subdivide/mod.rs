//! Subdivision: a finer mesh of the same shape and genus, by one of eight schemes.
//!
//! Sources: Doo and Sabin 1978; Catmull and Clark 1978; Loop 1987, extended to faces of any number
//! of sides; Peters and Reif 1997 ("simplest"); Akleman, Srinivasan 2002 (honeycomb); Srinivasan
//! 2004, VI and VII, and Srinivasan and Akleman 2004, figures 11 to 14, for their use on high-genus
//! meshes with self-loops. Weights: `operators.md` 10.
//!
//! ```text
//!   scheme            V        E    F          scheme           V     E     F
//!   doo-sabin         2E       4E   V+E+F      honeycomb        2E    3E    V+F
//!   catmull-clark     V+E+F    4E   2E         truncation       2E    3E    V+F
//!   loop              V+E      4E   F+2E       dual             F     E     V
//!   simplest          E        2E   V+F        triangulate      V     E+…   n−2 per face
//! ```
//!
//! Needs: nothing; self-loops, 2-gons and vertices of any valence are legal. Keeps: genus,
//! components, face groups of what stands for an old face. Always 3-valent: honeycomb and
//! truncation. Planarity: dual of triangle meshes and triangulations are planar, the others only by
//! luck; `planarize` or face cuts bring it back. Open meshes: the table holds for closed ones; a
//! rim stays a rim, its rule is given by each scheme.

mod averaging;
mod corner_schemes;
mod split_schemes;

#[cfg(test)]
mod tests;

use serde::Deserialize;

use super::simple::{Mended, keep_simple};
use super::size::{Counts, ask, check_size};
use super::{OpContext, OpError};
use crate::mesh::{FaceId, Mesh};
use crate::progress::Progress;
use crate::select::NewElements;

/// The most rounds that may be asked for; the size of the result ends it much sooner.
const MOST_ROUNDS: u32 = 32;

/// How a mesh is made finer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// A smaller copy of each face, a quad for each edge, a polygon for each vertex; approaches a
    /// smooth surface.
    DooSabin,
    /// Quads only, one for each corner; approaches a smooth surface.
    CatmullClark,
    /// Every edge halved, every corner cut off by a triangle; smooth on triangle meshes.
    Loop,
    /// The midpoints of edges joined around faces and vertices.
    Simplest,
    /// Every face with twice as many sides at every vertex: three edges everywhere.
    Honeycomb,
    /// Every vertex cut off at a share of its edges, whether or not the new corners lie in a plane:
    /// three edges everywhere.
    Truncation,
    /// A vertex for each face, a face for each vertex.
    Dual,
    /// Every face divided into triangles between its own corners.
    Triangulate,
}

impl Scheme {
    /// The counts after a round on a closed mesh, as in the table above. A triangulation makes its
    /// diagonals once.
    fn refined(self, Counts { vertices, edges, faces }: Counts) -> Counts {
        let [vertices, edges, faces] = match self {
            Self::DooSabin => [2.0 * edges, 4.0 * edges, vertices + edges + faces],
            Self::CatmullClark => [vertices + edges + faces, 4.0 * edges, 2.0 * edges],
            Self::Loop => [vertices + edges, 4.0 * edges, faces + 2.0 * edges],
            Self::Simplest => [edges, 2.0 * edges, vertices + faces],
            Self::Honeycomb | Self::Truncation => [2.0 * edges, 3.0 * edges, vertices + faces],
            Self::Dual => [faces, edges, vertices],
            Self::Triangulate => [vertices, 3.0 * vertices.max(edges - faces), edges],
        };
        Counts { vertices, edges, faces }
    }
}

/// How to subdivide. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct SubdivideParams {
    /// Which scheme.
    #[arg(value_enum, value_name = "SCHEME")]
    pub scheme: Scheme,
    /// How many rounds, 1 to 32; most schemes make four times as many edges in each.
    #[arg(long, default_value_t = default_rounds())]
    #[serde(default = "default_rounds")]
    pub rounds: u32,
    /// For `truncation`: where edges are cut, as a share of their length above 0 and below 1/2.
    #[arg(long, value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub offset: Option<f64>,
}

fn default_rounds() -> u32 {
    1
}

/// The share of an edge that a truncation cuts off unless said otherwise.
const DEFAULT_OFFSET: f64 = 0.25;

impl SubdivideParams {
    /// So many rounds of a scheme.
    pub fn new(scheme: Scheme, rounds: u32) -> Self {
        Self { scheme, rounds, offset: None }
    }
}

/// What a subdivision did besides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SubdivideReport {
    /// What had to be mended so that files can hold the result; nothing on a mesh without 2-valent
    /// vertices of which two faces have at most one edge in common.
    pub mended: Mended,
}

impl SubdivideReport {
    /// The report in words.
    pub fn notes(&self) -> Vec<String> {
        self.mended.notes()
    }
}

/// Subdivides a mesh. Positions count as constructed; planes are not carried along.
///
/// # Errors
/// [`OpError::RepeatOutOfRange`]; [`OpError::ShareOutOfRange`] for the offset of a truncation,
/// [`OpError::Requires`] for an offset with another scheme; [`OpError::DoesNotFit`] before the
/// first round; [`OpError::NotSimple`]; [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use kerfold::op::Scheme;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = SubdivideParams::new(Scheme::CatmullClark, 1);
/// let (rounder, _) = subdivide(&cube, &params, &OpContext::default())?;
/// assert_eq!(rounder.face_count(), 24);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn subdivide(
    mesh: &Mesh,
    params: &SubdivideParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, SubdivideReport), OpError> {
    let offset = check_params(params)?;
    let counts = Counts::of(mesh);
    let edges = |rounds| counts.after(rounds, |counts| params.scheme.refined(counts)).edges;
    check_size("rounds", params.rounds, edges)?;
    let mut fine: Option<Mesh> = None;
    for round in 0..params.rounds {
        if context.progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        context.progress.report("subdividing", round as usize, params.rounds as usize);
        let coarse = fine.as_ref().unwrap_or(mesh);
        fine = Some(once(coarse, params.scheme, offset, context.progress)?);
    }
    let mut fine = fine.expect("there is at least one round");
    let advice = "give the model three edges at every vertex first, or take another scheme";
    let mended = keep_simple(mesh, &mut fine, &mut NewElements::default(), advice)?;
    Ok((fine, SubdivideReport { mended }))
}

fn check_params(params: &SubdivideParams) -> Result<f64, OpError> {
    if !(1..=MOST_ROUNDS).contains(&params.rounds) {
        return Err(OpError::RepeatOutOfRange { repeat: params.rounds, limit: MOST_ROUNDS });
    }
    match params.offset {
        Some(_) if params.scheme != Scheme::Truncation => {
            Err(OpError::Requires { what: "an offset", needed: "the scheme truncation" })
        }
        Some(share) if !(share > 0.0 && share < 0.5) => {
            Err(OpError::ShareOutOfRange { what: "offset", share, limit: 0.5 })
        }
        offset => Ok(offset.unwrap_or(DEFAULT_OFFSET)),
    }
}

fn once(
    mesh: &Mesh,
    scheme: Scheme,
    offset: f64,
    progress: &dyn Progress,
) -> Result<Mesh, OpError> {
    match scheme {
        Scheme::DooSabin => corner_schemes::doo_sabin(mesh, progress),
        Scheme::Honeycomb => corner_schemes::honeycomb(mesh, progress),
        Scheme::Truncation => corner_schemes::truncation(mesh, offset, progress),
        Scheme::Simplest => corner_schemes::simplest(mesh, progress),
        Scheme::Dual => corner_schemes::dual(mesh, progress),
        Scheme::CatmullClark => split_schemes::catmull_clark(mesh, progress),
        Scheme::Loop => split_schemes::loop_scheme(mesh, progress),
        Scheme::Triangulate => split_schemes::triangulated(mesh, progress),
    }
}

/// Faces that stand for old ones keep their groups.
fn carry_groups(from: &Mesh, to: &mut Mesh, pairs: impl Iterator<Item = (FaceId, FaceId)>) {
    if from.groups().is_empty() {
        return;
    }
    for (old, new) in pairs {
        if let Some(name) = from.group(old) {
            to.set_group(new, name);
        }
    }
}
