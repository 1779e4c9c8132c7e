use glam::DVec3;

use super::*;
use crate::measure::{convexity, face_diameter, fold_angle, planarity, volume};
use crate::mesh::MeshBuilder;
use crate::op::{CutReport, Place, TruncateEdgeParams, truncate_edges};
use crate::shape::{SolidParams, cube, solid};
use crate::units::{Angle, Length};

fn named(name: &str) -> Mesh {
    let name = name.parse().expect("a name");
    solid(&SolidParams { name, edge: None, size: Some(Length::from_mm(180.0)) }).expect("a solid")
}

fn params(select: &str, roll: &str) -> TruncateEdgeParams {
    let roll = roll.parse().expect("a roll");
    TruncateEdgeParams::rolled(select.parse().expect("a selection"), roll)
}

/// As [`params`], with so many strips, or of so large a size at most.
fn in_strips(
    select: &str,
    roll: &str,
    strips: Option<u32>,
    strip: Option<StripSize>,
) -> TruncateEdgeParams {
    let params = params(select, roll);
    let rolling = RollOptions { strips, strip, ..params.rolling };
    TruncateEdgeParams { rolling, ..params }
}

fn rolled(mesh: &Mesh, params: &TruncateEdgeParams) -> Result<(Mesh, CutReport), OpError> {
    truncate_edges(mesh, params, &OpContext::default())
}

fn refused(mesh: &Mesh, params: &TruncateEdgeParams) -> RollError {
    match rolled(mesh, params) {
        Err(OpError::Roll(error)) => error,
        other => panic!("{:?}", other.map(|made| made.1)),
    }
}

/// An L of six by six, two thick, four high, the reflex edge upright.
fn angle_bar() -> Mesh {
    let outline = [[0.0, 0.0], [6.0, 0.0], [6.0, 2.0], [2.0, 2.0], [2.0, 6.0], [0.0, 6.0]];
    let mut builder = MeshBuilder::new();
    for z in [0.0, 4.0] {
        for [x, y] in outline {
            builder.vertex(DVec3::new(x, y, z));
        }
    }
    builder.face((0..6).rev());
    builder.face(6..12);
    for i in 0..6 {
        let j = (i + 1) % 6;
        builder.face([i, j, j + 6, i + 6]);
    }
    builder.build().expect("a mesh").0
}

fn edge_at(mesh: &Mesh, middle: [f64; 3]) -> EdgeId {
    let middle = DVec3::from(middle);
    let is_there = |e: &EdgeId| {
        let [a, b] = mesh.edge_positions(*e);
        a.midpoint(b).distance(middle) < 1e-9
    };
    mesh.edges().find(is_there).expect("an edge")
}

/// Counts, convexity and planarity of every 3-valent solid that has a name, at the largest radius
/// and at a small one, for both kinds of largest.
#[test]
fn folds_of_every_3_valent_solid_are_rolled() {
    let uniform = ["tetrahedron", "cube", "dodecahedron", "truncated-tetrahedron", "soccer-ball"];
    let prisms = [3, 5, 8, 20].map(|n| format!("prism-{n}"));
    for name in uniform.map(str::to_owned).into_iter().chain(prisms) {
        let solid = named(&name);
        for roll in ["max", "each", "0.5mm"] {
            let params = in_strips("matching", roll, Some(4), None);
            let (mesh, report) =
                rolled(&solid, &params).unwrap_or_else(|e| panic!("{name} {roll}: {e}"));
            let k = 4 * report.rolled.len();
            let counts = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
            let expected =
                [solid.vertex_count() + 2 * k, solid.edge_count() + 3 * k, solid.face_count() + k];
            assert_eq!(counts, expected, "{name} {roll}");
            assert_eq!(report.made.strip.len(), 5 * report.rolled.len(), "{name} {roll}");
            assert!(report.not_three_valent.is_empty() && report.missed == 0, "{name} {roll}");
            assert!(convexity(&mesh).is_convex(), "{name} {roll}");
            let planar = |f| planarity(&mesh, f).mm < 1e-9 * face_diameter(&mesh, f);
            assert!(mesh.faces().all(planar), "{name} {roll}");
        }
    }
}

/// Solids without any symmetry, whose ends lean in all ways: the same, and cones on top.
#[test]
fn folds_of_random_solids_are_rolled() {
    for seed in 0..8 {
        let solid = crate::shape::random_tangent_polytope(6 + 2 * seed as usize, seed);
        for roll in ["max", "each"] {
            let (mesh, report) = rolled(&solid, &params("matching", roll))
                .unwrap_or_else(|e| panic!("{seed} {roll}: {e}"));
            assert!(report.not_three_valent.is_empty(), "{seed} {roll}");
            assert!(convexity(&mesh).is_convex(), "{seed} {roll}");
            assert!(report.roll_limit.is_some_and(|limit| !limit.edges.is_empty()));
        }
        let edges = params("matching", "max").select.edges(&OpContext::default().select(&solid));
        let largest = largest_roll(&solid, &edges.expect("folds")).expect("a radius").radius;
        // A cone may take more of an edge than a cylinder; then what the error names must fit.
        let cone = |wide: f64| params("matching", &format!("{wide}mm,{}mm", wide / 3.0));
        let first = rolled(&solid, &cone(largest * 0.9));
        let (mesh, report) = match first {
            Err(OpError::Roll(RollError::TooLarge { largest, .. })) => {
                rolled(&solid, &cone(largest)).unwrap_or_else(|e| panic!("{seed}: {e}"))
            }
            first => first.unwrap_or_else(|e| panic!("{seed}: {e}")),
        };
        assert!(report.not_three_valent.is_empty() && convexity(&mesh).is_convex(), "{seed}");
    }
}

/// Every strip is at the distance r from the axis, and as wide as the formula says.
#[test]
fn strips_touch_one_cylinder_and_one_cone() {
    let cube = cube(100.0);
    let edge = cube.edges().find(|&e| {
        let [a, b] = cube.edge_positions(e);
        (a - b).abs().z > 1.0 && a.x > 0.0 && a.y > 0.0
    });
    let edge = edge.expect("an upright edge");
    let select = edge.to_string();
    let (mesh, report) = rolled(&cube, &params(&select, "30mm")).expect("a roll");
    let [a, _] = cube.edge_positions(edge);
    let axis = DVec3::new(a.x - 30.0, a.y - 30.0, 0.0);
    for &f in &report.made.faces {
        let plane = Plane::newell(&mesh.face_positions(f)).expect("a plane");
        assert!((plane.signed_distance(axis) + 30.0).abs() < 1e-12 * 100.0);
        assert!(plane.normal().z.abs() < 1e-15);
    }
    let width = 60.0 * (std::f64::consts::PI / 40.0).tan();
    assert!((report.rolled[0].width - width).abs() < 1e-12);
    assert!((report.rolled[0].touch[0] - 30.0).abs() < 1e-12);
    assert!((report.rolled[0].fold_deg - 9.0).abs() < 1e-12);

    // The planes of a cone meet in one point of the edge's line, where its radius would be 0.
    let (mesh, report) = rolled(&cube, &params(&select, "30mm,10mm")).expect("a cone");
    let [low, high] = {
        let [v, w] = cube.edge_vertices(edge);
        [v.min(w), v.max(w)].map(|v| cube.position(v))
    };
    let apex = low + (high - low) * 1.5;
    let mut angles = Vec::new();
    for &f in &report.made.faces {
        let plane = Plane::newell(&mesh.face_positions(f)).expect("a plane");
        assert!(plane.signed_distance(apex).abs() < 1e-11, "{}", plane.signed_distance(apex));
    }
    for &e in &report.made.strip {
        angles.push(fold_angle(&mesh, e).expect("a fold"));
    }
    assert!(angles.iter().all(|angle| (angle - angles[0]).abs() < 1e-12 && *angle > 0.1));
}

#[test]
fn the_largest_radius_is_that_of_the_lengths() {
    let cube = cube(100.0);
    let largest = |edges: &[usize]| {
        let edges: Vec<EdgeId> = edges.iter().map(|&e| EdgeId::new(e)).collect();
        largest_roll(&cube, &edges).expect("a radius").radius
    };
    // Alone an edge has the whole of its neighbours, two that share a neighbour half of it each.
    assert!((largest(&[0]) - 87.5).abs() < 1e-9);
    let parallel: Vec<usize> = cube
        .edges()
        .filter(|&e| {
            let [a, b] = cube.edge_positions(e);
            (a - b).abs().x > 1.0
        })
        .map(EdgeId::index)
        .collect();
    assert!((largest(&parallel) - 43.75).abs() < 1e-9);
    // A radius that is refused names one that is not.
    let select = "along=x";
    let RollError::TooLarge { largest, edges, .. } = refused(&cube, &params(select, "51mm")) else {
        panic!("another error")
    };
    assert_eq!((largest, edges.len()), (50.0, 2));
    assert!(rolled(&cube, &params(select, "50mm")).is_ok());
    let RollError::TooLarge { largest, .. } = refused(&cube, &params(select, "80mm,40mm")) else {
        panic!("another error")
    };
    let fits = format!("{largest}mm,{}mm", largest / 2.0);
    assert!(rolled(&cube, &params(select, &fits)).is_ok(), "{fits}");
    let over = format!("{}mm,{}mm", largest + 0.02, (largest + 0.02) / 2.0);
    assert!(rolled(&cube, &params(select, &over)).is_err(), "{over}");
}

/// Two edges share narrow sides, a third has sides of its own: `each` rolls it twice as far.
#[test]
fn each_edge_can_have_its_own_radius() {
    let mut bar = cube(100.0);
    let all: Vec<VertexId> = bar.vertices().collect();
    for v in all {
        let at = bar.position(v) * DVec3::new(1.0, 0.4, 1.0);
        bar.set_position(v, at, true);
    }
    bar.clear_planes();
    let edges = [[0.0, -20.0, 50.0], [0.0, 20.0, 50.0], [0.0, -20.0, -50.0]];
    let select: Vec<String> = edges.map(|at| edge_at(&bar, at).to_string()).to_vec();
    let radii = |roll: &str| {
        let (_, report) = rolled(&bar, &params(&select.join(","), roll)).expect("a roll");
        let mut radii: Vec<f64> = report.rolled.iter().map(|r| r.radii[0]).collect();
        radii.sort_by(f64::total_cmp);
        radii
    };
    let near = |found: Vec<f64>, expected: [f64; 3]| {
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-9), "{found:?}");
    };
    near(radii("max"), [17.5, 17.5, 17.5]);
    near(radii("each"), [17.5, 17.5, 35.0]);
}

#[test]
fn strips_are_counted_by_width_and_by_angle() {
    let cube = cube(100.0);
    let strips = |strip: StripSize| {
        let params = in_strips("0", "30mm", None, Some(strip));
        let (_, report) = rolled(&cube, &params).expect("a roll");
        (report.rolled[0].strips, report.rolled[0].width, report.rolled[0].fold_deg)
    };
    let (count, width, _) = strips("6mm".parse().expect("a width"));
    assert!(width <= 6.0 && 60.0 * (0.25 * std::f64::consts::PI / f64::from(count)).tan() > 6.0);
    let (count, _, fold) = strips(StripSize::Angle(Angle::from_degrees(10.0)));
    assert_eq!((count, fold), (8, 10.0));
    assert_eq!(strips("100deg".parse().expect("an angle")).0, 1);
}

#[test]
fn what_cannot_be_rolled_is_named_before_anything_is_cut() {
    let cube = cube(100.0);
    assert!(matches!(refused(&cube, &params("all", "1mm")), RollError::EdgesMeet { .. }));
    assert!(matches!(refused(&cube, &params("0", "0mm")), RollError::BadRadius { .. }));
    assert!(matches!(refused(&cube, &params("0", "3mm,-1mm")), RollError::BadRadius { .. }));
    for params in [
        in_strips("0", "1mm", Some(0), None),
        in_strips("0", "1mm", Some(1001), None),
        in_strips("0", "1mm", None, Some("0mm".parse().expect("a width"))),
        in_strips("0", "30mm", None, Some("0.001mm".parse().expect("a width"))),
    ] {
        assert!(matches!(refused(&cube, &params), RollError::BadStrips { .. }), "{params:?}");
    }
    for params in [
        TruncateEdgeParams { offset: Some(0.2), ..params("0", "1mm") },
        TruncateEdgeParams { bend: 0.1, ..params("0", "1mm") },
        TruncateEdgeParams { repeat: 2, ..params("0", "1mm") },
        TruncateEdgeParams { disjoint: crate::op::Disjoint::Yes, ..params("0", "1mm") },
    ] {
        let refused = rolled(&cube, &params);
        assert!(matches!(refused, Err(OpError::Exclude { first: "roll", .. })), "{params:?}");
    }
    let rolling = RollOptions { strips: Some(3), ..RollOptions::default() };
    let alone = TruncateEdgeParams { rolling, ..params("0", "1mm") };
    assert!(matches!(rolled(&cube, &alone), Err(OpError::Requires { what: "strips", .. })));
}

/// The convex edges of an L that end at convex corners; the others are refused by name.
#[test]
fn a_solid_that_is_not_convex_is_rolled_where_its_edges_are() {
    let bar = angle_bar();
    let [outer, reflex, inner] =
        [[0.0, 0.0, 2.0], [2.0, 2.0, 2.0], [4.0, 2.0, 4.0]].map(|middle| edge_at(&bar, middle));
    let with = |e: EdgeId, roll: &str| params(&e.to_string(), roll);
    assert!(matches!(
        refused(&bar, &with(reflex, "1mm")),
        RollError::NotConvex { why: "concave", .. }
    ));
    let RollError::EndNotConvex { edge, other, .. } = refused(&bar, &with(inner, "1mm")) else {
        panic!("another error")
    };
    assert_eq!((edge, other), (inner, reflex));
    // Across the corner behind the outer edge lies the reflex corner of the faces that it ends on: the
    // triangle that is cut off may not reach it.
    let limit = largest_roll(&bar, &[outer]).expect("a radius");
    assert!(matches!(limit.place, Place::Face(_)), "{limit:?}");
    assert!((limit.radius - 0.875 * 4.0).abs() < 1e-9, "{limit:?}");
    let (mesh, report) = rolled(&bar, &with(outer, "max")).expect("a roll");
    assert!(report.not_three_valent.is_empty() && volume(&mesh) < volume(&bar));
    assert_eq!(mesh.face_count(), 8 + 9);
}

/// An edge between corners with four edges: all strips come, and the result is convex.
#[test]
fn ends_with_more_than_three_edges_keep_their_strips() {
    let solid = named("octahedron");
    let (mesh, report) = rolled(&solid, &params("0", "max")).expect("a roll");
    assert_eq!(mesh.face_count(), 8 + 9);
    assert!(report.not_three_valent.iter().all(|&v| mesh.valence(v) == 4));
    assert!(convexity(&mesh).is_convex());
}

#[test]
fn rolls_are_read_as_they_are_written() {
    for text in ["max", "each", "40mm", "40mm,20mm"] {
        assert_eq!(text.parse::<Roll>().expect(text).to_string(), text);
    }
    for text in ["", "most", "1mm,2mm,3mm", "40deg"] {
        assert!(text.parse::<Roll>().is_err(), "{text}");
    }
    for text in ["6mm", "10deg"] {
        assert_eq!(text.parse::<StripSize>().expect(text).to_string(), text);
    }
    assert!("six".parse::<StripSize>().is_err());
    let read = |text: &str| toml::from_str::<TruncateEdgeParams>(text).expect(text);
    assert_eq!(
        read("select = \"0\"\nroll = 40").rolling.roll,
        Some(Roll::Radius(Length::from_mm(40.0)))
    );
    let cone = read("select = \"0\"\nroll = [40, \"2cm\"]\nstrip = \"10deg\"");
    assert_eq!(cone.rolling.roll, Some(Roll::Cone([40.0, 20.0].map(Length::from_mm))));
    assert_eq!(cone.rolling.strip, Some(StripSize::Angle(Angle::from_degrees(10.0))));
}
