//! The title block of a page.

use glam::DVec2;

use super::dimension::tenths;
use super::shape::{Pen, Shape, words_from};
use super::{BLOCK, BORDER, PAGE, is_bevelled};
use crate::panel::{PanelRow, Plate};
use crate::sheet::glyph;

/// Columns of the block, from the left, in mm.
const COLUMNS: [f64; 3] = [4.0, 76.0, 176.0];

pub(super) fn title_block(
    row: &PanelRow,
    plate: &Plate,
    (title, scale): (&str, f64),
) -> Vec<Shape> {
    let (low, high) = (DVec2::splat(BORDER), DVec2::new(PAGE.x - BORDER, BORDER + BLOCK));
    let corners = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let mut shapes = vec![Shape::outline(Pen::Dimension, corners)];
    let line = |column: usize, row: f64| low + DVec2::new(COLUMNS[column], BLOCK - 6.0 * row);
    shapes.extend(words_from(&row.id.to_string(), line(0, 1.9), 7.0));
    shapes.extend(words_from(&lettered(title), line(0, 3.2), 3.0));
    let group = format!("GROUP G{:03}  {} ALIKE", row.group + 1, row.copies);
    let group = if row.is_mirrored { group + "  MIRROR IMAGE" } else { group };
    let [length, width] = row.size.map(tenths);
    let middle = [
        group,
        format!("BLANK {length} × {width} MM"),
        format!("THICKNESS {} MM  MASS {:.2} KG", tenths(row.thickness), row.mass),
    ];
    let holes = match plate.holes.len() {
        0 => "NO HOLES".to_owned(),
        n => format!("{n} HOLES Ø{}", tenths(2.0 * plate.holes[0].radius)),
    };
    let back = if is_bevelled(plate) { "DASHED = BACK" } else { "SQUARE CUT" };
    let right = [
        format!("SCALE 1:{}  LENGTHS IN MM", tenths(scale)),
        format!("SEEN FROM OUTSIDE  {back}"),
        format!("{holes}  AREA {:.4} M2", row.area * 1e-6),
    ];
    for (column, lines) in [(1, middle), (2, right)] {
        for (i, words) in lines.iter().enumerate() {
            shapes.extend(words_from(words, line(column, 1.1 + 1.15 * i as f64), 2.8));
        }
    }
    shapes
}

/// The letters of a text that have a glyph, in capitals.
fn lettered(text: &str) -> String {
    let known: String = text.to_uppercase().chars().filter(|&c| glyph(c).is_some()).collect();
    known.chars().take(24).collect()
}
