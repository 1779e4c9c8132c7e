//! From a mesh to plates: schedule, sheets, assembly map and 3D files.

use clap::ValueEnum;
use serde::Deserialize;

use super::outputs::Output;
use super::panel_error::PanelOptionError;
use super::{Fabrication, MakeError, fabrication_outputs};
use crate::check::{FlatNeighbours, short};
use crate::io::map_files::{map_pdf, map_svg};
use crate::io::panels_csv::{cutting_list_csv, edges_csv, nodes_csv, panels_csv};
use crate::io::panels_json::panels_json;
use crate::io::panels_xlsx::panels_xlsx;
use crate::io::panes::{Pane, is_bevelled, pane_drawings, pane_dxf, panes_pdf};
use crate::io::plates::{NamedPlate, PLATES_MTL, plates_glb, plates_mtl, plates_obj, plates_stl};
use crate::io::step::step_bytes;
use crate::mesh::Mesh;
use crate::panel::{
    EdgeFallback, EdgeKind, Hardware, NodeCut, PanelError, PanelFinding, PanelParams, Plates,
    Schedule, Shallow, Solid, assembly_map, panel_findings, panel_net, plates, schedule, solid,
};
use crate::progress::Progress;
use crate::sheet::{
    Joint, JointParams, Labels, LetterParams, Mark, MarkKind, PieceKind, PlateSide, SheetParams,
    SheetSet, Stroke, lay_out_watched,
};
use crate::unfold::MeshSource;
use crate::units::Length;

/// What is written of a panelled model besides its schedule and sheets.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct PanelFiles {
    /// 3D files of the plates, separated by commas: step, obj, glb, stl; or none
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "LIST",
        default_value = "step,obj,glb,stl"
    )]
    #[serde(default = "all_solids")]
    pub solids: Vec<SolidFile>,
    /// Dimensioned drawings of the panes, separated by commas: pdf (panes.pdf, a page for each), dxf
    /// (pane-P01.dxf, …, at true size); or none
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST", default_value = "pdf")]
    #[serde(default = "usual_drawings")]
    pub drawings: Vec<PaneFile>,
}

/// A dimensioned drawing of panes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PaneFile {
    /// No drawing.
    None,
    /// `panes.pdf`: one page for each pane.
    Pdf,
    /// `pane-P01.dxf`: one file for each pane, at true size.
    Dxf,
}

fn usual_drawings() -> Vec<PaneFile> {
    vec![PaneFile::Pdf]
}

/// A 3D file of plates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SolidFile {
    /// No file.
    None,
    /// `plates.step`: one named solid for each plate.
    Step,
    /// `plates.obj`: one group for each plate, with its colours in `plates.mtl`.
    Obj,
    /// `plates.glb`: one named node for each plate, with its name lettered on it.
    Glb,
    /// `plates.stl`.
    Stl,
}

fn all_solids() -> Vec<SolidFile> {
    vec![SolidFile::Step, SolidFile::Obj, SolidFile::Glb, SolidFile::Stl]
}

impl Default for PanelFiles {
    fn default() -> Self {
        Self { solids: all_solids(), drawings: usual_drawings() }
    }
}

/// What is asked of a panelled model.
#[derive(Debug, Clone, Copy)]
pub struct PanelJob<'a> {
    /// How faces become plates. Sizes of fingers and holes that the sheet's parameters give count
    /// before its hardware.
    pub panels: &'a PanelParams,
    /// Which files are written.
    pub files: &'a PanelFiles,
    /// Where the panels go; their thickness.
    pub sheet: &'a SheetParams,
}

/// A panelled model, ready to be written.
#[derive(Debug, Clone)]
pub struct Panelled {
    /// The plates.
    pub plates: Plates,
    /// Panels, edges, nodes.
    pub schedule: Schedule,
    /// Nodes that break what was required.
    pub findings: Vec<PanelFinding>,
    /// The panels as pieces, on sheets.
    pub fabrication: Fabrication,
    /// What 3D files are wanted.
    pub files: PanelFiles,
    /// Faces that lie flat beside each other, which would better be one panel.
    pub flat: FlatNeighbours,
}

/// Makes the plates of a mesh in millimetres, lists them and lays them out on sheets. Without a
/// thickness in the sheet's parameters that of the material is taken.
///
/// # Errors
/// [`MakeError::PanelOption`] for options that do not fit together, [`MakeError::Panel`] for a
/// mesh that cannot be made of such plates, [`MakeError::Sheet`] for panels that no sheet can
/// hold.
pub fn panel_model(
    mesh: &Mesh,
    job: PanelJob<'_>,
    source: &MeshSource<'_>,
    progress: &dyn Progress,
) -> Result<Panelled, MakeError> {
    let thickness = thickness(job.sheet)?;
    let params = &panel_params(job)?;
    let plates = plates(mesh, thickness, params, progress)?;
    let schedule = schedule(mesh, &plates, params, progress)?;
    let findings = panel_findings(mesh, &plates, params);
    let net = panel_net(mesh, &plates, source.scale, source.split_vertices);
    progress.report("sheets", 0, 0);
    let mut sheets = lay_out_watched(&net, &bare(job.sheet), progress)?;
    add_sides(&mut sheets, &plates);
    let fabrication = Fabrication { net, sheets, seams: "", divided: 0, sources: Vec::new() };
    let (files, flat) = (job.files.clone(), FlatNeighbours::of(mesh));
    Ok(Panelled { plates, schedule, findings, fabrication, files, flat })
}

/// The outlines of both sides of bevelled plates, where they lie on the sheets.
fn add_sides(sheets: &mut SheetSet, plates: &Plates) {
    for (drawing, sheet) in sheets.drawings.iter_mut().zip(&sheets.layout.sheets) {
        for placed in &sheet.placed {
            let plate = &plates.plates[placed.piece.0];
            if !is_bevelled(plate) {
                continue;
            }
            let outlines = [(PlateSide::Front, &plate.front), (PlateSide::Back, &plate.back)];
            for (side, outline) in outlines {
                let points = placed.apply_all(outline);
                let word = if side == PlateSide::Front { "front" } else { "back" };
                let mark = Mark {
                    id: format!("{}-{word}", placed.piece),
                    kind: MarkKind::Note,
                    piece: Some(placed.piece),
                    strokes: vec![Stroke { points, closed: true }],
                };
                drawing.sides.push((side, mark));
            }
        }
    }
}

fn thickness(sheet: &SheetParams) -> Result<Length, PanelOptionError> {
    if sheet.joint.kind != Joint::None {
        return Err(PanelOptionError::Joint);
    }
    let of_material = sheet.stock.made_of.as_ref().map(|material| material.thickness);
    sheet.joint.thickness.or(of_material).ok_or(PanelOptionError::NoThickness)
}

/// The parameters of the plates with what the sheet's parameters give of them: hardware and
/// density.
fn panel_params(job: PanelJob<'_>) -> Result<PanelParams, PanelOptionError> {
    let (own, sheet) = (job.panels.hardware, job.sheet);
    let hardware = Hardware {
        finger_width: sheet.joint.finger_width.or(own.finger_width),
        hole_spacing: sheet.joint.hole_spacing.or(own.hole_spacing),
        hole_diameter: sheet.joint.hole_diameter.or(own.hole_diameter),
        hole_inset: sheet.joint.hole_inset.or(own.hole_inset),
    };
    check_use(job.panels, &hardware)?;
    let density = job.panels.density.or_else(|| sheet.stock.made_of.as_ref()?.density);
    Ok(PanelParams { density, hardware, ..job.panels.clone() })
}

/// Refuses sizes of hardware that no edge has.
fn check_use(params: &PanelParams, hardware: &Hardware) -> Result<(), PanelOptionError> {
    let has = |kinds: &[EdgeKind]| kinds.iter().any(|&k| params.edges.has(k));
    let has_fingers = has(&[EdgeKind::Finger]);
    let has_holes = has(&[EdgeKind::Stitch, EdgeKind::Hinge]) || params.shallow == Shallow::Stitch;
    let given = [
        ("finger-width", hardware.finger_width, has_fingers, "finger"),
        ("hole-spacing", hardware.hole_spacing, has_holes, "stitch or hinge"),
        ("hole-diameter", hardware.hole_diameter, has_holes, "stitch or hinge"),
        ("hole-inset", hardware.hole_inset, has_holes, "stitch or hinge"),
    ];
    let unused = given.into_iter().find(|(_, size, is_used, _)| size.is_some() && !is_used);
    unused.map_or(Ok(()), |(option, _, _, by)| Err(PanelOptionError::Unused { option, by }))
}

/// The sheet's parameters without what the plates have taken; seams carry the numbers of the edges,
/// as the schedule does.
fn bare(sheet: &SheetParams) -> SheetParams {
    let labels =
        if sheet.letter.labels == Labels::All { Labels::Edges } else { sheet.letter.labels };
    SheetParams {
        letter: LetterParams { labels, ..sheet.letter },
        joint: JointParams {
            thickness: None,
            finger_width: None,
            hole_spacing: None,
            hole_diameter: None,
            hole_inset: None,
            ..sheet.joint.clone()
        },
        pieces: PieceKind::Panels,
        ..sheet.clone()
    }
}

/// Everything that is written of a panelled model, a mesh in mm: schedule, map, 3D files, pieces
/// and sheets.
///
/// # Errors
/// [`MakeError::Io`] when a number does not fit into a file.
pub fn panel_outputs(
    panelled: &Panelled,
    mesh: &Mesh,
    sheet: &SheetParams,
    command: &str,
) -> Result<Vec<Output>, MakeError> {
    let Panelled { plates, schedule, findings, fabrication, .. } = panelled;
    let layout = &fabrication.sheets.layout;
    let map = assembly_map(plates);
    let mut outputs: Vec<Output> = vec![
        ("panels.csv".to_owned(), panels_csv(schedule, plates, layout, command).into_bytes()),
        ("edges.csv".to_owned(), edges_csv(schedule, command).into_bytes()),
        ("nodes.csv".to_owned(), nodes_csv(schedule, command).into_bytes()),
        ("cutting-list.csv".to_owned(), cutting_list_csv(schedule, command).into_bytes()),
        ("schedule.xlsx".to_owned(), panels_xlsx(schedule, plates, layout, command)?),
        (
            "panels.json".to_owned(),
            panels_json(schedule, plates, layout, findings, command).into_bytes(),
        ),
        ("assembly-map.svg".to_owned(), map_svg(&map, command).into_bytes()),
        ("assembly-map.pdf".to_owned(), map_pdf(&map, command)),
    ];
    outputs.extend(solid_files(panelled, command)?);
    outputs.extend(pane_files(panelled, sheet, command));
    outputs.extend(fabrication_outputs(fabrication, Some(mesh), &bare(sheet), command)?);
    Ok(outputs)
}

/// The dimensioned drawings that were asked for.
fn pane_files(panelled: &Panelled, sheet: &SheetParams, command: &str) -> Vec<Output> {
    let title = sheet.files.title.as_deref().unwrap_or_default();
    let wants = |file: PaneFile| panelled.files.drawings.contains(&file);
    if !wants(PaneFile::Pdf) && !wants(PaneFile::Dxf) {
        return Vec::new();
    }
    let panes = pane_drawings(&panelled.schedule, &panelled.plates, title);
    let mut outputs = Vec::new();
    if wants(PaneFile::Pdf) {
        outputs.push(("panes.pdf".to_owned(), panes_pdf(&panes, command)));
    }
    if wants(PaneFile::Dxf) {
        let dxf =
            |pane: &Pane| (format!("pane-{}.dxf", pane.name), pane_dxf(pane, command).into_bytes());
        outputs.extend(panes.iter().map(dxf));
    }
    outputs
}

/// The 3D files of the plates. No body is written that is not closed.
fn solid_files(panelled: &Panelled, command: &str) -> Result<Vec<Output>, MakeError> {
    let (plates, rows) = (&panelled.plates.plates, &panelled.schedule.panels);
    if panelled.files.solids.iter().all(|&file| file == SolidFile::None) {
        return Ok(Vec::new());
    }
    let bodies = plates.iter().map(solid).collect::<Result<Vec<Solid>, PanelError>>()?;
    let mut named: Vec<NamedPlate<'_>> = Vec::with_capacity(rows.len());
    for ((plate, body), row) in plates.iter().zip(&bodies).zip(rows) {
        let name = row.id.to_string();
        named.push(NamedPlate { name, group: row.group, plate, body, row: Some(row) });
    }
    let mut outputs = Vec::new();
    for file in &panelled.files.solids {
        let (name, bytes) = match file {
            SolidFile::None => continue,
            SolidFile::Step => ("plates.step", step_bytes(&named, command)),
            SolidFile::Obj => {
                outputs.push((PLATES_MTL.to_owned(), plates_mtl(&named, command)));
                ("plates.obj", plates_obj(&named, command))
            }
            SolidFile::Glb => ("plates.glb", plates_glb(&named, command)?),
            SolidFile::Stl => ("plates.stl", plates_stl(&named, command)?),
        };
        outputs.push((name.to_owned(), bytes));
    }
    Ok(outputs)
}

/// How many cuts at nodes are listed before they are only counted.
const LISTED: usize = 10;

/// What was cut off at a node, in words.
fn cut_text(cut: &NodeCut) -> String {
    let [a, b] = cut.panels;
    let cuts = cut.panels.iter().zip(cut.cut_mm).filter(|&(_, mm)| mm > 0.0);
    let cuts: Vec<String> =
        cuts.map(|(panel, mm)| format!("{panel} by {} mm", short(mm))).collect();
    format!(
        "at vertex {} the plates {a} and {b} took {} mm³ of each other; cut back: {}",
        cut.vertex,
        short(cut.overlap_mm3),
        cuts.join(", ")
    )
}

impl Panelled {
    /// What the user should know about the plates and their sheets.
    pub fn notes(&self) -> Vec<String> {
        let plates = &self.plates;
        let mut notes: Vec<String> = self.flat.proposal().into_iter().collect();
        let mut note = |count: usize, text: &str| {
            if count > 0 {
                notes.push(format!("{count} {text}"));
            }
        };
        let above = self.schedule.totals.nodes_above_three;
        note(
            above,
            "nodes have more than three edges: plates of constant thickness meet there only where \
            the node is conical",
        );
        let stepped = plates.edges.iter().filter(|e| e.is_stepped).count();
        note(
            stepped,
            "edges are too flat for their two thicknesses to meet: the surfaces step there",
        );
        note(
            plates.straight_corners.len(),
            "straight corners lie between edges with different cuts; both sides have the deeper",
        );
        note(plates.unrelieved_corners, "corners are too near to their neighbours to be relieved");
        let fallen = plates.edges.iter().filter(|e| e.fallback.is_some()).count();
        note(
            fallen,
            "edges could not have the joint of their rule and are mitred or stitched instead; \
            edges.csv says why",
        );
        let butting =
            plates.edges.iter().filter(|e| matches!(e.fallback, Some((_, EdgeFallback::Overlap))));
        note(
            butting.count(),
            "of them since plates would run into each other at their nodes otherwise",
        );
        note(plates.hole_pairs, "pairs of holes");
        note(plates.lost_hole_pairs, "pairs of holes had no room and were left out");
        let cuts = &plates.node_cuts;
        notes.extend(cuts.iter().take(LISTED).map(cut_text));
        if cuts.len() > LISTED {
            notes.push(format!(
                "{} pairs of plates were kept apart so; panels.json lists all",
                cuts.len()
            ));
        }
        notes.extend(self.fabrication.notes());
        notes
    }
}
