//! The growing hull: triangles that know their neighbours, a walk to where a point leaves, and the insertion of a point.
//!
//! Source: Clarkson and Shor 1989 for the incremental hull, with the walk of Devillers, Pion and Teillaud 2002 ("Walking in a
//! triangulation") in place of a conflict graph. A triangle that has the point in its plane counts as not seen. The seen
//! part is then the one that a point just a little further in would see, so it is a disc, and no triangle of the fan is flat.

mod parts;

use super::cloud::{Cloud, Signs};
use crate::geom::Side;

pub(super) use parts::Division;

/// A triangle of the hull, counter-clockwise seen from outside. Points are named by their place in the order of insertion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Facet {
    pub corners: [u32; 3],
    /// The facet beyond the side from `corners[i]` to `corners[i + 1]`.
    pub across: [u32; 3],
}

/// No facet, or the corners of a free slot.
pub(super) const NONE: u32 = u32::MAX;
/// Marks the first corner of a facet that the point at hand sees.
const SEEN: u32 = 1 << 31;
/// Marks what lies across a side at the border of a part of a surface: the slot in the whole surface.
const BORDER: u32 = 1 << 31;
/// The side after each.
const NEXT: [usize; 3] = [1, 2, 0];
/// Steps of a walk on rounded signs before exact ones take over.
const QUICK_STEPS: usize = 4096;

/// A closed surface of triangles, convex up to coplanar neighbours.
pub(super) struct Surface {
    facets: Vec<Facet>,
    free: Vec<u32>,
    /// Where the next walk begins.
    last: u32,
    /// The corner that serves as the centre, when no point inside is known.
    apex: Option<u32>,
    /// Whether any point ever lay in the plane of a facet that it was tested against.
    has_zeros: bool,
    random: u32,
    scratch: Scratch,
}

#[derive(Default)]
struct Scratch {
    seen: Vec<u32>,
    rim: Vec<RimSide>,
    stack: Vec<Visit>,
}

/// A side between the seen and the unseen facets.
#[derive(Clone, Copy)]
struct RimSide {
    from: u32,
    to: u32,
    /// The unseen facet, and which of its sides this is.
    outside: u32,
    back: usize,
}

/// A seen facet whose sides are still to be crossed, beginning with `side`.
struct Visit {
    facet: u32,
    side: usize,
    left: u32,
}

impl Surface {
    /// The tetrahedron of four points, of which the last lies below the other three. Room is made for `points` points.
    pub(super) fn tetrahedron([a, b, c, d]: [u32; 4], apex: Option<u32>, points: usize) -> Self {
        let mut facets = Vec::with_capacity(2 * points + 8);
        facets.extend([
            Facet { corners: [a, b, c], across: [1, 2, 3] },
            Facet { corners: [b, a, d], across: [0, 3, 2] },
            Facet { corners: [c, b, d], across: [0, 1, 3] },
            Facet { corners: [a, c, d], across: [0, 2, 1] },
        ]);
        let scratch = Scratch::default();
        Self { facets, free: Vec::new(), last: 0, apex, has_zeros: false, random: 1, scratch }
    }

    /// The facet in a slot.
    pub(super) fn facet(&self, f: u32) -> Facet {
        self.facets[f as usize]
    }

    /// Number of slots, free ones included.
    pub(super) fn slots(&self) -> usize {
        self.facets.len()
    }

    /// Number of facets.
    pub(super) fn len(&self) -> usize {
        self.facets.len() - self.free.len()
    }

    /// The slots of all facets, ascending.
    pub(super) fn live(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.facets.len() as u32).filter(|&f| self.facets[f as usize].corners[0] != NONE)
    }

    /// Whether a corner of the hull serves as the centre.
    pub(super) fn has_apex(&self) -> bool {
        self.apex.is_some()
    }

    /// Whether exact zeros came up, so that some neighbours may be coplanar by more than chance.
    pub(super) fn has_zeros(&self) -> bool {
        self.has_zeros
    }

    /// The facets around corner `v`, counter-clockwise, beginning with `first`.
    pub(super) fn fan_of(&self, v: u32, first: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |&f: &u32| {
            let facet = &self.facets[f as usize];
            // Across the side that comes back to v; by index, since nothing can foresee a branch.
            let place = usize::from(facet.corners[1] == v) + 2 * usize::from(facet.corners[2] == v);
            let next = facet.across[[2, 0, 1, 1][place]];
            (next != first).then_some(next)
        };
        std::iter::successors(Some(first), next)
    }

    /// Inserts a point; nothing changes when it does not lie outside.
    pub(super) fn insert<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) {
        if let Some(f) = self.locate(cloud, p) {
            self.insert_above(cloud, p, f);
        }
    }

    /// Inserts a point into a part of a surface if that concerns no side at its border and needs no exact walk; whether the
    /// point is settled.
    pub(super) fn insert_within<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> bool {
        match self.quick_walk(cloud, p) {
            Walk::Sees(f) => self.insert_above(cloud, p, f),
            Walk::Inside => true,
            Walk::Unsure => false,
        }
    }

    /// A facet that sees p, or `None` when p lies inside or on the surface.
    fn locate<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        if self.apex.is_none() {
            match self.quick_walk(cloud, p) {
                Walk::Sees(f) => return Some(f),
                Walk::Inside => return None,
                Walk::Unsure => {}
            }
        }
        self.exact_walk(cloud, p)
    }

    /// Walks over the sides that the ray from the centre to p certainly lies beyond, the farther of two.
    ///
    /// Carries along the products of the corners of the side that was crossed with the target, so that a step costs one more.
    fn quick_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Walk {
        let target = cloud.point(p);
        let bound = cloud.turn_bound();
        let mut f = self.last;
        let Facet { corners, across } = self.facet(f);
        let [a, b, c] = corners.map(|v| cloud.point(v));
        let (at, bt, ct) = (a.cross(target), b.cross(target), c.cross(target));
        let turns = [a.dot(bt), b.dot(ct), c.dot(at)];
        let least = turns[0].min(turns[1]).min(turns[2]);
        let mut is_certain = least > bound;
        if least >= -bound {
            return self.end_of_walk(cloud, p, f, is_certain);
        }
        let (mut next, [mut from, mut to]) = if least == turns[0] {
            (across[0], [bt, at])
        } else if least == turns[1] {
            (across[1], [ct, bt])
        } else {
            (across[2], [at, ct])
        };
        for _ in 0..QUICK_STEPS {
            if next & BORDER != 0 {
                break;
            }
            // Seen from the next facet the side runs the other way round.
            let Facet { corners, across } = self.facet(next);
            let side = position(across, f);
            f = next;
            let after = NEXT[side];
            let before = NEXT[after];
            let z = cloud.point(corners[before]);
            let zt = z.cross(target);
            let (turn_after, turn_before) = (-z.dot(to), z.dot(from));
            let least = turn_after.min(turn_before);
            if least >= -bound {
                is_certain = least > bound;
                return self.end_of_walk(cloud, p, f, is_certain);
            }
            if turn_after < turn_before {
                (next, from) = (across[after], zt);
            } else {
                (next, to) = (across[before], zt);
            }
        }
        self.last = f;
        Walk::Unsure
    }

    fn end_of_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, f: u32, is_certain: bool) -> Walk {
        self.last = f;
        if self.is_seen(cloud, f, p) {
            Walk::Sees(f)
        } else if is_certain {
            Walk::Inside
        } else {
            Walk::Unsure
        }
    }

    /// The walk on exact signs; where it takes too long or proves nothing, all facets are tried.
    #[cold]
    fn exact_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        if self.apex.is_some() {
            return self.walk_from_apex(cloud, p);
        }
        let mut f = self.last;
        for _ in 0..QUICK_STEPS + self.facets.len() / 4 {
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

    /// The walk with a corner of the hull for its centre. Facets around that corner, or in one plane with it, are flat seen
    /// from there: they are tested on the way, and a point in their plane proves nothing.
    fn walk_from_apex<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        let mut f = self.last;
        for _ in 0..QUICK_STEPS {
            if self.is_seen(cloud, f, p) {
                self.last = f;
                return Some(f);
            }
            let facet = self.facet(f);
            // The ray runs below a facet at the apex and leaves it across the opposite side.
            let opposite = facet.corners.iter().position(|&v| Some(v) == self.apex).map(|i| (i + 1) % 3);
            match opposite.or_else(|| self.first_crossed(cloud, f, p)) {
                Some(side) => f = facet.across[side],
                None => break,
            }
        }
        let Facet { corners: [a, b, c], .. } = self.facet(f);
        self.last = f;
        let is_inside = |a, b| cloud.signs.turn(a, b, p) == Side::Normal;
        if is_inside(a, b) && is_inside(b, c) && is_inside(c, a) { None } else { self.try_all(cloud, p) }
    }

    /// A side of the facet that the ray from the centre to p lies strictly beyond.
    fn first_crossed<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32, p: u32) -> Option<usize> {
        let corners = self.facet(f).corners;
        let first = self.random_side();
        let mut sides = (0..3).map(|k| (first + k) % 3);
        sides.find(|&side| cloud.signs.turn(corners[side], corners[(side + 1) % 3], p) == Side::Reverse)
    }

    fn try_all<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
        let slots = 0..self.facets.len() as u32;
        slots.filter(|&f| self.facets[f as usize].corners[0] != NONE).find(|&f| {
            let side = cloud.height(self.facets[f as usize].corners, p);
            side == Side::Normal
        })
    }

    fn is_seen<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32, p: u32) -> bool {
        let side = cloud.height(self.facet(f).corners, p);
        self.has_zeros |= side == Side::On;
        side == Side::Normal
    }

    /// Replaces what p sees, beginning with facet `first`, by a fan from p to the rim. Where p sees a facet at the border of a
    /// part nothing changes, and the answer is no.
    pub(super) fn insert_above<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32) -> bool {
        let mut scratch = std::mem::take(&mut self.scratch);
        let is_within = self.collect_seen(cloud, p, first, &mut scratch);
        if is_within {
            self.fan(p, &mut scratch);
        } else {
            scratch.seen.iter().for_each(|&f| self.facets[f as usize].corners[0] &= !SEEN);
        }
        self.scratch = scratch;
        is_within
    }

    /// Lists the seen facets, marking them, and the sides around them in counter-clockwise order; not to the end when one of
    /// them lies at the border of a part.
    fn collect_seen<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32, scratch: &mut Scratch) -> bool {
        let Scratch { seen, rim, stack } = scratch;
        seen.clear();
        rim.clear();
        stack.clear();
        let target = cloud.point(p);
        let facets = self.facets.as_mut_slice();
        let mut has_zeros = false;
        facets[first as usize].corners[0] |= SEEN;
        seen.push(first);
        stack.push(Visit { facet: first, side: 0, left: 3 });
        while let Some(visit) = stack.last_mut() {
            if visit.left == 0 {
                stack.pop();
                continue;
            }
            let (f, side) = (visit.facet, visit.side);
            visit.side = NEXT[side];
            visit.left -= 1;
            let Facet { corners, across } = facets[f as usize];
            let g = across[side];
            if g & BORDER != 0 {
                return false;
            }
            let beyond = facets[g as usize];
            if beyond.corners[0] & SEEN != 0 {
                continue;
            }
            let back = position(beyond.across, f);
            let height = cloud.height_of(target, beyond.corners, p);
            if height == Side::Normal {
                facets[g as usize].corners[0] |= SEEN;
                seen.push(g);
                stack.push(Visit { facet: g, side: NEXT[back], left: 2 });
            } else {
                has_zeros |= height == Side::On;
                let (from, to) = (corners[side] & !SEEN, corners[NEXT[side]] & !SEEN);
                rim.push(RimSide { from, to, outside: g, back });
            }
        }
        self.has_zeros |= has_zeros;
        true
    }

    /// Builds the fan in the slots of the seen facets, so that neighbours stay near each other in memory.
    fn fan(&mut self, p: u32, Scratch { seen, rim, .. }: &mut Scratch) {
        let count = rim.len();
        while seen.len() < count {
            let slot = self.free.pop().unwrap_or_else(|| {
                self.facets.push(Facet { corners: [NONE; 3], across: [NONE; 3] });
                self.facets.len() as u32 - 1
            });
            seen.push(slot);
        }
        let mut before = seen[count - 1];
        for (i, side) in rim.iter().enumerate() {
            let slot = seen[i];
            let after = seen[if i + 1 == count { 0 } else { i + 1 }];
            self.facets[slot as usize] =
                Facet { corners: [side.from, side.to, p], across: [side.outside, after, before] };
            self.facets[side.outside as usize].across[side.back] = slot;
            before = slot;
        }
        for &slot in &seen[count..] {
            self.facets[slot as usize].corners = [NONE; 3];
            self.free.push(slot);
        }
        self.last = seen[0];
    }

    /// Which side of `f` leads to `g`.
    pub(super) fn side_to(&self, f: u32, g: u32) -> usize {
        position(self.facet(f).across, g)
    }

    /// A walk that chose its sides always in the same order could run in circles over coplanar facets.
    fn random_side(&mut self) -> usize {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // The upper bits of the generator, times three, divided by their range.
        ((u64::from(self.random) * 3) >> 32) as usize
    }
}

/// How a walk ended.
#[derive(Debug, Clone, Copy)]
enum Walk {
    Sees(u32),
    Inside,
    Unsure,
}

fn position(across: [u32; 3], f: u32) -> usize {
    // Without branches, since nothing can foresee them.
    let not_first = usize::from(across[0] != f);
    not_first << usize::from(across[1] != f)
}
