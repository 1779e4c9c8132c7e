//! The sheets of the page as pictures inside it, and what belongs together.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec2;
use serde_json::{Value, json};

use super::{SheetPage, piece_colour};
use crate::io::number::{decimal, hex};
use crate::net::PieceId;
use crate::sheet::{Drawing, Labels, LayerKind, MarkKind, Placed, Stroke};

/// One sheet: parts in the colours of their pieces, all lines, and the sides of seams to point at.
pub(super) fn sheet_svg(page: &SheetPage<'_>, drawing: &Drawing) -> String {
    let (width, height) = (decimal(drawing.width), decimal(drawing.height));
    let stem = drawing.file_stem();
    let mut text = format!(
        "<figure><figcaption>{stem} – {width} × {height} mm</figcaption><svg id=\"{stem}\" \
        viewBox=\"0 0 {width} {height}\"><rect class=\"paper\" width=\"{width}\" \
        height=\"{height}\"/>"
    );
    parts(&mut text, page, drawing);
    let style = page.params.style();
    for layer in &drawing.layers {
        let colour = hex(style.pen(layer.kind).colour);
        let lines: String = layer
            .marks
            .iter()
            .flat_map(|mark| &mark.strokes)
            .map(|stroke| path(stroke, drawing.height))
            .collect();
        let kind = layer.kind.name();
        let _ = write!(text, "<path class=\"line {kind}\" stroke=\"{colour}\" d=\"{lines}\"/>");
    }
    seams(&mut text, page, drawing);
    text + "</svg></figure>\n"
}

/// The area of every part, its holes left out.
fn parts(text: &mut String, page: &SheetPage<'_>, drawing: &Drawing) {
    let places = places(page);
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
        let line: String = mark.strokes.iter().map(|s| path(s, drawing.height)).collect();
        *contours.entry(piece).or_default() += &line;
    }
    for (piece, line) in contours {
        let Some(&place) = places.get(&piece) else { continue };
        let colour = hex(piece_colour(place));
        let _ = write!(
            text,
            "<path class=\"part\" data-p=\"{place}\" fill=\"{colour}\" d=\"{line}\"/>"
        );
    }
}

/// The sides of seams as they lie on the sheet.
fn seams(text: &mut String, page: &SheetPage<'_>, drawing: &Drawing) {
    let Some(sheet) = page.sheets.layout.sheets.iter().find(|s| s.id == drawing.sheet) else {
        return;
    };
    let lying: BTreeMap<PieceId, &Placed> = sheet.placed.iter().map(|p| (p.piece, p)).collect();
    for (key, seams) in keys(page).into_iter().enumerate() {
        let mut line = String::new();
        for side in seams.1.iter().flat_map(|&s| &page.net.seams[s].sides) {
            if let Some(placed) = lying.get(&side.piece) {
                let points = side.segment.map(|p| placed.apply(p)).to_vec();
                line += &path(&Stroke { points, closed: false }, drawing.height);
            }
        }
        if !line.is_empty() {
            let _ = write!(text, "<path class=\"seam\" data-s=\"{key}\" d=\"{line}\"/>");
        }
    }
}

/// What the pointer can be on: the numbers on the sheet, each with the seams that it stands for.
fn keys(page: &SheetPage<'_>) -> Vec<(usize, Vec<usize>)> {
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
pub(super) fn page_json(page: &SheetPage<'_>, model: Option<Value>) -> String {
    let places = places(page);
    let names: Vec<String> = page.net.pieces.iter().map(|p| p.id.to_string()).collect();
    let colours: Vec<_> = (0..names.len()).map(piece_colour).collect();
    let seams: Vec<Value> = keys(page)
        .into_iter()
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

/// `M1 2L3 4Z` with two decimals, y down.
fn path(stroke: &Stroke, height: f64) -> String {
    let shown = |mm: f64| decimal((mm * 100.0).round() / 100.0);
    let mut text = String::new();
    for (i, p) in stroke.points.iter().enumerate() {
        let p = DVec2::new(p.x, height - p.y);
        let letter = if i == 0 { 'M' } else { 'L' };
        let _ = write!(text, "{letter}{} {}", shown(p.x), shown(p.y));
    }
    if stroke.closed {
        text.push('Z');
    }
    text
}
