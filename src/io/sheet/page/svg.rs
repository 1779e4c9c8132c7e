//! The sheets of the page as pictures inside it, and what belongs together.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use glam::DVec2;
use serde_json::{Value, json};

use super::{SheetPage, piece_colour};
use crate::io::number::{decimal, hex, push_point};
use crate::net::PieceId;
use crate::sheet::{Drawing, Labels, LayerKind, MarkKind, Placed, Sheet, SheetId, Stroke};

/// What the pointer can be on: a number on the sheet, and the seams that it stands for.
type Key = (usize, Vec<usize>);

/// What all sheets of a page look up.
pub(super) struct Index<'a> {
    page: &'a SheetPage<'a>,
    /// The place of every piece in the net.
    places: BTreeMap<PieceId, usize>,
    keys: Vec<Key>,
    /// The keys with a side on a piece, by their place in `keys`, ascending.
    of_piece: BTreeMap<PieceId, Vec<usize>>,
    sheets: BTreeMap<SheetId, &'a Sheet>,
}

impl<'a> Index<'a> {
    pub fn new(page: &'a SheetPage<'a>) -> Self {
        let keys = keys(page);
        let mut of_piece: BTreeMap<PieceId, Vec<usize>> = BTreeMap::new();
        for (i, (_, seams)) in keys.iter().enumerate() {
            for side in seams.iter().flat_map(|&s| &page.net.seams[s].sides) {
                let known = of_piece.entry(side.piece).or_default();
                if known.last() != Some(&i) {
                    known.push(i);
                }
            }
        }
        let sheets = page.sheets.layout.sheets.iter().map(|s| (s.id, s)).collect();
        Self { page, places: places(page), keys, of_piece, sheets }
    }
}

/// One sheet: parts in the colours of their pieces, all lines, and the sides of seams to point at.
pub(super) fn sheet_svg(index: &Index<'_>, drawing: &Drawing) -> String {
    let (width, height) = (decimal(drawing.width), decimal(drawing.height));
    let stem = drawing.file_stem();
    let mut text = format!(
        "<figure><figcaption>{stem} – {width} × {height} mm</figcaption><svg id=\"{stem}\" \
        viewBox=\"0 0 {width} {height}\"><rect class=\"paper\" width=\"{width}\" \
        height=\"{height}\"/>"
    );
    parts(&mut text, index, drawing);
    let style = index.page.params.style();
    for layer in &drawing.layers {
        let (colour, kind) = (hex(style.pen(layer.kind).colour), layer.kind.name());
        let _ = write!(text, "<path class=\"line {kind}\" stroke=\"{colour}\" d=\"");
        for stroke in layer.marks.iter().flat_map(|mark| &mark.strokes) {
            path(&mut text, stroke, drawing.height);
        }
        text += "\"/>";
    }
    seams(&mut text, index, drawing);
    text + "</svg></figure>\n"
}

/// The area of every part, its holes left out.
fn parts(text: &mut String, index: &Index<'_>, drawing: &Drawing) {
    let mut contours: BTreeMap<PieceId, String> = BTreeMap::new();
    let cuts = drawing
        .layers
        .iter()
        .filter(|l| matches!(l.kind, LayerKind::CutOuter | LayerKind::CutInner))
        .flat_map(|l| &l.marks);
    // Of lines that parts share the whole contours are kept.
    let whole: Vec<&str> = drawing.whole.iter().map(|m| m.id.as_str()).collect();
    let cuts = cuts.filter(|m| !whole.contains(&m.id.as_str())).chain(&drawing.whole);
    let bounds = [MarkKind::Outline, MarkKind::NestedOutline, MarkKind::Hole];
    for mark in cuts.filter(|m| bounds.contains(&m.kind)) {
        let Some(piece) = mark.piece else { continue };
        let line = contours.entry(piece).or_default();
        mark.strokes.iter().for_each(|s| path(line, s, drawing.height));
    }
    for (piece, line) in contours {
        let Some(&place) = index.places.get(&piece) else { continue };
        let colour = hex(piece_colour(place));
        let _ = write!(
            text,
            "<path class=\"part\" data-p=\"{place}\" fill=\"{colour}\" d=\"{line}\"/>"
        );
    }
}

/// The sides of seams as they lie on the sheet.
fn seams(text: &mut String, index: &Index<'_>, drawing: &Drawing) {
    let Some(sheet) = index.sheets.get(&drawing.sheet) else { return };
    let lying: BTreeMap<PieceId, &Placed> = sheet.placed.iter().map(|p| (p.piece, p)).collect();
    let here: BTreeSet<usize> =
        lying.keys().filter_map(|p| index.of_piece.get(p)).flatten().copied().collect();
    for key in here {
        let _ = write!(text, "<path class=\"seam\" data-s=\"{key}\" d=\"");
        for side in index.keys[key].1.iter().flat_map(|&s| &index.page.net.seams[s].sides) {
            if let Some(placed) = lying.get(&side.piece) {
                let points = side.segment.map(|p| placed.apply(p)).to_vec();
                path(text, &Stroke { points, closed: false }, drawing.height);
            }
        }
        *text += "\"/>";
    }
}

/// The numbers on the sheets, each with the seams that it stands for.
fn keys(page: &SheetPage<'_>) -> Vec<Key> {
    if page.params.letter.labels == Labels::Edges {
        return page.net.seams.iter().enumerate().map(|(i, s)| (s.id.0, vec![i])).collect();
    }
    let stretches = page.sheets.assembly.stretches.iter();
    stretches.map(|s| (s.number, s.seams.iter().map(|&(seam, _)| seam).collect())).collect()
}

/// The place of every piece in the net.
fn places(page: &SheetPage<'_>) -> BTreeMap<PieceId, usize> {
    page.net.pieces.iter().enumerate().map(|(i, p)| (p.id, i)).collect()
}

/// Names, colours and partners for the script.
pub(super) fn page_json(index: &Index<'_>, model: Option<Value>) -> String {
    let Index { page, places, keys, .. } = index;
    let names: Vec<String> = page.net.pieces.iter().map(|p| p.id.to_string()).collect();
    let colours: Vec<_> = (0..names.len()).map(piece_colour).collect();
    let seams: Vec<Value> = keys
        .iter()
        .map(|(number, seams)| {
            let sides = seams.first().map(|&s| &page.net.seams[s].sides);
            let pieces: Vec<_> =
                sides.into_iter().flatten().filter_map(|side| places.get(&side.piece)).collect();
            json!({ "number": number, "pieces": pieces, "seams": seams })
        })
        .collect();
    let data = json!({ "names": names, "colours": colours, "seams": seams, "model": model });
    // Nothing in it may end the script element.
    data.to_string().replace('<', "\\u003c")
}

/// Adds `M1 2L3 4Z` with two decimals, y down.
fn path(text: &mut String, stroke: &Stroke, height: f64) {
    let rounded = |mm: f64| (mm * 100.0).round() / 100.0;
    for (i, p) in stroke.points.iter().enumerate() {
        text.push(if i == 0 { 'M' } else { 'L' });
        push_point(text, DVec2::new(rounded(p.x), rounded(height - p.y)));
    }
    if stroke.closed {
        text.push('Z');
    }
}
