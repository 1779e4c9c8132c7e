//! A point deep inside half-spaces: the centre of a largest ball, as a small linear programme.
//!
//! Sources: Clarkson 1995 for working on few constraints and adding the one violated most; Seidel
//! 1991, "Small-dimensional linear programming made easy", for solving with one constraint more by
//! going down one dimension. All in rounded arithmetic: whoever uses the point checks it exactly.

use super::half_space::HalfSpace;
use glam::DVec3;

/// The centre of a largest ball inside half-spaces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Centre {
    pub point: DVec3,
    /// Below zero when the half-spaces have nothing in common: then every half-space must move
    /// outwards by that much at least.
    pub radius: f64,
    /// The half-spaces that the ball touches, ascending: those that keep it from growing.
    pub touching: Vec<usize>,
}

/// Σ a[i]·x[i] ≤ b with x = (x, y, z, radius).
#[derive(Debug, Clone, Copy)]
struct Constraint {
    a: [f64; 4],
    b: f64,
}

/// How far from the origin the centre is sought, in units of the largest distance of a plane from
/// the origin.
const FARTHEST: f64 = 1e9;
/// Rounds after which the search ends with what it has.
const MOST_ROUNDS: usize = 2000;
/// Relative to the size of the terms: less is rounding.
const ROUNDING: f64 = 1e-13;

/// Finds the centre, up to rounding.
pub(super) fn deepest_point(half_spaces: &[HalfSpace]) -> Centre {
    let unit = half_spaces.iter().map(|h| (h.offset / h.normal.length()).abs()).fold(0.0, f64::max);
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let constraint = |h: &HalfSpace| {
        let length = h.normal.length();
        let n = h.normal / length;
        Constraint { a: [n.x, n.y, n.z, 1.0], b: h.offset / length / unit }
    };
    // A ball in a bounded set is smaller than the largest distance of a plane, so the bound of 2 is
    // never reached there.
    let reach = [FARTHEST, FARTHEST, FARTHEST, 2.0];
    let mut x = [0.0, 0.0, 0.0, 2.0];
    let mut chosen: Vec<usize> = Vec::new();
    let mut constraints: Vec<Constraint> = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let violation = |h: &HalfSpace| constraint(h).excess(&x);
        let worst = (0..half_spaces.len())
            .max_by(|&i, &j| violation(&half_spaces[i]).total_cmp(&violation(&half_spaces[j])));
        let Some(worst) = worst.filter(|&i| constraint(&half_spaces[i]).is_violated(&x)) else {
            break;
        };
        if chosen.contains(&worst) {
            break;
        }
        let newest = constraint(&half_spaces[worst]);
        match on_boundary(&newest, &constraints, &[0.0, 0.0, 0.0, 1.0], &reach, 4) {
            Some(next) => x = next,
            None => break,
        }
        chosen.push(worst);
        constraints.push(newest);
    }
    let slack = |i: usize| -constraint(&half_spaces[i]).excess(&x);
    let mut touching: Vec<usize> =
        chosen.into_iter().filter(|&i| slack(i).abs() <= 1e-9 * (1.0 + x[3].abs())).collect();
    touching.sort_unstable();
    Centre { point: DVec3::new(x[0], x[1], x[2]) * unit, radius: x[3] * unit, touching }
}

impl Constraint {
    fn excess(&self, x: &[f64; 4]) -> f64 {
        (0..4).map(|i| self.a[i] * x[i]).sum::<f64>() - self.b
    }

    fn is_violated(&self, x: &[f64; 4]) -> bool {
        let terms: f64 = (0..4).map(|i| (self.a[i] * x[i]).abs()).sum();
        self.excess(x) > ROUNDING * (terms + self.b.abs())
    }
}

/// The greatest value of `aim`·x over the first `dimension` coordinates under constraints and
/// |x[i]| ≤ reach[i]; `None` when nothing fulfils them.
fn maximise(
    constraints: &[Constraint],
    aim: &[f64; 4],
    reach: &[f64; 4],
    dimension: usize,
) -> Option<[f64; 4]> {
    let mut x = [0.0; 4];
    for i in 0..dimension {
        x[i] = if aim[i] == 0.0 { 0.0 } else { reach[i].copysign(aim[i]) };
    }
    for (k, constraint) in constraints.iter().enumerate() {
        if constraint.is_violated(&x) {
            x = on_boundary(constraint, &constraints[..k], aim, reach, dimension)?;
        }
    }
    Some(x)
}

/// The same with one constraint taken as an equation: one coordinate is eliminated and the rest
/// solved.
fn on_boundary(
    equation: &Constraint,
    constraints: &[Constraint],
    aim: &[f64; 4],
    reach: &[f64; 4],
    dimension: usize,
) -> Option<[f64; 4]> {
    let out =
        (0..dimension).max_by(|&i, &j| equation.a[i].abs().total_cmp(&equation.a[j].abs()))?;
    let pivot = equation.a[out];
    let size: f64 = equation.a.iter().map(|a| a.abs()).sum();
    if pivot.abs() <= ROUNDING * size || pivot == 0.0 {
        return None;
    }
    // The eliminated coordinate changes places with the last, which then is left out.
    let last = dimension - 1;
    let moved = |values: &[f64; 4]| {
        let mut values = *values;
        values.swap(out, last);
        values
    };
    let row = moved(&equation.a);
    let project = |a: &[f64; 4], b: f64| {
        let a = moved(a);
        let factor = a[last] / pivot;
        let mut rest = [0.0; 4];
        for i in 0..last {
            rest[i] = a[i] - factor * row[i];
        }
        Constraint { a: rest, b: b - factor * equation.b }
    };
    let unit = |sign: f64| std::array::from_fn(|i| if i == out { sign } else { 0.0 });
    let bounds = [1.0, -1.0].map(|sign| project(&unit(sign), reach[out]));
    let projected: Vec<Constraint> =
        bounds.into_iter().chain(constraints.iter().map(|c| project(&c.a, c.b))).collect();
    let mut x = if last == 0 {
        projected.iter().all(|c| !c.is_violated(&[0.0; 4])).then_some([0.0; 4])?
    } else {
        maximise(&projected, &project(aim, 0.0).a, &moved(reach), last)?
    };
    x[last] = (equation.b - (0..last).map(|i| row[i] * x[i]).sum::<f64>()) / pivot;
    Some(moved(&x))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaces(planes: &[(f64, f64, f64, f64)]) -> Vec<HalfSpace> {
        planes
            .iter()
            .map(|&(x, y, z, offset)| HalfSpace { normal: DVec3::new(x, y, z), offset })
            .collect()
    }

    #[test]
    fn the_ball_of_a_box_far_away_touches_the_nearest_sides() {
        let sides = [
            (1., 0., 0., 1e6 + 3.),
            (-2., 0., 0., -2e6),
            (0., 1., 0., 1.),
            (0., -1., 0., 1.),
            (0., 0., 1., 9.),
            (0., 0., -1., 9.),
        ];
        let centre = deepest_point(&spaces(&sides));
        assert!((centre.radius - 1.0).abs() < 1e-8, "{centre:?}");
        assert!((centre.point.x - 1e6 - 1.5).abs() < 0.51 && centre.point.y.abs() < 1e-8);
        assert!([2, 3].iter().all(|i| centre.touching.contains(i)), "{centre:?}");
    }

    #[test]
    fn what_excludes_each_other_is_named() {
        let sides = [
            (1., 0., 0., 5.),
            (-1., 0., 0., 5.),
            (0., 1., 0., 5.),
            (0., 0., 3., 3.),
            (0., 0., -1., -2.),
            (0., -1., 0., 5.),
        ];
        let centre = deepest_point(&spaces(&sides));
        assert!((centre.radius + 0.5).abs() < 1e-12, "{centre:?}");
        assert_eq!(centre.touching, [3, 4]);
    }
}
