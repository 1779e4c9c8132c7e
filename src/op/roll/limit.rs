//! What limits a roll: edges and faces of which something must stay, from their lengths alone.
//!
//! A line of touch leaves the edge's end and meets the next edges of both faces; what lies before
//! is taken. With σ the direction of such an edge, away from the end, the stretch taken is t / (σ ·
//! into − slope · (σ · along)), t the distance of the touch at that end. Rolls whose stretches leave
//! something of every edge do not meet: the parts that planes take off a convex corner are convex,
//! and disjoint wherever they are disjoint on the surface.

use glam::DVec3;

use super::ridge::Ridge;
use crate::geom::Plane;
use crate::measure::edge_length;
use crate::mesh::{EdgeMap, FaceId, HalfEdgeId, Mesh};
use crate::op::rolled::Place;

/// Planes that stand for the whole roll where an edge leaves a corner between others.
const SAMPLES: u32 = 63;

/// A place with the share of it that each ridge takes; all taken at 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Limit {
    pub place: Place,
    /// The number of a ridge, and its share.
    pub taken: Vec<(usize, f64)>,
}

impl Limit {
    /// How much of the place is taken.
    pub fn filled(&self) -> f64 {
        self.taken.iter().map(|t| t.1).sum()
    }
}

/// All limits of ridges with these radii at their ends, those of edges first, by number.
pub(super) fn limits(mesh: &Mesh, ridges: &[Ridge], radii: &[[f64; 2]]) -> Vec<Limit> {
    let mut of_edge: EdgeMap<Vec<(usize, f64)>> = EdgeMap::filled(mesh.edge_slots(), Vec::new());
    let mut of_faces = Vec::new();
    for (i, ridge) in ridges.iter().enumerate() {
        let reach = Reached::new(mesh, ridge, radii[i]);
        for end in [0, 1] {
            for h in reach.leaving(end) {
                let e = h.edge();
                of_edge[e].push((i, reach.stretch(h, end) / edge_length(mesh, e)));
            }
        }
        of_faces.extend(
            reach
                .corners()
                .map(|(f, taken)| Limit { place: Place::Face(f), taken: vec![(i, taken)] }),
        );
    }
    let of_edges = mesh.edges().filter(|&e| !of_edge[e].is_empty());
    let limit = |e| Limit { place: Place::Edge(e), taken: of_edge[e].clone() };
    of_edges.map(limit).chain(of_faces).collect()
}

/// The limit that is filled most; the first of equals.
pub(super) fn tightest(limits: &[Limit]) -> Option<&Limit> {
    limits.iter().rev().max_by(|a, b| a.filled().total_cmp(&b.filled()))
}

/// What the planes of a ridge reach.
struct Reached<'a> {
    mesh: &'a Mesh,
    ridge: &'a Ridge,
    /// How far from the edge the faces are touched, at both ends.
    touch: [f64; 2],
    slope: f64,
    planes: Vec<Plane>,
}

impl<'a> Reached<'a> {
    fn new(mesh: &'a Mesh, ridge: &'a Ridge, radii: [f64; 2]) -> Self {
        let is_simple = ridge.ends.iter().all(|&v| mesh.valence(v) == 3);
        let planes =
            if is_simple { Vec::new() } else { ridge.planes(radii, SAMPLES).unwrap_or_default() };
        let touch = radii.map(|r| r * ridge.touch());
        Self { mesh, ridge, touch, slope: ridge.slope(radii), planes }
    }

    /// The edges that leave an end, but for the ridge itself.
    fn leaving(&self, end: usize) -> impl Iterator<Item = HalfEdgeId> + '_ {
        self.mesh.outgoing(self.ridge.ends[end]).filter(|h| h.edge() != self.ridge.edge)
    }

    fn direction(&self, h: HalfEdgeId) -> DVec3 {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.mesh.position(v));
        (b - a).normalize_or_zero()
    }

    /// The length that the planes take of an edge that leaves an end; infinite where they never
    /// leave it.
    fn stretch(&self, h: HalfEdgeId, end: usize) -> f64 {
        let direction = self.direction(h);
        let beside = [h, h.twin()].map(|side| self.mesh.face(side));
        let face = (0..2).find(|&i| beside.contains(&self.ridge.faces[i]));
        let along_face = face.map(|i| {
            let leaves =
                direction.dot(self.ridge.into[i]) - self.slope * direction.dot(self.ridge.along);
            quotient(self.touch[end], leaves)
        });
        let from = self.mesh.position(self.ridge.ends[end]);
        let by_planes = self
            .planes
            .iter()
            .map(|plane| quotient(plane.signed_distance(from), -plane.normal().dot(direction)));
        along_face.into_iter().chain(by_planes).fold(0.0, f64::max)
    }

    /// The corners of faces that the planes may come near, but for those on the edges that leave
    /// the ends, with the share of the way to them that is taken. On a convex face the edges are
    /// always tighter.
    fn corners(&self) -> impl Iterator<Item = (FaceId, f64)> + '_ {
        let beside = (0..2).flat_map(|i| self.corners_beside(i));
        let behind = (0..2).flat_map(|end| self.corners_behind(end));
        beside.chain(behind).filter(|taken| taken.1 > 0.0)
    }

    /// In a face beside the ridge: the corners above the ridge, between the edges at its ends.
    fn corners_beside(&self, i: usize) -> Vec<(FaceId, f64)> {
        let ridge = self.ridge;
        let face = ridge.faces[i];
        // How far the face's edge at an end leans outwards, for each mm into the face.
        let lean = |end: usize| {
            let h = self
                .leaving(end)
                .find(|&h| self.mesh.face(h) == face || self.mesh.face(h.twin()) == face)?;
            let direction = self.direction(h);
            Some(direction.dot(ridge.along) / direction.dot(ridge.into[i]))
        };
        let [Some(first), Some(last)] = [lean(0), lean(1)] else { return Vec::new() };
        let taken = |x: DVec3| {
            let (up, at) =
                ((x - ridge.start).dot(ridge.into[i]), (x - ridge.start).dot(ridge.along));
            let is_above = at >= first * up && at <= ridge.length + last * up;
            (up > 0.0 && is_above).then(|| (self.touch[0] + self.slope * at) / up)
        };
        self.others(face).filter_map(|x| Some((face, taken(x)?))).collect()
    }

    /// In a face that the ridge ends on: the corners inside the triangle that is taken off.
    fn corners_behind(&self, end: usize) -> Vec<(FaceId, f64)> {
        let v = self.ridge.ends[end];
        let at = self.mesh.position(v);
        let mut found = Vec::new();
        for h in self.leaving(end) {
            let face = self.mesh.face(h);
            if self.ridge.faces.contains(&face) {
                continue;
            }
            let before = self.mesh.prev(h).twin();
            let [one, other] = [h, before].map(|side| self.direction(side));
            let taken = [h, before].map(|side| self.stretch(side, end));
            let [a, b, c] = [one.dot(one), one.dot(other), other.dot(other)];
            let share = |x: DVec3| {
                let [p, q] = [(x - at).dot(one), (x - at).dot(other)];
                let size = a * c - b * b;
                let [s, t] = [(p * c - q * b) / size, (q * a - p * b) / size];
                (s > 0.0 && t > 0.0).then(|| (s / taken[0] + t / taken[1]).recip())
            };
            found.extend(self.others(face).filter_map(|x| Some((face, share(x)?))));
        }
        found
    }

    /// The corners of a face, without the ends of the ridge and what they are joined with.
    fn others(&self, face: FaceId) -> impl Iterator<Item = DVec3> + '_ {
        let near: Vec<_> = (0..2)
            .flat_map(|end| self.leaving(end).map(|h| self.mesh.target(h)))
            .chain(self.ridge.ends)
            .collect();
        let corners = self.mesh.face_vertices(face).filter(move |v| !near.contains(v));
        corners.map(|v| self.mesh.position(v))
    }
}

/// The quotient of lengths, infinite where the divisor is none.
fn quotient(length: f64, by: f64) -> f64 {
    if by > 0.0 { (length / by).max(0.0) } else { f64::INFINITY }
}
