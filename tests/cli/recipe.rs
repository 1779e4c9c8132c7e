//! `run`: recipes, good and bad.

use std::fs;
use std::path::{Path, PathBuf};

use kerfold::io::pieces_json::read_pieces_json;
use serde_json::Value;

use super::harness::{Folder, program, ran, run};

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
fn a_sweep_is_commands_that_run_as_they_stand_and_one_table_of_results() {
    let folder = Folder::new("sweep");
    let (recipe, table) = (folder.path("cube.toml"), folder.path("sizes.csv"));
    let text = "[parameters]\nsize = \"20mm\"\noffset = 0.2\n[[step]]\nsolid = \"cube\"\nsize = \
        \"{size}\"\n[[step]]\ncut = \"vertex\"\nselect = \"all\"\noffset = \"{offset}\"\n";
    fs::write(&recipe, text).expect("a recipe");
    fs::write(&table, "name,size,offset\nsmall,10mm,\nlarge,\"40 mm\",0.5\n").expect("a table");
    let (out, results) = (folder.path("out"), folder.path("results.csv"));
    let sweep = ["run", &recipe, "--sweep", &table, "-o", &out];
    let listed = run(&sweep);
    assert_eq!((listed.code, listed.err.as_str()), (Some(0), ""), "{}", listed.out);
    let commands = fs::read_to_string(folder.path("out/commands.txt")).expect("a list");
    assert_eq!(commands.lines().count(), 2);
    let gather = || run(&[&sweep[..], &["--results", &results]].concat());
    assert_eq!(gather().code, Some(1), "nothing has run");
    let rows = || fs::read_to_string(&results).expect("a table");
    assert_eq!(rows(), "name,size,offset,state\nsmall,10mm,,not run\nlarge,40 mm,0.5,not run\n");
    // The list runs as it stands, in a shell that finds the program.
    #[cfg(unix)]
    {
        let place = Path::new(env!("CARGO_BIN_EXE_kerfold")).parent().expect("a folder");
        let path = std::env::var("PATH").unwrap_or_default();
        let mut shell = std::process::Command::new("sh");
        shell.arg(folder.path("out/commands.txt"));
        shell.env("PATH", format!("{}:{path}", place.display()));
        let done = ran(&mut shell);
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert_eq!(gather().code, Some(0));
        let found = rows();
        let faces: Vec<&str> =
            found.lines().skip(1).map(|l| l.split(',').nth(5).unwrap_or("")).collect();
        assert!(found.starts_with("name,size,offset,state,verdict,model.edges,"), "{found}");
        assert_eq!(faces, ["36", "24"], "edges of a truncated cube and a cuboctahedron: {found}");
        let manifest = fs::read(folder.path("out/large/manifest.json")).expect("a manifest");
        let told: Value = serde_json::from_slice(&manifest).expect("JSON");
        assert_eq!(told["parameters"]["size"], "40 mm");
        for file in told["files"].as_array().expect("a list") {
            let name = file["name"].as_str().expect("a name");
            let size =
                fs::metadata(folder.path("out/large").clone() + "/" + name).expect(name).len();
            assert_eq!(file["bytes"].as_u64(), Some(size), "{name}");
        }
    }
    // The example of the guide.
    let [roof, variants] = ["roof.toml", "roof.csv"].map(|name| format!("fixtures/sweeps/{name}"));
    let listed = run(&["run", &roof, "--sweep", &variants, "-o", &folder.path("roofs")]);
    assert!(listed.out.contains("200 commands"), "{}{}", listed.out, listed.err);
    fs::write(&table, "size\n10mm\n2 miles\n").expect("a table");
    let refused = run(&sweep);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("line 3") && refused.err.contains("(E776)"), "{}", refused.err);
}
