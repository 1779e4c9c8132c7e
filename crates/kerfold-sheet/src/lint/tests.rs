use glam::DVec2;

use super::*;
use crate::units::Length;

fn path(points: &[(f64, f64)], closed: bool, operation: Operation) -> ArtPath {
    let points = points.iter().copied().map(DVec2::from).collect();
    ArtPath { points, closed, operation, layer: operation.name().to_owned(), name: None }
}

fn checks(paths: Vec<ArtPath>) -> Vec<Check> {
    let artwork = Artwork { size: Some(DVec2::new(200.0, 100.0)), paths, ..Artwork::default() };
    lint(&artwork, &LintParams::default())
        .expect("little")
        .findings
        .iter()
        .map(|f| f.check)
        .collect()
}

const SQUARE: [(f64, f64); 4] = [(10.0, 10.0), (50.0, 10.0), (50.0, 50.0), (10.0, 50.0)];

#[test]
fn lines_that_meet_end_to_end_are_one_contour_in_any_order_and_direction() {
    let side = |i: usize, turned: bool| {
        let ends = [SQUARE[i], SQUARE[(i + 1) % 4]];
        let ends = if turned { [ends[1], ends[0]] } else { ends };
        path(&ends, false, Operation::Cut)
    };
    assert_eq!(checks(vec![side(2, true), side(0, false), side(3, true), side(1, true)]), []);
    assert_eq!(checks(vec![side(2, true), side(0, false), side(1, true)]), [Check::OpenContour]);
}

#[test]
fn slits_are_no_open_contours_and_scores_need_not_close() {
    let slit = path(&[(20.0, 10.0), (20.0, 30.0)], false, Operation::CutInner);
    let fold = path(&[(30.0, 10.0), (30.0, 50.0)], false, Operation::Score);
    let outline = path(&SQUARE, true, Operation::CutOuter);
    assert_eq!(checks(vec![fold, slit, outline]), []);
    let alone = path(&[(120.0, 10.0), (120.0, 30.0)], false, Operation::CutInner);
    assert_eq!(checks(vec![alone]), [Check::OpenContour]);
}

#[test]
fn crossings_touches_and_overlaps_are_told_apart() {
    let outline = || path(&SQUARE, true, Operation::CutOuter);
    let fold = |points: &[(f64, f64)]| path(points, false, Operation::Score);
    assert_eq!(checks(vec![fold(&[(30.0, 5.0), (30.0, 30.0)]), outline()]), [Check::Crossing]);
    assert_eq!(checks(vec![fold(&[(30.0, 10.0), (30.0, 30.0)]), outline()]), []);
    assert_eq!(checks(vec![fold(&[(20.0, 10.0), (30.0, 10.0)]), outline()]), [Check::Overlap]);
    assert_eq!(
        checks(vec![path(&[(5.0, 20.0), (20.0, 20.0)], false, Operation::Engrave), outline()]),
        [Check::Crossing]
    );
}

#[test]
fn a_contour_that_runs_back_on_itself_overlaps_itself() {
    let spike = [
        (10.0, 10.0),
        (50.0, 10.0),
        (50.0, 30.0),
        (80.0, 30.0),
        (50.0, 30.0),
        (50.0, 50.0),
        (10.0, 50.0),
    ];
    assert_eq!(checks(vec![path(&spike, true, Operation::CutOuter)]), [Check::Overlap]);
}

#[test]
fn necks_are_found_and_tips_are_not() {
    // Two notches that leave half a millimetre between them.
    let neck = [
        (10.0, 10.0),
        (100.0, 10.0),
        (100.0, 29.75),
        (60.0, 29.75),
        (60.0, 30.25),
        (100.0, 30.25),
        (100.0, 60.0),
        (10.0, 60.0),
    ];
    // Outside the notch there is air, not material.
    assert_eq!(checks(vec![path(&neck, true, Operation::CutOuter)]), []);
    let bar = [
        (10.0, 10.0),
        (50.0, 10.0),
        (50.0, 29.75),
        (60.0, 29.75),
        (60.0, 10.0),
        (100.0, 10.0),
        (100.0, 60.0),
        (60.0, 60.0),
        (60.0, 30.25),
        (50.0, 30.25),
        (50.0, 60.0),
        (10.0, 60.0),
    ];
    assert_eq!(checks(vec![path(&bar, true, Operation::CutOuter)]), [Check::ThinWeb]);
    let needle = [(10.0, 10.0), (190.0, 12.0), (190.0, 8.0)];
    assert_eq!(checks(vec![path(&needle, true, Operation::CutOuter)]), []);
}

#[test]
fn everything_scales_but_the_limits() {
    let at = |scale: f64, shift: f64| {
        let moved: Vec<_> =
            SQUARE.iter().map(|p| (p.0 * scale + shift, p.1 * scale + shift)).collect();
        let paths = vec![path(&moved, true, Operation::Cut), path(&moved, true, Operation::Cut)];
        let artwork = Artwork { paths, ..Artwork::default() };
        let params = LintParams { gap: Length::from_mm(0.005 * scale), ..LintParams::default() };
        lint(&artwork, &params)
            .expect("little")
            .findings
            .iter()
            .map(|f| f.check)
            .collect::<Vec<_>>()
    };
    assert_eq!(at(1.0, 0.0), [Check::Duplicate]);
    assert_eq!(at(100.0, 1e6), [Check::Duplicate]);
    assert_eq!(at(0.1, -1e3), [Check::Duplicate]);
}

/// A plate with two round notches that leave 0.3 mm between them.
fn waist() -> ArtPath {
    let arc = |centre: (f64, f64), from: f64| {
        (0..=90).map(move |k| {
            let angle = from + std::f64::consts::PI * f64::from(k) / 90.0;
            DVec2::from(centre) + DVec2::from_angle(angle) * 19.85
        })
    };
    let mut points = vec![DVec2::new(10.0, 10.0)];
    points.extend(arc((60.0, 10.0), 0.0).collect::<Vec<_>>().into_iter().rev());
    points.extend([DVec2::new(110.0, 10.0), DVec2::new(110.0, 50.0)]);
    points.extend(arc((60.0, 50.0), std::f64::consts::PI).collect::<Vec<_>>().into_iter().rev());
    points.push(DVec2::new(10.0, 50.0));
    let layer = "cut".to_owned();
    ArtPath { points, closed: true, operation: Operation::Cut, layer, name: None }
}

#[test]
fn necks_between_curves_are_found_and_curved_tips_are_not() {
    let artwork = Artwork { paths: vec![waist()], ..Artwork::default() };
    let report = lint(&artwork, &LintParams::default()).expect("little");
    let found = &report.findings[0];
    assert_eq!((report.findings.len(), found.check), (1, Check::ThinWeb));
    assert!(found.measured.is_some_and(|width| (width - 0.3).abs() < 1e-9), "{found:?}");
    assert!(found.at.is_some_and(|at| at.distance(DVec2::new(60.0, 30.0)) < 1e-9), "{found:?}");
    // A drop: two sides that meet in a round tip.
    let tip = (0..=40).map(|k| {
        let angle = std::f64::consts::FRAC_PI_2 + std::f64::consts::PI * f64::from(k) / 40.0;
        (20.0 + 0.3 * angle.cos(), 50.0 + 0.3 * angle.sin())
    });
    let drop: Vec<_> = tip.chain([(180.0, 40.0), (180.0, 60.0)]).collect();
    assert_eq!(checks(vec![path(&drop, true, Operation::Cut)]), []);
}

#[test]
fn living_hinges_are_known_and_single_dashes_are_not() {
    let outline =
        || path(&[(5.0, 5.0), (195.0, 5.0), (195.0, 95.0), (5.0, 95.0)], true, Operation::Cut);
    let dash = |x: f64, y: f64| path(&[(x, y), (x, y + 25.0)], false, Operation::Cut);
    let slot = |x: f64, y: f64| {
        let corners = [(x, y), (x + 0.4, y), (x + 0.4, y + 25.0), (x, y + 25.0)];
        path(&corners, true, Operation::Cut)
    };
    let rows = |one: &dyn Fn(f64, f64) -> ArtPath| {
        let row = |k: u32| {
            let start = 10.0 + 15.0 * f64::from(k % 2);
            [0.0, 30.0].map(|y| one(50.0 + 1.2 * f64::from(k), start + y))
        };
        (0..12).flat_map(row).chain([outline()]).collect::<Vec<_>>()
    };
    assert_eq!(checks(rows(&dash)), []);
    assert_eq!(checks(rows(&slot)), []);
    let few = vec![dash(50.0, 20.0), dash(51.2, 20.0), outline()];
    assert_eq!(checks(few), [Check::OpenContour; 2]);
    let close = vec![slot(50.0, 20.0), slot(51.2, 20.0), outline()];
    assert_eq!(checks(close), [Check::ThinWeb]);
}

#[test]
fn work_grows_with_the_strokes_and_not_faster() {
    for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_4] {
        let comparisons = |count: usize| {
            let along = DVec2::from_angle(angle);
            let stroke = |k: usize| {
                let from = along.perp() * (0.05 * k as f64);
                let points = vec![from, from + along * 400.0];
                let operation =
                    if k.is_multiple_of(2) { Operation::Engrave } else { Operation::Cut };
                ArtPath { points, closed: false, operation, layer: String::new(), name: None }
            };
            let paths = (0..count).map(stroke).collect();
            let mut work = Work::default();
            let artwork = Artwork { paths, ..Artwork::default() };
            judge(&artwork, &LintParams::default(), &mut work).expect("little");
            work.comparisons()
        };
        let [few, many] = [comparisons(1000), comparisons(8000)];
        assert!(many <= 9 * few && many < 40 * 8000, "{angle}: {few} {many}");
    }
}

#[test]
fn what_lies_on_too_much_is_refused_and_what_is_drawn_often_is_not() {
    let square =
        |k: usize| path(&SQUARE.map(|p| (p.0, p.1 + 1e-7 * k as f64)), true, Operation::Cut);
    let judged = |paths: Vec<ArtPath>| {
        lint(&Artwork { paths, ..Artwork::default() }, &LintParams::default())
    };
    let equal = judged(vec![square(0); 5000]).expect("each is drawn again");
    assert_eq!(equal.counts().into_iter().collect::<Vec<_>>(), [(Check::Duplicate, 4999)]);
    assert_eq!(equal.at_most(20).count(), 20);
    let near = judged((0..5000).map(square).collect());
    assert!(matches!(near, Err(LintError::TooDense { .. })));
}

#[test]
fn checks_can_be_skipped_by_name() {
    let params = LintParams {
        skip: vec!["Open-Contour".parse().expect("a check")],
        ..LintParams::default()
    };
    let open = path(&[(0.0, 0.0), (5.0, 5.0)], false, Operation::Cut);
    let report = lint(&Artwork { paths: vec![open], ..Artwork::default() }, &params);
    let report = report.expect("little");
    assert!(report.is_clean() && report.skipped == [Check::OpenContour]);
    let error = "thinweb".parse::<Check>().expect_err("no check").to_string();
    assert!(error.contains("did you mean `thin-web`?"), "{error}");
}

#[test]
fn colours_tell_what_is_done_as_laser_programs_and_boxes_py_have_them() {
    let black = [0; 3];
    let [red, blue, green] = [[255, 0, 0], [0, 0, 255], [0, 255, 0]];
    let operations = |drawn: &[(ArtPath, Rgb)]| {
        let mut art =
            Artwork { paths: drawn.iter().map(|d| d.0.clone()).collect(), ..Artwork::default() };
        let paths = drawn.iter().map(|d| Some(d.1)).collect();
        art.operations_by_colour(&Colours { paths, ..Colours::default() });
        (art.paths.iter().map(|p| p.operation).collect::<Vec<_>>(), art.notes.len())
    };
    let frame =
        || path(&[(0.0, 0.0), (90.0, 0.0), (90.0, 90.0), (0.0, 90.0)], true, Operation::Cut);
    let square = || path(&SQUARE, true, Operation::Cut);
    let stroke = || path(&[(60.0, 10.0), (70.0, 10.0)], false, Operation::Cut);
    use Operation::{Cut, CutInner, CutOuter, Engrave, Info, Score};
    let laser = [(frame(), red), (square(), black), (stroke(), blue), (stroke(), green)];
    assert_eq!(operations(&laser), (vec![Cut, Engrave, Score, Engrave], 0));
    let boxes = [(frame(), black), (square(), blue), (stroke(), red), (stroke(), green)];
    assert_eq!(operations(&boxes), (vec![CutOuter, CutInner, Info, Engrave], 1));
    // A red contour within black, whole or in pieces, is cut.
    assert_eq!(operations(&[(frame(), black), (square(), red)]).0, [Engrave, Cut]);
    let end = || path(&[(70.0, 10.0), (70.0, 20.0)], false, Operation::Cut);
    let pieces = [(frame(), black), (stroke(), red), (end(), red)];
    assert_eq!(operations(&pieces).0, [Engrave, Cut, Cut]);
    assert_eq!(operations(&[(frame(), black), (stroke(), black)]), (vec![Cut, Cut], 0));
}
