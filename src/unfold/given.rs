//! Whether seams and folds that the caller gave can be, and whether they were kept to.

use super::dual::FLAT;
use super::{Seams, UnfoldError};
use crate::measure::angle_deficit;
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::net::Net;

/// Whether given seams (or folds) reach every vertex around which the faces cannot lie flat. [`super::unfold`] opens a
/// further edge there; call this first when the seams are a maker's own and are not to be added to.
///
/// # Errors
/// [`UnfoldError::ConePoints`] names the vertices that no seam and no rim reaches.
pub fn check_seams(mesh: &Mesh, seams: &Seams) -> Result<(), UnfoldError> {
    let (listed, opens): (&[EdgeId], bool) = match seams {
        Seams::Open(edges) => (edges, true),
        Seams::Folds(edges) => (edges, false),
        Seams::Free | Seams::Within { .. } => return Ok(()),
    };
    let mut is_open = EdgeMap::filled(mesh.edge_slots(), !opens);
    listed.iter().filter(|&&e| mesh.has_edge(e)).for_each(|&e| is_open[e] = opens);
    let is_inside = |v: &crate::mesh::VertexId| mesh.outgoing(*v).all(|h| !is_open[h.edge()] && !mesh.is_rim(h.edge()));
    let is_cone = |v: &crate::mesh::VertexId| angle_deficit(mesh, *v).is_some_and(|deficit| deficit.abs() > FLAT);
    let vertices: Vec<usize> = mesh.vertices().filter(|v| is_inside(v) && is_cone(v)).map(|v| v.index()).collect();
    if vertices.is_empty() { Ok(()) } else { Err(UnfoldError::ConePoints { vertices }) }
}

/// Whether these edges fold in a net (or are rims).
///
/// # Errors
/// [`UnfoldError::NotKept`] names those that are seams.
pub fn check_folded(net: &Net, keep: &[EdgeId]) -> Result<(), UnfoldError> {
    let seams: std::collections::BTreeSet<usize> = net.seams.iter().map(|s| s.id.0).collect();
    let mut edges: Vec<usize> = keep.iter().map(|e| e.index()).filter(|e| seams.contains(e)).collect();
    edges.sort_unstable();
    edges.dedup();
    if edges.is_empty() { Ok(()) } else { Err(UnfoldError::NotKept { edges }) }
}
