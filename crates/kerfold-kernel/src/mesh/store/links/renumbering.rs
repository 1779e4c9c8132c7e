//! Where elements went when the gaps between them were closed.

use super::NONE;
use crate::mesh::{EdgeId, FaceId, VertexId};

/// Where [`Mesh::compact`](crate::mesh::Mesh::compact) moved the elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Renumbering {
    pub(super) vertices: Vec<u32>,
    pub(super) edges: Vec<u32>,
    pub(super) faces: Vec<u32>,
}

impl Renumbering {
    /// The new id of a vertex; `None` when it was deleted.
    pub fn vertex(&self, v: VertexId) -> Option<VertexId> {
        self.vertices.get(v.index()).filter(|&&i| i != NONE).map(|&i| VertexId(i))
    }

    /// The new id of an edge; `None` when it was deleted.
    pub fn edge(&self, e: EdgeId) -> Option<EdgeId> {
        self.edges.get(e.index()).filter(|&&i| i != NONE).map(|&i| EdgeId(i))
    }

    /// The new id of a face or hole; `None` when it was deleted.
    pub fn face(&self, f: FaceId) -> Option<FaceId> {
        self.faces.get(f.index()).filter(|&&i| i != NONE).map(|&i| FaceId(i))
    }
}

/// The new number of everything that lives, counted without gaps; [`NONE`] for the rest.
pub(super) fn renumber(live: &[bool]) -> Vec<u32> {
    let mut next = 0;
    live.iter()
        .map(|&live| {
            let id = if live { next } else { NONE };
            next += u32::from(live);
            id
        })
        .collect()
}
