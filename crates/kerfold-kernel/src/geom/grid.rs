//! A sparse grid over points: which of them lie near a place, in any number of dimensions.

use std::collections::HashMap;

/// The mark for "no further point".
const NONE: u32 = u32::MAX;

/// The cell of a place, in whole steps from the corner of the grid.
pub type Cell<const D: usize> = [i64; D];

/// Points in the cells of a grid. Only cells that hold points take memory. The points are numbered
/// in the order in which they are put in, and every cell gives them in that order.
///
/// ```
/// use kerfold_kernel::geom::Grid;
///
/// let mut grid = Grid::new([0.0, 0.0], 1.0);
/// for p in [[0.2, 0.2], [5.0, 5.0], [1.1, 0.1]] {
///     grid.insert(p);
/// }
/// let near: Vec<u32> = grid.around([0.9, 0.9]).collect();
/// assert_eq!(near, [0, 2]);
/// ```
#[derive(Debug, Clone)]
pub struct Grid<const D: usize> {
    low: [f64; D],
    cell: f64,
    /// First and last point of every cell.
    ends: HashMap<Cell<D>, [u32; 2]>,
    /// For every point the next one in its cell.
    next: Vec<u32>,
}

impl<const D: usize> Grid<D> {
    /// An empty grid whose cells have the given side, more than 0. `low` is a corner of what it
    /// will hold; it only keeps the numbers of the cells small.
    pub fn new(low: [f64; D], cell: f64) -> Self {
        Self { low, cell, ends: HashMap::new(), next: Vec::new() }
    }

    /// The side of a cell.
    pub fn cell_size(&self) -> f64 {
        self.cell
    }

    /// The cell of a place. Places beyond the range of whole numbers go to the outermost cells.
    pub fn cell_of(&self, p: [f64; D]) -> Cell<D> {
        std::array::from_fn(|k| ((p[k] - self.low[k]) / self.cell).floor() as i64)
    }

    /// Puts a point in; its number.
    pub fn insert(&mut self, p: [f64; D]) -> u32 {
        self.insert_into(self.cell_of(p))
    }

    /// Puts a point into a cell that need not be its own; its number.
    pub fn insert_into(&mut self, cell: Cell<D>) -> u32 {
        let number = self.next.len() as u32;
        self.next.push(NONE);
        let ends = self.ends.entry(cell).or_insert([number; 2]);
        if ends[1] != number {
            self.next[ends[1] as usize] = number;
            ends[1] = number;
        }
        number
    }

    /// The points in one cell.
    pub fn in_cell(&self, cell: Cell<D>) -> impl Iterator<Item = u32> + '_ {
        let first = self.ends.get(&cell).map(|ends| ends[0]);
        std::iter::successors(first, |&number| {
            Some(self.next[number as usize]).filter(|&next| next != NONE)
        })
    }

    /// The points in the cell of a place and in its neighbours: all that are at most one side of a
    /// cell away are among them.
    pub fn around(&self, p: [f64; D]) -> impl Iterator<Item = u32> + '_ {
        let home = self.cell_of(p);
        neighbours(home).flat_map(|cell| self.in_cell(cell))
    }
}

/// A cell with the cells that touch it, in order of their numbers.
fn neighbours<const D: usize>(home: Cell<D>) -> impl Iterator<Item = Cell<D>> {
    let count = 3_usize.pow(D as u32);
    (0..count).filter_map(move |step| {
        let mut rest = step;
        let mut cell = home;
        for side in cell.iter_mut().rev() {
            // There is nothing beyond the outermost cells.
            *side = side.checked_add(rest as i64 % 3 - 1)?;
            rest /= 3;
        }
        Some(cell)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_points_within_a_cell_are_found_in_order_and_few_others() {
        let mut rng = crate::random::Rng::new(3);
        let points: Vec<[f64; 3]> =
            (0..500).map(|_| std::array::from_fn(|_| rng.unit() * 8.0 - 4.0)).collect();
        let mut grid = Grid::new([-4.0; 3], 1.0);
        for &p in &points {
            grid.insert(p);
        }
        let apart = |p: [f64; 3], q: [f64; 3]| (0..3).map(move |k| (p[k] - q[k]).abs());
        for &p in &points {
            let found: Vec<u32> = grid.around(p).collect();
            for (number, &q) in points.iter().enumerate() {
                let is_found = found.contains(&(number as u32));
                assert!(is_found || apart(p, q).any(|d| d > 1.0));
                assert!(!is_found || apart(p, q).all(|d| d < 2.0));
            }
        }
        let cell = grid.cell_of(points[0]);
        assert!(grid.in_cell(cell).is_sorted());
    }

    #[test]
    fn places_beyond_all_numbers_have_a_cell() {
        let mut grid = Grid::new([0.0], 1e-300);
        grid.insert([1e300]);
        assert_eq!(grid.around([f64::MAX]).count(), 1);
        assert_eq!(grid.around([-1e300]).count(), 0);
    }
}
