//! Good mesh files: the bundled ones in every format, and the real models where they are at hand.

use std::path::Path;

use kerfold::io::{
    MeshFormat, ReadMesh, ReadNote, ReadOptions, WriteOptions, mesh_bytes, read_mesh,
    read_mesh_bytes,
};
use kerfold::measure;
use kerfold::mesh::assert_sound;
use kerfold::units::Length;

fn read(path: &Path) -> ReadMesh {
    let read = read_mesh(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_sound(&read.mesh);
    read
}

#[test]
fn the_cube_is_the_same_in_every_format() {
    let folder = Path::new("fixtures/meshes");
    let files =
        ["cube.obj", "cube.off", "cube-ascii.ply", "cube-little-endian.ply", "cube-big-endian.ply"];
    let reference = read(&folder.join("cube.obj"));
    for name in files {
        let cube = read(&folder.join(name));
        assert!(cube.notes.is_empty() && cube.scale == 1.0);
        let corners = |read: &ReadMesh| -> Vec<_> {
            read.mesh.faces().map(|f| read.mesh.face_positions(f)).collect()
        };
        assert_eq!(corners(&cube), corners(&reference), "{name}");
    }
    for name in ["cube-ascii.stl", "cube-binary.stl"] {
        let cube = read(&folder.join(name)).mesh;
        assert_eq!((cube.vertex_count(), cube.face_count(), cube.is_closed()), (8, 12, true));
        assert_eq!(measure::volume(&cube), 1000.0);
    }
    for (name, scale) in [("cube.glb", 1000.0), ("cube.3mf", 1.0)] {
        let read = read(&folder.join(name));
        let cube = &read.mesh;
        assert_eq!((cube.vertex_count(), cube.face_count(), cube.is_closed()), (8, 12, true));
        assert!((measure::volume(cube) - 1000.0).abs() < 1e-3, "{name}");
        assert!(cube.faces().all(|f| cube.group(f) == Some("cube")), "{name}");
        let (low, high) = cube.bounds().expect("points");
        let (want_low, want_high) = reference.mesh.bounds().expect("points");
        assert!(low.distance(want_low) < 1e-4 && high.distance(want_high) < 1e-4, "{name}");
        assert_eq!((read.scale, read.notes.len()), (scale, 0), "{name}: {:?}", read.notes);
    }
    let mesh = &reference.mesh;
    let groups: Vec<_> = mesh.faces().map(|f| mesh.group(f).unwrap_or_default()).collect();
    assert_eq!(groups, ["caps", "caps", "walls", "walls", "walls", "walls"]);
    assert_eq!(mesh.edges().filter(|&e| mesh.is_seam(e)).count(), 3);
}

#[test]
fn spot_comes_back_digit_by_digit() {
    let path = Path::new("fixtures/meshes/spot.obj");
    let spot = read(path);
    assert_eq!(
        (spot.mesh.vertex_count(), spot.mesh.face_count(), spot.mesh.is_closed()),
        (2930, 5856, true)
    );
    assert!(spot.notes.is_empty(), "{:?}", spot.notes);
    let written =
        mesh_bytes(MeshFormat::Obj, &spot.mesh, &WriteOptions::default()).expect("written");
    let original = std::fs::read(path).expect("the file");
    assert!(statements(&written) == statements(&original), "positions or faces have changed");
}

/// The numbers of all `v` and `f` lines in their order, as bits; texture coordinates are left out.
fn statements(text: &[u8]) -> Vec<Vec<u64>> {
    let text = std::str::from_utf8(text).expect("text");
    let number = |word: &str| {
        word.split('/').next().and_then(|n| n.parse::<f64>().ok()).expect("a number").to_bits()
    };
    let lines = text.lines().filter(|line| line.starts_with("v ") || line.starts_with("f "));
    lines.map(|line| line.split_whitespace().skip(1).map(number).collect()).collect()
}

#[test]
fn a_real_model_is_scaled_to_the_size_asked_for() {
    let options = ReadOptions { size: Some(Length::from_mm(300.0)), ..ReadOptions::default() };
    let spot = read_mesh(Path::new("fixtures/meshes/spot.obj"), &options).expect("spot");
    assert!((measure::size(&spot.mesh).max_element() - 300.0).abs() < 1e-9);
    let plain = read(Path::new("fixtures/meshes/spot.obj"));
    assert_eq!(spot.scale, 300.0 / measure::size(&plain.mesh).max_element());
}

#[test]
fn groups_and_digits_go_through_a_3mf_and_triangles_merge_again() {
    let mut mesh = kerfold::shape::soccer_ball(7.1);
    let faces: Vec<_> = mesh.faces().collect();
    for &f in &faces[..12] {
        mesh.set_group(f, "tops & \"tails\"");
    }
    let bytes = mesh_bytes(MeshFormat::ThreeMf, &mesh, &WriteOptions::default()).expect("written");
    let again = mesh_bytes(MeshFormat::ThreeMf, &mesh, &WriteOptions::default()).expect("written");
    assert!(bytes == again, "the same mesh gives the same bytes");
    let options = ReadOptions { merge_flat: Some(Length::from_mm(1e-6)), ..ReadOptions::default() };
    let merged = read_mesh_bytes(Path::new("a.3mf"), &bytes, &options).expect("read");
    assert_eq!(merged.mesh.counts(), mesh.counts());
    let plain = read_mesh_bytes(Path::new("a.3mf"), &bytes, &ReadOptions::default()).expect("read");
    for v in mesh.vertices() {
        assert_eq!(plain.mesh.position(v), mesh.position(v));
    }
    let named = |mesh: &kerfold::mesh::Mesh, name: Option<&str>| -> f64 {
        let of = mesh.faces().filter(|&f| mesh.group(f) == name);
        of.map(|f| measure::face_area(mesh, f)).sum()
    };
    for name in [Some("tops & \"tails\""), None] {
        let (wanted, found) = (named(&mesh, name), named(&plain.mesh, name));
        assert!((wanted - found).abs() < 1e-9 * wanted && wanted > 0.0, "{name:?}");
    }
    let error =
        mesh_bytes(MeshFormat::Glb, &mesh, &WriteOptions::default()).expect_err("read only");
    assert!(error.to_string().contains("not written"), "{error}");
}

/// Only where the collection of real models stands beside the project.
#[test]
fn the_collection_of_real_models_is_read() {
    let folder = Path::new("../shared/models");
    if !folder.is_dir() {
        return;
    }
    for (name, vertices, faces) in
        [("cow", 2903, 5804), ("fandisk", 6475, 12946), ("spot", 2930, 5856)]
    {
        let model = read(&folder.join(format!("{name}.obj")));
        assert_eq!(
            (model.mesh.vertex_count() - model.splits.len(), model.mesh.face_count()),
            (vertices, faces),
            "{name}"
        );
        assert!(model.mesh.is_closed(), "{name}");
    }
    let teapot = read(&folder.join("teapot.obj"));
    assert_eq!(teapot.mesh.face_count(), 6320);
    assert!(!teapot.mesh.is_closed());
    assert!(
        teapot.notes.iter().any(|n| matches!(n, ReadNote::CoincidentRims { .. })),
        "{:?}",
        teapot.notes
    );
}

#[test]
fn a_name_without_extension_is_told_by_its_content() {
    for name in [
        "cube.obj",
        "cube.off",
        "cube-ascii.ply",
        "cube-big-endian.ply",
        "cube-ascii.stl",
        "cube-binary.stl",
        "cube.glb",
        "cube.3mf",
    ] {
        let bytes = std::fs::read(Path::new("fixtures/meshes").join(name)).expect("a fixture");
        let cube = read_mesh_bytes(Path::new("cube"), &bytes, &ReadOptions::default()).expect(name);
        assert!(cube.mesh.is_closed(), "{name}");
    }
}
