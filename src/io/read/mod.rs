//! Reading mesh files: one reader for each format, then scaling, welding and building, which are
//! the same for all.

use std::path::Path;

use super::error::IoError;
use super::format::MeshFormat;
use crate::measure::volume;
use crate::mend::{RepairParams, merge_flat};
use crate::mesh::{Mesh, SplitVertex};
use crate::select::NewElements;
use crate::units::Length;
use source::SourceFile;

pub mod artwork;
mod content;
mod decode;
mod glb;
mod heights;
mod keyhole;
mod made;
mod mended;
mod note;
mod obj;
mod off;
mod plain;
mod ply;
mod points;
mod quick;
mod raw;
mod rim;
mod seams;
mod source;
mod stl;
mod text;
mod threemf;
mod unit;
mod weld;

#[cfg(test)]
mod tests;

pub use decode::{decode_text, read_text};
pub use note::{ReadNote, size_note};
pub(super) use plain::polygons_in;
pub use points::{read_curves, read_curves_bytes, read_points, read_points_bytes};
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
    /// Turn all faces around, so that those that look inwards look outwards
    #[arg(long)]
    #[serde(default)]
    pub flip: bool,
    /// Turn faces until neighbours look the same way and closed parts look outwards
    #[arg(long)]
    #[serde(default)]
    pub orient: bool,
    /// Mend what is no surface as `kerfold repair` does, which closes no holes unless asked to
    #[arg(long)]
    #[serde(default)]
    pub mend: bool,
    /// Make one face of those that lie flat beside each other, as `kerfold merge` does; how far
    /// from flat is flat, 0 or more [default: none are merged; 0.01mm when nothing is said]
    #[arg(
        long,
        value_name = "TOLERANCE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "0.01mm"
    )]
    #[serde(default)]
    pub merge_flat: Option<Length>,
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
    /// The name as it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::In => "in",
        }
    }

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
    /// What the step before made that wrote the file, for the selections `made` and `strip`; only
    /// OBJ says it, and merging and welding end it.
    pub made: Option<NewElements>,
}

/// Reads a mesh from a file.
///
/// The format is shown by the extension, or else by the content. GLB and 3MF
/// have a unit of their own, which is used whatever the options say. A name that ends in `.csv` is a
/// grid of heights: a table whose first row is x and first column y, or rows x,y,z.
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
    read_and_mend(path, bytes, options, None)
}

/// Reads a mesh from the content of a file whose faces need not be a surface, and mends it: what was
/// done are notes.
///
/// # Errors
/// As [`read_mesh`]; [`IoError::BadHole`] for holes to close of no width.
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, repair_mesh_bytes};
/// use kerfold::mend::RepairParams;
/// use std::path::Path;
///
/// // The last face runs the wrong way around.
/// let text = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 2 3\n";
/// let (name, options) = (Path::new("mine.off"), ReadOptions::default());
/// let read = repair_mesh_bytes(name, text.as_bytes(), &options, &RepairParams::default())?;
/// assert!(read.mesh.is_closed());
/// assert!(read.notes[0].to_string().starts_with("1 face looked the other way"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repair_mesh_bytes(
    path: &Path,
    bytes: &[u8],
    options: &ReadOptions,
    params: &RepairParams,
) -> Result<ReadMesh, IoError> {
    match params.close_holes {
        Some(width) if width.mm() <= 0.0 => Err(IoError::BadHole { mm: width.mm() }),
        _ => read_and_mend(path, bytes, options, Some(params)),
    }
}

fn read_and_mend(
    path: &Path,
    bytes: &[u8],
    options: &ReadOptions,
    repair: Option<&RepairParams>,
) -> Result<ReadMesh, IoError> {
    check_options(options)?;
    let text = decode::as_utf8(bytes);
    if text.trim_ascii().is_empty() {
        return Err(IoError::Empty { path: path.to_owned() });
    }
    let format = MeshFormat::of_path(path)
        .or_else(|| stl::is_binary(bytes).then_some(MeshFormat::Stl))
        .or_else(|| MeshFormat::of_content(&text).filter(|_| !has_heights(path)));
    let raw = match format {
        None if has_heights(path) => heights::read(&text),
        None => return Err(IoError::UnknownFormat { path: path.to_owned() }),
        Some(MeshFormat::Obj) => obj::read(&text),
        // Zeros at the end of a binary file are numbers.
        Some(MeshFormat::Ply) if bytes.starts_with(b"ply") => ply::read(bytes),
        Some(MeshFormat::Ply) => ply::read(&text),
        Some(MeshFormat::Off) => off::read(&text),
        Some(MeshFormat::Stl) => stl::read(bytes, &text),
        Some(MeshFormat::Glb) => glb::read(bytes),
        Some(MeshFormat::ThreeMf) => threemf::read(bytes),
        Some(MeshFormat::Dxf) => {
            let (path, format) = (path.to_owned(), MeshFormat::Dxf);
            return Err(IoError::OnlyWritten { path, format });
        }
    };
    let mut source = SourceFile { path, raw: raw.map_err(|located| located.in_file(path))? };
    let mut notes = std::mem::take(&mut source.raw.notes);
    notes.extend(unit::note(format, bytes, &text, &source.raw, options));
    let scale = source.scale(options)?;
    source.weld(options, &mut notes)?;
    source.raw.make_faces_simple();
    notes.append(&mut source.raw.notes);
    mended::mend(&mut source.raw, options, repair);
    let is_asked = repair.is_some() || options.mend || options.orient;
    if is_asked && source.raw.notes.is_empty() {
        notes.push(ReadNote::NothingToMend);
    }
    notes.append(&mut source.raw.notes);
    let (mesh, splits) = source.build()?;
    source.note_torn(&mesh, &mut notes)?;
    source.note_vertices(&mesh, &splits, &mut notes);
    note_inside_out(&mesh, &mut notes);
    let is_changed = options.weld.is_some() || options.mend || repair.is_some();
    let made = if is_changed { None } else { made::of_raw(&source.raw, &mesh, &splits) };
    merged(ReadMesh { mesh, splits, notes, scale, made }, options)
}

/// Whether a name says that a file holds heights over a grid.
fn has_heights(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"))
}

/// A closed model of which the faces look inwards.
fn note_inside_out(mesh: &Mesh, notes: &mut Vec<ReadNote>) {
    if mesh.is_closed() {
        let volume = volume(mesh);
        if volume < 0.0 {
            notes.push(ReadNote::InsideOut { volume });
        }
    }
}

fn merged(read: ReadMesh, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    let Some(tolerance) = options.merge_flat else { return Ok(read) };
    // What was built from a file has nothing that a file could not hold; where merging would make
    // such a thing, the mesh stays.
    let ReadMesh { mesh, splits, mut notes, scale, made } = read;
    match merge_flat(&mesh, tolerance.mm()) {
        Ok((merged, _)) if merged.file_faults().is_empty() => {
            let (before, after) = (mesh.face_count(), merged.face_count());
            notes.push(ReadNote::Merged { before, after });
            Ok(ReadMesh { mesh: merged, splits: Vec::new(), notes, scale, made: None })
        }
        _ => {
            let after = mesh.face_count();
            notes.push(ReadNote::Merged { before: after, after });
            Ok(ReadMesh { mesh, splits, notes, scale, made })
        }
    }
}

fn check_options(options: &ReadOptions) -> Result<(), IoError> {
    match (options.size, options.weld) {
        (Some(size), _) if size.mm() <= 0.0 => Err(IoError::BadSize { mm: size.mm() }),
        (_, Some(weld)) if weld.mm() < 0.0 => Err(IoError::BadWeld { mm: weld.mm() }),
        _ => match options.merge_flat {
            Some(flat) if flat.mm() < 0.0 => Err(IoError::BadFlat { mm: flat.mm() }),
            _ => Ok(()),
        },
    }
}
