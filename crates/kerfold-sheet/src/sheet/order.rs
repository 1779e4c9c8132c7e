//! In which order the lines of a sheet are machined: what lies inside before what lies around it,
//! on short ways.
//!
//! Within an operation the next line is the nearest one (nearest neighbour), then stretches of the
//! way are turned around as long as that shortens it (2-opt, Croes 1958, with a window). A contour
//! is entered at its corner nearest to the way.

use std::ops::Range;

use glam::DVec2;

use super::drawing::{Drawing, Layer, LayerKind, Mark, MarkKind, Stroke};
use crate::geom::polygon::{Location, bounds, locate};
use crate::geom::{Cell, Grid};

/// How many lines a stretch that is turned around may have.
const WINDOW: usize = 60;

/// How often all stretches are tried.
const PASSES: usize = 12;

impl Layer {
    /// Length of all its lines, in mm.
    pub fn length(&self) -> f64 {
        self.marks.iter().flat_map(|m| &m.strokes).map(Stroke::length).sum()
    }
}

impl Drawing {
    /// Length of the travel moves, from the lower left corner on, in mm. Nothing is
    /// machined on the info layer.
    pub fn travel_length(&self) -> f64 {
        let layers = self.layers.iter().filter(|l| l.kind != LayerKind::Info);
        let strokes = layers.flat_map(|l| &l.marks).flat_map(|m| &m.strokes);
        let mut at = DVec2::ZERO;
        let mut length = 0.0;
        for stroke in strokes {
            let Some((&first, &last)) = stroke.points.first().zip(stroke.points.last()) else {
                continue;
            };
            length += at.distance(first);
            at = if stroke.closed { first } else { last };
        }
        length
    }

    /// Puts all lines into the order in which they are machined.
    pub(crate) fn arrange(&mut self) {
        self.cut_nested_pieces_first();
        let mut at = DVec2::ZERO;
        for layer in self.layers.iter_mut().filter(|l| l.kind != LayerKind::Info) {
            let mut done = Vec::new();
            for group in depths(std::mem::take(&mut layer.marks)) {
                let ordered = ordered(group, at);
                at = ordered.last().and_then(ends).map_or(at, |e| e[1]);
                done.extend(ordered);
            }
            layer.marks = done;
        }
    }

    /// A piece that lies in a hole of another is an inner cut: the hole falls out with all that is
    /// in it.
    fn cut_nested_pieces_first(&mut self) {
        let of_kind = |kind: MarkKind| {
            self.marks().filter(move |m| m.kind == kind).cloned().collect::<Vec<_>>()
        };
        let (holes, outlines) = (of_kind(MarkKind::Hole), of_kind(MarkKind::Outline));
        let boxed: Vec<_> =
            holes.iter().filter_map(|h| bounds(&h.strokes[0].points).map(|b| (h, b))).collect();
        let is_nested = |outline: &Mark| {
            let first = outline.strokes.first().and_then(|s| s.points.first()).copied();
            first.is_some_and(|p| {
                let holds = |(hole, (low, high)): &(&Mark, (DVec2, DVec2))| {
                    hole.piece != outline.piece
                        && p.cmpge(*low).all()
                        && p.cmple(*high).all()
                        && locate(&hole.strokes[0].points, p) == Location::Inside
                };
                boxed.iter().any(holds)
            })
        };
        let nested: Vec<Mark> = outlines.into_iter().filter(is_nested).collect();
        for mark in &nested {
            self.layers.iter_mut().for_each(|l| l.marks.retain(|m| m.id != mark.id));
        }
        for mark in nested {
            self.add(MarkKind::NestedOutline, mark.id, mark.piece, mark.strokes);
        }
    }
}

/// Marks by how many closed ones lie around them, the innermost first.
fn depths(marks: Vec<Mark>) -> Vec<Vec<Mark>> {
    let closed: Vec<(usize, &Vec<DVec2>, (DVec2, DVec2))> = marks
        .iter()
        .enumerate()
        .filter_map(|(i, m)| m.strokes.first().filter(|s| s.closed).map(|s| (i, &s.points)))
        .filter_map(|(i, points)| bounds(points).map(|b| (i, points, b)))
        .collect();
    // Only cuts close around others.
    let depth = |i: usize| {
        let first = marks[i].strokes.first().and_then(|s| s.points.first()).copied();
        let around = |p: DVec2| {
            let holds = |(j, points, (low, high)): &&(usize, &Vec<DVec2>, (DVec2, DVec2))| {
                *j != i
                    && p.cmpge(*low).all()
                    && p.cmple(*high).all()
                    && locate(points, p) == Location::Inside
            };
            closed.iter().filter(holds).count()
        };
        first.map_or(0, around)
    };
    let depths: Vec<usize> = (0..marks.len()).map(depth).collect();
    let deepest = depths.iter().copied().max().unwrap_or(0);
    let mut groups = vec![Vec::new(); deepest + 1];
    for (mark, depth) in marks.into_iter().zip(depths) {
        groups[deepest - depth].push(mark);
    }
    groups
}

/// Where the machine comes to a mark and where it leaves it.
fn ends(mark: &Mark) -> Option<[DVec2; 2]> {
    let first = *mark.strokes.first()?.points.first()?;
    let last = mark.strokes.last()?;
    Some([first, if last.closed { *last.points.first()? } else { *last.points.last()? }])
}

/// Whether the machine may come in at any of its corners.
fn is_ring(mark: &Mark) -> bool {
    matches!(mark.strokes.as_slice(), [stroke] if stroke.closed)
}

fn ordered(marks: Vec<Mark>, from: DVec2) -> Vec<Mark> {
    let mut ways = nearest_first(&marks, from);
    for _ in 0..PASSES {
        if !turn_stretches(&mut ways, from) {
            break;
        }
    }
    let mut marks: Vec<Option<Mark>> = marks.into_iter().map(Some).collect();
    let taken = ways.iter().filter_map(|way| marks[way.mark].take().map(|mark| (mark, *way)));
    let mut done: Vec<Mark> = taken.map(|(mark, way)| begun_at(mark, &way)).collect();
    enter_nearest(&mut done, from);
    done
}

/// A mark as it is passed.
#[derive(Debug, Clone, Copy)]
struct Way {
    mark: usize,
    /// First and last point.
    ends: [DVec2; 2],
    /// For rings the corner where they begin; else whether the mark is drawn backwards.
    corner: usize,
    is_reversed: bool,
}

impl Way {
    fn turned(self) -> Self {
        let [a, b] = self.ends;
        Self { ends: [b, a], is_reversed: !self.is_reversed, ..self }
    }
}

fn begun_at(mut mark: Mark, way: &Way) -> Mark {
    if is_ring(&mark) {
        mark.strokes[0].points.rotate_left(way.corner);
    } else if way.is_reversed {
        mark.strokes.reverse();
        mark.strokes.iter_mut().filter(|s| !s.closed).for_each(|s| s.points.reverse());
    }
    mark
}

/// Always on to the nearest mark that is left.
fn nearest_first(marks: &[Mark], from: DVec2) -> Vec<Way> {
    let mut grid = Nearest::of(marks);
    let mut at = from;
    let mut ways = Vec::with_capacity(marks.len());
    while let Some(way) = grid.take(at) {
        at = way.ends[1];
        ways.push(way);
    }
    ways
}

/// One pass of 2-opt; whether anything became shorter.
fn turn_stretches(ways: &mut [Way], from: DVec2) -> bool {
    let mut is_shorter = false;
    for i in 0..ways.len() {
        let before = if i == 0 { from } else { ways[i - 1].ends[1] };
        let mut best: Option<(f64, Range<usize>)> = None;
        for j in i + 1..ways.len().min(i + WINDOW) {
            let after = ways.get(j + 1).map(|w| w.ends[0]);
            let [entry, exit] = [ways[i].ends[0], ways[j].ends[1]];
            let to_after = |p: DVec2| after.map_or(0.0, |a| p.distance(a));
            let gain =
                before.distance(entry) + to_after(exit) - before.distance(exit) - to_after(entry);
            // Less than rounding is no gain, or stretches might turn for ever.
            if gain > 1e-9 * (1.0 + before.distance(entry))
                && best.as_ref().is_none_or(|b| gain > b.0)
            {
                best = Some((gain, i..j + 1));
            }
        }
        if let Some((_, stretch)) = best {
            ways[stretch.clone()].reverse();
            ways[stretch].iter_mut().for_each(|w| *w = w.turned());
            is_shorter = true;
        }
    }
    is_shorter
}

/// Every ring is entered at the corner that lies best between the marks before and after it.
fn enter_nearest(marks: &mut [Mark], from: DVec2) {
    for i in 0..marks.len() {
        if !is_ring(&marks[i]) {
            continue;
        }
        let before = if i == 0 { Some(from) } else { ends(&marks[i - 1]).map(|e| e[1]) };
        let after = marks.get(i + 1).and_then(ends).map(|e| e[0]);
        let points = &mut marks[i].strokes[0].points;
        let cost =
            |p: DVec2| [before, after].into_iter().flatten().map(|q| p.distance(q)).sum::<f64>();
        let best = (0..points.len()).min_by(|&a, &b| cost(points[a]).total_cmp(&cost(points[b])));
        points.rotate_left(best.unwrap_or(0));
    }
}

/// A place where a mark can be entered.
#[derive(Debug, Clone, Copy)]
struct Entry {
    mark: usize,
    corner: usize,
    /// Whether the mark would be drawn backwards.
    is_reversed: bool,
}

/// The places where marks can be entered, in a grid.
struct Nearest<'a> {
    marks: &'a [Mark],
    is_taken: Vec<bool>,
    /// Cells on a side of the grid.
    side: i64,
    grid: Grid<2>,
    /// By their numbers in the grid.
    entries: Vec<Entry>,
    left: usize,
}

impl<'a> Nearest<'a> {
    fn of(marks: &'a [Mark]) -> Self {
        let (low, high) = bounds(marks.iter().flat_map(|m| &m.strokes).flat_map(|s| &s.points))
            .unwrap_or_default();
        let side = ((marks.len() as f64).sqrt().ceil() as i64).clamp(1, 256);
        let cell = ((high - low).max_element() / side as f64).max(f64::MIN_POSITIVE);
        let mut nearest = Self {
            marks,
            is_taken: vec![false; marks.len()],
            side,
            grid: Grid::new(low.to_array(), cell),
            entries: Vec::new(),
            left: 0,
        };
        for (i, mark) in marks.iter().enumerate() {
            let Some([first, last]) = ends(mark) else { continue };
            nearest.left += 1;
            if is_ring(mark) {
                for (corner, &p) in mark.strokes[0].points.iter().enumerate() {
                    nearest.add(p, Entry { mark: i, corner, is_reversed: false });
                }
            } else {
                for (p, is_reversed) in [(first, false), (last, true)] {
                    nearest.add(p, Entry { mark: i, corner: 0, is_reversed });
                }
            }
        }
        nearest
    }

    fn add(&mut self, p: DVec2, entry: Entry) {
        self.grid.insert_into(self.cell_of(p));
        self.entries.push(entry);
    }

    /// The cell of a place, or the one at the border that is nearest to it.
    fn cell_of(&self, p: DVec2) -> Cell<2> {
        self.grid.cell_of(p.to_array()).map(|x| x.clamp(0, self.side - 1))
    }

    fn way(&self, entry: Entry) -> Option<Way> {
        let Entry { mark, corner, is_reversed } = entry;
        let [a, b] = ends(&self.marks[mark])?;
        let ends = match (is_ring(&self.marks[mark]), is_reversed) {
            (true, _) => [self.marks[mark].strokes[0].points[corner]; 2],
            (false, false) => [a, b],
            (false, true) => [b, a],
        };
        Some(Way { mark, ends, corner, is_reversed })
    }

    /// The nearest mark that is left; rings of cells around the place, until none further out can
    /// be nearer.
    fn take(&mut self, at: DVec2) -> Option<Way> {
        if self.left == 0 {
            return None;
        }
        let centre = self.cell_of(at);
        let mut best: Option<(f64, Way)> = None;
        for ring in 0..=self.side {
            // Everything in this ring is at least that far away.
            let reach = (ring - 1).max(0) as f64 * self.grid.cell_size();
            if best.as_ref().is_some_and(|b| b.0 < reach) {
                break;
            }
            for cell in self.ring(centre, ring) {
                self.nearest_in(cell, at, &mut best);
            }
        }
        let (_, way) = best?;
        self.is_taken[way.mark] = true;
        self.left -= 1;
        Some(way)
    }

    /// The cells of the grid that are so many steps away from one, row by row.
    fn ring(&self, [cx, cy]: Cell<2>, ring: i64) -> impl Iterator<Item = Cell<2>> + use<> {
        let side = self.side;
        ((cy - ring).max(0)..=(cy + ring).min(side - 1)).flat_map(move |y| {
            let is_edge = (y - cy).abs() == ring;
            let step = if is_edge || ring == 0 { 1 } else { 2 * ring };
            let columns = (cx - ring..=cx + ring).step_by(step as usize);
            columns.filter(move |x| (0..side).contains(x)).map(move |x| [x, y])
        })
    }

    /// Puts the nearest mark of a cell in the place of one that is farther; the earlier of two that
    /// are as near.
    fn nearest_in(&self, cell: Cell<2>, at: DVec2, best: &mut Option<(f64, Way)>) {
        for number in self.grid.in_cell(cell) {
            let entry = self.entries[number as usize];
            if self.is_taken[entry.mark] {
                continue;
            }
            let Some(way) = self.way(entry) else { continue };
            let distance = at.distance(way.ends[0]);
            let is_nearer = best
                .as_ref()
                .is_none_or(|b| distance.total_cmp(&b.0).then(way.mark.cmp(&b.1.mark)).is_lt());
            if is_nearer {
                *best = Some((distance, way));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::{Sheet, SheetId};
    use super::super::testing::{points, square};
    use super::*;
    use crate::net::PieceId;

    fn blank() -> Drawing {
        Drawing::new(&Sheet { id: SheetId(0), width: 600.0, height: 400.0, ..Sheet::default() })
    }

    fn ring_at(drawing: &mut Drawing, kind: MarkKind, piece: usize, low: (f64, f64), size: f64) {
        let points = square(size).into_iter().map(|p| p + DVec2::from(low)).collect();
        let id = format!("{}-{}", PieceId(piece), kind.name());
        drawing.add(kind, id, Some(PieceId(piece)), vec![Stroke { points, closed: true }]);
    }

    #[test]
    fn a_row_of_squares_is_cut_along_the_row() {
        let mut drawing = blank();
        let order = [7, 2, 9, 4, 0, 5, 1, 8, 3, 6];
        for i in order {
            ring_at(&mut drawing, MarkKind::Outline, i, (10.0 + 20.0 * i as f64, 10.0), 10.0);
        }
        let before = drawing.travel_length();
        let lengths = [drawing.cut_length(), drawing.marks().count() as f64];
        drawing.arrange();
        let pieces: Vec<usize> = drawing.marks().filter_map(|m| m.piece).map(|p| p.0).collect();
        assert_eq!(pieces, (0..10).collect::<Vec<_>>());
        assert!(drawing.travel_length() < 0.35 * before, "{} {before}", drawing.travel_length());
        assert_eq!([drawing.cut_length(), drawing.marks().count() as f64], lengths);
    }

    #[test]
    fn a_piece_in_a_hole_is_cut_before_the_hole_and_its_own_hole_before_it() {
        let mut drawing = blank();
        ring_at(&mut drawing, MarkKind::Outline, 0, (10.0, 10.0), 100.0);
        ring_at(&mut drawing, MarkKind::Hole, 0, (20.0, 20.0), 80.0);
        ring_at(&mut drawing, MarkKind::Outline, 1, (30.0, 30.0), 50.0);
        ring_at(&mut drawing, MarkKind::Hole, 1, (40.0, 40.0), 10.0);
        drawing.arrange();
        let order: Vec<_> = drawing.marks().map(|m| (m.kind, m.piece.map(|p| p.0))).collect();
        let expected = [
            (MarkKind::Hole, Some(1)),
            (MarkKind::NestedOutline, Some(1)),
            (MarkKind::Hole, Some(0)),
            (MarkKind::Outline, Some(0)),
        ];
        assert_eq!(order, expected);
    }

    #[test]
    fn open_lines_are_drawn_to_and_fro() {
        let mut drawing = blank();
        for i in 0..20 {
            let x = 10.0 + 5.0 * f64::from(i);
            let points = points([(x, 10.0), (x, 200.0)]);
            drawing.add(
                MarkKind::MountainFold,
                format!("E{i}"),
                None,
                vec![Stroke { points, closed: false }],
            );
        }
        drawing.arrange();
        assert!(
            (drawing.travel_length() - (DVec2::splat(10.0).length() + 19.0 * 5.0)).abs() < 1e-9
        );
    }
}
