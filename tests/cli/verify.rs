//! `verify`.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, good_model, run};

#[test]
fn verify_finds_what_is_wrong_and_trusts_no_proof() {
    let folder = Folder::new("verify");
    let model = good_model(&folder);
    let out = folder.path("out");
    assert_eq!(run(&["unfold", &model, "--sheet", "none", "-o", &out]).code, Some(0));
    let good = fs::read_to_string(folder.path("out/pieces.json")).expect("pieces");
    let path = folder.path("changed.json");
    let verify = |text: &str| {
        fs::write(&path, text).expect("a file");
        run(&["verify", &path, &model, "--json"])
    };
    let ran = verify(&good);
    assert_eq!(ran.code, Some(0), "{}", ran.out);
    // The file may claim what it likes about itself.
    let boasting = good.replace("\"overlaps\": 0", "\"overlaps\": 7");
    assert_ne!(boasting, good);
    assert_eq!(verify(&boasting).code, Some(0));
    // Other units, a face that is no face, a fold bent otherwise: each is a finding.
    for (from, to) in [
        ("\"scale\": 1.0", "\"scale\": 1.0000001"),
        ("\"face\": 3,", "\"face\": 400,"),
        ("\"fold_angle\": 63.4", "\"fold_angle\": 64.4"),
    ] {
        let changed = good.replacen(from, to, 1);
        assert_ne!(changed, good, "{from}");
        let ran = verify(&changed);
        assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""), "{from}");
        let told: Value = serde_json::from_str(&ran.out).expect("JSON");
        assert_eq!(
            (&told["verdict"], told["findings"].as_array().map(Vec::len)),
            (&Value::from("fail"), Some(1))
        );
    }
    for (text, message) in [
        ("", "line 1"),
        ("{}", "is missing"),
        (&good.replace("\"scale\": 1.0", "\"scale\": 0"), "scale"),
    ] {
        let ran = verify(text);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{}", ran.err);
        assert!(ran.err.contains(message), "{}", ran.err);
    }
    let cube = run(&["verify", &folder.path("out/pieces.json"), "fixtures/meshes/cube.obj"]);
    assert_eq!(cube.code, Some(1), "{}", cube.err);
    assert!(cube.out.contains("take the mesh that was unfolded"), "{}", cube.out);
}
