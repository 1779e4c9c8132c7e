//! Planes, groups and points that stay.

use super::*;

/// Planes of n·x = d, on lines counted from 1.
fn fixed(planes: &[(DVec3, f64)]) -> FixChoice {
    let plane =
        |(i, &(normal, offset)): (usize, &(DVec3, f64))| FixedPlane { normal, offset, line: i + 1 };
    FixChoice::Planes(planes.iter().enumerate().map(plane).collect())
}

fn off_plane(made: &Mesh, f: usize, (normal, offset): (DVec3, f64)) -> f64 {
    let corners = made.face_positions(FaceId::new(f));
    let off = |p: &DVec3| (p.dot(normal) - offset).abs() / normal.length();
    corners.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn given_planes_are_kept_to_the_last_digit() {
    let mesh = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    // The top plane 20 mm lower than the dome, and one that leans at (1500, 900).
    let [x, y] = [1500.0, 900.0];
    let lean = DVec3::new(x / 6000.0, y / 6000.0, 1.0);
    let planes =
        [(DVec3::Z * 3.0, -60.0), (lean, lean.dot(DVec3::new(x, y, -(x * x + y * y) / 12_000.0)))];
    let params = PanelizeParams { fix: fixed(&planes), ..sized(900.0) };
    let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
    assert_good(&made, &report);
    assert_eq!(report.fixed.len(), 2);
    for (panel, plane) in report.fixed.iter().zip(planes) {
        let off = off_plane(&made, panel.panel, plane);
        assert!(off < 1e-10 && panel.off_mm < 1e-10, "{panel:?}: {off}");
        let carried = made.carried_plane(FaceId::new(panel.panel)).expect("a plane");
        assert!((carried.normal().dot(plane.0) / plane.0.length() - 1.0).abs() < 1e-15);
    }
    let (free, free_report) = panelize(&mesh, &sized(900.0), &Silent).expect("panels");
    let tops = free.faces().map(|f| off_plane(&free, f.index(), planes[0]));
    assert!(tops.fold(f64::INFINITY, f64::min) > 1e-3, "the plane would be there anyway");
    assert!(free_report.fixed.is_empty());
    assert!(report.notes().concat().contains("line 1"), "{:?}", report.notes());
}

#[test]
fn planes_that_fit_nowhere_or_do_not_meet_are_told_with_their_lines() {
    let mesh = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    let refused = |planes: &[(DVec3, f64)]| {
        let params = PanelizeParams { fix: fixed(planes), ..sized(900.0) };
        panelize(&mesh, &params, &Silent).expect_err("refused")
    };
    let top = (DVec3::Z, 0.0);
    match refused(&[top, (DVec3::Z, 500.0)]) {
        PanelizeError::NoPlaneThere { line, distance_mm, .. } => {
            assert!(line == 2 && (490.0..560.0).contains(&distance_mm), "{distance_mm}");
        }
        error => panic!("{error}"),
    }
    let error = refused(&[top, (DVec3::Z, -10.0)]);
    assert!(matches!(error, PanelizeError::PlanesTooNear { lines: [1, 2], .. }), "{error}");
    // Tangent at the top and, turned a little the wrong way, a panel farther: both in reach of the
    // surface, but they meet nowhere near.
    let [x, z] = [800.0, -800.0 * 800.0 / 12_000.0];
    let wrong = DVec3::new(-0.01, 0.0, 1.0);
    let error = refused(&[top, (wrong, wrong.dot(DVec3::new(x, 0.0, z)))]);
    let is_told = matches!(error, PanelizeError::PlanesDoNotMeet { .. });
    assert!(is_told && error.to_string().contains("line 1 and line 2"), "{error}");
    let params = PanelizeParams { fix: "planes.csv".parse().expect("a file"), ..sized(900.0) };
    let error = panelize(&mesh, &params, &Silent).expect_err("unread");
    assert!(matches!(error, PanelizeError::PlanesUnread { .. }), "{error}");
}

/// A roof with a flat square in the middle of it, in a group of its own.
fn with_a_flat_group() -> Mesh {
    let height = |x: f64, y: f64| {
        let off = (x.abs().max(y.abs()) - 750.0).max(0.0);
        -off * off / 6000.0
    };
    let mut mesh = roof(5000.0, 4000.0, 250.0, height);
    let flat: Vec<FaceId> = mesh
        .faces()
        .filter(|&f| mesh.face_positions(f).iter().all(|p| p.x.abs().max(p.y.abs()) < 751.0))
        .collect();
    for f in flat {
        mesh.set_group(f, "skylight");
    }
    mesh
}

#[test]
fn a_flat_group_of_faces_stays_one_panel() {
    let mesh = with_a_flat_group();
    for fix in ["groups", "group:skylight"] {
        let params = PanelizeParams { fix: fix.parse().expect("a group"), ..sized(700.0) };
        let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
        assert_sound(&made);
        let [panel] = &report.fixed[..] else { panic!("{report:?}") };
        assert!(off_plane(&made, panel.panel, (DVec3::Z, 0.0)) < 1e-10);
        let area = crate::measure::face_area(&made, FaceId::new(panel.panel));
        assert!((1.6e6..3.6e6).contains(&area), "of 1.5 by 1.5 m: {area}");
        assert!(report.is_clean(), "{:?}", report.notes());
    }
    let refused = |fix: &str, mesh: &Mesh| {
        let params = PanelizeParams { fix: fix.parse().expect("a group"), ..sized(700.0) };
        panelize(mesh, &params, &Silent).expect_err("refused").to_string()
    };
    assert!(refused("group:door", &mesh).contains("`skylight`"));
    let mut bent = mesh.clone();
    let faces: Vec<FaceId> = bent.faces().collect();
    faces.into_iter().for_each(|f| bent.set_group(f, "all"));
    assert!(refused("group:all", &bent).contains("not flat"));
    let none = roof(5000.0, 4000.0, 250.0, |x, _| -x * x / 12_000.0);
    assert!(refused("groups", &none).contains("no groups"));
    // Of all groups those that are not flat are only named.
    let params = PanelizeParams { fix: FixChoice::Groups, ..sized(700.0) };
    let (_, report) = panelize(&bent, &params, &Silent).expect("panels");
    assert!(report.fixed.is_empty() && report.not_fixed.len() == 1, "{report:?}");
}

#[test]
fn points_that_stay_have_a_vertex_each_to_the_last_digit() {
    let height = |x: f64, y: f64| -(x * x + y * y) / 12_000.0;
    // One off the middle of the roof, two near each other, one on the rim and one at its corner.
    let flat = [[700.0, -400.0], [-1500.0, 800.0], [-1100.0, 1050.0], [900.0, 2000.0], [2500.0; 2]];
    let points = flat.map(|[x, y]| DVec3::new(x, y.min(2000.0), height(x, y.min(2000.0))));
    let free = panelize(&roof(5000.0, 4000.0, 250.0, height), &sized(900.0), &Silent);
    let free = free.expect("panels").0;
    let near = |mesh: &Mesh, p: DVec3| {
        mesh.vertices().map(|v| mesh.position(v).distance(p)).fold(f64::INFINITY, f64::min)
    };
    assert!(near(&free, points[0]) > 1.0, "a vertex would be there anyway");
    for far in [DVec3::ZERO, DVec3::new(3.0e4, -7.0e4, 1.0e4)] {
        let mut mesh = roof(5000.0, 4000.0, 250.0, height);
        for v in mesh.vertices().collect::<Vec<_>>() {
            mesh.set_position(v, mesh.position(v) + far, true);
        }
        let points = points.map(|p| p + far);
        let params = PanelizeParams { stay: StayChoice::Points(points.to_vec()), ..sized(900.0) };
        let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
        assert_good(&made, &report);
        assert_eq!(report.stayed.len(), points.len());
        for (stayed, p) in report.stayed.iter().zip(points) {
            assert_eq!(made.position(VertexId::new(stayed.vertex)), p, "{stayed:?}");
            assert!(stayed.off_mm == 0.0, "{stayed:?}");
        }
        assert!(report.notes().concat().contains("5 vertices stand"), "{:?}", report.notes());
    }
}

#[test]
fn points_that_cannot_stay_are_told_with_their_number() {
    let mesh = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    let refused = |points: &[[f64; 3]], more: PanelizeParams| {
        let points = points.iter().copied().map(DVec3::from).collect();
        let params = PanelizeParams { stay: StayChoice::Points(points), ..more };
        panelize(&mesh, &params, &Silent).expect_err("refused").to_string()
    };
    let off = refused(&[[0.0; 3], [10.0, 10.0, 500.0]], sized(900.0));
    assert!(off.contains("point 2") && off.contains("180.0 mm are allowed"), "{off}");
    let off = refused(&[[0.0; 3], [f64::NAN; 3]], sized(900.0));
    assert!(off.contains("point 2"), "{off}");
    let near = refused(&[[0.0; 3], [900.0, 0.0, -67.5], [100.0, 0.0, 0.0]], sized(900.0));
    assert!(near.contains("points 1 and 3") && near.contains("100.0 mm apart"), "{near}");
    let at = |k: u32| [f64::from(k % 5) * 280.0, f64::from(k / 5) * 280.0];
    let crowd: Vec<[f64; 3]> = (0..20).map(|k| [at(k)[0], at(k)[1], -20.0]).collect();
    let crowd = refused(&crowd, sized(900.0));
    assert!(crowd.contains("no corner of panels of 900.0 mm"), "{crowd}");
    let together = refused(&[[0.0; 3]], mirrored(900.0, "x"));
    assert!(together.contains("--stay"), "{together}");
    let params = PanelizeParams { stay: "heads.csv".parse().expect("a file"), ..sized(900.0) };
    let error = panelize(&mesh, &params, &Silent).expect_err("unread");
    assert!(matches!(error, PanelizeError::PointsUnread { .. }), "{error}");
}

#[test]
fn rims_stay_in_slanted_planes_of_a_file() {
    // Upright walls along x are sheared into slanted ones.
    let mut mesh = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    for v in mesh.vertices().collect::<Vec<_>>() {
        let p = mesh.position(v);
        mesh.set_position(v, p + DVec3::X * (0.2 * p.z), true);
    }
    let slanted = DVec3::new(1.0, 0.0, -0.2);
    let planes = [
        (slanted * 3.0, 7500.0),
        (slanted, -2500.0),
        (DVec3::Y, 2000.0),
        (DVec3::NEG_Y * 2.0, 4000.0),
    ];
    let FixChoice::Planes(given) = fixed(&planes) else { panic!("planes") };
    let params = PanelizeParams { rim: RimChoice::Given(given), ..sized(900.0) };
    let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
    assert_good(&made, &report);
    for v in made.vertices().filter(|&v| made.is_rim_vertex(v)) {
        let p = made.position(v);
        let off = planes.map(|(normal, d)| (p.dot(normal) - d).abs() / normal.length());
        assert!(off.into_iter().fold(f64::INFINITY, f64::min) < 1e-9, "{p}");
    }
    let params = PanelizeParams { rim: "walls.csv".parse().expect("a file"), ..sized(900.0) };
    let error = panelize(&mesh, &params, &Silent).expect_err("unread");
    assert!(matches!(error, PanelizeError::PlanesUnread { .. }), "{error}");
}
