//! Hulls of meshes.

use glam::DVec3;

use super::*;
use crate::geom::predicate::orient3d;
use crate::measure::volume;
use crate::mesh::assert_sound;
use crate::shape::{SolidParams, random_tangent_polytope, solid};

fn named(name: &str) -> Mesh {
    solid(&SolidParams { name: name.parse().expect(name), ..SolidParams::default() }).expect(name)
}

fn counts(mesh: &Mesh) -> [usize; 3] {
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

fn dual() -> HullParams {
    HullParams { dual: true, ..HullParams::default() }
}

#[track_caller]
fn make(mesh: &Mesh, params: &HullParams) -> (Mesh, HullReport) {
    let (result, report) = hull(mesh, params, &OpContext::default()).expect("a hull");
    assert_sound(&result);
    assert!(result.is_closed());
    (result, report)
}

fn size(mesh: &Mesh) -> f64 {
    let (low, high) = mesh.bounds().expect("vertices");
    (high - low).length()
}

/// Faces lie in their planes, and no point lies beyond one.
#[track_caller]
fn assert_convex_around(mesh: &Mesh, points: &Mesh) {
    let tolerance =
        1e-13 * size(mesh) + 8.0 * f64::EPSILON * mesh.position(VertexId::new(0)).length();
    for f in mesh.faces() {
        let plane = mesh.plane(f).expect("an area");
        assert!(
            mesh.face_positions(f).iter().all(|&p| plane.signed_distance(p).abs() <= tolerance),
            "{f:?} is not flat"
        );
        let most = points
            .vertices()
            .map(|v| plane.signed_distance(points.position(v)))
            .fold(f64::MIN, f64::max);
        assert!(most <= tolerance, "{f:?}: a point is {most:e} outside");
    }
}

#[test]
fn hulls_of_convex_solids_are_the_solids() {
    for name in ["tetrahedron", "box-1x2x3", "octahedron", "prism-7", "geodesic-3"] {
        let mesh = named(name);
        let (result, _) = make(&mesh, &HullParams::default());
        assert_eq!(counts(&result), counts(&mesh), "{name}");
        assert!((volume(&result) / volume(&mesh) - 1.0).abs() < 1e-12);
        assert_convex_around(&result, &mesh);
    }
    let (result, report) = make(&named("box-60x40x20"), &HullParams::default());
    assert_eq!(counts(&result), [8, 12, 6]);
    assert!(result.vertices().all(|v| result.is_given(v)));
    assert_eq!((report.parts[0].points, report.parts[0].faces), (8, 6));
}

#[test]
fn dual_hulls_without_box_are_the_dual_solids() {
    // Rounded coordinates, yet the planes that meet by symmetry meet in one vertex.
    for (name, expected) in [
        ("cube", [6, 12, 8]),
        ("octahedron", [8, 12, 6]),
        ("icosahedron", [20, 30, 12]),
        ("dodecahedron", [12, 30, 20]),
        ("cuboctahedron", [14, 24, 12]),
        ("icosidodecahedron", [32, 60, 30]),
        ("truncated-icosahedron", [32, 90, 60]),
    ] {
        let mesh = named(name);
        let (result, report) = make(&mesh, &HullParams { no_box: true, ..dual() });
        assert_eq!(counts(&result), expected, "{name}");
        assert_convex_around(&result, &mesh);
        assert_eq!(report.parts[0].without_face, Vec::<usize>::new());
        let (simple, _) = make(&mesh, &HullParams { no_box: true, simple: true, ..dual() });
        let n = expected[2];
        assert_eq!(counts(&simple), [2 * n - 4, 3 * n - 6, n], "{name}");
        assert!(simple.vertices().all(|v| simple.valence(v) == 3));
    }
}

#[test]
fn the_box_cuts_a_dual_hull_and_touching_planes_vanish() {
    // The cube is its own bounding box; the planes through its corners touch it there and
    // contribute nothing.
    let (result, report) = make(&named("cube"), &dual());
    assert_eq!(counts(&result), [8, 12, 6]);
    assert_eq!(report.parts[0].without_face, (0..8).collect::<Vec<_>>());
    // The box of an octahedron touches it at its corners, and so do the planes through them: they
    // are the same cube.
    let (result, _) = make(&named("octahedron"), &dual());
    assert_eq!(counts(&result), [8, 12, 6]);
    for name in ["icosahedron", "dodecahedron", "snub-cube", "prism-5"] {
        let mesh = named(name);
        let (result, _) = make(&mesh, &dual());
        assert_convex_around(&result, &mesh);
        let (result, _) = make(&mesh, &HullParams { simple: true, ..dual() });
        let n = result.face_count();
        assert_eq!(counts(&result), [2 * n - 4, 3 * n - 6, n], "{name}");
    }
}

#[test]
fn planes_in_general_position_give_the_simple_counts_anywhere() {
    // A sphere of triangles, each vertex moved a little outwards by an amount of its own.
    let mut mesh = named("geodesic-4");
    for (i, v) in mesh.vertices().collect::<Vec<_>>().into_iter().enumerate() {
        mesh.set_position(v, mesh.position(v) * (1.0 + 1e-3 * (1.7 * (i * i) as f64).sin()), true);
    }
    for (scale, shift) in [(1.0, 0.0), (1e-3, 1e3), (1e3, 0.0), (1.0, 1e6)] {
        let mut moved = mesh.clone();
        for v in mesh.vertices() {
            moved.set_position(v, mesh.position(v) * scale + DVec3::splat(shift), true);
        }
        let (result, report) = make(&moved, &HullParams { no_box: true, ..dual() });
        let n = 162;
        assert_eq!(counts(&result), [2 * n - 4, 3 * n - 6, n], "{scale} {shift}");
        assert!(report.not_three_valent.is_empty());
        assert_convex_around(&result, &moved);
    }
    let (with_box, _) = make(&mesh, &dual());
    assert_convex_around(&with_box, &mesh);
}

#[test]
fn planes_around_a_quadrilateral_of_tangent_planes_meet_in_one_vertex() {
    // With tangent planes n·x = 1 the plane through the corner of f, a, b is (f + a + b)·x = 3, so
    // four around a quadrilateral f depend on each other. Where f has another number of sides they
    // do not.
    let mesh = random_tangent_polytope(200, 3);
    let quadrilaterals = mesh.faces().filter(|&f| mesh.sides(f) == 4).count();
    let (result, report) = make(&mesh, &HullParams { no_box: true, ..dual() });
    assert!(quadrilaterals > 20);
    assert_eq!(report.not_three_valent.len(), quadrilaterals);
    assert_eq!(result.face_count(), 396);
    assert_convex_around(&result, &mesh);
}

#[test]
fn steps_begin_with_the_box_and_end_with_the_result() {
    let mesh = random_tangent_polytope(30, 8);
    let params = HullParams { steps: Some("0,1,20,all".parse().expect("steps")), ..dual() };
    let (result, report) = make(&mesh, &params);
    let steps: Vec<(usize, usize)> =
        report.steps.iter().map(|s| (s.planes, s.mesh.face_count())).collect();
    assert_eq!((steps[0], steps[1].0, steps[2].0, steps[3].0), ((0, 6), 1, 20, 56));
    assert_eq!(steps[1].1, 7);
    let volumes: Vec<f64> = report.steps.iter().map(|s| volume(&s.mesh)).collect();
    assert!(volumes.windows(2).all(|w| w[0] > w[1]));
    assert_eq!(report.steps[3].mesh.bounds(), result.bounds());
}

/// Two boxes, one above the other, as one mesh of two components and two groups.
fn two_boxes() -> Mesh {
    let mut builder = crate::mesh::MeshBuilder::new();
    for y in [0.0, 10.0] {
        let first = builder.vertex(DVec3::new(0.0, y, 0.0));
        for i in 1..8 {
            builder.vertex(DVec3::new(
                f64::from(i & 1),
                y + f64::from(i >> 1 & 1),
                f64::from(i >> 2),
            ));
        }
        for run in
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        {
            builder.face(run.map(|i| first + i));
        }
    }
    let (mut mesh, _) = builder.build().expect("two boxes");
    for f in mesh.faces().collect::<Vec<_>>() {
        mesh.set_group(f, if f.index() < 6 { "low" } else { "high" });
    }
    mesh
}

#[test]
fn clusters_and_groups_make_a_component_each() {
    let mesh = two_boxes();
    let (one, _) = make(&mesh, &HullParams::default());
    assert_eq!((counts(&one), one.components().len()), ([8, 12, 6], 1));
    for dual in [false, true] {
        let slabs = HullParams { clusters: Some(3), axis: Axis::Y, dual, ..HullParams::default() };
        let (result, report) = make(&mesh, &slabs);
        assert_eq!(
            (counts(&result), result.components().len(), report.empty_clusters),
            ([16, 24, 12], 2, 1)
        );
        assert_eq!(result.groups(), ["slab-1", "slab-3"]);
        let (result, _) =
            make(&mesh, &HullParams { by_group: true, dual, ..HullParams::default() });
        assert_eq!(
            (counts(&result), result.groups()),
            ([16, 24, 12], &["low".to_owned(), "high".to_owned()][..])
        );
    }
    let flat = HullParams { clusters: Some(22), axis: Axis::Y, ..HullParams::default() };
    let error =
        hull(&mesh, &flat, &OpContext::default()).expect_err("one layer of points has no hull");
    assert!(error.to_string().starts_with("slab-1: all 4 points lie in one plane"), "{error}");
}

#[test]
fn an_l_shape_falls_into_convex_parts_that_hold_all_its_points() {
    let base = [(0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (10.0, 10.0), (10.0, 30.0), (0.0, 30.0)];
    let at = |z: f64| base.iter().map(move |&(x, y)| DVec3::new(x, y, z));
    let sides = (0..6).map(|i| vec![i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i]);
    let tops = [[0, 1, 2, 3], [0, 3, 4, 5]];
    let faces = sides
        .chain(tops.iter().map(|t| t.iter().rev().copied().collect()))
        .chain(tops.iter().map(|t| t.iter().map(|i| i + 6).collect()));
    let mesh = Mesh::from_faces(at(0.0).chain(at(10.0)), faces.collect::<Vec<_>>()).expect("an L");
    let (whole, _) = make(&mesh, &HullParams::default());
    let (parts, report) = make(&mesh, &HullParams { parts: Some(4), ..HullParams::default() });
    assert!((2..=4).contains(&report.parts.len()), "{:?}", report.parts);
    assert!(volume(&parts) < 0.9 * volume(&whole));
    for v in mesh.vertices() {
        let p = mesh.position(v);
        let holds = |faces: &[crate::mesh::FaceId]| {
            faces.iter().all(|&f| {
                let c = parts.face_positions(f);
                orient3d(c[0], c[1], c[2], p) >= -1e-9 * volume(&mesh)
            })
        };
        assert!(parts.components().iter().any(|c| holds(&c.faces)), "{p} is in no part");
    }
    let (again, _) = make(&mesh, &HullParams { parts: Some(4), ..HullParams::default() });
    assert_eq!(counts(&again), counts(&parts));
}

#[test]
fn half_spaces_become_a_mesh_with_their_planes() {
    let space = |x: f64, y: f64, z: f64, offset| HalfSpace { normal: DVec3::new(x, y, z), offset };
    let context = OpContext::default();
    // A square pyramid with a repeated base and a plane that only touches its top.
    let planes = [
        space(0.0, 0.0, -1.0, 0.0),
        space(1.0, 0.0, 1.0, 4.0),
        space(-1.0, 0.0, 1.0, 4.0),
        space(0.0, 0.0, -2.0, 0.0),
        space(0.0, 1.0, 1.0, 4.0),
        space(0.0, -1.0, 1.0, 4.0),
        space(0.0, 0.0, 1.0, 4.0),
    ];
    let (mesh, report) =
        halfspaces(&planes, &HullParams::default(), &OpContext::default()).expect("a pyramid");
    assert_sound(&mesh);
    assert_eq!(counts(&mesh), [5, 8, 5]);
    assert_eq!(report.parts[0].without_face, [3, 6]);
    assert_eq!(report.not_three_valent.len(), 1);
    assert!((volume(&mesh) - 64.0 * 4.0 / 3.0).abs() < 1e-12);
    let plane = mesh.carried_plane(crate::mesh::FaceId::new(1)).expect("carried");
    assert!((plane.normal() - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-15);
    let (simple, report) =
        halfspaces(&planes, &HullParams { simple: true, ..HullParams::default() }, &context)
            .expect("a pyramid");
    assert_eq!(report.parts[0].moved, 4);
    assert_sound(&simple);
    assert_eq!((counts(&simple), report.not_three_valent.len()), ([6, 9, 5], 0));
    let error =
        halfspaces(&planes[1..3], &HullParams::default(), &OpContext::default()).expect_err("open");
    assert!(error.to_string().contains("open"), "{error}");
}

#[test]
fn bad_parameters_are_refused() {
    let mesh = named("cube");
    let refuse =
        |params: HullParams| hull(&mesh, &params, &OpContext::default()).expect_err("refused");
    let default = HullParams::default;
    assert_eq!(
        refuse(HullParams { clusters: Some(0), ..default() }),
        OpError::CountOutOfRange { what: "clusters", count: 0, limit: 10_000 }
    );
    assert!(matches!(
        refuse(HullParams { clusters: Some(2), by_group: true, ..default() }),
        OpError::Exclude { .. }
    ));
    assert!(matches!(
        refuse(HullParams { concavity: f64::NAN, ..default() }),
        OpError::ConcavityOutOfRange { .. }
    ));
    assert!(matches!(refuse(HullParams { no_box: true, ..default() }), OpError::Requires { .. }));
    let steps = Some(HullStepList(vec![HullStepChoice::All]));
    assert!(matches!(
        refuse(HullParams { no_box: true, steps, ..dual() }),
        OpError::Exclude { .. }
    ));
}

#[test]
fn flags_and_recipes_agree() {
    use clap::{Args, FromArgMatches};
    let flags = |words: &[&str]| {
        let command = HullParams::augment_args(clap::Command::new("hull"));
        let matches = command.try_get_matches_from([&["hull"], words].concat()).expect("flags");
        HullParams::from_arg_matches(&matches).expect("the arguments fit")
    };
    let recipe = |text: &str| toml::from_str::<HullParams>(text).expect(text);
    assert_eq!(flags(&[]), HullParams::default());
    assert_eq!(recipe(""), HullParams::default());
    let typed =
        flags(&["--dual", "--simple", "--clusters", "8", "--axis", "z", "--steps", "1,20,all"]);
    assert_eq!(
        typed,
        recipe("dual = true\nsimple = true\nclusters = 8\naxis = \"z\"\nsteps = [1, 20, \"all\"]")
    );
    assert_eq!(
        typed,
        recipe("dual = true\nsimple = true\nclusters = 8\naxis = \"z\"\nsteps = \"1,20,all\"")
    );
    assert_eq!(
        flags(&["--parts", "4", "--concavity", "1/20"]),
        recipe("parts = 4\nconcavity = 0.05")
    );
}
