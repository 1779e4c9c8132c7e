//! The outline of an end in polar coordinates across the axis.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::curve::Sample;

/// Twists that differ by no more are equal, and the first corner is taken.
const SAME_TWIST: f64 = 1e-9;

/// Corners by distance from the axis, angle around it, and height along it. Angles go on around: no
/// corner is more than half a turn from the one before.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    corners: Vec<(f64, f64, f64)>,
    /// From the last corner on to the first, the whole way around.
    turn: f64,
}

fn wrapped(angle: f64, around: f64) -> f64 {
    // In (around − π, around + π]; half a turn within rounding counts as positive.
    angle - TAU * ((angle - around - PI - SAME_TWIST) / TAU).ceil()
}

impl Outline {
    /// The outline of a face at an end of the axis. Where the axis does not leave at right angles
    /// the face is turned upright first.
    pub fn of(points: &[DVec3], end: &Sample) -> Self {
        let normal = if end.normal.dot(end.along) < 0.0 { -end.normal } else { end.normal };
        let upright = DQuat::from_rotation_arc(normal, end.along);
        let polar = |p: &DVec3| {
            let way = upright * (*p - end.point);
            let (x, y) = (way.dot(end.x), way.dot(end.y));
            (x.hypot(y), y.atan2(x), way.dot(end.along))
        };
        let mut corners: Vec<(f64, f64, f64)> = points.iter().map(polar).collect();
        for i in 1..corners.len() {
            corners[i].1 = wrapped(corners[i].1, corners[i - 1].1);
        }
        let last = corners[corners.len() - 1].1;
        let turn = wrapped(corners[0].1, last) - corners[0].1;
        Self { corners, turn }
    }

    /// The angle of the whole way around: a full turn, either way, for a face that is seen as a
    /// star from its centroid.
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// The mean angle from the corners of one outline to those of another.
    pub fn twist_to(&self, other: &Self) -> f64 {
        let pairs = self.corners.iter().zip(&other.corners);
        pairs.map(|(a, b)| b.1 - a.1).sum::<f64>() / self.corners.len() as f64
    }

    /// The same outline begun `shift` corners later.
    fn begun_at(&self, shift: usize) -> Self {
        let mut corners = self.corners[shift..].to_vec();
        corners
            .extend(self.corners[..shift].iter().map(|&(r, angle, z)| (r, angle + self.turn, z)));
        Self { corners, turn: self.turn }
    }

    /// The outline turned by whole turns, and if free begun at another corner, so that the twist
    /// from `first` is nearest to `twist`.
    pub fn turned_to(&self, first: &Self, twist: f64, is_free: bool) -> (usize, Self) {
        let candidates = if is_free { self.corners.len() } else { 1 };
        let mut best: Option<(f64, usize, Self)> = None;
        for shift in 0..candidates {
            let mut begun = self.begun_at(shift);
            let mean = first.twist_to(&begun);
            let turns = wrapped(mean, twist) - mean;
            begun.corners.iter_mut().for_each(|c| c.1 += turns);
            let miss = (mean + turns - twist).abs();
            if best.as_ref().is_none_or(|b| miss < b.0 - SAME_TWIST) {
                best = Some((miss, shift, begun));
            }
        }
        best.map_or_else(|| (0, self.clone()), |(_, shift, begun)| (shift, begun))
    }

    /// The corners of the section at share `t`, on the axis there.
    pub fn between(&self, other: &Self, t: f64, at: &Sample) -> Vec<DVec3> {
        let mix = |a: f64, b: f64| (1.0 - t) * a + t * b;
        let corner = |(a, b): (&(f64, f64, f64), &(f64, f64, f64))| {
            let (sin, cos) = mix(a.1, b.1).sin_cos();
            at.point + (at.x * cos + at.y * sin) * mix(a.0, b.0) + at.along * mix(a.2, b.2)
        };
        self.corners.iter().zip(&other.corners).map(corner).collect()
    }
}
