//! Finds surfaces that are open only because their vertices at one point are several.

use std::collections::HashMap;

use crate::mend::position_key;
use crate::mesh::{HalfEdgeId, Mesh, VertexId};

/// Rim edges that lie exactly on other rim edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Coincidence {
    /// Number of rim edges.
    pub rim_edges: usize,
    /// How many of them lie on another rim edge that runs the other way.
    pub coincident: usize,
    /// Two vertices at one point where the first such pair meets.
    pub vertices: [VertexId; 2],
}

/// Compares all rim edges; `None` when no two lie on each other.
pub(super) fn coincident_rims(mesh: &Mesh) -> Option<Coincidence> {
    let rims: Vec<HalfEdgeId> = mesh.holes().flat_map(|hole| mesh.face_half_edges(hole)).collect();
    let key =
        |h: HalfEdgeId| [mesh.origin(h), mesh.target(h)].map(|v| position_key(mesh.position(v)));
    // Each rim edge can meet one other; those without a partner so far wait here.
    let mut waiting: HashMap<[[u64; 3]; 2], Vec<HalfEdgeId>> = HashMap::with_capacity(rims.len());
    let mut coincident = 0;
    let mut first = None;
    for &h in &rims {
        let [from, to] = key(h);
        if let Some(partner) = waiting.get_mut(&[to, from]).and_then(Vec::pop) {
            coincident += 2;
            first = first.or_else(|| apart(mesh, h, partner));
        } else {
            waiting.entry([from, to]).or_default().push(h);
        }
    }
    first.map(|vertices| Coincidence { rim_edges: rims.len(), coincident, vertices })
}

/// The ends of two coincident edges that are different vertices.
fn apart(mesh: &Mesh, h: HalfEdgeId, partner: HalfEdgeId) -> Option<[VertexId; 2]> {
    let pairs = [(mesh.origin(h), mesh.target(partner)), (mesh.target(h), mesh.origin(partner))];
    pairs.into_iter().find(|(a, b)| a != b).map(|(a, b)| [a.min(b), a.max(b)])
}
