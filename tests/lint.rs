//! Planted faults are found where they are, sound drawings pass, and so does all that we write
//! ourselves.

use std::path::Path;

use glam::DVec2;
use kerfold::io::artwork::read_artwork;
use kerfold::io::sheet::files::sheet_bytes;
use kerfold::io::sheet::pdf::tiles::write_tiles;
use kerfold::lint::{Check, LintFinding, LintParams, lint, lint_pages};
use kerfold::make::{material, with_material};
use kerfold::net::{MeshCounts, Net, Piece, PieceId, Proof};
use kerfold::progress::Silent;
use kerfold::recipe::{Job, Recipe};
use kerfold::sheet::{
    CommonLine, FileParams, NestParams, Paper, Preset, ScoreParams, ScoreStyle, SheetFormat,
    SheetParams, SheetSize, StockParams, kerf_coupon, lay_out,
};
use kerfold::units::Length;

fn found(name: &str, params: &LintParams) -> Vec<LintFinding> {
    let path = Path::new("fixtures/lint").join(name);
    let bytes = std::fs::read(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
    let (_, pages) = read_artwork(&path, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
    lint_pages(&pages, params).expect("little").into_iter().flat_map(|r| r.findings).collect()
}

/// File, fault, the line that has it, and its place.
type Planted = (&'static str, Check, &'static str, Option<(f64, f64)>);

/// Thickness 3 mm: holes below 4.5 mm are too small.
const PLANTED: &[Planted] = &[
    ("01-open-contour.svg", Check::OpenContour, "gapped", Some((10.0, 89.8))),
    ("02-gap.dxf", Check::OpenContour, "path 1 on CUT", Some((10.0, 10.5))),
    ("03-duplicate.svg", Check::Duplicate, "again", None),
    ("04-overlap.dxf", Check::Overlap, "path 2 on CUT_OUTER", Some((110.0, 45.0))),
    ("05-text.svg", Check::Text, "", Some((20.0, 60.0))),
    ("06-text.pdf", Check::Text, "", Some((20.0, 40.0))),
    ("07-pixels.svg", Check::Units, "", None),
    ("08-no-unit.dxf", Check::Units, "", None),
    ("09-off-sheet.svg", Check::OffSheet, "beyond", Some((201.96, 70.0))),
    ("10-small-hole.svg", Check::SmallHole, "pinhole", Some((41.5, 60.0))),
    ("11-thin-web.dxf", Check::ThinWeb, "path 2 on CUT_INNER", Some((46.2, 40.0))),
    ("12-outer-first.svg", Check::Order, "late", None),
    ("13-stray-point.dxf", Check::StrayPoint, "path 1 on CUT_OUTER", Some((150.0, 50.0))),
    ("14-bow-tie.svg", Check::SelfCrossing, "bow", Some((60.0, 55.0))),
    ("15-score-after-cut.svg", Check::Order, "fold", None),
    ("16-crossing.pdf", Check::Crossing, "path 2", Some((110.0, 40.0))),
    ("17-stretched.svg", Check::Units, "", None),
    ("18-used-twice.svg", Check::Duplicate, "s", None),
    ("19-wrong-unit.dxf", Check::Units, "", None),
];

#[test]
fn every_planted_fault_is_found_in_its_place_and_nothing_else() {
    let params = LintParams { thickness: Some(Length::from_mm(3.0)), ..LintParams::default() };
    let mut listed: Vec<String> = std::fs::read_dir("fixtures/lint")
        .expect("fixtures")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    listed.retain(|name| !name.starts_with("good"));
    listed.sort();
    assert_eq!(listed, PLANTED.iter().map(|p| p.0).collect::<Vec<_>>());
    for &(name, check, element, at) in PLANTED {
        let findings = found(name, &params);
        assert_eq!(findings.len(), 1, "{name}: {findings:?}");
        let finding = &findings[0];
        assert_eq!(
            (finding.check, finding.element.as_str()),
            (check, element),
            "{name}: {finding:?}"
        );
        if let Some(at) = at {
            let distance = finding.at.expect("a place").distance(DVec2::from(at));
            assert!(distance < 0.02, "{name}: {finding:?}");
        }
    }
}

#[test]
fn sound_drawings_pass() {
    let params = LintParams { thickness: Some(Length::from_mm(3.0)), ..LintParams::default() };
    for name in ["good.svg", "good.dxf", "good.pdf"] {
        assert_eq!(found(name, &params), [], "{name}");
    }
}

#[test]
fn limits_move_with_the_parameters() {
    let thin = LintParams { thickness: Some(Length::from_mm(1.9)), ..LintParams::default() };
    assert_eq!(found("10-small-hole.svg", &thin), []);
    let narrow = LintParams { web: Some(Length::from_mm(0.3)), ..LintParams::default() };
    assert_eq!(found("11-thin-web.dxf", &narrow), []);
    let kerf = LintParams { kerf: Some(Length::from_mm(0.2)), ..narrow };
    assert_eq!(found("11-thin-web.dxf", &kerf).len(), 1);
    let tabs = LintParams { tabs: Some(Length::from_mm(0.6)), ..LintParams::default() };
    assert_eq!(found("02-gap.dxf", &tabs), []);
    let sheet =
        LintParams { sheet: Some("150x90".parse().expect("a size")), ..LintParams::default() };
    assert_eq!(found("good.svg", &sheet).len(), 1);
    assert_eq!(found("good.dxf", &sheet), []);
}

/// All drawings of a recipe, in all formats, judged against their own sheet.
fn assert_clean(name: &str, drawings: &[kerfold::sheet::Drawing], params: &SheetParams) {
    for format in SheetFormat::ALL.into_iter().filter(|f| *f != SheetFormat::Lbrn2) {
        for drawing in drawings {
            let bytes = sheet_bytes(drawing, format, params, "kerfold");
            let place = format!("{name} {} {}", drawing.file_stem(), format.extension());
            let (_, pages) =
                read_artwork(Path::new("x"), &bytes).unwrap_or_else(|e| panic!("{place}: {e}"));
            let limit = kerfold::lint::SheetLimit { width: drawing.width, height: drawing.height };
            let limits = LintParams { sheet: Some(limit), ..LintParams::default() };
            assert_eq!(pages.len(), 1, "{place}");
            let strokes: usize = drawing.marks().map(|m| m.strokes.len()).sum();
            assert_eq!(pages[0].paths.len(), strokes, "{place}");
            assert_eq!(lint(&pages[0], &limits).expect("little").findings, [], "{place}");
        }
    }
}

/// The first drawing, cut up onto sheets of paper.
fn assert_tiles_clean(name: &str, drawings: &[kerfold::sheet::Drawing], params: &SheetParams) {
    if let Some(drawing) = drawings.first() {
        let bytes =
            write_tiles(drawing, Paper::A4, params.style(), "kerfold").expect("known letters");
        let (_, pages) = read_artwork(Path::new("x"), &bytes).expect("a PDF");
        assert!(pages.len() > 1);
        for (i, page) in pages.iter().enumerate() {
            assert_eq!(
                lint(page, &LintParams::default()).expect("little").findings,
                [],
                "{name} on A4, page {}",
                i + 1
            );
        }
    }
}

#[test]
fn sheets_with_shared_lines_pass() {
    let ring = |i: usize| -> Vec<DVec2> {
        let corners = [3, 4, 6][i % 3];
        let corner = |k: usize| {
            DVec2::from_angle(i as f64 + k as f64 * std::f64::consts::TAU / corners as f64) * 25.0
        };
        (0..corners).map(corner).collect()
    };
    let polygon =
        |corners: &[[f64; 2]]| corners.iter().map(|&c| DVec2::from(c)).collect::<Vec<_>>();
    let ell =
        polygon(&[[0.0, 0.0], [80.0, 0.0], [80.0, 30.0], [30.0, 30.0], [30.0, 80.0], [0.0, 80.0]]);
    let triangle = polygon(&[[0.0, 0.0], [60.0, 0.0], [0.0, 40.0]]);
    let bar = polygon(&[[0.0, 0.0], [150.0, 0.0], [150.0, 20.0], [0.0, 20.0]]);
    let mixed = |i: usize| [&ell, &triangle, &bar, &triangle][i % 4].clone();
    let shapes: [&dyn Fn(usize) -> Vec<DVec2>; 2] = [&ring, &mixed];
    for shape in shapes {
        assert_shared_lines_pass(shape);
    }
}

fn assert_shared_lines_pass(shape: &dyn Fn(usize) -> Vec<DVec2>) {
    let piece = |i: usize| Piece {
        id: PieceId(i),
        outline: shape(i),
        holes: Vec::new(),
        faces: Vec::new(),
    };
    let net = Net {
        scale: 1.0,
        counts: MeshCounts::default(),
        pieces: (0..24).map(piece).collect(),
        folds: Vec::new(),
        seams: Vec::new(),
        rims: Vec::new(),
        proof: Proof::default(),
    };
    let nest = NestParams { common_line: CommonLine::On, ..NestParams::default() };
    let params = SheetParams {
        stock: StockParams { sheet: SheetSize::of_mm(240.0, 160.0), ..StockParams::default() },
        nest,
        ..SheetParams::default()
    };
    let set = lay_out(&net, &params).expect("all fit");
    assert!(set.report.shared_length > 300.0, "{}", set.report.shared_length);
    assert_clean("shared lines", &set.drawings, &params);
}

#[test]
fn nothing_is_found_in_what_we_write_ourselves() {
    let folder = Path::new("fixtures/recipes");
    let mut names: Vec<_> =
        std::fs::read_dir(folder).expect("recipes").map(|e| e.expect("an entry").path()).collect();
    names.retain(|path| path.is_file());
    names.sort();
    for path in names {
        let text = std::fs::read_to_string(&path).expect("a recipe");
        let recipe = Recipe::parse(&text).expect("a recipe");
        let job = Job::run(&recipe, folder, &Silent)
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        if let Some((fabrication, params)) = &job.fabrication {
            let name = path.display().to_string();
            assert_clean(&name, &fabrication.sheets.drawings, params);
            assert_tiles_clean(&name, &fabrication.sheets.drawings, params);
        }
    }
}

#[test]
fn every_preset_score_and_coupon_is_clean() {
    let text =
        "[[step]]\nsolid = \"truncated-cube\"\nsize = \"120mm\"\n[[step]]\nunfold = \"auto\"";
    let recipe = Recipe::parse(text).expect("a recipe");
    let job = Job::run(&recipe, Path::new(""), &Silent).expect("a solid");
    let net = &job.fabrication.as_ref().expect("pieces").0.net;
    let base = SheetParams {
        stock: StockParams {
            kerf: Length::from_mm(0.2),
            sheet: SheetSize::of_mm(700.0, 500.0),
            ..StockParams::default()
        },
        ..SheetParams::default()
    };
    for preset in [
        Preset::Boxes,
        Preset::Lightburn,
        Preset::Ponoko,
        Preset::Glowforge,
        Preset::Epilog,
        Preset::Cricut,
        Preset::Silhouette,
    ] {
        let params = SheetParams {
            files: FileParams { preset, ..base.files.clone() },
            score: ScoreParams { style: ScoreStyle::Valleys, ..base.score.clone() },
            ..base.clone()
        };
        let set = kerfold::sheet::lay_out(net, &params).expect("fits");
        assert_clean(&format!("{preset:?}"), &set.drawings, &params);
    }
    for score in [ScoreStyle::Dashed, ScoreStyle::Perforated] {
        let params = SheetParams {
            score: ScoreParams { style: score, ..base.score.clone() },
            ..base.clone()
        };
        let set = kerfold::sheet::lay_out(net, &params).expect("fits");
        assert_clean(&format!("{score:?}"), &set.drawings, &params);
    }
    let ply = material("ply3", None).expect("bundled");
    let coupon = kerf_coupon(ply.thickness.mm(), &ply.title).expect("a coupon");
    let params = SheetParams {
        stock: StockParams { material: Some("ply3".to_owned()), ..StockParams::default() },
        ..SheetParams::default()
    };
    assert_clean("coupon", &[coupon], &with_material(&params, Path::new("")).expect("bundled"));
}

#[test]
fn files_that_cannot_be_followed_say_why() {
    let read = |name: &str, bytes: &[u8]| read_artwork(Path::new(name), bytes).map(|r| r.1.len());
    for (name, bytes, words) in [
        ("x.svg", &b""[..], "empty"),
        ("x.txt", b"hello", "neither SVG, DXF nor PDF"),
        ("x.svg", b"<svg xmlns='http://www.w3.org/2000/svg'><g>", "no sound SVG"),
        (
            "x.svg",
            b"<svg xmlns='http://www.w3.org/2000/svg'><g id='a'><use href='#a'/></g></svg>",
            "nested",
        ),
        ("x.dxf", b"  0\nSECTION\n  2\nENTITIES\n", "breaks off"),
        ("x.dxf", b"  0\nSECTION\nzero\nENTITIES\n", "line 3"),
        ("x.dxf", b"AutoCAD Binary DXF\r\n\x1a\0", "binary file breaks off"),
        ("x.pdf", b"%PDF-1.4\n1 0 obj\n<< >>\nendobj\n", "no catalogue"),
        ("x.pdf", b"%PDF-1.4\ntrailer << /Encrypt 1 0 R >>", "encrypted"),
    ] {
        let error = read(name, bytes).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    }
}
