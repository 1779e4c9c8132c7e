//! `sheets.html`: one page to look at all sheets beside the model.
//!
//! The page is one file, with styles and script inside. A piece has the same colour on the model
//! and on its sheet; what the pointer is on lights up in both, with its partners across the seams.
//! The model can be turned. Nothing on it is to be cut: strokes are as wide as the eye needs.

mod model;
mod svg;

use crate::io::number::{hex, xml};
use crate::mesh::Mesh;
use crate::net::Net;
use crate::sheet::{LayerKind, Rgb, SheetParams, SheetSet};
use crate::units::counted;

/// The look of the page.
const STYLE: &str = include_str!("page.css");

/// What makes the model turn and partners light up.
const SCRIPT: &str = include_str!("page.js");

/// What a page shows.
#[derive(Debug, Clone, Copy)]
pub struct SheetPage<'a> {
    /// The pieces.
    pub net: &'a Net,
    /// Where they lie, and their drawings.
    pub sheets: &'a SheetSet,
    /// The mesh that was unfolded, in mm, whose faces have the numbers of the net; none for pieces
    /// of somebody else.
    pub model: Option<&'a Mesh>,
    /// How the sheets are drawn and what they are called.
    pub params: &'a SheetParams,
}

/// The text of the page; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::sheet::page::{SheetPage, sheets_html};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(40.0);
/// let source = MeshSource { scale: 1.0, split_vertices: &[] };
/// let net = unfold(&cube, &Seams::Free, &UnfoldParams::default(), &source, &Silent)?;
/// let params = SheetParams::default();
/// let sheets = lay_out(&net, &params)?;
/// let page = SheetPage { net: &net, sheets: &sheets, model: Some(&cube), params: &params };
/// assert!(sheets_html(&page, "my program").starts_with("<!DOCTYPE html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sheets_html(page: &SheetPage<'_>, command: &str) -> String {
    let title = page.params.files.title.as_deref().unwrap_or("Sheets");
    let (title, command) = (xml(title), xml(command));
    let pieces = counted(page.net.pieces.len(), "piece", "pieces");
    let sheets = counted(page.sheets.drawings.len(), "sheet", "sheets");
    let model = page.model.and_then(|mesh| model::model_json(page.net, mesh));
    let aside = match &model {
        Some(_) => {
            "<aside><canvas id=\"model\" width=\"1120\" height=\"1000\"></canvas><p>Drag to turn. \
            Point at a piece or at a seam: it lights up with its partners, on the model and on the \
            sheets.</p></aside>"
        }
        None if page.model.is_some() => {
            "<aside><p>The model has too many faces for this page.</p></aside>"
        }
        None => "",
    };
    let index = svg::Index::new(page);
    let drawn: String = page.sheets.drawings.iter().map(|d| svg::sheet_svg(&index, d)).collect();
    let data = svg::page_json(&index, model);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta \
        name=\"viewport\" content=\"width=device-width\">\n<meta name=\"description\" \
        content=\"{command}\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
        <header><h1>{title}</h1><p>{pieces} on {sheets}. {}</p><p id=\"about\" \
        aria-live=\"polite\">&nbsp;</p></header>\n<div id=\"both\">{aside}\n<main>{drawn}</main></div>\n\
        <script type=\"application/json\" id=\"data\">{data}</script>\n<script>\n{SCRIPT}</script>\n\
        </body>\n</html>\n",
        colours(page)
    )
}

/// What the colours of the lines mean.
fn colours(page: &SheetPage<'_>) -> String {
    let style = page.params.style();
    let has = |kind| page.sheets.drawings.iter().any(|d| !d.is_empty(kind));
    let words = [
        (LayerKind::CutOuter, "outlines are cut"),
        (LayerKind::CutInner, "holes are cut"),
        (LayerKind::Score, "folds are scored"),
        (LayerKind::Engrave, "letters are engraved"),
        (LayerKind::Info, "for the eye only"),
    ];
    let shown = words.into_iter().filter(|&(kind, _)| has(kind)).map(|(kind, words)| {
        let colour = hex(style.pen(kind).colour);
        format!("<span class=\"key\"><i style=\"background:{colour}\"></i>{words}</span>")
    });
    shown.collect()
}

/// The colour of a piece: hues by the golden angle, so that neighbours in number differ.
fn piece_colour(piece: usize) -> Rgb {
    let hue = (piece as f64 * 137.507_764).rem_euclid(360.0) / 60.0;
    let light = [0.80, 0.72, 0.86][piece % 3];
    let chroma = 0.20;
    std::array::from_fn(|channel| {
        // Red, green and blue peak at 0, 2 and 4 sixths of the circle.
        let away = (hue - 2.0 * channel as f64).rem_euclid(6.0);
        let share = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        (255.0 * (light - chroma + chroma * 1.6 * share).clamp(0.0, 1.0)).round() as u8
    })
}
