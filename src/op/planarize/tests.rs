use glam::DVec3;

use super::*;
use crate::mesh::assert_sound;
use crate::progress::Silent;

/// A number in [−1, 1) that depends on the seed alone.
fn noise(seed: u64) -> f64 {
    let mut x = seed.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A torus of quads, shaken: closed, with saddles.
fn shaken_torus(rings: usize, shake: f64) -> Mesh {
    let sides = rings / 2;
    let point = |i: usize| {
        let (u, v) = ((i / sides) as f64 / rings as f64, (i % sides) as f64 / sides as f64);
        let ((su, cu), (sv, cv)) =
            ((u * std::f64::consts::TAU).sin_cos(), (v * std::f64::consts::TAU).sin_cos());
        let jolt = [0, 1, 2].map(|axis| shake * noise(3 * i as u64 + axis));
        100.0 * DVec3::new((3.0 + cv) * cu, (3.0 + cv) * su, sv) + DVec3::from_array(jolt)
    };
    let faces = (0..rings * sides).map(|i| {
        let (r, s) = (i / sides, i % sides);
        let at = |r: usize, s: usize| (r % rings) * sides + s % sides;
        [at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)]
    });
    Mesh::from_faces((0..rings * sides).map(point), faces.collect::<Vec<_>>()).expect("a torus")
}

/// A façade of hexagons over a dome: open, three edges at every inner vertex.
pub(super) fn hexagon_dome(columns: usize, rows: usize) -> Mesh {
    // A brick wall whose bricks have six corners: two rows of corners for each row of bricks.
    let width = 2 * columns + 2;
    let radius = 40.0 * columns as f64;
    let mut points = Vec::new();
    for row in 0..=rows {
        for i in 0..width {
            let x = i as f64 * 0.866 * 20.0;
            let is_up = (i + row) % 2 == 0;
            let y = row as f64 * 30.0 + if is_up { 5.0 } else { -5.0 };
            let (dx, dy) = (x - 8.66 * width as f64, y - 15.0 * rows as f64);
            points.push(DVec3::new(x, y, -(dx * dx + 1.3 * dy * dy) / (2.0 * radius)));
        }
    }
    let mut faces = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let first = 2 * column + row % 2;
            let (low, high) = (row * width + first, (row + 1) * width + first);
            faces.push([low, low + 1, low + 2, high + 2, high + 1, high]);
        }
    }
    Mesh::from_faces(points, faces).expect("a wall of hexagons")
}

fn run(mesh: &Mesh, params: &PlanarizeParams) -> (Mesh, PlanarizeReport) {
    let (made, report) = planarize(mesh, params, &OpContext::default()).expect("numbers in range");
    assert_sound(&made);
    assert_eq!((made.vertex_count(), made.face_count()), (mesh.vertex_count(), mesh.face_count()));
    (made, report)
}

fn is_planar(mesh: &Mesh, profile: Profile) -> bool {
    mesh.faces().all(|f| profile.limits().allow(&planarity(mesh, f)))
}

#[test]
fn quads_of_a_shaken_torus_become_planar_and_move_little() {
    let torus = shaken_torus(24, 4.0);
    assert!(!is_planar(&torus, Profile::Glass));
    let (made, report) = run(&torus, &PlanarizeParams::default());
    assert!(report.is_planar && is_planar(&made, Profile::Exact), "{report:?}");
    assert!(report.largest_movement_mm < 12.0 && report.rounds < 60, "{report:?}");
    // Planes were carried along: a cut of the result is exact.
    assert!(made.faces().all(|f| made.carried_plane(f).is_some()));
}

#[test]
fn a_facade_of_hexagons_on_a_dome() {
    let dome = hexagon_dome(12, 12);
    let (made, report) = run(&dome, &PlanarizeParams::default());
    assert!(report.is_planar && is_planar(&made, Profile::Exact), "{report:?}");
    let (fixed, report) = run(
        &dome,
        &PlanarizeParams {
            rim: RimRule::Fixed,
            profile: Profile::Glass,
            ..PlanarizeParams::default()
        },
    );
    assert!(report.is_planar, "{report:?}");
    for v in dome.vertices().filter(|&v| dome.is_rim_vertex(v)) {
        assert_eq!(dome.position(v), fixed.position(v));
    }
}

#[test]
fn planar_models_stay_as_they_are_to_the_bit() {
    let dodecahedron = crate::shape::dodecahedron(40.0);
    let (made, report) = run(&dodecahedron, &PlanarizeParams::default());
    assert!(report.is_planar && report.rounds <= 1);
    assert!(dodecahedron.vertices().all(|v| made.position(v) == dodecahedron.position(v)));
}

#[test]
fn scale_and_place_do_not_matter() {
    let torus = shaken_torus(16, 4.0);
    let (plain, plain_report) = run(&torus, &PlanarizeParams::default());
    for (scale, shift) in
        [(1e-2, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, DVec3::new(37_000.0, -5_000.0, 900.0))]
    {
        let mut other = torus.clone();
        torus
            .vertices()
            .for_each(|v| other.set_position(v, torus.position(v) * scale + shift, true));
        let (made, report) = run(&other, &PlanarizeParams::default());
        assert!(report.is_planar);
        // Whether a last round helps is decided within the rounding, which is another one here.
        assert!(report.rounds.abs_diff(plain_report.rounds) <= 1, "{}", report.rounds);
        for v in torus.vertices() {
            let back = (made.position(v) - shift) / scale;
            assert!(back.distance(plain.position(v)) < 1e-6, "{v}: {back} {}", plain.position(v));
        }
    }
}

#[test]
fn fairness_smooths_the_movement() {
    let torus = shaken_torus(20, 3.0);
    let roughness = |made: &Mesh| -> f64 {
        let moved = |v: VertexId| made.position(v) - torus.position(v);
        torus
            .edges()
            .map(|e| torus.edge_vertices(e))
            .map(|[u, v]| moved(u).distance_squared(moved(v)))
            .sum()
    };
    let (plain, _) = run(&torus, &PlanarizeParams::default());
    let (fair, report) =
        run(&torus, &PlanarizeParams { fairness: 3.0, ..PlanarizeParams::default() });
    assert!(report.is_planar);
    assert!(
        roughness(&fair) < 0.98 * roughness(&plain),
        "{} {}",
        roughness(&fair),
        roughness(&plain)
    );
}

#[test]
fn what_cannot_move_is_told() {
    let torus = shaken_torus(8, 4.0);
    let all = PlanarizeParams { fix: Some(Selection::all()), ..PlanarizeParams::default() };
    let error = planarize(&torus, &all, &OpContext::default()).expect_err("nothing may move");
    assert!(matches!(error, OpError::AllCornersFixed { .. }), "{error}");
    for bad in [
        PlanarizeParams { closeness: 0.0, ..PlanarizeParams::default() },
        PlanarizeParams { closeness: f64::NAN, ..PlanarizeParams::default() },
        PlanarizeParams { fairness: -1.0, ..PlanarizeParams::default() },
        PlanarizeParams { rounds: 0, ..PlanarizeParams::default() },
    ] {
        assert!(planarize(&torus, &bad, &OpContext { made: None, progress: &Silent }).is_err());
    }
    let (_, report) = run(&torus, &PlanarizeParams { rounds: 1, ..PlanarizeParams::default() });
    assert!(!report.is_planar && report.worst.is_some() && report.notes().len() == 3);
}

#[test]
fn faces_that_the_movement_made_cross_are_named() {
    use crate::op::{Scheme, SierpinskiParams, SubdivideParams, sierpinski, subdivide};
    let context = OpContext::default();
    let (gasket, _) =
        sierpinski(&crate::shape::tetrahedron(200.0), &SierpinskiParams { rounds: 1 }, &context)
            .expect("a round on a tetrahedron");
    let (smoothed, _) =
        subdivide(&gasket, &SubdivideParams::new(Scheme::CatmullClark, 2), &context)
            .expect("two rounds");
    let crosses = |mesh: &Mesh| -> Vec<FaceId> {
        mesh.faces().filter(|&f| self_contact(mesh, f).is_some()).collect()
    };
    // The movement that keeps faces star-shaped makes none of them cross; what did would be named.
    let before = crosses(&smoothed);
    let (made, mut report) =
        run(&smoothed, &PlanarizeParams { profile: Profile::Paper, ..PlanarizeParams::default() });
    let new: Vec<FaceId> = crosses(&made).into_iter().filter(|f| !before.contains(f)).collect();
    assert!(new.is_empty() && report.crossing == new, "{new:?} {report:?}");
    report.crossing = made.faces().take(2).collect();
    assert!(report.is_planar && !report.is_clean());
    let told = report.notes().concat();
    assert!(
        told.contains("(F505)") && told.contains(&format!("{}, ", report.crossing[0])),
        "{told}"
    );
    let (_, report) = run(&shaken_torus(24, 4.0), &PlanarizeParams::default());
    assert!(report.is_clean() && report.crossing.is_empty());
}

/// A tip of 0.2° becomes one of 0.05°, too narrow for any tool.
#[test]
fn a_tip_that_becomes_a_needle_is_a_finding() {
    let wedge = |degrees: f64| {
        let half = 100.0 * (degrees.to_radians() / 2.0).tan();
        let points = [[0.0, 0.0, 0.0], [100.0, -half, 0.0], [200.0, 0.0, 0.0], [100.0, half, 0.0]];
        Mesh::from_faces(points.map(DVec3::from_array), [[0, 1, 2, 3]]).expect("a plate")
    };
    let needles = super::damage::needles(&wedge(0.2), &wedge(0.05));
    let places: Vec<_> = needles.iter().map(|n| (n.face.index(), n.vertex.index())).collect();
    assert_eq!(places, [(0, 0), (0, 2)]);
    assert!(needles.iter().all(|n| (n.degrees - 0.05).abs() < 1e-9), "{needles:?}");
    assert_eq!(super::damage::needles(&wedge(0.05), &wedge(0.05)), [], "it was one before");
    let (_, mut report) = run(&shaken_torus(24, 4.0), &PlanarizeParams::default());
    assert!(!report.notes().concat().contains("F506"));
    report.needles = needles;
    assert!(!report.is_clean() && report.is_planar);
    assert!(report.notes().iter().any(|note| note.contains("F506")), "{:?}", report.notes());
}
