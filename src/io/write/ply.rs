//! Stanford PLY: polygons as text or binary, with coordinates in double precision.

use std::io::Write as _;

use super::polygons::Polygons;
use super::{PlyEncoding, UNITS, WriteOptions};
use crate::mesh::Mesh;

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Vec<u8> {
    let polygons = Polygons::of(mesh);
    let mut bytes = Vec::new();
    write_header(&mut bytes, &polygons, options).expect("writing into memory does not fail");
    match options.ply {
        PlyEncoding::Text => {
            write_text(&mut bytes, &polygons).expect("writing into memory does not fail")
        }
        PlyEncoding::BinaryLittleEndian => {
            write_binary(&mut bytes, &polygons, f64::to_le_bytes, u32::to_le_bytes)
        }
        PlyEncoding::BinaryBigEndian => {
            write_binary(&mut bytes, &polygons, f64::to_be_bytes, u32::to_be_bytes)
        }
    }
    bytes
}

fn write_header(
    bytes: &mut Vec<u8>,
    polygons: &Polygons,
    options: &WriteOptions,
) -> std::io::Result<()> {
    let encoding = match options.ply {
        PlyEncoding::Text => "ascii",
        PlyEncoding::BinaryLittleEndian => "binary_little_endian",
        PlyEncoding::BinaryBigEndian => "binary_big_endian",
    };
    writeln!(bytes, "ply\nformat {encoding} 1.0")?;
    if let Some(command) = options.comment() {
        writeln!(bytes, "comment {command}")?;
    }
    writeln!(bytes, "comment {UNITS}")?;
    writeln!(bytes, "element vertex {}", polygons.positions.len())?;
    writeln!(bytes, "property double x\nproperty double y\nproperty double z")?;
    writeln!(bytes, "element face {}", polygons.face_count())?;
    // Lengths as uint, so that no polygon has too many corners.
    writeln!(bytes, "property list uint uint vertex_indices\nend_header")
}

fn write_text(bytes: &mut Vec<u8>, polygons: &Polygons) -> std::io::Result<()> {
    for p in &polygons.positions {
        writeln!(bytes, "{} {} {}", p.x, p.y, p.z)?;
    }
    for (_, corners) in polygons.faces() {
        write!(bytes, "{}", corners.len())?;
        for corner in corners {
            write!(bytes, " {corner}")?;
        }
        bytes.push(b'\n');
    }
    Ok(())
}

fn write_binary(
    bytes: &mut Vec<u8>,
    polygons: &Polygons,
    double: fn(f64) -> [u8; 8],
    uint: fn(u32) -> [u8; 4],
) {
    bytes.extend(polygons.positions.iter().flat_map(|p| p.to_array()).flat_map(double));
    for (_, corners) in polygons.faces() {
        // Ids of a mesh fit into u32.
        bytes.extend(std::iter::once(&corners.len()).chain(corners).flat_map(|&n| uint(n as u32)));
    }
}
