//! Verbs that carry out one operator: `kerfold planarize` and its kin. Their parameters say what
//! they do; all else is common.

use std::path::{Path, PathBuf};

use clap::Args;

use super::error::CliError;
use super::input::Input;
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::make::operate;
use crate::op::{OpContext, Operate};

/// A mesh, the parameters of an operator, and the mesh to write.
#[derive(Debug, Args)]
pub(super) struct OperatorArgs<T: Args> {
    // First, so that positional parameters come before the mesh: `subdivide SCHEME IN`.
    #[command(flatten)]
    params: T,
    #[command(flatten)]
    input: Input,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run<T: Args + Operate>(
    args: &OperatorArgs<T>,
    console: &Console,
) -> Result<Outcome, CliError> {
    let read = args.input.read()?;
    let progress = Terminal::new(console.quiet);
    let context = OpContext { made: read.made.as_ref(), progress: &progress };
    // Said at once, before work that may be long; as JSON it comes with the result alone.
    let preview = if console.json { Vec::new() } else { args.params.preview(&read.mesh) };
    console.notes(&preview);
    let made = operate(&args.params, (Path::new(""), read.scale), &read.mesh, &context)?;
    let notes = read.notes.iter().map(ToString::to_string).chain(made.notes);
    let notes: Vec<String> = notes.filter(|note| !preview.contains(note)).collect();
    console.write_model(&args.output, &made.mesh, made.made.as_ref(), &notes)?;
    Ok(if made.is_clean { Outcome::Clean } else { Outcome::Findings })
}
