//! Fewer corners for the search: an outline with very many is drawn a little larger, a hole a
//! little smaller, never the other way, so that what keeps its distance in the search keeps it in
//! truth.
//!
//! A concave corner is left out, which fills a notch; a convex side is left out by lengthening its
//! neighbours until they meet. The change that adds the least area comes first.

use glam::DVec2;

use crate::geom::polygon::{bounds, segments_cross};
use crate::geom::predicate::orient2d;

/// Outlines up to this number of corners stay as they are.
const ENOUGH_CORNERS: usize = 24;
/// How far a contour may move outwards, as a part of its size.
const MOST_MOVED: f64 = 1e-3;

/// The outline and its holes with fewer corners.
pub(super) fn simplified(outline: &[DVec2], holes: &[Vec<DVec2>]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let (low, high) = bounds(outline).unwrap_or_default();
    let most = MOST_MOVED * (high - low).length();
    // A hole runs clockwise: the material lies on the same side of every contour, so one rule
    // serves both.
    (fewer(outline, most), holes.iter().map(|h| fewer(h, most)).collect())
}

/// One way to lose a corner, at place `at`: what is put instead of how many corners, and the area
/// that it adds.
struct Change {
    at: usize,
    instead: Option<DVec2>,
    area: f64,
}

fn fewer(contour: &[DVec2], most: f64) -> Vec<DVec2> {
    let mut contour = contour.to_vec();
    while contour.len() > ENOUGH_CORNERS {
        let n = contour.len();
        let mut changes: Vec<Change> = (0..n).filter_map(|i| change(&contour, i, most)).collect();
        changes.sort_by(|a, b| a.area.total_cmp(&b.area).then(a.at.cmp(&b.at)));
        let Some(change) = changes.into_iter().find(|c| is_free(&contour, c)) else { break };
        let next = (change.at + 1) % n;
        match change.instead {
            Some(corner) => {
                contour[change.at] = corner;
                contour.remove(next);
            }
            None => _ = contour.remove(change.at),
        }
    }
    contour
}

fn change(contour: &[DVec2], i: usize, most: f64) -> Option<Change> {
    let n = contour.len();
    let at = |k: usize| contour[(i + k + n) % n];
    let (before, here, next, after) = (at(n - 1), at(0), at(1), at(2));
    let turn = orient2d(before, here, next);
    if turn <= 0.0 {
        let moved = -turn / before.distance(next);
        return (moved <= most || turn == 0.0).then_some(Change {
            at: i,
            instead: None,
            area: -turn / 2.0,
        });
    }
    if orient2d(here, next, after) <= 0.0 {
        return None;
    }
    // The lines before → here and next → after meet beyond the side, if the two corners together
    // turn by less than 180°.
    let (d, e) = (here - before, after - next);
    let cross = d.perp_dot(e);
    if cross <= 0.0 {
        return None;
    }
    let corner = here + d * ((next - here).perp_dot(e) / cross);
    let area = orient2d(here, corner, next).abs() / 2.0;
    let moved = 2.0 * area / here.distance(next);
    (corner.is_finite() && moved <= most).then_some(Change { at: i, instead: Some(corner), area })
}

/// Whether the new sides of a change cross no other side.
fn is_free(contour: &[DVec2], change: &Change) -> bool {
    let n = contour.len();
    let at = |k: usize| contour[(change.at + k) % n];
    let new: Vec<[DVec2; 2]> = match change.instead {
        Some(corner) => vec![[at(n - 1), corner], [corner, at(2)]],
        None => vec![[at(n - 1), at(1)]],
    };
    let (low, high) = bounds(new.iter().flatten()).unwrap_or_default();
    // The sides that go, and those that only become longer, may be touched.
    let gone = change.instead.map_or(2, |_| 3);
    (gone..n).all(|k| {
        let (a, b) = (at(n - 1 + k), at(k));
        let is_far = a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any();
        is_far || new.iter().all(|&[s, t]| !segments_cross(s, t, a, b))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::polygon::{Location, locate, signed_area};

    #[test]
    fn a_circle_with_many_corners_gets_few_and_stays_covered() {
        let circle: Vec<DVec2> =
            (0..720).map(|i| DVec2::from_angle(f64::from(i).to_radians() / 2.0) * 50.0).collect();
        let (fewer, _) = simplified(&circle, &[]);
        assert!(fewer.len() < 80, "{}", fewer.len());
        assert!(circle.iter().all(|&p| locate(&fewer, p) != Location::Outside
            || crate::sheet::distance::distance_to_contour(p, &fewer) < 1e-12));
        assert!(signed_area(&fewer) < signed_area(&circle) * 1.01);
        let hole: Vec<DVec2> = circle.iter().rev().copied().collect();
        let (_, holes) = simplified(&circle, &[hole]);
        assert!(holes[0].iter().all(|&p| p.length() <= 50.0 + 1e-12), "a hole never grows");
    }
}
