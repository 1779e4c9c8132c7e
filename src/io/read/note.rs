//! What should be known about a file and is no fault, in words.

use std::fmt;

use super::{MeshUnit, ReadOptions};
use crate::check::{CheckKind, short};
use crate::code::Coded;
use crate::measure::size;
use crate::mend::Mending;
use crate::mesh::{Mesh, VertexId};
use crate::units::counted;

/// Something about a file that is no fault, but should be known. Vertices and faces are numbered
/// from 0 in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ReadNote {
    /// Vertices went into others.
    Welded {
        /// How many.
        count: usize,
    },
    /// Faces lost their area when their corners became one, and were left out.
    DroppedFaces {
        /// How many.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Vertices at which several fans of faces meet were doubled.
    SplitVertices {
        /// How many were added.
        count: usize,
        /// The first that was doubled.
        first: VertexId,
    },
    /// Vertices that no face uses.
    UnusedVertices {
        /// How many.
        count: usize,
        /// The first.
        first: VertexId,
    },
    /// Some rim edges lie exactly on others: the surface may be torn there.
    CoincidentRims {
        /// How many rim edges lie on another.
        coincident: usize,
        /// Number of all rim edges.
        rim_edges: usize,
        /// Two vertices at one point where this is so.
        vertices: [VertexId; 2],
    },
    /// Faces named a vertex twice in a row; the second was left out.
    RepeatedCorners {
        /// How many faces.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Faces that visited a vertex twice (around a hole, for example) were divided.
    DividedFaces {
        /// How many.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Coordinates were divided by the weight after them.
    Weights {
        /// Of how many vertices.
        count: usize,
        /// The first.
        first: usize,
    },
    /// Numbers had a comma where a point is usual.
    DecimalCommas {
        /// How many.
        count: usize,
        /// The line of the first, from 1.
        first_line: usize,
    },
    /// Lines of a known format that make no face: curves, points, wires, or anything unknown.
    PassedOver {
        /// How many.
        count: usize,
        /// The first, from 1.
        first_line: usize,
    },
    /// Lines had more numbers than the header says.
    ExtraColumns {
        /// How many lines.
        count: usize,
        /// The first, from 1.
        first_line: usize,
    },
    /// The file is a grid of heights.
    Heights {
        /// How many values of x.
        columns: usize,
        /// How many values of y.
        rows: usize,
        /// Whether it has rows x, y, z; else a table whose first row is x and first column y.
        is_list: bool,
    },
    /// Faces were mended, since that was asked for.
    Mended(Mending),
    /// Seams were marked where mending left no edge.
    LostSeams {
        /// How many.
        count: usize,
    },
    /// There was nothing to mend.
    NothingToMend,
    /// Faces that lie flat beside each other became one.
    Merged {
        /// How many faces there were.
        before: usize,
        /// How many there are.
        after: usize,
    },
    /// The faces of a closed model look inwards.
    InsideOut {
        /// Its volume, in mm³; below 0.
        volume: f64,
    },
    /// The file names another unit than the one that it was read with.
    OtherUnit {
        /// What its comments say.
        stated: MeshUnit,
        /// What it was read with.
        taken: MeshUnit,
    },
    /// The file has a place for its unit, which was used; another one was asked for.
    OwnUnit {
        /// The unit of the file.
        unit: &'static str,
    },
    /// The file holds things besides meshes.
    LeftOut {
        /// How many.
        count: usize,
        /// What, in words that follow the number.
        what: &'static str,
    },
    /// The model is so small or so large that the unit may be wrong.
    OddSize {
        /// The largest extent, in mm.
        largest: f64,
    },
    /// The file goes on after its last element.
    Rest {
        /// How many bytes follow, white space at the ends not counted.
        bytes: usize,
    },
}

impl fmt::Display for ReadNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Welded { count } => {
                write!(f, "{} welded to others", counted(*count, "vertex was", "vertices were"))
            }
            Self::DroppedFaces { count, first } => write!(
                f,
                "{} left out, the first of them face {first} of the file; the faces after it are \
                numbered without them",
                counted(
                    *count,
                    "face lost its area because corners of it are at one point and was",
                    "faces lost their area because corners of theirs are at one point and were"
                )
            ),
            Self::SplitVertices { count, first } => write!(
                f,
                "{} added where several fans of faces met in one vertex, the first of them at \
                vertex {first}",
                counted(*count, "vertex was", "vertices were")
            ),
            Self::UnusedVertices { count, first } => {
                let count = counted(*count, "vertex belongs", "vertices belong");
                write!(f, "{count} to no face, the first of them vertex {first}")
            }
            Self::RepeatedCorners { count, first } => write!(
                f,
                "{} a vertex twice in a row and {} read without the second, the first of them \
                face {first}",
                counted(*count, "face names", "faces name"),
                were(*count)
            ),
            Self::DividedFaces { count, first } => write!(
                f,
                "{} a vertex twice (around a hole, for example) and {} divided, the first of \
                them face {first}; the further parts stand behind the faces of the file",
                counted(*count, "face visits", "faces visit"),
                were(*count)
            ),
            Self::Weights { count, first } => write!(
                f,
                "{} a weight other than 1 after the coordinates, which {} divided by it, the \
                first of them vertex {first}",
                counted(*count, "vertex has", "vertices have"),
                were(2)
            ),
            Self::DecimalCommas { count, first_line } => write!(
                f,
                "{} a decimal comma, the first of them in line {first_line}",
                counted(*count, "number has", "numbers have")
            ),
            Self::PassedOver { count, first_line } => write!(
                f,
                "{} no face and {} passed over, the first of them line {first_line}",
                counted(*count, "line makes", "lines make"),
                were(*count)
            ),
            Self::ExtraColumns { count, first_line } => write!(
                f,
                "{} more numbers than the header says, which were passed over, the first of them \
                line {first_line}",
                counted(*count, "line has", "lines have")
            ),
            Self::Rest { bytes } => write!(
                f,
                "{} after the last element and {} passed over",
                counted(*bytes, "byte follows", "bytes follow"),
                were(*bytes)
            ),
            _ => self.fmt_of_model(f),
        }
    }
}

impl ReadNote {
    /// Notes on the model and on what was done to it; those on the file are written above.
    fn fmt_of_model(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CoincidentRims { coincident, rim_edges, vertices: [a, b] } => write!(
                f,
                "{coincident} of {rim_edges} rim edges lie exactly on another one, such as at \
                vertices {a} and {b}; \
                 if the surface is torn there, --weld 0 closes it"
            ),
            Self::Heights { columns, rows, is_list } => write!(
                f,
                "heights over a grid, {columns} values of x by {rows} of y, read from {}",
                if *is_list {
                    "rows x, y, z"
                } else {
                    "a table whose first row is x and first column y"
                }
            ),
            Self::Mended(mending) => fmt::Display::fmt(mending, f),
            Self::LostSeams { count } => write!(
                f,
                "{} on no edge of the mended surface and {} left out",
                counted(*count, "seam was marked", "seams were marked"),
                were(*count)
            ),
            Self::NothingToMend => f.write_str("there was nothing to mend"),
            Self::Merged { before, after } => write!(
                f,
                "{} became {after}, flat neighbours merged; numbers are those of the merged mesh",
                counted(*before, "face", "faces")
            ),
            Self::OtherUnit { stated, taken } => write!(
                f,
                "the file says that its unit is {}, and it was read with {}; --units {0} takes it \
                at its word ({})",
                stated.name(),
                taken.name(),
                CheckKind::OtherUnit.code()
            ),
            Self::OwnUnit { unit } => write!(
                f,
                "the unit of the file ({unit}) was used: its format has a place for it, so --units \
                changes nothing; --size says how large the model is to be"
            ),
            Self::LeftOut { count, what } => {
                write!(f, "what is no mesh was left out: {what} ({count})")
            }
            Self::OddSize { largest } => write!(
                f,
                "the model is {} mm in its largest extent: is the unit right? --units m, cm or in \
                says what the numbers of the file are, --size 300mm how large it is to be",
                short(*largest)
            ),
            Self::InsideOut { volume } => write!(
                f,
                "the faces of this closed model look inwards (its volume is {volume:.4e} mm³); \
                --flip turns them around, and `kerfold repair` does for good"
            ),
            _ => Ok(()),
        }
    }
}

fn were(count: usize) -> &'static str {
    if count == 1 { "was" } else { "were" }
}

/// A question for whoever reads a model smaller than 10 mm or larger than 50 m without saying its
/// size: the unit may be wrong. [`read_mesh`](super::read_mesh) does not ask, since a program knows its units.
pub fn size_note(mesh: &Mesh, options: &ReadOptions) -> Option<ReadNote> {
    let largest = size(mesh).max_element();
    let is_odd = largest > 0.0 && !ORDINARY_MM.contains(&largest);
    (is_odd && options.size.is_none()).then_some(ReadNote::OddSize { largest })
}

/// Sizes of models that nobody wonders about, in mm.
const ORDINARY_MM: std::ops::RangeInclusive<f64> = 10.0..=50_000.0;
