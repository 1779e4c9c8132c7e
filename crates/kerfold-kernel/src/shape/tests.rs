use super::*;
use crate::geom::Plane;
use crate::measure::{edge_length, size, volume};
use crate::mesh::assert_sound;
use proptest::prelude::*;

fn named(name: &str) -> Mesh {
    solid(name.parse().expect(name), SolidSize::Standard).expect(name)
}

/// The sides of the faces around a vertex, rotated and mirrored to the lowest reading.
fn configuration(mesh: &Mesh, v: VertexId) -> Vec<usize> {
    let mut sides: Vec<usize> = mesh.vertex_faces(v).map(|f| mesh.sides(f)).collect();
    let mut readings = Vec::new();
    for _ in 0..2 {
        for _ in 0..sides.len() {
            sides.rotate_left(1);
            readings.push(sides.clone());
        }
        sides.reverse();
    }
    readings.into_iter().min().expect("a vertex has faces")
}

fn histogram(mesh: &Mesh) -> Vec<(usize, usize)> {
    let mut counts = std::collections::BTreeMap::new();
    mesh.faces().for_each(|f| *counts.entry(mesh.sides(f)).or_insert(0) += 1);
    counts.into_iter().collect()
}

fn assert_planar_and_centred(name: &str, mesh: &Mesh) {
    assert_sound(mesh);
    assert!(mesh.is_closed() && volume(mesh) > 0.0, "{name}");
    let extent = size(mesh).max_element();
    for f in mesh.faces() {
        let corners = mesh.face_positions(f);
        let plane = Plane::newell(&corners).expect("an area");
        assert!(plane.offset() > 0.0, "{name}: {f:?} looks outwards");
        let off = corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-15 * extent, "{name}: {f:?} is {off} off its plane");
    }
    let mean =
        mesh.vertices().map(|v| mesh.position(v)).sum::<DVec3>() / mesh.vertex_count() as f64;
    assert!(mean.length() <= 1e-15 * extent, "{name}: {mean}");
}

/// Name, vertices, edges, faces, histogram of sides, vertex configuration.
type Row = (&'static str, [usize; 3], &'static [(usize, usize)], &'static [usize]);

const UNIFORM: [Row; 24] = [
    ("tetrahedron", [4, 6, 4], &[(3, 4)], &[3, 3, 3]),
    ("cube", [8, 12, 6], &[(4, 6)], &[4, 4, 4]),
    ("octahedron", [6, 12, 8], &[(3, 8)], &[3, 3, 3, 3]),
    ("dodecahedron", [20, 30, 12], &[(5, 12)], &[5, 5, 5]),
    ("icosahedron", [12, 30, 20], &[(3, 20)], &[3, 3, 3, 3, 3]),
    ("truncated-tetrahedron", [12, 18, 8], &[(3, 4), (6, 4)], &[3, 6, 6]),
    ("cuboctahedron", [12, 24, 14], &[(3, 8), (4, 6)], &[3, 4, 3, 4]),
    ("truncated-cube", [24, 36, 14], &[(3, 8), (8, 6)], &[3, 8, 8]),
    ("truncated-octahedron", [24, 36, 14], &[(4, 6), (6, 8)], &[4, 6, 6]),
    ("rhombicuboctahedron", [24, 48, 26], &[(3, 8), (4, 18)], &[3, 4, 4, 4]),
    ("truncated-cuboctahedron", [48, 72, 26], &[(4, 12), (6, 8), (8, 6)], &[4, 6, 8]),
    ("snub-cube", [24, 60, 38], &[(3, 32), (4, 6)], &[3, 3, 3, 3, 4]),
    ("icosidodecahedron", [30, 60, 32], &[(3, 20), (5, 12)], &[3, 5, 3, 5]),
    ("truncated-dodecahedron", [60, 90, 32], &[(3, 20), (10, 12)], &[3, 10, 10]),
    ("soccer-ball", [60, 90, 32], &[(5, 12), (6, 20)], &[5, 6, 6]),
    ("rhombicosidodecahedron", [60, 120, 62], &[(3, 20), (4, 30), (5, 12)], &[3, 4, 5, 4]),
    ("truncated-icosidodecahedron", [120, 180, 62], &[(4, 30), (6, 20), (10, 12)], &[4, 6, 10]),
    ("snub-dodecahedron", [60, 150, 92], &[(3, 80), (5, 12)], &[3, 3, 3, 3, 5]),
    ("prism-3", [6, 9, 5], &[(3, 2), (4, 3)], &[3, 4, 4]),
    ("prism-4", [8, 12, 6], &[(4, 6)], &[4, 4, 4]),
    ("prism-17", [34, 51, 19], &[(4, 17), (17, 2)], &[4, 4, 17]),
    ("antiprism-3", [6, 12, 8], &[(3, 8)], &[3, 3, 3, 3]),
    ("antiprism-4", [8, 16, 10], &[(3, 8), (4, 2)], &[3, 3, 3, 4]),
    ("antiprism-11", [22, 44, 24], &[(3, 22), (11, 2)], &[3, 3, 3, 11]),
];

#[test]
fn every_uniform_solid_is_what_its_name_says() {
    for (name, counts, sides, corner) in UNIFORM {
        let edge = SolidSize::Edge(Length::from_mm(40.0));
        let mesh = solid(name.parse().expect(name), edge).expect(name);
        assert_planar_and_centred(name, &mesh);
        assert_eq!([mesh.vertex_count(), mesh.edge_count(), mesh.face_count()], counts, "{name}");
        assert_eq!(histogram(&mesh), sides, "{name}");
        assert!(mesh.vertices().all(|v| configuration(&mesh, v) == corner), "{name}");
        assert!(mesh.vertices().all(|v| !mesh.is_given(v)));
        for e in mesh.edges() {
            assert!(
                (edge_length(&mesh, e) / 40.0 - 1.0).abs() < 1e-14,
                "{name}: {e:?} is {}",
                edge_length(&mesh, e)
            );
        }
    }
}

#[test]
fn volumes_agree_with_the_tables() {
    // Volumes at edge length 1 (Cromwell 1997).
    for (solid, expected) in [
        (Archimedean::SnubCube, 7.889_477_399_975_39),
        (Archimedean::SnubDodecahedron, 37.616_649_962_733_36),
        (Archimedean::TruncatedIcosahedron, 55.287_730_758_122_74),
        (Archimedean::TruncatedIcosidodecahedron, 206.803_398_874_989_5),
    ] {
        let measured = volume(&archimedean(solid, 1.0));
        assert!((measured / expected - 1.0).abs() < 1e-13, "{solid:?}: {measured}");
    }
    assert_eq!(volume(&cube(40.0)), 64_000.0);
}

#[test]
fn face_lists_begin_at_their_lowest_vertex_in_lexicographic_order() {
    for solid in Archimedean::ALL {
        let mesh = archimedean(solid, 1.0);
        let faces: Vec<Vec<VertexId>> =
            mesh.faces().map(|f| mesh.face_vertices(f).collect()).collect();
        assert!(
            faces.is_sorted() && faces.iter().all(|face| face.iter().min() == face.first()),
            "{solid:?}"
        );
    }
}

#[test]
fn the_hands_of_the_snubs_stay_the_same() {
    // The turn of the square (pentagon) side that each corner sees first, as a sign; a mirror image
    // would flip it.
    for (solid, sides) in [(Archimedean::SnubCube, 4), (Archimedean::SnubDodecahedron, 5)] {
        let mesh = archimedean(solid, 1.0);
        let big: Vec<DVec3> = mesh
            .faces()
            .filter(|&f| mesh.sides(f) == sides)
            .map(|f| Plane::newell(&mesh.face_positions(f)).expect("an area").normal())
            .collect();
        let f = mesh.faces().find(|&f| mesh.sides(f) == sides).expect("a big face");
        let h = mesh.face_start(f).expect("edges");
        let [a, b] = [mesh.position(mesh.origin(h)), mesh.position(mesh.target(h))];
        let n = Plane::newell(&mesh.face_positions(f)).expect("an area").normal();
        // The nearest big face across this side lies off the middle of the side, to the right or to
        // the left.
        let middle = a.midpoint(b);
        let other = big
            .iter()
            .filter(|m| m.dot(n) < 0.99)
            .max_by(|p, q| p.dot(middle).total_cmp(&q.dot(middle)));
        let off = (*other.expect("six or twelve")).dot(b - a);
        assert!(off < -0.01, "{solid:?}: {off}");
    }
}

#[test]
fn geodesic_spheres_are_round_and_closed() {
    for n in [1, 2, 3, 4, 7] {
        let mesh = geodesic(n, 50.0);
        assert_sound(&mesh);
        let n = n as usize;
        assert_eq!(
            [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
            [10 * n * n + 2, 30 * n * n, 20 * n * n]
        );
        assert!(mesh.is_closed() && volume(&mesh) > 0.0);
        assert!(mesh.vertices().all(|v| (mesh.position(v).length() - 50.0).abs() < 2e-14));
        assert_eq!(mesh.vertices().filter(|&v| mesh.valence(v) == 5).count(), 12);
        assert!(mesh.vertices().all(|v| [5, 6].contains(&mesh.valence(v))));
    }
    let longest = |mesh: &Mesh| mesh.edges().map(|e| edge_length(mesh, e)).fold(0.0, f64::max);
    let sphere = solid(SolidName::Geodesic(3), SolidSize::Edge(Length::from_mm(7.0)));
    assert!((longest(&sphere.expect("a sphere")) - 7.0).abs() < 1e-14);
}

#[test]
fn sizes_and_edges_are_met() {
    for name in solid_names().filter(|name| !name.starts_with("box")) {
        assert!((size(&named(name)).max_element() - 100.0).abs() < 1e-13, "{name}");
    }
    let boxed = named("box-60x40x20");
    assert_eq!(size(&boxed), DVec3::new(60.0, 40.0, 20.0));
    assert_planar_and_centred("box", &boxed);
    assert!(boxed.vertices().all(|v| boxed.is_given(v)));
    assert_eq!(cuboid(DVec3::new(60.0, 40.0, 20.0)).bounds(), boxed.bounds());
    // A prism of squares is a cube parallel to the axes, to the last bit.
    assert_eq!(prism(4, 2.0).bounds(), cube(2.0).bounds());
}

#[test]
fn wrong_sizes_are_refused() {
    let mm = |mm| Some(Length::from_mm(mm));
    let make = |name: &str, edge, size| {
        solid(name.parse().expect(name), SolidSize::from_options(edge, size)?)
    };
    assert!(matches!(make("cube", mm(1.0), mm(2.0)), Err(ShapeError::EdgeAndSize { .. })));
    assert!(matches!(
        make("box-1x2x3", None, mm(2.0)),
        Err(ShapeError::BoxIsSized { what: "size", .. })
    ));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        assert!(
            matches!(make("cube", mm(bad), None), Err(ShapeError::Length { what: "edge", .. })),
            "{bad}"
        );
        assert!(
            matches!(make("cube", None, mm(bad)), Err(ShapeError::Length { what: "size", .. })),
            "{bad}"
        );
    }
    for name in [
        SolidName::Prism(2),
        SolidName::Geodesic(0),
        SolidName::Box([Length::from_mm(f64::NAN); 3]),
    ] {
        assert!(solid(name, SolidSize::Standard).is_err(), "{name}");
    }
    let error = make("cube", mm(0.0), None).expect_err("no edge");
    assert!(error.to_string().starts_with("the edge is 0mm; give a length above zero, like 40mm"));
}

proptest! {
    #[test]
    fn any_name_and_size_gives_a_sound_solid_or_an_error(index in 0_usize..40, n in 3_u32..40, exponent in -50_i32..50) {
        let names: Vec<&str> = solid_names().filter(|name| !name.starts_with("box")).collect();
        let name = names[index % names.len()].replace("-7", &format!("-{n}"));
        let edge = 10_f64.powi(exponent);
        let size = SolidSize::Edge(Length::from_mm(edge));
        let mesh = solid(name.parse().expect("listed"), size).expect("a solid");
        prop_assert!(mesh.faults().is_empty());
        prop_assert!(mesh.edges().all(|e| edge_length(&mesh, e) < edge * (1.0 + 1e-12)));
    }
}
