//! `kerfold repair`: faces that are no surface become one.

use std::io::Read as _;
use std::path::PathBuf;

use super::error::CliError;
use super::input::Input;
use super::{Console, Outcome};
use crate::io::{IoError, repair_mesh_bytes, size_note};
use crate::op::RepairParams;

/// Mend faces that are no surface: weld, orient, drop doubled and empty faces, close T-junctions,
/// part edges with more than two faces; says what was done
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold repair scan.stl --close-holes 10mm -o whole.obj")]
pub(super) struct RepairArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    params: RepairParams,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &RepairArgs, console: &Console) -> Result<Outcome, CliError> {
    let path = &args.input.input;
    let bytes = if path.as_os_str() == "-" {
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().read_to_end(&mut bytes);
        read.map(|_| bytes)
    } else if path.is_dir() {
        return Err(IoError::IsFolder { path: path.clone() }.into());
    } else {
        std::fs::read(path)
    };
    let bytes = bytes.map_err(|source| IoError::reading(path, source))?;
    let mut read = repair_mesh_bytes(path, &bytes, &args.input.options, &args.params)?;
    read.mesh.compact();
    read.notes.extend(size_note(&read.mesh, &args.input.options));
    let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
    console.write_model(&args.output, &read.mesh, None, &notes)?;
    Ok(Outcome::Clean)
}
