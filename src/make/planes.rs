//! A solid of half-spaces from a file, for the recipe step `planes` and the verb `hull --planes`.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::MakeError;
use crate::io::planes_csv::read_planes;
use crate::mesh::Mesh;
use crate::op::{HullParams, HullReport, OpContext, OpError, halfspaces};
use crate::progress::Progress;

/// A file of half-spaces.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct PlanesStep {
    /// The file, relative to the recipe's folder: nx,ny,nz,d on each line for n·x ≤ d.
    #[arg(value_name = "FILE.csv")]
    pub path: PathBuf,
    /// Divide vertices where more than three planes meet, so that exactly three edges meet in each;
    /// planes there move inwards by at most 1/32768 of the size.
    #[arg(long)]
    #[serde(default)]
    pub simple: bool,
}

/// Reads half-spaces and makes the solid that they bound. Of `params` only [`HullParams::simple`]
/// matters.
///
/// # Errors
/// [`MakeError::Planes`] with file and line, [`MakeError::Op`].
pub fn solid_of_planes(
    file: &Path,
    params: &HullParams,
    progress: &dyn Progress,
) -> Result<(Mesh, HullReport), MakeError> {
    let planes = read_planes(file)?;
    let context = OpContext { made: None, progress };
    halfspaces(&planes.half_spaces, params, &context).map_err(|error| match error {
        OpError::HalfSpaces { reason, .. } => planes.no_solid(file, reason).into(),
        other => other.into(),
    })
}
