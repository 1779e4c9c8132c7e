//! Half-spaces from a CSV file: `nx,ny,nz,d` on each line for nx·x + ny·y + nz·z ≤ d.
//!
//! Blank lines and what follows a `#` are skipped; a first line of names is a header. Numbers may
//! be fractions (`1/3`).

use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::code::codes;
use crate::geom::hull::{HalfSpace, HalfSpaceError};
use crate::units::parse_number;

/// Half-spaces with the lines that they came from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaneFile {
    /// The half-spaces in the order of the file.
    pub half_spaces: Vec<HalfSpace>,
    /// For each its line, counted from 1.
    pub lines: Vec<usize>,
}

impl PlaneFile {
    /// Why the half-spaces of this file bound no solid, with the lines of those concerned.
    pub fn no_solid(&self, file: &Path, reason: HalfSpaceError) -> PlanesError {
        let lines =
            reason.half_spaces().iter().filter_map(|&i| self.lines.get(i).copied()).collect();
        PlanesError::NoSolid { file: file.to_owned(), reason, lines }
    }
}

/// Why a file holds no half-spaces.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanesError {
    /// The file cannot be read.
    #[error("{}: {source}", file.display())]
    Read {
        /// Which file.
        file: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file holds no half-space.
    #[error("{}: there are no half-spaces; write one on each line as nx,ny,nz,d for nx·x + ny·y + \
    nz·z <= d", file.display())]
    Empty {
        /// Which file.
        file: PathBuf,
    },
    /// A line does not have four fields.
    #[error(
        "{}:{line}:{column}: {found} numbers where a half-space has 4: nx,ny,nz,d",
        file.display()
    )]
    Fields {
        /// Which file.
        file: PathBuf,
        /// Which line, counted from 1.
        line: usize,
        /// Where in the line the last field, or the first that is too many, begins, counted from 1.
        column: usize,
        /// How many fields there are.
        found: usize,
    },
    /// A field is no number.
    #[error(
        "{}:{line}:{column}: `{text}` is not a number; write it like 0.25, -2e-3 or 1/3",
        file.display()
    )]
    NotANumber {
        /// Which file.
        file: PathBuf,
        /// Which line, counted from 1.
        line: usize,
        /// Where in the line, counted from 1.
        column: usize,
        /// The field.
        text: String,
    },
    /// The half-spaces bound no solid.
    #[error("{}: {reason}{}", file.display(), on_lines(lines))]
    NoSolid {
        /// Which file.
        file: PathBuf,
        /// Why not.
        reason: HalfSpaceError,
        /// The lines of the half-spaces concerned, counted from 1.
        lines: Vec<usize>,
    },
    /// The normal is zero.
    #[error("{}:{line}: the normal is (0, 0, 0); give it a direction", file.display())]
    NoDirection {
        /// Which file.
        file: PathBuf,
        /// Which line, counted from 1.
        line: usize,
    },
}

codes!(error PlanesError {
    Read = 171,
    Empty = 172,
    Fields = 173,
    NotANumber = 174,
    NoDirection = 175,
} through {
    NoSolid.reason,
});

fn on_lines(lines: &[usize]) -> String {
    let lines: Vec<String> = lines.iter().map(usize::to_string).collect();
    if lines.is_empty() { String::new() } else { format!(" (on the lines {})", lines.join(", ")) }
}

/// Reads a file of half-spaces.
///
/// # Errors
/// [`PlanesError`] with file and line.
pub fn read_planes(file: &Path) -> Result<PlaneFile, PlanesError> {
    let text = super::read_text(file)
        .map_err(|source| PlanesError::Read { file: file.to_owned(), source })?;
    parse_planes(&text, file)
}

/// Reads half-spaces from text; `file` is its name for messages.
///
/// # Errors
/// [`PlanesError`] with file and line.
///
/// # Example
/// ```
/// use kerfold::io::planes_csv::parse_planes;
/// use std::path::Path;
///
/// let planes = parse_planes("nx,ny,nz,d\n1,0,0,5\n0,1,0,5\n", Path::new("planes.csv"))?;
/// assert_eq!(planes.half_spaces.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn parse_planes(text: &str, file: &Path) -> Result<PlaneFile, PlanesError> {
    let mut planes = PlaneFile::default();
    let mut is_first = true;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split('#').next().unwrap_or_default();
        if content.trim().is_empty() {
            continue;
        }
        let fields = fields(content);
        if std::mem::take(&mut is_first) && fields.iter().all(|field| is_name(field.1)) {
            continue;
        }
        planes.half_spaces.push(half_space(&fields, line, file)?);
        planes.lines.push(line);
    }
    if planes.lines.is_empty() {
        Err(PlanesError::Empty { file: file.to_owned() })
    } else {
        Ok(planes)
    }
}

/// The fields of a line, each with the column where it begins, counted from 1.
fn fields(content: &str) -> Vec<(usize, &str)> {
    let mut column = 1;
    let field = |text: &'_ str| {
        let before = text.chars().take_while(|c| c.is_whitespace()).count();
        let at = column + if text.trim().is_empty() { 0 } else { before };
        column += text.chars().count() + 1;
        at
    };
    let columns: Vec<usize> = content.split(',').map(field).collect();
    columns.into_iter().zip(content.split(',').map(str::trim)).collect()
}

fn half_space(
    fields: &[(usize, &str)],
    line: usize,
    file: &Path,
) -> Result<HalfSpace, PlanesError> {
    let file = || file.to_owned();
    if fields.len() != 4 {
        let column = fields[fields.len().min(5) - 1].0;
        return Err(PlanesError::Fields { file: file(), line, column, found: fields.len() });
    }
    let number = |&(column, text): &(usize, &str)| {
        parse_number(text).map_err(|_| PlanesError::NotANumber {
            file: file(),
            line,
            column,
            text: text.to_owned(),
        })
    };
    let numbers: Vec<f64> = fields.iter().map(number).collect::<Result<_, _>>()?;
    let normal = DVec3::new(numbers[0], numbers[1], numbers[2]);
    if normal == DVec3::ZERO {
        return Err(PlanesError::NoDirection { file: file(), line });
    }
    Ok(HalfSpace { normal, offset: numbers[3] })
}

/// Whether a field is the name of a column: it begins with a letter and is no word for a number
/// that is none.
fn is_name(field: &str) -> bool {
    let is_odd_number = ["nan", "inf", "infinity"].contains(&field.to_lowercase().as_str());
    field.trim_matches('"').starts_with(char::is_alphabetic) && !is_odd_number
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<PlaneFile, PlanesError> {
        parse_planes(text, Path::new("walls.csv"))
    }

    #[test]
    fn comments_header_and_fractions_are_read() {
        let text = "# walls\nnx,ny,nz,d\n1,0,0,2 # east\r\n\n 0, -1/2, 0, 1e-3\n";
        let planes = parse(text).expect("two half-spaces");
        assert_eq!(planes.lines, [3, 5]);
        assert_eq!(planes.half_spaces[0], HalfSpace { normal: DVec3::X, offset: 2.0 });
        assert_eq!(
            planes.half_spaces[1],
            HalfSpace { normal: DVec3::new(0.0, -0.5, 0.0), offset: 1e-3 }
        );
    }

    #[test]
    fn faults_are_named_with_file_and_line() {
        for (text, message) in [
            ("", "walls.csv: there are no half-spaces"),
            ("nx,ny,nz,d\n", "walls.csv: there are no half-spaces"),
            ("1,0, 0\n", "walls.csv:1:6: 3 numbers where a half-space has 4"),
            ("1,0,0,1,  7, 8\n", "walls.csv:1:11: 6 numbers where a half-space has 4"),
            ("1,0,0,1\n# c\n0, 1, x,1\n", "walls.csv:3:7: `x` is not a number"),
            ("1,0,0,1\n\nnx,ny,nz,d\n", "walls.csv:3:1: `nx` is not a number"),
            ("nan,0,0,1\n", "walls.csv:1:1: `nan` is not a number"),
            ("1,0,,1\n", "walls.csv:1:5: `` is not a number"),
            ("1,0,0,1e999\n", "walls.csv:1:7: `1e999` is not a number"),
            ("0,0,-0,1\n", "walls.csv:1: the normal is (0, 0, 0)"),
        ] {
            let error = parse(text).expect_err("a fault").to_string();
            assert!(error.starts_with(message), "{text:?}: {error}");
        }
        let planes = parse("# gap\n0,0,1,1\n0,0,-1,-2\n").expect("two");
        let reason = HalfSpaceError::NoVolume { half_spaces: vec![0, 1] };
        let message = planes.no_solid(Path::new("walls.csv"), reason).to_string();
        assert!(
            message.starts_with("walls.csv: ") && message.ends_with("(on the lines 2, 3)"),
            "{message}"
        );
        let error = read_planes(Path::new("no/such/file.csv")).expect_err("no file");
        assert!(error.to_string().starts_with("no/such/file.csv: "), "{error}");
    }
}
