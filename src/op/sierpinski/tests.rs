use glam::DVec3;

use super::*;
use crate::measure::{genus, volume};
use crate::op::{Scheme, SubdivideParams, subdivide};
use crate::shape;

fn run(mesh: &Mesh, rounds: u32) -> (Mesh, SierpinskiReport) {
    let (fine, report) =
        sierpinski(mesh, &SierpinskiParams { rounds }, &OpContext::default()).expect("it fits");
    assert!(
        fine.faults().is_empty(),
        "{rounds}: {:?}",
        &fine.faults()[..fine.faults().len().min(4)]
    );
    (fine, report)
}

fn solids() -> Vec<Mesh> {
    let platonic = shape::Platonic::ALL.map(|solid| shape::platonic(solid, 1.0));
    [&platonic[..], &[shape::soccer_ball(1.0)]].concat()
}

#[test]
fn counts_and_genus_are_the_closed_forms() {
    for mesh in &solids() {
        let (v, e) = (mesh.vertex_count(), mesh.edge_count());
        for rounds in 1..=5 {
            let (fine, report) = run(mesh, rounds);
            let power = 4_usize.pow(rounds);
            let loops = e * (power - 1) / 3;
            assert_eq!(fine.vertex_count(), v + loops);
            assert_eq!(fine.edge_count(), e * power + loops);
            assert_eq!(fine.face_count(), v + 2 * loops);
            assert_eq!(report.loops, loops);
            assert_eq!(genus(&fine), 1 + e * (power + 2) / 6 - v);
            assert!(fine.is_closed() && fine.components().len() == 1 && volume(&fine) > 0.0);
        }
    }
}

#[test]
fn the_sides_are_those_that_were_measured() {
    let (fine, _) = run(&shape::octahedron(1.0), 3);
    let sides = crate::measure::sides_histogram(&fine);
    assert_eq!(sides.into_iter().collect::<Vec<_>>(), [(3, 264), (4, 120), (6, 120), (8, 6)]);
}

#[test]
fn a_tetrahedron_keeps_half_of_its_volume_in_each_round() {
    let mesh = shape::tetrahedron(10.0);
    for rounds in 1..=3 {
        let kept = volume(&run(&mesh, rounds).0) / volume(&mesh);
        assert!((kept - 0.5_f64.powi(rounds as i32)).abs() < 1e-12, "{kept}");
    }
}

#[test]
fn a_smoothed_one_stays_connected() {
    let (fine, _) = run(&shape::tetrahedron(1.0), 2);
    let (smooth, _) =
        subdivide(&fine, &SubdivideParams::new(Scheme::DooSabin, 2), &OpContext::default())
            .expect("it fits");
    assert!(smooth.faults().is_empty());
    assert_eq!((smooth.components().len(), genus(&smooth)), (1, 15));
}

#[test]
fn the_pyramids_of_a_rim_are_parted() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.5)];
    let open = Mesh::from_faces(points, [[0, 1, 2], [1, 3, 2]]).expect("two triangles");
    let (fine, report) = run(&open, 2);
    // Two corners of one triangle and two of two: 4 parts, of which each is as the whole or as one
    // triangle was.
    assert_eq!((fine.hole_count(), fine.components().len(), report.kinds[5]), (14, 14, 4));
    assert_eq!((report.loops, fine.file_faults()), (0, Vec::new()));
}

#[test]
fn groups_go_to_the_corners() {
    let mut cube = shape::cube(1.0);
    cube.set_group(FaceId::new(2), "lid");
    let (fine, _) = run(&cube, 1);
    let lid: Vec<FaceId> = fine.faces().filter(|&f| fine.group(f) == Some("lid")).collect();
    assert_eq!(lid.len(), 4);
    let normal = cube.plane(FaceId::new(2)).expect("a plane").normal();
    assert!(lid.iter().all(|&f| fine.plane(f).expect("a plane").normal().distance(normal) < 1e-14));
}

/// A pyramid over the base, with the tip at the height given; the base is counter-clockwise seen
/// from above.
fn pyramid(base: &[(f64, f64)], tip: f64) -> Mesh {
    let n = base.len();
    let points =
        base.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).chain([DVec3::Z * tip, -DVec3::Z]);
    let faces = (0..n).flat_map(|i| [[i, (i + 1) % n, n], [(i + 1) % n, i, n + 1]]);
    Mesh::from_faces(points, faces).expect("a double pyramid")
}

#[test]
fn the_five_kinds_are_told_apart() {
    let square = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    let dented = [(1.0, 0.0), (0.2, 0.2), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    let kind =
        |base: &[(f64, f64)], tip: f64| vertex_kind(&pyramid(base, tip), VertexId::new(base.len()));
    for scale in [1e-3, 1.0, 1e5] {
        let scaled = |base: &[(f64, f64)]| {
            base.iter().map(|p| (p.0 * scale, p.1 * scale)).collect::<Vec<_>>()
        };
        assert_eq!(kind(&scaled(&square), scale), VertexKind::Convex);
        assert_eq!(kind(&scaled(&square), 0.0), VertexKind::Planar);
        assert_eq!(kind(&scaled(&square), -0.5 * scale.min(1.0)), VertexKind::Concave);
        assert_eq!(kind(&scaled(&dented), scale), VertexKind::Star);
    }
    let mut saddle = pyramid(&square, 0.0);
    for (i, z) in [0.3, -0.3, 0.3, -0.3].into_iter().enumerate() {
        let v = VertexId::new(i);
        saddle.set_position(v, saddle.position(v) + DVec3::Z * z, true);
    }
    assert_eq!(vertex_kind(&saddle, VertexId::new(4)), VertexKind::Saddle);
    for mesh in &solids() {
        assert!(mesh.vertices().all(|v| vertex_kind(mesh, v) == VertexKind::Convex));
    }
    let (_, report) = run(&saddle, 1);
    assert!(report.notes().iter().any(|n| n.starts_with("saddle: ")), "{:?}", report.notes());
}

#[test]
fn what_does_not_fit_is_refused() {
    let cube = shape::cube(1.0);
    let refuse = |rounds| {
        sierpinski(&cube, &SierpinskiParams { rounds }, &OpContext::default()).expect_err("refused")
    };
    assert!(matches!(refuse(0), OpError::RepeatOutOfRange { .. }));
    assert!(matches!(refuse(33), OpError::RepeatOutOfRange { .. }));
}
