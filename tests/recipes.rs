//! Every recipe of the fixtures runs, with the pieces that its figure shows, and its pieces are
//! proved once more.

use std::path::Path;

use kerfold::progress::Silent;
use kerfold::recipe::{Job, Recipe};
use kerfold::unfold::prove;

/// Recipe, pieces, and the genus of the model. Figures are those of the thesis.
const RECIPES: &[(&str, usize, usize)] = &[
    ("d-form-outlines-one-piece.toml", 1, 0),
    ("d-form-outlines-planes.toml", 2, 0),
    ("d-form-outlines-two-ellipses.toml", 2, 0),
    ("gonen-fig-17-cones.toml", 2, 0),
    ("gonen-fig-17-even-cuts.toml", 2, 0),
    ("gonen-fig-17-leaning-cuts.toml", 2, 0),
    ("gonen-fig-17-one-sided-cuts.toml", 2, 0),
    ("gonen-fig-18-three-piece-dodecahedron.toml", 3, 0),
    ("gonen-fig-19-two-piece-dodecahedron.toml", 2, 0),
    ("gonen-fig-20-two-y-pieces-octahedron.toml", 2, 0),
    ("gonen-fig-21-five-piece-truncated-tetrahedron.toml", 5, 0),
    ("gonen-fig-21-four-piece-dodecahedron.toml", 4, 0),
    ("gonen-fig-21-four-piece-hexagonal-prism.toml", 4, 0),
    ("gonen-fig-21-six-piece-truncated-cube.toml", 6, 0),
    ("one-piece-d-form-torus.toml", 1, 1),
    ("one-piece-torus.toml", 1, 1),
    ("two-piece-d-form.toml", 2, 0),
];

/// Recipes that end with a model: its genus.
const MODELS: &[(&str, usize)] = &[
    ("cup.toml", 1),
    ("menger-cube.toml", 81),
    ("peeled-ball.toml", 11),
    ("sierpinski-tetrahedron.toml", 15),
];

fn run(name: &str) -> Job {
    let folder = Path::new("fixtures/recipes");
    let text = std::fs::read_to_string(folder.join(name)).expect(name);
    let recipe = Recipe::parse(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
    Job::run(&recipe, folder, &Silent).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn every_recipe_gives_its_pieces_without_overlap() {
    let mut listed: Vec<String> = std::fs::read_dir("fixtures/recipes")
        .expect("recipes")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    listed.sort();
    let mut known: Vec<&str> =
        RECIPES.iter().map(|r| r.0).chain(MODELS.iter().map(|m| m.0)).collect();
    known.sort_unstable();
    assert_eq!(listed, known);
    for &(name, pieces, genus) in RECIPES {
        let job = run(name);
        let mesh = job.mesh().expect("a mesh");
        let (fabrication, _) = job.fabrication.as_ref().expect("pieces");
        assert_eq!(fabrication.net.pieces.len(), pieces, "{name}");
        assert_eq!(kerfold::measure::genus(mesh), genus, "{name}");
        let proof = prove(mesh, &fabrication.net).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(proof.overlaps, 0, "{name}");
        assert!(!fabrication.sheets.drawings.is_empty(), "{name}");
    }
}

/// The figures that the thesis shows smooth: three edges at every vertex, no cut meets another, and
/// all pieces lie on their sheets with even strips.
#[test]
fn smooth_figures_are_rolled_with_clean_seams() {
    for &(name, ..) in RECIPES.iter().filter(|r| r.0.starts_with("gonen") || r.0.starts_with("two"))
    {
        let job = run(name);
        let mesh = job.mesh().expect("a mesh");
        assert!(mesh.vertices().all(|v| mesh.valence(v) == 3), "{name}");
        let note = job.notes.iter().find(|note| note.contains("met each other"));
        assert_eq!(note, None, "{name}");
        let is_rolled = job.notes.iter().any(|note| note.contains("rolled with a radius"));
        assert!(is_rolled || name.ends_with("cuts.toml"), "{name}");
        assert!(kerfold::measure::convexity(mesh).is_convex(), "{name}");
    }
}

/// What `cut edge` promises `unfold` keeps, or nothing is made.
#[test]
fn a_recipe_that_cannot_keep_its_pieces_is_refused() {
    let with = |cut: &str| {
        let text = format!(
            "[[step]]\nsolid = \"truncated-tetrahedron\"\n[[step]]\ncut = \"edge\"\nselect = \
            \"matching:1\"\n{cut}\n[[step]]\nunfold = \"auto\"\n"
        );
        let recipe = Recipe::parse(&text).expect("a recipe");
        Job::run(&recipe, Path::new(""), &Silent)
    };
    let refused = with("offset = 0.9\nrepeat = 2").err().expect("pieces are lost").to_string();
    assert!(refused.contains("leave 3 pieces") && refused.contains("roll"), "{refused}");
    let rolled = with("roll = \"max\"").expect("pieces are kept");
    assert_eq!(rolled.fabrication.expect("pieces").0.net.pieces.len(), 3);
}

#[test]
fn models_have_their_genus() {
    for &(name, genus) in MODELS {
        let job = run(name);
        let mesh = job.mesh().expect("a mesh");
        assert!(
            mesh.faults().is_empty() && mesh.is_closed() && mesh.components().len() == 1,
            "{name}"
        );
        assert_eq!(kerfold::measure::genus(mesh), genus, "{name}");
        assert!(kerfold::measure::volume(mesh) > 0.0, "{name}");
    }
}

/// Every vertex is on the seams of a D-form and has one fold, but where one more cut has opened the
/// ring.
#[test]
fn the_one_piece_d_form_is_a_ring_along_one_seam() {
    let job = run("one-piece-d-form-torus.toml");
    let mesh = job.mesh().expect("a mesh");
    let (fabrication, _) = job.fabrication.as_ref().expect("pieces");
    let net = &fabrication.net;
    // One fold less than a perfect matching: the cut that opened the ring. Seams run with the model
    // on both sides.
    assert_eq!(net.folds.len(), mesh.vertex_count() / 2 - 1);
    assert!(
        net.seams.iter().all(|s| s.sides.iter().all(|side| side.piece.0 == 0)),
        "the piece meets only itself"
    );
    let mut folds = vec![0; mesh.vertex_slots()];
    net.folds.iter().flat_map(|f| f.edge).for_each(|v| folds[v] += 1);
    assert_eq!(folds.iter().filter(|&&n| n == 0).count(), 2, "the ends of the one more cut");
    assert!(folds.iter().all(|&n| n <= 1));
}

#[test]
fn the_long_piece_of_figure_18_meets_itself() {
    let job = run("gonen-fig-18-three-piece-dodecahedron.toml");
    let (fabrication, _) = job.fabrication.as_ref().expect("pieces");
    let seams = &fabrication.net.seams;
    let own = |piece: usize| {
        let is_own = |s: &&kerfold::net::Seam| s.sides.iter().all(|side| side.piece.0 == piece);
        seams.iter().filter(is_own).map(|s| s.length).sum::<f64>()
    };
    let total: f64 = seams.iter().map(|s| s.length).sum();
    assert!(own(0) > 0.25 * total, "the long piece meets itself along {} of {total} mm", own(0));
    assert_eq!([own(1), own(2)], [0.0, 0.0], "the caps meet only the long piece");
}

#[test]
fn the_pieces_of_figure_20_have_three_arms() {
    let job = run("gonen-fig-20-two-y-pieces-octahedron.toml");
    let net = &job.fabrication.as_ref().expect("pieces").0.net;
    for piece in &net.pieces {
        let arms = |face: usize| net.folds.iter().filter(|fold| fold.faces.contains(&face)).count();
        let middles = piece.faces.iter().filter(|flat| arms(flat.face) == 3).count();
        assert!(middles >= 1, "{} has no face with three folds", piece.id);
    }
}
