use glam::DVec3;

use super::*;
use crate::measure::{genus, volume};
use crate::shape;

const SCHEMES: [Scheme; 8] = [
    Scheme::DooSabin,
    Scheme::CatmullClark,
    Scheme::Loop,
    Scheme::Simplest,
    Scheme::Honeycomb,
    Scheme::Truncation,
    Scheme::Dual,
    Scheme::Triangulate,
];

fn run(mesh: &Mesh, scheme: Scheme, rounds: u32) -> Mesh {
    let (fine, _) = subdivide(mesh, &SubdivideParams::new(scheme, rounds), &OpContext::default())
        .expect("it fits");
    assert!(
        fine.faults().is_empty(),
        "{scheme:?}, {rounds}: {:?}",
        &fine.faults()[..fine.faults().len().min(4)]
    );
    fine
}

fn counts(mesh: &Mesh) -> [usize; 3] {
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

fn promised(scheme: Scheme, [v, e, f]: [usize; 3]) -> [usize; 3] {
    match scheme {
        Scheme::DooSabin => [2 * e, 4 * e, v + e + f],
        Scheme::CatmullClark => [v + e + f, 4 * e, 2 * e],
        Scheme::Loop => [v + e, 4 * e, f + 2 * e],
        Scheme::Simplest => [e, 2 * e, v + f],
        Scheme::Honeycomb | Scheme::Truncation => [2 * e, 3 * e, v + f],
        Scheme::Dual => [f, e, v],
        // Every face of n sides gets n − 3 diagonals.
        Scheme::Triangulate => [v, e + 2 * e - 3 * f, f + 2 * e - 3 * f],
    }
}

/// A frame of twelve boxes' worth of faces around a square hole: genus 1, with concave edges.
fn ring() -> Mesh {
    let square =
        |r: f64, z: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, y)| DVec3::new(x, y, z));
    let points = [square(2.0, 0.0), square(1.0, 0.0), square(1.0, 1.0), square(2.0, 1.0)].concat();
    let mut faces = Vec::new();
    for i in 0..4 {
        let j = (i + 1) % 4;
        faces.extend([
            [i, 4 + i, 4 + j, j],
            [4 + i, 8 + i, 8 + j, 4 + j],
            [8 + i, 12 + i, 12 + j, 8 + j],
            [12 + i, i, j, 12 + j],
        ]);
    }
    Mesh::from_faces(points, faces).expect("a ring")
}

#[test]
fn counts_are_those_of_the_table_and_genus_stays() {
    let models = [
        shape::tetrahedron(1.0),
        shape::cube(2.0),
        shape::dodecahedron(1.0),
        shape::soccer_ball(1.0),
        shape::antiprism(7, 1.0),
        ring(),
    ];
    for mesh in &models {
        for scheme in SCHEMES {
            let mut expected = counts(mesh);
            for rounds in 1..=3 {
                expected = promised(scheme, expected);
                let fine = run(mesh, scheme, rounds);
                assert_eq!(counts(&fine), expected, "{scheme:?}, {rounds} rounds");
                assert_eq!(genus(&fine), genus(mesh));
                assert!(fine.is_closed());
                let is_three_valent = fine.vertices().all(|v| fine.valence(v) == 3);
                assert!(
                    is_three_valent || !matches!(scheme, Scheme::Honeycomb | Scheme::Truncation)
                );
                assert!(
                    volume(&fine) > 0.0 && volume(&fine) < volume(mesh) * 1.5,
                    "{scheme:?} turned inside out"
                );
            }
        }
    }
}

#[test]
fn known_shapes_come_out() {
    let cube = shape::cube(2.0);
    // The cuboctahedron through the middles of a cube's edges: 8 of 48ths of the corners are cut
    // off.
    assert!((volume(&run(&cube, Scheme::Simplest, 1)) - 8.0 * 5.0 / 6.0).abs() < 1e-12);
    // The dual of the cube is the octahedron through the middles of its faces.
    assert!((volume(&run(&cube, Scheme::Dual, 1)) - 4.0 / 3.0).abs() < 1e-12);
    // Truncation at t cuts off eight corners with three legs of 2t each.
    let legs: f64 = 2.0 * 0.25;
    assert!(
        (volume(&run(&cube, Scheme::Truncation, 1)) - (8.0 - 8.0 * legs.powi(3) / 6.0)).abs()
            < 1e-12
    );
    assert!((volume(&run(&ring(), Scheme::Triangulate, 1)) - volume(&ring())).abs() < 1e-12);
    // Catmull–Clark's first points of a cube with corners at ±1: centres 1, edges 3/4, corners 5/9.
    let fine = run(&cube, Scheme::CatmullClark, 1);
    let corner = fine
        .vertices()
        .map(|v| fine.position(v))
        .find(|p| p.min_element() > 0.1)
        .expect("a corner");
    assert!(corner.abs_diff_eq(DVec3::splat(5.0 / 9.0), 1e-14), "{corner}");
    // Doo–Sabin on a cube: quads shrink to half.
    let fine = run(&cube, Scheme::DooSabin, 1);
    assert!(fine.vertices().all(|v| fine.position(v).abs().max_element() == 1.0));
    assert!(fine.vertices().all(|v| (fine.position(v).abs().min_element() - 0.5).abs() < 1e-14));
}

#[test]
fn weights_sum_to_one_so_that_moving_commutes() {
    let shift = DVec3::new(100.0, -50.0, 20.0);
    for mesh in [shape::soccer_ball(1.0), ring(), open_fan()] {
        let mut moved = mesh.clone();
        mesh.vertices().for_each(|v| moved.set_position(v, mesh.position(v) + shift, true));
        for scheme in SCHEMES {
            // The dual of five faces around one vertex is one face, and that has no inner vertex
            // left.
            let rounds = if mesh.is_closed() { 2 } else { 1 };
            let (here, there) = (run(&mesh, scheme, rounds), run(&moved, scheme, rounds));
            for v in here.vertices() {
                assert!(
                    (here.position(v) + shift).distance(there.position(v)) < 1e-12 * 100.0,
                    "{scheme:?}"
                );
            }
        }
    }
}

/// Five quads around a vertex and nothing else: open.
fn open_fan() -> Mesh {
    let ring = |i: usize, r: f64| {
        let (sin, cos) = (i as f64 * std::f64::consts::TAU / 10.0).sin_cos();
        DVec3::new(r * cos, r * sin, 0.2 * r * r)
    };
    let points =
        std::iter::once(DVec3::ZERO).chain((0..10).map(|i| ring(i, 1.0 + (i % 2) as f64 * 0.3)));
    let faces = (0..5).map(|i| [0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % 10]);
    Mesh::from_faces(points, faces).expect("a fan")
}

#[test]
fn a_rim_stays_a_rim() {
    let fan = open_fan();
    for scheme in SCHEMES {
        let rounds = if matches!(scheme, Scheme::Dual | Scheme::Simplest | Scheme::Honeycomb) {
            1
        } else {
            2
        };
        let fine = run(&fan, scheme, rounds);
        assert_eq!(
            (fine.hole_count(), fine.components().len()),
            (fan.hole_count(), 1),
            "{scheme:?}"
        );
    }
}

#[test]
fn groups_follow_their_faces() {
    let mut cube = shape::cube(1.0);
    cube.set_group(FaceId::new(2), "lid");
    for scheme in SCHEMES {
        let fine = run(&cube, scheme, 1);
        let count = fine.faces().filter(|&f| fine.group(f) == Some("lid")).count();
        let expected = match scheme {
            Scheme::CatmullClark => 4,
            Scheme::Loop => 5,
            Scheme::Triangulate => 2,
            Scheme::Dual => 0,
            _ => 1,
        };
        assert_eq!(count, expected, "{scheme:?}");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let cube = shape::cube(1.0);
    let refuse = |params: SubdivideParams| {
        subdivide(&cube, &params, &OpContext::default()).expect_err("refused")
    };
    assert!(matches!(
        refuse(SubdivideParams::new(Scheme::DooSabin, 0)),
        OpError::RepeatOutOfRange { .. }
    ));
    assert!(matches!(
        refuse(SubdivideParams::new(Scheme::DooSabin, 33)),
        OpError::RepeatOutOfRange { .. }
    ));
    let cut = |scheme, offset| SubdivideParams { scheme, rounds: 1, offset: Some(offset) };
    assert!(matches!(refuse(cut(Scheme::Truncation, 0.5)), OpError::ShareOutOfRange { .. }));
    assert!(matches!(refuse(cut(Scheme::Truncation, f64::NAN)), OpError::ShareOutOfRange { .. }));
    assert!(matches!(refuse(cut(Scheme::Dual, 0.3)), OpError::Requires { .. }));
}
