//! The schedule: panels, edges and nodes as a fabricator lists them, in millimetres, degrees and
//! kilograms.

use std::collections::BTreeMap;

use glam::DVec3;

use super::cut::{EdgeCut, EdgeFallback};
use super::error::PanelError;
use super::node::Node;
use super::params::PanelParams;
use super::plate::{Plate, Plates};
use super::rule::EdgeKind;
use super::twins::{Twin, twins};
use crate::geom::Frame;
use crate::geom::polygon::{signed_area, smallest_rectangle};
use crate::measure::{edge_length, planarity};
use crate::mesh::{EdgeId, FaceMap, HalfEdgeId, Mesh, VertexId};
use crate::net::PieceId;
use crate::progress::Progress;

/// Cuts nearer to square than this, in degrees, are square: no saw is set finer.
const SQUARE: f64 = 0.01;

/// A whole schedule.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Schedule {
    /// One row for each panel.
    pub panels: Vec<PanelRow>,
    /// One row for each edge.
    pub edges: Vec<EdgeRow>,
    /// One row for each node.
    pub nodes: Vec<NodeRow>,
    /// The cutting list: one row for each group of congruent panels, in the order of their first.
    pub groups: Vec<GroupRow>,
    /// Sums over everything.
    pub totals: Totals,
}

/// A panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelRow {
    /// Its name, as on the sheets.
    pub id: PieceId,
    /// The face in the mesh file.
    pub face: usize,
    /// The group of the face in the file.
    pub layer: Option<String>,
    /// The number of its group of congruent panels, from 0.
    pub group: usize,
    /// Whether it is a mirror image of the first panel of the group.
    pub is_mirrored: bool,
    /// How many panels the group has, mirror images with them.
    pub copies: usize,
    /// In mm.
    pub thickness: f64,
    /// Of the front, holes taken off, in mm².
    pub area: f64,
    /// Of the blank, in mm².
    pub blank_area: f64,
    /// In mm³.
    pub volume: f64,
    /// In kg.
    pub mass: f64,
    /// Length and width of the smallest box around the blank, in mm.
    pub size: [f64; 2],
    /// Lengths of the sides at the front, in mm; side i begins at vertex i of the face.
    pub sides: Vec<f64>,
    /// Interior angles at the vertices, in degrees.
    pub angles: Vec<f64>,
    /// The cut of each side in degrees off square, positive where the front is longer.
    pub bevels: Vec<f64>,
    /// The edges along the sides.
    pub edges: Vec<EdgeId>,
    /// Largest distance of a vertex from the face's best plane, in mm.
    pub planarity: f64,
    /// Whether it has a reflex corner.
    pub is_concave: bool,
    /// Around the blank, in mm.
    pub perimeter: f64,
    /// How much of that is cut at an angle: the edge work, in mm.
    pub bevelled: f64,
    /// Number of holes.
    pub holes: usize,
    /// Where its front goes in space.
    pub frame: Frame,
}

/// Which way an edge bends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EdgeShape {
    /// Outwards.
    Convex,
    /// Inwards.
    Concave,
    /// Not at all.
    Flat,
    /// It has one panel only.
    Rim,
}

impl EdgeShape {
    /// The word in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Convex => "convex",
            Self::Concave => "concave",
            Self::Flat => "flat",
            Self::Rim => "rim",
        }
    }
}

/// An edge.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeRow {
    /// The edge.
    pub id: EdgeId,
    /// Its vertices.
    pub nodes: [VertexId; 2],
    /// The panels on its two sides; `None` at a rim.
    pub panels: [Option<PieceId>; 2],
    /// On the model, in mm.
    pub length: f64,
    /// Between the two panels, inside, in degrees.
    pub dihedral: Option<f64>,
    /// The mitre of each panel in degrees off square, positive where the front is longer.
    pub mitres: [Option<f64>; 2],
    /// Which way it bends.
    pub shape: EdgeShape,
    /// The joint.
    pub kind: EdgeKind,
    /// What it should have been, and why it is not.
    pub fallback: Option<(EdgeKind, EdgeFallback)>,
    /// Distance between the panels at front and back, in mm; the larger one is the V-gap of square
    /// cuts.
    pub opening: Option<[f64; 2]>,
    /// Whether plates of different thickness step there.
    pub is_stepped: bool,
}

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeRow {
    /// The vertex, its meeting points, axis and residual.
    pub node: Node,
    /// Where the vertex is.
    pub position: DVec3,
    /// Its edges, counter-clockwise from outside.
    pub edges: Vec<EdgeId>,
    /// The angle from each of these edges to the next one, in degrees; 0 across a rim.
    pub angles: Vec<f64>,
    /// The angle of each edge with the axis, in degrees.
    pub tilts: Vec<f64>,
}

/// Congruent panels: a row of the cutting list.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupRow {
    /// Its number, from 0, shown as `G001`.
    pub number: usize,
    /// Its first panel.
    pub first: PieceId,
    /// Panels like the first.
    pub copies: usize,
    /// Mirror images of it.
    pub mirrored: usize,
    /// Whether a mirror image is the same part turned over: cut square, front and back alike.
    pub turns_over: bool,
    /// All of them.
    pub panels: Vec<PieceId>,
}

/// Sums.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// Of all fronts, in mm².
    pub area: f64,
    /// In kg.
    pub mass: f64,
    /// Around all blanks, in mm.
    pub perimeter: f64,
    /// Cut at an angle, in mm.
    pub bevelled: f64,
    /// The largest residual of a node, in mm per mm.
    pub residual: f64,
    /// The largest miss of a node, in mm.
    pub miss_mm: f64,
    /// Nodes with more than three edges.
    pub nodes_above_three: usize,
}

/// Lists everything.
///
/// # Errors
/// [`PanelError::Cancelled`].
pub fn schedule(
    mesh: &Mesh,
    plates: &Plates,
    params: &PanelParams,
    progress: &dyn Progress,
) -> Result<Schedule, PanelError> {
    let mut index = FaceMap::filled(mesh.face_slots(), usize::MAX);
    plates.plates.iter().enumerate().for_each(|(i, plate)| index[plate.face] = i);
    let mut panels: Vec<PanelRow> =
        plates.plates.iter().enumerate().map(|(i, plate)| panel(mesh, i, plate, params)).collect();
    let twins = twins(&plates.plates, params.tolerance.mm(), progress)?;
    let groups = groups(plates, params, twins, &mut panels);
    let edges = plates.edges.iter().map(|cut| edge(mesh, plates, cut, &index)).collect();
    let nodes: Vec<NodeRow> = plates.nodes.iter().map(|n| node(mesh, n)).collect();
    let sum = |of: fn(&PanelRow) -> f64| panels.iter().map(of).sum();
    let most = |of: fn(&NodeRow) -> f64| nodes.iter().map(of).fold(0.0, f64::max);
    let totals = Totals {
        area: sum(|p| p.area),
        mass: sum(|p| p.mass),
        perimeter: sum(|p| p.perimeter),
        bevelled: sum(|p| p.bevelled),
        residual: most(|n| n.node.residual),
        miss_mm: most(|n| n.node.miss_mm),
        nodes_above_three: nodes.iter().filter(|n| n.node.valence > 3).count(),
    };
    Ok(Schedule { panels, edges, nodes, groups, totals })
}

fn panel(mesh: &Mesh, i: usize, plate: &Plate, params: &PanelParams) -> PanelRow {
    let n = plate.half_edges.len();
    let corner = |i: usize| plate.reference[i % n];
    let angle = |i: usize| {
        let (back, along) = (corner(i + n - 1) - corner(i), corner(i + 1) - corner(i));
        along.perp_dot(back).atan2(along.dot(back)).to_degrees().rem_euclid(360.0)
    };
    let sides: Vec<f64> = (0..n).map(|i| plate.front_side(i)).map(|[a, b]| a.distance(b)).collect();
    let bevels: Vec<f64> = (0..n).map(|i| bevel(plate, i)).collect();
    let m = plate.blank.len();
    let volume = plate.volume();
    let blank_side = |i: usize| plate.blank[plate.begins[i]].distance(plate.blank[plate.ends[i]]);
    PanelRow {
        id: PieceId(i),
        face: plate.face.index(),
        layer: mesh.group(plate.face).map(str::to_owned),
        group: 0,
        is_mirrored: false,
        copies: 1,
        thickness: plate.thickness,
        area: plate.front_area(),
        blank_area: signed_area(&plate.blank),
        volume,
        // kg/m³ times mm³.
        mass: params.density_kg_m3() * volume * 1e-9,
        size: smallest_rectangle(&plate.blank),
        angles: (0..n).map(angle).collect(),
        edges: plate.half_edges.iter().map(|h| h.edge()).collect(),
        planarity: planarity(mesh, plate.face).mm,
        is_concave: plate.is_concave(),
        perimeter: (0..m).map(|i| plate.blank[i].distance(plate.blank[(i + 1) % m])).sum(),
        bevelled: (0..n).filter(|&i| bevels[i].abs() > SQUARE).map(blank_side).sum(),
        holes: plate.holes.len(),
        frame: plate.frame,
        sides,
        bevels,
    }
}

/// The cut of a side off square in degrees, measured on the plate.
fn bevel(plate: &Plate, i: usize) -> f64 {
    let [a, b] = plate.front_side(i);
    let inwards = (b - a).normalize_or_zero().perp();
    let inset = (plate.back[plate.begins[i]] - a).dot(inwards);
    (inset / plate.thickness).atan().to_degrees()
}

fn groups(
    plates: &Plates,
    params: &PanelParams,
    twins: Vec<Twin>,
    panels: &mut [PanelRow],
) -> Vec<GroupRow> {
    let mut rows: Vec<GroupRow> = Vec::new();
    let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
    for (i, twin) in twins.into_iter().enumerate() {
        let number = *numbers.entry(twin.first).or_insert(rows.len());
        if number == rows.len() {
            let plate = &plates.plates[i];
            let is_near = plate
                .front
                .iter()
                .zip(&plate.back)
                .all(|(a, b)| a.distance(*b) <= params.tolerance.mm());
            let (first, panels) = (PieceId(i), Vec::new());
            rows.push(GroupRow {
                number,
                first,
                copies: 0,
                mirrored: 0,
                turns_over: is_near,
                panels,
            });
        }
        let row = &mut rows[number];
        *(if twin.is_mirrored { &mut row.mirrored } else { &mut row.copies }) += 1;
        row.panels.push(PieceId(i));
        (panels[i].group, panels[i].is_mirrored) = (number, twin.is_mirrored);
    }
    for panel in panels {
        panel.copies = rows[panel.group].panels.len();
    }
    rows
}

fn edge(mesh: &Mesh, plates: &Plates, cut: &EdgeCut, index: &FaceMap<usize>) -> EdgeRow {
    let panel = |h: HalfEdgeId| (!mesh.is_hole(mesh.face(h))).then(|| index[mesh.face(h)]);
    let sides = cut.edge.half_edges().map(panel);
    let mitre = |i: usize| {
        sides[i]
            .zip(cut.insets[i])
            .map(|(p, inset)| inset.bevel(plates.plates[p].thickness).to_degrees())
    };
    let shape = match cut.fold {
        None => EdgeShape::Rim,
        Some(fold) if fold.to_degrees().abs() <= SQUARE => EdgeShape::Flat,
        Some(fold) if fold > 0.0 => EdgeShape::Convex,
        Some(_) => EdgeShape::Concave,
    };
    EdgeRow {
        id: cut.edge,
        nodes: mesh.edge_vertices(cut.edge),
        panels: sides.map(|p| p.map(PieceId)),
        length: edge_length(mesh, cut.edge),
        dihedral: cut.fold.map(|fold| 180.0 - fold.to_degrees()),
        mitres: [mitre(0), mitre(1)],
        shape,
        kind: cut.kind,
        fallback: cut.fallback,
        opening: cut.opening,
        is_stepped: cut.is_stepped,
    }
}

fn node(mesh: &Mesh, node: &Node) -> NodeRow {
    // `outgoing` runs clockwise.
    let mut around: Vec<HalfEdgeId> = mesh.outgoing(node.vertex).collect();
    around.reverse();
    let position = mesh.position(node.vertex);
    let along = |h: HalfEdgeId| (mesh.position(mesh.target(h)) - position).normalize_or_zero();
    let n = around.len();
    let angle = |i: usize| {
        // The face on the left of an outgoing half-edge lies between it and the next one.
        let (a, b) = (along(around[i]), along(around[(i + 1) % n]));
        if mesh.is_hole(mesh.face(around[i])) {
            0.0
        } else {
            a.cross(b).length().atan2(a.dot(b)).to_degrees()
        }
    };
    let tilt = |&h: &HalfEdgeId| {
        let a = along(h);
        a.cross(node.axis).length().atan2(a.dot(node.axis)).to_degrees()
    };
    NodeRow {
        position,
        edges: around.iter().map(|h| h.edge()).collect(),
        angles: (0..n).map(angle).collect(),
        tilts: around.iter().map(tilt).collect(),
        node: node.clone(),
    }
}
