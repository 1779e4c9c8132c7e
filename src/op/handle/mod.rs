//! Handles: a curved tube of several segments between two faces (Srinivasan 2004, IV).
//!
//! The axis is the Hermite curve through the centroids that leaves the first face along its normal
//! and reaches the second against its normal, each weighed by a length. The two outlines are taken
//! as polar coordinates (distance and angle that goes on around) across the ends of the curve, in a
//! frame that is carried along it without turning, and interpolated; so faces that are opposite,
//! parallel or on one line are no special case. Negative weights lead the curve inwards: a hole
//! instead of a handle. Without weights the distance of the centroids is taken, or up to sixteen
//! times as much: the least of some steps at which no section crosses the next. Instead of weights,
//! points can be given that the axis runs through (centripetal Catmull-Rom spline; its ends keep to
//! the normals), with segments of one length. Among three or more faces, see `hub`.
//!
//! Between faces of n sides with s segments:
//!
//! ```text
//!   vertices  V + n(s−1)    edges  E + n(2s−1)    faces  F + ns − 2    genus + 1, or two components become one
//! ```
//!
//! Of faces with different numbers of sides the one with fewer has its longest sides halved first:
//! V + 1, E + 1 for each. Needs: two faces with an area. Keeps: ids, groups and planes of all other
//! faces; the tube has the group of the first face. Planarity: quads are planar by luck. Degenerate
//! cases, all errors that say why: one segment between faces that share a corner would be flat;
//! weights of different signs would turn the tube inside out; a curve without length. Neighbouring
//! sections that pass through each other are reported with their segment.

mod curve;
mod hub;
mod outline;
mod params;

#[cfg(test)]
mod tests;

use glam::DVec3;

use super::report::{crossing_note, crossing_pairs, first_few};
use super::simple::{Mended, keep_simple};
use super::size::{ask, check_size};
use super::{OpContext, OpError, OpFinding};
use crate::code::Coded;
use crate::measure::CrossingPair;
use crate::mesh::{FaceId, FaceMap, HalfEdgeId, Mesh, VertexId};
use crate::progress::Progress;
use crate::select::NewElements;

pub use params::{FaceCorner, HandleAxis, HandleParams, Weights};

use curve::Curve;
use outline::Outline;

/// Default weights that are tried, in distances of the centroids.
const DEFAULT_WEIGHTS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0];
/// More sections than anybody can tell apart.
const MOST_SEGMENTS: u32 = 10_000;

/// What a handle came out as.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HandleReport {
    /// What was made: the tube.
    pub made: NewElements,
    /// How many sides of the face with fewer were halved.
    pub halved: usize,
    /// The mean angle by which the tube turns around its axis, in degrees.
    pub twist_degrees: f64,
    /// The default weights that were taken, in mm, where the distance of the centroids would have
    /// made the handle cross itself.
    pub lengthened: Option<f64>,
    /// Segments, counted from 1, whose two sections pass through each other; with a hub, of any of
    /// its tubes.
    pub crossing: Vec<usize>,
    /// Faces that go through each other, one of them of the tube; a thousand pairs at most.
    pub pairs: Vec<CrossingPair>,
    /// What had to be mended so that files can hold the result.
    pub mended: Mended,
}

impl HandleReport {
    /// The report in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.halved > 0 {
            notes.push(format!(
                "{} sides were halved, so that both faces have the same number",
                self.halved
            ));
        }
        if let Some(mm) = self.lengthened {
            notes.push(format!(
                "weights of {mm:.4} mm were taken, since with the distance of the faces it would \
                cross itself"
            ));
        }
        if !self.crossing.is_empty() {
            notes.push(format!(
                "the handle crosses itself in segment {}: it bends more sharply there than it is \
                wide; take other weights or fewer segments ({})",
                first_few(&self.crossing, 8),
                OpFinding::HandleCrosses.code()
            ));
        }
        notes.extend(crossing_note(&self.pairs, OpFinding::HandleCrosses.code()));
        notes.extend(self.mended.notes());
        notes
    }
}

/// Makes a handle.
///
/// # Errors
/// [`OpError::CountOutOfRange`] for the segments; [`OpError::NoSuchElement`]; [`OpError::NoArea`];
/// [`OpError::NoHandle`] with the reason; [`OpError::Exclude`] for an axis with weights or further
/// faces; [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use kerfold::op::FaceCorner;
///
/// // From one face of a cube to its neighbour.
/// let cube = kerfold::shape::cube(10.0);
/// let at = |face| FaceCorner { face, vertex: None };
/// let params = HandleParams {
///     from: at(0),
///     to: at(1),
///     segments: 8,
///     also: Vec::new(),
///     axis: None,
///     weights: None,
///     twist: Default::default(),
/// };
/// let (ring, _) = handle(&cube, &params, &OpContext::default())?;
/// assert_eq!(kerfold::measure::genus(&ring), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn handle(
    mesh: &Mesh,
    params: &HandleParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, HandleReport), OpError> {
    if !(1..=MOST_SEGMENTS).contains(&params.segments) {
        return Err(OpError::CountOutOfRange {
            what: "segments",
            count: params.segments,
            limit: MOST_SEGMENTS,
        });
    }
    let course = match (&params.axis, params.weights) {
        (Some(_), Some(_)) => return Err(OpError::Exclude { first: "an axis", second: "weights" }),
        (Some(_), None) if !params.also.is_empty() => {
            return Err(OpError::Exclude { first: "an axis", second: "further faces" });
        }
        (Some(HandleAxis::File(_)), None) => {
            let reason = "the axis is still the name of a file; read the file and give its points";
            return Err(OpError::NoHandle { from: params.from.face, to: params.to.face, reason });
        }
        (Some(HandleAxis::Points(points)), None) => Course::Through(points),
        (None, Some(weights)) => Course::Weighed(weights.0.map(crate::units::Length::mm)),
        (None, None) => Course::Free { sign: 1.0 },
    };
    let faces = 2 + params.also.len();
    let sides = mesh.faces().map(|f| mesh.sides(f)).max().unwrap_or(0);
    let ring = (2 * faces * sides) as f64;
    let edges = |segments: u32| mesh.edge_count() as f64 + ring * f64::from(segments);
    check_size("segments", params.segments, edges)?;
    if !params.also.is_empty() {
        let (made_mesh, report) = hub::hub(mesh, params, context)?;
        return finish(mesh, made_mesh, report, context.progress);
    }
    let tube = Join {
        from: params.from,
        to: params.to,
        segments: params.segments,
        twist: params.twist.radians(),
        course,
    };
    let (made_mesh, report) = join(mesh, &tube, context)?;
    finish(mesh, made_mesh, report, context.progress)
}

/// Makes the result one that files can hold, and finds where the tube goes through something.
fn finish(
    before: &Mesh,
    mut made_mesh: Mesh,
    mut report: HandleReport,
    progress: &dyn Progress,
) -> Result<(Mesh, HandleReport), OpError> {
    let advice = "take more segments, or other faces";
    report.mended = keep_simple(before, &mut made_mesh, &mut report.made, advice)?;
    let mut is_new = FaceMap::filled(made_mesh.face_slots(), false);
    report.made.faces.iter().for_each(|&f| is_new[f] = true);
    report.pairs = crossing_pairs(&made_mesh, progress)?;
    report.pairs.retain(|pair| is_new[pair.first] || is_new[pair.second]);
    Ok((made_mesh, report))
}

/// Where the axis of a tube runs.
#[derive(Debug, Clone, Copy)]
enum Course<'a> {
    /// With these weights, in mm.
    Weighed([f64; 2]),
    /// With default weights, outwards or inwards.
    Free { sign: f64 },
    /// Through these points.
    Through(&'a [DVec3]),
}

/// One tube between two faces.
struct Join<'a> {
    from: FaceCorner,
    to: FaceCorner,
    segments: u32,
    twist: f64,
    course: Course<'a>,
}

/// The sections of a tube, ready to be built.
struct Plan {
    shift: usize,
    sections: Vec<Vec<DVec3>>,
    crossing: Vec<usize>,
    twist: f64,
}

fn join(
    mesh: &Mesh,
    params: &Join<'_>,
    context: &OpContext<'_>,
) -> Result<(Mesh, HandleReport), OpError> {
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    let mut tube =
        Tube { ends: [find(mesh, params.from)?, find(mesh, params.to)?], mesh: mesh.clone() };
    let refuse = |reason| OpError::NoHandle { from: params.from.face, to: params.to.face, reason };
    let [f, g] = tube.ends.map(|h| mesh.face(h));
    if f == g {
        return Err(refuse("they are the same face; choose two"));
    }
    if params.segments == 1 && mesh.face_vertices(f).any(|v| mesh.face_vertices(g).any(|w| v == w))
    {
        return Err(refuse(
            "they share a corner, so that a tube of one segment would be flat; use at least two \
            segments",
        ));
    }
    let halved = tube
        .even_out()
        .ok_or_else(|| refuse("one of them has all of its sides in common with the other"))?;
    let mut report = HandleReport { halved, ..HandleReport::default() };
    let no_length = "the axis has no length; give other weights or points";
    let plan = match params.course {
        Course::Weighed(weights) => {
            let curve = Curve::between(mesh, [f, g], weights)?.ok_or_else(|| refuse(no_length))?;
            tube.plan(&curve, params)?
        }
        Course::Through(points) => {
            let curve = Curve::through(mesh, [f, g], points)?.ok_or_else(|| refuse(no_length))?;
            tube.plan(&curve, params)?
        }
        Course::Free { sign } => {
            let distance = curve::distance(mesh, [f, g]);
            let mut plans = Vec::with_capacity(1);
            let mut taken = 0;
            for (i, share) in DEFAULT_WEIGHTS.iter().enumerate() {
                let curve = Curve::between(mesh, [f, g], [sign * share * distance; 2])?;
                let plan = tube.plan(&curve.ok_or_else(|| refuse(no_length))?, params)?;
                let is_clean = plan.crossing.is_empty();
                plans.push(plan);
                if is_clean {
                    taken = i;
                    break;
                }
            }
            report.lengthened = (taken > 0).then(|| sign * DEFAULT_WEIGHTS[taken] * distance);
            plans.swap_remove(taken)
        }
    };
    (report.twist_degrees, report.crossing) = (plan.twist.to_degrees(), plan.crossing);
    tube.shift_end(plan.shift);
    if params.segments <= 2 && tube.returns_to_a_corner() {
        return Err(refuse(
            "they share a corner, to which a tube of two segments would lead out and back on the \
            same line; use at least three segments",
        ));
    }
    report.made = tube.build(&plan.sections, context.progress)?;
    Ok((tube.mesh, report))
}

/// The half-edge of a face at its wanted corner.
fn find(mesh: &Mesh, corner: FaceCorner) -> Result<HalfEdgeId, OpError> {
    let missing = |what: &'static str, id: u32| OpError::NoSuchElement { what, id: id as usize };
    let f = FaceId::new(corner.face as usize);
    let is_there = f.index() < mesh.face_slots() && mesh.has_face(f) && !mesh.is_hole(f);
    let start = is_there
        .then(|| mesh.face_start(f))
        .flatten()
        .ok_or_else(|| missing("face", corner.face))?;
    match corner.vertex {
        None => Ok(start),
        Some(v) => {
            let at = |h: &HalfEdgeId| mesh.origin(*h) == VertexId::new(v as usize);
            mesh.face_half_edges(f)
                .find(at)
                .ok_or_else(|| missing("corner of the face at vertex", v))
        }
    }
}

/// The mesh under work, with the first corner of each end.
struct Tube {
    mesh: Mesh,
    ends: [HalfEdgeId; 2],
}

impl Tube {
    /// The sections along a curve.
    fn plan(&self, curve: &Curve, params: &Join<'_>) -> Result<Plan, OpError> {
        let segments = params.segments as usize;
        let samples = curve.samples(segments);
        let first = Outline::of(&self.loop_of(0), &samples[0]);
        let second = Outline::of(&self.loop_of(1), &samples[segments]);
        if first.turn().signum() != second.turn().signum() {
            let reason = "the axis leaves one face outwards and reaches the other from inside; \
            give weights of the same sign, or other points";
            return Err(OpError::NoHandle { from: params.from.face, to: params.to.face, reason });
        }
        let (shift, second) = second.turned_to(&first, params.twist, params.to.vertex.is_none());
        let sections: Vec<Vec<DVec3>> = (1..segments)
            .map(|k| first.between(&second, k as f64 / segments as f64, &samples[k]))
            .collect();
        let mut end = self.loop_of(1);
        end.rotate_left(shift);
        let mut rings = vec![self.loop_of(0)];
        rings.extend(sections.iter().cloned());
        rings.push(end);
        let crossing = curve::crossing_segments(&rings, &samples);
        Ok(Plan { shift, sections, crossing, twist: first.twist_to(&second) })
    }

    /// Halves the longest sides of the face with fewer until both have as many; a side that both
    /// share would give one to each. `None` when there is no other.
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
            let own: Vec<HalfEdgeId> = self
                .mesh
                .face_half_edges(f)
                .filter(|&h| self.mesh.face(h.twin()) != other)
                .collect();
            let longest = own.iter().map(|&h| length(h)).fold(0.0, f64::max);
            let side = own.into_iter().find(|&h| length(h) >= longest * (1.0 - 1e-9))?;
            let corner = self.mesh.origin(self.ends[short]);
            self.mesh.subdivide_edge(side.edge());
            // The edge keeps its first half-edge; the corner's may be the new one.
            let at = |h: &HalfEdgeId| self.mesh.origin(*h) == corner;
            self.ends[short] =
                self.mesh.face_half_edges(f).find(at).expect("the corner is still there");
        }
        Some(missing)
    }

    /// The corners of an end in the order of the tube: around the first face as it runs, around the
    /// second the other way.
    fn corners(&self, end: usize) -> Vec<HalfEdgeId> {
        let start = self.ends[end];
        let step =
            |&h: &HalfEdgeId| Some(if end == 0 { self.mesh.next(h) } else { self.mesh.prev(h) });
        std::iter::successors(Some(start), step)
            .take(self.mesh.sides(self.mesh.face(start)))
            .collect()
    }

    /// Whether a corner of the tube's beginning is the corner of its end that it leads to.
    fn returns_to_a_corner(&self) -> bool {
        let origins = |end: usize| self.corners(end).into_iter().map(|h| self.mesh.origin(h));
        origins(0).zip(origins(1)).any(|(from, to)| from == to)
    }

    fn loop_of(&self, end: usize) -> Vec<DVec3> {
        self.corners(end).into_iter().map(|h| self.mesh.position(self.mesh.origin(h))).collect()
    }

    fn shift_end(&mut self, shift: usize) {
        self.ends[1] = self.corners(1)[shift];
    }

    /// Joins the ends through the sections, one pipe after the other.
    fn build(
        &mut self,
        sections: &[Vec<DVec3>],
        progress: &dyn Progress,
    ) -> Result<NewElements, OpError> {
        let mesh = &mut self.mesh;
        let ends = self.ends.map(|h| mesh.face(h));
        let carried: Vec<_> = mesh
            .faces()
            .filter(|f| !ends.contains(f))
            .filter_map(|f| mesh.carried_plane(f).map(|plane| (f, plane)))
            .collect();
        // New faces are made like the one that they are cut off, plane included; those of a tube
        // have planes of their own.
        mesh.clear_planes();
        let mut made = NewElements::default();
        let mut from = self.ends[0];
        for (turn, section) in sections.iter().enumerate() {
            ask(progress, turn)?;
            let (front, back) =
                mesh.create_face_manifold(section).expect("faces have at least three sides");
            let corners: Vec<HalfEdgeId> = mesh.face_half_edges(front).collect();
            let start = (0..corners.len())
                .find(|&i| {
                    (0..section.len()).all(|j| {
                        mesh.position(mesh.origin(corners[(i + j) % corners.len()])) == section[j]
                    })
                })
                .expect("the section was made of these points");
            let vertex = mesh.origin(corners[start]);
            let to = mesh
                .face_half_edges(back)
                .find(|&h| mesh.origin(h) == vertex)
                .expect("front and back share corners");
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
        Ok(made)
    }
}
