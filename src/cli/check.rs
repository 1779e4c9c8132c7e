//! `kerfold check`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::Input;
use super::output::command_line;
use super::{Console, Outcome};
use crate::check::{CheckParams, Report, check};
use crate::io::output::write_file;
use crate::io::report_csv::check_csv;
use crate::io::report_json::check_json;
use crate::io::report_text::check_text;

/// Measure planarity, valence, manifoldness, convexity and genus against limits; exit code 1 when something breaks them
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold check facade.obj --profile glass --require planar,valence3 --report facade.json"
)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    check: CheckParams,
    /// Also write the report to a file: .json or .csv
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

pub(super) fn run(args: &CheckArgs, console: &Console) -> Result<Outcome, CliError> {
    let writer = args.report.as_deref().map(report_writer).transpose()?;
    let read = args.input.read()?;
    let report = check(&read.mesh, &args.check)?;
    let command = command_line();
    if let Some((path, write)) = args.report.as_ref().zip(writer) {
        write_file(path, write(&report, &command).as_bytes())?;
    }
    console.notes(&read.notes);
    let text = if console.json { check_json(&report, &command) } else { check_text(&report, &command) };
    console.result(&text)?;
    Ok(if report.has_findings() { Outcome::Findings } else { Outcome::Clean })
}

type ReportWriter = fn(&Report, &str) -> String;

/// Chosen before anything is read, so that a mistyped name costs nothing.
fn report_writer(path: &Path) -> Result<ReportWriter, CliError> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("json") => Ok(check_json),
        Some("csv") => Ok(check_csv),
        _ => Err(CliError::UnknownReport { path: path.to_owned() }),
    }
}
