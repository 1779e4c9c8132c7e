//! Wavefront OBJ: polygons, face groups as `g`, seams as `l` lines in the group `seam`.

use std::io::Write as _;

use super::polygons::Polygons;
use super::{UNITS, WriteOptions, one_line};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::select::NewElements;

/// What OBJ calls the group of faces that belong to none.
const NO_GROUP: &str = "default";

/// What follows the group of a face that the last step made.
const MADE_MARK: &str = " made";

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
    writeln!(text, "# {UNITS}")?;
    for p in &polygons.positions {
        // The shortest digits that give the same number back.
        writeln!(text, "v {} {} {}", p.x, p.y, p.z)?;
    }
    let made = options.made.as_ref();
    let is_made = |f: FaceId| made.is_some_and(|made| made.faces.binary_search(&f).is_ok());
    let mut group = (None, false);
    for (f, corners) in polygons.faces() {
        if (mesh.group(f), is_made(f)) != group {
            group = (mesh.group(f), is_made(f));
            let mark = if group.1 { MADE_MARK } else { "" };
            writeln!(text, "g {}{mark}", group.0.map_or(NO_GROUP.into(), group_name))?;
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
    made.map_or(Ok(()), |made| write_made(text, mesh, polygons, made))
}

/// Vertices and edges that the last step made, as points and lines of the groups `made` and `strip`.
fn write_made(
    text: &mut Vec<u8>,
    mesh: &Mesh,
    polygons: &Polygons,
    made: &NewElements,
) -> std::io::Result<()> {
    let number = |v: VertexId| polygons.numbers[v] + 1;
    if !made.vertices.is_empty() || !made.edges.is_empty() {
        writeln!(text, "g made")?;
    }
    for &v in &made.vertices {
        writeln!(text, "p {}", number(v))?;
    }
    for (i, edges) in [&made.edges, &made.strip].into_iter().enumerate() {
        if i == 1 && !edges.is_empty() {
            writeln!(text, "g strip")?;
        }
        for [a, b] in edges.iter().map(|&e| mesh.edge_vertices(e)).filter(|[a, b]| a != b) {
            writeln!(text, "l {} {}", number(a), number(b))?;
        }
    }
    Ok(())
}

/// The name on one line; a `#` after a space would begin a comment.
fn group_name(name: &str) -> String {
    let name = one_line(name).replace(" #", " _").trim().to_owned();
    // A name that ends like the mark would be read as one.
    match name.strip_suffix(MADE_MARK) {
        Some(start) => format!("{start}_made"),
        None => name,
    }
}
