#![cfg_attr(feature = "mesh", doc = include_str!("../README.md"))]
#![cfg_attr(not(feature = "mesh"), doc = "Points, planes, flat polygons, hulls and units.")]

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
