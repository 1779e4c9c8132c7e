//! `kerfold nest`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::output::{Clean, command_line, short};
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::make::{
    Fabrication, MakeError, NestStep, fabrication_outputs, nest_files, with_material,
};
use crate::sheet::SheetParams;
use crate::units::counted;

/// Lay anybody's flat pieces out on sheets, close together, and draw the sheets
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold nest parts.json --sheet 600x400 --spacing 2 --effort 100 -o \
    out\n\n\
    A file of pieces is {\"pieces\": \
    [{\"outline\": [[x,y], ...]}]}, in mm; a piece may have \"id\", \"holes\", \"quantity\", \
    \"rotation\" (as --rotations) and \"group\" (pieces of a group share a sheet). Ctrl-C ends the \
    search; the best layout so \
    far is written. Exit code 2 when a piece is larger than every sheet."
)]
pub(super) struct NestArgs {
    #[command(flatten)]
    nest: NestStep,
    #[command(flatten)]
    sheet: SheetParams,
    /// The folder for pieces.json, layout.json and the sheets; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &NestArgs, console: &Console) -> Result<Outcome, CliError> {
    let progress = Terminal::new(console.quiet);
    let sheet = with_material(&args.sheet, Path::new("")).map_err(MakeError::from)?;
    let title = args.nest.pieces.first().and_then(|path| path.file_stem());
    let sheet = sheet.titled(&title.unwrap_or_default().to_string_lossy());
    let fabrication = nest_files(&args.nest, &sheet, Path::new(""), &progress)?;
    let command = command_line();
    let outputs = fabrication_outputs(&fabrication, None, &sheet, &command)?;
    let written = console.write_folder(&args.output, outputs, args.clean)?;
    let notes = fabrication.notes();
    if console.json {
        let layout = &fabrication.sheets.layout;
        let told = json!({
            "command": command, "written": written, "notes": notes,
            "findings": fabrication.findings(),
            "pieces": fabrication.net.pieces.len(),
            "sheets": layout.sheets.len(), "density": layout.density,
            "cut_length": layout.cut_length,
            "offcut": layout.sheets.last().and_then(|s| s.offcut),
        });
        console.result(&format!("{told:#}\n"))?;
    } else {
        console.notes(&notes);
        let found: String = fabrication.findings().iter().map(|f| format!("{f}\n")).collect();
        console.result(&(text(&fabrication) + &found))?;
    }
    Ok(if fabrication.findings().is_empty() { Outcome::Clean } else { Outcome::Findings })
}

fn text(fabrication: &Fabrication) -> String {
    let layout = &fabrication.sheets.layout;
    let mut text = format!(
        "{} on {}, {:.1} % used, {} mm to cut\n",
        counted(fabrication.net.pieces.len(), "piece", "pieces"),
        counted(layout.sheets.len(), "sheet", "sheets"),
        100.0 * layout.density,
        short(layout.cut_length)
    );
    if let Some([low, high]) = layout.sheets.last().and_then(|s| s.offcut) {
        let size = high - low;
        text +=
            &format!("{} × {} mm of the last sheet are left whole\n", short(size.x), short(size.y));
    }
    text
}
