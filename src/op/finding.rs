//! What an operator can find wrong with its own result, which it returns all the same.

use crate::code::codes;

/// What is wrong with a mesh that an operator made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OpFinding {
    /// [`super::planarize`] did not reach its profile.
    NotPlanar,
    /// The second skin of a [`super::rind`] crosses itself.
    ShellCrosses,
    /// Frames or tunnels of [`super::menger`] do not fit.
    SpongeCrosses,
    /// Sections of a [`super::handle`] pass through each other.
    HandleCrosses,
    /// [`super::planarize`] made sides of faces cross.
    FacesCross,
    /// [`super::planarize`] made corners of faces too sharp for any material.
    NeedleCorners,
    /// [`super::planarize`] moved vertices by more than a tenth of their edges.
    MovedFar,
    /// [`super::planarize`] made convex faces concave.
    MadeConcave,
    /// [`super::planarize`] made corners sharper than a plate may have them.
    MadeSharp,
    /// Faces of [`super::simplify`] go through each other.
    SimplifiedCrosses,
}

codes!(finding OpFinding {
    NotPlanar = 501,
    ShellCrosses = 502,
    SpongeCrosses = 503,
    HandleCrosses = 504,
    FacesCross = 505,
    NeedleCorners = 506,
    MovedFar = 507,
    MadeConcave = 508,
    MadeSharp = 509,
    SimplifiedCrosses = 510,
});
