//! Binary glTF 2.0 (GLB): the triangles of its scene, in the frame of the scene.
//!
//! glTF has metres and y up; here z is up: (x, y, z) becomes (x, −z, y), and the unit of the file is
//! used whatever `--units` says. Every node with a mesh is a body of its own, in its place: corners
//! at one point are one vertex within a node and never across two, since plates that touch are not
//! one plate. A body is a group by the name of its node; where its parts have several materials, the
//! parts are groups by the names of these. What moves, bends or is no triangle is left out and
//! noted.
//!
//! Source: the glTF 2.0 specification of the Khronos Group, chapters 3.5 to 3.7 and 4.

use std::collections::HashMap;

use glam::{DMat4, DQuat, DVec3};

use super::ReadNote;
use super::raw::{GroupRun, OwnUnit, RawMesh};
use crate::io::error::{ContentFault, Located};
use crate::mend::first_equal;
use buffer::Buffers;
use container::container;
use document::{Document, Node, Primitive};

mod buffer;
mod container;
mod document;
#[cfg(test)]
mod tests;

pub(super) use container::is_glb;

/// A small file can place one mesh many times: so many triangles and vertices are read at most.
const MOST: usize = 16_000_000;
const METRES: OwnUnit = OwnUnit { name: "m", mm: 1000.0 };

/// What is no mesh but could be missed, with how it is called.
const LINES: &str = "sets of lines or points";
const ANIMATIONS: &str = "animations";
const SKINS: &str = "skins that bend a mesh";
const MORPHS: &str = "meshes with other shapes to blend with";

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    let (text, binary, rest) = container(bytes).map_err(Located::anywhere)?;
    let document = Document::parse(text).map_err(Located::anywhere)?;
    let buffers = Buffers { document: &document, binary };
    let mut bodies = Bodies {
        document: &document,
        buffers,
        raw: RawMesh { own_unit: Some(METRES), ..RawMesh::default() },
        lines: 0,
        spent: 0,
    };
    let is_seen = bodies.take_scene().map_err(Located::anywhere)?;
    let Bodies { mut raw, lines, .. } = bodies;
    let seen = |has: fn(&Node) -> bool| {
        document.nodes.iter().zip(&is_seen).filter(|(node, seen)| **seen && has(node)).count()
    };
    let blends = |node: &Node| {
        let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh));
        mesh.is_some_and(|mesh| mesh.primitives.iter().any(|p| !p.targets.is_empty()))
    };
    let morphs = document.nodes.iter().zip(&is_seen).filter(|(n, seen)| **seen && blends(n));
    for (count, what) in [
        (lines, LINES),
        (document.animations.len(), ANIMATIONS),
        (seen(|node| node.mesh.is_some() && node.skin.is_some()), SKINS),
        (morphs.count(), MORPHS),
    ] {
        raw.notes.extend((count > 0).then_some(ReadNote::LeftOut { count, what }));
    }
    raw.notes.extend((rest > 0).then_some(ReadNote::Rest { bytes: rest }));
    raw.drop_flat_triangles();
    Ok(raw)
}

/// The bodies of a scene in the making.
struct Bodies<'a> {
    document: &'a Document,
    buffers: Buffers<'a>,
    raw: RawMesh,
    lines: usize,
    spent: usize,
}

impl Bodies<'_> {
    /// Walks through the nodes of the scene and returns which ones there are.
    fn take_scene(&mut self) -> Result<Vec<bool>, ContentFault> {
        let nodes = &self.document.nodes;
        let mut is_seen = vec![false; nodes.len()];
        let mut open: Vec<(usize, DMat4)> = Vec::new();
        // y up becomes z up.
        let upright = DMat4::from_cols(
            DVec3::X.extend(0.0),
            DVec3::Z.extend(0.0),
            DVec3::NEG_Y.extend(0.0),
            DVec3::ZERO.extend(1.0),
        );
        open.extend(self.document.roots()?.into_iter().rev().map(|root| (root, upright)));
        while let Some((number, parent)) = open.pop() {
            let Some(node) = nodes.get(number) else {
                return Err(broken(format!("node {number} is not there")));
            };
            if std::mem::replace(&mut is_seen[number], true) {
                return Err(broken(format!("node {number} hangs on two others or on itself")));
            }
            let place = parent * local(node)?;
            self.take_node(node, place)?;
            open.extend(node.children.iter().rev().map(|&child| (child, place)));
        }
        Ok(is_seen)
    }

    /// The triangles of a node, welded, each part a group.
    fn take_node(&mut self, node: &Node, place: DMat4) -> Result<(), ContentFault> {
        let Some(mesh_number) = node.mesh else { return Ok(()) };
        let Some(mesh) = self.document.meshes.get(mesh_number) else {
            return Err(broken(format!("mesh {mesh_number} is not there")));
        };
        let name = [&node.name, &mesh.name].into_iter().flatten().find(|n| !n.trim().is_empty());
        let is_solid = |p: &&Primitive| p.mode.unwrap_or(4) >= 4;
        self.lines += mesh.primitives.iter().filter(|p| !is_solid(p)).count();
        let parts: Vec<&Primitive> = mesh.primitives.iter().filter(is_solid).collect();
        let is_mixed = parts.iter().any(|part| part.material != parts[0].material);
        let mut body = Body { place, ..Body::default() };
        for part in parts {
            let material = part.material.and_then(|m| self.document.materials.get(m));
            let material = material.and_then(|m| m.name.as_deref()).filter(|_| is_mixed);
            let name = material.or(name.map(String::as_str)).map(|name| name.trim().to_owned());
            let first_face = self.raw.ends.len() + body.corners.len() / 3;
            self.raw.groups.push(GroupRun { first_face, name, is_made: false });
            self.spend(body.take_part(part, &self.buffers, MOST - self.spent)?)?;
        }
        body.finish(&mut self.raw);
        Ok(())
    }

    fn spend(&mut self, elements: usize) -> Result<(), ContentFault> {
        self.spent += elements;
        if self.spent > MOST { Err(ContentFault::TooMuchMesh { most: MOST }) } else { Ok(()) }
    }
}

/// Where a node lies in its parent.
fn local(node: &Node) -> Result<DMat4, ContentFault> {
    let bad = |what: &str| broken(format!("a node has a {what} of another length"));
    let three = |of: &Option<Vec<f64>>, or: DVec3, what| match of.as_deref() {
        None => Ok(or),
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        Some(_) => Err(bad(what)),
    };
    if let Some(matrix) = &node.matrix {
        let columns: [f64; 16] = matrix.as_slice().try_into().map_err(|_| bad("matrix"))?;
        return Ok(DMat4::from_cols_array(&columns));
    }
    let turn = match node.rotation.as_deref() {
        None => DQuat::IDENTITY,
        Some(&[x, y, z, w]) => DQuat::from_xyzw(x, y, z, w),
        Some(_) => return Err(bad("rotation")),
    };
    // Numbers of single precision are no unit quaternion to the last digit.
    let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
    let shift = three(&node.translation, DVec3::ZERO, "translation")?;
    let scale = three(&node.scale, DVec3::ONE, "scale")?;
    Ok(DMat4::from_translation(shift) * DMat4::from_quat(turn) * DMat4::from_scale(scale))
}

/// The triangles of a node before they are welded.
#[derive(Default)]
struct Body {
    place: DMat4,
    positions: Vec<DVec3>,
    /// Accessor of positions → the number of its first one; parts may share them.
    starts: HashMap<usize, usize>,
    corners: Vec<u32>,
}

impl Body {
    /// Reads a part and returns how much it is, at most `left`.
    fn take_part(
        &mut self,
        part: &Primitive,
        buffers: &Buffers<'_>,
        left: usize,
    ) -> Result<usize, ContentFault> {
        // A part without positions is not shown, says the specification.
        let Some(&accessor) = part.attributes.get("POSITION") else { return Ok(0) };
        let before = self.positions.len();
        let start = match self.starts.get(&accessor) {
            Some(&start) => start,
            None => {
                let place = self.place;
                let points = buffers.positions(accessor, left)?;
                self.positions.extend(points.map(|p| place.transform_point3(p)));
                self.starts.insert(accessor, before);
                before
            }
        };
        let count = buffers.count(accessor)?;
        let indices: Vec<u32> = match part.indices {
            Some(indices) => buffers.indices(indices, count, left)?,
            None => (0..count as u32).collect(),
        };
        let mut push = |t: [usize; 3]| {
            let corner = |i: usize| (start + indices[i] as usize) as u32;
            self.corners.extend(t.map(corner));
        };
        let n = indices.len();
        match part.mode.unwrap_or(4) {
            4 => (0..n / 3).for_each(|i| push([3 * i, 3 * i + 1, 3 * i + 2])),
            // Every other triangle of a strip runs the other way.
            5 => (2..n).for_each(|i| push([i - 2, i - 1 + i % 2, i - i % 2])),
            6 => (2..n).for_each(|i| push([i - 1, i, 0])),
            mode => return Err(broken(format!("there are no triangles of the kind {mode}"))),
        }
        Ok(self.positions.len() - before + n)
    }

    /// Hands welded vertices and triangles on; vertices without a triangle stay behind.
    fn finish(self, raw: &mut RawMesh) {
        let first = first_equal(&self.positions);
        let mut numbers = vec![u32::MAX; self.positions.len()];
        let is_mirrored = self.place.determinant() < 0.0;
        for triangle in self.corners.chunks_exact(3) {
            let mut corners = [0, 1, 2].map(|i| {
                let at = first[triangle[i] as usize] as usize;
                if numbers[at] == u32::MAX {
                    numbers[at] = raw.positions.len() as u32;
                    raw.positions.push(self.positions[at]);
                }
                numbers[at]
            });
            if is_mirrored {
                corners.swap(1, 2);
            }
            raw.push_face(corners);
        }
    }
}

fn broken(what: impl Into<String>) -> ContentFault {
    ContentFault::BrokenParts { format: "GLB", what: what.into() }
}
