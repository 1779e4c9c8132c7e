//! Measuring a layout once more, by other means than it was made: every cut inside the margin,
//! every two pieces apart.
//!
//! All distances are between the real contours, not between boxes, so that it judges any way of
//! placing.

use std::collections::BTreeMap;

use glam::DVec2;

use super::contact::{overlap, sticks_out};
pub(crate) use super::distance::{contour_distance, edges};
use super::error::SheetError;
use super::kerf::CutShape;
use super::layout::{Layout, Placed, Sheet, SheetId};
use super::nest::{CommonLine, StockSheet};
use super::params::SheetParams;
use super::stock::Stock;
use crate::geom::polygon::{Location, bounds, locate, segments_cross};
use crate::net::PieceId;

/// Measures a layout against the margin and the spacing of the parameters.
///
/// # Errors
/// [`SheetError::NotPlacedOnce`], [`SheetError::OverMargin`] and [`SheetError::TooClose`]: the
/// first violation found.
pub fn verify(
    shapes: &[CutShape],
    layout: &Layout,
    params: &SheetParams,
) -> Result<(), SheetError> {
    let Some(sheets) = params.sheets()? else { return Ok(()) };
    let mut times: BTreeMap<PieceId, usize> = shapes.iter().map(|s| (s.piece, 0)).collect();
    for placed in layout.sheets.iter().flat_map(|s| &s.placed) {
        *times.entry(placed.piece).or_default() += 1;
    }
    if let Some((&piece, &times)) = times.iter().find(|&(_, &n)| n != 1) {
        return Err(SheetError::NotPlacedOnce { piece, times });
    }
    verify_turns(layout, params)?;
    let by_id: BTreeMap<PieceId, &CutShape> = shapes.iter().map(|s| (s.piece, s)).collect();
    for sheet in &layout.sheets {
        let stock = &sheets[sheet.stock.min(sheets.len() - 1)];
        let laid = verify_sheet(&by_id, sheet, &stock.stock, params.nest.common_line)?;
        verify_stock(&laid, sheet, stock)?;
    }
    Ok(())
}

/// Angles that are allowed, and groups on one sheet.
fn verify_turns(layout: &Layout, params: &SheetParams) -> Result<(), SheetError> {
    let nest = &params.nest;
    let mut sheet_of: BTreeMap<PieceId, SheetId> = BTreeMap::new();
    for sheet in &layout.sheets {
        for &Placed { piece, rotation, .. } in &sheet.placed {
            sheet_of.insert(piece, sheet.id);
            if !nest.rotate.0.get(&piece).unwrap_or(&nest.rotations).allows(rotation) {
                return Err(SheetError::Turned { piece, rotation });
            }
        }
    }
    for group in &nest.together.0 {
        let mut members = group.iter();
        let Some(&first) = members.next() else { continue };
        if let Some(&second) = members.find(|p| sheet_of.get(p) != sheet_of.get(&first)) {
            return Err(SheetError::Parted { first, second });
        }
    }
    Ok(())
}

/// The outline of the sheet, its defects, and the cuts from edge to edge.
fn verify_stock(laid: &[Laid], sheet: &Sheet, stock: &StockSheet) -> Result<(), SheetError> {
    let rounding = 6.0 * stock.stock.rounding();
    for here in laid {
        let Some(contour) = here.contours.first() else { continue };
        let bad = |what, distance, least| {
            Err(SheetError::OnDefect { piece: here.piece, sheet: sheet.id, what, distance, least })
        };
        if !stock.outline.is_empty() {
            // A piece may lie on the outline, and then be off it by rounding.
            let is_outside = sticks_out(contour, &stock.outline, rounding);
            let distance = if is_outside { 0.0 } else { contour_distance(contour, &stock.outline) };
            if is_outside || distance < stock.stock.margin - rounding {
                return bad("the outline of the sheet", distance, stock.stock.margin);
            }
        }
        for corners in &stock.defects {
            let (low, high) = bounds(corners).unwrap_or_default();
            let defect = Laid { piece: here.piece, contours: vec![corners.clone()], low, high };
            let distance = distance(here, &defect);
            if distance < stock.stock.spacing - rounding {
                return bad("a defect", distance, stock.stock.spacing);
            }
        }
        // A cut is a segment: no side of the outline may cross it, and none of its ends may lie
        // inside.
        for &[a, b] in &sheet.cuts {
            let is_hit = edges(contour).any(|(p, q)| segments_cross(a, b, p, q))
                || [a, b, a.midpoint(b)].iter().any(|&p| locate(contour, p) == Location::Inside);
            if is_hit {
                return Err(SheetError::CutThrough { piece: here.piece, sheet: sheet.id });
            }
        }
    }
    Ok(())
}

/// A piece where it lies.
struct Laid {
    piece: PieceId,
    contours: Vec<Vec<DVec2>>,
    low: DVec2,
    high: DVec2,
}

impl Laid {
    fn new(shape: &CutShape, placed: &Placed) -> Self {
        let contours: Vec<_> = shape.contours().map(|c| placed.apply_all(c)).collect();
        let (low, high) = bounds(contours.iter().flatten()).unwrap_or_default();
        Self { piece: shape.piece, contours, low, high }
    }

    /// The distance from the outline of a piece that begins inside this one's: from the hole that
    /// it lies in, 0 where material covers it. `None` when it begins outside.
    fn distance_around(&self, outline: &[DVec2]) -> Option<f64> {
        let (&p, around) = (outline.first()?, self.contours.first()?);
        if locate(around, p) == Location::Outside {
            return None;
        }
        let hole = self.contours[1..].iter().find(|hole| locate(hole, p) == Location::Inside);
        Some(hole.map_or(0.0, |hole| contour_distance(hole, outline)))
    }
}

fn verify_sheet(
    shapes: &BTreeMap<PieceId, &CutShape>,
    sheet: &Sheet,
    stock: &Stock,
    common_line: CommonLine,
) -> Result<Vec<Laid>, SheetError> {
    let mut laid: Vec<Laid> = Vec::new();
    for placed in &sheet.placed {
        let shape = shapes
            .get(&placed.piece)
            .ok_or(SheetError::NotPlacedOnce { piece: placed.piece, times: 0 })?;
        let here = Laid::new(shape, placed);
        let low = DVec2::splat(stock.margin) - here.low;
        let high = here.high - (stock.size - DVec2::splat(stock.margin));
        let by = low.max(high).max_element();
        if by > 3.0 * stock.rounding() {
            return Err(SheetError::OverMargin { piece: here.piece, sheet: sheet.id, by });
        }
        laid.push(here);
    }
    let rounding = 6.0 * stock.rounding();
    let least = stock.spacing - rounding;
    let may_touch = |distance: f64, a: &Laid, b: &Laid| {
        common_line == CommonLine::On
            && distance <= rounding
            && !overlap(&a.contours, &b.contours, rounding)
    };
    // From left to right, so that only neighbours in x are compared.
    laid.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
    for (i, a) in laid.iter().enumerate() {
        for b in laid[i + 1..].iter().take_while(|b| b.low.x < a.high.x + stock.spacing) {
            let apart = (a.low - b.high).max(b.low - a.high).max(DVec2::ZERO).length();
            if apart >= least {
                continue;
            }
            let distance = distance(a, b);
            if (distance < least || distance.is_nan()) && !may_touch(distance, a, b) {
                let (first, second) = (a.piece.min(b.piece), a.piece.max(b.piece));
                return Err(SheetError::TooClose {
                    first,
                    second,
                    sheet: sheet.id,
                    distance,
                    spacing: stock.spacing,
                });
            }
        }
    }
    Ok(laid)
}

/// The distance in mm between two placed pieces; 0 when they touch or overlap. A piece inside a
/// hole of another does not overlap it.
pub fn clearance(a: (&CutShape, &Placed), b: (&CutShape, &Placed)) -> f64 {
    distance(&Laid::new(a.0, a.1), &Laid::new(b.0, b.1))
}

fn distance(a: &Laid, b: &Laid) -> f64 {
    let (Some(first), Some(second)) = (a.contours.first(), b.contours.first()) else {
        return f64::INFINITY;
    };
    // Of the holes only one in which the other piece lies is nearer than the outlines are: sheets
    // with thousands of stitch holes are measured as fast as without.
    let around = a.distance_around(second).or_else(|| b.distance_around(first));
    around.unwrap_or_else(|| contour_distance(first, second))
}

#[cfg(test)]
mod tests {
    use super::super::layout::SheetId;
    use super::super::testing::{ell, piece, ring, square};
    use super::*;

    fn placed(piece: usize, x: f64, y: f64, rotation: f64) -> Placed {
        Placed { piece: PieceId(piece), x, y, rotation }
    }

    fn layout(placed: Vec<Placed>) -> Layout {
        let sheet =
            Sheet { id: SheetId(0), width: 600.0, height: 400.0, placed, ..Sheet::default() };
        Layout { sheets: vec![sheet], ..Layout::default() }
    }

    fn shapes() -> Vec<CutShape> {
        let pieces = [ring(PieceId(0)), piece(PieceId(1), square(4.0)), piece(PieceId(2), ell())];
        pieces.iter().map(|p| CutShape::of_piece(p, 0.0).expect("sound")).collect()
    }

    fn check(places: [(f64, f64, f64); 3]) -> Result<(), SheetError> {
        let placed = places.iter().enumerate().map(|(i, &(x, y, r))| placed(i, x, y, r)).collect();
        verify(&shapes(), &layout(placed), &SheetParams::default())
    }

    #[test]
    fn a_piece_in_a_hole_and_one_in_a_notch_are_fine() {
        // The square of 4 mm has 3 mm on all sides in the hole of 10 mm.
        assert_eq!(check([(5.0, 5.0, 0.0), (18.0, 18.0, 0.0), (100.0, 100.0, 0.0)]), Ok(()));
        assert_eq!(check([(5.0, 5.0, 0.0), (123.0, 123.0, 0.0), (100.0, 100.0, 0.0)]), Ok(()));
    }

    #[test]
    fn too_close_overlapping_and_nested_pieces_are_found() {
        let close = check([(5.0, 5.0, 0.0), (18.5, 18.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(
            matches!(close, Err(SheetError::TooClose { distance, .. }) if (distance - 2.5).abs() < 1e-12),
            "{close:?}"
        );
        let crossing = check([(5.0, 5.0, 0.0), (13.0, 13.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(
            matches!(crossing, Err(SheetError::TooClose { distance: 0.0, .. })),
            "{crossing:?}"
        );
        let inside = check([(5.0, 5.0, 0.0), (108.0, 108.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(matches!(inside, Err(SheetError::TooClose { distance: 0.0, .. })), "{inside:?}");
    }

    #[test]
    fn the_margin_and_missing_pieces_are_found() {
        let over = check([(4.9, 5.0, 0.0), (60.0, 60.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(
            matches!(over, Err(SheetError::OverMargin { by, .. }) if (by - 0.1).abs() < 1e-9),
            "{over:?}"
        );
        let turned = check([(5.0, 5.0, 0.0), (60.0, 60.0, 0.0), (595.0, 360.0, 45.0)]);
        assert!(matches!(turned, Err(SheetError::OverMargin { .. })), "{turned:?}");
        let missing =
            verify(&shapes(), &layout(vec![placed(0, 5.0, 5.0, 0.0)]), &SheetParams::default());
        assert_eq!(missing, Err(SheetError::NotPlacedOnce { piece: PieceId(1), times: 0 }));
        let stranger = verify(
            &shapes()[..0],
            &layout(vec![placed(0, 5.0, 5.0, 0.0)]),
            &SheetParams::default(),
        );
        assert_eq!(stranger, Err(SheetError::NotPlacedOnce { piece: PieceId(0), times: 0 }));
    }
}
