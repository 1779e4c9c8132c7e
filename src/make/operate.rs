//! Carries out an operator with the files that its parameters name.

use std::path::Path;

use super::MakeError;
use crate::io::read_points;
use crate::mesh::{EdgeId, Mesh, VertexMap};
use crate::op::{OpContext, Operate, OperatorOutput};
use crate::seam::piece_count;
use crate::select::NewElements;

/// Reads the file of points that the parameters name, if any, relative to `folder`, and carries the
/// operator out.
///
/// # Errors
/// [`MakeError::Io`] for the file, [`MakeError::Op`] for the operator.
pub fn operate(
    params: &dyn Operate,
    folder: &Path,
    mesh: &Mesh,
    context: &OpContext<'_>,
) -> Result<OperatorOutput, MakeError> {
    let with_points = match params.points_file() {
        Some(file) => params.with_points(read_points(&folder.join(file))?),
        None => None,
    };
    Ok(with_points.as_deref().unwrap_or(params).operate(mesh, context)?)
}

/// How many pieces edges promise that were cut off one by one: those that all other edges of the mesh
/// before leave. Cutting the strips of the last cut again keeps its promise. Nothing is promised where
/// two of the edges meet, since the faces around that vertex need not lie flat, and on an open mesh.
pub fn promised_pieces(
    before: &Mesh,
    (cut, made): (&[EdgeId], Option<&NewElements>),
    promised: Option<usize>,
) -> Option<usize> {
    let mut folds = VertexMap::filled(before.vertex_slots(), 0_u8);
    let apart = cut.iter().flat_map(|&e| before.edge_vertices(e)).all(|v| {
        folds[v] = folds[v].saturating_add(1);
        folds[v] == 1
    });
    if made.is_some_and(|made| made.strip == cut) && promised.is_some() {
        return promised;
    }
    (apart && !cut.is_empty() && before.is_closed()).then(|| piece_count(before, cut))
}
