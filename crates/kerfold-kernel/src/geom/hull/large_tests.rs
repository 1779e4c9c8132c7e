//! Inputs so large that the surface grows in parts.

use std::collections::BTreeSet;

use super::tests::{Random, assert_closed, counts, simple_counts, tangent, v, with};
use super::*;

/// Enough for two parts.
const MANY: usize = 40_000;

fn on_sphere(n: usize, seed: u64) -> Vec<glam::DVec3> {
    let mut random = Random(seed);
    (0..n).map(|_| random.on_sphere()).collect()
}

/// The vertices of a simple polytope, each as its three half-spaces, by the numbers that `name`
/// gives them.
fn triples(p: &Polytope, name: impl Fn(u32) -> u32) -> BTreeSet<[u32; 3]> {
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); p.vertices.len()];
    for (run, &i) in p.faces.iter().zip(&p.half_spaces) {
        run.iter().for_each(|&u| at[u as usize].push(name(i)));
    }
    at.iter_mut().for_each(|names| names.sort_unstable());
    at.into_iter().map(|names| names.try_into().expect("three faces at each vertex")).collect()
}

#[test]
fn the_order_of_the_input_does_not_change_the_solid() {
    let planes = tangent(on_sphere(MANY, 29));
    let p = intersect(&planes, &with(Form::Simple)).expect("a ball");
    assert_eq!(counts(&p), simple_counts(MANY));
    assert_closed(&p.faces, p.vertices.len());
    let reversed: Vec<HalfSpace> = planes.iter().rev().copied().collect();
    let q = intersect(&reversed, &with(Form::Simple)).expect("a ball");
    let last = MANY as u32 - 1;
    assert_eq!(triples(&p, |i| i), triples(&q, |i| last - i));
    assert_eq!(p, intersect(&planes, &with(Form::Simple)).expect("a ball"));
}

#[test]
fn far_more_than_one_part_can_hold_agrees_with_few() {
    // Half of the planes lie far outside: the solid is that of the others, which are too few for
    // parts.
    let near = tangent(on_sphere(3000, 31));
    let far = on_sphere(MANY, 37).into_iter().map(|normal| HalfSpace { normal, offset: 1.5 });
    let all: Vec<HalfSpace> = near.iter().copied().chain(far).collect();
    let [few, many] =
        [&near, &all].map(|planes| intersect(planes, &with(Form::Simple)).expect("a ball"));
    assert_eq!(triples(&few, |i| i), triples(&many, |i| i));
}

#[test]
fn of_repeated_planes_the_first_counts_on_both_sides_of_a_border() {
    let round = |x: f64| (x * 1e6).round() / 1e6;
    let normals: Vec<glam::DVec3> =
        on_sphere(MANY, 41).into_iter().map(|n| v(round(n.x), round(n.y), round(n.z))).collect();
    let planes = tangent(normals.iter().chain(&normals).copied());
    let p = intersect(&planes, &with(Form::Simple)).expect("a ball");
    assert_eq!(counts(&p), simple_counts(p.faces.len()));
    assert_closed(&p.faces, p.vertices.len());
    // Rounding moves planes by up to 1e-6, so that a few vanish behind others at their side: those
    // that cut off nothing.
    let is_there = |i: u32| p.half_spaces.binary_search(&i).is_ok();
    let missing: Vec<u32> = (0..MANY as u32).filter(|&i| !is_there(i)).collect();
    assert!(missing.len() < 10, "{missing:?}");
    for i in missing {
        let most = p.vertices.iter().map(|x| normals[i as usize].dot(*x)).fold(f64::MIN, f64::max);
        assert!(most <= 1.0 + 1e-14, "half-space {i} cuts off {:e}", most - 1.0);
    }
    assert!(p.half_spaces.iter().all(|&i| i < MANY as u32), "the second of a pair");
}

#[test]
fn a_dome_of_radius_1000_keeps_its_planes() {
    let mut random = Random(43);
    let mut planes: Vec<HalfSpace> = (0..MANY)
        .map(|_| {
            let (r, (s, c)) =
                (5.0 * random.unit().sqrt(), (std::f64::consts::TAU * random.unit()).sin_cos());
            let normal = v(r * c, r * s, (1e6 - r * r).sqrt()) / 1000.0;
            HalfSpace { normal, offset: normal.dot(normal * 1000.0 - v(0.0, 0.0, 1000.0)) }
        })
        .collect();
    planes.push(HalfSpace { normal: glam::DVec3::NEG_Z, offset: 0.02 });
    let p = intersect(&planes, &with(Form::Simple)).expect("a dome");
    assert_eq!(counts(&p), simple_counts(p.faces.len()));
    assert_closed(&p.faces, p.vertices.len());
}

/// The corners of an icosahedron divided `levels` times, on the unit sphere.
fn subdivided_icosahedron(levels: u32) -> Vec<glam::DVec3> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corners = signs
        .iter()
        .flat_map(|&(a, b)| [v(0.0, a, b * golden), v(a, b * golden, 0.0), v(b * golden, 0.0, a)]);
    let mut points: Vec<glam::DVec3> = corners.map(|p| p.normalize()).collect();
    for _ in 0..levels {
        let faces = convex_hull(&points, Numbers::Given).expect("a ball");
        let mut sides: Vec<(u32, u32)> = Vec::new();
        for run in faces.iter() {
            sides.extend(
                (0..run.len()).map(|i| (run[i], run[(i + 1) % run.len()])).filter(|(a, b)| a < b),
            );
        }
        points.extend(
            sides
                .into_iter()
                .map(|(a, b)| (points[a as usize] + points[b as usize]).normalize())
                .collect::<Vec<_>>(),
        );
    }
    points
}

#[test]
fn a_subdivided_icosahedron_keeps_its_corners_and_faces() {
    let points = subdivided_icosahedron(4);
    assert_eq!(points.len(), 2562);
    let hull = convex_hull(&points, Numbers::Constructed).expect("a ball");
    assert_eq!(hull.len(), 5120);
    assert_closed(&hull, 2562);
    let p = intersect(&tangent(points), &with(Form::Simple)).expect("a ball");
    assert_eq!(counts(&p), simple_counts(2562));
}

#[test]
fn a_hull_of_many_points_is_that_of_its_corners() {
    // Most points lie inside; the corners are those of a hull found without parts.
    let mut points: Vec<glam::DVec3> = on_sphere(MANY, 47).into_iter().map(|p| p * 0.8).collect();
    points.extend(on_sphere(2000, 53));
    let hull = convex_hull(&points, Numbers::Given).expect("a ball");
    let few = convex_hull(&points[MANY..], Numbers::Given).expect("a ball");
    let shifted: Vec<u32> = few.corners().iter().map(|&i| i + MANY as u32).collect();
    assert_eq!(hull.corners(), shifted);
}
