//! What is too narrow to be cut: slits of an outline, and the ends of notches that are narrower
//! than the kerf.
//!
//! An opened edge between two faces in one plane has two sides in the same place. On the model they
//! lie so, too: left uncut it is a fold, and nothing is missing ([`mend`]). Where nothing is known
//! of the two sides, and where a notch is narrower than the kerf, so that an outline grown by half
//! the kerf closes before the notch ends, a channel is cut instead, wide enough that a closed path
//! leads in and out again ([`channels`]). Cut layers hold no open line.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::distance::edges;
use crate::geom::polygon::{bounds, segments_cross, signed_area};
use crate::geom::predicate::orient2d;
use crate::net::{EdgeLabel, Fold, FoldKind, Net, Piece, PieceId, Seam, Segment};

/// Files hold four decimals of a millimetre: what is narrower, along both axes, may be one line
/// there.
const FILE_STEP: f64 = 1.5e-4;

/// The same for small pieces, relative to their size.
const RELATIVE_STEP: f64 = 1e-6;

/// Stretches of a channel shorter than this part of its width are rounding.
const SHORTEST: f64 = 1e-6;

/// Fold angles up to this, in degrees, are none.
const FLAT: f64 = 6e-5;

/// Two sides of a seam that are nowhere farther apart than this, in mm, are one line for any
/// machine: cut, they would be cut twice.
const ONE_LINE: f64 = 6e-3;

/// The same for small pieces, relative to their size.
const RELATIVE_LINE: f64 = 4e-5;

/// How far before the mouth of a channel the grown contour may lie, in widths.
const REACH: f64 = 4.0;

/// Takes the spikes out of a contour: corners whose two edges lie on one another. Gives the rest of
/// the contour, empty when nothing else is left, and the spikes, each from its tip to its base.
pub(crate) fn take_spikes(contour: &[DVec2]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    take_spikes_within(contour, step_of(contour, FILE_STEP, RELATIVE_STEP))
}

/// As [`take_spikes`] with a distance up to which two points are one.
fn take_spikes_within(contour: &[DVec2], step: f64) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let mut rest = contour.to_vec();
    let mut spikes: Vec<Vec<DVec2>> = Vec::new();
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

/// How near two points of a contour are one: an absolute distance, for small contours one relative
/// to their size.
fn step_of(contour: &[DVec2], absolute: f64, relative: f64) -> f64 {
    let (low, high) = bounds(contour).unwrap_or_default();
    absolute.min(relative * (high - low).length())
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

/// A net whose slits are left uncut.
pub(crate) struct Mended {
    /// The same net, with folds for those seams whose two sides lie on one another.
    pub net: Net,
    /// For each of its seams the index in the net that was given.
    pub seams: Vec<usize>,
    /// The seams that became folds.
    pub uncut: Vec<EdgeLabel>,
}

/// Makes folds of all seams whose two sides lie on one another from the tip of a slit on; nothing
/// when there is none.
pub(crate) fn mend(net: &Net) -> Option<Mended> {
    // The seams of which both sides are on one piece, by that piece.
    let mut own: BTreeMap<PieceId, Vec<usize>> = BTreeMap::new();
    for (s, seam) in net.seams.iter().enumerate() {
        let piece = seam.sides[0].piece;
        if seam.sides.iter().all(|side| side.piece == piece) {
            own.entry(piece).or_default().push(s);
        }
    }
    let closed_of = |piece: &Piece, step: f64| -> Vec<usize> {
        let own = own.get(&piece.id).into_iter().flatten().copied();
        own.filter(|&s| is_closed(&net.seams[s], step)).collect()
    };
    if own.is_empty() {
        return None;
    }
    let mut mended = net.clone();
    let mut uncut: BTreeSet<usize> = BTreeSet::new();
    for piece in &mut mended.pieces {
        let step = step_of(&piece.outline, ONE_LINE, RELATIVE_LINE);
        let closed = closed_of(piece, step);
        if closed.is_empty() {
            continue;
        }
        for contour in std::iter::once(&mut piece.outline).chain(&mut piece.holes) {
            let (rest, spikes) = take_spikes_within(contour, step);
            let edges = || spikes.iter().flat_map(|s| s.windows(2)).map(|w| [w[0], w[1]]);
            let seam_of = |edge: Segment| {
                closed.iter().copied().find(|&s| lies_on(net.seams[s].sides[0].segment, edge, step))
            };
            let seams: Option<Vec<usize>> = edges().map(seam_of).collect();
            if let Some(seams) = seams.filter(|_| !spikes.is_empty() && !rest.is_empty()) {
                *contour = rest;
                uncut.extend(seams);
            }
        }
    }
    if uncut.is_empty() {
        return None;
    }
    mended.folds.extend(uncut.iter().map(|&s| fold_of(&net.seams[s])));
    mended.folds.sort_by_key(|f| f.id);
    let seams: Vec<usize> = (0..net.seams.len()).filter(|s| !uncut.contains(s)).collect();
    mended.seams = seams.iter().map(|&s| net.seams[s].clone()).collect();
    let uncut = uncut.into_iter().map(|s| net.seams[s].id).collect();
    Some(Mended { net: mended, seams, uncut })
}

/// Whether the two sides of a seam lie on one another.
fn is_closed(seam: &Seam, step: f64) -> bool {
    lies_on(seam.sides[0].segment, seam.sides[1].segment, step)
}

/// Whether two segments have the same ends, either way round.
fn lies_on([a, b]: Segment, [c, d]: Segment, step: f64) -> bool {
    let near = |p: DVec2, q: DVec2| p.distance(q) <= step;
    near(a, c) && near(b, d) || near(a, d) && near(b, c)
}

fn fold_of(seam: &Seam) -> Fold {
    let kind = match seam.fold_angle {
        angle if angle.abs() <= FLAT => FoldKind::Flat,
        angle if angle > 0.0 => FoldKind::Mountain,
        _ => FoldKind::Valley,
    };
    let [side, other] = &seam.sides;
    Fold {
        id: seam.id,
        edge: seam.edge,
        piece: side.piece,
        faces: [side.face, other.face],
        segment: side.segment,
        fold_angle: seam.fold_angle,
        kind,
    }
}

/// Where cuts have to be opened that no single line may open.
#[derive(Debug, Clone, Default)]
pub(crate) struct Channels {
    /// Their middle lines, from the tip outwards.
    pub lines: Vec<Vec<DVec2>>,
    /// Notches whose middle line would have gone through the piece.
    pub closed: usize,
}

/// The channels of contours and the spikes that were taken out of them: from the ends of all narrow
/// notches, when `has_kerf`, and from the tips of all spikes, to `wide`, the contours grown by half
/// the `width` of a channel.
pub(crate) fn channels(
    contours: &[Vec<DVec2>],
    spikes: &[Vec<DVec2>],
    (wide, width): (&[Vec<DVec2>], f64),
    has_kerf: bool,
) -> Channels {
    let mut channels = Channels::default();
    let carries_spike = |p: DVec2| spikes.iter().any(|s| s.last() == Some(&p));
    for contour in contours {
        for apex in (0..contour.len()).filter(|&i| is_narrow(contour, i)) {
            if !has_kerf && !carries_spike(contour[apex]) {
                continue;
            }
            let line = notch_line(contour, apex, wide, width);
            match line.filter(|s| stays_outside(s, contours)) {
                Some(line) => channels.lines.push(line),
                None => channels.closed += 1,
            }
        }
    }
    channels.lines.extend(spikes.iter().map(|s| spike_line(s, contours, wide, width)));
    channels
}

/// A spike, led on to the grown contours where it does not end in a notch that leads there.
fn spike_line(
    spike: &[DVec2],
    contours: &[Vec<DVec2>],
    wide: &[Vec<DVec2>],
    width: f64,
) -> Vec<DVec2> {
    let mut line = spike.to_vec();
    let base = spike.last().copied().unwrap_or_default();
    let corner = contours.iter().find_map(|c| c.iter().position(|&p| p == base).map(|i| (c, i)));
    if let (Some((contour, i)), Some(from)) = (corner, spike.iter().rev().nth(1))
        && !is_narrow(contour, i)
    {
        let ahead = base + (base - *from).normalize_or_zero() * (REACH * width);
        line.extend(first_hit(base, ahead, wide));
    }
    line
}

/// The area of a channel: one quadrangle for each of its stretches, counter-clockwise, that meet at
/// mitres.
pub(crate) fn channel_area(line: &[DVec2], width: f64) -> Vec<Vec<DVec2>> {
    let mut line = line.to_vec();
    line.dedup();
    let directions: Vec<DVec2> = line.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
    let Some(last) = directions.len().checked_sub(1) else { return Vec::new() };
    // To the left of every point, as far as both its stretches want.
    let offset = |i: usize| {
        let normals = [directions[i.saturating_sub(1)], directions[i.min(last)]].map(DVec2::perp);
        let middle = (normals[0] + normals[1]).normalize_or_zero();
        // At turns sharper than 120° the mitre would go too far.
        middle * (width / 2.0 / middle.dot(normals[0]).max(0.5))
    };
    let quadrangle = |i: usize| {
        let [p, q] = [line[i], line[i + 1]];
        let [l, m] = [offset(i), offset(i + 1)];
        let mut corners = vec![p - l, q - m, q + m, p + l];
        if signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        corners
    };
    (0..=last).map(quadrangle).collect()
}

/// Whether a contour has a narrow notch.
pub(crate) fn has_narrow(contour: &[DVec2]) -> bool {
    (0..contour.len()).any(|i| is_narrow(contour, i))
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
fn notch_line(
    contour: &[DVec2],
    apex: usize,
    wide: &[Vec<DVec2>],
    width: f64,
) -> Option<Vec<DVec2>> {
    let n = contour.len();
    let mut line = vec![contour[apex]];
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
        let from = *line.last()?;
        let to = left.midpoint(right);
        if let Some(hit) = first_hit(from, to, wide) {
            line.push(hit);
            return Some(line);
        }
        if left.distance(right) > width {
            // Out of the mouth, which growing has closed: straight on to the contour before it.
            let (tip, end) = (line[0], *line.last()?);
            // The sides may turn away one after the other; then the last stretches say little.
            line.retain(|&p| p == tip || p == end || p.distance(end) > width);
            let from = *line.iter().rev().nth(1)?;
            let ahead = (end - from).normalize_or_zero() * (REACH * width);
            line.push(first_hit(end, end + ahead, wide)?);
            return Some(line);
        }
        // Two sides that are equally long up to rounding would leave a stretch of no direction.
        if from.distance(to) > SHORTEST * width {
            line.push(to);
        }
    }
    None
}

/// Whether a line crosses none of the contours that bound the material.
fn stays_outside(slit: &[DVec2], contours: &[Vec<DVec2>]) -> bool {
    let crosses = |w: &[DVec2]| {
        contours.iter().any(|c| edges(c).any(|(a, b)| segments_cross(w[0], w[1], a, b)))
    };
    !slit.windows(2).any(crosses)
}

/// Where the segment from `a` to `b` first meets one of the contours.
fn first_hit(a: DVec2, b: DVec2, contours: &[Vec<DVec2>]) -> Option<DVec2> {
    let along = b - a;
    let mut first = f64::INFINITY;
    for contour in contours {
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
    use super::super::kerf::CutShape;
    use super::super::testing::{piece, points, square, two_pieces};
    use super::*;
    use crate::geom::polygon::{Location, locate};
    use crate::net::{PieceId, SeamSide};

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

    /// The width of what is cut away at a place, along y.
    fn width_at(shape: &CutShape, p: DVec2, kerf: f64) -> f64 {
        let reach = |way: f64| {
            let hit = first_hit(p, p + DVec2::new(0.0, way), std::slice::from_ref(&shape.outline));
            hit.map_or(0.0, |hit| hit.distance(p))
        };
        reach(5.0) + reach(-5.0) + kerf
    }

    #[test]
    fn a_slit_is_cut_by_a_closed_path_no_narrower_than_the_kerf() {
        for (kerf, cut_away) in [(0.0, 0.2), (0.1, 0.2), (0.3, 0.6)] {
            for width in [0.0, 1e-13, 0.02] {
                if kerf == 0.0 && width > 1e-9 {
                    continue;
                }
                let shape = cut(slit_square(width), kerf);
                let counts = (shape.widened_notches > 0, shape.closed_notches);
                assert_eq!(counts, (true, 0), "kerf {kerf}, width {width}");
                for p in [DVec2::new(60.0, 55.0), DVec2::new(85.0, 50.0)] {
                    // The first stretch is inclined by 26.6°.
                    let cosine = if p.x < 70.0 { 0.8_f64.sqrt() } else { 1.0 };
                    let expected = kerf + (cut_away - kerf) / cosine;
                    let found = width_at(&shape, p, kerf);
                    assert!((found - expected).abs() < 0.02, "kerf {kerf}, width {width}: {found}");
                }
                assert_eq!(locate(&shape.outline, DVec2::new(49.5, 60.25)), Location::Inside);
            }
        }
    }

    #[test]
    fn a_wide_notch_stays_and_a_narrow_one_is_cut_to_its_end() {
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
        assert_eq!(cut(notch(25.0), 0.2).widened_notches, 0);
        assert_eq!(cut(notch(1.0), 0.0).outline, notch(1.0));
        let narrow = cut(notch(1.0), 0.2);
        assert_eq!(narrow.widened_notches, 1);
        // Half a kerf before the end of the notch, and a kerf wide from there on.
        let end = narrow.outline.iter().filter(|p| p.x < 60.0 && p.y > 1.0 && p.y < 99.0);
        assert!(end.clone().filter(|p| (p.x - 50.1).abs() < 1e-6).count() == 2);
        assert!((width_at(&narrow, DVec2::new(52.0, 50.0), 0.2) - 0.4).abs() < 1e-6);
        // Where the notch itself is wide enough it is cut as it is.
        let wide = width_at(&narrow, DVec2::new(90.0, 50.0), 0.2);
        assert!((wide - 1.6).abs() < 1e-2, "{wide}");
    }

    #[test]
    fn a_hole_that_is_a_slit_becomes_a_narrow_hole() {
        let mut piece = piece(PieceId(0), square(50.0));
        piece.holes = vec![points([(10.0, 10.0), (20.0, 10.0), (30.0, 20.0), (20.0, 10.0)])];
        for kerf in [0.0, 0.1] {
            let shape = CutShape::of_piece(&piece, kerf).expect("a square with a slit");
            assert_eq!((shape.holes.len(), shape.lost_holes), (1, 0), "kerf {kerf}");
        }
    }

    #[test]
    fn seams_that_lie_on_one_another_become_folds() {
        // A square of two faces with a slit of two seams from the right side to its middle.
        let mut net = two_pieces();
        let (tip, bend, base) =
            (DVec2::new(50.0, 60.0), DVec2::new(70.0, 50.0), DVec2::new(100.0, 50.0));
        net.pieces.truncate(1);
        net.pieces[0].outline = slit_square(0.0);
        net.folds.clear();
        let seam = |i: usize, segment: Segment, fold_angle: f64| {
            let side = |face| SeamSide { piece: PieceId(0), face, segment };
            let (id, edge) = (EdgeLabel(i), [i, i + 1]);
            let sides = [side(0), side(1)];
            Seam { id, edge, length: segment[0].distance(segment[1]), fold_angle, sides }
        };
        net.seams = vec![seam(3, [tip, bend], 12.0), seam(7, [base, bend], 0.0)];
        let mended = mend(&net).expect("a slit");
        assert_eq!(mended.uncut, [EdgeLabel(3), EdgeLabel(7)]);
        assert_eq!((mended.net.seams.len(), mended.net.folds.len()), (0, 2));
        assert_eq!(
            mended.net.folds.iter().map(|f| f.kind).collect::<Vec<_>>(),
            [FoldKind::Mountain, FoldKind::Flat]
        );
        assert_eq!(mended.net.pieces[0].outline.len(), 5);
        // A slit that no seam explains stays what it is.
        net.seams.pop();
        assert!(mend(&net).is_none());
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
