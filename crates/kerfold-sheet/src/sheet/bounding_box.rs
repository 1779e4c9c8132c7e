//! The smallest rectangle around a piece, and the turn that makes it fit on a sheet.
//!
//! Source: Freeman and Shapira 1975, "Determining the minimum-area encasing rectangle for an
//! arbitrary closed curve": one side of the smallest rectangle lies along an edge of the convex
//! hull.

use glam::DVec2;

use super::layout::Turn;
use crate::geom::polygon::{bounds, convex_hull};

/// Two boxes whose areas differ by less than this part are equally good; then the smaller turn
/// wins, whatever rounding says.
const TIE: f64 = 1e-9;

/// A bounding rectangle after a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Degrees by which the points must be turned counter-clockwise so that the box is upright; in
    /// [0, 180).
    pub angle: f64,
    /// Extent along x after the turn.
    pub width: f64,
    /// Extent along y after the turn.
    pub height: f64,
}

/// The bounding rectangle of least area, lying: `width` is at least `height`. All zero without
/// points.
///
/// # Example
/// ```
/// use glam::DVec2;
/// use kerfold_sheet::sheet::smallest_box;
///
/// // A square that stands on a corner.
/// let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(DVec2::from_array);
/// let found = smallest_box(&corners);
/// assert!((found.width - 2.0_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn smallest_box(points: &[DVec2]) -> OrientedBox {
    let hull = convex_hull(points);
    let best = best_of(&hull, flush_angles(&hull).into_iter(), |_| true);
    best.map_or(OrientedBox { angle: 0.0, width: 0.0, height: 0.0 }, |b| {
        if b.width < b.height {
            OrientedBox { angle: b.angle + 90.0, width: b.height, height: b.width }
        } else {
            b
        }
    })
}

/// The turn of least box area at which the points fit into `room`, width by height; `None` when
/// they fit at no angle.
///
/// Exact over all angles: where the points fit at all, they fit at a turn with a hull edge along an
/// axis, or at one where the box just touches the room; all of these are tried. `rounding` is how
/// much larger a box may be that is called fitting; at least 1e-10 of the room, since turns have
/// nine decimals.
pub(crate) fn fitting_box(points: &[DVec2], room: DVec2, rounding: f64) -> Option<OrientedBox> {
    let hull = convex_hull(points);
    let fits = |b: &OrientedBox| b.width <= room.x + rounding && b.height <= room.y + rounding;
    let flush = flush_angles(&hull);
    let upright = flush.iter().copied();
    let both = upright.clone().chain(upright.map(|a| a + 90.0));
    best_of(&hull, both, fits)
        .or_else(|| best_of(&hull, touching_angles(&hull, &flush, room).into_iter(), fits))
}

/// The box of the hull after a turn of `angle` degrees.
pub(crate) fn box_at(hull: &[DVec2], angle: f64) -> OrientedBox {
    let turn = Turn::degrees(angle);
    let turned: Vec<DVec2> = hull.iter().map(|&p| turn.apply(p - hull[0])).collect();
    let (low, high) = bounds(&turned).unwrap_or_default();
    OrientedBox { angle, width: high.x - low.x, height: high.y - low.y }
}

fn best_of(
    hull: &[DVec2],
    angles: impl Iterator<Item = f64>,
    allowed: impl Fn(&OrientedBox) -> bool,
) -> Option<OrientedBox> {
    let area = |b: &OrientedBox| b.width * b.height;
    let boxes = angles.map(|a| box_at(hull, a)).filter(allowed);
    boxes.reduce(|best, b| if area(&b) < area(&best) * (1.0 - TIE) { b } else { best })
}

/// The turns in [0, 90), ascending, that bring an edge of the hull parallel to an axis.
fn flush_angles(hull: &[DVec2]) -> Vec<f64> {
    let edges = hull.iter().zip(hull.iter().cycle().skip(1)).map(|(&a, &b)| b - a);
    let mut angles: Vec<f64> = edges
        .map(|e| rounded((-e.y.atan2(e.x)).to_degrees().rem_euclid(90.0)).rem_euclid(90.0))
        .collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// The turns in [0, 180) at which the box is exactly as wide or as high as the room.
fn touching_angles(hull: &[DVec2], flush: &[f64], room: DVec2) -> Vec<f64> {
    let mut stops: Vec<f64> = flush.iter().flat_map(|&a| [a, a + 90.0]).collect();
    stops.sort_by(f64::total_cmp);
    let first = stops.first().map(|&a| a + 180.0);
    stops.extend(first);
    let mut angles = Vec::new();
    for w in stops.windows(2) {
        // Between two stops the same two corners are the outermost ones, so that an extent is one
        // sine arc.
        let turn = Turn::degrees(w[0].midpoint(w[1]));
        let across = |key: fn(DVec2) -> f64| {
            let (mut low, mut high) = (hull[0], hull[0]);
            for &p in hull {
                let k = key(turn.apply(p - hull[0]));
                low = if k < key(turn.apply(low - hull[0])) { p } else { low };
                high = if k > key(turn.apply(high - hull[0])) { p } else { high };
            }
            high - low
        };
        // x after a turn of t is |d|·cos(direction + t), y is |e|·sin(direction + t).
        let d = across(|p| p.x);
        let e = across(|p| p.y);
        let wide = (room.x / d.length()).acos().to_degrees();
        let high = (room.y / e.length()).asin().to_degrees();
        let (at_d, at_e) = (d.y.atan2(d.x).to_degrees(), e.y.atan2(e.x).to_degrees());
        let solutions = [wide - at_d, -wide - at_d, high - at_e, 180.0 - high - at_e];
        let inside = |t: &f64| *t >= w[0] - 1e-9 && *t <= w[1] + 1e-9;
        let turns = solutions.map(|t| w[0] + (t - w[0] + 1e-9).rem_euclid(360.0) - 1e-9);
        angles.extend(turns.into_iter().filter(inside).map(|t| rounded(t.rem_euclid(180.0))));
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// Nine decimals: what the layout file shows is what was used.
pub(crate) fn rounded(value: f64) -> f64 {
    let scaled = (value * 1e9).round() / 1e9;
    // Adding zero turns −0 into 0.
    if scaled.is_finite() { scaled + 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rectangle(width: f64, height: f64, angle: f64) -> Vec<DVec2> {
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        corners
            .map(|(x, y)| Turn::degrees(angle).apply(DVec2::new(x, y)) + DVec2::new(1e3, -2e3))
            .to_vec()
    }

    #[test]
    fn an_upright_rectangle_stays_and_a_turned_one_comes_back() {
        assert_eq!(
            smallest_box(&rectangle(5.0, 2.0, 0.0)),
            OrientedBox { angle: 0.0, width: 5.0, height: 2.0 }
        );
        let found = smallest_box(&rectangle(5.0, 2.0, 30.0));
        assert!((found.width - 5.0).abs() < 1e-9 && (found.height - 2.0).abs() < 1e-9);
        assert!((found.angle - 150.0).abs() < 1e-7, "{}", found.angle);
        assert_eq!(smallest_box(&[]), OrientedBox { angle: 0.0, width: 0.0, height: 0.0 });
        assert_eq!(smallest_box(&[DVec2::ONE]).width, 0.0);
    }

    #[test]
    fn a_needle_fits_along_the_diagonal_only() {
        // 450 × 10 in a room of 400 × 300, whose diagonal is 500.
        let needle = rectangle(450.0, 10.0, 7.0);
        let room = DVec2::new(400.0, 300.0);
        let found = fitting_box(&needle, room, 1e-6).expect("fits along the diagonal");
        let real = box_at(&needle, found.angle);
        assert!(real.width <= 400.0 + 1e-6 && real.height <= 300.0 + 1e-6, "{real:?}");
        assert_eq!(fitting_box(&rectangle(495.0, 10.0, 7.0), room, 1e-6), None);
    }

    #[test]
    fn a_piece_exactly_as_large_as_the_room_fits_at_every_turn() {
        for angle in [0.0, 10.0, 45.0, 91.3] {
            let found =
                fitting_box(&rectangle(590.0, 390.0, angle), DVec2::new(590.0, 390.0), 1e-6);
            assert!(found.is_some(), "{angle}");
            assert!(
                fitting_box(&rectangle(590.01, 390.0, angle), DVec2::new(590.0, 390.0), 1e-6)
                    .is_none()
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// A fine scan over all angles never finds a smaller box, nor a fit where the exact search
        /// finds none.
        #[test]
        fn no_scanned_angle_is_better(
            points in prop::collection::vec((-50.0..50.0_f64, -20.0..20.0_f64), 3..12),
            room in (20.0..90.0_f64, 10.0..40.0_f64),
        ) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
            let hull = convex_hull(&points);
            let best = smallest_box(&points);
            let fit = fitting_box(&points, room.into(), 1e-7);
            for step in 0..1800 {
                let scanned = box_at(&hull, f64::from(step) * 0.1);
                prop_assert!(best.width * best.height <= scanned.width * scanned.height * (1.0 + 1e-9));
                if scanned.width <= room.0 && scanned.height <= room.1 {
                    prop_assert!(fit.is_some(), "fits at {} degrees", scanned.angle);
                }
            }
            if let Some(fit) = fit {
                prop_assert!(fit.width <= room.0 + 2e-7 && fit.height <= room.1 + 2e-7);
            }
        }
    }
}
