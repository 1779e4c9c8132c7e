//! The figures of the papers as recipes: every one is read, and those that are quick are carried
//! out and keep what their captions promise.

use std::path::{Path, PathBuf};

use kerfold::measure::{genus, volume};
use kerfold::progress::Silent;
use kerfold::recipe::{Job, Recipe};
use kerfold::unfold::prove;

const FOLDER: &str = "fixtures/recipes/gallery";

/// Recipes that take a moment even without optimisation; components, and the genus summed over
/// them.
const QUICK: &[(&str, usize, usize)] = &[
    ("sierpinski-fig-01-b-cube", 1, 125),
    ("sierpinski-fig-11-a1-tetrahedron", 1, 3),
    ("sierpinski-fig-12-b-catmull-clark", 1, 7),
    ("srinivasan-fig-14-unity-knot", 1, 1),
    ("srinivasan-fig-19-octagon-to-triangle", 1, 0),
    ("srinivasan-fig-20-b-quarter-turn", 1, 0),
    ("srinivasan-fig-21-non-star-ends", 1, 0),
    ("srinivasan-fig-23-spiral-peel", 1, 0),
    ("srinivasan-fig-24-b-walls", 1, 1),
    ("srinivasan-fig-24-c-peeled", 1, 0),
    ("srinivasan-fig-25-rind-of-a-frame", 1, 3),
    ("srinivasan-fig-31-nested-balls", 2, 22),
    ("srinivasan-fig-32-branching", 1, 0),
    ("srinivasan-fig-33-teapot", 1, 2),
    ("srinivasan-fig-39-b-cube", 1, 125),
    ("srinivasan-fig-62-cube", 1, 81),
    ("srinivasan-fig-64-dodecahedron", 1, 11),
    ("srinivasan-fig-65-cup", 1, 1),
    ("srinivasan-fig-66-sierpinski-and-menger", 1, 41),
    ("srinivasan-future-hub-inside", 1, 11),
    ("srinivasan-future-hub-outside", 1, 2),
];

fn recipes() -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(FOLDER)
        .expect("the gallery")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    paths
}

fn read(path: &Path) -> Recipe {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert!(text.starts_with("# "), "{} does not say which figure it shows", path.display());
    Recipe::parse(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[test]
fn every_recipe_is_read_and_has_a_name() {
    let paths = recipes();
    assert!(paths.len() > 50, "{} recipes", paths.len());
    for path in &paths {
        assert!(read(path).name.is_some(), "{}", path.display());
    }
}

#[test]
fn quick_recipes_keep_what_their_captions_promise() {
    for &(name, components, expected) in QUICK {
        let recipe = read(&Path::new(FOLDER).join(format!("{name}.toml")));
        let job =
            Job::run(&recipe, Path::new(FOLDER), &Silent).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mesh = job.mesh().expect("a mesh");
        assert!(mesh.faults().is_empty(), "{name}: {:?}", mesh.faults().first());
        assert_eq!((mesh.components().len(), genus(mesh)), (components, expected), "{name}");
        assert!(volume(mesh) > 0.0, "{name}");
        let report = job.report().expect("a report");
        let findings: Vec<&str> =
            report.findings.iter().take(3).map(|f| f.message.as_str()).collect();
        assert!(job.is_check_asked && findings.is_empty(), "{name}: {findings:?}");
    }
}

/// Objects of genus above 0 on their way to card and plywood: pieces without overlap, proved once
/// more, and the same surface again.
#[test]
fn what_is_fabricated_is_planar_and_comes_apart() {
    for (name, expected) in [
        ("fabricated-menger-cube-unfolded", 5),
        ("fabricated-peeled-ball-unfolded", 11),
        ("fabricated-menger-rounded", 5),
        ("fabricated-honeycomb-planar", 0),
    ] {
        let recipe = read(&Path::new(FOLDER).join(format!("{name}.toml")));
        let job =
            Job::run(&recipe, Path::new(FOLDER), &Silent).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mesh = job.mesh().expect("a mesh");
        assert_eq!(genus(mesh), expected, "{name}");
        assert!(job.report().expect("a report").findings.is_empty(), "{name}");
        let (fabrication, _) = job.fabrication.as_ref().expect("pieces");
        let proof = prove(mesh, &fabrication.net).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(proof.overlaps == 0 && !fabrication.sheets.drawings.is_empty(), "{name}");
    }
    let name = "fabricated-menger-lamp";
    let recipe = read(&Path::new(FOLDER).join(format!("{name}.toml")));
    let job =
        Job::run(&recipe, Path::new(FOLDER), &Silent).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mesh = job.mesh().expect("a mesh");
    let (panelled, _) = job.panelled.as_ref().expect("plates");
    assert_eq!((genus(mesh), panelled.fabrication.net.pieces.len()), (11, mesh.face_count()));
    assert!(
        job.report().expect("a report").findings.is_empty()
            && !panelled.fabrication.sheets.drawings.is_empty()
    );
}
