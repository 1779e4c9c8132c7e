//! The one cutting operator, behind one door: what stands outside this room sees [`Cutter`] and
//! what its methods take and give, and none of its tables.
//!
//! The workspace (`cutter`), one cut from the plane to the caps (`reach`), its short ways for one
//! corner (`corner`) and for a whole mesh (`sweep`), dividing faces (`divide`), faces that lie in
//! the plane (`flat`), closing the wound (`section`), caps with holes (`bridge`); and the chain of
//! cuts for callers outside (`chain`).

mod bridge;
mod chain;
mod corner;
mod cutter;
mod divide;
mod flat;
mod reach;
mod section;
mod sweep;

#[cfg(test)]
mod patterns;

pub use chain::CutChain;
pub use cutter::{Capping, Reach};
pub(in crate::op) use cutter::{Cutter, Lineage, SlicingPlane};
