//! The growing hull: triangles that know their neighbours, a walk to where a point leaves, and the insertion of a point.
//!
//! Source: Clarkson and Shor 1989 for the incremental hull, with the walk of Devillers, Pion and Teillaud 2002 ("Walking in a
//! triangulation") in place of a conflict graph. A triangle that has the point in its plane counts as not seen. The seen
//! part is then the one that a point just a little further in would see, so it is a disc, and no triangle of the fan is flat.

mod parts;

use glam::DVec3;

use super::cloud::{Cloud, Signs};
use crate::geom::Side;

pub(super) use parts::{Division, Growth};

/// A triangle of the hull, counter-clockwise seen from outside. Points are named by their place in the order of insertion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Facet {
    pub corners: [u32; 3],
    /// The facet beyond the side from `corners[i]` to `corners[i + 1]`.
    pub across: [u32; 3],
}

/// How a facet is stored: corners, then what lies across. Zeros are a free slot, as are three equal corners.
pub(super) type Slot = [u32; 6];
/// No facet.
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
pub(super) struct Surface<'a> {
    /// Room for all facets that there can ever be; those from `used` on are free.
    facets: &'a mut [Slot],
    used: usize,
    count: usize,
    /// Free slots below `used`.
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
    /// The sides between the seen and the unseen facets: each as four times the unseen facet plus which of its sides it is.
    rim: Vec<u32>,
    stack: Vec<Pending>,
}

/// A neighbour of a seen facet that is still to be entered or left outside.
#[derive(Clone, Copy)]
struct Pending {
    facet: u32,
    /// Which of its sides leads back.
    back: u32,
    is_seen: bool,
    /// Its corner that is not on that side, seen from the point at hand.
    third: DVec3,
}

/// What became of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Insertion {
    /// It is a corner now.
    Done,
    /// The facet does not see it.
    NotSeen,
    /// It sees a facet at the border of a part; nothing has changed.
    AtBorder,
}

/// Room for the hull of so many points.
pub(super) fn room(points: usize) -> Vec<Slot> {
    vec![[0; 6]; 2 * points + 8]
}

impl<'a> Surface<'a> {
    /// The tetrahedron of four points, of which the last lies below the other three, in `facets`, which are all free.
    pub(super) fn tetrahedron([a, b, c, d]: [u32; 4], apex: Option<u32>, facets: &'a mut [Slot]) -> Self {
        let tetrahedron = [[a, b, c, 1, 2, 3], [b, a, d, 0, 3, 2], [c, b, d, 0, 1, 3], [a, c, d, 0, 2, 1]];
        facets[..4].copy_from_slice(&tetrahedron);
        Self { apex, ..Self::with_facets(facets, 4) }
    }

    fn with_facets(facets: &'a mut [Slot], used: usize) -> Self {
        Self {
            facets,
            used,
            count: used,
            free: Vec::new(),
            last: 0,
            apex: None,
            has_zeros: false,
            random: 1,
            scratch: Scratch::default(),
        }
    }

    /// The facet in a slot.
    #[inline]
    pub(super) fn facet(&self, f: u32) -> Facet {
        let [a, b, c, ab, bc, ca] = self.facets[f as usize];
        Facet { corners: [a, b, c], across: [ab, bc, ca] }
    }

    /// Number of slots, free ones included.
    pub(super) fn slots(&self) -> usize {
        self.used
    }

    /// Number of facets.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    fn is_free(&self, f: u32) -> bool {
        let slot = &self.facets[f as usize];
        slot[0] == slot[1]
    }

    /// The slots of all facets, ascending.
    pub(super) fn live(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.used as u32).filter(|&f| !self.is_free(f))
    }

    /// Whether a corner of the hull serves as the centre.
    pub(super) fn has_apex(&self) -> bool {
        self.apex.is_some()
    }

    /// Whether exact zeros came up, so that some neighbours may be coplanar by more than chance.
    pub(super) fn has_zeros(&self) -> bool {
        self.has_zeros
    }

    /// The facet after `f` around its corner `v`, counter-clockwise.
    #[inline]
    pub(super) fn next_around(&self, v: u32, f: u32) -> u32 {
        let slot = &self.facets[f as usize];
        // Across the side that comes back to v; by index, since nothing can foresee a branch.
        let place = usize::from(slot[1] == v) + 2 * usize::from(slot[2] == v);
        slot[[5, 3, 4, 4][place]]
    }

    /// The facets around corner `v`, counter-clockwise, beginning with `first`.
    pub(super) fn fan_of(&self, v: u32, first: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |&f: &u32| {
            let next = self.next_around(v, f);
            (next != first).then_some(next)
        };
        std::iter::successors(Some(first), next)
    }

    /// Inserts a point; nothing changes when it does not lie outside.
    pub(super) fn insert<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) {
        if self.apex.is_none() && self.insert_quickly(cloud, p) == Quick::Settled {
            return;
        }
        if let Some(f) = self.exact_walk(cloud, p) {
            self.insert_above(cloud, p, f);
        }
    }

    /// Inserts a point into a part of a surface if that concerns no side at its border and needs no exact walk; whether the
    /// point is settled. If not, the next walk begins where this one ended, since the next point lies near this one.
    pub(super) fn insert_within<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> bool {
        self.insert_quickly(cloud, p) == Quick::Settled
    }

    fn insert_quickly<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Quick {
        let Some(is_certain) = self.quick_walk(cloud, p) else { return Quick::Unsure };
        match self.insert_above(cloud, p, self.last) {
            Insertion::Done => Quick::Settled,
            // Certainly below this facet, so inside.
            Insertion::NotSeen if is_certain => Quick::Settled,
            _ => Quick::Unsure,
        }
    }

    /// Walks over the sides that the ray from the centre to p certainly lies beyond, the farther of two.
    ///
    /// Ends at [`Self::last`] and tells whether the ray certainly passes through that facet; `None` when it led nowhere. Carries along
    /// the products of the corners of the side that was crossed with the target, so that a step costs one more.
    fn quick_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<bool> {
        let target = cloud.point(p);
        let bound = cloud.turn_bound();
        let mut f = self.last;
        let Facet { corners, across } = self.facet(f);
        let [a, b, c] = corners.map(|v| cloud.point(v));
        let (at, bt, ct) = (a.cross(target), b.cross(target), c.cross(target));
        let turns = [a.dot(bt), b.dot(ct), c.dot(at)];
        let least = turns[0].min(turns[1]).min(turns[2]);
        if least >= -bound {
            return Some(least > bound);
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
            let (turn_after, turn_before) = (-z.dot(to), z.dot(from));
            let least = turn_after.min(turn_before);
            if least >= -bound {
                self.last = f;
                return Some(least > bound);
            }
            let zt = z.cross(target);
            if turn_after < turn_before {
                (next, from) = (across[after], zt);
            } else {
                (next, to) = (across[before], zt);
            }
        }
        self.last = f;
        None
    }

    /// The walk on exact signs; where it takes too long or proves nothing, all facets are tried.
    #[cold]
    fn exact_walk<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Option<u32> {
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
        self.live().find(|&f| cloud.height(self.facet(f).corners, p) == Side::Normal)
    }

    fn is_seen<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32, p: u32) -> bool {
        let side = cloud.height(self.facet(f).corners, p);
        self.has_zeros |= side == Side::On;
        side == Side::Normal
    }

    /// Replaces what p sees, beginning with facet `first`, by a fan from p to the rim.
    pub(super) fn insert_above<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32) -> Insertion {
        let mut scratch = std::mem::take(&mut self.scratch);
        let insertion = self.collect_seen(cloud, p, first, &mut scratch);
        match insertion {
            Insertion::Done => self.fan(p, &mut scratch),
            Insertion::NotSeen => {}
            Insertion::AtBorder => {
                scratch.seen.iter().for_each(|&f| self.facets[f as usize][0] &= !SEEN);
            }
        }
        self.scratch = scratch;
        insertion
    }

    /// Lists the seen facets, marking them, and the sides around them in counter-clockwise order; not to the end when one of
    /// them lies at the border of a part.
    fn collect_seen<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32, scratch: &mut Scratch) -> Insertion {
        let Scratch { seen, rim, stack } = scratch;
        seen.clear();
        rim.clear();
        stack.clear();
        let view = View { cloud, p, target: cloud.point(p) };
        let Facet { corners, across } = self.facet(first);
        let facets = &mut *self.facets;
        let [a, b, c] = corners.map(|v| view.corner(v));
        let bc = b.cross(c);
        let height = cloud.settled_height(corners, p, a.dot(bc));
        self.has_zeros |= height == Side::On;
        if height != Side::Normal {
            return Insertion::NotSeen;
        }
        if (across[0] | across[1] | across[2]) & BORDER != 0 {
            return Insertion::AtBorder;
        }
        facets[first as usize][0] |= SEEN;
        seen.push(first);
        let crosses = [a.cross(b), bc, c.cross(a)];
        for side in [2, 1, 0] {
            if let Some(pending) = view.beyond(facets, first, across[side], crosses[side], &mut self.has_zeros) {
                stack.push(pending);
            }
        }
        while let Some(Pending { facet: f, back, is_seen, third }) = stack.pop() {
            let [a, b, c, ab, bc, ca] = facets[f as usize];
            if a & SEEN != 0 {
                continue;
            }
            if !is_seen {
                rim.push(f << 2 | back);
                continue;
            }
            let (corners, across) = ([a, b, c], [ab, bc, ca]);
            let after = NEXT[back as usize];
            let before = NEXT[after];
            if (across[after] | across[before]) & BORDER != 0 {
                return Insertion::AtBorder;
            }
            facets[f as usize][0] |= SEEN;
            seen.push(f);
            // Both neighbours are looked at before either is needed: so their facets and corners arrive from memory together.
            let (to, from) = (view.corner(corners[back as usize]), view.corner(corners[after]));
            let second = view.beyond(facets, f, across[before], third.cross(to), &mut self.has_zeros);
            let next = view.beyond(facets, f, across[after], from.cross(third), &mut self.has_zeros);
            if let Some(second) = second {
                stack.push(second);
            }
            if let Some(next) = next {
                stack.push(next);
            }
        }
        Insertion::Done
    }

    /// Builds the fan in the slots of the seen facets, so that neighbours stay near each other in memory.
    fn fan(&mut self, p: u32, Scratch { seen, rim, .. }: &mut Scratch) {
        let count = rim.len();
        self.count = self.count + count - seen.len();
        while seen.len() < count {
            let slot = self.free.pop().unwrap_or_else(|| {
                self.used += 1;
                self.used as u32 - 1
            });
            seen.push(slot);
        }
        for &slot in &seen[count..] {
            self.facets[slot as usize] = [0; 6];
            self.free.push(slot);
        }
        seen.truncate(count);
        let facets = &mut *self.facets;
        let (first, mut before) = (seen[0], seen[count - 1]);
        let after = seen.iter().skip(1).chain(std::iter::once(&first));
        for ((&side, &slot), &after) in rim.iter().zip(seen.iter()).zip(after) {
            let (outside, back) = (side >> 2, (side & 3) as usize);
            let facet = &mut facets[outside as usize];
            // Seen from outside the side runs the other way round.
            let (to, from) = (facet[back], facet[NEXT[back]]);
            facet[3 + back] = slot;
            facets[slot as usize] = [from, to, p, outside, after, before];
            before = slot;
        }
        self.last = first;
    }

    /// Moves the last facets into the free slots, so that the slots below [`Self::len`] are all there are.
    pub(super) fn compact(&mut self) {
        let mut holes = std::mem::take(&mut self.free);
        holes.sort_unstable();
        for hole in holes {
            while self.used > self.count && self.is_free(self.used as u32 - 1) {
                self.used -= 1;
            }
            if self.used == self.count {
                break;
            }
            self.used -= 1;
            let last = self.used as u32;
            for g in self.facet(last).across {
                let side = self.side_to(g, last);
                self.facets[g as usize][3 + side] = hole;
            }
            self.facets[hole as usize] = std::mem::take(&mut self.facets[last as usize]);
        }
        self.last = 0;
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

/// The surface seen from a point that is to be inserted.
struct View<'a, S> {
    cloud: &'a Cloud<S>,
    p: u32,
    target: DVec3,
}

impl<S: Signs> View<'_, S> {
    #[inline(always)]
    fn corner(&self, v: u32) -> DVec3 {
        self.cloud.point(v) - self.target
    }

    /// What lies beyond a side of facet `f`, of which `cross` is the product of the ends; nothing if that is among the seen already.
    #[inline(always)]
    fn beyond(&self, facets: &[Slot], f: u32, g: u32, cross: DVec3, has_zeros: &mut bool) -> Option<Pending> {
        let [a, b, c, ab, bc, ca] = facets[g as usize];
        if a & SEEN != 0 {
            return None;
        }
        // Seen from the facet beyond, the side runs the other way round. Only its third corner is new.
        let (corners, back) = ([a, b, c], position([ab, bc, ca], f));
        let third = self.corner(corners[NEXT[NEXT[back]]]);
        let height = self.cloud.settled_height(corners, self.p, -third.dot(cross));
        *has_zeros |= height == Side::On;
        Some(Pending { facet: g, back: back as u32, is_seen: height == Side::Normal, third })
    }
}

/// How an insertion on rounded signs ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quick {
    Settled,
    Unsure,
}

fn position(across: [u32; 3], f: u32) -> usize {
    // Without branches, since nothing can foresee them.
    let not_first = usize::from(across[0] != f);
    not_first << usize::from(across[1] != f)
}
