//! One closed outline: points, corners, and places along its rim.

use glam::DVec2;

use super::GluingError;
use super::triangle::turn;
use crate::geom::polygon::{bounds, signed_area};

/// From this turn on a point of a drawn outline is a corner, in radians: five degrees. Curves of
/// drawings are flattened much finer.
const CORNER: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Points nearer than that part of the outline's size are one point.
const SAME: f64 = 1e-9;
/// More points than that are refused.
const MOST_POINTS: usize = 2_000_000;

/// A closed outline, counter-clockwise, as seen from outside the body. Lengths in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    name: String,
    points: Vec<DVec2>,
    /// Length of the rim before each point, and the whole length at the end.
    arc: Vec<f64>,
    is_corner: Vec<bool>,
}

impl Outline {
    /// An outline from its points in order, either way round; the first point stays the first, and
    /// a repeated last one is dropped. Points where the outline turns by 5° or more are corners.
    ///
    /// # Errors
    /// [`GluingError::BadOutline`] when a number is not finite or the points bound no area. That it
    /// does not cross itself is found when it is cut into chords.
    pub fn new(name: &str, points: &[DVec2]) -> Result<Self, GluingError> {
        Self::with_corners(name, points, CORNER)
    }

    /// The same with every point as a corner that turns by so many radians.
    pub(super) fn with_corners(
        name: &str,
        points: &[DVec2],
        corner: f64,
    ) -> Result<Self, GluingError> {
        let bad = |fault: String| GluingError::BadOutline { name: name.to_owned(), fault };
        if points.len() > MOST_POINTS {
            let count = points.len();
            return Err(bad(format!("it has {count} points; {MOST_POINTS} are the most")));
        }
        if let Some(p) = points.iter().find(|p| !p.is_finite()) {
            return Err(bad(format!("the point ({}, {}) is not finite", p.x, p.y)));
        }
        let Some((low, high)) = bounds(points) else {
            return Err(bad("it has no points".to_owned()));
        };
        let size = (high - low).length();
        let mut kept: Vec<DVec2> = Vec::with_capacity(points.len());
        for &p in points {
            if kept.last().is_none_or(|last| last.distance(p) > SAME * size) {
                kept.push(p);
            }
        }
        while kept.len() > 1 && kept[0].distance(kept[kept.len() - 1]) <= SAME * size {
            kept.pop();
        }
        let area = signed_area(&kept);
        if kept.len() < 3 || area.abs() <= SAME * size * size {
            let count = kept.len();
            return Err(bad(format!(
                "its {count} points bound an area of {:.3e} mm²; draw one closed line around \
                the piece",
                area.abs()
            )));
        }
        if area < 0.0 {
            kept[1..].reverse();
        }
        Ok(Self::finished(name, kept, corner))
    }

    fn finished(name: &str, points: Vec<DVec2>, corner: f64) -> Self {
        let n = points.len();
        let mut arc = Vec::with_capacity(n + 1);
        let mut length = 0.0;
        for i in 0..n {
            arc.push(length);
            length += points[i].distance(points[(i + 1) % n]);
        }
        arc.push(length);
        let turn_at = |i: usize| {
            let (a, b, c) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
            turn(b - a, c - b)
        };
        let is_corner = (0..n).map(|i| turn_at(i).abs() >= corner).collect();
        Self { name: name.to_owned(), points, arc, is_corner }
    }

    /// Its name, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The same under another name.
    pub fn renamed(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Its points, counter-clockwise.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Length of its rim.
    pub fn length(&self) -> f64 {
        self.arc[self.points.len()]
    }

    /// Width and height.
    pub fn size(&self) -> DVec2 {
        bounds(&self.points).map_or(DVec2::ZERO, |(low, high)| high - low)
    }

    /// The outline that many times as large.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let points = self.points.iter().map(|&p| p * factor).collect();
        let arc = self.arc.iter().map(|&s| s * factor).collect();
        Self { points, arc, ..self.clone() }
    }

    /// The point at a length along the rim, which goes round and round.
    pub fn at(&self, length: f64) -> DVec2 {
        let s = length.rem_euclid(self.length());
        let i = self.arc.partition_point(|&a| a <= s).clamp(1, self.points.len()) - 1;
        let (a, b) = (self.points[i], self.points[(i + 1) % self.points.len()]);
        let part = (s - self.arc[i]) / (self.arc[i + 1] - self.arc[i]);
        a.lerp(b, part.clamp(0.0, 1.0))
    }

    /// Places of its corners along the rim.
    pub fn corners(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.points.len()).filter(|&i| self.is_corner[i]).map(|i| self.arc[i])
    }
}
