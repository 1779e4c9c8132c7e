//! Plates from the command line: what is in the files, and when the exit code is not 0.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("kerfold-panels-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("a plain path").to_owned()
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    fn solid(&self, name: &str) -> String {
        let path = self.path(&format!("{name}.obj"));
        assert!(kerfold(&["solid", name, "--size", "120mm", "-o", &path]).status.success());
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn kerfold(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_kerfold"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_soccer_ball_gives_schedule_sheets_map_and_solids() {
    let folder = Folder::new("ball");
    let model = folder.solid("soccer-ball");
    let out = folder.path("out");
    let ran = kerfold(&[
        "panels",
        &model,
        "--thickness",
        "3mm",
        "--gap",
        "0.5mm",
        "--sheet",
        "300x200",
        "-o",
        &out,
    ]);
    assert_eq!(ran.status.code(), Some(0), "{}", stderr(&ran));
    let json: Value = serde_json::from_str(&folder.read("out/panels.json")).expect("JSON");
    let list = |key: &str| json[key].as_array().expect(key).clone();
    assert_eq!(
        (list("panels").len(), list("edges").len(), list("nodes").len(), list("groups").len()),
        (32, 90, 60, 2)
    );
    assert!(list("panels").iter().all(|p| p["sheet"].as_str().is_some_and(|s| s.starts_with('S'))));
    let mass: f64 = list("panels").iter().filter_map(|p| p["mass"].as_f64()).sum();
    assert!(
        (mass - json["totals"]["mass_kg"].as_f64().expect("a mass")).abs() < 1e-12 && mass > 0.1
    );
    for (name, rows) in
        [("panels.csv", 32), ("edges.csv", 90), ("nodes.csv", 60), ("cutting-list.csv", 2)]
    {
        let text = folder.read(&format!("out/{name}"));
        let lines: Vec<&str> = text.split_terminator("\r\n").collect();
        assert_eq!(lines.len(), rows + 1, "{name}");
        let columns = lines[0].split(',').count();
        assert!(lines[2].split(',').count() == columns, "{name}: {}", lines[2]);
        assert!(lines[1].contains("kerfold panels"), "{name}");
    }
    let step = folder.read("out/plates.step");
    assert_eq!(
        (step.matches("MANIFOLD_SOLID_BREP('P").count(), step.matches("=PRODUCT('P").count()),
        (32, 32)
    );
    assert_eq!(folder.read("out/plates.obj").lines().filter(|l| l.starts_with("g P")).count(), 32);
    assert!(fs::read(folder.path("out/plates.glb")).expect("a file").starts_with(b"glTF"));
    let stl = fs::read(folder.path("out/plates.stl")).expect("a file");
    // 12 pentagons and 20 hexagons: twice n − 2 for front and back, 2n for the sides.
    assert_eq!((stl.len() - 84) / 50, 12 * (2 * 3 + 10) + 20 * (2 * 4 + 12));
    let map = folder.read("out/assembly-map.svg");
    assert!(
        (1..=32).all(|i| map.contains(&format!("class=\"P{i:02}\""))),
        "every panel is on the map"
    );
    assert!(fs::read(folder.path("out/assembly-map.pdf")).expect("a file").starts_with(b"%PDF-"));
    let sheet = folder.read("out/sheet-01.svg");
    assert!(
        sheet.contains("id=\"P01\"") && sheet.contains("number"),
        "panels are named, edges numbered"
    );
}

#[test]
fn an_octahedron_is_a_finding_when_three_edges_are_required() {
    let folder = Folder::new("octahedron");
    let model = folder.solid("octahedron");
    let panels = |extra: &[&str]| {
        let out = folder.path("out");
        kerfold(
            &[
                &["panels", &model, "--thickness", "3mm", "--solids", "none", "--json", "-o", &out],
                extra,
            ]
            .concat(),
        )
    };
    assert_eq!(panels(&[]).status.code(), Some(0));
    let ran = panels(&["--require", "valence3"]);
    assert_eq!(ran.status.code(), Some(1), "{}", stderr(&ran));
    let told: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
    assert_eq!(
        (told["panels"]["verdict"].as_str(), told["panels"]["findings"].as_array().map(Vec::len)),
        (Some("fail"), Some(6))
    );
    // Regular: the offsets of all four planes still meet.
    assert_eq!(panels(&["--require", "conical"]).status.code(), Some(0));
    // One vertex moved off all planes of symmetry.
    let text = folder.read("octahedron.obj");
    let first = text.lines().find(|l| l.starts_with("v ")).expect("a vertex");
    let shift =
        |(word, by): (&str, f64)| format!("{}", word.parse::<f64>().expect("a number") + by);
    let moved: Vec<String> =
        first.split_whitespace().skip(1).zip([6.0, 9.0, -4.0]).map(shift).collect();
    fs::write(&model, text.replacen(first, &format!("v {}", moved.join(" ")), 1)).expect("a file");
    let ran = panels(&["--require", "conical"]);
    assert_eq!(ran.status.code(), Some(1), "{}", stderr(&ran));
    let told: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
    assert!(told["panels"]["largest_residual_mm_per_mm"].as_f64().is_some_and(|r| r > 1e-3));
}

#[test]
fn what_cannot_be_made_is_told_and_nothing_is_written() {
    let folder = Folder::new("refused");
    let model = folder.solid("truncated-octahedron");
    let cases: &[(&[&str], &str)] = &[
        (&[], "panels need a thickness"),
        (&["--thickness", "0"], "thickness is 0, but must be above 0"),
        (&["--thickness", "60mm"], "the largest thickness that works everywhere is"),
        (&["--thickness", "1mm", "--gap", "80mm"], "make the gap narrower"),
        (&["--thickness", "3mm", "--joint", "flaps"], "panels do not take joint"),
        (&["--thickness", "3mm", "--hole-inset", "4mm"], "hole-inset is used by no edge"),
        (&["--thickness", "3mm", "--thickness-of", "roof=4mm"], "there is no group `roof`"),
        (&["--thickness", "3mm", "--edges", "0-90:buttt"], "write it like butt"),
        (&["--thickness", "3mm", "--sheet", "20x20", "--margin", "1"], "too large"),
    ];
    for (options, message) in cases {
        let out = folder.path("out");
        let ran = kerfold(&[&["panels", &model, "-o", &out], *options].concat());
        assert_eq!(ran.status.code(), Some(2), "{options:?}");
        assert!(stderr(&ran).contains(message), "{options:?}: {}", stderr(&ran));
        assert!(!PathBuf::from(out).exists(), "{options:?}");
    }
}

#[test]
fn the_recipe_step_writes_the_same_bytes_as_the_verb() {
    let folder = Folder::new("recipe");
    let recipe = "[[step]]\nsolid = \"dodecahedron\"\nsize = \"120mm\"\n[[step]]\npanels = \
    \"mid\"\nthickness = 4\n\
                  edges = \"30-140:finger\"\nfinger_width = \"12mm\"\nsolids = [\"obj\"]\ntitle = \"model\"\nrequire \
                  = [\"valence3\"]\n";
    fs::write(folder.path("recipe.toml"), recipe).expect("a file");
    let ran = kerfold(&["run", &folder.path("recipe.toml"), "-o", &folder.path("run")]);
    assert_eq!(ran.status.code(), Some(0), "{}", stderr(&ran));
    let verb = [
        "panels",
        &folder.path("run/model.obj"),
        "--side",
        "mid",
        "--thickness",
        "4",
        "--edges",
        "30-140:finger",
    ];
    let more = ["--finger-width", "12mm", "--solids", "obj", "-o", &folder.path("verb")];
    let ran = kerfold(&[&verb[..], &more[..]].concat());
    assert_eq!(ran.status.code(), Some(0), "{}", stderr(&ran));
    // But for the command line that every file carries.
    let without_command = |name: &str| {
        let text = folder.read(name);
        text.lines().filter(|l| !l.contains("kerfold ")).map(str::to_owned).collect::<Vec<_>>()
    };
    for name in [
        "panels.json",
        "panels.csv",
        "edges.csv",
        "plates.obj",
        "pieces.json",
        "sheet-01.svg",
        "assembly-map.svg",
    ] {
        let (run, verb) =
            (without_command(&format!("run/{name}")), without_command(&format!("verb/{name}")));
        assert!(run.len() > 5, "{name}");
        assert_eq!(run, verb, "{name}");
    }
    assert!(folder.read("run/edges.csv").contains(",finger,"), "fingers were made");
}
