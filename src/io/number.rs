//! Numbers and colours as the sheet files show them.

use glam::DVec2;

use crate::sheet::{Rgb, Stroke};

/// At most four decimals, no trailing zeros, never −0.
pub(super) fn decimal(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The points of a stroke as text, without those that four decimals cannot tell apart; y is turned over where a height is given.
pub(super) fn shown_points(stroke: &Stroke, height: Option<f64>) -> Vec<[String; 2]> {
    let shown = |p: &DVec2| [decimal(p.x), decimal(height.map_or(p.y, |h| h - p.y))];
    let mut points: Vec<_> = stroke.points.iter().map(shown).collect();
    points.dedup();
    while stroke.closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// `#RRGGBB`.
pub(super) fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Text as XML holds it between tags and in quotes. Control characters cannot be written in XML, not even escaped.
pub(super) fn xml(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            c if is_not_xml(c) => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Whether XML has no way to write a character.
pub(super) fn is_not_xml(c: char) -> bool {
    (c < ' ' && !matches!(c, '\t' | '\n')) || matches!(c, '\u{fffe}' | '\u{ffff}')
}
