//! Closed polygons with given sides: how chords become as long as their arcs (see `rims`).

use glam::{DMat3, DVec2, DVec3};

use super::triangle::{STRAIGHT, turn};

/// The closed polygon with the given sides whose turns are as nearly as possible in proportion to
/// those of the given one. `None` when it does not close.
pub(super) fn with_sides(points: &[DVec2], sides: &[f64]) -> Option<Vec<DVec2>> {
    let n = points.len();
    let perimeter: f64 = sides.iter().sum();
    let side = |i: usize| points[(i + 1) % n] - points[i];
    if (0..n).all(|i| (side(i).length() - sides[i]).abs() <= 1e-14 * perimeter) {
        return Some(points.to_vec());
    }
    let turn_at = |i: usize| {
        let t = turn(side((i + n - 1) % n), side(i));
        if t.abs() < STRAIGHT { 0.0 } else { t }
    };
    let turns: Vec<f64> = (0..n).map(turn_at).collect();
    let middle = points.iter().sum::<DVec2>() / n as f64;
    let basis: Vec<DVec3> =
        points.iter().map(|&p| ((p - middle) / perimeter).extend(1.0)).collect();
    let mut change = DVec3::ZERO;
    for _ in 0..30 {
        let (chain, end) = chain(side(0).to_angle(), sides, &turns, &basis, change);
        let turned: f64 = turns.iter().zip(&basis).map(|(t, b)| t.abs() * change.dot(*b)).sum();
        let gap = (end / perimeter).extend(turned);
        if gap.length() <= 2e-16 * (n as f64).sqrt() {
            return Some(aligned(&chain, points));
        }
        // How the gap moves with each turn, times how the turn moves with each of the three.
        let mut slope = DMat3::ZERO;
        for k in 0..n {
            let lever = if k == 0 { DVec2::ZERO } else { (end - chain[k]).perp() / perimeter };
            let weighted = basis[k] * turns[k].abs();
            let column = lever.extend(1.0);
            slope +=
                DMat3::from_cols(column * weighted.x, column * weighted.y, column * weighted.z);
        }
        if slope.determinant() == 0.0 {
            return None;
        }
        let next = change - slope.inverse() * gap;
        if !next.is_finite() || next.length() > 0.5 * n as f64 {
            return None;
        }
        if next == change {
            break;
        }
        change = next;
    }
    let (chain, end) = chain(side(0).to_angle(), sides, &turns, &basis, change);
    (end.length() <= 1e-13 * perimeter).then(|| aligned(&chain, points))
}

/// The corners one after the other, and where the last side ends.
fn chain(
    heading: f64,
    sides: &[f64],
    turns: &[f64],
    basis: &[DVec3],
    change: DVec3,
) -> (Vec<DVec2>, DVec2) {
    let (mut at, mut heading) = (DVec2::ZERO, heading);
    let mut corners = Vec::with_capacity(sides.len());
    for i in 0..sides.len() {
        if i > 0 {
            heading += turns[i] + turns[i].abs() * change.dot(basis[i]);
        }
        corners.push(at);
        at += DVec2::from_angle(heading) * sides[i];
    }
    (corners, at)
}

/// Moved and turned to lie as near to the model as can be.
fn aligned(chain: &[DVec2], model: &[DVec2]) -> Vec<DVec2> {
    let n = chain.len() as f64;
    let (a, b) = (chain.iter().sum::<DVec2>() / n, model.iter().sum::<DVec2>() / n);
    let (mut cos, mut sin) = (0.0, 0.0);
    for (&p, &q) in chain.iter().zip(model) {
        cos += (p - a).dot(q - b);
        sin += (p - a).perp_dot(q - b);
    }
    let turn = DVec2::new(cos, sin).normalize_or(DVec2::X);
    chain.iter().map(|&p| b + turn.rotate(p - a)).collect()
}
