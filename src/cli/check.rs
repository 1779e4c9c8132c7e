//! `kerfold check`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::Input;
use super::output::command_line;
use super::{Console, Outcome};
use crate::check::{CheckFinding, CheckKind, CheckParams, Element, Report, Unit, check, details};
use crate::io::ReadNote;
use crate::io::output::write_file;
use crate::io::report::csv::check_csv;
use crate::io::report::html::check_html;
use crate::io::report::json::check_json_with;
use crate::io::report::page::{ReportPage, ReportRows};
use crate::io::report::pdf::check_pdf;
use crate::io::report::text::check_text;
use crate::make::report_pictures;
use crate::mesh::Mesh;
use crate::picture::{RenderParams, UpAxis, View};

/// Measure planarity, valence, manifoldness, convexity and genus against limits; exit code 1 when
/// something breaks them
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold check facade.obj --profile glass --require planar,valence3 \
    --report facade.json"
)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    check: CheckParams,
    /// Also write the report to a file: .html (one page with pictures), .pdf (the same on A4),
    /// .json or .csv
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Rows of the lists of vertices and edges in JSON, and of all lists in HTML and PDF: without
    /// it JSON has none of the two, the others the worst
    #[arg(long, value_enum, default_value_t)]
    rows: ReportRows,
    /// Where to look from in the pictures of the report, as in `render`
    #[arg(long, default_value_t, allow_hyphen_values = true)]
    view: View,
    /// The axis of the model that points up in the pictures
    #[arg(long, value_enum, default_value_t)]
    up: UpAxis,
}

pub(super) fn run(args: &CheckArgs, console: &Console) -> Result<Outcome, CliError> {
    let format = args.report.as_deref().map(report_format).transpose()?;
    let read = args.input.read()?;
    let mut report = check(&read.mesh, &args.check)?;
    report.findings.extend(read.notes.iter().filter_map(unit_finding));
    let command = command_line();
    if let Some((path, format)) = args.report.as_ref().zip(format) {
        let bytes = match format {
            ReportFormat::Html => {
                page(args, &read.mesh, &report, |page| check_html(page).into_bytes(), &command)?
            }
            ReportFormat::Pdf => page(args, &read.mesh, &report, check_pdf, &command)?,
            ReportFormat::Json => json(args, &read.mesh, &report, &command).into_bytes(),
            ReportFormat::Csv => check_csv(&report, &command).into_bytes(),
        };
        write_file(path, &bytes)?;
    }
    console.notes(&read.notes);
    let text = if console.json {
        json(args, &read.mesh, &report, &command)
    } else {
        check_text(&report, &command)
    };
    console.result(&text)?;
    Ok(if report.has_findings() { Outcome::Findings } else { Outcome::Clean })
}

/// A finding where the file names another unit than the one that it was read with.
fn unit_finding(note: &ReadNote) -> Option<CheckFinding> {
    let ReadNote::OtherUnit { stated, taken } = *note else { return None };
    Some(CheckFinding {
        check: CheckKind::OtherUnit,
        element: Element::Model,
        id: 0,
        measured: taken.mm(),
        limit: stated.mm(),
        unit: Unit::Mm,
        message: note.to_string(),
    })
}

fn json(args: &CheckArgs, mesh: &Mesh, report: &Report, command: &str) -> String {
    let details = (args.rows == ReportRows::All).then(|| details(mesh));
    check_json_with(report, details.as_ref(), command)
}

/// The report for people, by the writer of its format.
fn page(
    args: &CheckArgs,
    mesh: &Mesh,
    report: &Report,
    write: impl Fn(&ReportPage<'_>) -> Vec<u8>,
    command: &str,
) -> Result<Vec<u8>, CliError> {
    let render = RenderParams { view: args.view, up: args.up, ..RenderParams::default() };
    let pictures = report_pictures(mesh, report, &render)?;
    let title = args.input.input.file_name().map_or("model".into(), |name| name.to_string_lossy());
    let title = if title == "-" { "model".into() } else { title };
    let details = details(mesh);
    let page = ReportPage {
        title: &title,
        report,
        details: &details,
        pictures: &pictures,
        rows: args.rows,
        command,
    };
    Ok(write(&page))
}

#[derive(Clone, Copy)]
enum ReportFormat {
    Html,
    Pdf,
    Json,
    Csv,
}

/// Chosen before anything is read, so that a mistyped name costs nothing.
fn report_format(path: &Path) -> Result<ReportFormat, CliError> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("html" | "htm") => Ok(ReportFormat::Html),
        Some("pdf") => Ok(ReportFormat::Pdf),
        Some("json") => Ok(ReportFormat::Json),
        Some("csv") => Ok(ReportFormat::Csv),
        _ => Err(CliError::UnknownReport { path: path.to_owned() }),
    }
}
