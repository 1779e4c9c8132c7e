//! The axis of a handle: a Hermite curve with a frame that does not turn around it (double reflection: Wang, Jüttler, Zheng & Liu 2008,
//! "Computation of rotation minimizing frames").

use glam::DVec3;

use super::super::OpError;
use super::Weights;
use crate::measure::face_centroid;
use crate::mesh::{FaceId, Mesh};

/// Steps of the frame within one segment.
const STEPS: usize = 16;
/// A tangent shorter than this share of the curve's size has no direction.
const NO_TANGENT: f64 = 1e-9;

/// The Hermite curve: two points and two tangents.
pub(super) struct Curve {
    ends: [DVec3; 2],
    tangents: [DVec3; 2],
    normals: [DVec3; 2],
}

/// A point of the axis with its frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub point: DVec3,
    /// Along the axis.
    pub along: DVec3,
    /// Across it.
    pub x: DVec3,
    /// Across both.
    pub y: DVec3,
    /// At an end of the curve the normal of the face there.
    pub normal: DVec3,
}

impl Curve {
    /// The curve between two faces; `None` when it has no length.
    pub fn between(mesh: &Mesh, faces: [FaceId; 2], weights: Option<Weights>) -> Result<Option<Self>, OpError> {
        let mut normals = [DVec3::ZERO; 2];
        for (normal, f) in normals.iter_mut().zip(faces) {
            *normal = mesh.plane(f).ok_or(OpError::NoArea(f))?.normal();
        }
        let ends = faces.map(|f| face_centroid(mesh, f));
        let distance = ends[0].distance(ends[1]);
        let weights = weights.map_or([distance; 2], |w| w.0.map(crate::units::Length::mm));
        let tangents = [normals[0] * weights[0], -normals[1] * weights[1]];
        let size = distance.max(weights[0].abs()).max(weights[1].abs());
        Ok((size > 0.0 && size.is_finite()).then_some(Self { ends, tangents, normals }))
    }

    fn point(&self, t: f64) -> DVec3 {
        let (t2, t3) = (t * t, t * t * t);
        let chord = self.ends[1] - self.ends[0];
        // Relative to the first end, so that far from the origin no digits are lost.
        self.ends[0]
            + chord * (3.0 * t2 - 2.0 * t3)
            + self.tangents[0] * (t3 - 2.0 * t2 + t)
            + self.tangents[1] * (t3 - t2)
    }

    fn direction(&self, t: f64) -> DVec3 {
        let chord = self.ends[1] - self.ends[0];
        let slope = chord * (6.0 * t - 6.0 * t * t)
            + self.tangents[0] * (3.0 * t * t - 4.0 * t + 1.0)
            + self.tangents[1] * (3.0 * t * t - 2.0 * t);
        let size = chord.length().max(self.tangents[0].length()).max(self.tangents[1].length());
        if slope.length() > NO_TANGENT * size {
            return slope.normalize();
        }
        // Where the curve stands still: from a little before to a little after.
        let (before, after) = ((t - 1e-3).max(0.0), (t + 1e-3).min(1.0));
        (self.point(after) - self.point(before)).normalize_or(self.normals[0])
    }

    /// The ends of all segments, with frames carried along without turning.
    pub fn samples(&self, segments: usize) -> Vec<Sample> {
        let steps = segments * STEPS;
        let along = self.direction(0.0);
        let mut across = along.any_orthonormal_vector();
        let mut at = (self.point(0.0), along);
        let mut samples = Vec::with_capacity(segments + 1);
        for i in 0..=steps {
            let t = i as f64 / steps as f64;
            let next = (self.point(t), self.direction(t));
            across = carried(at, next, across);
            at = next;
            if i % STEPS == 0 {
                let normal = self.normals[usize::from(i > 0)];
                samples.push(Sample { point: at.0, along: at.1, x: across, y: at.1.cross(across), normal });
            }
        }
        samples
    }
}

/// A vector across the axis, carried from one point and tangent to the next by two reflections.
fn carried(from: (DVec3, DVec3), to: (DVec3, DVec3), across: DVec3) -> DVec3 {
    let reflect = |v: DVec3, mirror: DVec3| {
        let square = mirror.length_squared();
        if square > 0.0 { v - mirror * (2.0 * v.dot(mirror) / square) } else { v }
    };
    let chord = to.0 - from.0;
    let (half, tangent) = (reflect(across, chord), reflect(from.1, chord));
    let whole = reflect(half, to.1 - tangent);
    // Rounding only.
    (whole - to.1 * whole.dot(to.1)).normalize_or(to.1.any_orthonormal_vector())
}

/// Segments, counted from 1, of which a corner does not go forward as seen from both of its sections.
pub(super) fn crossing_segments(rings: &[Vec<DVec3>], samples: &[Sample]) -> Vec<usize> {
    // Faces at the ends need not be planar; elsewhere only rounding is allowed for.
    let slack = |ring: &[DVec3], at: &Sample| {
        let width = ring.iter().map(|p| p.distance(at.point)).fold(0.0, f64::max);
        let height = ring.iter().map(|p| (*p - at.point).dot(at.along).abs()).fold(0.0, f64::max);
        height + 1e-9 * width
    };
    let passes_through = |k: usize| {
        let (near, far) = (&samples[k], &samples[k + 1]);
        let behind = rings[k + 1].iter().any(|p| (*p - near.point).dot(near.along) < -slack(&rings[k], near));
        let before = rings[k].iter().any(|p| (*p - far.point).dot(far.along) > slack(&rings[k + 1], far));
        behind || before
    };
    (0..rings.len() - 1).filter(|&k| passes_through(k)).map(|k| k + 1).collect()
}
