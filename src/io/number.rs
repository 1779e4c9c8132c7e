//! Numbers and colours as the sheet files show them.

use glam::DVec2;

use crate::sheet::{Rgb, Stroke};

/// At most four decimals, no trailing zeros, never −0.
pub(super) fn decimal(value: f64) -> String {
    const PARTS: u64 = 10_000;
    let scaled = value * PARTS as f64;
    let nearest = scaled.round();
    // The product is off by an ulp at most, so where it is not near a half its nearest whole number
    // is the right one. Files of panels have millions of numbers, and this is several times faster
    // than the exact way.
    if scaled.abs() < 1e11 && (scaled - nearest).abs() < 0.499 {
        let parts = nearest.abs() as u64;
        let (whole, rest) = (parts / PARTS, parts % PARTS);
        let sign = if nearest < 0.0 { "-" } else { "" };
        if rest == 0 {
            return format!("{sign}{whole}");
        }
        let mut text = format!("{sign}{whole}.{rest:04}");
        text.truncate(text.trim_end_matches('0').len());
        return text;
    }
    exact(value)
}

/// The same for every number, slowly.
fn exact(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The points of a stroke as text, without those that four decimals cannot tell apart; y is turned
/// over where a height is given.
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

/// Text as XML holds it between tags and in quotes. Control characters cannot be written in XML,
/// not even escaped.
pub(crate) fn xml(text: &str) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fast_way_shows_the_same_decimals() {
        let halves = (-40_000..40_000).map(|i| f64::from(i) * 2.5e-5);
        let others = (0..40_000).map(|i| (f64::from(i) * 0.7391).sin() * 10f64.powi(i % 14 - 3));
        let odd = [-0.0, 1e-9, -1e-9, 9.99995, 1e11, -3e15, 5e-324, f64::MAX, f64::NAN];
        for value in halves.chain(others).chain(odd) {
            assert_eq!(decimal(value), exact(value), "{value:?}");
        }
        assert_eq!([0.5, -2.0, 1.00005, 100.0].map(decimal), ["0.5", "-2", "1.0001", "100"]);
    }
}
