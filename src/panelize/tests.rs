use glam::DVec3;

use super::*;
use crate::mesh::assert_sound;
use crate::progress::Silent;
use crate::units::Length;

/// A height field over a rectangle about the origin, of triangles of about a given size.
fn roof(width: f64, depth: f64, step: f64, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let (columns, rows) = ((width / step).ceil() as usize, (depth / step).ceil() as usize);
    let at = |i: usize, j: usize| {
        let x = width * (i as f64 / columns as f64 - 0.5);
        let y = depth * (j as f64 / rows as f64 - 0.5);
        DVec3::new(x, y, height(x, y))
    };
    let points = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
    let points: Vec<DVec3> = points.map(|(i, j)| at(i, j)).collect();
    let id = |i: usize, j: usize| j * (columns + 1) + i;
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    });
    Mesh::from_faces(points, faces.collect::<Vec<_>>()).expect("a roof")
}

fn sized(mm: f64) -> PanelizeParams {
    PanelizeParams {
        size: Some(Length::from_mm(mm)),
        rim: RimChoice::Walls,
        ..PanelizeParams::default()
    }
}

/// What must hold for every result that is not complained of.
fn assert_good(made: &Mesh, report: &PanelizeReport) {
    assert_sound(made);
    assert!(report.is_clean(), "{:?}", report.notes());
    for v in made.vertices() {
        let most = if made.is_rim_vertex(v) { 2..=3 } else { 3..=3 };
        assert!(most.contains(&made.valence(v)), "vertex {v} has {} edges", made.valence(v));
    }
    for f in made.faces() {
        let off = crate::measure::planarity(made, f).mm;
        assert!(off < 1e-12 * report.size_mm, "face {f} is off by {off} mm");
    }
    assert!((report.panels as f64 / report.wanted - 1.0).abs() < 0.1, "{report:?}");
}

#[test]
fn a_dome_a_saddle_and_a_vault_become_planar_panels_with_three_members_at_every_node() {
    type Height = fn(f64, f64) -> f64;
    let roofs: [(Height, usize); 3] = [
        (|x, y| -(x * x + y * y) / 12_000.0, 0),
        (|x, y| (x * x - y * y) / 14_000.0, 8),
        (|x, _| -x * x / 12_000.0, 0),
    ];
    for (height, concave) in roofs {
        let mesh = roof(5000.0, 4000.0, 250.0, height);
        let (made, report) = panelize(&mesh, &sized(1000.0), &Silent).expect("panels");
        assert_good(&made, &report);
        assert!(report.deviation_mm[0] < 80.0, "{report:?}");
        assert!(report.concave >= concave, "bow-ties are needed in saddles: {report:?}");
        // Straight rims stay in their walls.
        for v in made.vertices().filter(|&v| made.is_rim_vertex(v)) {
            let p = made.position(v);
            let off = (p.x.abs() - 2500.0).abs().min((p.y.abs() - 2000.0).abs());
            assert!(off < 1e-9, "{p}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_one_another_layout() {
    let mesh = roof(4000.0, 4000.0, 250.0, |x, y| (x * y) / 9_000.0);
    let run = |seed: u64| {
        let params = PanelizeParams { seed, ..sized(1000.0) };
        let (made, _) = panelize(&mesh, &params, &Silent).expect("panels");
        made.vertices().map(|v| made.position(v).to_array().map(f64::to_bits)).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn a_count_and_a_sag_give_a_size() {
    let mesh = roof(4500.0, 4500.0, 300.0, |x, y| -(x * x + y * y) / 12_000.0);
    let count = PanelizeParams { count: Some(30), size: None, ..sized(1.0) };
    let (made, report) = panelize(&mesh, &count, &Silent).expect("panels");
    assert_good(&made, &report);
    assert!((27..=33).contains(&made.face_count()), "{report:?}");
    // The curvature is 1/6000 mm: a panel of 900 mm leaves the surface by 22.5 mm.
    let sag = PanelizeParams { sag: Some(Length::from_mm(22.5)), size: None, ..sized(1.0) };
    let (_, report) = panelize(&mesh, &sag, &Silent).expect("panels");
    assert!((report.size_mm / 900.0 - 1.0).abs() < 0.1, "{report:?}");
}

#[test]
fn what_is_wrong_is_told_with_its_place() {
    let mesh = roof(4000.0, 3000.0, 250.0, |x, _| -2.0 * x.abs());
    let (_, report) = panelize(&mesh, &sized(1200.0), &Silent).expect("panels");
    assert!(!report.is_clean());
    let told = report.notes().concat();
    assert!(told.contains("(F604)") && told.contains("smaller size"), "{told}");
    let sheet = PanelizeParams { max_panel: Some(SheetSize([500.0, 600.0])), ..sized(800.0) };
    let (_, report) = panelize(&mesh, &sheet, &Silent).expect("panels");
    assert!(report.notes().concat().contains("(F607)"), "{:?}", report.notes());
    let narrow = roof(4000.0, 200.0, 100.0, |_, _| 0.0);
    let error = panelize(&narrow, &sized(1500.0), &Silent).expect_err("one row");
    assert!(matches!(error, PanelizeError::TooNarrow { .. }), "{error}");
    let error = panelize(&mesh, &sized(0.5), &Silent).expect_err("too many");
    assert!(matches!(error, PanelizeError::TooFine { .. }), "{error}");
    for (params, given) in
        [(PanelizeParams::default(), 0), (PanelizeParams { count: Some(40), ..sized(1000.0) }, 2)]
    {
        let error = panelize(&mesh, &params, &Silent).expect_err("no size, or two");
        assert_eq!(error, PanelizeError::NoSize { given });
    }
    let params = PanelizeParams { even: 0.7, ..sized(1000.0) };
    let error = panelize(&mesh, &params, &Silent).expect_err("out of range");
    assert!(matches!(error, PanelizeError::OutOfRange { .. }), "{error}");
}

#[test]
fn rims_are_read_as_they_are_written() {
    for text in ["free", "walls", "plane:z=0mm", "plane:z=0mm,x=250mm"] {
        assert_eq!(text.parse::<RimChoice>().expect(text).to_string(), text);
    }
    for text in ["", "wall", "plane:", "plane:w=0", "plane:z=a"] {
        assert!(text.parse::<RimChoice>().is_err(), "{text}");
    }
}
