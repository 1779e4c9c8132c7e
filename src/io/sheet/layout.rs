//! `layout.json`: which piece lies where.

use glam::DVec2;
use serde::Serialize;

use crate::io::order_json::OrderSource;
use crate::sheet::{Layout, Placed, Sheet};

#[derive(Serialize)]
struct File<'a> {
    command: &'a str,
    sheets: Vec<SheetEntry>,
    density: f64,
    cut_length: f64,
    score_length: f64,
}

#[derive(Serialize)]
struct SheetEntry {
    id: String,
    width: f64,
    height: f64,
    placed: Vec<PlacedEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    offcut: Option<[DVec2; 2]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    guillotine: Vec<[DVec2; 2]>,
}

#[derive(Serialize)]
struct PlacedEntry {
    piece: String,
    x: f64,
    y: f64,
    rotation: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<SourceEntry>,
}

#[derive(Serialize)]
struct SourceEntry {
    file: usize,
    id: String,
    copy: usize,
}

/// The text of `layout.json`; `command` is the command line that made it. Places are written to the
/// digit, sums to six decimals.
///
/// # Example
/// ```
/// use kerfold::io::sheet::layout::write_layout_json;
/// use kerfold::prelude::*;
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let sheets = lay_out(&net, &SheetParams::default())?;
/// assert!(write_layout_json(&sheets.layout, "my program").contains("\"placed\""));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_layout_json(layout: &Layout, command: &str) -> String {
    write_order_layout_json(layout, &[], command)
}

/// As [`write_layout_json`]; pieces of an order, for which there are sources, tell where they come
/// from.
///
/// # Example
/// ```
/// use kerfold::io::{order_json::Order, pieces_json::write_pieces_json};
/// use kerfold::io::sheet::layout::write_order_layout_json;
/// use kerfold::prelude::*;
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let mut order = Order::default();
/// order.add(&write_pieces_json(&net, "my program"), 3)?;
/// let sheets = lay_out(&order.net, &SheetParams::default())?;
/// let json = write_order_layout_json(&sheets.layout, &order.sources, "my program");
/// assert!(json.contains("\"copy\""));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_order_layout_json(layout: &Layout, sources: &[OrderSource], command: &str) -> String {
    let file = File {
        command,
        sheets: layout.sheets.iter().map(|s| sheet(s, sources)).collect(),
        density: six_decimals(layout.density),
        cut_length: six_decimals(layout.cut_length),
        score_length: six_decimals(layout.score_length),
    };
    let text = serde_json::to_string_pretty(&file).expect("plain numbers and text become JSON");
    text + "\n"
}

fn sheet(sheet: &Sheet, sources: &[OrderSource]) -> SheetEntry {
    let placed = sheet.placed.iter().map(|p| placed(p, sources)).collect();
    let places =
        |points: [DVec2; 2]| points.map(|p| DVec2::new(six_decimals(p.x), six_decimals(p.y)));
    SheetEntry {
        id: sheet.id.to_string(),
        width: sheet.width,
        height: sheet.height,
        placed,
        offcut: sheet.offcut.map(places),
        guillotine: sheet.cuts.iter().copied().map(places).collect(),
    }
}

fn placed(placed: &Placed, sources: &[OrderSource]) -> PlacedEntry {
    let Placed { piece, x, y, rotation } = *placed;
    let source =
        sources.get(piece.0).map(|s| SourceEntry { file: s.file, id: s.id.clone(), copy: s.copy });
    PlacedEntry { piece: piece.to_string(), x, y, rotation, source }
}

/// Sums depend on the order of additions in their last digits; those are not shown.
fn six_decimals(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::net::PieceId;
    use crate::sheet::SheetId;

    #[test]
    fn the_keys_come_in_the_order_of_the_contract() {
        let placed = vec![Placed { piece: PieceId(11), x: 5.25, y: 7.0, rotation: 90.0 }];
        let sheets =
            vec![Sheet { id: SheetId(0), width: 600.0, height: 400.0, placed, ..Sheet::default() }];
        let layout =
            Layout { sheets, density: 0.123_456_789, cut_length: 10.0, score_length: 0.1 + 0.2 };
        let text = write_layout_json(&layout, "kerfold nest \"a\"");
        let keys = [
            "command",
            "sheets",
            "id",
            "width",
            "placed",
            "piece",
            "\"x\"",
            "rotation",
            "density",
            "score_length",
        ];
        let places: Vec<_> = keys.iter().map(|k| text.find(k).expect(k)).collect();
        assert!(places.is_sorted(), "{text}");
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["command"], "kerfold nest \"a\"");
        assert_eq!(value["sheets"][0]["placed"][0]["piece"], "P12");
        assert_eq!(value["density"], 0.123_457);
        assert_eq!(value["score_length"], 0.3);
    }
}
