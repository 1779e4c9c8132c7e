//! Planarizing what people planarize: `cargo bench --bench planarize`.
//!
//! Four models, each to the profiles `exact` and `glass`: rounds, movements and CPU seconds, and
//! whether the bar of 30 s for every one is missed. No peer is known that planarizes from a file
//! without a scene of its own, so none is compared.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::process_seconds;
use glam::DVec3;
use kerfold::check::Profile;
use kerfold::measure::planarity;
use kerfold::mesh::Mesh;
use kerfold::op::{OpContext, PlanarizeParams, Scheme, SubdivideParams, planarize, subdivide};
use kerfold::shape::{SolidParams, hexagonal_facade, solid};

/// What each may take.
const MOST_SECONDS: f64 = 30.0;

fn main() {
    println!("peer: none known");
    let models = [
        (
            "Catmull–Clark quads over a shaken torus",
            finer(Scheme::CatmullClark, &shaken_torus(40, 20), 2),
        ),
        ("honeycomb level 2", finer(Scheme::Honeycomb, &named("geodesic-4"), 2)),
        ("Doo–Sabin level 3 of a cube", finer(Scheme::DooSabin, &named("cube"), 3)),
        (
            "Doo–Sabin level 3 of a geodesic sphere",
            finer(Scheme::DooSabin, &named("geodesic-4"), 3),
        ),
        (
            "façade of 5000 hexagons, shaken",
            shaken(&hexagonal_facade(100, 50, 1000.0, [90_000.0, 60_000.0]), 10.0),
        ),
        (
            "saddle of 5000 hexagons, shaken",
            shaken(&hexagonal_facade(100, 50, 1000.0, [90_000.0, -60_000.0]), 10.0),
        ),
        (
            "5000 hexagons projected onto a dome",
            dome(&hexagonal_facade(100, 50, 1000.0, [90_000.0, 60_000.0])),
        ),
    ];
    for (name, mesh) in &models {
        for profile in [Profile::Exact, Profile::Glass] {
            measure(name, mesh, profile);
        }
    }
}

fn measure(name: &str, mesh: &Mesh, profile: Profile) {
    let start = process_seconds();
    let params = PlanarizeParams { profile, ..PlanarizeParams::default() };
    let (made, report) = planarize(mesh, &params, &OpContext::default()).expect("numbers in range");
    let seconds = process_seconds() - start;
    let broken = made.faces().filter(|&f| !profile.limits().allow(&planarity(&made, f))).count();
    let verdict = if broken > 0 || seconds > MOST_SECONDS { "MISSED" } else { "kept" };
    println!(
        "{name}, {profile}: {} faces, {} rounds, {:.2e} mm before, {:.2e} mm after; moved {:.3} mm \
        at most, {:.4} mm on average; \
         {broken} faces broken; {seconds:.2} CPU s; bar 30 s {verdict}",
        mesh.face_count(),
        report.rounds,
        report.before_mm,
        report.after_mm,
        report.largest_movement_mm,
        report.mean_movement_mm
    );
}

fn named(name: &str) -> Mesh {
    solid(&SolidParams { name: name.parse().expect("a name"), edge: None, size: None })
        .expect("a solid")
}

fn finer(scheme: Scheme, mesh: &Mesh, rounds: u32) -> Mesh {
    let params = SubdivideParams::new(scheme, rounds);
    subdivide(mesh, &params, &OpContext::default()).expect("a scheme that suits all meshes").0
}

/// A number in [−1, 1) that depends on the seed alone.
fn noise(seed: u64) -> f64 {
    let mut x = seed.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn shaken(mesh: &Mesh, shake: f64) -> Mesh {
    let mut made = mesh.clone();
    for (i, v) in mesh.vertices().enumerate() {
        let jolt = DVec3::from_array([0, 1, 2].map(|axis| shake * noise(3 * i as u64 + axis)));
        made.set_position(v, mesh.position(v) + jolt, true);
    }
    made
}

/// The same panels with their corners on a surface that no plane touches but once.
fn dome(mesh: &Mesh) -> Mesh {
    let mut made = mesh.clone();
    for v in mesh.vertices() {
        let p = mesh.position(v);
        let bend = (p.x / 20_000.0).sin() * (p.y / 14_000.0).cos();
        made.set_position(v, DVec3::new(p.x, p.y, p.z + 3_000.0 * bend), true);
    }
    made
}

/// A torus of quads with its corners shaken.
fn shaken_torus(rings: usize, sides: usize) -> Mesh {
    let point = |i: usize| {
        let turn = |k: usize, n: usize| (k as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
        let ((su, cu), (sv, cv)) = (turn(i / sides, rings), turn(i % sides, sides));
        100.0 * DVec3::new((3.0 + cv) * cu, (3.0 + cv) * su, sv)
    };
    let at = |r: usize, s: usize| (r % rings) * sides + s % sides;
    let quad = |i: usize| {
        let (r, s) = (i / sides, i % sides);
        [at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)]
    };
    let count = rings * sides;
    let torus = Mesh::from_faces((0..count).map(point), (0..count).map(quad).collect::<Vec<_>>());
    shaken(&torus.expect("a torus"), 3.0)
}
