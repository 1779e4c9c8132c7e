//! The exact sign of a 4×4 determinant: on which side of three others a fourth plane passes their
//! meeting point.
//!
//! Source: Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates": sums and products of doubles are kept as expansions, unevaluated sums of doubles
//! that do not overlap, smallest first.

use crate::geom::Side;

/// The sign of the determinant of four rows, exact barring overflow and underflow.
pub(super) fn sign_of_determinant(rows: [[f64; 4]; 4]) -> Side {
    // Laplace expansion by the 2×2 minors of the upper two and the lower two rows.
    let upper = |i, j| minor(rows[0], rows[1], i, j);
    let lower = |i, j| minor(rows[2], rows[3], i, j);
    let first: Expansion<64> =
        product(&upper(0, 1), &lower(2, 3)).plus(&product(&upper(2, 0), &lower(1, 3)));
    let second: Expansion<64> =
        product(&upper(0, 3), &lower(1, 2)).plus(&product(&upper(1, 2), &lower(0, 3)));
    let third: Expansion<64> =
        product(&upper(3, 1), &lower(0, 2)).plus(&product(&upper(2, 3), &lower(0, 1)));
    let most: Expansion<128> = first.plus(&second);
    let all: Expansion<192> = most.plus(&third);
    Side::of(all.leading())
}

/// The determinant of three columns of three rows, right to about an ulp barring overflow and
/// underflow.
pub(super) fn determinant_of_three(rows: &[[f64; 4]; 3], [i, j, k]: [usize; 3]) -> f64 {
    let [upper, middle, lower] = rows;
    let first = minor(*upper, *middle, i, j).scaled(lower[k]);
    let second = minor(*upper, *middle, j, k).scaled(lower[i]);
    let third = minor(*upper, *middle, k, i).scaled(lower[j]);
    let two: Expansion<16> = first.plus(&second);
    let all: Expansion<24> = two.plus(&third);
    all.value()
}

/// n·x − d with the rounding errors of products and sums added up in a second double: right to
/// about an ulp even where the terms cancel (Ogita, Rump and Oishi 2005, "Accurate Sum and Dot
/// Product").
pub(super) fn excess(n: [f64; 3], x: [f64; 3], d: f64) -> f64 {
    let (mut sum, mut errors) = (-d, 0.0);
    for i in 0..3 {
        let (product, product_error) = two_product(n[i], x[i]);
        let (next, sum_error) = two_sum(sum, product);
        sum = next;
        errors += product_error + sum_error;
    }
    sum + errors
}

/// `a[i]·b[j] − a[j]·b[i]`.
fn minor(a: [f64; 4], b: [f64; 4], i: usize, j: usize) -> Expansion<4> {
    let (high, low) = two_product(a[i], b[j]);
    let (other_high, other_low) = two_product(a[j], b[i]);
    Expansion::<2>::pair(high, low).plus(&Expansion::<2>::pair(-other_high, -other_low))
}

fn product(a: &Expansion<4>, b: &Expansion<4>) -> Expansion<32> {
    let mut sum = Expansion::<32>::default();
    for &factor in b.terms() {
        sum = sum.plus(&a.scaled(factor));
    }
    sum
}

/// A sum of doubles that do not overlap, smallest first; at most N of them, zeros left out.
#[derive(Clone, Copy)]
struct Expansion<const N: usize> {
    terms: [f64; N],
    length: usize,
}

impl<const N: usize> Default for Expansion<N> {
    fn default() -> Self {
        Self { terms: [0.0; N], length: 0 }
    }
}

impl Expansion<2> {
    fn pair(high: f64, low: f64) -> Self {
        let mut pair = Self::default();
        pair.push(low);
        pair.push(high);
        pair
    }
}

impl<const N: usize> Expansion<N> {
    fn terms(&self) -> &[f64] {
        &self.terms[..self.length]
    }

    fn push(&mut self, term: f64) {
        if term != 0.0 {
            self.terms[self.length] = term;
            self.length += 1;
        }
    }

    /// The largest term: it carries the sign of the sum.
    fn leading(&self) -> f64 {
        self.terms().last().copied().unwrap_or(0.0)
    }

    /// The sum as one double.
    fn value(&self) -> f64 {
        self.terms().iter().sum()
    }

    /// Fast-Expansion-Sum (Shewchuk 1997, figure 8): both are merged by size and added up. M must
    /// hold both.
    fn plus<const K: usize, const M: usize>(&self, other: &Expansion<K>) -> Expansion<M> {
        let (a, b) = (self.terms(), other.terms());
        let mut sum = Expansion::default();
        let (mut i, mut j, mut carry) = (0, 0, 0.0);
        while i < a.len() || j < b.len() {
            let take_a = j == b.len() || (i < a.len() && a[i].abs() <= b[j].abs());
            let term = if take_a { a[i] } else { b[j] };
            if take_a {
                i += 1
            } else {
                j += 1
            }
            let (next, error) = two_sum(carry, term);
            sum.push(error);
            carry = next;
        }
        sum.push(carry);
        sum
    }

    /// Scale-Expansion (Shewchuk 1997, figure 13): eight terms hold four times a double.
    fn scaled(&self, factor: f64) -> Expansion<8> {
        let mut scaled = Expansion::default();
        let mut carry = 0.0;
        for &term in self.terms() {
            let (high, low) = two_product(term, factor);
            let (middle, error) = two_sum(carry, low);
            scaled.push(error);
            let (next, error) = two_sum(high, middle);
            scaled.push(error);
            carry = next;
        }
        scaled.push(carry);
        scaled
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// Product and its rounding error after Dekker and Veltkamp: without a fused multiply-add, which is
/// slow where the processor has none.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2²⁷ + 1
    let shifted = SPLITTER * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn by_integers(rows: [[i64; 4]; 4]) -> Side {
        let m = |a: usize, b: usize, i: usize, j: usize| {
            i128::from(rows[a][i]) * i128::from(rows[b][j])
                - i128::from(rows[a][j]) * i128::from(rows[b][i])
        };
        let pairs = [
            (0, 1, 2, 3, 1),
            (0, 2, 1, 3, -1),
            (0, 3, 1, 2, 1),
            (1, 2, 0, 3, 1),
            (1, 3, 0, 2, -1),
            (2, 3, 0, 1, 1),
        ];
        let sum: i128 =
            pairs.iter().map(|&(i, j, k, l, sign)| sign * m(0, 1, i, j) * m(2, 3, k, l)).sum();
        Side::of(sum.signum() as f64)
    }

    proptest! {
        #[test]
        fn the_determinant_agrees_with_integers(
            rows in prop::array::uniform3(prop::array::uniform4(-(1_i64 << 28)..1 << 28)),
            weights in prop::array::uniform3(-2_i64..3),
            nudge in -1_i64..=1,
        ) {
            // The last row is a combination of the others up to a nudge: no filter could tell the
            // sign.
            let mut last = std::array::from_fn(|i| (0..3).map(|r| weights[r] * rows[r][i]).sum::<i64>());
            last[3] += nudge;
            let all = [rows[0], rows[1], rows[2], last];
            let exact = by_integers(all);
            let scaled = all.map(|row| row.map(|x| x as f64 * 0.125));
            prop_assert_eq!(sign_of_determinant(scaled), exact);
        }

        #[test]
        fn the_excess_is_right_where_terms_cancel(n in prop::array::uniform3(-(1_i64 << 40)..1 << 40), x in prop::array::uniform3(-(1_i64 << 10)..1 << 10), nudge in -1_i64..=1) {
            let d = (0..3).map(|i| n[i] * x[i]).sum::<i64>() - nudge;
            let (n, x) = (n.map(|v| v as f64 / 1024.0), x.map(|v| v as f64));
            prop_assert_eq!(excess(n, x, d as f64 / 1024.0), nudge as f64 / 1024.0);
        }
    }
}
