//! kerfold carves planar 3-valence meshes, proves that they are so, and unfolds them into sheets
//! that a shop can cut.
//!
//! A solid or a file becomes a [`Mesh`](mesh::Mesh); operators ([`op`]) carve it and return a new
//! one; [`check`](mod@check) measures it; [`unfold`](mod@unfold) makes a net, which
//! [`unfold::prove`] checks by code of its own; [`sheet`] lays it out. Each operator has one
//! parameter struct, which is also the command line's and the recipe's.
//!
//! ```
//! use kerfold::op::{OpContext, TruncateEdgeParams, truncate_edges};
//! use kerfold::progress::Silent;
//! use kerfold::shape::{SolidParams, solid};
//! use kerfold::unfold::{Seams, MeshSource, UnfoldParams, prove, unfold};
//! use kerfold::units::Length;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cube = solid(&SolidParams { name: "cube".parse()?, edge: Some(Length::from_mm(80.0)), size: None })?;
//! // Every edge along z is cut off: planar faces, three edges at every vertex.
//! let cut = TruncateEdgeParams::new("along=z".parse()?, 0.25);
//! let (column, _) = truncate_edges(&cube, &cut, &OpContext::default())?;
//! let source = MeshSource { scale: 1.0, split_vertices: &[] };
//! let net = unfold(&column, &Seams::Free, &UnfoldParams::default(), &source, &Silent)?;
//! let proof = prove(&column, &net)?;
//! assert_eq!((column.face_count(), net.pieces.len(), proof.overlaps), (10, 1, 0));
//! # Ok(())
//! # }
//! ```
//!
//! The modules are layers; each uses only those below it (`docs/architecture.md`).

pub use kerfold_kernel::{code, geom, measure, mesh, progress, random, units};
pub use kerfold_sheet::{lint, net, sheet};

pub mod explain;
pub mod memory;

pub mod seam;
pub mod select;
pub mod shape;

pub mod bloom;
pub mod check;
pub mod op;
pub mod panel;
pub mod unfold;

pub mod io;
pub mod make;
pub mod picture;
pub mod recipe;

pub mod gallery;

#[cfg(feature = "cli")]
pub mod cli;

/// Small meshes for tests, shared with the kernel's own.
#[cfg(test)]
#[path = "../crates/kerfold-kernel/src/measure/fixtures.rs"]
mod fixtures;
