//! `kerfold panels`

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::CliError;
use super::input::Input;
use super::output::{Clean, command_line, model_json, model_text, short};
use super::terminal::Terminal;
use super::unfold::summary_json;
use super::{Console, Outcome};
use crate::code::Coded;
use crate::io::panels_json::finding;
use crate::make::{
    MakeError, PanelFiles, PanelJob, Panelled, panel_model, panel_outputs, with_material,
};
use crate::panel::{PanelCheck, PanelElement, PanelFinding, PanelParams};
use crate::sheet::SheetParams;
use crate::unfold::MeshSource;
use crate::units::counted;

/// Make every face a plate of constant thickness: mitres, gaps, joints, schedule, sheets, assembly
/// map and 3D files
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold panels facade.obj --thickness 10mm --gap 8mm --side out --sheet \
    3210x6000 -o out\n\
    Example: kerfold panels box.obj --thickness 4mm --edges 30-140:finger --cutting square --kerf 0.2mm -o out"
)]
pub(super) struct PanelsArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    panels: PanelParams,
    #[command(flatten)]
    files: PanelFiles,
    #[command(flatten)]
    sheet: SheetParams,
    /// The folder for schedule, sheets, map and 3D files; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &PanelsArgs, console: &Console) -> Result<Outcome, CliError> {
    let read = args.input.read()?;
    let sheet = with_material(&args.sheet, Path::new("")).map_err(MakeError::from)?;
    let sheet = args.input.titled(sheet);
    let progress = Terminal::new(console.quiet);
    let source = MeshSource { scale: read.scale, split_vertices: &read.splits };
    let job = PanelJob { panels: &args.panels, files: &args.files, sheet: &sheet };
    let panelled = panel_model(&read.mesh, job, &source, &progress)?;
    let command = command_line();
    let outputs = panel_outputs(&panelled, &read.mesh, &sheet, &command)?;
    let written = console.write_folder(&args.output, outputs, args.clean)?;
    let notes: Vec<String> =
        read.notes.iter().map(ToString::to_string).chain(panelled.notes()).collect();
    if console.json {
        let summary = json!({
            "command": command, "written": written, "notes": notes, "model": model_json(&read.mesh),
            "panels": panels_json(&panelled),
            "fabrication": summary_json(&panelled.fabrication, &sheet),
        });
        console.result(&format!("{summary:#}\n"))?;
    } else {
        console.notes(&notes);
        console.result(&format!("{}\n{}", model_text(&read.mesh), panels_text(&panelled)))?;
    }
    Ok(if panelled.findings.is_empty() { Outcome::Clean } else { Outcome::Findings })
}

/// How many findings are printed before they are only counted.
const LISTED: usize = 20;

/// Panels, edges, nodes and sheets in a few lines.
pub(super) fn panels_text(panelled: &Panelled) -> String {
    let (schedule, totals) = (&panelled.schedule, &panelled.schedule.totals);
    let mirrored: usize = schedule.groups.iter().map(|g| g.mirrored).sum();
    let mut text = format!(
        "{}, {} different ({} of another), {} m², {} kg\n",
        counted(schedule.panels.len(), "panel", "panels"),
        schedule.groups.len(),
        counted(mirrored, "is a mirror image", "are mirror images"),
        short(totals.area * 1e-6),
        short(totals.mass),
    );
    let mitres = || schedule.edges.iter().flat_map(|e| e.mitres.into_iter().flatten());
    let (least, most) =
        mitres().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), m| (a.min(m), b.max(m)));
    if least <= most {
        text += &format!(
            "{}, mitres {least:.2}° to {most:.2}° off square, ",
            counted(schedule.edges.len(), "edge", "edges")
        );
        text += &format!("{} m of edges cut at an angle\n", short(totals.bevelled * 1e-3));
    }
    let openings =
        schedule.edges.iter().filter_map(|e| e.opening).map(|[front, back]| (front - back).abs());
    let widest = openings.fold(0.0, f64::max);
    // Less than the finest file can show is rounding.
    if widest > 1e-6 {
        text += &format!("V-gaps of square cuts: up to {} mm\n", short(widest));
    }
    text += &format!(
        "{}, {} with more than three edges; residual up to {} mm per mm, plates miss by up \
        to {} mm\n",
        counted(schedule.nodes.len(), "node", "nodes"),
        totals.nodes_above_three,
        settled(totals.residual),
        settled(totals.miss_mm),
    );
    let layout = &panelled.fabrication.sheets.layout;
    if !layout.sheets.is_empty() {
        text += &format!(
            "{}, {:.0} % used, {} m to cut\n",
            counted(layout.sheets.len(), "sheet", "sheets"),
            100.0 * layout.density,
            short(layout.cut_length * 1e-3)
        );
    }
    for finding in panelled.findings.iter().take(LISTED) {
        text += &finding_text(finding);
    }
    if panelled.findings.len() > LISTED {
        text += &format!(
            "and {}, listed in panels.json\n",
            counted(panelled.findings.len() - LISTED, "more finding", "more findings")
        );
    }
    text
}

fn finding_text(finding: &PanelFinding) -> String {
    let code = finding.check.code();
    let (measured, limit) = (short(finding.measured), short(finding.limit));
    let place = match finding.element {
        PanelElement::Node(vertex) => format!("vertex {vertex}"),
        PanelElement::Face(face) => format!("face {face}"),
    };
    match finding.check {
        PanelCheck::Valence3 => {
            format!("finding {code}: {place} has {} edges instead of 3\n", finding.measured)
        }
        PanelCheck::Conical => format!(
            "finding {code}: the plates of {place} miss each other by {measured} mm per mm of \
            offset (at most {limit})\n"
        ),
        PanelCheck::Planar => format!(
            "finding {code}: {place} is not planar: a corner lies {measured} mm off its plane (at \
            most {limit} mm), its plate is cut back by as much\n"
        ),
    }
}

pub(super) fn panels_json(panelled: &Panelled) -> Value {
    let (schedule, totals) = (&panelled.schedule, &panelled.schedule.totals);
    json!({
        "count": schedule.panels.len(), "different": schedule.groups.len(), "area_mm2": totals.area,
        "mass_kg": totals.mass,
        "edge_work_mm": totals.bevelled, "nodes_above_valence_3": totals.nodes_above_three,
        "largest_residual_mm_per_mm": totals.residual, "largest_miss_mm": totals.miss_mm,
        "verdict": if panelled.findings.is_empty() { "pass" } else { "fail" },
        "findings": panelled.findings.iter().map(finding).collect::<Vec<_>>(),
    })
}

/// A length for people: what is below a millionth is rounding.
fn settled(mm: f64) -> String {
    if mm < 1e-6 { "0".to_owned() } else { short(mm) }
}
