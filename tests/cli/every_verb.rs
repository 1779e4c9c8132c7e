//! What holds for every verb, whatever it does.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::harness::{Folder, run, verbs};
use super::rows::{ROWS, Takes, inputs, samples};

/// Verbs that only print what they are asked for, without a summary as JSON.
const PRINTERS: &[&str] = &["completions"];

/// Verbs that only start another program; they have tests of their own.
const STARTERS: &[&str] = &["studio"];

#[test]
fn no_verb_lacks_a_row() {
    let mut without = Vec::new();
    for verb in verbs() {
        let is_row = |words: &[&str]| words.iter().zip(&verb).all(|(a, b)| a == b);
        if verb != ["help"] && verb != STARTERS && !ROWS.iter().any(|row| is_row(row.arguments)) {
            without.push(verb.join(" "));
        }
    }
    assert!(without.is_empty(), "add these to ROWS in tests/cli/rows.rs: {without:?}");
}

#[test]
fn good_input_gives_results_on_stdout_and_whole_files() {
    let (folder, inputs) = (Folder::new("good"), inputs("good-inputs"));
    let model = inputs.path("model.obj");
    for (i, row) in ROWS.iter().enumerate() {
        let (input, output) =
            (samples(&inputs, row.takes).good, folder.path(&format!("{i}-{}", row.writes)));
        let arguments = row.fill(&input, &model, &output);
        let ran = run(&arguments);
        assert_eq!(ran.code, Some(0), "{arguments:?}: {}", ran.err);
        assert!(!ran.out.is_empty(), "{arguments:?} says nothing");
        assert!(ran.err.lines().all(|l| l.starts_with("note: ")), "{arguments:?}: {}", ran.err);
        assert_eq!(Path::new(&output).exists(), !row.writes.is_empty(), "{arguments:?}");
    }
    let leftovers =
        folder.contents().into_iter().filter(|(p, _)| p.to_string_lossy().contains("tmp-"));
    assert_eq!(leftovers.count(), 0);
}

#[test]
fn bad_input_is_exit_code_2_with_one_line_and_no_file() {
    let (folder, inputs) = (Folder::new("bad"), inputs("bad-inputs"));
    let model = inputs.path("model.obj");
    for row in ROWS {
        for (input, message) in samples(&inputs, row.takes).bad {
            let output = folder.path(row.writes);
            let arguments = row.fill(&input, &model, &output);
            let ran = run(&arguments);
            assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{arguments:?}");
            assert!(ran.err.contains(message), "{arguments:?}: {}", ran.err);
            // Words are judged by clap, which says on further lines what there is.
            if !matches!(row.takes, Takes::Word(..)) {
                assert!(ran.err.starts_with("kerfold: "), "{arguments:?}: {}", ran.err);
                // Below the line of a fault in a recipe its place is shown, as compilers do.
                let mut further = ran.err.lines().skip(1);
                let is_place = |line: &str| line.contains('|') || line.contains("-->");
                assert!(further.all(is_place), "{arguments:?}: {}", ran.err);
            }
            assert_eq!(folder.contents(), [], "{arguments:?}: nothing may be written");
        }
    }
}

#[test]
fn output_that_cannot_be_written_leaves_everything_as_it_was() {
    let (folder, inputs) = (Folder::new("unwritable"), inputs("unwritable-inputs"));
    let model = inputs.path("model.obj");
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    let before = folder.contents();
    for row in ROWS.iter().filter(|row| !row.writes.is_empty()) {
        let (input, output) =
            (samples(&inputs, row.takes).good, folder.path(&format!("wall/{}", row.writes)));
        let arguments = row.fill(&input, &model, &output);
        let ran = run(&arguments);
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
fn json_parses_and_quiet_is_silent() {
    let (folder, inputs) = (Folder::new("json"), inputs("json-inputs"));
    let model = inputs.path("model.obj");
    for (i, row) in ROWS.iter().enumerate().filter(|(_, r)| !PRINTERS.contains(&r.arguments[0])) {
        let (input, output) =
            (samples(&inputs, row.takes).good, folder.path(&format!("{i}-{}", row.writes)));
        let mut with = row.fill(&input, &model, &output);
        with.push("--json");
        let ran = run(&with);
        assert_eq!(ran.code, Some(0), "{with:?}: {}", ran.err);
        let value: Value =
            serde_json::from_str(&ran.out).unwrap_or_else(|e| panic!("{with:?}: {e}\n{}", ran.out));
        assert!(value["command"].as_str().is_some_and(|c| c.starts_with("kerfold ")), "{with:?}");
        *with.last_mut().expect("--json") = "--quiet";
        let ran = run(&with);
        assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (Some(0), "", ""), "{with:?}");
        if let Some(place) = row.place() {
            with[place] = "no-such-thing.obj";
            let ran = run(&with);
            assert_eq!(ran.code, Some(2), "{with:?}");
            assert!(!ran.err.is_empty(), "errors are not silenced: {with:?}");
        }
    }
}
