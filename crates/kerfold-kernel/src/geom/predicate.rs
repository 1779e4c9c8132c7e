//! Signs that cannot lie: adaptive exact predicates on given numbers.
//!
//! Sources: Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates"; orientation tests by the `robust` crate, the plane side test by the expansion
//! arithmetic of the same paper.

use glam::{DVec2, DVec3};
use robust::{Coord, Coord3D};

/// On which side of a plane or line something lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// Behind the plane: what a cut keeps.
    Reverse,
    /// On the plane.
    On,
    /// In front of the plane: what a cut removes.
    Normal,
}

impl Side {
    /// The side that the sign of `value` shows; zero is on.
    #[inline]
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Normal
        } else if value < 0.0 {
            Self::Reverse
        } else {
            Self::On
        }
    }
}

/// Twice the signed area of the triangle a, b, c with an exact sign: positive when it runs
/// counter-clockwise.
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Six times the signed volume of the tetrahedron a, b, c, d with an exact sign: positive when d
/// lies below the plane from whose upper side a, b, c run counter-clockwise.
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// The exact side of `x` with respect to the plane through `point` with the direction `normal` (any
/// length).
///
/// All nine numbers are taken as given; the sign of normal · (x − point) is exact barring overflow
/// and underflow.
#[inline]
pub fn side_of_plane(normal: DVec3, point: DVec3, x: DVec3) -> Side {
    rounded_side(normal, point, x).unwrap_or_else(|| exact_side(normal, point, x))
}

/// The side as far as rounded arithmetic can tell it; `None` when `x` is so near to the plane that
/// only exact arithmetic could. No rounded construction, such as the point where an edge crosses
/// the plane, can be distinguished from such an `x`.
#[inline]
pub fn rounded_side(normal: DVec3, point: DVec3, x: DVec3) -> Option<Side> {
    let products = normal * (x - point);
    let sum = products.x + products.y + products.z;
    // Each of the three products carries two roundings, the sum two more.
    let bound = 4.0 * f64::EPSILON * (products.x.abs() + products.y.abs() + products.z.abs());
    (sum.abs() > bound).then(|| Side::of(sum))
}

#[cold]
fn exact_side(normal: DVec3, point: DVec3, x: DVec3) -> Side {
    let mut sum = Expansion::default();
    for axis in 0..3 {
        let (high, low) = two_difference(x[axis], point[axis]);
        for part in [high, low] {
            let (product, error) = two_product(normal[axis], part);
            sum.add(error);
            sum.add(product);
        }
    }
    Side::of(sum.sign())
}

/// A sum of non-overlapping doubles, smallest first (Shewchuk 1997, 2.4). Twelve terms are all that
/// a plane test adds.
#[derive(Default)]
struct Expansion {
    terms: [f64; 12],
    length: usize,
}

impl Expansion {
    /// Grow-Expansion (Shewchuk 1997, figure 6).
    fn add(&mut self, value: f64) {
        let mut carry = value;
        let mut kept = 0;
        for i in 0..self.length {
            let (sum, error) = two_sum(carry, self.terms[i]);
            carry = sum;
            if error != 0.0 {
                self.terms[kept] = error;
                kept += 1;
            }
        }
        self.terms[kept] = carry;
        self.length = kept + 1;
    }

    /// The largest term carries the sign of the sum.
    fn sign(&self) -> f64 {
        self.terms[..self.length].iter().rev().copied().find(|&t| t != 0.0).unwrap_or(0.0)
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

fn two_difference(a: f64, b: f64) -> (f64, f64) {
    two_sum(a, -b)
}

fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_ulp_off_the_plane_is_seen() {
        let (normal, point) = (DVec3::new(1.0, 1.0, 1.0), DVec3::splat(0.1));
        let on = DVec3::splat(0.1);
        assert_eq!(side_of_plane(normal, point, on), Side::On);
        let above = DVec3::new(0.1_f64.next_up(), 0.1, 0.1);
        assert_eq!(side_of_plane(normal, point, above), Side::Normal);
        let below = DVec3::new(0.1, 0.1, 0.1_f64.next_down());
        assert_eq!(side_of_plane(normal, point, below), Side::Reverse);
    }

    /// Integers scaled by powers of two are exact in i128, so they judge the floating-point sign.
    fn exact_by_integers(n: [i64; 3], p: [i64; 3], x: [i64; 3]) -> Side {
        let sum: i128 =
            (0..3).map(|i| i128::from(n[i]) * (i128::from(x[i]) - i128::from(p[i]))).sum();
        Side::of(sum.signum() as f64)
    }

    proptest! {
        #[test]
        fn agrees_with_integer_arithmetic(
            n in prop::array::uniform3(-(1_i64 << 40)..1 << 40),
            p in prop::array::uniform3(-(1_i64 << 50)..1 << 50),
            u in prop::array::uniform3(-(1_i64 << 8)..1 << 8),
            nudge in -1_i64..=1,
        ) {
            // x − p is perpendicular to n up to a nudge of one unit: the filter fails, the
            // expansion must decide.
            let cross = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]];
            let x = [p[0] + cross[0] + nudge, p[1] + cross[1], p[2] + cross[2]];
            let vec = |a: [i64; 3]| DVec3::new(a[0] as f64, a[1] as f64, a[2] as f64);
            prop_assert_eq!(side_of_plane(vec(n), vec(p), vec(x)), exact_by_integers(n, p, x));
        }
    }
}
