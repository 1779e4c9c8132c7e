//! A hash grid of boxes in several sizes: which laid-out faces may touch a given box.
//!
//! Every face lives on the level whose cells are as large as the face, so its box covers at most
//! four cells however much the sizes of the faces differ. All storage is flat; moving a face costs
//! a few links.

use glam::DVec2;

use super::dual::NONE;

/// See the module documentation. Faces of different pieces never meet.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    /// Cell size of level 0.
    base: f64,
    level: Vec<u8>,
    /// Level → its faces, for boxes that would visit more cells than there are faces.
    members: Vec<Vec<u32>>,
    heads: Vec<u32>,
    /// Four links for each face.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    cell: Cell,
    next: u32,
    prev: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Cell {
    x: i32,
    y: i32,
    level: u8,
    piece: u32,
}

impl Cell {
    fn hash(self) -> u64 {
        let place = (self.x as u32 as u64) << 32 | self.y as u32 as u64;
        let kind = (u64::from(self.piece) << 8 | u64::from(self.level))
            .wrapping_mul(0xd6e8_feb8_6659_fd93);
        let mixed = (place ^ kind).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ mixed >> 29
    }
}

const NOWHERE: Cell = Cell { x: 0, y: 0, level: 0, piece: NONE };

impl Grid {
    /// A grid for faces with these diameters, none of them placed yet.
    pub fn new(diameters: &[f64]) -> Self {
        // Below a thousandth of the largest face the cells need not shrink further.
        let largest = diameters.iter().copied().fold(0.0, f64::max);
        let base = diameters.iter().copied().fold(largest, f64::min).max(largest * 1e-3);
        // A little room, so that rounding cannot make a box wider than a cell.
        let level: Vec<u8> =
            diameters.iter().map(|d| (d * 1.001 / base).log2().ceil().max(0.0) as u8).collect();
        let mut members =
            vec![Vec::new(); level.iter().copied().max().map_or(0, |l| l as usize + 1)];
        level.iter().enumerate().for_each(|(f, &l)| members[l as usize].push(f as u32));
        let buckets = (diameters.len() * 4).next_power_of_two();
        let nodes = vec![Node { cell: NOWHERE, next: NONE, prev: NONE }; diameters.len() * 4];
        Self { base, level, members, heads: vec![NONE; buckets], nodes }
    }

    fn cell_size(&self, level: usize) -> f64 {
        self.base * (1_u64 << level) as f64
    }

    fn bucket(&self, cell: Cell) -> usize {
        cell.hash() as usize & (self.heads.len() - 1)
    }

    /// Places a face, which must not be in the grid.
    pub fn insert(&mut self, face: u32, piece: u32, bounds: [DVec2; 2]) {
        let level = self.level[face as usize];
        let [low, high] = cells(bounds, self.cell_size(level as usize));
        let mut node = face * 4;
        for y in low.1..=high.1 {
            for x in low.0..=high.0 {
                let cell = Cell { x, y, level, piece };
                let bucket = self.bucket(cell);
                let next = std::mem::replace(&mut self.heads[bucket], node);
                if next != NONE {
                    self.nodes[next as usize].prev = node;
                }
                self.nodes[node as usize] = Node { cell, next, prev: NONE };
                node += 1;
            }
        }
    }

    /// Takes a face out again.
    pub fn remove(&mut self, face: u32) {
        for node in face * 4..face * 4 + 4 {
            let Node { cell, next, prev } = self.nodes[node as usize];
            if cell == NOWHERE {
                continue;
            }
            if next != NONE {
                self.nodes[next as usize].prev = prev;
            }
            match prev {
                NONE => {
                    let bucket = self.bucket(cell);
                    self.heads[bucket] = next;
                }
                _ => self.nodes[prev as usize].next = next,
            }
            self.nodes[node as usize].cell = NOWHERE;
        }
    }

    /// Calls `visit` once for every face of `piece` whose box, given by `boxes`, may meet `bounds`,
    /// until it returns false. Returns whether all were visited.
    pub fn visit(
        &self,
        piece: u32,
        bounds: [DVec2; 2],
        boxes: &[[DVec2; 2]],
        mut visit: impl FnMut(u32) -> bool,
    ) -> bool {
        for (level, members) in
            self.members.iter().enumerate().filter(|(_, members)| !members.is_empty())
        {
            let size = self.cell_size(level);
            let [low, high] = cells(bounds, size);
            let count = (i64::from(high.0) - i64::from(low.0) + 1)
                * (i64::from(high.1) - i64::from(low.1) + 1);
            let go_on = if count > members.len() as i64 {
                members.iter().all(|&f| {
                    !self.is_in(f, piece) || !touch(bounds, boxes[f as usize]) || visit(f)
                })
            } else {
                self.visit_cells(piece, level as u8, [low, high], |f, x, y| {
                    let other = boxes[f as usize];
                    // A face lies in up to four cells: it counts in the one that holds the lower
                    // corner of the common box.
                    let corner = bounds[0].max(other[0]);
                    !touch(bounds, other) || cells([corner, corner], size)[0] != (x, y) || visit(f)
                })
            };
            if !go_on {
                return false;
            }
        }
        true
    }

    fn is_in(&self, face: u32, piece: u32) -> bool {
        self.nodes[face as usize * 4].cell.piece == piece
    }

    fn visit_cells(
        &self,
        piece: u32,
        level: u8,
        [low, high]: [(i32, i32); 2],
        mut visit: impl FnMut(u32, i32, i32) -> bool,
    ) -> bool {
        for y in low.1..=high.1 {
            for x in low.0..=high.0 {
                let cell = Cell { x, y, level, piece };
                let mut node = self.heads[self.bucket(cell)];
                while node != NONE {
                    let here = self.nodes[node as usize];
                    if here.cell == cell && !visit(node / 4, x, y) {
                        return false;
                    }
                    node = here.next;
                }
            }
        }
        true
    }
}

#[inline]
fn touch(a: [DVec2; 2], b: [DVec2; 2]) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}

#[inline]
fn cells(bounds: [DVec2; 2], size: f64) -> [(i32, i32); 2] {
    bounds.map(|p| (floor(p.x / size), floor(p.y / size)))
}

/// Rounds down by a cast: the library call for it shows in profiles of the search.
#[inline]
fn floor(x: f64) -> i32 {
    let towards_zero = x as i32;
    towards_zero - i32::from(x < f64::from(towards_zero))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_comparing_all_boxes_finds(
            given in prop::collection::vec((-50.0..50.0_f64, -50.0..50.0_f64, 0.01..20.0_f64), 1..60),
            removed in prop::collection::vec(any::<bool>(), 60),
        ) {
            let boxes: Vec<[DVec2; 2]> = given.iter().map(|&(x, y, d)| [DVec2::new(x, y), DVec2::new(x + d * 0.7, y + d * 0.7)]).collect();
            let diameters: Vec<f64> = given.iter().map(|g| g.2).collect();
            let mut grid = Grid::new(&diameters);
            for (i, &b) in boxes.iter().enumerate() {
                grid.insert(i as u32, i as u32 % 2, b);
            }
            let kept: Vec<usize> = (0..boxes.len()).filter(|&i| !removed[i]).collect();
            (0..boxes.len()).filter(|&i| removed[i]).for_each(|i| grid.remove(i as u32));
            for &b in &boxes {
                let mut found = Vec::new();
                grid.visit(1, b, &boxes, |f| { found.push(f as usize); true });
                found.sort_unstable();
                let expected: Vec<usize> = kept.iter().copied().filter(|&i| i % 2 == 1 && touch(b, boxes[i])).collect();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
