//! What stands on the info layer, which is never cut: the outline of the sheet and its defects, the
//! cuts from edge to edge, the offcut, a reference to measure, a legend, and marks for plotters.
//!
//! Nothing of it lies on a part. What finds no place beside the parts goes into the margin, and
//! what has no room there either is left out and counted.

mod free;
mod legend;
mod registration;

use std::collections::BTreeMap;

use glam::DVec2;

use self::free::{FreeSpace, Rectangle};
use self::legend::{Line, lines};
use super::drawing::{Drawing, LayerKind, MarkKind, Stroke};
use super::error::SheetError;
use super::files::Reference;
use super::kerf::CutShape;
use super::layout::{Layout, Sheet, SheetReport};
use super::letter::{plain_lettering, sheet_letter};
use super::nest::StockSheet;
use super::params::SheetParams;
use super::verify::edges;
use crate::geom::polygon::{Location, bounds, locate, segments_meet};
use crate::net::{Net, PieceId};

pub(super) use self::legend::lettered;

/// Sides of the reference square that are tried, in mm.
const REFERENCE_SIDES: [f64; 4] = [100.0, 50.0, 20.0, 10.0];

/// Least height of letters beside the parts, in mm.
const LEAST_LETTER: f64 = 1.5;
/// The same in a margin.
const LEAST_IN_MARGIN: f64 = 1.0;

/// From one line of the legend to the next, in heights of its letters.
const PITCH: f64 = 1.8;

/// How much of a margin's width its letters take.
const SHARE_OF_MARGIN: f64 = 0.5;

/// Draws the info layer of every sheet, and counts what had no room.
pub(super) fn draw_info(
    drawings: &mut [Drawing],
    (net, shapes): (&Net, &[CutShape]),
    (layout, stock): (&Layout, &[StockSheet]),
    params: &SheetParams,
    report: &mut SheetReport,
) -> Result<(), SheetError> {
    let shows_outside = !net.folds.is_empty() || !net.seams.is_empty();
    let about = (drawings.len(), shows_outside);
    let by_id: BTreeMap<PieceId, &CutShape> = shapes.iter().map(|s| (s.piece, s)).collect();
    for (drawing, sheet) in drawings.iter_mut().zip(&layout.sheets) {
        let lying = sheet.placed.iter().filter_map(|p| by_id.get(&p.piece).copied());
        let free = FreeSpace::new(sheet, lying, &stock[sheet.stock]);
        let mut page = Page {
            drawing,
            free,
            margin: params.stock.margin.mm(),
            clear: (params.stock.spacing.mm() / 2.0).min(2.0),
            letter: sheet_letter(DVec2::new(sheet.width, sheet.height)),
        };
        if params.style().prints_info() {
            let is_whole = stock[sheet.stock].outline.is_empty();
            report.sheets_without_marks += usize::from(!(is_whole && page.registration()));
        }
        page.sheet_lines(sheet, &stock[sheet.stock], report)?;
        if params.files.reference == Reference::On {
            report.sheets_without_reference += usize::from(!page.reference()?);
        }
        let words = lines(page.drawing, params, about);
        report.sheets_without_legend += usize::from(!page.legend(&words)?);
    }
    Ok(())
}

/// Measures once more, by plain geometry, that no line of the info layer touches a part; those of the
/// sheet itself, which parts may lie on, are measured with the layout.
///
/// # Errors
/// [`SheetError::InfoOnPart`] for the first that does.
pub(super) fn verify_info(
    drawings: &[Drawing],
    shapes: &[CutShape],
    layout: &Layout,
) -> Result<(), SheetError> {
    let by_id: BTreeMap<PieceId, &CutShape> = shapes.iter().map(|s| (s.piece, s)).collect();
    for (drawing, sheet) in drawings.iter().zip(&layout.sheets) {
        let info = drawing.layers.iter().filter(|l| l.kind == LayerKind::Info);
        let lines: Vec<(&str, DVec2, DVec2)> = info
            .flat_map(|l| &l.marks)
            .filter(|m| !is_of_stock(&m.id))
            .flat_map(|m| m.strokes.iter().map(move |s| (m.id.as_str(), s)))
            .flat_map(|(id, s)| {
                let count = s.points.len() - usize::from(!s.closed && !s.points.is_empty());
                edges(&s.points).take(count).map(move |(a, b)| (id, a, b))
            })
            .collect();
        for placed in &sheet.placed {
            let Some(shape) = by_id.get(&placed.piece) else { continue };
            let outline = placed.apply_all(&shape.outline);
            let Some((low, high)) = bounds(&outline) else { continue };
            let touches = |&&(_, a, b): &&(&str, DVec2, DVec2)| {
                let is_near = a.max(b).cmpge(low).all() && a.min(b).cmple(high).all();
                is_near
                    && (locate(&outline, a) == Location::Inside
                        || edges(&outline).any(|(p, q)| segments_meet(a, b, p, q)))
            };
            if let Some(&(id, ..)) = lines.iter().find(touches) {
                let (mark, piece) = (id.to_owned(), placed.piece);
                return Err(SheetError::InfoOnPart { mark, piece, sheet: sheet.id });
            }
        }
    }
    Ok(())
}

/// Whether a mark shows what the stock is like or where it is cut from edge to edge.
fn is_of_stock(id: &str) -> bool {
    let is_line = |name: &str| {
        let rest = id.strip_prefix(name);
        rest.is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit()))
    };
    id == "sheet-outline" || is_line("guillotine-") || is_line("defect-")
}

/// One sheet whose info layer is being drawn.
struct Page<'a> {
    drawing: &'a mut Drawing,
    free: FreeSpace<'a>,
    margin: f64,
    /// What is kept free around parts, in mm.
    clear: f64,
    /// Height of letters that suits the sheet.
    letter: f64,
}

impl Page<'_> {
    /// What the sheet itself is like: its outline, its defects, the cuts from edge to edge in their
    /// order, and where the offcut begins.
    fn sheet_lines(
        &mut self,
        sheet: &Sheet,
        stock: &StockSheet,
        report: &mut SheetReport,
    ) -> Result<(), SheetError> {
        if !stock.outline.is_empty() {
            self.note("sheet-outline", vec![closed(stock.outline.clone())]);
        }
        for (i, defect) in stock.defects.iter().enumerate() {
            self.note(&format!("defect-{}", i + 1), vec![closed(defect.clone())]);
        }
        let mut named: Vec<(String, String, [DVec2; 2])> = Vec::new();
        for (i, &cut) in sheet.cuts.iter().enumerate() {
            named.push((format!("guillotine-{}", i + 1), format!("CUT {}", i + 1), cut));
        }
        if let Some([low, high]) = sheet.offcut {
            let edge =
                if low.x > 0.0 { DVec2::new(low.x, high.y) } else { DVec2::new(high.x, low.y) };
            let [width, height] = (high - low).to_array().map(|mm| (mm * 10.0).round() / 10.0);
            let words = format!("OFFCUT {width} X {height}");
            named.push(("offcut".to_owned(), words, [low, edge]));
            self.free.take_line([low, edge]);
        }
        for (id, words, line) in &named {
            let stroke = Stroke { points: line.to_vec(), closed: false };
            self.note(id, vec![stroke]);
            if !self.line_label(id, words, *line)? {
                report.unlabelled_lines += 1;
            }
        }
        Ok(())
    }

    /// Marks by which a plotter finds the printed sheet; whether they fit.
    fn registration(&mut self) -> bool {
        let size = DVec2::new(self.drawing.width, self.drawing.height);
        let marks = registration::marks(size, self.margin);
        for (i, (strokes, place)) in marks.iter().enumerate() {
            self.note(&format!("registration-{}", i + 1), strokes.clone());
            self.free.take(*place);
        }
        !marks.is_empty()
    }

    /// Writes beside a line, as near to its beginning as there is room.
    fn line_label(
        &mut self,
        id: &str,
        words: &str,
        [a, b]: [DVec2; 2],
    ) -> Result<bool, SheetError> {
        const STEPS: usize = 40;
        let largest = self.letter;
        let in_margin = SHARE_OF_MARGIN * self.margin;
        let heights = [largest, 0.7 * largest, 0.5 * largest, in_margin.min(0.5 * largest)];
        let sideways = (b - a).normalize_or_zero().perp();
        for height in heights.into_iter().filter(|&h| h >= LEAST_LETTER.min(0.5 * largest)) {
            let text = plain_lettering(words, height)?;
            let half = (text.high - text.low) / 2.0;
            let reach = half.dot(sideways.abs()) + 0.3 * height;
            for step in 0..=STEPS {
                let along = a.lerp(b, step as f64 / STEPS as f64);
                for side in [1.0, -1.0] {
                    let middle = along + side * reach * sideways;
                    let place = [middle - half, middle + half];
                    if self.free.is_free(place, 0.2 * height) {
                        self.write(&format!("{id}-label"), words, height, place)?;
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// A square to measure, beside the parts; where there is no room for one, a bar in the margin.
    fn reference(&mut self) -> Result<bool, SheetError> {
        let border = self.margin / 2.0;
        for side in REFERENCE_SIDES {
            let size = DVec2::splat(side);
            let Some([low, high]) = self.free.place(size, border, self.clear) else { continue };
            let words = format!("{side} MM");
            let height = (side / 20.0).max(LEAST_LETTER);
            let text = plain_lettering(&words, height)?;
            let mut strokes = vec![rectangle([low, high])];
            strokes.extend(moved(text.strokes, low + DVec2::splat(side / 20.0)));
            self.drawing.add(MarkKind::Reference, "reference".to_owned(), None, strokes);
            self.free.take([low, high]);
            return Ok(true);
        }
        self.reference_bar()
    }

    /// A bar of known length in the upper or lower margin, with its length behind it.
    fn reference_bar(&mut self) -> Result<bool, SheetError> {
        let (depth, height) = (0.4 * self.margin, SHARE_OF_MARGIN * self.margin);
        if height < LEAST_IN_MARGIN {
            return Ok(false);
        }
        let size = DVec2::new(self.drawing.width, self.drawing.height);
        for length in REFERENCE_SIDES {
            let text = plain_lettering(&format!("{length} MM"), height)?;
            let whole = length + 0.5 * self.margin + text.high.x;
            let right = size.x - self.margin - whole;
            for y in [size.y - 0.5 * self.margin, 0.5 * self.margin] {
                let low = DVec2::new(right, y - 0.5 * depth);
                let bar = [low, low + DVec2::new(length, depth)];
                let letters = DVec2::new(bar[1].x + 0.5 * self.margin, y - 0.5 * height);
                let all = [low.min(letters), DVec2::new(right + whole, y + 0.5 * height)];
                if right >= 0.0 && self.free.is_free(all, 0.0) {
                    let mut strokes = vec![rectangle(bar)];
                    strokes.extend(moved(text.strokes, letters));
                    self.drawing.add(MarkKind::Reference, "reference".to_owned(), None, strokes);
                    self.free.take(all);
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// The legend as a block beside the parts, or in the margins.
    fn legend(&mut self, lines: &[Line]) -> Result<bool, SheetError> {
        for share in [1.0, 0.75, 0.5] {
            let height = share * self.letter;
            let sizes = lines.iter().map(|l| Ok(plain_lettering(&l.words, height)?.high.x));
            let widths = sizes.collect::<Result<Vec<f64>, SheetError>>()?;
            let width = widths.into_iter().fold(0.0, f64::max);
            let size = DVec2::new(width, PITCH * height * lines.len() as f64);
            let border = self.margin.max(0.5 * height);
            if height < LEAST_LETTER {
                break;
            }
            if let Some([low, high]) = self.free.place(size, border, self.clear.max(height)) {
                for (i, line) in lines.iter().enumerate() {
                    let y = high.y - (i as f64 + 1.0) * PITCH * height + 0.4 * height;
                    self.legend_line(i, line, height, DVec2::new(low.x, y))?;
                }
                self.free.take([low, high]);
                return Ok(true);
            }
        }
        self.legend_in_margin(lines)
    }

    /// The lines of the legend one after the other in the lower and the upper margin.
    fn legend_in_margin(&mut self, lines: &[Line]) -> Result<bool, SheetError> {
        let height = (SHARE_OF_MARGIN * self.margin).min(self.letter);
        if height < LEAST_IN_MARGIN {
            return Ok(false);
        }
        let [width, top] = [self.drawing.width, self.drawing.height];
        let rows = [0.5 * self.margin, top - 0.5 * self.margin];
        let mut next = [self.margin; 2];
        let mut is_whole = true;
        for (i, line) in lines.iter().enumerate() {
            let text = plain_lettering(&line.words, height)?;
            let fits = |&row: &usize| {
                let low = DVec2::new(next[row], rows[row] - 0.5 * height + text.low.y);
                let high = DVec2::new(next[row] + text.high.x, rows[row] + 0.5 * height);
                high.x <= width - self.margin && self.free.is_free([low, high], 0.0)
            };
            match [0, 1].iter().find(|row| fits(row)) {
                Some(&row) => {
                    let at = DVec2::new(next[row], rows[row] - 0.5 * height);
                    self.legend_line(i, line, height, at)?;
                    next[row] += text.high.x + 3.0 * height;
                }
                None => is_whole = false,
            }
        }
        Ok(is_whole)
    }

    fn legend_line(
        &mut self,
        i: usize,
        line: &Line,
        height: f64,
        at: DVec2,
    ) -> Result<(), SheetError> {
        let what = if line.is_of_colours { "legend-colours" } else { "legend" };
        let strokes = moved(plain_lettering(&line.words, height)?.strokes, at).collect();
        self.note(&format!("{what}-{}", i + 1), strokes);
        Ok(())
    }

    fn write(
        &mut self,
        id: &str,
        words: &str,
        height: f64,
        place: Rectangle,
    ) -> Result<(), SheetError> {
        let text = plain_lettering(words, height)?;
        let strokes = moved(text.strokes, place[0] - text.low).collect();
        self.note(id, strokes);
        self.free.take(place);
        Ok(())
    }

    fn note(&mut self, id: &str, strokes: Vec<Stroke>) {
        self.drawing.add(MarkKind::Note, id.to_owned(), None, strokes);
    }
}

fn closed(points: Vec<DVec2>) -> Stroke {
    Stroke { points, closed: true }
}

fn rectangle([low, high]: Rectangle) -> Stroke {
    closed(vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)])
}

pub(super) fn moved(strokes: Vec<Vec<DVec2>>, by: DVec2) -> impl Iterator<Item = Stroke> {
    let stroke = move |points: Vec<DVec2>| Stroke {
        points: points.into_iter().map(|p| p + by).collect(),
        closed: false,
    };
    strokes.into_iter().map(stroke)
}
