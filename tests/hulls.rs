//! Hulls as files: whatever a hull writes is a mesh that every reader takes, and convex parts are
//! never more than were asked for.

use std::path::Path;

use glam::DVec3;
use kerfold::geom::hull::HalfSpace;
use kerfold::io::{MeshFormat, ReadOptions, WriteOptions, mesh_bytes, read_mesh, read_mesh_bytes};
use kerfold::measure::{convexity, edge_length, volume};
use kerfold::mesh::{Mesh, assert_sound};
use kerfold::op::{
    Axis, HullParams, HullReport, OpContext, OpError, TruncateEdgeParams, halfspaces, hull,
    truncate_edges,
};
use kerfold::shape::{SolidParams, solid};

fn model(name: &str) -> Mesh {
    let path = format!("fixtures/meshes/{name}.obj");
    read_mesh(Path::new(&path), &ReadOptions::default()).expect(name).mesh
}

fn ready_made(name: &str) -> Mesh {
    solid(&SolidParams { name: name.parse().expect(name), ..SolidParams::default() }).expect(name)
}

#[track_caller]
fn make(mesh: &Mesh, params: &HullParams, what: &str) -> (Mesh, HullReport) {
    let made = hull(mesh, params, &OpContext::default());
    made.unwrap_or_else(|error| panic!("{what}: {error}"))
}

/// Writes the mesh in every format and reads it again.
#[track_caller]
fn assert_comes_back(mesh: &Mesh, what: &str) {
    assert_sound(mesh);
    assert!(mesh.is_closed(), "{what}");
    let formats = [
        (MeshFormat::Obj, "a.obj"),
        (MeshFormat::Ply, "a.ply"),
        (MeshFormat::Off, "a.off"),
        (MeshFormat::Stl, "a.stl"),
    ];
    // STL knows corners by where they lie, so parts that touch along an edge are one in it.
    let is_one = mesh.components().len() == 1;
    for (format, file) in formats.into_iter().filter(|f| is_one || f.0 != MeshFormat::Stl) {
        let bytes = mesh_bytes(format, mesh, &WriteOptions::default()).expect(what);
        let read = read_mesh_bytes(Path::new(file), &bytes, &ReadOptions::default());
        let read = read.unwrap_or_else(|error| panic!("{what}: {error}")).mesh;
        assert_sound(&read);
        let loss = (volume(&read) / volume(mesh) - 1.0).abs();
        assert!(read.is_closed() && loss < 1e-5, "{what}, {file}: {loss:e}");
        if format != MeshFormat::Stl {
            assert_eq!(read.face_count(), mesh.face_count(), "{what}, {file}");
            assert_eq!(read.vertex_count(), mesh.vertex_count(), "{what}, {file}");
        }
    }
}

/// All ways to make a hull of all vertices.
fn ways() -> Vec<HullParams> {
    let mut ways = Vec::new();
    for (dual, no_box) in [(false, false), (true, false), (true, true)] {
        for simple in [false, true] {
            ways.push(HullParams { dual, no_box, simple, ..HullParams::default() });
        }
    }
    ways
}

#[test]
fn every_hull_of_a_solid_comes_back_from_every_format() {
    for name in [
        "cube",
        "tetrahedron",
        "octahedron",
        "icosahedron",
        "dodecahedron",
        "cuboctahedron",
        "icosidodecahedron",
        "truncated-icosahedron",
        "snub-cube",
        "prism-5",
        "antiprism-6",
        "box-1x2x300",
        "geodesic-3",
    ] {
        let mesh = ready_made(name);
        for params in ways() {
            let what = format!("{name} {params:?}");
            let (made, report) = make(&mesh, &params, &what);
            assert_comes_back(&made, &what);
            if params.simple && params.dual {
                assert_eq!(report.not_three_valent, [], "{what}");
                let n = made.face_count();
                assert_eq!([made.vertex_count(), made.edge_count()], [2 * n - 4, 3 * n - 6]);
                let size = report.parts[0].moved > 0;
                let shortest =
                    made.edges().map(|e| edge_length(&made, e)).fold(f64::INFINITY, f64::min);
                assert!(!size || shortest > 1e-7, "{what}: {shortest:e}");
            }
        }
    }
}

#[test]
fn clusters_groups_parts_and_steps_come_back_too() {
    for name in ["spot-200", "two-troughs", "stool"] {
        let mesh = model(name);
        for simple in [false, true] {
            for base in [
                HullParams { clusters: Some(3), axis: Axis::Y, ..HullParams::default() },
                HullParams { parts: Some(4), ..HullParams::default() },
                HullParams {
                    steps: Some("0,1,5,all".parse().expect("steps")),
                    ..HullParams::default()
                },
            ] {
                let params = HullParams { dual: true, simple, ..base };
                let what = format!("{name} {params:?}");
                let made = hull(&mesh, &params, &OpContext::default());
                // Points of a slab may lie in a plane.
                let Ok((made, report)) = made else {
                    assert!(matches!(made, Err(OpError::NoHull { .. })), "{what}");
                    continue;
                };
                assert_comes_back(&made, &what);
                report.steps.iter().for_each(|step| assert_comes_back(&step.mesh, &what));
            }
        }
    }
}

#[test]
fn dual_hulls_of_cut_octahedra_stay_inside_the_box() {
    // The planes at the corners of the cut are nearly the same.
    for offset in [0.001, 0.01, 0.05, 0.1, 0.3, 0.5, 0.9, 0.999] {
        for bend in [-0.9, -0.3, 0.0, 0.2] {
            let octahedron = ready_made("octahedron");
            let edge = "0".parse().expect("an edge");
            let cut = TruncateEdgeParams { bend, ..TruncateEdgeParams::new(edge, offset) };
            let (mesh, _) =
                truncate_edges(&octahedron, &cut, &OpContext::default()).expect("a cut");
            for simple in [false, true] {
                let what = format!("{offset} {bend} {simple}");
                let params = HullParams { dual: true, simple, ..HullParams::default() };
                let (dual, _) = make(&mesh, &params, &what);
                assert_comes_back(&dual, &what);
                let ((low, high), (l, h)) =
                    (mesh.bounds().expect("points"), dual.bounds().expect("points"));
                let slack = DVec3::splat(1e-9 * (high - low).length());
                assert!(l.cmpge(low - slack).all() && h.cmple(high + slack).all(), "{what}");
                let judged = convexity(&dual);
                assert!(judged.is_convex(), "{what}: {judged:?}");
            }
        }
    }
}

#[test]
fn planes_listed_twice_up_to_the_last_digit_give_a_mesh() {
    for sides in [3_u32, 5, 8, 12] {
        let ring = |round: u32| {
            (0..sides).map(move |k| {
                let angle = std::f64::consts::TAU * f64::from(k + round * sides) / f64::from(sides);
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            })
        };
        let ends = [DVec3::Z, DVec3::NEG_Z].into_iter();
        let planes: Vec<HalfSpace> = ring(0)
            .chain(ring(1))
            .chain(ring(2))
            .chain(ends)
            .map(|normal| HalfSpace { normal, offset: 100.0 })
            .collect();
        for simple in [false, true] {
            let what = format!("{sides} {simple}");
            let params = HullParams { simple, ..HullParams::default() };
            let (mesh, _) = halfspaces(&planes, &params, &OpContext::default()).expect("a prism");
            assert_comes_back(&mesh, &what);
            // Planes that are turned by an ulp meet in the middle of a side, as they are given.
            let faces = sides as usize + 2..=planes.len();
            assert!(faces.contains(&mesh.face_count()), "{what}: {} faces", mesh.face_count());
            assert!(convexity(&mesh).is_convex(), "{what}");
        }
    }
}

#[test]
fn there_are_never_more_parts_than_asked_for() {
    for (name, convex_parts) in [
        ("cube", Some(1)),
        ("stool", Some(5)),
        ("dented-star", None),
        ("gabled-frame", None),
        ("spot-200", None),
        ("drilled-trapezohedron", None),
        ("two-cubes", None),
        ("pot", None),
    ] {
        let mesh = model(name);
        let whole = volume(&make(&mesh, &HullParams::default(), name).0);
        let mut last = whole * (1.0 + 1e-9);
        for most in [1, 2, 3, 8, 40] {
            let params = HullParams { parts: Some(most), ..HullParams::default() };
            let (parts, report) = make(&mesh, &params, name);
            let count = report.parts.len();
            assert!((1..=most as usize).contains(&count), "{name}: {count} of {most}");
            assert_eq!(parts.components().len(), count, "{name}");
            assert_comes_back(&parts, name);
            if let Some(convex_parts) = convex_parts {
                assert_eq!(count, convex_parts.min(most as usize), "{name} in {most}");
            }
            // They cover the model, and more parts never cover more.
            let covered = volume(&parts);
            assert!(covered >= volume(&mesh) * (1.0 - 1e-9), "{name} in {most}");
            assert!(covered <= last * 1.02, "{name} in {most}: {covered} after {last}");
            last = covered;
        }
    }
    // The stool is cut into its seat and four legs exactly.
    let stool = model("stool");
    let params = HullParams { parts: Some(8), ..HullParams::default() };
    let parts = volume(&make(&stool, &params, "stool").0);
    assert!((parts / volume(&stool) - 1.0).abs() < 1e-9);
}

#[test]
fn an_open_mesh_is_not_divided_into_convex_parts() {
    let mut open = ready_made("cube");
    let e = open.edges().next().expect("edges");
    open.set_kind(open.edge_faces(e)[0], kerfold::mesh::FaceKind::Hole);
    let params = HullParams { parts: Some(3), ..HullParams::default() };
    let error = hull(&open, &params, &OpContext::default()).expect_err("open");
    assert!(matches!(error, OpError::NotClosed { holes: 1, .. }), "{error}");
}
