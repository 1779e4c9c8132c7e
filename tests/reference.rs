//! `docs/reference.md` is what the program itself says, and its table of files is what the program
//! writes.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use golden::assert_golden;

#[path = "golden/mod.rs"]
mod golden;

#[test]
fn the_reference_is_that_of_the_program() {
    assert_golden("docs/reference.md", &kerfold::cli::reference());
}

/// The flags and verbs that a text names: words after `kerfold` and words that begin with two
/// hyphens, in code.
fn called(text: &str) -> (BTreeSet<&str>, BTreeSet<&str>) {
    let (mut flags, mut verbs) = (BTreeSet::new(), BTreeSet::new());
    for code in text.split('`').skip(1).step_by(2) {
        let mut words = code.split_whitespace().peekable();
        while let Some(word) = words.next() {
            if word.starts_with("--") && word.len() > 2 {
                flags.insert(word.split('=').next().unwrap_or(word));
            }
            if word == "kerfold" {
                verbs.extend(
                    words
                        .peek()
                        .filter(|verb| verb.chars().all(|c| c.is_ascii_lowercase() || c == '-')),
                );
            }
        }
    }
    (flags, verbs)
}

#[test]
fn the_pages_of_errors_name_options_and_verbs_that_exist() {
    let made = kerfold::cli::reference();
    let pages: Vec<&str> = kerfold::explain::pages().iter().map(|page| page.text).collect();
    let text = pages.join("\n");
    let (flags, verbs) = called(&text);
    assert!(flags.len() > 40 && verbs.len() > 10, "the pages were not read");
    let is_known =
        |flag: &&&str| [" ", "`", "["].iter().any(|end| made.contains(&format!("{flag}{end}")));
    let unknown: Vec<_> = flags.iter().filter(|flag| !is_known(flag)).collect();
    assert!(unknown.is_empty(), "docs/errors.md names options that no verb has: {unknown:?}");
    let unknown: Vec<_> =
        verbs.iter().filter(|verb| !made.contains(&format!("\n### kerfold {verb}"))).collect();
    assert!(unknown.is_empty(), "docs/errors.md names verbs that there are not: {unknown:?}");
    assert_eq!(
        called("`kerfold fly --wings 2` --no `-o`"),
        (BTreeSet::from(["--wings"]), BTreeSet::from(["fly"]))
    );
}

/// The names in the table of files.
fn listed() -> BTreeSet<String> {
    let made = kerfold::cli::reference();
    let (_, files) = made.split_once("\n## Files\n").expect("a table of files");
    files
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once('`'))
        .map(|(name, _)| name.to_owned())
        .collect()
}

/// A file's name as the table has it: `sheet-01-a4.pdf` is `sheet-NN-PAPER.pdf`.
fn general(name: &str) -> String {
    let name = name.replace("-a4.pdf", "-PAPER.pdf");
    if let Some(verb) = name.strip_prefix("kerfold-").filter(|rest| rest.ends_with(".1")) {
        assert!(!verb.is_empty());
        return "kerfold-VERB.1".to_owned();
    }
    let (stem, ending) = name.rsplit_once('.').expect("an ending");
    let digits = stem.find(|c: char| c.is_ascii_digit());
    let stem = match digits {
        Some(at) => {
            let rest = stem[at..].trim_start_matches(|c: char| c.is_ascii_digit());
            format!("{}NN{rest}", &stem[..at])
        }
        None => stem.to_owned(),
    };
    // Parts are listed once, for all formats.
    if stem == "PNN" { "PNN.svg".to_owned() } else { format!("{stem}.{ending}") }
}

fn run(arguments: &[&str]) {
    let ran = Command::new(env!("CARGO_BIN_EXE_kerfold"))
        .args(arguments)
        .output()
        .expect("the program starts");
    assert_eq!(
        ran.status.code(),
        Some(0),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&ran.stderr)
    );
}

#[test]
fn the_files_of_the_table_are_those_that_are_written() {
    let folder = std::env::temp_dir().join(format!("kerfold-reference-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    let path = |name: &str| folder.join(name).to_str().expect("a plain path").to_owned();
    let (model, recipe) = (path("cube.obj"), path("recipe.toml"));
    run(&["solid", "cube", "--size", "60mm", "-o", &model]);
    let formats = "svg,dxf,pdf,lbrn2";
    let unfold = [
        "unfold",
        &model,
        "--assembly",
        "pictures",
        "--format",
        formats,
        "--tile",
        "a4",
        "--part-files",
        "on",
    ];
    run(&[&unfold[..], &["-o", &path("unfolded")]].concat());
    run(&[
        "panels",
        &model,
        "--thickness",
        "3mm",
        "--solids",
        "step,obj,glb,stl",
        "--drawings",
        "pdf,dxf",
        "-o",
        &path("panels"),
    ]);
    run(&["dform", "tetrahedron", "--rounds", "1", "-o", &path("dform")]);
    let outlines = ["dform", "--outlines", "circle", "ellipse-2x1", "--points", "24", "--list"];
    run(&[&outlines[..], &["-o", &path("listed")]].concat());
    run(&["nest", &path("unfolded/pieces.json"), "-o", &path("nested")]);
    run(&["man", "-o", &path("manual")]);
    let steps = "[[step]]\nsolid = \"cube\"\n\n[[step]]\nhull = \"dual\"\nsteps = \
    \"1,all\"\n\n[[step]]\ncut = \"vertex\"\nselect = \"all\"\noffset = \
    0.2\n\n[[step]]\ncheck = \"glass\"\n\n\
                 [[step]]\nrender = \"iso\"\nwidth = 64\nbefore = \"on\"\nstory = [\"cut\", \"model\", \"sheets\"]\n\n[[step]]\nunfold = \"auto\"\n";
    fs::write(&recipe, steps).expect("a recipe");
    run(&["run", &recipe, "-o", &path("made")]);

    let mut written = BTreeSet::new();
    for name in ["unfolded", "panels", "dform", "listed", "nested", "manual", "made"] {
        for entry in fs::read_dir(path(name)).expect("a folder") {
            written.insert(general(&entry.expect("an entry").file_name().to_string_lossy()));
        }
    }
    let _ = fs::remove_dir_all(&folder);
    assert_eq!(
        written,
        listed(),
        "mend the table of src/cli/reference/files.rs, then KERFOLD_BLESS=1 cargo test --test reference"
    );
}
