//! Faces that are not planar: a plate is flat, so its corners cannot all be those of such a face.
//!
//! One function measures ([`crate::measure::planarity`]), and `check` has both limits: that of its
//! usual profile, above which `unfold` refuses a face, too, and [`ROUNDED`], below which nothing is
//! said.

use super::error::{NotPlanar, PanelError};
use crate::check::{Limits, Profile, ROUNDED};
use crate::measure::planarity;
use crate::mesh::Mesh;

/// The faces that are no plates of any thickness up to rounding, with what rounding is for them.
pub(super) fn bent_faces(mesh: &Mesh) -> Vec<NotPlanar> {
    beyond(mesh, &Limits { permille: Some(1000.0 * ROUNDED), ..Limits::default() })
}

/// Refuses faces that break the usual profile.
pub(super) fn refuse_bent(mesh: &Mesh) -> Result<(), PanelError> {
    let found = beyond(mesh, &Profile::default().limits());
    if found.is_empty() { Ok(()) } else { Err(PanelError::NotPlanar { found }) }
}

/// The faces that break a limit of lengths or per mille, with that limit in mm.
fn beyond(mesh: &Mesh, limits: &Limits) -> Vec<NotPlanar> {
    let bent = |face| {
        let found = planarity(mesh, face);
        let breach = limits.breach(&found)?;
        let limit = found.mm * breach.limit / breach.measured;
        Some(NotPlanar { face, mm: found.mm, limit })
    };
    mesh.faces().filter_map(bent).collect()
}
