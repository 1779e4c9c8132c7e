//! Which faces belong to one piece: what marked seams bound, else what is connected.

use crate::mesh::{FaceMap, Mesh};

/// A number for every face, from 0, in the order in which pieces are met.
pub(super) fn piece_of_faces(mesh: &Mesh) -> FaceMap<usize> {
    let mut pieces = FaceMap::filled(mesh.face_slots(), usize::MAX);
    let mut count = 0;
    for first in mesh.faces() {
        if pieces[first] != usize::MAX {
            continue;
        }
        pieces[first] = count;
        let mut waiting = vec![first];
        while let Some(f) = waiting.pop() {
            for h in mesh.face_half_edges(f) {
                let other = mesh.face(h.twin());
                let is_bound = mesh.is_seam(h.edge()) || mesh.is_hole(other);
                if !is_bound && pieces[other] == usize::MAX {
                    pieces[other] = count;
                    waiting.push(other);
                }
            }
        }
        count += 1;
    }
    pieces
}
