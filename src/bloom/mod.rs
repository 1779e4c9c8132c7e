//! Folding kinematics: from flat pieces to the closed model, and every state between.
//!
//! The faces of a net hang on one another by their folds, and by the seams that are closed, as a
//! forest ([`FoldTree`]); given how far each hinge has turned, every face has a [`Pose`]. [`Bloom`]
//! is the way from the sheets to the closed model in time; [`state_mesh`] makes a mesh of any
//! state, for pictures. Only the net is needed, so anybody's pieces can be folded.
//!
//! The proof of a net folds it up as well, by code of its own on purpose; see `unfold`.

mod motion;
mod pose;
mod state;
mod tree;

#[cfg(test)]
mod tests;

pub use motion::{Bloom, END, FOLDING, FlatPlace, MOVING};
pub use pose::Pose;
pub use state::state_mesh;
pub use tree::{FoldTree, Hinge, HingeKind, Leaf};
