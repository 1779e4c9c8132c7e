//! Every vertex and every edge in numbers, for reports that list them.

use glam::DVec3;

use crate::measure::{self, conical_residual_of};
use crate::mesh::{EdgeId, FaceMap, Mesh, VertexId};

/// What a report tells of each vertex and each edge. Worked out apart from the
/// [`Report`](super::Report), since most checks do not need it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Details {
    /// The vertices that have an edge, ascending.
    pub vertices: Vec<VertexDetail>,
    /// The edges, ascending.
    pub edges: Vec<EdgeDetail>,
}

/// One vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexDetail {
    /// The vertex.
    pub vertex: VertexId,
    /// Number of its edges.
    pub valence: usize,
    /// Whether it lies on a rim.
    pub is_on_rim: bool,
    /// By how many mm per mm of thickness plates miss each other there
    /// ([`measure::conical_residual`]).
    pub residual: Option<f64>,
    /// 360° minus the face angles around it ([`measure::angle_deficit`]), in degrees.
    pub deficit_degrees: Option<f64>,
}

/// One edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeDetail {
    /// The edge.
    pub edge: EdgeId,
    /// The vertices that it joins.
    pub ends: [VertexId; 2],
    /// Its length, in mm.
    pub length_mm: f64,
    /// The interior angle between its faces ([`measure::dihedral_angle`]), in degrees in [0, 360);
    /// `None` at a rim.
    pub dihedral_degrees: Option<f64>,
}

/// Measures every vertex and every edge.
pub fn details(mesh: &Mesh) -> Details {
    let mut normals = FaceMap::filled(mesh.face_slots(), None);
    for f in mesh.faces() {
        normals[f] = mesh.plane(f).map(|plane| plane.normal());
    }
    let vertex = |vertex: VertexId| {
        let around: Option<Vec<DVec3>> = mesh.vertex_faces(vertex).map(|f| normals[f]).collect();
        VertexDetail {
            vertex,
            valence: mesh.valence(vertex),
            is_on_rim: mesh.is_rim_vertex(vertex),
            residual: around.and_then(|normals| conical_residual_of(&normals)),
            deficit_degrees: measure::angle_deficit(mesh, vertex).map(f64::to_degrees),
        }
    };
    let edge = |edge| EdgeDetail {
        edge,
        ends: mesh.edge_vertices(edge),
        length_mm: measure::edge_length(mesh, edge),
        dihedral_degrees: measure::dihedral_angle(mesh, edge).map(f64::to_degrees),
    };
    let vertices = mesh.vertices().filter(|&v| mesh.valence(v) > 0).map(vertex).collect();
    Details { vertices, edges: mesh.edges().map(edge).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{cube, octahedron, open_box};

    #[test]
    fn a_cube_has_right_angles_everywhere() {
        let found = details(&cube());
        assert_eq!((found.vertices.len(), found.edges.len()), (8, 12));
        assert!(found.vertices.iter().all(|v| v.valence == 3 && !v.is_on_rim));
        assert!(
            found
                .vertices
                .iter()
                .all(|v| v.deficit_degrees.is_some_and(|d| (d - 90.0).abs() < 1e-12))
        );
        assert!(
            found
                .edges
                .iter()
                .all(|e| e.dihedral_degrees.is_some_and(|d| (d - 90.0).abs() < 1e-12))
        );
        assert!(found.edges.iter().all(|e| e.length_mm == 2.0));
    }

    #[test]
    fn rims_have_no_dihedral_and_the_deficits_of_a_ball_are_720_degrees() {
        let open = details(&open_box());
        assert_eq!(open.edges.iter().filter(|e| e.dihedral_degrees.is_none()).count(), 4);
        assert_eq!(open.vertices.iter().filter(|v| v.is_on_rim).count(), 4);
        let ball = details(&octahedron());
        let total: f64 = ball.vertices.iter().filter_map(|v| v.deficit_degrees).sum();
        assert!((total - 720.0).abs() < 1e-10, "{total}");
    }
}
