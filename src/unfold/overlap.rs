//! When two laid-out faces overlap.
//!
//! Laid-out coordinates carry rounding: two faces that share a fold, or that merely touch, may sink
//! into each other by some 1e-15 of the model's size. So an overlap is said to be *deeper than a
//! bound*: two convex polygons overlap when no line through a side of one of them leaves the other
//! on its outer side up to `bound`. Touching at sides and corners, whether between neighbours or
//! strangers, is then no overlap, without special cases. The bound is 1e-11 of the model's size
//! (ten times the rounding bound of constructed points, [`crate::geom::RoundingBound`]), a hundred
//! times what laying out a chain of a thousand faces loses; an overlap that is let through has an
//! area below bound × perimeter. Concave faces are compared part by part ([`super::convex`]).

use glam::DVec2;

use super::dual::Dual;

/// Whether two faces with their corners at `p` and `q` overlap deeper than the bound.
pub(super) fn overlap(dual: &Dual, f: u32, p: &[DVec2], g: u32, q: &[DVec2]) -> bool {
    let others = dual.parts.of(g);
    dual.parts.of(f).any(|a| others.clone().any(|b| convex_overlap(a, p, b, q, dual.bound)))
}

/// The same for two convex parts, given by their corner numbers. Separating axes of convex polygons
/// are their sides.
fn convex_overlap(a: &[u32], p: &[DVec2], b: &[u32], q: &[DVec2], bound: f64) -> bool {
    !separated(a, p, b, q, bound) && !separated(b, q, a, p, bound)
}

/// Whether some side of `a` has all of `b` on its outer side.
fn separated(a: &[u32], p: &[DVec2], b: &[u32], q: &[DVec2], bound: f64) -> bool {
    let mut from = p[a[a.len() - 1] as usize];
    for &k in a {
        let to = p[k as usize];
        let side = to - from;
        let limit = bound * side.length();
        if b.iter().all(|&j| side.perp_dot(q[j as usize] - from) <= limit) {
            return true;
        }
        from = to;
    }
    false
}

/// Whether two boxes overlap deeper than the bound.
pub(super) fn boxes_overlap(a: [DVec2; 2], b: [DVec2; 2], bound: f64) -> bool {
    let depth = a[1].min(b[1]) - a[0].max(b[0]);
    depth.x > bound && depth.y > bound
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(at: DVec2, turn: f64) -> Vec<DVec2> {
        [(0., 0.), (1., 0.), (1., 1.), (0., 1.)]
            .map(|(x, y)| at + DVec2::from_angle(turn).rotate(DVec2::new(x, y)))
            .into()
    }

    #[test]
    fn touching_within_the_bound_is_no_overlap() {
        let all = [0, 1, 2, 3];
        let unit = square(DVec2::ZERO, 0.0);
        let meets = |other: &[DVec2]| convex_overlap(&all, &unit, &all, other, 1e-11);
        for (at, turn, expected) in [
            (DVec2::new(1.0, 0.0), 0.0, false),
            (DVec2::new(1.0 - 1e-12, 0.3), 0.0, false),
            (DVec2::new(1.0 - 1e-10, 0.3), 0.0, true),
            (DVec2::new(1.0, 1.0), 0.5, false),
            (DVec2::new(0.5, 1.0), std::f64::consts::FRAC_PI_4, false),
            (DVec2::new(0.5, 1.0 - 1e-9), std::f64::consts::FRAC_PI_4, true),
            (DVec2::new(0.0, 0.0), 0.0, true),
            (DVec2::new(0.4, 0.4), 3.0, true),
        ] {
            assert_eq!(meets(&square(at, turn)), expected, "{at} {turn}");
        }
    }
}
