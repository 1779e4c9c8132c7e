//! kerfold carves planar 3-valence meshes, proves that they are so, and unfolds them into sheets
//! that a shop can cut.
//!
//! A solid or a file becomes a [`Mesh`](mesh::Mesh); operators ([`op`]) carve it and return a new
//! one; [`check`](mod@check) measures it; [`unfold`](mod@unfold) makes a net, which
//! [`unfold::prove`] checks by code of its own; [`sheet`] lays it out. Each operator has one
//! parameter struct, which is also the command line's and the recipe's.
//!
//! ```
//! use kerfold::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A cube of which every edge along z is cut off: planar faces, three edges at every vertex.
//! let cube = kerfold::shape::cube(80.0);
//! let params = TruncateEdgeParams::new("along=z".parse()?, 0.25);
//! let (column, _) = truncate_edges(&cube, &params, &OpContext::default())?;
//! let report = check(&column, &CheckParams::default())?;
//! assert!(report.findings.is_empty());
//!
//! // Unfolded to pieces that never overlap, each with its proof, and laid out on sheets.
//! let source = MeshSource { scale: 1.0, split_vertices: &[] };
//! let net = unfold(&column, &Seams::Free, &UnfoldParams::default(), &source, &Silent)?;
//! let proof = prove(&column, &net)?;
//! assert_eq!((column.face_count(), net.pieces.len(), proof.overlaps), (10, 1, 0));
//! let sheets = lay_out(&net, &SheetParams::default())?;
//! assert_eq!(sheets.drawings.len(), 1);
//! # Ok(())
//! # }
//! ```
//!
//! The modules are layers; each uses only those below it (`docs/architecture.md`). The kernel
//! (points, planes, hulls, meshes) and the sheets (nesting, kerf, lettering) are crates of their
//! own, `kerfold-kernel` and `kerfold-sheet`, of which this crate shows the modules. The feature
//! `cli`, on by default, is the command line; the library needs none of it.

pub use kerfold_kernel::{code, geom, measure, mesh, progress, random, units};
pub use kerfold_sheet::{lint, net, sheet};

pub mod explain;
pub mod memory;

pub mod mend;
pub mod seam;
pub mod select;
pub mod shape;

pub mod bloom;
pub mod check;
pub mod gluing;
pub mod op;
pub mod panel;
pub mod panelize;
pub mod unfold;

pub mod io;
pub mod make;
pub mod picture;
pub mod recipe;

pub mod gallery;

#[cfg(feature = "cli")]
pub mod cli;

/// What most programs use: `use kerfold::prelude::*;`.
pub mod prelude {
    pub use crate::check::{CheckParams, check};
    pub use crate::io::{ReadOptions, WriteOptions, read_mesh, write_mesh};
    pub use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh, MeshBuilder, VertexId};
    pub use crate::op::{
        HandleParams, HullParams, MengerParams, MergeParams, OpContext, PlanarizeParams,
        RepairParams, ResolveParams, RindParams, SierpinskiParams, SimplifyParams, SliceParams,
        SubdivideParams, TruncateEdgeParams, TruncateFaceParams, TruncateVertexParams, handle,
        hull, menger, merge, planarize, repair, resolve, rind, sierpinski, simplify, slice,
        subdivide, truncate_edges, truncate_faces, truncate_vertices,
    };
    pub use crate::progress::{Progress, Silent};
    pub use crate::select::Selection;
    pub use crate::shape::{SolidParams, solid};
    pub use crate::sheet::{SheetParams, lay_out};
    pub use crate::unfold::{MeshSource, Seams, UnfoldParams, prove, unfold};
    pub use crate::units::{Angle, Length};
}

/// The example of the README, which is tested as those of the two lower crates are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

/// Small meshes for tests, shared with the kernel's own.
#[cfg(test)]
#[path = "../crates/kerfold-kernel/src/measure/fixtures.rs"]
mod fixtures;
