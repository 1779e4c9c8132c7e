//! Cavities under local cuts: a local cut reaches only what is connected with its element, so it
//! may take the shell around a cavity and leave the cavity.

use glam::DVec3;

use super::OpError;
use super::cut::{Cutter, Reach, SlicingPlane};
use crate::geom::Plane;
use crate::measure::{crossings, winding_number};
use crate::mesh::{Component, FaceId, FaceMap, Mesh, VertexId};

/// A point is inside when surfaces go around it more often than this.
const INSIDE: f64 = 0.5;

/// The cavities of a solid before it is cut.
pub(super) struct Cavities {
    /// The vertices of each.
    list: Vec<Vec<VertexId>>,
}

impl Cavities {
    /// The closed parts that look inwards and lie inside of others.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let components = mesh.components();
        let mut list = Vec::new();
        if components.len() > 1 {
            let inwards = components.into_iter().filter(|c| c.holes == 0 && volume(mesh, c) < 0.0);
            for component in inwards {
                if is_enclosed(mesh, &component.vertices, &component.faces) {
                    list.push(component.vertices);
                }
            }
        }
        Self { list }
    }

    /// Takes away the cavities that have no solid around them any more; returns how many.
    ///
    /// # Errors
    /// [`OpError::CavityLaidOpen`] where the cuts run into a cavity.
    pub(super) fn settle(&self, cutter: &mut Cutter) -> Result<usize, OpError> {
        let mut gone = 0;
        for vertices in &self.list {
            let living = |v: &&VertexId| cutter.mesh().has_vertex(**v);
            let Some(&start) = vertices.iter().find(living) else { continue };
            let own = connected(cutter.mesh(), start);
            if is_enclosed(cutter.mesh(), &[start], &own) {
                if is_crossed(cutter.mesh(), &own) {
                    return Err(OpError::CavityLaidOpen { vertex: start });
                }
            } else {
                take_away(cutter, start);
                gone += 1;
            }
        }
        Ok(gone)
    }
}

/// The signed volume of a part.
fn volume(mesh: &Mesh, component: &Component) -> f64 {
    let origin = component.vertices.first().map_or(DVec3::ZERO, |&v| mesh.position(v));
    let cone = |f: FaceId| {
        let corners: Vec<DVec3> =
            mesh.face_vertices(f).map(|v| mesh.position(v) - origin).collect();
        let fan = corners.windows(2).skip(1);
        fan.map(|pair| corners[0].dot(pair[0].cross(pair[1]))).sum::<f64>()
    };
    component.faces.iter().map(|&f| cone(f)).sum::<f64>() / 6.0
}

/// Whether faces other than a part's own go around its first vertex.
fn is_enclosed(mesh: &Mesh, vertices: &[VertexId], own: &[FaceId]) -> bool {
    let mut is_own = FaceMap::filled(mesh.face_slots(), false);
    own.iter().for_each(|&f| is_own[f] = true);
    let others = mesh.faces().filter(|&f| !is_own[f]);
    winding_number(mesh, others, mesh.position(vertices[0])) > INSIDE
}

/// The faces that are connected with a vertex.
fn connected(mesh: &Mesh, start: VertexId) -> Vec<FaceId> {
    let mut is_found = FaceMap::filled(mesh.face_slots(), false);
    let mut faces: Vec<FaceId> = Vec::new();
    let mut open: Vec<FaceId> = mesh.vertex_faces(start).collect();
    while let Some(f) = open.pop() {
        if !std::mem::replace(&mut is_found[f], true) {
            faces.push(f);
            open.extend(mesh.face_half_edges(f).map(|h| mesh.face(h.twin())));
        }
    }
    faces.retain(|&f| !mesh.is_hole(f));
    faces
}

/// Whether a part crosses another.
fn is_crossed(mesh: &Mesh, own: &[FaceId]) -> bool {
    let mut is_own = FaceMap::filled(mesh.face_slots(), false);
    own.iter().for_each(|&f| is_own[f] = true);
    crossings(mesh, usize::MAX).iter().any(|pair| is_own[pair.first] != is_own[pair.second])
}

/// Cuts a whole part off, by a plane that has all of it in front.
fn take_away(cutter: &mut Cutter, start: VertexId) {
    let Some((low, high)) = cutter.mesh().bounds() else { return };
    let below = low - (high - low).max(DVec3::splat(f64::MIN_POSITIVE)) - low.abs().max(high.abs());
    if let Some(plane) = Plane::new(DVec3::Z, below) {
        cutter.cut(&SlicingPlane { plane, given: None }, Reach::Local(&[start]));
    }
}
