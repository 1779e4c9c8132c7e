//! Standard input and output.

use std::process::Stdio;

use serde_json::Value;

use super::harness::{piped, program, run};

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
