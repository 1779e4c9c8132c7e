//! `nest`, verb and recipe step.

use std::fs;
use std::path::Path;

use kerfold::io::pieces_json::read_pieces_json;
use serde_json::Value;

use super::harness::{Folder, good_model, run};

/// Anybody's pieces: two kinds, one with a hole, some of them several times.
const PARTS: &str = r#"{"pieces": [
    {"id": "frame", "outline": [[0,0],[90,0],[90,90],[0,90]], "holes": [[[15,15],[75,15],[75,75],[15,75]]], "group": "g"},
    {"id": "disc", "outline": [[20,0],[40,10],[40,30],[20,40],[0,30],[0,10]], "quantity": 5, "rotation": "90"}]}"#;

#[test]
fn nest_lays_anybodys_pieces_out_and_twice_gives_the_same() {
    let folder = Folder::new("nest");
    let parts = folder.path("parts.json");
    fs::write(&parts, PARTS).expect("a file");
    let nest = |out: &str| {
        run(&[
            "nest",
            &parts,
            &parts,
            "--quantity",
            "2",
            "--sheet",
            "200x150",
            "--effort",
            "2",
            "--seed",
            "3",
            "-o",
            out,
        ])
    };
    let (first, second) = (folder.path("one"), folder.path("two"));
    let ran = nest(&first);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.starts_with("24 pieces on "), "{}", ran.out);
    let layout = fs::read_to_string(format!("{first}/layout.json")).expect("a layout");
    let value: Value = serde_json::from_str(&layout).expect("JSON");
    let placed: Vec<&Value> = value["sheets"]
        .as_array()
        .expect("sheets")
        .iter()
        .flat_map(|s| s["placed"].as_array().expect("placed"))
        .collect();
    assert_eq!(placed.len(), 24);
    let copies = placed.iter().filter(|p| p["source"]["id"] == "disc" && p["source"]["file"] == 1);
    assert_eq!(
        copies.filter(|p| p["rotation"].as_f64().expect("degrees") % 90.0 == 0.0).count(),
        10
    );
    let (net, _) =
        read_pieces_json(&fs::read_to_string(format!("{first}/pieces.json")).expect("pieces"))
            .expect("ours");
    assert_eq!((net.pieces.len(), net.pieces[0].holes.len()), (24, 1));
    assert_eq!(nest(&second).code, Some(0));
    let bytes = |folder: &str| {
        fs::read_to_string(format!("{folder}/layout.json"))
            .expect("a layout")
            .replace("/two", "/one")
    };
    assert_eq!(bytes(&first), bytes(&second));
}

#[test]
fn nest_takes_back_what_unfold_writes_with_its_folds_and_seams() {
    let folder = Folder::new("nest-unfolded");
    let (model, out, again) = (good_model(&folder), folder.path("out"), folder.path("again"));
    assert_eq!(run(&["unfold", &model, "--sheet", "none", "-o", &out]).code, Some(0));
    let ran = run(&[
        "nest",
        &format!("{out}/pieces.json"),
        "--quantity",
        "2",
        "--sheet",
        "900x900",
        "--json",
        "-o",
        &again,
    ]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let read = |path: String| {
        read_pieces_json(&fs::read_to_string(path).expect("a file")).expect("ours").0
    };
    let (one, two) = (read(format!("{out}/pieces.json")), read(format!("{again}/pieces.json")));
    assert_eq!((two.folds.len(), two.seams.len()), (2 * one.folds.len(), 2 * one.seams.len()));
}

#[test]
fn nest_refuses_what_is_no_order_of_pieces() {
    let folder = Folder::new("nest-bad");
    let (file, out) = (folder.path("parts.json"), folder.path("out"));
    let refuse = |text: &str, options: &[&str], complaint: &str| {
        fs::write(&file, text).expect("a file");
        let ran = run(&[&["nest", &file, "-o", &out], options].concat());
        assert_eq!(ran.code, Some(2), "{text} {options:?}: {}", ran.out);
        assert!(ran.err.contains(complaint), "{text} {options:?}: {}", ran.err);
        assert!(!Path::new(&out).exists(), "{text}");
    };
    refuse("", &[], "line 1");
    refuse("{\"pieces\": []}", &[], "0 pieces");
    refuse("{\"pieces\": [{\"outline\": [[0,0],[9,9],[9,0],[0,8]]}]}", &[], "cross");
    refuse(PARTS, &["--sheet", "80x80"], "90.0 × 90.0 mm");
    refuse(PARTS, &["--quantity", "0"], "quantity");
    refuse(PARTS, &["--rotations", "45"], "free, 90, 180");
    refuse(PARTS, &["--rotate", "P77=fixed"], "P77");
    refuse(PARTS, &["--guillotine", "--defects", "0,0:5,5"], "guillotine");
    refuse(PARTS, &["--sheet-outline", "0,0:700,0:0,300"], "sheet-outline");
    refuse(PARTS, &["--common-line", "--kerf", "0.2"], "0.1 mm of both parts");
    refuse(PARTS, &["--common-line", "--material", "ply3"], "needs a kerf of 0");
    refuse(PARTS, &["--common-line", "--guillotine"], "guillotine does not go with common-line");
    let missing = run(&["nest", &folder.path("none.json"), "-o", &out]);
    assert!(missing.code == Some(2) && missing.err.contains("none.json"), "{}", missing.err);
    fs::write(&file, PARTS).expect("a file");
    fs::write(&out, "a file").expect("a file in the way");
    assert_eq!(run(&["nest", &file, "-o", &out]).code, Some(2));
}

#[test]
fn shared_lines_are_cut_once_from_flags_and_recipes_alike() {
    let folder = Folder::new("nest-common-line");
    let square = "{\"pieces\": [{\"outline\": [[0,0],[50,0],[50,50],[0,50]], \"quantity\": 4}]}";
    fs::write(folder.path("parts.json"), square).expect("a file");
    let (recipe, out, again) =
        (folder.path("recipe.toml"), folder.path("out"), folder.path("again"));
    let sheet = ["--sheet", "110x110", "--margin", "5", "--part-files", "on"];
    let ran =
        run(&[&["nest", &folder.path("parts.json"), "--common-line", "-o", &out][..], &sheet]
            .concat());
    // Two by two: twelve lines instead of sixteen.
    assert!(ran.code == Some(0) && ran.out.contains("600 mm to cut"), "{} {}", ran.out, ran.err);
    assert!(ran.err.contains("200 mm of cuts are shared"), "{}", ran.err);
    let text = "[[step]]\nnest = \"parts.json\"\ncommon_line = \"on\"\nsheet = \"110x110\"\nmargin \
    = \"5mm\"\npart_files = \"on\"\ntitle = \"parts\"\n";
    fs::write(&recipe, text).expect("a recipe");
    assert_eq!(run(&["run", &recipe, "-o", &again]).code, Some(0));
    let cuts = |folder: &str, name: &str| {
        let text = fs::read_to_string(format!("{folder}/{name}.svg")).expect("a sheet");
        text.lines().filter(|l| l.contains("<path")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(cuts(&out, "sheet-01"), cuts(&again, "sheet-01"));
    let lint = run(&["lint", &format!("{out}/sheet-01.svg")]);
    assert_eq!(lint.code, Some(0), "{}", lint.out);
}

#[test]
fn recipes_nest_pieces_too() {
    let folder = Folder::new("nest-recipe");
    // Guillotine layouts know no groups.
    fs::write(folder.path("parts.json"), PARTS.replace(", \"group\": \"g\"", "")).expect("a file");
    let recipe = folder.path("recipe.toml");
    fs::write(
        &recipe,
        "[[step]]\nnest = \"parts.json\"\nquantity = 2\nsheet = \"300x200\"\nguillotine = \
        \"on\"\nnest_effort = 1\n",
    )
    .expect("a recipe");
    let ran = run(&["run", &recipe, "-o", &folder.path("out")]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let layout = fs::read_to_string(folder.path("out/layout.json")).expect("a layout");
    assert!(layout.contains("\"guillotine\""), "{layout}");
    assert!(Path::new(&folder.path("out/sheet-01.png")).exists());
}
