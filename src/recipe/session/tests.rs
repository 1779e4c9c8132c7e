//! Sessions without a window: history, what is done again, and the same bytes as the recipe.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::code::Coded;
use crate::progress::Silent;
use crate::recipe::{Recipe, job_outputs};

fn cube() -> Session {
    let mut session = Session::new(Path::new(""));
    let solid = StepDraft::new("solid", "cube").with("size", "60mm");
    session.apply(solid, None).expect("a solid");
    session
}

fn cut(select: &str, offset: f64) -> StepDraft {
    StepDraft::new("cut", "edge").with("select", select).with("offset", offset)
}

fn faces(session: &mut Session) -> usize {
    let job = session.run(session.step_count(), &Silent).expect("a run");
    job.mesh().expect("a mesh").face_count()
}

/// Counts how often work asks whether it should stop, and stops at the given time.
struct StopAt(AtomicUsize, usize);

impl Progress for StopAt {
    fn report(&self, _: &str, _: usize, _: usize) {}

    fn is_cancelled(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) >= self.1
    }
}

#[test]
fn a_session_goes_forth_and_back() {
    let mut session = cube();
    assert_eq!(faces(&mut session), 6);
    session.apply(cut("along=z", 0.2), None).expect("a cut");
    assert_eq!(faces(&mut session), 10);
    session.apply(cut("strip", 0.2), None).expect("a cut");
    assert_eq!(faces(&mut session), 18);
    session.set(2, "select", Some("along=z | along=x".into()), None).expect("a value");
    assert_eq!(faces(&mut session), 22);
    assert!(session.undo());
    assert_eq!(faces(&mut session), 18);
    assert!(session.redo());
    assert_eq!(faces(&mut session), 22);
    session.remove(3).expect("a step");
    assert_eq!(faces(&mut session), 14);
    assert!(!session.redo());
    assert_eq!(session.can_undo_redo(), [true, false]);
    while session.undo() {}
    assert_eq!((session.step_count(), session.can_undo_redo()), (0, [false, true]));
}

#[test]
fn only_what_follows_a_change_is_done_again() {
    let mut session = cube();
    session.apply(cut("along=z", 0.2), None).expect("a cut");
    session.apply(cut("along=x", 0.1), None).expect("a cut");
    let left = |session: &mut Session| session.replay(session.step_count()).expect("steps").left();
    assert_eq!(left(&mut session), 3);
    faces(&mut session);
    assert_eq!(left(&mut session), 0);
    session.set(3, "offset", Some(0.15.into()), None).expect("a value");
    assert_eq!(left(&mut session), 1);
    faces(&mut session);
    session.set(2, "offset", Some(0.25.into()), None).expect("a value");
    assert_eq!(left(&mut session), 2);
    // What was made before the change is still known.
    session.undo();
    assert_eq!(left(&mut session), 0);
    session.forget();
    assert_eq!(left(&mut session), 3);
}

#[test]
fn a_new_name_makes_everything_anew_since_it_stands_on_sheets() {
    let mut session = cube();
    let replay = session.replay(1).expect("a step");
    faces(&mut session);
    session.rename(Some("Other".to_owned()));
    assert_eq!(session.replay(1).expect("a step").left(), 1);
    // What was begun under the old name is not taken for what it is now.
    session.keep(&replay.run(&Silent).0);
    assert_eq!(session.replay(1).expect("a step").left(), 1);
}

#[test]
fn a_slider_that_is_dragged_is_one_change() {
    let mut session = cube();
    session.apply(cut("along=z", 0.2), None).expect("a cut");
    for i in 1..9 {
        let value = Value::from(f64::from(i) / 20.0);
        session.set(2, "offset", Some(value), Some(7)).expect("a value");
    }
    session.set(2, "offset", Some(0.45.into()), Some(8)).expect("a value");
    assert!(session.undo());
    assert_eq!(session.recipe().steps[1].get("offset"), Some(&Value::from(0.4)));
    assert!(session.undo());
    assert_eq!(session.recipe().steps[1].get("offset"), Some(&Value::from(0.2)));
}

#[test]
fn what_cannot_be_read_changes_nothing() {
    let mut session = cube();
    session.apply(cut("along=z", 0.2), None).expect("a cut");
    let before = session.recipe();
    let error = session.set(2, "offset", Some("far".into()), None).expect_err("no number");
    let SessionError::Step { step: 2, key: Some(key), .. } = &error else { panic!("{error:?}") };
    assert_eq!((key.as_str(), error.code().to_string().as_str()), ("offset", "E705"));
    assert!(!error.to_string().contains("line"), "{error}");
    for step in [0, 3] {
        let error = session.set(step, "offset", None, None).expect_err("no such step");
        assert_eq!(error.code().to_string(), "E761");
    }
    assert!(session.apply(cut("all", 0.1), Some(4)).is_err());
    assert!(session.apply(StepDraft::new("cut", "corner"), None).is_err());
    assert_eq!(session.recipe(), before);
}

#[test]
fn a_newer_value_stops_the_work_and_what_was_reached_is_kept() {
    let mut session = cube();
    session.apply(StepDraft::new("subdivide", "doo-sabin").with("rounds", 3), None).expect("ok");
    session.apply(cut("all", 0.1), None).expect("a cut");
    let replay = session.replay(3).expect("steps");
    let (all, result) = replay.run(&Silent);
    assert!(result.is_ok() && all.len() == 3);
    // Stopped wherever it asks: never a wrong state, and the next run goes on from what is known.
    for at in [0, 1, 2, 3, 5, 8] {
        let stop = StopAt(AtomicUsize::new(0), at);
        let (reached, result) = session.replay(3).expect("steps").run(&stop);
        if let Err(error) = result {
            assert_eq!(error.code().to_string(), "E329", "{error}");
            assert!(reached.len() < 3);
        }
        session.keep(&reached);
        let left = session.replay(3).expect("steps").left();
        assert!(left <= 3 - reached.len());
    }
    assert_eq!(
        session.run(3, &Silent).expect("a run").mesh().expect("a mesh").face_count(),
        all[2].job().mesh().expect("a mesh").face_count()
    );
}

#[test]
fn a_preview_shows_what_meets_and_changes_nothing() {
    let mut session = cube();
    let replay = session.replay(1).expect("a step");
    let look = |offset: f64| replay.preview(cut("along=z", offset), &Silent).1.expect("a preview");
    let small = look(0.2);
    let cut_report = small.cut.expect("a cut");
    assert!(cut_report.overcut.is_empty());
    assert_eq!((small.mesh.face_count(), small.made.map_or(0, |m| m.faces.len())), (10, 4));
    let large = look(0.7);
    assert_eq!(large.cut.map(|c| c.overcut.len()), Some(4));
    assert!(large.notes.iter().any(|n| n.contains("met each other")), "{:?}", large.notes);
    let error = replay.preview(StepDraft::new("unfold", "auto"), &Silent).1.expect_err("no mesh");
    assert_eq!(error.code().to_string(), "E762");
    assert_eq!(session.step_count(), 1);
}

#[test]
fn a_recipe_saved_from_a_session_makes_the_same_bytes() {
    let mut session = cube();
    session.rename(Some("A \"column\"".to_owned()));
    session.apply(cut("along=z", 0.1), None).expect("a cut");
    session.set(2, "offset", Some(0.3.into()), None).expect("a value");
    session.apply(StepDraft::new("unfold", "one").with("kerf", "0.2mm"), None).expect("a step");
    session.set(3, "sheet", Some("300x300".into()), None).expect("a value");
    session.undo();
    session.redo();
    let ours = session.run(3, &Silent).expect("a run");
    let recipe = Recipe::parse(&session.recipe().text()).expect("a recipe");
    assert_eq!(recipe.name.as_deref(), Some("A \"column\""));
    let theirs = Job::run(&recipe, Path::new(""), &Silent).expect("a run");
    let [ours, theirs] = [&*ours, &theirs].map(|job| job_outputs(job, "same").expect("files"));
    assert!(ours.iter().any(|(name, _)| name == "sheet-01.svg"));
    assert!(ours == theirs, "the files differ");
}

#[test]
fn a_session_opens_recipes_and_can_go_back() {
    let mut session = cube();
    let error = session.open("[[step]]\nsolid = \"kube\"").expect_err("no such solid");
    assert!(error.to_string().starts_with("line 2"), "{error}");
    session.open("name = \"x\"\n[[step]]\nsolid = \"octahedron\"\n").expect("a recipe");
    assert_eq!(faces(&mut session), 8);
    assert!(session.undo());
    assert_eq!(faces(&mut session), 6);
}

#[test]
fn memory_is_bounded() {
    let mut session = cube();
    session.apply(cut("along=z", 0.2), None).expect("a cut");
    for i in 0..150 {
        let value = Value::from(0.1 + f64::from(i) / 1000.0);
        session.set(2, "offset", Some(value), Some(1)).expect("a value");
        session.run(2, &Silent).expect("a run");
    }
    assert!(session.cache.len() <= 128);
}

#[test]
fn a_parameter_changes_the_steps_that_use_it() {
    let mut session = Session::new(Path::new(""));
    let text = "[parameters]\nsize = \"80mm\"\n[[step]]\nsolid = \"cube\"\nsize = \"{size}\"\n\
        [[step]]\ncut = \"edge\"\nselect = \"along=z\"\noffset = 0.2\n";
    session.open(text).expect("a recipe");
    let size = |session: &mut Session| {
        let job = session.run(2, &Silent).expect("a run");
        crate::mesh::Mesh::bounds(job.mesh().expect("a mesh")).map(|(low, high)| (high - low).z)
    };
    assert_eq!(size(&mut session), Some(80.0));
    session.set_parameter("size", "50mm".into()).expect("a value");
    assert_eq!(size(&mut session), Some(50.0));
    let refused = session.set_parameter("size", "wide".into()).expect_err("no length");
    assert!(matches!(refused, SessionError::Step { step: 1, .. }), "{refused:?}");
    assert!(session.recipe().text().contains("size = \"50mm\"\n\n[[step]]"));
    session.undo();
    assert_eq!(size(&mut session), Some(80.0));
}
