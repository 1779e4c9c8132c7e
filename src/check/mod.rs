//! Findings against limits, as data.
//!
//! [`check`] measures a mesh and compares it with the limits of a [`Profile`] and with what the
//! user requires. It prints nothing and decides nothing but pass or fail; the writers in `io` show
//! the [`Report`].

mod details;
mod findings;
mod params;
mod profile;
mod report;
mod run;
mod short;
mod surface;

pub use details::{Details, EdgeDetail, VertexDetail, details};
pub use params::{CheckError, CheckParams, Requirement};
pub use profile::{Breach, Limits, Profile, ROUNDED, Unit};
pub use report::{
    CheckFinding, CheckKind, ConicalNode, Element, FaceReport, FlatNeighbours, MOST_CROSSINGS,
    ModelCounts, Report, ValenceReport, Verdict,
};
pub use run::check;
pub(crate) use short::short;
