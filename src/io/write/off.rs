//! Object File Format: polygons as text.

use std::io::Write as _;

use super::polygons::Polygons;
use super::{UNITS, WriteOptions};
use crate::mesh::Mesh;

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Vec<u8> {
    let mut text = Vec::new();
    write_into(&mut text, mesh, &Polygons::of(mesh), options)
        .expect("writing into memory does not fail");
    text
}

fn write_into(
    text: &mut Vec<u8>,
    mesh: &Mesh,
    polygons: &Polygons,
    options: &WriteOptions,
) -> std::io::Result<()> {
    writeln!(text, "OFF")?;
    if let Some(command) = options.comment() {
        writeln!(text, "# {command}")?;
    }
    writeln!(text, "# {UNITS}")?;
    writeln!(text, "{} {} {}", polygons.positions.len(), polygons.face_count(), mesh.edge_count())?;
    for p in &polygons.positions {
        writeln!(text, "{} {} {}", p.x, p.y, p.z)?;
    }
    for (_, corners) in polygons.faces() {
        write!(text, "{}", corners.len())?;
        for corner in corners {
            write!(text, " {corner}")?;
        }
        text.push(b'\n');
    }
    Ok(())
}
