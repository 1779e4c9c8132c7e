//! What happened on the way in and the user should know.

use std::fmt;

use crate::mesh::VertexId;
use crate::units::counted;

/// Something about a file that is no fault, but should be known. Vertices and faces are numbered
/// from 0 in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
            Self::CoincidentRims { coincident, rim_edges, vertices: [a, b] } => write!(
                f,
                "{coincident} of {rim_edges} rim edges lie exactly on another one, such as at \
                vertices {a} and {b}; \
                 if the surface is torn there, --weld 0 closes it"
            ),
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
        }
    }
}

fn were(count: usize) -> &'static str {
    if count == 1 { "was" } else { "were" }
}
