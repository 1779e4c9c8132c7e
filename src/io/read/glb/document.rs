//! The JSON of a glTF file, as much of it as makes triangles.

use std::collections::HashMap;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::broken;
use crate::io::error::ContentFault;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Document {
    pub scene: Option<usize>,
    pub scenes: Vec<Scene>,
    pub nodes: Vec<Node>,
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Named>,
    pub accessors: Vec<Accessor>,
    pub buffer_views: Vec<View>,
    pub buffers: Vec<Buffer>,
    pub animations: Vec<IgnoredAny>,
    extensions_required: Vec<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub name: Option<String>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub children: Vec<usize>,
    pub matrix: Option<Vec<f64>>,
    pub translation: Option<Vec<f64>>,
    pub rotation: Option<Vec<f64>>,
    pub scale: Option<Vec<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Primitive {
    pub attributes: HashMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    pub targets: Vec<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Named {
    pub name: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
}

/// Extensions that change looks alone, by how their names begin, and one that is read.
const HARMLESS: [&str; 9] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "MSFT_packing_",
    "KHR_lights_",
    "KHR_xmp",
    "KHR_animation_",
    "KHR_mesh_quantization",
];

impl Document {
    pub fn parse(text: &[u8]) -> Result<Self, ContentFault> {
        let document: Self = serde_json::from_slice(text)
            .map_err(|error| broken(format!("its JSON cannot be read ({error})")))?;
        let is_unknown = |name: &&String| !HARMLESS.iter().any(|start| name.starts_with(start));
        match document.extensions_required.iter().find(is_unknown) {
            Some(name) => Err(ContentFault::NeedsExtension {
                format: "GLB",
                name: crate::io::error::excerpt(name.as_bytes()),
            }),
            None => Ok(document),
        }
    }

    /// The nodes of the scene that is shown; without scenes all that hang on no other.
    pub fn roots(&self) -> Result<Vec<usize>, ContentFault> {
        let number = self.scene.unwrap_or(0);
        match self.scenes.get(number) {
            Some(scene) => Ok(scene.nodes.clone()),
            None if self.scene.is_some() => Err(broken(format!("scene {number} is not there"))),
            None => {
                let mut is_root = vec![true; self.nodes.len()];
                for &child in self.nodes.iter().flat_map(|node| &node.children) {
                    if let Some(is_root) = is_root.get_mut(child) {
                        *is_root = false;
                    }
                }
                Ok((0..self.nodes.len()).filter(|&node| is_root[node]).collect())
            }
        }
    }
}
