//! See `glb` in the library of this package.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| kerfold_fuzz::glb(bytes));
