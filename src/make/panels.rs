//! From a mesh to plates: schedule, sheets, assembly map and 3D files.

use clap::ValueEnum;
use serde::Deserialize;

use super::outputs::Output;
use super::{Fabrication, MakeError, fabrication_outputs};
use crate::code::codes;
use crate::io::map_files::{map_pdf, map_svg};
use crate::io::panels_csv::{cutting_list_csv, edges_csv, nodes_csv, panels_csv};
use crate::io::panels_json::panels_json;
use crate::io::plates::{NamedPlate, plates_glb, plates_obj, plates_stl};
use crate::io::step::{StepPart, step_bytes};
use crate::mesh::Mesh;
use crate::panel::{
    EdgeKind, Hardware, PanelFinding, PanelParams, Plates, Schedule, assembly_map, panel_findings,
    panel_net, plates, schedule,
};
use crate::progress::Progress;
use crate::sheet::{
    Joint, JointParams, Labels, LetterParams, PieceKind, SheetParams, lay_out_watched,
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
}

/// A 3D file of plates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SolidFile {
    /// No file.
    None,
    /// `plates.step`: one named solid for each plate.
    Step,
    /// `plates.obj`: one group for each plate.
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
        Self { solids: all_solids() }
    }
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
}

/// Why panels cannot be made as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PanelOptionError {
    /// No thickness.
    #[error("panels need a thickness; give it, for example thickness 10mm, or a material")]
    NoThickness,
    /// A joint of the sheets instead of one of the panels.
    #[error(
        "panels do not take joint; say what their edges are with edges, for example edges finger"
    )]
    Joint,
    /// An option that nothing uses.
    #[error("{option} is used by no edge; leave it out, or let edges be {by}")]
    Unused {
        /// The option.
        option: &'static str,
        /// What would use it.
        by: &'static str,
    },
}

codes!(error PanelOptionError {
    NoThickness = 741,
    Joint = 742,
    Unused = 743,
});

/// What a job of panels is asked for.
#[derive(Debug, Clone, Copy)]
pub struct PanelSettings<'a> {
    /// How the plates are made.
    pub panels: &'a PanelParams,
    /// Which 3D files are written.
    pub files: &'a PanelFiles,
    /// How the plates lie on sheets, and what is drawn on them.
    pub sheet: &'a SheetParams,
}

/// Makes the plates of a mesh in millimetres, lists them and lays them out on sheets. The
/// thickness, the width of fingers and the sizes of holes are those of the sheet's parameters;
/// without a thickness that of the material is taken.
///
/// # Errors
/// [`MakeError::PanelOption`] for options that do not fit together, [`MakeError::Panel`] for a
/// mesh that cannot be made of such plates, [`MakeError::Sheet`] for panels that no sheet can
/// hold.
pub fn panel_model(
    mesh: &Mesh,
    settings: &PanelSettings<'_>,
    source: &MeshSource<'_>,
    progress: &dyn Progress,
) -> Result<Panelled, MakeError> {
    let PanelSettings { panels: params, files, sheet } = *settings;
    let (thickness, hardware) = hardware(params, sheet)?;
    let density = params.density.or_else(|| sheet.stock.made_of.as_ref()?.density);
    let params = &PanelParams { density, ..params.clone() };
    let plates = plates(mesh, thickness, (params, &hardware), progress)?;
    let schedule = schedule(mesh, &plates, params);
    let findings = panel_findings(&plates, params);
    let net = panel_net(mesh, &plates, source.scale, source.split_vertices);
    progress.report("sheets", 0, 0);
    let sheets = lay_out_watched(&net, &bare(sheet), progress)?;
    let fabrication = Fabrication { net, sheets, seams: "", divided: 0, sources: Vec::new() };
    Ok(Panelled { plates, schedule, findings, fabrication, files: files.clone() })
}

/// The options of the sheet that plates take over.
fn hardware(
    params: &PanelParams,
    sheet: &SheetParams,
) -> Result<(Length, Hardware), PanelOptionError> {
    if sheet.joint.kind != Joint::None {
        return Err(PanelOptionError::Joint);
    }
    let has = |kinds: &[EdgeKind]| kinds.iter().any(|&k| params.edges.has(k));
    let has_holes = has(&[EdgeKind::Stitch, EdgeKind::Hinge])
        || params.shallow == crate::panel::Shallow::Stitch;
    let unused = |option: &'static str, is_given: bool, is_used: bool, by: &'static str| {
        if is_given && !is_used { Err(PanelOptionError::Unused { option, by }) } else { Ok(()) }
    };
    unused("finger-width", sheet.joint.finger_width.is_some(), has(&[EdgeKind::Finger]), "finger")?;
    for (option, value) in [
        ("hole-spacing", sheet.joint.hole_spacing),
        ("hole-diameter", sheet.joint.hole_diameter),
        ("hole-inset", sheet.joint.hole_inset),
    ] {
        unused(option, value.is_some(), has_holes, "stitch or hinge")?;
    }
    let of_material = sheet.stock.made_of.as_ref().map(|material| material.thickness);
    let thickness = sheet.joint.thickness.or(of_material).ok_or(PanelOptionError::NoThickness)?;
    let hardware = Hardware {
        finger_width: sheet.joint.finger_width,
        hole_spacing: sheet.joint.hole_spacing,
        hole_diameter: sheet.joint.hole_diameter,
        hole_inset: sheet.joint.hole_inset,
    };
    Ok((thickness, hardware))
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

/// Everything that is written of a panelled model: schedule, map, 3D files, pieces and sheets.
///
/// # Errors
/// [`MakeError::Io`] when a number does not fit into a file.
pub fn panel_outputs(
    panelled: &Panelled,
    sheet: &SheetParams,
    command: &str,
) -> Result<Vec<Output>, MakeError> {
    let Panelled { plates, schedule, findings, fabrication, files } = panelled;
    let layout = &fabrication.sheets.layout;
    let map = assembly_map(plates);
    let mut outputs: Vec<Output> = vec![
        ("panels.csv".to_owned(), panels_csv(schedule, plates, layout, command).into_bytes()),
        ("edges.csv".to_owned(), edges_csv(schedule, command).into_bytes()),
        ("nodes.csv".to_owned(), nodes_csv(schedule, command).into_bytes()),
        ("cutting-list.csv".to_owned(), cutting_list_csv(schedule, command).into_bytes()),
        (
            "panels.json".to_owned(),
            panels_json(schedule, plates, layout, findings, command).into_bytes(),
        ),
        ("assembly-map.svg".to_owned(), map_svg(&map, command).into_bytes()),
        ("assembly-map.pdf".to_owned(), map_pdf(&map, command)),
    ];
    let name = |i: usize| schedule.panels[i].id.to_string();
    let named: Vec<NamedPlate<'_>> = plates
        .plates
        .iter()
        .enumerate()
        .map(|(i, plate)| NamedPlate { name: name(i), group: schedule.panels[i].group, plate })
        .collect();
    for file in &files.solids {
        match file {
            SolidFile::None => {}
            SolidFile::Step => {
                let parts = named.iter().map(|n| StepPart { name: &n.name, plate: n.plate });
                outputs.push(("plates.step".to_owned(), step_bytes(parts, command)));
            }
            SolidFile::Obj => outputs.push(("plates.obj".to_owned(), plates_obj(&named, command))),
            SolidFile::Glb => outputs.push(("plates.glb".to_owned(), plates_glb(&named, command)?)),
            SolidFile::Stl => outputs.push(("plates.stl".to_owned(), plates_stl(&named, command)?)),
        }
    }
    outputs.extend(fabrication_outputs(fabrication, &bare(sheet), command)?);
    Ok(outputs)
}

impl Panelled {
    /// What the user should know about the plates and their sheets.
    pub fn notes(&self) -> Vec<String> {
        let plates = &self.plates;
        let mut notes = Vec::new();
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
            "straight corners lie between edges with different cuts, which were averaged there",
        );
        note(plates.unrelieved_corners, "corners are too near to their neighbours to be relieved");
        let fallen = plates.edges.iter().filter(|e| e.fallback.is_some()).count();
        note(
            fallen,
            "edges could not have the joint of their rule and are mitred or stitched instead; \
            edges.csv says why",
        );
        note(plates.hole_pairs, "pairs of holes");
        note(plates.lost_hole_pairs, "pairs of holes had no room and were left out");
        notes.extend(self.fabrication.notes());
        notes
    }
}
