//! Sparse linear systems that are symmetric and positive definite, solved directly.
//!
//! The order of elimination is a nested dissection by geometry (George 1973; Gilbert, Teng 1987):
//! unknowns that belong to places on a surface are halved along the widest axis, the ones that
//! stand between the halves come last. On surfaces the factor then holds of the order of n log n
//! numbers, where the order of a file could cost n².

use glam::DVec3;
use nalgebra::DMatrix;
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::{CooMatrix, CscMatrix, CsrMatrix};

/// Below this many places a part is not halved any further.
const SMALL: usize = 24;

/// A row of a sparse matrix: columns and values.
pub type SparseRow = Vec<(usize, f64)>;

/// The multipliers of a least-squares problem with linear constraints: solves `(A W Aᵀ + shift I) y
/// = b` for y.
///
/// `rows` are the rows of A, `weights` the diagonal of W (not negative), `order` the rows in the
/// order of elimination, each once. `None` when the matrix is not positive definite within
/// rounding; a larger shift helps.
pub fn solve_normal(
    rows: &[SparseRow],
    weights: &[f64],
    shift: f64,
    order: &[usize],
    b: &[f64],
) -> Option<Vec<f64>> {
    let count = rows.len();
    let mut scaled = CooMatrix::new(count, weights.len());
    for (i, &row) in order.iter().enumerate() {
        for &(column, value) in &rows[row] {
            scaled.push(i, column, value * weights[column].sqrt());
        }
    }
    let scaled = CsrMatrix::from(&scaled);
    let mut identity = CsrMatrix::identity(count);
    identity.values_mut().fill(shift);
    let system = &scaled * &scaled.transpose() + identity;
    // Symmetric, so that rows are columns.
    let (offsets, indices, values) = system.disassemble();
    let system = CscMatrix::try_from_csc_data(count, count, offsets, indices, values).ok()?;
    let factor = CscCholesky::factor(&system).ok()?;
    let right = DMatrix::from_iterator(count, 1, order.iter().map(|&row| b[row]));
    let solved = factor.solve(&right);
    let mut y = vec![0.0; count];
    for (i, &row) in order.iter().enumerate() {
        y[row] = solved[(i, 0)];
    }
    y.iter().all(|x| x.is_finite()).then_some(y)
}

/// An order of places such that eliminating them one after the other fills in little.
/// `neighbours(i)` are the places that share an equation with the i-th. Deterministic.
pub fn nested_dissection(places: &[DVec3], neighbours: &[Vec<usize>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(places.len());
    let mut part = vec![0_u32; places.len()];
    let mut next_part = 0;
    dissect((0..places.len()).collect(), places, neighbours, &mut part, &mut next_part, &mut order);
    order
}

fn dissect(
    mut all: Vec<usize>,
    places: &[DVec3],
    neighbours: &[Vec<usize>],
    part: &mut [u32],
    next_part: &mut u32,
    order: &mut Vec<usize>,
) {
    if all.len() <= SMALL {
        order.extend(all);
        return;
    }
    let low = all.iter().fold(DVec3::INFINITY, |low, &i| low.min(places[i]));
    let high = all.iter().fold(DVec3::NEG_INFINITY, |high, &i| high.max(places[i]));
    let axis = (high - low).max_position();
    let key = |i: usize| places[i][axis];
    let middle = all.len() / 2;
    all.select_nth_unstable_by(middle, |&i, &j| key(i).total_cmp(&key(j)).then(i.cmp(&j)));
    let mut right = all.split_off(middle);
    right.sort_unstable();
    all.sort_unstable();
    *next_part += 1;
    let mark = *next_part;
    right.iter().for_each(|&i| part[i] = mark);
    let (between, left): (Vec<usize>, Vec<usize>) =
        all.into_iter().partition(|&i| neighbours[i].iter().any(|&j| part[j] == mark));
    dissect(left, places, neighbours, part, next_part, order);
    dissect(right, places, neighbours, part, next_part, order);
    order.extend(between);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of n × n places, each with an equation that says how it bends against its four
    /// neighbours.
    fn grid(n: usize) -> (Vec<DVec3>, Vec<Vec<usize>>, Vec<SparseRow>) {
        let at = |x: usize, y: usize| y * n + x;
        let (mut places, mut neighbours, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..n * n {
            let (x, y) = (i % n, i / n);
            places.push(DVec3::new(x as f64, y as f64, 0.0));
            let mut near = Vec::new();
            for (dx, dy) in [(0, 1), (1, 0), (2, 1), (1, 2)] {
                let (u, v) = (x + dx, y + dy);
                if (1..=n).contains(&u) && (1..=n).contains(&v) {
                    near.push(at(u - 1, v - 1));
                }
            }
            rows.push(std::iter::once((i, 4.5)).chain(near.iter().map(|&j| (j, -1.0))).collect());
            // Rows meet in A Aᵀ when they share a column, so a place's neighbours are two steps
            // away, too.
            neighbours.push(near);
        }
        let two_steps: Vec<Vec<usize>> = (0..n * n)
            .map(|i| {
                let mut all: Vec<usize> =
                    neighbours[i].iter().flat_map(|&j| neighbours[j].clone()).collect();
                all.extend(&neighbours[i]);
                all.sort_unstable();
                all.dedup();
                all
            })
            .collect();
        (places, two_steps, rows)
    }

    #[test]
    fn the_order_holds_every_place_once_and_the_solution_solves() {
        let (places, neighbours, rows) = grid(30);
        let order = nested_dissection(&places, &neighbours);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..900));
        let weights: Vec<f64> =
            (0..900).map(|i| if i % 7 == 0 { 0.0 } else { 1.0 + i as f64 / 900.0 }).collect();
        let b: Vec<f64> = (0..900).map(|i| (i as f64 * 0.7).sin()).collect();
        let y = solve_normal(&rows, &weights, 0.1, &order, &b).expect("positive definite");
        // Back through the definition: W Aᵀ y, then A of that, plus the shift.
        let mut columns = vec![0.0; 900];
        rows.iter().zip(&y).for_each(|(row, y)| row.iter().for_each(|&(j, a)| columns[j] += a * y));
        columns.iter_mut().zip(&weights).for_each(|(c, w)| *c *= w);
        for (i, row) in rows.iter().enumerate() {
            let value = row.iter().map(|&(j, a)| a * columns[j]).sum::<f64>() + 0.1 * y[i];
            assert!((value - b[i]).abs() < 1e-10, "{i}: {value} {}", b[i]);
        }
    }

    #[test]
    fn a_singular_system_is_refused() {
        let rows = vec![vec![(0, 1.0)], vec![(0, 1.0)]];
        assert!(solve_normal(&rows, &[1.0], 0.0, &[0, 1], &[1.0, 2.0]).is_none());
        assert!(solve_normal(&rows, &[1.0], 1e-3, &[0, 1], &[1.0, 1.0]).is_some());
    }
}
