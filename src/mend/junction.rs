//! T-junctions of a mesh: vertices of a rim that lie on an edge of a rim and are no end of it.

use super::repair::{WELD_SHARE, on_segments};
use crate::measure::size;
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};

/// A vertex on an edge that it does not belong to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Junction {
    /// The vertex.
    pub vertex: VertexId,
    /// The edge that it lies on.
    pub edge: EdgeId,
    /// How far it is from the edge, in mm.
    pub distance: f64,
    /// How far it may be and still count as on it: a millionth of the model, in mm.
    pub limit: f64,
}

/// All T-junctions, ascending by vertex; one edge for each vertex.
pub fn junctions(mesh: &Mesh) -> Vec<Junction> {
    let near = WELD_SHARE * size(mesh).max_element();
    let rims: Vec<HalfEdgeId> = mesh.holes().flat_map(|hole| mesh.face_half_edges(hole)).collect();
    let mut vertices: Vec<VertexId> = rims.iter().map(|&h| mesh.origin(h)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let segments: Vec<_> = rims.iter().map(|h| mesh.edge_positions(h.edge())).collect();
    let points: Vec<_> = vertices.iter().map(|&v| mesh.position(v)).collect();
    let mut found: Vec<Junction> = Vec::new();
    for (segment, point, along) in on_segments(&segments, &points, near) {
        let (h, vertex) = (rims[segment], vertices[point]);
        let face: FaceId = mesh.face(h.twin());
        if mesh.face_vertices(face).all(|v| v != vertex) {
            let [a, b] = segments[segment];
            let distance = points[point].distance(a.lerp(b, along));
            found.push(Junction { vertex, edge: h.edge(), distance, limit: near });
        }
    }
    found.sort_by_key(|junction| (junction.vertex, junction.edge));
    found.dedup_by_key(|junction| junction.vertex);
    found
}
