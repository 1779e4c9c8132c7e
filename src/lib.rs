//! kerfold carves planar 3-valence meshes, proves that they are so, and unfolds them into sheets that a shop can cut.
//!
//! The modules are layers; each uses only those below it (`docs/architecture.md`).

pub mod code;
pub mod geom;
pub mod progress;
pub mod units;

pub mod mesh;
pub mod net;

pub mod measure;
pub mod seam;
pub mod select;
pub mod shape;

pub mod bloom;
pub mod check;
pub mod op;
pub mod panel;
pub mod sheet;
pub mod unfold;

pub mod io;
pub mod lint;
pub mod picture;
pub mod recipe;

pub mod cli;
