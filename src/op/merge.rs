//! Merge: faces that lie in one plane with their neighbours become polygons.
//!
//! Source: our own; the core is [`crate::mend::merge_flat`], which reading files uses, too. Meshes
//! from STL files and CAD programs come as triangles, though a panel or a piece of paper wants whole
//! faces.
//!
//! Needs: a mesh that a file of polygons can hold. Keeps: the surface within the tolerance, genus,
//! rims, groups and seams, and every place: no vertex moves. Changes: F falls to the number of flat
//! regions (a region around a hole stays two faces or more, since a face is one ring of corners); V
//! and E fall with them, and vertices on straight runs go. Degenerate: faces without area have no
//! plane and join a neighbour in whose plane they lie.

use serde::Deserialize;

use super::report::first_few;
use super::{OpContext, OpError};
use crate::mend::{FLAT_MM, Merged, merge_flat};
use crate::mesh::{Mesh, VertexId};
use crate::select::NewElements;
use crate::units::{Length, counted};

/// How to merge flat neighbours. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct MergeParams {
    /// How far a corner may lie from the plane of its face, and a vertex on a straight run from the
    /// line that takes its place; 0 or more, in mm unless a unit is given.
    #[arg(long, default_value = "0.01mm")]
    #[serde(default = "default_tolerance")]
    pub tolerance: Length,
}

fn default_tolerance() -> Length {
    Length::from_mm(FLAT_MM)
}

impl Default for MergeParams {
    fn default() -> Self {
        Self { tolerance: default_tolerance() }
    }
}

/// What merging did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MergeReport {
    /// What was merged, and what could not be.
    pub merged: Merged,
    /// How many faces there are now.
    pub faces: usize,
    /// The faces that were made of several, with their vertices and edges.
    pub made: NewElements,
}

impl MergeReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let merged = &self.merged;
        if merged.made.is_empty() && merged.straight_vertices == 0 {
            return vec![format!(
                "no faces lie flat beside each other: all {} stay; a larger --tolerance merges more",
                counted(self.faces, "face", "faces")
            )];
        }
        let mut notes = vec![format!(
            "{} became {}: {} made of several ({}), and {} on straight runs went",
            counted(merged.faces_before, "face", "faces"),
            self.faces,
            counted(merged.made.len(), "face is", "faces are"),
            first_few(&merged.made, 8),
            counted(merged.straight_vertices, "vertex", "vertices"),
        )];
        if merged.divided_regions > 0 {
            notes.push(format!(
                "{} a hole, and a face has no holes: each is left in two faces or more",
                counted(
                    merged.divided_regions,
                    "flat region goes around",
                    "flat regions go around"
                )
            ));
        }
        if merged.left_regions > 0 {
            notes.push(format!(
                "{} as before, since the outline of the whole would meet itself",
                counted(merged.left_regions, "flat region stays", "flat regions stay")
            ));
        }
        notes
    }
}

/// Makes one face of those that lie in one plane beside each other.
///
/// # Errors
/// [`OpError::ToleranceOutOfRange`] for a negative or infinite tolerance, [`OpError::NotSimple`]
/// for a mesh with self-loops or faces of two sides, or when merging would make such a mesh.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use kerfold::op::Scheme;
///
/// let cube = kerfold::shape::cube(100.0);
/// let params = SubdivideParams::new(Scheme::Triangulate, 1);
/// let (triangles, _) = subdivide(&cube, &params, &OpContext::default())?;
/// let (merged, _) = merge(&triangles, &MergeParams::default(), &OpContext::default())?;
/// assert_eq!((triangles.face_count() > 6, merged.face_count()), (true, 6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn merge(
    mesh: &Mesh,
    params: &MergeParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, MergeReport), OpError> {
    let tolerance = params.tolerance.mm();
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        return Err(OpError::ToleranceOutOfRange { tolerance });
    }
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    let advice = "merge the mesh as it is in a file: write it, then `kerfold merge FILE`";
    if let Some(&fault) = mesh.file_faults().first() {
        return Err(OpError::NotSimple { fault, advice });
    }
    let (result, merged) = merge_flat(mesh, tolerance)?;
    if let Some(&fault) = result.file_faults().first() {
        let advice = "take a smaller --tolerance";
        return Err(OpError::NotSimple { fault, advice });
    }
    let mut made = NewElements { faces: merged.made.clone(), ..NewElements::default() };
    let sides = || merged.made.iter().flat_map(|&f| result.face_half_edges(f));
    made.vertices = sides().map(|h| result.origin(h)).collect::<Vec<VertexId>>();
    made.edges = sides().map(|h| h.edge()).collect();
    made.vertices.sort_unstable();
    made.vertices.dedup();
    made.edges.sort_unstable();
    made.edges.dedup();
    let report = MergeReport { faces: result.face_count(), merged, made };
    Ok((result, report))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;

    #[test]
    fn a_negative_tolerance_is_refused() {
        let params = MergeParams { tolerance: Length::from_mm(-1.0) };
        let refused = merge(&shape::cube(10.0), &params, &OpContext::default());
        assert!(matches!(refused, Err(OpError::ToleranceOutOfRange { .. })));
    }

    #[test]
    fn the_defaults_are_the_same_everywhere() {
        let recipe: MergeParams = toml::from_str("").expect("all optional");
        assert_eq!(recipe.tolerance, MergeParams::default().tolerance);
    }

    #[test]
    fn nothing_to_merge_is_said() {
        let (mesh, report) =
            merge(&shape::cube(10.0), &MergeParams::default(), &OpContext::default())
                .expect("merged");
        assert_eq!(mesh.face_count(), 6);
        assert!(report.notes()[0].starts_with("no faces lie flat"), "{:?}", report.notes());
    }
}
