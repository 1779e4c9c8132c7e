use super::*;
use crate::geom::nearest_on_triangle;
use crate::measure::volume;
use crate::mesh::assert_sound;
use crate::shape;

fn simplified(mesh: &Mesh, params: &SimplifyParams) -> (Mesh, SimplifyReport) {
    let (result, report) = simplify(mesh, params, &OpContext::default()).expect("simplified");
    assert_sound(&result);
    assert!(result.file_faults().is_empty() && report.is_clean());
    assert_eq!(report.after, result.face_count());
    // No vertex is new.
    for v in result.vertices() {
        let place = result.position(v);
        assert!(mesh.vertices().any(|old| mesh.position(old) == place));
    }
    (result, report)
}

fn to_faces(faces: usize) -> SimplifyParams {
    SimplifyParams { faces: Some(faces), deviation: None }
}

fn within(mm: f64) -> SimplifyParams {
    SimplifyParams { faces: None, deviation: Some(Length::from_mm(mm)) }
}

/// A ball of 2000 triangles.
fn ball() -> Mesh {
    shape::geodesic(10, 100.0)
}

#[test]
fn a_ball_of_two_thousand_becomes_one_of_a_hundred() {
    let mesh = ball();
    let (result, report) = simplified(&mesh, &to_faces(100));
    assert!((80..=110).contains(&result.face_count()), "{report:?}");
    assert!(result.is_closed() && genus(&result) == 0 && !report.kept_more);
    // Corners on the sphere: a little of it is cut off.
    let share = volume(&result) / volume(&mesh);
    assert!((0.85..1.0).contains(&share), "{share}");
    assert!(report.deviation_mm > 0.5 && report.deviation_mm < 20.0, "{report:?}");
}

#[test]
fn the_deviation_is_kept_and_measured() {
    let mesh = ball();
    let mut last = usize::MAX;
    for mm in [1.0, 4.0, 12.0] {
        let (result, report) = simplified(&mesh, &within(mm));
        assert!(report.deviation_mm <= mm, "{report:?}");
        assert!(result.face_count() < last);
        last = result.face_count();
    }
    assert!(last < 300, "{last}");
}

#[test]
fn flat_sides_cost_nothing_and_groups_stay() {
    let mut cube = shape::cube(100.0);
    for (i, f) in cube.faces().collect::<Vec<_>>().into_iter().enumerate() {
        cube.set_group(f, ["a", "b", "c", "d", "e", "f"][i]);
    }
    let params = super::super::SubdivideParams::new(super::super::Scheme::Triangulate, 1);
    let (triangles, _) =
        super::super::subdivide(&cube, &params, &OpContext::default()).expect("triangles");
    let (result, report) = simplified(&triangles, &within(0.1));
    assert_eq!(result.face_count(), 12);
    assert!(report.deviation_mm < 1e-9);
    let mut groups: Vec<_> = result.faces().filter_map(|f| result.group(f)).collect();
    groups.sort_unstable();
    assert_eq!(groups, ["a", "a", "b", "b", "c", "c", "d", "d", "e", "e", "f", "f"]);
}

#[test]
fn numbers_out_of_range_are_refused() {
    let cube = shape::cube(10.0);
    let refused = |params: &SimplifyParams| simplify(&cube, params, &OpContext::default()).err();
    assert!(matches!(refused(&SimplifyParams::default()), Some(OpError::Requires { .. })));
    assert!(matches!(refused(&to_faces(3)), Some(OpError::TooFewFaces { .. })));
    assert!(matches!(refused(&within(0.0)), Some(OpError::ToleranceOutOfRange { .. })));
}

#[test]
fn the_same_mesh_gives_the_same_triangles() {
    let places = |mesh: &Mesh| mesh.faces().map(|f| mesh.face_positions(f)).collect::<Vec<_>>();
    let [a, b] = [0, 1].map(|_| simplified(&ball(), &to_faces(150)).0);
    assert_eq!(places(&a), places(&b));
}

#[test]
fn distances_to_a_triangle_are_those_of_its_parts() {
    let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
    for (p, distance) in [
        (DVec3::new(0.5, 0.5, 3.0), 3.0),
        (DVec3::new(-1.0, 1.0, 0.0), 1.0),
        (DVec3::new(-3.0, -4.0, 0.0), 5.0),
        (DVec3::new(2.0, 2.0, 0.0), 2.0_f64.sqrt()),
    ] {
        assert!((nearest_on_triangle(p, corners).distance(p) - distance).abs() < 1e-12, "{p}");
    }
}
