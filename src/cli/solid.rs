//! `kerfold solid`

use std::path::PathBuf;

use super::error::CliError;
use super::{Console, Outcome};
use crate::shape::{SolidParams, solid};

/// Write a ready-made solid: Platonic, Archimedean, prism-N, antiprism-N, geodesic-N, soccer-ball,
/// box-AxBxC
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold solid dodecahedron --edge 40mm -o dodecahedron.obj")]
pub(super) struct SolidArgs {
    #[command(flatten)]
    solid: SolidParams,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &SolidArgs, console: &Console) -> Result<Outcome, CliError> {
    console.write_model(&args.output, &solid(&args.solid)?, None, &[])?;
    Ok(Outcome::Clean)
}
