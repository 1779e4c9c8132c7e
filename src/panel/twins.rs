//! Congruent panels: the same front and back outlines after moving one onto the other, or onto its
//! mirror image.
//!
//! The best turn for a matching of corners follows from one sum of complex products (Procrustes in
//! the plane); all cyclic matchings are tried, so panels may begin at any corner. Panels are only
//! compared with the first panel of every group, so the tolerance does not add up along a chain.

use std::collections::BTreeMap;

use glam::DVec2;

use super::error::PanelError;
use super::plate::Plate;
use crate::progress::Progress;

/// Panels that are compared between two looks at whether to stop.
const STRIDE: usize = 64;

/// To which group a panel belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Twin {
    /// The index of the first panel of the group.
    pub first: usize,
    /// Whether it is the mirror image of that panel.
    pub is_mirrored: bool,
}

/// What is compared: the corners of front and back about their mean, then the middles of the holes.
struct Shape {
    corners: Vec<[DVec2; 2]>,
    holes: Vec<(DVec2, f64)>,
    perimeter: f64,
    /// The distances of the corners from the mean, ascending.
    reaches: Vec<f64>,
}

impl Shape {
    fn of(plate: &Plate) -> Self {
        let n = plate.front.len();
        let mean = plate.front.iter().chain(&plate.back).sum::<DVec2>() / (2 * n).max(1) as f64;
        let corners: Vec<[DVec2; 2]> =
            plate.front.iter().zip(&plate.back).map(|(&a, &b)| [a - mean, b - mean]).collect();
        let perimeter = (0..n).map(|i| corners[i][0].distance(corners[(i + 1) % n][0])).sum();
        let mut reaches: Vec<f64> = corners.iter().flatten().map(|p| p.length()).collect();
        reaches.sort_unstable_by(f64::total_cmp);
        Self {
            corners,
            reaches,
            holes: plate.holes.iter().map(|h| (h.centre - mean, h.radius)).collect(),
            perimeter,
        }
    }

    /// Seen from behind in a mirror: corners keep front and back, and run counter-clockwise again.
    fn mirrored(&self) -> Self {
        let flip = |p: DVec2| DVec2::new(-p.x, p.y);
        Self {
            corners: self.corners.iter().rev().map(|pair| pair.map(flip)).collect(),
            holes: self.holes.iter().map(|&(p, r)| (flip(p), r)).collect(),
            perimeter: self.perimeter,
            reaches: self.reaches.clone(),
        }
    }

    /// Whether some turn of it or of its mirror image could bring all corners within the tolerance of
    /// those of `other`: no distance from the mean changes by more, nor does any of them in order.
    /// Seen at a glance, where most shapes fail; a thousandth more leaves room for rounding.
    fn is_like(&self, other: &Self, tolerance: f64) -> bool {
        let pairs = self.reaches.iter().zip(&other.reaches);
        pairs.rev().all(|(a, b)| (a - b).abs() <= 1.001 * tolerance)
    }

    /// Whether some turn brings all corners and holes of `self` within the tolerance of those of
    /// `other`.
    fn fits(&self, other: &Self, tolerance: f64) -> bool {
        self.corners.len() == other.corners.len()
            && self.holes.len() == other.holes.len()
            && (0..self.corners.len()).any(|shift| self.fits_at(other, shift, tolerance))
    }

    fn fits_at(&self, other: &Self, shift: usize, tolerance: f64) -> bool {
        let pairs = || {
            let partners = other.corners.iter().cycle().skip(shift);
            self.corners.iter().zip(partners).flat_map(|(a, b)| [(a[0], b[0]), (a[1], b[1])])
        };
        // Σ conj(a)·b points along the turn.
        let sum: DVec2 = pairs().map(|(a, b)| DVec2::new(a.dot(b), a.perp_dot(b))).sum();
        let Some(turn) = sum.try_normalize() else { return false };
        let is_near = |a: DVec2, b: DVec2| turn.rotate(a).distance(b) <= tolerance;
        pairs().all(|(a, b)| is_near(a, b))
            && self.holes.iter().all(|&(p, r)| {
                other.holes.iter().any(|&(q, s)| is_near(p, q) && (r - s).abs() <= tolerance)
            })
    }
}

/// Groups congruent panels; for each panel, in order, the first of its group. `tolerance` is in mm.
///
/// # Errors
/// [`PanelError::Cancelled`].
pub fn twins(
    plates: &[Plate],
    tolerance: f64,
    progress: &dyn Progress,
) -> Result<Vec<Twin>, PanelError> {
    let shapes: Vec<Shape> = plates.iter().map(Shape::of).collect();
    let longest = shapes.iter().map(|s| s.perimeter).fold(0.0, f64::max);
    // Equal numbers computed in another order differ in their last digits.
    let tolerance = tolerance.max(1e-10 * longest);
    let mut firsts: BTreeMap<(usize, u64, i64, i64), Vec<usize>> = BTreeMap::new();
    let mut found = Vec::with_capacity(plates.len());
    for (i, (plate, shape)) in plates.iter().zip(&shapes).enumerate() {
        if i.is_multiple_of(STRIDE) && progress.is_cancelled() {
            return Err(PanelError::Cancelled);
        }
        let corners = shape.corners.len();
        // Corners that differ by the tolerance let the perimeter differ by twice that for each, and
        // the outermost lie farther out by the tolerance; twice that leaves room for rounding.
        let width = 2.0 * corners as f64 * tolerance;
        let key = |step: i64, farther: i64| {
            let cell = |size: f64, width: f64| (size / width).floor() as i64;
            let thickness = plate.thickness.to_bits();
            let reach =
                cell(shape.reaches.last().copied().unwrap_or(0.0), 2.0 * tolerance) + farther;
            (corners, thickness, cell(shape.perimeter, width) + step, reach)
        };
        // What has other perimeters is parted first, then of each its reaches in a row.
        let mut near: Vec<usize> = [-1, 0, 1]
            .iter()
            .flat_map(|&step| firsts.range(key(step, -1)..=key(step, 1)))
            .flat_map(|(_, firsts)| firsts.iter().copied())
            .collect();
        near.retain(|&first| shape.is_like(&shapes[first], tolerance));
        near.sort_unstable();
        let mirrored = if near.is_empty() { None } else { Some(shape.mirrored()) };
        let is_mirrored =
            |other: &Shape| mirrored.as_ref().is_some_and(|m| m.fits(other, tolerance));
        let twin = near.iter().find_map(|&first| match &shapes[first] {
            other if shape.fits(other, tolerance) => Some(Twin { first, is_mirrored: false }),
            other if is_mirrored(other) => Some(Twin { first, is_mirrored: true }),
            _ => None,
        });
        if twin.is_none() {
            firsts.entry(key(0, 0)).or_default().push(i);
        }
        found.push(twin.unwrap_or(Twin { first: i, is_mirrored: false }));
    }
    Ok(found)
}
