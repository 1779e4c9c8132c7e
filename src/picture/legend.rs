//! What the colours mean, at the right of the picture.

use std::collections::BTreeMap;

use tiny_skia::{Paint, PathBuilder, Pixmap, Rect, Transform};

use super::lettering::write;
use super::paint;
use crate::mesh::Mesh;

/// The legend of a picture.
pub(super) enum Legend {
    /// A scale from 0 to `top`.
    Scale { title: &'static str, top: f64 },
    /// How many vertices there are of each valence.
    Valence { counts: BTreeMap<usize, usize> },
}

impl Legend {
    /// A scale from planar to `top` mm.
    pub fn planarity(top: f64) -> Self {
        Self::Scale { title: "PLANARITY MM", top }
    }

    /// A scale from nothing to twice the limit.
    pub fn limit() -> Self {
        Self::Scale { title: "% OF LIMIT", top: 200.0 }
    }

    /// The valences of a mesh; 6 stands for 6 and more.
    pub fn valence(mesh: &Mesh) -> Self {
        let mut counts = BTreeMap::new();
        for v in mesh.vertices() {
            *counts.entry(mesh.valence(v).min(6)).or_insert(0) += 1;
        }
        Self::Valence { counts }
    }

    /// The width of the strip for the legend, in pixels.
    pub fn width(width: u32, height: u32) -> f64 {
        f64::from(letter_height(width, height)) * 14.0
    }

    /// Whether a picture is large enough for one.
    pub fn has_room(width: u32, height: u32) -> bool {
        width.min(height) >= 160
    }

    /// Draws the legend over the right end of the picture.
    pub fn draw(&self, pixmap: &mut Pixmap) {
        for shape in self.shapes(pixmap.width(), pixmap.height()) {
            match shape {
                Shape::Bar { place, colour } => rectangle(pixmap, place, colour),
                Shape::Disc { middle, radius, colour } => disc(pixmap, middle, radius, colour),
                Shape::Text { text, place, height, colour } => {
                    write(pixmap, &text, place, height, colour);
                }
            }
        }
    }

    /// What is drawn at the right end of a picture of this size, the same for pixels and for areas
    /// and lines.
    pub fn shapes(&self, width: u32, height: u32) -> Vec<Shape> {
        let letter = letter_height(width, height);
        let left = width as f32 - letter * 13.5;
        match self {
            Self::Scale { title, top } => scale(title, *top, [left, letter], height as f32),
            Self::Valence { counts } => valences(counts, [left, letter], height as f32),
        }
    }
}

/// A part of a legend, in pixels, y down.
pub(super) enum Shape {
    /// A rectangle: left, top, width, height.
    Bar {
        place: [f32; 4],
        colour: [u8; 3],
    },
    Disc {
        middle: (f32, f32),
        radius: f32,
        colour: [u8; 3],
    },
    /// A text whose base line begins at `place`; `height` is that of a capital.
    Text {
        text: String,
        place: (f32, f32),
        height: f32,
        colour: [u8; 3],
    },
}

/// The height of capitals in pixels.
fn letter_height(width: u32, height: u32) -> f32 {
    (width.min(height) as f32 / 62.0).max(6.0)
}

fn text(text: &str, place: (f32, f32), height: f32) -> Shape {
    Shape::Text { text: text.to_owned(), place, height, colour: paint::LINE }
}

fn scale(title: &str, top: f64, [left, letter]: [f32; 2], height: f32) -> Vec<Shape> {
    let (above, bar) = (height * 0.28, height * 0.44);
    let mut shapes = vec![text(title, (left, above - 2.2 * letter), letter)];
    let rows = bar.round() as usize;
    for row in 0..rows {
        let share = 1.0 - (row as f64 + 0.5) / rows as f64;
        let place = [left, above + row as f32, 1.6 * letter, 1.0];
        shapes.push(Shape::Bar { place, colour: paint::scale_colour(share) });
    }
    for i in 0..=4 {
        let share = f64::from(i) / 4.0;
        let y = above + bar * (1.0 - share as f32);
        let place = [left + 1.6 * letter, y - 0.5, 0.6 * letter, 1.0];
        shapes.push(Shape::Bar { place, colour: paint::LINE });
        let number = three_digits(top * share);
        shapes.push(text(&number, (left + 2.9 * letter, y + letter / 2.0), letter));
    }
    shapes
}

fn valences(counts: &BTreeMap<usize, usize>, [left, letter]: [f32; 2], height: f32) -> Vec<Shape> {
    let above = height * 0.4;
    let mut shapes = vec![text("VALENCE", (left, above - 2.2 * letter), letter)];
    for (i, (&valence, count)) in counts.iter().enumerate() {
        let y = above + i as f32 * 2.4 * letter;
        let middle = (left + 0.7 * letter, y);
        let colour = paint::valence_colour(valence);
        shapes.push(Shape::Disc { middle, radius: 0.6 * letter, colour });
        let name = if valence < 6 { valence.to_string() } else { "6+".to_owned() };
        shapes.push(text(&name, (left + 2.2 * letter, y + letter / 2.0), letter));
        shapes.push(Shape::Text {
            text: count.to_string(),
            place: (left + 5.4 * letter, y + letter / 2.0),
            height: letter,
            colour: [120, 116, 110],
        });
    }
    shapes
}

/// A number with three significant digits, as short as can be.
fn three_digits(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let magnitude = x.abs().log10().floor() as i32;
    if (-4..6).contains(&magnitude) {
        format!("{x:.*}", (2 - magnitude).max(0) as usize)
    } else {
        format!("{x:.2E}")
    }
}

fn rectangle(pixmap: &mut Pixmap, [x, y, width, height]: [f32; 4], colour: [u8; 3]) {
    let mut paint = Paint { anti_alias: false, ..Paint::default() };
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    if let Some(rect) =
        Rect::from_xywh(x.round(), y.round(), width.round().max(1.0), height.round().max(1.0))
    {
        pixmap.fill_rect(rect, &paint, Transform::identity(), None);
    }
}

fn disc(pixmap: &mut Pixmap, (x, y): (f32, f32), radius: f32, colour: [u8; 3]) {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    if let Some(path) = PathBuilder::from_circle(x, y, radius) {
        pixmap.fill_path(&path, &paint, tiny_skia::FillRule::Winding, Transform::identity(), None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 0.012345, 1.0, 12.345, 123.4, 12345.6, 1.5e-7, 2e9].map(three_digits);
        assert_eq!(shown, ["0", "0.0123", "1.00", "12.3", "123", "12346", "1.50E-7", "2.00E9"]);
    }
}
