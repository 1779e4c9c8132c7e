//! The mesh file that most verbs begin with.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::error::CliError;
use crate::io::{
    IoError, ReadMesh, ReadOptions, decode_text, read_mesh, read_mesh_bytes, size_note,
};
use crate::sheet::SheetParams;

/// A mesh file and how to read it.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct Input {
    /// The mesh: OBJ, PLY, STL, OFF, GLB or 3MF; `-` reads OBJ from standard input
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    #[command(flatten)]
    pub options: ReadOptions,
}

impl Input {
    /// Sheet parameters with the name of the file as that of the project, unless they have one.
    pub(super) fn titled(&self, sheet: SheetParams) -> SheetParams {
        let stem = self.input.file_stem().filter(|_| self.input.as_os_str() != "-");
        sheet.titled(&stem.unwrap_or_default().to_string_lossy())
    }

    pub(super) fn read(&self) -> Result<ReadMesh, CliError> {
        let mut read = read_model(&self.input, &self.options)?;
        read.notes.extend(size_note(&read.mesh, &self.options));
        Ok(read)
    }
}

/// Reads a mesh file, or OBJ from standard input when the path is `-`.
pub(super) fn read_model(path: &Path, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    if path.as_os_str() != "-" {
        return read_mesh(path, options);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|source| IoError::reading(path, source))?;
    read_mesh_bytes(path, &bytes, options)
}

/// A file as text.
pub(super) fn read_text(path: &Path) -> Result<String, CliError> {
    let bytes = std::fs::read(path)
        .map_err(|error| CliError::Unreadable { path: path.to_owned(), error })?;
    decode_text(&bytes).map_err(|at| CliError::NotText { path: path.to_owned(), at })
}
