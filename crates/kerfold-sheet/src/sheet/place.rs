//! Placing boxes on sheets: maximal rectangles, several orders and rules tried, the best taken.
//!
//! Source: Jylänki 2010, "A Thousand Ways to Pack the Bin", MAXRECTS. Every run is deterministic;
//! ties go to the lower sheet, then the lower and left place, then the unturned box.

use glam::DVec2;

/// A box to place, spacing included: its size upright and a quarter turned; nothing where it would
/// not fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Item {
    pub upright: Option<DVec2>,
    pub turned: Option<DVec2>,
}

/// Where a box came to lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    pub bin: usize,
    pub low: DVec2,
    pub turned: bool,
}

#[derive(Debug, Clone, Copy)]
struct Rect {
    low: DVec2,
    high: DVec2,
}

impl Rect {
    fn size(&self) -> DVec2 {
        self.high - self.low
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.low.cmplt(other.high).all() && other.low.cmplt(self.high).all()
    }

    fn contains(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && other.high.cmple(self.high).all()
    }
}

/// Which free place is the best for a box.
#[derive(Debug, Clone, Copy)]
enum Rule {
    /// The one that leaves the narrowest strip.
    ShortSide,
    /// The one with the least area.
    Area,
    /// The lowest, then the leftmost.
    BottomLeft,
}

const RULES: [Rule; 3] = [Rule::ShortSide, Rule::Area, Rule::BottomLeft];

/// What the boxes are sorted by, largest first.
const ORDERS: [fn(DVec2) -> f64; 3] = [|s| s.x * s.y, |s| s.max_element(), |s| s.x + s.y];

/// Places every item in a room of the given size, as often as rooms are needed; one spot per item.
/// At least one way of every item must fit.
pub(crate) fn pack(items: &[Item], room: DVec2) -> Vec<Spot> {
    let sizes: Vec<DVec2> =
        items.iter().map(|i| i.upright.or(i.turned).unwrap_or_default()).collect();
    let mut best: Option<((usize, f64), Vec<Spot>)> = None;
    for key in ORDERS {
        let mut order: Vec<usize> = (0..items.len()).collect();
        order.sort_by(|&a, &b| key(sizes[b]).total_cmp(&key(sizes[a])).then(a.cmp(&b)));
        for (rule, may_turn) in RULES.into_iter().flat_map(|r| [(r, true), (r, false)]) {
            let spots = run(items, &order, rule, may_turn, room);
            let cost = cost(&spots, &sizes);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, spots));
            }
        }
    }
    best.map(|(_, spots)| spots).unwrap_or_default()
}

/// Places every item in rows, the highest first, without looking back: next-fit shelves by falling
/// height (Coffman, Garey, Johnson and Tarjan 1980). For tens of thousands of items, where [`pack`]
/// would take minutes. At least one way of every item must fit.
pub(crate) fn pack_rows(items: &[Item], room: DVec2) -> Vec<Spot> {
    // Lying, so that rows are low; upright where only that fits.
    let way = |item: &Item| match (item.upright, item.turned) {
        (Some(a), Some(b)) if b.y < a.y => (b, true),
        (Some(a), _) => (a, false),
        (None, b) => (b.unwrap_or_default(), true),
    };
    let ways: Vec<(DVec2, bool)> = items.iter().map(way).collect();
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by(|&a, &b| ways[b].0.y.total_cmp(&ways[a].0.y).then(a.cmp(&b)));
    let mut spots = vec![Spot { bin: 0, low: DVec2::ZERO, turned: false }; items.len()];
    let (mut bin, mut at, mut above) = (0, DVec2::ZERO, 0.0);
    for i in order {
        let (size, turned) = ways[i];
        if at.x > 0.0 && at.x + size.x > room.x {
            at = DVec2::new(0.0, above);
        }
        if at.y > 0.0 && at.y + size.y > room.y {
            (bin, at) = (bin + 1, DVec2::ZERO);
        }
        spots[i] = Spot { bin, low: at, turned };
        // Rows become lower: the first item of a row is its highest.
        above = if at.x == 0.0 { at.y + size.y } else { above };
        at.x += size.x;
    }
    spots
}

/// Number of sheets, then the area on the last one.
fn cost(spots: &[Spot], sizes: &[DVec2]) -> (usize, f64) {
    let bins = spots.iter().map(|s| s.bin + 1).max().unwrap_or(0);
    let last = spots.iter().zip(sizes).filter(|(s, _)| s.bin + 1 == bins);
    (bins, last.map(|(_, size)| size.x * size.y).sum())
}

fn run(items: &[Item], order: &[usize], rule: Rule, may_turn: bool, room: DVec2) -> Vec<Spot> {
    let whole = Rect { low: DVec2::ZERO, high: room };
    let mut bins: Vec<Vec<Rect>> = Vec::new();
    let mut spots = vec![Spot { bin: 0, low: DVec2::ZERO, turned: false }; items.len()];
    for &i in order {
        let item = Item {
            turned: items[i].turned.filter(|_| may_turn || items[i].upright.is_none()),
            ..items[i]
        };
        let Spot { bin, low, turned } = best_place(&bins, &item, rule).unwrap_or_else(|| {
            bins.push(vec![whole]);
            Spot { bin: bins.len() - 1, low: DVec2::ZERO, turned: item.upright.is_none() }
        });
        let size =
            if turned { item.turned } else { item.upright }.expect("one way of every item fits");
        occupy(&mut bins[bin], Rect { low, high: low + size });
        spots[i] = Spot { bin, low, turned };
    }
    spots
}

fn best_place(bins: &[Vec<Rect>], item: &Item, rule: Rule) -> Option<Spot> {
    let ways = [(item.upright, false), (item.turned, true)];
    let mut best: Option<((f64, f64), Spot)> = None;
    for (bin, free) in bins.iter().enumerate() {
        for rect in free {
            for (size, turned) in ways {
                let Some(size) = size.filter(|s| s.cmple(rect.size()).all()) else { continue };
                let score = score(rect, size, rule);
                if best.is_none_or(|(least, _)| score < least) {
                    best = Some((score, Spot { bin, low: rect.low, turned }));
                }
            }
        }
    }
    best.map(|(_, spot)| spot)
}

fn score(rect: &Rect, size: DVec2, rule: Rule) -> (f64, f64) {
    let rest = rect.size() - size;
    match rule {
        Rule::ShortSide => (rest.min_element(), rest.max_element()),
        Rule::Area => (rect.size().x * rect.size().y - size.x * size.y, rest.min_element()),
        Rule::BottomLeft => (rect.low.y + size.y, rect.low.x),
    }
}

/// Takes a rectangle out of the free ones, which stay maximal.
fn occupy(free: &mut Vec<Rect>, used: Rect) {
    let mut parts = Vec::new();
    free.retain(|rect| {
        let hit = rect.overlaps(&used);
        if hit {
            parts.extend(around(rect, &used));
        }
        !hit
    });
    for (i, part) in parts.iter().enumerate() {
        let in_part = |(j, other): (usize, &Rect)| {
            j != i && other.contains(part) && (j < i || !part.contains(other))
        };
        if !free.iter().any(|f| f.contains(part)) && !parts.iter().enumerate().any(in_part) {
            free.push(*part);
        }
    }
}

/// The up to four maximal rests of a rectangle around another one.
fn around(rect: &Rect, used: &Rect) -> impl Iterator<Item = Rect> {
    let (low, high) = (rect.low, rect.high);
    let rests = [
        Rect { low, high: DVec2::new(used.low.x, high.y) },
        Rect { low: DVec2::new(used.high.x, low.y), high },
        Rect { low, high: DVec2::new(high.x, used.low.y) },
        Rect { low: DVec2::new(low.x, used.high.y), high },
    ];
    rests.into_iter().filter(|r| r.size().cmpgt(DVec2::ZERO).all())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn items(sizes: &[DVec2], room: DVec2) -> Vec<Item> {
        let fit = |s: DVec2| s.cmple(room).all().then_some(s);
        sizes.iter().map(|&s| Item { upright: fit(s), turned: fit(DVec2::new(s.y, s.x)) }).collect()
    }

    #[test]
    fn six_boxes_fill_a_room_without_rest() {
        let sizes = vec![DVec2::new(2.0, 3.0); 6];
        let room = DVec2::new(6.0, 6.0);
        let spots = pack(&items(&sizes, room), room);
        assert!(spots.iter().all(|s| s.bin == 0), "{spots:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn boxes_stay_inside_and_apart(sizes in prop::collection::vec((0.5..60.0_f64, 0.5..40.0_f64), 0..60)) {
            let room = DVec2::new(100.0, 45.0);
            let sizes: Vec<DVec2> = sizes.into_iter().map(DVec2::from).collect();
            for spots in [pack(&items(&sizes, room), room), pack_rows(&items(&sizes, room), room)] {
            let rects: Vec<(usize, Rect)> = spots.iter().zip(&sizes).map(|(spot, &size)| {
                let size = if spot.turned { DVec2::new(size.y, size.x) } else { size };
                (spot.bin, Rect { low: spot.low, high: spot.low + size })
            }).collect();
            for (i, (bin, rect)) in rects.iter().enumerate() {
                prop_assert!(rect.low.cmpge(DVec2::ZERO).all() && rect.high.cmple(room + DVec2::splat(1e-12)).all());
                for (other_bin, other) in &rects[..i] {
                    let nearly = Rect { low: rect.low + DVec2::splat(1e-9), high: rect.high - DVec2::splat(1e-9) };
                    prop_assert!(bin != other_bin || !nearly.overlaps(other));
                }
            }
            }
        }
    }
}
