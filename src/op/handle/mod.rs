//! Handles: a curved tube of several segments between two faces (Srinivasan 2004, IV).
//!
//! The axis is the Hermite curve through the centroids that leaves the first face along its normal and reaches the second against its normal,
//! each weighed by a length. The two outlines are taken as polar coordinates (distance and angle that goes on around) across the ends of the
//! curve, in a frame that is carried along it without turning, and interpolated; so faces that are opposite, parallel or on one line
//! are no special case. Negative weights lead the curve inwards: a hole instead of a handle.
//!
//! Between faces of n sides with s segments:
//!
//! ```text
//!   vertices  V + n(s−1)    edges  E + n(2s−1)    faces  F + ns − 2    genus + 1, or two components become one
//! ```
//!
//! Of faces with different numbers of sides the one with fewer has its longest sides halved first: V + 1, E + 1 for each. Needs: two faces
//! with an area. Keeps: ids, groups and planes of all other faces; the tube has the group of the first face. Planarity: quads are planar by luck.
//! Degenerate cases, all errors that say why: one segment between faces that share a corner would be flat; weights of different signs would
//! turn the tube inside out; a curve without length. Neighbouring sections that pass through each other are reported with their segment.

mod curve;
mod outline;

#[cfg(test)]
mod tests;

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

use super::{OpContext, OpError, OpFinding};
use crate::code::Coded;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use crate::select::Made;
use crate::units::{Angle, Length, UnitError};

use curve::Curve;
use outline::Outline;

/// More sections than anybody can tell apart.
const MOST_SEGMENTS: u32 = 10_000;

/// How to make a handle. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct HandleParams {
    /// The face to begin at, and, if wanted, the corner that is joined first: `0` or `0:3`.
    #[arg(long, value_name = "FACE[:VERTEX]")]
    pub from: FaceCorner,
    /// The face to end at, and, if wanted, the corner that the first one is joined to; else the twist decides.
    #[arg(long, value_name = "FACE[:VERTEX]")]
    pub to: FaceCorner,
    /// How many segments, 1 to 10000.
    #[arg(long, default_value_t = default_segments())]
    #[serde(default = "default_segments")]
    pub segments: u32,
    /// How far the axis keeps to the normals at its two ends; negative for a hole; the distance of the centroids when left out.
    #[arg(long, value_name = "LENGTH,LENGTH", allow_hyphen_values = true)]
    #[serde(default)]
    pub weights: Option<Weights>,
    /// How far the tube turns around its axis, as near as the corners allow; whole turns add up.
    #[arg(long, default_value = "0deg", allow_hyphen_values = true)]
    #[serde(default)]
    pub twist: Angle,
}

fn default_segments() -> u32 {
    5
}

/// A face and perhaps one of its corners, by ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceCorner {
    /// The face.
    pub face: u32,
    /// The vertex at the corner.
    pub vertex: Option<u32>,
}

impl FromStr for FaceCorner {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error = |_| UnitError { text: text.to_owned(), wanted: "a face and a vertex", example: "4 or 4:7" };
        let (face, vertex) = text.split_once(':').map_or((text, None), |(face, vertex)| (face, Some(vertex)));
        let vertex = vertex.map(|v| v.trim().parse().map_err(error)).transpose()?;
        Ok(Self { face: face.trim().parse().map_err(error)?, vertex })
    }
}

impl fmt::Display for FaceCorner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.face.fmt(f)?;
        self.vertex.map_or(Ok(()), |v| write!(f, ":{v}"))
    }
}

impl<'de> Deserialize<'de> for FaceCorner {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Typed {
            Id(u32),
            Text(String),
        }
        match Typed::deserialize(deserializer)? {
            Typed::Id(face) => Ok(Self { face, vertex: None }),
            Typed::Text(text) => text.parse().map_err(de::Error::custom),
        }
    }
}

/// How far the axis keeps to the normals: `30mm,30mm`, in mm unless a unit is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights(pub [Length; 2]);

impl FromStr for Weights {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error = || UnitError { text: text.to_owned(), wanted: "a pair of lengths", example: "30mm,-20mm" };
        let (a, b) = text.split_once(',').ok_or_else(error)?;
        Ok(Self([a.parse()?, b.parse()?]))
    }
}

impl fmt::Display for Weights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.0[0], self.0[1])
    }
}

impl<'de> Deserialize<'de> for Weights {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Typed {
            Pair([Length; 2]),
            Text(String),
        }
        match Typed::deserialize(deserializer)? {
            Typed::Pair(pair) => Ok(Self(pair)),
            Typed::Text(text) => text.parse().map_err(de::Error::custom),
        }
    }
}

/// What a handle came out as.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HandleReport {
    /// How many sides of the face with fewer were halved.
    pub halved: usize,
    /// The mean angle by which the tube turns around its axis, in degrees.
    pub twist_degrees: f64,
    /// Segments, counted from 1, whose two sections pass through each other.
    pub crossing: Vec<usize>,
}

impl HandleReport {
    /// The report in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.halved > 0 {
            notes.push(format!("{} sides were halved, so that both faces have the same number", self.halved));
        }
        if !self.crossing.is_empty() {
            let shown: Vec<String> = self.crossing.iter().take(8).map(usize::to_string).collect();
            let more = if self.crossing.len() > 8 { ", …" } else { "" };
            notes.push(format!(
                "the handle crosses itself in segment {}{more}: it bends more sharply there than it is wide; take other weights or fewer segments ({})",
                shown.join(", "),
                OpFinding::HandleCrosses.code()
            ));
        }
        notes
    }
}

/// Makes a handle. Returns the mesh, what was made (the tube), and a report.
///
/// # Errors
/// [`OpError::CountOutOfRange`] for the segments; [`OpError::NoSuchElement`]; [`OpError::NoArea`]; [`OpError::NoHandle`] with the reason;
/// [`OpError::Cancelled`].
pub fn handle(
    mesh: &Mesh,
    params: &HandleParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, Made, HandleReport), OpError> {
    if !(1..=MOST_SEGMENTS).contains(&params.segments) {
        return Err(OpError::CountOutOfRange { what: "segments", count: params.segments, limit: MOST_SEGMENTS });
    }
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    let segments = params.segments as usize;
    let mut tube = Tube { ends: [find(mesh, params.from)?, find(mesh, params.to)?], mesh: mesh.clone() };
    let refuse = |reason| OpError::NoHandle { from: params.from.face, to: params.to.face, reason };
    let [f, g] = tube.ends.map(|h| mesh.face(h));
    if f == g {
        return Err(refuse("they are the same face; choose two"));
    }
    if segments == 1 && mesh.face_vertices(f).any(|v| mesh.face_vertices(g).any(|w| v == w)) {
        return Err(refuse(
            "they share a corner, so that a tube of one segment would be flat; use at least two segments",
        ));
    }
    let curve = Curve::between(mesh, [f, g], params.weights)?
        .ok_or_else(|| refuse("the axis has no length; give other weights"))?;
    let halved = tube.even_out().ok_or_else(|| refuse("one of them has all of its sides in common with the other"))?;
    let samples = curve.samples(segments);
    let first = Outline::of(&tube.loop_of(0), &samples[0]);
    let second = Outline::of(&tube.loop_of(1), &samples[segments]);
    if first.turn().signum() != second.turn().signum() {
        return Err(refuse(
            "the axis leaves one face outwards and reaches the other from inside; give weights of the same sign",
        ));
    }
    let (shift, second) = second.turned_to(&first, params.twist.radians(), params.to.vertex.is_none());
    tube.shift_end(shift);
    let sections: Vec<Vec<DVec3>> =
        (1..segments).map(|k| first.between(&second, k as f64 / segments as f64, &samples[k])).collect();
    let mut rings = vec![tube.loop_of(0)];
    rings.extend(sections.iter().cloned());
    rings.push(tube.loop_of(1));
    let crossing = curve::crossing_segments(&rings, &samples);
    let report = HandleReport { halved, twist_degrees: first.twist_to(&second).to_degrees(), crossing };
    let made = tube.build(&sections);
    Ok((tube.mesh, made, report))
}

/// The half-edge of a face at its wanted corner.
fn find(mesh: &Mesh, corner: FaceCorner) -> Result<HalfEdgeId, OpError> {
    let missing = |what: &'static str, id: u32| OpError::NoSuchElement { what, id: id as usize };
    let f = FaceId::new(corner.face as usize);
    let is_there = f.index() < mesh.face_slots() && mesh.has_face(f) && !mesh.is_hole(f);
    let start = is_there.then(|| mesh.face_start(f)).flatten().ok_or_else(|| missing("face", corner.face))?;
    match corner.vertex {
        None => Ok(start),
        Some(v) => {
            let at = |h: &HalfEdgeId| mesh.origin(*h) == VertexId::new(v as usize);
            mesh.face_half_edges(f).find(at).ok_or_else(|| missing("corner of the face at vertex", v))
        }
    }
}

/// The mesh under work, with the first corner of each end.
struct Tube {
    mesh: Mesh,
    ends: [HalfEdgeId; 2],
}

impl Tube {
    /// Halves the longest sides of the face with fewer until both have as many; a side that both share would give one to each. `None` when there
    /// is no other.
    fn even_out(&mut self) -> Option<usize> {
        let sides = self.ends.map(|h| self.mesh.sides(self.mesh.face(h)));
        let short = usize::from(sides[1] < sides[0]);
        let missing = sides[0].abs_diff(sides[1]);
        let other = self.mesh.face(self.ends[1 - short]);
        for _ in 0..missing {
            let f = self.mesh.face(self.ends[short]);
            let length = |h: HalfEdgeId| {
                let [a, b] = self.mesh.edge_positions(h.edge());
                a.distance_squared(b)
            };
            // Sides that differ by rounding only count as equal, and the first of them is taken.
            let own: Vec<HalfEdgeId> =
                self.mesh.face_half_edges(f).filter(|&h| self.mesh.face(h.twin()) != other).collect();
            let longest = own.iter().map(|&h| length(h)).fold(0.0, f64::max);
            let side = own.into_iter().find(|&h| length(h) >= longest * (1.0 - 1e-9))?;
            let corner = self.mesh.origin(self.ends[short]);
            self.mesh.subdivide_edge(side.edge());
            // The edge keeps its first half-edge; the corner's may be the new one.
            let at = |h: &HalfEdgeId| self.mesh.origin(*h) == corner;
            self.ends[short] = self.mesh.face_half_edges(f).find(at).expect("the corner is still there");
        }
        Some(missing)
    }

    /// The corners of an end in the order of the tube: around the first face as it runs, around the second the other way.
    fn corners(&self, end: usize) -> Vec<HalfEdgeId> {
        let start = self.ends[end];
        let step = |&h: &HalfEdgeId| Some(if end == 0 { self.mesh.next(h) } else { self.mesh.prev(h) });
        std::iter::successors(Some(start), step).take(self.mesh.sides(self.mesh.face(start))).collect()
    }

    fn loop_of(&self, end: usize) -> Vec<DVec3> {
        self.corners(end).into_iter().map(|h| self.mesh.position(self.mesh.origin(h))).collect()
    }

    fn shift_end(&mut self, shift: usize) {
        self.ends[1] = self.corners(1)[shift];
    }

    /// Joins the ends through the sections, one pipe after the other.
    fn build(&mut self, sections: &[Vec<DVec3>]) -> Made {
        let mesh = &mut self.mesh;
        let ends = self.ends.map(|h| mesh.face(h));
        let carried: Vec<_> = mesh
            .faces()
            .filter(|f| !ends.contains(f))
            .filter_map(|f| mesh.carried_plane(f).map(|plane| (f, plane)))
            .collect();
        // New faces are made like the one that they are cut off, plane included; those of a tube have planes of their own.
        mesh.clear_planes();
        let mut made = Made::default();
        let mut from = self.ends[0];
        for section in sections {
            let (front, back) = mesh.create_face_manifold(section).expect("faces have at least three sides");
            let corners: Vec<HalfEdgeId> = mesh.face_half_edges(front).collect();
            let start = (0..corners.len())
                .find(|&i| {
                    (0..section.len())
                        .all(|j| mesh.position(mesh.origin(corners[(i + j) % corners.len()])) == section[j])
                })
                .expect("the section was made of these points");
            let vertex = mesh.origin(corners[start]);
            let to =
                mesh.face_half_edges(back).find(|&h| mesh.origin(h) == vertex).expect("front and back share corners");
            for &corner in &corners {
                made.vertices.push(mesh.origin(corner));
                mesh.set_position(mesh.origin(corner), mesh.position(mesh.origin(corner)), false);
            }
            made.faces.extend(mesh.create_pipe(from, to).expect("a section is a face of its own"));
            from = corners[start];
        }
        made.faces.extend(mesh.create_pipe(from, self.ends[1]).expect("the ends differ"));
        carried.into_iter().for_each(|(f, plane)| mesh.set_plane(f, plane));
        made.faces.sort_unstable();
        made.vertices.sort_unstable();
        made
    }
}
