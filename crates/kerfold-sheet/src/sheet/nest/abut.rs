//! Pieces side to side, so that one cut serves two: every piece is tried with each of its sides
//! against each side of those that lie already, corner to corner, and goes where it reaches least
//! far and shares most.

use glam::DVec2;

use super::super::bounding_box::rounded;
use super::super::layout::Turn;
use super::Axis;
use super::collision_field::{CollisionField, Spot};
use super::search::Turns;
use super::shape::Posed;

/// How many free places are compared, and how many are looked at for them.
const KEPT: usize = 8;
const TRIED: usize = 1500;
/// What a millimetre of shared line is worth, in millimetres of reach.
const WORTH: f64 = 0.5;

/// A place with a side against a side.
struct Against {
    key: f64,
    spot: Spot,
}

/// The best place of a piece against those in a bin, if there is one.
pub(super) fn abutting(
    field: &mut CollisionField<'_>,
    turns: &Turns,
    axis: Axis,
    (i, bin): (usize, usize),
) -> Option<Spot> {
    let tolerance = 3e-9 * (field.rooms[bin].high - field.rooms[bin].low).length();
    let mut places = against(field, turns, axis, (i, bin));
    places.sort_by(|a, b| a.key.total_cmp(&b.key));
    let mut posed = Posed::default();
    let mut best: Option<(f64, Spot)> = None;
    let mut free = 0;
    for Against { key, spot } in places.into_iter().take(TRIED) {
        posed.turn(&field.shapes[i], spot.angle);
        let Some(touched) = field.touched(i, &posed, spot, tolerance) else { continue };
        let mine = sides_at(field, i, spot);
        let shared: f64 = touched
            .iter()
            .map(|&j| shared(&mine, &sides_at(field, j, field.spots[j]), tolerance))
            .sum();
        let score = key - WORTH * shared;
        if shared > 0.0 && best.is_none_or(|b| score < b.0) {
            best = Some((score, spot));
        }
        free += usize::from(shared > 0.0);
        if free == KEPT {
            break;
        }
    }
    best.map(|b| b.1)
}

/// All places in the room of the bin at which a side of the piece lies against a side of another,
/// corner to corner.
fn against(
    field: &mut CollisionField<'_>,
    turns: &Turns,
    axis: Axis,
    (i, bin): (usize, usize),
) -> Vec<Against> {
    let mut places = Vec::new();
    let slack = DVec2::splat(1e-9 * (field.rooms[bin].high - field.rooms[bin].low).length());
    let mut posed = Posed::default();
    let others: Vec<usize> =
        (0..field.pieces).filter(|&j| field.is_in(j) && field.spots[j].bin == bin).collect();
    for j in others {
        for [a, b] in sides_at(field, j, field.spots[j]) {
            for &[p, q] in &field.shapes[i].sides {
                let turn = (a - b).to_angle().to_degrees() - (q - p).to_angle().to_degrees();
                let Some(angle) = allowed(turns, turn) else { continue };
                field.work += posed.turn_box(&field.shapes[i], angle);
                let (low, high) = field.range(&posed, bin);
                let turned = Turn::degrees(angle);
                for at in [b - turned.apply(p), a - turned.apply(q)] {
                    if at.cmpge(low - slack).all() && at.cmple(high + slack).all() {
                        let far = at + posed.high;
                        let key = axis.of(far) + 0.05 * axis.across(far);
                        places.push(Against { key, spot: Spot { bin, at, angle } });
                    }
                }
            }
        }
    }
    field.work += places.len() as u64 / 4;
    places
}

/// The angle as files show it, if the piece may be turned by it.
fn allowed(turns: &Turns, angle: f64) -> Option<f64> {
    let near = |a: f64| ((angle - a + 180.0).rem_euclid(360.0) - 180.0).abs() < 1e-8;
    match turns {
        Turns::Free { .. } => Some(rounded(rounded(angle).rem_euclid(360.0))),
        Turns::Some(angles) => angles.iter().copied().find(|&a| near(a)),
    }
}

fn sides_at(field: &CollisionField<'_>, i: usize, spot: Spot) -> Vec<[DVec2; 2]> {
    let turn = Turn::degrees(spot.angle);
    field.shapes[i].sides.iter().map(|side| side.map(|p| turn.apply(p) + spot.at)).collect()
}

/// The length that sides of two pieces have in common.
fn shared(mine: &[[DVec2; 2]], theirs: &[[DVec2; 2]], tolerance: f64) -> f64 {
    let mut sum = 0.0;
    for [a, b] in mine {
        let length = a.distance(*b);
        let along = (b - a) / length;
        for [c, d] in theirs {
            if [c, d].iter().any(|&&e| along.perp_dot(e - a).abs() > tolerance) {
                continue;
            }
            let (s, t) = (along.dot(*d - *a), along.dot(*c - *a));
            sum += (t.min(length) - s.max(0.0)).max(0.0);
        }
    }
    sum
}
