//! Which points get a hull of their own.

use glam::DVec3;

use super::super::OpError;
use super::HullParams;
use super::convex_parts::convex_parts;
use crate::mesh::{FaceId, Mesh, VertexId};

/// Points that get one hull together.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Cluster {
    pub name: String,
    pub points: Vec<DVec3>,
    /// For each point whether it came with the input.
    pub is_given: Vec<bool>,
}

/// All clusters that hold points, and how many hold none.
pub(super) struct Clusters {
    pub parts: Vec<Cluster>,
    pub empty: usize,
}

impl Cluster {
    fn of(mesh: &Mesh, name: String, vertices: impl IntoIterator<Item = VertexId>) -> Self {
        let (points, is_given) =
            vertices.into_iter().map(|v| (mesh.position(v), mesh.is_given(v))).unzip();
        Self { name, points, is_given }
    }
}

/// Divides the vertices of a mesh as the parameters say. Every vertex is in a cluster.
pub(super) fn clusters(mesh: &Mesh, params: &HullParams) -> Result<Clusters, OpError> {
    if let Some(count) = params.clusters {
        return Ok(slabs(mesh, count as usize, params.axis as usize));
    }
    let parts = if params.by_group {
        groups(mesh)
    } else if let Some(most) = params.parts {
        automatic(mesh, most, params.concavity)
    } else {
        vec![Cluster::of(mesh, "hull".to_owned(), mesh.vertices())]
    };
    Ok(Clusters { parts, empty: 0 })
}

/// Slabs of equal height across an axis; a vertex between two belongs to the upper one.
fn slabs(mesh: &Mesh, count: usize, axis: usize) -> Clusters {
    let (low, high) = mesh.bounds().map_or((0.0, 0.0), |(low, high)| (low[axis], high[axis]));
    let mut slabs: Vec<Vec<VertexId>> = vec![Vec::new(); count];
    for v in mesh.vertices() {
        let share = (mesh.position(v)[axis] - low) / (high - low);
        // A cast takes the NaN of a flat model to 0.
        let slab = ((share * count as f64) as usize).min(count - 1);
        slabs[slab].push(v);
    }
    let empty = slabs.iter().filter(|slab| slab.is_empty()).count();
    let named = slabs.into_iter().enumerate().filter(|(_, slab)| !slab.is_empty());
    let parts = named.map(|(i, slab)| Cluster::of(mesh, format!("slab-{}", i + 1), slab)).collect();
    Clusters { parts, empty }
}

/// The vertices of each face group, in the order of the groups; of the faces without a group and
/// the stray vertices last.
fn groups(mesh: &Mesh) -> Vec<Cluster> {
    let mut is_grouped = vec![false; mesh.vertex_slots()];
    let mut parts = Vec::new();
    for name in mesh.groups() {
        let faces = mesh.faces().filter(|&f| mesh.group(f) == Some(name));
        let vertices = vertices_of(mesh, faces);
        vertices.iter().for_each(|v| is_grouped[v.index()] = true);
        if !vertices.is_empty() {
            parts.push(Cluster::of(mesh, name.clone(), vertices));
        }
    }
    let mut rest = vertices_of(mesh, mesh.faces().filter(|&f| mesh.group(f).is_none()));
    rest.extend(mesh.vertices().filter(|v| !is_grouped[v.index()]));
    rest.sort_unstable();
    rest.dedup();
    if !rest.is_empty() {
        parts.push(Cluster::of(mesh, "rest".to_owned(), rest));
    }
    parts
}

fn vertices_of(mesh: &Mesh, faces: impl Iterator<Item = FaceId>) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> =
        faces.flat_map(|f| mesh.face_vertices(f).collect::<Vec<_>>()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Nearly convex parts of a concave model. The points are where the parts meet the surface, and
/// every vertex besides, so that the hulls together hold all vertices.
fn automatic(mesh: &Mesh, most: u32, concavity: f64) -> Vec<Cluster> {
    let vertices: Vec<VertexId> = mesh.vertices().collect();
    let points: Vec<DVec3> = vertices.iter().map(|&v| mesh.position(v)).collect();
    let mut number = vec![0_u32; mesh.vertex_slots()];
    vertices.iter().enumerate().for_each(|(i, v)| number[v.index()] = i as u32);
    let mut triangles = Vec::new();
    for f in mesh.faces() {
        let corners: Vec<u32> = mesh.face_vertices(f).map(|v| number[v.index()]).collect();
        let fan = (2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]);
        triangles.extend(fan.filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
    }
    let pieces = convex_parts(&points, &triangles, most, concavity);
    if pieces.len() < 2 {
        return vec![Cluster::of(mesh, "part-1".to_owned(), vertices)];
    }
    let part = |(i, pieces): (usize, Vec<DVec3>)| {
        let is_given = vec![false; pieces.len()];
        Cluster { name: format!("part-{}", i + 1), points: pieces, is_given }
    };
    let mut parts: Vec<Cluster> = pieces.into_iter().enumerate().map(part).collect();
    add_missing(mesh, &vertices, &mut parts);
    parts
}

/// Adds each vertex to the part with the nearest point: cut corners come back, and no vertex is
/// left out.
fn add_missing(mesh: &Mesh, vertices: &[VertexId], parts: &mut [Cluster]) {
    let mut nearest = vec![(f64::INFINITY, 0); vertices.len()];
    for (k, part) in parts.iter().enumerate() {
        for (best, &v) in nearest.iter_mut().zip(vertices) {
            let position = mesh.position(v);
            let distance = part
                .points
                .iter()
                .map(|p| p.distance_squared(position))
                .fold(f64::INFINITY, f64::min);
            if distance < best.0 {
                *best = (distance, k);
            }
        }
    }
    for ((_, k), &v) in nearest.into_iter().zip(vertices) {
        parts[k].points.push(mesh.position(v));
        parts[k].is_given.push(mesh.is_given(v));
    }
}
