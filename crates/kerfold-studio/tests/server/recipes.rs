//! A whole way through the server: steps, model, marks, sheets, files, and back after a reload.

use std::path::Path;

use kerfold::progress::Silent;
use kerfold::recipe::{Job, Recipe, job_outputs};
use serde_json::{Value, json};

use super::harness::Running;

/// The text of an answer with arrays, and how many numbers each has.
fn told(bytes: &[u8]) -> Value {
    assert_eq!(&bytes[..4], kerfold_studio::MAGIC);
    let length = u32::from_le_bytes(bytes[4..8].try_into().expect("four bytes")) as usize;
    assert_eq!(length % 4, 0);
    let told: Value = serde_json::from_slice(&bytes[8..8 + length]).expect("JSON");
    for (name, array) in told["arrays"].as_object().expect("arrays") {
        let end = array["at"].as_u64().expect("a place") + 4 * array["count"].as_u64().expect("n");
        assert!(8 + length + end as usize <= bytes.len(), "{name}");
    }
    told
}

#[test]
fn from_a_solid_to_the_bytes_of_the_command_line() {
    let studio = Running::start();
    let tab = studio.tab();
    let steps = format!("{tab}/steps");
    let step = |step: Value| {
        let answer = studio.post(&steps, &json!({ "step": step }));
        assert_eq!(answer.status, 200, "{}", String::from_utf8_lossy(&answer.body));
    };
    step(json!([["solid", "cube"], ["size", "60mm"]]));
    let cut = json!([["cut", "edge"], ["select", "along=z"], ["offset", 0.2]]);
    let preview = studio.post(&format!("{tab}/preview"), &json!({ "step": cut }));
    let preview = told(&preview.body);
    assert_eq!(preview["arrays"]["faces"]["count"], 10);
    assert_eq!(preview["arrays"]["made_faces"]["count"], 4);
    assert_eq!(preview["cut"]["overcut"], json!([]));
    let limit = json!({ "step": cut, "key": "offset", "from": 0, "to": 2 });
    let limit = studio.post(&format!("{tab}/limit"), &limit).json();
    let limit = limit["value"].as_f64().expect("a limit");
    // Planes of neighbours meet in the middle of the faces.
    assert!((0.49..=0.51).contains(&limit), "{limit}");
    // Rolled, neighbours meet there, too: a radius of half a face.
    let roll = json!([["cut", "edge"], ["select", "along=z"], ["roll", "20mm"]]);
    let limit = json!({ "step": roll, "key": "roll", "unit": "mm", "from": 0, "to": 80 });
    let limit = studio.post(&format!("{tab}/limit"), &limit).json();
    let limit = limit["value"].as_f64().expect("a limit");
    assert!((29.9..=30.1).contains(&limit), "{limit}");
    step(cut);
    let told_model = told(&studio.get(&format!("{tab}/model")).body);
    assert_eq!(told_model["arrays"]["faces"]["count"], 10);
    assert_eq!(
        told(&studio.get(&format!("{tab}/model?steps=1")).body)["arrays"]["faces"]["count"],
        6
    );
    let body = json!({ "key": "offset", "value": 0.3, "gesture": 5 });
    assert_eq!(studio.ask("PATCH", &format!("{steps}/2"), Some(&body)).status, 200);
    let body = json!({ "key": "offset", "value": "wide" });
    let refused = studio.ask("PATCH", &format!("{steps}/2"), Some(&body));
    assert_eq!((refused.code().as_str(), &refused.json()["key"]), ("E705", &json!("offset")));

    // Sheets without being asked for, and the same as those that are written once they are.
    let result = studio.get(&format!("{tab}/result")).json();
    assert_eq!(result["pieces"]["proof"]["overlaps"], 0);
    assert!(result["layout"]["sheets"].as_array().is_some_and(|s| s.len() == 1));
    step(json!([["unfold", "one"], ["kerf", "0.2mm"]]));
    let shown = studio.get(&format!("{tab}/sheets/1?file=column.toml&folder=made"));
    assert_eq!(shown.status, 200);
    let moment = told(&studio.get(&format!("{tab}/bloom?seconds=2.5")).body);
    assert_eq!(moment["arrays"]["faces"]["count"], 10);

    let body = json!({ "file": "column.toml", "folder": "made" });
    let written = studio.post(&format!("{tab}/export"), &body).json();
    assert_eq!(written["command"], "kerfold run column.toml -o made");
    let text = std::fs::read_to_string(studio.path().join("column.toml")).expect("the recipe");
    let recipe = Recipe::parse(&text).expect("a recipe");
    let job = Job::run(&recipe, Path::new(""), &Silent).expect("a run");
    let expected = job_outputs(&job, "kerfold run column.toml -o made").expect("files");
    assert!(expected.len() > 5);
    for (name, bytes) in expected {
        let ours = std::fs::read(studio.path().join("made").join(&name)).expect("a file");
        assert!(ours == bytes, "{name} differs");
        if name == "sheet-01.svg" {
            assert!(shown.body == bytes, "the sheet that is shown is another one");
        }
    }
    let archive = studio.get(&format!("{tab}/export.zip?folder=made"));
    assert!(archive.body.starts_with(b"PK\x03\x04column.toml") || archive.body.starts_with(b"PK"));
}

#[test]
fn nothing_is_lost_on_reload_or_restart() {
    let studio = Running::start();
    let tab = studio.tab();
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["solid", "cube"], ["size", 50]] }));
    let name = tab.rsplit('/').next().expect("a name");
    let again = studio.post("/api/tabs", &json!({ "resume": name })).json();
    assert_eq!(again["tab"], name);
    assert_eq!(again["steps"], json!([[["solid", "cube"], ["size", 50]]]));
    // Tabs beyond the most are closed; their recipes are kept.
    for _ in 0..20 {
        studio.tab();
    }
    assert_eq!(studio.get(&tab).code(), "E906");
    let back = studio.post("/api/tabs", &json!({ "resume": name })).json();
    assert_eq!(back["steps"], json!([[["solid", "cube"], ["size", 50]]]));
}

#[test]
fn a_studio_begins_with_a_file() {
    let text = "name = \"Mine\"\n[[step]]\nsolid = \"octahedron\"\n";
    let studio = Running::start_with(Some(("mine.toml", text)));
    let told = studio.get(&studio.tab()).json();
    assert_eq!((&told["name"], &told["file"]), (&json!("Mine"), &json!("mine.toml")));
    let obj = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let studio = Running::start_with(Some(("corner.obj", obj)));
    let tab = studio.tab();
    assert_eq!(studio.get(&tab).json()["steps"], json!([[["read", "corner.obj"]]]));
    assert_eq!(told_faces(&studio, &tab), 4);
}

fn told_faces(studio: &Running, tab: &str) -> u64 {
    told(&studio.get(&format!("{tab}/model")).body)["arrays"]["faces"]["count"].as_u64().expect("n")
}

#[test]
fn marks_are_texts_and_texts_are_marks() {
    let studio = Running::start();
    let tab = studio.tab();
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["solid", "cube"]] }));
    let mark = |body: Value| studio.post(&format!("{tab}/mark"), &body);
    let text = mark(json!({ "kind": "edge", "selection": "along=z" })).json();
    let ids = text["ids"].as_array().expect("ids").clone();
    assert_eq!(ids.len(), 4);
    let click = mark(json!({ "kind": "edge", "id": ids[0], "how": "direction" })).json();
    assert_eq!((&click["selection"], &click["ids"]), (&json!("along=z:1deg"), &text["ids"]));
    let all = mark(json!({ "kind": "vertex", "id": 0, "how": "symmetric" })).json();
    assert_eq!(all["selection"], "0-7");
    assert_eq!(mark(json!({ "kind": "edge", "selection": "along=" })).status, 422);
    assert_eq!(mark(json!({ "kind": "face", "selection": "sides=5" })).status, 422);
    assert_eq!(mark(json!({ "kind": "face", "id": 99 })).code(), "E909");
    let seams = studio.get(&format!("{tab}/seams")).json();
    assert!(seams["rows"].as_array().is_some_and(|rows| rows.len() > 1), "{seams}");
}

#[test]
fn files_are_put_into_the_folder_and_never_over_others() {
    let studio = Running::start();
    let put = |text: &str| studio.ask("PUT", "/api/files/a.toml", Some(&json!(text)));
    assert_eq!(put("one").status, 200);
    assert_eq!(put("one").status, 200);
    assert_eq!((put("two").status, put("two").code()), (409, "E910".into()));
    let files = studio.get("/api/files").json();
    assert_eq!(files["files"], json!(["a.toml"]));
    let tab = studio.tab();
    studio.post(&format!("{tab}/steps"), &json!({ "step": [["solid", "cube"]] }));
    let save = |body: Value| studio.post(&format!("{tab}/save"), &body);
    assert_eq!(save(json!({ "file": "a.toml" })).code(), "E910");
    assert_eq!(save(json!({ "file": "b.toml" })).json()["file"], "b.toml");
    assert_eq!(save(json!({ "file": "a.toml", "replace": true })).status, 200);
}

#[test]
fn the_schema_is_enough_for_forms() {
    let studio = Running::start();
    let schema = studio.get("/api/schema").json();
    let steps = schema["properties"]["step"]["items"]["anyOf"].as_array().expect("steps").clone();
    assert!(steps.len() > 15);
    let cut = steps.iter().find(|s| s["title"] == "cut edge").expect("a step");
    let offset = &cut["properties"]["offset"];
    assert_eq!((&offset["minimum"], &offset["maximum"]), (&json!(0.0), &json!(2.0)));
    assert_eq!(cut["required"], json!(["cut", "select"]));
    assert_eq!(studio.get("/openapi.json").json()["openapi"], "3.1.0");
    let page = studio.get("/api.html");
    assert!(String::from_utf8_lossy(&page.body).contains("/api/tabs/{tab}/preview"));
}
