//! How much memory a result may take, asked before the work begins.

use sysinfo::System;

/// Of the memory that is free, the share that one result may take: the rest is for what is beside
/// it, and for what an estimate leaves out.
const SHARE: f64 = 0.75;

/// A budget of memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    bytes: f64,
}

/// A result that will not fit, with the most of its kind that will.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    /// How many were asked for: rounds, or whatever makes the result large.
    pub asked: u32,
    /// The most that fit; may be none.
    pub most: u32,
    /// What the result would take, in bytes.
    pub bytes: f64,
    /// What it may take, in bytes.
    pub budget: f64,
}

impl Memory {
    /// What the machine has to spare now, within the limits of the container that the process runs
    /// in. Without limit where the system does not say.
    pub fn of_machine() -> Self {
        let mut system = System::new();
        system.refresh_memory();
        let free = match system.available_memory() {
            0 => f64::INFINITY,
            bytes => bytes as f64,
        };
        let group =
            system.cgroup_limits().map_or(f64::INFINITY, |limits| limits.free_memory as f64);
        Self::of_bytes(SHARE * free.min(group))
    }

    /// So many bytes.
    pub fn of_bytes(bytes: f64) -> Self {
        Self { bytes }
    }

    /// Checks that the result of `asked` rounds fits; `bytes` estimates what so many take, and does
    /// not fall with their number. An estimate too large for a number is infinite, and never fits.
    ///
    /// # Errors
    /// [`TooLarge`], with the largest number that fits.
    pub fn check(&self, asked: u32, bytes: impl Fn(u32) -> f64) -> Result<(), TooLarge> {
        let fits = |count: u32| {
            let needed = bytes(count);
            needed.is_finite() && needed <= self.bytes
        };
        if fits(asked) {
            return Ok(());
        }
        let (mut most, mut too_many) = (0, asked);
        while too_many - most > 1 {
            let middle = most + (too_many - most) / 2;
            if fits(middle) { most = middle } else { too_many = middle }
        }
        Err(TooLarge { asked, most, bytes: bytes(asked), budget: self.bytes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_number_that_fits_is_named() {
        let memory = Memory::of_bytes(1000.0);
        let bytes = |rounds: u32| 4.0_f64.powi(rounds as i32);
        assert_eq!(memory.check(4, bytes), Ok(()));
        let refused = memory.check(16, bytes).expect_err("far too much");
        assert_eq!((refused.asked, refused.most, refused.budget), (16, 4, 1000.0));
        assert_eq!(refused.bytes, bytes(16));
        let nothing = memory.check(1, |_| 1e9).expect_err("too much");
        assert_eq!(nothing.most, 0);
        // Beyond all numbers.
        let most = memory.check(u32::MAX, |n| 2.0_f64.powi(n.min(i32::MAX as u32) as i32));
        assert_eq!(most.map_err(|refused| refused.most), Err(9));
    }

    #[test]
    fn the_machine_has_some_memory() {
        let memory = Memory::of_machine();
        assert!(memory.check(1, |_| 1e6).is_ok());
        assert!(memory.check(1, |_| f64::INFINITY).is_err());
    }
}
