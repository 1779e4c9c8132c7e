//! Face truncation: push a face inwards along its normal, so that it and what surrounds it become
//! planar and 3-valent.
//!
//! Source: Gonen 2007, III.B.3. P0 = mean of the edge points on the edges that leave the face; n =
//! the face's normal. Changes, while the cuts are disjoint: V and E stay for 3-valent corners, F
//! stays; a corner of higher valence is resolved. Degenerate: as for vertices.

use serde::Deserialize;

use super::cut::Cutter;
use super::truncate::{Element, Growth, Offsets, Settings, edge_point, truncate};
use super::truncate_vertex::{default_offset, default_repeat};
use super::{ChosenElements, CutReport, Disjoint, OpContext, OpError, Scope};
use crate::geom::Plane;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::select::{NewElements, Selection};

/// How to cut faces off. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct TruncateFaceParams {
    /// Which faces, in the selection language: `all`, `3,7,10-14`, `sides=5`, `normal=z:20deg`, ….
    #[arg(long, value_name = "SELECTION")]
    pub select: Selection,
    /// Where the plane meets the edges that leave the face: 0 at the face, 1 at the far ends. In
    /// (0, 2], warned above 1.
    #[arg(long, default_value_t = default_offset(), value_parser = crate::units::parse_number)]
    #[serde(default = "default_offset")]
    pub offset: f64,
    /// Cut the whole mesh, or only the part connected with the face.
    #[arg(long, value_enum, default_value_t = Scope::Global)]
    #[serde(default)]
    pub scope: Scope,
    /// How many rounds, 1 to 64; every round after the first cuts the caps of the round before.
    #[arg(long, default_value_t = default_repeat())]
    #[serde(default = "default_repeat")]
    pub repeat: u32,
    /// Make the offset smaller where cuts would meet each other, so that every element gets a cut
    /// of its own.
    #[arg(long, value_enum, default_value_t = Disjoint::No, default_missing_value = "yes", num_args = 0..=1, require_equals = true)]
    #[serde(default)]
    pub disjoint: Disjoint,
}

impl TruncateFaceParams {
    /// Cuts the selected faces at `offset`, everything else by default.
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

/// Cuts off every chosen face. All planes of a round are set before its first cut and applied in
/// the order of ids.
///
/// # Errors
/// [`OpError::Select`] for an empty selection, [`OpError::OffsetOutOfRange`],
/// [`OpError::RepeatOutOfRange`], [`OpError::NoPlaneAtFace`], [`OpError::NothingLeft`] when the
/// planes leave no mesh, [`OpError::NotSimple`] when a face comes twice to a vertex and cannot be
/// divided, [`OpError::NotDisjoint`] when disjoint cuts were asked for and cannot be had.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = TruncateFaceParams::new("0".parse()?, 0.5);
/// let (half, _) = truncate_faces(&cube, &params, &OpContext::default())?;
/// assert!((kerfold::measure::volume(&half) - 500.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn truncate_faces(
    mesh: &Mesh,
    params: &TruncateFaceParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, CutReport), OpError> {
    let chosen = params.select.faces(&context.select(mesh))?;
    let TruncateFaceParams { offset, scope, repeat, disjoint, .. } = *params;
    // Each face leaves its cap.
    let first = chosen.iter().map(|&f| mesh.sides(f)).sum();
    let growth = Growth { first, multiplies: 1.0 };
    let settings = Settings { offset, scope, repeat, disjoint, growth };
    let (mesh, report) = truncate(
        mesh,
        &settings,
        context,
        |cutter: &Cutter, made: Option<&NewElements>, offsets: &Offsets| {
            let faces = made.map_or(&chosen, |made| &made.faces);
            faces.iter().map(|&f| element(cutter.mesh(), f, offsets.of(f.index()))).collect()
        },
    )?;
    let chosen = ChosenElements { faces: chosen, ..ChosenElements::default() };
    Ok((mesh, CutReport { chosen, ..report }))
}

fn element(mesh: &Mesh, f: FaceId, t: f64) -> Result<Element, OpError> {
    let mut points = Vec::new();
    for h in mesh.face_half_edges(f) {
        let own = [h.edge(), mesh.prev(h).edge()];
        let leaving = mesh.outgoing(mesh.origin(h)).filter(|out| !own.contains(&out.edge()));
        points.extend(leaving.map(|out| edge_point(mesh, mesh.origin(out), mesh.target(out), t)));
    }
    let normal = mesh.plane(f).ok_or(OpError::NoPlaneAtFace(f))?.normal();
    let plane = Plane::through_mean(&points, &[normal]).ok_or(OpError::NoPlaneAtFace(f))?;
    let vertices: Vec<VertexId> = mesh.face_vertices(f).collect();
    Ok(Element { id: f.index(), vertices, plane, along: None })
}
