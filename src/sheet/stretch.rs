//! Stretches: seam edges that follow one another on both their sides, numbered and marked as one.
//!
//! A smooth seam of a D-form has hundreds of tiny edges; nobody could letter or read that many numbers.

use super::joint::Boundaries;
use crate::net::{Net, PieceId};

/// A stretch ends where an outline turns by more than this, in radians (35°).
const CORNER: f64 = 0.611;

/// Smooth seams longer than this, in mm, are divided.
const LONGEST: f64 = 60.0;

/// Consecutive seam edges between the same two pieces, under one number.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Counted from 1.
    pub number: usize,
    /// The seams by their index in the net, each with the side that runs forwards; its partner runs backwards.
    pub seams: Vec<(usize, usize)>,
    /// The pieces on the two sides.
    pub pieces: [PieceId; 2],
    /// Whether it goes on smoothly at its beginning and its end, so that only a mark shows where it ends.
    pub goes_on: [bool; 2],
}

impl Stretch {
    /// Its length in mm.
    pub fn length(&self, net: &Net) -> f64 {
        self.seams.iter().map(|&(s, _)| net.seams[s].length).sum()
    }

    /// The seam at a distance from the beginning, its forward side, and the place on it, 0 to 1.
    pub(crate) fn at(&self, net: &Net, distance: f64) -> (usize, usize, f64) {
        let mut rest = distance;
        for &(s, k) in &self.seams {
            let length = net.seams[s].length;
            if rest <= length {
                return (s, k, (rest / length).clamp(0.0, 1.0));
            }
            rest -= length;
        }
        let (s, k) = self.seams[self.seams.len() - 1];
        (s, k, 1.0)
    }
}

/// All stretches of a net, in the order of their lowest seam.
pub(crate) fn stretches(net: &Net, boundaries: &Boundaries) -> Vec<Stretch> {
    let mut seen = vec![false; net.seams.len()];
    let mut all = Vec::new();
    for s in 0..net.seams.len() {
        if seen[s] {
            continue;
        }
        let mut start = (s, 0);
        let mut is_loop = false;
        while let Some(before) = previous(boundaries, start) {
            is_loop = before == (s, 0);
            if is_loop || before.0 == s {
                break;
            }
            start = before;
        }
        start = if is_loop { (s, 0) } else { start };
        let mut chain = vec![start];
        seen[start.0] = true;
        while let Some(after) = following(boundaries, chain[chain.len() - 1]).filter(|a| !seen[a.0]) {
            seen[after.0] = true;
            chain.push(after);
        }
        divide(net, &chain, is_loop, &mut all);
    }
    all
}

fn divide(net: &Net, chain: &[(usize, usize)], is_loop: bool, all: &mut Vec<Stretch>) {
    let total: f64 = chain.iter().map(|&(s, _)| net.seams[s].length).sum();
    let parts = (total / LONGEST).ceil().max(1.0);
    let mut done = 0.0;
    let mut groups: Vec<Vec<(usize, usize)>> = vec![Vec::new()];
    for &(s, k) in chain {
        let middle = done + net.seams[s].length / 2.0;
        if middle > total * groups.len() as f64 / parts && groups.last().is_some_and(|g| !g.is_empty()) {
            groups.push(Vec::new());
        }
        groups.last_mut().expect("at least one group").push((s, k));
        done += net.seams[s].length;
    }
    let last = groups.len() - 1;
    for (i, seams) in groups.into_iter().enumerate() {
        let (s, k) = seams[0];
        let pieces = [k, 1 - k].map(|k| net.seams[s].sides[k].piece);
        let goes_on = [i > 0 || is_loop, i < last || is_loop];
        all.push(Stretch { number: all.len() + 1, seams, pieces, goes_on });
    }
}

/// The seam side that goes on smoothly after one, on both pieces.
fn following(boundaries: &Boundaries, (s, k): (usize, usize)) -> Option<(usize, usize)> {
    let [own, partner] = [k, 1 - k].map(|k| boundaries.places[s][k]);
    let (own, partner) = (own?, partner?);
    let (contour, other) = (&boundaries.contours[own.contour], &boundaries.contours[partner.contour]);
    let (n, m) = (contour.len(), other.len());
    let (i, j) = ((own.edge + 1) % n, (partner.edge + m - 1) % m);
    let next = contour.sides[i]?;
    let turn = |a: [glam::DVec2; 2], b: [glam::DVec2; 2]| (a[1] - a[0]).angle_to(b[1] - b[0]).abs();
    let is_smooth = turn(contour.edge(own.edge), contour.edge(i)) < CORNER
        && turn(other.edge(j), other.edge(partner.edge)) < CORNER;
    (is_smooth && other.sides[j] == Some((next.0, 1 - next.1)) && next.0 != s).then_some(next)
}

/// The seam side that one follows.
fn previous(boundaries: &Boundaries, (s, k): (usize, usize)) -> Option<(usize, usize)> {
    // Backwards on this side is forwards on the partner.
    following(boundaries, (s, 1 - k)).map(|(s, k)| (s, 1 - k))
}
