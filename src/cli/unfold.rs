//! `kerfold unfold`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::input::Input;
use super::output::{Clean, command_line, model_text, short};
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::make::{
    FabricateParams, FabricateSettings, Fabrication, MakeError, ShowParams, fabricate,
    fabrication_outputs, show_outputs, with_material,
};
use crate::net::Net;
use crate::picture::RenderParams;
use crate::progress::Progress;
use crate::sheet::SheetParams;
use crate::unfold::{MeshSource, UnfoldParams};
use crate::units::counted;

/// Unfold a mesh into flat pieces that never overlap, and lay them out on sheets
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold unfold model.obj --sheet 600x400 --kerf 0.15mm -o out")]
pub(super) struct UnfoldArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    unfold: UnfoldParams,
    #[command(flatten)]
    choice: FabricateParams,
    #[command(flatten)]
    sheet: SheetParams,
    #[command(flatten)]
    show: ShowParams,
    /// The folder for pieces.json, layout.json and the sheets; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &UnfoldArgs, console: &Console) -> Result<Outcome, CliError> {
    let read = args.input.read()?;
    let sheet = with_material(&args.sheet, Path::new("")).map_err(MakeError::from)?;
    let sheet = args.input.titled(sheet);
    let progress = Terminal::new(console.quiet);
    let source = MeshSource { scale: read.scale, split_vertices: &read.splits };
    let settings = FabricateSettings { unfold: &args.unfold, choice: &args.choice, sheet: &sheet };
    let fabrication = fabricate(&read.mesh, read.made.as_ref(), &settings, &source, &progress)?;
    let command = command_line();
    let mut outputs = fabrication_outputs(&fabrication, Some(&read.mesh), &sheet, &command)?;
    let show = args.show.from_here();
    outputs.extend(show_outputs(
        &fabrication,
        &read.mesh,
        (&show, sheet.letter.labels),
        &RenderParams::default(),
        &command,
    )?);
    let written = console.write_folder(&args.output, outputs, args.clean)?;
    let stopped = progress
        .is_cancelled()
        .then(|| "stopped on request; the files hold the best net so far".to_owned());
    let notes: Vec<String> = read
        .notes
        .iter()
        .map(ToString::to_string)
        .chain(fabrication.notes())
        .chain(stopped)
        .collect();
    if console.json {
        let summary = json!({
            "command": command, "written": written, "notes": notes,
            "fabrication": summary_json(&fabrication, &sheet),
        });
        console.result(&format!("{summary:#}\n"))?;
    } else {
        console.notes(&notes);
        console.result(&format!(
            "{}\n{}",
            model_text(&read.mesh),
            summary_text(&fabrication, &sheet)
        ))?;
    }
    Ok(if fabrication.findings().is_empty() { Outcome::Clean } else { Outcome::Findings })
}

/// What a net consists of, in one line.
pub(super) fn net_text(net: &Net) -> String {
    [
        counted(net.pieces.len(), "piece", "pieces"),
        counted(net.folds.len(), "fold", "folds"),
        counted(net.seams.len(), "seam", "seams"),
        counted(net.rims.len(), "rim edge", "rim edges"),
    ]
    .join(", ")
}

/// Pieces, sheets and proof in a few lines.
pub(super) fn summary_text(fabrication: &Fabrication, sheet: &SheetParams) -> String {
    let (net, layout) = (&fabrication.net, &fabrication.sheets.layout);
    let mut text = net_text(net) + "\n";
    text += &format!(
        "proof: faces true to {:.1e} mm, folds up to {:.1e} mm, {}\n",
        net.proof.congruence_mm,
        net.proof.refold_mm,
        counted(net.proof.overlaps, "overlap", "overlaps")
    );
    if !layout.sheets.is_empty() {
        text += &format!(
            "{}, {:.0} % used, {} mm to cut, {} mm to score\n",
            counted(layout.sheets.len(), "sheet", "sheets"),
            100.0 * layout.density,
            short(layout.cut_length),
            short(layout.score_length)
        );
        text += &format!("{} mm between lines", short(fabrication.sheets.travel_length()));
        if let Some((material, seconds)) =
            sheet.stock.made_of.as_ref().zip(fabrication.sheets.seconds(sheet))
        {
            text += &format!(
                ", about {} min on the machine for {}",
                short((seconds / 6.0).ceil() / 10.0),
                material.title
            );
        }
        text += "\n";
    }
    fabrication.findings().iter().for_each(|finding| text += &format!("{finding}\n"));
    text
}

pub(super) fn summary_json(fabrication: &Fabrication, sheet: &SheetParams) -> serde_json::Value {
    let (net, layout) = (&fabrication.net, &fabrication.sheets.layout);
    json!({
        "pieces": net.pieces.len(), "folds": net.folds.len(), "seams": net.seams.len(),
        "rims": net.rims.len(),
        "proof": { "congruence_mm": net.proof.congruence_mm, "refold_mm": net.proof.refold_mm, "overlaps": net.proof.overlaps },
        "sheets": layout.sheets.len(), "density": layout.density,
        "cut_length": layout.cut_length, "score_length": layout.score_length,
        "findings": fabrication.findings(),
        "travel_length": fabrication.sheets.travel_length(),
        "seconds": fabrication.sheets.seconds(sheet),
    })
}
