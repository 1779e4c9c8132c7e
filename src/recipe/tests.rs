//! Recipes as text, and what becomes of them.

use std::path::Path;

use super::*;
use crate::mesh::assert_sound;
use crate::progress::Silent;

fn message(text: &str) -> String {
    Recipe::parse(text).expect_err("a broken recipe").to_string()
}

fn run(text: &str) -> Result<Job, StepError> {
    Job::run(&Recipe::parse(text).expect("a recipe"), Path::new(""), &Silent)
}

#[test]
fn a_recipe_is_a_chain_of_the_verbs_parameters() {
    let recipe = Recipe::parse(
        r#"
name = "All kinds of steps"
[[step]]
solid = "soccer-ball"
edge = "20mm"
[[step]]
cut = "plane"
normal = [0, 0, 1]
point = "0,0,1cm"
keep = "reverse"
[[step]]
cut = "vertex"
select = "valence=3"
scope = "local"
[[step]]
cut = "face"
select = "made"
offset = 0.5
[[step]]
check = "plywood"
require = ["planar", "closed"]
[[step]]
unfold = 1
sheet = "A3"
kerf = 0.2
[[step]]
render = "iso"
width = 400
"#,
    )
    .expect("a recipe");
    let verbs: Vec<&str> = recipe.steps.iter().map(Step::verb).collect();
    assert_eq!(
        verbs,
        ["solid", "cut plane", "cut vertex", "cut face", "check", "unfold", "render"]
    );
    assert_eq!(recipe.name.as_deref(), Some("All kinds of steps"));
    let Step::Unfold { sheet, .. } = &recipe.steps[5] else { panic!("an unfold step") };
    assert_eq!(sheet.stock.kerf.mm(), 0.2);
}

#[test]
fn mistakes_are_named_with_line_column_and_the_nearest_name() {
    for (text, expected) in [
        (
            "[[step]]\nsolid = \"cube\"\nszie = \"3mm\"",
            "line 3, column 1: `szie` is not known in a step with `solid`; did you mean `size`?",
        ),
        ("nmae = \"x\"", "line 1, column 1: `nmae` is not known in a recipe; did you mean `name`?"),
        (
            "[[step]]\nsolidd = \"cube\"",
            "line 2, column 1: `solidd` is not known as a step; did you mean `solid`?",
        ),
        (
            "[[step]]\ncut = \"egde\"",
            "line 2, column 7: `egde` is not known as something to cut; did you mean `edge`?",
        ),
        (
            "[[step]]\nsolid = \"cube\"\ncut = \"edge\"",
            "line 3, column 1: this step says both `solid` and `cut`; make two steps of it",
        ),
        (
            "name = \"nothing\"",
            "the recipe has no [[step]]; the first one names a solid or reads a file, e.g. solid = \
            \"dodecahedron\"",
        ),
        ("[[step]]\nsolid = \"kube\"", "line 2, column 9: "),
        (
            "[[step]]\nsolid = \"cube\"\n[[step]]\ncut = \"edge\"\noffset = 0.2",
            "line 3, column 1: missing field `select`",
        ),
        (
            "[[step]]\nsolid = \"cube\"\n[[step]]\nunfold = \"auto\"\nkerf = \"3 apples\"",
            "line 5, column 8: `3 apples` is not a length",
        ),
        (
            "[[step]]\nsolid = \"cube\"\n[[step]]\ncut = \"edge\"\nselect = \"valense=3\"",
            "line 5, column 10: ",
        ),
        ("[[step]\nsolid = 1", "line 1, column "),
        ("[[step]]\nsolid = \"ä\"\nsize.x=\"ü\"", "line 3, column 1: `size` takes a value"),
        ("[[step]]\nsolid = \"cube\"\n[[step.size]]\n", "line 3, column 8: `size` takes a value"),
        ("step = 3", "line 1, column 8: steps are written [[step]], with two brackets"),
    ] {
        let message = message(text);
        assert!(message.starts_with(expected), "{message}\ninstead of\n{expected}");
    }
    assert!(message("[[step]]\nsolid = \"kube\"").contains("cube"));
}

#[test]
fn a_step_that_fails_is_named_by_its_number() {
    let failure = |text: &str| match run(text) {
        Ok(_) => panic!("the recipe should fail"),
        Err(error) => error.to_string(),
    };
    assert!(
        failure("[[step]]\ncut = \"edge\"\nselect = \"all\"")
            .starts_with("step 1 (cut edge): there is no mesh yet")
    );
    let twice = "[[step]]\nsolid = \"cube\"\n[[step]]\nsolid = \"cube\"";
    assert!(failure(twice).starts_with("step 2 (solid): there is a mesh already"));
    let empty = "[[step]]\nsolid = \"cube\"\n[[step]]\ncut = \"vertex\"\nselect = \"valence=9\"";
    assert!(failure(empty).starts_with("step 2 (cut vertex): "));
    assert!(failure("[[step]]\nread = \"missing.obj\"").contains("missing.obj"));
}

#[test]
fn made_and_strip_mean_what_the_last_step_made() {
    let job =
        run("[[step]]\nsolid = \"cube\"\n[[step]]\ncut = \"edge\"\nselect = \"0\"\noffset = 0.2\n\
                   [[step]]\ncut = \"edge\"\nselect = \"strip\"\noffset = 0.2")
        .expect("two rounds");
    let mesh = job.mesh().expect("a mesh");
    assert_sound(mesh);
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (8 + 2 + 4, 6 + 1 + 2));
}

#[test]
fn a_hull_is_convex_or_dual() {
    let faces = |kind: &str| {
        let text = format!(
            "[[step]]\nsolid = \"octahedron\"\n[[step]]\nhull = \"{kind}\"\nno_box = {}",
            kind == "dual"
        );
        run(&text).expect("a hull").mesh().expect("a mesh").face_count()
    };
    assert_eq!((faces("convex"), faces("dual")), (8, 6));
    assert!(message("[[step]]\nhull = \"round\"").starts_with("line 2, column 8: "));
}

#[test]
fn half_spaces_and_steps_of_a_hull_in_a_recipe() {
    let planes = "[[step]]\nplanes = \"fixtures/planes/octahedron.csv\"\n";
    let job = run(planes).expect("an octahedron");
    assert_eq!(job.mesh().expect("a mesh").face_count(), 8);
    let job =
        run(&format!("{planes}simple = true\n[[step]]\nhull = \"dual\"\nsteps = [0, 2, \"all\"]"))
            .expect("a dual");
    let names: Vec<String> =
        job_outputs(&job, "test").expect("files").into_iter().map(|output| output.0).collect();
    assert!(
        names.contains(&"model-after-0.png".to_owned())
            && names.contains(&"model-after-2.png".to_owned())
    );
    let error = run("[[step]]\nplanes = \"nowhere.csv\"").err().expect("no file").to_string();
    assert!(error.contains("nowhere.csv"), "{error}");
}

#[test]
fn an_unfold_step_has_lists_of_edges_to_keep_and_to_cut() {
    let job =
        run("[[step]]\nsolid = \"cube\"\n[[step]]\nunfold = \"one\"\nkeep = \"0\"\ncut = \"3\"")
            .expect("a net");
    let (fabrication, _) = job.fabrication.as_ref().expect("pieces");
    assert!(fabrication.net.folds.iter().any(|f| f.id.0 == 0));
    assert!(fabrication.net.seams.iter().any(|s| s.id.0 == 3));
}

#[test]
fn a_piece_too_large_for_the_sheet_is_divided_until_it_fits() {
    let recipe = |sheet: &str| {
        format!(
            "[[step]]\nsolid = \"cube\"\nsize = 100\n[[step]]\nunfold = \"one\"\nsheet = \
            \"{sheet}\""
        )
    };
    let whole = run(&recipe("600x400")).expect("room for all");
    let (whole, _) = whole.fabrication.as_ref().expect("pieces");
    assert_eq!((whole.net.pieces.len(), whole.divided), (1, 0));
    let divided = run(&recipe("250x250")).expect("room for parts");
    let (divided, _) = divided.fabrication.as_ref().expect("pieces");
    assert!(divided.net.pieces.len() > 1 && divided.divided > 0);
    assert_eq!(divided.net.proof.overlaps, 0);
    let error =
        run(&recipe("100x100")).map(|_| ()).expect_err("a single face is too large").to_string();
    assert!(error.contains("single face") && error.contains("100 × 100"), "{error}");
}

#[test]
fn a_piece_whose_flaps_do_not_fit_on_the_sheet_is_divided() {
    // A cross of six squares needs 160 x 120 mm, with flaps 16 mm more.
    let unfold = |rest: &str| {
        let text = format!(
            "[[step]]\nsolid = \"cube\"\nedge = \"40mm\"\n[[step]]\nunfold = \"auto\"\nsheet = \
            \"165x125mm\"\nmargin = 1\n{rest}"
        );
        let job = run(&text).expect("two steps");
        job.fabrication.expect("pieces").0
    };
    let bare = unfold("");
    assert_eq!((bare.net.pieces.len(), bare.divided), (1, 0));
    let flaps = unfold("joint = \"flaps\"\nflap_width = \"8mm\"");
    assert!(flaps.net.pieces.len() > 1 && flaps.divided > 0);
    assert!(flaps.sheets.report.joints.flaps > 0);
}

#[test]
fn what_an_operator_did_not_reach_counts_until_it_is_mended() {
    let rough = "[[step]]\nsolid = \"cube\"\n[[step]]\nsubdivide = \"honeycomb\"\nrounds = \
    2\n[[step]]\nplanarize = \"exact\"\nrounds = 1\n";
    let unclean = |more: &str| run(&(rough.to_owned() + more)).expect("a job").with_findings;
    assert_eq!(unclean(""), [StepWithFindings { step: 3, verb: "planarize" }]);
    assert_eq!(unclean("")[0].to_string(), "step 3 (planarize) has findings, see its notes");
    assert_eq!(unclean("[[step]]\nplanarize = \"exact\"\n"), []);
    assert_eq!(unclean("[[step]]\nhull = \"convex\"\n"), []);
    assert_eq!(unclean("[[step]]\ncut = \"face\"\nselect = \"0\"\n").len(), 1);
}

#[test]
fn panels_have_a_size_or_a_word_for_what_stands_in_its_place() {
    let panelize = |step: &str| {
        let text = format!("[[step]]\nheight = \"0\"\ndomain = \"4mx3m\"\n[[step]]\n{step}\n");
        Recipe::parse(&text).map(|recipe| format!("{:?}", recipe.steps[1]))
    };
    for (step, wanted) in [
        ("panelize = \"1.2m\"", "size: Some(Length { mm: 1200.0 }), count: None"),
        ("panelize = 40", "size: Some(Length { mm: 40.0 }), count: None"),
        ("panelize = \"count\"\ncount = 40", "size: None, count: Some(40)"),
    ] {
        let read = panelize(step).expect(step);
        assert!(read.contains(wanted), "{step}: {read}");
    }
    assert!(panelize("panelize = \"tall\"").is_err());
    let open = "[[step]]\nheight = \"0\"\ndomain = \"4mx3m\"\n[[step]]\npanelize = \"sag\"\n";
    let error = run(open).err().expect("no size").to_string();
    assert!(error.contains("exactly one"), "{error}");
}

const EDGE_CUT: &str = "[[step]]\nsolid = \"cube\"\nsize = \"50mm\"\n[[step]]\ncut = \"edge\"\nselect = \
    \"0\"\noffset = 0.25\n[[step]]\nrender = \"iso\"\nwidth = 90\n";

#[test]
fn a_story_has_a_frame_for_every_word_and_says_what_is_missing() {
    let story = |words: &str| {
        let job = run(&format!("{EDGE_CUT}story = [{words}]\n")).expect("a job");
        job_outputs(&job, "kerfold run")
    };
    for (words, size) in [
        (r#""model""#, [180, 135]),
        (r#""start", "cut", "model""#, [180, 45]),
        // Four frames, two in a row: the only cut is the last step, so there is none for `each`.
        (r#""start", "each", "cuts", "model", "model""#, [180, 134]),
    ] {
        let outputs = story(words).expect("pictures");
        let (_, png) = outputs.iter().find(|(name, _)| name == "story.png").expect("a story");
        let number =
            |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().expect("four bytes"));
        assert_eq!([number(16), number(20)], size, "{words}");
    }
    for (word, missing) in [("steps", "hull = \"dual\""), ("sheets", "nothing was unfolded")] {
        let error = story(&format!("\"{word}\"")).expect_err(word).to_string();
        assert!(error.contains(word) && error.contains(missing), "{error}");
    }
    let none = run("[[step]]\nsolid = \"cube\"\n[[step]]\nrender = \"iso\"\nstory = [\"cut\"]\n");
    let error = job_outputs(&none.expect("a job"), "kerfold run").expect_err("no operator");
    assert!(error.to_string().contains("no step before it changes the mesh"), "{error}");
}

#[test]
fn what_is_about_to_be_cut_is_marked_with_its_plane() {
    let job = run(&format!("{EDGE_CUT}before = \"on\"\n")).expect("a job");
    let [moment] = &job.moments[..] else { panic!("one operator") };
    let (shown, marks) = moment.about_to();
    assert_eq!((marks.edges.len(), marks.sections.len(), marks.planes.len()), (1, 1, 1));
    // The cube as it was, the section and the plane beside it.
    assert_eq!(shown.face_count(), 8);
    let ends = shown.edge_vertices(marks.edges[0]).map(|v| shown.position(v));
    let [a, b] =
        moment.before.edge_vertices(moment.chosen.edges[0]).map(|v| moment.before.position(v));
    assert!(ends == [a, b] || ends == [b, a], "{ends:?}");
    let plane = shown.plane(marks.planes[0]).expect("a plane");
    let section = shown.face_positions(marks.sections[0]);
    assert!(section.iter().all(|&p| plane.signed_distance(p).abs() < 1e-9));
}
