//! How folds are drawn: solid, dashed, perforated, or as a field of slits that makes plates bend.

use std::collections::{BTreeMap, BTreeSet};

use clap::ValueEnum;
use glam::DVec2;
use serde::Deserialize;

use super::drawing::Stroke;
use super::error::SheetError;
use crate::net::{EdgeLabel, Fold, Piece, Segment};
use crate::units::Length;

/// Length of a dash and of the gap after it, in mm.
const DASHED: [f64; 2] = [2.0, 2.0];

/// Length of a cut of a perforation and of the bridge after it, in mm.
const PERFORATED: [f64; 2] = [3.0, 1.0];

/// Length of a slit of a hinge field and of the bridge after it, in mm.
const SLITS: [f64; 2] = [20.0, 3.0];

/// Rows of slits lie no further apart than this, in mm.
const ROWS: f64 = 2.5;

/// How folds are drawn.
#[derive(Debug, Clone, PartialEq, Default, clap::Args, Deserialize)]
pub struct ScoreParams {
    /// How folds are scored
    #[arg(id = "score", long = "score", value_name = "SCORE", value_enum, default_value = "solid")]
    #[serde(default, rename = "score")]
    pub style: ScoreStyle,
    /// Length of a dash or of a cut of a perforation, at least 0.1mm; 2mm, perforated 3mm unless
    /// given
    #[arg(id = "score_dash", long = "score-dash", value_name = "LENGTH")]
    #[serde(default, rename = "score_dash")]
    pub dash: Option<Length>,
    /// Length of the gap or bridge between them, about, at least 0.1mm; 2mm, perforated 1mm unless
    /// given
    #[arg(id = "score_gap", long = "score-gap", value_name = "LENGTH")]
    #[serde(default, rename = "score_gap")]
    pub gap: Option<Length>,
    /// How much of a fold is left out at both its ends, where folds run into corners; 0 or more
    #[arg(id = "score_inset", long = "score-inset", value_name = "LENGTH", default_value = "0mm")]
    #[serde(default, rename = "score_inset")]
    pub inset: Length,
    /// Faces between two folds that are narrower than this become living hinges: staggered slits
    /// instead of scores
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub hinge: Option<Length>,
    /// How a material folds that does not by itself, as plywood, acrylic and glass: without it every
    /// face is a piece of its own
    #[arg(long, value_name = "WAY", value_enum)]
    #[serde(default)]
    pub fold: Option<FoldWay>,
}

/// How a rigid material folds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FoldWay {
    /// Along scored lines: grooves to be milled or steamed.
    Score,
    /// Along living hinges: faces between two folds that are narrower than --hinge, ten times the
    /// thickness unless given, are slit.
    Hinge,
}

/// How folds are scored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScoreStyle {
    /// One line per fold.
    #[default]
    Solid,
    /// Dashes of 2 mm with gaps of about 2 mm, beginning and ending with a dash.
    Dashed,
    /// Cut through, with bridges, beginning and ending with a bridge.
    Perforated,
    /// Mountains solid, valleys dashed.
    Valleys,
}

/// Checked numbers for drawing folds, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScorePlan {
    style: ScoreStyle,
    dash: Option<f64>,
    gap: Option<f64>,
    inset: f64,
    hinge: Option<f64>,
}

/// A row of slits of a hinge field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SlitRow {
    /// The fold that it belongs to, and its number from there on.
    pub fold: EdgeLabel,
    pub number: usize,
    pub slits: Vec<[DVec2; 2]>,
}

/// The hinge fields of one piece.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hinges {
    /// Folds that are slit instead of scored.
    pub folds: BTreeSet<EdgeLabel>,
    pub rows: Vec<SlitRow>,
}

impl ScorePlan {
    /// # Errors
    /// [`SheetError::OutOfRange`] for numbers; [`SheetError::ScoreOption`] for lengths of dashes
    /// without dashes.
    pub fn of(params: &ScoreParams) -> Result<Self, SheetError> {
        if params.style == ScoreStyle::Solid {
            for (option, is_given) in
                [("score-dash", params.dash.is_some()), ("score-gap", params.gap.is_some())]
            {
                if is_given {
                    return Err(SheetError::ScoreOption { option });
                }
            }
        }
        let checked =
            |name: &'static str, value: Option<Length>, least: f64| match value.map(|v| v.mm()) {
                Some(value) if !(value >= least && value.is_finite()) => {
                    Err(SheetError::OutOfRange { name, value, least })
                }
                value => Ok(value),
            };
        Ok(Self {
            style: params.style,
            dash: checked("score-dash", params.dash, 0.1)?,
            gap: checked("score-gap", params.gap, 0.1)?,
            inset: checked("score-inset", Some(params.inset), 0.0)?.unwrap_or(0.0),
            hinge: checked("hinge", params.hinge, 0.1)?,
        })
    }

    /// Whether folds are cut through here and there.
    pub fn is_cut(&self) -> bool {
        self.style == ScoreStyle::Perforated
    }

    /// A fold as lines from a to b. Nothing is left of a fold that is shorter than what its ends
    /// keep free.
    pub fn strokes(&self, a: DVec2, b: DVec2, is_valley: bool) -> Vec<Stroke> {
        let length = a.distance(b);
        let [dash, gap] = match self.style {
            ScoreStyle::Perforated => {
                [self.dash.unwrap_or(PERFORATED[0]), self.gap.unwrap_or(PERFORATED[1])]
            }
            _ => [self.dash.unwrap_or(DASHED[0]), self.gap.unwrap_or(DASHED[1])],
        };
        // A perforation begins with a bridge: cut at its ends, it would open the outline.
        let inset = if self.is_cut() { self.inset.max(gap) } else { self.inset };
        if inset > 0.0 && length <= 2.0 * inset {
            return Vec::new();
        }
        let along = (b - a) / length;
        let [a, b] = if inset > 0.0 { [a + along * inset, b - along * inset] } else { [a, b] };
        let is_dashed = match self.style {
            ScoreStyle::Solid => false,
            ScoreStyle::Dashed | ScoreStyle::Perforated => true,
            ScoreStyle::Valleys => is_valley,
        };
        let lines = if is_dashed { dashes(a, b, dash, gap) } else { vec![[a, b]] };
        lines.into_iter().map(|line| Stroke { points: line.to_vec(), closed: false }).collect()
    }

    /// The hinge fields of a piece: every chain of faces narrower than the hinge width, with the
    /// folds at their ends.
    pub fn hinges(&self, piece: &Piece, folds: &[&Fold]) -> Hinges {
        self.hinge.map_or_else(Hinges::default, |width| hinges(piece, folds, width))
    }
}

/// Dashes that begin and end at the ends; the gaps between them are as near to `gap` as that
/// allows.
fn dashes(a: DVec2, b: DVec2, dash: f64, gap: f64) -> Vec<[DVec2; 2]> {
    let length = a.distance(b);
    // As many gaps as leave room for a dash at each end.
    let gaps = ((length - dash) / (dash + gap)).round();
    if gaps.is_nan() || gaps < 1.0 {
        return vec![[a, b]];
    }
    let period = (length - dash) / gaps;
    let at = |distance: f64| a.lerp(b, distance / length);
    let one = |i: u32| [at(f64::from(i) * period), at((f64::from(i) * period + dash).min(length))];
    (0..=gaps as u32).map(one).collect()
}

/// Both folds of a narrow face, the same way round.
struct Strip {
    folds: [usize; 2],
    sides: [Segment; 2],
}

fn hinges(piece: &Piece, folds: &[&Fold], width: f64) -> Hinges {
    let strips = strips(piece, folds, width);
    let parity = parities(&strips, folds.len());
    let of_strip = |strip: &Strip| strip.folds.map(|i| folds[i].id);
    let mut hinges =
        Hinges { folds: strips.iter().flat_map(of_strip).collect(), ..Hinges::default() };
    // The folds themselves are rows, and between the two of a strip as many as keep the rows near
    // enough.
    let mut rows: Vec<HingeRow> = Vec::new();
    for (i, fold) in folds.iter().enumerate().filter(|(_, f)| hinges.folds.contains(&f.id)) {
        rows.push(HingeRow { fold: i, line: fold.segment, is_odd: parity[i] });
    }
    for strip in &strips {
        let [[a, b], [c, d]] = strip.sides;
        let between = rows_between(strip);
        for k in 1..=between {
            let t = k as f64 / (between + 1) as f64;
            let is_odd = parity[strip.folds[0]] ^ (k % 2 == 1);
            let line = [a.lerp(c, t), b.lerp(d, t)];
            rows.push(HingeRow { fold: strip.folds[0], line, is_odd });
        }
    }
    let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
    for HingeRow { fold, line: [a, b], is_odd } in rows {
        let number = numbers.entry(fold).or_insert(0);
        *number += 1;
        let slits = slits(a, b, is_odd);
        if !slits.is_empty() {
            hinges.rows.push(SlitRow { fold: folds[fold].id, number: *number, slits });
        }
    }
    hinges
}

/// A row of slits before it is cut.
struct HingeRow {
    /// The fold that it belongs to, by its index.
    fold: usize,
    line: Segment,
    /// Whether it is moved by half a period.
    is_odd: bool,
}

/// The faces with two folds that are as narrow as a hinge may be.
fn strips(piece: &Piece, folds: &[&Fold], width: f64) -> Vec<Strip> {
    let mut of_face: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, fold) in folds.iter().enumerate() {
        fold.faces.iter().for_each(|&f| of_face.entry(f).or_default().push(i));
    }
    let mut strips = Vec::new();
    for face in &piece.faces {
        let Some(&[i, j]) = of_face.get(&face.face).map(Vec::as_slice) else { continue };
        let [a, b] = folds[i].segment;
        let [c, d] = folds[j].segment;
        let is_same_way = a.distance(c) + b.distance(d) <= a.distance(d) + b.distance(c);
        let other = if is_same_way { [c, d] } else { [d, c] };
        let span = a.distance(other[0]).max(b.distance(other[1]));
        // A strip is longer along its folds than across.
        if span <= width && span < a.distance(b).max(c.distance(d)) {
            strips.push(Strip { folds: [i, j], sides: [[a, b], other] });
        }
    }
    strips
}

/// How many rows come between the folds of a strip.
fn rows_between(strip: &Strip) -> usize {
    let [[a, b], [c, d]] = strip.sides;
    (a.distance(c).max(b.distance(d)) / ROWS).ceil().max(1.0) as usize - 1
}

/// Whether the slits of a fold are moved by half a period, so that they are so in every other row
/// of a chain.
fn parities(strips: &[Strip], count: usize) -> Vec<bool> {
    let mut parity: Vec<Option<bool>> = vec![None; count];
    for start in 0..strips.len() {
        if parity[strips[start].folds[0]].is_some() {
            continue;
        }
        parity[strips[start].folds[0]] = Some(false);
        // Chains are short enough to be gone over until nothing is new.
        let mut is_new = true;
        while is_new {
            is_new = false;
            for strip in strips {
                let [i, j] = strip.folds;
                for (from, to) in [(i, j), (j, i)] {
                    if let (Some(known), None) = (parity[from], parity[to]) {
                        // A chain of faces has no ring: folds are a forest.
                        parity[to] = Some(known ^ rows_between(strip).is_multiple_of(2));
                        is_new = true;
                    }
                }
            }
        }
    }
    parity.into_iter().map(|p| p.unwrap_or(false)).collect()
}

/// Slits along a row: whole ones with bridges at both ends, or moved by half a period with halves
/// at the ends.
fn slits(a: DVec2, b: DVec2, is_odd: bool) -> Vec<[DVec2; 2]> {
    let length = a.distance(b);
    let [slit, bridge] = SLITS;
    let count = ((length - bridge) / (slit + bridge)).round().max(1.0);
    // What is left for the slits once every bridge has its width.
    let own = (length - bridge * (count + 1.0)) / count;
    if own <= bridge {
        return Vec::new();
    }
    let period = own + bridge;
    let at = |distance: f64| a.lerp(b, distance / length);
    let whole = |i: u32| [bridge + f64::from(i) * period, bridge + f64::from(i) * period + own];
    let moved = |i: u32| {
        let from = bridge + (f64::from(i) - 0.5) * period;
        [from.max(bridge), (from + own).min(length - bridge)]
    };
    let n = count as u32;
    let spans: Vec<[f64; 2]> =
        if is_odd { (0..=n).map(moved).collect() } else { (0..n).map(whole).collect() };
    spans
        .into_iter()
        .filter(|[from, to]| to - from > bridge / 2.0)
        .map(|[from, to]| [at(from), at(to)])
        .collect()
}

/// Opens a contour at `count` places, `width` mm wide: bridges that hold a part until it is broken
/// out. They lie in the middle of edges, spread over the contour; a contour too short for them
/// stays closed.
pub(crate) fn with_holding_tabs(contour: &[DVec2], count: usize, width: f64) -> Vec<Stroke> {
    let n = contour.len();
    let lengths: Vec<f64> = (0..n).map(|i| contour[i].distance(contour[(i + 1) % n])).collect();
    let is_long = lengths.iter().sum::<f64>() >= 4.0 * width * count as f64;
    let places =
        if n < 3 || !is_long { Vec::new() } else { edges_for_tabs(&lengths, count, width) };
    if places.is_empty() {
        return vec![Stroke { points: contour.to_vec(), closed: true }];
    }
    let gap = |i: usize| {
        let (a, b) = (contour[i], contour[(i + 1) % n]);
        let half = (b - a) / lengths[i] * (width / 2.0);
        let middle = a.midpoint(b);
        [middle - half, middle + half]
    };
    let line = |k: usize| {
        let (from, to) = (places[k], places[(k + 1) % places.len()]);
        let steps = (to + n - from - 1) % n + 1;
        let mut points = vec![gap(from)[1]];
        points.extend((1..=steps).map(|s| contour[(from + s) % n]));
        points.push(gap(to)[0]);
        Stroke { points, closed: false }
    };
    (0..places.len()).map(line).collect()
}

/// For every share of a contour the longest edge whose middle is in it and that is wide enough.
fn edges_for_tabs(lengths: &[f64], count: usize, width: f64) -> Vec<usize> {
    let total: f64 = lengths.iter().sum();
    let mut places: Vec<usize> = Vec::new();
    for share in 0..count {
        let [from, to] = [share, share + 1].map(|s| total * s as f64 / count as f64);
        let mut at = 0.0;
        let mut best: Option<usize> = None;
        for (i, length) in lengths.iter().enumerate() {
            let middle = at + length / 2.0;
            if (from..to).contains(&middle)
                && *length > 2.0 * width
                && best.is_none_or(|b| *length > lengths[b])
            {
                best = Some(i);
            }
            at += length;
        }
        places.extend(best);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::testing::{square, two_pieces};
    use super::*;
    use crate::units::Length;

    fn plan(params: &ScoreParams) -> ScorePlan {
        ScorePlan::of(params).expect("good numbers")
    }

    fn lengths(strokes: &[Stroke]) -> Vec<f64> {
        strokes.iter().map(|s| (s.length() * 1e6).round() / 1e6).collect()
    }

    #[test]
    fn dashes_begin_and_end_with_a_dash() {
        let plan = plan(&ScoreParams { style: ScoreStyle::Dashed, ..ScoreParams::default() });
        let dashes = plan.strokes(DVec2::ZERO, DVec2::new(30.0, 0.0), false);
        assert_eq!(dashes.len(), 8);
        assert_eq!(dashes[0].points[0], DVec2::ZERO);
        assert!((dashes[7].points[1].x - 30.0).abs() < 1e-12);
        assert!(dashes.iter().all(|d| (d.length() - 2.0).abs() < 1e-12));
        assert_eq!(plan.strokes(DVec2::ZERO, DVec2::new(3.0, 0.0), false).len(), 1);
    }

    #[test]
    fn perforations_keep_bridges_at_both_ends_and_insets_free_the_corners() {
        let perforated =
            plan(&ScoreParams { style: ScoreStyle::Perforated, ..ScoreParams::default() });
        let cuts = perforated.strokes(DVec2::ZERO, DVec2::new(21.0, 0.0), false);
        assert_eq!((cuts[0].points[0].x, cuts[cuts.len() - 1].points[1].x), (1.0, 20.0));
        assert_eq!(lengths(&cuts), [3.0; 5]);
        let inset = ScoreParams { inset: Length::from_mm(2.5), ..ScoreParams::default() };
        let solid = plan(&inset).strokes(DVec2::ZERO, DVec2::new(21.0, 0.0), false);
        assert_eq!(lengths(&solid), [16.0]);
        assert!(plan(&inset).strokes(DVec2::ZERO, DVec2::new(5.0, 0.0), false).is_empty());
    }

    #[test]
    fn options_that_do_nothing_are_refused() {
        let params = ScoreParams { gap: Some(Length::from_mm(1.0)), ..ScoreParams::default() };
        assert!(ScorePlan::of(&params).expect_err("no dashes").to_string().contains("score-gap"));
        let params = ScoreParams { hinge: Some(Length::from_mm(-1.0)), ..ScoreParams::default() };
        assert!(
            ScorePlan::of(&params).expect_err("below 0").to_string().contains("hinge is -1 mm")
        );
    }

    #[test]
    fn bridges_hold_a_square_and_take_no_corner() {
        let held = with_holding_tabs(&square(40.0), 2, 0.5);
        assert_eq!(held.len(), 2);
        let total: f64 = held.iter().map(Stroke::length).sum();
        assert!((total - 159.0).abs() < 1e-9);
        let mut corners: Vec<DVec2> = held.iter().flat_map(|s| &s.points).copied().collect();
        corners.retain(|p| square(40.0).contains(p));
        assert_eq!(corners.len(), 4);
        assert_eq!(
            with_holding_tabs(&square(0.5), 4, 0.5),
            vec![Stroke { points: square(0.5), closed: true }]
        );
        assert_eq!(with_holding_tabs(&square(40.0), 1, 0.5).len(), 1);
    }

    #[test]
    fn neighbouring_rows_have_their_slits_in_other_places() {
        let (even, odd) = (
            slits(DVec2::ZERO, DVec2::new(72.0, 0.0), false),
            slits(DVec2::ZERO, DVec2::new(72.0, 0.0), true),
        );
        assert_eq!((even.len(), odd.len()), (3, 4));
        // Every bridge of one row lies beside a slit of the other.
        for bridge in even.windows(2).map(|w| w[0][1].midpoint(w[1][0])) {
            assert!(
                odd.iter().any(|s| s[0].x < bridge.x - 1.5 && bridge.x + 1.5 < s[1].x),
                "{bridge}"
            );
        }
        assert!(even.iter().chain(&odd).all(|s| s[0].x >= 3.0 - 1e-9 && s[1].x <= 69.0 + 1e-9));
    }

    #[test]
    fn wide_faces_make_no_hinge() {
        let net = two_pieces();
        let folds: Vec<&Fold> = net.folds.iter().collect();
        let params = ScoreParams { hinge: Some(Length::from_mm(8.0)), ..ScoreParams::default() };
        let hinges = plan(&params).hinges(&net.pieces[0], &folds);
        assert!(hinges.folds.is_empty() && hinges.rows.is_empty());
    }
}
