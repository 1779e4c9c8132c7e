//! `dform`, of a name, a file and standard input, and of outlines.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, piped, run};

#[test]
fn a_d_form_of_a_named_solid_is_two_pieces_that_verify() {
    let folder = Folder::new("dform");
    let out = folder.path("out");
    let ran =
        run(&["dform", "dodecahedron", "--size", "18cm", "--rounds", "2", "-o", &out, "--json"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(told["fabrication"]["pieces"], 2);
    let [pieces, model] = ["out/pieces.json", "out/model.obj"].map(|name| folder.path(name));
    let ran = run(&["verify", &pieces, &model]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "{}", ran.out);
    assert!(
        ran.out.contains("pass") && ran.out.contains("0 overlaps") && ran.out.contains("1e-9"),
        "{}",
        ran.out
    );
    let misspelt = run(&["dform", "dodecahedrn", "-o", &out]);
    assert!(
        misspelt.code == Some(2) && misspelt.err.contains("did you mean `dodecahedron`?"),
        "{}",
        misspelt.err
    );
}

#[test]
fn a_d_form_of_standard_input_is_that_of_the_file() {
    let folder = Folder::new("dform-stdin");
    let (file, by_file, by_pipe) =
        (folder.path("cube.obj"), folder.path("by-file"), folder.path("by-pipe"));
    assert_eq!(run(&["solid", "cube", "-o", &file]).code, Some(0));
    let text = fs::read_to_string(&file).expect("a model");
    assert_eq!(run(&["dform", &file, "--rounds", "1", "-o", &by_file]).code, Some(0));
    let ran = piped(&["dform", "-", "--rounds", "1", "-o", &by_pipe], &text);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let [one, two] = [&by_file, &by_pipe].map(|out| fs::read(format!("{out}/model.png")));
    assert_eq!(one.expect("a picture"), two.expect("a picture"));
}

#[test]
fn all_choices_are_drawn() {
    let folder = Folder::new("dform-list");
    let (out, file, picture) =
        (folder.path("out"), folder.path("cube.obj"), folder.path("all.png"));
    let ran = run(&["dform", "cube", "--list", "-o", &out]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.contains("matching:0") && ran.out.contains("choices.png"), "{}", ran.out);
    assert_eq!(run(&["solid", "cube", "-o", &file]).code, Some(0));
    let ran = run(&["seams", &file, "--draw", &picture]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let [one, two] = [format!("{out}/choices.png"), picture].map(fs::read);
    assert_eq!(one.expect("a picture"), two.expect("a picture"));
    let ran = run(&["seams", &file, "--draw", &folder.path("all.jpg")]);
    assert_eq!(ran.code, Some(2), "{}", ran.err);
}

#[test]
fn strips_too_narrow_for_the_material_are_a_finding() {
    let folder = Folder::new("dform-narrow");
    let with = |strips: &str| {
        let out = folder.path("out");
        run(&[
            "dform",
            "tetrahedron",
            "--size",
            "90mm",
            "--strips",
            strips,
            "--material",
            "card",
            "-o",
            &out,
        ])
    };
    let narrow = with("90");
    assert!(
        narrow.code == Some(1) && narrow.text().contains("F631"),
        "{}{}",
        narrow.out,
        narrow.err
    );
    let wide = with("4");
    assert!(wide.code == Some(0) && !wide.text().contains("F631"), "{}", wide.err);
}

#[test]
fn rolls_and_offsets_do_not_mix() {
    let folder = Folder::new("dform-mixed");
    let out = folder.path("out");
    let ran = run(&["dform", "cube", "--roll", "5mm", "--offset", "0.2", "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("E315"), "{}", ran.err);
    let ran = run(&["dform", "cube", "--size", "90mm", "--roll", "80mm", "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("E345"), "{}", ran.err);
}

/// An SVG with one closed path; `more` stands beside it.
fn drawing(folder: &Folder, name: &str, path: &str, more: &str) -> String {
    let file = folder.path(name);
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"200mm\" \
        viewBox=\"0 0 200 200\"><path d=\"{path}\"/>{more}</svg>"
    );
    fs::write(&file, text).expect("a drawing");
    file
}

#[test]
fn drawn_outlines_become_pieces_that_verify() {
    let folder = Folder::new("dform-outlines");
    let a = drawing(&folder, "a.svg", "M20 60 A60 40 0 0 1 140 60 A60 40 0 0 1 20 60 Z", "");
    let b = drawing(
        &folder,
        "b.svg",
        "M20 20 h80 a20 20 0 0 1 20 20 v40 a20 20 0 0 1 -20 20 h-80 a20 20 0 0 1 -20 -20 v-40 a20 20 0 0 1 20 -20 Z",
        "",
    );
    let out = folder.path("out");
    let told =
        run(&["dform", "--outlines", &a, &b, "--start", "30mm", "--points", "60", "-o", &out]);
    assert_eq!(told.code, Some(0), "{}", told.err);
    assert!(told.err.contains("was scaled by") && told.out.contains("2 pieces"), "{}", told.err);
    let [pieces, model] = ["out/pieces.json", "out/model.obj"].map(|name| folder.path(name));
    let ran = run(&["verify", &pieces, &model]);
    assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
    let ran = run(&["check", &model, "--profile", "exact", "--require", "closed,convex,planar"]);
    assert_eq!(ran.code, Some(0), "{}", ran.out);
    let exact = run(&["dform", "--outlines", &a, &b, "--fit", "exact", "-o", &out]);
    assert!(exact.code == Some(2) && exact.err.contains("E889"), "{}", exact.err);
    let two = drawing(&folder, "two.svg", "M0 0 h9 v9 Z", "<circle cx=\"50\" cy=\"50\" r=\"9\"/>");
    let ran = run(&["dform", "--outlines", &a, &two, "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("2 closed"), "{}", ran.err);
}

#[test]
fn what_outlines_cannot_be_is_told() {
    let folder = Folder::new("dform-refused");
    let out = folder.path("out");
    for (arguments, said) in [
        (&["circle", "circle"][..], "E880"),
        (&["trefoil-0.25", "trefoil-0.25", "--start", "1/6"], "E879"),
        (&["circle"], "E886"),
        (&["circle", "ellipse-2x1", "--rounds", "2"], "E886"),
        (&["circle", "circle", "--zip", "0.1"], "E886"),
        (&["circle@90mm", "circle@90mm", "--size", "50mm"], "E886"),
        (&["circle", "ellipse-2x1", "--units", "m"], "E886"),
        (&["circle", "ellipse-2x1", "--planar", "6", "--bending", "3deg"], "E886"),
        (&["circle", "ellipse-2x1", "--list", "--start", "0.2"], "E886"),
        (&["circle", "circel"], "E871"),
        (&["circle", "missing.svg"], "E887"),
        (&["circle", "ellipse-2x1", "--points", "5"], "E874"),
        (&["circle", "ellipse-2x1", "--planar", "1"], "E883"),
    ] {
        let ran = run(&[&["dform", "--outlines"][..], arguments, &["-o", &out]].concat());
        assert!(ran.code == Some(2) && ran.err.contains(said), "{arguments:?}: {}", ran.err);
    }
    let ran = run(&["dform", "cube", "--zip", "0.1", "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("E886"), "{}", ran.err);
    assert!(!std::path::Path::new(&out).exists());
}

#[test]
fn gluing_files_join_any_number_of_pieces() {
    let folder = Folder::new("dform-glue");
    let out = folder.path("out");
    for (file, count) in [("ball-of-four", "4 pieces"), ("drum-of-three", "3 pieces")] {
        let file = format!("{}/fixtures/glue/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let ran = run(&["dform", "--glue", &file, "--points", "24", "-o", &out]);
        assert!(ran.code == Some(0) && ran.out.contains(count), "{}{}", ran.out, ran.err);
        let [pieces, model] = ["out/pieces.json", "out/model.obj"].map(|name| folder.path(name));
        assert_eq!(run(&["verify", &pieces, &model]).code, Some(0));
    }
    let seams = |text: &str| {
        let file = folder.path("bad.toml");
        fs::write(&file, format!("seams = [{text}]\n[outlines]\nA = \"circle\"\nB = \"circle\"\n"))
            .expect("a file");
        let ran = run(&["dform", "--glue", &file, "-o", &out]);
        assert_eq!(ran.code, Some(2), "{text}");
        ran.err
    };
    fs::write(folder.path("none.toml"), "seams = []\n[outlines]\n").expect("a file");
    let none = run(&["dform", "--glue", &folder.path("none.toml"), "-o", &out]);
    assert!(none.code == Some(2) && none.err.contains("E890"), "{}", none.err);
    assert!(seams("\"A = C\"").contains("no outline `C`"));
    assert!(seams("\"A[0..0.5] = B[0..0.5]\"").contains("left open"));
    assert!(seams("\"A[0..0.5] = B[0..0.6]\"").contains("E875"));
    assert!(seams("\"A[0..half] = B\"").contains("E890"));
}

#[test]
fn a_list_draws_every_start() {
    let folder = Folder::new("dform-outline-list");
    let out = folder.path("out");
    let ran = run(&[
        "dform",
        "--outlines",
        "ellipse-2x1",
        "ellipse-2x1",
        "--points",
        "24",
        "--list",
        "-o",
        &out,
    ]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.contains("start 0: joined so, the pieces fold flat"), "{}", ran.out);
    assert!(ran.out.contains("start 0.25: ") && ran.out.contains("list.png"), "{}", ran.out);
    assert!(fs::read(folder.path("out/list.png")).expect("a picture").starts_with(b"\x89PNG"));
}
