use serde_json::{Value, json};

use super::*;
use crate::io::glb::{GlbNode, GlbScene, GlbSurface, glb_bytes};
use crate::io::{ReadMesh, ReadOptions, read_mesh_bytes};
use crate::units::Length;

fn file(text: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = text.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |n: usize| (n as u32).to_le_bytes();
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let header = [*b"glTF", word(2), word(total), word(text.len()), *b"JSON"].concat();
    [&header, &*text, &word(binary.len()), b"BIN\0", binary].concat()
}

/// A corner of a cube of 1 m: three quads as strips and fans, with corners of their own.
fn corner() -> (Value, Vec<u8>) {
    let points: [[f32; 3]; 12] = [
        [0., 0., 0.],
        [0., 0., 1.],
        [1., 0., 0.],
        [1., 0., 1.],
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 0.],
        [0., 1., 0.],
        [0., 1., 1.],
        [0., 0., 1.],
    ];
    let mut binary: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    binary.extend([0, 1, 2, 2, 1, 3, 0, 0]);
    let at = |first: usize| json!({ "bufferView": 0, "byteOffset": 48 * first, "componentType": 5126, "count": 4, "type": "VEC3" });
    let value = json!({
        "asset": { "version": "2.0" },
        "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "house", "mesh": 0 }],
        "materials": [{ "name": "red" }, { "name": "blue" }],
        "meshes": [{ "primitives": [
            { "attributes": { "POSITION": 0 }, "indices": 3, "material": 0 },
            { "attributes": { "POSITION": 1 }, "mode": 6, "material": 1 },
            { "attributes": { "POSITION": 2 }, "mode": 6 },
            { "attributes": { "POSITION": 2 }, "mode": 2 },
        ] }],
        "accessors": [
            at(0), at(1), at(2),
            { "bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 144 }, { "buffer": 0, "byteOffset": 144, "byteLength": 8 },
        ],
        "buffers": [{ "byteLength": 152 }],
        "animations": [{}],
    });
    (value, binary)
}

fn taken(text: &Value, binary: &[u8], options: &ReadOptions) -> Result<ReadMesh, String> {
    let path = std::path::Path::new("x.glb");
    read_mesh_bytes(path, &file(text, binary), options).map_err(|error| error.to_string())
}

#[test]
fn triangles_of_every_kind_are_welded_turned_upright_and_in_millimetres() {
    let (text, binary) = corner();
    let read = taken(&text, &binary, &ReadOptions::default()).expect("a corner");
    let mesh = &read.mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count(), read.scale), (7, 6, 1000.0));
    let bounds = mesh.bounds().expect("points");
    assert_eq!(bounds, (DVec3::new(0.0, -1000.0, 0.0), DVec3::new(1000.0, 0.0, 1000.0)));
    let groups: Vec<_> = mesh.faces().map(|f| mesh.group(f).unwrap_or("-")).collect();
    assert_eq!(groups, ["red", "red", "blue", "blue", "house", "house"]);
    let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|note| note.contains(LINES)), "{notes:?}");
    assert!(notes.iter().any(|note| note.contains(ANIMATIONS)), "{notes:?}");
    let inches = ReadOptions { units: crate::io::MeshUnit::In, ..ReadOptions::default() };
    let read = taken(&text, &binary, &inches).expect("a corner");
    assert!(read.scale == 1000.0 && read.notes.contains(&ReadNote::OwnUnit { unit: "m" }));
    let sized = ReadOptions { size: Some(Length::from_mm(50.0)), ..inches };
    let read = taken(&text, &binary, &sized).expect("a corner");
    assert!(read.scale == 50.0 && !read.notes.contains(&ReadNote::OwnUnit { unit: "m" }));
}

#[test]
fn nodes_are_placed_by_their_parents_and_mirrored_ones_stay_right_side_out() {
    let (mut text, binary) = corner();
    text["scenes"] = json!([{ "nodes": [1, 2] }]);
    text["nodes"] = json!([
        { "name": "a", "mesh": 0 },
        { "children": [0], "translation": [2, 0, 0], "rotation": [0, 0.5f32.sqrt(), 0, 0.5f32.sqrt()] },
        { "name": "b", "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1] },
    ]);
    let read = taken(&text, &binary, &ReadOptions::default()).expect("two corners");
    let mesh = &read.mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (14, 12));
    let (low, high) = mesh.bounds().expect("points");
    let (want_low, want_high) = (DVec3::new(-1000., -1000., 0.), DVec3::new(3000., 1000., 6000.));
    assert!(low.distance(want_low) < 1e-3 && high.distance(want_high) < 1e-3, "{low} {high}");
    let turn = |f: usize| mesh.plane(crate::mesh::FaceId::new(f)).expect("a plane").normal();
    // The walls of both look into their rooms, of which the second is the mirror image.
    let wanted = [DVec3::Z, DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X];
    for (wall, wanted) in (0..).zip(wanted) {
        assert!(turn(2 * wall).distance(wanted) < 1e-6, "wall {wall}: {}", turn(2 * wall));
    }
}

#[test]
fn what_is_written_as_glb_is_read_again() {
    let ball = crate::shape::soccer_ball(20.0);
    let mut scene = GlbScene::new("ball");
    let points: Vec<DVec3> = ball.vertices().map(|v| ball.position(v)).collect();
    let fan = |f| {
        let v: Vec<u32> = ball.face_vertices(f).map(|v| v.index() as u32).collect();
        (2..v.len()).map(|i| [v[0], v[i - 1], v[i]]).collect::<Vec<_>>()
    };
    scene.add_node(GlbNode {
        name: "P01".to_owned(),
        parent: None,
        translation: DVec3::new(100.0, 0.0, 7.0),
        rotation: DQuat::from_rotation_x(0.3),
        surface: Some(GlbSurface {
            points,
            triangles: ball.faces().flat_map(fan).collect(),
            ..GlbSurface::default()
        }),
        extras: Vec::new(),
    });
    let bytes = glb_bytes(&scene, "kerfold").expect("a scene");
    let path = std::path::Path::new("no ending");
    let read = read_mesh_bytes(path, &bytes, &ReadOptions::default()).expect("a ball");
    assert!(read.mesh.is_closed() && read.mesh.vertex_count() == ball.vertex_count());
    assert!(read.mesh.faces().all(|f| read.mesh.group(f) == Some("P01")));
    let wanted = crate::measure::volume(&ball);
    assert!((crate::measure::volume(&read.mesh) - wanted).abs() < 1e-5 * wanted);
    let middle = read.mesh.bounds().map(|(low, high)| low.midpoint(high)).expect("points");
    assert!(middle.distance(DVec3::new(100.0, 0.0, 7.0)) < 1e-3, "{middle}");
}

#[test]
fn damaged_files_are_told_what_is_wrong() {
    let (good, binary) = corner();
    let changed = |pointer: &str, value: Value| {
        let mut text = good.clone();
        *text.pointer_mut(pointer).expect(pointer) = value;
        taken(&text, &binary, &ReadOptions::default()).expect_err(pointer)
    };
    for (pointer, value, told) in [
        ("/scene", json!(3), "scene 3 is not there"),
        ("/scenes/0/nodes", json!([7]), "node 7 is not there"),
        ("/scenes/0/nodes", json!([0, 0]), "hangs on two others"),
        ("/nodes/0/mesh", json!(9), "mesh 9 is not there"),
        ("/meshes/0/primitives/0/indices", json!(9), "accessor 9 is not there"),
        ("/accessors/0/count", json!(2), "names vertex 2 of 2"),
        ("/accessors/0/count", json!(1_000_000_000_000_u64), "reaches beyond its bytes"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "reaches beyond its bytes"),
        ("/accessors/0/type", json!("VEC2"), "holds no points"),
        ("/accessors/3/componentType", json!(5126), "holds no numbers of vertices"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "reaches beyond its bytes"),
        ("/bufferViews/0/buffer", json!(1), "in another file"),
        ("/buffers/0", json!({ "uri": "x.bin" }), "in another file"),
        ("/meshes/0/primitives/1/mode", json!(7), "kind 7"),
        ("/nodes", json!("none"), "JSON cannot be read"),
    ] {
        let error = changed(pointer, value);
        assert!(error.contains(told), "{pointer}: {error}");
    }
    let mut packed = good.clone();
    packed["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let error = taken(&packed, &binary, &ReadOptions::default()).expect_err("packed");
    assert!(error.contains("KHR_draco_mesh_compression"), "{error}");
    let whole = file(&good, &binary);
    for cut in 1..whole.len() {
        assert!(read(&whole[..cut]).is_err(), "{cut}");
    }
    let mut longer = whole.clone();
    longer.extend(*b"xx");
    let notes = read(&longer).expect("all there").notes;
    assert!(notes.contains(&ReadNote::Rest { bytes: 2 }));
}

#[test]
fn one_mesh_in_many_places_is_bounded() {
    let (mut text, mut binary) = corner();
    // One point many times over costs 20 bytes of JSON for each of its places.
    binary.truncate(144);
    binary.extend(std::iter::repeat_n(0, 3_000_000));
    text["accessors"][3]["count"] = json!(3_000_000);
    text["bufferViews"][1]["byteLength"] = json!(3_000_000);
    let nodes: Vec<Value> = (0..9).map(|_| json!({ "mesh": 0 })).collect();
    text["nodes"] = json!(nodes);
    text["scenes"] = json!([{ "nodes": (0..9).collect::<Vec<_>>() }]);
    let error = read(&file(&text, &binary)).expect_err("too much");
    assert_eq!(error.fault, ContentFault::TooMuchMesh { most: MOST });
}
