//! Drawing a layout: cuts, folds, lettering and information of every sheet.

use std::collections::BTreeMap;

use glam::DVec2;

use super::drawing::{Drawing, MarkKind, Stroke};
use super::error::SheetError;
use super::joint::{FlapFold, Jointed, on_material};
use super::kerf::CutShape;
use super::layout::{Layout, Placed, SheetReport};
use super::letter::Stretch;
use super::letter::lettering;
use super::letter::{Label, Taken, is_clear, name_label, number_across, number_label};
use super::params::{Angles, Labels, SheetParams, Stock};
use super::score::{Hinges, ScorePlan, hold};
use crate::geom::polygon::{Location, bounds, locate};
use crate::net::{FlatFace, Fold, FoldKind, Net, Piece, PieceId, Seam};

/// Sides of the reference square that are tried, in mm.
const REFERENCE_SIDES: [f64; 3] = [100.0, 10.0, 1.0];

/// What lies on a piece besides its outline.
#[derive(Default)]
struct Features<'a> {
    folds: Vec<&'a Fold>,
    /// The seams of the piece with the side, 0 or 1, that lies on it.
    seams: Vec<(&'a Seam, usize)>,
    /// Stretches of seam with the side, 0 for forwards and 1 for its partner, that lies on the
    /// piece.
    stretches: Vec<(&'a Stretch, usize)>,
}

fn features<'a>(
    net: &'a Net,
    stretches: &'a [Stretch],
) -> Result<BTreeMap<PieceId, Features<'a>>, SheetError> {
    let mut all: BTreeMap<PieceId, Features<'a>> =
        net.pieces.iter().map(|p| (p.id, Features::default())).collect();
    let unknown = |edge: String, piece| SheetError::UnknownPiece { edge, piece };
    for fold in &net.folds {
        let here =
            all.get_mut(&fold.piece).ok_or_else(|| unknown(fold.id.to_string(), fold.piece))?;
        here.folds.push(fold);
    }
    for seam in &net.seams {
        for (i, side) in seam.sides.iter().enumerate() {
            let here =
                all.get_mut(&side.piece).ok_or_else(|| unknown(seam.id.to_string(), side.piece))?;
            here.seams.push((seam, i));
        }
    }
    for stretch in stretches {
        for (i, piece) in stretch.pieces.iter().enumerate() {
            all.entry(*piece).or_default().stretches.push((stretch, i));
        }
    }
    Ok(all)
}

/// Draws every sheet of a layout.
pub(crate) fn draw(
    net: &Net,
    shapes: &[CutShape],
    layout: &Layout,
    stock: &Stock,
    (params, stretches, jointed): (&SheetParams, &[Stretch], Option<&Jointed>),
) -> Result<(Vec<Drawing>, SheetReport), SheetError> {
    let features = features(net, stretches)?;
    let by_id: BTreeMap<PieceId, (&Piece, &CutShape)> =
        net.pieces.iter().zip(shapes).map(|(p, s)| (p.id, (p, s))).collect();
    let score = ScorePlan::of(params)?;
    let tabs = hold_of(params)?;
    let mut report = SheetReport::default();
    let mut drawings = Vec::new();
    for sheet in &layout.sheets {
        let mut drawing = Drawing::new(sheet);
        for placed in &sheet.placed {
            let (piece, shape) = by_id[&placed.piece];
            let here = &features[&placed.piece];
            draw_cuts(&mut drawing, shape, placed, tabs);
            let cut = jointed.is_some().then_some(piece);
            let hinges = score.hinges(piece, &here.folds);
            draw_folds(&mut drawing, here, (placed, cut), (&score, &hinges), &mut report);
            let flaps = jointed.iter().flat_map(|j| &j.flap_folds).filter(|f| f.piece == piece.id);
            draw_flap_folds(&mut drawing, flaps, placed, &score);
            // The cut of a panel is not the border of its face: there are gaps, fingers and holes.
            let is_face = |f: &FlatFace| piece.outline == f.polygon && piece.holes.is_empty();
            let is_panel = piece.faces.len() == 1 && !is_face(&piece.faces[0]);
            let mut obstacles: Vec<Vec<DVec2>> = if jointed.is_some() || is_panel {
                shape.contours().cloned().collect()
            } else {
                Vec::new()
            };
            obstacles.extend(hinges.rows.iter().flat_map(|r| &r.slits).map(|slit| slit.to_vec()));
            let lettering = Lettering { net, piece, here, placed, obstacles: &obstacles, params };
            lettering.draw(&mut drawing, &mut report)?;
        }
        let stock = Stock { size: DVec2::new(sheet.width, sheet.height), ..*stock };
        draw_info(&mut drawing, &stock, params)?;
        drawing.arrange();
        drawings.push(drawing);
    }
    Ok((drawings, report))
}

/// Number and width in mm of the tabs that hold every part.
fn hold_of(params: &SheetParams) -> Result<(usize, f64), SheetError> {
    let width = params.hold_width.map_or(0.5, |w| w.mm());
    match params.hold {
        0 if params.hold_width.is_some() => Err(SheetError::HoldOption),
        0..=100 if width >= 0.05 && width.is_finite() => Ok((params.hold as usize, width)),
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
    let stroke =
        |points: &[DVec2], closed| vec![Stroke { points: placed.apply_all(points), closed }];
    drawing.add(
        MarkKind::Outline,
        id.to_string(),
        Some(id),
        hold(&placed.apply_all(&shape.outline), tabs, width),
    );
    for (i, hole) in shape.holes.iter().enumerate() {
        drawing.add(MarkKind::Hole, format!("{id}-hole-{}", i + 1), Some(id), stroke(hole, true));
    }
    for (i, slit) in shape.slits.iter().enumerate() {
        drawing.add(MarkKind::Slit, format!("{id}-slit-{}", i + 1), Some(id), stroke(slit, false));
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
    placed: &Placed,
    score: &ScorePlan,
) {
    for fold in folds {
        let [a, b] = fold.segment.map(|p| placed.apply(p));
        let kind = if score.is_cut() { MarkKind::Perforation } else { MarkKind::FlapFold };
        let strokes = score.strokes(a, b, false);
        if !strokes.is_empty() {
            drawing.add(kind, format!("{}-flap", fold.id), Some(placed.piece), strokes);
        }
    }
}

/// What is lettered first and so gets the best place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    NameFirst,
    NumbersFirst,
}

/// The lettering of one piece.
#[derive(Default)]
struct Lettered {
    labels: Vec<(MarkKind, String, Label)>,
    taken: Taken,
    named: bool,
    unnumbered: usize,
    unmarked_angles: usize,
}

/// Letters one piece.
struct Lettering<'a> {
    net: &'a Net,
    piece: &'a Piece,
    here: &'a Features<'a>,
    placed: &'a Placed,
    obstacles: &'a [Vec<DVec2>],
    params: &'a SheetParams,
}

/// Length of the mark at the end of a stretch, and how far from the edge it begins, in mm.
const MARK: [f64; 2] = [2.0, 0.4];

impl Lettering<'_> {
    fn draw(&self, drawing: &mut Drawing, report: &mut SheetReport) -> Result<(), SheetError> {
        let mut lettered = self.letter(Order::NameFirst)?;
        if lettered.unnumbered > 0 {
            // A seam without its number is the greater loss: the name makes room.
            let other = self.letter(Order::NumbersFirst)?;
            lettered = if other.unnumbered < lettered.unnumbered { other } else { lettered };
        }
        if !lettered.named && self.params.labels != Labels::None {
            report.unnamed_pieces.push(self.piece.id);
        }
        report.unnumbered_sides += lettered.unnumbered;
        report.unmarked_angles += lettered.unmarked_angles;
        for (kind, id, label) in lettered.labels {
            let open = |points: &Vec<DVec2>| Stroke {
                points: self.placed.apply_all(points),
                closed: false,
            };
            drawing.add(kind, id, Some(self.piece.id), label.strokes.iter().map(open).collect());
        }
        Ok(())
    }

    fn letter(&self, order: Order) -> Result<Lettered, SheetError> {
        let mut lettered = Lettered::default();
        let labels = self.params.labels;
        if order == Order::NameFirst && labels != Labels::None {
            self.name(&mut lettered)?;
        }
        match labels {
            Labels::All => self.stretches(&mut lettered)?,
            Labels::Edges => self.edges(&mut lettered)?,
            Labels::None | Labels::Pieces => {}
        }
        if order == Order::NumbersFirst && labels != Labels::None {
            self.name(&mut lettered)?;
        }
        if self.params.angles == Angles::On {
            self.angles(&mut lettered)?;
        }
        Ok(lettered)
    }

    fn name(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let upright = DVec2::from_angle(-self.placed.rotation.to_radians());
        if let Some((face, label)) =
            name_label(self.piece, upright, &lettered.taken, self.obstacles)?
        {
            lettered.put(MarkKind::PieceName, format!("{}-name", self.piece.id), face, label);
            lettered.named = true;
        }
        Ok(())
    }

    fn faces(&self) -> BTreeMap<usize, usize> {
        self.piece.faces.iter().enumerate().map(|(i, f)| (f.face, i)).collect()
    }

    fn edges(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for &(seam, i) in &self.here.seams {
            let text = seam.id.0.to_string();
            match self.beside(&text, &faces, (seam, i), false, &lettered.taken)? {
                Some((at, label)) => lettered.put(
                    MarkKind::SeamNumber,
                    format!("{}-number-{}", seam.id, i + 1),
                    at,
                    label,
                ),
                None => lettered.unnumbered += 1,
            }
        }
        Ok(())
    }

    /// One number for every stretch, as near to its middle as there is room, and marks where only
    /// they show its ends.
    fn stretches(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for &(stretch, i) in &self.here.stretches {
            let text = stretch.number.to_string();
            let n = stretch.seams.len();
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by_key(|&k| ((2 * k + 1).abs_diff(n), k));
            let mut found = None;
            for across in [false, true] {
                for &k in &order {
                    let (s, forward) = stretch.seams[k];
                    let side = (&self.net.seams[s], forward ^ i);
                    found = match found {
                        None => self.beside(&text, &faces, side, across, &lettered.taken)?,
                        some => some,
                    };
                }
            }
            let (first, forward) = stretch.seams[0];
            let name =
                |what: &str| format!("{}-{what}-{}", self.net.seams[first].id, 1 + (forward ^ i));
            match found {
                Some((at, label)) => lettered.put(MarkKind::SeamNumber, name("number"), at, label),
                None => lettered.unnumbered += 1,
            }
            if let Some(mark) = self.mark(stretch, i, &faces) {
                lettered.labels.push((MarkKind::SeamMark, name("mark"), mark));
            }
        }
        Ok(())
    }

    /// The short line at the beginning of a stretch that another one runs into.
    fn mark(&self, stretch: &Stretch, i: usize, faces: &BTreeMap<usize, usize>) -> Option<Label> {
        let (s, forward) = *stretch.seams.first().filter(|_| stretch.goes_on[0])?;
        let side = &self.net.seams[s].sides[forward ^ i];
        let face = &self.piece.faces[*faces.get(&side.face)?];
        let [a, b] = face.side(self.net.seams[s].edge, side.segment)?;
        // The beginning of the stretch is where its forward side begins and its partner ends.
        let (at, towards) = if i == 0 { (a, b) } else { (b, a) };
        // A little beside the corner, where a fold may begin.
        let at = at + (towards - at).normalize_or_zero() * (0.25_f64).min(0.2 * a.distance(b));
        let inwards = (b - a).normalize_or_zero().perp();
        let line = vec![at + inwards * MARK[1], at + inwards * (MARK[1] + MARK[0])];
        let inside = line.iter().all(|&p| locate(&face.polygon, p) == Location::Inside);
        let frame = [line[0], line[1], line[1], line[0]];
        let label = Label { strokes: vec![line], frame, height: MARK[0] };
        (inside && is_clear(&label, self.obstacles)).then_some(label)
    }

    fn angles(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for fold in self.here.folds.iter().filter(|f| f.kind != FoldKind::Flat) {
            let text = format!("{:.0}°", fold.fold_angle);
            let mut found = None;
            for at in fold.faces.iter().filter_map(|f| faces.get(f).copied()) {
                let taken = lettered.taken.get(&at).map_or(&[][..], Vec::as_slice);
                found = match found {
                    None => number_label(
                        &text,
                        &self.piece.faces[at],
                        fold.edge,
                        fold.segment,
                        taken,
                        self.obstacles,
                    )?
                    .map(|label| (at, label)),
                    some => some,
                };
            }
            match found {
                Some((at, label)) => {
                    lettered.put(MarkKind::FoldAngle, format!("{}-angle", fold.id), at, label)
                }
                None => lettered.unmarked_angles += 1,
            }
        }
        Ok(())
    }

    fn beside(
        &self,
        text: &str,
        faces: &BTreeMap<usize, usize>,
        (seam, i): (&Seam, usize),
        across: bool,
        taken: &Taken,
    ) -> Result<Option<(usize, Label)>, SheetError> {
        let side = &seam.sides[i];
        let Some(&at) = faces.get(&side.face) else { return Ok(None) };
        let taken = taken.get(&at).map_or(&[][..], Vec::as_slice);
        let put = if across { number_across } else { number_label };
        let label =
            put(text, &self.piece.faces[at], seam.edge, side.segment, taken, self.obstacles)?;
        Ok(label.map(|label| (at, label)))
    }
}

impl Lettered {
    fn put(&mut self, kind: MarkKind, id: String, face: usize, label: Label) {
        self.taken.entry(face).or_default().push(label.frame);
        self.labels.push((kind, id, label));
    }
}

/// The reference square, clear of all pieces where there is room and else in the lower left corner;
/// and a note in the lower margin, where it is high enough.
fn draw_info(drawing: &mut Drawing, stock: &Stock, params: &SheetParams) -> Result<(), SheetError> {
    let inset = stock.margin / 2.0;
    let room = stock.size - DVec2::splat(2.0 * inset);
    if let Some(side) = REFERENCE_SIDES.into_iter().find(|&s| s <= room.min_element()) {
        let low = free_corner(drawing, stock, side).unwrap_or(DVec2::splat(inset));
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
            .map(|(x, y)| low + DVec2::new(x, y));
        let mut strokes = vec![Stroke { points: corners.to_vec(), closed: true }];
        let text = lettering(&format!("{side} MM"), side / 20.0)?;
        strokes.extend(text_strokes(text.strokes, low + DVec2::splat(side / 20.0)));
        drawing.add(MarkKind::Reference, "reference".to_owned(), None, strokes);
    }
    let short = |value: f64| (value * 1e4).round() / 1e4;
    let (width, height, kerf) = (short(stock.size.x), short(stock.size.y), short(params.kerf.mm()));
    let text = lettering(
        &format!("{}  {width} X {height} MM  KERF {kerf} MM", drawing.sheet),
        (stock.margin / 2.0).min(3.0),
    )?;
    let fits = text.high.x + 2.0 * stock.margin <= stock.size.x;
    if stock.margin >= 2.0 && fits {
        let strokes = text_strokes(
            text.strokes,
            DVec2::new(stock.margin, stock.margin / 4.0 + 0.25 * -text.low.y),
        );
        drawing.add(MarkKind::Note, "note".to_owned(), None, strokes);
    }
    Ok(())
}

fn text_strokes(strokes: Vec<Vec<DVec2>>, at: DVec2) -> Vec<Stroke> {
    let moved = |points: Vec<DVec2>| points.into_iter().map(|p| p + at).collect();
    strokes.into_iter().map(|points| Stroke { points: moved(points), closed: false }).collect()
}

/// The lower left corner of a free square on the sheet, searched from the upper right on a grid of
/// places.
fn free_corner(drawing: &Drawing, stock: &Stock, side: f64) -> Option<DVec2> {
    const PLACES: usize = 24;
    let outlines = drawing.marks().filter(|m| m.kind == MarkKind::Outline).flat_map(|m| &m.strokes);
    let boxes: Vec<(DVec2, DVec2)> = outlines.filter_map(|s| bounds(&s.points)).collect();
    let (first, room) = (DVec2::splat(stock.margin), stock.usable() - DVec2::splat(side));
    let corner = |i: usize| {
        let part = |k: usize| 1.0 - k as f64 / (PLACES - 1) as f64;
        first + room * DVec2::new(part(i % PLACES), part(i / PLACES))
    };
    let is_free = |low: &DVec2| {
        let high = *low + DVec2::splat(side);
        boxes.iter().all(|(l, h)| l.cmpgt(high).any() || h.cmplt(*low).any())
    };
    Some(room).filter(|r| r.min_element() >= 0.0)?;
    (0..PLACES * PLACES).map(corner).find(is_free)
}

#[cfg(test)]
mod tests {
    use super::super::drawing::LayerKind;
    use super::super::drawing::Mark;
    use super::super::lay_out;
    use super::super::letter::segments_meet;
    use super::super::params::ScoreStyle;
    use super::super::testing::{net_of, random_convex, ring, square, strips, two_pieces};
    use super::super::verify::edges;
    use super::super::{NestParams, Rotation};
    use super::*;
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
        assert_eq!(ids(&drawing, LayerKind::Info), ["reference", "note", "offcut"]);
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
        let params = SheetParams { kerf: Length::from_mm(0.2), ..SheetParams::default() };
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
            let (drawing, _) =
                drawn(&two_pieces(), &SheetParams { labels, ..SheetParams::default() });
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
        let with = |score| drawn(&two_pieces(), &SheetParams { score, ..SheetParams::default() }).0;
        assert!((with(ScoreStyle::Dashed).score_length() - 16.0).abs() < 1e-9);
        let perforated = with(ScoreStyle::Perforated);
        assert_eq!(
            (ids(&perforated, LayerKind::Score).len(), ids(&perforated, LayerKind::CutInner)),
            (0, vec!["E004"])
        );
        let held = SheetParams { hold: 3, ..SheetParams::default() };
        let (whole, _) = drawn(&two_pieces(), &SheetParams::default());
        let (drawing, _) = drawn(&two_pieces(), &held);
        assert!((whole.cut_length() - drawing.cut_length() - 3.0).abs() < 1e-9);
        let error = lay_out(
            &two_pieces(),
            &SheetParams { hold_width: Some(Length::from_mm(1.0)), ..Default::default() },
        );
        assert_eq!(error, Err(SheetError::HoldOption));
    }

    #[test]
    fn a_chain_of_narrow_faces_becomes_one_hinge_field() {
        let net = strips(8, 5.0, 80.0);
        let nest = NestParams { rotations: Rotation::Fixed, ..NestParams::default() };
        let params =
            SheetParams { hinge: Some(Length::from_mm(6.0)), nest, ..SheetParams::default() };
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
    fn the_reference_square_shrinks_with_the_sheet() {
        let sizes = [(600.0, 100.0), (60.0, 10.0), (9.0, 1.0)].map(|(sheet, side)| {
            let params = SheetParams {
                sheet: super::super::SheetSize::of_mm(sheet, sheet),
                margin: Length::from_mm(1.0),
                ..SheetParams::default()
            };
            let (drawing, _) = drawn(&net_of(vec![square(5.0)]), &params);
            let reference = drawing.marks().find(|m| m.id == "reference").expect("a reference");
            (reference.strokes[0].length() / 4.0 - side).abs() < 1e-9
        });
        assert_eq!(sizes, [true; 3]);
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
