//! `seams`.

use serde_json::Value;

use super::harness::{Folder, good_model, run};

#[test]
fn seams_are_listed_up_to_symmetry_or_the_best_of_too_many() {
    let folder = Folder::new("seams");
    let model = good_model(&folder);
    let told = |arguments: &[&str]| {
        let ran = run(&[&["seams", &model, "--json"], arguments].concat());
        assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
        let value: Value = serde_json::from_str(&ran.out).expect("JSON");
        let rows = value["matchings"].as_array().expect("rows").clone();
        let columns = rows
            .iter()
            .map(|r| (r["pieces"].as_u64(), r["seam_cycles"].as_u64(), r["orbit"].as_u64()));
        (columns.collect::<Vec<_>>(), value["notes"].as_array().expect("notes").len())
    };
    assert_eq!(told(&[]), (vec![(Some(2), Some(1), Some(30)), (Some(4), Some(3), Some(6))], 0));
    let (rows, notes) = told(&["--limit", "10"]);
    assert_eq!((rows.len(), rows[1], notes), (2, (Some(2), Some(1), None), 1));
    let octahedron = folder.path("octahedron.obj");
    assert_eq!(run(&["solid", "octahedron", "-o", &octahedron]).code, Some(0));
    let ran = run(&["seams", &octahedron]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("valence 4"), "{}", ran.err);
}
