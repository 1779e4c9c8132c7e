//! Cuts from edge to edge, as glass is cut: every box lies in the corner of a free rectangle, whose
//! rest is divided by one cut into two free rectangles.
//!
//! Source: Jylänki 2010, "A Thousand Ways to Pack the Bin", GUILLOTINE. Several orders and rules,
//! then shuffled orders; the layout with the least area of sheets wins.

use glam::DVec2;

use super::super::params::Stock;
use super::stock::StockSheet;
use super::{Axis, Effort, NoPlace};
use crate::progress::Progress;
use crate::random::Rng;

/// A piece as the boxes around it: for every angle, its size with the spacing on its upper and
/// right side.
#[derive(Debug, Clone)]
pub(super) struct Boxed {
    pub ways: Vec<(f64, DVec2)>,
}

/// Where a box lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub bin: usize,
    pub angle: f64,
    pub low: DVec2,
}

#[derive(Debug, Clone, Copy)]
struct Free {
    low: DVec2,
    high: DVec2,
}

/// Which side of the rest is cut through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Split {
    /// The rest to the right is as high as the free rectangle.
    Upright,
    /// The rest above is as wide as the free rectangle.
    Level,
    /// Whichever leaves the larger rectangle.
    Larger,
}

const SPLITS: [Split; 3] = [Split::Larger, Split::Upright, Split::Level];

struct Sheet {
    bin: usize,
    is_untouched: bool,
    free: Vec<Free>,
    cuts: Vec<[DVec2; 2]>,
}

type Packed = (Vec<Place>, Vec<Vec<[DVec2; 2]>>);

/// Lays all boxes; the cuts of every sheet come in the order in which they are made.
pub(super) fn guillotine(
    boxes: &[Boxed],
    sheets: &[StockSheet],
    effort: Effort,
    progress: &dyn Progress,
) -> Result<Packed, NoPlace> {
    let mut rng = Rng::new(effort.seed);
    let key = |b: &Boxed, by: usize| {
        let size = b.ways.first().map_or(DVec2::ZERO, |w| w.1);
        [size.x * size.y, size.max_element(), size.x + size.y][by]
    };
    let mut best: Option<(f64, Packed)> = None;
    // A round of small work each; nine rounds are made whatever the effort is.
    let each = (boxes.len() as u64).pow(2).max(100);
    let rounds = 9 + (effort.work / each).min(2000);
    for round in 0..rounds {
        if round >= 1 && progress.is_cancelled() {
            break;
        }
        progress.report("nesting: guillotine layouts", round as usize, rounds as usize);
        let by = (round % 3) as usize;
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        let keys: Vec<f64> = boxes
            .iter()
            .map(|b| key(b, by) * if round < 9 { 1.0 } else { rng.between(0.7, 1.3) })
            .collect();
        order.sort_by(|&a, &b| keys[b].total_cmp(&keys[a]).then(a.cmp(&b)));
        let packed = pack(boxes, &order, sheets, SPLITS[(round / 3 % 3) as usize])?;
        let cost = cost(&packed.0, boxes, sheets);
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, packed));
        }
    }
    Ok(best.map(|b| b.1).unwrap_or_default())
}

fn sheet_of(sheets: &[StockSheet], bin: usize) -> &StockSheet {
    &sheets[bin.min(sheets.len() - 1)]
}

fn size_of(b: &Boxed, angle: f64) -> DVec2 {
    b.ways.iter().find(|w| w.0 == angle).map_or(DVec2::ZERO, |w| w.1)
}

/// The area of the sheets, of the last one only what is used.
fn cost(places: &[Place], boxes: &[Boxed], sheets: &[StockSheet]) -> f64 {
    let last = places.iter().map(|p| p.bin).max().unwrap_or(0);
    let area = |bin: usize| sheet_of(sheets, bin).stock.size.x * sheet_of(sheets, bin).stock.size.y;
    let mut bins: Vec<usize> = places.iter().map(|p| p.bin).filter(|&b| b < last).collect();
    bins.sort_unstable();
    bins.dedup();
    let size = sheet_of(sheets, last).stock.size;
    let axis = if size.x >= size.y { Axis::X } else { Axis::Y };
    let here = places.iter().zip(boxes).filter(|(p, _)| p.bin == last);
    let used = here.map(|(p, b)| axis.of(p.low + size_of(b, p.angle))).fold(0.0, f64::max);
    bins.into_iter().map(area).sum::<f64>() + area(last) * used / axis.of(size)
}

fn pack(
    boxes: &[Boxed],
    order: &[usize],
    sheets: &[StockSheet],
    split: Split,
) -> Result<Packed, NoPlace> {
    let mut open: Vec<Sheet> = Vec::new();
    let mut places = vec![Place { bin: 0, angle: 0.0, low: DVec2::ZERO }; boxes.len()];
    for &i in order {
        let place = loop {
            if let Some(place) = best_place(&open, &boxes[i]) {
                break place;
            }
            let bin = open.len();
            // Beyond the stock there are only sheets of the last kind; when one of them is too
            // small, all are.
            if bin > sheets.len() && open.last().is_some_and(|s| s.is_untouched) {
                return Err(NoPlace { pieces: vec![i] });
            }
            let stock = &sheet_of(sheets, bin).stock;
            // Boxes are laid with the spacing on their upper and right side, so the room has it
            // there, too. What fits exactly may be larger by rounding.
            let reserve = stock.spacing + stock.rounding();
            let (low, high) =
                (DVec2::splat(stock.margin), stock.size - DVec2::splat(stock.margin - reserve));
            open.push(Sheet {
                bin,
                is_untouched: true,
                free: vec![Free { low, high }],
                cuts: trimming(stock),
            });
        };
        let (sheet, free, angle) = place;
        let stock = &sheet_of(sheets, open[sheet].bin).stock;
        let size = size_of(&boxes[i], angle);
        open[sheet].is_untouched = false;
        let rect = open[sheet].free.swap_remove(free);
        places[i] = Place { bin: open[sheet].bin, angle, low: rect.low };
        divide(&mut open[sheet], rect, size, split, stock);
    }
    Ok((places, open.into_iter().map(|s| s.cuts).collect()))
}

/// The sheet, the free rectangle on it and the angle that leave the narrowest strip.
fn best_place(open: &[Sheet], b: &Boxed) -> Option<(usize, usize, f64)> {
    let (mut least, mut best) = ((f64::INFINITY, f64::INFINITY), None);
    for (s, sheet) in open.iter().enumerate() {
        for (f, free) in sheet.free.iter().enumerate() {
            for &(angle, size) in &b.ways {
                let rest = free.high - free.low - size;
                let score = (rest.min_element(), rest.max_element());
                if rest.min_element() >= 0.0 && score < least {
                    (least, best) = (score, Some((s, f, angle)));
                }
            }
        }
        // A sheet that holds it is better than any later one.
        if best.is_some() {
            break;
        }
    }
    best
}

/// The cuts that take the margin off on the left and below; on the other sides the last cuts do it.
fn trimming(stock: &Stock) -> Vec<[DVec2; 2]> {
    let at = stock.margin - stock.spacing / 2.0;
    if at <= 0.0 {
        return Vec::new();
    }
    let left = [DVec2::new(at, 0.0), DVec2::new(at, stock.size.y)];
    vec![left, [DVec2::new(at, at), DVec2::new(stock.size.x, at)]]
}

/// Cuts a box out of the lower left corner of a free rectangle. Cuts run in the middle of the
/// spacing.
fn divide(sheet: &mut Sheet, rect: Free, size: DVec2, split: Split, stock: &Stock) {
    let half = stock.spacing / 2.0;
    let corner = (rect.low + size).min(rect.high);
    let rest = (rect.high - corner).max(DVec2::ZERO);
    let upright = match split {
        Split::Upright => true,
        Split::Level => false,
        Split::Larger => rest.x * (rect.high.y - rect.low.y) >= rest.y * (rect.high.x - rect.low.x),
    };
    // Rectangles that reach the margin reach the edge of the glass.
    let last = stock.size - DVec2::splat(stock.margin + half);
    let end = |p: DVec2| DVec2::select(p.cmpge(last), stock.size, p);
    let (low, at, high) =
        ((rect.low - half).max(DVec2::ZERO), corner - half, end(rect.high - half));
    let (x, y) = ((at.x < stock.size.x).then_some(at.x), (at.y < stock.size.y).then_some(at.y));
    let upright_to = |top: f64| x.map(|x| [DVec2::new(x, low.y), DVec2::new(x, top)]);
    let level_to = |right: f64| y.map(|y| [DVec2::new(low.x, y), DVec2::new(right, y)]);
    let right = Free { low: DVec2::new(corner.x, rect.low.y), high: rect.high };
    let above = Free { low: DVec2::new(rect.low.x, corner.y), high: rect.high };
    let (cuts, rests) = if upright {
        let above = Free { high: DVec2::new(corner.x, rect.high.y), ..above };
        ([upright_to(high.y), level_to(at.x.min(high.x))], [right, above])
    } else {
        let right = Free { high: DVec2::new(rect.high.x, corner.y), ..right };
        ([level_to(high.x), upright_to(at.y.min(high.y))], [right, above])
    };
    sheet.cuts.extend(cuts.into_iter().flatten());
    sheet.free.extend(rests.into_iter().filter(|f| (f.high - f.low).cmpgt(DVec2::ZERO).all()));
}
