//! The poles of facets, and what they tell of a point without a look at the corners.
//!
//! The pole y of a plane that misses the centre is the point with y·x = 1 for all x on the plane; x
//! lies beyond it, seen from the centre, where y·x > 1. So one product of three terms says whether
//! a facet sees a point. A pole is rounded: it is kept only where that can be wrong by less than
//! [`POLE_BOUND`], and values nearer to 1 are left to the corners.

use glam::DVec3;

/// The pole of a facet; not a number where none is good enough.
pub(in super::super) type Pole = [f64; 3];

/// The most that y·x may be wrong by, for all points x of the cloud.
const POLE_BOUND: f64 = 1.0 / (1_u64 << 28) as f64;

/// A point with a higher y·x is certainly seen.
pub(super) const SEEN_FROM: f64 = 1.0 + POLE_BOUND;
/// A point with a lower y·x is certainly not seen.
pub(super) const UNSEEN_BELOW: f64 = 1.0 - POLE_BOUND;

/// y·x.
#[inline(always)]
pub(super) fn product(pole: &Pole, x: DVec3) -> f64 {
    pole[0] * x.x + pole[1] * x.y + pole[2] * x.z
}

/// Two corners of a facet seen from the third: the difference, and its largest entry.
#[derive(Clone, Copy)]
pub(super) struct Ray {
    along: DVec3,
    reach: f64,
}

impl Ray {
    #[inline(always)]
    pub(super) fn new(from: DVec3, to: DVec3) -> Self {
        let along = to - from;
        let size = along.abs();
        Self { along, reach: larger(larger(size.x, size.y), size.z) }
    }
}

/// The pole of the plane through `apex` and the ends of two rays from there, counter-clockwise.
///
/// No coordinate exceeds 1, and each may be off by `noise` = ν. With u half an ulp of 1 the entries
/// of a ray, of at most m, are off by η = 2ν + 2u; those of the normal n by 11mη; D = n·apex by
/// 60mη, which is little where the test below holds. Then an entry of the pole y is off by (11 +
/// 60|yᵢ|)mη/D and two roundings, and y·x for any x of the cloud by (33 + 60s)mη/D + s(5.2u + ν),
/// where s = Σ|yᵢ|. As D ≤ 6m² and m ≤ 2, the second term is below 43smη/D; and as 1 ≤ s in all but
/// rounding, the sum is below 138smη/D.
#[inline(always)]
pub(super) fn pole(apex: DVec3, a: Ray, b: Ray, noise: f64) -> Pole {
    let normal = a.along.cross(b.along);
    let size = normal.dot(apex);
    let y = normal * (1.0 / size);
    let sum = normal.x.abs() + normal.y.abs() + normal.z.abs();
    let doubt = 138.0 / POLE_BOUND * (2.0 * noise + f64::EPSILON) * larger(a.reach, b.reach) * sum;
    // One entry that is no number is enough.
    [if size > 0.0 && doubt <= size * size { y.x } else { f64::NAN }, y.y, y.z]
}

/// One instruction, where the method of the standard library takes care of numbers that are none.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::predicate::orient3d;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from_array)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn what_a_pole_tells_for_certain_is_so(
            apex in point(), ways in prop::array::uniform2(point()), sizes in prop::array::uniform2(0..40),
            weights in prop::array::uniform2(-2.0..2.0_f64), nudge in point(), nearness in 0..60,
        ) {
            // Triangles of every size and shape, slivers among them, and points ever nearer to
            // their planes.
            let corner = |i: usize| (apex + ways[i] * 0.5_f64.powi(sizes[i])).clamp(DVec3::NEG_ONE, DVec3::ONE);
            let (a, b) = (corner(0), corner(1));
            let near = apex + (a - apex) * weights[0] + (b - apex) * weights[1] + nudge * 0.5_f64.powi(nearness);
            let x = near.clamp(DVec3::NEG_ONE, DVec3::ONE);
            let y = pole(apex, Ray::new(apex, a), Ray::new(apex, b), 0.0);
            let value = product(&y, x);
            // Positive below the plane, which the pole is only kept for where the centre is.
            let below = orient3d(apex, a, b, x);
            if !value.is_nan() {
                prop_assert!(orient3d(apex, a, b, DVec3::ZERO) > 0.0);
            }
            if value > SEEN_FROM {
                prop_assert!(below < 0.0, "{value} {below}");
            } else if value < UNSEEN_BELOW {
                prop_assert!(below > 0.0, "{value} {below}");
            }
        }

        #[test]
        fn facets_of_a_good_shape_have_a_pole(apex in point(), ways in prop::array::uniform2(point()), size in 0..8) {
            let [a, b] = ways.map(|way| (apex + way * 0.5_f64.powi(size)).clamp(DVec3::NEG_ONE, DVec3::ONE));
            let normal = (a - apex).cross(b - apex);
            let spread = normal.length() / (a - apex).length_squared().max((b - apex).length_squared());
            let height = normal.normalize_or_zero().dot(apex);
            let is_good = spread > 0.3 && height > 0.4 && ways.iter().all(|way| way.length() > 0.5);
            let has_pole = !pole(apex, Ray::new(apex, a), Ray::new(apex, b), 0.0)[0].is_nan();
            prop_assert!(has_pole || !is_good);
        }
    }
}
