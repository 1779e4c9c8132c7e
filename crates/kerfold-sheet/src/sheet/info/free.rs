//! Where a sheet is free of parts and of what else stands on it.

use glam::DVec2;

use crate::geom::polygon::{Location, borders_meet, bounds, locate, segments_meet};
use crate::sheet::kerf::CutShape;
use crate::sheet::layout::Sheet;
use crate::sheet::nest::StockSheet;

/// Places that are tried along each axis.
const PLACES: usize = 24;

/// An axis-parallel rectangle, lower left and upper right corner.
pub(super) type Rectangle = [DVec2; 2];

/// What is taken on a sheet.
pub(super) struct FreeSpace<'a> {
    size: DVec2,
    /// The outlines of the parts as they lie, holes filled, with their boxes.
    parts: Vec<(Vec<DVec2>, Rectangle)>,
    /// The outline of an odd sheet; empty when it is a whole rectangle.
    outline: &'a [DVec2],
    /// Lines on the info layer that nothing should cross.
    lines: Vec<[DVec2; 2]>,
    /// What stands on the info layer already, and defects.
    taken: Vec<Rectangle>,
}

impl<'a> FreeSpace<'a> {
    /// `shapes` are those of the pieces that the sheet holds, in their order.
    pub fn new<'b>(
        sheet: &Sheet,
        shapes: impl Iterator<Item = &'b CutShape>,
        stock: &'a StockSheet,
    ) -> Self {
        let lying = sheet.placed.iter().zip(shapes);
        let parts = lying.filter_map(|(placed, shape)| {
            let outline = placed.apply_all(&shape.outline);
            bounds(&outline).map(|(low, high)| (outline, [low, high]))
        });
        let defects = stock.defects.iter().filter_map(bounds);
        Self {
            size: DVec2::new(sheet.width, sheet.height),
            parts: parts.collect(),
            outline: &stock.outline,
            lines: sheet.cuts.clone(),
            taken: defects.map(|(low, high)| [low, high]).collect(),
        }
    }

    /// Keeps a rectangle from now on.
    pub fn take(&mut self, rectangle: Rectangle) {
        self.taken.push(rectangle);
    }

    /// Keeps a line from now on.
    pub fn take_line(&mut self, line: [DVec2; 2]) {
        self.lines.push(line);
    }

    /// Whether a rectangle lies on the sheet, crosses no line of it, and stays `clear` mm away from
    /// every part and from what else stands there.
    pub fn is_free(&self, [low, high]: Rectangle, clear: f64) -> bool {
        let on_sheet = low.min_element() >= 0.0 && high.cmple(self.size).all();
        let own = corners([low, high]);
        let meets = |&[a, b]: &[DVec2; 2]| {
            let inside = a.cmpge(low).all() && a.cmple(high).all();
            inside || (0..4).any(|i| segments_meet(own[i], own[(i + 1) % 4], a, b))
        };
        let inside_outline = || {
            self.outline.is_empty()
                || (own.iter().all(|&p| locate(self.outline, p) == Location::Inside)
                    && !borders_meet(self.outline, &own))
        };
        on_sheet
            && !self.lines.iter().any(meets)
            && self.is_off_parts([low, high], clear)
            && inside_outline()
    }

    /// The same for a rectangle that may cross lines.
    pub fn is_off_parts(&self, [low, high]: Rectangle, clear: f64) -> bool {
        let clear = DVec2::splat(clear);
        let (low, high) = (low - clear, high + clear);
        let own = corners([low, high]);
        let apart = |[l, h]: &Rectangle| h.cmplt(low).any() || l.cmpgt(high).any();
        let misses = |(outline, part): &(Vec<DVec2>, Rectangle)| {
            apart(part)
                || (locate(outline, low) == Location::Outside
                    && outline.first().is_none_or(|&p| locate(&own, p) == Location::Outside)
                    && !borders_meet(outline, &own))
        };
        self.taken.iter().all(apart) && self.parts.iter().all(misses)
    }

    /// A free rectangle of a size, searched from the upper right on a grid of places that keeps
    /// `border` mm to the border of the sheet.
    pub fn place(&self, size: DVec2, border: f64, clear: f64) -> Option<Rectangle> {
        let (first, room) = (DVec2::splat(border), self.size - DVec2::splat(2.0 * border) - size);
        if room.is_nan() || room.min_element() < 0.0 {
            return None;
        }
        let part = |k: usize| 1.0 - k as f64 / (PLACES - 1) as f64;
        let at = |i: usize| first + room * DVec2::new(part(i % PLACES), part(i / PLACES));
        let places = (0..PLACES * PLACES).map(at).map(|low| [low, low + size]);
        places.into_iter().find(|&place| self.is_free(place, clear))
    }
}

fn corners([low, high]: Rectangle) -> [DVec2; 4] {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}
