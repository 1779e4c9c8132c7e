use std::collections::HashMap;

use glam::DVec3;
use roxmltree::{Document, Node, ParsingOptions};
use serde_json::Value;

use super::*;
use crate::check::{CheckParams, Requirement, check, details};
use crate::check::{Details, Report};
use crate::fixtures::{cube, octahedron, open_box};
use crate::io::report::json::check_json_with;
use crate::io::report::page::ReportRows;
use crate::io::report::page::words::{figure, optional};
use crate::make::report_pictures;
use crate::mesh::{Mesh, VertexId};
use crate::picture::RenderParams;
use crate::shape::{SolidParams, solid};

/// A cube with a corner pulled out: three faces bent by more than glass may be.
fn bent() -> Mesh {
    let mut mesh = cube();
    mesh.set_position(VertexId::new(0), DVec3::new(-1.0, -1.1, -1.3), true);
    mesh
}

fn page_of(mesh: &Mesh, rows: ReportRows, params: &CheckParams) -> (String, Report, Details) {
    let report = check(mesh, params).expect("good limits");
    let details = details(mesh);
    let render = RenderParams::default();
    let pictures = report_pictures(mesh, &report, &render).expect("a model that can be drawn");
    let (title, command) = ("a <b> & \"c\"\u{1}.obj", "kerfold check 'a <b>.obj'");
    let page = ReportPage {
        title,
        report: &report,
        details: &details,
        pictures: &pictures,
        rows,
        command,
    };
    (check_html(&page), report, details)
}

fn parsed(html: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(html, options).expect("well-formed XML")
}

fn unbase64(text: &str) -> Vec<u8> {
    let digit = |c| "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/".find(c);
    let (mut bytes, mut bits, mut held) = (Vec::new(), 0_usize, 0);
    for value in text.chars().filter_map(digit) {
        (bits, held) = (bits << 6 | value, held + 6);
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held & 255) as u8);
        }
    }
    bytes
}

/// The figures of each row of a table, and its cells without one as `None`.
fn rows(document: &Document<'_>, class: &str) -> Vec<Vec<Option<f64>>> {
    let figure = |cell: Node<'_, '_>| {
        let data =
            cell.children().find(|n| n.has_tag_name(("http://www.w3.org/1999/xhtml", "data")));
        data.map_or_else(
            || cell.text().and_then(|t| t.parse().ok()),
            |d| d.attribute("value").and_then(|v| v.parse().ok()),
        )
    };
    let is = |n: &Node<'_, '_>, name: &str| n.tag_name().name() == name;
    let table = document
        .descendants()
        .find(|n| is(n, "table") && n.attribute("class") == Some(class))
        .expect(class);
    let body = table.descendants().filter(|n| is(n, "tr")).skip(1);
    body.map(|row| row.children().filter(|n| is(n, "td")).map(figure).collect()).collect()
}

#[test]
fn the_page_is_whole_and_every_picture_in_it_decodes() {
    let (html, report, _) = page_of(&bent(), ReportRows::Worst, &CheckParams::default());
    let document = parsed(&html);
    let named = |name: &str| {
        document.descendants().filter(|n| n.tag_name().name() == name).collect::<Vec<_>>()
    };
    assert_eq!(named("h1")[0].text(), Some("a <b> & \"c\"\u{fffd}.obj"));
    let bent = report.faces.iter().filter(|f| f.breach.is_some()).count();
    assert!(bent > 0 && report.has_findings());
    let images = named("img");
    assert_eq!(
        images.len(),
        3 + 2 * report.faces.iter().filter(|f| f.planarity.mm > 0.0).count().min(12)
    );
    for image in images {
        let data = image
            .attribute("src")
            .and_then(|s| s.strip_prefix("data:image/png;base64,"))
            .expect("inside the page");
        let picture = tiny_skia::Pixmap::decode_png(&unbase64(data)).expect("a PNG file");
        assert!(
            picture.width() >= 320 && picture.pixels().iter().any(|p| *p != picture.pixels()[0]),
            "not blank"
        );
        assert!(image.attribute("alt").is_some_and(|words| !words.is_empty()));
    }
    // Nothing is loaded and nothing runs.
    for node in document.descendants().filter(Node::is_element) {
        assert!(!["script", "link", "iframe", "object"].contains(&node.tag_name().name()));
        assert!(
            node.attributes().all(
                |a| a.name() != "href" && (a.name() != "src" || a.value().starts_with("data:"))
            )
        );
    }
    assert!(!html.contains("url(") && !html.contains("@import"));
    assert!(html.contains(&format!("Fail: {} findings", report.findings.len())));
}

#[test]
fn the_figures_are_those_of_the_json() {
    let mut open = open_box();
    open.set_position(VertexId::new(2), DVec3::new(1.3, 1.2, -0.9), true);
    for mesh in [bent(), octahedron(), open] {
        let (html, report, details) = page_of(&mesh, ReportRows::All, &CheckParams::default());
        let json: Value =
            serde_json::from_str(&check_json_with(&report, Some(&details), "k")).expect("JSON");
        let document = parsed(&html);
        let told = |list: &Value, keys: &[&str]| -> Vec<Vec<Option<f64>>> {
            let row = |row: &Value| keys.iter().map(|key| row[key].as_f64()).collect();
            list.as_array().expect("a list").iter().map(row).collect()
        };
        let picked = |class: &str, columns: &[usize]| -> Vec<Vec<Option<f64>>> {
            rows(&document, class)
                .iter()
                .map(|row| columns.iter().map(|&c| row[c]).collect())
                .collect()
        };
        let keys = ["face", "sides", "mm", "permille", "degrees", "percent"];
        assert_eq!(picked("faces", &[0, 1, 2, 3, 4, 5]), told(&json["planarity"]["faces"], &keys));
        let keys = ["vertex", "valence", "residual", "deficit_degrees"];
        assert_eq!(picked("nodes", &[0, 1, 3, 4]), told(&json["vertices"], &keys));
        assert_eq!(
            picked("edges", &[1, 2]),
            told(&json["edges"], &["length_mm", "dihedral_degrees"])
        );
        let largest = ["max_mm", "max_permille", "max_degrees", "max_percent"]
            .map(|k| json["planarity"][k].as_f64());
        assert_eq!(rows(&document, "limits").iter().map(|r| r[1]).collect::<Vec<_>>(), largest);
        let limits = ["max_mm", "max_permille", "max_degrees"].map(|k| json["profile"][k].as_f64());
        assert_eq!(
            rows(&document, "limits").iter().map(|r| r[2]).take(3).collect::<Vec<_>>(),
            limits
        );
    }
}

#[test]
fn every_panel_node_and_fold_stands_in_one_bar() {
    let mesh = bent();
    let (html, report, details) = page_of(&mesh, ReportRows::Worst, &CheckParams::default());
    let document = parsed(&html);
    let mut sums = HashMap::new();
    for chart in document.descendants().filter(|n| n.attribute("class") == Some("chart")) {
        let labels = chart
            .children()
            .filter(|n| n.tag_name().name() == "text" && n.attribute("class").is_none());
        // The last one is the axis.
        let counts: usize = labels.filter_map(|n| n.text()?.parse::<usize>().ok()).sum();
        sums.insert(chart.attribute("aria-label").expect("a name"), counts);
    }
    assert_eq!(sums["Panels by share of the limit"], report.faces.len());
    assert_eq!(sums["Panels by distance in mm"], report.faces.len());
    assert_eq!(sums["Nodes by valence"], mesh.vertex_count());
    assert_eq!(sums["Edges by dihedral angle"], details.edges.len());
    let (flat, ..) = page_of(&cube(), ReportRows::Worst, &CheckParams::default());
    assert!(flat.contains("more than rounding") && !flat.contains("Panels by distance in mm"));
    assert!(flat.contains("Pass: ") && !flat.contains("class=\"fail\""));
}

#[test]
fn long_lists_are_cut_and_say_so() {
    let params = CheckParams { require: vec![Requirement::Valence3], ..CheckParams::default() };
    let mesh =
        solid(&SolidParams { name: "geodesic-3".parse().expect("a name"), edge: None, size: None });
    let mesh = mesh.expect("a solid");
    let (html, report, _) = page_of(&mesh, ReportRows::Worst, &params);
    let document = parsed(&html);
    assert_eq!(
        ["faces", "nodes", "edges", "findings"].map(|class| rows(&document, class).len()),
        [24, 24, 24, 12]
    );
    assert!(html.contains(&format!("12 of {}", report.findings.len())));
    let residuals: Vec<f64> = rows(&document, "nodes").iter().filter_map(|row| row[3]).collect();
    assert!(residuals.len() == 24 && residuals.is_sorted_by(|a, b| a >= b), "{residuals:?}");
    // Triangles are planar exactly: there is no worst one.
    assert!(!html.contains("The worst panels"));
    let (html, ..) = page_of(&mesh, ReportRows::All, &params);
    let document = parsed(&html);
    assert_eq!(rows(&document, "faces").len(), mesh.face_count());
    assert_eq!(rows(&document, "edges").len(), mesh.edge_count());
}

#[test]
fn small_figures_are_told_as_small_and_kept_in_full() {
    let figure = |x| words(&figure(x));
    assert_eq!(figure(1.5e-9), "<data value=\"1.5e-9\">&lt; 0.0001</data>");
    assert_eq!(figure(-12.34567), "<data value=\"-12.34567\">−12.35</data>");
    assert_eq!(words(&optional(None)), "–");
}
