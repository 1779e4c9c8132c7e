//! Repeatable random numbers: splitmix64 (Steele, Lea and Flood 2014).

use glam::DVec3;

/// A generator with a seed.
#[derive(Debug, Clone)]
pub(super) struct Random(u64);

impl Random {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// A number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number from 0 to below `count`, which must not be 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// A direction, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        super::start::unit_vector(2.0 * self.unit() - 1.0, self.unit() * std::f64::consts::TAU)
    }

    /// Brings `count` random entries to the front, in random order.
    pub fn shuffle_front<T>(&mut self, values: &mut [T], count: usize) {
        for i in 0..count.min(values.len()) {
            let j = i + self.below(values.len() - i);
            values.swap(i, j);
        }
    }
}
