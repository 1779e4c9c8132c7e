//! The program as users meet it: exit codes, messages, pipes, and files that are whole or not
//! there.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use kerfold::io::pieces_json::read_pieces_json;
use serde_json::Value;

/// A folder that goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("kerfold-cli-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("a plain path").to_owned()
    }

    /// Everything in it, with its bytes; folders without.
    fn contents(&self) -> Vec<(PathBuf, Option<Vec<u8>>)> {
        fn collect(folder: &Path, found: &mut Vec<(PathBuf, Option<Vec<u8>>)>) {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    collect(&path, found);
                    found.push((path, None));
                } else {
                    let bytes = fs::read(&path).expect("a file");
                    found.push((path, Some(bytes)));
                }
            }
        }
        let mut found = Vec::new();
        collect(&self.0, &mut found);
        found.sort();
        found
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

struct Ran {
    code: Option<i32>,
    out: String,
    err: String,
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kerfold"));
    command.stdin(Stdio::null());
    command
}

fn run(arguments: &[&str]) -> Ran {
    ran(program().args(arguments))
}

fn ran(command: &mut Command) -> Ran {
    let output = command.output().expect("the program starts");
    Ran {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

fn piped(arguments: &[&str], input: &str) -> Ran {
    let mut command = program();
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("the program reads");
    let output = child.wait_with_output().expect("the program ends");
    Ran {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

/// Verbs that read a mesh, with IN and OUT where the files go, and the name of what they write.
const READERS: &[(&[&str], &str)] = &[
    (&["info", "IN"], ""),
    (&["check", "IN"], ""),
    (&["check", "IN", "--report", "OUT"], "report.json"),
    (&["check", "IN", "--report", "OUT", "--up", "y", "--view", "iso"], "report.html"),
    (&["check", "IN", "--report", "OUT", "--rows", "all"], "report.pdf"),
    (&["check", "IN", "--rows", "all", "--report", "OUT"], "report.csv"),
    (&["cut", "vertex", "IN", "--select", "all", "--offset", "0.25", "-o", "OUT"], "out.obj"),
    (&["cut", "edge", "IN", "--select", "0", "--offset", "0.2", "-o", "OUT"], "out.ply"),
    (&["cut", "face", "IN", "--select", "0", "-o", "OUT"], "out.off"),
    (&["cut", "plane", "IN", "--normal", "z", "--point", "0,0,0", "-o", "OUT"], "out.stl"),
    (&["hull", "IN", "-o", "OUT"], "hull.ply"),
    (&["hull", "IN", "--dual", "--steps", "1,all", "-o", "OUT"], "dual.obj"),
    (&["subdivide", "doo-sabin", "IN", "--rounds", "2", "-o", "OUT"], "out.obj"),
    (&["sierpinski", "IN", "--rounds", "2", "-o", "OUT"], "out.obj"),
    (
        &["rind", "IN", "--thickness", "2mm", "--punch", "0", "--peel", "1,2", "-o", "OUT"],
        "out.obj",
    ),
    (&["menger", "IN", "--thickness", "1/4", "-o", "OUT"], "out.obj"),
    (
        &[
            "handle",
            "IN",
            "--from",
            "0",
            "--to",
            "1",
            "--weights",
            "500mm,500mm",
            "--segments",
            "16",
            "-o",
            "OUT",
        ],
        "out.obj",
    ),
    (
        &[
            "handle",
            "IN",
            "--from",
            "0",
            "--to",
            "1",
            "--also",
            "2",
            "--segments",
            "8",
            "-o",
            "OUT",
        ],
        "hub.obj",
    ),
    (&["planarize", "IN", "-o", "OUT"], "out.obj"),
    (&["unfold", "IN", "--sheet", "600x400", "-o", "OUT"], "out"),
    (&["unfold", "IN", "--sheet", "none", "--assembly", "pictures", "-o", "OUT"], "shown"),
    (&["seams", "IN"], ""),
    (&["dform", "IN", "--rounds", "1", "-o", "OUT"], "out"),
    (&["panels", "IN", "--thickness", "2mm", "--gap", "1mm", "-o", "OUT"], "panels"),
    (&["render", "IN", "--width", "64", "-o", "OUT"], "out.png"),
];

/// Verbs that need no mesh but write something.
const MAKERS: &[(&[&str], &str)] = &[
    (&["solid", "dodecahedron", "--size", "100mm", "-o", "OUT"], "out.obj"),
    (&["hull", "--planes", "fixtures/planes/octahedron.csv", "-o", "OUT"], "crystal.obj"),
    (&["kerf-test", "--material", "ply3", "-o", "OUT"], "kerf.svg"),
    (&["man", "-o", "OUT"], "man"),
];

fn fill<'a>(arguments: &[&'a str], input: &'a str, output: &'a str) -> Vec<&'a str> {
    let filled = arguments.iter().map(|&a| match a {
        "IN" => input,
        "OUT" => output,
        _ => a,
    });
    filled.collect()
}

fn good_model(folder: &Folder) -> String {
    let model = folder.path("model.obj");
    let made = run(&["solid", "dodecahedron", "--size", "100mm", "-o", &model]);
    assert_eq!((made.code, made.err.as_str()), (Some(0), ""), "{}", made.out);
    model
}

#[test]
fn good_input_gives_results_on_stdout_and_whole_files() {
    let folder = Folder::new("good");
    let model = good_model(&folder);
    for (i, (arguments, name)) in READERS.iter().chain(MAKERS).enumerate() {
        let output = folder.path(&format!("{i}-{name}"));
        let ran = run(&fill(arguments, &model, &output));
        assert_eq!(ran.code, Some(0), "{arguments:?}: {}", ran.err);
        assert!(!ran.out.is_empty(), "{arguments:?} says nothing");
        assert!(ran.err.lines().all(|l| l.starts_with("note: ")), "{arguments:?}: {}", ran.err);
        if !name.is_empty() {
            assert!(Path::new(&output).exists(), "{arguments:?}");
        }
    }
    let leftovers =
        folder.contents().into_iter().filter(|(p, _)| p.to_string_lossy().contains("tmp-"));
    assert_eq!(leftovers.count(), 0);
}

#[test]
fn bad_input_is_exit_code_2_with_one_line_and_no_file() {
    let folder = Folder::new("bad");
    let missing = folder.path("nothing-here.obj");
    let inputs = [
        ("fixtures/bad/empty.obj", "is empty"),
        ("fixtures/bad/word.obj", "as in `v 0 1.5 2`"),
        ("fixtures/bad/garbage.stl", "export the model again"),
        (missing.as_str(), "there is no file"),
    ];
    for (arguments, name) in READERS {
        for (input, message) in inputs {
            let output = folder.path(name);
            let ran = run(&fill(arguments, input, &output));
            assert_eq!(ran.code, Some(2), "{arguments:?} {input}");
            assert_eq!(ran.out, "", "{arguments:?} {input}");
            assert!(
                ran.err.starts_with("kerfold: ") && ran.err.contains(message),
                "{arguments:?}: {}",
                ran.err
            );
            assert_eq!(ran.err.lines().count(), 1, "{arguments:?}: {}", ran.err);
        }
    }
    assert_eq!(folder.contents(), [], "nothing may be written");
}

#[test]
fn planes_that_bound_nothing_are_refused_with_place_and_reason() {
    let folder = Folder::new("planes");
    let output = folder.path("out.obj");
    let walls = "1,0,0,1\n-1,0,0,1\n0,1,0,1\n0,-1,0,1\n";
    for (name, text, messages) in [
        ("empty.csv", String::new(), &["there are no half-spaces"][..]),
        ("word.csv", format!("{walls}0, 0, up, 1\n"), &["word.csv:5:7: `up` is not a number"]),
        (
            "open.csv",
            format!("{walls}0,0,1,1\n"),
            &["the direction (0.0000, 0.0000, -1.0000) open"],
        ),
        (
            "apart.csv",
            format!("# box\n{walls}0,0,1,1\n0,0,-1,-2\n"),
            &["exclude each other", "on the lines 6, 7"],
        ),
        ("flat.csv", format!("{walls}0,0,1,1\n0,0,-1,-1\n"), &["no room", "on the lines 5, 6"]),
    ] {
        let file = folder.path(name);
        fs::write(&file, text).expect("a file");
        let ran = run(&["hull", "--planes", &file, "-o", &output]);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{name}");
        assert!(messages.iter().all(|m| ran.err.contains(m)), "{name}: {}", ran.err);
        assert!(!Path::new(&output).exists(), "{name}");
    }
    let missing = run(&["hull", "--planes", &folder.path("none.csv"), "-o", &output]);
    assert!(missing.code == Some(2) && missing.err.contains("none.csv"), "{}", missing.err);
}

#[test]
fn output_that_cannot_be_written_leaves_everything_as_it_was() {
    let folder = Folder::new("unwritable");
    let model = good_model(&folder);
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    let before = folder.contents();
    for (arguments, name) in READERS.iter().chain(MAKERS).filter(|v| !v.1.is_empty()) {
        let output = folder.path(&format!("wall/{name}"));
        let ran = run(&fill(arguments, &model, &output));
        assert_eq!(ran.code, Some(2), "{arguments:?}");
        // Notes may come first: what a verb says before its work begins.
        let error = ran.err.lines().find(|line| !line.starts_with("note: ")).unwrap_or_default();
        assert!(
            error.starts_with("kerfold: ") && error.contains("wall"),
            "{arguments:?}: {}",
            ran.err
        );
        assert_eq!(folder.contents(), before, "{arguments:?}");
    }
}

#[test]
fn of_several_files_all_are_written_or_none() {
    let folder = Folder::new("all-or-none");
    let model = good_model(&folder);
    fs::create_dir_all(folder.path("out/layout.json")).expect("a folder where a file should go");
    fs::write(folder.path("out/pieces.json"), "precious").expect("a file");
    let before = folder.contents();
    let ran = run(&["unfold", &model, "--sheet", "600x400", "-o", &folder.path("out")]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("layout.json"), "{}", ran.err);
    assert_eq!(folder.contents(), before);
}

#[test]
fn a_dash_is_standard_input_and_output() {
    let made = run(&["solid", "cube", "-o", "-"]);
    assert_eq!(made.code, Some(0));
    assert!(made.err.contains("8 vertices"), "the summary gives way to the mesh: {}", made.err);
    let cut =
        piped(&["cut", "vertex", "-", "--select", "all", "--offset", "0.25", "-o", "-"], &made.out);
    assert_eq!(cut.code, Some(0), "{}", cut.err);
    let info = piped(&["info", "-", "--json"], &cut.out);
    let told: Value = serde_json::from_str(&info.out).expect("JSON");
    assert!(info.out.contains("24"), "a truncated cube has 24 vertices: {told}");
    let empty = piped(&["info", "-"], "");
    assert_eq!(empty.code, Some(2));
    assert!(empty.err.contains("standard input"), "{}", empty.err);
}

#[test]
fn json_parses_and_quiet_is_silent() {
    let folder = Folder::new("json");
    let model = good_model(&folder);
    for (i, (arguments, name)) in READERS.iter().chain(MAKERS).enumerate() {
        let output = folder.path(&format!("{i}-{name}"));
        let mut with = fill(arguments, &model, &output);
        with.push("--json");
        let ran = run(&with);
        assert_eq!(ran.code, Some(0), "{with:?}: {}", ran.err);
        let value: Value =
            serde_json::from_str(&ran.out).unwrap_or_else(|e| panic!("{with:?}: {e}\n{}", ran.out));
        assert!(value["command"].as_str().is_some_and(|c| c.starts_with("kerfold ")), "{with:?}");
        *with.last_mut().expect("--json") = "--quiet";
        let ran = run(&with);
        assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (Some(0), "", ""), "{with:?}");
        with[if arguments[0] == "cut" { 2 } else { 1 }] = "no-such-thing.obj";
        if arguments.contains(&"IN") {
            let ran = run(&with);
            assert_eq!(ran.code, Some(2), "{with:?}");
            assert!(!ran.err.is_empty(), "errors are not silenced: {with:?}");
        }
    }
}

#[test]
fn findings_are_exit_code_1() {
    let folder = Folder::new("findings");
    let model = folder.path("octahedron.obj");
    assert_eq!(run(&["solid", "octahedron", "-o", &model]).code, Some(0));
    let ran = run(&["check", &model, "--require", "valence3"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{}", ran.out);
    assert!(ran.out.contains("valence"), "{}", ran.out);
    let page = folder.path("report.html");
    let ran = run(&[
        "check",
        &model,
        "--require",
        "valence3",
        "--report",
        &page,
        "--json",
        "--rows",
        "all",
    ]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{}", ran.out);
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(
        ["vertices", "edges"].map(|key| told[key].as_array().map(Vec::len)),
        [Some(6), Some(12)]
    );
    let page = fs::read_to_string(&page).expect("a page");
    assert!(page.contains("Fail: 6 findings") && page.contains("octahedron.obj"));
}

#[test]
fn what_an_operator_finds_counts_in_a_recipe_as_it_does_in_its_verb() {
    let folder = Folder::new("unclean");
    let (model, sponge) = (folder.path("tetrahedron.obj"), folder.path("sponge.obj"));
    assert_eq!(run(&["solid", "tetrahedron", "-o", &model]).code, Some(0));
    let ran = run(&["menger", &model, "--thickness", "0.3", "-o", &sponge]);
    assert!(ran.code == Some(1) && ran.err.contains("(F503)"), "{}", ran.err);
    let recipe = |thickness: &str| {
        let path = folder.path("recipe.toml");
        let text = format!(
            "[[step]]\nsolid = \"tetrahedron\"\n[[step]]\nmenger = 1\nthickness = {thickness}\n"
        );
        fs::write(&path, text).expect("a recipe");
        run(&["run", &path, "-o", &folder.path("made"), "--json"])
    };
    for (thickness, code, unclean) in [("0.3", 1, 1), ("0.15", 0, 0)] {
        let ran = recipe(thickness);
        let told: Value = serde_json::from_str(&ran.out).expect("JSON");
        assert_eq!(
            (ran.code, told["unclean"].as_array().map(Vec::len)),
            (Some(code), Some(unclean)),
            "{}",
            ran.out
        );
    }
    // Kinds of vertices are told before the rounds, and once.
    let ran = run(&["sierpinski", &model, "-o", &sponge]);
    assert_eq!(
        (ran.code, ran.err.matches("vertices before the first round: 4 convex").count()),
        (Some(0), 1)
    );
    assert!(ran.err.starts_with("note: vertices before"), "{}", ran.err);
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    for arguments in [&["completions", "bash"][..], &["solid", "geodesic-40", "-o", "-"]] {
        let mut command = program();
        command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("the program ends");
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {err}");
        assert!(!err.contains("kerfold:") && !err.contains("panicked"), "{err}");
    }
}

/// The verbs that the help lists, those of `cut` with it.
fn verbs() -> Vec<Vec<String>> {
    let listed = |of: &[&str]| -> Vec<String> {
        let help = run(&[of, &["--help"]].concat());
        assert_eq!(help.code, Some(0), "{of:?}");
        let commands = help.out.split("Commands:\n").nth(1).expect("a list of verbs");
        let lines = commands
            .lines()
            .take_while(|l| !l.is_empty())
            .filter(|l| l.starts_with("  ") && !l.starts_with("   "));
        lines.filter_map(|l| l.split_whitespace().next().map(str::to_owned)).collect()
    };
    let mut all: Vec<Vec<String>> = listed(&[]).into_iter().map(|v| vec![v]).collect();
    all.extend(listed(&["cut"]).into_iter().map(|v| vec!["cut".to_owned(), v]));
    all
}

#[test]
fn every_verb_has_an_example_in_its_help() {
    let verbs = verbs();
    for name in [
        "solid",
        "info",
        "check",
        "cut",
        "unfold",
        "seams",
        "dform",
        "panels",
        "verify",
        "lint",
        "kerf-test",
        "run",
        "gallery",
        "render",
        "completions",
        "man",
    ] {
        assert!(verbs.contains(&vec![name.to_owned()]), "{name}");
    }
    assert!(verbs.len() >= 16, "{verbs:?}");
    for verb in verbs {
        let mut arguments: Vec<&str> = verb.iter().map(String::as_str).collect();
        let example = format!("Example: kerfold {}", arguments.join(" "));
        arguments.push("--help");
        let help = run(&arguments);
        assert_eq!((help.code, help.err.as_str()), (Some(0), ""));
        assert!(help.out.contains(&example), "{verb:?} has no example:\n{}", help.out);
    }
}

#[test]
fn completions_and_manual_pages_know_every_verb() {
    let folder = Folder::new("man");
    assert_eq!(run(&["man", "-o", &folder.path("man1")]).code, Some(0));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run(&["completions", shell]);
        assert_eq!((script.code, script.err.as_str()), (Some(0), ""), "{shell}");
        for verb in verbs() {
            assert!(script.out.contains(verb.last().expect("a verb")), "{shell} {verb:?}");
            let page = folder.path(&format!("man1/kerfold-{}.1", verb.join("-")));
            assert!(fs::read_to_string(&page).expect(&page).contains("Example: kerfold"), "{page}");
        }
    }
    assert_eq!(run(&["completions", "tcsh"]).code, Some(2));
}

#[test]
fn mistyped_arguments_are_exit_code_2() {
    let cases: &[(&[&str], &str)] = &[
        (&["unfoldd", "x.obj"], "unfold"),
        (&["unfold", "x.obj"], "--output"),
        (&["solid", "dodecahedrn", "-o", "x.obj"], "dodecahedron"),
        (&["render", "fixtures/meshes/cube.obj", "-o", "x.jpg"], ".png"),
        (
            &["unfold", "fixtures/meshes/cube.obj", "--animate", "x.gltf", "-o", "x"],
            "something.glb",
        ),
        (&["unfold", "fixtures/meshes/cube.off", "--joint", "tabs", "-o", "x"], "thickness"),
        (&["check", "fixtures/meshes/cube.obj", "--report", "x.txt"], ".json"),
        (
            &["cut", "edge", "fixtures/meshes/cube.obj", "--select", "hamiltonain", "-o", "x.obj"],
            "hamiltonian",
        ),
    ];
    for (arguments, hint) in cases {
        let ran = run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(ran.err.contains(hint), "{arguments:?}: {}", ran.err);
    }
    assert!(!Path::new("x.obj").exists() && !Path::new("x.jpg").exists());
}

/// Recipe, place, and what the message advises.
const BAD_RECIPES: &[(&str, &str, &str)] = &[
    ("misspelt-key.toml", "line 7, column 1", "did you mean `offset`?"),
    ("misspelt-solid.toml", "line 2, column 9", "dodecahedron"),
    ("misspelt-table.toml", "line 1, column 3", "did you mean `step`?"),
    ("misspelt-verb.toml", "line 2, column 1", "did you mean `solid`?"),
    ("no-mesh.toml", "step 1 (cut edge)", "begin with a step that names a solid or reads a file"),
    ("no-steps.toml", "no [[step]]", "solid = \"dodecahedron\""),
    ("syntax.toml", "line 2", "string"),
    ("two-verbs.toml", "line 3, column 1", "make two steps of it"),
    ("unknown-cut.toml", "line 5, column 7", "did you mean `edge`?"),
    ("wrong-value.toml", "line 7, column 10", "invalid type: string \"wide\""),
];

#[test]
fn recipe_errors_name_line_column_and_the_nearest_word() {
    let mut listed: Vec<_> = fs::read_dir("fixtures/bad-recipes").expect("recipes").collect();
    listed.sort_by_key(|e| e.as_ref().expect("an entry").file_name());
    let listed: Vec<_> =
        listed.into_iter().map(|e| e.expect("an entry").file_name().into_string()).collect();
    assert_eq!(listed, BAD_RECIPES.iter().map(|r| Ok(r.0.to_owned())).collect::<Vec<_>>());
    let folder = Folder::new("recipes");
    let output = folder.path("out");
    for (name, place, advice) in BAD_RECIPES {
        let path = format!("fixtures/bad-recipes/{name}");
        let ran = run(&["run", &path, "-o", &output]);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{name}");
        assert!(ran.err.starts_with(&format!("kerfold: {path}: ")), "{}", ran.err);
        assert!(ran.err.contains(place) && ran.err.contains(advice), "{name}: {}", ran.err);
    }
    for (path, message) in
        [("nothing.toml", "cannot be read"), ("fixtures/bad/garbage.bin", "UTF-8")]
    {
        let ran = run(&["run", path, "-o", &output]);
        assert_eq!(ran.code, Some(2));
        assert!(ran.err.contains(message), "{}", ran.err);
    }
    assert_eq!(folder.contents(), []);
}

#[test]
fn animations_are_written_where_they_are_named_or_nothing_is() {
    let folder = Folder::new("animate");
    let model = good_model(&folder);
    for (name, start) in [("bloom.glb", &b"glTF"[..]), ("bloom.png", &b"\x89PNG"[..])] {
        let file = folder.path(name);
        let ran = run(&["unfold", &model, "--animate", &file, "-o", &folder.path("out"), "--json"]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.contains(name), "{}", ran.out);
        assert!(fs::read(&file).expect("the animation").starts_with(start), "{name}");
    }
    let recipe = folder.path("recipe.toml");
    let text = "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n\n[[step]]\nunfold = \"one\"\nanimate \
    = \"up.glb\"\n\
        assembly = \"pictures\"\njoint = \"tabs\"\nthickness = 3\nsubstitute = \"mitre\"\n";
    fs::write(&recipe, text).expect("a recipe");
    for out in ["first", "second"] {
        let ran = run(&["run", &recipe, "-o", &folder.path(out)]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
    }
    for name in ["up.glb", "assembly-01.png", "assembly.txt"] {
        let [first, second] =
            ["first", "second"].map(|out| fs::read(folder.path(&format!("{out}/{name}"))));
        let (first, second) = (first.expect(name), second.expect(name));
        // The command in the file names its folder.
        assert!(first.len() > 100 && (name != "assembly-01.png" || first == second), "{name}");
    }
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    let before = folder.contents();
    let ran = run(&[
        "unfold",
        &model,
        "--animate",
        &folder.path("wall/x.glb"),
        "-o",
        &folder.path("new"),
    ]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("wall"), "{}", ran.err);
    assert_eq!(folder.contents(), before);
}

#[test]
fn a_gallery_shows_what_works_and_names_what_fails() {
    let folder = Folder::new("gallery");
    let bundled = folder.path("bundled");
    let ran =
        run(&["gallery", "--only", "gonen-fig-08,gonen-fig-05", "--width", "64", "-o", &bundled]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert!(
        ran.out.contains("gonen-fig-08-vertex-truncation") && ran.out.contains("pass"),
        "{}",
        ran.out
    );
    let page = fs::read_to_string(folder.path("bundled/index.html")).expect("the page");
    assert!(
        page.contains("24 vertices, 36 edges, 14 faces") && page.contains("planar to rounding"),
        "{page}"
    );
    assert!(
        fs::read(folder.path("bundled/gonen-fig-05-global-cut/model.png"))
            .expect("a picture")
            .len()
            > 100
    );
    // The recipes lie beside it and run as they are.
    let recipe = folder.path("bundled/recipes/gallery/gonen-fig-05-global-cut.toml");
    assert_eq!(run(&["run", &recipe, "-o", &folder.path("again")]).code, Some(0));

    let own = folder.path("own");
    fs::create_dir(&own).expect("a folder");
    let none = run(&["gallery", &own, "-o", &folder.path("site")]);
    assert!(none.code == Some(2) && none.err.contains("no recipes"), "{}", none.err);
    let cube = "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n";
    fs::write(folder.path("own/good.toml"), cube).expect("a recipe");
    fs::write(folder.path("own/bad.toml"), "[[step]]\nsolid = \"cbe\"\n").expect("a recipe");
    let open = format!("{cube}[[step]]\ncheck = \"glass\"\nrequire = \"valence3,closed,planar\"\n");
    fs::write(folder.path("own/checked.toml"), open).expect("a recipe");
    let mixed = run(&["gallery", &own, "-o", &folder.path("site")]);
    assert_eq!(mixed.code, Some(2));
    assert!(
        mixed.err.contains("1 of 3 recipes failed") && mixed.err.contains("bad: line 2"),
        "{}",
        mixed.err
    );
    let page = fs::read_to_string(folder.path("site/index.html")).expect("the page");
    assert!(page.contains("good/model.png") && page.contains("class=\"fail\""), "{page}");
    let unknown = run(&["gallery", "--only", "nothing", "-o", &folder.path("x")]);
    assert!(unknown.code == Some(2) && unknown.err.contains("gonen-fig-08"), "{}", unknown.err);
    assert_eq!(run(&["gallery", &folder.path("missing"), "-o", &folder.path("x")]).code, Some(2));
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    assert_eq!(run(&["gallery", &own, "-o", &folder.path("wall")]).code, Some(2));
}

const TWO_PIECES: &str = "fixtures/recipes/two-piece-d-form.toml";

#[test]
fn the_two_piece_recipe_gives_two_pieces_and_the_same_bytes_twice() {
    let recipe = fs::canonicalize(TWO_PIECES).expect("the recipe");
    let folders = [Folder::new("twice-a"), Folder::new("twice-b")];
    let told = folders.each_ref().map(|folder| {
        let ran = ran(program()
            .current_dir(&folder.0)
            .args(["--json", "run"])
            .arg(&recipe)
            .args(["-o", "out"]));
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        ran.out
    });
    assert_eq!(told[0], told[1]);
    let told: Value = serde_json::from_str(&told[0]).expect("JSON");
    assert_eq!(
        (&told["fabrication"]["pieces"], &told["verdict"]),
        (&Value::from(2), &Value::from("pass"))
    );
    let [first, second] = folders.each_ref().map(|folder| {
        let strip = |(path, bytes): (PathBuf, _)| {
            (path.strip_prefix(&folder.0).expect("inside").to_owned(), bytes)
        };
        folder.contents().into_iter().map(strip).collect::<Vec<_>>()
    });
    assert_eq!(first, second);
    for name in [
        "model.obj",
        "model.png",
        "report.json",
        "pieces.json",
        "layout.json",
        "sheet-01.svg",
        "sheet-01.png",
    ] {
        let found = first.iter().find(|(path, _)| path == &Path::new("out").join(name));
        assert!(
            found.is_some_and(|(_, bytes)| bytes.as_ref().is_some_and(|b| b.len() > 100)),
            "{name}"
        );
    }
    let text = fs::read_to_string(folders[0].path("out/pieces.json")).expect("pieces");
    let (net, command) = read_pieces_json(&text).expect("our own file");
    assert!(command.starts_with("kerfold --json run "));
    assert_eq!((net.pieces.len(), net.proof.overlaps), (2, 0));
    assert!(net.proof.congruence_mm < 1e-9 && net.proof.refold_mm < 1e-6, "{:?}", net.proof);
}

#[test]
fn lint_tells_what_it_finds_and_passes_our_own_sheets() {
    let folder = Folder::new("lint");
    let model = good_model(&folder);
    let out = folder.path("out");
    let formats = "dxf,pdf,svg,lbrn2";
    let ran = run(&[
        "unfold",
        &model,
        "--format",
        formats,
        "--material",
        "ply3",
        "--tile",
        "a4",
        "-o",
        &out,
    ]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.contains("min on the machine for Birch plywood 3 mm"), "{}", ran.out);
    let sheets = ["svg", "dxf", "pdf"].map(|ending| folder.path(&format!("out/sheet-01.{ending}")));
    let sheets: Vec<&str> = sheets.iter().map(String::as_str).collect();
    let ran = run(&[&["lint", "--material", "ply3"], &sheets[..]].concat());
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "{}", ran.out);
    assert_eq!(ran.out.matches("600 × 400 mm: pass").count(), 2, "{}", ran.out);
    let ran = run(&["lint", "fixtures/lint/14-bow-tie.svg", sheets[0], "--json"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""));
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    let findings = [0, 1].map(|i| told["files"][i]["findings"].as_array().map(Vec::len));
    assert_eq!((findings, &told["verdict"]), ([Some(1), Some(0)], &Value::from("fail")));
    assert_eq!(told["files"][0]["findings"][0]["check"], "self-crossing");
    assert!(run(&["lint", "--quiet", "fixtures/lint/05-text.svg"]).out.is_empty());
    for (arguments, words) in [
        (&["lint", "nothing.svg"][..], "cannot be read"),
        (&["lint", "fixtures/bad/empty.obj"], "empty"),
        (&["lint", "fixtures/bad/word.obj"], "neither SVG, DXF nor PDF"),
        (&["lint", sheets[0], "--gap", "0"], "gap is 0 mm"),
        (&["lint", sheets[0], "--material", "ply"], "did you mean"),
        (&["unfold", &model, "--format", "svg,png", "-o", &out], "`png`"),
        (&["unfold", &model, "--material", "unobtainium", "-o", &out], "known are"),
        (&["kerf-test", "--thickness", "3mm", "-o", "kerf.png"], ".lbrn2"),
        (&["kerf-test", "-o", "kerf.svg"], "--thickness"),
        (&["kerf-test", "--thickness", "0.1mm", "-o", "kerf.svg"], "0.3"),
    ] {
        let ran = run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(ran.err.contains(words), "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn seams_are_listed_up_to_symmetry_or_the_best_of_too_many() {
    let folder = Folder::new("seams");
    let model = good_model(&folder);
    let told = |arguments: &[&str]| {
        let ran = run(&[&["seams", &model, "--json"], arguments].concat());
        assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
        let value: Value = serde_json::from_str(&ran.out).expect("JSON");
        let rows = value["matchings"].as_array().expect("rows").clone();
        let columns = rows
            .iter()
            .map(|r| (r["pieces"].as_u64(), r["seam_cycles"].as_u64(), r["orbit"].as_u64()));
        (columns.collect::<Vec<_>>(), value["notes"].as_array().expect("notes").len())
    };
    assert_eq!(told(&[]), (vec![(Some(2), Some(1), Some(30)), (Some(4), Some(3), Some(6))], 0));
    let (rows, notes) = told(&["--limit", "10"]);
    assert_eq!((rows.len(), rows[1], notes), (2, (Some(2), Some(1), None), 1));
    let octahedron = folder.path("octahedron.obj");
    assert_eq!(run(&["solid", "octahedron", "-o", &octahedron]).code, Some(0));
    let ran = run(&["seams", &octahedron]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("valence 4"), "{}", ran.err);
}

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
fn verify_finds_what_is_wrong_and_trusts_no_proof() {
    let folder = Folder::new("verify");
    let model = good_model(&folder);
    let out = folder.path("out");
    assert_eq!(run(&["unfold", &model, "--sheet", "none", "-o", &out]).code, Some(0));
    let good = fs::read_to_string(folder.path("out/pieces.json")).expect("pieces");
    let path = folder.path("changed.json");
    let verify = |text: &str| {
        fs::write(&path, text).expect("a file");
        run(&["verify", &path, &model, "--json"])
    };
    let ran = verify(&good);
    assert_eq!(ran.code, Some(0), "{}", ran.out);
    // The file may claim what it likes about itself.
    let boasting = good.replace("\"overlaps\": 0", "\"overlaps\": 7");
    assert_ne!(boasting, good);
    assert_eq!(verify(&boasting).code, Some(0));
    // Other units, a face that is no face, a fold bent otherwise: each is a finding.
    for (from, to) in [
        ("\"scale\": 1.0", "\"scale\": 1.0000001"),
        ("\"face\": 3,", "\"face\": 400,"),
        ("\"fold_angle\": 63.4", "\"fold_angle\": 64.4"),
    ] {
        let changed = good.replacen(from, to, 1);
        assert_ne!(changed, good, "{from}");
        let ran = verify(&changed);
        assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{from}");
        let told: Value = serde_json::from_str(&ran.out).expect("JSON");
        assert_eq!(
            (&told["verdict"], told["findings"].as_array().map(Vec::len)),
            (&Value::from("fail"), Some(1))
        );
    }
    for (text, message) in [
        ("", "line 1"),
        ("{}", "is missing"),
        (&good.replace("\"scale\": 1.0", "\"scale\": 0"), "scale"),
    ] {
        let ran = verify(text);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{}", ran.err);
        assert!(ran.err.contains(message), "{}", ran.err);
    }
    let cube = run(&["verify", &folder.path("out/pieces.json"), "fixtures/meshes/cube.obj"]);
    assert_eq!(cube.code, Some(1), "{}", cube.err);
    assert!(cube.out.contains("take the mesh that was unfolded"), "{}", cube.out);
}

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
    = \"5mm\"\npart_files = \"on\"\n";
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

#[test]
fn codes_stand_behind_errors_and_are_explained() {
    let missing = run(&["info", "nothing-here.obj"]);
    assert!(missing.code == Some(2) && missing.err.ends_with(" (E101)\n"), "{}", missing.err);
    let refused =
        run(&["cut", "vertex", "fixtures/meshes/spot.obj", "--select", "valense=4", "-o", "-"]);
    assert!(
        refused.code == Some(2) && refused.err.contains("kerfold explain E292"),
        "{}",
        refused.err
    );
    let told = run(&["explain", "E101", "planarity"]);
    assert_eq!((told.code, told.err.as_str()), (Some(0), ""));
    assert!(told.out.starts_with("E101 File is missing\nThere is no file"), "{}", told.out);
    assert!(told.out.contains("\n\nF104 planarity\n"), "{}", told.out);
    let listed = run(&["explain"]);
    assert!(
        listed.out.lines().count() > 250 && listed.out.contains("\nF201 open-contour\n"),
        "{}",
        listed.out
    );
    let json: Value = serde_json::from_str(&run(&["explain", "e101", "--json"]).out).expect("JSON");
    assert_eq!(json["pages"][0]["title"], "File is missing");
    let unknown = run(&["explain", "E199"]);
    assert_eq!((unknown.code, unknown.out.as_str()), (Some(2), ""));
    assert!(
        unknown.err.contains("did you mean `E201`?") && unknown.err.ends_with(" (E010)\n"),
        "{}",
        unknown.err
    );
    assert_eq!(run(&["explain", "E101", "--quiet"]).out, "");
}

#[test]
fn findings_carry_their_codes_in_text_and_json() {
    let folder = Folder::new("codes");
    let bent = folder.path("bent.obj");
    fs::write(&bent, "v 0 0 0\nv 10 0 0\nv 10 10 5\nv 0 10 0\nf 1 2 3 4\n").expect("a file");
    let text = run(&["check", &bent, "--require", "closed"]);
    assert!(
        text.code == Some(1)
            && text.out.contains("\nF104 planarity  ")
            && text.out.contains("\nF106 closed     "),
        "{}",
        text.out
    );
    let report = folder.path("report.json");
    assert_eq!(run(&["check", &bent, "--report", &report]).code, Some(1));
    let report: Value =
        serde_json::from_str(&fs::read_to_string(report).expect("a report")).expect("JSON");
    assert_eq!(
        (&report["findings"][0]["check"], &report["findings"][0]["code"]),
        (&"planarity".into(), &"F104".into())
    );
}
