//! Modelling operators, mesh in, mesh out; one operator, one file.

mod bridge;
mod cutter;
mod divide;
mod error;
mod hull;
mod report;
mod section;
mod slice;
mod truncate;
mod truncate_edge;
mod truncate_face;
mod truncate_vertex;

#[cfg(test)]
mod tests;

pub use error::OpError;
pub use hull::{Axis, HullParams, HullPart, HullReport, HullStep, Step, Steps, halfspaces, hull};
pub use report::CutReport;
pub use slice::{Direction, Keep, Point, SliceParams, slice};
pub use truncate::{OpContext, Scope};
pub use truncate_edge::{TruncateEdge, truncate_edges};
pub use truncate_face::{TruncateFace, truncate_faces};
pub use truncate_vertex::{TruncateVertex, truncate_vertices};
