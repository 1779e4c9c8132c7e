//! A net in the numbers of a mesh that was read anew.
//!
//! A file names faces and vertices; the numbers of edges, and the corner at which a face begins,
//! are ours and depend on who built the mesh. Before anybody's net is proved its edges are found
//! again by their faces and ends.

use std::collections::HashSet;

use super::structure::{is_face, is_vertex};
use crate::mesh::{EdgeId, FaceId, Mesh, VertexId};
use crate::net::{EdgeLabel, FlatFace, Net};

/// The same net with edges numbered, ends and sides ordered, and faces begun as on the mesh. What
/// the mesh does not have stays as it is, for [`super::prove`] to find.
pub fn renumbered(mesh: &Mesh, net: &Net) -> Net {
    let mut net = net.clone();
    net.pieces
        .iter_mut()
        .flat_map(|piece| &mut piece.faces)
        .for_each(|flat| begin_as_on_mesh(mesh, flat));
    let mut taken = HashSet::new();
    for fold in &mut net.folds {
        let Some(e) = find(mesh, fold.edge, fold.faces, &mut taken) else { continue };
        fold.id = EdgeLabel(e.index());
        if is_turned(mesh, e, fold.edge) {
            fold.edge.reverse();
            fold.segment.reverse();
        }
        if mesh.edge_faces(e).map(FaceId::index) != fold.faces {
            fold.faces.reverse();
        }
    }
    for seam in &mut net.seams {
        let faces = [seam.sides[0].face, seam.sides[1].face];
        let Some(e) = find(mesh, seam.edge, faces, &mut taken) else { continue };
        seam.id = EdgeLabel(e.index());
        if is_turned(mesh, e, seam.edge) {
            seam.edge.reverse();
            seam.sides.iter_mut().for_each(|side| side.segment.reverse());
        }
        if mesh.edge_faces(e).map(FaceId::index) != faces {
            seam.sides.reverse();
        }
    }
    for rim in &mut net.rims {
        let Some(e) =
            edges_of(mesh, rim.face).find(|&e| mesh.is_rim(e) && joins(mesh, e, rim.edge))
        else {
            continue;
        };
        if is_turned(mesh, e, rim.edge) {
            rim.edge.reverse();
            rim.segment.reverse();
        }
    }
    net
}

fn begin_as_on_mesh(mesh: &Mesh, flat: &mut FlatFace) {
    if flat.face >= mesh.face_slots() || !is_face(mesh, FaceId::new(flat.face)) {
        return;
    }
    let corners: Vec<VertexId> = mesh.face_vertices(FaceId::new(flat.face)).collect();
    let n = corners.len();
    if flat.vertices.len() != n || flat.polygon.len() != n {
        return;
    }
    let fits = |&shift: &usize| {
        (0..n).all(|i| is_vertex(mesh, flat.vertices[(i + shift) % n], corners[i]))
    };
    if let Some(shift) = (0..n).find(fits) {
        flat.vertices.rotate_left(shift);
        flat.polygon.rotate_left(shift);
    }
}

/// The edge between two faces with these ends. Where two faces share several such edges, each is
/// found once.
fn find(
    mesh: &Mesh,
    ends: [usize; 2],
    faces: [usize; 2],
    taken: &mut HashSet<EdgeId>,
) -> Option<EdgeId> {
    let is_between = |&e: &EdgeId| {
        let [f, g] = mesh.edge_faces(e).map(FaceId::index);
        ([f, g] == faces || [g, f] == faces) && joins(mesh, e, ends)
    };
    let fitting: Vec<EdgeId> = edges_of(mesh, faces[0]).filter(is_between).collect();
    let e = fitting.iter().find(|e| !taken.contains(e)).or(fitting.first()).copied()?;
    taken.insert(e);
    Some(e)
}

fn edges_of(mesh: &Mesh, face: usize) -> impl Iterator<Item = EdgeId> + '_ {
    let face =
        (face < mesh.face_slots() && is_face(mesh, FaceId::new(face))).then(|| FaceId::new(face));
    face.into_iter().flat_map(|f| mesh.face_half_edges(f)).map(|h| h.edge())
}

fn joins(mesh: &Mesh, e: EdgeId, [a, b]: [usize; 2]) -> bool {
    let [v, w] = mesh.edge_vertices(e);
    (is_vertex(mesh, a, v) && is_vertex(mesh, b, w))
        || (is_vertex(mesh, a, w) && is_vertex(mesh, b, v))
}

fn is_turned(mesh: &Mesh, e: EdgeId, [a, b]: [usize; 2]) -> bool {
    let [v, w] = mesh.edge_vertices(e);
    !(is_vertex(mesh, a, v) && is_vertex(mesh, b, w))
}
