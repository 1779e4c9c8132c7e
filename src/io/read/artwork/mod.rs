//! Drawings of others: SVG, DXF and PDF as lines in millimetres for [`crate::lint`].
//!
//! Curves are flattened to within [`FLATNESS`]; transforms, blocks and nested pages are carried
//! out; what is not lines is counted. One page of a file is one [`Artwork`].

mod curve;
mod dxf;
mod dxf_entity;
mod pdf;
mod pdf_object;
mod pdf_page;
mod svg;
mod svg_path;

use std::path::Path;

use crate::code::codes;
use crate::lint::{ArtPath, ArtText, Artwork, Operation, UnitState};
use glam::DVec2;

/// How far a flattened curve may be from the true one, in mm.
pub const FLATNESS: f64 = 0.01;

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
    /// Neither the name nor the content tells the format.
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
}

codes!(error ArtError {
    UnknownFormat = 151,
    Empty = 152,
    Svg = 153,
    Dxf = 154,
    Pdf = 155,
    TooDeep = 156,
});

impl ArtFormat {
    /// The format by the beginning of the content, else by the name.
    pub fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let start = &bytes[..bytes.len().min(2048)];
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
            "svg" => Some(Self::Svg),
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
/// not.
///
/// # Errors
/// [`ArtError`] for files that cannot be followed; strange but readable content is left to the
/// judge.
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
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ArtError::Empty);
    }
    let format = ArtFormat::of(path, bytes).ok_or(ArtError::UnknownFormat)?;
    let pages = match format {
        ArtFormat::Svg => vec![svg::read(bytes)?],
        ArtFormat::Dxf => vec![dxf::read(bytes)?],
        ArtFormat::Pdf => pdf::read(bytes)?,
    };
    Ok((format, pages))
}

/// Gathers the lines of a page with their colours.
#[derive(Default)]
struct Collector {
    art: Artwork,
    colours: Vec<Option<[u8; 3]>>,
}

impl Collector {
    /// A line; `operation` as far as its layer tells.
    fn path(&mut self, (points, closed): (Vec<DVec2>, bool), place: &Place<'_>) {
        self.colours.push(place.operation.is_none().then_some(place.colour));
        self.art.paths.push(ArtPath {
            points,
            closed,
            operation: place.operation.unwrap_or(Operation::Cut),
            layer: place.layer.to_owned(),
            name: place.name.map(str::to_owned),
        });
    }

    fn text(&mut self, text: String, at: DVec2) {
        self.art.texts.push(ArtText { text, at });
    }

    fn unread(&mut self, kind: &str) {
        match self.art.unread.iter_mut().find(|(k, _)| k == kind) {
            Some((_, count)) => *count += 1,
            None => self.art.unread.push((kind.to_owned(), 1)),
        }
    }

    fn finish(mut self, size: Option<DVec2>, unit: UnitState) -> Artwork {
        self.art.size = size;
        self.art.unit = unit;
        self.art.operations_by_colour(&self.colours);
        // Numbers that are none have no place anywhere.
        self.art.paths.iter_mut().for_each(|p| p.points.retain(|q| q.is_finite()));
        self.art.paths.retain(|p| !p.points.is_empty());
        self.art
    }
}

/// Where a line stands in its file.
struct Place<'a> {
    layer: &'a str,
    name: Option<&'a str>,
    operation: Option<Operation>,
    colour: [u8; 3],
}

#[cfg(test)]
mod tests;
