//! Every verb once or more, with what it takes and what it writes.

use std::fs;

use super::harness::{Folder, good_model, run};

/// What stands for IN: each kind comes good, empty, broken and missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// A mesh file.
    Mesh,
    /// A file of half-spaces.
    Planes,
    /// Pieces, for `verify` with the mesh that they are of.
    Pieces,
    /// A sheet.
    Drawing,
    /// A recipe.
    Recipe,
    /// A folder of recipes.
    Recipes,
    /// One of some words: a good one and a broken one.
    Word(&'static str, &'static str),
    /// Nothing.
    Nothing,
}

/// A call: IN is what the verb takes, MODEL a good mesh, OUT the file or folder that it writes.
pub struct Row {
    pub arguments: &'static [&'static str],
    pub takes: Takes,
    /// The name of what it writes; empty for nothing.
    pub writes: &'static str,
}

const fn row(takes: Takes, arguments: &'static [&'static str], writes: &'static str) -> Row {
    Row { arguments, takes, writes }
}

use Takes::{Drawing, Mesh, Nothing, Pieces, Planes, Recipe, Recipes, Word};

pub const ROWS: &[Row] = &[
    row(
        Word("dodecahedron", "dodecahedrn"),
        &["solid", "IN", "--size", "100mm", "-o", "OUT"],
        "out.obj",
    ),
    row(Mesh, &["info", "IN"], ""),
    row(Mesh, &["check", "IN"], ""),
    row(Mesh, &["check", "IN", "--report", "OUT"], "report.json"),
    row(Mesh, &["check", "IN", "--report", "OUT", "--up", "y", "--view", "iso"], "report.html"),
    row(Mesh, &["check", "IN", "--report", "OUT", "--rows", "all"], "report.pdf"),
    row(Mesh, &["check", "IN", "--rows", "all", "--report", "OUT"], "report.csv"),
    row(
        Mesh,
        &["cut", "vertex", "IN", "--select", "all", "--offset", "0.25", "-o", "OUT"],
        "out.obj",
    ),
    row(Mesh, &["cut", "edge", "IN", "--select", "0", "--offset", "0.2", "-o", "OUT"], "out.ply"),
    row(Mesh, &["cut", "face", "IN", "--select", "0", "-o", "OUT"], "out.off"),
    row(Mesh, &["cut", "plane", "IN", "--normal", "z", "--point", "0,0,0", "-o", "OUT"], "out.stl"),
    row(Mesh, &["hull", "IN", "-o", "OUT"], "hull.ply"),
    row(Mesh, &["hull", "IN", "--dual", "--steps", "1,all", "-o", "OUT"], "dual.obj"),
    row(Planes, &["hull", "--planes", "IN", "-o", "OUT"], "crystal.obj"),
    row(Mesh, &["subdivide", "doo-sabin", "IN", "--rounds", "2", "-o", "OUT"], "out.obj"),
    row(Mesh, &["sierpinski", "IN", "--rounds", "2", "-o", "OUT"], "out.obj"),
    row(
        Mesh,
        &["rind", "IN", "--thickness", "2mm", "--punch", "0", "--peel", "1,2", "-o", "OUT"],
        "out.obj",
    ),
    row(Mesh, &["menger", "IN", "--thickness", "1/4", "-o", "OUT"], "out.obj"),
    row(
        Mesh,
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
    row(
        Mesh,
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
    row(Mesh, &["planarize", "IN", "-o", "OUT"], "out.obj"),
    row(Mesh, &["merge", "IN", "--tolerance", "0.02mm", "-o", "OUT"], "merged.obj"),
    row(Mesh, &["repair", "IN", "--close-holes", "10mm", "-o", "OUT"], "repaired.obj"),
    row(Mesh, &["simplify", "IN", "--faces", "20", "-o", "OUT"], "simple.obj"),
    row(Mesh, &["panelize", "IN", "--count", "24", "-o", "OUT"], "out.obj"),
    row(Mesh, &["unfold", "IN", "--sheet", "600x400", "-o", "OUT"], "out"),
    row(Mesh, &["unfold", "IN", "--sheet", "none", "--assembly", "pictures", "-o", "OUT"], "shown"),
    row(Mesh, &["seams", "IN"], ""),
    row(Mesh, &["dform", "IN", "--rounds", "1", "-o", "OUT"], "out"),
    row(
        Word("ellipse-2x1", "elipse-2x1"),
        &["dform", "--outlines", "IN", "--zip", "0.12", "--points", "24", "-o", "OUT"],
        "zipped",
    ),
    row(Mesh, &["panels", "IN", "--thickness", "2mm", "--gap", "1mm", "-o", "OUT"], "panels"),
    row(Pieces, &["verify", "IN", "MODEL"], ""),
    row(Pieces, &["nest", "IN", "--sheet", "900x900", "--effort", "1", "-o", "OUT"], "nested"),
    row(Drawing, &["lint", "IN"], ""),
    row(Word("ply3", "plyy3"), &["kerf-test", "--material", "IN", "-o", "OUT"], "kerf.svg"),
    row(Recipe, &["run", "IN", "-o", "OUT"], "made"),
    row(Recipes, &["gallery", "IN", "--width", "64", "-o", "OUT"], "site"),
    row(Mesh, &["render", "IN", "--width", "64", "-o", "OUT"], "out.png"),
    row(Word("E101", "E1x1"), &["explain", "IN"], ""),
    row(Word("merge", "mrege"), &["help", "IN"], ""),
    row(Word("bash", "bsh"), &["completions", "IN"], ""),
    row(Nothing, &["man", "-o", "OUT"], "man"),
];

impl Row {
    /// The arguments with files in their places.
    pub fn fill<'a>(&self, input: &'a str, model: &'a str, output: &'a str) -> Vec<&'a str>
    where
        'static: 'a,
    {
        let filled = self.arguments.iter().map(|&argument| match argument {
            "IN" => input,
            "MODEL" => model,
            "OUT" => output,
            _ => argument,
        });
        filled.collect()
    }

    /// Its place in the arguments where IN stands.
    pub fn place(&self) -> Option<usize> {
        self.arguments.iter().position(|&argument| argument == "IN")
    }
}

/// What a row can be called with: a good input, and bad ones with words of their messages.
pub struct Samples {
    pub good: String,
    pub bad: Vec<(String, &'static str)>,
}

/// The inputs of a kind, made in a folder of which `model` is a good mesh and `out` what `unfold`
/// made of it.
pub fn samples(folder: &Folder, takes: Takes) -> Samples {
    let file = |name: &str, text: &str| {
        let path = folder.path(name);
        fs::write(&path, text).expect("a file");
        path
    };
    let missing = folder.path("nothing-here.obj");
    let empty = file("empty", "");
    let fixed = str::to_owned;
    match takes {
        Mesh => Samples {
            good: folder.path("model.obj"),
            bad: vec![
                (fixed("fixtures/bad/empty.obj"), "is empty"),
                (fixed("fixtures/bad/word.obj"), "as in `v 0 1.5 2`"),
                (fixed("fixtures/bad/garbage.stl"), "export the model again"),
                (missing, "there is no file"),
            ],
        },
        Planes => Samples {
            good: fixed("fixtures/planes/octahedron.csv"),
            bad: vec![
                (empty, "there are no half-spaces"),
                (file("word.csv", "1,0,0,1\n0,0,up,1\n"), "word.csv:2:5: `up` is not a number"),
                (missing, "nothing-here"),
            ],
        },
        Pieces => Samples {
            good: folder.path("out/pieces.json"),
            bad: vec![
                (empty, "line 1"),
                (file("no-pieces.json", "{}"), "pieces"),
                (missing, "nothing-here"),
            ],
        },
        Drawing => Samples {
            good: folder.path("out/sheet-01.svg"),
            bad: vec![
                (empty, "empty"),
                (fixed("fixtures/bad/word.obj"), "neither SVG, DXF nor PDF"),
                (missing, "nothing-here"),
            ],
        },
        Recipe => Samples {
            good: file("good.toml", "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n"),
            bad: vec![
                (empty, "[[step]]"),
                (fixed("fixtures/bad-recipes/syntax.toml"), "line 2"),
                (missing, "cannot be read"),
            ],
        },
        Recipes => {
            let [good, none] = ["recipes", "no-recipes"].map(|name| {
                fs::create_dir_all(folder.path(name)).expect("a folder");
                folder.path(name)
            });
            file("recipes/cube.toml", "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n");
            Samples {
                good,
                bad: vec![
                    (none, "no recipes"),
                    (fixed("fixtures/bad/word.obj"), "word.obj"),
                    (missing, "nothing-here"),
                ],
            }
        }
        Word(good, broken) => Samples {
            good: fixed(good),
            bad: vec![
                (fixed(broken), broken),
                (fixed(""), ""),
                (fixed("nothing-here"), "nothing-here"),
            ],
        },
        Nothing => Samples { good: String::new(), bad: Vec::new() },
    }
}

/// A folder with a good mesh and its sheets, from which all samples come.
pub fn inputs(name: &str) -> Folder {
    let folder = Folder::new(name);
    let model = good_model(&folder);
    let made = run(&["unfold", &model, "--sheet", "600x400", "-o", &folder.path("out")]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    folder
}
