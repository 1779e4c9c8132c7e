//! Reading mesh files: one reader for each format, then scaling, welding and building, which are
//! the same for all.

use std::fmt;
use std::path::Path;

use super::error::{IoError, Place};
use super::format::MeshFormat;
use crate::mesh::{BuildError, FaceId, Mesh, MeshBuilder, SplitVertex, VertexId};
use crate::units::{Length, counted};
use raw::RawMesh;

pub mod artwork;
mod decode;
mod keyhole;
mod obj;
mod off;
mod plain;
mod ply;
mod points;
mod raw;
mod rim;
mod seams;
mod stl;
mod text;
mod weld;

pub use decode::{decode_text, read_text};
pub(super) use off::begins_off;
pub(super) use plain::polygons_in;
pub use points::{read_points, read_points_bytes};
pub use seams::{read_seams, read_seams_bytes};
pub(super) use stl::is_binary as is_binary_stl;

/// How a mesh file is taken.
#[derive(Debug, Clone, Default, clap::Args, serde::Deserialize)]
pub struct ReadOptions {
    /// Unit of the numbers in the file [default: mm]
    #[arg(long, value_enum, default_value = "mm", hide_default_value = true)]
    #[serde(default)]
    pub units: MeshUnit,
    /// Scale the model so that its largest extent is this length, whatever its unit, e.g. 300mm;
    /// above 0 [default: not scaled]
    #[arg(long)]
    #[serde(default)]
    pub size: Option<Length>,
    /// Make one vertex of those that are at most this far apart after scaling; 0 or more, 0 joins
    /// equal positions only [default: none are joined]
    #[arg(long)]
    #[serde(default)]
    pub weld: Option<Length>,
}

/// The unit of the numbers in a mesh file, which carries none itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MeshUnit {
    /// Millimetres.
    #[default]
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches of 25.4 mm.
    In,
}

impl MeshUnit {
    /// The unit in millimetres.
    pub fn mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::M => 1000.0,
            Self::In => 25.4,
        }
    }
}

/// A mesh with what happened on the way in.
#[derive(Debug, Clone)]
pub struct ReadMesh {
    /// The mesh, in millimetres. The n-th vertex and face of the file have the ids n − 1, as long
    /// as no faces were dropped and the file is not STL; vertices without faces leave gaps.
    pub mesh: Mesh,
    /// Vertices that were doubled because several fans of faces met there.
    pub splits: Vec<SplitVertex>,
    /// What the user should know.
    pub notes: Vec<ReadNote>,
    /// The factor from the numbers of the file to millimetres.
    pub scale: f64,
}

/// Something about a file that is no fault, but should be known. Vertices and faces are numbered
/// from 0 in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReadNote {
    /// Vertices went into others.
    Welded {
        /// How many.
        count: usize,
    },
    /// Faces lost their area when their corners became one, and were left out.
    DroppedFaces {
        /// How many.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Vertices at which several fans of faces meet were doubled.
    SplitVertices {
        /// How many were added.
        count: usize,
        /// The first that was doubled.
        first: VertexId,
    },
    /// Vertices that no face uses.
    UnusedVertices {
        /// How many.
        count: usize,
        /// The first.
        first: VertexId,
    },
    /// Some rim edges lie exactly on others: the surface may be torn there.
    CoincidentRims {
        /// How many rim edges lie on another.
        coincident: usize,
        /// Number of all rim edges.
        rim_edges: usize,
        /// Two vertices at one point where this is so.
        vertices: [VertexId; 2],
    },
    /// Faces named a vertex twice in a row; the second was left out.
    RepeatedCorners {
        /// How many faces.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Faces that visited a vertex twice (around a hole, for example) were divided.
    DividedFaces {
        /// How many.
        count: usize,
        /// The first, by its number in the file.
        first: usize,
    },
    /// Coordinates were divided by the weight after them.
    Weights {
        /// Of how many vertices.
        count: usize,
        /// The first.
        first: usize,
    },
    /// Numbers had a comma where a point is usual.
    DecimalCommas {
        /// How many.
        count: usize,
        /// The line of the first, from 1.
        first_line: usize,
    },
    /// Lines of a known format that make no face: curves, points, wires, or anything unknown.
    PassedOver {
        /// How many.
        count: usize,
        /// The first, from 1.
        first_line: usize,
    },
    /// Lines had more numbers than the header says.
    ExtraColumns {
        /// How many lines.
        count: usize,
        /// The first, from 1.
        first_line: usize,
    },
    /// The file goes on after its last element.
    Rest {
        /// How many bytes follow, white space at the ends not counted.
        bytes: usize,
    },
}

impl fmt::Display for ReadNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Welded { count } => {
                write!(f, "{} welded to others", counted(*count, "vertex was", "vertices were"))
            }
            Self::DroppedFaces { count, first } => write!(
                f,
                "{} left out, the first of them face {first} of the file; the faces after it are \
                numbered without them",
                counted(
                    *count,
                    "face lost its area because corners of it are at one point and was",
                    "faces lost their area because corners of theirs are at one point and were"
                )
            ),
            Self::SplitVertices { count, first } => write!(
                f,
                "{} added where several fans of faces met in one vertex, the first of them at \
                vertex {first}",
                counted(*count, "vertex was", "vertices were")
            ),
            Self::UnusedVertices { count, first } => {
                let count = counted(*count, "vertex belongs", "vertices belong");
                write!(f, "{count} to no face, the first of them vertex {first}")
            }
            Self::CoincidentRims { coincident, rim_edges, vertices: [a, b] } => write!(
                f,
                "{coincident} of {rim_edges} rim edges lie exactly on another one, such as at \
                vertices {a} and {b}; \
                 if the surface is torn there, --weld 0 closes it"
            ),
            Self::RepeatedCorners { count, first } => write!(
                f,
                "{} a vertex twice in a row and {} read without the second, the first of them \
                face {first}",
                counted(*count, "face names", "faces name"),
                were(*count)
            ),
            Self::DividedFaces { count, first } => write!(
                f,
                "{} a vertex twice (around a hole, for example) and {} divided, the first of \
                them face {first}; the further parts stand behind the faces of the file",
                counted(*count, "face visits", "faces visit"),
                were(*count)
            ),
            Self::Weights { count, first } => write!(
                f,
                "{} a weight other than 1 after the coordinates, which {} divided by it, the \
                first of them vertex {first}",
                counted(*count, "vertex has", "vertices have"),
                were(2)
            ),
            Self::DecimalCommas { count, first_line } => write!(
                f,
                "{} a decimal comma, the first of them in line {first_line}",
                counted(*count, "number has", "numbers have")
            ),
            Self::PassedOver { count, first_line } => write!(
                f,
                "{} no face and {} passed over, the first of them line {first_line}",
                counted(*count, "line makes", "lines make"),
                were(*count)
            ),
            Self::ExtraColumns { count, first_line } => write!(
                f,
                "{} more numbers than the header says, which were passed over, the first of them \
                line {first_line}",
                counted(*count, "line has", "lines have")
            ),
            Self::Rest { bytes } => write!(
                f,
                "{} after the last element and {} passed over",
                counted(*bytes, "byte follows", "bytes follow"),
                were(*bytes)
            ),
        }
    }
}

fn were(count: usize) -> &'static str {
    if count == 1 { "was" } else { "were" }
}

/// Reads a mesh from a file.
///
/// The format is told by the extension, or else by the content.
///
/// # Errors
/// When the file cannot be read or is not a mesh; every message names the place and what to do.
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, read_mesh};
/// use std::path::Path;
///
/// let read = read_mesh(Path::new("fixtures/meshes/cube.obj"), &ReadOptions::default())?;
/// assert_eq!((read.mesh.face_count(), read.scale), (6, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_mesh(path: &Path, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    if path.is_dir() {
        return Err(IoError::IsFolder { path: path.to_owned() });
    }
    let bytes = std::fs::read(path).map_err(|source| IoError::reading(path, source))?;
    read_mesh_bytes(path, &bytes, options)
}

/// Reads a mesh from the content of a file; `path` tells the format and is named in messages.
///
/// # Errors
/// As [`read_mesh`].
///
/// # Example
/// ```
/// use kerfold::io::{ReadOptions, read_mesh_bytes};
/// use std::path::Path;
///
/// let text = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
/// let read = read_mesh_bytes(Path::new("mine.off"), text.as_bytes(), &ReadOptions::default())?;
/// assert!(read.mesh.is_closed());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_mesh_bytes(
    path: &Path,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<ReadMesh, IoError> {
    check_options(options)?;
    let text = decode::as_utf8(bytes);
    if text.trim_ascii().is_empty() {
        return Err(IoError::Empty { path: path.to_owned() });
    }
    let format = MeshFormat::of_path(path)
        .or_else(|| stl::is_binary(bytes).then_some(MeshFormat::Stl))
        .or_else(|| MeshFormat::of_content(&text));
    let raw = match format.ok_or_else(|| IoError::UnknownFormat { path: path.to_owned() })? {
        MeshFormat::Obj => obj::read(&text),
        // Zeros at the end of a binary file are numbers.
        MeshFormat::Ply if bytes.starts_with(b"ply") => ply::read(bytes),
        MeshFormat::Ply => ply::read(&text),
        MeshFormat::Off => off::read(&text),
        MeshFormat::Stl => stl::read(bytes, &text),
    };
    let mut source = SourceFile { path, raw: raw.map_err(|located| located.in_file(path))? };
    let mut notes = std::mem::take(&mut source.raw.notes);
    let scale = source.scale(options)?;
    source.weld(options, &mut notes)?;
    source.raw.make_faces_simple();
    notes.append(&mut source.raw.notes);
    let (mesh, splits) = source.build()?;
    source.note_torn(&mesh, &mut notes)?;
    source.note_vertices(&mesh, &splits, &mut notes);
    Ok(ReadMesh { mesh, splits, notes, scale })
}

fn check_options(options: &ReadOptions) -> Result<(), IoError> {
    match (options.size, options.weld) {
        (Some(size), _) if size.mm() <= 0.0 => Err(IoError::BadSize { mm: size.mm() }),
        (_, Some(weld)) if weld.mm() < 0.0 => Err(IoError::BadWeld { mm: weld.mm() }),
        _ => Ok(()),
    }
}

/// What came out of a file, on its way to a mesh.
struct SourceFile<'a> {
    path: &'a Path,
    raw: RawMesh,
}

impl SourceFile<'_> {
    /// Scales the positions and returns the factor. A factor of 1 touches no digit.
    fn scale(&mut self, options: &ReadOptions) -> Result<f64, IoError> {
        if let Some(vertex) = self.raw.positions.iter().position(|p| !p.is_finite()) {
            return Err(
                self.fault(BuildError::NotFinite { vertex, position: self.raw.positions[vertex] })
            );
        }
        let factor = options
            .size
            .and_then(|size| Some(size.mm() / self.extent()?))
            .unwrap_or(options.units.mm());
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

    fn weld(&mut self, options: &ReadOptions, notes: &mut Vec<ReadNote>) -> Result<(), IoError> {
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

    fn build(&self) -> Result<(Mesh, Vec<SplitVertex>), IoError> {
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
    fn note_torn(&self, mesh: &Mesh, notes: &mut Vec<ReadNote>) -> Result<(), IoError> {
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

    fn note_vertices(&self, mesh: &Mesh, splits: &[SplitVertex], notes: &mut Vec<ReadNote>) {
        if let Some(first) = splits.first() {
            notes.push(ReadNote::SplitVertices { count: splits.len(), first: first.given });
        }
        // Welded vertices have a note of their own.
        let is_welded = notes.iter().any(|note| matches!(note, ReadNote::Welded { .. }));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;
    use clap::Parser as _;
    use glam::DVec3;

    const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
        f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

    fn options(units: MeshUnit, size: Option<f64>, weld: Option<f64>) -> ReadOptions {
        ReadOptions { units, size: size.map(Length::from_mm), weld: weld.map(Length::from_mm) }
    }

    fn read_text(text: &str, options: &ReadOptions) -> Result<ReadMesh, IoError> {
        read_mesh_bytes(Path::new("model.obj"), text.as_bytes(), options)
    }

    /// Every face with corners of its own.
    fn torn_cube() -> String {
        let read = read_text(CUBE, &ReadOptions::default()).expect("a cube");
        let mut text = String::new();
        for f in read.mesh.faces() {
            for p in read.mesh.face_positions(f) {
                text += &format!("v {} {} {}\n", p.x, p.y, p.z);
            }
            text += "f -4 -3 -2 -1\n";
        }
        text
    }

    #[derive(Debug, clap::Parser)]
    struct Command {
        #[command(flatten)]
        read: ReadOptions,
    }

    #[test]
    fn the_defaults_are_the_same_everywhere() {
        let by_flags = Command::parse_from(["x"]).read;
        let by_recipe: ReadOptions = toml::from_str("").expect("all optional");
        let shown = |options: &ReadOptions| format!("{options:?}");
        assert_eq!(shown(&by_flags), shown(&ReadOptions::default()));
        assert_eq!(shown(&by_recipe), shown(&ReadOptions::default()));
        let by_flags =
            Command::parse_from(["x", "--units", "in", "--size", "30cm", "--weld", "0"]).read;
        let by_recipe: ReadOptions =
            toml::from_str("units = 'in'\nsize = '30cm'\nweld = 0").expect("options");
        assert_eq!(shown(&by_flags), shown(&by_recipe));
    }

    #[test]
    fn units_and_size_scale_and_a_factor_of_one_touches_nothing() {
        let moved = CUBE.replace("v 1", "v 0.30000000000000004");
        let size = |options: &ReadOptions| {
            let read = read_text(&moved, options).expect("a box");
            let (low, high) = read.mesh.bounds().expect("vertices");
            (read.scale, high - low)
        };
        let exact = 0.30000000000000004;
        assert_eq!(size(&options(MeshUnit::Mm, None, None)), (1.0, DVec3::new(exact, 1., 1.)));
        assert_eq!(
            size(&options(MeshUnit::In, None, None)),
            (25.4, DVec3::new(exact * 25.4, 25.4, 25.4))
        );
        assert_eq!(size(&options(MeshUnit::M, Some(300.0), None)).1.max_element(), 300.0);
        assert!(matches!(
            read_text(CUBE, &options(MeshUnit::Mm, Some(0.0), None)),
            Err(IoError::BadSize { .. })
        ));
    }

    #[test]
    fn a_torn_surface_is_a_fault_and_welding_closes_it() {
        let torn = torn_cube();
        let error = read_text(&torn, &ReadOptions::default()).expect_err("torn");
        assert!(matches!(error, IoError::Torn { rim_edges: 24, .. }), "{error}");
        assert!(error.to_string().ends_with("; weld them with --weld 0"), "{error}");
        for distance in [0.0, 0.5] {
            let read =
                read_text(&torn, &options(MeshUnit::Mm, None, Some(distance))).expect("welded");
            assert_sound(&read.mesh);
            assert!(read.mesh.is_closed());
            assert_eq!(
                (read.mesh.vertex_count(), read.mesh.edge_count(), read.mesh.face_count()),
                (8, 12, 6)
            );
            assert_eq!(read.notes, [ReadNote::Welded { count: 16 }]);
        }
        let nothing = read_text(&torn, &options(MeshUnit::Mm, None, Some(2.0)));
        assert!(matches!(nothing, Err(IoError::WeldedAway { .. })));
        assert!(matches!(
            read_text(&torn, &options(MeshUnit::Mm, None, Some(-1.0))),
            Err(IoError::BadWeld { .. })
        ));
    }

    #[test]
    fn a_surface_torn_in_places_is_noted() {
        let open: String = torn_cube().lines().skip(5).map(|line| format!("{line}\n")).collect();
        let read = read_text(&open, &ReadOptions::default()).expect("an open box in five pieces");
        let [ReadNote::CoincidentRims { coincident: 16, rim_edges: 20, .. }] = read.notes[..]
        else {
            panic!("{:?}", read.notes)
        };
    }

    #[test]
    fn welding_collapses_thin_faces_and_keeps_groups_and_seams_in_place() {
        // A box of which one edge is a sliver face wide.
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv \
        1.001 1 0\nv 1.001 1 1\n\
            g sliver\nf 3 7 10 9\ng rest\nf 4 3 9 2 1\nf 5 6 10 7 8\nf 1 2 6 5\nf 2 9 10 6\ng back\nf 3 4 8 7\nf 4 1 5 8\n\
            g seam\nl 9 10\nl 3 9\n";
        let whole = read_text(text, &ReadOptions::default()).expect("a box");
        assert_eq!((whole.mesh.face_count(), whole.mesh.is_closed()), (7, true));
        let welded = read_text(text, &options(MeshUnit::Mm, None, Some(0.01))).expect("welded");
        assert_sound(&welded.mesh);
        assert_eq!((welded.mesh.face_count(), welded.mesh.is_closed()), (6, true));
        assert_eq!(
            welded.notes,
            [ReadNote::Welded { count: 2 }, ReadNote::DroppedFaces { count: 1, first: 0 }]
        );
        let groups: Vec<_> =
            welded.mesh.faces().map(|f| welded.mesh.group(f).unwrap_or_default()).collect();
        assert_eq!(groups, ["rest", "rest", "rest", "rest", "back", "back"]);
        let seams = welded.mesh.edges().filter(|&e| welded.mesh.is_seam(e)).collect::<Vec<_>>();
        assert_eq!(seams.len(), 1);
    }

    #[test]
    fn vertices_that_are_split_or_unused_are_noted_and_seams_find_them() {
        let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 2 3 4\nf 2 5 6\ng \
        seam\nl 5 2\n";
        let read = read_text(text, &ReadOptions::default()).expect("a bow tie");
        let (first, centre) = (VertexId::new(0), VertexId::new(1));
        let split = ReadNote::SplitVertices { count: 1, first: centre };
        assert_eq!(read.notes, [split, ReadNote::UnusedVertices { count: 1, first }]);
        let seam = read.mesh.edges().find(|&e| read.mesh.is_seam(e)).expect("a seam");
        assert!(read.mesh.edge_vertices(seam).contains(&VertexId::new(4)));
    }
}
