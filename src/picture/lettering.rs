//! Single-stroke characters on pictures: the strokes of the sheets' lettering.

use tiny_skia::{LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

use crate::sheet::{CAPITAL, glyph};

/// From one character to the next, in units of the glyphs.
const ADVANCE: f32 = 5.6;

/// Writes `text` with its base line beginning at (x, y), in pixels; `height` is that of a capital.
/// Characters without a glyph leave a blank.
pub(super) fn write(
    pixmap: &mut Pixmap,
    text: &str,
    place: (f32, f32),
    height: f32,
    colour: [u8; 3],
) {
    strokes(pixmap, text, place, (height, None), colour);
}

/// As [`write`], with a pale rim around the letters, so that they are read on lines and colours.
pub(super) fn write_clear(
    pixmap: &mut Pixmap,
    text: &str,
    place: (f32, f32),
    height: f32,
    colour: [u8; 3],
) {
    strokes(pixmap, text, place, (height, Some(height / 2.2)), super::paint::PAPER);
    strokes(pixmap, text, place, (height, Some(height / 7.0)), colour);
}

fn strokes(
    pixmap: &mut Pixmap,
    text: &str,
    (x, y): (f32, f32),
    (height, width): (f32, Option<f32>),
    colour: [u8; 3],
) {
    let unit = height / CAPITAL as f32;
    let mut path = PathBuilder::new();
    for (i, character) in text.chars().enumerate() {
        let left = x + i as f32 * ADVANCE * unit;
        for stroke in glyph(character).unwrap_or_default() {
            for (j, point) in stroke.iter().enumerate() {
                let (px, py) = (left + point.x as f32 * unit, y - point.y as f32 * unit);
                if j == 0 { path.move_to(px, py) } else { path.line_to(px, py) }
            }
        }
    }
    let Some(path) = path.finish() else { return };
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    let stroke = Stroke {
        width: width.unwrap_or((height / 8.0).max(1.0)),
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
    fn all_that_legends_write_has_glyphs() {
        for character in "PLANARITY MM VALENCE 0123456789 6+ 1.50E-7 % OF LIMIT".chars() {
            assert!(glyph(character).is_some(), "{character}");
        }
    }
}
