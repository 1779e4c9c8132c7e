//! `explain` and the codes behind errors.

use serde_json::Value;

use super::harness::run;

#[test]
fn codes_stand_behind_errors_and_are_explained() {
    let missing = run(&["info", "nothing-here.obj"]);
    assert!(missing.code == Some(2) && missing.err.ends_with(" (E101)\n"), "{}", missing.err);
    let refused =
        run(&["cut", "vertex", "fixtures/meshes/spot.obj", "--select", "valense=4", "-o", "-"]);
    assert!(
        refused.code == Some(2) && refused.err.contains("kerfold explain E292"),
        "{}",
        refused.err
    );
    let told = run(&["explain", "E101", "planarity"]);
    assert_eq!((told.code, told.err.as_str()), (Some(0), ""));
    assert!(told.out.starts_with("E101 File is missing\nThere is no file"), "{}", told.out);
    assert!(told.out.contains("\n\nF104 planarity\n"), "{}", told.out);
    let listed = run(&["explain"]);
    assert!(
        listed.out.lines().count() > 250 && listed.out.contains("\nF201 open-contour\n"),
        "{}",
        listed.out
    );
    let json: Value = serde_json::from_str(&run(&["explain", "e101", "--json"]).out).expect("JSON");
    assert_eq!(json["pages"][0]["title"], "File is missing");
    let unknown = run(&["explain", "E199"]);
    assert_eq!((unknown.code, unknown.out.as_str()), (Some(2), ""));
    assert!(
        unknown.err.contains("did you mean `E201`?") && unknown.err.ends_with(" (E010)\n"),
        "{}",
        unknown.err
    );
    assert_eq!(run(&["explain", "E101", "--quiet"]).out, "");
}
