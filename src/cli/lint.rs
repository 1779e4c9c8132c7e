//! `kerfold lint`

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::CliError;
use super::output::{command_line, short};
use super::{Console, Outcome};
use crate::code::Coded;
use crate::io::artwork::{LARGEST_FILE, read_artwork};
use crate::lint::{Artwork, Check, LintFinding, LintParams, LintReport, lint_pages};
use crate::make::{MakeError, material};
use crate::units::counted;

/// Find what a shop would send back in drawings to be cut, anybody's: SVG, DXF or PDF
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold lint out/sheet-01.dxf --sheet 600x400 --thickness 3mm\n\n\
    Layers tell what is cut, scored and engraved by their names (cut, score, fold, engrave, info, ...); without names, colours do: \
    where red is used, blue is scored, black and green are engraved; in the colours of boxes.py, black and blue are cut and red is a note. \
    Exit code 1 when something is found."
)]
pub(super) struct LintArgs {
    /// The drawings
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    params: LintParams,
    /// Take thickness, kerf and least web from a material, where they are not given
    #[arg(long, value_name = "NAME")]
    material: Option<String>,
    /// A file with further materials (TOML)
    #[arg(long, value_name = "FILE", requires = "material")]
    materials: Option<PathBuf>,
    /// List all findings; else twenty of each check, and how many more there are
    #[arg(long)]
    all: bool,
}

/// How many findings of one check are listed before they are only counted.
const LISTED: usize = 20;

impl LintArgs {
    fn listed(&self) -> usize {
        if self.all { usize::MAX } else { LISTED }
    }
}

/// One page of one file.
struct Judged {
    file: PathBuf,
    format: &'static str,
    page: usize,
    artwork: Artwork,
    report: LintReport,
}

pub(super) fn run(args: &LintArgs, console: &Console) -> Result<Outcome, CliError> {
    let params = limits(args)?;
    params.check().map_err(CliError::Limit)?;
    let mut judged = Vec::new();
    for file in &args.files {
        judged.extend(judge(file, &params)?);
    }
    let is_clean = judged.iter().all(|j| j.report.is_clean());
    let listed = args.listed();
    let text = if console.json {
        as_json(&judged, listed, is_clean)
    } else {
        judged.iter().map(|page| page_as_text(page, listed)).collect()
    };
    console.result(&text)?;
    Ok(if is_clean { Outcome::Clean } else { Outcome::Findings })
}

fn limits(args: &LintArgs) -> Result<LintParams, CliError> {
    let mut params = args.params.clone();
    if let Some(name) = &args.material {
        let made_of = material(name, args.materials.as_deref())
            .map_err(|e| CliError::Step(MakeError::from(e)))?;
        params.thickness = params.thickness.or(Some(made_of.thickness));
        params.kerf = params.kerf.or(Some(made_of.kerf));
        params.web = params.web.or(Some(made_of.web));
    }
    Ok(params)
}

fn judge(file: &Path, params: &LintParams) -> Result<Vec<Judged>, CliError> {
    let bytes =
        read(file).map_err(|error| CliError::Unreadable { path: file.to_owned(), error })?;
    let (format, pages) = read_artwork(file, &bytes)
        .map_err(|error| CliError::Artwork { path: file.to_owned(), error })?;
    let reports = lint_pages(&pages, params)
        .map_err(|error| CliError::Lint { path: file.to_owned(), error })?;
    let numbered = pages.into_iter().zip(reports).enumerate();
    let judged = numbered.map(|(page, (artwork, report))| Judged {
        file: file.to_owned(),
        format: format.name(),
        page: page + 1,
        artwork,
        report,
    });
    Ok(judged.collect())
}

/// The bytes of a file; of one that is too large only as many as show that it is.
fn read(file: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(file)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn page_as_text(page: &Judged, listed: usize) -> String {
    let mut head = page.file.display().to_string();
    if page.page > 1 {
        head += &format!(" page {}", page.page);
    }
    let mut text = String::new();
    for finding in page.report.at_most(listed) {
        text += &format!("{head}: {}\n", finding_as_text(finding));
    }
    for (check, more) in unlisted(&page.report, listed) {
        let code = check.code();
        text += &format!("{head}: {code} {}: {more} more, list them with --all\n", check.name());
    }
    for (kind, count) in &page.artwork.unread {
        text += &format!("{head}: not judged: {count} × {kind}\n");
    }
    for note in &page.artwork.notes {
        text += &format!("{head}: note: {note}\n");
    }
    if !page.report.skipped.is_empty() {
        text += &format!("{head}: not checked: {}\n", names(&page.report.skipped).join(", "));
    }
    text + &format!("{head}: {}\n", verdict(page))
}

fn finding_as_text(finding: &LintFinding) -> String {
    let place = finding.at.map_or(String::new(), |at| format!(" at {:.2}, {:.2}", at.x, at.y));
    let element = match finding.element.as_str() {
        "" => String::new(),
        element => format!("{element} "),
    };
    let (code, name) = (finding.check.code(), finding.check.name());
    format!("{code} {name}{place}: {element}{}; {}", finding.words, finding.check.advice())
}

/// How many findings of each check are not listed.
fn unlisted(report: &LintReport, listed: usize) -> Vec<(Check, usize)> {
    let more = |(check, count): (Check, usize)| (check, count.saturating_sub(listed));
    report.counts().into_iter().map(more).filter(|(_, more)| *more > 0).collect()
}

fn verdict(page: &Judged) -> String {
    let size = page.artwork.size;
    let size = size.map_or(String::new(), |s| format!(" on {} × {} mm", short(s.x), short(s.y)));
    let findings = match page.report.findings.len() {
        0 => "pass".to_owned(),
        count => format!("FAIL, {}", counted(count, "finding", "findings")),
    };
    format!("{}{size}: {findings}", counted(page.artwork.paths.len(), "line", "lines"))
}

fn names(checks: &[Check]) -> Vec<&'static str> {
    checks.iter().map(|check| check.name()).collect()
}

fn as_json(judged: &[Judged], listed: usize, is_clean: bool) -> String {
    let files: Vec<Value> = judged.iter().map(|page| page_as_json(page, listed)).collect();
    let verdict = if is_clean { "pass" } else { "fail" };
    format!("{:#}\n", json!({ "command": command_line(), "files": files, "verdict": verdict }))
}

fn page_as_json(page: &Judged, listed: usize) -> Value {
    let unread = page.artwork.unread.iter();
    let unread: Vec<Value> =
        unread.map(|(kind, count)| json!({ "kind": kind, "count": count })).collect();
    let counts = page.report.counts().into_iter();
    let counts: serde_json::Map<String, Value> =
        counts.map(|(check, count)| (check.name().to_owned(), json!(count))).collect();
    json!({
        "file": page.file.display().to_string(),
        "format": page.format,
        "page": page.page,
        "lines": page.artwork.paths.len(),
        "size_mm": page.artwork.size.map(|s| [s.x, s.y]),
        "not_judged": unread,
        "notes": page.artwork.notes,
        "skipped": names(&page.report.skipped),
        "counts": counts,
        "findings": page.report.at_most(listed).map(finding_as_json).collect::<Vec<_>>(),
    })
}

fn finding_as_json(finding: &LintFinding) -> Value {
    json!({
        "check": finding.check.name(),
        "code": finding.check.code().to_string(),
        "element": finding.element,
        "at": finding.at.map(|p| [p.x, p.y]),
        "measured": finding.measured,
        "limit": finding.limit,
        "unit": finding.measured.map(|_| "mm"),
        "message": finding.words,
        "advice": finding.check.advice(),
    })
}
