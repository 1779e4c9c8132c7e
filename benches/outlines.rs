//! D-forms from outlines against their bars: `cargo bench --bench outlines` (`-- quick` leaves out
//! 960 points).
//!
//! Twenty random convex pairs and the pairs of the first trial at 60, 240 and 960 points: convex,
//! edges true to 1e-12 of the size, angles to 1e-9 (a body that is not is an error). 240 points in
//! a second, 960 in twenty. One piece: four outlines zipped from 21 places, each solved, flat, or
//! refused with the place. Times are CPU seconds of one thread.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;
#[path = "../src/gluing/random_points.rs"]
mod random_points;

use clock::thread_seconds;
use kerfold::gluing::{Gluing, GluingError, Outline, glue, named_outline};
use kerfold::progress::Silent;
use kerfold::random::Rng;
use random_points::random_points;

/// Points, and what the slowest body may take in seconds.
const BARS: [(usize, f64); 3] = [(60, 1.0), (240, 1.0), (960, 20.0)];
const PAIRS: [(&str, &str, f64); 6] = [
    ("circle", "ellipse-1.6x1", 0.1),
    ("ellipse-2x1", "ellipse-2x1", 0.25),
    ("ellipse-2x1", "ellipse-2x1", 0.125),
    ("superellipse-1x1-6", "ellipse-1.5x1", 0.07),
    ("trefoil-0.12", "trefoil-0.12", 1.0 / 6.0),
    ("peanut-0.25", "peanut-0.25", 0.25),
];

fn main() {
    let is_quick = std::env::args().any(|a| a == "quick");
    for (points, limit) in BARS.into_iter().filter(|b| !is_quick || b.0 < 960) {
        let (mut slowest, mut edge, mut angle) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut pairs: Vec<(Outline, Outline, f64)> =
            PAIRS.map(|(a, b, start)| (named(a), named(b), start)).to_vec();
        pairs.extend((0..20).map(random_pair));
        for (a, b, start) in pairs {
            let b = b.scaled(a.length() / b.length());
            let start = start * b.length();
            let begin = thread_seconds();
            let glued = glue(&Gluing::pair(a, b, start, points), &Silent).expect("a body");
            slowest = slowest.max(thread_seconds() - begin);
            edge = edge.max(glued.facts.edge_error);
            angle = angle.max(glued.facts.angle_error);
        }
        println!(
            "{points} points: 26 of 26 bodies, edges true to {edge:.1e} of the size, angles to \
            {angle:.1e} rad, the slowest {slowest:.2} s (bar {limit} s): {}",
            verdict(slowest <= limit && edge <= 1e-12 && angle <= 1e-9)
        );
    }
    zips();
}

fn zips() {
    for name in ["ellipse-2x1", "ellipse-3x1", "trefoil-0.12", "egg-0.2"] {
        let (mut solved, mut flat, mut refused, mut lost) = (0, 0, 0, 0);
        for k in 0..=20 {
            let outline = named(name);
            let start = outline.length() * f64::from(k) / 20.0;
            match glue(&Gluing::zip(outline, start, 240), &Silent) {
                Ok(_) => solved += 1,
                Err(GluingError::FoldsFlat { .. }) => flat += 1,
                Err(GluingError::Angle { .. }) => refused += 1,
                Err(_) => lost += 1,
            }
        }
        println!(
            "zip {name}: {solved} solved, {flat} fold flat, {refused} refused, {lost} lost: {}",
            verdict(lost == 0)
        );
    }
}

fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "MISSED" }
}

fn named(name: &str) -> Outline {
    named_outline(name).expect(name)
}

fn random_pair(seed: u64) -> (Outline, Outline, f64) {
    let mut rng = Rng::new(seed);
    let (a, b) = (random_outline(&mut rng), random_outline(&mut rng));
    (a, b, rng.unit())
}

fn random_outline(rng: &mut Rng) -> Outline {
    Outline::new("random", &random_points(|| rng.unit(), 16384)).expect("an outline")
}
