//! Hulls and intersections against brute force, and the degenerate inputs that trip others.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::geom::predicate::orient3d;

pub(super) fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn exact_hull(points: &[DVec3]) -> Result<Polygons, HullError> {
    convex_hull(points, Numbers::Given)
}

/// A small generator for the tests (xorshift64*).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn on_sphere(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        let r = (1.0 - z * z).sqrt();
        v(r * cos, r * sin, z)
    }
}

pub(super) fn tangent(normals: impl IntoIterator<Item = DVec3>) -> Vec<HalfSpace> {
    normals.into_iter().map(|normal| HalfSpace { normal, offset: 1.0 }).collect()
}

pub(super) fn with(form: Form) -> Intersect {
    Intersect { form, ..Intersect::default() }
}

/// Faces, edges and vertices.
pub(super) fn counts(p: &Polytope) -> [usize; 3] {
    [p.faces.len(), p.edge_count(), p.vertices.len()]
}

pub(super) fn simple_counts(n: usize) -> [usize; 3] {
    [n, 3 * n - 6, 2 * n - 4]
}

/// Every side has its partner, Euler's number is 2, every vertex lies on the planes of its faces
/// and none beyond a plane.
#[track_caller]
fn assert_polytope(p: &Polytope, half_spaces: &[HalfSpace], tolerance: f64) {
    assert_closed(&p.faces, p.vertices.len());
    for (run, &i) in p.faces.iter().zip(&p.half_spaces) {
        let h = &half_spaces[i as usize];
        let length = h.normal.length();
        let height = |u: &DVec3| {
            (h.normal.dot(*u - p.interior) - (h.offset - h.normal.dot(p.interior))) / length
        };
        for &u in run {
            let off = height(&p.vertices[u as usize]);
            assert!(off.abs() <= tolerance, "vertex {u} is {off:e} off half-space {i}");
        }
    }
    for h in half_spaces.iter().take(200) {
        let length = h.normal.length();
        let most = p
            .vertices
            .iter()
            .map(|u| (h.normal.dot(*u) - h.offset) / length)
            .fold(f64::MIN, f64::max);
        assert!(most <= tolerance, "a vertex is {most:e} beyond a plane");
    }
}

#[track_caller]
pub(super) fn assert_closed(faces: &Polygons, vertices: usize) {
    let mut sides: Vec<(u32, u32)> = Vec::new();
    for run in faces.iter() {
        assert!(run.len() >= 3);
        sides.extend((0..run.len()).map(|i| (run[i], run[(i + 1) % run.len()])));
    }
    sides.sort_unstable();
    assert!(sides.windows(2).all(|w| w[0] != w[1]), "a side comes twice");
    assert!(
        sides.iter().all(|&(a, b)| sides.binary_search(&(b, a)).is_ok()),
        "a side has no partner"
    );
    assert_eq!(vertices + faces.len(), sides.len() / 2 + 2, "Euler");
}

fn cube_points(n: i32) -> Vec<DVec3> {
    let range = move || 0..=n;
    range()
        .flat_map(|x| {
            range().flat_map(move |y| {
                range().map(move |z| v(f64::from(x), f64::from(y), f64::from(z)))
            })
        })
        .collect()
}

#[test]
fn a_grid_of_points_is_a_cube_with_six_faces() {
    for n in [1, 2, 5] {
        for shift in [DVec3::ZERO, v(1e6, -1e7, 3e5)] {
            let points: Vec<DVec3> = cube_points(n).into_iter().map(|p| p + shift).collect();
            let hull = exact_hull(&points).expect("a cube");
            assert_eq!((hull.len(), hull.corners().len()), (6, 24));
            assert_closed(&hull, 8);
        }
    }
}

#[test]
fn repeated_points_count_once() {
    let points: Vec<DVec3> = cube_points(1).into_iter().flat_map(|p| [p, p, p]).collect();
    let hull = exact_hull(&points).expect("a cube");
    assert_eq!(hull.len(), 6);
    assert_closed(&hull, 8);
}

#[test]
fn points_without_a_volume_are_refused_with_the_reason() {
    assert_eq!(exact_hull(&[DVec3::ZERO; 3]), Err(HullError::TooFew { count: 3 }));
    assert!(matches!(exact_hull(&[DVec3::ONE; 9]), Err(HullError::Coincident { count: 9, .. })));
    let line: Vec<DVec3> = (0..50).map(|i| v(1.0, 2.0, -3.0) * f64::from(i)).collect();
    let Err(HullError::Collinear { direction, .. }) = exact_hull(&line) else { panic!("a line") };
    assert!(direction.cross(v(1.0, 2.0, -3.0)).length() < 1e-14);
    let plane: Vec<DVec3> = (0..50)
        .map(|i| v(f64::from(i % 7), f64::from(i), f64::from(i) + f64::from(i % 7)))
        .collect();
    let error = exact_hull(&plane).expect_err("a plane");
    assert!(
        matches!(error, HullError::Coplanar { normal, .. } if normal.dot(v(1.0, 1.0, -1.0)).abs() > 1.7),
        "{error}"
    );
    let bad = [v(0.0, 0.0, f64::NAN), DVec3::X, DVec3::Y, DVec3::Z];
    assert!(matches!(exact_hull(&bad), Err(HullError::NotFinite { point: 0, .. })));
}

#[test]
fn a_sheet_one_ulp_thick_has_a_hull() {
    // No double lies between the two layers, so there is no centre to walk from.
    let (low, high) = (1e6, 1e6_f64.next_up());
    let mut random = Random(5);
    let mut points: Vec<DVec3> = (0..400).map(|_| v(random.unit(), random.unit(), low)).collect();
    points.extend((0..400).map(|_| v(random.unit(), random.unit(), high)));
    let hull = exact_hull(&points).expect("two layers");
    assert_hull(&points, &hull);
}

#[track_caller]
fn assert_hull(points: &[DVec3], hull: &Polygons) {
    let mut used: Vec<u32> = hull.corners().to_vec();
    used.sort_unstable();
    used.dedup();
    assert_closed(hull, used.len());
    let at = |i: u32| points[i as usize];
    for run in hull.iter() {
        for (i, &a) in run.iter().enumerate() {
            // Strictly convex corners, all in one plane, nothing above: exactly.
            let (b, c) = (run[(i + 1) % run.len()], run[(i + 2) % run.len()]);
            assert!(points.iter().all(|&p| orient3d(at(a), at(b), at(c), p) >= 0.0));
            assert!(run.iter().all(|&d| orient3d(at(a), at(b), at(c), at(d)) == 0.0));
            assert!(!cloud::are_collinear([at(a), at(b), at(c)]));
        }
        // No two faces lie in one plane: whoever is on this plane is inside or on this face's
        // edges.
        let on: Vec<u32> = used
            .iter()
            .copied()
            .filter(|&d| orient3d(at(run[0]), at(run[1]), at(run[2]), at(d)) == 0.0)
            .collect();
        assert_eq!(on.len(), run.len());
    }
}

#[test]
fn faces_flat_up_to_rounding_are_one_when_computed() {
    let mut random = Random(23);
    let normal = random.on_sphere();
    let (x, y) = normal.any_orthonormal_pair();
    // A turned grid of points and one of its layers moved by less than rounding.
    let mut points: Vec<DVec3> =
        cube_points(4).into_iter().map(|p| x * p.x + y * p.y + normal * p.z + 7.0).collect();
    points[31] += normal * 1e-15;
    assert!(exact_hull(&points).expect("a cube").len() > 6);
    let hull = convex_hull(&points, Numbers::Constructed).expect("a cube");
    assert_eq!((hull.len(), hull.corners().len()), (6, 24));
    // Thinner than rounding altogether: nothing is joined, so that a solid remains.
    let sheet: Vec<DVec3> = points.iter().map(|&p| p - normal * (p - 7.0).dot(normal)).collect();
    if let Ok(exact) = exact_hull(&sheet) {
        assert_eq!(convex_hull(&sheet, Numbers::Constructed), Ok(exact));
    }
}

#[test]
fn random_tangent_planes_are_simple_and_all_there() {
    let mut random = Random(7);
    for n in [10, 100, 3000] {
        let sphere: Vec<DVec3> = (0..n).map(|_| random.on_sphere()).collect();
        let Ok(p) = intersect(&tangent(sphere.clone()), &Intersect::default()) else { continue };
        assert_eq!(counts(&p), simple_counts(n));
        assert_polytope(&p, &tangent(sphere.clone()), 1e-14);
        assert_eq!(p, intersect(&tangent(sphere), &with(Form::Simple)).expect("the same"));
    }
    // The planes that touch the ellipsoid with the axes 10, 3 and 1.
    let ellipsoid: Vec<HalfSpace> = (0..3000)
        .map(|_| random.on_sphere())
        .map(|u| HalfSpace { normal: u / v(10.0, 3.0, 1.0), offset: 1.0 })
        .collect();
    let p = intersect(&ellipsoid, &Intersect::default()).expect("bounded");
    assert_eq!(counts(&p), simple_counts(3000));
    assert_polytope(&p, &ellipsoid, 1e-13);
}

/// The normals of a grid of `rows` latitudes and `columns` longitudes, and the two poles.
fn grid(rows: usize, columns: usize) -> Vec<DVec3> {
    let mut normals = vec![DVec3::Z, DVec3::NEG_Z];
    for i in 0..rows {
        let (sin, cos) = (PI * (i + 1) as f64 / (rows + 1) as f64).sin_cos();
        for j in 0..columns {
            let (s, c) = (TAU * j as f64 / columns as f64).sin_cos();
            normals.push(v(sin * c, sin * s, cos));
        }
    }
    normals
}

#[test]
fn a_grid_of_latitudes_and_longitudes_keeps_every_face() {
    let planes = tangent(grid(71, 140));
    let simple = intersect(&planes, &with(Form::Simple)).expect("a grid");
    assert_eq!(counts(&simple), simple_counts(9942));
    assert_polytope(&simple, &planes, 1e-13);
    // As computed numbers the four neighbours of each crossing meet in one point, and 140 faces do
    // around each pole's rim.
    let merged = Intersect { numbers: Numbers::Constructed, ..Intersect::default() };
    let p = intersect(&planes, &merged).expect("a grid");
    assert_eq!(counts(&p), [9942, 9942 + 72 * 140 - 2, 72 * 140]);
    assert_polytope(&p, &planes, 1e-12);
}

#[test]
fn planes_that_only_touch_contribute_nothing() {
    // An octahedron |x| + |y| + |z| ≤ 1024, touched at its vertices and edges by planes whose
    // numbers are exact.
    let corner =
        |i: i32| v(f64::from(1 - 2 * (i & 1)), f64::from(1 - (i & 2)), f64::from(1 - (i & 4) / 2));
    let faces = (0..8).map(|i| HalfSpace { normal: corner(i), offset: 1024.0 });
    let mut random = Random(3);
    let mut whole = move || (random.unit() * 2047.0).floor() - 1023.0;
    let mut touching = Vec::new();
    while touching.len() < 10_080 {
        // The largest coordinate of the normal in size times 1024 is the support of the octahedron.
        let (a, b) = (whole() / 1024.0, whole() / 1024.0);
        let n = [
            v(1.0, a, b),
            v(a, 1.0, b),
            v(a, b, -1.0),
            v(1.0, 1.0, a),
            v(-1.0, a, 1.0),
            v(a, -1.0, -1.0),
        ];
        touching.push(HalfSpace { normal: n[touching.len() % 6], offset: 1024.0 });
    }
    for first in [true, false] {
        let (faces, touching) = (faces.clone(), touching.iter().copied());
        let planes: Vec<HalfSpace> =
            if first { faces.chain(touching).collect() } else { touching.chain(faces).collect() };
        let merged = intersect(&planes, &with(Form::Merged)).expect("an octahedron");
        assert_eq!(counts(&merged), [8, 12, 6]);
        assert_eq!(merged.half_spaces[0], if first { 0 } else { 10_080 });
        let simple = intersect(&planes, &with(Form::Simple)).expect("an octahedron");
        assert_eq!(counts(&simple), simple_counts(8));
        assert_closed(&simple.faces, 12);
    }
}

#[test]
fn repeated_cylinder_angles_count_once() {
    let angles = (0..10_000).map(|i| (TAU * f64::from(i % 100) / 100.0).sin_cos());
    let mut planes = tangent(angles.map(|(s, c)| v(c, s, 0.0)));
    planes.extend(tangent([DVec3::Z, DVec3::NEG_Z]));
    let simple = intersect(&planes, &with(Form::Simple)).expect("a drum");
    assert_eq!(counts(&simple), simple_counts(102));
    assert_polytope(&simple, &planes, 1e-13);
}

#[test]
fn a_shallow_dome_keeps_its_planes() {
    // 2000 planes that touch a sphere of radius 1000 within 5 of its top, and a base.
    let mut random = Random(11);
    let top = v(0.0, 0.0, 1000.0);
    let mut planes: Vec<HalfSpace> = (0..2000)
        .map(|_| {
            let (r, (s, c)) = (5.0 * random.unit().sqrt(), (TAU * random.unit()).sin_cos());
            let normal = v(r * c, r * s, (1e6 - r * r).sqrt()) / 1000.0;
            HalfSpace { normal, offset: normal.dot(normal * 1000.0 - top) }
        })
        .collect();
    planes.push(HalfSpace { normal: DVec3::NEG_Z, offset: 0.02 });
    let p = intersect(&planes, &Intersect::default()).expect("a dome");
    assert_eq!(counts(&p), simple_counts(p.faces.len()));
    assert!(p.faces.len() > 1990, "{}", p.faces.len());
    assert_polytope(&p, &planes, 1e-14);
}

#[test]
fn normals_rounded_to_six_decimals_lose_nothing() {
    let mut random = Random(13);
    let round = |x: f64| (x * 1e6).round() / 1e6;
    let mut normals: Vec<DVec3> = (0..4000)
        .map(|_| random.on_sphere())
        .map(|n| v(round(n.x), round(n.y), round(n.z)))
        .collect();
    let p = intersect(&tangent(normals.clone()), &with(Form::Simple)).expect("a sphere");
    assert_eq!(counts(&p), simple_counts(4000));
    normals.extend(normals.clone());
    let doubled = intersect(&tangent(normals), &with(Form::Simple)).expect("a sphere");
    assert_eq!(counts(&doubled), simple_counts(4000));
}

#[test]
fn infeasible_flat_and_open_sets_are_refused_with_the_reason() {
    let space = |n: DVec3, offset| HalfSpace { normal: n, offset };
    let sides = || {
        [
            space(DVec3::X, 1.0),
            space(DVec3::NEG_X, 1.0),
            space(DVec3::Y, 1.0),
            space(DVec3::NEG_Y, 1.0),
        ]
    };
    let refuse = |more: &[HalfSpace]| {
        let planes: Vec<HalfSpace> = sides().into_iter().chain(more.iter().copied()).collect();
        intersect(&planes, &Intersect::default()).expect_err("refused")
    };
    let error = refuse(&[]);
    assert!(
        matches!(error, HalfSpaceError::Unbounded { direction } if direction.z.abs() > 0.999),
        "{error}"
    );
    let error = refuse(&[space(DVec3::Z, 1.0)]);
    assert!(
        matches!(error, HalfSpaceError::Unbounded { direction } if direction.z < -0.999),
        "{error}"
    );
    let error = refuse(&[space(DVec3::Z, 1.0), space(DVec3::NEG_Z, -1.5)]);
    let wanted = HalfSpaceError::Infeasible { half_spaces: vec![4, 5], gap: 0.25 };
    assert!(
        matches!(&error, HalfSpaceError::Infeasible { half_spaces, .. } if half_spaces[..] == [4, 5]),
        "{error}"
    );
    assert!(wanted.to_string().contains("half-spaces 4 and 5 exclude each other"), "{wanted}");
    let error = refuse(&[space(DVec3::Z, 1.0), space(DVec3::NEG_Z, -1.0)]);
    assert!(
        matches!(error, HalfSpaceError::NoVolume { ref half_spaces } if half_spaces[..] == [4, 5]),
        "{error}"
    );
    assert_eq!(refuse(&[space(DVec3::ZERO, 1.0)]), HalfSpaceError::NoDirection { half_space: 4 });
    assert_eq!(refuse(&[space(DVec3::Z, f64::NAN)]), HalfSpaceError::NotFinite { half_space: 4 });
    for few in 0..4 {
        let error = intersect(&sides()[..few], &Intersect::default()).expect_err("open");
        let HalfSpaceError::Unbounded { direction } = error else { panic!("{error}") };
        assert!(
            sides()[..few].iter().all(|h| h.normal.dot(direction) <= 1e-15),
            "{few}: {direction}"
        );
    }
}

#[test]
fn however_flat_or_long_a_solid_is_it_is_the_same() {
    let mut random = Random(23);
    let normals: Vec<DVec3> = (0..2000).map(|_| random.on_sphere()).collect();
    let reference = intersect(&tangent(normals.clone()), &Intersect::default()).expect("a ball");
    for axes in
        [v(1.0, 0.25, 4.0), v(1024.0, 1.0, 1.0), v(1.0, 1.0, 1.0 / 4096.0), v(1e-30, 1.0, 1e30)]
    {
        // Powers of two change no digit; others the last.
        let planes: Vec<HalfSpace> =
            normals.iter().map(|&n| HalfSpace { normal: n / axes, offset: 1.0 }).collect();
        let p = intersect(&planes, &Intersect::default()).expect("an ellipsoid");
        assert_eq!(counts(&p), counts(&reference), "{axes}");
        let worst = p.vertices.iter().map(|&x| (x / axes).length()).fold(0.0, f64::max);
        let expected = reference.vertices.iter().map(|x| x.length()).fold(0.0, f64::max);
        assert!(
            (worst - expected).abs() <= 1e-12 * expected,
            "{axes}: {worst} instead of {expected}"
        );
    }
}

#[test]
fn the_open_direction_of_a_flat_or_long_set_is_right() {
    let mut random = Random(29);
    let open = v(3.0, -2.0, 1.0);
    let normals: Vec<DVec3> =
        (0..500).map(|_| random.on_sphere()).filter(|n| n.dot(open) < 0.0).collect();
    for axes in [DVec3::ONE, v(1000.0, 1.0, 0.001), v(1e-12, 1.0, 1e12)] {
        let planes: Vec<HalfSpace> =
            normals.iter().map(|&n| HalfSpace { normal: n / axes, offset: 1.0 }).collect();
        let error = intersect(&planes, &Intersect::default()).expect_err("open");
        let HalfSpaceError::Unbounded { direction } = error else { panic!("{axes}: {error}") };
        assert!((direction.length() - 1.0).abs() < 1e-12);
        let closes = |h: &HalfSpace| {
            h.normal.dot(direction) > 1e-12 * (h.normal * direction).abs().max_element()
        };
        assert!(!planes.iter().any(closes), "{axes}: {direction}");
    }
}

#[test]
fn far_away_and_at_any_scale_it_is_the_same_solid() {
    let mut random = Random(17);
    let normals: Vec<DVec3> = (0..300).map(|_| random.on_sphere()).collect();
    let reference = intersect(&tangent(normals.clone()), &Intersect::default()).expect("a ball");
    for (scale, shift) in
        [(1e-3, DVec3::ZERO), (1e-30, DVec3::ZERO), (1e20, DVec3::ZERO), (1.0, v(1e6, -2e6, 5e5))]
    {
        let planes: Vec<HalfSpace> = normals
            .iter()
            .map(|&normal| HalfSpace { normal, offset: scale + normal.dot(shift) })
            .collect();
        let p = intersect(&planes, &Intersect::default()).expect("a ball");
        assert_eq!(counts(&p), counts(&reference));
        let tolerance = 1e-14 * scale + 4.0 * f64::EPSILON * shift.length();
        assert_polytope(&p, &planes, tolerance);
    }
}

/// Points of a small grid: nearly all of their hulls are degenerate.
fn grid_points() -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec(prop::array::uniform3(-3_i32..=3), 4..60).prop_map(|points| {
        points.into_iter().map(|[x, y, z]| v(x.into(), y.into(), z.into())).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn hulls_of_grid_points_are_exact(points in grid_points(), shift in prop::sample::select(vec![0.0, 1e5, 0.1])) {
        let points: Vec<DVec3> = points.into_iter().map(|p| p + shift).collect();
        match exact_hull(&points) {
            Ok(hull) => {
                assert_hull(&points, &hull);
                // The hull of the hull's corners is the hull.
                let mut used = hull.corners().to_vec();
                used.sort_unstable();
                used.dedup();
                let corners: Vec<DVec3> = used.iter().map(|&i| points[i as usize]).collect();
                let again = exact_hull(&corners).expect("the same hull");
                let back: Vec<u32> = again.corners().iter().map(|&i| used[i as usize]).collect();
                prop_assert_eq!(back, hull.corners());
            }
            Err(HullError::Coplanar { .. } | HullError::Collinear { .. } | HullError::Coincident { .. }) => {
                let flat = |w: &[DVec3]| orient3d(w[0], w[1], w[2], w[3]) == 0.0;
                prop_assert!(points.windows(4).all(flat));
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn hulls_of_nearly_flat_points_are_exact(flat in prop::collection::vec(prop::array::uniform2(-1.0_f64..1.0), 5..40), seed in 1_u64..1000) {
        // Points of a slanted plane, each coordinate rounded: the hull is a layer some ulps thick.
        let mut random = Random(seed);
        let normal = random.on_sphere();
        let (x, y) = normal.any_orthonormal_pair();
        let points: Vec<DVec3> = flat.iter().map(|&[a, b]| x * a + y * b + normal * 0.3).collect();
        if let Ok(hull) = exact_hull(&points) {
            assert_hull(&points, &hull);
        }
    }

    #[test]
    fn whole_numbered_planes_agree_with_their_dual_hull(points in grid_points()) {
        // Planes n·x ≤ 1 are the duals of grid points: their intersection is bounded when the
        // origin lies inside the hull.
        let normals: Vec<DVec3> = points.iter().copied().filter(|p| *p != DVec3::ZERO).collect();
        let planes = tangent(normals.clone());
        match intersect(&planes, &Intersect::default()) {
            Ok(p) => {
                let hull = exact_hull(&normals).expect("bounded, so the normals span space");
                let mut corners = hull.corners().to_vec();
                corners.sort_unstable();
                corners.dedup();
                prop_assert_eq!([p.faces.len(), p.vertices.len()], [corners.len(), hull.len()]);
                assert_polytope(&p, &planes, 1e-13);
                let simple = intersect(&planes, &with(Form::Simple)).expect("the same");
                prop_assert_eq!(counts(&simple), simple_counts(corners.len()));
                assert_closed(&simple.faces, simple.vertices.len());
            }
            Err(HalfSpaceError::Unbounded { direction }) => {
                prop_assert!(normals.iter().all(|n| n.dot(direction) <= 1e-12));
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }
}
