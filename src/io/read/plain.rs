//! What a file says, as plain polygons, before anything is made of it: for the check of what was
//! written.

use glam::DVec3;

use super::raw::RawMesh;
use super::{glb, obj, off, ply, stl, threemf};
use crate::io::format::MeshFormat;

/// Faces as the numbers of their corners.
pub(in crate::io) struct PlainFaces(RawMesh);

impl PlainFaces {
    /// How many.
    pub fn count(&self) -> usize {
        self.0.ends.len()
    }

    /// The corners of each.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.count()).map(|face| self.0.face(face))
    }
}

/// The vertices and faces of a file that kerfold wrote, as they stand there; `None` when it cannot
/// be read.
pub(in crate::io) fn polygons_in(
    format: MeshFormat,
    bytes: &[u8],
) -> Option<(Vec<DVec3>, PlainFaces)> {
    let read = match format {
        MeshFormat::Obj => obj::read(bytes),
        MeshFormat::Ply => ply::read(bytes),
        MeshFormat::Off => off::read(bytes),
        MeshFormat::Stl => stl::read(bytes, bytes),
        MeshFormat::Glb => glb::read(bytes),
        MeshFormat::ThreeMf => threemf::read(bytes),
        MeshFormat::Dxf => return None,
    };
    let mut raw = read.ok()?;
    Some((std::mem::take(&mut raw.positions), PlainFaces(raw)))
}
