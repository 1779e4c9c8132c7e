//! One drawing per part, for shops that nest themselves.

use glam::DVec2;

use super::drawing::{Drawing, Layer, LayerKind, Mark, Stroke};
use crate::geom::polygon::bounds;
use crate::net::PieceId;

/// Free border around a part, in mm.
const BORDER: f64 = 5.0;

impl Drawing {
    /// The parts of a sheet, each alone on a page just large enough, turned as on the sheet;
    /// ascending by name.
    pub fn parts(&self) -> Vec<Self> {
        let mut ids: Vec<PieceId> =
            self.marks().chain(&self.whole).filter_map(|m| m.piece).collect();
        ids.sort();
        ids.dedup();
        ids.into_iter().filter_map(|id| self.part(id)).collect()
    }

    fn part(&self, id: PieceId) -> Option<Self> {
        let points = self
            .layers
            .iter()
            .flat_map(|l| self.own(l, id))
            .flat_map(|m| &m.strokes)
            .flat_map(|s| &s.points);
        let (low, high) = bounds(points)?;
        let shift = DVec2::splat(BORDER) - low;
        let moved = |m: &Mark| {
            let stroke = |s: &Stroke| Stroke {
                points: s.points.iter().map(|&p| p + shift).collect(),
                closed: s.closed,
            };
            Mark { strokes: m.strokes.iter().map(stroke).collect(), ..m.clone() }
        };
        let layers = self.layers.iter();
        let layers =
            layers.map(|l| Layer { kind: l.kind, marks: self.own(l, id).map(moved).collect() });
        let size = high - low + DVec2::splat(2.0 * BORDER);
        let (width, height) = (round_up(size.x), round_up(size.y));
        Some(Self {
            sheet: self.sheet,
            part: Some(id),
            width,
            height,
            layers: layers.collect(),
            whole: Vec::new(),
            sides: self
                .sides
                .iter()
                .filter(|(_, m)| m.piece == Some(id))
                .map(|(side, m)| (*side, moved(m)))
                .collect(),
        })
    }

    /// The marks of a part on a layer. Alone, a part has its whole contour, whoever draws it on the
    /// sheet.
    fn own<'a>(&'a self, layer: &'a Layer, id: PieceId) -> impl Iterator<Item = &'a Mark> {
        let drawn = layer.marks.iter().filter(|m| !self.whole.iter().any(|w| w.id == m.id));
        let whole = self.whole.iter().filter(|w| w.kind.layer() == layer.kind);
        drawn.chain(whole).filter(move |m| m.piece == Some(id))
    }

    /// Whether a layer holds nothing.
    pub fn is_empty(&self, layer: LayerKind) -> bool {
        self.layers.iter().all(|l| l.kind != layer || l.marks.is_empty())
    }
}

/// To whole tenths of a millimetre.
fn round_up(mm: f64) -> f64 {
    (mm * 10.0).ceil() / 10.0
}

#[cfg(test)]
mod tests {
    use super::super::testing::two_pieces;
    use super::super::{SheetParams, lay_out};
    use super::*;

    #[test]
    fn parts_hold_all_that_the_sheet_cuts_and_nothing_of_one_another() {
        let sheet =
            &lay_out(&two_pieces(), &SheetParams::default()).expect("two pieces fit").drawings[0];
        let parts = sheet.parts();
        assert_eq!(parts.iter().map(Drawing::file_stem).collect::<Vec<_>>(), ["P01", "P02"]);
        let sum = |f: fn(&Drawing) -> f64| parts.iter().map(f).sum::<f64>();
        assert!((sum(Drawing::cut_length) - sheet.cut_length()).abs() < 1e-9);
        assert!((sum(Drawing::score_length) - sheet.score_length()).abs() < 1e-9);
        for part in &parts {
            assert!(part.is_empty(LayerKind::Info) && !part.is_empty(LayerKind::CutOuter));
            let inside = |p: &DVec2| {
                p.min_element() >= BORDER - 1e-9 && p.x < part.width && p.y < part.height
            };
            assert!(part.marks().flat_map(|m| &m.strokes).flat_map(|s| &s.points).all(inside));
        }
    }
}
