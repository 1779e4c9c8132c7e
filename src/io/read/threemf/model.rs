//! A part of a 3MF file that holds objects.

use std::collections::HashMap;

use glam::{DMat4, DVec3};
use roxmltree::{Document, Node, ParsingOptions};

use super::broken;
use crate::io::error::{ContentFault, excerpt};
use crate::io::read::raw::OwnUnit;

const PRODUCTION: &str = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
const MATERIALS: &str = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
const BEAMS: &str = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
/// Elements of a part; more would be no model but a bomb.
const MOST_NODES: u32 = 16_000_000;

/// Units by name.
const UNITS: [(&str, OwnUnit); 6] = [
    ("micron", OwnUnit { name: "micron", mm: 0.001 }),
    ("millimeter", OwnUnit { name: "mm", mm: 1.0 }),
    ("centimeter", OwnUnit { name: "cm", mm: 10.0 }),
    ("inch", OwnUnit { name: "in", mm: 25.4 }),
    ("foot", OwnUnit { name: "ft", mm: 304.8 }),
    ("meter", OwnUnit { name: "m", mm: 1000.0 }),
];

pub(super) struct Model {
    pub unit: OwnUnit,
    pub objects: HashMap<u32, Object>,
    pub items: Vec<Placed>,
}

/// An object with triangles, or with components, or with both.
#[derive(Default)]
pub(super) struct Object {
    pub name: Option<String>,
    /// Supports and the like, which are not to be built.
    pub is_extra: bool,
    pub has_beams: bool,
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Which material begins with which triangle.
    pub runs: Vec<MaterialRun>,
    pub components: Vec<Placed>,
}

pub(super) struct MaterialRun {
    pub first: usize,
    pub material: Option<String>,
}

/// An object by its number, in its place.
#[derive(Clone)]
pub(super) struct Placed {
    pub path: Option<String>,
    pub object: u32,
    pub transform: DMat4,
}

impl Object {
    /// Vertices and corners.
    pub fn size(&self) -> usize {
        self.positions.len() + 3 * self.triangles.len()
    }
}

impl Model {
    pub fn parse(text: &str, path: &str) -> Result<Self, ContentFault> {
        let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options)
            .map_err(|error| broken(format!("{path} is no XML that can be read ({error})")))?;
        let root = document.root_element();
        if root.tag_name().name() != "model" {
            return Err(broken(format!("{path} is no model")));
        }
        check_extensions(root)?;
        let named = root.attribute("unit").unwrap_or("millimeter");
        let unit = UNITS.iter().find(|(name, _)| *name == named).map(|&(_, unit)| unit);
        let unit = unit.ok_or_else(|| {
            broken(format!("its unit `{}` is not known", excerpt(named.as_bytes())))
        })?;
        let mut objects = HashMap::new();
        let resources: Vec<Node<'_, '_>> = child(root, "resources").collect();
        let materials = Materials::of(&resources);
        for node in resources.iter().flat_map(|resources| child(*resources, "object")) {
            let id: u32 = number(node, "id")?;
            objects.insert(id, object(node, id, &materials)?);
        }
        let items = child(root, "build").flat_map(|build| child(build, "item"));
        let items = items.map(placed).collect::<Result<_, _>>()?;
        Ok(Self { unit, objects, items })
    }
}

fn check_extensions(root: Node<'_, '_>) -> Result<(), ContentFault> {
    for prefix in root.attribute("requiredextensions").unwrap_or_default().split_whitespace() {
        let name = root.lookup_namespace_uri(Some(prefix)).unwrap_or(prefix);
        if ![PRODUCTION, MATERIALS, BEAMS].contains(&name) {
            let name =
                excerpt(name.rsplit_once("3dmanufacturing/").map_or(name, |n| n.1).as_bytes());
            return Err(ContentFault::NeedsExtension { format: "3MF", name });
        }
    }
    Ok(())
}

/// Names of materials by their group and place in it.
struct Materials(HashMap<(u32, u32), String>);

impl Materials {
    fn of(resources: &[Node<'_, '_>]) -> Self {
        let mut names = HashMap::new();
        for group in resources.iter().flat_map(|resources| child(*resources, "basematerials")) {
            let Ok(id) = number(group, "id") else { continue };
            for (place, base) in (0..).zip(child(group, "base")) {
                if let Some(name) = text(base, "name") {
                    names.insert((id, place), name);
                }
            }
        }
        Self(names)
    }

    fn name(&self, group: Option<u32>, place: Option<u32>) -> Option<&String> {
        self.0.get(&(group?, place.unwrap_or(0)))
    }
}

fn object(node: Node<'_, '_>, id: u32, materials: &Materials) -> Result<Object, ContentFault> {
    let is_extra = matches!(node.attribute("type"), Some("support" | "solidsupport" | "other"));
    let mut object = Object { name: text(node, "name"), is_extra, ..Object::default() };
    let components = child(node, "components").flat_map(|list| child(list, "component"));
    object.components = components.map(placed).collect::<Result<_, _>>()?;
    let Some(mesh) = child(node, "mesh").next() else { return Ok(object) };
    object.has_beams = child(mesh, "beamlattice").next().is_some();
    for (v, vertex) in child(mesh, "vertices").flat_map(|list| child(list, "vertex")).enumerate() {
        let coordinate = |name| {
            let value = vertex.attribute(name).and_then(|value| value.trim().parse::<f64>().ok());
            value.ok_or_else(|| broken(format!("vertex {v} of object {id} has no number {name}")))
        };
        object.positions.push(DVec3::new(coordinate("x")?, coordinate("y")?, coordinate("z")?));
    }
    let own = [optional(node, "pid"), optional(node, "pindex")];
    let count = object.positions.len();
    let mut last: Option<Option<&String>> = None;
    let triangles = child(mesh, "triangles").flat_map(|list| child(list, "triangle"));
    for (t, triangle) in triangles.enumerate() {
        let corner = |name| {
            let vertex = optional(triangle, name).filter(|&vertex| (vertex as usize) < count);
            vertex.ok_or_else(|| {
                let text = excerpt(triangle.attribute(name).unwrap_or_default().as_bytes());
                broken(format!(
                    "triangle {t} of object {id} names vertex `{text}` of {count}, counted from 0"
                ))
            })
        };
        object.triangles.push([corner("v1")?, corner("v2")?, corner("v3")?]);
        let [group, place] = match optional(triangle, "pid") {
            Some(group) => [Some(group), optional(triangle, "p1")],
            None => [own[0], optional(triangle, "p1").or(own[1])],
        };
        let material = materials.name(group, place);
        if last != Some(material) {
            last = Some(material);
            object.runs.push(MaterialRun { first: t, material: material.cloned() });
        }
    }
    Ok(object)
}

fn placed(node: Node<'_, '_>) -> Result<Placed, ContentFault> {
    let path = node.attribute((PRODUCTION, "path")).map(|p| p.trim_start_matches('/').to_owned());
    let object = number(node, "objectid")?;
    let Some(text) = node.attribute("transform") else {
        return Ok(Placed { path, object, transform: DMat4::IDENTITY });
    };
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|n| n.parse().ok()).collect();
    let numbers = numbers.and_then(|numbers| <[f64; 12]>::try_from(numbers).ok());
    let n =
        numbers.ok_or_else(|| broken(format!("a place of object {object} is not 12 numbers")))?;
    // Rows of the file are columns here.
    let column = |i: usize, w: f64| DVec3::new(n[3 * i], n[3 * i + 1], n[3 * i + 2]).extend(w);
    let transform =
        DMat4::from_cols(column(0, 0.0), column(1, 0.0), column(2, 0.0), column(3, 1.0));
    Ok(Placed { path, object, transform })
}

/// Children of a name, whatever prefix they have.
fn child<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> + 'a {
    node.children().filter(move |node| node.is_element() && node.tag_name().name() == name)
}

fn text(node: Node<'_, '_>, name: &str) -> Option<String> {
    let text = node.attribute(name)?.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn optional(node: Node<'_, '_>, name: &str) -> Option<u32> {
    node.attribute(name)?.trim().parse().ok()
}

fn number(node: Node<'_, '_>, name: &str) -> Result<u32, ContentFault> {
    let tag = node.tag_name().name();
    optional(node, name).ok_or_else(|| broken(format!("a `{tag}` has no number `{name}`")))
}
