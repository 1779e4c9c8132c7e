//! Cuts from edge to edge, as glass is cut: every box lies in the corner of a free rectangle, whose
//! rest is divided by one cut into two free rectangles.
//!
//! Source: Jylänki 2010, "A Thousand Ways to Pack the Bin", GUILLOTINE. Several orders and rules,
//! then shuffled orders; the layout with the least area of sheets wins.

use glam::DVec2;

use super::super::stock::Stock;
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
    /// The rectangle of glass that holds it, bounded by the cuts so far and the edges of the sheet.
    glass: Glass,
}

#[derive(Debug, Clone, Copy)]
struct Glass {
    low: DVec2,
    high: DVec2,
}

/// The direction of a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cut {
    Upright,
    Level,
}

impl Glass {
    /// Cuts it through, and gives the cut with the part before and the part behind; `None` where
    /// there is an edge already.
    fn cut(self, cut: Cut, at: DVec2, rounding: f64) -> Option<([DVec2; 2], [Self; 2])> {
        let along = |p: DVec2| if cut == Cut::Upright { p.x } else { p.y };
        if along(at) <= along(self.low) + rounding || along(at) >= along(self.high) - rounding {
            return None;
        }
        let moved = |p: DVec2| match cut {
            Cut::Upright => DVec2::new(at.x, p.y),
            Cut::Level => DVec2::new(p.x, at.y),
        };
        let before = Self { high: moved(self.high), ..self };
        let behind = Self { low: moved(self.low), ..self };
        Some(([behind.low, before.high], [before, behind]))
    }
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
            let (cuts, glass) = trimmed(stock);
            let free = vec![Free { low, high, glass }];
            open.push(Sheet { bin, is_untouched: true, free, cuts });
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

/// The cuts that take the margin off on the left and below, and the glass that is left; on the
/// other sides the last cuts do it.
fn trimmed(stock: &Stock) -> (Vec<[DVec2; 2]>, Glass) {
    let at = DVec2::splat(stock.margin - stock.spacing / 2.0);
    let mut glass = Glass { low: DVec2::ZERO, high: stock.size };
    let mut cuts = Vec::new();
    for direction in [Cut::Upright, Cut::Level] {
        if let Some((cut, [_, behind])) = glass.cut(direction, at, stock.rounding()) {
            cuts.push(cut);
            glass = behind;
        }
    }
    (cuts, glass)
}

/// Cuts a box out of the lower left corner of a free rectangle. Cuts run in the middle of the
/// spacing.
fn divide(sheet: &mut Sheet, rect: Free, size: DVec2, split: Split, stock: &Stock) {
    let corner = (rect.low + size).min(rect.high);
    let rest = (rect.high - corner).max(DVec2::ZERO);
    let is_upright = match split {
        Split::Upright => true,
        Split::Level => false,
        Split::Larger => rest.x * (rect.high.y - rect.low.y) >= rest.y * (rect.high.x - rect.low.x),
    };
    let order = if is_upright { [Cut::Upright, Cut::Level] } else { [Cut::Level, Cut::Upright] };
    let at = corner - DVec2::splat(stock.spacing / 2.0);
    let (mut left, mut rests) = (rect, Vec::new());
    for direction in order {
        // Where the box reaches an edge of its glass there is no rest either.
        let Some((cut, [before, behind])) = left.glass.cut(direction, at, stock.rounding()) else {
            continue;
        };
        sheet.cuts.push(cut);
        let (low, high) = match direction {
            Cut::Upright => (DVec2::new(corner.x, left.low.y), DVec2::new(corner.x, left.high.y)),
            Cut::Level => (DVec2::new(left.low.x, corner.y), DVec2::new(left.high.x, corner.y)),
        };
        rests.push((direction, Free { low, high: left.high, glass: behind }));
        left = Free { low: left.low, high, glass: before };
    }
    // What lies to the right comes first, whichever cut was made first.
    rests.sort_by_key(|&(direction, _)| direction == Cut::Level);
    let least = DVec2::splat(stock.rounding());
    let is_room = |f: &Free| (f.high - f.low).cmpgt(least).all();
    sheet.free.extend(rests.into_iter().map(|(_, rest)| rest).filter(is_room));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;
    use proptest::prelude::*;

    /// Carries the cuts out: each must divide one part of the glass from edge to edge.
    fn parts_of(size: DVec2, cuts: &[[DVec2; 2]]) -> Result<Vec<Glass>, String> {
        let mut parts = vec![Glass { low: DVec2::ZERO, high: size }];
        for &[a, b] in cuts {
            let direction = if a.x == b.x { Cut::Upright } else { Cut::Level };
            let divided = parts.iter().position(|part| {
                let ends = part.cut(direction, a, 1e-6).map(|(cut, _)| cut);
                ends.is_some_and(|[p, q]| p.distance(a) < 1e-6 && q.distance(b) < 1e-6)
            });
            let i = divided.ok_or_else(|| format!("{a} to {b} divides no part"))?;
            let (_, halves) = parts.swap_remove(i).cut(direction, a, 1e-6).expect("just tried");
            parts.extend(halves);
        }
        Ok(parts)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn every_cut_divides_one_part_of_the_glass(
            // Few sizes, so that boxes often fill a rectangle, and some that nearly do.
            sizes in prop::collection::vec((1..6_u32, 1..6_u32, 0..3_u32), 1..40),
            margin in prop::sample::select(vec![0.0, 1.0, 1.5, 2.0, 10.0]),
            split in prop::sample::select(SPLITS.to_vec()),
        ) {
            let stock = Stock { size: DVec2::new(300.0, 200.0), margin, spacing: 3.0 };
            let boxes: Vec<Boxed> = sizes.iter().map(|&(w, h, off)| {
                let side = |n: u32| f64::from(n) * 20.0 + f64::from(off) * 0.7 + 3.0;
                let size = DVec2::new(side(w), side(h));
                Boxed { ways: vec![(0.0, size), (90.0, DVec2::new(size.y, size.x))] }
            }).collect();
            let sheet = StockSheet { stock, outline: Vec::new(), defects: Vec::new() };
            let order: Vec<usize> = (0..boxes.len()).collect();
            let (places, cuts) = pack(&boxes, &order, &[sheet], split).expect("all fit");
            for (bin, cuts) in cuts.iter().enumerate() {
                let parts = parts_of(stock.size, cuts).map_err(TestCaseError::fail)?;
                // Every box comes out, alone and whole.
                for (place, b) in places.iter().zip(&boxes).filter(|(p, _)| p.bin == bin) {
                    let high = place.low + size_of(b, place.angle) - DVec2::splat(stock.spacing);
                    let middle = place.low.midpoint(high);
                    let holds = |part: &&Glass| middle.cmpgt(part.low).all() && middle.cmplt(part.high).all();
                    let part = parts.iter().find(holds).expect("the parts cover the glass");
                    prop_assert!(place.low.cmpge(part.low - 1e-6).all() && high.cmple(part.high + 1e-6).all());
                    prop_assert!(((part.high - part.low) - (high - place.low)).cmple(DVec2::splat(2.0 * margin + 6.0)).all());
                }
            }
        }
    }

    #[test]
    fn boxes_that_fill_a_sheet_share_their_cuts() {
        // Six squares of 100 mm with 2 mm between them fill the room inside the margin.
        let stock = Stock { size: DVec2::new(324.0, 222.0), margin: 10.0, spacing: 2.0 };
        let boxes = vec![Boxed { ways: vec![(0.0, DVec2::splat(102.0))] }; 6];
        let sheet = StockSheet { stock, outline: Vec::new(), defects: Vec::new() };
        let effort = Effort { seed: 0, work: 0 };
        let (places, cuts) = guillotine(&boxes, &[sheet], effort, &Silent).expect("all fit");
        assert!(places.iter().all(|p| p.bin == 0));
        // The margin on four sides, two lines between columns or one between rows, and the others
        // once for each row or column.
        let parts = parts_of(stock.size, &cuts[0]).expect("each cut divides a part");
        assert_eq!(parts.len(), cuts[0].len() + 1);
        assert!(cuts[0].len() <= 13, "{}", cuts[0].len());
    }
}
