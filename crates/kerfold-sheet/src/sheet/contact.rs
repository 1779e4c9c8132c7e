//! Whether two parts that may touch overlap: found from where their borders run, without moving
//! anything.
//!
//! The border of one is divided where it meets the border of the other. Each stretch then lies
//! outside, inside, or on the other border; inside is an overlap, and so is on it in the same
//! direction, since material lies on the left of every contour.

use glam::DVec2;

use super::distance::{distance_to_segment, edges};
use crate::geom::polygon::{Location, bounds, locate};

/// Whether two parts, each an outline counter-clockwise and holes clockwise, overlap by more than
/// `tolerance` mm.
pub(crate) fn overlap(a: &[Vec<DVec2>], b: &[Vec<DVec2>], tolerance: f64) -> bool {
    runs_inside(a, b, tolerance) || runs_inside(b, a, tolerance)
}

/// Whether a contour reaches beyond the outline of its sheet, both counter-clockwise, by more than
/// `tolerance` mm.
pub(crate) fn sticks_out(contour: &[DVec2], outline: &[DVec2], tolerance: f64) -> bool {
    let Some((low, high)) = bounds(contour.iter().chain(outline)) else { return false };
    // What lies around the sheet, as if it were material with a hole.
    let by = high - low + DVec2::splat(2.0 * tolerance);
    let (low, high) = (low - by, high + by);
    let frame = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let hole = outline.iter().rev().copied().collect();
    runs_inside(&[contour.to_vec()], &[frame, hole], tolerance)
}

fn runs_inside(a: &[Vec<DVec2>], b: &[Vec<DVec2>], tolerance: f64) -> bool {
    let sides: Vec<(DVec2, DVec2)> = b.iter().flat_map(|c| edges(c)).collect();
    a.iter().flat_map(|c| edges(c)).any(|(p, q)| {
        let length = p.distance(q);
        let grown = DVec2::splat(tolerance);
        let (low, high) = (p.min(q) - grown, p.max(q) + grown);
        let is_near =
            |&&(r, s): &&(DVec2, DVec2)| r.max(s).cmpge(low).all() && r.min(s).cmple(high).all();
        let near: Vec<(DVec2, DVec2)> = sides.iter().filter(is_near).copied().collect();
        let mut meets = vec![0.0, 1.0];
        near.iter().for_each(|&side| meets.extend(meetings((p, q), side, tolerance)));
        meets.sort_by(f64::total_cmp);
        let stretches = meets.windows(2).filter(|w| (w[1] - w[0]) * length > 2.0 * tolerance);
        let mut middles = stretches.map(|w| p.lerp(q, (w[0] + w[1]) / 2.0));
        middles.any(|middle| is_in((p, q), middle, b, &near, tolerance))
    })
}

/// Whether the stretch around a point of a side runs through the material of `b`, whose sides
/// nearby are given.
fn is_in(
    (p, q): (DVec2, DVec2),
    middle: DVec2,
    b: &[Vec<DVec2>],
    near: &[(DVec2, DVec2)],
    tolerance: f64,
) -> bool {
    let on = near.iter().find(|&&(r, s)| distance_to_segment(middle, r, s) <= tolerance);
    if let Some((r, s)) = on {
        return (q - p).dot(*s - *r) > 0.0;
    }
    let in_outline = b.first().is_some_and(|c| locate(c, middle) == Location::Inside);
    in_outline && b[1..].iter().all(|c| locate(c, middle) == Location::Outside)
}

/// Where along `p`–`q`, from 0 to 1, the side `r`–`s` crosses it or has an end on it.
fn meetings(
    (p, q): (DVec2, DVec2),
    (r, s): (DVec2, DVec2),
    tolerance: f64,
) -> impl Iterator<Item = f64> {
    let (along, across) = (q - p, s - r);
    let ends = [r, s].into_iter().filter(move |&e| distance_to_segment(e, p, q) <= tolerance);
    let ends = ends.map(move |e| (e - p).dot(along) / along.length_squared());
    let cross = along.perp_dot(across);
    let (t, u) = ((r - p).perp_dot(across) / cross, (r - p).perp_dot(along) / cross);
    let crosses = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u);
    ends.chain(crosses.then_some(t)).filter(|t| (0.0..=1.0).contains(t))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{ell, points, square};
    use super::*;

    fn moved(contour: &[DVec2], x: f64, y: f64) -> Vec<Vec<DVec2>> {
        vec![contour.iter().map(|&p| p + DVec2::new(x, y)).collect()]
    }

    #[test]
    fn what_only_touches_does_not_overlap() {
        let a = [square(10.0)];
        for (x, y) in [(10.0, 0.0), (10.0, 3.0), (-10.0, 10.0), (0.0, 1e-7 - 10.0), (50.0, 0.0)] {
            assert!(!overlap(&a, &moved(&square(10.0), x, y), 1e-6), "{x} {y}");
        }
        // Into the notch of an L, and into a hole of the same size.
        assert!(!overlap(&[ell()], &moved(&square(20.0), 20.0, 20.0), 1e-6));
        let hole: Vec<DVec2> =
            square(4.0).into_iter().rev().map(|p| p + DVec2::splat(3.0)).collect();
        assert!(!overlap(&[square(10.0), hole], &moved(&square(4.0), 3.0, 3.0), 1e-6));
    }

    #[test]
    fn what_sticks_out_of_a_sheet_is_found_and_what_lies_on_its_border_is_not() {
        let turned = |by: f64| -> Vec<DVec2> {
            ell().iter().map(|p| DVec2::from_angle(by).rotate(*p) + DVec2::splat(70.0)).collect()
        };
        for by in [0.0, 0.3, 1.1, 2.9] {
            // In itself, with every corner off by rounding.
            let sheet = turned(by);
            let shaken = |scale: f64| -> Vec<DVec2> {
                let off = |(i, p): (usize, &DVec2)| *p + DVec2::from_angle(i as f64) * scale;
                sheet.iter().enumerate().map(off).collect()
            };
            assert!(!sticks_out(&sheet, &sheet, 1e-9), "{by}");
            assert!(!sticks_out(&shaken(1e-12), &sheet, 1e-9), "{by}");
            assert!(sticks_out(&shaken(1e-3), &sheet, 1e-9), "{by}");
            // Beside it, and across its notch with all corners inside.
            let beside: Vec<DVec2> = sheet.iter().map(|p| *p + DVec2::splat(500.0)).collect();
            assert!(sticks_out(&beside, &sheet, 1e-9), "{by}");
        }
        let across = points([(5.0, 35.0), (35.0, 5.0), (35.0, 8.0), (8.0, 35.0)]);
        assert!(sticks_out(&across, &ell(), 1e-9));
    }

    #[test]
    fn what_overlaps_is_found_however_the_borders_run() {
        let a = [square(10.0)];
        for (x, y) in [(0.0, 0.0), (9.99, 0.0), (5.0, 0.0), (3.0, -4.0), (0.0, 1e-4 - 10.0)] {
            assert!(overlap(&a, &moved(&square(10.0), x, y), 1e-6), "{x} {y}");
        }
        assert!(overlap(&a, &moved(&square(4.0), 3.0, 3.0), 1e-6), "one in the other");
        // All corners of one on the border of the other, and the other way round.
        let diamond = points([(5.0, 0.0), (10.0, 5.0), (5.0, 10.0), (0.0, 5.0)]);
        assert!(overlap(&a, &[diamond], 1e-6));
        let half = points([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]);
        assert!(overlap(&a, &[half], 1e-6));
    }
}
