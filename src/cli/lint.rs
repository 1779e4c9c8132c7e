//! `kerfold lint`

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::CliError;
use super::output::{command_line, short};
use super::{Console, Outcome};
use crate::code::Coded;
use crate::io::artwork::read_artwork;
use crate::lint::{Artwork, LintFinding, LintParams, LintReport, lint};
use crate::make::{MakeError, material};
use crate::units::counted;

/// Find what a shop would send back in drawings to be cut, anybody's: SVG, DXF or PDF
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold lint out/sheet-01.dxf --sheet 600x400 --thickness 3mm\n\n\
    Layers tell what is cut, scored and engraved by their names (cut, score, fold, engrave, info, ...); without names, colours do: \
    where red is used, blue is scored, black and green are engraved. Exit code 1 when something is found."
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
    let text = if console.json { as_json(&judged, is_clean) } else { as_text(&judged) };
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
    let bytes = std::fs::read(file)
        .map_err(|error| CliError::Unreadable { path: file.to_owned(), error })?;
    let (format, pages) = read_artwork(file, &bytes)
        .map_err(|error| CliError::Artwork { path: file.to_owned(), error })?;
    let judge = |(page, artwork): (usize, Artwork)| {
        let report = lint(&artwork, params);
        Judged { file: file.to_owned(), format: format.name(), page: page + 1, artwork, report }
    };
    Ok(pages.into_iter().enumerate().map(judge).collect())
}

fn as_text(judged: &[Judged]) -> String {
    let mut text = String::new();
    for page in judged {
        let mut head = page.file.display().to_string();
        if page.page > 1 {
            head += &format!(" page {}", page.page);
        }
        for finding in &page.report.findings {
            text += &format!("{head}: {} {}", finding.check.code(), finding.check.name());
            if let Some(at) = finding.at {
                text += &format!(" at {:.2}, {:.2}", at.x, at.y);
            }
            let element = if finding.element.is_empty() {
                String::new()
            } else {
                format!("{} ", finding.element)
            };
            text += &format!(": {element}{}; {}\n", finding.words, finding.check.advice());
        }
        for (kind, count) in &page.artwork.unread {
            text += &format!("{head}: not judged: {count} × {kind}\n");
        }
        let size = page
            .artwork
            .size
            .map_or(String::new(), |s| format!(" on {} × {} mm", short(s.x), short(s.y)));
        let (lines, count) = (page.artwork.paths.len(), page.report.findings.len());
        let verdict = if count == 0 {
            "pass".to_owned()
        } else {
            format!("FAIL, {}", counted(count, "finding", "findings"))
        };
        text += &format!("{head}: {}{size}: {verdict}\n", counted(lines, "line", "lines"));
    }
    text
}

fn as_json(judged: &[Judged], is_clean: bool) -> String {
    let files: Vec<Value> = judged
        .iter()
        .map(|page| {
            let unread: Vec<Value> =
                page.artwork.unread.iter().map(|(kind, count)| json!({ "kind": kind, "count": count })).collect();
            json!({
                "file": page.file, "format": page.format, "page": page.page, "lines": page.artwork.paths.len(),
                "size_mm": page.artwork.size.map(|s| [s.x, s.y]), "not_judged": unread,
                "findings": page.report.findings.iter().map(finding).collect::<Vec<_>>(),
            })
        })
        .collect();
    let verdict = if is_clean { "pass" } else { "fail" };
    format!("{:#}\n", json!({ "command": command_line(), "files": files, "verdict": verdict }))
}

fn finding(finding: &LintFinding) -> Value {
    json!({
        "check": finding.check.name(), "code": finding.check.code().to_string(), "element": finding.element, "at": finding.at.map(|p| [p.x, p.y]),
        "measured": finding.measured, "limit": finding.limit, "unit": finding.measured.map(|_| "mm"),
        "message": finding.words, "advice": finding.check.advice(),
    })
}
