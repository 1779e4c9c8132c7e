//! Cholesky factors of large sparse matrices that are sums of small dense ones.
//!
//! The matrix has a *node* for each place, with a few unknowns of its own (its *width*), and is the
//! sum of dense blocks over *cliques* of nodes, as finite elements are. It is eliminated front by
//! front (Duff, Reid 1983; Liu 1992, "The multifrontal method"): columns with one pattern are
//! eliminated together in one dense matrix, and what is left of it is handed to the parent. Nearly
//! all of the time goes into dense products. The analysis depends on the pattern alone and is made
//! once for many matrices.

use glam::DVec3;

use super::sparse::nested_dissection;

/// So many columns are eliminated before the rest of a front is brought up to date.
const BLOCK: usize = 48;
/// Columns are eliminated together when that adds at most this share of zeros to their pattern.
const ZEROS: f64 = 0.2;

/// The pattern of a matrix: the order of elimination and the fronts. See the module.
#[derive(Debug)]
pub struct Fronts {
    width: usize,
    /// The place of each node in the order of elimination.
    place: Vec<usize>,
    fronts: Vec<Front>,
    /// For each clique its nodes, and where the block of each pair of them is added: pairs (i, j)
    /// row by row with j up to i.
    cliques: Vec<Clique>,
    values: usize,
}

/// Columns that are eliminated together.
#[derive(Debug)]
struct Front {
    first: usize,
    count: usize,
    /// The places below that are coupled with the columns, ascending.
    below: Vec<usize>,
    /// Where its columns begin among the values.
    start: usize,
    children: Vec<usize>,
}

#[derive(Debug)]
struct Clique {
    nodes: Vec<usize>,
    /// Where the block of a pair begins, the number of rows there, and whether the block is to be
    /// transposed.
    targets: Vec<(usize, u32, bool)>,
}

/// The values of a matrix with the pattern of some [`Fronts`].
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    values: Vec<f64>,
}

/// A Cholesky factor with the pattern of some [`Fronts`].
#[derive(Debug)]
pub struct FrontFactor<'a> {
    fronts: &'a Fronts,
    values: Vec<f64>,
}

impl Fronts {
    /// Analyses the pattern of a matrix with `width` unknowns at each of the nodes at `places`,
    /// coupled within each of the cliques. Nodes without a clique must have a shift to be solvable.
    pub fn new(places: &[DVec3], cliques: Vec<Vec<usize>>, width: usize) -> Self {
        let neighbours = neighbours(places.len(), &cliques);
        let order = nested_dissection(places, &neighbours);
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(i, &node)| place[node] = i);
        let patterns = patterns(&order, &place, &neighbours);
        let mut fronts = merge_columns(&patterns);
        let mut values = 0;
        for front in &mut fronts {
            front.start = values;
            values += front.size() * front.count * width * width;
        }
        let mut made = Self { width, place, fronts, cliques: Vec::new(), values };
        made.link_children();
        made.cliques = made.targets(cliques);
        made
    }

    fn link_children(&mut self) {
        let home = self.home();
        for child in 0..self.fronts.len() {
            if let Some(&parent) = self.fronts[child].below.first() {
                self.fronts[home[parent]].children.push(child);
            }
        }
    }

    /// The front of each place.
    fn home(&self) -> Vec<usize> {
        let runs = self.fronts.iter().enumerate();
        runs.flat_map(|(i, front)| std::iter::repeat_n(i, front.count)).collect()
    }

    fn targets(&self, cliques: Vec<Vec<usize>>) -> Vec<Clique> {
        let home = self.home();
        let target = |a: usize, b: usize| {
            let (row, column) =
                (self.place[a].max(self.place[b]), self.place[a].min(self.place[b]));
            let front = &self.fronts[home[column]];
            let rows = front.size() * self.width;
            let offset = (column - front.first) * self.width * rows + front.row(row) * self.width;
            (front.start + offset, rows as u32, self.place[a] < self.place[b])
        };
        let each = |nodes: Vec<usize>| {
            let pairs = (0..nodes.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
            let targets = pairs.map(|(i, j)| target(nodes[i], nodes[j])).collect();
            Clique { nodes, targets }
        };
        cliques.into_iter().map(each).collect()
    }

    /// A matrix of zeros.
    pub fn zeros(&self) -> BlockMatrix {
        BlockMatrix { values: vec![0.0; self.values] }
    }

    /// Gives back the memory that [`Self::add`] needs: for the last matrix of a pattern, before it is
    /// factored. Nothing can be added afterwards.
    pub fn forget_cliques(&mut self) {
        self.cliques = Vec::new();
    }

    /// Adds the block of a clique: a symmetric matrix over the unknowns of its nodes in their
    /// order, row by row.
    pub fn add(&self, matrix: &mut BlockMatrix, clique: usize, block: &[f64]) {
        let Clique { nodes, targets } = &self.cliques[clique];
        let (w, size) = (self.width, nodes.len() * self.width);
        let mut pair = targets.iter();
        for i in 0..nodes.len() {
            for j in 0..=i {
                let &(start, rows, turned) = pair.next().expect("one target for each pair");
                for a in 0..w {
                    let from = if i == j { a } else { 0 };
                    for b in from..w {
                        // Column a, row b of the block below the diagonal.
                        let (row, column) =
                            if turned { (j * w + b, i * w + a) } else { (i * w + b, j * w + a) };
                        matrix.values[start + a * rows as usize + b] += block[row * size + column];
                    }
                }
            }
        }
    }

    /// Factors the matrix with `shift` added to its diagonal, in its own memory; `None` when that is
    /// not positive definite within rounding.
    pub fn factor(&self, matrix: BlockMatrix, shift: f64) -> Option<FrontFactor<'_>> {
        let mut values = matrix.values;
        let mut left: Vec<Option<Vec<f64>>> = vec![None; self.fronts.len()];
        for (i, front) in self.fronts.iter().enumerate() {
            let (rows, columns) = (front.size() * self.width, front.count * self.width);
            let own = &mut values[front.start..front.start + rows * columns];
            (0..columns).for_each(|j| own[j * rows + j] += shift);
            let mut dense = vec![0.0; rows * rows];
            dense[..own.len()].copy_from_slice(own);
            for &child in &front.children {
                let update = left[child].take().unwrap_or_default();
                self.take_over(front, &self.fronts[child], &update, &mut dense);
            }
            eliminate(&mut dense, rows, columns)?;
            own.copy_from_slice(&dense[..rows * columns]);
            left[i] = Some(trailing(&dense, rows, columns));
        }
        Some(FrontFactor { fronts: self, values })
    }

    /// Adds what is left of a child to its parent's dense matrix.
    fn take_over(&self, front: &Front, child: &Front, update: &[f64], dense: &mut [f64]) {
        let (w, rows, size) =
            (self.width, front.size() * self.width, child.below.len() * self.width);
        let to: Vec<usize> = child.below.iter().map(|&p| front.row(p) * w).collect();
        for (j, &column) in to.iter().enumerate() {
            for b in 0..w {
                let from = &update[(j * w + b) * size..][..size];
                let into = &mut dense[(column + b) * rows..][..rows];
                for (i, &row) in to.iter().enumerate().skip(j) {
                    let first = if i == j { b } else { 0 };
                    (first..w).for_each(|a| into[row + a] += from[i * w + a]);
                }
            }
        }
    }
}

impl FrontFactor<'_> {
    /// Solves for a right-hand side over the unknowns of all nodes, in the order of the nodes.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let Fronts { width: w, place, fronts, .. } = self.fronts;
        let mut x = vec![0.0; right.len()];
        for (node, &p) in place.iter().enumerate() {
            x[p * w..][..*w].copy_from_slice(&right[node * w..][..*w]);
        }
        fronts.iter().for_each(|front| self.forward(front, &mut x));
        fronts.iter().rev().for_each(|front| self.backward(front, &mut x));
        let mut solved = vec![0.0; right.len()];
        for (node, &p) in place.iter().enumerate() {
            solved[node * w..][..*w].copy_from_slice(&x[p * w..][..*w]);
        }
        solved
    }

    fn forward(&self, front: &Front, x: &mut [f64]) {
        let w = self.fronts.width;
        let (rows, columns) = (front.size() * w, front.count * w);
        for j in 0..columns {
            let column = &self.values[front.start + j * rows..][..rows];
            let value = x[front.first * w + j] / column[j];
            x[front.first * w + j] = value;
            (j + 1..columns).for_each(|i| x[front.first * w + i] -= column[i] * value);
            for (i, &p) in front.below.iter().enumerate() {
                (0..w).for_each(|a| x[p * w + a] -= column[columns + i * w + a] * value);
            }
        }
    }

    fn backward(&self, front: &Front, x: &mut [f64]) {
        let w = self.fronts.width;
        let (rows, columns) = (front.size() * w, front.count * w);
        for j in (0..columns).rev() {
            let column = &self.values[front.start + j * rows..][..rows];
            let mut value = x[front.first * w + j];
            (j + 1..columns).for_each(|i| value -= column[i] * x[front.first * w + i]);
            for (i, &p) in front.below.iter().enumerate() {
                (0..w).for_each(|a| value -= column[columns + i * w + a] * x[p * w + a]);
            }
            x[front.first * w + j] = value / column[j];
        }
    }
}

impl Front {
    /// Its columns and the places below.
    fn size(&self) -> usize {
        self.count + self.below.len()
    }

    /// The row of a place.
    fn row(&self, place: usize) -> usize {
        if place < self.first + self.count {
            return place - self.first;
        }
        self.count + self.below.binary_search(&place).expect("the place belongs to the front")
    }
}

/// The nodes that share a clique with each node, ascending.
fn neighbours(count: usize, cliques: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut near = vec![Vec::new(); count];
    for clique in cliques {
        for &i in clique {
            near[i].extend(clique.iter().copied().filter(|&j| j != i));
        }
    }
    for list in &mut near {
        list.sort_unstable();
        list.dedup();
    }
    near
}

/// For each place in the order of elimination the later places that its column couples with.
fn patterns(order: &[usize], place: &[usize], neighbours: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut patterns: Vec<Vec<usize>> = Vec::with_capacity(order.len());
    let mut children = vec![Vec::new(); order.len()];
    let mut seen = vec![usize::MAX; order.len()];
    for (p, &node) in order.iter().enumerate() {
        let mut pattern = Vec::new();
        let mut take = |q: usize| {
            if q > p && seen[q] != p {
                seen[q] = p;
                pattern.push(q);
            }
        };
        neighbours[node].iter().for_each(|&n| take(place[n]));
        for &child in &children[p] {
            let below: &Vec<usize> = &patterns[child];
            below.iter().for_each(|&q| take(q));
        }
        pattern.sort_unstable();
        if let Some(&parent) = pattern.first() {
            children[parent].push(p);
        }
        patterns.push(pattern);
    }
    patterns
}

/// Joins columns that follow each other and have nearly one pattern.
fn merge_columns(patterns: &[Vec<usize>]) -> Vec<Front> {
    let mut fronts: Vec<Front> = Vec::new();
    for (p, pattern) in patterns.iter().enumerate() {
        if let Some(last) = fronts.last_mut().filter(|last| last.below.first() == Some(&p)) {
            let zeros = last.count * (pattern.len() + 1 - last.below.len());
            let size = last.count * (last.count + last.below.len());
            if zeros as f64 <= ZEROS * size as f64 {
                last.count += 1;
                last.below.clone_from(pattern);
                continue;
            }
        }
        let below = pattern.clone();
        fronts.push(Front { first: p, count: 1, below, start: 0, children: Vec::new() });
    }
    fronts
}

/// Eliminates the first columns of a dense symmetric matrix of which the lower part is given,
/// column by column. `None` when a pivot is not positive.
fn eliminate(dense: &mut [f64], rows: usize, columns: usize) -> Option<()> {
    let mut start = 0;
    while start < columns {
        let end = (start + BLOCK).min(columns);
        for j in start..end {
            let (before, rest) = dense.split_at_mut(j * rows);
            let column = &mut rest[j..rows];
            for k in start..j {
                let left = &before[k * rows + j..(k + 1) * rows];
                let factor = left[0];
                column.iter_mut().zip(left).for_each(|(c, l)| *c -= factor * l);
            }
            let pivot = column[0];
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let inverse = 1.0 / pivot.sqrt();
            column.iter_mut().for_each(|c| *c *= inverse);
        }
        update(dense, rows, start, end);
        start = end;
    }
    Some(())
}

/// Takes the products of the columns from `start` to `end` off all later columns, four of them at
/// a time.
fn update(dense: &mut [f64], rows: usize, start: usize, end: usize) {
    let (done, rest) = dense.split_at_mut(end * rows);
    for (j, column) in rest.chunks_exact_mut(rows).enumerate() {
        let first = end + j;
        let column = &mut column[first..];
        let mut k = start;
        while k + 4 <= end {
            let [a, b, c, d] =
                [0, 1, 2, 3].map(|i| &done[(k + i) * rows + first..(k + i + 1) * rows]);
            let (fa, fb, fc, fd) = (a[0], b[0], c[0], d[0]);
            let n = column.len();
            let (a, b, c, d) = (&a[..n], &b[..n], &c[..n], &d[..n]);
            for i in 0..n {
                column[i] -= fa * a[i] + fb * b[i] + fc * c[i] + fd * d[i];
            }
            k += 4;
        }
        for k in k..end {
            let left = &done[k * rows + first..(k + 1) * rows];
            let factor = left[0];
            column.iter_mut().zip(left).for_each(|(c, l)| *c -= factor * l);
        }
    }
}

/// The part of a dense matrix behind the eliminated columns.
fn trailing(dense: &[f64], rows: usize, columns: usize) -> Vec<f64> {
    let size = rows - columns;
    let mut rest = vec![0.0; size * size];
    for j in 0..size {
        let from = &dense[(columns + j) * rows + columns..][..size];
        rest[j * size..][..size].copy_from_slice(from);
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of quads as cliques of four nodes, each with a block that is positive definite.
    fn quads(n: usize, width: usize) -> (Vec<DVec3>, Vec<Vec<usize>>, Vec<Vec<f64>>) {
        let places = (0..n * n).map(|i| DVec3::new((i % n) as f64, (i / n) as f64, 0.0)).collect();
        let mut cliques = Vec::new();
        let mut blocks = Vec::new();
        for i in 0..n - 1 {
            for j in 0..n - 1 {
                let at = |x: usize, y: usize| (i + x) * n + j + y;
                cliques.push(vec![at(0, 0), at(1, 1), at(1, 0), at(0, 1)]);
                let size = 4 * width;
                let row = |k: usize| -> Vec<f64> {
                    (0..size).map(|c| ((i * 7 + j * 3 + k * 5 + c * c) as f64).sin()).collect()
                };
                let rows: Vec<Vec<f64>> = (0..size / 2).map(row).collect();
                let entry = |a: usize, b: usize| rows.iter().map(|r| r[a] * r[b]).sum::<f64>();
                blocks.push((0..size * size).map(|k| entry(k / size, k % size)).collect());
            }
        }
        (places, cliques, blocks)
    }

    #[test]
    fn the_factor_solves_what_the_blocks_say() {
        for width in [1, 2, 3] {
            let (places, cliques, blocks) = quads(23, width);
            let fronts = Fronts::new(&places, cliques.clone(), width);
            let mut matrix = fronts.zeros();
            blocks.iter().enumerate().for_each(|(i, block)| fronts.add(&mut matrix, i, block));
            let right: Vec<f64> =
                (0..places.len() * width).map(|i| (i as f64 * 0.3).cos()).collect();
            let x = fronts.factor(matrix.clone(), 0.5).expect("positive definite").solve(&right);
            let mut product: Vec<f64> = x.iter().map(|x| 0.5 * x).collect();
            for (clique, block) in cliques.iter().zip(&blocks) {
                let unknown = |k: usize| clique[k / width] * width + k % width;
                let size = clique.len() * width;
                for a in 0..size {
                    for b in 0..size {
                        product[unknown(a)] += block[a * size + b] * x[unknown(b)];
                    }
                }
            }
            for (p, r) in product.iter().zip(&right) {
                assert!((p - r).abs() < 1e-10, "{p} {r}");
            }
            assert!(fronts.factor(matrix.clone(), -1.0).is_none(), "not positive definite");
        }
    }
}
