//! Seam sets of a mesh as graphs: matchings, 2-factors, Hamiltonian cycles.
//!
//! Stands in for the module of the same name until that is merged; only the signatures count.

use crate::mesh::{EdgeId, Mesh};

/// Why folds or seams of the wanted kind cannot be given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeamError {
    /// The stand-in knows no seams.
    #[error("seams are not built in yet")]
    StandIn,
}

/// The perfect matching with the least sum of fold weights.
///
/// # Errors
/// Always.
pub fn least_matching(_mesh: &Mesh) -> Result<Vec<EdgeId>, SeamError> {
    Err(SeamError::StandIn)
}

/// The perfect matching number `k` in a stable order.
///
/// # Errors
/// Always.
pub fn matching(_mesh: &Mesh, _k: usize) -> Result<Vec<EdgeId>, SeamError> {
    Err(SeamError::StandIn)
}

/// The folds of a two-piece seam.
///
/// # Errors
/// Always.
pub fn hamiltonian_folds(_mesh: &Mesh) -> Result<Vec<EdgeId>, SeamError> {
    Err(SeamError::StandIn)
}
