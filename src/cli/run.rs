//! `kerfold run`

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::CliError;
use super::input::read_text;
use super::output::{Clean, command_line, model_json, model_text};
use super::panels::{panels_json, panels_text};
use super::sweep::{self, SweepArgs};
use super::terminal::Terminal;
use super::unfold::{summary_json, summary_text};
use super::{Console, Outcome};
use crate::gallery::{bundled_recipe, unpacked};
use crate::make::Fabrication;
use crate::recipe::{Job, MANIFEST, Recipe, job_outputs};
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
    /// Also write manifest.json: the recipe, its parameters, the verdict, what was counted and
    /// measured, and the files with their sizes
    #[arg(long)]
    manifest: bool,
    #[command(flatten)]
    clean: Clean,
    #[command(flatten)]
    sweep: SweepArgs,
}

pub(super) fn run(args: &RunArgs, console: &Console) -> Result<Outcome, CliError> {
    let bundled = bundled_recipe(&args.recipe);
    let text = bundled.map_or_else(|| read_text(&args.recipe), |file| Ok(file.text.to_owned()))?;
    if args.sweep.is_asked() {
        return sweep::run(&args.sweep, (&args.recipe, &text), &args.output, console);
    }
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
    let manifest = args.manifest.then(|| {
        json!({
            "recipe": args.recipe.to_string_lossy(),
            "parameters": args.set.iter().map(|(name, value)| (name.clone(), json!(value)))
                .collect::<serde_json::Map<_, _>>(),
        })
    });
    finish(&job, recipe.name, (&args.output, args.clean, manifest), console)
}

/// Writes everything that a job has made into a folder and reports it. Where a manifest was begun,
/// it is filled in and written too.
pub(super) fn finish(
    job: &Job,
    name: Option<String>,
    (folder, clean, manifest): (&Path, Clean, Option<Value>),
    console: &Console,
) -> Result<Outcome, CliError> {
    let command = command_line();
    let mut outputs = job_outputs(job, &command)?;
    if let Some(begun) = manifest {
        let told = filled(begun, job, name.as_deref(), &outputs)?;
        outputs.push((MANIFEST.to_owned(), format!("{told:#}\n").into_bytes()));
    }
    let written = console.write_folder(folder, outputs, clean)?;
    if let (false, Some(made)) = (job.has_mesh(), &job.fabrication) {
        return nested(made, job, (name, &command, &written), console);
    }
    let report = job.report()?;
    let has_findings = report.has_findings();
    let panelled = job.panelled.as_ref().map(|(panelled, _)| panelled);
    if console.json {
        let mut summary = json!({
            "command": command, "name": name, "written": written, "notes": job.notes,
        });
        add_results(&mut summary, job)?;
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

/// Puts what came out of a job to an object of JSON.
fn add_results(told: &mut Value, job: &Job) -> Result<(), CliError> {
    let fabrication = job.fabrication.as_ref().map(|(f, sheet)| summary_json(f, sheet));
    told["fabrication"] = json!(fabrication);
    if job.has_mesh() || job.fabrication.is_none() {
        told["model"] = model_json(job.mesh()?);
        told["verdict"] = json!(job.report()?.verdict().name());
        told["panels"] = json!(job.panelled.as_ref().map(|(panelled, _)| panels_json(panelled)));
        let unclean: Vec<String> = job.with_findings.iter().map(ToString::to_string).collect();
        told["unclean"] = json!(unclean);
    }
    Ok(())
}

/// A manifest with what came out of a job. No word of it depends on where or when the job ran.
fn filled(
    mut begun: Value,
    job: &Job,
    name: Option<&str>,
    outputs: &[(String, Vec<u8>)],
) -> Result<Value, CliError> {
    begun["kerfold"] = json!(env!("CARGO_PKG_VERSION"));
    begun["name"] = json!(name);
    begun["notes"] = json!(job.notes);
    let file = |(name, bytes): &(String, Vec<u8>)| json!({ "name": name, "bytes": bytes.len() });
    begun["files"] = outputs.iter().map(file).collect();
    add_results(&mut begun, job)?;
    Ok(begun)
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
