use glam::DVec3;

use super::*;
use crate::measure::{genus, volume};
use crate::mesh::FaceId;
use crate::shape;

fn run(mesh: &Mesh, params: &MengerParams) -> (Mesh, MengerReport) {
    let (sponge, report) = menger(mesh, params, &OpContext::default()).expect("a sponge");
    assert!(sponge.faults().is_empty(), "{:?}", &sponge.faults()[..sponge.faults().len().min(4)]);
    assert!(sponge.is_closed() && sponge.components().len() == 1 && volume(&sponge) > 0.0);
    (sponge, report)
}

fn share(share: f64, rounds: u32) -> MengerParams {
    MengerParams { rounds, thickness: Thickness::Share(share), ..MengerParams::default() }
}

fn counts(mesh: &Mesh) -> [usize; 3] {
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

#[test]
fn counts_and_genus_are_the_closed_forms() {
    let solids = [
        shape::octahedron(1.0),
        shape::dodecahedron(1.0),
        shape::icosahedron(1.0),
        shape::soccer_ball(1.0),
    ];
    for mesh in &solids {
        let [v, e, f] = counts(mesh);
        let (sponge, report) = run(mesh, &share(0.2, 1));
        assert_eq!(counts(&sponge), [v + 6 * e, 15 * e, 7 * e + v]);
        assert_eq!((genus(&sponge), report.crossing.len()), (f - 1, 0));
    }
    // Where the tunnels' ends meet: a strip left out takes an edge and a face, the three corners at
    // a vertex become one.
    let (cube, report) = run(&shape::cube(1.0), &MengerParams::default());
    assert_eq!((counts(&cube), genus(&cube), report.crossing.len()), ([64, 144, 72], 5, 0));
    let (tetrahedron, report) = run(&shape::tetrahedron(1.0), &share(0.15, 1));
    assert_eq!(
        (counts(&tetrahedron), genus(&tetrahedron), report.crossing.len()),
        ([32, 72, 36], 3, 0)
    );
}

#[test]
fn the_general_sponge_of_a_cube_is_the_exact_one_at_first() {
    for (rounds, expected) in [(1, 5), (2, 81)] {
        let (sponge, report) = run(&shape::cube(3.0), &share(1.0 / 3.0, rounds));
        assert_eq!((genus(&sponge), report.crossing.len()), (expected, 0));
        let kept = volume(&sponge) / 27.0;
        assert!((kept - (20.0_f64 / 27.0).powi(rounds as i32)).abs() < 1e-12, "{kept}");
    }
}

#[test]
fn slits_without_area_are_not_left_behind() {
    for thickness in [1.0 / 3.0, 0.25, 0.2] {
        let (sponge, _) = run(&shape::cube(3.0), &share(thickness, 2));
        let thin = sponge.faces().filter(|&f| crate::measure::face_area(&sponge, f) < 1e-12);
        assert_eq!((thin.count(), genus(&sponge)), (0, 81), "{thickness}");
    }
}

#[test]
fn the_exact_sponge_has_its_genus_and_volume() {
    let sheared = {
        let mut cube = shape::cube(1.0);
        for v in cube.vertices().collect::<Vec<_>>() {
            let p = cube.position(v);
            cube.set_position(v, p * 40.0 + DVec3::new(0.3 * p.y + 500.0, 0.2 * p.z, 0.0), true);
        }
        cube
    };
    for mesh in [shape::cube(10.0), shape::cuboid(DVec3::new(1.0, 2.0, 3.0)), sheared] {
        for (rounds, expected, faces) in [(1, 5, 72), (2, 81, 1056), (3, 1409, 18048)] {
            let exact = MengerParams { rounds, exact: true, ..MengerParams::default() };
            let (sponge, _) = run(&mesh, &exact);
            assert_eq!((genus(&sponge), sponge.face_count()), (expected, faces));
            let kept = volume(&sponge) / volume(&mesh);
            assert!((kept - (20.0_f64 / 27.0).powi(rounds as i32)).abs() < 1e-12, "{kept}");
        }
    }
}

/// A box with a step: one concave edge, with a corner of three concave neighbours nowhere.
fn step() -> Mesh {
    let outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)];
    let points = [0.0, 2.0].into_iter().flat_map(|z| outline.map(|(x, y)| DVec3::new(x, y, z)));
    let sides = (0..6).map(|i| vec![i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i]);
    let ends = [vec![5, 4, 3, 2, 1, 0], vec![6, 7, 8, 9, 10, 11]];
    Mesh::from_faces(points, sides.chain(ends)).expect("a prism")
}

#[test]
fn strips_bend_around_concave_edges() {
    let mesh = step();
    let (sponge, report) = run(&mesh, &share(0.2, 1));
    assert_eq!((genus(&sponge), report.crossing.len()), (mesh.face_count() - 1, 0));
    // Ten corners of three right angles, and two where one edge is concave: there its strip is the
    // only one, so that it is left out, too.
    assert!(volume(&sponge) < volume(&mesh));
    let (deeper, _) = run(&mesh, &share(0.2, 2));
    assert_eq!(genus(&deeper), 2 * genus(&sponge) + sponge.face_count() - 1);
}

#[test]
fn the_result_scales_with_the_input() {
    let (small, large) = (shape::icosahedron(1e-3), shape::icosahedron(1e5));
    let (a, b) = (run(&small, &share(0.2, 2)).0, run(&large, &share(0.2, 2)).0);
    assert_eq!(counts(&a), counts(&b));
    assert!((volume(&a) / volume(&small) - volume(&b) / volume(&large)).abs() < 1e-9);
    let length =
        MengerParams { thickness: "2mm".parse().expect("a length"), ..MengerParams::default() };
    assert!((volume(&run(&shape::cube(6.0), &length).0) - 8.0 * 20.0).abs() < 1e-10);
}

#[test]
fn groups_go_to_frames() {
    let mut cube = shape::cube(1.0);
    cube.set_group(FaceId::new(2), "lid");
    let (sponge, _) = run(&cube, &MengerParams::default());
    let lid = sponge.faces().filter(|&f| sponge.group(f) == Some("lid"));
    let normal = cube.plane(FaceId::new(2)).expect("a plane").normal();
    assert_eq!(
        lid.filter(|&f| sponge.plane(f).expect("a plane").normal().distance(normal) < 1e-14)
            .count(),
        8
    );
}

#[test]
fn what_does_not_fit_is_told_or_refused() {
    let tetrahedron = shape::tetrahedron(1.0);
    let (_, report) = menger(&tetrahedron, &share(0.3, 1), &OpContext::default())
        .expect("a sponge that crosses itself");
    assert_eq!(report.crossing, [RoundCrossing { round: 1, faces: vec![0, 1, 2, 3] }]);
    assert!(report.notes()[0].contains("too large"));
    let refuse = |mesh: &Mesh, p: MengerParams| {
        menger(mesh, &p, &OpContext::default()).expect_err("refused")
    };
    assert!(matches!(refuse(&tetrahedron, share(0.5, 1)), OpError::ShareOutOfRange { .. }));
    assert!(matches!(refuse(&tetrahedron, share(0.2, 0)), OpError::RepeatOutOfRange { .. }));
    let exact = MengerParams { exact: true, ..MengerParams::default() };
    assert!(matches!(refuse(&tetrahedron, exact.clone()), OpError::NotABox));
    assert!(matches!(
        refuse(&tetrahedron, MengerParams { exact: true, ..share(0.2, 1) }),
        OpError::Exclude { .. }
    ));
    let wide = MengerParams { collapse: Angle::from_degrees(180.0), ..exact };
    assert!(matches!(refuse(&tetrahedron, wide), OpError::AngleOutOfRange { .. }));
    let sheet =
        Mesh::from_faces([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]]).expect("a triangle");
    assert!(matches!(refuse(&sheet, MengerParams::default()), OpError::NotClosed { .. }));
}

#[test]
fn self_loops_have_no_frame_of_their_own() {
    use crate::op::{SierpinskiParams, sierpinski};
    let (gasket, _) =
        sierpinski(&shape::cube(1.0), &SierpinskiParams { rounds: 1 }, &OpContext::default())
            .expect("a round on a cube");
    let (sponge, report) = run(&gasket, &share(0.125, 1));
    // 2 g + F - 1 with genus 5 and 32 faces; the pyramids' bases are dug as well, and nothing
    // crosses.
    assert_eq!((genus(&sponge), report.crossing.len()), (41, 0));
    let (_, report) = menger(&gasket, &share(0.25, 1), &OpContext::default())
        .expect("a sponge that crosses itself");
    assert_eq!(report.crossing, [RoundCrossing { round: 1, faces: (0..32).collect() }]);
}
