//! DXF: the faces of a mesh as 3DFACE entities, a layer for each group.
//!
//! A 3DFACE has three or four corners, so other faces are cut into triangles whose inner sides are
//! marked as not to be seen: every program shows the edges of the mesh and no others. Coordinates
//! keep every digit. Faces without a group lie on the layer `0`.

use std::collections::HashMap;

use super::WriteOptions;
use super::polygons::Polygons;
use crate::geom::Frame;
use crate::io::sheet::dxf::{DxfLayer, Entities, dxf_file, plain};
use crate::mesh::{FaceId, Mesh};

/// Colours of the index, for the layers in turn.
const COLOURS: [u8; 8] = [5, 1, 3, 6, 30, 4, 2, 8];
/// The layer that every drawing has.
const NO_GROUP: &str = "0";
/// The longest name of a layer.
const LONGEST: usize = 200;
/// What names of layers must not have.
const FORBIDDEN: &[char] = &['<', '>', '/', '\\', '"', ':', ';', '?', '*', '|', ',', '=', '`'];

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Vec<u8> {
    let polygons = Polygons::of(mesh);
    let names = layer_names(mesh, &polygons);
    let mut entities = Entities::default();
    for (f, corners) in polygons.faces() {
        let layer = mesh.group(f).and_then(|group| names.get(group));
        let layer = layer.map_or(NO_GROUP, |(_, name)| name);
        let shown = |c: usize| polygons.positions[c].to_array().map(|x| x.to_string());
        for part in parts(mesh, &polygons, f, corners) {
            entities.face(layer, part.corners.map(shown), part.hidden);
        }
    }
    let mut rows: Vec<_> = names.values().collect();
    rows.sort_unstable();
    let layers: Vec<DxfLayer<'_>> = rows
        .into_iter()
        .map(|(number, name)| DxfLayer {
            name,
            colour: COLOURS[number % COLOURS.len()],
            weight: 20,
            is_dashed: false,
            is_plotted: true,
        })
        .collect();
    let size = mesh.bounds().map_or([1.0; 2], |(low, high)| {
        let size = (high - low).truncate();
        [size.x, size.y].map(|extent| extent.max(1.0))
    });
    dxf_file(size, &layers, &options.comment().unwrap_or_default(), &entities).into_bytes()
}

/// One entity: a side is hidden when its bit is set, the first side has the lowest.
struct Part {
    corners: [usize; 4],
    hidden: u8,
}

/// A face as entities.
fn parts(mesh: &Mesh, polygons: &Polygons, f: FaceId, corners: &[usize]) -> Vec<Part> {
    if let &[a, b, c, d] = corners
        && is_convex(mesh, polygons, f, corners)
    {
        return vec![Part { corners: [a, b, c, d], hidden: 0 }];
    }
    let n = corners.len();
    let is_inner = |from: usize, to: usize| (from + 1) % n != to;
    let triangles = polygons.triangles(mesh, f, corners).into_iter();
    let part = |[a, b, c]: [usize; 3]| {
        // The third side of a triangle is the fourth of an entity.
        let sides = [(a, b, 1), (b, c, 2), (c, a, 8)];
        let hidden = sides.into_iter().filter(|&(from, to, _)| is_inner(from, to));
        Part {
            corners: [a, b, c, c].map(|i| corners[i]),
            hidden: hidden.map(|(_, _, bit)| bit).sum(),
        }
    };
    triangles.map(part).collect()
}

fn is_convex(mesh: &Mesh, polygons: &Polygons, f: FaceId, corners: &[usize]) -> bool {
    let Some(plane) = mesh.plane(f) else { return false };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<_> = corners.iter().map(|&c| frame.flatten(polygons.positions[c])).collect();
    let n = flat.len();
    (0..n).all(|i| {
        let [a, b, c] = [flat[i], flat[(i + 1) % n], flat[(i + 2) % n]];
        (b - a).perp_dot(c - b) > 0.0
    })
}

/// Groups with their number and the name of their layer. Names differ without regard to capitals.
fn layer_names<'a>(mesh: &'a Mesh, polygons: &Polygons) -> HashMap<&'a str, (usize, String)> {
    let mut names: HashMap<&str, (usize, String)> = HashMap::new();
    let mut taken = vec![NO_GROUP.to_owned()];
    for (f, _) in polygons.faces() {
        let Some(group) = mesh.group(f).filter(|group| !names.contains_key(group)) else {
            continue;
        };
        let allowed = |c: char| if c.is_control() || FORBIDDEN.contains(&c) { '_' } else { c };
        let clean: String = group.trim().chars().take(LONGEST).map(allowed).collect();
        let clean = if clean.is_empty() { "_".to_owned() } else { plain(&clean) };
        let numbered = (2..).map(|i| format!("{clean}_{i}"));
        let free = |name: &String| !taken.contains(&name.to_lowercase());
        let name = std::iter::once(clean.clone()).chain(numbered).find(free).unwrap_or_default();
        taken.push(name.to_lowercase());
        names.insert(group, (names.len(), name));
    }
    names
}

/// Whether the sides to be seen in a drawing are the sides of the faces of the mesh, each once for
/// every face, and the hidden ones lie between two entities.
pub(super) fn says(text: &[u8], mesh: &Mesh) -> bool {
    let Ok(text) = std::str::from_utf8(text) else { return false };
    let polygons = Polygons::of(mesh);
    // Sides to be seen as they run; hidden ones from the lower end to the upper.
    let mut sides: HashMap<(bool, [[u64; 3]; 2]), i64> = HashMap::new();
    let key = |p: [f64; 3]| p.map(|x| (x + 0.0).to_bits());
    for (_, corners) in polygons.faces() {
        for (i, &corner) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            let ends = [corner, next].map(|c| key(polygons.positions[c].to_array()));
            *sides.entry((true, ends)).or_default() += 1;
        }
    }
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let pairs: Vec<(&str, &str)> = lines.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
    for entity in pairs.split(|(code, _)| *code == "0").filter(|e| is_face(e)) {
        let value = |code: usize| {
            let code = code.to_string();
            entity.iter().find(|(c, _)| *c == code).and_then(|(_, value)| value.parse::<f64>().ok())
        };
        let corner = |i: usize| Some([value(10 + i)?, value(20 + i)?, value(30 + i)?]);
        let [Some(a), Some(b), Some(c), Some(d)] = [0, 1, 2, 3].map(corner) else { return false };
        let hidden = value(70).unwrap_or(0.0) as u8;
        for (ends, bit) in [([a, b], 1), ([b, c], 2), ([c, d], 4), ([d, a], 8)] {
            let [from, to] = ends.map(key);
            if from == to {
                continue;
            }
            if hidden & bit == 0 {
                *sides.entry((true, [from, to])).or_default() -= 1;
            } else {
                // Its partner runs the other way.
                let (ends, sign) = if from < to { ([from, to], 1) } else { ([to, from], -1) };
                *sides.entry((false, ends)).or_default() += sign;
            }
        }
    }
    sides.values().all(|&count| count == 0)
}

/// Whether the pairs of an entity are those of a 3DFACE.
fn is_face(entity: &[(&str, &str)]) -> bool {
    entity.contains(&("100", "AcDbFace"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{IoError, MeshFormat, ReadOptions, mesh_bytes, read_mesh_bytes};
    use crate::shape::{cube, prism, soccer_ball};

    fn written(mesh: &Mesh) -> String {
        let bytes = mesh_bytes(MeshFormat::Dxf, mesh, &WriteOptions::default()).expect("a mesh");
        String::from_utf8(bytes).expect("text")
    }

    #[test]
    fn faces_are_entities_and_inner_sides_are_hidden() {
        let text = written(&cube(10.0));
        assert_eq!(text.matches("3DFACE").count(), 6);
        assert!(text.contains("\n 70\n0\n") && !text.contains("\n 70\n8\n"), "nothing is hidden");
        // A hexagon has four triangles: two with one inner side, two with two.
        let text = written(&prism(6, 10.0));
        assert_eq!(text.matches("3DFACE").count(), 6 + 2 * 4);
        let ball = soccer_ball(7.1);
        let text = written(&ball);
        assert_eq!(text.matches("3DFACE").count(), 12 * 3 + 20 * 4);
        assert!(says(text.as_bytes(), &ball) && !says(text.as_bytes(), &cube(10.0)));
        let seen = text.replacen("\n 70\n8\n", "\n 70\n0\n", 1);
        assert!(seen == text || !says(seen.as_bytes(), &ball));
        let (start, _) = text.rsplit_once("3DFACE").expect("a face");
        assert!(!says(start.as_bytes(), &ball), "a face is missing");
    }

    #[test]
    fn groups_are_layers_with_names_that_differ() {
        let mut mesh = cube(10.0);
        let faces: Vec<FaceId> = mesh.faces().collect();
        for (&f, name) in faces.iter().zip(["Wall/north", "wall_north", "0", "Dächer", " "]) {
            mesh.set_group(f, name);
        }
        let text = written(&mesh);
        for name in ["Wall_north", "wall_north_2", "0_2", "D\\U+00E4cher", "_"] {
            let shown = format!("\n  8\n{name}\n");
            assert!(text.contains(&shown), "{name}");
            assert!(text.contains(&format!("\n  2\n{name}\n")), "{name} has no layer");
        }
        assert!(text.contains("\n  8\n0\n"));
    }

    #[test]
    fn it_is_not_read_as_a_mesh() {
        let text = written(&cube(10.0));
        let name = std::path::Path::new("x.dxf");
        let error = read_mesh_bytes(name, text.as_bytes(), &ReadOptions::default());
        assert!(matches!(error, Err(IoError::OnlyWritten { .. })));
    }
}
