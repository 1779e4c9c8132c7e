//! A sheet at true size on several pages of paper.
//!
//! The first page is a map: the sheet made small, the pages on it with their numbers. Every other
//! page shows its window of the sheet with some overlap, crop marks at the window's corners, a
//! scale bar to measure after printing, and its number. A page without a line is left out.

use std::fmt::Write as _;

use glam::DVec2;

use super::{Page, colour, decimal, document, draw_layers, path};
use crate::sheet::{Drawing, LayerKind, Paper, SheetError, Stroke, Style, lettering};

/// Free border left, right and above the window, in mm: printers need about 5.
const BORDER: f64 = 10.0;

/// Free border below the window, for number and scale bar, in mm.
const FOOT: f64 = 20.0;

/// How far the drawing goes on beyond the window, in mm, so that pages can be glued with an
/// overlap.
const BLEED: f64 = 3.0;

/// Length of the crop marks, and the gap between them and the window's corner, in mm.
const CROP: [f64; 2] = [5.0, 1.0];

/// Length of the scale bar, in mm.
const BAR: f64 = 100.0;

/// The layer of what belongs to the page and not to the sheet: printed, never cut.
const PAGE_LAYER: &str = "page info";
const BEGIN_PAGE: &str = "/OC /L5 BDC\n";

/// How the windows of the pages lie on a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tiling {
    /// The paper as it is turned.
    pub paper: DVec2,
    /// Part of the sheet that one page shows, without its bleed.
    pub window: DVec2,
    /// Number of windows along x and y.
    pub counts: [usize; 2],
}

impl Tiling {
    /// The tiling with fewer pages of the two ways to turn the paper; upright if equal.
    pub fn of(sheet: DVec2, paper: Paper) -> Self {
        let turned = |paper: DVec2| {
            let window = paper - DVec2::new(2.0 * BORDER, BORDER + FOOT);
            // A window that ends within rounding of the sheet's border is the last one.
            let count = |sheet: f64, window: f64| ((sheet / window - 1e-9).ceil() as usize).max(1);
            Self { paper, window, counts: [count(sheet.x, window.x), count(sheet.y, window.y)] }
        };
        let [upright, across] = [turned(paper.mm()), turned(paper.mm().perp().abs())];
        if across.pages() < upright.pages() { across } else { upright }
    }

    /// Number of windows.
    pub fn pages(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// Lower left corner of a window on the sheet; windows count row by row from the top left, as
    /// one reads.
    fn low(&self, i: usize, sheet: DVec2) -> DVec2 {
        let (column, row) = (i % self.counts[0], i / self.counts[0]);
        DVec2::new(column as f64 * self.window.x, sheet.y - (row + 1) as f64 * self.window.y)
    }
}

/// The bytes of a PDF with the sheet in tiles; `command` is the command line that made it.
///
/// # Errors
/// [`SheetError::NoGlyph`] never, unless a sheet's name has a letter without a glyph.
///
/// # Example
/// ```
/// use kerfold::io::sheet::pdf::tiles::write_tiles;
/// use kerfold::sheet::{Paper, Preset};
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// let pages = write_tiles(&coupon, Paper::A4, Preset::RedCut, "my program")?;
/// assert!(pages.starts_with(b"%PDF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_tiles(
    drawing: &Drawing,
    paper: Paper,
    style: impl Into<Style>,
    command: &str,
) -> Result<Vec<u8>, SheetError> {
    let style = style.into();
    let sheet = DVec2::new(drawing.width, drawing.height);
    let tiling = Tiling::of(sheet, paper);
    let shown: Vec<usize> =
        (0..tiling.pages()).filter(|&i| has_lines(drawing, &tiling, i, sheet)).collect();
    let mut pages = vec![map_page(drawing, &tiling, &shown, &style)?];
    for (k, &i) in shown.iter().enumerate() {
        pages.push(tile_page(drawing, &tiling, (i, k + 1, shown.len()), &style)?);
    }
    Ok(document(
        &pages,
        (&format!("{} on {}", drawing.file_stem(), paper.name()), command),
        Some(PAGE_LAYER),
        style.prints_info(),
    ))
}

/// Whether something that is machined shows in a window.
fn has_lines(drawing: &Drawing, tiling: &Tiling, i: usize, sheet: DVec2) -> bool {
    let low = tiling.low(i, sheet);
    let high = low + tiling.window;
    let marks = drawing.marks().filter(|m| m.kind.layer() != LayerKind::Info);
    let mut segments = marks.flat_map(|m| &m.strokes).flat_map(|s| {
        let closing =
            s.points.last().zip(s.points.first()).filter(|_| s.closed).map(|(a, b)| [*a, *b]);
        s.points.windows(2).map(|w| [w[0], w[1]]).chain(closing)
    });
    segments.any(|[a, b]| meets_box(a, b, low, high))
}

/// Whether a segment has a point in a box: what is left of it between the box's sides is not
/// nothing.
fn meets_box(a: DVec2, b: DVec2, low: DVec2, high: DVec2) -> bool {
    let mut range = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let (from, along) = (a[axis], b[axis] - a[axis]);
        if along == 0.0 {
            if from < low[axis] || from > high[axis] {
                return false;
            }
            continue;
        }
        let (s, t) = ((low[axis] - from) / along, (high[axis] - from) / along);
        range = [range[0].max(s.min(t)), range[1].min(s.max(t))];
    }
    range[0] <= range[1]
}

fn tile_page(
    drawing: &Drawing,
    tiling: &Tiling,
    (i, number, of): (usize, usize, usize),
    style: &Style,
) -> Result<Page, SheetError> {
    let sheet = DVec2::new(drawing.width, drawing.height);
    let corner = DVec2::new(BORDER, FOOT);
    let mut content = String::new();
    let clip = corner - DVec2::splat(BLEED);
    let size = tiling.window + DVec2::splat(2.0 * BLEED);
    let shift = corner - tiling.low(i, sheet);
    let [x, y, w, h, dx, dy] = [clip.x, clip.y, size.x, size.y, shift.x, shift.y].map(decimal);
    let _ = writeln!(content, "q {x} {y} {w} {h} re W n 1 0 0 1 {dx} {dy} cm");
    draw_layers(&mut content, drawing, style);
    content += "Q\n";
    content += BEGIN_PAGE;
    content += "0 0 0 RG 0.1 w\n";
    crop_marks(&mut content, corner, corner + tiling.window);
    scale_bar(&mut content)?;
    let (column, row) = (i % tiling.counts[0] + 1, i / tiling.counts[0] + 1);
    let words = format!(
        "{}  PAGE {number} OF {of}  COLUMN {column} ROW {row}",
        drawing.file_stem().to_uppercase()
    );
    write_words(&mut content, &words, DVec2::new(BORDER, 4.0), 2.5)?;
    content += "EMC\n";
    Ok(Page { width: tiling.paper.x, height: tiling.paper.y, content })
}

/// The sheet made small, with the windows and the numbers of their pages.
fn map_page(
    drawing: &Drawing,
    tiling: &Tiling,
    shown: &[usize],
    style: &Style,
) -> Result<Page, SheetError> {
    let sheet = DVec2::new(drawing.width, drawing.height);
    let covered = tiling.window * DVec2::new(tiling.counts[0] as f64, tiling.counts[1] as f64);
    let scale = (tiling.window / covered).min_element().min(1.0);
    let corner = DVec2::new(BORDER, FOOT);
    // The windows hang from the sheet's upper border and may reach below its lower one.
    let shift = corner + DVec2::new(0.0, (covered.y - sheet.y) * scale);
    let at = |p: DVec2| shift + p * scale;
    let mut content = String::new();
    let [x, y] = [shift.x, shift.y].map(decimal);
    // A picture of the sheet: nothing in it is to be cut at this size.
    content += BEGIN_PAGE;
    let _ = writeln!(content, "q {scale:.9} 0 0 {scale:.9} {x} {y} cm");
    for layer in &drawing.layers {
        colour(&mut content, style.pen(layer.kind));
        layer.marks.iter().flat_map(|m| &m.strokes).for_each(|stroke| path(&mut content, stroke));
    }
    content += "Q\n0.6 0.6 0.6 RG 0.2 w\n";
    let rectangle = |content: &mut String, low: DVec2, size: DVec2| {
        let corners = [(0.0, 0.0), (size.x, 0.0), (size.x, size.y), (0.0, size.y)];
        let points = corners.map(|(x, y)| at(low + DVec2::new(x, y))).to_vec();
        path(content, &Stroke { points, closed: true });
    };
    for i in 0..tiling.pages() {
        rectangle(&mut content, tiling.low(i, sheet), tiling.window);
    }
    content += "0 0 0 RG 0.1 w\n";
    rectangle(&mut content, DVec2::ZERO, sheet);
    let height = (6.0_f64).min(0.2 * scale * tiling.window.min_element());
    for (k, &i) in shown.iter().enumerate() {
        let place = at(tiling.low(i, sheet)) + DVec2::splat(height / 2.0);
        write_words(&mut content, &(k + 1).to_string(), place, height)?;
    }
    scale_bar(&mut content)?;
    let words = format!("{}  MAP OF {} PAGES", drawing.file_stem().to_uppercase(), shown.len());
    write_words(&mut content, &words, DVec2::new(BORDER, 4.0), 2.5)?;
    content += "EMC\n";
    Ok(Page { width: tiling.paper.x, height: tiling.paper.y, content })
}

/// Two short lines outside every corner of a window, in the continuation of its sides.
fn crop_marks(content: &mut String, low: DVec2, high: DVec2) {
    for (x, out_x) in [(low.x, -1.0), (high.x, 1.0)] {
        for (y, out_y) in [(low.y, -1.0), (high.y, 1.0)] {
            for out in [DVec2::new(out_x, 0.0), DVec2::new(0.0, out_y)] {
                let corner = DVec2::new(x, y);
                let points = vec![corner + CROP[1] * out, corner + (CROP[0] + CROP[1]) * out];
                path(content, &Stroke { points, closed: false });
            }
        }
    }
}

/// A bar in the foot with a tick every 10 mm, true to size.
fn scale_bar(content: &mut String) -> Result<(), SheetError> {
    let low = DVec2::new(BORDER, 8.5);
    let line = |content: &mut String, a: DVec2, b: DVec2| {
        path(content, &Stroke { points: vec![a, b], closed: false })
    };
    line(content, low, low + DVec2::new(BAR, 0.0));
    for tick in 0..=10 {
        let at = low + DVec2::new(BAR / 10.0 * f64::from(tick), 0.0);
        line(content, at, at + DVec2::new(0.0, if tick % 5 == 0 { 3.0 } else { 1.5 }));
    }
    write_words(content, &format!("{BAR} MM"), low + DVec2::new(BAR + 2.0, 0.0), 2.5)
}

fn write_words(
    content: &mut String,
    words: &str,
    at: DVec2,
    height: f64,
) -> Result<(), SheetError> {
    for points in lettering(words, height)?.strokes {
        path(
            content,
            &Stroke { points: points.into_iter().map(|p| p + at).collect(), closed: false },
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_cover_the_sheet_with_the_fewest_pages() {
        let tiling = Tiling::of(DVec2::new(600.0, 400.0), Paper::A4);
        // Upright 190 × 267: 4 × 2; across 277 × 180: 3 × 3.
        assert_eq!((tiling.counts, tiling.window), ([4, 2], DVec2::new(190.0, 267.0)));
        let one = Tiling::of(DVec2::new(277.0, 180.0), Paper::A4);
        assert_eq!((one.counts, one.paper), ([1, 1], DVec2::new(297.0, 210.0)));
        for paper in [Paper::A4, Paper::A3, Paper::Letter] {
            let sheet = DVec2::new(1220.0, 2440.0);
            let tiling = Tiling::of(sheet, paper);
            assert_eq!(tiling.low(0, sheet).x, 0.0);
            let last = tiling.low(tiling.pages() - 1, sheet);
            assert!(last.y <= 0.0 && last.x + tiling.window.x >= sheet.x);
        }
    }

    #[test]
    fn a_line_past_a_corner_is_not_in_the_box() {
        let at =
            |a: (f64, f64), b: (f64, f64)| meets_box(a.into(), b.into(), DVec2::ZERO, DVec2::ONE);
        assert!(at((-1.0, 0.5), (2.0, 0.5)) && at((0.2, 0.2), (0.3, 0.3)));
        assert!(!at((-1.0, 0.5), (0.5, 2.1)) && !at((2.0, 0.0), (2.0, 1.0)));
    }
}
