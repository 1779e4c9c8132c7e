//! Vertex truncation: cut a vertex off by a plane set by its own neighbourhood.
//!
//! Source: Gonen 2007, III.B.2 and eq. 3.1 (t runs from the vertex outwards, see
//! `docs/operators.md`).
//!
//! ```text
//!        v                 .
//!       /|\    t·(u−v)    / \     P0 = mean of the edge points, n = mean of the face normals:
//!      / | \    ------>  /___\    a cap with as many sides as v has edges, every corner 3-valent
//!     u  u  u           u  u  u
//! ```
//!
//! Keeps: planarity of every old face; genus. Changes, while the caps are disjoint: V + (valence −
//! 1), E + valence, F + 1 for each chosen vertex. Degenerate: a plane through a neighbour keeps
//! that neighbour as a corner of the cap; cuts that meet are named in [`CutReport::overcut`], never
//! silently merged.

use serde::Deserialize;

use super::cut::Cutter;
use super::truncate::{Element, Growth, Offsets, Settings, edge_point, truncate};
use super::{ChosenElements, CutReport, Disjoint, OpContext, OpError, Scope};
use crate::geom::Plane;
use crate::mesh::{Mesh, VertexId};
use crate::select::{NewElements, Selection};

/// How to cut vertices off. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct TruncateVertexParams {
    /// Which vertices, in the selection language: `all`, `3,7,10-14`, `valence>3`, ….
    #[arg(long, value_name = "SELECTION")]
    pub select: Selection,
    /// Where the plane meets the edges of the vertex: 0 at the vertex, 1 at the far ends. In (0,
    /// 2], warned above 1.
    #[arg(long, default_value_t = default_offset(), value_parser = crate::units::parse_number)]
    #[serde(default = "default_offset")]
    pub offset: f64,
    /// Cut the whole mesh, or only the part connected with the vertex.
    #[arg(long, value_enum, default_value_t = Scope::Global)]
    #[serde(default)]
    pub scope: Scope,
    /// How many rounds, 1 to 64; every round after the first cuts the corners of the caps of the
    /// round before.
    #[arg(long, default_value_t = default_repeat())]
    #[serde(default = "default_repeat")]
    pub repeat: u32,
    /// Make the offset smaller where cuts would meet each other, so that every element gets a cut
    /// of its own.
    #[arg(long, value_enum, default_value_t = Disjoint::No, default_missing_value = "yes", num_args = 0..=1, require_equals = true)]
    #[serde(default)]
    pub disjoint: Disjoint,
}

pub(super) fn default_offset() -> f64 {
    0.25
}

pub(super) fn default_repeat() -> u32 {
    1
}

impl TruncateVertexParams {
    /// Cuts the selected vertices at `offset`, everything else by default.
    pub fn new(select: Selection, offset: f64) -> Self {
        Self {
            select,
            offset,
            scope: Scope::default(),
            repeat: default_repeat(),
            disjoint: Disjoint::default(),
        }
    }
}

/// Cuts off every chosen vertex. All planes of a round are set before its first cut and applied in
/// the order of ids.
///
/// # Errors
/// [`OpError::Select`] for an empty selection, [`OpError::OffsetOutOfRange`],
/// [`OpError::RepeatOutOfRange`], [`OpError::NoPlaneAtVertex`], [`OpError::NothingLeft`] when the
/// planes leave no mesh, [`OpError::NotSimple`] when a face comes twice to a vertex and cannot be
/// divided, [`OpError::NotDisjoint`] when disjoint cuts were asked for and cannot be had.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = TruncateVertexParams::new("all".parse()?, 0.25);
/// let (carved, _) = truncate_vertices(&cube, &params, &OpContext::default())?;
/// // Six faces with eight sides, eight triangles, three edges at every vertex.
/// assert_eq!((carved.face_count(), carved.vertex_count()), (14, 24));
/// assert!(carved.vertices().all(|v| carved.valence(v) == 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn truncate_vertices(
    mesh: &Mesh,
    params: &TruncateVertexParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, CutReport), OpError> {
    let chosen = params.select.vertices(&context.select(mesh))?;
    let TruncateVertexParams { offset, scope, repeat, disjoint, .. } = *params;
    // Each vertex leaves one at each of its edges, three as a rule.
    let first = chosen.iter().map(|&v| mesh.valence(v)).sum();
    let growth = Growth { first, multiplies: 3.0 };
    let settings = Settings { offset, scope, repeat, disjoint, growth };
    let (mesh, report) = truncate(
        mesh,
        &settings,
        context,
        |cutter: &Cutter, made: Option<&NewElements>, offsets: &Offsets| {
            let vertices = made.map_or(&chosen, |made| &made.vertices);
            vertices.iter().map(|&v| element(cutter.mesh(), v, offsets.of(v.index()))).collect()
        },
    )?;
    let chosen = ChosenElements { vertices: chosen, ..ChosenElements::default() };
    Ok((mesh, CutReport { chosen, ..report }))
}

fn element(mesh: &Mesh, v: VertexId, t: f64) -> Result<Element, OpError> {
    let points: Vec<_> = mesh.neighbours(v).map(|u| edge_point(mesh, v, u, t)).collect();
    let normals: Vec<_> =
        mesh.vertex_faces(v).filter_map(|f| mesh.plane(f)).map(|p| p.normal()).collect();
    let plane = Plane::through_mean(&points, &normals).ok_or(OpError::NoPlaneAtVertex(v))?;
    Ok(Element { id: v.index(), vertices: vec![v], plane, along: None })
}
