//! Repeatable random numbers: the same seed gives the same numbers on every machine.
//!
//! The generator is splitmix64 (Steele, Lea and Flood 2014, Fast splittable pseudorandom number
//! generators), by the crate `rand_xoshiro`; how its bits become numbers is fixed here, so that no
//! new version of a crate changes a net or a layout.

use glam::{DVec2, DVec3};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng};

/// A generator with a seed.
#[derive(Debug, Clone)]
pub struct Rng(SplitMix64);

impl Rng {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number from −1 to below 1.
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A number between two; the middle when the second is not above the first.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = self.unit();
        if high > low { low + (high - low) * unit } else { low.midpoint(high) }
    }

    /// A number from −2 to 2 that is more often small: the sum of four.
    pub fn near_zero(&mut self) -> f64 {
        self.unit() + self.unit() + self.unit() + self.unit() - 2.0
    }

    /// A whole number from 0 to below `count`, which must not be 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// A point of a box; in the middle of an extent that is empty.
    pub fn point(&mut self, low: DVec2, high: DVec2) -> DVec2 {
        let x = self.between(low.x, high.x);
        DVec2::new(x, self.between(low.y, high.y))
    }

    /// A point of the unit sphere, uniform (Marsaglia 1972): nothing but a square root, so all
    /// machines agree.
    pub fn on_sphere(&mut self) -> DVec3 {
        loop {
            let (u, v) = (self.signed(), self.signed());
            let s = u * u + v * v;
            if s < 1.0 {
                let radius = 2.0 * (1.0 - s).sqrt();
                return DVec3::new(u * radius, v * radius, 1.0 - 2.0 * s);
            }
        }
    }

    /// Brings values into random order.
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for i in (1..values.len()).rev() {
            let j = self.below(i + 1);
            values.swap(i, j);
        }
    }

    /// Brings `count` random values to the front, in random order.
    pub fn shuffle_front<T>(&mut self, values: &mut [T], count: usize) {
        for i in 0..count.min(values.len()) {
            let j = i + self.below(values.len() - i);
            values.swap(i, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_numbers_that_the_paper_prints() {
        // The first numbers of splitmix64 with the seed 1234567, as its authors publish them.
        let mut rng = Rng::new(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!(expected.map(|_| rng.bits()), expected);
    }

    #[test]
    fn numbers_stay_in_their_ranges_and_shuffles_lose_nothing() {
        let mut rng = Rng::new(7);
        for _ in 0..10_000 {
            assert!((0.0..1.0).contains(&rng.unit()));
            assert!((-1.0..1.0).contains(&rng.signed()));
            assert!(rng.below(3) < 3);
            assert!((rng.on_sphere().length() - 1.0).abs() < 1e-15 * 8.0);
        }
        assert_eq!(rng.between(2.0, 2.0), 2.0);
        let mut values: Vec<usize> = (0..100).collect();
        rng.shuffle(&mut values);
        rng.shuffle_front(&mut values, 10);
        assert!(!values.is_sorted());
        values.sort_unstable();
        assert!(values.into_iter().eq(0..100));
    }
}
