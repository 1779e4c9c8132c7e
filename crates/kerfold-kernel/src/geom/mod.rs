//! Planes, frames, exact-sign predicates, plane fits and flat polygons; knows no mesh.

mod bending;
mod box_tree;
mod fit;
mod frame;
#[cfg(feature = "sparse")]
pub mod fronts;
mod grid;
pub mod hull;
#[cfg(feature = "sparse")]
pub mod ldl;
mod meet;
mod meet_three;
mod nearest;
mod plane;
pub mod polygon;
pub mod predicate;
mod quadric;
mod rounding;
pub mod segments;
#[cfg(feature = "sparse")]
pub mod sparse;
mod triangulate;
mod triple;

pub use bending::bending_patterns;
pub use box_tree::{AxisBox, BoxTree};
pub use fit::fit_plane;
pub use frame::Frame;
pub use grid::{Cell, Grid};
pub use meet::{meet_planes, meet_planes_near};
pub use meet_three::meet_three;
pub use nearest::{nearest_on_segment, nearest_on_triangle};
pub use plane::Plane;
pub use predicate::Side;
pub use quadric::{HeightSample, fit_quadric};
pub use rounding::RoundingBound;
pub use triangulate::{
    triangulate, triangulate_contours, triangulate_region, triangulate_region_through,
};
pub use triple::{Double, triple_product};
