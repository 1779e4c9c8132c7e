//! The ways to a facet that sees a point.

use glam::DVec3;

use super::pole::{SEEN_FROM, product};
use super::{BEFORE, BORDER, Facet, NEXT, Surface};
use crate::geom::Side;
use crate::geom::hull::cloud::{Cloud, Signs};

/// Steps of a walk on rounded signs before exact ones take over.
const QUICK_STEPS: usize = 4096;

impl Surface<'_> {
    /// Goes from facet to facet, always to the neighbour whose plane p lies farthest beyond, to the
    /// first that certainly sees p. Ends at [`Self::last`]; false where no neighbour is better and
    /// none sees p for certain.
    pub(super) fn climb(&mut self, target: DVec3) -> bool {
        let mut best = (product(&self.poles[self.last as usize], target), self.last);
        loop {
            let (value, f) = best;
            self.last = f;
            if value > SEEN_FROM {
                return true;
            }
            let [_, _, _, sides @ ..] = &self.facets[f as usize];
            for &side in sides.iter().filter(|&side| side & BORDER == 0) {
                let value = product(&self.poles[(side >> 2) as usize], target);
                if value > best.0 {
                    best = (value, side >> 2);
                }
            }
            if best.1 == f {
                return false;
            }
        }
    }

    /// Walks over the sides that the ray from the centre to p certainly lies beyond, the farther of
    /// two.
    ///
    /// Ends at [`Self::last`] and says whether the ray certainly passes through that facet; `None`
    /// when it led nowhere. Carries along the products of the corners of the side that was crossed
    /// with the target, so that a step costs one more.
    pub(super) fn quick_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<bool> {
        let target = cloud.point(p);
        let bound = cloud.turn_bound();
        let [a, b, c, ab, bc, ca] = self.facets[self.last as usize];
        let [a, b, c] = [a, b, c].map(|v| cloud.point(v));
        let (at, bt, ct) = (a.cross(target), b.cross(target), c.cross(target));
        let turns = [a.dot(bt), b.dot(ct), c.dot(at)];
        let least = turns[0].min(turns[1]).min(turns[2]);
        if least >= -bound {
            return Some(least > bound);
        }
        let (mut next, [mut from, mut to]) = if least == turns[0] {
            (ab, [bt, at])
        } else if least == turns[1] {
            (bc, [ct, bt])
        } else {
            (ca, [at, ct])
        };
        for _ in 0..QUICK_STEPS {
            if next & BORDER != 0 {
                break;
            }
            // Seen from the next facet the side runs the other way round.
            let (f, side) = (next >> 2, (next & 3) as usize);
            let slot = &self.facets[f as usize];
            let (after, before) = (NEXT[side], BEFORE[side]);
            let z = cloud.point(slot[before]);
            self.last = f;
            let (turn_after, turn_before) = (-z.dot(to), z.dot(from));
            let least = turn_after.min(turn_before);
            if least >= -bound {
                return Some(least > bound);
            }
            let zt = z.cross(target);
            if turn_after < turn_before {
                (next, from) = (slot[3 + after], zt);
            } else {
                (next, to) = (slot[3 + before], zt);
            }
        }
        None
    }

    /// The walk on exact signs; where it takes too long or proves nothing, all facets are tried.
    #[cold]
    pub(super) fn exact_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        if self.apex.is_some() {
            return self.walk_from_apex(cloud, p);
        }
        let mut f = self.last;
        for _ in 0..QUICK_STEPS + self.used / 4 {
            match self.first_crossed(cloud, f, p) {
                Some(side) => f = self.facet(f).across[side],
                None => {
                    self.last = f;
                    return self.is_seen(cloud, f, p).then_some(f);
                }
            }
        }
        self.try_all(cloud, p)
    }

    /// The walk with a corner of the hull for its centre. Facets around that corner, or in one
    /// plane with it, are flat seen from there: they are tested on the way, and a point in their
    /// plane proves nothing.
    fn walk_from_apex<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        let mut f = self.last;
        for _ in 0..QUICK_STEPS {
            if self.is_seen(cloud, f, p) {
                self.last = f;
                return Some(f);
            }
            let facet = self.facet(f);
            // The ray runs below a facet at the apex and leaves it across the opposite side.
            let opposite =
                facet.corners.iter().position(|&v| Some(v) == self.apex).map(|i| (i + 1) % 3);
            match opposite.or_else(|| self.first_crossed(cloud, f, p)) {
                Some(side) => f = facet.across[side],
                None => break,
            }
        }
        let Facet { corners: [a, b, c], .. } = self.facet(f);
        self.last = f;
        let is_inside = |a, b| cloud.signs.turn(a, b, p) == Side::Normal;
        if is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
            None
        } else {
            self.try_all(cloud, p)
        }
    }

    /// A side of the facet that the ray from the centre to p lies strictly beyond.
    fn first_crossed<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32, p: u32) -> Option<usize> {
        let corners = self.facet(f).corners;
        let first = self.random_side();
        let mut sides = (0..3).map(|k| (first + k) % 3);
        sides.find(|&side| {
            cloud.signs.turn(corners[side], corners[(side + 1) % 3], p) == Side::Reverse
        })
    }

    fn try_all<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        self.live().find(|&f| cloud.height(self.facet(f).corners, p) == Side::Normal)
    }

    pub(super) fn is_seen<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32, p: u32) -> bool {
        let side = cloud.height(self.facet(f).corners, p);
        self.has_zeros |= side == Side::On;
        side == Side::Normal
    }

    /// A walk that chose its sides always in the same order could run in circles over coplanar
    /// facets.
    fn random_side(&mut self) -> usize {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // The upper bits of the generator, times three, divided by their range.
        ((u64::from(self.random) * 3) >> 32) as usize
    }
}
