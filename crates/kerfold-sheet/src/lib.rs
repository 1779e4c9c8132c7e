#![doc = include_str!("../README.md")]

// What lies below, under the names that it has in the kernel.
use kerfold_kernel::{code, geom, progress, random, units};

pub mod lint;
pub mod net;
pub mod sheet;
