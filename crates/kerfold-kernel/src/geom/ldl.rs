//! Sparse linear systems that are symmetric but not definite: `L D Lᵀ` factors without pivoting.
//!
//! Second derivatives at a saddle have a few negative pivots, which their factor counts. The order
//! of elimination is that of least degree (Tinney, Walker 1967), which needs no places, so it also
//! serves surfaces that lie nowhere yet. Without pivoting a pivot may come out near zero; one step
//! of refinement against the given matrix shows and mends what that loses.

use std::collections::BTreeSet;

/// A row of a sparse matrix: columns and values. A column may come several times; its values are
/// added.
type Row = Vec<(usize, f64)>;

/// The factors of a symmetric matrix.
#[derive(Debug, Clone)]
pub struct Ldl {
    /// Place in the elimination → unknown.
    order: Vec<usize>,
    /// Columns of L below the diagonal, by places.
    columns: Vec<Vec<(usize, f64)>>,
    pivots: Vec<f64>,
}

impl Ldl {
    /// Factors the matrix whose rows are given in full, both triangles. `None` when a pivot vanishes
    /// or a number is not finite.
    pub fn new(rows: &[Row]) -> Option<Self> {
        let (order, fill) = least_degree(rows);
        let count = rows.len();
        let mut place = vec![0; count];
        order.iter().enumerate().for_each(|(p, &i)| place[i] = p);
        let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(count);
        let mut pivots = Vec::with_capacity(count);
        // Row p of L as far as it is known: columns and where the entry stands in them.
        let mut left: Vec<Vec<(usize, usize)>> = vec![Vec::new(); count];
        let mut work = vec![0.0; count];
        for p in 0..count {
            let mut below: Vec<usize> = fill[order[p]].iter().map(|&i| place[i]).collect();
            below.sort_unstable();
            for &(i, value) in &rows[order[p]] {
                if place[i] >= p {
                    work[place[i]] += value;
                }
            }
            for &(column, at) in &left[p] {
                let entries: &Vec<(usize, f64)> = &columns[column];
                let factor = entries[at].1 * pivots[column];
                entries[at..].iter().for_each(|&(q, value)| work[q] -= factor * value);
            }
            let pivot = std::mem::take(&mut work[p]);
            if pivot == 0.0 || !pivot.is_finite() {
                return None;
            }
            let mut entries = Vec::with_capacity(below.len());
            for q in below {
                left[q].push((p, entries.len()));
                entries.push((q, std::mem::take(&mut work[q]) / pivot));
            }
            pivots.push(pivot);
            columns.push(entries);
        }
        Some(Self { order, columns, pivots })
    }

    /// How many pivots are negative: as many as the matrix has negative eigenvalues.
    pub fn negative(&self) -> usize {
        self.pivots.iter().filter(|&&d| d < 0.0).count()
    }

    /// Solves for one right side.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut y: Vec<f64> = self.order.iter().map(|&i| b[i]).collect();
        for (p, entries) in self.columns.iter().enumerate() {
            let known = y[p];
            entries.iter().for_each(|&(q, value)| y[q] -= value * known);
        }
        y.iter_mut().zip(&self.pivots).for_each(|(y, d)| *y /= d);
        for (p, entries) in self.columns.iter().enumerate().rev() {
            y[p] -= entries.iter().map(|&(q, value)| value * y[q]).sum::<f64>();
        }
        let mut x = vec![0.0; y.len()];
        self.order.iter().zip(y).for_each(|(&i, y)| x[i] = y);
        x
    }
}

/// Solves a symmetric system with one step of refinement. `None` as for [`Ldl::new`], or when the
/// solution is not finite.
pub fn solve_symmetric(rows: &[Row], b: &[f64]) -> Option<Vec<f64>> {
    let factors = Ldl::new(rows)?;
    let mut x = factors.solve(b);
    let rest: Vec<f64> = rows
        .iter()
        .zip(b)
        .map(|(row, b)| b - row.iter().map(|&(j, value)| value * x[j]).sum::<f64>())
        .collect();
    x.iter_mut().zip(factors.solve(&rest)).for_each(|(x, dx)| *x += dx);
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// The order in which the unknown with the fewest neighbours left is eliminated first, and the
/// neighbours that each has left when its turn comes.
fn least_degree(rows: &[Row]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut near: Vec<BTreeSet<usize>> = rows
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().map(|&(j, _)| j).filter(|&j| j != i).collect())
        .collect();
    let mut queue: BTreeSet<(usize, usize)> =
        near.iter().enumerate().map(|(i, set)| (set.len(), i)).collect();
    let mut order = Vec::with_capacity(rows.len());
    let mut fill = vec![Vec::new(); rows.len()];
    while let Some((_, i)) = queue.pop_first() {
        let left: Vec<usize> = std::mem::take(&mut near[i]).into_iter().collect();
        for &j in &left {
            queue.remove(&(near[j].len(), j));
            near[j].remove(&i);
            near[j].extend(left.iter().copied().filter(|&k| k != j));
            queue.insert((near[j].len(), j));
        }
        fill[i] = left;
        order.push(i);
    }
    (order, fill)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid with as many negative numbers on its diagonal as are asked for.
    fn grid(n: usize, negative: usize) -> Vec<Row> {
        let at = |x: usize, y: usize| y * n + x;
        (0..n * n)
            .map(|i| {
                let (x, y) = (i % n, i / n);
                let mut row = vec![(i, if i < negative { -9.0 } else { 4.5 })];
                let mut link = |j| row.push((j, -1.0));
                if x > 0 {
                    link(at(x - 1, y));
                }
                if y > 0 {
                    link(at(x, y - 1));
                }
                if x + 1 < n {
                    link(at(x + 1, y));
                }
                if y + 1 < n {
                    link(at(x, y + 1));
                }
                row
            })
            .collect()
    }

    #[test]
    fn saddles_are_solved_and_their_signs_counted() {
        for negative in [0, 1, 5] {
            let rows = grid(20, negative);
            let b: Vec<f64> = (0..400).map(|i| (f64::from(i) * 0.7).sin()).collect();
            let x = solve_symmetric(&rows, &b).expect("not singular");
            for (row, b) in rows.iter().zip(&b) {
                let value: f64 = row.iter().map(|&(j, value)| value * x[j]).sum();
                assert!((value - b).abs() < 1e-12, "{value} {b}");
            }
            assert_eq!(Ldl::new(&rows).expect("not singular").negative(), negative);
        }
    }

    #[test]
    fn values_of_one_column_are_added_and_singular_ones_refused() {
        let rows = vec![vec![(0, 1.0), (0, 1.0), (1, 1.0)], vec![(0, 1.0), (1, 0.5)]];
        assert!(Ldl::new(&rows).is_none());
        let rows = vec![vec![(0, 1.0), (0, 1.0), (1, 1.0)], vec![(0, 1.0), (1, 1.5)]];
        let x = solve_symmetric(&rows, &[3.0, 2.5]).expect("2 1; 1 1.5");
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
    }
}
