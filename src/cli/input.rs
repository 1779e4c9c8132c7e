//! The mesh file that most verbs begin with.

use std::path::PathBuf;

use super::error::CliError;
use crate::io::{ReadMesh, ReadOptions, read_mesh};

/// A mesh file and how to read it.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Input {
    /// The mesh: OBJ, PLY, STL or OFF; `-` reads OBJ from standard input
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    #[command(flatten)]
    pub options: ReadOptions,
}

impl Input {
    pub(super) fn read(&self) -> Result<ReadMesh, CliError> {
        Ok(read_mesh(&self.input, &self.options)?)
    }
}
