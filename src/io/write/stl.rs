//! Binary STL: triangles in single precision.

use glam::DVec3;

use super::polygons::Polygons;
use super::{UNITS, WriteOptions};
use crate::io::error::IoError;
use crate::mesh::Mesh;

const HEADER: usize = 80;
const TRIANGLE: usize = 50;

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Result<Vec<u8>, IoError> {
    let polygons = Polygons::of(mesh);
    let is_too_far = |p: &DVec3| !p.as_vec3().is_finite();
    if let Some(vertex) = polygons.positions.iter().position(is_too_far) {
        return Err(IoError::TooFarForStl { vertex });
    }
    let mut bytes = header(&options.comment().unwrap_or_default());
    bytes.reserve(4 + 2 * polygons.positions.len() * TRIANGLE);
    bytes.extend([0; 4]);
    let mut count: u32 = 0;
    for (f, corners) in polygons.faces() {
        let points: Vec<DVec3> = corners.iter().map(|&c| polygons.positions[c]).collect();
        let plane = mesh.plane(f);
        let normal = plane.map_or(DVec3::ZERO, |plane| plane.normal());
        for triangle in polygons.triangles(mesh, f, corners) {
            count += 1;
            for p in [normal, points[triangle[0]], points[triangle[1]], points[triangle[2]]] {
                bytes.extend(p.as_vec3().to_array().into_iter().flat_map(f32::to_le_bytes));
            }
            bytes.extend([0; 2]);
        }
    }
    bytes[HEADER..HEADER + 4].copy_from_slice(&count.to_le_bytes());
    Ok(bytes)
}

/// The 80 bytes of free text. They must not begin with `solid`, as text files do, and end between
/// characters.
fn header(comment: &str) -> Vec<u8> {
    let text = format!("binary STL, {UNITS}: {comment}");
    let end =
        (0..=HEADER.min(text.len())).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
    let mut bytes = text.as_bytes()[..end].to_vec();
    bytes.resize(HEADER, b' ');
    bytes
}
