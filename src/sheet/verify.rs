//! Measuring a layout once more, by other means than it was made: every cut inside the margin, every two pieces apart.
//!
//! All distances are between the real contours, not between boxes, so that it judges any way of placing.

use glam::DVec2;

use super::error::SheetError;
use super::kerf::CutShape;
use super::layout::{Layout, Placed, Sheet};
use super::params::{SheetParams, Stock};
use crate::geom::polygon::{Location, bounds, locate, segments_cross};
use crate::net::PieceId;

/// Measures a layout against the margin and the spacing of the parameters.
///
/// # Errors
/// [`SheetError::NotPlacedOnce`], [`SheetError::OverMargin`] and [`SheetError::TooClose`]: the first violation found.
pub fn verify(shapes: &[CutShape], layout: &Layout, params: &SheetParams) -> Result<(), SheetError> {
    let Some(stock) = params.stock()? else { return Ok(()) };
    for shape in shapes {
        let all = layout.sheets.iter().flat_map(|s| &s.placed);
        let times = all.filter(|p| p.piece == shape.piece).count();
        if times != 1 {
            return Err(SheetError::NotPlacedOnce { piece: shape.piece, times });
        }
    }
    layout.sheets.iter().try_for_each(|sheet| verify_sheet(shapes, sheet, &stock))
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

    /// Whether a point is covered by the piece: inside the outline and in none of its holes.
    fn covers(&self, p: DVec2) -> bool {
        let mut contours = self.contours.iter();
        let in_outline = contours.next().is_some_and(|c| locate(c, p) != Location::Outside);
        in_outline && contours.all(|c| locate(c, p) != Location::Inside)
    }
}

fn verify_sheet(shapes: &[CutShape], sheet: &Sheet, stock: &Stock) -> Result<(), SheetError> {
    let mut laid: Vec<Laid> = Vec::new();
    for placed in &sheet.placed {
        let shape = shapes.iter().find(|s| s.piece == placed.piece);
        let shape = shape.ok_or(SheetError::NotPlacedOnce { piece: placed.piece, times: 0 })?;
        let here = Laid::new(shape, placed);
        let low = DVec2::splat(stock.margin) - here.low;
        let high = here.high - (stock.size - DVec2::splat(stock.margin));
        let by = low.max(high).max_element();
        if by > 3.0 * stock.rounding() {
            return Err(SheetError::OverMargin { piece: here.piece, sheet: sheet.id, by });
        }
        laid.push(here);
    }
    let least = stock.spacing - 6.0 * stock.rounding();
    for (i, a) in laid.iter().enumerate() {
        for b in &laid[..i] {
            let apart = (a.low - b.high).max(b.low - a.high).max(DVec2::ZERO).length();
            if apart >= least {
                continue;
            }
            let distance = distance(a, b);
            if distance < least || distance.is_nan() {
                let (first, second) = (b.piece, a.piece);
                return Err(SheetError::TooClose { first, second, sheet: sheet.id, distance, spacing: stock.spacing });
            }
        }
    }
    Ok(())
}

/// The distance in mm between two placed pieces; 0 when they touch or overlap. A piece inside a hole of another does not
/// overlap it.
pub fn clearance(a: (&CutShape, &Placed), b: (&CutShape, &Placed)) -> f64 {
    distance(&Laid::new(a.0, a.1), &Laid::new(b.0, b.1))
}

fn distance(a: &Laid, b: &Laid) -> f64 {
    let one_covers = |x: &Laid, y: &Laid| y.contours.first().and_then(|c| c.first()).is_some_and(|&p| x.covers(p));
    if one_covers(a, b) || one_covers(b, a) {
        return 0.0;
    }
    let pairs = a.contours.iter().flat_map(|c| b.contours.iter().map(move |d| (c, d)));
    pairs.map(|(c, d)| contour_distance(c, d)).fold(f64::INFINITY, f64::min)
}

/// The least distance between two closed contours; 0 when they cross.
fn contour_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    let crossing = edges(a).any(|(p, q)| edges(b).any(|(r, s)| segments_cross(p, q, r, s)));
    if crossing {
        return 0.0;
    }
    // Without a crossing the least distance is at a corner of one of them.
    let from_a = a.iter().map(|&p| distance_to_contour(p, b));
    let from_b = b.iter().map(|&p| distance_to_contour(p, a));
    from_a.chain(from_b).fold(f64::INFINITY, f64::min)
}

/// The distance from a point to a closed contour.
pub(crate) fn distance_to_contour(p: DVec2, contour: &[DVec2]) -> f64 {
    edges(contour).map(|(a, b)| distance_to_segment(p, a, b)).fold(f64::INFINITY, f64::min)
}

/// The distance from a point to a closed segment.
pub(crate) fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * t)
}

/// The edges of a closed contour.
pub(crate) fn edges(contour: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    contour.iter().zip(contour.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
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
        let sheet = Sheet { id: SheetId(0), width: 600.0, height: 400.0, placed };
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
        assert!(matches!(crossing, Err(SheetError::TooClose { distance: 0.0, .. })), "{crossing:?}");
        let inside = check([(5.0, 5.0, 0.0), (108.0, 108.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(matches!(inside, Err(SheetError::TooClose { distance: 0.0, .. })), "{inside:?}");
    }

    #[test]
    fn the_margin_and_missing_pieces_are_found() {
        let over = check([(4.9, 5.0, 0.0), (60.0, 60.0, 0.0), (100.0, 100.0, 0.0)]);
        assert!(matches!(over, Err(SheetError::OverMargin { by, .. }) if (by - 0.1).abs() < 1e-9), "{over:?}");
        let turned = check([(5.0, 5.0, 0.0), (60.0, 60.0, 0.0), (595.0, 360.0, 45.0)]);
        assert!(matches!(turned, Err(SheetError::OverMargin { .. })), "{turned:?}");
        let missing = verify(&shapes(), &layout(vec![placed(0, 5.0, 5.0, 0.0)]), &SheetParams::default());
        assert_eq!(missing, Err(SheetError::NotPlacedOnce { piece: PieceId(1), times: 0 }));
        let stranger = verify(&shapes()[..0], &layout(vec![placed(0, 5.0, 5.0, 0.0)]), &SheetParams::default());
        assert_eq!(stranger, Err(SheetError::NotPlacedOnce { piece: PieceId(0), times: 0 }));
    }
}
