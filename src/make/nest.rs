//! Anybody's pieces onto sheets: reads the files, lays everything out, gives back what an unfolding
//! gives.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{Fabrication, MakeError, NestError};
use crate::io::artwork::read_artwork;
use crate::io::order_artwork::pieces_of_artwork;
use crate::io::order_json::Order;
use crate::io::read_text;
use crate::net::{Net, Piece};
use crate::progress::Progress;
use crate::sheet::{PieceKind, SheetParams, lay_out_watched};

/// Which pieces are nested.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args, Deserialize)]
pub struct NestStep {
    /// Files of pieces, like the pieces.json that unfold writes, of which only the outlines are
    /// needed; or drawings, SVG or DXF, whose closed cuts are outlines and holes
    #[arg(value_name = "PIECES", required = true)]
    #[serde(deserialize_with = "one_or_many")]
    pub pieces: Vec<PathBuf>,
    /// How often everything is made, 1 to 10000; a file may give a quantity for each of its pieces,
    /// too
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = clap::value_parser!(u32).range(1..=10_000)
    )]
    #[serde(default = "once")]
    pub quantity: u32,
}

fn once() -> u32 {
    1
}

/// Recipes may name one file without brackets.
fn one_or_many<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<PathBuf>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Files {
        One(PathBuf),
        Many(Vec<PathBuf>),
    }
    Ok(match Files::deserialize(deserializer)? {
        Files::One(file) => vec![file],
        Files::Many(files) => files,
    })
}

/// What the pieces of files are, which the files do not say: plates are cut otherwise than along
/// the border of their only face.
fn kind_of(net: &Net) -> PieceKind {
    let is_plate = |piece: &Piece| match piece.faces.as_slice() {
        [face] => piece.outline != face.polygon || !piece.holes.is_empty(),
        _ => false,
    };
    if net.pieces.iter().any(is_plate) { PieceKind::Panels } else { PieceKind::Faces }
}

/// The pieces of a file as JSON: as they stand, or the outlines of a drawing.
fn pieces_text(path: &Path) -> Result<String, NestError> {
    let unreadable = |error| NestError::Unreadable { path: path.to_owned(), error };
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    if !matches!(ending.as_deref(), Some("svg" | "svgz" | "dxf")) {
        return read_text(path).map_err(unreadable);
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    let pages = read_artwork(path, &bytes)
        .map_err(|error| NestError::Drawing { path: path.to_owned(), error })?;
    pieces_of_artwork(&pages.1).map_err(|why| NestError::NoOutlines { path: path.to_owned(), why })
}

/// Nests the pieces of files, which are looked for from `folder`.
///
/// # Errors
/// [`NestError`] for the files, and what laying out can refuse.
pub fn nest_files(
    step: &NestStep,
    sheet: &SheetParams,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Fabrication, MakeError> {
    if !(1..=10_000).contains(&step.quantity) {
        return Err(NestError::Quantity { quantity: step.quantity }.into());
    }
    let mut order = Order::default();
    for name in &step.pieces {
        let path = folder.join(name);
        let text = pieces_text(&path)?;
        order
            .add(&text, step.quantity as usize)
            .map_err(|error| NestError::Order { path, error })?;
    }
    let path = step.pieces.first().cloned().unwrap_or_default();
    let nest = order.params(&sheet.nest).map_err(|error| NestError::Order { path, error })?;
    let params = SheetParams { nest, pieces: kind_of(&order.net), ..sheet.clone() };
    let sheets = lay_out_watched(&order.net, &params, progress)?;
    let Order { net, sources, .. } = order;
    Ok(Fabrication { net, sheets, seams: "the pieces were given", divided: 0, sources })
}
