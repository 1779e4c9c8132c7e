//! Reads an OBJ file that was written back, by a reader that is not ours, and compares it with the
//! mesh: a wrong file must not leave the house.
//!
//! The crate `tobj` numbers positions by their first use within each group, so corners are compared
//! by where they lie, face by face in the order of the file.

use glam::DVec3;
use tobj::{LoadError, LoadOptions, Model};

use super::polygons::Polygons;
use crate::mesh::Mesh;

/// Whether every face of the mesh stands in the text, with its corners where they are, to the last
/// digit.
pub(super) fn says(text: &[u8], mesh: &Mesh) -> bool {
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let mut reader = text;
    let Ok((models, _)) = tobj::load_obj_buf(&mut reader, &LoadOptions::default(), no_materials)
    else {
        return false;
    };
    let polygons = Polygons::of(mesh);
    let mut read = models.iter().flat_map(faces_of);
    let all_are_there = polygons.faces().all(|(_, corners)| {
        let wanted = corners.iter().map(|&corner| polygons.positions[corner]);
        read.next().is_some_and(|face| face.eq(wanted))
    });
    all_are_there && read.next().is_none()
}

/// The faces of a group as the positions of their corners; lines are no faces.
fn faces_of(model: &Model) -> impl Iterator<Item = impl Iterator<Item = DVec3> + '_> + '_ {
    let mesh = &model.mesh;
    // Sides are only listed where not all faces are triangles.
    let count =
        if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { mesh.face_arities.len() };
    let sides = |i: usize| mesh.face_arities.get(i).map_or(3, |&sides| sides as usize);
    let mut end = 0;
    let runs = (0..count).map(move |i| {
        let start = end;
        end += sides(i);
        &mesh.indices[start..end]
    });
    runs.filter(|run| run.len() > 2).map(|run| {
        run.iter().map(|&i| DVec3::from_slice(&mesh.positions[3 * i as usize..3 * i as usize + 3]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{MeshFormat, WriteOptions, mesh_bytes};
    use crate::shape::{soccer_ball, tetrahedron};

    #[test]
    fn what_was_written_is_there_and_what_was_changed_is_not() {
        let mut mesh = soccer_ball(7.1);
        let half: Vec<_> = mesh.faces().take(16).collect();
        for f in half {
            mesh.set_group(f, "lower half");
        }
        let options = WriteOptions::default();
        let text = mesh_bytes(MeshFormat::Obj, &mesh, &options).expect("a sound mesh");
        assert!(says(&text, &mesh));
        let text = String::from_utf8(text).expect("text");
        let faces = text.matches("\nf ").count();
        assert_eq!(faces, 32);
        let lost_face = text.rsplit_once("\nf ").expect("a face").0.to_owned() + "\n";
        assert!(!says(lost_face.as_bytes(), &mesh));
        let first = text.find("v ").expect("a vertex");
        let mut moved = text.clone();
        moved.insert(first + 2, '1');
        assert!(!says(moved.as_bytes(), &mesh));
        assert!(!says(b"f 1 2 x\n", &mesh));
        let triangles = tetrahedron(1.0);
        let text = mesh_bytes(MeshFormat::Obj, &triangles, &options).expect("a sound mesh");
        assert!(says(&text, &triangles) && !says(&text, &mesh));
    }
}
