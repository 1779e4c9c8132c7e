//! Plates as meshes: OBJ with a group for each panel and the colours beside it, STL, and GLB with
//! names, colours and lettering.

use std::io::Write as _;

use glam::{DQuat, DVec2, DVec3};

use super::glb::{GlbExtra, GlbNode, GlbScene, GlbSurface, glb_bytes};
use super::one_line;
use crate::io::error::IoError;
use crate::panel::{PanelRow, Plate, Solid, label_room};
use crate::sheet::lettering;

/// A plate with its name, its body and the number of its group of congruent panels.
#[derive(Debug, Clone)]
pub struct NamedPlate<'a> {
    /// Its name, as `P01`.
    pub name: String,
    /// Decides its colour.
    pub group: usize,
    /// The plate.
    pub plate: &'a Plate,
    /// Its body, which is closed.
    pub body: &'a Solid,
    /// What the schedule says of it, for the `extras` of GLB.
    pub row: Option<&'a PanelRow>,
}

/// The name of the colours' file, which an OBJ of plates names.
pub const PLATES_MTL: &str = "plates.mtl";

/// An OBJ with a group for each plate. Faces stay polygons where they are convex and without holes,
/// else they are triangles. Its colours stand in a file of the name [`PLATES_MTL`] beside it
/// ([`plates_mtl`]).
///
/// # Example
/// ```
/// use kerfold::io::plates::{NamedPlate, plates_obj};
/// use kerfold::panel::{PanelParams, plates, solid};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let bodies: Vec<_> = made.plates.iter().map(solid).collect::<Result<_, _>>()?;
/// let parts = made.plates.iter().zip(&bodies);
/// let named = |(plate, body)| NamedPlate { name: "side".to_owned(), group: 0, plate, body, row: None };
/// let parts: Vec<NamedPlate> = parts.map(named).collect();
/// let bytes = plates_obj(&parts, "my program");
/// assert!(bytes.windows(6).any(|w| w == b"g side"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plates_obj(plates: &[NamedPlate<'_>], command: &str) -> Vec<u8> {
    let mut text = Vec::new();
    write_obj(&mut text, plates, command).expect("writing into memory does not fail");
    text
}

fn write_obj(text: &mut Vec<u8>, plates: &[NamedPlate<'_>], command: &str) -> std::io::Result<()> {
    writeln!(text, "# {}", one_line(command))?;
    writeln!(text, "mtllib {PLATES_MTL}")?;
    let mut before = 1;
    for named in plates {
        let body = named.body;
        writeln!(text, "g {}", named.name)?;
        writeln!(text, "usemtl {}", material(named.group))?;
        for p in &body.points {
            writeln!(text, "v {} {} {}", p.x, p.y, p.z)?;
        }
        for face in &body.faces {
            if face.is_convex {
                write_polygon(text, &face.outline, before)?;
            } else {
                face.triangles.iter().try_for_each(|t| write_polygon(text, t, before))?;
            }
        }
        before += body.points.len() as u32;
    }
    Ok(())
}

/// The material of a group of congruent panels, of which there are as many as colours.
fn material(group: usize) -> String {
    format!("colour-{}", group % COLOURS.len() + 1)
}

/// How many colours the plates take.
fn colours_of(plates: &[NamedPlate<'_>]) -> usize {
    plates.iter().map(|p| p.group + 1).max().unwrap_or(0).min(COLOURS.len())
}

/// The colours of an OBJ of the same plates, one for each group of congruent panels.
///
/// # Example
/// ```
/// use kerfold::io::plates::plates_mtl;
///
/// assert_eq!(plates_mtl(&[], "my program"), b"# my program\n");
/// ```
pub fn plates_mtl(plates: &[NamedPlate<'_>], command: &str) -> Vec<u8> {
    let mut text = format!("# {}\n", one_line(command));
    for (group, colour) in COLOURS.iter().enumerate().take(colours_of(plates)) {
        let [r, g, b] = colour.map(|value| (f64::from(value) / 2.55).round() / 100.0);
        // Diffuse colour alone, nothing that shines or is see-through.
        text += &format!("newmtl {}\nKd {r} {g} {b}\nd 1\nillum 1\n", material(group));
    }
    text.into_bytes()
}

/// A face of corners that are numbered from `first`.
fn write_polygon(text: &mut Vec<u8>, corners: &[u32], first: u32) -> std::io::Result<()> {
    text.push(b'f');
    corners.iter().try_for_each(|corner| write!(text, " {}", corner + first))?;
    text.push(b'\n');
    Ok(())
}

const STL_HEADER: usize = 80;

/// A binary STL of all plates.
///
/// # Errors
/// [`IoError::TooFarForStl`] when a coordinate does not fit into single precision.
///
/// # Example
/// ```
/// use kerfold::io::plates::{NamedPlate, plates_stl};
/// use kerfold::panel::{PanelParams, plates, solid};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let bodies: Vec<_> = made.plates.iter().map(solid).collect::<Result<_, _>>()?;
/// let parts = made.plates.iter().zip(&bodies);
/// let named = |(plate, body)| NamedPlate { name: "side".to_owned(), group: 0, plate, body, row: None };
/// let parts: Vec<NamedPlate> = parts.map(named).collect();
/// let bytes = plates_stl(&parts, "my program")?;
/// assert!(bytes.len() > 84);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plates_stl(plates: &[NamedPlate<'_>], command: &str) -> Result<Vec<u8>, IoError> {
    let mut bytes: Vec<u8> = one_line(command).bytes().take(STL_HEADER).collect();
    // A header that begins with `solid` is taken for a text file.
    if bytes.starts_with(b"solid") {
        bytes[0] = b'S';
    }
    bytes.resize(STL_HEADER + 4, b' ');
    let mut count: u32 = 0;
    for named in plates {
        let body = named.body;
        if let Some(vertex) = body.points.iter().position(|p| !p.as_vec3().is_finite()) {
            return Err(IoError::TooFarForStl { vertex });
        }
        for face in &body.faces {
            for triangle in &face.triangles {
                count += 1;
                let corners = triangle.map(|i| body.points[i as usize]);
                for p in std::iter::once(face.normal).chain(corners) {
                    bytes.extend(p.as_vec3().to_array().into_iter().flat_map(f32::to_le_bytes));
                }
                bytes.extend([0; 2]);
            }
        }
    }
    bytes[STL_HEADER..STL_HEADER + 4].copy_from_slice(&count.to_le_bytes());
    Ok(bytes)
}

/// Colours that are told apart; groups of congruent panels take them in turn.
pub(super) const COLOURS: [[u8; 3]; 12] = [
    [141, 188, 216],
    [244, 190, 120],
    [163, 207, 142],
    [229, 150, 150],
    [190, 170, 214],
    [214, 194, 150],
    [150, 210, 200],
    [240, 214, 130],
    [200, 160, 180],
    [170, 190, 240],
    [205, 220, 160],
    [180, 180, 180],
];

/// A GLB with a node for each plate: its name, the colour of its group, its edges, its name lettered
/// on the front, and in its `extras` what the schedule says of it, in the words and units of
/// `panels.json`.
///
/// # Errors
/// [`IoError`] when a number does not fit into single precision.
///
/// # Example
/// ```
/// use kerfold::io::plates::{NamedPlate, plates_glb};
/// use kerfold::panel::{PanelParams, plates, solid};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let bodies: Vec<_> = made.plates.iter().map(solid).collect::<Result<_, _>>()?;
/// let parts = made.plates.iter().zip(&bodies);
/// let named = |(plate, body)| NamedPlate { name: "side".to_owned(), group: 0, plate, body, row: None };
/// let parts: Vec<NamedPlate> = parts.map(named).collect();
/// let bytes = plates_glb(&parts, "my program")?;
/// assert!(bytes.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plates_glb(plates: &[NamedPlate<'_>], command: &str) -> Result<Vec<u8>, IoError> {
    let mut scene = GlbScene::new("panels");
    let colours: Vec<_> = (0..colours_of(plates))
        .map(|i| scene.add_material(format!("colour {}", i + 1), COLOURS[i], 1.0))
        .collect();
    let ink = scene.add_material("lines", [40, 40, 40], 1.0);
    for named in plates {
        // Every node stands where its plate does, so that single precision has its digits for the
        // plate.
        let origin = named.plate.frame.origin;
        let mut surface = GlbSurface {
            material: colours.get(named.group % COLOURS.len()).copied(),
            ..GlbSurface::default()
        };
        surface.points = named.body.points.iter().map(|&p| p - origin).collect();
        let faces = &named.body.faces;
        surface.triangles = faces.iter().flat_map(|face| &face.triangles).copied().collect();
        surface.lines = outlines(named);
        letter(&mut surface, named, origin);
        surface.line_material = Some(ink);
        scene.add_node(GlbNode {
            name: named.name.clone(),
            parent: None,
            translation: origin,
            rotation: DQuat::IDENTITY,
            surface: Some(surface),
            extras: named.row.map(extras).unwrap_or_default(),
        });
    }
    glb_bytes(&scene, command)
}

/// The keys of `panels.json` that say what a plate is, whatever becomes of it.
fn extras(row: &PanelRow) -> Vec<(&'static str, GlbExtra)> {
    use GlbExtra::{Number, Numbers, Text};
    let layer = row.layer.clone().map(|layer| ("layer", Text(layer)));
    let facts = [
        ("id", Text(row.id.to_string())),
        ("face", Number(row.face as f64)),
        ("thickness", Number(row.thickness)),
        ("area", Number(row.area)),
        ("volume", Number(row.volume)),
        ("mass", Number(row.mass)),
        ("mitres", Numbers(row.bevels.clone())),
        ("side_lengths", Numbers(row.sides.clone())),
    ];
    facts.into_iter().chain(layer).collect()
}

/// The edges of a plate: those of front and back with their holes, and between the corners of both.
fn outlines(named: &NamedPlate<'_>) -> Vec<[u32; 2]> {
    let caps = named.body.faces.iter().take(2);
    let loops = caps.flat_map(|face| std::iter::once(&face.outline).chain(&face.holes));
    let along = loops.flat_map(|l| (0..l.len()).map(|i| [l[i], l[(i + 1) % l.len()]]));
    let n = named.plate.front.len() as u32;
    along.chain((0..n).map(|i| [i, n + i])).collect()
}

/// The share of the free room on the front that the name takes, and how far it floats above the
/// front, relative to its height.
const NAME_SHARE: f64 = 0.5;
const FLOAT: f64 = 0.02;

/// What is up for somebody who reads a plate from outside, as in the views of the assembly map: the
/// sky, and for plates that rather lie than stand what is away from the front.
fn upwards(normal: DVec3) -> DVec3 {
    let lies = normal.z.abs() >= normal.x.abs().max(normal.y.abs());
    if lies { DVec3::Y * normal.z.signum() } else { DVec3::Z }
}

fn letter(surface: &mut GlbSurface, named: &NamedPlate<'_>, origin: DVec3) {
    let frame = &named.plate.frame;
    let up = upwards(frame.normal);
    let up = DVec2::new(up.dot(frame.x), up.dot(frame.y)).normalize_or(DVec2::Y);
    let right = -up.perp();
    let turned: Vec<DVec2> =
        named.plate.inner.iter().map(|p| DVec2::new(p.dot(right), p.dot(up))).collect();
    let (at, room) = label_room(&turned);
    let Ok(unit) = lettering(&named.name, 1.0) else { return };
    let size = unit.high - unit.low;
    let height = NAME_SHARE * (room.x / size.x).min(room.y / size.y);
    if !(height > 0.0 && height.is_finite()) {
        return;
    }
    let middle = unit.low.midpoint(unit.high);
    for stroke in &unit.strokes {
        let first = surface.points.len() as u32;
        let lifted = |&p: &DVec2| {
            let p = at + (p - middle) * height;
            named.plate.on_front(right * p.x + up * p.y) + frame.normal * (FLOAT * height) - origin
        };
        surface.points.extend(stroke.iter().map(lifted));
        surface.lines.extend((first..first + stroke.len() as u32 - 1).map(|i| [i, i + 1]));
    }
}
