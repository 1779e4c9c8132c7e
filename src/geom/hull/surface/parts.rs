//! A surface in parts that grow side by side.
//!
//! A facet at the border of a part is never replaced there, so it keeps its slot, and the parts fit together again whatever
//! happened inside them.

use super::{BORDER, Facet, NONE, Scratch, Surface};

/// How a surface was divided.
pub(in super::super) struct Division {
    /// For each slot of the whole surface its part; `NONE` for free slots.
    part_of: Vec<u32>,
    /// For each slot of the whole surface the slot in its part.
    slot_in_part: Vec<u32>,
}

impl Division {
    /// Part and slot there of a facet of the whole surface; `None` for a free slot.
    pub(in super::super) fn place_of(&self, f: u32) -> Option<(usize, u32)> {
        let part = self.part_of[f as usize];
        (part != NONE).then(|| (part as usize, self.slot_in_part[f as usize]))
    }
}

impl Surface {
    /// Divides the surface, which is left empty, by what `part_of` says of each facet. `room` tells for each part how many facets to expect
    /// at least.
    pub(in super::super) fn divide(
        &mut self,
        room: &[usize],
        part_of: impl Fn(&Facet) -> usize,
    ) -> (Vec<Self>, Division) {
        let whole = std::mem::take(&mut self.facets);
        self.free.clear();
        let mut parts: Vec<Self> = room.iter().map(|&room| Self::empty(room)).collect();
        let mut division = Division { part_of: vec![NONE; whole.len()], slot_in_part: vec![NONE; whole.len()] };
        for (f, facet) in whole.iter().enumerate().filter(|(_, facet)| facet.corners[0] != NONE) {
            let part = part_of(facet);
            division.part_of[f] = part as u32;
            division.slot_in_part[f] = parts[part].facets.len() as u32;
            parts[part].facets.push(*facet);
        }
        for (k, part) in parts.iter_mut().enumerate() {
            for g in part.facets.iter_mut().flat_map(|facet| &mut facet.across) {
                let is_here = division.part_of[*g as usize] == k as u32;
                *g = if is_here { division.slot_in_part[*g as usize] } else { *g | BORDER };
            }
        }
        (parts, division)
    }

    fn empty(room: usize) -> Self {
        Self {
            facets: Vec::with_capacity(room),
            free: Vec::new(),
            last: 0,
            apex: None,
            has_zeros: false,
            random: 1,
            scratch: Scratch::default(),
        }
    }

    /// Puts the parts together again.
    pub(in super::super) fn join(&mut self, parts: Vec<Self>, division: &Division) {
        let mut bases = Vec::with_capacity(parts.len());
        let mut slots = 0;
        for part in &parts {
            bases.push(slots);
            slots += part.facets.len() as u32;
        }
        let whole_slot = |f: u32| {
            let f = (f & !BORDER) as usize;
            bases[division.part_of[f] as usize] + division.slot_in_part[f]
        };
        for (mut part, &base) in parts.into_iter().zip(&bases) {
            for facet in part.facets.iter_mut().filter(|facet| facet.corners[0] != NONE) {
                facet.across = facet.across.map(|g| if g & BORDER == 0 { base + g } else { whole_slot(g) });
            }
            self.free.extend(part.free.iter().map(|&f| base + f));
            self.has_zeros |= part.has_zeros;
            // The first part has room for all.
            if base == 0 { self.facets = part.facets } else { self.facets.append(&mut part.facets) }
        }
        let first = self.live().next();
        self.last = first.unwrap_or(0);
    }

    /// Where the next walk begins, if that slot still holds a facet.
    pub(in super::super) fn go_to(&mut self, f: u32) {
        if self.facets[f as usize].corners[0] != NONE {
            self.last = f;
        }
    }
}
