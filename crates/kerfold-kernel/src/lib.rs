//! A half-edge mesh kernel.

pub mod code;
pub mod geom;
pub mod progress;
pub mod random;
pub mod units;

#[cfg(feature = "mesh")]
pub mod measure;
#[cfg(feature = "mesh")]
pub mod mesh;
#[cfg(feature = "mesh")]
pub mod shape;
