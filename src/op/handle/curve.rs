//! The axis of a handle: a Hermite curve, or several end to end (centripetal Catmull-Rom: Yuksel,
//! Schaefer & Keyser 2011, "Parameterization and applications of Catmull-Rom curves"), with a frame
//! that does not turn around it (double reflection: Wang, Jüttler, Zheng & Liu 2008, "Computation
//! of rotation minimizing frames").

use glam::DVec3;

use super::super::OpError;
use crate::geom::RoundingBound;
use crate::measure::face_centroid;
use crate::mesh::{FaceId, Mesh};

/// Steps of the frame within one segment.
const STEPS: usize = 16;
/// A tangent shorter than this share of the curve's size has no direction.
const NO_TANGENT: f64 = 1e-9;

/// Parts into which a span is divided to measure its length.
const LENGTH_STEPS: usize = 64;

/// A Hermite curve: two points and two tangents.
struct Span {
    ends: [DVec3; 2],
    tangents: [DVec3; 2],
}

/// The axis: spans end to end.
pub(super) struct Curve {
    spans: Vec<Span>,
    normals: [DVec3; 2],
    /// With several spans the length from the start to each step within each span.
    lengths: Vec<f64>,
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

impl Span {
    fn point(&self, t: f64) -> DVec3 {
        let (t2, t3) = (t * t, t * t * t);
        let chord = self.ends[1] - self.ends[0];
        // Relative to the first end, so that far from the origin no digits are lost.
        self.ends[0]
            + chord * (3.0 * t2 - 2.0 * t3)
            + self.tangents[0] * (t3 - 2.0 * t2 + t)
            + self.tangents[1] * (t3 - t2)
    }

    fn direction(&self, t: f64, without: DVec3) -> DVec3 {
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
        (self.point(after) - self.point(before)).normalize_or(without)
    }
}

/// The distance of the centroids of two faces.
pub(super) fn distance(mesh: &Mesh, faces: [FaceId; 2]) -> f64 {
    let [a, b] = faces.map(|f| face_centroid(mesh, f));
    a.distance(b)
}

/// The points from start to end, each once: points at one place, and centroids that were given as
/// well, are one.
fn way_through(mesh: &Mesh, start: DVec3, points: &[DVec3], end: DVec3) -> Vec<DVec3> {
    let same = mesh.bounds().map_or(0.0, |(low, high)| RoundingBound::of_box(low, high).length());
    let mut way = vec![start];
    for &p in points.iter().chain([&end]) {
        if way[way.len() - 1].distance(p) > same {
            way.push(p);
        }
    }
    if way[way.len() - 1] != end {
        way.pop();
        way.push(end);
    }
    way
}

fn normals(mesh: &Mesh, faces: [FaceId; 2]) -> Result<[DVec3; 2], OpError> {
    let mut normals = [DVec3::ZERO; 2];
    for (normal, f) in normals.iter_mut().zip(faces) {
        *normal = mesh.plane(f).ok_or(OpError::NoArea(f))?.normal();
    }
    Ok(normals)
}

impl Curve {
    /// The curve between two faces with weights in mm; `None` when it has no length.
    pub fn between(
        mesh: &Mesh,
        faces: [FaceId; 2],
        weights: [f64; 2],
    ) -> Result<Option<Self>, OpError> {
        let normals = normals(mesh, faces)?;
        let ends = faces.map(|f| face_centroid(mesh, f));
        let tangents = [normals[0] * weights[0], -normals[1] * weights[1]];
        let size = ends[0].distance(ends[1]).max(weights[0].abs()).max(weights[1].abs());
        let curve = Self { spans: vec![Span { ends, tangents }], normals, lengths: Vec::new() };
        Ok((size > 0.0 && size.is_finite()).then_some(curve))
    }

    /// The curve from one face to another through points; `None` when it has no length. It leaves
    /// along the first face's normal and arrives along the second's, each to the side on which the
    /// nearest point lies.
    pub fn through(
        mesh: &Mesh,
        faces: [FaceId; 2],
        points: &[DVec3],
    ) -> Result<Option<Self>, OpError> {
        let normals = normals(mesh, faces)?;
        let [start, end] = faces.map(|f| face_centroid(mesh, f));
        let way = way_through(mesh, start, points, end);
        if way.len() < 2
            || way.iter().any(|p| !p.is_finite())
            || way.windows(2).any(|w| w[0] == w[1])
        {
            return Ok(None);
        }
        let last = way.len() - 1;
        let legs: Vec<DVec3> = way.windows(2).map(|w| w[1] - w[0]).collect();
        let knots: Vec<f64> = legs.iter().map(|leg| leg.length().sqrt()).collect();
        // The slope at each point over the knots.
        let slope = |i: usize| {
            let (before, after) = (legs[i - 1] / knots[i - 1], legs[i] / knots[i]);
            before + after - (legs[i - 1] + legs[i]) / (knots[i - 1] + knots[i])
        };
        let along = |normal: DVec3, leg: DVec3| {
            let towards = if normal.dot(leg) < 0.0 { -normal } else { normal };
            towards * leg.length()
        };
        let tangent = |i: usize, leg: usize| match i {
            0 => along(normals[0], legs[0]),
            _ if i == last => along(-normals[1], legs[last - 1]),
            _ => slope(i) * knots[leg],
        };
        let span = |i: usize| Span {
            ends: [way[i], way[i + 1]],
            tangents: [tangent(i, i), tangent(i + 1, i)],
        };
        let mut curve = Self { spans: (0..last).map(span).collect(), normals, lengths: Vec::new() };
        curve.measure();
        Ok(Some(curve))
    }

    fn measure(&mut self) {
        let mut length = 0.0;
        self.lengths.push(length);
        for span in &self.spans {
            for i in 0..LENGTH_STEPS {
                let [a, b] = [i, i + 1].map(|i| span.point(i as f64 / LENGTH_STEPS as f64));
                length += a.distance(b);
                self.lengths.push(length);
            }
        }
    }

    /// The point and the direction at a share of the way; by length where there are several spans.
    fn at(&self, t: f64) -> (DVec3, DVec3) {
        let (span, t) = match self.lengths.last() {
            None => (0, t),
            Some(whole) => {
                let wanted = t * whole;
                let step =
                    self.lengths.partition_point(|&l| l <= wanted).clamp(1, self.lengths.len() - 1)
                        - 1;
                let (from, to) = (self.lengths[step], self.lengths[step + 1]);
                let part =
                    if to > from { ((wanted - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
                let span = step / LENGTH_STEPS;
                (span, ((step % LENGTH_STEPS) as f64 + part) / LENGTH_STEPS as f64)
            }
        };
        (self.spans[span].point(t), self.spans[span].direction(t, self.normals[0]))
    }

    /// The ends of all segments, with frames carried along without turning.
    pub fn samples(&self, segments: usize) -> Vec<Sample> {
        let steps = segments * STEPS;
        let mut at = self.at(0.0);
        let mut across = at.1.any_orthonormal_vector();
        let mut samples = Vec::with_capacity(segments + 1);
        for i in 0..=steps {
            let t = i as f64 / steps as f64;
            let next = self.at(t);
            across = carried(at, next, across);
            at = next;
            if i % STEPS == 0 {
                let normal = self.normals[usize::from(i > 0)];
                samples.push(Sample {
                    point: at.0,
                    along: at.1,
                    x: across,
                    y: at.1.cross(across),
                    normal,
                });
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

/// Segments, counted from 1, of which a corner does not go forward as seen from both of its
/// sections.
pub(super) fn crossing_segments(rings: &[Vec<DVec3>], samples: &[Sample]) -> Vec<usize> {
    // Faces at the ends need not be planar; elsewhere only rounding is allowed for.
    let slack = |ring: &[DVec3], at: &Sample| {
        let width = ring.iter().map(|p| p.distance(at.point)).fold(0.0, f64::max);
        let height = ring.iter().map(|p| (*p - at.point).dot(at.along).abs()).fold(0.0, f64::max);
        height + 1e-9 * width
    };
    let passes_through = |k: usize| {
        let (near, far) = (&samples[k], &samples[k + 1]);
        let behind = rings[k + 1]
            .iter()
            .any(|p| (*p - near.point).dot(near.along) < -slack(&rings[k], near));
        let before =
            rings[k].iter().any(|p| (*p - far.point).dot(far.along) > slack(&rings[k + 1], far));
        behind || before
    };
    (0..rings.len() - 1).filter(|&k| passes_through(k)).map(|k| k + 1).collect()
}
