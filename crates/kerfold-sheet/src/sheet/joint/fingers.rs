//! Finger joints between plates of one thickness, cut square.
//!
//! The faces are the outer sides of the plates. Every edge, in the direction in which its face
//! runs, begins with a finger and ends with a notch, an even number of zones in all; its partner
//! runs the other way and so has a notch wherever this one has a finger. At a corner of three
//! plates each holds one of its two neighbours: there is nothing to choose.
//!
//! With the dihedral angle δ and the thickness t a notch is t / sin δ deep for δ ≥ 90° and t ·
//! cot(δ/2) for less, so that the partner's slab passes; for δ < 90° fingers are shorter by t · cot
//! δ, so that nothing juts out of the model.

use glam::DVec2;

use super::super::boundary::{Boundaries, Contour};
use super::params::{Fingers, WEB};
use super::webs::in_the_way;
use super::{JointFallback, JointReport};
use crate::net::{Net, Segment};

/// Dihedral angles that fingers can hold, in degrees.
const SHARPEST: f64 = 30.0;
const FLATTEST: f64 = 140.0;

/// Sines of corner angles below this count as straight or reflex: offset lines are not led to where
/// they meet.
const STRAIGHT: f64 = 0.35;

/// Fingers along one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Comb {
    /// Even number of zones.
    pub zones: usize,
    /// How far inside of the edge the fingers end.
    pub short: f64,
    /// How far inside of the edge the notches end.
    pub deep: f64,
}

impl Comb {
    /// The fingers of a seam, or why it can have none.
    pub fn of(fold_angle: f64, length: f64, fingers: &Fingers) -> Result<Self, JointFallback> {
        let thickness = fingers.thickness;
        let (short, deep) = depths(fold_angle, thickness)?;
        let zones = 2 * (length / (2.0 * fingers.width)).round().max(1.0) as usize;
        // The first finger loses the depth of the notch around the corner.
        let least = (1.5 * deep).max(thickness);
        let zones = if length / (zones as f64) < least {
            2 * (length / (2.0 * least)) as usize
        } else {
            zones
        };
        if zones == 0 { Err(JointFallback::Short) } else { Ok(Self { zones, short, deep }) }
    }

    fn level(&self, zone: usize) -> f64 {
        if zone.is_multiple_of(2) { self.short } else { self.deep }
    }
}

/// How far before the edge a plate ends that goes through its partner, and one that ends at the
/// partner's inner side.
pub(super) fn depths(fold_angle: f64, thickness: f64) -> Result<(f64, f64), JointFallback> {
    let dihedral = 180.0 - fold_angle;
    if dihedral > 180.0 {
        return Err(JointFallback::Concave);
    }
    if dihedral > FLATTEST {
        return Err(JointFallback::Shallow);
    }
    if dihedral.is_nan() || dihedral < SHARPEST {
        return Err(JointFallback::Sharp);
    }
    let (sin, cos) = dihedral.to_radians().sin_cos();
    let short = (thickness * cos / sin).max(0.0);
    Ok((short, thickness / sin + short))
}

/// Adds fingers to all seams that can have them; gives those that cannot.
pub(super) fn add_fingers(
    net: &Net,
    boundaries: &mut Boundaries,
    fingers: &Fingers,
    report: &mut JointReport,
) -> Vec<usize> {
    let mut combs: Vec<Result<Comb, JointFallback>> = (0..net.seams.len())
        .map(|s| match boundaries.places[s] {
            [Some(_), Some(_)] => Comb::of(net.seams[s].fold_angle, net.seams[s].length, fingers),
            _ => Err(JointFallback::Narrow),
        })
        .collect();
    // Every round takes fingers away, so that it ends; without any the outlines are those of the
    // net.
    loop {
        boundaries.contours.iter_mut().for_each(|c| shape(c, &combs));
        let mut is_clean = true;
        for piece in 0..net.pieces.len() {
            for s in in_the_way(boundaries, piece, (fingers.thickness / 2.0).max(WEB), |s| {
                combs[s].is_ok()
            }) {
                combs[s] = Err(JointFallback::Narrow);
                is_clean = false;
            }
        }
        if is_clean {
            break;
        }
    }
    let mut fallen = Vec::new();
    for (s, comb) in combs.iter().enumerate() {
        match comb {
            Ok(_) => report.fingered += 1,
            Err(why) => {
                report.fallbacks.push((net.seams[s].id, *why));
                fallen.push(s);
            }
        }
    }
    fallen
}

/// Cuts the fingers of all edges of a contour.
fn shape(contour: &mut Contour, combs: &[Result<Comb, JointFallback>]) {
    let n = contour.len();
    let comb = |i: usize| contour.sides[i].and_then(|(s, _)| combs[s].as_ref().ok().copied());
    let all: Vec<Option<Comb>> = (0..n).map(comb).collect();
    for i in 0..n {
        let before = (i + n - 1) % n;
        let ends = (all[before].map_or(0.0, |c| c.deep), all[i].map_or(0.0, |c| c.short));
        contour.cut_corners[i] = corner(contour.edge(before), contour.edge(i), ends);
        contour.profiles[i] = all[i].map_or_else(Vec::new, |c| profile(contour.edge(i), &c));
    }
}

/// Where the end of one edge, moved inwards, meets the beginning of the next.
pub(super) fn corner(before: Segment, after: Segment, (end, begin): (f64, f64)) -> Vec<DVec2> {
    let p = after[0];
    if end == 0.0 && begin == 0.0 {
        return vec![p];
    }
    let [u, v] = [before, after].map(|[a, b]| (b - a).normalize_or_zero());
    let sin = u.perp_dot(v);
    // At a reflex corner they would meet deep in the material, and at a straight one anywhere.
    if sin < STRAIGHT {
        return vec![p + u.perp() * end, p + v.perp() * begin];
    }
    // p + x u + end u⊥ = p + y v + begin v⊥, multiplied by v⊥.
    let x = (begin - end * u.perp().dot(v.perp())) / u.dot(v.perp());
    vec![p + u * x + u.perp() * end]
}

fn profile([a, b]: Segment, comb: &Comb) -> Vec<DVec2> {
    let inwards = (b - a).normalize_or_zero().perp();
    let step = |zone: usize| {
        let at = a.lerp(b, zone as f64 / comb.zones as f64);
        [at + inwards * comb.level(zone - 1), at + inwards * comb.level(zone)]
    };
    (1..comb.zones).flat_map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PLY: Fingers = Fingers { thickness: 3.0, width: 9.0 };

    #[test]
    fn depths_follow_the_dihedral_angle() {
        let right = Comb::of(90.0, 60.0, &PLY).expect("a right angle");
        assert!((right.deep - 3.0).abs() < 1e-12 && right.short.abs() < 1e-12);
        let sharp = Comb::of(120.0, 60.0, &PLY).expect("60 degrees");
        assert!((sharp.deep - 3.0 / 30_f64.to_radians().tan()).abs() < 1e-12, "{sharp:?}");
        assert!((sharp.short - 3.0 / 60_f64.to_radians().tan()).abs() < 1e-12);
        let dull = Comb::of(63.0, 60.0, &PLY).expect("117 degrees");
        assert!((dull.deep - 3.0 / 117_f64.to_radians().sin()).abs() < 1e-12 && dull.short == 0.0);
    }

    #[test]
    fn what_fingers_cannot_hold_is_told() {
        let why = |fold: f64, length: f64| Comb::of(fold, length, &PLY).expect_err("no fingers");
        assert_eq!(why(20.0, 60.0), JointFallback::Shallow);
        assert_eq!(why(-20.0, 60.0), JointFallback::Concave);
        assert_eq!(why(155.0, 60.0), JointFallback::Sharp);
        assert_eq!(why(90.0, 5.0), JointFallback::Short);
    }

    proptest! {
        /// At every place exactly one of the two sides has a finger, and the two fit into each
        /// other.
        #[test]
        fn the_two_sides_are_complementary(fold in 41.0..149.0_f64, length in 20.0..300.0_f64, at in 0.0..1.0_f64) {
            let Ok(comb) = Comb::of(fold, length, &PLY) else { return Ok(()) };
            let zone = |t: f64| ((t * comb.zones as f64) as usize).min(comb.zones - 1);
            let border = (at * comb.zones as f64).fract();
            prop_assume!(border > 1e-9 && border < 1.0 - 1e-9);
            let levels = [comb.level(zone(at)), comb.level(zone(1.0 - at))];
            prop_assert_eq!(levels[0] + levels[1], comb.short + comb.deep);
            let engaged = comb.deep - comb.short;
            prop_assert!((engaged - 3.0 / (180.0 - fold).to_radians().sin()).abs() < 1e-9);
        }
    }
}
