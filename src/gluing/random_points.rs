//! Points of random convex outlines, for the tests and for the bench, which takes this file by its
//! path.

use std::f64::consts::TAU;

use glam::DVec2;

/// Points of a smooth convex outline of about 50 mm in radius: a support function with a positive
/// radius of curvature. `unit` gives random numbers from 0 to 1.
pub fn random_points(mut unit: impl FnMut() -> f64, count: usize) -> Vec<DVec2> {
    let waves: Vec<[f64; 3]> = (2..6).map(|k| [f64::from(k), unit(), TAU * unit()]).collect();
    let total: f64 = waves.iter().map(|[k, a, _]| a * (k * k - 1.0)).sum();
    let point = |i: usize| {
        let t = TAU * i as f64 / count as f64;
        let (mut h, mut slope) = (1.0, 0.0);
        for &[k, a, phase] in &waves {
            h += 0.9 / total * a * (k * t + phase).cos();
            slope -= 0.9 / total * a * k * (k * t + phase).sin();
        }
        50.0 * (h * DVec2::from_angle(t) + slope * DVec2::from_angle(t).perp())
    };
    (0..count).map(point).collect()
}
