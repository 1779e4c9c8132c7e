//! A few single-stroke characters for legends.
// To be replaced by the lettering of `sheet` when that is there.

use tiny_skia::{LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// Strokes on a grid of 4 × 6, y up from the base line: two digits a point, a blank between
/// strokes.
const GLYPHS: [(char, &str); 29] = [
    ('0', "10 01 05 16 36 45 41 30 10"),
    ('1', "15 26 20"),
    ('2', "05 16 36 45 44 00 40"),
    ('3', "05 16 36 45 44 33 13|33 42 41 30 10 01"),
    ('4', "30 36 02 42"),
    ('5', "46 06 03 33 42 41 30 10 01"),
    ('6', "45 36 16 05 01 10 30 41 42 33 13 02"),
    ('7', "06 46 10"),
    ('8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"),
    ('9', "01 10 30 41 45 36 16 05 04 13 33 44"),
    ('.', "10 11"),
    ('-', "13 33"),
    ('+', "03 43|21 25"),
    ('A', "00 26 40|12 32"),
    ('C', "45 36 16 05 01 10 30 41"),
    ('E', "46 06 00 40|03 33"),
    ('I', "20 26"),
    ('L', "06 00 40"),
    ('M', "00 06 23 46 40"),
    ('N', "00 06 40 46"),
    ('P', "00 06 36 45 44 33 03"),
    ('R', "00 06 36 45 44 33 03|23 40"),
    ('T', "06 46|26 20"),
    ('V', "06 20 46"),
    ('Y', "06 23 46|23 20"),
    ('F', "46 06 00|03 33"),
    ('O', "10 01 05 16 36 45 41 30 10"),
    ('%', "46 00|06 16 15 05 06|30 40 41 31 30"),
    ('e', "02 42 43 34 14 03 01 10 40"),
];
/// From one character to the next, in grid steps.
const ADVANCE: f32 = 5.6;

/// Writes `text` with its base line beginning at (x, y), in pixels; `height` is that of a capital.
/// Characters that are not in the table leave a blank.
pub(super) fn write(
    pixmap: &mut Pixmap,
    text: &str,
    (x, y): (f32, f32),
    height: f32,
    colour: [u8; 3],
) {
    let step = height / 6.0;
    let mut path = PathBuilder::new();
    for (i, character) in text.chars().enumerate() {
        let left = x + i as f32 * ADVANCE * step;
        let glyph = GLYPHS.iter().find(|&&(c, _)| c == character);
        for stroke in glyph.iter().flat_map(|(_, strokes)| strokes.split('|')) {
            for (j, point) in stroke.split(' ').enumerate() {
                let [column, row] = [0, 1].map(|k| f32::from(point.as_bytes()[k] - b'0'));
                let (px, py) = (left + column * step, y - row * step);
                if j == 0 { path.move_to(px, py) } else { path.line_to(px, py) }
            }
        }
    }
    let Some(path) = path.finish() else { return };
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    let stroke = Stroke {
        width: (height / 8.0).max(1.0),
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..Stroke::default()
    };
    pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_legends_write_has_glyphs_on_the_grid() {
        for character in
            "PLANARITY MM VALENCE 0123456789 6+ 1.50e-7 % OF LIMIT".chars().filter(|&c| c != ' ')
        {
            let (_, strokes) = GLYPHS.iter().find(|&&(c, _)| c == character).expect("a glyph");
            for point in strokes.split(['|', ' ']) {
                let on_grid = matches!(point.as_bytes(), [b'0'..=b'4', b'0'..=b'6']);
                assert!(on_grid, "{character}: {point}");
            }
        }
    }
}
