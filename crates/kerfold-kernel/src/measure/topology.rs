//! Numbers that no position changes: valences, genus, rims, Euler's number.

use std::collections::BTreeMap;

use super::edge_length;
use crate::mesh::{FaceId, Mesh, VertexId};

/// How many vertices have how many edges, by valence. Stray vertices count under 0.
pub fn valence_histogram(mesh: &Mesh) -> BTreeMap<usize, usize> {
    histogram(mesh.vertices().map(|v| mesh.valence(v)))
}

/// How many faces have how many sides.
pub fn sides_histogram(mesh: &Mesh) -> BTreeMap<usize, usize> {
    histogram(mesh.faces().map(|f| mesh.sides(f)))
}

/// The vertices whose valence is not three, ascending.
pub fn other_valences(mesh: &Mesh) -> Vec<VertexId> {
    mesh.vertices().filter(|&v| mesh.valence(v) != 3).collect()
}

/// The vertices without an edge, ascending.
pub fn stray_vertices(mesh: &Mesh) -> Vec<VertexId> {
    mesh.vertices().filter(|&v| mesh.vertex_start(v).is_none()).collect()
}

/// The number of handles of all components together; rims count as closed by discs.
pub fn genus(mesh: &Mesh) -> usize {
    mesh.components().iter().map(|c| c.genus).sum()
}

/// V − E + F, holes not counted as faces: 2 for a ball, 1 for a disc, 0 for a torus.
pub fn euler_number(mesh: &Mesh) -> i64 {
    mesh.vertex_count() as i64 - mesh.edge_count() as i64 + mesh.face_count() as i64
}

/// The edge of an opening in the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// The hole that it bounds.
    pub hole: FaceId,
    /// Number of edges.
    pub edges: usize,
    /// Length all around, in mm.
    pub length: f64,
}

/// The rims, in the order of their holes.
pub fn rims(mesh: &Mesh) -> Vec<Rim> {
    let rim = |hole| Rim {
        hole,
        edges: mesh.sides(hole),
        length: mesh.face_half_edges(hole).map(|h| edge_length(mesh, h.edge())).sum(),
    };
    mesh.holes().map(rim).collect()
}

fn histogram(values: impl Iterator<Item = usize>) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    for value in values {
        *counts.entry(value).or_insert(0) += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::fixtures::{cube, open_box, torus};

    #[test]
    fn a_cube_has_three_edges_everywhere() {
        let mesh = cube();
        assert_eq!(valence_histogram(&mesh), BTreeMap::from([(3, 8)]));
        assert_eq!(sides_histogram(&mesh), BTreeMap::from([(4, 6)]));
        assert!(other_valences(&mesh).is_empty() && rims(&mesh).is_empty());
        assert_eq!((genus(&mesh), euler_number(&mesh)), (0, 2));
    }

    #[test]
    fn a_torus_has_a_handle_and_four_edges_everywhere() {
        let mesh = torus(5, 4);
        assert_eq!((genus(&mesh), euler_number(&mesh)), (1, 0));
        assert_eq!(valence_histogram(&mesh), BTreeMap::from([(4, 20)]));
        assert_eq!(other_valences(&mesh).len(), 20);
    }

    #[test]
    fn an_open_box_has_one_rim_and_a_point_is_stray() {
        let mut mesh = open_box();
        let (v, _) = mesh.create_vertex(glam::DVec3::ONE);
        let rims = rims(&mesh);
        assert_eq!(rims.iter().map(|r| (r.edges, r.length)).collect::<Vec<_>>(), [(4, 8.0)]);
        assert_eq!(stray_vertices(&mesh), [v]);
        assert_eq!(other_valences(&mesh), [v]);
        assert_eq!(valence_histogram(&mesh), BTreeMap::from([(0, 1), (3, 8)]));
    }
}
