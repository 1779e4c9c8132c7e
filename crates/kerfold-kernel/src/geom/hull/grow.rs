//! From the first corners to the hull of all points: seeds first, then cell by cell, parts of the
//! surface side by side.
//!
//! What is done depends on the points alone, never on the number of processors: the surface is
//! divided along the cells of the order, each part grows for itself, and the few points that
//! concern the border between two are inserted when they are together again.

use std::ops::Range;

use super::GoesOn;
use super::cloud::{Cloud, Signs};
use super::order::Order;
use super::parallel::each;
use super::surface::{Division, Growth, Surface};

/// From so many points on the surface is divided into so many parts.
const PARTS: [(usize, usize); 2] = [(1 << 21, 4), (1 << 15, 2)];

/// So many points in a row may lie beyond a border as seen from where the last one was inserted;
/// then the next is sought from elsewhere.
const TRIES: usize = 16;

/// After so many points it is asked whether to go on.
const ASKED_EVERY: u32 = 1 << 12;

/// Inserts all points but those that are corners already, `inserted` (ascending). `None` when
/// `goes_on` said no.
pub(super) fn grow<S: Signs>(
    cloud: &Cloud<S>,
    surface: &mut Surface<'_>,
    order: &Order,
    inserted: &[u32],
    goes_on: GoesOn<'_>,
) -> Option<()> {
    let (seeds, count) = (order.seed_cells.len() as u32, cloud.len());
    let insert_all = |surface: &mut Surface<'_>, points: &mut dyn Iterator<Item = u32>| {
        for (i, p) in (1_u32..).zip(points) {
            if i % ASKED_EVERY == 0 && !goes_on() {
                return None;
            }
            surface.insert(cloud, p);
        }
        goes_on().then_some(())
    };
    insert_all(surface, &mut without(0..seeds, inserted))?;
    let parts =
        PARTS.iter().find(|&&(least, _)| count as usize >= least).map_or(1, |&(_, parts)| parts);
    // A walk from a corner of the hull may have to try all facets.
    if parts == 1 || surface.has_apex() {
        insert_all(surface, &mut without(seeds..count, inserted))
    } else {
        let left = Borders::of(order, parts).grow(cloud, surface, inserted, goes_on)?;
        insert_all(surface, &mut left.into_iter())
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
    /// For each part its cells.
    cells: Vec<Range<usize>>,
}

/// A part of the surface while it grows.
struct Part<'a> {
    /// Nothing any more once it has grown.
    surface: Option<Surface<'a>>,
    /// Its first slot in the whole surface.
    begin: u32,
    growth: Option<Growth>,
    cells: Range<usize>,
    /// For each of the cells a facet near it.
    hints: Vec<u32>,
    /// The points that concern the border.
    left: Vec<u32>,
}

impl<'a> Borders<'a> {
    /// Runs of cells with about the same number of points.
    fn of(order: &'a Order, parts: usize) -> Self {
        let end = |k: usize| order.cells.len() * k / parts;
        Self { order, cells: (0..parts).map(|k| end(k)..end(k + 1)).collect() }
    }

    /// The cell of a point.
    fn cell_of(&self, place: u32) -> u32 {
        let late = || self.order.cells.partition_point(|&end| end <= place) as u32;
        self.order.seed_cells.get(place as usize).copied().unwrap_or_else(late)
    }

    /// The part that a point belongs to.
    fn part_of(&self, place: u32) -> usize {
        let cell = self.cell_of(place) as usize;
        self.cells.iter().position(|cells| cell < cells.end).unwrap_or(0)
    }

    /// Divides the surface by its facets' first corners, lets the parts grow, and joins them;
    /// returns the points that are left.
    fn grow<S: Signs>(
        &self,
        cloud: &Cloud<S>,
        surface: &mut Surface<'_>,
        inserted: &[u32],
        goes_on: GoesOn<'_>,
    ) -> Option<Vec<u32>> {
        let mut near: Vec<(u32, u32)> =
            surface.live().map(|f| (self.cell_of(surface.facet(f).corners[0]), f)).collect();
        near.sort_unstable();
        let room =
            |cells: &Range<usize>| 2 * without(places(self.order, cells.clone()), inserted).count();
        let room: Vec<usize> = self.cells.iter().map(room).collect();
        let (surfaces, division) = surface.divide(&room, |corner| self.part_of(corner));
        let part = |(k, surface)| Part {
            surface: Some(surface),
            begin: division.begin(k),
            growth: None,
            cells: self.cells[k].clone(),
            hints: self.hints(k, &near, &division),
            left: Vec::new(),
        };
        let mut parts: Vec<Part<'_>> = surfaces.into_iter().enumerate().map(part).collect();
        each(&mut parts, cloud.len() as usize, |part| {
            part.grow(cloud, self.order, inserted, goes_on);
        });
        let mut left = Vec::new();
        let mut growths = Vec::with_capacity(parts.len());
        for part in parts {
            left.extend(part.left);
            growths.push(part.growth?);
        }
        surface.join(growths, &division);
        Some(left)
    }

    /// For each cell of part `k` a facet of that part in it or before it along the curve. `near`
    /// holds cells and facets of the whole surface, ascending.
    fn hints(&self, k: usize, near: &[(u32, u32)], division: &Division) -> Vec<u32> {
        let mut last = 0;
        let hint = |cell: usize| {
            let start = near.partition_point(|n| (n.0 as usize) < cell);
            let facets = near[start..].iter().take_while(|n| n.0 as usize == cell);
            let here =
                facets.filter_map(|&(_, f)| division.place_of(f)).find(|&(part, _)| part == k);
            last = here.map_or(last, |(_, slot)| slot);
            last
        };
        self.cells[k].clone().map(hint).collect()
    }
}

impl Part<'_> {
    /// Grows; has no growth when `goes_on` said no.
    fn grow<S: Signs>(
        &mut self,
        cloud: &Cloud<S>,
        order: &Order,
        inserted: &[u32],
        goes_on: GoesOn<'_>,
    ) {
        let Some(mut surface) = self.surface.take() else { return };
        for (i, &hint) in self.cells.clone().zip(&self.hints) {
            if !goes_on() {
                return;
            }
            let late = without(places(order, i..i + 1), inserted);
            if surface.len() == 0 {
                self.left.extend(late);
                continue;
            }
            surface.go_to(hint);
            let mut in_a_row = 0;
            for p in late {
                // Of equal points the first comes first, wherever it is inserted.
                let is_repeated =
                    self.left.last().is_some_and(|&q| cloud.point(q) == cloud.point(p));
                if !is_repeated && surface.insert_within(cloud, p) {
                    in_a_row = 0;
                    continue;
                }
                self.left.push(p);
                in_a_row += 1;
                if in_a_row % TRIES == 0 {
                    surface.go_to(hint);
                }
            }
        }
        self.growth = Some(surface.into_growth(self.begin));
    }
}

/// The places of the points in a run of cells.
fn places(order: &Order, cells: Range<usize>) -> Range<u32> {
    let end = |i: usize| i.checked_sub(1).map_or(order.seed_cells.len() as u32, |i| order.cells[i]);
    end(cells.start)..end(cells.end)
}
