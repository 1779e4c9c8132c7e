//! Edge truncation: shave an edge off; repeated, it rolls the edge into a developable strip. With
//! `roll` all strips are set at once, even and tangent to both faces (`roll`).
//!
//! Source: Gonen 2007, III.B.1, IV.A and figure 10; the "bent" control of chapter V is `bend`.
//!
//! P0 = mean of the edge points on all other edges at both ends; n ∝ (1 + b) n₁ + (1 − b) n₂ with
//! n₁ the normal of the face with the lower id. Changes, while the caps are disjoint and the ends
//! 3-valent: V + 2, E + 3, F + 1 for each chosen edge. Degenerate: as for vertices.

use serde::Deserialize;

use super::cut::Cutter;
use super::roll::{Roll, RollOptions, RollParams, roll_edges};
use super::truncate::{Element, Growth, Offsets, Settings, edge_point, truncate};
use super::truncate_vertex::{default_offset, default_repeat};
use super::{CutReport, Disjoint, OpContext, OpError, Scope};
use crate::geom::Plane;
use crate::mesh::{EdgeId, HalfEdgeId, Mesh};
use crate::select::{NewElements, Selection};

/// How to cut edges off. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct TruncateEdgeParams {
    /// Which edges, in the selection language: `all`, `3,7,10-14`, `fold>30deg`, `along=z:5deg`,
    /// `hamiltonian`, ….
    #[arg(long, value_name = "SELECTION")]
    pub select: Selection,
    /// Where the plane meets the other edges at the two ends: 0 at the edge, 1 at the far ends. In
    /// (0, 2], warned above 1; 0.25 unless given.
    #[arg(long, value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub offset: Option<f64>,
    /// How far the plane leans towards one of the two faces, -1 to 1; 0 weighs their normals alike.
    #[arg(long, default_value_t = 0.0, value_parser = crate::units::parse_number, allow_negative_numbers = true)]
    #[serde(default)]
    pub bend: f64,
    /// Cut the whole mesh, or only the part connected with the edge.
    #[arg(long, value_enum, default_value_t = Scope::Global)]
    #[serde(default)]
    pub scope: Scope,
    /// How many rounds, 1 to 64; every round after the first cuts the two long edges of each strip
    /// of the round before.
    #[arg(long, default_value_t = default_repeat())]
    #[serde(default = "default_repeat")]
    pub repeat: u32,
    /// Make the offset smaller where cuts would meet each other, so that every element gets a cut
    /// of its own.
    #[arg(long, value_enum, default_value_t = Disjoint::No, default_missing_value = "yes", num_args = 0..=1, require_equals = true)]
    #[serde(default)]
    pub disjoint: Disjoint,
    /// Whether to roll the edges instead.
    #[command(flatten)]
    #[serde(flatten)]
    pub rolling: RollOptions,
}

impl TruncateEdgeParams {
    /// Cuts the selected edges at `offset`, everything else by default.
    pub fn new(select: Selection, offset: f64) -> Self {
        Self {
            select,
            offset: Some(offset),
            bend: 0.0,
            scope: Scope::default(),
            repeat: default_repeat(),
            disjoint: Disjoint::default(),
            rolling: RollOptions::default(),
        }
    }

    /// Rolls the selected edges into nine strips each.
    pub fn rolled(select: Selection, roll: Roll) -> Self {
        Self { offset: None, rolling: RollOptions::new(roll), ..Self::new(select, 0.0) }
    }

    /// How to roll, if that is asked for; what belongs to the other way of cutting is refused.
    fn roll(&self) -> Result<Option<RollParams>, OpError> {
        let Some(first) = self.rolling.given() else { return Ok(None) };
        let Some(roll) = self.rolling.roll else {
            return Err(OpError::Requires { what: first, needed: "roll" });
        };
        let cuts = [
            ("offset", self.offset.is_some()),
            ("bend", self.bend != 0.0),
            ("repeat", self.repeat != default_repeat()),
            ("disjoint", self.disjoint == Disjoint::Yes),
        ];
        match cuts.into_iter().find(|given| given.1) {
            Some((second, _)) => Err(OpError::Exclude { first, second }),
            None => Ok(Some(self.rolling.or(roll))),
        }
    }
}

/// Cuts off every chosen edge. All planes of a round are set before its first cut and applied in
/// the order of ids.
///
/// # Errors
/// [`OpError::Select`] for an empty selection, [`OpError::OffsetOutOfRange`],
/// [`OpError::BendOutOfRange`], [`OpError::RepeatOutOfRange`], [`OpError::NoPlaneAtEdge`],
/// [`OpError::NothingLeft`] when the planes leave no mesh, [`OpError::NotSimple`] when a face comes
/// twice to a vertex and cannot be divided, [`OpError::NotDisjoint`] when disjoint
/// cuts were asked for and cannot be had; [`OpError::Roll`] for edges that cannot be rolled,
/// [`OpError::Exclude`] and [`OpError::Requires`] for options that do not go together.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = TruncateEdgeParams::new("along=z".parse()?, 0.2);
/// let (column, report) = truncate_edges(&cube, &params, &OpContext::default())?;
/// assert_eq!((column.face_count(), report.cuts), (10, 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn truncate_edges(
    mesh: &Mesh,
    params: &TruncateEdgeParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, CutReport), OpError> {
    if !(-1.0..=1.0).contains(&params.bend) {
        return Err(OpError::BendOutOfRange { bend: params.bend });
    }
    let roll = params.roll()?;
    let chosen = params.select.edges(&context.select(mesh))?;
    if let Some(roll) = roll {
        let (mesh, report) = roll_edges(mesh, &chosen, &roll, context)?;
        return Ok((mesh, report.of_edges(chosen)));
    }
    let offset = params.offset.unwrap_or(default_offset());
    let TruncateEdgeParams { scope, repeat, disjoint, .. } = *params;
    // Each edge leaves the two long sides of its strip.
    let first = chosen.iter().flat_map(|&e| mesh.edge_vertices(e)).map(|v| mesh.valence(v)).sum();
    let growth = Growth { first, multiplies: 2.0 };
    let settings = Settings { offset, scope, repeat, disjoint, growth };
    let (mesh, report) = truncate(
        mesh,
        &settings,
        context,
        |cutter: &Cutter, made: Option<&NewElements>, offsets: &Offsets| {
            let edges = made.map_or(&chosen, |made| &made.strip);
            edges.iter().map(|&e| element(cutter, e, offsets.of(e.index()), params.bend)).collect()
        },
    )?;
    Ok((mesh, report.of_edges(chosen)))
}

fn element(cutter: &Cutter, e: EdgeId, t: f64, bend: f64) -> Result<Element, OpError> {
    let mesh = cutter.mesh();
    let around = |h: HalfEdgeId| mesh.outgoing(mesh.origin(h)).filter(move |out| out.edge() != e);
    let points: Vec<_> = e
        .half_edges()
        .into_iter()
        .flat_map(around)
        .map(|out| edge_point(mesh, mesh.origin(out), mesh.target(out), t))
        .collect();
    let mut faces = mesh.edge_faces(e);
    faces.sort_unstable();
    let weights = [1.0 + bend, 1.0 - bend];
    let normals: Vec<_> = faces
        .into_iter()
        .zip(weights)
        .filter(|&(f, _)| !mesh.is_hole(f))
        .filter_map(|(f, weight)| Some(mesh.plane(f)?.normal() * weight))
        .collect();
    let plane = Plane::through_mean(&points, &normals).ok_or(OpError::NoPlaneAtEdge(e))?;
    let along = Some(mesh.edge_faces(e).map(|f| cutter.lineage_of(f)));
    Ok(Element { id: e.index(), vertices: mesh.edge_vertices(e).to_vec(), plane, along })
}
