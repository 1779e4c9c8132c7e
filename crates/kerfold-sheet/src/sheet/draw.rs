//! Drawing a layout: cuts, folds, lettering and information of every sheet.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;

use super::drawing::{Drawing, MarkKind, Stroke};
use super::error::SheetError;
use super::features::{Features, features};
use super::joint::{FlapFold, Jointed, on_material};
use super::kerf::CutShape;
use super::layout::{Layout, Placed, Sheet, SheetReport};
use super::letter::{PieceLettering, sheet_letter};
use super::params::{PieceKind, SheetParams};
use super::score::{Hinges, ScorePlan, with_holding_tabs};
use super::stretch::Stretch;
use crate::net::{FoldKind, Net, Piece, PieceId};

/// Draws every sheet of a layout.
pub(crate) fn draw(
    net: &Net,
    shapes: &[CutShape],
    layout: &Layout,
    (params, stretches, jointed): (&SheetParams, &[Stretch], Option<&Jointed>),
) -> Result<(Vec<Drawing>, SheetReport), SheetError> {
    let features = features(net, stretches)?;
    let by_id: BTreeMap<PieceId, (&Piece, &CutShape)> =
        net.pieces.iter().zip(shapes).map(|(p, s)| (p.id, (p, s))).collect();
    let score = ScorePlan::of(&params.score)?;
    let tabs = holding_tabs(params)?;
    let work = Work { net, by_id, features, jointed, params, score, tabs };
    let drawn: Vec<_> = layout.sheets.par_iter().map(|sheet| work.sheet(sheet)).collect();
    let mut report = SheetReport::default();
    let mut drawings = Vec::new();
    for sheet in drawn {
        let (drawing, counted) = sheet?;
        report.unnamed_pieces.extend(counted.unnamed_pieces);
        report.unnumbered_sides += counted.unnumbered_sides;
        report.unmarked_angles += counted.unmarked_angles;
        report.flat_folds += counted.flat_folds;
        report.unscored_folds += counted.unscored_folds;
        drawings.push(drawing);
    }
    Ok((drawings, report))
}

/// What all sheets are drawn with.
struct Work<'a> {
    net: &'a Net,
    by_id: BTreeMap<PieceId, (&'a Piece, &'a CutShape)>,
    features: BTreeMap<PieceId, Features<'a>>,
    jointed: Option<&'a Jointed>,
    params: &'a SheetParams,
    score: ScorePlan,
    tabs: (usize, f64),
}

impl Work<'_> {
    /// One sheet, and what there was no room for.
    fn sheet(&self, sheet: &Sheet) -> Result<(Drawing, SheetReport), SheetError> {
        let Self { jointed, params, score, .. } = self;
        let cut_is_no_border = jointed.is_some() || params.pieces == PieceKind::Panels;
        let mut report = SheetReport::default();
        let mut drawing = Drawing::new(sheet);
        for placed in &sheet.placed {
            let (piece, shape) = self.by_id[&placed.piece];
            let here = &self.features[&placed.piece];
            draw_cuts(&mut drawing, shape, placed, self.tabs);
            // Channels for narrow notches take a little of the folds that end there.
            let is_widened = shape.widened_notches > 0;
            let as_cut = is_widened.then(|| as_cut(piece, shape));
            let cut = as_cut.as_ref().or(jointed.is_some().then_some(piece));
            let hinges = score.hinges(piece, &here.folds);
            draw_folds(&mut drawing, here, (placed, cut), (score, &hinges), &mut report);
            let flaps = jointed.iter().flat_map(|j| &j.flap_folds).filter(|f| f.piece == piece.id);
            draw_flap_folds(&mut drawing, flaps, (placed, as_cut.as_ref()), score);
            let mut obstacles: Vec<Vec<DVec2>> = if cut_is_no_border || is_widened {
                shape.contours().cloned().collect()
            } else {
                Vec::new()
            };
            obstacles.extend(hinges.rows.iter().flat_map(|r| &r.slits).map(|slit| slit.to_vec()));
            let letter = sheet_letter(DVec2::new(sheet.width, sheet.height));
            let on = (piece, here, placed);
            let lettering = PieceLettering::new(self.net, on, &obstacles, (params.letter, letter));
            lettering.draw(&mut drawing, &mut report)?;
        }
        drawing.arrange();
        Ok((drawing, report))
    }
}

/// A piece with the contours that are cut instead of its own.
fn as_cut(piece: &Piece, shape: &CutShape) -> Piece {
    Piece { outline: shape.outline.clone(), holes: shape.holes.clone(), ..piece.clone() }
}

/// Number and width in mm of the tabs that hold every part.
fn holding_tabs(params: &SheetParams) -> Result<(usize, f64), SheetError> {
    let width = params.stock.holding_tab_width.map_or(0.5, |w| w.mm());
    match params.stock.holding_tabs {
        0 if params.stock.holding_tab_width.is_some() => Err(SheetError::HoldOption),
        0..=100 if width >= 0.05 && width.is_finite() => {
            Ok((params.stock.holding_tabs as usize, width))
        }
        0..=100 => Err(SheetError::OutOfRange { name: "hold-width", value: width, least: 0.05 }),
        count => Err(SheetError::TooManyTabs { count }),
    }
}

fn draw_cuts(
    drawing: &mut Drawing,
    shape: &CutShape,
    placed: &Placed,
    (tabs, width): (usize, f64),
) {
    let id = shape.piece;
    let closed = |points: &[DVec2]| vec![Stroke { points: placed.apply_all(points), closed: true }];
    drawing.add(
        MarkKind::Outline,
        id.to_string(),
        Some(id),
        with_holding_tabs(&placed.apply_all(&shape.outline), tabs, width),
    );
    for (i, hole) in shape.holes.iter().enumerate() {
        drawing.add(MarkKind::Hole, format!("{id}-hole-{}", i + 1), Some(id), closed(hole));
    }
}

/// The folds of a piece; of one whose `cut` differs from its faces only what lies inside of the
/// cut.
fn draw_folds(
    drawing: &mut Drawing,
    here: &Features<'_>,
    (placed, cut): (&Placed, Option<&Piece>),
    (score, hinges): (&ScorePlan, &Hinges),
    report: &mut SheetReport,
) {
    for fold in &here.folds {
        let kind = match fold.kind {
            FoldKind::Mountain => MarkKind::MountainFold,
            FoldKind::Valley => MarkKind::ValleyFold,
            FoldKind::Flat => {
                report.flat_folds += 1;
                continue;
            }
        };
        if hinges.folds.contains(&fold.id) {
            continue;
        }
        let parts =
            cut.map_or_else(|| vec![fold.segment], |piece| on_material(piece, fold.segment));
        let parts = parts.into_iter().map(|part| part.map(|p| placed.apply(p)));
        let strokes: Vec<Stroke> =
            parts.flat_map(|[a, b]| score.strokes(a, b, kind == MarkKind::ValleyFold)).collect();
        if strokes.is_empty() {
            report.unscored_folds += 1;
            continue;
        }
        let kind = if score.is_cut() { MarkKind::Perforation } else { kind };
        drawing.add(kind, fold.id.to_string(), Some(placed.piece), strokes);
    }
    for row in &hinges.rows {
        let slit = |s: &[DVec2; 2]| Stroke { points: placed.apply_all(s), closed: false };
        let id = format!("{}-slits-{}", row.fold, row.number);
        drawing.add(MarkKind::Hinge, id, Some(placed.piece), row.slits.iter().map(slit).collect());
    }
}

fn draw_flap_folds<'a>(
    drawing: &mut Drawing,
    folds: impl Iterator<Item = &'a FlapFold>,
    (placed, cut): (&Placed, Option<&Piece>),
    score: &ScorePlan,
) {
    let kind = if score.is_cut() { MarkKind::Perforation } else { MarkKind::FlapFold };
    for fold in folds {
        let parts =
            cut.map_or_else(|| vec![fold.segment], |piece| on_material(piece, fold.segment));
        let parts = parts.into_iter().map(|part| part.map(|p| placed.apply(p)));
        let strokes: Vec<Stroke> = parts.flat_map(|[a, b]| score.strokes(a, b, false)).collect();
        if !strokes.is_empty() {
            drawing.add(kind, format!("{}-flap", fold.id), Some(placed.piece), strokes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::distance::edges;
    use super::super::drawing::LayerKind;
    use super::super::drawing::Mark;
    use super::super::lay_out;
    use super::super::testing::{random_convex, ring, strips, two_pieces};
    use super::super::{Labels, LetterParams, ScoreParams, ScoreStyle, StockParams};
    use super::super::{NestParams, Rotation};
    use super::*;
    use crate::geom::polygon::segments_meet;
    use crate::units::Length;

    fn drawn(net: &Net, params: &SheetParams) -> (Drawing, SheetReport) {
        let set = lay_out(net, params).expect("the net fits");
        (set.drawings.into_iter().next().expect("one sheet"), set.report)
    }

    fn ids(drawing: &Drawing, kind: LayerKind) -> Vec<&str> {
        drawing.marks().filter(|m| m.kind.layer() == kind).map(|m| m.id.as_str()).collect()
    }

    fn lines(drawing: &Drawing) -> Vec<(LayerKind, DVec2, DVec2)> {
        let strokes = drawing.marks().flat_map(|m| m.strokes.iter().map(|s| (m.kind.layer(), s)));
        strokes
            .flat_map(|(layer, s)| {
                let count = s.points.len() - usize::from(!s.closed);
                edges(&s.points).take(count).map(move |(a, b)| (layer, a, b)).collect::<Vec<_>>()
            })
            .collect()
    }

    #[test]
    fn layers_come_in_working_order_with_all_lines_once() {
        let (drawing, report) = drawn(&two_pieces(), &SheetParams::default());
        assert_eq!(drawing.layers.iter().map(|l| l.kind).collect::<Vec<_>>(), LayerKind::ALL);
        assert_eq!(ids(&drawing, LayerKind::CutOuter), ["P01", "P02"]);
        assert_eq!(ids(&drawing, LayerKind::Score), ["E004"]);
        let mut engraved = ids(&drawing, LayerKind::Engrave);
        engraved.sort_unstable();
        assert_eq!(engraved, ["E016-number-1", "E016-number-2", "P01-name", "P02-name"]);
        let info = ids(&drawing, LayerKind::Info);
        let legend = ["legend-1", "legend-2", "legend-3", "legend-colours-4", "legend-colours-5"];
        assert_eq!(info[..3], ["offcut", "offcut-label", "reference"]);
        assert_eq!(info[3..], legend);
        assert_eq!(report, SheetReport::default());
        let mut seen: Vec<[DVec2; 2]> = Vec::new();
        for (_, a, b) in lines(&drawing) {
            assert!(!seen.contains(&[a, b]) && !seen.contains(&[b, a]), "{a} {b} twice");
            seen.push([a, b]);
        }
    }

    #[test]
    fn lettering_crosses_no_cut_and_no_fold_and_the_square_no_piece() {
        let mut net = two_pieces();
        net.pieces.push(ring(PieceId(2)));
        net.pieces.extend(
            (3..20).map(|i| super::super::testing::piece(PieceId(i), random_convex(i as u64))),
        );
        let params = SheetParams {
            stock: StockParams { kerf: Length::from_mm(0.2), ..StockParams::default() },
            ..SheetParams::default()
        };
        let (drawing, _) = drawn(&net, &params);
        let lines = lines(&drawing);
        let solid = |l: LayerKind| {
            matches!(l, LayerKind::Score | LayerKind::CutInner | LayerKind::CutOuter)
        };
        for (_, a, b) in lines.iter().filter(|(l, ..)| !solid(*l)) {
            for (_, c, d) in lines.iter().filter(|(l, ..)| solid(*l)) {
                assert!(!segments_meet(*a, *b, *c, *d), "{a} {b} meets {c} {d}");
            }
        }
    }

    #[test]
    fn labels_are_left_out_on_request_and_counted_when_too_small() {
        for (labels, expected) in
            [(Labels::None, vec![]), (Labels::Pieces, vec!["P01-name", "P02-name"])]
        {
            let (drawing, _) = drawn(
                &two_pieces(),
                &SheetParams {
                    letter: LetterParams { labels, ..LetterParams::default() },
                    ..SheetParams::default()
                },
            );
            assert_eq!(ids(&drawing, LayerKind::Engrave), expected);
        }
        // Too small even for a number of one digit.
        let shrink = 0.05;
        let mut small = two_pieces();
        for piece in &mut small.pieces {
            let faces = piece.faces.iter_mut().flat_map(|f| &mut f.polygon);
            faces.chain(&mut piece.outline).for_each(|p| *p *= shrink);
        }
        small.folds[0].segment = small.folds[0].segment.map(|p| p * shrink);
        small.seams[0].sides.iter_mut().for_each(|s| s.segment = s.segment.map(|p| p * shrink));
        let (drawing, report) = drawn(&small, &SheetParams::default());
        assert_eq!(ids(&drawing, LayerKind::Engrave), [""; 0]);
        assert_eq!((report.unnamed_pieces.len(), report.unnumbered_sides), (2, 2));
    }

    #[test]
    fn dashed_perforated_and_held_sheets_have_their_lines_on_the_right_layers() {
        let with = |score| {
            drawn(
                &two_pieces(),
                &SheetParams {
                    score: ScoreParams { style: score, ..ScoreParams::default() },
                    ..SheetParams::default()
                },
            )
            .0
        };
        assert!((with(ScoreStyle::Dashed).score_length() - 16.0).abs() < 1e-9);
        let perforated = with(ScoreStyle::Perforated);
        assert_eq!(
            (ids(&perforated, LayerKind::Score).len(), ids(&perforated, LayerKind::CutInner)),
            (0, vec!["E004"])
        );
        let held = SheetParams {
            stock: StockParams { holding_tabs: 3, ..StockParams::default() },
            ..SheetParams::default()
        };
        let (whole, _) = drawn(&two_pieces(), &SheetParams::default());
        let (drawing, _) = drawn(&two_pieces(), &held);
        assert!((whole.cut_length() - drawing.cut_length() - 3.0).abs() < 1e-9);
        let error = lay_out(
            &two_pieces(),
            &SheetParams {
                stock: StockParams {
                    holding_tab_width: Some(Length::from_mm(1.0)),
                    ..StockParams::default()
                },
                ..Default::default()
            },
        );
        assert_eq!(error, Err(SheetError::HoldOption));
    }

    #[test]
    fn a_chain_of_narrow_faces_becomes_one_hinge_field() {
        let net = strips(8, 5.0, 80.0);
        let nest = NestParams { rotations: Rotation::Fixed, ..NestParams::default() };
        let params = SheetParams {
            score: ScoreParams { hinge: Some(Length::from_mm(6.0)), ..ScoreParams::default() },
            nest,
            ..SheetParams::default()
        };
        let (drawing, _) = drawn(&net, &params);
        // Six narrow faces between two wide ones: seven folds, none scored, and a row between every
        // two.
        assert_eq!(ids(&drawing, LayerKind::Score), [""; 0]);
        let rows: Vec<&Mark> = drawing.marks().filter(|m| m.kind == MarkKind::Hinge).collect();
        assert_eq!(rows.len(), 7 + 6);
        // No two neighbouring rows have a bridge in the same place: nothing is left unslit across
        // three rows.
        let mut lines: Vec<(f64, Vec<[f64; 2]>)> = rows
            .iter()
            .map(|m| {
                (
                    m.strokes[0].points[0].x,
                    m.strokes.iter().map(|s| sorted([s.points[0].y, s.points[1].y])).collect(),
                )
            })
            .collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in lines.windows(2) {
            assert!((pair[1].0 - pair[0].0 - 2.5).abs() < 1e-9);
            assert_ne!(pair[0].1.len(), pair[1].1.len());
        }
    }

    fn sorted([a, b]: [f64; 2]) -> [f64; 2] {
        [a.min(b), a.max(b)]
    }

    #[test]
    fn flat_folds_are_not_scored_and_valleys_are_told_apart() {
        let mut net = two_pieces();
        net.folds[0].kind = FoldKind::Valley;
        let (drawing, _) = drawn(&net, &SheetParams::default());
        assert!(drawing.marks().any(|m| m.kind == MarkKind::ValleyFold));
        net.folds[0].kind = FoldKind::Flat;
        let (drawing, report) = drawn(&net, &SheetParams::default());
        assert_eq!((ids(&drawing, LayerKind::Score).len(), report.flat_folds), (0, 1));
    }

    #[test]
    fn a_seam_on_a_missing_piece_is_an_error() {
        let mut net = two_pieces();
        net.pieces.pop();
        let error = lay_out(&net, &SheetParams::default()).expect_err("P02 is missing");
        assert_eq!(
            error.to_string(),
            "edge E016 lies on piece P02, which the net does not hold; read the pieces file again"
        );
    }
}
