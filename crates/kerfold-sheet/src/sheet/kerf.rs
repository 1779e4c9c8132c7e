//! Kerf: outlines grow by half the width of the cut, holes shrink by as much, corners stay sharp.
//!
//! Growing is done by `i_overlay` on a grid of 2⁶¹ steps across the piece, which unites what
//! overlaps: no loops, at narrow notches neither. What growing would close is widened before, see
//! [`super::slit`].

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

use super::error::SheetError;
use super::slit::{channel_area, channels, has_narrow, take_spikes};
use crate::geom::polygon::{bounds, signed_area};
use crate::net::{Piece, PieceId};

/// Corners sharper than this are cut off square: the mitre would reach more than four times the
/// offset.
const SHARPEST_MITRE: f64 = 29.0;

/// Corners straighter than this would be found only roughly, so they are cut off as well; the bevel
/// lies less than a 10000th of the offset inside the mitre.
const STRAIGHTEST_MITRE: f64 = 1.0;

/// Width of a channel for a slit when there is no kerf, in mm.
const LEAST_CHANNEL: f64 = 0.2;

/// What is cut to get one piece, in the piece's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct CutShape {
    /// The piece.
    pub piece: PieceId,
    /// The outer cut, counter-clockwise; the piece's outline to the digit when the kerf is zero.
    pub outline: Vec<DVec2>,
    /// Inner cuts, clockwise.
    pub holes: Vec<Vec<DVec2>>,
    /// Holes that vanish because they are narrower than the kerf.
    pub lost_holes: usize,
    /// Notches narrower than the kerf that no channel could open without dividing the piece.
    pub closed_notches: usize,
    /// Slits, and notches narrower than the kerf, that are cut wider than they are.
    pub widened_notches: usize,
}

impl CutShape {
    /// What must be cut so that a piece comes out true to size with a cut of width `kerf` mm.
    ///
    /// # Errors
    /// [`SheetError::BadContour`] for a contour without area or with numbers that are not finite;
    /// [`SheetError::KerfSplit`] for an outline that crosses itself.
    pub fn of_piece(piece: &Piece, kerf: f64) -> Result<Self, SheetError> {
        let mut contours = Vec::new();
        let mut spikes = Vec::new();
        for (i, contour) in std::iter::once(&piece.outline).chain(&piece.holes).enumerate() {
            let bad =
                || SheetError::BadContour { piece: piece.id, contour: i, corners: contour.len() };
            if !contour.iter().all(|p| p.is_finite()) {
                return Err(bad());
            }
            let (rest, found) = take_spikes(contour);
            spikes.extend(found);
            let area = signed_area(&rest);
            // A hole that is nothing but a slit has no area and needs none.
            if rest.is_empty() && i > 0 && contour.len() > 1 {
                continue;
            }
            if rest.len() < 3 || !area.is_finite() || (area > 0.0) != (i == 0) {
                return Err(bad());
            }
            contours.push(rest);
        }
        let (low, high) = bounds(contours.iter().flatten()).unwrap_or_default();
        // A kerf below the rounding of the coordinates moves nothing; the grid could not show it
        // either.
        let kerf = if kerf > 1e-12 * (high - low).length() { kerf } else { 0.0 };
        if kerf == 0.0 && spikes.is_empty() {
            return Ok(Self::of_contours(piece.id, contours));
        }
        let opened = opened(contours, &spikes, kerf);
        let mut shape = grown(piece.id, &opened.contours, kerf)?;
        shape.closed_notches += opened.closed;
        shape.widened_notches = opened.widened;
        Ok(shape)
    }

    /// A shape that is cut along its contours, the outline first.
    fn of_contours(piece: PieceId, contours: Vec<Vec<DVec2>>) -> Self {
        let mut contours = contours.into_iter();
        let outline = contours.next().unwrap_or_default();
        let holes = contours.collect();
        Self { piece, outline, holes, lost_holes: 0, closed_notches: 0, widened_notches: 0 }
    }

    /// The area inside the cuts, in mm².
    pub fn area(&self) -> f64 {
        self.contours().map(|c| signed_area(c)).sum()
    }

    /// The outline, then the holes.
    pub fn contours(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        std::iter::once(&self.outline).chain(&self.holes)
    }
}

/// Contours whose slits and narrow notches are wide enough to be cut.
struct Opened {
    contours: Vec<Vec<DVec2>>,
    widened: usize,
    closed: usize,
}

/// Widens slits and narrow notches to channels that closed paths can follow. A channel that would
/// divide the piece is left out.
fn opened(contours: Vec<Vec<DVec2>>, spikes: &[Vec<DVec2>], kerf: f64) -> Opened {
    let is_open = spikes.is_empty() && !(kerf > 0.0 && contours.iter().any(|c| has_narrow(c)));
    if is_open {
        return Opened { contours, widened: 0, closed: 0 };
    }
    // A path into a channel and out again is as wide as the kerf; the cut is wider by it.
    let width = if kerf > 0.0 { 2.0 * kerf } else { LEAST_CHANNEL };
    let wide: Vec<Vec<DVec2>> = grow(&contours, width / 2.0).into_iter().flatten().collect();
    let channels = channels(&contours, spikes, (&wide, width), kerf > 0.0);
    let areas: Vec<Vec<Vec<DVec2>>> =
        channels.lines.iter().map(|line| channel_area(line, width)).collect();
    let mut opened = Opened { contours, widened: areas.len(), closed: channels.closed };
    if areas.is_empty() {
        return opened;
    }
    if let Some(contours) = without(&opened.contours, &areas.concat()) {
        opened.contours = contours;
        return opened;
    }
    opened.widened = 0;
    for area in &areas {
        match without(&opened.contours, area) {
            Some(contours) => (opened.contours, opened.widened) = (contours, opened.widened + 1),
            None => opened.closed += 1,
        }
    }
    opened
}

/// The contours of a shape without an area; nothing when it is not one piece any more.
fn without(contours: &[Vec<DVec2>], area: &[Vec<DVec2>]) -> Option<Vec<Vec<DVec2>>> {
    let centre = middle(contours);
    let (subject, clip) = (numbers(contours, centre), numbers(area, centre));
    let shapes = subject.overlay_as::<i64>(&clip, OverlayRule::Difference, FillRule::NonZero);
    let mut shapes = shapes.into_iter();
    let first = shapes.next().filter(|_| shapes.next().is_none())?;
    let points = |c: Vec<[f64; 2]>| c.into_iter().map(|p| DVec2::from(p) + centre).collect();
    Some(first.into_iter().map(points).collect())
}

/// The middle of the box of contours, from which grids lose the fewest digits.
fn middle(contours: &[Vec<DVec2>]) -> DVec2 {
    let (low, high) = bounds(contours.iter().flatten()).unwrap_or_default();
    low.midpoint(high)
}

fn numbers(contours: &[Vec<DVec2>], centre: DVec2) -> Vec<Vec<[f64; 2]>> {
    contours.iter().map(|c| c.iter().map(|&p| (p - centre).to_array()).collect()).collect()
}

/// What is cut around contours with a kerf; the contours themselves without one.
fn grown(piece: PieceId, contours: &[Vec<DVec2>], kerf: f64) -> Result<CutShape, SheetError> {
    if kerf == 0.0 {
        return Ok(CutShape::of_contours(piece, contours.to_vec()));
    }
    let shapes = grow(contours, kerf / 2.0);
    let parts = shapes.len();
    let shape = shapes.into_iter().next().filter(|shape| parts == 1 && !shape.is_empty());
    let shape = shape.ok_or(SheetError::KerfSplit { piece, parts })?;
    let mut grown = CutShape::of_contours(piece, shape);
    grown.lost_holes = (contours.len() - 1).saturating_sub(grown.holes.len());
    // A notch that closes at its mouth only leaves a hole more, and its flaps together.
    grown.closed_notches = (grown.holes.len() + 1).saturating_sub(contours.len());
    Ok(grown)
}

/// The Minkowski sum with a disc of radius `by`, its arcs drawn as mitres.
fn grow(contours: &[Vec<DVec2>], by: f64) -> Vec<Vec<Vec<DVec2>>> {
    let centre = middle(contours);
    let shape = numbers(contours, centre);
    let style = OutlineStyle::new(by)
        .line_join(LineJoin::Miter(SHARPEST_MITRE.to_radians()))
        .miter_min_turn(STRAIGHTEST_MITRE.to_radians());
    let to_points = |c: Vec<[f64; 2]>| {
        let points: Vec<DVec2> = c.into_iter().map(|p| DVec2::from(p) + centre).collect();
        sharpened(straightened(points, by), SHORT_BEVEL * by)
    };
    let shapes = shape.outline_as::<i64>(&style);
    // A notch just as wide as the kerf ends in a line that is cut on both its sides: the open cut
    // of the notch is enough.
    let to_points = |c| {
        let points = to_points(c);
        let (rest, _) = take_spikes(&points);
        if rest.is_empty() { points } else { rest }
    };
    shapes.into_iter().map(|s| s.into_iter().map(to_points).collect()).collect()
}

/// A contour without the points that growing by `by` leaves on straight edges beside a mitre: where
/// it turns by no more than rounding, no further from a corner than a mitre reaches.
fn straightened(points: Vec<DVec2>, by: f64) -> Vec<DVec2> {
    let n = points.len();
    let is_idle = |i: usize| {
        let (a, p, b) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let (u, v) = (p - a, b - p);
        let turn = u.perp_dot(v).abs() / (u.length() * v.length());
        u.length().min(v.length()) < 4.0 * by && u.dot(v) > 0.0 && turn < NO_TURN
    };
    let kept: Vec<DVec2> = (0..n).filter(|&i| !is_idle(i)).map(|i| points[i]).collect();
    if kept.len() < 3 { points } else { kept }
}

/// Turns below this, in radians, are rounding.
const NO_TURN: f64 = 1e-6;

/// Bevels shorter than this part of the offset become corners, where the edges around them turn by
/// less than about 11°.
const SHORT_BEVEL: f64 = 0.1;

/// The cosine of that angle.
const STRAIGHT: f64 = 0.98;

/// A contour whose runs of edges shorter than `least` have given way to the corner of the edges
/// around them. Growing cuts nearly straight corners off; such edges are shorter than any machine's
/// step and look like lines drawn twice.
fn sharpened(points: Vec<DVec2>, least: f64) -> Vec<DVec2> {
    let n = points.len();
    let at = |i: usize| points[i % n];
    let is_short = |i: usize| at(i).distance(at(i + 1)) < least;
    // Begin where a long edge begins, so that no run goes over the end.
    let Some(first) = (0..n).find(|&i| !is_short(i)) else { return points };
    let mut sharp: Vec<DVec2> = Vec::with_capacity(n);
    let mut i = first + 1;
    while i <= first + n {
        let run = (i..first + n).take_while(|&k| is_short(k)).count();
        let (before, q, r, after) = (at(i - 1), at(i), at(i + run), at(i + run + 1));
        let (u, v) = (q - before, r - after);
        let corner = q + u * ((r - q).perp_dot(v) / u.perp_dot(v));
        // Only nearly straight corners; what cuts a needle off square stays.
        let is_straight = u.dot(-v) > STRAIGHT * u.length() * v.length();
        if run > 0
            && is_straight
            && corner.is_finite()
            && corner.distance(q) < least
            && corner.distance(r) < least
        {
            sharp.push(corner);
        } else {
            sharp.extend((i..=i + run).map(at));
        }
        i += run + 1;
    }
    if sharp.len() < 3 { points } else { sharp }
}

#[cfg(test)]
mod tests {
    use super::super::distance::distance_to_contour;
    use super::super::testing::{ell, piece, points, random_convex, ring, square};
    use super::*;
    use crate::geom::polygon::{Location, locate, segments_cross};
    use proptest::prelude::*;

    fn cut(contour: Vec<DVec2>, kerf: f64) -> CutShape {
        CutShape::of_piece(&piece(PieceId(0), contour), kerf).expect("a sound piece")
    }

    fn assert_simple(contour: &[DVec2]) {
        let n = contour.len();
        for i in 0..n {
            for j in 0..i {
                let (a, b, c, d) =
                    (contour[i], contour[(i + 1) % n], contour[j], contour[(j + 1) % n]);
                assert!(!segments_cross(a, b, c, d), "edges {i} and {j} cross");
            }
        }
    }

    #[test]
    fn no_kerf_changes_no_digit() {
        let contour = random_convex(3);
        assert_eq!(cut(contour.clone(), 0.0).outline, contour);
    }

    #[test]
    fn a_square_grows_with_sharp_corners() {
        let grown = cut(square(10.0), 0.2);
        assert_eq!(grown.outline.len(), 4);
        assert!((grown.area() - 10.2 * 10.2).abs() < 1e-6, "{}", grown.area());
        assert_eq!(grown.widened_notches, 0);
    }

    #[test]
    fn nearly_straight_corners_stay_corners() {
        let n = 160;
        let round: Vec<DVec2> = (0..n)
            .map(|i| 50.0 * DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(n)))
            .collect();
        let grown = cut(round.clone(), 0.15);
        assert_eq!(grown.outline.len(), round.len());
        let turned = cut(random_convex(5), 0.15);
        assert_eq!(turned.outline.len(), random_convex(5).len());
        let mitre = 50.0 + 0.075 / (std::f64::consts::PI / f64::from(n)).cos();
        assert!(grown.outline.iter().all(|p| (p.length() - mitre).abs() < 1e-6));
    }

    #[test]
    fn a_hole_shrinks_and_a_narrow_one_is_counted() {
        let ring = ring(PieceId(0));
        let grown = CutShape::of_piece(&ring, 0.2).expect("a ring");
        assert_eq!(grown.holes.len(), 1);
        assert!((signed_area(&grown.holes[0]) + 9.8 * 9.8).abs() < 1e-6);
        assert!((signed_area(&grown.outline) - 30.2 * 30.2).abs() < 1e-6);
        let lost = CutShape::of_piece(&ring, 12.0).expect("a ring without its hole");
        assert_eq!((lost.holes.len(), lost.lost_holes), (0, 1));
    }

    /// A tab of 3 mm fits a slot of 3 mm after cutting, whatever the kerf: drawn, the tab is wider
    /// and the slot narrower by it.
    #[test]
    fn a_tab_of_three_millimetres_fits_a_slot_of_three() {
        let tab = points([
            (0.0, 0.0),
            (40.0, 0.0),
            (40.0, 20.0),
            (21.5, 20.0),
            (21.5, 23.0),
            (18.5, 23.0),
            (18.5, 20.0),
            (0.0, 20.0),
        ]);
        let mut plate = piece(PieceId(1), square(40.0));
        plate.holes = vec![points([(10.0, 10.0), (10.0, 13.0), (30.0, 13.0), (30.0, 10.0)])];
        for kerf in [0.08, 0.2, 0.5] {
            let drawn_tab = cut(tab.clone(), kerf).outline;
            let tops = drawn_tab.iter().filter(|p| p.y > 22.0).map(|p| p.x);
            let (low, high) =
                tops.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let slot = CutShape::of_piece(&plate, kerf).expect("a plate");
            let (from, to) = bounds(&slot.holes[0]).expect("a slot");
            let (drawn_tab, drawn_slot) = (high - low, to.y - from.y);
            assert!(
                (drawn_tab - (3.0 + kerf)).abs() < 1e-6 && (drawn_slot - (3.0 - kerf)).abs() < 1e-6
            );
            // The cut takes half its width on both sides of the line.
            assert!(((drawn_tab - kerf) - (drawn_slot + kerf)).abs() < 1e-6);
        }
    }

    #[test]
    fn a_concave_corner_keeps_its_distance() {
        let grown = cut(ell(), 1.0);
        assert_eq!(grown.outline.len(), 6);
        // 40 × 40 less 20 × 20, grown by 0.5 on all sides.
        assert!((grown.area() - (41.0 * 41.0 - 20.0 * 20.0)).abs() < 1e-6, "{}", grown.area());
    }

    #[test]
    fn a_notch_that_closes_at_its_mouth_is_counted() {
        let contour = points([
            (0.0, 0.0),
            (50.0, 0.0),
            (50.0, 24.95),
            (40.0, 24.95),
            (40.0, 10.0),
            (20.0, 10.0),
            (20.0, 40.0),
            (40.0, 40.0),
            (40.0, 25.05),
            (50.0, 25.05),
            (50.0, 50.0),
            (0.0, 50.0),
        ]);
        let grown = cut(contour.clone(), 0.2);
        assert_eq!((grown.holes.len(), grown.closed_notches, grown.lost_holes), (1, 1, 0));
        assert_eq!(cut(contour, 0.05).closed_notches, 0);
    }

    #[test]
    fn a_needle_is_cut_off_square_near_its_tip() {
        let grown = cut([(0.0, 0.0), (100.0, -1.0), (100.0, 1.0)].map(DVec2::from).to_vec(), 0.2);
        let reach = grown.outline.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
        assert!((-0.45..=-0.1).contains(&reach), "{reach}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        /// Star-shaped outlines with spikes and notches: every corner of the grown contour keeps
        /// half the kerf from what channels leave of the piece, the contour does not cross itself,
        /// and that lies inside. It is the piece where no channel had to be cut, and never more.
        #[test]
        fn grown_outlines_keep_their_distance(radii in prop::collection::vec(2.0..60.0_f64, 5..24), kerf in 0.01..2.0_f64) {
            let n = radii.len() as f64;
            let star: Vec<DVec2> = radii.iter().enumerate()
                .map(|(i, r)| DVec2::from_angle(i as f64 * std::f64::consts::TAU / n) * r).collect();
            let grown = cut(star.clone(), kerf);
            let left = opened(vec![star.clone()], &[], kerf).contours;
            let distance = |p: DVec2| {
                left.iter().map(|c| distance_to_contour(p, c)).fold(f64::INFINITY, f64::min)
            };
            if grown.widened_notches == 0 {
                prop_assert_eq!(left.as_slice(), std::slice::from_ref(&star));
            }
            for contour in grown.contours() {
                assert_simple(contour);
                for (i, &p) in contour.iter().enumerate() {
                    let middle = p.midpoint(contour[(i + 1) % contour.len()]);
                    prop_assert!(distance(p) >= kerf / 2.0 - 1e-6);
                    prop_assert!(distance(middle) >= kerf / 2.0 * 0.999 - 1e-6);
                    prop_assert!(distance(p) <= kerf / 2.0 * 4.05 + 1e-6);
                }
            }
            for &p in left.iter().flatten() {
                prop_assert!(locate(&grown.outline, p) == Location::Inside);
                let is_of_piece = locate(&star, p) != Location::Outside;
                prop_assert!(is_of_piece || distance_to_contour(p, &star) < 1e-9);
            }
        }
    }
}
