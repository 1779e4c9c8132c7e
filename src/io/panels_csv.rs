//! The schedule of panels as tables: CSV as of RFC 4180, lengths in millimetres, angles in degrees,
//! masses in kilograms.
//!
//! The first line holds the names of the columns, with their units; the command line stands in the
//! last column of the first row. Several values in one field are separated by spaces. Numbers have
//! at most six decimals.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::csv_cell::cell;
use super::number::push_rounded;
use crate::mesh::EdgeId;
use crate::net::{EdgeLabel, PieceId};
use crate::panel::{GroupRow, NodeRow, PanelRow, Plate, Plates, Schedule};
use crate::sheet::Layout;

/// On which sheet every panel lies.
pub(super) fn sheet_of(layout: &Layout) -> BTreeMap<PieceId, String> {
    layout
        .sheets
        .iter()
        .flat_map(|s| s.placed.iter().map(|p| (p.piece, s.id.to_string())))
        .collect()
}

/// `panels.csv`: one row for each panel.
///
/// # Example
/// ```
/// use kerfold::io::panels_csv::panels_csv;
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
/// let csv = panels_csv(&list, &made, &sheets.layout, "my program");
/// assert_eq!(csv.lines().filter(|line| !line.starts_with('#')).count(), 1 + 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn panels_csv(schedule: &Schedule, plates: &Plates, layout: &Layout, command: &str) -> String {
    panels_table(schedule, plates, layout).csv(command)
}

pub(super) fn panels_table(schedule: &Schedule, plates: &Plates, layout: &Layout) -> Table {
    let sheets = sheet_of(layout);
    let mut table = Table::new(
        "panel,face,layer,group,mirrored,copies,thickness_mm,area_mm2,blank_area_mm2,volume_mm3,mass_kg,box_length_mm,\
         box_width_mm,perimeter_mm,edge_work_mm,sides,edges,side_lengths_mm,angles_deg,mitres_deg,planarity_mm,concave,holes,\
         sheet,origin_mm,x_axis,y_axis,normal,front_mm,back_mm",
    );
    for (row, plate) in schedule.panels.iter().zip(&plates.plates) {
        table.row(panel(row, plate, sheets.get(&row.id).map_or("", String::as_str)));
    }
    table
}

fn panel(row: &PanelRow, plate: &Plate, sheet: &str) -> Vec<String> {
    let frame = &row.frame;
    let mut fields =
        vec![row.id.to_string(), row.face.to_string(), row.layer.clone().unwrap_or_default()];
    fields.extend([group_name(row.group), yes(row.is_mirrored), row.copies.to_string()]);
    fields.extend([row.thickness, row.area, row.blank_area, row.volume, row.mass].map(number));
    fields.extend([row.size[0], row.size[1], row.perimeter, row.bevelled].map(number));
    fields.extend([row.sides.len().to_string(), edge_names(&row.edges)]);
    fields.extend([&row.sides, &row.angles, &row.bevels].map(|values| numbers(values)));
    fields.extend([
        number(row.planarity),
        yes(row.is_concave),
        row.holes.to_string(),
        sheet.to_owned(),
    ]);
    fields.extend([frame.origin, frame.x, frame.y, frame.normal].map(vector));
    fields.extend([&plate.front, &plate.back].map(|outline| points(outline)));
    fields
}

/// `edges.csv`: one row for each edge.
///
/// # Example
/// ```
/// use kerfold::io::panels_csv::edges_csv;
/// use kerfold::panel::schedule;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// assert_eq!(edges_csv(&list, "my program").lines().filter(|l| !l.starts_with('#')).count(), 1 + 12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn edges_csv(schedule: &Schedule, command: &str) -> String {
    edges_table(schedule).csv(command)
}

pub(super) fn edges_table(schedule: &Schedule) -> Table {
    let mut table = Table::new(
        "edge,node_a,node_b,panel_a,panel_b,length_mm,dihedral_deg,mitre_a_deg,mitre_b_deg,shape,joint,wanted,why,\
         opening_front_mm,opening_back_mm,stepped",
    );
    for row in &schedule.edges {
        let panel = |p: Option<PieceId>| p.map(|p| p.to_string()).unwrap_or_default();
        let maybe = |value: Option<f64>| value.map(number).unwrap_or_default();
        let (wanted, why) = row.fallback.map_or(("", ""), |(kind, why)| (kind.name(), why.name()));
        let mut fields = vec![
            edge_name(row.id),
            node_name(row.nodes[0].index()),
            node_name(row.nodes[1].index()),
        ];
        fields.extend(row.panels.map(panel));
        fields.extend([number(row.length), maybe(row.dihedral)]);
        fields.extend(row.mitres.map(maybe));
        fields.extend([row.shape.name(), row.kind.name(), wanted, why].map(str::to_owned));
        fields.extend([row.opening.map(|o| o[0]), row.opening.map(|o| o[1])].map(maybe));
        fields.push(yes(row.is_stepped));
        table.row(fields);
    }
    table
}

/// `nodes.csv`: one row for each node.
///
/// # Example
/// ```
/// use kerfold::io::panels_csv::nodes_csv;
/// use kerfold::panel::schedule;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// assert_eq!(nodes_csv(&list, "my program").lines().filter(|l| !l.starts_with('#')).count(), 1 + 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nodes_csv(schedule: &Schedule, command: &str) -> String {
    nodes_table(schedule).csv(command)
}

pub(super) fn nodes_table(schedule: &Schedule) -> Table {
    let mut table = Table::new(
        "node,valence,rim,edges,angles_deg,tilts_deg,position_mm,axis,front_mm,back_mm,residual_mm_per_mm,miss_mm",
    );
    schedule.nodes.iter().for_each(|row| table.row(node(row)));
    table
}

fn node(row: &NodeRow) -> Vec<String> {
    let node = &row.node;
    let mut fields =
        vec![node_name(node.vertex.index()), node.valence.to_string(), yes(node.is_rim)];
    fields.extend([edge_names(&row.edges), numbers(&row.angles), numbers(&row.tilts)]);
    fields.extend([row.position, node.axis, node.front, node.back].map(vector));
    fields.extend([format!("{:.3e}", node.residual), number(node.miss_mm)]);
    fields
}

/// `cutting-list.csv`: one row for each group of congruent panels.
///
/// # Example
/// ```
/// use kerfold::io::panels_csv::cutting_list_csv;
/// use kerfold::panel::schedule;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// let csv = cutting_list_csv(&list, "my program");
/// assert!(csv.lines().count() > 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cutting_list_csv(schedule: &Schedule, command: &str) -> String {
    cutting_list_table(schedule).csv(command)
}

pub(super) fn cutting_list_table(schedule: &Schedule) -> Table {
    let mut table = Table::new(
        "group,panels,as_first,mirrored,turns_over,first,thickness_mm,box_length_mm,box_width_mm,area_each_mm2,mass_each_kg,\
         mass_all_kg,perimeter_all_mm,edge_work_all_mm,names",
    );
    for row in &schedule.groups {
        table.row(group(row, &schedule.panels));
    }
    table
}

fn group(row: &GroupRow, panels: &[PanelRow]) -> Vec<String> {
    let first = &panels[row.first.0];
    let count = row.panels.len();
    let sum = |of: fn(&PanelRow) -> f64| number(row.panels.iter().map(|p| of(&panels[p.0])).sum());
    let mut fields = vec![
        group_name(row.number),
        count.to_string(),
        row.copies.to_string(),
        row.mirrored.to_string(),
    ];
    fields.extend([yes(row.turns_over), row.first.to_string()]);
    fields.extend(
        [first.thickness, first.size[0], first.size[1], first.area, first.mass].map(number),
    );
    fields.extend([sum(|p| p.mass), sum(|p| p.perimeter), sum(|p| p.bevelled)]);
    fields.push(row.panels.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "));
    fields
}

/// Rows under a header.
pub(super) struct Table {
    pub columns: Vec<&'static str>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    fn new(columns: &'static str) -> Self {
        Self { columns: columns.split(',').collect(), rows: Vec::new() }
    }

    fn row(&mut self, fields: Vec<String>) {
        self.rows.push(fields);
    }

    /// The table as text; the command line in the last column of the first row.
    fn csv(&self, command: &str) -> String {
        let mut text = self.columns.join(",") + ",command\r\n";
        for (i, fields) in self.rows.iter().enumerate() {
            for field in fields {
                text += &cell(field);
                text.push(',');
            }
            text += &cell(if i == 0 { command } else { "" });
            text += "\r\n";
        }
        text
    }
}

/// The name of a group of congruent panels.
pub(super) fn group_name(number: usize) -> String {
    format!("G{:03}", number + 1)
}

pub(super) fn edge_name(edge: EdgeId) -> String {
    EdgeLabel(edge.index()).to_string()
}

pub(super) fn node_name(vertex: usize) -> String {
    format!("N{vertex:03}")
}

fn edge_names(edges: &[EdgeId]) -> String {
    edges.iter().map(|&e| edge_name(e)).collect::<Vec<_>>().join(" ")
}

fn yes(is_so: bool) -> String {
    if is_so { "yes" } else { "no" }.to_owned()
}

/// At most six decimals, without zeros at the end, never −0.
fn number(value: f64) -> String {
    let mut text = String::with_capacity(16);
    push_rounded::<6>(&mut text, value);
    text
}

fn numbers(values: &[f64]) -> String {
    let mut text = String::new();
    for (i, &value) in values.iter().enumerate() {
        text += if i == 0 { "" } else { " " };
        push_rounded::<6>(&mut text, value);
    }
    text
}

fn vector(v: DVec3) -> String {
    numbers(&v.to_array())
}

fn points(outline: &[DVec2]) -> String {
    let mut text = String::new();
    for (i, p) in outline.iter().enumerate() {
        text += if i == 0 { "" } else { "; " };
        push_rounded::<6>(&mut text, p.x);
        text.push(' ');
        push_rounded::<6>(&mut text, p.y);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_quoted_and_the_command_comes_once() {
        let mut table = Table::new("a,b");
        table.row(vec!["1".to_owned(), "p, q".to_owned()]);
        table.row(vec!["2".to_owned(), "r".to_owned()]);
        assert_eq!(
            table.csv("kerfold panels \"x, y\""),
            "a,b,command\r\n1,\"p, q\",\"kerfold panels \"\"x, y\"\"\"\r\n2,r,\r\n"
        );
        assert_eq!([1.5, -1e-9, 2.0, 1e3].map(number), ["1.5", "0", "2", "1000"]);
    }
}
