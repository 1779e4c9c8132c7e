//! Repeatable random numbers: splitmix64 (Steele, Lea and Flood 2014).

use glam::DVec2;

/// A generator with a seed.
#[derive(Debug, Clone)]
pub(super) struct Chance(u64);

impl Chance {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// A number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number between two; the middle when the second is not above the first.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = self.unit();
        if high > low { low + (high - low) * unit } else { low.midpoint(high) }
    }

    /// A point of a box; in the middle of an extent that is empty.
    pub fn point(&mut self, low: DVec2, high: DVec2) -> DVec2 {
        let x = self.between(low.x, high.x);
        DVec2::new(x, self.between(low.y, high.y))
    }

    /// A number from −1 to 1 that is more often small.
    pub fn near_zero(&mut self) -> f64 {
        self.unit() + self.unit() + self.unit() + self.unit() - 2.0
    }

    /// A number from 0 to below `count`, which must not be 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// Brings values into random order.
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for i in (1..values.len()).rev() {
            let j = self.below(i + 1);
            values.swap(i, j);
        }
    }
}
