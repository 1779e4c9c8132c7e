//! `dform`, of a name, a file and standard input.

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
