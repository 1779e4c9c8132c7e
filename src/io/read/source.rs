//! What came out of a file, scaled, welded and built.

use std::path::Path;

use super::raw::RawMesh;
use super::{ReadNote, ReadOptions, rim, weld};
use crate::io::error::{IoError, Place};
use crate::mesh::{BuildError, FaceId, Mesh, MeshBuilder, SplitVertex, VertexId};

/// What came out of a file, on its way to a mesh.
pub(super) struct SourceFile<'a> {
    pub path: &'a Path,
    pub raw: RawMesh,
}

impl SourceFile<'_> {
    /// Scales the positions and returns the factor. A factor of 1 touches no digit.
    pub fn scale(&mut self, options: &ReadOptions) -> Result<f64, IoError> {
        if let Some(vertex) = self.raw.positions.iter().position(|p| !p.is_finite()) {
            return Err(
                self.fault(BuildError::NotFinite { vertex, position: self.raw.positions[vertex] })
            );
        }
        let factor = options
            .size
            .and_then(|size| Some(size.mm() / self.extent()?))
            .unwrap_or_else(|| self.raw.own_unit.map_or(options.units.mm(), |unit| unit.mm));
        if factor != 1.0 {
            self.raw.positions.iter_mut().for_each(|p| *p *= factor);
        }
        Ok(factor)
    }

    /// The largest extent of the vertices that faces use; `None` without any.
    fn extent(&self) -> Option<f64> {
        let mut used = self.raw.corners.iter().filter_map(|&v| self.raw.positions.get(v as usize));
        let &first = used.next()?;
        let (low, high) = used.fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        Some((high - low).max_element()).filter(|extent| *extent > 0.0)
    }

    pub fn weld(
        &mut self,
        options: &ReadOptions,
        notes: &mut Vec<ReadNote>,
    ) -> Result<(), IoError> {
        let Some(distance) = options.weld else { return Ok(()) };
        let had_faces = !self.raw.ends.is_empty();
        let welded = weld::weld(&mut self.raw, distance.mm());
        if had_faces && self.raw.ends.is_empty() {
            return Err(IoError::WeldedAway { path: self.path.to_owned() });
        }
        if welded.vertices > 0 {
            notes.push(ReadNote::Welded { count: welded.vertices });
        }
        notes.extend(welded.faces.map(|(count, first)| ReadNote::DroppedFaces { count, first }));
        Ok(())
    }

    pub fn build(&self) -> Result<(Mesh, Vec<SplitVertex>), IoError> {
        let mut builder = MeshBuilder::new();
        for &position in &self.raw.positions {
            builder.vertex(position);
        }
        for face in 0..self.raw.ends.len() {
            builder.face(self.raw.face(face).iter().map(|&v| v as usize));
        }
        let (mut mesh, splits) = builder.build().map_err(|fault| self.fault(fault))?;
        self.set_groups(&mut mesh);
        self.set_seams(&mut mesh, &splits)?;
        Ok((mesh, splits))
    }

    fn set_groups(&self, mesh: &mut Mesh) {
        let ends =
            self.raw.groups.iter().skip(1).map(|run| run.first_face).chain([self.raw.ends.len()]);
        for (run, end) in self.raw.groups.iter().zip(ends) {
            if let Some(name) = &run.name {
                (run.first_face..end).for_each(|face| mesh.set_group(FaceId::new(face), name));
            }
        }
    }

    fn set_seams(&self, mesh: &mut Mesh, splits: &[SplitVertex]) -> Result<(), IoError> {
        for seam in &self.raw.seams {
            let [a, b] = seam.ends.map(|v| VertexId::new(v as usize));
            let copies = |v: VertexId| {
                let added = splits.iter().filter(move |s| s.given == v).map(|s| s.added);
                std::iter::once(v).chain(added).filter(|&v| mesh.has_vertex(v))
            };
            let edges: Vec<_> = copies(a).flat_map(|a| copies(b).map(move |b| (a, b))).collect();
            let edge = edges.into_iter().find_map(|(a, b)| mesh.edge_between(a, b));
            let Some(edge) = edge else {
                let (a, b) = (a.index(), b.index());
                return Err(IoError::SeamOffEdges { place: self.place(Some(seam.line)), a, b });
            };
            mesh.set_seam(edge, true);
        }
        Ok(())
    }

    /// A surface that equal vertices would close is a fault; rims that lie on each other here and
    /// there are a note.
    pub fn note_torn(&self, mesh: &Mesh, notes: &mut Vec<ReadNote>) -> Result<(), IoError> {
        let Some(rim::Coincidence { rim_edges, coincident, vertices }) = rim::coincident_rims(mesh)
        else {
            return Ok(());
        };
        if coincident < rim_edges {
            notes.push(ReadNote::CoincidentRims { coincident, rim_edges, vertices });
            return Ok(());
        }
        let [a, b] = vertices.map(VertexId::index);
        let lines = [a, b].into_iter().filter_map(|v| self.raw.vertex_line(v)).collect();
        Err(IoError::Torn { path: self.path.to_owned(), rim_edges, a, b, lines })
    }

    pub fn note_vertices(&self, mesh: &Mesh, splits: &[SplitVertex], notes: &mut Vec<ReadNote>) {
        if let Some(first) = splits.first() {
            notes.push(ReadNote::SplitVertices { count: splits.len(), first: first.given });
        }
        // Welded vertices have a note of their own.
        let is_welded =
            notes.iter().any(|n| matches!(n, ReadNote::Welded { .. } | ReadNote::Mended(_)));
        let unused =
            || (0..self.raw.positions.len()).map(VertexId::new).filter(|&v| !mesh.has_vertex(v));
        if let Some(first) = unused().next().filter(|_| !is_welded) {
            notes.push(ReadNote::UnusedVertices { count: unused().count(), first });
        }
    }

    fn place(&self, line: Option<usize>) -> Place {
        Place { path: self.path.to_owned(), line }
    }

    /// The builder's fault, with faces numbered as in the file, and its place.
    fn fault(&self, fault: BuildError) -> IoError {
        let fault = self.renumbered(fault);
        let face = |f: usize| self.raw.face_line(f);
        let vertex = |v: usize| self.raw.vertex_line(v);
        let (line, also) = match &fault {
            BuildError::NotFinite { vertex: v, .. } => (vertex(*v), vec![]),
            BuildError::ZeroLengthEdge { face: f, a, b, .. } => {
                (face(*f), vec![vertex(*a), vertex(*b)])
            }
            BuildError::MissingVertex { face: f, .. }
            | BuildError::TooFewCorners { face: f, .. }
            | BuildError::RepeatedCorner { face: f, .. }
            | BuildError::DegenerateFace { face: f } => (face(*f), vec![]),
            BuildError::ThreeFacesAtEdge { faces: [f, g, h], .. } => {
                (face(*h), vec![face(*f), face(*g)])
            }
            BuildError::FlippedFace { first, second, .. } => (face(*second), vec![face(*first)]),
            // No faces, or too many; or a fault of a later kernel that names no line.
            _ => (None, vec![]),
        };
        IoError::Mesh {
            place: self.place(line),
            fault,
            also_lines: also.into_iter().flatten().collect(),
        }
    }

    fn renumbered(&self, mut fault: BuildError) -> BuildError {
        let in_file = |f: &mut usize| *f = self.raw.file_face(*f);
        match &mut fault {
            BuildError::MissingVertex { face, .. }
            | BuildError::TooFewCorners { face, .. }
            | BuildError::RepeatedCorner { face, .. }
            | BuildError::ZeroLengthEdge { face, .. }
            | BuildError::DegenerateFace { face } => in_file(face),
            BuildError::ThreeFacesAtEdge { faces, .. } => faces.iter_mut().for_each(in_file),
            BuildError::FlippedFace { first, second, .. } => {
                [first, second].into_iter().for_each(in_file)
            }
            // The others name no face.
            _ => {}
        }
        fault
    }
}
