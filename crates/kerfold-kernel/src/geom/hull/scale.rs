//! Scaling by powers of two, which loses no digit.

/// The power of two that brings `x` into [1, 2); 1 for zero.
pub(super) fn inverse_power_of_two(x: f64) -> f64 {
    let exponent = x.to_bits() >> 52 & 0x7ff;
    if x == 0.0 { 1.0 } else { f64::from_bits((2046 - exponent.clamp(1, 2045)) << 52) }
}
