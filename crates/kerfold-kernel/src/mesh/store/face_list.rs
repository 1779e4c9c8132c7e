//! The walks of faces and holes from which a mesh is assembled.

use crate::mesh::{FaceKind, HalfEdgeId};

/// The walks of faces and holes, for [`Mesh::assemble`]: all half-edges in one vector, with the
/// ends of the walks.
#[derive(Default)]
pub(in crate::mesh) struct FaceList {
    half_edges: Vec<HalfEdgeId>,
    ends: Vec<(u32, FaceKind)>,
}

impl FaceList {
    /// An empty list with room for so many half-edges and faces.
    pub(in crate::mesh) fn with_capacity(half_edges: usize, faces: usize) -> Self {
        Self { half_edges: Vec::with_capacity(half_edges), ends: Vec::with_capacity(faces) }
    }

    /// Faces whose walks lie one behind the other and end at these places.
    pub(in crate::mesh) fn of_faces(half_edges: Vec<HalfEdgeId>, ends: &[usize]) -> Self {
        Self { half_edges, ends: ends.iter().map(|&end| (end as u32, FaceKind::Solid)).collect() }
    }

    /// Adds a walk and returns its number; nothing is added for an empty one.
    pub(in crate::mesh) fn push(
        &mut self,
        walk: impl IntoIterator<Item = HalfEdgeId>,
        kind: FaceKind,
    ) -> Option<usize> {
        let before = self.half_edges.len();
        self.half_edges.extend(walk);
        (self.half_edges.len() > before).then(|| {
            self.ends.push((self.half_edges.len() as u32, kind));
            self.ends.len() - 1
        })
    }

    /// Number of walks.
    pub(in crate::mesh) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Number of half-edges in all walks.
    pub(in crate::mesh) fn half_edge_count(&self) -> usize {
        self.half_edges.len()
    }

    /// The walks in order.
    pub(in crate::mesh) fn iter(&self) -> impl Iterator<Item = (&[HalfEdgeId], FaceKind)> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|&(end, _)| end));
        starts
            .zip(&self.ends)
            .map(|(start, &(end, kind))| (&self.half_edges[start as usize..end as usize], kind))
    }
}
