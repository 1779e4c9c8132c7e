//! `panels.json`: plates, edges and nodes with all their digits; lengths in millimetres, angles in
//! degrees, masses in kilograms.
//!
//! A flat point (x, y) of a panel's front is at `origin + x·x_axis + y·y_axis` in space, one of its
//! back at that minus the thickness along `normal`. One panel, edge, node or group to a line.

use glam::{DVec2, DVec3};
use serde::Serialize;
use serde_json::{Value, json};

use super::panels_csv::{edge_name, group_name, node_name, sheet_of};
use crate::code::Coded;
use crate::net::PieceId;
use crate::panel::{
    EdgeRow, GroupRow, NodeCut, NodeRow, PanelCheck, PanelElement, PanelFinding, PanelRow, Plate,
    Plates, Schedule,
};
use crate::sheet::Layout;

/// The text of `panels.json`; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::panels_json::panels_json;
/// use kerfold::panel::panel_net;
/// use kerfold::sheet::{SheetParams, lay_out};
/// use kerfold::panel::schedule;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// let net = panel_net(&cube, &made, 1.0, &[]);
/// let sheets = lay_out(&net, &SheetParams::default())?;
/// let json = panels_json(&list, &made, &sheets.layout, &[], "my program");
/// let value: serde_json::Value = serde_json::from_str(&json)?;
/// assert_eq!(value["panels"].as_array().map(Vec::len), Some(6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn panels_json(
    schedule: &Schedule,
    plates: &Plates,
    layout: &Layout,
    findings: &[PanelFinding],
    command: &str,
) -> String {
    let sheets = sheet_of(layout);
    let panels = schedule
        .panels
        .iter()
        .zip(&plates.plates)
        .map(|(row, plate)| compact(&panel(row, plate, &sheets)));
    let totals = &schedule.totals;
    let sums = json!({
        "panels": schedule.panels.len(), "groups": schedule.groups.len(), "area_mm2": totals.area,
        "mass_kg": totals.mass,
        "perimeter_mm": totals.perimeter, "edge_work_mm": totals.bevelled,
        "nodes_above_valence_3": totals.nodes_above_three,
        "largest_residual_mm_per_mm": totals.residual, "largest_miss_mm": totals.miss_mm,
    });
    let lists = [
        ("command", compact(command)),
        ("units", compact("mm")),
        ("totals", compact(&sums)),
        ("findings", lines(findings.iter().map(|f| compact(&finding(f))))),
        ("node_cuts", lines(plates.node_cuts.iter().map(|cut| compact(&node_cut(cut))))),
        ("groups", lines(schedule.groups.iter().map(|g| compact(&group(g))))),
        ("panels", lines(panels)),
        ("edges", lines(schedule.edges.iter().map(|e| compact(&edge(e))))),
        ("nodes", lines(schedule.nodes.iter().map(|n| compact(&node(n))))),
    ];
    let body = lists.map(|(key, value)| format!("  \"{key}\": {value}")).join(",\n");
    format!("{{\n{body}\n}}\n")
}

fn panel(
    row: &PanelRow,
    plate: &Plate,
    sheets: &std::collections::BTreeMap<PieceId, String>,
) -> Value {
    let holes: Vec<Value> = plate
        .holes
        .iter()
        .map(|h| json!({ "x": h.centre.x, "y": h.centre.y, "diameter": 2.0 * h.radius, "edge": edge_name(h.edge) }))
        .collect();
    json!({
        "id": row.id.to_string(), "face": row.face, "layer": row.layer,
        "group": group_name(row.group),
        "mirrored": row.is_mirrored, "copies": row.copies, "thickness": row.thickness,
        "area": row.area,
        "blank_area": row.blank_area, "volume": row.volume, "mass": row.mass, "box": row.size,
        "perimeter": row.perimeter,
        "edge_work": row.bevelled,
        "edges": row.edges.iter().map(|&e| edge_name(e)).collect::<Vec<_>>(),
        "side_lengths": row.sides, "angles": row.angles, "mitres": row.bevels,
        "planarity": row.planarity,
        "concave": row.is_concave, "sheet": sheets.get(&row.id),
        "frame": {
            "origin": array(row.frame.origin), "x_axis": array(row.frame.x),
            "y_axis": array(row.frame.y),
            "normal": array(row.frame.normal)
        },
        "front": flat(&plate.front), "back": flat(&plate.back), "blank": flat(&plate.blank),
        "holes": holes,
    })
}

fn edge(row: &EdgeRow) -> Value {
    json!({
        "id": edge_name(row.id), "nodes": row.nodes.map(|v| node_name(v.index())),
        "panels": row.panels.map(|p| p.map(|p| p.to_string())), "length": row.length,
        "dihedral": row.dihedral,
        "mitres": row.mitres, "shape": row.shape.name(), "joint": row.kind.name(),
        "fallback": row.fallback.map(|(kind, why)| json!({ "wanted": kind.name(), "why": why.name() })),
        "opening": row.opening.map(|[front, back]| json!({ "front": front, "back": back })),
        "stepped": row.is_stepped,
    })
}

fn node(row: &NodeRow) -> Value {
    let node = &row.node;
    json!({
        "id": node_name(node.vertex.index()), "valence": node.valence, "rim": node.is_rim,
        "edges": row.edges.iter().map(|&e| edge_name(e)).collect::<Vec<_>>(), "angles": row.angles,
        "tilts": row.tilts,
        "position": array(row.position), "axis": array(node.axis), "front": array(node.front),
        "back": array(node.back),
        "residual": node.residual, "miss": node.miss_mm,
    })
}

fn group(row: &GroupRow) -> Value {
    json!({
        "id": group_name(row.number), "first": row.first.to_string(), "copies": row.copies,
        "mirrored": row.mirrored,
        "turns_over": row.turns_over,
        "panels": row.panels.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

fn node_cut(cut: &NodeCut) -> Value {
    json!({
        "node": node_name(cut.vertex.index()), "panels": cut.panels.map(|p| p.to_string()),
        "overlap_mm3": cut.overlap_mm3, "cut_back_mm": cut.cut_mm,
    })
}

/// A finding as `panels.json` and `--json` show it.
pub fn finding(finding: &PanelFinding) -> Value {
    let (check, unit) = match finding.check {
        PanelCheck::Valence3 => ("valence3", "edges"),
        PanelCheck::Conical => ("conical", "mm/mm"),
        PanelCheck::Planar => ("planar-faces", "mm"),
    };
    let (element, id) = match finding.element {
        PanelElement::Node(vertex) => ("node", vertex.index()),
        PanelElement::Face(face) => ("face", face.index()),
    };
    json!({
        "check": check, "code": finding.check.code().to_string(), "element": element, "id": id,
        "measured": finding.measured, "limit": finding.limit, "unit": unit,
    })
}

fn array(v: DVec3) -> [f64; 3] {
    v.to_array()
}

fn flat(outline: &[DVec2]) -> Vec<[f64; 2]> {
    outline.iter().map(|p| p.to_array()).collect()
}

fn compact<T: Serialize + ?Sized>(value: &T) -> String {
    serde_json::to_string(value).expect("plain numbers and text become JSON")
}

fn lines(rows: impl Iterator<Item = String>) -> String {
    let rows: Vec<String> = rows.map(|row| format!("    {row}")).collect();
    if rows.is_empty() { "[]".to_owned() } else { format!("[\n{}\n  ]", rows.join(",\n")) }
}
