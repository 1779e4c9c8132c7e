//! `kerfold run --sweep`: a list of commands instead of a run, and a table of what they left.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::input::read_text;
use super::output::{Clean, command_line};
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::recipe::{MANIFEST, Sweep};
use crate::units::counted;

/// A table of variants instead of one run.
#[derive(Debug, clap::Args)]
pub(super) struct SweepArgs {
    /// Run nothing, but write DIR/commands.txt: one command for each line of a table (CSV), whose
    /// first line names parameters of the recipe and may have a column `name` for the folders; GNU
    /// parallel, make or a batch queue runs them
    #[arg(long, value_name = "TABLE.csv", conflicts_with_all = ["set", "manifest", "clean"])]
    sweep: Option<PathBuf>,
    /// Run nothing, but gather what the commands of the table have left into one table (CSV); exit
    /// code 1 while some have not run
    #[arg(long, value_name = "RESULTS.csv", requires = "sweep")]
    results: Option<PathBuf>,
}

impl SweepArgs {
    pub(super) fn is_asked(&self) -> bool {
        self.sweep.is_some()
    }
}

/// Writes the commands, or gathers their results.
pub(super) fn run(
    args: &SweepArgs,
    (recipe, text): (&Path, &str),
    folder: &Path,
    console: &Console,
) -> Result<Outcome, CliError> {
    let Some(table) = &args.sweep else { return Ok(Outcome::Clean) };
    let told = |error| CliError::Sweep { path: table.clone(), error };
    let sweep = Sweep::parse(&read_text(table)?, text).map_err(told)?;
    match &args.results {
        Some(results) => gather(&sweep, (table, folder), results, console),
        None => list(&sweep, recipe, folder, console),
    }
}

fn list(
    sweep: &Sweep,
    recipe: &Path,
    folder: &Path,
    console: &Console,
) -> Result<Outcome, CliError> {
    let commands = sweep.commands(&recipe.to_string_lossy(), &folder.to_string_lossy());
    let text = (commands.join("\n") + "\n").into_bytes();
    let files = vec![("commands.txt".to_owned(), text)];
    let path = console.write_folder(folder, files, Clean { clean: false })?.join(", ");
    let text = match console.json {
        true => {
            let (command, variants) = (command_line(), commands.len());
            format!("{:#}\n", json!({ "command": command, "written": path, "variants": variants }))
        }
        false => format!(
            "wrote {path}: {}; run them with `parallel < {path}` or `sh {path}`\n",
            counted(commands.len(), "command", "commands")
        ),
    };
    console.result(&text)?;
    Ok(Outcome::Clean)
}

fn gather(
    sweep: &Sweep,
    (table, folder): (&Path, &Path),
    results: &Path,
    console: &Console,
) -> Result<Outcome, CliError> {
    let manifest = |name: &str| folder.join(name).join(MANIFEST);
    let read = |name: &str| match manifest(name) {
        path if path.exists() => read_text(&path).map(Some),
        _ => Ok(None),
    };
    let manifests: Vec<Option<String>> =
        sweep.variants.iter().map(|variant| read(&variant.folder)).collect::<Result<_, _>>()?;
    let found = sweep
        .results(&manifests)
        .map_err(|error| CliError::Sweep { path: table.to_owned(), error })?;
    write_file(results, found.table.as_bytes())?;
    let (all, done) = (manifests.len(), found.done);
    let path = results.to_string_lossy();
    let told = match console.json {
        true => {
            let counts = json!({ "written": path, "variants": all, "done": done });
            format!("{counts:#}\n")
        }
        false => {
            let first = found.first_open.map_or_else(String::new, |folder| {
                format!("; the first that has not run is {folder}")
            });
            format!("wrote {path}: {done} of {} done{first}\n", counted(all, "variant", "variants"))
        }
    };
    if results != Path::new("-") {
        console.result(&told)?;
    }
    Ok(if done == all { Outcome::Clean } else { Outcome::Findings })
}
