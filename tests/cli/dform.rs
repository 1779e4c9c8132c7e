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
