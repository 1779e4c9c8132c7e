//! Single-stroke lettering: one table, one stroke where a machine draws one line.

use glam::DVec2;

use crate::geom::polygon::bounds;
use crate::sheet::error::SheetError;

/// Height of a capital letter in units of [`glyph`]; a letter is 4 units wide.
pub const CAPITAL: f64 = 6.0;

/// From one letter to the next, in table units.
const ADVANCE: f64 = 6.0;

/// Strokes are separated by spaces; each is a row of points, a digit for x (0 to 4) and one for y
/// (0 to 6) each.
const TABLE: [(char, &str); 53] = [
    (' ', ""),
    ('A', "0004264440 0242"),
    ('B', "00063645443303 3342413000"),
    ('C', "4536160501103041"),
    ('D', "00062644422000"),
    ('E', "46060040 0333"),
    ('F', "460600 0333"),
    ('G', "45361605011030414323"),
    ('H', "0006 4046 0343"),
    ('I', "1030 1636 2026"),
    ('J', "0110304146"),
    ('K', "0006 460340"),
    ('L', "060040"),
    ('M', "0006234640"),
    ('N', "00064046"),
    ('O', "100105163645413010"),
    ('P', "00063645443303"),
    ('Q', "100105163645413010 2240"),
    ('R', "00063645443303 2340"),
    ('S', "453616050413334241301001"),
    ('T', "0646 2026"),
    ('U', "060110304146"),
    ('V', "062046"),
    ('W', "0610233046"),
    ('X', "0046 0640"),
    ('Y', "062346 2320"),
    ('Z', "06460040"),
    ('0', "100105163645413010 1135"),
    ('1', "142620 1030"),
    ('2', "05163645440040"),
    ('3', "05163645443323 334241301001"),
    ('4', "30360242"),
    ('5', "460603334241301001"),
    ('6', "361605011030414233 3303"),
    ('7', "064610"),
    ('8', "130405163645443313 1302011030414233"),
    ('9', "103041453616050413 1343"),
    ('-', "1333"),
    ('.', "1011212010"),
    ('/', "0046"),
    ('#', "1016 3036 0242 0444"),
    ('+', "0343 2125"),
    (':', "2122 2425"),
    ('_', "0040"),
    ('°', "1526352415"),
    ('%', "0046 0616150506 4030314140"),
    (',', "2110"),
    ('(', "36251130"),
    (')', "16253110"),
    ('=', "0242 0444"),
    ('×', "1135 1531"),
    ('Ø', "100105163645413010 0046"),
    ('<', "450341"),
];

/// A line of text as strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct Lettering {
    /// Open polylines, in reading order.
    pub strokes: Vec<Vec<DVec2>>,
    /// Lower left corner of their bounding box.
    pub low: DVec2,
    /// Upper right corner of their bounding box.
    pub high: DVec2,
}

/// The strokes of a character, [`CAPITAL`] units high, with its base line on y = 0; `None` for a
/// character other than A–Z, 0–9, space and `- . / # + : _ ° % , ( ) = × Ø <`.
pub fn glyph(character: char) -> Option<Vec<Vec<DVec2>>> {
    let (_, strokes) = TABLE.iter().find(|(c, _)| *c == character)?;
    Some(strokes.split_whitespace().map(points).collect())
}

/// Letters a text with capitals `height` mm high, from (0, 0) on along x, baseline on y = 0. The
/// figures 6 and 9 are underlined, so that they can be told apart on a loose piece.
///
/// # Errors
/// [`SheetError::NoGlyph`] for a character other than A–Z, 0–9, space and
/// `- . / # + : _ ° % , ( ) = × Ø <`.
///
/// # Example
/// ```
/// let name = kerfold_sheet::sheet::lettering("P01", 5.0)?;
/// assert!((name.high.y - name.low.y - 5.0).abs() < 1e-9);
/// assert!(kerfold_sheet::sheet::lettering("ß", 5.0).is_err());
/// # Ok::<(), kerfold_sheet::sheet::SheetError>(())
/// ```
pub fn lettering(text: &str, height: f64) -> Result<Lettering, SheetError> {
    letters(text, height, true)
}

/// As [`lettering`], without lines under 6 and 9: for words that nobody reads upside down.
///
/// # Errors
/// As [`lettering`].
///
/// # Example
/// ```
/// let size = kerfold_sheet::sheet::plain_lettering("600 X 400 MM", 5.0)?;
/// assert_eq!(size.low.y, 0.0);
/// # Ok::<(), kerfold_sheet::sheet::SheetError>(())
/// ```
pub fn plain_lettering(text: &str, height: f64) -> Result<Lettering, SheetError> {
    letters(text, height, false)
}

fn letters(text: &str, height: f64, is_underlined: bool) -> Result<Lettering, SheetError> {
    let unit = height / CAPITAL;
    let mut strokes = Vec::new();
    for (i, character) in text.chars().enumerate() {
        let origin = DVec2::new(i as f64 * ADVANCE, 0.0);
        let glyph = glyph(character)
            .ok_or_else(|| SheetError::NoGlyph { character, text: text.to_owned() })?;
        let mut add = |points: Vec<DVec2>| {
            strokes.push(points.into_iter().map(|p| (origin + p) * unit).collect())
        };
        glyph.into_iter().for_each(&mut add);
        if is_underlined && matches!(character, '6' | '9') {
            add(vec![DVec2::new(0.0, -1.5), DVec2::new(4.0, -1.5)]);
        }
    }
    let (low, high) = bounds(strokes.iter().flatten()).unwrap_or_default();
    Ok(Lettering { strokes, low, high })
}

fn points(stroke: &str) -> Vec<DVec2> {
    let digit = |b: u8| f64::from(b - b'0');
    stroke
        .as_bytes()
        .chunks_exact(2)
        .map(|pair| DVec2::new(digit(pair[0]), digit(pair[1])))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_drawn_inside_its_box_and_no_two_are_alike() {
        let mut seen = Vec::new();
        for character in ('A'..='Z').chain('0'..='9').chain("-./#+:_°%,()=×Ø<".chars()) {
            let text = character.to_string();
            let letter = lettering(&text, 6.0).expect("in the table");
            assert!(letter.low.x >= 0.0 && letter.high.x <= 4.0 && letter.high.y <= 6.0, "{text}");
            assert!(letter.strokes.iter().all(|s| s.len() > 1), "{text}");
            assert!(!seen.contains(&letter.strokes), "{text}");
            seen.push(letter.strokes);
        }
        let widths = TABLE.iter().flat_map(|(_, s)| s.split_whitespace()).all(|s| s.len() % 2 == 0);
        assert!(widths, "a stroke with half a point");
    }

    #[test]
    fn no_glyph_draws_a_line_twice() {
        for (character, _) in TABLE {
            let letter = lettering(&character.to_string(), 6.0).expect("in the table");
            let lines: Vec<_> = letter.strokes.iter().flat_map(|s| s.windows(2)).collect();
            for (i, a) in lines.iter().enumerate() {
                for b in &lines[..i] {
                    assert!(!overlap(a, b), "{character}: {a:?} {b:?}");
                }
            }
        }
    }

    /// Whether two segments share more than a point.
    fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
        let along = a[1] - a[0];
        if along.perp_dot(b[0] - a[0]) != 0.0 || along.perp_dot(b[1] - a[0]) != 0.0 {
            return false;
        }
        let at = |p: DVec2| (p - a[0]).dot(along) / along.length_squared();
        let (low, high) = (at(b[0]).min(at(b[1])), at(b[0]).max(at(b[1])));
        low.max(0.0) < high.min(1.0)
    }

    #[test]
    fn six_and_nine_are_underlined_and_strangers_refused() {
        assert!(lettering("6", 6.0).expect("a six").low.y < 0.0);
        assert_eq!(lettering("8", 6.0).expect("an eight").low.y, 0.0);
        let error = lettering("P01 ß", 3.0).expect_err("no such glyph");
        assert!(error.to_string().contains("'ß'"), "{error}");
    }
}
