//! `report.json` and what `info --json` prints (`formats.md`).
//!
//! Keys come in the order of the contract, further ones after it. Numbers have as many digits as
//! read back to the same bits, and no more; ids are those of the input file.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::check::{CheckFinding, Details, EdgeDetail, FaceReport, Limits, Report, VertexDetail};
use crate::code::Coded;
use crate::measure::Summary;
use crate::mesh::VertexId;

/// The report of `check`, with one line for each face and each finding.
///
/// # Example
/// ```
/// use kerfold::io::report::json::check_json;
/// use kerfold::prelude::*;
///
/// let report = check(&kerfold::shape::cube(40.0), &CheckParams::default())?;
/// let value: serde_json::Value = serde_json::from_str(&check_json(&report, "my program"))?;
/// assert_eq!(value["model"]["faces"], 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_json(report: &Report, command: &str) -> String {
    check_json_with(report, None, command)
}

/// The same, and with `details` one line for each vertex and each edge.
///
/// # Example
/// ```
/// use kerfold::check::details;
/// use kerfold::io::report::json::check_json_with;
/// use kerfold::prelude::*;
///
/// let report = check(&kerfold::shape::cube(40.0), &CheckParams::default())?;
/// let rows = details(&kerfold::shape::cube(40.0));
/// assert!(check_json_with(&report, Some(&rows), "my program").len() > 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_json_with(report: &Report, details: Option<&Details>, command: &str) -> String {
    let valence = Valence {
        histogram: &report.valence.histogram,
        other: report.valence.other.iter().map(|v| v.index()).collect(),
    };
    let mut fields = vec![
        ("command", compact(command)),
        ("model", compact(&model(report))),
        ("planarity", planarity(report)),
        ("valence", compact(&valence)),
        ("convex", compact(&report.is_convex())),
        ("findings", lines(report.findings.iter().map(|f| compact(&finding(f))))),
        ("verdict", compact(report.verdict().name())),
        ("profile", compact(&profile(report))),
        (
            "profiles",
            compact(
                &report.profiles.iter().map(|&(p, ok)| (p.name(), ok)).collect::<BTreeMap<_, _>>(),
            ),
        ),
        ("concave", compact(&concave(report))),
        (
            "conical",
            lines(report.conical.iter().map(|node| {
                compact(&Conical {
                    vertex: node.vertex.index(),
                    valence: node.valence,
                    residual: node.residual,
                })
            })),
        ),
    ];
    if let Some(details) = details {
        fields.push(("vertices", lines(details.vertices.iter().map(|v| compact(&vertex(v))))));
        fields.push(("edges", lines(details.edges.iter().map(|e| compact(&edge(e))))));
    }
    object(&fields)
}

/// The summary of `info`. `notes` are what the reader had to say.
///
/// # Example
/// ```
/// use kerfold::io::report::json::info_json;
/// use kerfold::measure::summary;
///
/// let text = info_json(&summary(&kerfold::shape::cube(40.0)), &[], "my program");
/// let value: serde_json::Value = serde_json::from_str(&text)?;
/// assert_eq!(value["model"]["edges"], 12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn info_json(summary: &Summary, notes: &[String], command: &str) -> String {
    let model = InfoModel {
        vertices: summary.vertices,
        edges: summary.edges,
        faces: summary.faces,
        components: summary.components.len(),
        genus: summary.components.iter().map(|c| c.genus).sum(),
        rims: summary.rims.len(),
        size_mm: summary.size.to_array(),
        euler_number: summary.euler_number,
        stray_vertices: summary.stray_vertices,
        seams: summary.seams,
        area_mm2: summary.area,
    };
    let components = summary.components.iter().map(|c| {
        compact(&Component {
            vertices: c.vertices,
            edges: c.edges,
            faces: c.faces,
            genus: c.genus,
            rims: c.rims,
            volume_mm3: c.volume,
        })
    });
    let lengths = summary.edge_lengths.map(|l| Lengths {
        min: l.min,
        mean: l.mean,
        max: l.max,
        total: l.total,
    });
    let groups = summary.groups.iter().map(|g| compact(&Group { name: &g.name, faces: g.faces }));
    object(&[
        ("command", compact(command)),
        ("model", compact(&model)),
        ("components", lines(components)),
        ("rims", compact(&Rims { edges: &summary.rims, length_mm: summary.rim_length })),
        ("edge_lengths_mm", compact(&lengths)),
        ("valence", compact(&summary.valences)),
        ("sides", compact(&summary.sides)),
        ("groups", lines(groups)),
        ("notes", lines(notes.iter().map(compact))),
    ])
}

#[derive(Serialize)]
struct Model {
    vertices: usize,
    edges: usize,
    faces: usize,
    components: usize,
    genus: usize,
    rims: usize,
    size_mm: [f64; 3],
}

#[derive(Serialize)]
struct InfoModel {
    vertices: usize,
    edges: usize,
    faces: usize,
    components: usize,
    genus: usize,
    rims: usize,
    size_mm: [f64; 3],
    euler_number: i64,
    stray_vertices: usize,
    seams: usize,
    area_mm2: f64,
}

#[derive(Serialize)]
struct Component {
    vertices: usize,
    edges: usize,
    faces: usize,
    genus: usize,
    rims: usize,
    volume_mm3: Option<f64>,
}

#[derive(Serialize)]
struct Lengths {
    min: f64,
    mean: f64,
    max: f64,
    total: f64,
}

#[derive(Serialize)]
struct Rims<'a> {
    edges: &'a [usize],
    length_mm: f64,
}

#[derive(Serialize)]
struct Group<'a> {
    name: &'a str,
    faces: usize,
}

#[derive(Serialize)]
struct Face {
    face: usize,
    sides: usize,
    mm: f64,
    permille: f64,
    degrees: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    percent: Option<f64>,
}

#[derive(Serialize)]
struct Valence<'a> {
    histogram: &'a BTreeMap<usize, usize>,
    other: Vec<usize>,
}

#[derive(Serialize)]
struct FindingRow<'a> {
    check: &'a str,
    code: String,
    element: &'a str,
    id: usize,
    measured: f64,
    limit: f64,
    unit: &'a str,
    message: &'a str,
}

#[derive(Serialize)]
struct Profile {
    name: &'static str,
    max_mm: Option<f64>,
    max_permille: Option<f64>,
    max_degrees: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min_angle_degrees: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min_edge_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max_mitre_degrees: Option<f64>,
    require: Vec<String>,
    note: &'static str,
}

#[derive(Serialize)]
struct Concave {
    edges: Vec<[usize; 2]>,
    faces: Vec<usize>,
    deepest_mm: f64,
}

#[derive(Serialize)]
struct Vertex {
    vertex: usize,
    valence: usize,
    rim: bool,
    residual: Option<f64>,
    deficit_degrees: Option<f64>,
}

#[derive(Serialize)]
struct Edge {
    edge: usize,
    ends: [usize; 2],
    length_mm: f64,
    dihedral_degrees: Option<f64>,
}

#[derive(Serialize)]
struct Conical {
    vertex: usize,
    valence: usize,
    residual: Option<f64>,
}

fn model(report: &Report) -> Model {
    let m = &report.model;
    Model {
        vertices: m.vertices,
        edges: m.edges,
        faces: m.faces,
        components: m.components,
        genus: m.genus,
        rims: m.rims,
        size_mm: m.size_mm.to_array(),
    }
}

/// Inside: the largest of each measure, then a line for each face.
fn planarity(report: &Report) -> String {
    let worst = &report.worst;
    let mut fields = vec![
        ("max_mm", compact(&worst.mm)),
        ("max_permille", compact(&worst.permille)),
        ("max_degrees", compact(&worst.degrees)),
        ("faces", lines(report.faces.iter().map(|f| compact(&face(f))))),
    ];
    fields.extend(worst.percent.map(|percent| ("max_percent", compact(&percent))));
    fields.extend(report.carried_mm.map(|mm| ("carried_mm", compact(&mm))));
    let fields: Vec<String> =
        fields.into_iter().map(|(name, value)| format!("\"{name}\":{value}")).collect();
    format!("{{{}}}", fields.join(","))
}

fn face(f: &FaceReport) -> Face {
    let p = &f.planarity;
    Face {
        face: f.face.index(),
        sides: f.sides,
        mm: p.mm,
        permille: p.permille,
        degrees: p.degrees,
        percent: p.percent,
    }
}

fn vertex(v: &VertexDetail) -> Vertex {
    Vertex {
        vertex: v.vertex.index(),
        valence: v.valence,
        rim: v.is_on_rim,
        residual: v.residual,
        deficit_degrees: v.deficit_degrees,
    }
}

fn edge(e: &EdgeDetail) -> Edge {
    Edge {
        edge: e.edge.index(),
        ends: e.ends.map(|v| v.index()),
        length_mm: e.length_mm,
        dihedral_degrees: e.dihedral_degrees,
    }
}

fn finding(f: &CheckFinding) -> FindingRow<'_> {
    FindingRow {
        check: f.check.name(),
        code: f.check.code().to_string(),
        element: f.element.name(),
        id: f.id,
        measured: f.measured,
        limit: f.limit,
        unit: f.unit.name(),
        message: &f.message,
    }
}

fn profile(report: &Report) -> Profile {
    let Limits { mm, permille, degrees, min_angle_degrees, min_edge_mm, max_mitre_degrees } =
        report.limits;
    Profile {
        name: report.profile.name(),
        max_mm: mm,
        max_permille: permille,
        max_degrees: degrees,
        min_angle_degrees,
        min_edge_mm,
        max_mitre_degrees,
        require: report.require.iter().map(ToString::to_string).collect(),
        note: "limits are kerfold's own defaults or the user's, not norms",
    }
}

fn concave(report: &Report) -> Concave {
    Concave {
        edges: report.concave_ends.iter().map(|ends| ends.map(VertexId::index)).collect(),
        faces: report.convexity.concave_faces.iter().map(|f| f.index()).collect(),
        deepest_mm: report.convexity.deepest_mm,
    }
}

/// A value without any white space.
fn compact<T: Serialize + ?Sized>(value: &T) -> String {
    serde_json::to_string(value).expect("plain numbers, names and lists can be written")
}

/// A list with one item a line.
fn lines(items: impl Iterator<Item = String>) -> String {
    let items: Vec<String> = items.collect();
    if items.is_empty() { "[]".into() } else { format!("[\n    {}\n  ]", items.join(",\n    ")) }
}

/// An object with one key a line; the values are written already.
fn object(fields: &[(&str, String)]) -> String {
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("  \"{name}\": {value}")).collect();
    format!("{{\n{}\n}}\n", fields.join(",\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckParams, Requirement, check};
    use crate::fixtures::{cube, ell_prism, octahedron, open_box};
    use crate::measure::summary;
    use serde_json::{Value, json};

    fn keys_in_order(text: &str, keys: &[&str]) {
        let places: Vec<usize> = keys
            .iter()
            .map(|key| text.find(&format!("\"{key}\"")).unwrap_or_else(|| panic!("no {key}")))
            .collect();
        assert!(places.is_sorted(), "{keys:?} at {places:?}");
    }

    #[test]
    fn the_report_keeps_the_contract() {
        let params = CheckParams { require: vec![Requirement::Convex], ..CheckParams::default() };
        let report = check(&ell_prism(), &params).expect("good limits");
        let text = check_json(&report, "kerfold check \"ell\".obj");
        keys_in_order(
            &text,
            &[
                "command",
                "model",
                "planarity",
                "valence",
                "convex",
                "findings",
                "verdict",
                "profile",
            ],
        );
        keys_in_order(
            &text,
            &["max_mm", "max_permille", "max_degrees", "face", "histogram", "other"],
        );
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["command"], json!("kerfold check \"ell\".obj"));
        let model = json!({"vertices": 12, "edges": 18, "faces": 8, "components": 1, "genus": 0, "rims": 0, "size_mm": [2.0, 2.0, 1.0]});
        assert_eq!(value["model"], model);
        assert_eq!(value["valence"], json!({"histogram": {"3": 12}, "other": []}));
        assert_eq!((&value["convex"], &value["verdict"]), (&json!(false), &json!("fail")));
        assert_eq!(value["planarity"]["faces"].as_array().map(Vec::len), Some(8));
        let last = &value["findings"][2];
        assert_eq!(
            (&last["check"], &last["element"], &last["unit"]),
            (&json!("convex"), &json!("edge"), &json!("degrees"))
        );
        assert_eq!(value["concave"]["edges"].as_array().map(Vec::len), Some(1));
        assert_eq!(text, check_json(&report, "kerfold check \"ell\".obj"));
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let mut mesh = cube();
        mesh.set_position(VertexId::new(3), glam::DVec3::new(1.0, 0.9, -1.0 / 3.0), true);
        let report = check(&mesh, &CheckParams::default()).expect("good limits");
        let text = check_json(&report, "");
        // Read by the standard library: serde_json itself may be off by the last bit.
        let all = |key: &str| -> Vec<f64> {
            let key = format!("\"{key}\":");
            let parts = text.split(&key).skip(1);
            parts
                .map(|part| {
                    part[..part.find([',', '}']).expect("an end")].parse().expect("a number")
                })
                .collect()
        };
        assert_eq!(
            all("degrees"),
            report.faces.iter().map(|f| f.planarity.degrees).collect::<Vec<_>>()
        );
        assert_eq!(all("max_mm")[0], report.worst.mm);
    }

    #[test]
    fn crowded_vertices_are_listed_with_their_residual() {
        let report = check(&octahedron(), &CheckParams::default()).expect("good limits");
        let value: Value = serde_json::from_str(&check_json(&report, "")).expect("JSON");
        assert_eq!(value["valence"]["other"], json!([0, 1, 2, 3, 4, 5]));
        assert_eq!(
            (&value["conical"][5]["vertex"], &value["conical"][5]["valence"]),
            (&json!(5), &json!(4))
        );
        assert_eq!(value["verdict"], json!("pass"));
    }

    #[test]
    fn the_info_says_the_same_as_the_summary() {
        let value: Value = serde_json::from_str(&info_json(
            &summary(&open_box()),
            &["a note".into()],
            "kerfold info x",
        ))
        .expect("JSON");
        assert_eq!(
            (&value["model"]["rims"], &value["model"]["euler_number"]),
            (&json!(1), &json!(1))
        );
        assert_eq!(value["components"][0]["volume_mm3"], Value::Null);
        assert_eq!(value["edge_lengths_mm"]["total"], json!(24.0));
        assert_eq!(value["notes"], json!(["a note"]));
        assert_eq!(value["sides"], json!({"4": 5}));
    }
}
