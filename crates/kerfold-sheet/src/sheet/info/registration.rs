//! Marks by which a cutting plotter finds a printed sheet again: a full square in the upper left
//! corner, and the corners of a frame in the upper right and the lower left one.
//!
//! This is the older of the two kinds that Silhouette machines look for. Where they are and how
//! large is typed into the page setup of Silhouette Studio, so it only has to be the same there.

use glam::DVec2;

use super::{Rectangle, rectangle};
use crate::sheet::drawing::Stroke;

/// From the borders of the sheet to the marks, in mm.
const INSET: f64 = 10.0;
/// Side of the square.
const SQUARE: f64 = 5.0;
/// Length of the lines of a corner, and their width.
const LENGTH: f64 = 20.0;
const WIDTH: f64 = 0.5;
/// From one stroke to the next where an area is filled; strokes are 0.2 mm wide.
const PITCH: f64 = 0.15;
/// What a sensor wants to be white around a mark, and the least margin.
const WHITE: f64 = 2.0;
pub(super) const LEAST_MARGIN: f64 = INSET + SQUARE;

/// The marks of a sheet with the places that they take; none for a sheet that they do not fit on.
pub(super) fn marks(size: DVec2, margin: f64) -> Vec<(Vec<Stroke>, Rectangle)> {
    if margin < LEAST_MARGIN || size.min_element() < 2.0 * (INSET + LENGTH) + SQUARE {
        return Vec::new();
    }
    let (left, right) = (INSET, size.x - INSET);
    let (low, high) = (INSET, size.y - INSET);
    let square = [DVec2::new(left, high - SQUARE), DVec2::new(left + SQUARE, high)];
    let upper_right = [
        [DVec2::new(right - LENGTH, high - WIDTH), DVec2::new(right, high)],
        [DVec2::new(right - WIDTH, high - LENGTH), DVec2::new(right, high)],
    ];
    let lower_left = [
        [DVec2::new(left, low), DVec2::new(left + LENGTH, low + WIDTH)],
        [DVec2::new(left, low), DVec2::new(left + WIDTH, low + LENGTH)],
    ];
    [&[square][..], &upper_right, &lower_left]
        .into_iter()
        .map(|bars| (bars.iter().flat_map(|&bar| filled(bar)).collect(), around(bars)))
        .collect()
}

/// An area as rectangles within one another, and a line in the middle of a narrow one.
fn filled([low, high]: Rectangle) -> Vec<Stroke> {
    let middle = low.midpoint(high);
    let rings = ((high - low).min_element() / (2.0 * PITCH)).floor() as usize;
    // The middle of a stroke of 0.2 mm lies half of that inside.
    let ring = |i: usize| DVec2::splat(0.1 + PITCH * i as f64);
    (0..=rings)
        .map(|i| [(low + ring(i)).min(middle), (high - ring(i)).max(middle)])
        .filter(|[low, high]| low != high)
        .map(rectangle)
        .collect()
}

fn around(bars: &[Rectangle]) -> Rectangle {
    let low = bars.iter().map(|bar| bar[0]).reduce(DVec2::min).unwrap_or_default();
    let high = bars.iter().map(|bar| bar[1]).reduce(DVec2::max).unwrap_or_default();
    [low - DVec2::splat(WHITE), high + DVec2::splat(WHITE)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_marks_stand_in_the_margin_as_they_are_typed_in() {
        let size = DVec2::new(304.8, 609.6);
        let made = marks(size, 15.0);
        assert_eq!(made.len(), 3);
        let points: Vec<DVec2> =
            made.iter().flat_map(|(s, _)| s).flat_map(|s| &s.points).copied().collect();
        // Strokes are 0.2 mm wide.
        let low = points.iter().copied().reduce(DVec2::min).expect("points") - DVec2::splat(0.1);
        let high = points.iter().copied().reduce(DVec2::max).expect("points") + DVec2::splat(0.1);
        assert!(low.distance(DVec2::splat(INSET)) < 1e-9);
        assert!(high.distance(size - DVec2::splat(INSET)) < 1e-9);
        let inner = |p: &&DVec2| {
            let border = p.min(size - **p);
            border.min_element() > LEAST_MARGIN
        };
        assert_eq!(points.iter().find(inner), None, "parts begin at the margin");
        assert!(marks(size, 14.9).is_empty() && marks(DVec2::splat(60.0), 15.0).is_empty());
    }
}
