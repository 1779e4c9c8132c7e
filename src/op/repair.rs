//! Repair: doubled and empty faces, torn edges, small holes and faces that look the wrong way are
//! mended.
//!
//! Source: [`crate::mend::repair`], which says what is done in which order; reading files uses it,
//! too, on faces that are no mesh yet. As a step it works on a mesh, so it finds what a mesh may
//! have: vertices at one place, T-junctions, doubled faces, holes, parts that are inside out.
//!
//! Needs: a mesh that a file of polygons can hold. Keeps: the places of vertices; groups and seams
//! of what stays. Changes: V, E, F and genus as far as something was to mend; ids are closed up.

use super::{OpContext, OpError};
pub use crate::mend::RepairParams;
use crate::mend::{Mending, Repairs, Soup};
use crate::mesh::Mesh;

/// What repairing did.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RepairReport {
    /// What was done, and how often.
    pub repairs: Repairs,
}

impl RepairReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        if self.repairs.is_nothing() {
            return vec!["there was nothing to mend".to_owned()];
        }
        self.repairs.done.iter().map(Mending::to_string).collect()
    }
}

/// Mends a mesh, and says what was done.
///
/// # Errors
/// [`OpError::HoleOutOfRange`] for holes to close of no width, [`OpError::NotSimple`] for a mesh
/// with self-loops or faces of two sides.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// // A box without its top: a hole of 10 mm by 10 mm, 14.2 mm across.
/// let cube = kerfold::shape::cube(10.0);
/// let faces = cube.faces().skip(1);
/// let open = Mesh::from_faces(
///     cube.vertices().map(|v| cube.position(v)),
///     faces.map(|f| cube.face_vertices(f).map(|v| v.index()).collect::<Vec<_>>()),
/// )?;
/// let params = RepairParams { close_holes: Some(Length::from_mm(15.0)) };
/// let (closed, report) = repair(&open, &params, &OpContext::default())?;
/// assert!(closed.is_closed());
/// assert_eq!(report.notes(), ["1 hole was closed"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repair(
    mesh: &Mesh,
    params: &RepairParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, RepairReport), OpError> {
    match params.close_holes {
        Some(width) if width.mm() <= 0.0 => {
            return Err(OpError::HoleOutOfRange { mm: width.mm() });
        }
        _ => {}
    }
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    let advice = "repair the mesh as it is in a file: write it, then `kerfold repair FILE`";
    if let Some(&fault) = mesh.file_faults().first() {
        return Err(OpError::NotSimple { fault, advice });
    }
    let mut soup = Soup::of_mesh(mesh);
    let repairs = crate::mend::repair(&mut soup, params);
    let result = if repairs.is_nothing() { mesh.clone() } else { soup.build(mesh)? };
    Ok((result, RepairReport { repairs }))
}
