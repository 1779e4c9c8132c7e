//! Stretches: seam edges that follow one another on both their sides, numbered and marked as one.
//!
//! A smooth seam of a D-form has hundreds of tiny edges; nobody could letter or read that many
//! numbers.

use super::boundary::Boundaries;
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
    /// The seams by their index in the net, each with the side that runs forwards; its partner runs
    /// backwards.
    pub seams: Vec<(usize, usize)>,
    /// The pieces on the two sides.
    pub pieces: [PieceId; 2],
    /// Whether it goes on smoothly at its beginning and its end, so that only a mark shows where it
    /// ends.
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
        while let Some(after) = following(boundaries, chain[chain.len() - 1]).filter(|a| !seen[a.0])
        {
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
        if middle > total * groups.len() as f64 / parts
            && groups.last().is_some_and(|g| !g.is_empty())
        {
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
    let (contour, other) =
        (&boundaries.contours[own.contour], &boundaries.contours[partner.contour]);
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

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use crate::sheet::testing::{random_convex, square, twins, two_pieces};

    fn of(net: &Net) -> Vec<Stretch> {
        stretches(net, &Boundaries::new(net))
    }

    fn circle(radius: f64, corners: usize) -> Vec<DVec2> {
        let step = std::f64::consts::TAU / corners as f64;
        (0..corners).map(|i| radius * DVec2::from_angle(i as f64 * step)).collect()
    }

    /// The vertices along a stretch, in its direction; nothing when two seams of it have no common
    /// end.
    fn way(net: &Net, stretch: &Stretch) -> Option<Vec<usize>> {
        let ends = |&(s, k): &(usize, usize)| {
            let seam = &net.seams[s];
            let piece = net.pieces.iter().find(|p| p.id == seam.sides[k].piece)?;
            let face = piece.faces.iter().find(|f| f.face == seam.sides[k].face)?;
            let forward = face.side(seam.edge, seam.sides[k].segment)? == seam.sides[k].segment;
            Some(if forward { seam.edge } else { [seam.edge[1], seam.edge[0]] })
        };
        let edges: Vec<[usize; 2]> = stretch.seams.iter().map(ends).collect::<Option<_>>()?;
        let follow = edges.windows(2).all(|w| w[0][1] == w[1][0]);
        follow.then(|| edges.iter().map(|e| e[0]).chain(edges.last().map(|e| e[1])).collect())
    }

    #[test]
    fn a_square_has_a_stretch_on_every_side() {
        let net = twins(square(50.0), 60.0);
        let all = of(&net);
        assert_eq!(all.iter().map(|s| s.number).collect::<Vec<_>>(), [1, 2, 3, 4]);
        assert!(all.iter().all(|s| s.seams.len() == 1 && s.goes_on == [false; 2]));
        assert_eq!(all[0].pieces, [PieceId(0), PieceId(1)]);
        let lone = of(&two_pieces());
        assert_eq!((lone.len(), lone[0].length(&two_pieces())), (1, 30.0));
    }

    #[test]
    fn a_smooth_ring_is_divided_evenly_with_marks_at_every_end() {
        let net = twins(circle(50.0, 120), 60.0);
        let all = of(&net);
        // 314 mm in parts of at most 60 mm.
        assert_eq!(all.len(), 6);
        for stretch in &all {
            assert_eq!(stretch.goes_on, [true; 2]);
            assert!((stretch.length(&net) - 314.0 / 6.0).abs() < 3.0, "{}", stretch.length(&net));
        }
    }

    #[test]
    fn long_straight_seams_stay_whole_and_a_corner_of_35_degrees_ends_a_stretch() {
        let net = twins(square(500.0), 60.0);
        assert_eq!(of(&net).len(), 4, "one edge is never divided");
        let turning = |degrees: f64| {
            let bend = DVec2::from_angle(degrees.to_radians());
            let (a, b) = (DVec2::ZERO, DVec2::new(20.0, 0.0));
            let net = twins(vec![a, b, b + 20.0 * bend, DVec2::new(-20.0, 60.0)], 60.0);
            of(&net).len()
        };
        assert_eq!((turning(30.0), turning(40.0)), (3, 4));
    }

    #[test]
    fn a_place_on_a_stretch_is_found_by_its_distance() {
        let net = twins(circle(50.0, 120), 60.0);
        let stretch = &of(&net)[0];
        let length = stretch.length(&net);
        let (s, k, t) = stretch.at(&net, 0.0);
        assert_eq!(((s, k), t), (stretch.seams[0], 0.0));
        let (s, k, t) = stretch.at(&net, length + 1.0);
        assert_eq!((Some(&(s, k)), t), (stretch.seams.last(), 1.0));
        let first = net.seams[stretch.seams[0].0].length;
        let (s, _, t) = stretch.at(&net, 1.5 * first);
        assert!(s == stretch.seams[1].0 && (t - 0.5).abs() < 1e-6, "{s} {t}");
    }

    proptest! {
        /// Every seam is in one stretch, stretches run on without a gap, and the number is that of
        /// their order.
        #[test]
        fn stretches_divide_the_seams(seed in 0..500_u64, corners in 3..90_usize, radius in 5.0..200.0_f64) {
            for net in [twins(random_convex(seed), 40.0), twins(circle(radius, corners), 40.0)] {
                let all = of(&net);
                let mut seen: Vec<usize> = all.iter().flat_map(|s| s.seams.iter().map(|x| x.0)).collect();
                seen.sort_unstable();
                prop_assert_eq!(seen, (0..net.seams.len()).collect::<Vec<_>>());
                for (i, stretch) in all.iter().enumerate() {
                    prop_assert_eq!(stretch.number, i + 1);
                    prop_assert!(way(&net, stretch).is_some(), "a gap in stretch {}", i + 1);
                    let longest = net.seams.iter().map(|s| s.length).fold(0.0, f64::max);
                    prop_assert!(stretch.length(&net) <= LONGEST + longest, "{}", stretch.length(&net));
                }
            }
        }
    }
}
