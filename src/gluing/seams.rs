//! Which parts of which rims are joined.

use super::Outline;

/// Parts of a rim that differ by less than that part of the whole are equal.
pub(super) const EQUAL: f64 = 1e-9;
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
}
