use glam::DVec2;

use super::*;
use crate::units::Length;

fn path(points: &[(f64, f64)], closed: bool, operation: Operation) -> ArtPath {
    let points = points.iter().copied().map(DVec2::from).collect();
    ArtPath { points, closed, operation, layer: operation.name().to_owned(), name: None }
}

fn checks(paths: Vec<ArtPath>) -> Vec<Check> {
    let artwork = Artwork { size: Some(DVec2::new(200.0, 100.0)), paths, ..Artwork::default() };
    lint(&artwork, &LintParams::default()).expect("little").findings.iter().map(|f| f.check).collect()
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
        lint(&artwork, &params).expect("little").findings.iter().map(|f| f.check).collect::<Vec<_>>()
    };
    assert_eq!(at(1.0, 0.0), [Check::Duplicate]);
    assert_eq!(at(100.0, 1e6), [Check::Duplicate]);
    assert_eq!(at(0.1, -1e3), [Check::Duplicate]);
}
