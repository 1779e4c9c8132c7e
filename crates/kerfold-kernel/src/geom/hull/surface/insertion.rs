//! The insertion of a point: what it sees is replaced by a fan.

use super::pole::{Ray, SEEN_FROM, UNSEEN_BELOW, pole, product};
use super::{BEFORE, BORDER, Insertion, NEXT, SEEN, Scratch, Slot, Surface, link};
use crate::geom::Side;
use crate::geom::hull::cloud::{Cloud, Signs};

/// Marks a side that leads to a seen facet.
const ENTER: u32 = 1 << 31;

/// How an insertion on rounded signs ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quick {
    Settled,
    Unsure,
}

impl Surface<'_> {
    /// Inserts a point; nothing changes when it does not lie outside.
    pub(in super::super) fn insert<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) {
        if self.apex.is_none() && self.insert_quickly(cloud, p) == Quick::Settled {
            return;
        }
        if let Some(f) = self.exact_walk(cloud, p) {
            self.insert_above(cloud, p, f);
        }
    }

    /// Inserts a point into a part of a surface if that concerns no side at its border and needs no
    /// exact walk; whether the point is settled. If not, the next walk begins where this one ended,
    /// since the next point lies near this one.
    pub(in super::super) fn insert_within<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> bool {
        self.insert_quickly(cloud, p) == Quick::Settled
    }

    fn insert_quickly<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) -> Quick {
        if self.climb(cloud.point(p)) {
            let is_done = self.replace_seen(cloud, p, self.last) == Insertion::Done;
            return if is_done { Quick::Settled } else { Quick::Unsure };
        }
        let Some(is_certain) = self.quick_walk(cloud, p) else { return Quick::Unsure };
        match self.insert_above(cloud, p, self.last) {
            Insertion::Done => Quick::Settled,
            // Certainly below this facet, so inside.
            Insertion::NotSeen if is_certain => Quick::Settled,
            _ => Quick::Unsure,
        }
    }

    /// Replaces what p sees, beginning with facet `first`, by a fan from p to the rim.
    pub(in super::super) fn insert_above<S: Signs>(
        &mut self,
        cloud: &Cloud<S>,
        p: u32,
        first: u32,
    ) -> Insertion {
        if self.is_seen(cloud, first, p) {
            self.replace_seen(cloud, p, first)
        } else {
            Insertion::NotSeen
        }
    }

    /// The same for a facet that is known to see p.
    fn replace_seen<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32) -> Insertion {
        let insertion = self.collect_seen(cloud, p, first);
        if insertion == Insertion::Done {
            self.fan(cloud, p);
        } else {
            self.scratch.seen.iter().for_each(|&f| self.facets[f as usize][0] &= !SEEN);
        }
        insertion
    }

    /// Lists the seen facets, marking them, and the sides around them in counter-clockwise order;
    /// not to the end when one of them lies at the border of a part.
    fn collect_seen<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32, first: u32) -> Insertion {
        let Scratch { seen, rim, stack } = &mut self.scratch;
        seen.clear();
        rim.clear();
        stack.clear();
        let target = cloud.point(p);
        let (facets, poles, has_zeros) = (&mut *self.facets, &*self.poles, &mut self.has_zeros);
        let mut sees = |facets: &[Slot], side: u32| {
            let g = (side >> 2) as usize;
            let value = product(&poles[g], target);
            if value > SEEN_FROM {
                true
            } else if value < UNSEEN_BELOW {
                false
            } else {
                sees_closely(cloud, &facets[g], p, has_zeros)
            }
        };
        let [.., ab, bc, ca] = facets[first as usize];
        if (ab | bc | ca) & BORDER != 0 {
            return Insertion::AtBorder;
        }
        facets[first as usize][0] |= SEEN;
        seen.push(first);
        for side in [ca, bc, ab] {
            stack.push(if sees(facets, side) { side | ENTER } else { side });
        }
        while let Some(mut side) = stack.pop() {
            if side & ENTER == 0 {
                rim.push(side);
                continue;
            }
            side &= !ENTER;
            loop {
                let (f, back) = (side >> 2, (side & 3) as usize);
                let slot = &mut facets[f as usize];
                if slot[0] & SEEN != 0 {
                    break;
                }
                let (next, second) = (slot[3 + NEXT[back]], slot[3 + BEFORE[back]]);
                if (next | second) & BORDER != 0 {
                    return Insertion::AtBorder;
                }
                slot[0] |= SEEN;
                seen.push(f);
                // Both are looked at before either is needed, so that one does not wait for the
                // other.
                match (sees(facets, next), sees(facets, second)) {
                    (true, true) => {
                        stack.push(second | ENTER);
                        side = next;
                    }
                    (true, false) => {
                        stack.push(second);
                        side = next;
                    }
                    (false, true) => {
                        rim.push(next);
                        side = second;
                    }
                    (false, false) => {
                        rim.extend([next, second]);
                        break;
                    }
                }
            }
        }
        Insertion::Done
    }

    /// Builds the fan in the slots of the seen facets, so that neighbours stay near each other in
    /// memory.
    fn fan<S: Signs>(&mut self, cloud: &Cloud<S>, p: u32) {
        let Scratch { seen, rim, .. } = &mut self.scratch;
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
        let (facets, poles) = (&mut *self.facets, &mut *self.poles);
        let (first, mut before) = (seen[0], seen[count - 1]);
        let target = cloud.point(p);
        // Seen from outside a side runs the other way round.
        let begin = facets[(rim[0] >> 2) as usize][NEXT[(rim[0] & 3) as usize]];
        let mut from = begin;
        let mut ray = Ray::new(target, cloud.point(begin));
        for (i, (&side, &slot)) in rim.iter().zip(seen.iter()).enumerate() {
            let after = seen.get(i + 1).map_or(first, |&after| after);
            let outside = &mut facets[(side >> 2) as usize];
            let to = outside[(side & 3) as usize];
            outside[3 + (side & 3) as usize] = link(slot, 0);
            facets[slot as usize] = [from, to, p, side, link(after, 2), link(before, 1)];
            let next = Ray::new(target, cloud.point(to));
            poles[slot as usize] = pole(target, ray, next, cloud.noise());
            (ray, from, before) = (next, to, slot);
        }
        self.last = first;
    }

    /// Finds the pole of a facet from its corners.
    pub(super) fn set_pole<S: Signs>(&mut self, cloud: &Cloud<S>, f: u32) {
        let [a, b, c] = self.facet(f).corners.map(|v| cloud.point(v));
        self.poles[f as usize] = pole(c, Ray::new(c, a), Ray::new(c, b), cloud.noise());
    }
}

/// The same for a point too near to the plane for the pole.
#[cold]
#[inline(never)]
fn sees_closely<S: Signs>(cloud: &Cloud<S>, slot: &Slot, p: u32, has_zeros: &mut bool) -> bool {
    let height = cloud.height([slot[0] & !SEEN, slot[1], slot[2]], p);
    *has_zeros |= height == Side::On;
    height == Side::Normal
}
