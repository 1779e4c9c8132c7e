//! The SVG of a small two-piece net: compared with a golden file, read by an XML parser, judged by
//! the contract.
//!
//! `KERFOLD_BLESS=1 cargo test --test sheet_svg` rewrites the golden files.

use std::collections::BTreeSet;

use glam::DVec2;
use kerfold::io::sheet::layout::write_layout_json;
use kerfold::io::sheet::svg::write_svg;
use kerfold::net::{
    EdgeLabel, FlatFace, Fold, FoldKind, MeshCounts, Net, Piece, PieceId, Proof, Seam, SeamSide,
    Segment,
};
use kerfold::sheet::{
    Preset, ScoreParams, ScoreStyle, SheetParams, SheetSet, StockParams, lay_out,
};
use kerfold::units::Length;

use golden::{assert_golden, difference};

#[path = "golden/mod.rs"]
mod golden;

const PRESETS: [Preset; 8] = [
    Preset::RedCut,
    Preset::Boxes,
    Preset::Lightburn,
    Preset::Ponoko,
    Preset::Glowforge,
    Preset::Epilog,
    Preset::Cricut,
    Preset::Silhouette,
];

const COMMAND: &str = "kerfold nest \"a&b\".json --kerf 0.2mm <x> \u{1}-- \u{1b}[0m";

fn points<const N: usize>(corners: [(f64, f64); N]) -> Vec<DVec2> {
    corners.map(DVec2::from).to_vec()
}

/// A strip of two squares with a fold, and a frame of four quadrilaterals around a hole; one seam
/// joins them.
fn small_net() -> Net {
    let strip =
        points([(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (60.0, 30.0), (30.0, 30.0), (0.0, 30.0)]);
    let face = |face, vertices: &[usize], polygon: Vec<DVec2>| FlatFace {
        face,
        vertices: vertices.to_vec(),
        polygon,
    };
    let left = face(0, &[0, 1, 4, 5], vec![strip[0], strip[1], strip[4], strip[5]]);
    let right = face(1, &[1, 2, 3, 4], vec![strip[1], strip[2], strip[3], strip[4]]);
    let outer = points([(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)]);
    let inner = points([(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)]);
    let names = [3, 2, 6, 7];
    let ring = |i: usize| {
        let j = (i + 1) % 4;
        face(
            2 + i,
            &[names[i], names[j], 10 + j, 10 + i],
            vec![outer[i], outer[j], inner[j], inner[i]],
        )
    };
    let fold = |id, edge, piece, faces, segment: Segment, kind| {
        let fold_angle = if kind == FoldKind::Mountain { 30.0 } else { -30.0 };
        Fold { id: EdgeLabel(id), edge, piece: PieceId(piece), faces, segment, fold_angle, kind }
    };
    let mut folds = vec![fold(4, [1, 4], 0, [0, 1], [strip[1], strip[4]], FoldKind::Mountain)];
    for i in 0..4 {
        let kind = if i % 2 == 0 { FoldKind::Valley } else { FoldKind::Mountain };
        folds.push(fold(
            20 + i,
            [names[i], 10 + i],
            1,
            [2 + i, 2 + (i + 3) % 4],
            [outer[i], inner[i]],
            kind,
        ));
    }
    let side = |piece, face, segment| SeamSide { piece: PieceId(piece), face, segment };
    let sides = [side(0, 1, [strip[2], strip[3]]), side(1, 2, [outer[1], outer[0]])];
    let seam = Seam { id: EdgeLabel(16), edge: [2, 3], length: 30.0, fold_angle: 90.0, sides };
    let pieces = vec![
        Piece { id: PieceId(0), outline: strip, holes: vec![], faces: vec![left, right] },
        Piece {
            id: PieceId(1),
            outline: outer.clone(),
            holes: vec![inner.iter().rev().copied().collect()],
            faces: (0..4).map(ring).collect(),
        },
    ];
    let counts = MeshCounts { vertices: 14, edges: 20, faces: 6 };
    Net {
        scale: 1.0,
        counts,
        pieces,
        folds,
        seams: vec![seam],
        rims: vec![],
        proof: Proof::default(),
    }
}

fn laid_out(params: &SheetParams) -> SheetSet {
    lay_out(&small_net(), params).expect("two small pieces fit")
}

fn with_kerf() -> SheetParams {
    SheetParams {
        stock: StockParams { kerf: Length::from_mm(0.2), ..StockParams::default() },
        ..SheetParams::default()
    }
}

#[test]
fn golden_svg_and_layout() {
    let set = laid_out(&with_kerf());
    assert_golden(
        "fixtures/golden/two_pieces_sheet.svg",
        &write_svg(&set.drawings[0], Preset::RedCut, COMMAND),
    );
    assert_golden(
        "fixtures/golden/two_pieces_layout.json",
        &write_layout_json(&set.layout, COMMAND),
    );
}

#[test]
fn the_compare_fails_on_one_changed_byte() {
    let set = laid_out(&with_kerf());
    let text = write_svg(&set.drawings[0], Preset::RedCut, COMMAND);
    assert_eq!(difference(&text, &text), None);
    let changed = text.replacen('5', "6", 1);
    assert!(difference(&changed, &text).is_some());
    assert!(difference(&text[..text.len() - 1], &text).is_some());
}

#[test]
fn the_file_keeps_the_contract_under_every_preset() {
    for preset in PRESETS {
        for score in [ScoreStyle::Solid, ScoreStyle::Dashed] {
            let set = laid_out(&SheetParams {
                score: ScoreParams { style: score, ..with_kerf().score },
                ..with_kerf()
            });
            let text = write_svg(&set.drawings[0], preset, COMMAND);
            assert_contract(&text);
        }
    }
}

fn assert_contract(text: &str) {
    let document = roxmltree::Document::parse(text).expect("well-formed XML");
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("600mm"));
    assert_eq!(root.attribute("height"), Some("400mm"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 600 400"));
    let metadata = root
        .children()
        .find(|n| n.has_tag_name("metadata"))
        .and_then(|n| n.text())
        .expect("metadata");
    assert_eq!(metadata, COMMAND.replace(['\u{1}', '\u{1b}'], "\u{fffd}"));
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let layers: Vec<_> =
        root.children().filter(|n| n.attribute((inkscape, "groupmode")) == Some("layer")).collect();
    let names: Vec<_> = layers.iter().filter_map(|n| n.attribute((inkscape, "label"))).collect();
    assert_eq!(names, ["engrave", "score", "cut-inner", "cut-outer", "info"]);
    let mut ids = BTreeSet::new();
    for node in document.descendants().filter(|n| n.is_element()) {
        assert!(!node.has_tag_name("text") && node.attribute("transform").is_none());
        assert!(node.attribute("id").is_none_or(|id| ids.insert(id.to_owned())), "id twice");
        if let Some(width) = node.attribute("stroke-width") {
            assert!(width.parse::<f64>().expect("a number") <= 0.2);
        }
        if let Some(data) = node.attribute("d") {
            assert_path(data, node.attribute("class").expect("a class"));
        }
    }
    for id in [
        "P01",
        "P02",
        "P02-hole-1",
        "E004",
        "E020",
        "P01-name",
        "E016-number-1",
        "E016-number-2",
        "reference",
    ] {
        assert!(ids.contains(id), "{id}");
    }
}

fn assert_path(data: &str, class: &str) {
    if matches!(class, "outline" | "hole") {
        assert!(data.ends_with(" Z") && data.matches('M').count() == 1, "{data}");
    }
    for number in data.split([' ', ',']).filter(|t| !matches!(*t, "M" | "L" | "Z")) {
        assert!(number.parse::<f64>().is_ok_and(|x| (0.0..=600.0).contains(&x)), "{number}");
        assert!(
            !number.starts_with("-0") && number.split_once('.').is_none_or(|(_, d)| d.len() <= 4),
            "{number}"
        );
    }
}

fn short(mm: f64) -> f64 {
    (mm * 1e4).round() / 1e4
}

#[test]
fn y_is_turned_over_and_nothing_else() {
    let set = laid_out(&SheetParams::default());
    let text = write_svg(&set.drawings[0], Preset::RedCut, "");
    let document = roxmltree::Document::parse(&text).expect("well-formed XML");
    let data = document
        .descendants()
        .find(|n| n.attribute("id") == Some("P01"))
        .and_then(|n| n.attribute("d"));
    let placed = set.layout.sheets[0].placed[0];
    let outline = placed.apply_all(&small_net().pieces[0].outline);
    let corner = |x: f64, y: f64| format!("{},{}", short(x), short(400.0 - y));
    let mut expected: Vec<String> = outline.iter().map(|p| corner(p.x, p.y)).collect();
    let found: Vec<&str> =
        data.expect("a path").trim_matches(|c| " MZ".contains(c)).split(" L ").collect();
    // Where the contour begins is the machine's business.
    let first = expected.iter().position(|p| p == found[0]).expect("it begins at a corner");
    expected.rotate_left(first);
    assert_eq!(found, expected);
}
