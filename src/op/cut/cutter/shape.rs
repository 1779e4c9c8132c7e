//! Which faces are convex, and the planes that faces carry.

use super::Cutter;
use crate::geom::Plane;
use crate::mesh::{FaceId, HalfEdgeId};

/// A face about whose shape nothing is known; zero, so that a new table costs nothing.
const UNKNOWN: u8 = 0;
/// A face that every line meets in one piece.
const CONVEX: u8 = 1;
/// Any other face.
const OTHER: u8 = 2;

impl Cutter {
    /// Whether every line meets the face in one piece. Asked once for each face; a cut leaves
    /// convex faces convex.
    #[inline]
    pub(in crate::op::cut) fn is_convex(&mut self, f: FaceId) -> bool {
        if self.shapes[f.index()] == UNKNOWN {
            self.shapes[f.index()] = if self.finds_convex(f) { CONVEX } else { OTHER };
        }
        self.shapes[f.index()] == CONVEX
    }

    /// A part of a face that was divided or merged: only convexity lasts.
    pub(in crate::op::cut) fn forget_shape_unless_convex(&mut self, f: FaceId) {
        if self.shapes[f.index()] != CONVEX {
            self.shapes[f.index()] = UNKNOWN;
        }
    }

    fn finds_convex(&mut self, f: FaceId) -> bool {
        let Some(first) = self.mesh.face_start(f).filter(|_| !self.mesh.is_hole(f)) else {
            return false;
        };
        let (second, third) = (self.mesh.next(first), self.mesh.next(self.mesh.next(first)));
        if self.mesh.next(third) == first {
            let [a, b, c] = [first, second, third].map(|h| self.mesh.origin(h));
            return a != b && b != c && c != a;
        }
        self.ensure_plane(f);
        let Some(normal) = self.mesh.carried_plane(f).map(|p| p.normal()) else { return false };
        let corner = |h: HalfEdgeId| self.mesh.position(self.mesh.origin(h));
        let origin = corner(first);
        let mut h = second;
        // It turns left everywhere, and it does so once: seen from its first corner it never turns
        // back.
        while h != first {
            let (before, here, after) =
                (corner(self.mesh.prev(h)), corner(h), corner(self.mesh.next(h)));
            let turns_left = normal.dot((here - before).cross(after - here)) >= 0.0;
            if !turns_left || normal.dot((here - origin).cross(after - origin)) < 0.0 {
                return false;
            }
            h = self.mesh.next(h);
        }
        let before = corner(self.mesh.prev(first));
        normal.dot((origin - before).cross(corner(second) - origin)) >= 0.0
    }

    /// Lets a face carry its plane from the first cut on, so that it cannot drift. Faces that are
    /// not planar carry none.
    pub(in crate::op::cut) fn ensure_plane(&mut self, f: FaceId) {
        if self.mesh.carried_plane(f).is_some() || self.mesh.is_hole(f) {
            return;
        }
        let corners = self.mesh.face_positions(f);
        if let Some(plane) = Plane::newell(&corners)
            && corners.iter().all(|&p| plane.signed_distance(p).abs() <= self.bound)
        {
            self.mesh.set_plane(f, plane);
        }
    }
}
