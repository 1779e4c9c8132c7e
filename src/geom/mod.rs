//! Planes, frames, exact-sign predicates, plane fits and flat polygons; knows no mesh.

mod fit;
mod frame;
pub mod hull;
mod meet3;
mod plane;
pub mod polygon;
pub mod predicate;
mod rounding;

pub use fit::fit_plane;
pub use frame::Frame;
pub use meet3::meet_three;
pub use plane::Plane;
pub use predicate::Side;
pub use rounding::RoundingBound;
