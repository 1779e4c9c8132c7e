//! Binary glTF 2.0 (GLB): named nodes in a tree, faces with colours, and animations, in single
//! precision.
//!
//! A [`GlbScene`] is in millimetres with z up, as everything here. The file is in metres with y up,
//! as glTF asks; one node around everything turns and scales it. Normals are left out: readers then
//! shade every triangle flat, as plates and folded paper are.
//!
//! Source: the glTF 2.0 specification of the Khronos Group.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use serde_json::{Map, Value, json};

use super::one_line;
use crate::io::error::IoError;

const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const TRIANGLES: u32 = 4;
const LINES: u32 = 1;

/// What a GLB file holds, in millimetres, z up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GlbScene {
    name: String,
    nodes: Vec<GlbNode>,
    materials: Vec<GlbMaterial>,
    tracks: Vec<GlbTrack>,
}

/// A node of [`GlbScene`], by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GlbNodeId(usize);

/// A material of [`GlbScene`], by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GlbMaterialId(usize);

/// A thing with a name, a place relative to its parent, and perhaps a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct GlbNode {
    /// Its name, as `P01` or `F003`.
    pub name: String,
    /// The node that carries it; none for one of the scene itself.
    pub parent: Option<GlbNodeId>,
    /// Where its origin lies in its parent, in mm.
    pub translation: DVec3,
    /// How it is turned in its parent; of unit length.
    pub rotation: DQuat,
    /// Its surface.
    pub surface: Option<GlbSurface>,
    /// What programs should know about it besides, by names: the `extras` of glTF.
    pub extras: Vec<(&'static str, GlbExtra)>,
}

/// A value of the `extras` of a node.
#[derive(Debug, Clone, PartialEq)]
pub enum GlbExtra {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
    /// Several numbers, such as one for each side.
    Numbers(Vec<f64>),
}

/// Triangles and lines between points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GlbSurface {
    /// Points in the node's own frame, in mm.
    pub points: Vec<DVec3>,
    /// Triangles by the places of their corners, counter-clockwise from outside, with their
    /// material.
    pub triangles: Vec<[u32; 3]>,
    /// The material of the triangles; the reader's own when missing.
    pub material: Option<GlbMaterialId>,
    /// Lines by the places of their ends, such as the edges of a face.
    pub lines: Vec<[u32; 2]>,
    /// The material of the lines.
    pub line_material: Option<GlbMaterialId>,
}

/// A colour with a name; seen from both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct GlbMaterial {
    /// Its name.
    pub name: String,
    /// Red, green and blue as on a screen (sRGB).
    pub colour: [u8; 3],
    /// 1 for solid, less for see-through, as glass.
    pub opacity: f64,
}

/// How one property of a node goes through time; straight between its moments.
#[derive(Debug, Clone, PartialEq)]
pub struct GlbTrack {
    /// The node.
    pub node: GlbNodeId,
    /// The moments in seconds, ascending from 0.
    pub times: Vec<f64>,
    /// The value at each of them.
    pub values: GlbValues,
}

/// Values of a [`GlbTrack`], as many as it has moments.
#[derive(Debug, Clone, PartialEq)]
pub enum GlbValues {
    /// Rotations relative to the parent, of unit length; readers turn from one to the next by the
    /// shorter way.
    Rotations(Vec<DQuat>),
    /// Translations relative to the parent, in mm.
    Translations(Vec<DVec3>),
}

impl GlbScene {
    /// An empty scene.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds a material.
    pub fn add_material(
        &mut self,
        name: impl Into<String>,
        colour: [u8; 3],
        opacity: f64,
    ) -> GlbMaterialId {
        self.materials.push(GlbMaterial {
            name: name.into(),
            colour,
            opacity: opacity.clamp(0.0, 1.0),
        });
        GlbMaterialId(self.materials.len() - 1)
    }

    /// Adds a node. Its parent was added before, so that nodes are a forest by construction.
    pub fn add_node(&mut self, node: GlbNode) -> GlbNodeId {
        self.nodes.push(node);
        GlbNodeId(self.nodes.len() - 1)
    }

    /// Adds a movement; all movements of a scene are one animation.
    pub fn add_track(&mut self, track: GlbTrack) {
        self.tracks.push(track);
    }

    /// Its nodes, parents first.
    pub fn nodes(&self) -> &[GlbNode] {
        &self.nodes
    }

    /// Its movements.
    pub fn tracks(&self) -> &[GlbTrack] {
        &self.tracks
    }
}

impl GlbNodeId {
    /// Its place in [`GlbScene::nodes`].
    pub fn index(self) -> usize {
        self.0
    }
}

/// The file of a scene; `command` is the command line that made it.
///
/// # Errors
/// [`IoError::TooFarForGlb`] when a number does not fit into single precision.
///
/// # Example
/// ```
/// use kerfold::io::glb::{GlbScene, glb_bytes};
///
/// let bytes = glb_bytes(&GlbScene::new("empty"), "my program")?;
/// assert!(bytes.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn glb_bytes(scene: &GlbScene, command: &str) -> Result<Vec<u8>, IoError> {
    let mut file = File::default();
    let nodes = file.nodes(scene)?;
    let animation = file.animation(scene)?;
    let File { bytes, views, accessors, meshes, .. } = file;
    let mut root = Map::new();
    let generator = json!({
        "version": "2.0", "generator": "kerfold", "extras": { "command": one_line(command) },
    });
    root.insert("asset".to_owned(), generator);
    root.insert("scene".to_owned(), json!(0));
    root.insert(
        "scenes".to_owned(),
        json!([{ "name": one_line(&scene.name), "nodes": [scene.nodes.len()] }]),
    );
    root.insert("nodes".to_owned(), Value::Array(nodes));
    // glTF forbids empty lists.
    let materials: Vec<Value> = scene.materials.iter().map(material).collect();
    let lists = [
        ("meshes", meshes),
        ("materials", materials),
        ("accessors", accessors),
        ("bufferViews", views),
    ];
    for (key, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        root.insert(key.to_owned(), Value::Array(list));
    }
    if let Some(animation) = animation {
        root.insert("animations".to_owned(), json!([animation]));
    }
    if !bytes.is_empty() {
        root.insert("buffers".to_owned(), json!([{ "byteLength": bytes.len() }]));
    }
    Ok(container(Value::Object(root).to_string().into_bytes(), bytes))
}

/// The two chunks with their headers, each filled up to whole words.
fn container(mut text: Vec<u8>, bytes: Vec<u8>) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let has_bytes = !bytes.is_empty();
    let total = 12 + 8 + text.len() + if has_bytes { 8 + bytes.len() } else { 0 };
    let mut file = Vec::with_capacity(total);
    let word = |file: &mut Vec<u8>, word: usize| file.extend((word as u32).to_le_bytes());
    file.extend(b"glTF");
    word(&mut file, 2);
    word(&mut file, total);
    word(&mut file, text.len());
    file.extend(b"JSON");
    file.extend(text);
    if has_bytes {
        word(&mut file, bytes.len());
        file.extend(b"BIN\0");
        file.extend(bytes);
    }
    file
}

fn material(material: &GlbMaterial) -> Value {
    // Four decimals are finer than the 256 steps of a screen and the same on every machine.
    let rounded = |x: f64| (x * 1e4).round() / 1e4;
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        rounded(if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
    };
    let [r, g, b] = material.colour.map(linear);
    let mut value = json!({
        "name": one_line(&material.name),
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, rounded(material.opacity)], "metallicFactor": 0.0,
            "roughnessFactor": 0.9
        },
        "doubleSided": true,
    });
    if material.opacity < 1.0 {
        value["alphaMode"] = json!("BLEND");
    }
    value
}

fn extras(extras: &[(&'static str, GlbExtra)]) -> Value {
    let value = |extra: &GlbExtra| match extra {
        GlbExtra::Text(text) => json!(one_line(text)),
        GlbExtra::Number(number) => json!(number),
        GlbExtra::Numbers(numbers) => json!(numbers),
    };
    extras
        .iter()
        .map(|(name, extra)| ((*name).to_owned(), value(extra)))
        .collect::<Map<_, _>>()
        .into()
}

/// The lists of the file in the making.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    /// The accessor of every list of moments, by the bits of its numbers.
    times: BTreeMap<Vec<u32>, usize>,
}

impl File {
    /// All nodes, and behind them the one that carries those without a parent.
    fn nodes(&mut self, scene: &GlbScene) -> Result<Vec<Value>, IoError> {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); scene.nodes.len() + 1];
        for (i, node) in scene.nodes.iter().enumerate() {
            children[node.parent.map_or(scene.nodes.len(), |p| p.0)].push(i);
        }
        let mut nodes = Vec::with_capacity(children.len());
        for (i, node) in scene.nodes.iter().enumerate() {
            let mut value = json!({ "name": one_line(&node.name) });
            if node.translation != DVec3::ZERO {
                value["translation"] = json!(singles(node.translation.to_array(), &node.name)?);
            }
            if node.rotation != DQuat::IDENTITY {
                value["rotation"] = json!(singles(node.rotation.to_array(), &node.name)?);
            }
            if !node.extras.is_empty() {
                value["extras"] = extras(&node.extras);
            }
            if let Some(surface) = &node.surface {
                value["mesh"] = json!(self.mesh(surface, &node.name)?);
            }
            if !children[i].is_empty() {
                value["children"] = json!(children[i]);
            }
            nodes.push(value);
        }
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let mut all = json!({
            "name": "millimetres, z up", "rotation": [-half, 0.0, 0.0, half],
            "scale": [0.001_f32, 0.001_f32, 0.001_f32]
        });
        if let Some(roots) = children.last().filter(|roots| !roots.is_empty()) {
            all["children"] = json!(roots);
        }
        nodes.push(all);
        Ok(nodes)
    }

    fn mesh(&mut self, surface: &GlbSurface, name: &str) -> Result<usize, IoError> {
        let mut numbers = Vec::with_capacity(surface.points.len());
        for p in &surface.points {
            numbers.push(singles(p.to_array(), name)?);
        }
        let points = self.floats(&numbers, "VEC3", Some(34962));
        let mut primitives = Vec::new();
        let parts = [
            (TRIANGLES, surface.triangles.as_flattened(), surface.material),
            (LINES, surface.lines.as_flattened(), surface.line_material),
        ];
        for (mode, places, material) in
            parts.into_iter().filter(|(_, places, _)| !places.is_empty())
        {
            let indices = self.indices(places);
            let mut primitive =
                json!({ "attributes": { "POSITION": points }, "indices": indices, "mode": mode });
            if let Some(material) = material {
                primitive["material"] = json!(material.0);
            }
            primitives.push(primitive);
        }
        self.meshes.push(json!({ "name": one_line(name), "primitives": primitives }));
        Ok(self.meshes.len() - 1)
    }

    fn animation(&mut self, scene: &GlbScene) -> Result<Option<Value>, IoError> {
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        for track in &scene.tracks {
            let name = &scene.nodes[track.node.0].name;
            let input = self.moments(&track.times, name)?;
            let (output, path) = match &track.values {
                GlbValues::Rotations(values) => {
                    let numbers = values
                        .iter()
                        .map(|q| singles(q.to_array(), name))
                        .collect::<Result<Vec<_>, _>>()?;
                    (self.floats(&numbers, "VEC4", None), "rotation")
                }
                GlbValues::Translations(values) => {
                    let numbers = values
                        .iter()
                        .map(|p| singles(p.to_array(), name))
                        .collect::<Result<Vec<_>, _>>()?;
                    (self.floats(&numbers, "VEC3", None), "translation")
                }
            };
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": track.node.0, "path": path } }));
            samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        }
        let animation =
            json!({ "name": one_line(&scene.name), "channels": channels, "samplers": samplers });
        Ok((!channels.is_empty()).then_some(animation))
    }

    fn moments(&mut self, times: &[f64], name: &str) -> Result<usize, IoError> {
        let numbers = times.iter().map(|&t| singles([t], name)).collect::<Result<Vec<_>, _>>()?;
        let key: Vec<u32> = numbers.iter().map(|t| t[0].to_bits()).collect();
        if let Some(&known) = self.times.get(&key) {
            return Ok(known);
        }
        let accessor = self.floats(&numbers, "SCALAR", None);
        self.times.insert(key, accessor);
        Ok(accessor)
    }

    /// An accessor with its bounds.
    fn floats<const N: usize>(
        &mut self,
        numbers: &[[f32; N]],
        kind: &str,
        target: Option<u32>,
    ) -> usize {
        let view = self.view(numbers.as_flattened().iter().flat_map(|x| x.to_le_bytes()), target);
        let bound = |pick: fn(f32, f32) -> f32| {
            let all =
                numbers.iter().copied().reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i])));
            all.map_or_else(Vec::new, |bound| bound.to_vec())
        };
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": numbers.len(), "type": kind,
            "min": bound(f32::min), "max": bound(f32::max),
        }));
        self.accessors.len() - 1
    }

    fn indices(&mut self, places: &[u32]) -> usize {
        let view = self.view(places.iter().flat_map(|i| i.to_le_bytes()), Some(34963));
        let accessor = json!({
            "bufferView": view, "componentType": UNSIGNED, "count": places.len(), "type": "SCALAR",
        });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// All our numbers have four bytes, so that every view begins at a whole word.
    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view =
            json!({ "buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }
}

fn singles<const N: usize>(numbers: [f64; N], name: &str) -> Result<[f32; N], IoError> {
    let single = numbers.map(|x| x as f32);
    if single.iter().all(|x| x.is_finite()) {
        Ok(single)
    } else {
        Err(IoError::TooFarForGlb { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle on an arm that turns.
    fn scene() -> GlbScene {
        let mut scene = GlbScene::new("arm");
        let red = scene.add_material("red", [255, 0, 0], 1.0);
        let glass = scene.add_material("glass", [200, 220, 230], 0.4);
        let node = |name: &str, parent, surface| GlbNode {
            name: name.to_owned(),
            parent,
            translation: DVec3::new(0.0, 5.0, 0.0),
            rotation: DQuat::IDENTITY,
            surface,
            extras: vec![
                ("id", GlbExtra::Text(name.to_owned())),
                ("mitres", GlbExtra::Numbers(vec![20.5, -3.0])),
                ("mass", GlbExtra::Number(0.25)),
            ],
        };
        let arm = scene.add_node(node("arm", None, None));
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let surface = GlbSurface {
            points,
            triangles: vec![[0, 1, 2]],
            material: Some(red),
            lines: vec![[0, 1], [1, 2]],
            line_material: Some(glass),
        };
        let hand = scene.add_node(node("hand", Some(arm), Some(surface)));
        let turns = vec![DQuat::IDENTITY, DQuat::from_rotation_x(1.0)];
        scene.add_track(GlbTrack {
            node: hand,
            times: vec![0.0, 2.0],
            values: GlbValues::Rotations(turns),
        });
        let places = vec![DVec3::ZERO, DVec3::Z];
        scene.add_track(GlbTrack {
            node: arm,
            times: vec![0.0, 2.0],
            values: GlbValues::Translations(places),
        });
        scene
    }

    fn chunks(file: &[u8]) -> (Value, &[u8]) {
        let word = |at: usize| {
            u32::from_le_bytes([file[at], file[at + 1], file[at + 2], file[at + 3]]) as usize
        };
        assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
        let text = word(12);
        assert_eq!((text % 4, &file[16..20]), (0, &b"JSON"[..]));
        let rest = 20 + text;
        assert_eq!((word(rest), &file[rest + 4..rest + 8]), (file.len() - rest - 8, &b"BIN\0"[..]));
        (serde_json::from_slice(&file[20..rest]).expect("JSON"), &file[rest + 8..])
    }

    #[test]
    fn the_file_holds_the_tree_the_colours_and_the_movements() {
        let file = glb_bytes(&scene(), "kerfold test\n").expect("small numbers");
        let (root, bytes) = chunks(&file);
        assert_eq!(root["asset"]["extras"]["command"], "kerfold test ");
        assert_eq!(root["scenes"][0]["nodes"], json!([2]));
        assert_eq!(root["nodes"][2]["children"], json!([0]));
        assert_eq!(root["nodes"][0]["children"], json!([1]));
        assert_eq!(root["nodes"][1]["translation"], json!([0.0, 5.0, 0.0]));
        let extras = json!({ "id": "hand", "mass": 0.25, "mitres": [20.5, -3.0] });
        assert_eq!(root["nodes"][1]["extras"], extras);
        assert_eq!(root["meshes"][0]["primitives"].as_array().map(Vec::len), Some(2));
        assert_eq!(
            root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"],
            json!([1.0, 0.0, 0.0, 1.0])
        );
        assert_eq!(root["materials"][1]["alphaMode"], "BLEND");
        assert_eq!(root["accessors"][0]["max"], json!([1.0, 1.0, 0.0]));
        let samplers = root["animations"][0]["samplers"].as_array().expect("samplers");
        assert_eq!(samplers[0]["input"], samplers[1]["input"], "equal moments are written once");
        assert_eq!(root["buffers"][0]["byteLength"], json!(bytes.len()));
        for (view, accessor) in root["bufferViews"]
            .as_array()
            .into_iter()
            .flatten()
            .zip(root["accessors"].as_array().into_iter().flatten())
        {
            let wide = match accessor["type"].as_str() {
                Some("SCALAR") => 4,
                Some("VEC3") => 12,
                _ => 16,
            };
            assert_eq!(
                view["byteLength"],
                json!(wide * accessor["count"].as_u64().expect("a count"))
            );
        }
    }

    #[test]
    fn an_empty_scene_has_no_empty_lists_and_far_numbers_are_told() {
        let file = glb_bytes(&GlbScene::new(""), "kerfold").expect("nothing to write");
        let text = String::from_utf8_lossy(&file[20..]).into_owned();
        assert!(!text.contains("[]"), "{text}");
        let mut far = scene();
        far.nodes[1].translation.x = 1e300;
        let error = glb_bytes(&far, "kerfold").expect_err("too far");
        assert!(error.to_string().contains("hand"), "{error}");
    }
}
