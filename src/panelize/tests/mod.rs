mod rings;
mod stays;

use glam::DVec3;

use super::*;
use crate::mesh::{VertexId, assert_sound};
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
    assert_clean(made, report);
    assert!((report.panels as f64 / report.wanted - 1.0).abs() < 0.1, "{report:?}");
}

/// The same for so few panels that their number says little.
fn assert_clean(made: &Mesh, report: &PanelizeReport) {
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
    let mesh = roof(4000.0, 3000.0, 250.0, |x, y| -(x * x + y * y) / 700.0);
    let (_, report) = panelize(&mesh, &sized(1200.0), &Silent).expect("panels");
    assert!(!report.is_clean());
    let told = report.notes().concat();
    assert!(told.contains("(F604)") && told.contains("smaller size"), "{told}");
    let sheet = PanelizeParams { max_panel: Some(SheetSize([500.0, 600.0])), ..sized(800.0) };
    let (_, report) = panelize(&mesh, &sheet, &Silent).expect("panels");
    assert!(report.notes().concat().contains("(F607)"), "{:?}", report.notes());
    let narrow = roof(4000.0, 200.0, 100.0, |_, _| 0.0);
    let error = panelize(&narrow, &sized(1500.0), &Silent).expect_err("one row");
    assert!(error.to_string().contains("--size"), "{error}");
    let PanelizeError::TooNarrow { fits: Some(fits), .. } = error else { panic!("{error}") };
    assert!(fits < 1500.0);
    panelize(&narrow, &sized(fits), &Silent).expect("panels of the size that was told");
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
    for text in ["walls.csv", "a/planes.CSV"] {
        assert_eq!(text.parse::<RimChoice>().expect(text).to_string(), text);
    }
    for text in ["", "wall", "plane:", "plane:w=0", "plane:z=a"] {
        assert!(text.parse::<RimChoice>().is_err(), "{text}");
    }
}

fn with_crease(mm: f64) -> PanelizeParams {
    PanelizeParams { crease: Some(crate::units::Angle::from_degrees(40.0)), ..sized(mm) }
}

#[test]
fn a_straight_crease_between_flat_sides_is_kept_to_the_last_digit() {
    let mesh = roof(4000.0, 3000.0, 250.0, |x, _| -0.7 * x.abs());
    let (made, report) = panelize(&mesh, &with_crease(1000.0), &Silent).expect("panels");
    assert_sound(&made);
    assert!(report.is_clean(), "{:?}", report.notes());
    assert_eq!(report.creases.edges, 12);
    assert!((report.creases.largest_fold - 2.0 * 0.7_f64.atan().to_degrees()).abs() < 1e-9);
    assert!(report.creases.is_kept && report.creases.off_mm < 1e-9, "{:?}", report.creases);
    let on_ridge = made.vertices().filter(|&v| made.position(v).x.abs() < 1e-9).count();
    assert!(on_ridge >= 5, "corners from both sides, and two at the rim: {on_ridge}");
    for f in made.faces() {
        let corners = made.face_positions(f);
        let goes = |sign: f64| corners.iter().any(|p| p.x * sign > 1e-9);
        assert!(goes(1.0) != goes(-1.0), "panel {f} lies on both sides of the ridge");
        assert!(corners.iter().all(|p| (p.z + 0.7 * p.x.abs()).abs() < 0.1), "{corners:?}");
    }
    for v in made.vertices().filter(|&v| !made.is_rim_vertex(v)) {
        assert_eq!(made.valence(v), 3, "vertex {v}");
    }
}

#[test]
fn a_crease_of_bent_sides_is_followed_and_without_the_option_said_to_be_rounded() {
    let mesh =
        roof(4000.0, 3000.0, 250.0, |x, y| -x.abs() * (0.6 + y / 30_000.0) - y * y / 20_000.0);
    let (made, report) = panelize(&mesh, &with_crease(900.0), &Silent).expect("panels");
    assert_good(&made, &report);
    assert!(report.creases.is_kept && report.creases.off_mm < 45.0, "{:?}", report.creases);
    let (_, rounded) = panelize(&mesh, &sized(900.0), &Silent).expect("panels");
    assert!(!rounded.creases.is_kept && rounded.creases.edges == 12);
    assert!(rounded.creases.off_mm > 2.0 * report.creases.off_mm, "{:?}", rounded.creases);
    let told = rounded.notes().concat();
    assert!(told.contains("creases rounded: 12 edges") && told.contains("--crease"), "{told}");
}

#[test]
fn a_cube_keeps_its_corners_and_the_top_of_a_pyramid_has_a_member_too_many() {
    let at = |i: usize| [1, 2, 4].map(|bit| if i & bit == 0 { -750.0 } else { 750.0 });
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
    let cube = Mesh::from_faces((0..8).map(|i| DVec3::from_array(at(i))), faces).expect("a cube");
    let (made, report) = panelize(&cube, &with_crease(700.0), &Silent).expect("panels");
    assert_sound(&made);
    assert!(made.is_closed() && report.creases.off_mm < 1e-9, "{:?}", report.notes());
    let is_corner = |p: DVec3| (p.abs() - DVec3::splat(750.0)).length() < 1e-9;
    assert_eq!(made.vertices().filter(|&v| is_corner(made.position(v))).count(), 8);
    assert!(made.vertices().all(|v| made.valence(v) == 3));
    let points =
        [(-1.5, -1.5, 0.0), (1.5, -1.5, 0.0), (1.5, 1.5, 0.0), (-1.5, 1.5, 0.0), (0.0, 0.0, 1.3)];
    let points = points.map(|(x, y, z)| 1000.0 * DVec3::new(x, y, z));
    let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let pyramid = Mesh::from_faces(points, faces).expect("a pyramid");
    let (_, report) = panelize(&pyramid, &with_crease(800.0), &Silent).expect("panels");
    let full = report.findings.iter().filter(|p| p.finding == PanelizeFinding::FullNode);
    assert_eq!(full.map(|p| p.measured).collect::<Vec<_>>(), [4.0], "{:?}", report.notes());
    let error = panelize(
        &pyramid,
        &PanelizeParams { crease: Some(crate::units::Angle::from_degrees(1.0)), ..sized(800.0) },
        &Silent,
    );
    assert!(matches!(error, Err(PanelizeError::OutOfRange { .. })));
}

#[test]
fn rows_follow_what_is_written() {
    for text in ["flat", "rim", "none", "a/rows.obj"] {
        assert_eq!(text.parse::<Align>().expect(text).to_string(), text);
    }
    assert!("rows.txt".parse::<Align>().is_err() && "".parse::<Align>().is_err());
}

fn mirrored(mm: f64, axes: &str) -> PanelizeParams {
    PanelizeParams { symmetry: axes.parse().expect("axes"), ..sized(mm) }
}

/// Pairs of panels that are images of each other across x = `at`, and panels across it, by corners
/// that are rounded to a thousandth of a millimetre.
fn pairs_across(made: &Mesh, axis: usize, at: f64) -> [usize; 2] {
    let key = |f: FaceId, sign: f64| {
        let place = |p: &DVec3| {
            let mut p = *p;
            p[axis] = sign * (p[axis] - at);
            (p * 1000.0).round().to_array().map(|x| x as i64)
        };
        let mut corners: Vec<[i64; 3]> = made.face_positions(f).iter().map(place).collect();
        corners.sort_unstable();
        corners
    };
    let own: Vec<_> = made.faces().map(|f| key(f, 1.0)).collect();
    let image: Vec<_> = made.faces().map(|f| key(f, -1.0)).collect();
    let across = own.iter().zip(&image).filter(|(a, b)| a == b).count();
    let with_image = own.iter().filter(|face| image.contains(face)).count();
    [(with_image - across) / 2, across]
}

#[test]
fn mirror_symmetric_surfaces_give_mirrored_pairs() {
    type Height = fn(f64, f64) -> f64;
    let roofs: [(Height, &str); 4] = [
        (|x, y| -x * x / 12_000.0 - y * y / 17_000.0, "x"),
        (|x, y| (x * x - y * y) / 14_000.0, "x,y"),
        (|x, _| -x * x / 12_000.0, "y"),
        (|x, y| 300.0 * (y / 900.0).sin() * (1.0 + x * x / 9e6), "x"),
    ];
    for (k, (height, axes)) in roofs.into_iter().enumerate() {
        let mesh = roof(6000.0, 5000.0, 240.0, height);
        let (made, report) = panelize(&mesh, &mirrored(800.0, axes), &Silent).expect("panels");
        assert_clean(&made, &report);
        for mirror in &report.mirrors {
            let found = pairs_across(&made, mirror.axis, mirror.at_mm);
            assert_eq!([mirror.pairs, mirror.across], found, "roof {k}");
            let all = 2 * mirror.pairs + mirror.across;
            assert!(mirror.alone == 0 && all == report.panels, "roof {k}: {mirror:?}");
        }
        assert_eq!(report.mirrors.len(), axes.split(',').count());
        let free = panelize(&mesh, &sized(800.0), &Silent).expect("panels").0;
        assert!(pairs_across(&free, report.mirrors[0].axis, 0.0)[0] < report.panels / 4);
    }
}

#[test]
fn what_is_no_image_of_itself_is_refused() {
    let lean = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0 + x / 20.0);
    match panelize(&lean, &mirrored(900.0, "x"), &Silent).expect_err("it leans") {
        PanelizeError::NotMirrored { axis: "x", off, at, .. } => {
            assert!((100.0..260.0).contains(&off) && at.abs() < 1e-9, "{off}");
        }
        error => panic!("{error}"),
    }
    assert!(panelize(&lean, &mirrored(900.0, "y"), &Silent).is_ok());
    let both = PanelizeParams { fix: FixChoice::Groups, ..mirrored(900.0, "y") };
    let error = panelize(&lean, &both, &Silent).expect_err("two options");
    assert!(matches!(error, PanelizeError::Together { .. }), "{error}");
}

#[test]
fn edges_are_drawn_to_few_lengths_and_how_far_is_told() {
    let mesh = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    let params = PanelizeParams { families: Some(12), ..sized(900.0) };
    let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
    assert_sound(&made);
    assert!(report.planarity_mm < 1e-13 * report.size_mm, "{report:?}");
    let found = report.families.as_ref().expect("families");
    // The edges that are alike are counted here anew: within a thousandth of some length.
    let mut lengths: Vec<f64> =
        made.edges().map(|e| made.edge_positions(e)).map(|[a, b]| a.distance(b)).collect();
    lengths.sort_by(f64::total_cmp);
    assert_eq!(found.edges, lengths.len());
    let (free, _) = panelize(&mesh, &sized(900.0), &Silent).expect("panels");
    let spread = |made: &Mesh| {
        let mut all: Vec<f64> =
            made.edges().map(|e| made.edge_positions(e)).map(|[a, b]| a.distance(b)).collect();
        all.sort_by(f64::total_cmp);
        all.windows(2).filter(|pair| pair[1] - pair[0] < 0.05).count()
    };
    assert!(spread(&made) > 2 * spread(&free), "{} {}", spread(&made), spread(&free));
    assert!(found.off_mm[1] < found.off_mm[0], "{found:?}");
    assert!(found.lengths[1] < found.lengths[0], "{found:?}");
    let is_missed = report.findings.iter().any(|f| f.finding == PanelizeFinding::ManyLengths);
    assert_eq!(is_missed, found.lengths[1] > 12, "{found:?}");
}

#[test]
fn folds_and_hollows_beyond_their_limits_are_named() {
    let mesh = roof(5000.0, 4000.0, 250.0, |x, y| (x * x - y * y) / 14_000.0);
    let (_, report) = panelize(&mesh, &sized(1000.0), &Silent).expect("panels");
    assert!((200.0..600.0).contains(&report.hollow_mm), "{report:?}");
    assert!((2.0..20.0).contains(&report.largest_fold), "{report:?}");
    assert_eq!(report.worst[0].1, report.deviation_mm[0]);
    let params = PanelizeParams {
        max_hollow: Some(Length::from_mm(report.hollow_mm * 0.99)),
        max_fold: Some(crate::units::Angle::from_degrees(report.largest_fold * 0.99)),
        ..sized(1000.0)
    };
    let (_, strict) = panelize(&mesh, &params, &Silent).expect("panels");
    let named = |kind| strict.findings.iter().find(|p| p.finding == kind).map(|p| p.measured);
    assert_eq!(named(PanelizeFinding::DeepHollow), Some(report.hollow_mm));
    assert_eq!(named(PanelizeFinding::SharpFold), Some(report.largest_fold));
    let dome = roof(5000.0, 4000.0, 250.0, |x, y| -(x * x + y * y) / 12_000.0);
    let (_, report) = panelize(&dome, &sized(1000.0), &Silent).expect("panels");
    assert!(report.hollow_mm < 1e-9, "a dome has convex panels: {report:?}");
}
