//! Points that stand for their common hull.

use glam::DVec3;

use crate::geom::hull::{Numbers, convex_hull};

/// A point, and whether it came with the input.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartPoint {
    pub position: DVec3,
    pub is_given: bool,
}

/// Points with the volume of their hull.
#[derive(Debug, Clone)]
pub(super) struct Bundle {
    /// The corners of the hull; all points where they span no volume.
    points: Vec<PartPoint>,
    /// The volume of the hull; zero where there is none.
    pub(super) volume: f64,
    /// The corners of the box around the points.
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bundle {
    pub(super) fn of(points: Vec<PartPoint>) -> Self {
        let positions: Vec<DVec3> = points.iter().map(|point| point.position).collect();
        let low = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
        let Ok(faces) = convex_hull(&positions, Numbers::Given) else {
            return Self { points, volume: 0.0, low, high };
        };
        let apex = positions[faces.corners()[0] as usize];
        let mut six_volumes = 0.0;
        for run in faces.iter() {
            let corner = |i: usize| positions[run[i] as usize] - apex;
            for i in 2..run.len() {
                six_volumes += corner(0).dot(corner(i - 1).cross(corner(i)));
            }
        }
        let mut corners = faces.corners().to_vec();
        corners.sort_unstable();
        corners.dedup();
        let points = corners.into_iter().map(|i| points[i as usize]).collect();
        Self { points, volume: six_volumes / 6.0, low, high }
    }

    /// Points of which it is the hull.
    pub(super) fn into_points(self) -> Vec<PartPoint> {
        self.points
    }

    /// Takes in more points.
    pub(super) fn add(&mut self, more: Vec<PartPoint>) {
        let points = std::mem::take(&mut self.points);
        *self = Self::of(points.into_iter().chain(more).collect());
    }

    /// The hull of the points of both.
    pub(super) fn joined(&self, other: &Self) -> Self {
        Self::of(self.points.iter().chain(&other.points).copied().collect())
    }

    /// The middle of the box.
    pub(super) fn middle(&self) -> DVec3 {
        self.low.midpoint(self.high)
    }

    /// Whether the boxes come as near as `margin`.
    pub(super) fn touches(&self, other: &Self, margin: f64) -> bool {
        (self.low - margin).cmple(other.high).all() && (other.low - margin).cmple(self.high).all()
    }

    /// The diagonal of the box around both.
    pub(super) fn span(&self, other: &Self) -> f64 {
        (self.high.max(other.high) - self.low.min(other.low)).length()
    }
}
