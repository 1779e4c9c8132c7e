//! Faces as a file has them, before they are a mesh: lists of corners that may be anything.

use std::collections::HashMap;

use glam::DVec3;

use crate::geom::Plane;
use crate::mesh::{BuildError, FaceId, Mesh, MeshBuilder, VertexId};

/// One face of a [`Soup`].
#[derive(Debug, Clone, PartialEq)]
pub struct SoupFace {
    /// The numbers of its corners, counter-clockwise seen from outside.
    pub corners: Vec<u32>,
    /// Its number when it came; `None` for faces that close holes.
    pub source: Option<u32>,
}

/// Positions and faces that need not be a surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Soup {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// The faces; every corner is below the number of positions.
    pub faces: Vec<SoupFace>,
}

/// A side of a face: from one corner to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    /// The face, by its place in the list.
    pub face: u32,
    /// The place of the corner where it begins.
    pub corner: u32,
    pub from: u32,
    pub to: u32,
}

impl Side {
    /// Its ends, the lower first.
    pub fn ends(&self) -> [u32; 2] {
        [self.from.min(self.to), self.from.max(self.to)]
    }
}

impl Soup {
    /// The faces of a mesh, in its order.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let mut positions = vec![DVec3::ZERO; mesh.vertex_slots()];
        mesh.vertices().for_each(|v| positions[v.index()] = mesh.position(v));
        let face = |f: FaceId| SoupFace {
            corners: mesh.face_vertices(f).map(|v| v.index() as u32).collect(),
            source: Some(f.index() as u32),
        };
        Self { positions, faces: mesh.faces().map(face).collect() }
    }

    /// Builds the mesh, with the groups that the faces had in another one.
    ///
    /// # Errors
    /// [`BuildError`] for whatever is no surface.
    pub fn build(&self, groups: &Mesh) -> Result<Mesh, BuildError> {
        let mut builder = MeshBuilder::new();
        self.positions.iter().for_each(|&p| {
            builder.vertex(p);
        });
        for face in &self.faces {
            builder.face(face.corners.iter().map(|&v| v as usize));
        }
        let (mut mesh, _) = builder.build()?;
        for (i, face) in self.faces.iter().enumerate() {
            let before = face.source.map(|f| FaceId::new(f as usize));
            let is_there = |f: &FaceId| f.index() < groups.face_slots() && groups.has_face(*f);
            let group = before.filter(is_there).and_then(|f| groups.group(f));
            if let Some(name) = group {
                mesh.set_group(FaceId::new(i), name);
            }
        }
        for e in groups.edges().filter(|&e| groups.is_seam(e)) {
            let [a, b] = groups.edge_vertices(e);
            let is_there = |v: VertexId| v.index() < mesh.vertex_slots() && mesh.has_vertex(v);
            if is_there(a)
                && is_there(b)
                && let Some(e) = mesh.edge_between(a, b)
            {
                mesh.set_seam(e, true);
            }
        }
        mesh.compact();
        Ok(mesh)
    }

    /// The places of a face's corners.
    pub(super) fn places(&self, face: usize) -> Vec<DVec3> {
        self.faces[face].corners.iter().map(|&v| self.positions[v as usize]).collect()
    }

    /// The normal of a face; `None` without area.
    pub(super) fn normal(&self, face: usize) -> Option<DVec3> {
        Plane::newell(&self.places(face)).map(|plane| plane.normal())
    }

    /// Twice the area of a face, as a vector along its normal.
    pub(super) fn area_vector(&self, face: usize) -> DVec3 {
        let places = self.places(face);
        let Some((&first, rest)) = places.split_first() else { return DVec3::ZERO };
        rest.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum()
    }

    /// All sides, in the order of faces.
    pub(super) fn sides(&self) -> Vec<Side> {
        let mut sides = Vec::with_capacity(self.faces.iter().map(|f| f.corners.len()).sum());
        for (f, face) in self.faces.iter().enumerate() {
            let n = face.corners.len();
            sides.extend((0..n).map(|i| Side {
                face: f as u32,
                corner: i as u32,
                from: face.corners[i],
                to: face.corners[(i + 1) % n],
            }));
        }
        sides
    }

    /// The box around the vertices that faces use; `None` without any.
    pub(super) fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut used = self.faces.iter().flat_map(|f| &f.corners);
        let first = self.positions[*used.next()? as usize];
        Some(used.fold((first, first), |(low, high), &v| {
            let p = self.positions[v as usize];
            (low.min(p), high.max(p))
        }))
    }
}

/// The sides at each edge, by its two ends, in the order in which the edges first come.
pub(super) fn by_edge(sides: &[Side]) -> Vec<Vec<u32>> {
    let mut number: HashMap<[u32; 2], usize> = HashMap::with_capacity(sides.len() / 2 + 1);
    let mut edges: Vec<Vec<u32>> = Vec::new();
    for (i, side) in sides.iter().enumerate() {
        let e = *number.entry(side.ends()).or_insert_with(|| {
            edges.push(Vec::with_capacity(2));
            edges.len() - 1
        });
        edges[e].push(i as u32);
    }
    edges
}
