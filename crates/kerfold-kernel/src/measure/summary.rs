//! The whole model in one table: what `kerfold info` shows.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{
    edge_length, euler_number, rims, sides_histogram, size, stray_vertices, surface_area,
    valence_histogram,
};
use crate::mesh::{Component, Mesh, VertexMap};

/// Counts and sizes of a model, in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces, holes not counted.
    pub faces: usize,
    /// V − E + F.
    pub euler_number: i64,
    /// The connected parts, ordered by their lowest vertex.
    pub components: Vec<ComponentSummary>,
    /// Number of edges of each rim.
    pub rims: Vec<usize>,
    /// Length of all rims, in mm.
    pub rim_length: f64,
    /// Vertices without an edge.
    pub stray_vertices: usize,
    /// Extent along the three axes, in mm.
    pub size: DVec3,
    /// Area of all faces, in mm².
    pub area: f64,
    /// Edge lengths; `None` without edges.
    pub edge_lengths: Option<EdgeLengths>,
    /// How many vertices have how many edges.
    pub valences: BTreeMap<usize, usize>,
    /// How many faces have how many sides.
    pub sides: BTreeMap<usize, usize>,
    /// The face groups with at least one face, in the order in which they came up.
    pub groups: Vec<GroupSummary>,
    /// Edges marked as seams.
    pub seams: usize,
}

/// One connected part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComponentSummary {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Number of handles, rims closed by discs.
    pub genus: usize,
    /// Number of rims.
    pub rims: usize,
    /// Enclosed volume in mm³, negative when the faces look inwards; `None` when open.
    pub volume: Option<f64>,
}

/// The spread of the edge lengths, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLengths {
    /// The shortest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The longest.
    pub max: f64,
    /// All together.
    pub total: f64,
}

/// A face group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroupSummary {
    /// Its name.
    pub name: String,
    /// Number of its faces.
    pub faces: usize,
}

/// Sums up a mesh.
pub fn summary(mesh: &Mesh) -> Summary {
    let rims = rims(mesh);
    Summary {
        vertices: mesh.vertex_count(),
        edges: mesh.edge_count(),
        faces: mesh.face_count(),
        euler_number: euler_number(mesh),
        components: components(mesh),
        rims: rims.iter().map(|rim| rim.edges).collect(),
        rim_length: rims.iter().map(|rim| rim.length).sum(),
        stray_vertices: stray_vertices(mesh).len(),
        size: size(mesh),
        area: surface_area(mesh),
        edge_lengths: edge_lengths(mesh),
        valences: valence_histogram(mesh),
        sides: sides_histogram(mesh),
        groups: groups(mesh),
        seams: mesh.edges().filter(|&e| mesh.is_seam(e)).count(),
    }
}

/// The spread of the edge lengths; `None` without edges.
pub fn edge_lengths(mesh: &Mesh) -> Option<EdgeLengths> {
    let (mut min, mut max, mut total) = (f64::INFINITY, 0.0_f64, 0.0);
    for e in mesh.edges() {
        let length = edge_length(mesh, e);
        (min, max, total) = (min.min(length), max.max(length), total + length);
    }
    let count = mesh.edge_count();
    (count > 0).then(|| EdgeLengths { min, mean: total / count as f64, max, total })
}

fn components(mesh: &Mesh) -> Vec<ComponentSummary> {
    let components = mesh.components();
    let volumes = volumes(mesh, &components);
    let summed = components.iter().zip(volumes).map(|(c, volume)| ComponentSummary {
        vertices: c.vertices.len(),
        edges: c.edges,
        faces: c.faces.len(),
        genus: c.genus,
        rims: c.holes,
        volume: (c.holes == 0).then_some(volume),
    });
    summed.collect()
}

/// The signed volume of each component, each measured from one of its own vertices.
fn volumes(mesh: &Mesh, components: &[Component]) -> Vec<f64> {
    let mut part = VertexMap::filled(mesh.vertex_slots(), 0);
    for (i, component) in components.iter().enumerate() {
        for &v in &component.vertices {
            part[v] = i;
        }
    }
    let anchors: Vec<DVec3> = components.iter().map(|c| mesh.position(c.vertices[0])).collect();
    let mut volumes = vec![0.0; components.len()];
    for f in mesh.faces() {
        let Some(i) = mesh.face_vertices(f).next().map(|v| part[v]) else { continue };
        let corners: Vec<DVec3> =
            mesh.face_vertices(f).map(|v| mesh.position(v) - anchors[i]).collect();
        let fan = corners.windows(2).skip(1).map(|w| corners[0].dot(w[0].cross(w[1])));
        volumes[i] += fan.sum::<f64>() / 6.0;
    }
    volumes
}

fn groups(mesh: &Mesh) -> Vec<GroupSummary> {
    let mut counts = std::collections::HashMap::new();
    for f in mesh.faces() {
        if let Some(name) = mesh.group(f) {
            *counts.entry(name).or_insert(0) += 1;
        }
    }
    let known = mesh.groups().iter().filter_map(|name| Some((name, *counts.get(name.as_str())?)));
    known.map(|(name, faces)| GroupSummary { name: name.clone(), faces }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::fixtures::{cube, open_box, torus};
    use crate::mesh::{EdgeId, FaceId, MeshBuilder};

    #[test]
    fn a_cube_in_numbers() {
        let mut mesh = cube();
        mesh.set_group(FaceId::new(2), "front");
        mesh.set_seam(EdgeId::new(0), true);
        let found = summary(&mesh);
        assert_eq!((found.vertices, found.edges, found.faces, found.euler_number), (8, 12, 6, 2));
        assert_eq!(
            found.edge_lengths,
            Some(EdgeLengths { min: 2.0, mean: 2.0, max: 2.0, total: 24.0 })
        );
        assert_eq!((found.size, found.area), (DVec3::splat(2.0), 24.0));
        assert_eq!(found.groups, [GroupSummary { name: "front".into(), faces: 1 }]);
        assert_eq!((found.seams, found.stray_vertices), (1, 0));
        let part = ComponentSummary {
            vertices: 8,
            edges: 12,
            faces: 6,
            genus: 0,
            rims: 0,
            volume: Some(8.0),
        };
        assert_eq!(found.components, [part]);
    }

    #[test]
    fn components_have_their_own_volume_and_open_ones_none() {
        let mut builder = MeshBuilder::new();
        let mut add = |mesh: &Mesh, shift: f64| {
            let ids: Vec<usize> =
                mesh.vertices().map(|v| builder.vertex(mesh.position(v) + shift)).collect();
            for f in mesh.faces() {
                builder.face(mesh.face_vertices(f).map(|v| ids[v.index()]));
            }
        };
        add(&cube(), 1e5);
        add(&open_box(), 0.0);
        add(&torus(6, 5), -50.0);
        let (mesh, _) = builder.build().expect("three parts");
        let found = summary(&mesh);
        let of = |i: usize| (found.components[i].genus, found.components[i].rims);
        assert_eq!((of(0), of(1), of(2)), ((0, 0), (0, 1), (1, 0)));
        assert!((found.components[0].volume.expect("closed") - 8.0).abs() < 1e-9);
        assert_eq!(found.components[1].volume, None);
        assert_eq!((found.rims, found.rim_length), (vec![4], 8.0));
    }
}
