//! `kerfold run`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::output::{Clean, command_line, model_json, model_text};
use super::panels::{panels_json, panels_text};
use super::terminal::Terminal;
use super::unfold::{summary_json, summary_text};
use super::{Console, Outcome};
use crate::gallery::{bundled_recipe, unpacked};
use crate::io::decode_text;
use crate::make::Fabrication;
use crate::recipe::{Job, Recipe, job_outputs};
use crate::sheet::SheetParams;

/// Run a recipe: model, picture, report, pieces and sheets into a folder
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold run fixtures/recipes/two-piece-d-form.toml -o out")]
pub(super) struct RunArgs {
    /// The recipe: a TOML file, or the name of a recipe that comes with kerfold, such as
    /// two-piece-d-form
    #[arg(value_name = "RECIPE")]
    recipe: PathBuf,
    /// Another value for a parameter of the recipe, such as size=200mm; more than once for several
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<(String, String)>,
    /// The folder for everything that the recipe makes; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &RunArgs, console: &Console) -> Result<Outcome, CliError> {
    let bundled = bundled_recipe(&args.recipe);
    let text = bundled.map_or_else(|| read_text(&args.recipe), |file| Ok(file.text.to_owned()))?;
    let recipe = Recipe::parse_with(&text, &args.set).map_err(|error| CliError::Recipe {
        path: args.recipe.clone(),
        error: Box::new(error),
        text,
    })?;
    // Bundled recipes read their meshes from beside them, so they get a folder with all of them.
    let beside = bundled.map(unpacked).transpose()?;
    let folder = match &beside {
        Some((_, folder)) => folder.as_path(),
        None => args.recipe.parent().unwrap_or(Path::new("")),
    };
    let job = Job::run(&recipe, folder, &Terminal::new(console.quiet))
        .map_err(|error| CliError::RecipeStep { path: args.recipe.clone(), error })?;
    finish(&job, recipe.name, (&args.output, args.clean), console)
}

/// Writes everything that a job has made into a folder and reports it.
pub(super) fn finish(
    job: &Job,
    name: Option<String>,
    (folder, clean): (&Path, Clean),
    console: &Console,
) -> Result<Outcome, CliError> {
    let command = command_line();
    let written = console.write_folder(folder, job_outputs(job, &command)?, clean)?;
    if let (false, Some(made)) = (job.has_mesh(), &job.fabrication) {
        return nested(made, job, (name, &command, &written), console);
    }
    let report = job.report()?;
    let has_findings = report.has_findings();
    let panelled = job.panelled.as_ref().map(|(panelled, _)| panelled);
    if console.json {
        let summary = json!({
            "command": command, "name": name, "written": written, "notes": job.notes,
            "model": model_json(job.mesh()?),
            "verdict": report.verdict().name(),
            "fabrication": job.fabrication.as_ref().map(|(f, sheet)| summary_json(f, sheet)),
            "panels": panelled.map(panels_json),
            "unclean": job.with_findings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        });
        console.result(&format!("{summary:#}\n"))?;
    } else {
        console.notes(&job.notes);
        let mut text = name.map_or_else(String::new, |name| name + "\n");
        text += &format!(
            "{}\ncheck: {} ({})\n",
            model_text(job.mesh()?),
            report.verdict().name(),
            job.check.profile.name()
        );
        job.with_findings.iter().for_each(|step| text += &format!("{step}\n"));
        text +=
            &job.fabrication.as_ref().map_or_else(String::new, |(f, sheet)| summary_text(f, sheet));
        text += &panelled.map_or_else(String::new, panels_text);
        for path in &written {
            text += &format!("wrote {path}\n");
        }
        console.result(&text)?;
    }
    let has_panel_findings = panelled.is_some_and(|p| !p.findings.is_empty());
    let is_unclean =
        has_findings && job.is_check_asked || has_panel_findings || !job.with_findings.is_empty();
    let has_sheet_findings =
        job.fabrication.as_ref().is_some_and(|(f, _)| !f.findings().is_empty());
    Ok(if is_unclean || has_sheet_findings { Outcome::Findings } else { Outcome::Clean })
}

/// Tells about a job that had pieces and no model.
fn nested(
    (fabrication, sheet): &(Fabrication, SheetParams),
    job: &Job,
    (name, command, written): (Option<String>, &str, &[String]),
    console: &Console,
) -> Result<Outcome, CliError> {
    if console.json {
        let told = json!({
            "command": command, "name": name, "written": written, "notes": job.notes,
            "fabrication": summary_json(fabrication, sheet),
        });
        console.result(&format!("{told:#}\n"))?;
    } else {
        console.notes(&job.notes);
        let name = name.map_or_else(String::new, |name| name + "\n");
        let paths: String = written.iter().map(|path| format!("wrote {path}\n")).collect();
        console.result(&format!("{name}{}{paths}", summary_text(fabrication, sheet)))?;
    }
    Ok(if fabrication.findings().is_empty() { Outcome::Clean } else { Outcome::Findings })
}

/// `size=200mm`.
fn setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}` sets nothing; write it like size=200mm"))?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

fn read_text(path: &Path) -> Result<String, CliError> {
    let bytes = std::fs::read(path)
        .map_err(|error| CliError::Unreadable { path: path.to_owned(), error })?;
    decode_text(&bytes).map_err(|at| CliError::NotText { path: path.to_owned(), at })
}
