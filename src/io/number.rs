//! Numbers and colours as the sheet files show them.

use glam::DVec2;

use crate::sheet::{Rgb, Stroke};

/// At most four decimals, no trailing zeros, never −0.
pub(super) fn decimal(value: f64) -> String {
    let mut text = String::with_capacity(12);
    push_decimal(&mut text, value);
    text
}

/// Adds a number to a text as [`decimal`] shows it: files of panels have millions of numbers, and a
/// text of its own for each costs more than its digits.
pub(super) fn push_decimal(text: &mut String, value: f64) {
    push_rounded::<4>(text, value);
}

/// Adds a number with at most so many decimals, no more than 8; no trailing zeros, never −0.
pub(super) fn push_rounded<const DECIMALS: u32>(text: &mut String, value: f64) {
    let parts_of_one = 10_u64.pow(DECIMALS);
    let scaled = value * parts_of_one as f64;
    let nearest = scaled.round();
    // The product is off by an ulp at most, so where it is not near a half its nearest whole number
    // is the right one, which is several times faster than the exact way. NaN fails the test, too.
    let is_plain = scaled.abs() < 1e11 && (scaled - nearest).abs() < 0.499;
    if !is_plain {
        *text += &exact(value, DECIMALS as usize);
        return;
    }
    let parts = nearest.abs() as u64;
    let (mut whole, mut rest) = (parts / parts_of_one, parts % parts_of_one);
    // From the last digit to the first: at most 12, a point and a sign.
    let mut digits = [0; 16];
    let mut first = digits.len();
    let mut put = |byte: u8| {
        first -= 1;
        digits[first] = byte;
    };
    if rest > 0 {
        let mut decimals = DECIMALS;
        while rest.is_multiple_of(10) {
            (rest, decimals) = (rest / 10, decimals - 1);
        }
        for _ in 0..decimals {
            put(b'0' + (rest % 10) as u8);
            rest /= 10;
        }
        put(b'.');
    }
    loop {
        put(b'0' + (whole % 10) as u8);
        whole /= 10;
        if whole == 0 {
            break;
        }
    }
    if nearest < 0.0 {
        put(b'-');
    }
    text.push_str(std::str::from_utf8(&digits[first..]).expect("digits are ASCII"));
}

/// Adds both numbers of a point with a space between them.
pub(super) fn push_point(text: &mut String, p: DVec2) {
    push_decimal(text, p.x);
    text.push(' ');
    push_decimal(text, p.y);
}

/// The same for every number, slowly.
fn exact(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
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

/// Adds the points that [`shown_points`] shows, turned over, as `x,y` with ` L ` between them.
pub(super) fn push_shown_points(text: &mut String, stroke: &Stroke, height: f64) {
    const BETWEEN: &str = " L ";
    let start = text.len();
    // Where the texts of the points begin.
    let mut places: Vec<usize> = Vec::with_capacity(stroke.points.len());
    for p in &stroke.points {
        let before = text.len();
        *text += if places.is_empty() { "" } else { BETWEEN };
        let at = text.len();
        push_decimal(text, p.x);
        text.push(',');
        push_decimal(text, height - p.y);
        let is_same = places.last().is_some_and(|&last| text[last..before] == text[at..]);
        if is_same { text.truncate(before) } else { places.push(at) }
    }
    if !stroke.closed {
        return;
    }
    while let [first, second, .., last] | [first, second @ last] = places[..]
        && text[first..second - BETWEEN.len()] == text[last..]
    {
        text.truncate(last - BETWEEN.len());
        places.pop();
    }
    debug_assert_eq!(places.first().copied().unwrap_or(start), start);
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
    fn points_are_written_as_they_are_shown() {
        let lines: [&[[f64; 2]]; 6] = [
            &[],
            &[[1.0, 2.0]],
            &[[1.0, 2.0], [1.000_01, 2.0]],
            &[[0.0, 0.0], [5.0, 1e-6], [5.0, 0.0], [0.0, 3.0], [0.0, 1e-7], [1e-7, 0.0]],
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]],
            &[[0.1, 0.2], [0.3, 0.4], [0.1, 0.2], [0.1, 0.2]],
        ];
        for (points, closed) in lines.iter().flat_map(|l| [(l, true), (l, false)]) {
            let stroke = Stroke { points: points.iter().map(|&p| p.into()).collect(), closed };
            let shown = shown_points(&stroke, Some(10.0));
            let shown: Vec<String> = shown.iter().map(|p| p.join(",")).collect();
            let mut text = "M ".to_owned();
            push_shown_points(&mut text, &stroke, 10.0);
            assert_eq!(text, format!("M {}", shown.join(" L ")));
        }
    }

    #[test]
    fn the_fast_way_shows_the_same_decimals() {
        let halves = (-40_000..40_000).map(|i| f64::from(i) * 2.5e-5);
        let others = (0..40_000).map(|i| (f64::from(i) * 0.7391).sin() * 10f64.powi(i % 14 - 3));
        let odd = [-0.0, 1e-9, -1e-9, 9.99995, 1e11, -3e15, 5e-324, f64::MAX, f64::NAN];
        for value in halves.chain(others).chain(odd) {
            assert_eq!(decimal(value), exact(value, 4), "{value:?}");
            let mut text = String::new();
            push_rounded::<6>(&mut text, value);
            assert_eq!(text, exact(value, 6), "{value:?}");
        }
        assert_eq!([0.5, -2.0, 1.00005, 100.0].map(decimal), ["0.5", "-2", "1.0001", "100"]);
    }
}
