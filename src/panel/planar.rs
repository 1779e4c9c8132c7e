//! Faces that are not planar: a plate is flat, so its corners cannot all be those of such a face.
//!
//! One function measures ([`crate::measure::planarity`]) and one profile limits
//! ([`Profile`]); the limit below which nothing is said is that of files with few digits.

use super::error::{NotPlanar, PanelError};
use crate::check::{Limits, Profile};
use crate::measure::planarity;
use crate::mesh::Mesh;

/// A corner that lies off the plane of its face by no more than this part of the face's diameter is
/// rounding of the file: the seventh digit. `unfold` has the same limit.
const ROUNDED: f64 = 1e-5;

/// Faces beyond this are refused: the widest profile, one millimetre.
const REFUSED: Profile = Profile::Plywood;

/// The faces that are no plates of any thickness up to rounding, with what rounding is for them.
pub(super) fn bent_faces(mesh: &Mesh) -> Vec<NotPlanar> {
    let limits = Limits { permille: Some(1000.0 * ROUNDED), ..Limits::default() };
    let bent = |face| {
        let found = planarity(mesh, face);
        let breach = limits.breach(&found)?;
        let limit = found.mm * breach.limit / breach.measured;
        Some(NotPlanar { face, mm: found.mm, limit })
    };
    mesh.faces().filter_map(bent).collect()
}

/// Refuses faces that are far from planar.
pub(super) fn refuse_bent(mesh: &Mesh) -> Result<(), PanelError> {
    let bent = |face| {
        let breach = REFUSED.limits().breach(&planarity(mesh, face))?;
        Some(NotPlanar { face, mm: breach.measured, limit: breach.limit })
    };
    let found: Vec<NotPlanar> = mesh.faces().filter_map(bent).collect();
    if found.is_empty() { Ok(()) } else { Err(PanelError::NotPlanar { found }) }
}
