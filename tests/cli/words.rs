//! Words and habits: what carries over from one call to the next, and what is called alike.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, run};

fn model(path: &str) -> Value {
    let ran = run(&["info", path, "--json"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    serde_json::from_str::<Value>(&ran.out).expect("JSON")["model"].clone()
}

#[test]
fn what_a_cut_made_is_known_to_the_next_call() {
    let folder = Folder::new("words-made");
    let [solid, first, second] = ["a.obj", "b.obj", "c.obj"].map(|name| folder.path(name));
    assert_eq!(run(&["solid", "dodecahedron", "--size", "100mm", "-o", &solid]).code, Some(0));
    let cut = |select: &str, from: &str, to: &str| {
        run(&["cut", "edge", from, "--select", select, "--offset", "0.2", "-o", to])
    };
    assert_eq!(cut("hamiltonian", &solid, &first).code, Some(0));
    // Round after round in the shell is what `--repeat` does in one call.
    let made = cut("strip", &first, &second);
    assert_eq!(made.code, Some(0), "{}", made.err);
    let text = fs::read_to_string(&first).expect("a model");
    for mark in ["\ng default made\n", "\ng made\n", "\ng strip\n", "\np ", "\nl "] {
        assert!(text.contains(mark), "{mark}");
    }
    assert_eq!(run(&["info", &first]).err, "", "marks are read without a word");
    // 10 edges cut: 10 new faces; then both long sides of each.
    assert_eq!(
        (model(&first)["faces"].as_u64(), model(&second)["faces"].as_u64()),
        (Some(22), Some(42))
    );
    let faces = run(&["cut", "face", &first, "--select", "made", "-o", &second]);
    assert!(faces.err.is_empty() || faces.code == Some(0), "{}", faces.err);
    // A mesh of which nobody said what was made has no strips.
    let none = cut("strip", &solid, &second);
    assert!(none.code == Some(2) && none.err.contains("(E284)"), "{}", none.err);
}

#[test]
fn joints_have_the_same_names_on_sheets_and_plates() {
    let folder = Folder::new("words-joints");
    let (cube, out) = (folder.path("cube.obj"), folder.path("out"));
    assert_eq!(run(&["solid", "cube", "--size", "80mm", "-o", &cube]).code, Some(0));
    for word in ["finger", "fingers"] {
        let unfold = ["unfold", &cube, "--joint", word, "--thickness", "3mm", "-o", &out];
        assert_eq!(run(&unfold).code, Some(0), "{word}");
        let panels = ["panels", &cube, "--thickness", "3mm", "--edges", word, "-o", &out];
        assert!(run(&panels).code < Some(2), "{word}: {}", run(&panels).err);
    }
}

#[test]
fn help_is_a_word_and_colour_is_a_choice() {
    let asked = run(&["help", "cut", "edge"]);
    assert_eq!((asked.code, asked.err.as_str()), (Some(0), ""));
    assert!(asked.out.contains("Example: kerfold cut edge"), "{}", asked.out);
    assert!(run(&["help"]).out.contains("Commands:"));
    let wrong = run(&["help", "unfoldd"]);
    assert!(wrong.code == Some(2) && wrong.err.contains("did you mean `unfold`?"), "{}", wrong.err);
    let coloured = |when: &str| run(&["--color", when, "solid", "cubee", "-o", "x.obj"]).err;
    assert!(coloured("always").contains('\u{1b}') && !coloured("never").contains('\u{1b}'));
    assert!(!coloured("auto").contains('\u{1b}'), "a pipe is no terminal");
    assert_eq!(run(&["--color", "sometimes", "help"]).code, Some(2));
}

#[test]
fn parameters_of_recipes_are_set_by_name() {
    let folder = Folder::new("words-parameters");
    let recipe = folder.path("box.toml");
    let text = "[parameters]\nsize = \"90mm\"\nrounds = 1\n\n[[step]]\nsolid = \"cube\"\nsize = \
        \"{size}\"\n[[step]]\ncut = \"vertex\"\nselect = \"all\"\noffset = \"1/{rounds}/4\"\n";
    fs::write(&recipe, text).expect("a recipe");
    let out = folder.path("out");
    let largest = |set: &[&str]| {
        let ran = run(&[&["run", &recipe, "-o", &out][..], set].concat());
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        let model = model(&format!("{out}/model.obj"));
        assert_eq!(model["faces"], 14);
        model["size_mm"][0].as_f64().expect("a length")
    };
    assert_eq!(largest(&[]), 90.0);
    assert_eq!(largest(&["--set", "size=20cm"]), 200.0);
    assert_eq!(largest(&["--set", "size=1/2m", "--set", "rounds=2"]), 500.0);
    let wrong = run(&["run", &recipe, "--set", "sise=3", "-o", &out]);
    assert!(wrong.code == Some(2) && wrong.err.contains("did you mean `size`?"), "{}", wrong.err);
    fs::write(&recipe, text.replace("{size}", "{sice}")).expect("a recipe");
    let wrong = run(&["run", &recipe, "-o", &out]);
    assert!(wrong.err.contains("line 7") && wrong.err.contains("`sice`"), "{}", wrong.err);
}

#[test]
fn bundled_recipes_are_found_by_name() {
    let folder = Folder::new("words-bundled");
    let out = folder.path("out");
    let made = run(&["run", "two-piece-d-form", "-o", &out]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    assert!(fs::metadata(format!("{out}/sheet-01.svg")).is_ok());
    let missing = run(&["run", "three-piece-d-form", "-o", &out]);
    assert_eq!(missing.code, Some(2));
}

#[test]
fn drawings_are_nested() {
    let folder = Folder::new("words-nest");
    let [drawing, out] = ["lid.svg", "out"].map(|name| folder.path(name));
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"60mm\" viewBox=\"0 0 \
        100 60\"><rect x=\"5\" y=\"5\" width=\"40\" height=\"30\"/><circle cx=\"20\" cy=\"20\" \
        r=\"6\"/><rect x=\"60\" y=\"5\" width=\"20\" height=\"20\"/></svg>";
    fs::write(&drawing, svg).expect("a drawing");
    let made = run(&["nest", &drawing, "--sheet", "200x100", "--quantity", "2", "-o", &out]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    let layout = fs::read_to_string(format!("{out}/layout.json")).expect("a layout");
    let layout: Value = serde_json::from_str(&layout).expect("JSON");
    assert_eq!(layout["sheets"][0]["placed"].as_array().map(Vec::len), Some(4));
    // What was laid out is a drawing again, and can be nested as one.
    let again = run(&["nest", &format!("{out}/sheet-01.dxf"), "--sheet", "200x100", "-o", &out]);
    assert!(again.code == Some(0) || again.err.contains("(E"), "{}", again.err);
    fs::write(&drawing, svg.replace("<rect", "<text").replace("<circle", "<text")).expect("text");
    let none = run(&["nest", &drawing, "--sheet", "200x100", "-o", &out]);
    assert!(none.code == Some(2) && none.err.contains("(E723)"), "{}", none.err);
}
