//! Cuts without width: slits of an outline, and the ends of notches that are narrower than the
//! kerf.
//!
//! An opened edge between two faces in one plane has two sides in the same place: two lines where
//! the machine must cut once. And where a notch is narrower than the kerf, an outline grown by half
//! the kerf closes before the notch ends, so that its flaps would stay connected. Both become single
//! open cuts that end on the closed one.

use glam::DVec2;

use super::kerf::CutShape;
use super::verify::edges;
use crate::geom::polygon::{bounds, segments_cross};
use crate::geom::predicate::orient2d;

/// Files hold four decimals of a millimetre: what is narrower, along both axes, may be one line
/// there.
const FILE_STEP: f64 = 1.5e-4;

/// The same for small pieces, relative to their size.
const RELATIVE_STEP: f64 = 1e-6;

/// How far before the mouth of a slit its contour may lie, in kerfs.
const REACH: f64 = 4.0;

/// Takes the spikes out of a contour: corners whose two edges lie on one another. Gives the rest of
/// the contour, empty when nothing else is left, and the spikes, each from its tip to its base.
pub(crate) fn take_spikes(contour: &[DVec2]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let mut rest = contour.to_vec();
    let mut spikes: Vec<Vec<DVec2>> = Vec::new();
    let (low, high) = bounds(contour).unwrap_or_default();
    let step = FILE_STEP.min(RELATIVE_STEP * (high - low).length());
    while let Some(i) = spike_at(&rest, step) {
        let n = rest.len();
        let base = rest[(i + n - 1) % n];
        add_edge(&mut spikes, rest[i], base);
        // The tip goes, and so does one of the two corners at the base.
        let next = (i + 1) % n;
        for gone in [i.max(next), i.min(next)] {
            rest.remove(gone);
        }
    }
    if let [a, b] = rest[..] {
        // Whichever end a spike has reached goes on from there.
        let (a, b) = if spikes.iter().any(|s| s.last() == Some(&b)) { (b, a) } else { (a, b) };
        add_edge(&mut spikes, a, b);
        rest.clear();
    }
    (rest, spikes)
}

fn spike_at(contour: &[DVec2], step: f64) -> Option<usize> {
    let n = contour.len();
    let is_spike = |i: usize| {
        let (before, tip, after) = (contour[(i + n - 1) % n], contour[i], contour[(i + 1) % n]);
        before.distance(after) <= step && before.distance(tip) > step
    };
    if n < 3 { None } else { (0..n).find(|&i| is_spike(i)) }
}

/// Adds an edge to the spike that ends at its tip, or begins a new one.
fn add_edge(spikes: &mut Vec<Vec<DVec2>>, tip: DVec2, base: DVec2) {
    match spikes.iter_mut().find(|s| s.last() == Some(&tip)) {
        Some(spike) => spike.push(base),
        None => spikes.push(vec![tip, base]),
    }
}

/// The open cuts of a grown shape: the narrow notches of the contours that it grew from, and the
/// spikes led to its edge; and the number of notches whose cut would have gone through the piece.
pub(crate) fn notch_slits(
    contours: &[Vec<DVec2>],
    spikes: &[Vec<DVec2>],
    grown: &CutShape,
    kerf: f64,
) -> (Vec<Vec<DVec2>>, usize) {
    let mut slits = Vec::new();
    let mut closed = 0;
    for contour in contours {
        for apex in (0..contour.len()).filter(|&i| is_narrow(contour, i)) {
            let Some(mut slit) =
                notch_slit(contour, apex, grown, kerf).filter(|s| stays_outside(s, contours))
            else {
                closed += 1;
                continue;
            };
            let carries_spike = spikes.iter().any(|s| s.last() == Some(&contour[apex]));
            if !carries_spike {
                shorten(&mut slit, kerf / 2.0);
            }
            slits.push(slit);
        }
    }
    for spike in spikes {
        let mut slit = spike.clone();
        shorten(&mut slit, kerf / 2.0);
        let base = spike.last().copied().unwrap_or_default();
        let corner =
            contours.iter().find_map(|c| c.iter().position(|&p| p == base).map(|i| (c, i)));
        if let (Some((contour, i)), Some(from)) = (corner, spike.iter().rev().nth(1))
            && !is_narrow(contour, i)
        {
            let ahead = base + (base - *from).normalize_or_zero() * (REACH * kerf);
            slit.extend(first_hit(base, ahead, grown));
        }
        slits.push(slit);
    }
    (slits, closed)
}

/// Whether more than the kerf would stay uncut at the end of the notch at corner `i`: the beam of
/// radius r stops r / sin α before it, α being half the notch's angle.
fn is_narrow(contour: &[DVec2], i: usize) -> bool {
    let n = contour.len();
    let (before, apex, after) = (contour[(i + n - 1) % n], contour[i], contour[(i + 1) % n]);
    let half_sine =
        (before - apex).normalize_or_zero().distance((after - apex).normalize_or_zero()) / 2.0;
    orient2d(before, apex, after) < 0.0 && half_sine < 1.0 / 3.0
}

/// The middle line of a notch from its end to the grown contour; `None` when it never gets there.
///
/// Two points go along the two sides equally far, and the line between them has its middle on the
/// slit.
fn notch_slit(contour: &[DVec2], apex: usize, grown: &CutShape, kerf: f64) -> Option<Vec<DVec2>> {
    let n = contour.len();
    let mut slit = vec![contour[apex]];
    let (mut left, mut right) = (contour[apex], contour[apex]);
    let (mut next_left, mut next_right) = (1, 1);
    while next_left + next_right <= n {
        let (to_left, to_right) =
            (contour[(apex + n - next_left) % n], contour[(apex + next_right) % n]);
        let (l, r) = (left.distance(to_left), right.distance(to_right));
        let step = l.min(r);
        // The nearer corner is reached; the farther one only when it is equally far.
        (left, next_left) = if l <= r {
            (to_left, next_left + 1)
        } else {
            (left.lerp(to_left, step / l), next_left)
        };
        (right, next_right) = if r <= l {
            (to_right, next_right + 1)
        } else {
            (right.lerp(to_right, step / r), next_right)
        };
        let from = *slit.last()?;
        let to = left.midpoint(right);
        if let Some(hit) = first_hit(from, to, grown) {
            slit.push(hit);
            return Some(slit);
        }
        if left.distance(right) > kerf {
            // Out of the mouth, which the kerf has closed: straight on to the contour before it.
            let (&end, &before) = (slit.last()?, slit.iter().rev().nth(1)?);
            slit.push(first_hit(
                end,
                end + (end - before).normalize_or_zero() * (REACH * kerf),
                grown,
            )?);
            return Some(slit);
        }
        if from != to {
            slit.push(to);
        }
    }
    None
}

/// Whether a slit crosses none of the contours that bound the material.
fn stays_outside(slit: &[DVec2], contours: &[Vec<DVec2>]) -> bool {
    let crosses = |w: &[DVec2]| {
        contours.iter().any(|c| edges(c).any(|(a, b)| segments_cross(w[0], w[1], a, b)))
    };
    !slit.windows(2).any(crosses)
}

/// Moves the first point inwards, so that the round end of the beam reaches just where it was.
fn shorten(slit: &mut [DVec2], by: f64) {
    if let [first, second, ..] = slit {
        let length = first.distance(*second);
        if length > 2.0 * by {
            *first = first.lerp(*second, by / length);
        }
    }
}

/// Where the segment from `a` to `b` first meets a contour of the shape.
fn first_hit(a: DVec2, b: DVec2, shape: &CutShape) -> Option<DVec2> {
    let along = b - a;
    let mut first = f64::INFINITY;
    for contour in shape.contours() {
        for (c, d) in edges(contour) {
            let edge = d - c;
            let cross = along.perp_dot(edge);
            if cross == 0.0 {
                continue;
            }
            let t = (c - a).perp_dot(edge) / cross;
            let u = (c - a).perp_dot(along) / cross;
            // A little beyond its ends the edge counts too: a hit at a corner must not slip
            // through.
            if (0.0..=1.0).contains(&t) && (-1e-9..=1.0 + 1e-9).contains(&u) {
                first = first.min(t);
            }
        }
    }
    (first <= 1.0).then(|| a.lerp(b, first))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{piece, points, square};
    use super::super::verify::distance_to_contour;
    use super::*;
    use crate::geom::polygon::signed_area;
    use crate::net::PieceId;

    /// A square of 100 mm with a slit in two edges that goes in from the middle of the right side.
    fn slit_square(width: f64) -> Vec<DVec2> {
        let w = width / 2.0;
        let low =
            [(0.0, 0.0), (100.0, 0.0), (100.0, 50.0 - 2.0 * w), (70.0, 50.0 - w), (50.0, 60.0)];
        points(low)
            .into_iter()
            .chain(points([
                (70.0, 50.0 + w),
                (100.0, 50.0 + 2.0 * w),
                (100.0, 100.0),
                (0.0, 100.0),
            ]))
            .collect()
    }

    fn cut(contour: Vec<DVec2>, kerf: f64) -> CutShape {
        CutShape::of_piece(&piece(PieceId(0), contour), kerf).expect("a sound piece")
    }

    #[test]
    fn a_slit_without_width_is_cut_once() {
        let shape = cut(slit_square(0.0), 0.0);
        assert_eq!(shape.outline.len(), 5);
        assert_eq!(shape.slits, [points([(50.0, 60.0), (70.0, 50.0), (100.0, 50.0)])]);
        assert_eq!(shape.area(), 1e4);
    }

    #[test]
    fn with_a_kerf_the_slit_reaches_the_grown_outline() {
        for width in [0.0, 1e-13, 0.02] {
            let shape = cut(slit_square(width), 0.2);
            assert_eq!(shape.slits.len(), 1, "width {width}");
            let end = *shape.slits[0].last().expect("points");
            assert!(distance_to_contour(end, &shape.outline) < 1e-6, "width {width}: {end}");
            let start = shape.slits[0][0];
            assert!(
                (start.distance(DVec2::new(50.0, 60.0)) - 0.1).abs() < 1e-3,
                "width {width}: {start}"
            );
            assert!((signed_area(&shape.outline) - 100.2 * 100.2).abs() < 0.5, "width {width}");
        }
    }

    #[test]
    fn a_wide_notch_needs_no_slit_and_a_narrow_one_is_cut_to_its_end() {
        let notch = |half: f64| {
            points([
                (0.0, 0.0),
                (100.0, 0.0),
                (100.0, 50.0 - half),
                (50.0, 50.0),
                (100.0, 50.0 + half),
                (100.0, 100.0),
                (0.0, 100.0),
            ])
        };
        assert!(cut(notch(25.0), 0.2).slits.is_empty());
        let narrow = cut(notch(1.0), 0.2);
        // The grown sides meet 0.1 / sin(1.15°) before the end.
        let expected = points([(50.1, 50.0), (50.0 + 0.1 * 50.0_f64.hypot(1.0), 50.0)]);
        assert_eq!(narrow.slits.len(), 1);
        for (found, expected) in narrow.slits[0].iter().zip(&expected) {
            assert!(found.distance(*expected) < 1e-4, "{found} {expected}");
        }
    }

    #[test]
    fn a_hole_that_is_a_slit_becomes_a_cut() {
        let mut piece = piece(PieceId(0), square(50.0));
        piece.holes = vec![points([(10.0, 10.0), (20.0, 10.0), (30.0, 20.0), (20.0, 10.0)])];
        for kerf in [0.0, 0.1] {
            let shape = CutShape::of_piece(&piece, kerf).expect("a square with a slit");
            assert!(shape.holes.is_empty());
            assert_eq!(shape.slits.len(), 1);
            assert_eq!(shape.lost_holes, 0);
        }
    }

    #[test]
    fn a_branched_slit_keeps_all_its_arms() {
        let y = points([
            (0.0, 0.0),
            (100.0, 0.0),
            (100.0, 50.0),
            (60.0, 50.0),
            (40.0, 30.0),
            (60.0, 50.0),
            (40.0, 70.0),
            (60.0, 50.0),
            (100.0, 50.0),
            (100.0, 100.0),
            (0.0, 100.0),
        ]);
        let (rest, spikes) = take_spikes(&y);
        assert_eq!(rest.len(), 5);
        let length: f64 =
            spikes.iter().flat_map(|s| s.windows(2)).map(|w| w[0].distance(w[1])).sum();
        assert!((length - (40.0 + 2.0 * 800.0_f64.sqrt())).abs() < 1e-9, "{spikes:?}");
    }
}
