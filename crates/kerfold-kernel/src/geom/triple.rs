//! The triple product of three differences of points, to about the last digit of the result.
//!
//! Sums and products are kept as a number and its rounding error (Dekker 1971, "A floating-point
//! technique for extending the available precision"; Knuth 1997, 4.2.2, theorem B), so that long
//! thin triangles, whose terms nearly cancel, keep their digits.

use glam::DVec3;

/// A number as the sum of two, the second below the rounding of the first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// The exact difference of two numbers.
    fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let b_seen = a - high;
        Self { high, low: (a - (high + b_seen)) + (b_seen - b) }
    }

    /// The sum, right to about 100 bits.
    pub fn plus(self, other: Self) -> Self {
        let high = self.high + other.high;
        let seen = high - self.high;
        let error = (self.high - (high - seen)) + (other.high - seen);
        Self::settled(high, error + self.low + other.low)
    }

    fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    fn times(self, other: Self) -> Self {
        let high = self.high * other.high;
        let (a, b) = (halves(self.high), halves(other.high));
        let error = ((a.0 * b.0 - high) + a.0 * b.1 + a.1 * b.0) + a.1 * b.1;
        Self::settled(high, error + self.high * other.low + self.low * other.high)
    }

    fn settled(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }

    /// The nearest plain number.
    pub fn value(self) -> f64 {
        self.high + self.low
    }
}

/// A number in two parts of 26 bits each.
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

/// `(a − o) · ((b − o) × (c − o))`: six times the signed volume of a tetrahedron.
pub fn triple_product(o: DVec3, [a, b, c]: [DVec3; 3]) -> Double {
    let from = |p: DVec3| [0, 1, 2].map(|i| Double::difference(p[i], o[i]));
    let (a, b, c) = (from(a), from(b), from(c));
    let minor = |i: usize, j: usize| b[i].times(c[j]).minus(b[j].times(c[i]));
    let [x, y, z] = [a[0].times(minor(1, 2)), a[1].times(minor(2, 0)), a[2].times(minor(0, 1))];
    x.plus(y).plus(z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_far_away_keeps_its_digits() {
        // Exact in binary: a, b and c nearly in one line, far from the origin of coordinates.
        let o = DVec3::new(1024.0, -512.0, 64.0);
        let tiny = 2.0_f64.powi(-30);
        let along = DVec3::new(100.0, 70.0, -33.0);
        let points =
            [o + along, o - along * 0.5 + DVec3::X * tiny, o + along * 0.25 + DVec3::Y * tiny];
        // det(u, −u/2 + t x, u/4 + t y) = t² det(u, x, y) = t² u.z
        let exact = tiny * tiny * along.z;
        let found = triple_product(o, points).value();
        assert!((found - exact).abs() <= 1e-12 * exact.abs(), "{found:e} for {exact:e}");
    }
}
