//! Layouts in rings on surfaces of revolution.

use super::*;

/// A surface of revolution about an upright axis through a place, by radius and height in mm; a
/// radius of 0 is a point on the axis.
fn turned(curve: &[(f64, f64)], columns: usize, axis: DVec3) -> Mesh {
    let mut points = Vec::new();
    let rows: Vec<Vec<usize>> = curve
        .iter()
        .map(|&(radius, height)| {
            let first = points.len();
            let count = if radius == 0.0 { 1 } else { columns };
            points.extend((0..count).map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / columns as f64;
                axis + DVec3::new(radius * angle.cos(), radius * angle.sin(), height)
            }));
            (0..columns).map(|i| first + i % count).collect()
        })
        .collect();
    let mut faces = Vec::new();
    for pair in rows.windows(2) {
        for i in 0..columns {
            let j = (i + 1) % columns;
            let mut face = vec![pair[0][i], pair[0][j], pair[1][j], pair[1][i]];
            face.dedup();
            if face.first() == face.last() {
                face.pop();
            }
            faces.push(face);
        }
    }
    Mesh::from_faces(points, faces).expect("a surface of revolution")
}

fn in_rings(mm: f64, axis: usize) -> PanelizeParams {
    PanelizeParams { layout: LayoutChoice::Rings(axis), ..sized(mm) }
}

/// The number of different panels, by all distances between their corners.
fn kinds_of(made: &Mesh, tolerance: f64) -> usize {
    let mut firsts: Vec<Vec<f64>> = Vec::new();
    for f in made.faces() {
        let p = made.face_positions(f);
        let pairs = (0..p.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let mut distances: Vec<f64> = pairs.map(|(i, j)| p[i].distance(p[j])).collect();
        distances.sort_by(f64::total_cmp);
        let is_like = |other: &&Vec<f64>| {
            let mut both = distances.iter().zip(other.iter());
            other.len() == distances.len() && both.all(|(a, b)| (a - b).abs() < tolerance)
        };
        if !firsts.iter().any(|first| is_like(&first)) {
            firsts.push(distances);
        }
    }
    firsts.len()
}

#[test]
fn rings_of_a_tower_and_of_a_dome_have_one_kind_of_panel_each() {
    // A waist, about an axis that is not in the middle of any box.
    let tower: Vec<(f64, f64)> = (0..=24)
        .map(|k| f64::from(k) * 125.0)
        .map(|z| (1800.0 + (z - 1800.0) * (z - 1800.0) / 9000.0, z))
        .collect();
    let dome: Vec<(f64, f64)> = (0..=20)
        .map(|k| f64::from(k) / 20.0)
        .map(|t| (2600.0 * (1.1 * (1.0 - t)).sin(), 2600.0 * (1.1 * (1.0 - t)).cos()))
        .collect();
    for (curve, mm) in [(tower, 900.0), (dome, 800.0)] {
        let mesh = turned(&curve, 60, DVec3::new(700.0, -400.0, 100.0));
        let (made, report) = panelize(&mesh, &in_rings(mm, 2), &Silent).expect("rings");
        assert_good(&made, &report);
        let kinds = kinds_of(&made, 1e-6);
        assert!(report.rings > 2 && kinds <= report.rings + 2, "{kinds}: {report:?}");
        assert!(report.panel_kinds <= kinds, "{kinds}: {report:?}");
        assert!(report.deviation_mm[0] < 0.08 * mm, "{report:?}");
    }
}

#[test]
fn what_does_not_turn_about_an_axis_is_refused() {
    let wave = roof(4000.0, 3000.0, 250.0, |x, y| (x * y) / 9_000.0);
    let error = panelize(&wave, &in_rings(900.0, 2), &Silent).expect_err("a saddle");
    assert!(matches!(error, PanelizeError::NotRound { axis: "z", .. }), "{error}");
    let tube: Vec<(f64, f64)> = (0..=10).map(|k| (1500.0, f64::from(k) * 300.0)).collect();
    let tube = turned(&tube, 40, DVec3::ZERO);
    let error = panelize(&tube, &in_rings(900.0, 0), &Silent).expect_err("the wrong axis");
    let is_refused = matches!(error, PanelizeError::NoTurn { .. } | PanelizeError::NotRound { .. });
    assert!(is_refused, "{error}");
    let half = tube.faces().filter(|&f| tube.face_positions(f).iter().all(|p| p.x > -1.0));
    let half = Mesh::from_faces(
        tube.vertices().map(|v| tube.position(v)),
        half.map(|f| tube.face_vertices(f).map(|v| v.index()).collect::<Vec<_>>())
            .collect::<Vec<_>>(),
    );
    let error = panelize(&half.expect("half"), &in_rings(700.0, 2), &Silent).expect_err("a half");
    assert!(matches!(error, PanelizeError::NoTurn { count: 0, .. }), "{error}");
    let both = PanelizeParams { crease: with_crease(1.0).crease, ..in_rings(900.0, 2) };
    let error = panelize(&tube, &both, &Silent).expect_err("two options");
    assert!(matches!(error, PanelizeError::Together { .. }), "{error}");
    for text in ["free", "rings:axis=x", "rings:axis=z"] {
        assert_eq!(text.parse::<LayoutChoice>().expect(text).to_string(), text);
    }
    assert!("rings:axis=w".parse::<LayoutChoice>().is_err());
}

/// A ball is its own image across its equator, so that both halves have the same panels.
#[test]
fn rings_of_a_ball_are_mirrored_across_its_equator() {
    let point = |k: u32| {
        let (sin, cos) = (std::f64::consts::PI * f64::from(k) / 60.0).sin_cos();
        (if k == 60 { 0.0 } else { 3000.0 * sin }, -3000.0 * cos)
    };
    let ball: Vec<(f64, f64)> = (0..=60).map(point).collect();
    for (mm, place) in [(900.0, DVec3::ZERO), (550.0, DVec3::new(700.0, -400.0, 9000.0))] {
        let mesh = turned(&ball, 96, place);
        let (made, report) = panelize(&mesh, &in_rings(mm, 2), &Silent).expect("rings");
        assert_good(&made, &report);
        let kinds = kinds_of(&made, 1e-6);
        assert!(report.rings > 4 && kinds <= report.rings / 2 + 4, "{kinds}: {report:?}");
        // Every vertex has its image at the same height on the other side.
        let heights = |sign: f64| {
            let height = |v| sign * (made.position(v).z - place.z);
            let mut all: Vec<f64> = made.vertices().map(height).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let off = heights(1.0).into_iter().zip(heights(-1.0)).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-6);
    }
}
