//! Carries out an operator with the files that its parameters name.

use std::path::Path;

use super::MakeError;
use crate::io::planes_csv::read_planes;
use crate::io::{read_curves, read_points};
use crate::mesh::{EdgeId, Mesh, VertexMap};
use crate::op::{OpContext, Operate, OperatorOutput};
use crate::seam::piece_count;
use crate::select::NewElements;

/// Reads the files of points and of planes that the parameters name, if any, relative to `folder`, and
/// carries the operator out. `scale` is the factor from the numbers of the model's file to millimetres, which
/// curves that were drawn on it share.
///
/// # Errors
/// [`MakeError::Io`] and [`MakeError::Planes`] for the files, [`MakeError::Op`] for the operator.
pub fn operate(
    params: &dyn Operate,
    (folder, scale): (&Path, f64),
    mesh: &Mesh,
    context: &OpContext<'_>,
) -> Result<OperatorOutput, MakeError> {
    let with_points = match params.points_file() {
        Some(file) => params.with_points(read_curves(&folder.join(file))?, scale),
        None => None,
    };
    let params = with_points.as_deref().unwrap_or(params);
    let with_places = match params.places_file() {
        Some(file) => params.with_places(read_points(&folder.join(file))?, scale),
        None => None,
    };
    let params = with_places.as_deref().unwrap_or(params);
    let planes = |file: &Path| -> Result<Vec<_>, MakeError> {
        let read = read_planes(&folder.join(file))?;
        Ok(read.half_spaces.into_iter().zip(read.lines).collect())
    };
    let with_rim = match params.rim_file() {
        Some(file) => params.with_rim(&planes(file)?, scale),
        None => None,
    };
    let params = with_rim.as_deref().unwrap_or(params);
    let with_planes = match params.planes_file() {
        Some(file) => params.with_planes(&planes(file)?, scale),
        None => None,
    };
    Ok(with_planes.as_deref().unwrap_or(params).operate(mesh, context)?)
}

/// Into how many pieces the strips of edges come apart that were cut off one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PiecePromise {
    /// The pieces that all other edges of the mesh before leave.
    pub pieces: usize,
    /// Whether every vertex had one of the edges: the mesh is a D-form, and nothing else.
    pub is_perfect: bool,
}

impl PiecePromise {
    /// What edges promise that were cut. Cutting the strips of the last cut again keeps its promise.
    /// Nothing is promised where two of the edges meet, since the faces around that vertex need not
    /// lie flat, and on an open mesh.
    pub fn of(
        before: &Mesh,
        (cut, made): (&[EdgeId], Option<&NewElements>),
        earlier: Option<Self>,
    ) -> Option<Self> {
        if earlier.is_some() && made.is_some_and(|made| made.strip == cut) {
            return earlier;
        }
        let mut folds = VertexMap::filled(before.vertex_slots(), 0_u8);
        let apart = cut.iter().flat_map(|&e| before.edge_vertices(e)).all(|v| {
            folds[v] = folds[v].saturating_add(1);
            folds[v] == 1
        });
        let is_perfect = before.vertices().all(|v| before.valence(v) == 3 && folds[v] == 1);
        (apart && !cut.is_empty() && before.is_closed())
            .then(|| Self { pieces: piece_count(before, cut), is_perfect })
    }
}
