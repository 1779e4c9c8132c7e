//! A net as an origami file: FOLD, with the crease pattern and the closed form.
//!
//! The first frame is the flat net as it lies on the sheets, with every fold's angle: what programs
//! that simulate folding read. The second one inherits all of it and only has other places of the
//! same vertices: those of the closed model. So a vertex of the model is there once for each part
//! of the net that it belongs to, and the two sides of a seam are two edges, which name each other
//! in a key of our own.
//!
//! Source: the FOLD specification 1.1 by Demaine, Ku and Lang, and its JSON schema. Its mountains
//! have angles below 0, ours above.

use std::collections::HashMap;
use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use serde::Serialize;

use crate::bloom::Bloom;
use crate::net::{FlatFace, FoldKind};

/// The unit. FOLD has a key `frame_unit` for it, but its published schema refuses every value of that
/// key: `mm` is both one of its names and any text, and must be exactly one of the two.
const UNITS: &str = "units: mm";

/// The text of a FOLD file. `corners` gives where the corners of a face of the model are when all
/// is closed, in the order of the face; a face that it does not know lies where folding puts it.
///
/// # Example
/// ```
/// use kerfold::bloom::Bloom;
/// use kerfold::io::bloom_fold::fold_text;
/// use kerfold::prelude::*;
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let text = fold_text(&Bloom::new(&net, &[], |_| None), |_| None, "cube", "my program");
/// assert!(text.contains("\"frame_classes\": [\"creasePattern\"]"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fold_text(
    bloom: &Bloom<'_>,
    corners: impl Fn(usize) -> Option<Vec<DVec3>>,
    title: &str,
    command: &str,
) -> String {
    let pattern = Pattern::new(bloom);
    let (flat, closed) = pattern.places(bloom, corners);
    let edges = pattern.edges(bloom);
    let faces = &pattern.faces;
    let mut text = "{\n".to_owned();
    line(&mut text, "file_spec", &1.1);
    line(&mut text, "file_creator", &"kerfold");
    line(&mut text, "file_title", &title);
    line(&mut text, "file_description", &command);
    line(&mut text, "file_classes", &["singleModel"]);
    line(&mut text, "frame_title", &"flat");
    line(&mut text, "frame_classes", &["creasePattern"]);
    line(&mut text, "frame_attributes", &["2D", "manifold", "orientable"]);
    line(&mut text, "frame_description", &UNITS);
    line(&mut text, "vertices_coords", &list(&flat, |p: &DVec2| [p.x + 0.0, p.y + 0.0]));
    line(&mut text, "vertices_kerfold:vertex", &pattern.given);
    line(&mut text, "edges_vertices", &list(&edges, |e| e.vertices));
    line(&mut text, "edges_faces", &list(&edges, |e| e.faces.clone()));
    line(&mut text, "edges_assignment", &list(&edges, |e| e.assignment));
    line(&mut text, "edges_foldAngle", &list(&edges, |e| e.angle));
    line(&mut text, "edges_kerfold:edge", &list(&edges, |e| e.label));
    line(&mut text, "edges_kerfold:partner", &list(&edges, |e| e.partner));
    line(&mut text, "faces_vertices", &list(faces, |f| pattern.vertices_of(f)));
    line(&mut text, "faces_kerfold:face", &list(faces, |f| f.flat.face));
    line(&mut text, "faces_kerfold:piece", &list(faces, |f| f.piece.clone()));
    text.push_str("\"file_frames\": [ {\n");
    line(&mut text, "frame_title", &"closed");
    line(&mut text, "frame_classes", &["foldedForm"]);
    line(&mut text, "frame_attributes", &["3D", "manifold", "orientable"]);
    line(&mut text, "frame_description", &UNITS);
    line(&mut text, "frame_parent", &0);
    line(&mut text, "frame_inherit", &true);
    let closed = list(&closed, |p: &DVec3| (*p + DVec3::ZERO).to_array());
    line(&mut text, "vertices_coords", &closed);
    // The last value of an object has no comma after it.
    text.truncate(text.trim_end_matches([',', '\n']).len());
    text.push_str(" } ] }\n");
    text
}

/// One key with its value, and a comma.
fn line(text: &mut String, key: &str, value: &impl Serialize) {
    let value = serde_json::to_string(value).expect("numbers and texts are JSON");
    writeln!(text, "\"{key}\": {value},").expect("writing into a string cannot fail");
}

fn list<T, V>(of: &[T], value: impl Fn(&T) -> V) -> Vec<V> {
    of.iter().map(value).collect()
}

/// A face of the file.
struct PatternFace<'a> {
    flat: &'a FlatFace,
    /// Its place in the forest.
    leaf: usize,
    piece: String,
    /// The number of its first corner among all corners.
    first: usize,
}

/// The faces in the order of the model, and which of their corners are one vertex.
struct Pattern<'a> {
    faces: Vec<PatternFace<'a>>,
    /// Number of a face of the model → its place in `faces`.
    places: HashMap<usize, usize>,
    /// Corner → vertex of the file.
    vertices: Vec<usize>,
    /// Vertex of the file → vertex of the model.
    given: Vec<usize>,
}

/// An edge of the file, with its left face first.
struct PatternEdge {
    vertices: [usize; 2],
    faces: Vec<usize>,
    assignment: &'static str,
    angle: f64,
    label: Option<usize>,
    partner: Option<usize>,
}

impl<'a> Pattern<'a> {
    fn new(bloom: &Bloom<'a>) -> Self {
        let tree = bloom.tree();
        let mut faces: Vec<PatternFace<'_>> = (tree.leaves().iter().enumerate())
            .map(|(leaf, at)| {
                let piece = tree.net().pieces[at.piece].id.to_string();
                PatternFace { flat: tree.flat(at), leaf, piece, first: 0 }
            })
            .collect();
        faces.sort_by_key(|face| face.flat.face);
        let mut count = 0;
        for face in &mut faces {
            face.first = count;
            count += face.flat.vertices.len();
        }
        let places = faces.iter().enumerate().map(|(i, f)| (f.flat.face, i)).collect();
        let mut pattern = Self { faces, places, vertices: Vec::new(), given: Vec::new() };
        pattern.number(bloom, count);
        pattern
    }

    /// Corners that folds hold together are one vertex; vertices are numbered as they come.
    fn number(&mut self, bloom: &Bloom<'_>, count: usize) {
        let mut root: Vec<usize> = (0..count).collect();
        for fold in &bloom.tree().net().folds {
            let sides = fold.faces.map(|face| self.side(face, fold.edge));
            let [Some([a, b]), Some([c, d])] = sides else { continue };
            // The two faces run along it in opposite directions.
            for (p, q) in [(a, d), (b, c)] {
                let (p, q) = (find(&mut root, p), find(&mut root, q));
                root[p.max(q)] = p.min(q);
            }
        }
        let model: Vec<usize> = self.faces.iter().flat_map(|f| &f.flat.vertices).copied().collect();
        for (corner, vertex) in model.into_iter().enumerate() {
            let first = find(&mut root, corner);
            if first == corner {
                self.vertices.push(self.given.len());
                self.given.push(vertex);
            } else {
                self.vertices.push(self.vertices[first]);
            }
        }
    }

    /// The two corners of a face's side between two vertices of the model, as the face runs.
    fn side(&self, face: usize, edge: [usize; 2]) -> Option<[usize; 2]> {
        let face = &self.faces[*self.places.get(&face)?];
        let (n, of) = (face.flat.vertices.len(), &face.flat.vertices);
        let is_side = |&i: &usize| {
            let ends = [of[i], of[(i + 1) % n]];
            ends == edge || ends == [edge[1], edge[0]]
        };
        (0..n).find(is_side).map(|i| [face.first + i, face.first + (i + 1) % n])
    }

    fn vertices_of(&self, face: &PatternFace<'_>) -> Vec<usize> {
        self.vertices[face.first..face.first + face.flat.vertices.len()].to_vec()
    }

    /// Where every vertex lies on the sheets, and when all is closed.
    fn places(
        &self,
        bloom: &Bloom<'_>,
        corners: impl Fn(usize) -> Option<Vec<DVec3>>,
    ) -> (Vec<DVec2>, Vec<DVec3>) {
        let count = self.given.len();
        let (mut flat, mut closed) = (vec![DVec2::ZERO; count], vec![DVec3::ZERO; count]);
        // Of several corners the first one has the word.
        for face in self.faces.iter().rev() {
            let polygon = &face.flat.polygon;
            let there = corners(face.flat.face).filter(|points| points.len() == polygon.len());
            for (i, (&p, &v)) in polygon.iter().zip(&self.vertices[face.first..]).enumerate() {
                flat[v] = bloom.flat()[face.leaf].lift(p).truncate();
                closed[v] = match &there {
                    Some(points) => points[i],
                    None => bloom.closed()[face.leaf].lift(p),
                };
            }
        }
        (flat, closed)
    }

    /// Folds, then both sides of every seam, then rims.
    fn edges(&self, bloom: &Bloom<'_>) -> Vec<PatternEdge> {
        let net = bloom.tree().net();
        let border = |face: usize, edge, label| {
            let vertices = self.side(face, edge)?.map(|corner| self.vertices[corner]);
            let faces = vec![*self.places.get(&face)?];
            let (assignment, angle, partner) = ("B", 0.0, None);
            Some(PatternEdge { vertices, faces, assignment, angle, label, partner })
        };
        let mut edges: Vec<PatternEdge> = Vec::new();
        for fold in &net.folds {
            let [left, right] = fold.faces;
            let Some(mut edge) = border(left, fold.edge, Some(fold.id.0)) else { continue };
            edge.faces.extend(self.places.get(&right));
            (edge.assignment, edge.angle) = match fold.kind {
                FoldKind::Mountain => ("M", -fold.fold_angle),
                FoldKind::Valley => ("V", -fold.fold_angle),
                FoldKind::Flat => ("F", 0.0),
            };
            edges.push(edge);
        }
        for seam in &net.seams {
            let first = edges.len();
            let sides = [0, 1].map(|k| border(seam.sides[k].face, seam.edge, Some(seam.id.0)));
            edges.extend(sides.into_iter().flatten());
            if let [a, b] = &mut edges[first..] {
                (a.partner, b.partner) = (Some(first + 1), Some(first));
            }
        }
        edges.extend(net.rims.iter().filter_map(|rim| border(rim.face, rim.edge, None)));
        edges
    }
}

/// The first of the corners that are one with this one.
fn find(root: &mut [usize], mut corner: usize) -> usize {
    while root[corner] != corner {
        root[corner] = root[root[corner]];
        corner = root[corner];
    }
    corner
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::mesh::{FaceId, Mesh};
    use crate::progress::Silent;
    use crate::unfold::{MeshSource, PiecesMode, Seams, UnfoldParams, unfold};

    fn numbers<const N: usize>(value: &Value) -> Vec<[f64; N]> {
        let point = |p: &Value| {
            let p = p.as_array().expect("a point");
            assert_eq!(p.len(), N);
            std::array::from_fn(|i| p[i].as_f64().expect("a number"))
        };
        value.as_array().expect("points").iter().map(point).collect()
    }

    fn indices(value: &Value, below: usize) -> Vec<Vec<usize>> {
        let index = |v: &Value| {
            let i = v.as_u64().expect("a number") as usize;
            assert!(i < below, "{i} of {below}");
            i
        };
        let row = |v: &Value| v.as_array().expect("a row").iter().map(index).collect();
        value.as_array().expect("rows").iter().map(row).collect()
    }

    /// What the schema and the words of the specification ask for, and that the folded frame is the
    /// flat one bent by the angles that it states. Returns how often each assignment comes.
    fn checked(text: &str, mesh: &Mesh) -> HashMap<String, usize> {
        let file: Value = serde_json::from_str(text).expect("JSON");
        let folded = &file["file_frames"][0];
        assert_eq!((&file["file_spec"], &folded["frame_inherit"]), (&1.1.into(), &true.into()));
        for key in file.as_object().expect("an object").keys() {
            let known = ["file_", "frame_", "vertices_", "edges_", "faces_"];
            assert!(known.iter().any(|start| key.starts_with(start)), "{key}");
            assert_ne!(key, "frame_unit", "the schema refuses it");
        }
        let flat = numbers::<2>(&file["vertices_coords"]);
        let closed = numbers::<3>(&folded["vertices_coords"]);
        assert_eq!((flat.len(), closed.len()), (flat.len(), flat.len()));
        let flat: Vec<DVec2> = flat.into_iter().map(DVec2::from).collect();
        let closed: Vec<DVec3> = closed.into_iter().map(DVec3::from).collect();
        let faces = indices(&file["faces_vertices"], flat.len());
        assert_eq!(faces.len(), mesh.face_count());
        let size = crate::measure::size(mesh).length();
        for (number, face) in faces.iter().enumerate() {
            let there = mesh.face_positions(FaceId::new(number));
            assert_eq!(face.len(), there.len());
            // The face of the model, in order, and neither bent nor mirrored on the sheet.
            assert!(face.iter().zip(&there).all(|(&v, p)| closed[v].distance(*p) < 1e-9 * size));
            let n = face.len();
            let doubled: f64 =
                (0..n).map(|i| flat[face[i]].perp_dot(flat[face[(i + 1) % n]])).sum();
            assert!(doubled > 0.0, "face {number} runs clockwise");
        }
        let edges = indices(&file["edges_vertices"], flat.len());
        let beside = indices(&file["edges_faces"], faces.len());
        let assigned = file["edges_assignment"].as_array().expect("assignments");
        let angles = file["edges_foldAngle"].as_array().expect("angles");
        let partners = file["edges_kerfold:partner"].as_array().expect("partners");
        assert_eq!([edges.len(); 4], [beside.len(), assigned.len(), angles.len(), partners.len()]);
        let normal = |face: usize| mesh.plane(FaceId::new(face)).expect("a plane").normal();
        let mut counts = HashMap::new();
        for (e, ends) in edges.iter().enumerate() {
            let [a, b] = [ends[0], ends[1]];
            let (long, wide) = (flat[a].distance(flat[b]), closed[a].distance(closed[b]));
            assert!((long - wide).abs() < 1e-9 * size, "edge {e}: {long} and {wide}");
            let runs = |face: &Vec<usize>, a, b| {
                (0..face.len()).any(|i| face[i] == a && face[(i + 1) % face.len()] == b)
            };
            assert!(runs(&faces[beside[e][0]], a, b), "edge {e}: its left face comes first");
            let angle = angles[e].as_f64().expect("an angle");
            assert!((-180.0..=180.0).contains(&angle));
            let letter = assigned[e].as_str().expect("a letter");
            match letter {
                "B" => assert_eq!((beside[e].len(), angle), (1, 0.0)),
                "M" | "V" | "F" => {
                    assert!(beside[e].len() == 2 && runs(&faces[beside[e][1]], b, a));
                    let [left, right] = [beside[e][0], beside[e][1]].map(normal);
                    let turn = left.cross(right).dot((closed[b] - closed[a]).normalize());
                    let turn = turn.atan2(left.dot(right)).to_degrees();
                    assert!((turn + angle).abs() < 1e-6, "edge {e}: {turn} and {angle}");
                    let sign = if letter == "F" { 0.0 } else { angle.signum() };
                    assert_eq!(
                        sign,
                        ["M", "F", "V"]
                            .iter()
                            .zip([-1.0, 0.0, 1.0])
                            .find(|(l, _)| **l == letter)
                            .expect("a letter")
                            .1
                    );
                }
                other => panic!("{other} is no assignment"),
            }
            if let Some(partner) = partners[e].as_u64() {
                let other = &edges[partner as usize];
                assert_eq!(partners[partner as usize], Value::from(e));
                assert!(closed[a].distance(closed[other[1]]) < 1e-9 * size);
                assert!(closed[b].distance(closed[other[0]]) < 1e-9 * size);
            }
            *counts.entry(letter.to_owned()).or_insert(0) += 1;
        }
        counts
    }

    fn written(mesh: &Mesh, pieces: PiecesMode) -> (String, [usize; 3]) {
        let source = MeshSource { scale: 1.0, split_vertices: &[] };
        let params = UnfoldParams { pieces, ..UnfoldParams::default() };
        let net = unfold(mesh, &Seams::Free, &params, &source, &Silent).expect("it unfolds");
        let corners = |f| Some(mesh.face_positions(FaceId::new(f)));
        let bloom = Bloom::new(&net, &[], corners);
        let counts = [net.folds.len(), net.seams.len(), net.rims.len()];
        (fold_text(&bloom, corners, "a \"test\"", "kerfold"), counts)
    }

    #[test]
    fn both_frames_say_the_same_net_with_all_its_angles() {
        let concave = {
            let text = include_str!("../../fixtures/meshes/dented-star.obj");
            let name = std::path::Path::new("l.obj");
            crate::io::read_mesh_bytes(name, text.as_bytes(), &crate::io::ReadOptions::default())
                .expect("a mesh")
                .mesh
        };
        for (mesh, pieces) in [
            (crate::shape::cube(40.0), PiecesMode::One),
            (crate::shape::soccer_ball(20.0), PiecesMode::Auto),
            (crate::shape::dodecahedron(20.0), PiecesMode::Faces),
            (concave.clone(), PiecesMode::Auto),
        ] {
            let (text, [folds, seams, rims]) = written(&mesh, pieces);
            let counts = checked(&text, &mesh);
            let of = |letter: &str| counts.get(letter).copied().unwrap_or(0);
            assert_eq!(of("M") + of("V") + of("F"), folds);
            assert_eq!(of("B"), 2 * seams + rims);
        }
        let (text, _) = written(&concave, PiecesMode::Auto);
        assert!(text.contains("\"V\"") && text.contains("\"M\""), "both kinds of folds");
    }

    #[test]
    fn the_checker_sees_a_wrong_sign() {
        let cube = crate::shape::cube(40.0);
        let (text, _) = written(&cube, PiecesMode::One);
        let wrong = text.replacen("-90.0", "90.0", 1).replacen("-89.99999999999999", "90.0", 1);
        assert_ne!(wrong, text);
        assert!(std::panic::catch_unwind(|| checked(&wrong, &cube)).is_err());
    }
}
