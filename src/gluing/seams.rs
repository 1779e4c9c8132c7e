//! Which parts of which rims are joined.

use super::rims::{self, Rims};
use super::{GluingError, Outline};

/// Parts of a rim that differ by less than that part of the whole are equal.
pub(super) const EQUAL: f64 = 1e-9;
/// Other places to begin that are tried where there is too much material, and pairs of corners.
const MEND_STEPS: usize = 240;
const MEND_CORNERS: usize = 2500;

/// A part of a rim, counter-clockwise from one place to another, in mm from the outline's first
/// point. `to` is larger than `from` by at most the whole rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The outline, counted from 0.
    pub piece: usize,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl Span {
    pub(super) fn length(&self) -> f64 {
        self.to - self.from
    }
}

/// Two parts of rims that are joined; they run against each other, as the two sides of a seam do
/// when both pieces are seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// One side.
    pub a: Span,
    /// The other.
    pub b: Span,
}

/// Outlines and how they are joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Gluing {
    /// The outlines; each is one piece.
    pub outlines: Vec<Outline>,
    /// The seams; together they take every part of every rim once.
    pub seams: Vec<Seam>,
    /// Chords on the longest rim.
    pub points: usize,
    /// By how much of its rim the two sides of a seam may differ; they are then made equal.
    pub slack: f64,
}

impl Gluing {
    /// Two outlines rim to rim: the first point of `a` meets the place `start` (in mm) of `b`.
    /// Their perimeters must be equal.
    pub fn pair(a: Outline, b: Outline, start: f64, points: usize) -> Self {
        let seam = Seam {
            a: Span { piece: 0, from: 0.0, to: a.length() },
            b: Span { piece: 1, from: start, to: start + b.length() },
        };
        Self { outlines: vec![a, b], seams: vec![seam], points, slack: EQUAL }
    }

    /// One outline zipped shut from the place `start` (in mm) of its rim: points at equal distances
    /// from it meet (a pita form; Demaine, O'Rourke 2007, "Geometric Folding Algorithms", 25.7).
    pub fn zip(outline: Outline, start: f64, points: usize) -> Self {
        let half = outline.length() / 2.0;
        let seam = Seam {
            a: Span { piece: 0, from: start, to: start + half },
            b: Span { piece: 0, from: start + half, to: start + 2.0 * half },
        };
        Self { outlines: vec![outline], seams: vec![seam], points, slack: EQUAL }
    }

    /// A side of a seam in words.
    pub(super) fn span_text(&self, span: &Span) -> String {
        let outline = &self.outlines[span.piece];
        format!("{}[{:.4}mm..{:.4}mm]", outline.name(), span.from, span.to)
    }

    /// A seam in words.
    pub(super) fn seam_text(&self, seam: &Seam) -> String {
        format!("{} = {}", self.span_text(&seam.a), self.span_text(&seam.b))
    }

    /// The same seams begun elsewhere: the side `b` of the first seam is moved along its rim, and of
    /// a zip both sides. `None` for more than one seam, which have no such freedom.
    fn moved(&self, by: f64) -> Option<Self> {
        let [seam] = self.seams.as_slice() else { return None };
        let moved = |span: &Span| Span { from: span.from + by, to: span.to + by, ..*span };
        let a = if self.outlines.len() == 1 { moved(&seam.a) } else { seam.a };
        Some(Self { seams: vec![Seam { a, b: moved(&seam.b) }], ..self.clone() })
    }

    /// Cuts the rims into chords and checks that they make a sphere without too much material
    /// anywhere. Where there is too much, the nearest other place to start that has none is named.
    pub(super) fn rims(&self) -> Result<Rims, GluingError> {
        match rims::cut(self) {
            Err(GluingError::Angle { place, degrees, count, .. }) => {
                Err(GluingError::Angle { place, degrees, count, mend: self.mend() })
            }
            rims => rims,
        }
    }

    fn mend(&self) -> Option<String> {
        self.moved(0.0)?;
        let is_zip = self.outlines.len() == 1;
        let whole = self.outlines[self.outlines.len() - 1].length();
        let word = if is_zip { "zip" } else { "start" };
        let begin = self.seams[0].b.from - if is_zip { whole / 2.0 } else { 0.0 };
        let mut changes = self.changes(begin, whole);
        changes.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
        let step = whole / MEND_STEPS as f64;
        let mended = changes
            .into_iter()
            .find(|&by| self.moved(by).is_some_and(|moved| rims::cut(&moved).is_ok()));
        Some(match mended {
            Some(by) => {
                let place = (begin + by).rem_euclid(whole);
                let part = place / whole;
                format!(
                    "the smallest change that mends it, in steps of {step:.2} mm, is {by:+.2} mm: \
                     `--{word} {part:.9}` ({place:.4} mm)"
                )
            }
            None => format!(
                "no other `--{word}` mends it (tried in steps of {step:.2} mm): make the outlines \
                 less hollow"
            ),
        })
    }

    /// Ways to begin elsewhere: equal steps, and where a corner meets a corner.
    fn changes(&self, begin: f64, whole: f64) -> Vec<f64> {
        let nearest = |by: f64| by - whole * (by / whole).round();
        let mut changes: Vec<f64> =
            (1..MEND_STEPS).map(|k| nearest(k as f64 * whole / MEND_STEPS as f64)).collect();
        let [first, last] = [&self.outlines[0], &self.outlines[self.outlines.len() - 1]];
        let (a, b): (Vec<f64>, Vec<f64>) = (first.corners().collect(), last.corners().collect());
        if a.len() * b.len() <= MEND_CORNERS {
            for x in &a {
                // Of a zip, corners at equal distances from its beginning meet.
                let halved = if self.outlines.len() == 1 { 2.0 } else { 1.0 };
                changes.extend(b.iter().map(|y| nearest((x + y) / halved - begin)));
            }
        }
        changes
    }
}
