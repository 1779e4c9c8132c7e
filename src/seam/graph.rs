//! The mesh as a plain graph: vertices and edges numbered without gaps, with the way back to their
//! ids.

use super::SeamError;
use crate::mesh::{EdgeId, Mesh, VertexId, VertexMap};

/// Vertices 0..n and edges 0..m of a mesh, both in the order of their ids.
#[derive(Debug, Clone)]
pub(super) struct Graph {
    /// The two ends of each edge.
    pub ends: Vec<[u32; 2]>,
    /// The edges at each vertex, ascending, one vertex after the other; a self-loop comes twice.
    incident: Vec<u32>,
    /// Where the edges of each vertex begin in `incident`, and their number at the end.
    starts: Vec<u32>,
    /// The mesh's name of each vertex.
    pub vertex_ids: Vec<VertexId>,
    /// The mesh's name of each edge.
    pub edge_ids: Vec<EdgeId>,
}

impl Graph {
    /// The graph of any mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let vertex_ids: Vec<VertexId> = mesh.vertices().collect();
        let edge_ids: Vec<EdgeId> = mesh.edges().collect();
        let mut number = VertexMap::filled(mesh.vertex_slots(), 0);
        for (i, &v) in (0u32..).zip(&vertex_ids) {
            number[v] = i;
        }
        let ends: Vec<[u32; 2]> =
            edge_ids.iter().map(|&e| mesh.edge_vertices(e).map(|v| number[v])).collect();
        let (starts, incident) = incidence(vertex_ids.len(), &ends);
        Self { ends, incident, starts, vertex_ids, edge_ids }
    }

    /// The graph of a closed mesh whose vertices all have valence 3.
    ///
    /// # Errors
    /// [`SeamError::Empty`], [`SeamError::Open`], [`SeamError::Valence`].
    pub fn cubic(mesh: &Mesh) -> Result<Self, SeamError> {
        if mesh.edge_count() == 0 {
            return Err(SeamError::Empty);
        }
        if let Some(edge) = mesh.edges().find(|&e| mesh.is_rim(e)) {
            return Err(SeamError::Open { holes: mesh.hole_count(), edge });
        }
        let graph = Self::new(mesh);
        let mut others = (0..graph.vertex_count()).filter(|&v| graph.incident(v).len() != 3);
        if let Some(v) = others.next() {
            let valence = graph.incident(v).len();
            return Err(SeamError::Valence {
                vertex: graph.vertex_ids[v as usize],
                valence,
                count: 1 + others.count(),
            });
        }
        Ok(graph)
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> u32 {
        self.vertex_ids.len() as u32
    }

    /// The edges at a vertex.
    pub fn incident(&self, v: u32) -> &[u32] {
        &self.incident[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// The end of an edge that is not `v`; `v` itself for a self-loop.
    pub fn other(&self, e: u32, v: u32) -> u32 {
        let [a, b] = self.ends[e as usize];
        a ^ b ^ v
    }

    /// The ids of some edges, ascending.
    pub fn ids(&self, edges: impl IntoIterator<Item = u32>) -> Vec<EdgeId> {
        let mut ids: Vec<EdgeId> = edges.into_iter().map(|e| self.edge_ids[e as usize]).collect();
        ids.sort_unstable();
        ids
    }

    /// A graph without a mesh, for tests; ids equal numbers.
    #[cfg(test)]
    pub fn of_ends(vertices: usize, ends: Vec<[u32; 2]>) -> Self {
        let (starts, incident) = incidence(vertices, &ends);
        let vertex_ids = (0..vertices).map(VertexId::new).collect();
        let edge_ids = (0..ends.len()).map(EdgeId::new).collect();
        Self { ends, incident, starts, vertex_ids, edge_ids }
    }
}

fn incidence(vertices: usize, ends: &[[u32; 2]]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; vertices + 1];
    for &v in ends.iter().flatten() {
        starts[v as usize + 1] += 1;
    }
    for v in 0..vertices {
        starts[v + 1] += starts[v];
    }
    let mut free = starts.clone();
    let mut incident = vec![0; 2 * ends.len()];
    for (e, pair) in (0u32..).zip(ends) {
        for &v in pair {
            incident[free[v as usize] as usize] = e;
            free[v as usize] += 1;
        }
    }
    (starts, incident)
}
