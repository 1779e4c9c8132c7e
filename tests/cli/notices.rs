//! A program that notices: each trouble of a model has a fixture, a message with a command, and that
//! command, run, leaves no trouble.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, Ran, run};

/// Runs the command that a message holds between words of its own, with IN and OUT in their places.
fn run_advice(ran: &Ran, command: &str, input: &str, output: &str) -> Ran {
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains(command), "`{command}` is not said:\n{said}");
    let words = command.trim_start_matches("kerfold ").split_whitespace();
    let words: Vec<&str> = words
        .map(|word| match word {
            "IN" => input,
            "OUT" => output,
            "repaired.obj" => output,
            word => word,
        })
        .collect();
    run(&words)
}

fn findings(ran: &Ran) -> Vec<String> {
    let report: Value = serde_json::from_str(&ran.out).expect("a report");
    let list = report["findings"].as_array().expect("findings").iter();
    list.map(|f| f["check"].as_str().unwrap_or_default().to_owned()).collect()
}

fn checked(model: &str, more: &[&str]) -> (Ran, Vec<String>) {
    let ran = run(&[&["check", model, "--json"], more].concat());
    let found = findings(&ran);
    assert_eq!(ran.code, Some(i32::from(!found.is_empty())), "{}", ran.err);
    (ran, found)
}

fn model(path: &str, more: &[&str]) -> Value {
    let ran = run(&[&["info", path, "--json"], more].concat());
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    serde_json::from_str::<Value>(&ran.out).expect("JSON")["model"].clone()
}

#[test]
fn what_check_finds_of_a_surface_repair_mends() {
    let folder = Folder::new("notices-repair");
    for (fixture, trouble) in [
        ("inside-out", "inside-out"),
        ("t-junction", "t-junction"),
        ("doubled-face", "doubled-face"),
    ] {
        let input = format!("fixtures/mend/{fixture}.obj");
        let (_, found) = checked(&input, &[]);
        assert_eq!(found, [trouble], "{fixture}");
        let output = folder.path(&format!("{fixture}.obj"));
        let told = run(&["check", &input]);
        let mended = run_advice(&told, "kerfold repair IN -o OUT", &input, &output);
        assert_eq!(mended.code, Some(0), "{}", mended.err);
        let has_count =
            |line: &str| line["note: ".len()..].starts_with(|c: char| c.is_ascii_digit());
        assert!(mended.err.lines().all(has_count), "said with counts: {}", mended.err);
        assert_eq!(checked(&output, &[]).1, [""; 0], "{fixture}");
    }
    // Reading with the flag that every verb names does the same without a file.
    let told = run(&["render", "fixtures/mend/inside-out.obj", "-o", &folder.path("x.png")]);
    assert!(told.err.contains("--flip turns them around"), "{}", told.err);
    for flag in ["--flip", "--orient", "--mend"] {
        assert_eq!(checked("fixtures/mend/inside-out.obj", &[flag]).1, [""; 0], "{flag}");
    }
}

#[test]
fn what_no_mesh_can_hold_is_refused_with_the_command_that_mends_it() {
    let folder = Folder::new("notices-refused");
    for (fixture, flag, faces, what) in [
        ("flipped-face", "--orient", 6, "looked the other way"),
        ("needle", "--mend", 5, "had no area"),
        ("touching-cubes", "--mend", 12, "had more than two faces"),
        ("moebius", "--mend", 24, "only one side"),
    ] {
        let input = format!("fixtures/mend/{fixture}.obj");
        let refused = run(&["info", &input]);
        assert_eq!(refused.code, Some(2), "{fixture}");
        assert!(refused.err.contains(flag), "{}", refused.err);
        let output = folder.path(&format!("{fixture}.obj"));
        let command = format!("kerfold repair {input} -o repaired.obj");
        let mended = run_advice(&refused, &command, &input, &output);
        assert_eq!(mended.code, Some(0), "{}", mended.err);
        assert!(mended.err.contains(what), "{}", mended.err);
        assert_eq!(model(&output, &[])["faces"], faces, "{fixture}");
        assert_eq!(model(&input, &[flag])["faces"], faces, "{fixture}");
    }
}

#[test]
fn holes_close_as_far_as_is_said() {
    let folder = Folder::new("notices-holes");
    let (input, output) = ("fixtures/mend/open-box.obj", folder.path("closed.obj"));
    let told = run(&["check", input, "--require", "closed"]);
    let command = "kerfold repair IN --close-holes 10mm -o OUT";
    let small = run_advice(&told, command, input, &output);
    assert!(small.code == Some(0) && small.err.contains("nothing to mend"), "{}", small.err);
    let whole = run(&["repair", input, "--close-holes", "60mm", "-o", &output]);
    assert!(whole.err.contains("1 hole was closed"), "{}", whole.err);
    assert_eq!(checked(&output, &["--require", "closed"]).1, [""; 0]);
    let none = run(&["repair", input, "--close-holes", "0", "-o", &output]);
    assert!(none.code == Some(2) && none.err.contains("(E126)"), "{}", none.err);
}

#[test]
fn flat_triangles_become_panes() {
    let folder = Folder::new("notices-merge");
    let (input, output) = ("fixtures/mend/dome-of-triangles.obj", folder.path("panes.obj"));
    let told = run(&["check", input]);
    let merged = run_advice(&told, "kerfold merge IN -o OUT", input, &output);
    assert!(merged.err.contains("400 faces became 100"), "{}", merged.err);
    assert_eq!(model(&output, &[])["faces"], 100);
    assert_eq!(model(input, &["--merge-flat"])["faces"], 100);
    assert!(!run(&["check", &output]).out.contains("kerfold merge"));
    let panels = |model: &str| {
        run(&["panels", model, "--thickness", "10", "--sheet", "none", "-o", &folder.path("p")])
    };
    assert!(panels(input).err.contains("kerfold merge IN -o OUT"), "{}", panels(input).err);
    assert!(!panels(&output).err.contains("kerfold merge"), "{}", panels(&output).err);
}

#[test]
fn units_are_compared_and_odd_sizes_asked_about() {
    let folder = Folder::new("notices-units");
    // A cube of 1: a metre, says the file.
    let (told, found) = checked("fixtures/mend/in-metres.obj", &[]);
    assert_eq!(found, ["other-unit"]);
    assert!(told.out.contains("--units m takes it"), "{}", told.out);
    assert!(told.err.contains("1 mm in its largest extent: is the unit right?"), "{}", told.err);
    let (right, found) = checked("fixtures/mend/in-metres.obj", &["--units", "m"]);
    assert_eq!((found, right.err.as_str()), (vec![], ""));
    // What we write says mm, in every format.
    for name in ["model.obj", "model.ply", "model.off", "model.stl"] {
        let path = folder.path(name);
        assert_eq!(run(&["solid", "cube", "--size", "100mm", "-o", &path]).code, Some(0));
        let head = fs::read(&path).expect("a file");
        let head = String::from_utf8_lossy(&head[..200.min(head.len())]).into_owned();
        assert!(head.contains("units: mm"), "{name}: {head}");
        assert_eq!(checked(&path, &[]).1, [""; 0]);
        let (told, found) = checked(&path, &["--units", "m"]);
        assert_eq!(found, ["other-unit"], "{name}");
        assert!(told.err.contains("100000 mm in its largest extent"), "{}", told.err);
    }
}

#[test]
fn rigid_materials_do_not_fold_unless_told_how() {
    let folder = Folder::new("notices-rigid");
    let (cube, out) = (folder.path("cube.obj"), folder.path("out"));
    assert_eq!(run(&["solid", "cube", "--size", "80mm", "-o", &cube]).code, Some(0));
    let pieces = |more: &[&str]| {
        let words = ["unfold", &cube, "--material", "ply3", "--sheet", "none", "-o", &out];
        let ran = run(&[&words[..], more].concat());
        let text = fs::read_to_string(format!("{out}/pieces.json")).unwrap_or_default();
        let count = serde_json::from_str::<Value>(&text)
            .map_or(0, |net| net["pieces"].as_array().map_or(0, Vec::len));
        (ran, count)
    };
    let (told, count) = pieces(&[]);
    assert_eq!((told.code, count), (Some(0), 6));
    assert!(told.err.contains("--fold score or --fold hinge folds it"), "{}", told.err);
    for way in ["score", "hinge"] {
        let (told, count) = pieces(&["--fold", way]);
        assert_eq!((told.code, count), (Some(0), 1), "{}", told.err);
    }
    let (refused, _) = pieces(&["--pieces", "one"]);
    assert!(refused.code == Some(2) && refused.err.contains("(E714)"), "{}", refused.err);
    let (told, _) = pieces(&["--pieces", "one", "--fold", "score"]);
    assert_eq!(told.code, Some(0));
}

#[test]
fn planarize_says_what_it_cost_and_which_ways_are_better() {
    let folder = Folder::new("notices-planarize");
    let (input, output) = ("fixtures/mend/saddle-of-quads.obj", folder.path("planar.obj"));
    let told = run(&["planarize", input, "-o", &output]);
    assert_eq!(told.code, Some(1), "{}", told.err);
    for words in ["(F507)", "conjugate directions"] {
        assert!(told.err.contains(words), "{words}: {}", told.err);
    }
    assert!(!told.err.contains("cut face"), "an open surface: {}", told.err);
    // The other ways, run as they are said, leave panels that are planar.
    for command in
        ["kerfold panelize IN --count 64 -o OUT", "kerfold subdivide triangulate IN -o OUT"]
    {
        let ran = run_advice(&told, command, input, &output);
        assert_eq!(ran.code, Some(0), "{command}: {}", ran.err);
        assert_eq!(checked(&output, &["--profile", "exact"]).1, [""; 0], "{command}");
    }
    // Of a closed model every face gets a plane of its own.
    let (dented, output) = (folder.path("dented.obj"), folder.path("cut.obj"));
    let text = fs::read_to_string("fixtures/meshes/cube.obj").expect("a cube");
    let moved = text.replacen("v 0 0 0", "v -4 -4 -4", 1);
    fs::write(&dented, moved).expect("a file");
    let told = run(&["planarize", &dented, "-o", &folder.path("planar.obj")]);
    let command = "kerfold cut face IN --select all -o OUT";
    let ran = run_advice(&told, command, &dented, &output);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert_eq!(checked(&output, &["--profile", "exact"]).1, [""; 0]);
}

#[test]
fn limits_of_shops_are_findings_and_crossings_are_on_request() {
    let cube = "fixtures/meshes/cube.obj";
    assert_eq!(checked(cube, &[]).1, [""; 0]);
    assert_eq!(checked(cube, &["--profile", "joiner"]).1, vec!["short-edge"; 12]);
    assert_eq!(checked(cube, &["--min-angle", "91deg"]).1, vec!["sharp-corner"; 6]);
    assert_eq!(checked(cube, &["--max-mitre", "40deg"]).1, vec!["mitre"; 12]);
    let boxes = "fixtures/mend/crossing-boxes.obj";
    let told = run(&["check", boxes]);
    assert!(told.code == Some(0) && told.out.contains("go through each other"), "{}", told.out);
    let (_, found) = checked(boxes, &["--require", "simple"]);
    assert!(!found.is_empty() && found.iter().all(|f| f == "simple"), "{found:?}");
}

#[test]
fn a_dense_model_becomes_one_for_paper() {
    let folder = Folder::new("notices-simplify");
    let (dense, paper) = (folder.path("dense.obj"), folder.path("paper.obj"));
    assert_eq!(run(&["solid", "geodesic-16", "--size", "150mm", "-o", &dense]).code, Some(0));
    assert_eq!(model(&dense, &[])["faces"], 5120);
    let made = run(&["simplify", &dense, "--faces", "200", "-o", &paper]);
    assert!(made.code == Some(0) && made.err.contains("5120 triangles became"), "{}", made.err);
    let faces = model(&paper, &[])["faces"].as_u64().expect("a number");
    assert!((150..=220).contains(&faces), "{faces}");
    let required = ["--require", "closed,manifold,one-component,simple"];
    assert_eq!(checked(&paper, &required).1, [""; 0]);
    let made = run(&["simplify", &dense, "--deviation", "1mm", "--json", "-o", &paper]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    assert_eq!(run(&["simplify", &dense, "-o", &paper]).code, Some(2));
}
