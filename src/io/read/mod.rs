//! Reading mesh files: one reader for each format, then scaling, welding and building, which are
//! the same for all.

use std::path::Path;

use super::error::IoError;
use super::format::MeshFormat;
use crate::mesh::{Mesh, SplitVertex};
use crate::units::Length;
use source::SourceFile;

pub mod artwork;
mod content;
mod decode;
mod keyhole;
mod note;
mod obj;
mod off;
mod plain;
mod ply;
mod points;
mod raw;
mod rim;
mod seams;
mod source;
mod stl;
mod text;
mod weld;

#[cfg(test)]
mod tests;

pub use decode::{decode_text, read_text};
pub use note::ReadNote;
pub(super) use plain::polygons_in;
pub use points::{read_points, read_points_bytes};
pub use seams::{read_seams, read_seams_bytes};

/// How a mesh file is taken.
#[derive(Debug, Clone, Default, clap::Args, serde::Deserialize)]
pub struct ReadOptions {
    /// Unit of the numbers in the file [default: mm]
    #[arg(long, value_enum, default_value = "mm", hide_default_value = true)]
    #[serde(default)]
    pub units: MeshUnit,
    /// Scale the model so that its largest extent is this length, whatever its unit, e.g. 300mm;
    /// above 0 [default: not scaled]
    #[arg(long)]
    #[serde(default)]
    pub size: Option<Length>,
    /// Make one vertex of those that are at most this far apart after scaling; 0 or more, 0 joins
    /// equal positions only [default: none are joined]
    #[arg(long)]
    #[serde(default)]
    pub weld: Option<Length>,
}

/// The unit of the numbers in a mesh file, which carries none itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MeshUnit {
    /// Millimetres.
    #[default]
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches of 25.4 mm.
    In,
}

impl MeshUnit {
    /// The unit in millimetres.
    pub fn mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::M => 1000.0,
            Self::In => 25.4,
        }
    }
}

/// A mesh with what happened on the way in.
#[derive(Debug, Clone)]
pub struct ReadMesh {
    /// The mesh, in millimetres. The n-th vertex and face of the file have the ids n − 1, as long
    /// as no faces were dropped and the file is not STL; vertices without faces leave gaps.
    pub mesh: Mesh,
    /// Vertices that were doubled because several fans of faces met there.
    pub splits: Vec<SplitVertex>,
    /// What the user should know.
    pub notes: Vec<ReadNote>,
    /// The factor from the numbers of the file to millimetres.
    pub scale: f64,
}

/// Reads a mesh from a file.
///
/// The format is shown by the extension, or else by the content.
///
/// # Errors
/// When the file cannot be read or is not a mesh; every message names the place and what to do.
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, read_mesh};
/// use std::path::Path;
///
/// let read = read_mesh(Path::new("fixtures/meshes/cube.obj"), &ReadOptions::default())?;
/// assert_eq!((read.mesh.face_count(), read.scale), (6, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_mesh(path: &Path, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    if path.is_dir() {
        return Err(IoError::IsFolder { path: path.to_owned() });
    }
    let bytes = std::fs::read(path).map_err(|source| IoError::reading(path, source))?;
    read_mesh_bytes(path, &bytes, options)
}

/// Reads a mesh from the content of a file; `path` shows the format and is named in messages.
///
/// # Errors
/// As [`read_mesh`].
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, read_mesh_bytes};
/// use std::path::Path;
///
/// let text = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
/// let read = read_mesh_bytes(Path::new("mine.off"), text.as_bytes(), &ReadOptions::default())?;
/// assert!(read.mesh.is_closed());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_mesh_bytes(
    path: &Path,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<ReadMesh, IoError> {
    check_options(options)?;
    let text = decode::as_utf8(bytes);
    if text.trim_ascii().is_empty() {
        return Err(IoError::Empty { path: path.to_owned() });
    }
    let format = MeshFormat::of_path(path)
        .or_else(|| stl::is_binary(bytes).then_some(MeshFormat::Stl))
        .or_else(|| MeshFormat::of_content(&text));
    let raw = match format.ok_or_else(|| IoError::UnknownFormat { path: path.to_owned() })? {
        MeshFormat::Obj => obj::read(&text),
        // Zeros at the end of a binary file are numbers.
        MeshFormat::Ply if bytes.starts_with(b"ply") => ply::read(bytes),
        MeshFormat::Ply => ply::read(&text),
        MeshFormat::Off => off::read(&text),
        MeshFormat::Stl => stl::read(bytes, &text),
    };
    let mut source = SourceFile { path, raw: raw.map_err(|located| located.in_file(path))? };
    let mut notes = std::mem::take(&mut source.raw.notes);
    let scale = source.scale(options)?;
    source.weld(options, &mut notes)?;
    source.raw.make_faces_simple();
    notes.append(&mut source.raw.notes);
    let (mesh, splits) = source.build()?;
    source.note_torn(&mesh, &mut notes)?;
    source.note_vertices(&mesh, &splits, &mut notes);
    Ok(ReadMesh { mesh, splits, notes, scale })
}

fn check_options(options: &ReadOptions) -> Result<(), IoError> {
    match (options.size, options.weld) {
        (Some(size), _) if size.mm() <= 0.0 => Err(IoError::BadSize { mm: size.mm() }),
        (_, Some(weld)) if weld.mm() < 0.0 => Err(IoError::BadWeld { mm: weld.mm() }),
        _ => Ok(()),
    }
}
