//! A mesh as the page takes it: a short text that says what follows, and arrays that can be handed
//! to a graphics card as they are.
//!
//! `KFM1`, the length of the text as u32, the text (JSON, filled with blanks to a multiple of 4),
//! and the arrays, all little-endian: f32 or u32. The text names each array with its kind, where it
//! begins after the text, and how many numbers it has.

use glam::{DVec2, DVec3};
use kerfold::geom::{Frame, triangulate};
use kerfold::measure::{fold_angle, planarity};
use kerfold::mesh::{FaceId, Mesh};
use kerfold::select::NewElements;
use serde_json::{Map, Value, json};

/// How every such answer begins.
pub const MAGIC: &[u8; 4] = b"KFM1";

/// Arrays with their names, and what else is told.
#[derive(Default)]
struct Arrays {
    told: Map<String, Value>,
    list: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    fn floats(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        let at = self.bytes.len();
        values.into_iter().for_each(|x| self.bytes.extend((x as f32).to_le_bytes()));
        self.name(name, "f32", at);
    }

    fn numbers(&mut self, name: &str, values: impl IntoIterator<Item = usize>) {
        let at = self.bytes.len();
        values.into_iter().for_each(|n| self.bytes.extend((n as u32).to_le_bytes()));
        self.name(name, "u32", at);
    }

    fn name(&mut self, name: &str, kind: &str, at: usize) {
        let count = (self.bytes.len() - at) / 4;
        self.list.insert(name.to_owned(), json!({ "kind": kind, "at": at, "count": count }));
    }

    fn finish(mut self) -> Vec<u8> {
        self.told.insert("arrays".to_owned(), Value::Object(self.list));
        let mut text = Value::Object(self.told).to_string();
        while !text.len().is_multiple_of(4) {
            text.push(' ');
        }
        let mut all = MAGIC.to_vec();
        all.extend((text.len() as u32).to_le_bytes());
        all.extend(text.as_bytes());
        all.extend(self.bytes);
        all
    }
}

/// A mesh with what the page shows of it. `told` goes into the text as it is; `made` is what the
/// last step made.
///
/// Arrays: `positions` of vertices by id (3 each, in mm, from `origin`); `vertex_valence` by id;
/// `faces`, the ids of the faces; `face_starts` and `face_vertices`, their corners; `face_planarity`
/// in mm; `face_group`, places in `groups`, or the number of groups; `triangles` (3 vertices each)
/// and `triangle_face`, places in `faces`; `edges`, their ids; `edge_vertices` (2 each);
/// `edge_faces` (2 each, ids); `edge_fold` in degrees, NaN at rims; `made_vertices`, `made_edges`,
/// `made_strip`, `made_faces`.
pub fn mesh_bytes(mesh: &Mesh, made: Option<&NewElements>, told: Map<String, Value>) -> Vec<u8> {
    let mut arrays = Arrays { told, ..Arrays::default() };
    let (low, high) = mesh.bounds().unwrap_or_default();
    let origin = low.midpoint(high);
    let size = high - low;
    arrays.told.insert("origin".to_owned(), json!(origin.to_array()));
    arrays.told.insert("size".to_owned(), json!(size.to_array()));
    arrays.told.insert("groups".to_owned(), json!(mesh.groups()));
    vertices(&mut arrays, mesh, origin);
    faces(&mut arrays, mesh);
    edges(&mut arrays, mesh);
    let none = NewElements::default();
    let made = made.unwrap_or(&none);
    arrays.numbers("made_vertices", made.vertices.iter().map(|v| v.index()));
    arrays.numbers("made_edges", made.edges.iter().map(|e| e.index()));
    arrays.numbers("made_strip", made.strip.iter().map(|e| e.index()));
    arrays.numbers("made_faces", made.faces.iter().map(|f| f.index()));
    arrays.finish()
}

fn vertices(arrays: &mut Arrays, mesh: &Mesh, origin: DVec3) {
    let mut places = vec![DVec3::NAN; mesh.vertex_slots()];
    let mut valences = vec![0; mesh.vertex_slots()];
    for v in mesh.vertices() {
        places[v.index()] = mesh.position(v) - origin;
        valences[v.index()] = mesh.valence(v);
    }
    arrays.floats("positions", places.into_iter().flat_map(|p| p.to_array()));
    arrays.numbers("vertex_valence", valences);
}

fn faces(arrays: &mut Arrays, mesh: &Mesh) {
    let faces: Vec<FaceId> = mesh.faces().collect();
    let (mut starts, mut corners) = (vec![0], Vec::new());
    let (mut triangles, mut of_face) = (Vec::new(), Vec::new());
    for (place, &f) in faces.iter().enumerate() {
        let vertices: Vec<usize> = mesh.face_vertices(f).map(|v| v.index()).collect();
        for triangle in triangles_of(mesh, f) {
            triangles.extend(triangle.map(|corner| vertices[corner]));
            of_face.push(place);
        }
        corners.extend(vertices);
        starts.push(corners.len());
    }
    let groups = mesh.groups();
    let group = |f: &FaceId| {
        let name = mesh.group(*f);
        name.and_then(|name| groups.iter().position(|g| g == name)).unwrap_or(groups.len())
    };
    arrays.numbers("faces", faces.iter().map(|f| f.index()));
    arrays.numbers("face_starts", starts);
    arrays.numbers("face_vertices", corners);
    arrays.floats("face_planarity", faces.iter().map(|&f| planarity(mesh, f).mm));
    arrays.numbers("face_group", faces.iter().map(group));
    arrays.numbers("triangles", triangles);
    arrays.numbers("triangle_face", of_face);
}

/// The triangles of a face, by the places of its corners.
fn triangles_of(mesh: &Mesh, f: FaceId) -> Vec<[usize; 3]> {
    let points = mesh.face_positions(f);
    if points.len() == 3 {
        return vec![[0, 1, 2]];
    }
    let Some(plane) = mesh.plane(f) else {
        return (2..points.len()).map(|i| [0, i - 1, i]).collect();
    };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = points.iter().map(|&p| frame.flatten(p)).collect();
    triangulate(&flat)
}

fn edges(arrays: &mut Arrays, mesh: &Mesh) {
    arrays.numbers("edges", mesh.edges().map(|e| e.index()));
    let ends = mesh.edges().flat_map(|e| mesh.edge_vertices(e)).map(|v| v.index());
    arrays.numbers("edge_vertices", ends);
    let beside = mesh.edges().flat_map(|e| mesh.edge_faces(e)).map(|f| f.index());
    arrays.numbers("edge_faces", beside);
    let fold = |e| fold_angle(mesh, e).map_or(f64::NAN, f64::to_degrees);
    arrays.floats("edge_fold", mesh.edges().map(fold));
}

/// Faces in the air: arrays `faces` (ids), `face_starts` and `corners` (3 each, in mm, from the
/// middle of the model), `triangles` (3 corners each) and `triangle_face`, places in `faces`.
pub(crate) fn bloom_bytes(
    faces: impl Iterator<Item = (usize, Vec<DVec3>, Vec<[usize; 3]>)>,
) -> Vec<u8> {
    let (mut ids, mut starts) = (Vec::new(), vec![0]);
    let (mut points, mut triangles, mut of_face) = (Vec::new(), Vec::new(), Vec::new());
    for (id, corners, own) in faces {
        let start = points.len();
        for triangle in own {
            triangles.extend(triangle.map(|corner| start + corner));
            of_face.push(ids.len());
        }
        points.extend(corners);
        starts.push(points.len());
        ids.push(id);
    }
    let mut arrays = Arrays::default();
    arrays.numbers("faces", ids);
    arrays.numbers("face_starts", starts);
    arrays.floats("corners", points.into_iter().flat_map(|p| p.to_array()));
    arrays.numbers("triangles", triangles);
    arrays.numbers("triangle_face", of_face);
    arrays.finish()
}
