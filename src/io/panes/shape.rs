//! What a page consists of.

use glam::DVec2;

use crate::sheet::plain_lettering;

/// What a line stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pen {
    /// The outline of the front.
    Front,
    /// The outline of the back, dashed.
    Back,
    /// Holes.
    Hole,
    /// Dimension lines, diagonals, frames.
    Dimension,
    /// Letters.
    Text,
}

impl Pen {
    pub const ALL: [Self; 5] = [Self::Front, Self::Back, Self::Hole, Self::Dimension, Self::Text];

    /// The layer of the DXF.
    pub const fn layer(self) -> &'static str {
        match self {
            Self::Front => "FRONT",
            Self::Back => "BACK",
            Self::Hole => "HOLES",
            Self::Dimension => "DIMENSIONS",
            Self::Text => "TEXT",
        }
    }

    /// Width of the line in mm of paper.
    pub const fn width(self) -> f64 {
        match self {
            Self::Front => 0.5,
            Self::Back | Self::Hole => 0.35,
            Self::Dimension => 0.13,
            Self::Text => 0.25,
        }
    }
}

/// A line or a circle, in mm of paper.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Line { pen: Pen, points: Vec<DVec2>, is_closed: bool },
    Circle { pen: Pen, centre: DVec2, radius: f64 },
}

impl Shape {
    pub fn outline(pen: Pen, points: Vec<DVec2>) -> Self {
        Self::Line { pen, points, is_closed: true }
    }

    pub fn line(pen: Pen, points: impl Into<Vec<DVec2>>) -> Self {
        Self::Line { pen, points: points.into(), is_closed: false }
    }

    pub const fn pen(&self) -> Pen {
        match self {
            Self::Line { pen, .. } | Self::Circle { pen, .. } => *pen,
        }
    }
}

/// Letters around a middle, reading along a direction, never upside down.
pub(super) fn words(text: &str, middle: DVec2, along: DVec2, height: f64) -> Vec<Shape> {
    let is_upside_down = along.x < -1e-9 || (along.x.abs() <= 1e-9 && along.y < 0.0);
    let along = if is_upside_down { -along } else { along };
    let Ok(letters) = plain_lettering(text, height) else { return Vec::new() };
    let centre = DVec2::new((letters.low.x + letters.high.x) / 2.0, height / 2.0);
    let put = |p: DVec2| middle + along.rotate(p - centre);
    let strokes = letters.strokes.into_iter();
    strokes.map(|s| Shape::line(Pen::Text, s.into_iter().map(put).collect::<Vec<_>>())).collect()
}

/// Letters from a point on to the right.
pub(super) fn words_from(text: &str, at: DVec2, height: f64) -> Vec<Shape> {
    let Ok(letters) = plain_lettering(text, height) else { return Vec::new() };
    let strokes = letters.strokes.into_iter();
    let line = |s: Vec<DVec2>| s.into_iter().map(|p| p + at).collect::<Vec<_>>();
    strokes.map(|s| Shape::line(Pen::Text, line(s))).collect()
}
