//! On which side of the plane of a cut vertices lie.

use glam::DVec3;

use super::{Cutter, SlicingPlane};
use crate::geom::Side;
use crate::geom::predicate::side_of_plane;
use crate::mesh::VertexId;

/// The number of a cut and a side in one word. Zero stands for "not asked yet", so that a new table
/// costs nothing until it is used; the same holds for the other tables of the workspace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StampedSide(pub(super) u32);

impl StampedSide {
    pub(super) fn new(cut: u32, side: Side) -> Self {
        let code = match side {
            Side::On => 0,
            Side::Normal => 1,
            Side::Reverse => 2,
        };
        Self(cut << 2 | code)
    }

    pub(super) fn of_cut(self, cut: u32) -> Option<Side> {
        (self.0 >> 2 == cut).then_some(match self.0 & 3 {
            0 => Side::On,
            1 => Side::Normal,
            _ => Side::Reverse,
        })
    }
}

impl Cutter {
    /// On which side of the plane a vertex lies. Exact for given numbers; constructed ones within
    /// the bound are on it.
    pub(in crate::op::cut) fn side(&mut self, plane: &SlicingPlane, v: VertexId) -> Side {
        if let Some(side) = StampedSide(self.sides[v.index()]).of_cut(self.cut) {
            return side;
        }
        let side = self.classify(plane, v);
        self.sides[v.index()] = StampedSide::new(self.cut, side).0;
        side
    }

    pub(in crate::op::cut) fn classify(&mut self, plane: &SlicingPlane, v: VertexId) -> Side {
        self.side_unless_set(v, |cutter| cutter.classify_by_numbers(plane, v))
    }

    /// The side of a vertex for a constructed plane at a known distance.
    pub(in crate::op::cut) fn side_at(&mut self, v: VertexId, distance: f64) -> Side {
        self.side_unless_set(v, |cutter| cutter.constructed_side(distance))
    }

    #[cfg(test)]
    fn side_unless_set(&mut self, v: VertexId, find: impl FnOnce(&Self) -> Side) -> Side {
        self.classified += 1;
        self.pattern.get(v.index()).copied().unwrap_or_else(|| find(self))
    }

    #[cfg(not(test))]
    #[inline]
    fn side_unless_set(&mut self, _: VertexId, find: impl FnOnce(&Self) -> Side) -> Side {
        find(self)
    }

    #[inline]
    fn constructed_side(&self, distance: f64) -> Side {
        if distance.abs() <= self.bound { Side::On } else { Side::of(distance) }
    }

    fn classify_by_numbers(&self, plane: &SlicingPlane, v: VertexId) -> Side {
        let x = self.mesh.position(v);
        let distance = plane.plane.signed_distance(x);
        match plane.given {
            Some((normal, point)) if self.mesh.is_given(v) => {
                if distance.abs() <= indistinct(x, point) {
                    Side::On
                } else {
                    side_of_plane(normal, point, x)
                }
            }
            _ => self.constructed_side(distance),
        }
    }

    /// Finds the side of every vertex, with no more than a distance for those that are clearly off
    /// the plane. Returns the vertices in front and those on the plane, ascending.
    pub(in crate::op::cut) fn sweep_vertices(
        &mut self,
        plane: &SlicingPlane,
    ) -> (Vec<VertexId>, Vec<VertexId>) {
        let clear = self.bound + indistinct(DVec3::splat(self.largest), plane.plane.point());
        let is_by_numbers = self.goes_by_numbers();
        let (mut in_front, mut on) = (Vec::new(), Vec::new());
        for v in (0..self.mesh.vertex_slots()).map(VertexId::new) {
            if !self.mesh.has_vertex(v) {
                continue;
            }
            let distance = plane.plane.signed_distance(self.mesh.position(v));
            let is_clear = is_by_numbers && distance.abs() > clear;
            let side = if is_clear { Side::of(distance) } else { self.classify(plane, v) };
            self.sides[v.index()] = StampedSide::new(self.cut, side).0;
            match side {
                Side::Normal => in_front.push(v),
                Side::On => on.push(v),
                Side::Reverse => {}
            }
        }
        (in_front, on)
    }

    #[cfg(test)]
    fn goes_by_numbers(&self) -> bool {
        self.pattern.is_empty()
    }

    #[cfg(not(test))]
    fn goes_by_numbers(&self) -> bool {
        true
    }

    /// The side found for `v` in this cut; only for vertices that were asked before.
    pub(in crate::op::cut) fn known_side(&self, v: VertexId) -> Side {
        let side = StampedSide(self.sides[v.index()]).of_cut(self.cut);
        side.expect("the side was asked in this cut")
    }

    /// Whether the tables of this cut know the vertex.
    pub(in crate::op::cut) fn is_known(&self, v: VertexId) -> bool {
        self.sides
            .get(v.index())
            .is_some_and(|&stamped| StampedSide(stamped).of_cut(self.cut).is_some())
    }
}

/// How near a given vertex may be to a given plane before the points where its edges cross the
/// plane can no longer be distinguished from it: cutting there would make edges of no length, or
/// swap points that lie an ulp apart.
fn indistinct(x: DVec3, point: DVec3) -> f64 {
    64.0 * f64::EPSILON * x.abs().max(point.abs()).max_element()
}
