//! What labels keep clear of, with boxes, so that hundreds of stitch holes cost no more than they
//! must.

use glam::DVec2;

use crate::geom::polygon::{Location, borders_meet, bounds, locate, signed_area};
use crate::sheet::distance::distance_to_contour;

/// Contours of joints that lettering must keep clear of: the cut of a piece where it differs from
/// its faces, and slits.
pub(super) type Obstacles<'a> = &'a [Obstacle];

/// One of them.
#[derive(Debug, Clone)]
pub(super) struct Obstacle {
    contour: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
    /// Outlines run counter-clockwise, holes clockwise, slits have no inside.
    is_outline: bool,
}

impl Obstacle {
    /// `None` for a contour without points.
    pub fn of(contour: &[DVec2]) -> Option<Self> {
        let (low, high) = bounds(contour)?;
        let is_outline = contour.len() > 2 && signed_area(contour) > 0.0;
        Some(Self { contour: contour.to_vec(), low, high, is_outline })
    }

    /// Whether a label in a box may come near it. Slits are few, and always may.
    fn is_near(&self, low: DVec2, high: DVec2) -> bool {
        self.contour.len() <= 2 || self.meets_box(low, high)
    }

    fn meets_box(&self, low: DVec2, high: DVec2) -> bool {
        self.low.cmple(high).all() && low.cmple(self.high).all()
    }

    /// Whether a point lies on its material side.
    pub fn has_material(&self, p: DVec2) -> bool {
        let is_inside = self.meets_box(p, p) && locate(&self.contour, p) == Location::Inside;
        is_inside == self.is_outline
    }

    /// The distance of a point, where it is less than `most`.
    pub fn distance_below(&self, p: DVec2, most: f64) -> f64 {
        let to_box = (self.low - p).max(p - self.high).max(DVec2::ZERO).length();
        if to_box >= most { most } else { distance_to_contour(p, &self.contour).min(most) }
    }

    /// Whether its line runs into a frame.
    fn enters(&self, frame: &[DVec2; 4]) -> bool {
        let Some((low, high)) = bounds(frame) else { return false };
        self.meets_box(low, high)
            && (borders_meet(&self.contour, frame)
                || self.contour.first().is_some_and(|&p| locate(frame, p) != Location::Outside))
    }
}

/// What of the obstacles of a piece may come near a label in a face: the rest lies beyond the box of
/// the face, and a label lies inside.
pub(super) fn obstacles_near(polygon: &[DVec2], obstacles: Obstacles<'_>) -> Vec<Obstacle> {
    let Some((low, high)) = bounds(polygon) else { return Vec::new() };
    obstacles.iter().filter(|obstacle| obstacle.is_near(low, high)).cloned().collect()
}

/// Whether the frame of a label neither crosses an obstacle nor has one inside, nor lies in a notch
/// or hole that is cut away.
pub(super) fn is_clear(frame: &[DVec2; 4], obstacles: Obstacles<'_>) -> bool {
    obstacles.iter().all(|o| o.has_material(frame[0])) && obstacles.iter().all(|o| !o.enters(frame))
}
