//! `check`: findings, codes, reports.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, run};

#[test]
fn findings_are_exit_code_1() {
    let folder = Folder::new("findings");
    let model = folder.path("octahedron.obj");
    assert_eq!(run(&["solid", "octahedron", "-o", &model]).code, Some(0));
    let ran = run(&["check", &model, "--require", "valence3"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{}", ran.out);
    assert!(ran.out.contains("valence"), "{}", ran.out);
    let page = folder.path("report.html");
    let ran = run(&[
        "check",
        &model,
        "--require",
        "valence3",
        "--report",
        &page,
        "--json",
        "--rows",
        "all",
    ]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{}", ran.out);
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(
        ["vertices", "edges"].map(|key| told[key].as_array().map(Vec::len)),
        [Some(6), Some(12)]
    );
    let page = fs::read_to_string(&page).expect("a page");
    assert!(page.contains("Fail: 6 findings") && page.contains("octahedron.obj"));
}

#[test]
fn findings_carry_their_codes_in_text_and_json() {
    let folder = Folder::new("codes");
    let bent = folder.path("bent.obj");
    fs::write(&bent, "v 0 0 0\nv 10 0 0\nv 10 10 5\nv 0 10 0\nf 1 2 3 4\n").expect("a file");
    let text = run(&["check", &bent, "--require", "closed"]);
    assert!(
        text.code == Some(1)
            && text.out.contains("\nF104 planarity  ")
            && text.out.contains("\nF106 closed     "),
        "{}",
        text.out
    );
    let report = folder.path("report.json");
    assert_eq!(run(&["check", &bent, "--report", &report]).code, Some(1));
    let report: Value =
        serde_json::from_str(&fs::read_to_string(report).expect("a report")).expect("JSON");
    assert_eq!(
        (&report["findings"][0]["check"], &report["findings"][0]["code"]),
        (&"planarity".into(), &"F104".into())
    );
}
