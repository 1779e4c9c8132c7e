//! `hull` of half-spaces.

use std::fs;
use std::path::Path;

use super::harness::{Folder, run};

#[test]
fn planes_that_bound_nothing_are_refused_with_place_and_reason() {
    let folder = Folder::new("planes");
    let output = folder.path("out.obj");
    let walls = "1,0,0,1\n-1,0,0,1\n0,1,0,1\n0,-1,0,1\n";
    for (name, text, messages) in [
        ("empty.csv", String::new(), &["there are no half-spaces"][..]),
        ("word.csv", format!("{walls}0, 0, up, 1\n"), &["word.csv:5:7: `up` is not a number"]),
        (
            "open.csv",
            format!("{walls}0,0,1,1\n"),
            &["the direction (0.0000, 0.0000, -1.0000) open"],
        ),
        (
            "apart.csv",
            format!("# box\n{walls}0,0,1,1\n0,0,-1,-2\n"),
            &["exclude each other", "on the lines 6, 7"],
        ),
        ("flat.csv", format!("{walls}0,0,1,1\n0,0,-1,-1\n"), &["no room", "on the lines 5, 6"]),
    ] {
        let file = folder.path(name);
        fs::write(&file, text).expect("a file");
        let ran = run(&["hull", "--planes", &file, "-o", &output]);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{name}");
        assert!(messages.iter().all(|m| ran.err.contains(m)), "{name}: {}", ran.err);
        assert!(!Path::new(&output).exists(), "{name}");
    }
    let missing = run(&["hull", "--planes", &folder.path("none.csv"), "-o", &output]);
    assert!(missing.code == Some(2) && missing.err.contains("none.csv"), "{}", missing.err);
}
