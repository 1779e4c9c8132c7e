//! Why a D-form cannot be made from outlines as asked.

use std::path::PathBuf;

use crate::code::codes;
use crate::io::artwork::ArtError;

/// What is wrong with outlines, options, or the file that says how they are joined.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutlinesError {
    /// A place on a rim that could not be read.
    #[error(
        "`{text}` is no place on a rim; write a part of the rim from -1 to 1 like 0.25 or 1/3, or \
        a length with its unit like 40mm"
    )]
    Place {
        /// What was typed.
        text: String,
    },
    /// Options that do not go together.
    #[error("{what}; {advice}")]
    Options {
        /// What does not go together.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// A file that cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A drawing that cannot be followed.
    #[error("{}: {error}", path.display())]
    Drawing {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: ArtError,
    },
    /// A drawing with no closed line, or with several.
    #[error(
        "{}: an outline is one closed line, and this drawing has {closed} closed and {open} open \
        lines; leave exactly one closed line in it", path.display()
    )]
    NotOne {
        /// The file.
        path: PathBuf,
        /// Closed lines.
        closed: usize,
        /// Others.
        open: usize,
    },
    /// Perimeters that differ where they must not.
    #[error(
        "{} has a perimeter of {:.6} mm and {} one of {:.6} mm; let the second be scaled \
        (`--fit scale`), or draw them equal", names[0], mm[0], names[1], mm[1]
    )]
    Perimeters {
        /// The outlines.
        names: [String; 2],
        /// Their perimeters.
        mm: [f64; 2],
    },
    /// A line of a list of points that holds no point.
    #[error("{}: line {line} is no point; write x,y in mm, one point on each line", path.display())]
    Points {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// A file of seams that could not be read.
    #[error("{}: {fault}", path.display())]
    Glue {
        /// The file.
        path: PathBuf,
        /// What is wrong, where, and how to write it.
        fault: String,
    },
}

codes!(error OutlinesError {
    Place = 885,
    Options = 886,
    Unreadable = 887,
    NotOne = 888,
    Perimeters = 889,
    Glue = 890,
    Points = 891,
} through {
    Drawing.error,
});
