//! What a file holds, mended before it is a mesh.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::raw::{GroupRun, RawMesh};
use super::{ReadNote, ReadOptions};
use crate::mend::{RepairParams, Repairs, Soup, SoupFace, orient, repair};

/// Turns and repairs faces as the options and `params` ask; says what was done. Faces that name
/// vertices that are not there are left for the builder to report.
pub(super) fn mend(raw: &mut RawMesh, options: &ReadOptions, params: Option<&RepairParams>) {
    let names_all = raw.corners.iter().all(|&v| (v as usize) < raw.positions.len());
    let by_default = RepairParams::default();
    let params = params.or(options.mend.then_some(&by_default));
    if names_all && (params.is_some() || options.orient) {
        let mut soup = Soup { positions: std::mem::take(&mut raw.positions), faces: faces(raw) };
        let repairs = match params {
            Some(params) => repair(&mut soup, params),
            None => orient(&mut soup),
        };
        take_back(raw, soup);
        note(raw, &repairs);
        keep_seams(raw);
    }
    if options.flip {
        raw.change_faces(|face| face.reverse());
    }
}

/// Seams go with vertices that were welded. A mark on what is no side of a face any more is left out:
/// it is a mark, and no reason to refuse the surface.
fn keep_seams(raw: &mut RawMesh) {
    let mut sides = HashSet::new();
    let mut vertex_at = HashMap::new();
    for f in 0..raw.ends.len() {
        let face = raw.face(f);
        for (i, &v) in face.iter().enumerate() {
            sides.insert(pair([v, face[(i + 1) % face.len()]]));
            vertex_at.entry(key(raw.positions[v as usize])).or_insert(v);
        }
    }
    let count = raw.seams.len();
    raw.seams.retain_mut(|seam| {
        if !sides.contains(&pair(seam.ends)) {
            let place =
                |v: u32| raw.positions.get(v as usize).and_then(|&p| vertex_at.get(&key(p)));
            seam.ends = seam.ends.map(|v| place(v).copied().unwrap_or(v));
        }
        sides.contains(&pair(seam.ends))
    });
    let lost = count - raw.seams.len();
    if lost > 0 {
        raw.notes.push(ReadNote::LostSeams { count: lost });
    }
}

fn pair([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// A position as a key; adding zero makes −0 and 0 one.
fn key(position: DVec3) -> [u64; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}

fn note(raw: &mut RawMesh, repairs: &Repairs) {
    raw.notes.extend(repairs.done.iter().map(|&mending| ReadNote::Mended(mending)));
}

fn faces(raw: &RawMesh) -> Vec<SoupFace> {
    let face = |f: usize| SoupFace { corners: raw.face(f).to_vec(), source: u32::try_from(f).ok() };
    (0..raw.ends.len()).map(face).collect()
}

/// Puts the faces back, each with the group that it had.
fn take_back(raw: &mut RawMesh, soup: Soup) {
    let group_of = |face: usize| -> Option<(Option<String>, bool)> {
        let run = raw.groups.partition_point(|run| run.first_face <= face);
        let run = raw.groups.get(run.checked_sub(1)?)?;
        Some((run.name.clone(), run.is_made))
    };
    let has_groups = !raw.groups.is_empty();
    let mut groups: Vec<GroupRun> = Vec::new();
    let mut numbers = Vec::with_capacity(soup.faces.len());
    for (i, face) in soup.faces.iter().enumerate() {
        let source = face.source.map(|f| f as usize);
        // A face that closes a hole is behind all faces of the file.
        numbers.push(source.map_or(raw.face_lines.len(), |f| raw.file_face(f)) as u32);
        let (name, is_made) = source.and_then(group_of).unwrap_or_default();
        let is_same = |run: &GroupRun| run.name == name && run.is_made == is_made;
        if has_groups && !groups.last().is_some_and(is_same) {
            groups.push(GroupRun { first_face: i, name, is_made });
        }
    }
    (raw.corners, raw.ends) = (Vec::new(), Vec::new());
    soup.faces.iter().for_each(|face| raw.push_face(face.corners.iter().copied()));
    (raw.positions, raw.groups, raw.face_numbers) = (soup.positions, groups, Some(numbers));
}
