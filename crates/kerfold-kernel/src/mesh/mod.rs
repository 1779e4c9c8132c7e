//! The 2-manifold half-edge store; the only place that writes links.

mod build;
mod faults;
mod file_counts;
mod file_faults;
mod id;
mod operators;
mod store;
mod walk;
mod walks;

pub use build::{BuildError, MeshBuilder, SplitVertex};
pub use faults::{Fault, assert_sound};
pub use file_counts::FileCounts;
pub use file_faults::FileFault;
pub use id::{
    EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Id, SideTable, VertexId, VertexMap,
};
pub use operators::OperatorError;
pub use store::Region;
pub use store::{Corner, FaceKind, LinkError, Mesh, Renumbering};
pub use walk::Component;
pub use walks::WalkBuilder;

/// Ids stay below this, so that a link can use the top bit as a tag.
const MAX_ELEMENTS: u32 = 1 << 31;
