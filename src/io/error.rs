//! What can be wrong with a file, with its place and what to do.

use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub use super::fault::ContentFault;
use super::format::MeshFormat;
use crate::code::codes;
use crate::mesh::{BuildError, FileCounts, FileFault};

/// Where in a file something is. Shown as `spot.obj:17`, or as `spot.stl` when the file has no
/// lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file, as it was named.
    pub path: PathBuf,
    /// The line, counted from 1; `None` in binary files, or when the whole file is meant.
    pub line: Option<usize>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Shown(&self.path))?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// A path as messages show it: `-` is the standard stream.
struct Shown<'a>(&'a Path);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.as_os_str() == "-" {
            f.write_str("standard input")
        } else {
            self.0.display().fmt(f)
        }
    }
}

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The file to read does not exist.
    #[error("there is no file {}; check the name and the folder", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// A folder was named where a file is needed.
    #[error("{} is a folder; name a file", path.display())]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The file cannot be opened or read.
    #[error("{} cannot be read ({source}); check that you may read it", Shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Neither the name nor the content shows the format.
    #[error(
        "{}: unknown mesh format; use a name that ends in .obj, .ply, .stl, .off or .3mf (or .glb, or \
        .csv for a grid of heights, which are read, or .dxf, which is written)",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file has no content.
    #[error("{} is empty; export the model again", Shown(path))]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The content does not follow the format.
    #[error("{place}: {fault}")]
    Content {
        /// Where.
        place: Place,
        /// What is wrong.
        fault: ContentFault,
    },
    /// The vertices and faces do not make a mesh.
    #[error("{place}: {fault}{}{}", advice(fault, &place.path), AlsoSee(also_lines))]
    Mesh {
        /// Where.
        place: Place,
        /// What is wrong; vertices and faces are numbered from 0 in the order of the file.
        fault: BuildError,
        /// Lines of other elements that take part.
        also_lines: Vec<usize>,
    },
    /// A seam line of an OBJ file runs where the mesh has no edge.
    #[error("{place}: the seam runs from vertex {} to vertex {} (counted from 1), but no edge \
    does; let it follow the edges of the mesh", a + 1, b + 1)]
    SeamOffEdges {
        /// Where.
        place: Place,
        /// One end, counted from 0 (OBJ counts from 1, and so does the message).
        a: usize,
        /// The other end.
        b: usize,
    },
    /// A seam file names two vertices without an edge.
    #[error(
        "{place}: there is no edge between vertices {a} and {b} (counted from 0); name the two \
        ends of an edge"
    )]
    NoSuchEdge {
        /// Where.
        place: Place,
        /// One end, counted from 0.
        a: usize,
        /// The other end.
        b: usize,
    },
    /// A seam file without a seam.
    #[error(
        "{} names no seam; write `l 1 2 3` lines in an OBJ file, or two vertices (counted from 0) \
        per line",
        Shown(path)
    )]
    NoSeams {
        /// The file.
        path: PathBuf,
    },
    /// The surface would be closed if vertices at one point were one.
    #[error(
        "{}: the surface is torn: each of its {rim_edges} rim edges lies exactly on another one; \
         vertices {a} and {b} lie at one point{}; weld them with --weld 0",
        Shown(path),
        AlsoSee(lines)
    )]
    Torn {
        /// The file.
        path: PathBuf,
        /// Number of rim edges.
        rim_edges: usize,
        /// A vertex, counted from 0.
        a: usize,
        /// Another vertex at the same point.
        b: usize,
        /// The lines of both; empty in binary files.
        lines: Vec<usize>,
    },
    /// Welding left no face.
    #[error("{}: welding leaves no face; weld by less than the shortest edge", Shown(path))]
    WeldedAway {
        /// The file.
        path: PathBuf,
    },
    /// The welding distance is below zero.
    #[error("cannot weld vertices {mm}mm apart; --weld takes a distance of 0mm or more")]
    BadWeld {
        /// What was asked.
        mm: f64,
    },
    /// The distance within which faces count as flat is below zero.
    #[error("cannot merge faces {mm}mm off flat; --merge-flat takes a distance of 0mm or more")]
    BadFlat {
        /// What was asked.
        mm: f64,
    },
    /// Holes to close have no width.
    #[error("cannot close holes of {mm}mm; --close-holes takes a length above 0mm")]
    BadHole {
        /// What was asked.
        mm: f64,
    },
    /// The wanted size is not above zero.
    #[error("cannot make the model {mm}mm large; --size takes a length above 0mm")]
    BadSize {
        /// What was asked.
        mm: f64,
    },
    /// The folder to write into does not exist.
    #[error(
        "cannot write {}: there is no folder {}; make it first",
        path.display(),
        folder.display()
    )]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// Something else than a folder stands where a folder is needed.
    #[error(
        "cannot write into {}: {} is a file, not a folder; choose another place",
        path.display(),
        file.display()
    )]
    NotAFolder {
        /// What was to be written, or made.
        path: PathBuf,
        /// The file in the way.
        file: PathBuf,
    },
    /// The existing file is marked as read-only.
    #[error("{} is write-protected; lift the protection or choose another name", path.display())]
    WriteProtected {
        /// The file.
        path: PathBuf,
    },
    /// The system refuses to write.
    #[error(
        "cannot write {} ({source}); check that you may write there and that the disk has room",
        path.display()
    )]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A coordinate does not fit the single precision of STL.
    #[error(
        "vertex {vertex} is too far out for STL, which holds numbers up to 3e38; write OBJ or PLY"
    )]
    TooFarForStl {
        /// The vertex, counted from 0 among the vertices that are written.
        vertex: usize,
    },
    /// A mesh that no file of polygons can hold.
    #[error(
        "this mesh would not be read again: {fault}; take another step, or other numbers, that \
        leave a mesh of simple polygons"
    )]
    NotForFiles {
        /// What is wrong with it, in numbers of the mesh in memory.
        fault: FileFault,
    },
    /// What was to be written reads otherwise than the mesh: a fault of ours.
    #[error(
        "the file read back does not say what the mesh is, so nothing was written; please report \
        this bug, and write another format than {format}"
    )]
    NotReadBack {
        /// Of which format.
        format: MeshFormat,
    },
    /// A mesh that readers would take for another.
    #[error(
        "this mesh would be read as another: {}; take another step, or other numbers, that leave \
        a mesh of simple polygons with one rim at most at each vertex",
        other(wanted, found.as_ref())
    )]
    ReadAsOther {
        /// What is in memory.
        wanted: FileCounts,
        /// What a reader finds; `None` when it refuses the file.
        found: Option<FileCounts>,
    },
    /// A mesh that STL cannot hold: it knows vertices by their places, in single precision.
    #[error(
        "STL, which knows vertices by their places alone, cannot hold this mesh: {why}; write OBJ, \
        PLY or OFF"
    )]
    NotForStl {
        /// What happens to it.
        why: String,
    },
    /// A mesh of which the triangles are no surface.
    #[error(
        "{format}, which knows triangles alone, cannot hold this mesh: {why}; write OBJ, PLY or OFF"
    )]
    NotForTriangles {
        /// The format.
        format: MeshFormat,
        /// What happens to it.
        why: String,
    },
    /// A zip that could not be made.
    #[error("the 3MF file cannot be packed: {fault}; write OBJ or PLY")]
    Packing {
        /// What the packer says.
        fault: String,
    },
    /// A coordinate does not fit the single precision of glTF.
    #[error("{name} is too far out for GLB, which holds numbers up to 3e38; write OBJ or PLY")]
    TooFarForGlb {
        /// The name of the node that holds it.
        name: String,
    },
    /// A mesh was to be written in a format that is only read.
    #[error("meshes are read as {format}, not written; write OBJ, PLY, STL, OFF, 3MF or DXF")]
    OnlyRead {
        /// The format.
        format: MeshFormat,
    },
    /// A file of a format in which meshes are only written.
    #[error(
        "{}: meshes are written as {format}, not read; export the model as OBJ, PLY, STL, OFF, GLB \
        or 3MF",
        Shown(path)
    )]
    OnlyWritten {
        /// The file.
        path: PathBuf,
        /// The format.
        format: MeshFormat,
    },
    /// A table that no workbook can hold.
    #[error("schedule.xlsx cannot be written: {fault}; the CSV files hold the same tables")]
    Workbook {
        /// What the format does not take.
        fault: String,
    },
}

codes!(error IoError {
    Missing = 101,
    IsFolder = 102,
    Unreadable = 103,
    UnknownFormat = 104,
    Empty = 105,
    SeamOffEdges = 106,
    NoSuchEdge = 107,
    NoSeams = 108,
    Torn = 109,
    WeldedAway = 110,
    BadWeld = 111,
    BadSize = 112,
    NoFolder = 113,
    NotAFolder = 114,
    WriteProtected = 115,
    Unwritable = 116,
    TooFarForStl = 117,
    TooFarForGlb = 118,
    NotForFiles = 119,
    NotReadBack = 120,
    ReadAsOther = 121,
    NotForStl = 122,
    OnlyRead = 123,
    NotForTriangles = 124,
    BadFlat = 125,
    BadHole = 126,
    Packing = 127,
    Workbook = 128,
    OnlyWritten = 150,
} through {
    Content.fault,
    Mesh.fault,
});

impl IoError {
    /// Whether the reader at the other end of a pipe has gone, which is no failure of ours.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Self::Unwritable { source, .. } if source.kind() == ErrorKind::BrokenPipe)
    }

    /// The error of reading `path`.
    pub(crate) fn reading(path: &Path, source: std::io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            ErrorKind::NotFound => Self::Missing { path },
            ErrorKind::IsADirectory => Self::IsFolder { path },
            _ => Self::Unreadable { path, source },
        }
    }
}

/// How a file is mended, while it is read or for good.
fn repair_advice(way: &str, path: &Path) -> String {
    format!("; or read with {way}, or `kerfold repair {} -o repaired.obj`", path.display())
}

/// What is read instead.
fn other(wanted: &FileCounts, found: Option<&FileCounts>) -> String {
    match found {
        Some(found) => format!("{found} instead of {wanted}"),
        None => "more than two faces meet at an edge, or a face comes twice to a vertex".to_owned(),
    }
}

/// What to do, where the fault itself does not say it.
fn advice(fault: &BuildError, path: &Path) -> String {
    let text = match fault {
        BuildError::NoFaces => "; export the model as a polygon mesh",
        BuildError::NotFinite { .. } => "; correct it or export the model again",
        BuildError::MissingVertex { .. } => "; correct the number or export the model again",
        BuildError::TooFewCorners { .. } => "; remove it",
        BuildError::TooMany { .. } => "; simplify the model first",
        BuildError::FlippedFace { .. } => {
            let way = "--orient (--mend where there is one side only)";
            return repair_advice(way, path);
        }
        BuildError::ThreeFacesAtEdge { .. }
        | BuildError::DegenerateFace { .. }
        | BuildError::ZeroLengthEdge { .. } => return repair_advice("--mend", path),
        _ => "",
    };
    text.to_owned()
}

/// ` (see also line 3)`, ` (see also lines 3 and 7)`, or nothing.
struct AlsoSee<'a>(&'a [usize]);

impl fmt::Display for AlsoSee<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            [] => Ok(()),
            [line] => write!(f, " (see also line {line})"),
            [first @ .., last] => {
                f.write_str(" (see also lines ")?;
                for (i, line) in first.iter().enumerate() {
                    write!(f, "{}{line}", if i > 0 { ", " } else { "" })?;
                }
                write!(f, " and {last})")
            }
        }
    }
}

/// A fault with its line; the path is added by the caller.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Located {
    pub line: Option<usize>,
    pub fault: ContentFault,
}

impl Located {
    pub fn at(line: usize, fault: ContentFault) -> Self {
        Self { line: Some(line), fault }
    }

    pub fn anywhere(fault: ContentFault) -> Self {
        Self { line: None, fault }
    }

    pub fn in_file(self, path: &Path) -> IoError {
        IoError::Content {
            place: Place { path: path.to_owned(), line: self.line },
            fault: self.fault,
        }
    }
}

/// The start of a text from a file, fit for a message: one line, no control characters, not long.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LONGEST)]);
    let clean: String =
        text.trim().chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if clean.chars().count() > LONGEST {
        clean.chars().take(LONGEST).chain(['…']).collect()
    } else {
        clean
    }
}
