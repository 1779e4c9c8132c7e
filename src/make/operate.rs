//! Carries out an operator with the files that its parameters name.

use std::path::Path;

use super::MakeError;
use crate::io::read_points;
use crate::mesh::Mesh;
use crate::op::{OpContext, Operate, OperatorOutput};

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
