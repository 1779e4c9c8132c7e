//! `lint`, `kerf-test` and materials.

use serde_json::Value;

use super::harness::{Folder, good_model, run};

#[test]
fn lint_tells_what_it_finds_and_passes_our_own_sheets() {
    let folder = Folder::new("lint");
    let model = good_model(&folder);
    let out = folder.path("out");
    let formats = "dxf,pdf,svg,lbrn2";
    let ran = run(&[
        "unfold",
        &model,
        "--format",
        formats,
        "--material",
        "ply3",
        "--tile",
        "a4",
        "-o",
        &out,
    ]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.out.contains("min on the machine for Birch plywood 3 mm"), "{}", ran.out);
    let sheets = ["svg", "dxf", "pdf"].map(|ending| folder.path(&format!("out/sheet-01.{ending}")));
    let sheets: Vec<&str> = sheets.iter().map(String::as_str).collect();
    let ran = run(&[&["lint", "--material", "ply3"], &sheets[..]].concat());
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "{}", ran.out);
    assert_eq!(ran.out.matches("600 × 400 mm: pass").count(), 2, "{}", ran.out);
    let ran = run(&["lint", "fixtures/lint/14-bow-tie.svg", sheets[0], "--json"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(1), ""));
    let told: Value = serde_json::from_str(&ran.out).expect("JSON");
    let findings = [0, 1].map(|i| told["files"][i]["findings"].as_array().map(Vec::len));
    assert_eq!((findings, &told["verdict"]), ([Some(1), Some(0)], &Value::from("fail")));
    assert_eq!(told["files"][0]["findings"][0]["check"], "self-crossing");
    assert!(run(&["lint", "--quiet", "fixtures/lint/05-text.svg"]).out.is_empty());
    for (arguments, words) in [
        (&["lint", "nothing.svg"][..], "cannot be read"),
        (&["lint", "fixtures/bad/empty.obj"], "empty"),
        (&["lint", "fixtures/bad/word.obj"], "neither SVG, DXF nor PDF"),
        (&["lint", sheets[0], "--gap", "0"], "gap is 0 mm"),
        (&["lint", sheets[0], "--material", "ply"], "did you mean"),
        (&["unfold", &model, "--format", "svg,png", "-o", &out], "`png`"),
        (&["unfold", &model, "--material", "unobtainium", "-o", &out], "known are"),
        (&["kerf-test", "--thickness", "3mm", "-o", "kerf.png"], ".lbrn2"),
        (&["kerf-test", "-o", "kerf.svg"], "--thickness"),
        (&["kerf-test", "--thickness", "0mm", "-o", "kerf.svg"], "0.01"),
    ] {
        let ran = run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(ran.err.contains(words), "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn what_is_skipped_is_told_and_long_lists_are_cut_short() {
    let plain = run(&["lint", "fixtures/lint/05-text.svg"]);
    assert_eq!(plain.code, Some(1), "{}", plain.out);
    assert!(plain.out.contains(" text"), "{}", plain.out);
    let skipped = run(&["lint", "--skip", "text,order", "fixtures/lint/05-text.svg"]);
    assert_eq!((skipped.code, skipped.err.as_str()), (Some(0), ""), "{}", skipped.out);
    let (told, verdict) = ("not checked: ", ": pass\n");
    assert!(skipped.out.contains(told) && skipped.out.ends_with(verdict), "{}", skipped.out);
    let json = run(&["lint", "--json", "--skip", "text", "fixtures/lint/05-text.svg"]);
    let json: Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(json["files"][0]["skipped"], serde_json::json!(["text"]));
    let wrong = run(&["lint", "--skip", "words", "fixtures/lint/05-text.svg"]);
    assert_eq!((wrong.code, wrong.out.as_str()), (Some(2), ""));
    assert!(wrong.err.contains("words"), "{}", wrong.err);

    // Thirty open lines: twenty are listed, ten counted, all with `--all`, and JSON counts them.
    let folder = Folder::new("lint-all");
    let lines: String = (0..30)
        .map(|i| format!("<path d='M {x} 10 L {x} 20' stroke='red' fill='none'/>", x = 3 * i + 5))
        .collect();
    let size = "width='100mm' height='30mm' viewBox='0 0 100 30'";
    let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' {size}>{lines}</svg>");
    let file = folder.path("lines.svg");
    std::fs::write(&file, svg).expect("a file");
    let count = |text: &str| text.matches(" open-contour at ").count();
    let few = run(&["lint", &file]);
    assert_eq!((few.code, count(&few.out)), (Some(1), 20), "{}", few.out);
    assert!(few.out.contains("10 more, list them with --all"), "{}", few.out);
    let all = run(&["lint", "--all", &file]);
    assert_eq!((all.code, count(&all.out)), (Some(1), 30), "{}", all.out);
    assert!(!all.out.contains("more, list them"), "{}", all.out);
    let json = run(&["lint", "--json", &file]);
    let json: Value = serde_json::from_str(&json.out).expect("JSON");
    let page = &json["files"][0];
    let listed = page["findings"].as_array().map(Vec::len);
    assert_eq!((page["counts"]["open-contour"].as_u64(), listed), (Some(30), Some(20)));
}
