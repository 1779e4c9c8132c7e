//! The edge selections that come from seams: the one place that calls that module.

use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;
use crate::seam::{self, SeamError};

/// A choice of folds, one at every vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Folds {
    /// `matching`: the perfect matching whose folds weigh least.
    Least,
    /// `flattest`: the perfect matching whose folds turn least, by angle alone.
    Flattest,
    /// `matching:K`: number K of all perfect matchings, in the order of [`seam::matching`].
    Number(usize),
    /// `hamiltonian`: the folds that leave one closed seam, so that there are two pieces.
    TwoPieces,
}

/// The folds on the mesh as it is now.
pub(super) fn folds(
    mesh: &Mesh,
    which: Folds,
    progress: &dyn Progress,
) -> Result<Vec<EdgeId>, SeamError> {
    match which {
        Folds::Least => seam::least_matching(mesh, progress),
        Folds::Flattest => seam::flattest_matching(mesh, progress),
        Folds::Number(k) => seam::matching(mesh, k, progress),
        Folds::TwoPieces => seam::hamiltonian_folds(mesh, progress),
    }
}
