//! A face laid flat, and polygons with its sides moved inwards.

use glam::{DVec2, DVec3};

use super::error::PanelError;
use crate::geom::Frame;
use crate::mesh::{FaceId, HalfEdgeId, Mesh};

/// Sines of turns below this are straight corners: sides moved by different insets would meet
/// nowhere near.
const STRAIGHT: f64 = 1e-7;

/// A face in the frame of its plate.
pub(super) struct FlatFace {
    pub face: FaceId,
    /// On the face's plane (not yet on the front); x along the longest side.
    pub frame: Frame,
    pub half_edges: Vec<HalfEdgeId>,
    /// Where the vertices lie.
    pub corners: Vec<DVec2>,
    /// Unit direction of each side.
    pub along: Vec<DVec2>,
}

impl FlatFace {
    pub fn new(mesh: &Mesh, f: FaceId) -> Result<Self, PanelError> {
        let plane = mesh.plane(f).ok_or(PanelError::NoPlane { face: f })?;
        let half_edges: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
        let ends = |h: HalfEdgeId| mesh.position(mesh.target(h)) - mesh.position(mesh.origin(h));
        let longest = half_edges.iter().map(|&h| ends(h)).reduce(longer).unwrap_or(DVec3::X);
        // Near the face, so that far from the origin no digits are lost.
        let origin = plane
            .project(half_edges.first().map_or(plane.point(), |&h| mesh.position(mesh.origin(h))));
        let frame =
            Frame::along(origin, longest, plane.normal()).ok_or(PanelError::NoPlane { face: f })?;
        let corners: Vec<DVec2> =
            half_edges.iter().map(|&h| frame.flatten(mesh.position(mesh.origin(h)))).collect();
        let n = corners.len();
        let along: Vec<DVec2> =
            (0..n).map(|i| (corners[(i + 1) % n] - corners[i]).normalize_or_zero()).collect();
        if along.contains(&DVec2::ZERO) {
            return Err(PanelError::NoPlane { face: f });
        }
        Ok(Self { face: f, frame, half_edges, corners, along })
    }

    pub fn len(&self) -> usize {
        self.corners.len()
    }

    pub fn before(&self, i: usize) -> usize {
        (i + self.len() - 1) % self.len()
    }

    /// The length of a side on the mesh.
    pub fn length(&self, i: usize) -> f64 {
        self.corners[i].distance(self.corners[(i + 1) % self.len()])
    }

    /// Where corner `i` goes when the side before it is moved inwards by `before` and the side
    /// after it by `after`; at a straight corner by their mean. `None` where the corner turns back
    /// on itself.
    pub fn corner(&self, i: usize, before: f64, after: f64) -> Option<DVec2> {
        let (u, v) = (self.along[self.before(i)], self.along[i]);
        let open = 1.0 + u.dot(v);
        if open <= f64::EPSILON {
            return None;
        }
        // Split into what both sides do alike and what they do differently: only the latter gets
        // large at flat corners.
        let (alike, differently) = (before.midpoint(after), (before - after) / 2.0);
        let common = (u.perp() + v.perp()) * (alike / open);
        let apart =
            if self.is_straight(i) { DVec2::ZERO } else { (u + v) * (differently / self.turn(i)) };
        Some(self.corners[i] + common + apart)
    }

    /// The sine of the turn at a corner, positive where it is convex.
    fn turn(&self, i: usize) -> f64 {
        self.along[self.before(i)].perp_dot(self.along[i])
    }

    /// Whether the two sides of a corner lie in a line.
    pub fn is_straight(&self, i: usize) -> bool {
        self.turn(i).abs() < STRAIGHT
    }

    /// Whether a corner is convex.
    pub fn is_convex(&self, i: usize) -> bool {
        self.turn(i) > 0.0
    }

    /// The inward unit bisector of a corner.
    pub fn bisector(&self, i: usize) -> DVec2 {
        (self.along[self.before(i)].perp() + self.along[i].perp()).normalize_or_zero()
    }

    /// The polygon whose side `i` is moved inwards by `insets[i]`. A corner that turns back on
    /// itself, which was refused before, stays where it is.
    pub fn moved(&self, insets: &[f64]) -> Vec<DVec2> {
        let corner = |i: usize| self.corner(i, insets[self.before(i)], insets[i]);
        (0..self.len()).map(|i| corner(i).unwrap_or(self.corners[i])).collect()
    }

    /// The point at a distance along side `i` from its first vertex, moved inwards.
    pub fn at(&self, i: usize, distance: f64, inset: f64) -> DVec2 {
        self.corners[i] + self.along[i] * distance + self.along[i].perp() * inset
    }

    /// Refuses corners that turn back on themselves.
    pub fn check(&self, mesh: &Mesh) -> Result<(), PanelError> {
        match (0..self.len()).find(|&i| self.corner(i, 0.0, 0.0).is_none()) {
            Some(i) => {
                Err(PanelError::Spike { face: self.face, vertex: mesh.origin(self.half_edges[i]) })
            }
            None => Ok(()),
        }
    }
}

/// The longer of two vectors; of equal ones, up to rounding, the first.
fn longer(a: DVec3, b: DVec3) -> DVec3 {
    if b.length() > a.length() * (1.0 + 1e-9) { b } else { a }
}
