//! One tetrahedron in the spellings of many programs: read alike, and whatever was not plain is
//! said.

use std::path::Path;

use kerfold::code::Coded;
use kerfold::io::{ReadMesh, ReadNote, ReadOptions, read_mesh_bytes};
use kerfold::measure::{surface_area, volume};
use kerfold::mesh::assert_sound;
use kerfold::progress::Silent;
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, unfold};

fn read(name: &str, bytes: &[u8]) -> ReadMesh {
    read_mesh_bytes(Path::new(name), bytes, &ReadOptions::default())
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Corners at the origin and 30 mm along each axis, whatever the spelling.
fn is_tetrahedron(what: &str, read: &ReadMesh) {
    assert_sound(&read.mesh);
    assert_eq!((read.mesh.vertex_count(), read.mesh.face_count()), (4, 4), "{what}");
    assert_eq!(volume(&read.mesh), 4500.0, "{what}");
}

const OBJ: &str = "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const OFF: &str = "OFF\n4 4 6\n0 0 0\n30 0 0\n0 30 0\n0 0 30\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n30 0 0\n0 30 0\n0 0 30\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

fn stl() -> String {
    let p = ["0 0 0", "30 0 0", "0 30 0", "0 0 30"];
    let facet = |[a, b, c]: [usize; 3]| {
        let vertices = [a, b, c].map(|i| format!("vertex {}\n", p[i])).concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet).concat();
    format!("solid x\n{facets}endsolid x\n")
}

fn utf16(text: &str) -> Vec<u8> {
    format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect()
}

#[test]
fn the_dialects_of_other_programs_are_read_without_a_word() {
    let stl = stl();
    let files: Vec<(&str, Vec<u8>)> = vec![
        ("plain.obj", OBJ.into()),
        ("marked.obj", format!("\u{feff}{OBJ}").into()),
        ("wide.obj", utf16(OBJ)),
        ("padded.obj", format!("{OBJ}\0\0\0\x1a").into()),
        ("comment.obj", OBJ.replace("f 1 3 2", "# floor \\\nf 1 3 2").into()),
        ("path.obj", OBJ.replace("f 1 3 2", "usemtl C:\\floor\\\nf 1 3 2").into()),
        ("one.obj", OBJ.replace(" 0\n", " 0 1.0\n").into()),
        ("old.obj", OBJ.replace("f ", "fo ").into()),
        ("plain.off", OFF.into()),
        ("glued.off", OFF.replace("OFF\n", "OFF").into()),
        ("wide.off", utf16(OFF)),
        ("lines.off", OFF.replace(" 0\n", "\n0\n").into()),
        ("row.off", OFF.replace('\n', " ").into()),
        ("colours.off", OFF.replace("OFF", "COFF").replace("3 1 2 3\n", "3 1 2 3 9 9 9\n").into()),
        ("plain.stl", stl.clone().into()),
        ("apart.stl", stl.replace("endloop", "end loop").replace("endfacet", "end facet").into()),
        ("end.stl", stl.replace("endsolid x", "end solid").into()),
        ("marked.stl", format!("\u{feff}{stl}").into()),
        ("wide.stl", utf16(&stl)),
        ("padded.stl", format!("{stl}\0\0\0").into()),
        ("bare.stl", stl.replacen("solid x\n", "", 1).into()),
        ("plain.ply", PLY.into()),
        ("marked.ply", format!("\u{feff}{PLY}").into()),
        ("wide.ply", utf16(PLY)),
        ("row.ply", PLY.replace("30\n3", "30 3").into()),
    ];
    for (name, bytes) in files {
        let read = read(name, &bytes);
        is_tetrahedron(name, &read);
        assert_eq!(read.notes, [], "{name}");
    }
}

#[test]
fn what_is_read_otherwise_than_it_stands_is_said() {
    let faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let corners = PLY.replace("3 0 2 1\n", "3 0 2 1 255 0 0\n");
    let files: Vec<(&str, String, ReadNote)> = vec![
        (
            "commas.obj",
            OBJ.replace("30", "30,0"),
            ReadNote::DecimalCommas { count: 3, first_line: 2 },
        ),
        (
            "weights.obj",
            format!("v 0 0 0 2\nv 60 0 0 2\nv 0 30 0\nv 0 0 15 0.5\n{faces}"),
            ReadNote::Weights { count: 3, first: 0 },
        ),
        (
            "wires.obj",
            format!("{OBJ}l 1 2\np 3\n"),
            ReadNote::PassedOver { count: 2, first_line: 9 },
        ),
        (
            "quads.obj",
            OBJ.replace("f 2 3 4", "f 2 3 4 4"),
            ReadNote::RepeatedCorners { count: 1, first: 3 },
        ),
        (
            "commas.off",
            OFF.replace("30 0", "30,0 0"),
            ReadNote::DecimalCommas { count: 2, first_line: 4 },
        ),
        ("more.off", format!("{OFF}3 0 2 1\n"), ReadNote::Rest { bytes: 7 }),
        ("columns.ply", corners, ReadNote::ExtraColumns { count: 1, first_line: 14 }),
        (
            "note.ply",
            PLY.replace("element vertex", "comment\nCreated by hand\nelement vertex"),
            ReadNote::PassedOver { count: 1, first_line: 4 },
        ),
    ];
    for (name, text, note) in files {
        let read = read(name, text.as_bytes());
        is_tetrahedron(name, &read);
        assert_eq!(read.notes, [note], "{name}");
    }
}

#[test]
fn strips_are_triangles_in_text_and_in_binary() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
            property float z\nelement tristrips 1\nproperty list int int vertex_indices\n\
            end_header\n"
        )
    };
    let strip = [0, 2, 1, 3, -1, 0, 3, 2, -1, 0, 1, 3];
    let numbers = strip.map(|v| v.to_string()).join(" ");
    let text = format!("{}0 0 0 30 0 0 0 30 0 0 0 30\n12 {numbers}\n", header("ascii"));
    is_tetrahedron("text", &read("strip.ply", text.as_bytes()));
    let mut binary = header("binary_little_endian").into_bytes();
    for x in [0, 0, 0, 30, 0, 0, 0, 30, 0, 0, 0, 30] {
        binary.extend((x as f32).to_le_bytes());
    }
    binary.extend(12_i32.to_le_bytes());
    binary.extend(strip.iter().flat_map(|v: &i32| v.to_le_bytes()));
    is_tetrahedron("binary", &read("strip.ply", &binary));
}

#[test]
fn a_face_around_a_hole_is_divided_and_its_group_goes_with_it() {
    let text = "v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 0\nv 20 20 0\nv 20 40 0\nv 40 40 0\nv 40 20 0\n\
        v 30 30 90\ng plate\nf 1 2 3 4 1 5 6 7 8 5\ng cone\nf 5 8 9\nf 8 7 9\nf 7 6 9\nf 6 5 9\n";
    for name in ["plate.obj", "plate.off"] {
        let text = match name {
            "plate.obj" => text.to_owned(),
            _ => "OFF 9 5 0\n0 0 0\n60 0 0\n60 60 0\n0 60 0\n20 20 0\n20 40 0\n40 40 0\n40 20 0\n\
                30 30 90\n10 0 1 2 3 0 4 5 6 7 4\n3 4 7 8\n3 7 6 8\n3 6 5 8\n3 5 4 8\n"
                .to_owned(),
        };
        let read = read(name, text.as_bytes());
        assert_sound(&read.mesh);
        assert_eq!(read.notes, [ReadNote::DividedFaces { count: 1, first: 0 }], "{name}");
        // The plate alone: all of it but the square hole, which the cone stands over.
        let flat =
            read.mesh.faces().filter(|&f| read.mesh.face_positions(f).iter().all(|p| p.z == 0.0));
        let flat: Vec<_> = flat.collect();
        let area: f64 = flat.iter().map(|&f| kerfold::measure::face_area(&read.mesh, f)).sum();
        assert!((area - 3200.0).abs() < 1e-9, "{name}: {area}");
        assert_eq!(read.mesh.hole_count(), 1, "{name}");
        if name == "plate.obj" {
            assert!(flat.iter().all(|&f| read.mesh.group(f) == Some("plate")));
            let cone = read.mesh.faces().filter(|&f| read.mesh.group(f) == Some("cone"));
            assert_eq!(cone.count(), 4);
        }
        assert!(surface_area(&read.mesh) > 3200.0);
    }
}

/// A corner 1e-17 off an edge, as Boolean operations write it: the face is called without area, at
/// any scale, and nobody is asked to report a fault of the program.
#[test]
fn a_sliver_is_a_face_without_area() {
    let text = "v 0.0 0.0 0.0\nv 0.6897672259185221 0.5968395439492737 -0.40988258419587603\n\
        v -0.6504469675848901 0.7594679082995816 0.01128000987052713\n\
        v 0.3180250248145378 0.25882630283933894 0.9120685437784988\n\
        v 0.28738081251979747 0.2486639356569665 -0.17077121912695695\n\
        f 1 3 5\nf 3 2 5\nf 1 5 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    for size in [1e-3, 1.0, 1e5] {
        let length = kerfold::units::Length::from_mm(size);
        let options = ReadOptions { size: Some(length), ..ReadOptions::default() };
        let read = read_mesh_bytes(Path::new("x.obj"), text.as_bytes(), &options).expect("a mesh");
        let (params, source) = (UnfoldParams::default(), MeshSource::default());
        let error =
            unfold(&read.mesh, &Seams::Free, &params, &source, &Silent).expect_err("no area");
        assert_eq!(error.code().to_string(), "E422", "{size}: {error}");
    }
}
