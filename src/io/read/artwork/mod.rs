//! Drawings of others: SVG, DXF and PDF as lines in millimetres for [`crate::lint`].
//!
//! Curves are flattened to within [`FLATNESS`]; transforms, blocks and nested pages are carried
//! out; what is not lines is counted. One page of a file is one [`Artwork`]. All readers spend from
//! one budget, so that no file takes long or much memory, however small it is.

mod budget;
mod collect;
mod curve;
mod decode;
mod dxf;
mod dxf_binary;
mod dxf_entity;
mod dxf_value;
mod pdf;
mod pdf_file;
mod pdf_object;
mod pdf_page;
mod pdf_unpack;
mod svg;
mod svg_page;
mod svg_path;
mod svg_style;

use std::path::Path;

use crate::code::codes;
use crate::lint::Artwork;

use budget::Budget;
use collect::{Collector, Place};

/// How far a flattened curve may be from the true one, in mm.
///
/// Less than half the gap within which `lint` takes lines for one, so that two flattenings of the
/// same curve are one line to it.
pub const FLATNESS: f64 = 0.002;

/// Files larger than that, in bytes, are not read.
pub const LARGEST_FILE: u64 = 64 << 20;

/// Coordinates beyond that, in mm, are a mistake.
const FARTHEST: f64 = 1e7;

/// How deep blocks, groups and forms may be nested before the file is taken to be malicious.
const DEEPEST: usize = 32;

/// A format of drawings that can be judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArtFormat {
    /// Scalable Vector Graphics.
    Svg,
    /// AutoCAD drawing exchange, as text.
    Dxf,
    /// Portable Document Format.
    Pdf,
}

/// Why a drawing could not be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArtError {
    /// Neither the name nor the content shows the format.
    #[error("this is neither SVG, DXF nor PDF; export the drawing in one of these")]
    UnknownFormat,
    /// No content.
    #[error("the file is empty; export the drawing again")]
    Empty,
    /// SVG that is no well-formed XML, or no SVG.
    #[error("no sound SVG: {0}")]
    Svg(String),
    /// DXF that breaks off or is not text.
    #[error("line {line}: {fault}")]
    Dxf {
        /// Line of the file, from 1.
        line: usize,
        /// What is wrong and what to do.
        fault: &'static str,
    },
    /// PDF that cannot be followed.
    #[error("no readable PDF: {0}")]
    Pdf(&'static str),
    /// Nested without end.
    #[error(
        "groups or blocks are nested deeper than {DEEPEST} levels; they may contain themselves"
    )]
    TooDeep,
    /// More than any drawing needs: the file is broken or malicious.
    #[error(
        "it needs more than {limit} {what}; explode blocks and groups that are put many times, \
        leave out what is not cut, or divide the drawing"
    )]
    TooMuch {
        /// What there is too much of.
        what: &'static str,
        /// The most that is read.
        limit: usize,
    },
    /// A number that is none, or beyond every machine.
    #[error(
        "{what} has numbers that are not finite or beyond {FARTHEST} mm; export the drawing again"
    )]
    OutOfRange {
        /// Which line, text or attribute.
        what: String,
    },
}

codes!(error ArtError {
    UnknownFormat = 151,
    Empty = 152,
    Svg = 153,
    Dxf = 154,
    Pdf = 155,
    TooDeep = 156,
    TooMuch = 157,
    OutOfRange = 158,
});

impl ArtFormat {
    /// The format by the beginning of the content, else by the name.
    pub fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let start = &bytes[..bytes.len().min(2048)];
        // Without zeros UTF-16 shows its letters.
        let start: Vec<u8> = start.iter().copied().filter(|b| *b != 0).collect();
        let has = |what: &[u8]| start.windows(what.len()).any(|w| w == what);
        if has(b"%PDF-") {
            return Some(Self::Pdf);
        }
        if has(b"<svg") || has(b":svg") {
            return Some(Self::Svg);
        }
        if has(b"SECTION") || start.starts_with(b"AutoCAD Binary DXF") {
            return Some(Self::Dxf);
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "svg" | "svgz" => Some(Self::Svg),
            "dxf" => Some(Self::Dxf),
            "pdf" => Some(Self::Pdf),
            _ => None,
        }
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Dxf => "dxf",
            Self::Pdf => "pdf",
        }
    }
}

/// Reads the pages of a drawing. The path serves only to tell the format where the content does
/// not. Packed SVG (`.svgz`) is unpacked.
///
/// # Errors
/// [`ArtError`] for files that cannot be followed or take too much; strange but readable content is
/// left to the judge.
///
/// # Example
/// ```
/// use kerfold::io::artwork::read_artwork;
/// use std::path::Path;
///
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="50mm" height="30mm"
///     viewBox="0 0 50 30"><rect x="5" y="5" width="40" height="20"/></svg>"#;
/// let (_, pages) = read_artwork(Path::new("lid.svg"), svg.as_bytes())?;
/// assert_eq!((pages.len(), pages[0].paths.len()), (1, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_artwork(path: &Path, bytes: &[u8]) -> Result<(ArtFormat, Vec<Artwork>), ArtError> {
    read(path, bytes, Budget::default())
}

/// The same with curves flattened to within another distance, in mm, than [`FLATNESS`].
///
/// # Errors
/// As [`read_artwork`].
pub fn read_artwork_within(
    path: &Path,
    bytes: &[u8],
    flatness: f64,
) -> Result<(ArtFormat, Vec<Artwork>), ArtError> {
    read(path, bytes, Budget::within(flatness))
}

fn read(path: &Path, bytes: &[u8], budget: Budget) -> Result<(ArtFormat, Vec<Artwork>), ArtError> {
    if bytes.len() as u64 > LARGEST_FILE {
        let limit = LARGEST_FILE as usize;
        return Err(ArtError::TooMuch { what: "bytes", limit });
    }
    let unpacked = decode::gunzipped(bytes, &budget)?;
    let bytes = unpacked.as_deref().unwrap_or(bytes);
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ArtError::Empty);
    }
    let format = ArtFormat::of(path, bytes).ok_or(ArtError::UnknownFormat)?;
    let pages = match format {
        ArtFormat::Svg => vec![svg::read(bytes, &budget)?],
        ArtFormat::Dxf => vec![dxf::read(bytes, &budget)?],
        ArtFormat::Pdf => pdf::read(bytes, &budget)?,
    };
    Ok((format, pages))
}

#[cfg(test)]
mod tests;
