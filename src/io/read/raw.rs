//! What a reader finds in a file, before it is a mesh.

use glam::DVec3;

use super::{ReadNote, keyhole};

/// Vertices and faces in the order of the file, with the places where they stand.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RawMesh {
    pub positions: Vec<DVec3>,
    /// The corners of all faces, one face after the other.
    pub corners: Vec<u32>,
    /// Where the corners of each face end.
    pub ends: Vec<usize>,
    pub groups: Vec<GroupRun>,
    pub seams: Vec<SeamSegment>,
    pub made: RawMade,
    /// The line of each vertex; empty in binary files.
    pub vertex_lines: Vec<u32>,
    /// The line of each face in the file, dropped ones included; empty in binary files.
    pub face_lines: Vec<u32>,
    /// The number that each face has in the file, when faces were dropped or divided.
    pub face_numbers: Option<Vec<u32>>,
    /// The unit of the format or of the file, which is used whatever the options say.
    pub own_unit: Option<OwnUnit>,
    /// What the user should know about the file.
    pub notes: Vec<ReadNote>,
}

/// The unit of a file that has a place for one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OwnUnit {
    pub name: &'static str,
    /// In millimetres.
    pub mm: f64,
}

/// The faces from `first_face` on belong to a group, until the next run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroupRun {
    pub first_face: usize,
    pub name: Option<String>,
    /// Whether the last step made them.
    pub is_made: bool,
}

/// What the file says that the last step made, besides faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RawMade {
    pub vertices: Vec<u32>,
    pub edges: Vec<[u32; 2]>,
    pub strip: Vec<[u32; 2]>,
}

/// A stretch of a seam line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SeamSegment {
    pub line: usize,
    pub ends: [u32; 2],
}

impl RawMesh {
    pub fn push_face(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    pub fn face(&self, face: usize) -> &[u32] {
        let start = if face == 0 { 0 } else { self.ends[face - 1] };
        &self.corners[start..self.ends[face]]
    }

    /// Replaces every face by what `change` makes of its corners, and drops it when fewer than
    /// three are left. Returns the number of dropped faces and the number of the first.
    pub fn change_faces(
        &mut self,
        mut change: impl FnMut(&mut Vec<u32>),
    ) -> Option<(usize, usize)> {
        let old = std::mem::take(&mut self.corners);
        let old_ends = std::mem::take(&mut self.ends);
        let mut numbers = Vec::with_capacity(old_ends.len());
        let mut dropped = None;
        let (mut start, mut face) = (0, Vec::new());
        let mut first_kept =
            Vec::with_capacity(if self.groups.is_empty() { 0 } else { old_ends.len() + 1 });
        for (index, &end) in old_ends.iter().enumerate() {
            if !self.groups.is_empty() {
                first_kept.push(self.ends.len());
            }
            face.clear();
            face.extend_from_slice(&old[start..end]);
            start = end;
            change(&mut face);
            let number = self.file_face(index);
            if face.len() < 3 {
                dropped = dropped.map(|(count, first)| (count + 1, first)).or(Some((1, number)));
            } else {
                self.push_face(face.iter().copied());
                numbers.push(number as u32);
            }
        }
        for run in &mut self.groups {
            run.first_face = first_kept.get(run.first_face).copied().unwrap_or(self.ends.len());
        }
        if dropped.is_some() {
            self.face_numbers = Some(numbers);
        }
        dropped
    }

    /// Drops triangles of which two corners are one, as welding leaves them, and notes it. All faces
    /// are triangles.
    pub fn drop_flat_triangles(&mut self) {
        let is_flat = |t: &[u32]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if !self.corners.chunks_exact(3).any(is_flat) {
            return;
        }
        let dropped = self.change_faces(|face| {
            if is_flat(face) {
                face.clear();
            }
        });
        self.notes.extend(dropped.map(|(count, first)| ReadNote::DroppedFaces { count, first }));
    }

    /// Takes corners away that repeat the one before them, and divides faces that visit a vertex
    /// twice into simple ones; the further parts stand behind all faces, so that the others keep
    /// their numbers. What cannot be divided is left for the builder to report.
    pub fn make_faces_simple(&mut self) {
        let mut faces = (0..self.ends.len()).map(|face| self.face(face));
        // Faces of two corners are for the builder to report, with their numbers as they are.
        if faces.clone().any(|face| face.len() < 3) || !faces.any(keyhole::visits_twice) {
            return;
        }
        self.drop_repeated_corners();
        self.divide_keyholes();
    }

    fn drop_repeated_corners(&mut self) {
        let numbers = self.face_numbers.clone();
        let in_file = |face: usize| numbers.as_ref().map_or(face, |n| n[face] as usize);
        let mut repeated = None;
        let mut at = 0;
        let dropped = self.change_faces(|face| {
            let before = face.len();
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
            if face.len() < before {
                let (count, first) = repeated.unwrap_or((0, in_file(at)));
                repeated = Some((count + 1, first));
            }
            at += 1;
        });
        self.notes
            .extend(repeated.map(|(count, first)| ReadNote::RepeatedCorners { count, first }));
        self.notes.extend(dropped.map(|(count, first)| ReadNote::DroppedFaces { count, first }));
    }

    fn divide_keyholes(&mut self) {
        let mut further: Vec<(usize, Vec<u32>)> = Vec::new();
        let mut divided: Option<(usize, usize)> = None;
        let mut faces: Vec<Vec<u32>> =
            (0..self.ends.len()).map(|face| self.face(face).to_vec()).collect();
        for (index, face) in faces.iter_mut().enumerate() {
            if !keyhole::visits_twice(face) {
                continue;
            }
            let Some(parts) = keyhole::simple_parts(face, &self.positions) else { continue };
            let mut parts = parts.into_iter();
            *face = parts.next().unwrap_or_default();
            further.extend(parts.map(|part| (index, part)));
            let (count, first) = divided.unwrap_or((0, self.file_face(index)));
            divided = Some((count + 1, first));
        }
        let Some((count, first)) = divided else { return };
        self.notes.push(ReadNote::DividedFaces { count, first });
        let numbers = (0..faces.len()).map(|face| self.file_face(face) as u32);
        let numbers: Vec<u32> =
            numbers.chain(further.iter().map(|&(face, _)| self.file_face(face) as u32)).collect();
        (self.corners, self.ends) = (Vec::new(), Vec::new());
        faces.into_iter().for_each(|face| self.push_face(face));
        for (face, part) in further {
            if !self.groups.is_empty() {
                let run = self.groups.iter().rev().find(|run| run.first_face <= face);
                let name = run.and_then(|run| run.name.clone());
                let is_made = run.is_some_and(|run| run.is_made);
                self.groups.push(GroupRun { first_face: self.ends.len(), name, is_made });
            }
            self.push_face(part);
        }
        self.face_numbers = Some(numbers);
    }

    /// The number that a face has in the file.
    pub fn file_face(&self, face: usize) -> usize {
        self.face_numbers
            .as_ref()
            .and_then(|numbers| numbers.get(face))
            .map_or(face, |&n| n as usize)
    }

    /// The line of a face, by its number in the file.
    pub fn face_line(&self, file_face: usize) -> Option<usize> {
        self.face_lines.get(file_face).map(|&line| line as usize)
    }

    /// The line of a vertex.
    pub fn vertex_line(&self, vertex: usize) -> Option<usize> {
        self.vertex_lines.get(vertex).map(|&line| line as usize)
    }
}
