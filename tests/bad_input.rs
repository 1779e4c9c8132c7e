//! Every broken file gets a message that names the place and says what to do; no file brings the
//! readers down.

use std::path::{Path, PathBuf};

use kerfold::io::output::{OutputFolder, write_file};
use kerfold::io::{IoError, ReadOptions, read_mesh, read_mesh_bytes};
use kerfold::mesh::assert_sound;

/// File, how the message begins, and what it contains or advises.
const TABLE: &[(&str, &str, &[&str])] = &[
    ("degenerate-face.obj", ":6: face 0 has no area", &["remove it"]),
    ("empty.obj", " is empty", &["export the model again"]),
    ("empty.stl", " is empty", &["export the model again"]),
    (
        "flipped-face.obj",
        ":12: faces 0 and 3 run along",
        &["same direction", "turn one of them around", "line 9"],
    ),
    ("flipped-face.stl", ": faces 0 and 1 run along", &["turn one of them around"]),
    ("garbage.bin", ": unknown mesh format", &[".obj, .ply, .stl, .off or .3mf"]),
    ("garbage.obj", ": this is binary data, not OBJ text", &["check the file's type"]),
    ("garbage.off", ": this is binary data, not OFF text", &["check the file's type"]),
    ("garbage.ply", ":1: this is not PLY", &["check the file's type"]),
    (
        "garbage.stl",
        ": the header announces 1120141961 of `triangle`",
        &["only 516 bytes", "export the model again"],
    ),
    (
        "heights-gap.csv",
        ":4: column 3 is ``, not a number",
        &["first row is x and first column y", "rows x, y, z"],
    ),
    ("heights-twice.csv", ":5: x = 1, y = 0 stood in line 3 already", &["a whole grid"]),
    (
        "huge-count-ascii.ply",
        ": the header announces 4294967295 of `vertex`",
        &["28 bytes", "header is wrong"],
    ),
    (
        "huge-count-binary.ply",
        ": the header announces 4294967295 of `vertex`",
        &["49 bytes", "header is wrong"],
    ),
    (
        "index-out-of-range.obj",
        ":5: `f 3 2 9` names vertex 9, but the file has 3",
        &["correct the number"],
    ),
    (
        "index-out-of-range.off",
        ":6: face 0 names vertex 3, but there are only 3",
        &["correct the number"],
    ),
    (
        "index-out-of-range.ply",
        ":13: face 0 names vertex 7, but there are only 3",
        &["correct the number"],
    ),
    (
        "index-out-of-range-binary.ply",
        ": face 0 names vertex 7, but there are only 3",
        &["correct the number"],
    ),
    (
        "infinite.obj",
        ":3: vertex 2 has a coordinate that is not a finite number",
        &["inf", "correct it"],
    ),
    (
        "nan.obj",
        ":3: vertex 1 has a coordinate that is not a finite number",
        &["NaN", "correct it"],
    ),
    (
        "nan.off",
        ":4: vertex 1 has a coordinate that is not a finite number",
        &["NaN", "correct it"],
    ),
    (
        "nan.ply",
        ":11: vertex 1 has a coordinate that is not a finite number",
        &["NaN", "correct it"],
    ),
    (
        "nan-binary.ply",
        ": vertex 1 has a coordinate that is not a finite number",
        &["NaN", "correct it"],
    ),
    (
        "nan.stl",
        ": triangle 0 (counted from 0) has a coordinate that is not a finite number",
        &["correct it"],
    ),
    ("no-faces.obj", ": there are no faces", &["export the model as a polygon mesh"]),
    ("no-faces.off", ": there are no faces", &["export the model as a polygon mesh"]),
    ("no-faces.stl", ": there are no faces", &["export the model as a polygon mesh"]),
    ("repeated-corner.obj", ":5: face 0 visits vertex 1 twice", &["divide it"]),
    ("seam-off-edges.obj", ":17: the seam runs from vertex 1 to vertex 8", &["follow the edges"]),
    ("short.off", ": the file ends within `face` number 1 (of 2", &["export the model again"]),
    (
        "three-faces-at-edge.obj",
        ":8: the edge between vertices 0 and 1",
        &["(0, 1 and 2)", "remove", "lines 6 and 7"],
    ),
    (
        "torn.obj",
        ": the surface is torn: each of its 24 rim edges",
        &["vertices 3 and 9", "lines 5 and 13", "--weld 0"],
    ),
    ("truncated.ply", ": the file ends within `face` number 0 (of 1", &["export the model again"]),
    (
        "truncated.stl",
        ": the header announces 12 of `triangle`",
        &["only 480 bytes", "export the model again"],
    ),
    ("two-corners.obj", ":5: face 1 has 2 corners", &["remove it"]),
    ("word.obj", ":2: `v 10 zero 0` is not a vertex", &["as in `v 0 1.5 2`"]),
    (
        "zero-length-edge.obj",
        ":5: face 0 has an edge of length zero",
        &["weld them", "lines 2 and 3"],
    ),
];

fn bad(name: &str) -> PathBuf {
    Path::new("fixtures/bad").join(name)
}

fn names(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("fixtures");
    let mut names: Vec<_> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn every_broken_file_has_its_message() {
    let mut in_table: Vec<_> = TABLE.iter().map(|&(name, ..)| name).collect();
    in_table.sort_unstable();
    assert_eq!(in_table, names("fixtures/bad"));
    for &(name, start, parts) in TABLE {
        let path = bad(name);
        let message = read_mesh(&path, &ReadOptions::default()).expect_err(name).to_string();
        let start = format!("{}{start}", path.display());
        assert!(message.starts_with(&start), "{message}\n does not start with\n{start}");
        for part in parts {
            assert!(message.contains(part), "{message}\n lacks\n{part}");
        }
        assert!(!message.contains('\n') && message.len() < 300, "{message}");
    }
}

#[test]
fn folders_and_missing_files_are_named() {
    let message =
        |path: &Path| read_mesh(path, &ReadOptions::default()).expect_err("unreadable").to_string();
    assert_eq!(message(Path::new("fixtures/bad")), "fixtures/bad is a folder; name a file");
    let missing = "there is no file fixtures/bad/missing.obj; check the name and the folder";
    assert_eq!(message(&bad("missing.obj")), missing);
    assert!(message(&bad("torn.obj/x.obj")).contains("check"));
}

#[test]
fn a_folder_that_cannot_be_made_is_named_and_nothing_is_left() {
    let before = names("fixtures/bad");
    let mut folder = OutputFolder::new(bad("torn.obj").join("sheets"));
    folder.add("sheet-01.svg", "<svg/>");
    let message = folder.commit().expect_err("a file is in the way").to_string();
    assert_eq!(
        message,
        "cannot write into fixtures/bad/torn.obj/sheets: fixtures/bad/torn.obj is a file, not a \
        folder; choose another place"
    );
    let message = write_file(&bad("none/x.obj"), b"x").expect_err("no folder").to_string();
    assert_eq!(
        message,
        "cannot write fixtures/bad/none/x.obj: there is no folder fixtures/bad/none; make it first"
    );
    assert!(matches!(write_file(Path::new("fixtures/bad"), b"x"), Err(IoError::IsFolder { .. })));
    assert_eq!(names("fixtures/bad"), before);
}

/// Cuts and changes good files in many ways: an error or a sound mesh, never a panic.
#[test]
fn damaged_files_never_panic() {
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for name in names("fixtures/meshes").into_iter().filter(|name| name.starts_with("cube")) {
        let path = Path::new("fixtures/meshes").join(&name);
        let whole = std::fs::read(&path).expect("a fixture");
        for round in 0..1500 {
            let mut bytes = whole.clone();
            if round % 4 == 0 {
                bytes.truncate(random(whole.len()));
            }
            for _ in 0..1 + random(3) {
                if !bytes.is_empty() {
                    let at = random(bytes.len());
                    bytes[at] = if round % 2 == 0 {
                        random(256) as u8
                    } else {
                        b"0123456789 -.#/\\e\n"[random(18)]
                    };
                }
            }
            if let Ok(read) = read_mesh_bytes(&path, &bytes, &ReadOptions::default()) {
                assert_sound(&read.mesh);
            }
        }
    }
}
