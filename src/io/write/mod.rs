//! Writing mesh files: one writer for each format. Elements are numbered densely in the order of
//! their ids; holes are not written.

use std::path::Path;

use super::error::IoError;
use super::format::MeshFormat;
use super::output;
use crate::mesh::Mesh;
use crate::select::NewElements;

mod faces_dxf;
pub mod glb;
mod obj;
mod obj_check;
mod off;
pub mod plates;
mod ply;
mod polygons;
mod read_back;
pub mod step;
mod stl;
mod threemf;

/// How a mesh file is written.
#[derive(Debug, Clone, Default)]
pub struct WriteOptions {
    /// The whole command line that made the mesh (`kerfold solid cube -o cube.obj`), for a comment
    /// in the file.
    pub command: Option<String>,
    /// What the last step made, for OBJ: groups `made` and `strip`, which the selections of those
    /// names find again when the file is read.
    pub made: Option<NewElements>,
    /// How PLY files are encoded.
    pub ply: PlyEncoding,
}

/// How the numbers of a PLY file are written. All three keep every digit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PlyEncoding {
    /// As text.
    #[default]
    Text,
    /// Binary, lowest byte first.
    BinaryLittleEndian,
    /// Binary, highest byte first.
    BinaryBigEndian,
}

impl WriteOptions {
    /// The command line as a comment of one line.
    fn comment(&self) -> Option<String> {
        self.command.as_ref().map(|command| one_line(command))
    }
}

/// What the comments of mesh files say about their numbers; `--units` is compared with it.
const UNITS: &str = "units: mm";

/// The text without control characters, which would end a line.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Writes a mesh to a file in the format of its extension, or as OBJ to standard output when the
/// path is `-`. The file is whole or not there ([`output::write_file`]).
///
/// # Errors
/// When the extension is not known or the file cannot be written.
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, WriteOptions, read_mesh, write_mesh};
///
/// let path = std::env::temp_dir().join(format!("kerfold-doc-{}-cube.ply", std::process::id()));
/// write_mesh(&path, &kerfold::shape::cube(10.0), &WriteOptions::default())?;
/// let again = read_mesh(&path, &ReadOptions::default())?;
/// # std::fs::remove_file(&path)?;
/// assert_eq!(again.mesh.face_count(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_mesh(path: &Path, mesh: &Mesh, options: &WriteOptions) -> Result<(), IoError> {
    let format = MeshFormat::of_path(path)
        .ok_or_else(|| IoError::UnknownFormat { path: path.to_owned() })?;
    output::write_file(path, &mesh_bytes(format, mesh, options)?)
}

/// The content of a mesh file.
///
/// OBJ, PLY, OFF, 3MF and DXF keep every digit of the coordinates; OBJ, 3MF and DXF keep groups, OBJ
/// alone keeps seams; STL rounds to single precision; STL and 3MF cut faces into triangles.
///
/// # Errors
/// [`IoError::NotForFiles`] for a mesh that would not be read again, [`IoError::ReadAsOther`] for
/// one that would be read as another; [`IoError::OnlyRead`] for a format of which meshes are read
/// alone; [`IoError::NotReadBack`] for a fault of a writer: all files
/// are read back by other code. [`IoError::TooFarForStl`] when a coordinate does not fit,
/// [`IoError::NotForStl`] when parts touch that STL cannot tell apart,
/// [`IoError::NotForTriangles`] when no triangles hold the mesh.
///
/// # Example
/// ```
/// use kerfold::io::{MeshFormat, WriteOptions, mesh_bytes};
///
/// let cube = kerfold::shape::cube(10.0);
/// let off = mesh_bytes(MeshFormat::Off, &cube, &WriteOptions::default())?;
/// assert!(off.starts_with(b"OFF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_bytes(
    format: MeshFormat,
    mesh: &Mesh,
    options: &WriteOptions,
) -> Result<Vec<u8>, IoError> {
    if let Some(&fault) = mesh.file_faults().first() {
        return Err(IoError::NotForFiles { fault });
    }
    read_back::check_counts(mesh)?;
    let bytes = match format {
        MeshFormat::Obj => obj::write(mesh, options),
        MeshFormat::Ply => ply::write(mesh, options),
        MeshFormat::Off => off::write(mesh, options),
        MeshFormat::Stl => stl::write(mesh, options)?,
        MeshFormat::ThreeMf => threemf::write(mesh, options)?,
        MeshFormat::Dxf => faces_dxf::write(mesh, options),
        MeshFormat::Glb => return Err(IoError::OnlyRead { format }),
    };
    read_back::check_bytes(format, &bytes, mesh)?;
    Ok(bytes)
}

/// What the user should know of the file of a mesh: what holds a mesh in memory together, but is no
/// part of files.
pub fn file_note(mesh: &Mesh) -> Option<String> {
    let counts = mesh.file_counts().filter(|_| read_back::has_more_than_files(mesh))?;
    Some(format!(
        "self-loops and faces with two sides are no part of files: the file has {counts}; smooth \
        the model before it is written to keep it in one"
    ))
}

#[cfg(test)]
mod tests;
