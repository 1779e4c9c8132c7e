//! Which points get a hull of their own.

use glam::DVec3;

use super::super::OpError;
use super::HullParams;
use super::decompose::convex_parts;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::progress::Progress;

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
pub(super) fn clusters(
    mesh: &Mesh,
    params: &HullParams,
    progress: &dyn Progress,
) -> Result<Clusters, OpError> {
    if let Some(count) = params.clusters {
        return Ok(slabs(mesh, count as usize, params.axis as usize));
    }
    let parts = if params.by_group {
        groups(mesh)
    } else if let Some(most) = params.parts {
        automatic(mesh, most as usize, params.concavity, progress)?
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

/// Nearly convex parts of a concave model; together they hold all vertices.
fn automatic(
    mesh: &Mesh,
    most: usize,
    concavity: f64,
    progress: &dyn Progress,
) -> Result<Vec<Cluster>, OpError> {
    let parts = convex_parts(mesh, most, concavity, progress)?;
    if parts.len() < 2 {
        return Ok(vec![Cluster::of(mesh, "part-1".to_owned(), mesh.vertices())]);
    }
    let mut clusters: Vec<Cluster> = Vec::with_capacity(parts.len());
    for (i, points) in (1..).zip(parts) {
        let (points, is_given) = points.into_iter().map(|p| (p.position, p.is_given)).unzip();
        clusters.push(Cluster { name: format!("part-{i}"), points, is_given });
    }
    Ok(clusters)
}
