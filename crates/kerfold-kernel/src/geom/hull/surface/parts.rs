//! A surface in parts that grow side by side, each in its own stretch of the slots.
//!
//! A facet at the border of a part is never replaced there, so it keeps its slot, and the parts fit
//! together again whatever happened inside them.

use super::{BORDER, NONE, Pole, Slot, Surface, link};

/// How a surface was divided.
pub(in super::super) struct Division {
    /// For each slot of the whole surface its part; `NONE` for free slots.
    part_of: Vec<u32>,
    /// For each slot of the whole surface the slot in its part.
    slot_in_part: Vec<u32>,
    /// For each part its first slot, and one more for the end.
    begins: Vec<usize>,
}

/// What is left of a part when it has grown and its facets point into the whole surface again.
pub(in super::super) struct Growth {
    used: usize,
    count: usize,
    free: Vec<u32>,
    has_zeros: bool,
}

impl Division {
    /// Part and slot there of a facet as it was in the whole surface; `None` for a free slot.
    pub(in super::super) fn place_of(&self, f: u32) -> Option<(usize, u32)> {
        let part = self.part_of[f as usize];
        (part != NONE).then(|| (part as usize, self.slot_in_part[f as usize]))
    }

    /// The first slot of a part in the whole surface.
    pub(in super::super) fn begin(&self, part: usize) -> u32 {
        self.begins[part] as u32
    }
}

impl Surface<'_> {
    /// Divides the surface by what `part_of` says of each facet's first corner. `room` says for
    /// each part how many facets can be added there.
    ///
    /// Until [`Self::join`] the surface itself is of no use.
    pub(in super::super) fn divide(
        &mut self,
        room: &[usize],
        part_of: impl Fn(u32) -> usize,
    ) -> (Vec<Surface<'_>>, Division) {
        let whole: Vec<Slot> = self.facets[..self.used].to_vec();
        let poles: Vec<Pole> = self.poles[..self.used].to_vec();
        self.facets[..self.used].fill([0; 6]);
        let mut sizes = vec![0; room.len()];
        let mut division = Division {
            part_of: vec![NONE; whole.len()],
            slot_in_part: vec![NONE; whole.len()],
            begins: vec![0],
        };
        for (f, facet) in whole.iter().enumerate().filter(|(_, facet)| facet[0] != facet[1]) {
            let part = part_of(facet[0]);
            division.part_of[f] = part as u32;
            division.slot_in_part[f] = sizes[part] as u32;
            sizes[part] += 1;
        }
        for (size, room) in sizes.iter().zip(room) {
            division.begins.push(division.begins[division.begins.len() - 1] + size + room);
        }
        for (f, facet) in whole.iter().enumerate() {
            if let Some((part, slot)) = division.place_of(f as u32) {
                let [a, b, c, across @ ..] = *facet;
                let [ab, bc, ca] = across.map(|side| match division.place_of(side >> 2) {
                    Some((other, slot)) if other != part => {
                        link(division.begin(other) + slot, side & 3) | BORDER
                    }
                    place => place.map_or(NONE, |(_, slot)| link(slot, side & 3)),
                });
                let at = division.begins[part] + slot as usize;
                self.facets[at] = [a, b, c, ab, bc, ca];
                self.poles[at] = poles[f];
            }
        }
        let (mut facets, mut poles) = (&mut *self.facets, &mut *self.poles);
        let mut parts = Vec::with_capacity(sizes.len());
        for (part, size) in sizes.into_iter().enumerate() {
            let slots = division.begins[part + 1] - division.begins[part];
            let (own_facets, own_poles);
            (own_facets, facets) = facets.split_at_mut(slots);
            (own_poles, poles) = poles.split_at_mut(slots);
            parts.push(Surface::with_facets(own_facets, own_poles, size));
        }
        (parts, division)
    }

    /// Ends the growth of a part that begins at slot `begin` of the whole surface: its facets point
    /// into that again.
    pub(in super::super) fn into_growth(self, begin: u32) -> Growth {
        for slot in self.facets[..self.used].iter_mut().filter(|slot| slot[0] != slot[1]) {
            for side in &mut slot[3..] {
                *side = if *side & BORDER == 0 { link(begin, 0) + *side } else { *side & !BORDER };
            }
        }
        let free = self.free.iter().map(|&f| begin + f).collect();
        Growth { used: self.used, count: self.count, free, has_zeros: self.has_zeros }
    }

    /// Puts the parts together again.
    pub(in super::super) fn join(&mut self, parts: Vec<Growth>, division: &Division) {
        self.free.clear();
        self.count = 0;
        self.used = division.begins[parts.len()];
        for (part, ends) in parts.into_iter().zip(division.begins.windows(2)) {
            self.count += part.count;
            self.has_zeros |= part.has_zeros;
            self.free.extend(part.free);
            self.free.extend((ends[0] + part.used..ends[1]).map(|f| f as u32));
        }
        let first = self.live().next();
        self.last = first.unwrap_or(0);
    }

    /// Where the next walk begins, if that slot still holds a facet.
    pub(in super::super) fn go_to(&mut self, f: u32) {
        if !self.is_free(f) {
            self.last = f;
        }
    }
}
