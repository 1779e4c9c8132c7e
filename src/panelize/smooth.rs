//! A rough surface made even, within a distance that the user allows: each vertex goes to the
//! quadric that is fitted to what lies around it, as far as a panel reaches, and each vertex of a
//! rim to a parabola along the rim. Fits of second order keep curvature, which averages would take
//! away (Fleishman, Cohen-Or, Silva 2005, for moving least squares).

use glam::{DMat3, DVec3};

use super::curvature::offsets;
use super::refine::Triangles;
use super::report::percentile;
use super::surface::{NONE, Surface};

/// Rounds: each fit sees the directions that the one before made even.
const ROUNDS: usize = 3;
/// So far along the rim a fit looks, and the standard deviation of its weights, in panel sizes.
const REACH: f64 = 0.85;
const SPREAD: f64 = 0.45;

/// How far the surface that is used lies from the one that was given.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Moved {
    /// The farthest, and the 95th percentile, in panel sizes.
    pub distance: [f64; 2],
    /// The share of the vertices that would have gone farther than was allowed.
    pub held: f64,
}

/// The surface made even, no vertex farther than `most` from its place, and how far they went.
pub(super) fn smoothed(given: Surface, most: f64) -> (Surface, Moved) {
    let start = given.points.clone();
    let mut surface = given;
    let mut held = 0;
    for _ in 0..ROUNDS {
        let offsets = offsets(&surface);
        held = 0;
        let mut points = surface.points.clone();
        for (v, p) in points.iter_mut().enumerate() {
            let wanted = match surface.is_rim(v) {
                true => along_rim(&surface, v),
                false => *p + surface.normals[v] * offsets[v],
            };
            let way = wanted - start[v];
            held += usize::from(way.length() > most);
            *p = start[v] + way.clamp_length_max(most);
        }
        surface =
            Surface::new(Triangles { points, corners: surface.triangles, ..Triangles::default() });
    }
    let ways: Vec<f64> = start.iter().zip(&surface.points).map(|(a, b)| a.distance(*b)).collect();
    let distance = [1.0, 0.95].map(|share| percentile(&ways, share));
    (surface, Moved { distance, held: held as f64 / ways.len().max(1) as f64 })
}

/// Where a vertex of a rim should be: on the parabola through what is near it along the rim, up to
/// corners, which stay.
fn along_rim(surface: &Surface, v: usize) -> DVec3 {
    let place = surface.points[v];
    if surface.is_corner[v] {
        return place;
    }
    let mut near = vec![(0.0, place)];
    for (next, sign) in [(&surface.rim_next, 1.0), (&surface.rim_before, -1.0)] {
        let (mut u, mut way) = (v, 0.0);
        loop {
            let w = next[u];
            if w == NONE || w == v {
                break;
            }
            way += surface.points[u].distance(surface.points[w]);
            if way > REACH {
                break;
            }
            near.push((sign * way / SPREAD, surface.points[w]));
            u = w;
            if surface.is_corner[u] {
                break;
            }
        }
    }
    // Seen from the vertex, so that straight rims stay straight to the last digit.
    let (mut matrix, mut right) = (DMat3::ZERO, [DVec3::ZERO; 3]);
    for (s, p) in near {
        let weight = (-s * s / 2.0).exp();
        let powers = DVec3::new(1.0, s, s * s);
        matrix += DMat3::from_cols(powers, powers * s, powers * (s * s)) * weight;
        for (axis, sum) in right.iter_mut().enumerate() {
            *sum += powers * (weight * (p - place)[axis]);
        }
    }
    // Fewer than three places bear no parabola.
    if matrix.determinant().abs() < 1e-9 * matrix.col(0).x.powi(3) {
        return place;
    }
    let inverse = matrix.inverse();
    let move_by = DVec3::from_array(right.map(|r| (inverse * r).x));
    if move_by.is_finite() { place + move_by } else { place }
}

#[cfg(test)]
mod tests {
    use super::super::surface::SPACING;
    use super::*;
    use crate::random::Rng;

    /// A cap of radius 7 over a square of 8 panels, each vertex off it by noise; at the rim only
    /// upwards, so that its walls stay.
    fn rough(noise: f64) -> Surface {
        let count = 9;
        let point = |i: usize| {
            let (x, y) = ((i % count) as f64 - 4.0, (i / count) as f64 - 4.0);
            DVec3::new(x, y, 0.0)
        };
        let cells = (0..count - 1).flat_map(|j| (0..count - 1).map(move |i| count * j + i));
        let corners =
            cells.flat_map(|a| [[a, a + 1, a + 10], [a, a + 10, a + 9]]).collect::<Vec<_>>();
        let mut made = Triangles {
            points: (0..count * count).map(point).collect(),
            corners,
            ..Triangles::default()
        };
        assert!(made.refine(SPACING, 100_000));
        let mut random = Rng::new(7);
        for p in &mut made.points {
            let mut uniform = || random.signed();
            p.z = height(*p) + noise * (uniform() + uniform() + uniform());
        }
        Surface::new(made)
    }

    fn height(p: DVec3) -> f64 {
        (49.0 - p.x * p.x - p.y * p.y).sqrt()
    }

    /// The root mean square of the distances from the cap, along z.
    fn off(surface: &Surface) -> f64 {
        let all = surface.points.iter().map(|p| (p.z - height(*p)).powi(2));
        (all.sum::<f64>() / surface.points.len() as f64).sqrt()
    }

    #[test]
    fn noise_falls_to_a_third_and_walls_stay() {
        let given = rough(0.005);
        let before = off(&given);
        let (made, moved) = smoothed(given, 0.05);
        assert!(off(&made) < before / 3.0, "{} of {before}", off(&made));
        assert!(moved.held == 0.0 && moved.distance[0] < 0.05, "{moved:?}");
        assert!(moved.distance[1] > before, "{moved:?}");
        for v in (0..made.points.len()).filter(|&v| made.is_rim(v)) {
            let p = made.points[v];
            assert!((p.x.abs().max(p.y.abs()) - 4.0).abs() < 1e-14, "{p}");
        }
    }

    #[test]
    fn a_smooth_surface_hardly_moves_and_the_limit_holds() {
        let (_, moved) = smoothed(rough(0.0), 0.05);
        assert!(moved.distance[0] < 1e-3, "{moved:?}");
        let given = rough(0.02);
        let start = given.points.clone();
        let (made, moved) = smoothed(given, 0.01);
        let ways = start.iter().zip(&made.points).map(|(a, b)| a.distance(*b));
        let farthest = ways.fold(0.0, f64::max);
        assert!(farthest <= 0.01 * (1.0 + 1e-12), "{farthest}");
        assert!(moved.held > 0.5 && (moved.distance[0] - farthest).abs() < 1e-15, "{moved:?}");
    }
}
