//! Files as names and bytes, written whole or not at all.

use std::path::{Path, PathBuf};

use kerfold::io::output::{self, OutputFolder};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::trouble::coded;

/// Names and bytes.
pub(crate) type Files<'py> = Vec<(String, Bound<'py, PyBytes>)>;

/// Files of the house as those of Python.
pub(crate) fn named(py: Python<'_>, files: Vec<(String, Vec<u8>)>) -> Files<'_> {
    files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect()
}

/// Writes files into a folder, all or none; returns their paths, and those of files of an earlier
/// run that are no part of this one and were removed (`clean`) or not.
#[pyfunction]
pub(crate) fn write_folder(
    folder: PathBuf,
    files: Files<'_>,
    clean: bool,
) -> PyResult<(Vec<PathBuf>, Vec<PathBuf>)> {
    let mut together = OutputFolder::new(folder);
    for (name, bytes) in &files {
        together.add(name, bytes.as_bytes());
    }
    let written = together.commit().map_err(|error| coded(&error))?;
    if clean {
        written.remove_stale().map_err(|error| coded(&error))?;
    }
    Ok((written.paths, written.stale))
}

/// Writes a file, whole or not at all.
#[pyfunction]
pub(crate) fn write_file(path: PathBuf, bytes: &Bound<'_, PyBytes>) -> PyResult<()> {
    output::write_file(Path::new(&path), bytes.as_bytes()).map_err(|error| coded(&error))
}
