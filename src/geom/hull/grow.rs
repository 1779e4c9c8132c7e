//! From the first corners to the hull of all points: seeds first, then cell by cell, parts of the surface side by side.
//!
//! What is done depends on the points alone, never on the number of processors: the surface is divided along the cells of the
//! order, each part grows for itself, and the few points that concern the border between two are inserted when they are
//! together again.

use std::ops::Range;

use super::cloud::{Cloud, Signs};
use super::order::Order;
use super::parallel::each;
use super::surface::{Division, Surface};

/// From so many points on the surface is divided into so many parts.
const PARTS: [(usize, usize); 2] = [(1 << 19, 4), (1 << 15, 2)];

/// Inserts all points but those that are corners already, `inserted` (ascending).
pub(super) fn grow<S: Signs>(cloud: &Cloud<S>, surface: &mut Surface, order: &Order, inserted: &[u32]) {
    let (seeds, count) = (order.seed_cells.len() as u32, cloud.len());
    without(0..seeds, inserted).for_each(|p| surface.insert(cloud, p));
    let parts = PARTS.iter().find(|&&(least, _)| count as usize >= least).map_or(1, |&(_, parts)| parts);
    // A walk from a corner of the hull may have to try all facets.
    if parts == 1 || surface.has_apex() {
        without(seeds..count, inserted).for_each(|p| surface.insert(cloud, p));
    } else {
        let left = Borders::of(order, parts).grow(cloud, surface, inserted);
        left.into_iter().for_each(|p| surface.insert(cloud, p));
    }
}

/// The places that are not yet inserted; both ascend.
fn without(places: Range<u32>, inserted: &[u32]) -> impl Iterator<Item = u32> {
    let mut rest = inserted;
    places.filter(move |&p| {
        while rest.first().is_some_and(|&i| i < p) {
            rest = &rest[1..];
        }
        rest.first() != Some(&p)
    })
}

/// Where one part ends and the next begins.
struct Borders<'a> {
    order: &'a Order,
    /// For each part the indices of its cells in [`Order::cells`].
    cells: Vec<Range<usize>>,
}

/// A part of the surface while it grows.
struct Part {
    surface: Surface,
    /// Indices of its cells.
    cells: Range<usize>,
    /// For each of the cells a facet near it.
    hints: Vec<u32>,
    /// The points that concern the border.
    left: Vec<u32>,
}

impl<'a> Borders<'a> {
    /// Runs of cells with about the same number of points.
    fn of(order: &'a Order, parts: usize) -> Self {
        let (seeds, count) = (order.seed_cells.len(), order.points.len());
        let end = |k: usize| {
            let goal = seeds + (count - seeds) * k / parts;
            order.cells.partition_point(|&(_, end)| (end as usize) <= goal)
        };
        Self { order, cells: (0..parts).map(|k| end(k)..end(k + 1)).collect() }
    }

    /// The cell of a point.
    fn cell_of(&self, place: u32) -> u32 {
        let late = || self.order.cells[self.order.cells.partition_point(|&(_, end)| end <= place)].0;
        self.order.seed_cells.get(place as usize).copied().unwrap_or_else(late)
    }

    /// The part that a cell belongs to.
    fn part_of(&self, cell: u32) -> usize {
        let first = |cells: &Range<usize>| self.order.cells.get(cells.start).map_or(u32::MAX, |c| c.0);
        self.cells.iter().skip(1).take_while(|cells| first(cells) <= cell).count()
    }

    /// Divides the surface by its facets' first corners, lets the parts grow, and joins them; returns the points that are left.
    fn grow<S: Signs>(&self, cloud: &Cloud<S>, surface: &mut Surface, inserted: &[u32]) -> Vec<u32> {
        let mut near: Vec<(u32, u32)> =
            surface.live().map(|f| (self.cell_of(surface.facet(f).corners[0]), f)).collect();
        near.sort_unstable();
        let (facets, count) = (surface.slots(), cloud.len() as usize);
        // The first part will hold all of them in the end.
        let room = |cells: &Range<usize>| {
            if cells.start == 0 { 2 * count + 8 } else { 2 * places(self.order, cells.clone()).len() + facets }
        };
        let room: Vec<usize> = self.cells.iter().map(room).collect();
        let (parts, division) = surface.divide(&room, |facet| self.part_of(self.cell_of(facet.corners[0])));
        let mut parts: Vec<Part> = (0..)
            .zip(parts)
            .zip(&self.cells)
            .map(|((k, surface), cells)| Part {
                hints: self.hints(k, cells, &near, &division),
                surface,
                cells: cells.clone(),
                left: Vec::new(),
            })
            .collect();
        each(&mut parts, |part| part.grow(cloud, self.order, inserted));
        let mut left = Vec::new();
        parts.iter_mut().for_each(|part| left.append(&mut part.left));
        surface.join(parts.into_iter().map(|part| part.surface).collect(), &division);
        left
    }

    /// For each cell of part `k` a facet of that part in it or before it along the curve. `near` holds cells and facets of the
    /// whole surface, ascending.
    fn hints(&self, k: usize, cells: &Range<usize>, near: &[(u32, u32)], division: &Division) -> Vec<u32> {
        let mut last = 0;
        let hint = |&(cell, _): &(u32, u32)| {
            let start = near.partition_point(|n| n.0 < cell);
            let facets = near[start..].iter().take_while(|n| n.0 == cell);
            let here = facets.filter_map(|&(_, f)| division.place_of(f)).find(|&(part, _)| part == k);
            last = here.map_or(last, |(_, slot)| slot);
            last
        };
        self.order.cells[cells.clone()].iter().map(hint).collect()
    }
}

impl Part {
    fn grow<S: Signs>(&mut self, cloud: &Cloud<S>, order: &Order, inserted: &[u32]) {
        if self.surface.slots() == 0 {
            self.left.extend(without(places(order, self.cells.clone()), inserted));
            return;
        }
        for (i, &hint) in self.cells.clone().zip(&self.hints) {
            self.surface.go_to(hint);
            for p in without(places(order, i..i + 1), inserted) {
                // Of equal points the first comes first, wherever it is inserted.
                let is_repeated = self.left.last().is_some_and(|&q| cloud.point(q) == cloud.point(p));
                if is_repeated || !self.surface.insert_within(cloud, p) {
                    self.left.push(p);
                    self.surface.go_to(hint);
                }
            }
        }
    }
}

/// The places of the points in a run of cells.
fn places(order: &Order, cells: Range<usize>) -> Range<u32> {
    let end = |i: usize| i.checked_sub(1).map_or(order.seed_cells.len() as u32, |i| order.cells[i].1);
    end(cells.start)..end(cells.end)
}
