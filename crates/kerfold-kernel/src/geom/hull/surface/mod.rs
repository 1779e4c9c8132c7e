//! The growing hull: triangles that know their neighbours and poles, the ways to one that sees a
//! point, and the insertion of a point.
//!
//! Source: Clarkson and Shor 1989 for the incremental hull, with walks in place of a conflict
//! graph: uphill over the poles, and where that ends without an answer, that of Devillers, Pion and
//! Teillaud 2002 ("Walking in a triangulation"). A triangle that has the point in its plane counts
//! as not seen. The seen part is then the one that a point just a little further in would see, so
//! it is a disc, and no triangle of the fan is flat.

mod insertion;
mod parts;
mod pole;
mod walk;

use super::cloud::{Cloud, Signs};
use super::parallel::update_and_pick;

pub(super) use parts::{Division, Growth};
pub(super) use pole::Pole;

/// A triangle of the hull, counter-clockwise seen from outside. Points are named by their place in
/// the order of insertion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Facet {
    pub corners: [u32; 3],
    /// The facet beyond the side from `corners[i]` to `corners[i + 1]`.
    pub across: [u32; 3],
}

/// How a facet is stored: corners, then what lies across each side: four times that facet, plus
/// which of its sides leads back. So neither insertion nor a turn around a corner searches. Zeros
/// are a free slot, as are three equal corners.
pub(super) type Slot = [u32; 6];
/// No facet.
pub(super) const NONE: u32 = u32::MAX;
/// Marks the first corner of a facet that the point at hand sees.
const SEEN: u32 = 1 << 31;
/// Marks what lies across a side at the border of a part of a surface: the facet in the whole
/// surface.
const BORDER: u32 = 1 << 31;
/// The side after each; four, so that two bits always point at one.
const NEXT: [usize; 4] = [1, 2, 0, 0];
/// The side before each.
const BEFORE: [usize; 4] = [2, 0, 1, 1];

/// A closed surface of triangles, convex up to coplanar neighbours.
pub(super) struct Surface<'a> {
    /// Room for all facets that there can ever be; those from `used` on are free.
    facets: &'a mut [Slot],
    /// The pole of each.
    poles: &'a mut [Pole],
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
    /// The sides between the seen and the unseen facets: each as four times the unseen facet plus
    /// which of its sides it is.
    rim: Vec<u32>,
    /// Sides of facets that are still to be entered or left outside, likewise.
    stack: Vec<u32>,
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

/// Room for a hull.
pub(super) struct Room {
    facets: Vec<Slot>,
    poles: Vec<Pole>,
}

impl Room {
    /// Room for the hull of so many points.
    pub(super) fn new(points: usize) -> Self {
        let facets = 2 * points + 8;
        Self { facets: vec![[0; 6]; facets], poles: vec![[0.0; 3]; facets] }
    }

    /// What is left of the first facets: their poles, by slot.
    pub(super) fn into_poles(mut self, count: usize) -> Vec<Pole> {
        self.poles.truncate(count);
        self.poles
    }
}

impl<'a> Surface<'a> {
    /// The tetrahedron of four points, of which the last lies below the other three, in a room that
    /// is all free.
    pub(super) fn tetrahedron<S: Signs>(
        cloud: &Cloud<S>,
        [a, b, c, d]: [u32; 4],
        apex: Option<u32>,
        room: &'a mut Room,
    ) -> Self {
        let tetrahedron = [
            [a, b, c, link(1, 0), link(2, 0), link(3, 0)],
            [b, a, d, link(0, 0), link(3, 2), link(2, 1)],
            [c, b, d, link(0, 1), link(1, 2), link(3, 1)],
            [a, c, d, link(0, 2), link(2, 2), link(1, 1)],
        ];
        room.facets[..4].copy_from_slice(&tetrahedron);
        let mut surface = Self { apex, ..Self::with_facets(&mut room.facets, &mut room.poles, 4) };
        (0..4).for_each(|f| surface.set_pole(cloud, f));
        surface
    }

    fn with_facets(facets: &'a mut [Slot], poles: &'a mut [Pole], used: usize) -> Self {
        Self {
            facets,
            poles,
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
        let [a, b, c, across @ ..] = self.facets[f as usize];
        Facet { corners: [a, b, c], across: across.map(|link| link >> 2) }
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

    /// The facets around corner `v`, counter-clockwise, beginning with `first`.
    pub(super) fn fan_of(&self, v: u32, first: u32) -> impl Iterator<Item = u32> + '_ {
        let [a, b, ..] = self.facets[first as usize];
        let first = link(first, if v == a { 0 } else { 1 + u32::from(v != b) });
        let next = move |&at: &u32| {
            let next = self.next_around(at);
            (next != first).then_some(next)
        };
        std::iter::successors(Some(first), next).map(|link| link >> 2)
    }

    /// The facet after one around one of its corners, counter-clockwise. Both as four times the
    /// facet plus which of its corners it is.
    #[inline(always)]
    pub(super) fn next_around(&self, at: u32) -> u32 {
        // The side that comes in at the corner leaves it in the facet beyond.
        self.facets[(at >> 2) as usize][3 + BEFORE[(at & 3) as usize]]
    }

    /// Moves the last facets into the free slots, so that the slots below [`Self::len`] are all
    /// there are.
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
            let [_, _, _, across @ ..] = self.facets[last as usize];
            for (beyond, side) in across.into_iter().zip(0..) {
                self.facets[(beyond >> 2) as usize][3 + (beyond & 3) as usize] = link(hole, side);
            }
            self.facets[hole as usize] = std::mem::take(&mut self.facets[last as usize]);
            self.poles[hole as usize] = self.poles[last as usize];
        }
        self.last = 0;
    }

    /// Sets every pole to what `make` has first for the facet, its corners and the pole so far, and
    /// returns what it has besides.
    pub(super) fn update_poles<P: Send>(
        &mut self,
        make: impl Fn(u32, [u32; 3], Pole) -> (Pole, Option<P>) + Sync,
    ) -> Vec<P> {
        let facets = &*self.facets;
        update_and_pick(&mut self.poles[..self.used], |f, &pole| {
            let [a, b, c, ..] = facets[f];
            make(f as u32, [a, b, c], pole)
        })
    }

    /// The pole of a facet, or what it was set to.
    pub(super) fn pole(&self, f: u32) -> Pole {
        self.poles[f as usize]
    }

    /// Sets the pole of a facet.
    pub(super) fn replace_pole(&mut self, f: u32, pole: Pole) {
        self.poles[f as usize] = pole;
    }

    /// Which side of `f` leads to `g`.
    pub(super) fn side_to(&self, f: u32, g: u32) -> usize {
        let Facet { across: [first, second, _], .. } = self.facet(f);
        if g == first { 0 } else { 1 + usize::from(g != second) }
    }
}

/// A facet and one of its sides.
pub(super) const fn link(facet: u32, side: u32) -> u32 {
    facet << 2 | side
}
