//! Wavefront OBJ: polygons, face groups as `g`, seams as `l` lines in the group `seam`.

use std::io::Write as _;

use super::polygons::Polygons;
use super::{WriteOptions, one_line};
use crate::mesh::Mesh;

/// What OBJ calls the group of faces that belong to none.
const NO_GROUP: &str = "default";

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Vec<u8> {
    let polygons = Polygons::of(mesh);
    let mut text = Vec::with_capacity(48 * polygons.positions.len() + 24 * polygons.face_count());
    write_into(&mut text, mesh, &polygons, options).expect("writing into memory does not fail");
    text
}

fn write_into(
    text: &mut Vec<u8>,
    mesh: &Mesh,
    polygons: &Polygons,
    options: &WriteOptions,
) -> std::io::Result<()> {
    if let Some(command) = options.comment() {
        writeln!(text, "# {command}")?;
    }
    for p in &polygons.positions {
        // The shortest digits that give the same number back.
        writeln!(text, "v {} {} {}", p.x, p.y, p.z)?;
    }
    let mut group = None;
    for (f, corners) in polygons.faces() {
        if mesh.group(f) != group {
            group = mesh.group(f);
            writeln!(text, "g {}", group.map_or(NO_GROUP.into(), group_name))?;
        }
        text.push(b'f');
        for corner in corners {
            write!(text, " {}", corner + 1)?;
        }
        text.push(b'\n');
    }
    let seams = mesh
        .edges()
        .filter(|&e| mesh.is_seam(e))
        .map(|e| mesh.edge_vertices(e).map(|v| polygons.numbers[v] + 1));
    for (i, [a, b]) in seams.filter(|[a, b]| a != b).enumerate() {
        if i == 0 {
            writeln!(text, "g seam")?;
        }
        writeln!(text, "l {a} {b}")?;
    }
    Ok(())
}

/// The name on one line; a `#` after a space would begin a comment.
fn group_name(name: &str) -> String {
    one_line(name).replace(" #", " _").trim().to_owned()
}
