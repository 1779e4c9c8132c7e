//! Where three planes meet: from their dual points with a bound on the error, and from the given
//! numbers to the last digit.

use glam::DVec3;

use super::determinant::determinant_of_three;
use super::half_space::HalfSpace;
use super::scale::inverse_power_of_two;

/// By number the first point, the one farthest from it, and the one farthest from the line of the
/// two; counter-clockwise order is not kept.
pub(super) fn widest_triple(points: &[DVec3]) -> [usize; 3] {
    let far = |measure: &dyn Fn(DVec3) -> f64| {
        let most =
            (0..points.len()).max_by(|&i, &j| measure(points[i]).total_cmp(&measure(points[j])));
        most.unwrap_or_default()
    };
    let Some(&a) = points.first() else { return [0; 3] };
    let second = far(&|p| p.distance_squared(a));
    let b = points[second];
    [0, second, far(&|p| (b - a).cross(p - a).length_squared())]
}

/// Terms of this size leave no more to gain.
pub(super) const SETTLED: f64 = 2.0 * f64::EPSILON;

/// Where q·y = 1 for three dual points, with the residuals solved for again: y lies on the planes
/// to rounding unless they meet too flat for that; [`uncertainty`] says how much.
#[inline(never)]
pub(super) fn meeting_point([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let inverse = 1.0 / normal.dot(a);
    let mut best = normal * inverse;
    for _ in 0..3 {
        let residuals = DVec3::new(1.0 - a.dot(best), 1.0 - b.dot(best), 1.0 - c.dot(best));
        if residuals.abs().max_element() <= SETTLED {
            break;
        }
        let [x, y, z] = residuals.to_array();
        let turned = normal * x + ac.cross(a) * (y - x) + a.cross(ab) * (z - x);
        let better = best + turned * inverse;
        if !better.is_finite() {
            break;
        }
        best = better;
    }
    best
}

/// The most that a coordinate of y can be off where y is to be the meeting point of three dual
/// points, whose coordinates of at most 1 carry the relative error `noise`. Not a number when
/// nothing can be said.
///
/// With the residuals r = 1 − q·y, each uncertain by the rounding of its three terms, y is off by
/// M⁻¹ r, where the rows of M are a, b and c. The columns of M⁻¹ are a × ac, ab × a and ab × ac up
/// to sums, over the determinant D = a·(ab × ac); the last, over D, is y itself, and the others are
/// at most 2m/D with no entry of ab and ac above m.
#[inline(always)]
pub(super) fn uncertainty([a, b, c]: [DVec3; 3], y: DVec3, noise: f64) -> f64 {
    let (ab, ac) = (b - a, c - a);
    let size = y.abs();
    let terms = size.x + size.y + size.z;
    let residuals = DVec3::new(1.0 - a.dot(y), 1.0 - b.dot(y), 1.0 - c.dot(y)).abs();
    let residual = residuals.x + residuals.y + residuals.z + (noise + SETTLED) * terms;
    let reach = ab.abs().max(ac.abs());
    let reach = reach.x + reach.y + reach.z;
    // The determinant is off by at most 60 m (2ν + ε), see `pole`.
    let doubt = 60.0 * reach * (2.0 * noise + f64::EPSILON);
    let determinant = ab.cross(ac).dot(a).abs() - doubt;
    let bound = residual * (terms + 8.0 * reach / determinant);
    if determinant > 0.0 { bound } else { f64::NAN }
}

/// The point where the planes of three half-spaces meet, each coordinate right to about an ulp:
/// Cramer's rule with exact determinants. `None` when they meet in no single point, or beyond what
/// a double can hold.
pub(super) fn exact_meeting(planes: [&HalfSpace; 3]) -> Option<DVec3> {
    // Powers of two change no digit, and keep products from overflowing.
    let mut rows = planes.map(HalfSpace::row);
    let scale = inverse_power_of_two(rows.iter().map(|row| row[3].abs()).fold(0.0, f64::max));
    rows.iter_mut().for_each(|row| row[3] *= scale);
    let determinant = determinant_of_three(&rows, [0, 1, 2]);
    let columns = [[3, 1, 2], [0, 3, 2], [0, 1, 3]];
    let scaled = columns.map(|columns| determinant_of_three(&rows, columns) / determinant);
    // Adding zero makes −0 and 0 one.
    let point = DVec3::from_array(scaled) / scale + DVec3::ZERO;
    (determinant != 0.0 && point.is_finite()).then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_that_differ_in_the_last_digit_meet_where_they_do() {
        // x = 1 and x + t y = 1 meet at y = 0 however small t is; z = 3 far from both.
        for t in [1.0, 1e-8, f64::EPSILON, 1e-80] {
            let plane = |x, y, z, offset| HalfSpace { normal: DVec3::new(x, y, z), offset };
            let planes =
                [plane(1.0, 0.0, 0.0, 1.0), plane(1.0, t, 0.0, 1.0), plane(0.25, 0.0, 1.0, 3.25)];
            let [a, b, c] = &planes;
            let point = exact_meeting([a, b, c]).expect("they meet");
            assert!(point.distance(DVec3::new(1.0, 0.0, 3.0)) < 1e-15, "{t:e}: {point}");
            assert_eq!(exact_meeting([a, a, c]), None);
        }
    }

    #[test]
    fn the_uncertainty_is_an_upper_bound() {
        // Planes through a known point with normals ever nearer to each other.
        let point = DVec3::new(0.5, -0.25, 0.75);
        let mut seen = [0_usize; 2];
        for shift in 0..50 {
            let near = 0.5_f64.powi(shift);
            let normals = [
                DVec3::new(0.3, 0.4, 0.8),
                DVec3::new(0.3 + near, 0.4, 0.8),
                DVec3::new(0.3, 0.4 + 0.7 * near, 0.8 - near),
            ];
            let dual = normals.map(|n| n / n.dot(point));
            let y = meeting_point(dual);
            let bound = uncertainty(dual, y, 2.0 * f64::EPSILON);
            let off = (y - point).abs().max_element();
            seen[usize::from(bound.is_nan())] += 1;
            assert!(bound.is_nan() || off <= bound, "{shift}: {off:e} of {bound:e}");
            // No more than a few thousand times what is there.
            assert!(shift > 40 || bound <= 1e-12 / near, "{shift}: {bound:e}");
        }
        assert!(seen.iter().all(|&n| n > 0), "{seen:?}");
    }
}
