//! What was written is read back before it leaves the house, so that no file says anything else
//! than the mesh.
//!
//! That a reader of polygons finds the same elements is counted from the corners of the faces alone
//! ([`Mesh::file_counts`]); that the bytes say these corners is compared number by number. STL has
//! neither polygons nor numbers of vertices, so it goes through the reader as a whole, and what must
//! stay are rims, parts and handles.

use std::path::Path;

use super::polygons::Polygons;
use super::{faces_dxf, obj_check};
use crate::io::error::IoError;
use crate::io::format::MeshFormat;
use crate::io::read::{ReadOptions, polygons_in, read_mesh_bytes};
use crate::mesh::Mesh;

/// Refuses a mesh of which a reader would find other elements. Self-loops and faces of two sides
/// are no part of files, so a mesh with some of them is read otherwise on purpose.
pub(super) fn check_counts(mesh: &Mesh) -> Result<(), IoError> {
    let (wanted, found) = (mesh.counts(), mesh.file_counts());
    match found {
        Some(found) if found == wanted || has_more_than_files(mesh) => Ok(()),
        _ => Err(IoError::ReadAsOther { wanted, found }),
    }
}

/// Whether a mesh has self-loops, or faces with fewer than three sides that are none.
pub(super) fn has_more_than_files(mesh: &Mesh) -> bool {
    let is_loop = |h| mesh.origin(h) == mesh.target(h);
    mesh.edges().any(|e| is_loop(e.half_edge())) || mesh.faces().any(|f| mesh.sides(f) < 3)
}

/// Refuses bytes that say something else than the mesh.
pub(super) fn check_bytes(format: MeshFormat, bytes: &[u8], mesh: &Mesh) -> Result<(), IoError> {
    let is_right = match format {
        MeshFormat::Obj => obj_check::says(bytes, mesh),
        MeshFormat::Ply | MeshFormat::Off => says(format, bytes, mesh),
        MeshFormat::Stl => return check_stl(bytes, mesh),
        MeshFormat::ThreeMf => return check_triangles(format, bytes, mesh),
        MeshFormat::Dxf => faces_dxf::says(bytes, mesh),
        // None is written.
        MeshFormat::Glb => false,
    };
    if is_right { Ok(()) } else { Err(IoError::NotReadBack { format }) }
}

/// Whether the bytes hold all vertices and faces of the mesh, to the last digit.
fn says(format: MeshFormat, bytes: &[u8], mesh: &Mesh) -> bool {
    let Some((positions, faces)) = polygons_in(format, bytes) else { return false };
    let polygons = Polygons::of(mesh);
    let is_same = |(read, (_, wanted)): (&[u32], (_, &[usize]))| {
        read.len() == wanted.len() && read.iter().zip(wanted).all(|(&a, &b)| a as usize == b)
    };
    positions == polygons.positions
        && faces.count() == polygons.face_count()
        && faces.iter().zip(polygons.faces()).all(is_same)
}

fn check_stl(bytes: &[u8], mesh: &Mesh) -> Result<(), IoError> {
    match other_shape(MeshFormat::Stl, bytes, mesh)? {
        Some(why) => Err(IoError::NotForStl { why }),
        None => Ok(()),
    }
}

/// Refuses triangles of which the vertices are not those of the mesh, and a mesh that its triangles
/// do not hold: two of them may come to run along one line where the faces did not.
fn check_triangles(format: MeshFormat, bytes: &[u8], mesh: &Mesh) -> Result<(), IoError> {
    let positions = polygons_in(format, bytes).map(|(positions, _)| positions);
    if positions.as_ref() != Some(&Polygons::of(mesh).positions) {
        return Err(IoError::NotReadBack { format });
    }
    match other_shape(format, bytes, mesh)? {
        Some(why) => Err(IoError::NotForTriangles { format, why }),
        None => Ok(()),
    }
}

/// What keeps the file from having the rims, parts and handles of the mesh.
fn other_shape(format: MeshFormat, bytes: &[u8], mesh: &Mesh) -> Result<Option<String>, IoError> {
    let name = format.to_string();
    let read = match read_mesh_bytes(Path::new(&name), bytes, &ReadOptions::default()) {
        Ok(read) => read.mesh.counts(),
        Err(error) => return Ok(Some(error.to_string())),
    };
    let wanted = mesh.file_counts().ok_or(IoError::NotReadBack { format })?;
    let of = |counts: crate::mesh::FileCounts| (counts.rims, counts.components, counts.euler());
    Ok((of(read) != of(wanted)).then(|| format!("it would be read as {read}")))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::io::{WriteOptions, mesh_bytes};
    use crate::mesh::{FaceId, FaceKind};
    use crate::shape::{cube, soccer_ball};

    #[test]
    fn what_was_written_is_there_and_what_was_changed_is_not() {
        let mesh = soccer_ball(7.1);
        for format in [MeshFormat::Ply, MeshFormat::Off] {
            let bytes = mesh_bytes(format, &mesh, &WriteOptions::default()).expect("sound");
            assert!(check_bytes(format, &bytes, &mesh).is_ok());
            assert!(check_bytes(format, &bytes, &cube(7.1)).is_err());
            let text = String::from_utf8(bytes).expect("text");
            let (start, last) = text.trim_end().rsplit_once(' ').expect("numbers");
            let other = format!("{start} {}\n", if last == "0" { "1" } else { "0" });
            assert!(check_bytes(format, other.as_bytes(), &mesh).is_err());
            assert!(check_bytes(format, b"rubbish", &mesh).is_err());
        }
    }

    #[test]
    fn a_vertex_with_several_rims_is_not_written() {
        let points = (0..5).map(|i| DVec3::new(f64::from(i * i), f64::from(i), 0.0));
        let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        let mut mesh = Mesh::from_faces(points, fan).expect("a fan");
        mesh.set_kind(FaceId::new(0), FaceKind::Hole);
        mesh.set_kind(FaceId::new(2), FaceKind::Hole);
        let error = mesh_bytes(MeshFormat::Off, &mesh, &WriteOptions::default());
        let Err(IoError::ReadAsOther { wanted, found: Some(found) }) = error else {
            panic!("{error:?}")
        };
        assert_eq!((wanted.vertices, found.vertices), (5, 6));
    }

    /// STL knows an edge by the places of its ends, so boxes that touch in one have four faces
    /// there. Boxes that touch in a corner are read as they were.
    #[test]
    fn parts_that_touch_along_an_edge_are_not_written_as_stl() {
        let boxes = |step: DVec3| {
            let corner =
                |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
            let sides = [
                [0, 2, 3, 1],
                [4, 5, 7, 6],
                [0, 1, 5, 4],
                [2, 6, 7, 3],
                [0, 4, 6, 2],
                [1, 3, 7, 5],
            ];
            let points = (0..8).map(corner).chain((0..8).map(|i| corner(i) + step));
            let faces = sides.into_iter().chain(sides.map(|side| side.map(|i| i + 8)));
            Mesh::from_faces(points, faces).expect("two boxes")
        };
        let write = |format, mesh: &Mesh| mesh_bytes(format, mesh, &WriteOptions::default());
        let along_edge = boxes(DVec3::new(1.0, 1.0, 0.0));
        assert!(write(MeshFormat::Obj, &along_edge).is_ok());
        let error = write(MeshFormat::Stl, &along_edge).expect_err("four faces at an edge");
        assert!(error.to_string().contains("more than two faces"), "{error}");
        assert!(write(MeshFormat::Stl, &boxes(DVec3::ONE)).is_ok());
        // Two parts that rounding makes one.
        let near = boxes(DVec3::new(1.0 + 1e-12, 0.0, 0.0));
        assert!(matches!(write(MeshFormat::Stl, &near), Err(IoError::NotForStl { .. })));
    }
}
