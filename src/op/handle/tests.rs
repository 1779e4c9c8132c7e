use super::*;
use crate::measure::{genus, volume};
use crate::shape;
use crate::units::Angle;

fn params(from: &str, to: &str, segments: u32) -> HandleParams {
    HandleParams {
        from: from.parse().expect("a face"),
        to: to.parse().expect("a face"),
        segments,
        also: Vec::new(),
        axis: None,
        weights: None,
        twist: Angle::default(),
    }
}

fn run(mesh: &Mesh, params: &HandleParams) -> (Mesh, HandleReport) {
    let (made, report) = handle(mesh, params, &OpContext::default()).expect("a handle");
    assert!(made.faults().is_empty(), "{:?}", &made.faults()[..made.faults().len().min(4)]);
    assert!(made.is_closed());
    let adds = params.segments > 1 && report.crossing.is_empty();
    assert!(
        !adds || volume(&made) > volume(mesh),
        "{params:?}: {} of {}",
        volume(&made),
        volume(mesh)
    );
    assert_eq!(report.made.faces.len() % params.segments as usize, 0);
    (made, report)
}

fn counts(mesh: &Mesh) -> [usize; 3] {
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

fn solids() -> [Mesh; 5] {
    shape::Platonic::ALL.map(|solid| shape::platonic(solid, 10.0))
}

#[test]
fn every_pair_of_faces_of_every_platonic_solid_gets_a_handle() {
    handles_between_all_pairs(&[1, 2, 5, 20]);
}

fn handles_between_all_pairs(numbers: &[u32]) {
    for mesh in &solids() {
        let [v, e, f] = counts(mesh);
        let sides = mesh.sides(mesh.faces().next().expect("faces"));
        for from in 0..f {
            for to in (0..f).filter(|&to| to != from) {
                for &segments in numbers {
                    let wanted = params(&from.to_string(), &to.to_string(), segments);
                    let corners = |f: usize| mesh.face_vertices(FaceId::new(f));
                    if segments == 1 && corners(from).any(|v| corners(to).any(|w| v == w)) {
                        let refused =
                            handle(mesh, &wanted, &OpContext::default()).expect_err("flat");
                        assert!(matches!(refused, OpError::NoHandle { .. }));
                        continue;
                    }
                    if segments == 2 && returns_to_a_corner(mesh, &wanted) {
                        continue;
                    }
                    let (made, report) = run(mesh, &wanted);
                    let s = segments as usize;
                    // A tube of one segment may run along edges of the solid, and is kept apart.
                    let split = report.mended.split;
                    assert!(segments == 1 || split == 0, "{from} to {to}, {s} segments");
                    let expected = [
                        v + sides * (s - 1) + split,
                        e + sides * (2 * s - 1) + split,
                        f + sides * s - 2,
                    ];
                    assert_eq!(counts(&made), expected, "{from} to {to}, {s} segments");
                    assert_eq!((genus(&made), made.components().len(), report.halved), (1, 1, 0));
                    if segments == 5 {
                        let largest = 180.0 / sides as f64 + 1e-6;
                        assert!(
                            report.twist_degrees.abs() <= largest,
                            "{from} to {to}: {report:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Whether two segments would lead from a corner back to it, which no file can hold; said only of
/// faces that share a corner.
fn returns_to_a_corner(mesh: &Mesh, wanted: &HandleParams) -> bool {
    let Err(refused) = handle(mesh, wanted, &OpContext::default()) else { return false };
    let corners = |f: u32| mesh.face_vertices(FaceId::new(f as usize));
    assert!(refused.to_string().contains("at least three segments"), "{refused}");
    corners(wanted.from.face).any(|v| corners(wanted.to.face).any(|w| v == w))
        || panic!("{refused}")
}

/// Two opposite faces of a cube.
fn opposite(mesh: &Mesh) -> [String; 2] {
    let first = mesh.faces().next().expect("faces");
    let touches = |f: FaceId| mesh.face_half_edges(f).any(|h| mesh.face(h.twin()) == first);
    let second = mesh.faces().find(|&f| f != first && !touches(f)).expect("six faces");
    [first, second].map(|f| f.index().to_string())
}

#[test]
fn opposite_faces_get_a_straight_hole_or_a_loop() {
    let cube = shape::cube(10.0);
    let [from, to] = opposite(&cube);
    let mut wanted = params(&from, &to, 4);
    wanted.weights = Some("-10,-10".parse().expect("weights"));
    let (tunnel, report) = run_whatever_volume(&cube, &wanted);
    // As wide as the cube: nothing but walls without thickness is left, so the volume is zero, but
    // the links are those of a ring.
    assert_eq!((counts(&tunnel), genus(&tunnel), report.crossing.len()), ([20, 40, 20], 1, 0));
    assert!(volume(&tunnel).abs() < 1e-9);
    let (ring, report) = run(&cube, &params(&from, &to, 24));
    assert!(
        volume(&ring) > volume(&cube) && report.crossing.is_empty() == report.notes().is_empty()
    );
}

fn run_whatever_volume(mesh: &Mesh, params: &HandleParams) -> (Mesh, HandleReport) {
    let (made, report) = handle(mesh, params, &OpContext::default()).expect("a handle");
    assert!(made.faults().is_empty());
    (made, report)
}

#[test]
fn two_solids_become_one_by_a_straight_bar() {
    let mut mesh = shape::cube(2.0);
    let offset = glam::DVec3::new(0.0, 0.0, 6.0);
    let far: Vec<glam::DVec3> = mesh.vertices().map(|v| mesh.position(v) + offset).collect();
    let near: Vec<glam::DVec3> = mesh.vertices().map(|v| mesh.position(v)).collect();
    let walks: Vec<Vec<usize>> =
        mesh.faces().map(|f| mesh.face_vertices(f).map(VertexId::index).collect()).collect();
    let shifted: Vec<Vec<usize>> =
        walks.iter().map(|w| w.iter().map(|i| i + 8).collect()).collect();
    mesh = Mesh::from_faces(near.into_iter().chain(far), walks.into_iter().chain(shifted))
        .expect("two cubes");
    let up = |low: usize| {
        let look = |f: &FaceId| {
            mesh.plane(*f).expect("a plane").normal().z * if low == 0 { 1.0 } else { -1.0 } > 0.9
        };
        let of_part = |f: &FaceId| f.index() / 6 == usize::from(low != 0);
        mesh.faces().filter(of_part).find(look).expect("a face").index().to_string()
    };
    for segments in [1, 3] {
        let (bar, report) = run(&mesh, &params(&up(0), &up(8), segments));
        assert_eq!((bar.components().len(), genus(&bar), report.crossing.len()), (1, 0, 0));
        assert!((volume(&bar) - 2.0 * 2.0 * 8.0).abs() < 1e-10, "{}", volume(&bar));
        assert!(report.twist_degrees.abs() < 1e-6);
    }
    // A quarter turn more, chosen by angle or by corners.
    let mut wanted = params(&up(0), &up(8), 8);
    wanted.twist = Angle::from_degrees(90.0);
    let (_, report) = run(&mesh, &wanted);
    assert!((report.twist_degrees - 90.0).abs() < 1e-6);
    wanted.twist = Angle::from_degrees(360.0);
    assert!((run(&mesh, &wanted).1.twist_degrees - 360.0).abs() < 1e-6);
}

#[test]
fn faces_with_different_numbers_of_sides_are_evened_out() {
    let prism = shape::prism(5, 10.0);
    let pentagon = prism.faces().find(|&f| prism.sides(f) == 5).expect("an end").index();
    let square = prism.faces().find(|&f| prism.sides(f) == 4).expect("a side").index();
    for (from, to) in [(pentagon, square), (square, pentagon)] {
        let two = params(&from.to_string(), &to.to_string(), 2);
        assert!(returns_to_a_corner(&prism, &two));
        for segments in [3, 7] {
            let (made, report) = run(&prism, &params(&from.to_string(), &to.to_string(), segments));
            assert_eq!((report.halved, genus(&made)), (1, 1));
            let s = segments as usize;
            assert_eq!(counts(&made), [11 + 5 * (s - 1), 16 + 5 * (2 * s - 1), 7 + 5 * s - 2]);
        }
    }
}

#[test]
fn a_bend_sharper_than_its_width_is_told_with_its_segment() {
    let cube = shape::cube(10.0);
    let mut wanted = params("0", "0", 12);
    let beside = cube
        .face_half_edges(FaceId::new(0))
        .map(|h| cube.face(h.twin()))
        .next()
        .expect("neighbours");
    wanted.to = beside.index().to_string().parse().expect("a face");
    wanted.weights = Some("1,1".parse().expect("weights"));
    let (_, report) = run_whatever_volume(&cube, &wanted);
    assert!(
        !report.crossing.is_empty() && report.crossing.iter().all(|k| (1..=12).contains(k)),
        "{report:?}"
    );
    assert!(report.notes()[0].contains("segment"));
    wanted.weights = Some("200,200".parse().expect("weights"));
    assert!(run(&cube, &wanted).1.crossing.is_empty());
}

#[test]
fn scaled_input_gives_the_scaled_handle() {
    let (small, large) = (shape::dodecahedron(1e-3), shape::dodecahedron(1e4));
    let [a, b] = [&small, &large].map(|mesh| run(mesh, &params("0", "3", 6)).0);
    let sizes: Vec<f64> =
        a.vertices().map(|v| a.position(v).distance(b.position(v) / 1e7)).collect();
    assert!(sizes.iter().all(|&d| d < 1e-12), "{:?}", sizes.iter().copied().fold(0.0, f64::max));
}

#[test]
fn what_cannot_be_is_refused_with_the_reason() {
    let cube = shape::cube(10.0);
    let refuse = |p: HandleParams| handle(&cube, &p, &OpContext::default()).expect_err("refused");
    assert!(matches!(refuse(params("0", "9", 5)), OpError::NoSuchElement { what: "face", id: 9 }));
    assert!(matches!(refuse(params("0:77", "1", 5)), OpError::NoSuchElement { id: 77, .. }));
    assert!(matches!(refuse(params("0", "1", 0)), OpError::CountOutOfRange { .. }));
    assert!(matches!(refuse(params("2", "2", 5)), OpError::NoHandle { .. }));
    let mut wanted = params("0", "1", 5);
    wanted.weights = Some("-10,10".parse().expect("weights"));
    assert!(matches!(refuse(wanted), OpError::NoHandle { .. }));
    assert!("1:x".parse::<FaceCorner>().is_err() && "1".parse::<Weights>().is_err());
}

#[test]
fn default_weights_grow_until_nothing_crosses() {
    let cube = shape::cube(10.0);
    let beside = cube
        .face_half_edges(FaceId::new(0))
        .map(|h| cube.face(h.twin()))
        .next()
        .expect("neighbours");
    let mut wanted = params("0", &beside.index().to_string(), 12);
    let (_, report) = run(&cube, &wanted);
    assert!(report.crossing.is_empty(), "{report:?}");
    let mm = report.lengthened.expect("the distance of the centroids is too little");
    assert!(report.notes()[0].contains("weights of"));
    // Half as much crosses.
    wanted.weights = Some(format!("{},{}", mm / 2.0, mm / 2.0).parse().expect("weights"));
    assert!(!run_whatever_volume(&cube, &wanted).1.crossing.is_empty());
}

#[test]
fn an_axis_is_followed_in_segments_of_one_length() {
    let cube = shape::cube(10.0);
    let mut wanted = params("0", "0", 40);
    let [from, to] = opposite(&cube);
    (wanted.from, wanted.to) = (from.parse().expect("a face"), to.parse().expect("a face"));
    let [a, b] = [wanted.from, wanted.to].map(|f| FaceId::new(f.face as usize));
    let n = cube.plane(a).expect("a plane").normal();
    let (start, end) =
        (crate::measure::face_centroid(&cube, a), crate::measure::face_centroid(&cube, b));
    let side = n.any_orthonormal_vector() * 40.0;
    let through =
        [start + n * 20.0, start + n * 30.0 + side, end - n * 30.0 + side, end - n * 20.0];
    wanted.axis = Some(HandleAxis::Points(through.to_vec()));
    let (ring, report) = run(&cube, &wanted);
    assert_eq!((genus(&ring), report.crossing.len()), (1, 0));
    // Centroids of the sections: near every point given, and equally far from each other.
    let sections: Vec<glam::DVec3> = (0..39)
        .map(|k| {
            (0..4).map(|i| ring.position(VertexId::new(8 + 4 * k + i))).sum::<glam::DVec3>() / 4.0
        })
        .collect();
    let steps: Vec<f64> = sections.windows(2).map(|w| w[0].distance(w[1])).collect();
    let (least, most) =
        steps.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &s| (a.min(s), b.max(s)));
    assert!(most < 1.05 * least, "{least} to {most}");
    for p in through {
        assert!(sections.iter().any(|s| s.distance(p) < most), "{p} is not passed");
    }
    // The centroids may be given as well, and a straight way inwards is a tunnel.
    let also_ends: Vec<glam::DVec3> = [start].into_iter().chain(through).chain([end]).collect();
    wanted.axis = Some(HandleAxis::Points(also_ends));
    let (again, _) = run(&cube, &wanted);
    assert!(again.vertices().all(|v| again.position(v) == ring.position(v)));
    wanted.axis = Some(HandleAxis::Points(vec![start.midpoint(end)]));
    let (tunnel, _) = run_whatever_volume(&cube, &wanted);
    assert!(volume(&tunnel).abs() < 1e-9);
    wanted.weights = Some("1,1".parse().expect("weights"));
    let refuse = |p: &HandleParams| handle(&cube, p, &OpContext::default()).expect_err("refused");
    assert!(matches!(refuse(&wanted), OpError::Exclude { .. }));
    wanted.weights = None;
    wanted.also = vec!["2".parse().expect("a face")];
    assert!(matches!(refuse(&wanted), OpError::Exclude { .. }));
    wanted.axis = Some(HandleAxis::File("axis.txt".into()));
    wanted.also.clear();
    assert!(matches!(refuse(&wanted), OpError::NoHandle { .. }));
}

/// All faces of a mesh, as those to be joined.
fn among(faces: &[usize], segments: u32) -> HandleParams {
    let mut wanted = params(&faces[0].to_string(), &faces[1].to_string(), segments);
    wanted.also = faces[2..].iter().map(|f| f.to_string().parse().expect("a face")).collect();
    wanted
}

#[test]
fn k_faces_are_joined_by_a_hub_and_add_k_minus_one_to_the_genus() {
    for mesh in &solids() {
        let f = mesh.face_count();
        let v = mesh.vertices().next().expect("vertices");
        let around: Vec<usize> = mesh.vertex_faces(v).map(FaceId::index).collect();
        let all: Vec<usize> = (0..f).collect();
        for (faces, is_inside) in [(around, false), (all, true)] {
            for segments in [1, 6] {
                let wanted = among(&faces, segments);
                let (made, report) = handle(mesh, &wanted, &OpContext::default())
                    .unwrap_or_else(|e| panic!("{f} faces, {faces:?}: {e}"));
                assert!(made.faults().is_empty(), "{:?}", made.faults().first());
                assert_eq!(
                    (genus(&made), made.components().len()),
                    (faces.len() - 1, 1),
                    "{f} faces, {faces:?}"
                );
                assert_eq!(volume(&made) < volume(mesh), is_inside, "{report:?}");
                assert!(volume(&made) > 0.0 && made.is_closed());
                assert_eq!(made.face_count(), f - faces.len() + report.made.faces.len());
            }
        }
    }
}

#[test]
fn a_hub_that_cannot_be_is_refused_with_the_reason() {
    let cube = shape::cube(10.0);
    let refuse = |p: &HandleParams| handle(&cube, p, &OpContext::default()).expect_err("refused");
    assert!(refuse(&among(&[0, 1, 1], 4)).to_string().contains("twice"));
    assert!(matches!(refuse(&among(&[0, 1, 9], 4)), OpError::NoSuchElement { id: 9, .. }));
    // Two opposite faces and one beside them see no place outside in common.
    let [a, b] = opposite(&cube).map(|f| f.parse::<usize>().expect("a number"));
    let beside = (0..6).find(|f| *f != a && *f != b).expect("six faces");
    assert!(matches!(refuse(&among(&[a, b, beside], 4)), OpError::NoHandle { .. }));
}

#[test]
fn every_pair_gets_a_handle_with_every_number_of_segments_from_1_to_20() {
    let all: Vec<u32> = (1..=20).collect();
    handles_between_all_pairs(&all);
}
