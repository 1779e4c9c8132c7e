//! Modelling operators, mesh in, mesh out; one operator, one file.

mod cavity;
mod cut;
mod divide;
mod error;
mod finding;
mod handle;
mod hull;
mod menger;
mod merge;
mod operate;
mod planarize;
mod repair;
mod report;
mod resolve;
mod rind;
mod roll;
mod roll_error;
mod rolled;
mod sierpinski;
mod simple;
mod simplify;
mod size;
mod slice;
mod subdivide;
mod truncate;
mod truncate_edge;
mod truncate_face;
mod truncate_vertex;

#[cfg(test)]
mod tests;

pub use cut::{Capping, CutChain, Reach};
pub use error::OpError;
pub use finding::OpFinding;
pub use handle::{FaceCorner, HandleParams, HandleReport, Weights, handle};
pub use hull::{
    Axis, HullParams, HullPart, HullReport, HullStep, HullStepChoice, HullStepList, halfspaces,
    hull,
};
pub use menger::{MengerParams, MengerReport, RoundCrossing, Thickness, menger};
pub use merge::{MergeParams, MergeReport, merge};
pub use operate::{Operate, OperatorOutput};
pub use planarize::{FarMove, Needle, PlanarizeParams, PlanarizeReport, RimRule, planarize};
pub use repair::{RepairParams, RepairReport, repair};
pub use report::{ChosenElements, CutReport, Origins, ShrunkOffset};
pub use resolve::{ResolveParams, ResolveReport, resolve};
pub use rind::{GroupThickness, RindParams, RindReport, ShellSource, rind};
pub use roll::{
    Roll, RollOptions, RollParams, RollWordError, StripSize, StripWordError, largest_roll,
};
pub use roll_error::RollError;
pub use rolled::{Place, RollLimit, RolledEdge};
pub use sierpinski::{
    SierpinskiParams, SierpinskiReport, VertexKind, sierpinski, sierpinski_preview, vertex_kind,
};
pub use simple::Mended;
pub use simplify::{SimplifyParams, SimplifyReport, simplify};
pub use slice::{Keep, SliceParams, slice, slice_both};
pub use subdivide::{Scheme, SubdivideParams, SubdivideReport, subdivide};
pub use truncate::{Disjoint, OpContext, Scope};
pub use truncate_edge::{TruncateEdgeParams, truncate_edges};
pub use truncate_face::{TruncateFaceParams, truncate_faces};
pub use truncate_vertex::{TruncateVertexParams, truncate_vertices};

pub use handle::HandleAxis;
