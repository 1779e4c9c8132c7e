//! Pictures of models and sheets as pixels.
//!
//! A model is drawn with its own depth buffer: faces first, at 3 × 3 samples per pixel, then the
//! edges on top, each only where one of its own faces is seen (an item buffer: Weghorst, Hooper and
//! Greenberg 1984). A sheet is drawn by strokes. Both become PNG through tiny-skia. The same input
//! gives the same bytes, on any number of threads. Models are also drawn as areas and lines, for SVG
//! and PDF ([`render_vector`]).

mod band;
mod bsp;
mod camera;
mod frame;
mod legend;
mod lettering;
mod line_png;
mod marks;
mod model;
mod paint;
mod params;
mod pieces;
mod scene;
mod sheet;
mod smooth;
mod story;
mod strip;
mod through;
mod vector;
mod views;

pub use marks::Marks;
pub use model::{render_marked, render_model, render_shares};
pub use params::{
    Colour, EdgeLines, Ids, Projection, RenderParams, Shadow, Surface, UpAxis, View, ViewError,
};
pub use sheet::{Polyline, StrokeLayer, Strokes, render_sheet};
pub use story::{Frame, render_story};
pub use strip::{Cell, render_strip};
pub use vector::{MAX_VECTOR_FACES, VectorPicture, render_vector};
pub use views::render_with;

use tiny_skia::Pixmap;

use self::line_png::line_png;
use crate::code::codes;
use crate::mesh::VertexId;

/// The smallest width and height of a picture, in pixels.
pub const MIN_PIXELS: u32 = 16;
/// The largest width and height of a picture, in pixels.
pub const MAX_PIXELS: u32 = 8192;

/// An opaque picture. Pixel (0, 0) is at the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pixmap: Pixmap,
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The width or the height is out of range.
    #[error("a picture cannot be {pixels} pixels {side}; choose {MIN_PIXELS} to {MAX_PIXELS}")]
    SizeOutOfRange {
        /// `wide` or `high`.
        side: &'static str,
        /// What was asked for.
        pixels: u32,
    },
    /// The direction of view is zero or not finite.
    #[error(
        "{x},{y},{z} is no direction to look from; give three finite numbers that are not all zero"
    )]
    NoDirection {
        /// First coordinate.
        x: f64,
        /// Second coordinate.
        y: f64,
        /// Third coordinate.
        z: f64,
    },
    /// The zoom is no number in its range.
    #[error("a zoom of {zoom} is out of range; choose 0.1 to 20, 1 shows the whole model")]
    ZoomOutOfRange {
        /// What was asked for.
        zoom: f64,
    },
    /// The model has no faces.
    #[error("there is nothing to draw: the model has no faces")]
    NoFaces,
    /// A vertex is not finite, or so far away that the model's size is not.
    #[error("vertex {vertex} is at {x},{y},{z}, too far away to be drawn; mend or remove it")]
    VertexTooFar {
        /// The vertex.
        vertex: VertexId,
        /// First coordinate.
        x: f64,
        /// Second coordinate.
        y: f64,
        /// Third coordinate.
        z: f64,
    },
    /// More triangles than a vector picture can have.
    #[error(
        "the model has {triangles} triangles, too many for a vector picture, which has \
        {MAX_VECTOR_FACES} at most; write a PNG"
    )]
    TooManyFaces {
        /// Number of triangles of its faces.
        triangles: usize,
    },
    /// Several views or a soft shadow on a picture of areas and lines.
    #[error(
        "several views and soft shadows are for pictures of pixels; write a PNG, or leave out \
        `views` and `shadow`"
    )]
    OnlyPixels,
    /// The sheet has no size.
    #[error(
        "a sheet of {width_mm} mm by {height_mm} mm cannot be drawn; both must be positive numbers"
    )]
    SheetWithoutSize {
        /// Width of the sheet in mm.
        width_mm: f64,
        /// Height of the sheet in mm.
        height_mm: f64,
    },
    /// A point of a stroke is not finite.
    #[error("layer {layer}, line {line}, point {point} is not a pair of finite numbers: {x},{y}")]
    StrokeNotFinite {
        /// The name of the layer.
        layer: String,
        /// The line within the layer, from 0.
        line: usize,
        /// The point within the line, from 0.
        point: usize,
        /// First coordinate in mm.
        x: f64,
        /// Second coordinate in mm.
        y: f64,
    },
}

codes!(error PictureError {
    SizeOutOfRange = 821,
    NoDirection = 822,
    NoFaces = 823,
    VertexTooFar = 824,
    SheetWithoutSize = 825,
    StrokeNotFinite = 826,
    TooManyFaces = 829,
    OnlyPixels = 830,
    ZoomOutOfRange = 832,
});

impl Picture {
    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.pixmap.width()
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.pixmap.height()
    }

    /// Red, green and blue (sRGB) of a pixel; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        // Compared here, because tiny-skia looks at the number of the pixel only: beyond the right
        // end is the next row.
        let pixel = (x < self.width()).then(|| self.pixmap.pixel(x, y)).flatten()?;
        Some([pixel.red(), pixel.green(), pixel.blue()])
    }

    /// The picture as a PNG file.
    ///
    /// # Panics
    /// Never for a picture that was made here: writing into memory does not fail.
    pub fn to_png(&self) -> Vec<u8> {
        self.pixmap.encode_png().expect("a picture of checked size is encoded into memory")
    }

    /// As [`Picture::to_png`], the same pixels packed faster where lines run on plain
    /// ground, as of sheets; for shaded pictures its files are larger.
    ///
    /// # Panics
    /// Never for a picture that was made here.
    pub fn to_line_png(&self) -> Vec<u8> {
        line_png(&self.pixmap).unwrap_or_else(|| self.to_png())
    }
}

/// An empty picture of checked size.
fn blank(width: u32, height: u32) -> Result<Pixmap, PictureError> {
    for (side, pixels) in [("wide", width), ("high", height)] {
        if !(MIN_PIXELS..=MAX_PIXELS).contains(&pixels) {
            return Err(PictureError::SizeOutOfRange { side, pixels });
        }
    }
    Ok(Pixmap::new(width, height).expect("a checked size is neither zero nor too large"))
}
