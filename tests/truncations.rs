//! All vertices, edges or faces of the Platonic solids and the soccer ball cut off, compared with
//! an intersection of half-spaces found by brute force.
//!
//! Nothing of the cutting code is used on the other side: the planes are computed here by the
//! formulas of `docs/operators.md` 2, the vertices are all triples of planes that no other plane
//! cuts away.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use kerfold::geom::{Plane, fit_plane};
use kerfold::measure::{face_diameter, volume};
use kerfold::mesh::{FaceId, Mesh, assert_sound};
use kerfold::op::{
    CutReport, OpContext, OpError, Scope, TruncateEdgeParams, TruncateFaceParams,
    TruncateVertexParams, truncate_edges, truncate_faces, truncate_vertices,
};
use kerfold::select::Selection;
use kerfold::shape;

/// A half-space n · x ≤ d.
#[derive(Debug, Clone, Copy)]
struct HalfSpace {
    n: DVec3,
    d: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Vertex,
    Edge,
    Face,
}

/// What a convex solid is known by here.
#[derive(Debug, PartialEq)]
struct Facts {
    counts: [usize; 3],
    valences: BTreeMap<usize, usize>,
    sides: BTreeMap<usize, usize>,
    volume: f64,
}

// ---- the planes, by the book --------------------------------------------------------------------

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

fn normal_of(corners: &[DVec3]) -> DVec3 {
    // The solids are regular: any three corners give the plane of a face.
    (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize()
}

fn face_planes(mesh: &Mesh) -> Vec<HalfSpace> {
    let plane = |f: FaceId| {
        let corners = mesh.face_positions(f);
        let n = normal_of(&corners);
        HalfSpace { n, d: n.dot(mean(&corners)) }
    };
    mesh.faces().map(plane).collect()
}

fn slicing_planes(mesh: &Mesh, kind: Kind, t: f64) -> Vec<HalfSpace> {
    let at = |v| mesh.position(v);
    let normal = |f: FaceId| normal_of(&mesh.face_positions(f));
    let plane = |points: Vec<DVec3>, normals: Vec<DVec3>| {
        let n = mean(&normals).normalize();
        HalfSpace { n, d: n.dot(mean(&points)) }
    };
    match kind {
        Kind::Vertex => mesh
            .vertices()
            .map(|v| {
                let points = mesh.neighbours(v).map(|u| at(v) + t * (at(u) - at(v))).collect();
                plane(points, mesh.vertex_faces(v).map(normal).collect())
            })
            .collect(),
        Kind::Edge => mesh
            .edges()
            .map(|e| {
                let [a, b] = mesh.edge_vertices(e);
                let from =
                    |v, other| mesh.neighbours(v).filter(move |&u| u != other).map(move |u| (v, u));
                let points = from(a, b)
                    .chain(from(b, a))
                    .map(|(v, u)| at(v) + t * (at(u) - at(v)))
                    .collect();
                plane(points, mesh.edge_faces(e).map(normal).to_vec())
            })
            .collect(),
        Kind::Face => mesh
            .faces()
            .map(|f| {
                let corners: Vec<_> = mesh.face_vertices(f).collect();
                let leaving = |&v: &_| {
                    mesh.neighbours(v).filter(|u| !corners.contains(u)).map(move |u| (v, u))
                };
                let points = corners
                    .iter()
                    .flat_map(leaving)
                    .map(|(v, u)| at(v) + t * (at(u) - at(v)))
                    .collect();
                plane(points, vec![normal(f)])
            })
            .collect(),
    }
}

// ---- the intersection, by brute force -----------------------------------------------------------

fn brute_force(planes: &[HalfSpace], size: f64) -> Option<Facts> {
    let tolerance = 1e-9 * size;
    let is_kept = |p: DVec3| planes.iter().all(|h| h.n.dot(p) - h.d <= tolerance);
    let mut corners: Vec<DVec3> = Vec::new();
    for (i, a) in planes.iter().enumerate() {
        for (j, b) in planes.iter().enumerate().take(i) {
            for c in &planes[..j] {
                let rows = DMat3::from_cols(a.n, b.n, c.n).transpose();
                if rows.determinant().abs() < 1e-6 {
                    continue;
                }
                let p = rows.inverse() * DVec3::new(a.d, b.d, c.d);
                if is_kept(p) && !corners.iter().any(|q| q.distance(p) <= tolerance) {
                    corners.push(p);
                }
            }
        }
    }
    facts_of_hull(planes, &corners, tolerance)
}

/// The faces of the solid with these corners are the sets of corners on one plane that span an
/// area.
fn facts_of_hull(planes: &[HalfSpace], corners: &[DVec3], tolerance: f64) -> Option<Facts> {
    let mut faces: Vec<Vec<usize>> = Vec::new();
    let mut volume = 0.0;
    for plane in planes {
        let on: Vec<usize> = (0..corners.len())
            .filter(|&i| (plane.n.dot(corners[i]) - plane.d).abs() <= tolerance)
            .collect();
        let area = area(plane.n, &on.iter().map(|&i| corners[i]).collect::<Vec<_>>());
        if on.len() >= 3 && area > tolerance * tolerance && !faces.contains(&on) {
            volume += area * plane.d / 3.0;
            faces.push(on);
        }
    }
    let mut valences = vec![0; corners.len()];
    for &i in faces.iter().flatten() {
        valences[i] += 1;
    }
    // A solid has room inside: a mere point, line or polygon is nothing.
    if faces.len() < 4 || volume < tolerance {
        return None;
    }
    let edges = faces.iter().map(Vec::len).sum::<usize>() / 2;
    assert_eq!(corners.len() + faces.len(), edges + 2, "the brute force itself is at fault");
    Some(Facts {
        counts: [corners.len(), edges, faces.len()],
        valences: histogram(valences),
        sides: histogram(faces.iter().map(Vec::len)),
        volume,
    })
}

/// The area of the convex polygon of these points, given in any order.
fn area(n: DVec3, points: &[DVec3]) -> f64 {
    if points.len() < 3 {
        return 0.0;
    }
    let centre = mean(points);
    let x = n.any_orthonormal_vector();
    let y = n.cross(x);
    let angle = |p: &DVec3| (*p - centre).dot(y).atan2((*p - centre).dot(x));
    let mut points = points.to_vec();
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(&a, &b)| (a - centre).cross(b - centre).dot(n)).sum::<f64>() / 2.0
}

fn histogram(values: impl IntoIterator<Item = usize>) -> BTreeMap<usize, usize> {
    let mut histogram = BTreeMap::new();
    for value in values {
        *histogram.entry(value).or_default() += 1;
    }
    histogram
}

// ---- the cuts -----------------------------------------------------------------------------------

fn truncate(mesh: &Mesh, kind: Kind, t: f64) -> Result<(Mesh, CutReport), OpError> {
    let context = OpContext::default();
    match kind {
        Kind::Vertex => {
            truncate_vertices(mesh, &TruncateVertexParams::new(Selection::all(), t), &context)
        }
        Kind::Edge => truncate_edges(mesh, &TruncateEdgeParams::new(Selection::all(), t), &context),
        Kind::Face => truncate_faces(mesh, &TruncateFaceParams::new(Selection::all(), t), &context),
    }
}

fn facts(mesh: &Mesh) -> Facts {
    Facts {
        counts: [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
        valences: histogram(mesh.vertices().map(|v| mesh.valence(v))),
        sides: histogram(mesh.faces().map(|f| mesh.sides(f))),
        volume: volume(mesh),
    }
}

fn assert_convex_and_planar(mesh: &Mesh, size: f64, name: &str) {
    for f in mesh.faces() {
        let corners = mesh.face_positions(f);
        let plane = fit_plane(&corners).expect("a face has a plane");
        let deviation = corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
        let diameter = face_diameter(mesh, f);
        assert!(deviation <= 1e-12 * diameter, "{name}: {f} deviates {deviation:e} of {diameter}");
        let newell = Plane::newell(&corners).expect("a face has an area");
        let highest =
            mesh.vertices().map(|v| newell.signed_distance(mesh.position(v))).fold(0.0, f64::max);
        assert!(highest <= 1e-9 * size, "{name}: a vertex lies {highest:e} above {f}");
    }
}

fn solids() -> [(&'static str, Mesh); 6] {
    [
        ("tetrahedron", shape::tetrahedron(10.0)),
        ("cube", shape::cube(10.0)),
        ("octahedron", shape::octahedron(10.0)),
        ("dodecahedron", shape::dodecahedron(10.0)),
        ("icosahedron", shape::icosahedron(10.0)),
        ("soccer ball", shape::soccer_ball(10.0)),
    ]
}

const KINDS: [Kind; 3] = [Kind::Vertex, Kind::Edge, Kind::Face];

/// One row of the table; all comparisons.
fn check(name: &str, mesh: &Mesh, kind: Kind, t: f64) -> String {
    let size = kerfold::measure::size(mesh).length();
    let mut planes = face_planes(mesh);
    planes.extend(slicing_planes(mesh, kind, t));
    let expected = brute_force(&planes, size);
    let title = format!("{name:<13} {:<7} {t:<5}", format!("{kind:?}"));
    match (truncate(mesh, kind, t), expected) {
        (Ok((cut, report)), Some(expected)) => {
            assert_sound(&cut);
            assert_convex_and_planar(&cut, size, &title);
            let found = facts(&cut);
            let difference = (found.volume - expected.volume).abs();
            assert!(
                difference <= 1e-9 * volume(mesh),
                "{title}: volume {} for {}",
                found.volume,
                expected.volume
            );
            let expected = Facts { volume: found.volume, ..expected };
            assert_eq!(found, expected, "{title}");
            let other = cut.vertices().filter(|&v| cut.valence(v) != 3).count();
            assert_eq!(report.not_three_valent.len(), other, "{title}");
            let [v, e, f] = found.counts;
            format!("{title} {v:>5} {e:>5} {f:>5}  {:?}", found.valences)
        }
        (Err(OpError::NothingLeft { .. }), None) => format!("{title}   nothing left"),
        (found, expected) => {
            let found = found.map(|(mesh, _)| facts(&mesh));
            panic!("{title}: found {found:?}, expected {expected:?}")
        }
    }
}

#[test]
#[allow(clippy::print_stdout)] // The table, for those who run it with --nocapture.
fn cutting_everything_off_is_the_intersection_of_half_spaces() {
    let mut table = Vec::new();
    for (name, mesh) in solids() {
        for kind in KINDS {
            for t in [0.25, 0.5, 0.75, 1.0, 1.5] {
                table.push(check(name, &mesh, kind, t));
            }
        }
    }
    println!(
        "solid         element offset    V     E     F  vertices by valence\n{}",
        table.join("\n")
    );
}

#[test]
fn known_counts() {
    let counts =
        |mesh: &Mesh, kind, t| facts(&truncate(mesh, kind, t).expect("something is left").0).counts;
    assert_eq!(counts(&shape::icosahedron(1.0), Kind::Face, 0.25), [12, 30, 20]);
    assert_eq!(counts(&shape::cube(1.0), Kind::Vertex, 0.25), [24, 36, 14]);
    assert_eq!(counts(&shape::cube(1.0), Kind::Vertex, 0.5), [12, 24, 14]);
    assert_eq!(counts(&shape::cube(1.0), Kind::Edge, 0.25), [32, 48, 18]);
    assert_eq!(counts(&shape::tetrahedron(1.0), Kind::Vertex, 0.5), [6, 12, 8]);
    assert_eq!(counts(&shape::soccer_ball(1.0), Kind::Vertex, 0.25), [180, 270, 92]);
}

/// The same topology at every size and far from the origin.
#[test]
fn size_and_place_do_not_matter() {
    for (name, mesh) in solids() {
        for (kind, t) in KINDS.into_iter().flat_map(|kind| [0.25, 0.5].map(|t| (kind, t))) {
            let Ok((expected, _)) = truncate(&mesh, kind, t) else { continue };
            let expected = facts(&expected);
            for (scale, shift) in [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e6), (1e-3, 1e3)] {
                let mut moved = mesh.clone();
                moved.clear_planes();
                for v in mesh.vertices() {
                    moved.set_position(
                        v,
                        mesh.position(v) * scale + DVec3::new(shift, -shift, 2.0 * shift),
                        true,
                    );
                }
                let (cut, _) = truncate(&moved, kind, t).expect("something is left");
                assert_sound(&cut);
                let found = facts(&cut);
                let title = format!("{name} {kind:?} {t} times {scale} moved by {shift}");
                assert_eq!(
                    (found.counts, found.valences, found.sides),
                    (expected.counts, expected.valences.clone(), expected.sides.clone()),
                    "{title}"
                );
            }
        }
    }
}

/// The plane of the paper at a third of the edges, round after round, in millimetres at the origin
/// and 37 m away: neighbours meet from the third round on, which the report says, and faces stay
/// planar whether or not. All vertices for four rounds, one corner for ten.
#[test]
fn the_papers_plane_at_a_third_overcuts_from_the_third_round_on() {
    let runs =
        (1..=4).map(|repeat| ("all", repeat, Scope::Global)).chain([("0", 10, Scope::Local)]);
    for (select, repeat, scope) in runs {
        for shift in [DVec3::ZERO, DVec3::new(37_000.0, -37_000.0, 37_000.0)] {
            let mut mesh = shape::cube(100.0);
            mesh.clear_planes();
            for v in mesh.vertices().collect::<Vec<_>>() {
                mesh.set_position(v, mesh.position(v) + shift, true);
            }
            let select: Selection = select.parse().expect("a selection");
            let params = TruncateVertexParams {
                repeat,
                scope,
                ..TruncateVertexParams::new(select, 1.0 / 3.0)
            };
            let (cut, report) = truncate_vertices(&mesh, &params, &OpContext::default())
                .expect("something is left");
            assert_sound(&cut);
            assert_eq!(
                report.overcut.is_empty(),
                repeat < 3,
                "round {repeat}: {} overcut",
                report.overcut.len()
            );
            // A corner cut off becomes a triangle of its own, unless another cut meets it.
            let caps = cut.faces().filter(|&f| cut.face_vertices(f).count() == 3).count();
            assert_eq!(
                caps == 8 * 3_usize.pow(repeat - 1),
                repeat < 3,
                "round {repeat}: {caps} triangles"
            );
            let diameter = kerfold::measure::size(&cut).length();
            for f in cut.faces() {
                let corners = cut.face_positions(f);
                let plane = fit_plane(&corners).expect("a plane");
                let off =
                    corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
                assert!(
                    off <= 1e-12 * diameter,
                    "round {repeat} at {shift}: {f} is {off:e} off its plane"
                );
            }
        }
    }
}
