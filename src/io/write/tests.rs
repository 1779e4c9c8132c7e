use super::*;
use crate::io::{ReadOptions, read_mesh_bytes};
use crate::measure;
use crate::mesh::{FaceId, VertexId, assert_sound};
use glam::DVec3;
use proptest::prelude::*;

/// A prism over an L, with a group for the two caps and a seam, and an unused vertex in front.
fn ell() -> Mesh {
    let floor = [(0.1, 0.2), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let at = |z: f64| floor.map(|(x, y)| DVec3::new(x, y, z));
    let points = [DVec3::ZERO].into_iter().chain(at(0.0)).chain(at(1.0 / 3.0));
    let mut faces: Vec<Vec<usize>> = vec![(1..7).rev().collect(), (7..13).collect()];
    faces.extend((0..6).map(|i| vec![1 + i, 1 + (i + 1) % 6, 7 + (i + 1) % 6, 7 + i]));
    let mut mesh = Mesh::from_faces(points, faces).expect("a prism");
    mesh.set_group(FaceId::new(0), "caps and more");
    mesh.set_group(FaceId::new(1), "caps and more");
    mesh.set_group(FaceId::new(7), "last");
    let seam = mesh.edge_between(VertexId::new(1), VertexId::new(7)).expect("an edge");
    mesh.set_seam(seam, true);
    mesh
}

fn reread(format: MeshFormat, name: &str, mesh: &Mesh, options: &WriteOptions) -> Mesh {
    let bytes = mesh_bytes(format, mesh, options).expect("written");
    let read =
        read_mesh_bytes(Path::new(name), &bytes, &ReadOptions::default()).expect("read back");
    assert_sound(&read.mesh);
    assert!(read.notes.is_empty(), "{:?}", read.notes);
    read.mesh
}

/// Positions, faces with groups, and seams, all by the order of the elements.
type Content = (Vec<DVec3>, Vec<(Vec<usize>, Option<String>)>, Vec<[usize; 2]>);

fn content(mesh: &Mesh) -> Content {
    let order: Vec<VertexId> = mesh.vertices().collect();
    let place = |v: VertexId| order.binary_search(&v).expect("a vertex of the mesh");
    let face = |f| (mesh.face_vertices(f).map(place).collect(), mesh.group(f).map(str::to_owned));
    let seams = mesh.edges().filter(|&e| mesh.is_seam(e)).map(|e| mesh.edge_vertices(e).map(place));
    (
        order.iter().map(|&v| mesh.position(v)).collect(),
        mesh.faces().map(face).collect(),
        seams.collect(),
    )
}

#[test]
fn an_obj_comes_back_as_it_was_and_byte_for_byte() {
    let mesh = ell();
    let options =
        WriteOptions { command: Some("kerfold x\n -o y".into()), ..WriteOptions::default() };
    let back = reread(MeshFormat::Obj, "a.obj", &mesh, &options);
    assert_eq!(content(&back), content(&mesh));
    let bytes = |mesh| mesh_bytes(MeshFormat::Obj, mesh, &options).expect("written");
    assert_eq!(bytes(&back), bytes(&mesh));
    let text = String::from_utf8(bytes(&mesh)).expect("text");
    assert!(text.starts_with("# kerfold x  -o y\n# units: mm\nv 0.1 0.2 0\nv 2 0 0\n"), "{text}");
    assert!(text.contains("v 0.1 0.2 0.3333333333333333\n"), "{text}");
    assert!(
        text.contains("g caps and more\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\ng default\nf 1 2 8 7\n"),
        "{text}"
    );
    assert!(text.ends_with("g seam\nl 7 1\n"), "{text}");
}

#[test]
fn ply_and_off_keep_every_digit_and_the_order() {
    let mesh = ell();
    let (positions, faces, _) = content(&mesh);
    let plain: Vec<_> = faces.into_iter().map(|(corners, _)| (corners, None)).collect();
    let command = Some("kerfold made this".to_owned());
    for ply in [PlyEncoding::Text, PlyEncoding::BinaryLittleEndian, PlyEncoding::BinaryBigEndian] {
        let back = reread(
            MeshFormat::Ply,
            "a.ply",
            &mesh,
            &WriteOptions { command: command.clone(), ply, made: None },
        );
        assert_eq!(content(&back), (positions.clone(), plain.clone(), vec![]));
    }
    let back = reread(
        MeshFormat::Off,
        "a.off",
        &mesh,
        &WriteOptions { command, ..WriteOptions::default() },
    );
    assert_eq!(content(&back), (positions, plain, vec![]));
}

#[test]
fn an_stl_encloses_the_same_volume_even_when_faces_are_concave() {
    let mesh = ell();
    let back = reread(MeshFormat::Stl, "a.stl", &mesh, &WriteOptions::default());
    assert!(back.is_closed());
    assert_eq!((back.vertex_count(), back.face_count()), (12, 2 * 4 + 6 * 2));
    let error = measure::volume(&back) - measure::volume(&mesh);
    assert!(error.abs() < 1e-6, "{error}");
    assert!((measure::surface_area(&back) - measure::surface_area(&mesh)).abs() < 1e-6);
    let long = WriteOptions { command: Some("solid ä".repeat(30)), ..WriteOptions::default() };
    reread(MeshFormat::Stl, "a.stl", &mesh, &long);
    let far = Mesh::from_faces([DVec3::ZERO, DVec3::X * 1e39, DVec3::Y], [[0, 1, 2]])
        .expect("a triangle");
    let error = mesh_bytes(MeshFormat::Stl, &far, &WriteOptions::default()).expect_err("too far");
    assert!(matches!(error, IoError::TooFarForStl { vertex: 1 }));
}

#[test]
fn loops_two_gons_and_holes_are_not_written() {
    let mut mesh =
        Mesh::from_faces([DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]]).expect("a triangle");
    let h = mesh.face_half_edges(FaceId::new(0)).next().expect("an edge");
    let at = crate::mesh::Corner::At;
    // A second edge beside the first makes a 2-gon, a loop at its end repeats a corner.
    mesh.insert_edge(at(h), at(mesh.next(h))).expect("an edge");
    let corner = mesh.face_half_edges(FaceId::new(0)).next().expect("an edge");
    mesh.insert_edge(at(corner), at(corner)).expect("a loop");
    let text = String::from_utf8(
        mesh_bytes(MeshFormat::Obj, &mesh, &WriteOptions::default()).expect("written"),
    );
    let text = text.expect("text");
    assert_eq!(text.matches("\nf ").count(), 1, "{text}");
    let back = reread(MeshFormat::Obj, "a.obj", &mesh, &WriteOptions::default());
    assert_eq!((back.face_count(), back.hole_count()), (1, 1));
}

#[test]
fn an_unknown_extension_is_refused() {
    let error =
        write_mesh(Path::new("a.step"), &ell(), &WriteOptions::default()).expect_err("unknown");
    assert_eq!(
        error.to_string(),
        "a.step: unknown mesh format; use a name that ends in .obj, .ply, .stl, .off or .3mf \
         (or .glb, or .csv for a grid of heights, which are read, or .dxf, which is written)"
    );
}

proptest! {
    #[test]
    fn every_number_comes_back(bits in prop::array::uniform9(any::<u64>())) {
        let numbers = bits.map(|b| Some(f64::from_bits(b)).filter(|x| x.is_finite()).unwrap_or(0.5));
        let points = numbers.chunks(3).map(DVec3::from_slice);
        // Any three points that make a triangle.
        if let Ok(mesh) = Mesh::from_faces(points, [[0, 1, 2]]) {
            for (format, name) in [(MeshFormat::Obj, "a.obj"), (MeshFormat::Ply, "a.ply"), (MeshFormat::Off, "a.off")] {
                let back = reread(format, name, &mesh, &WriteOptions::default());
                prop_assert_eq!(content(&back).0, content(&mesh).0);
            }
        }
    }
}
