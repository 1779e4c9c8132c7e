//! `kerfold gallery`

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::output::{Clean, command_line, write_into};
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::code::Coded;
use crate::gallery::{
    Exhibit, GalleryError, GalleryRecipe, bundled, exhibit, gallery_html, side_by_side,
};
use crate::io::decode_text;
use crate::io::output::OutputFolder;
use crate::progress::Progress;

/// Build many recipes side by side and show them on one page: those of the papers' figures, or a
/// folder of your own
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold gallery -o gallery\nExample: kerfold gallery recipes --width \
    480 -o site"
)]
pub(super) struct GalleryArgs {
    /// A folder with recipes; without it the bundled ones, which are written into the gallery as
    /// well
    #[arg(value_name = "FOLDER")]
    recipes: Option<PathBuf>,
    /// Only the recipes whose names contain one of these words
    #[arg(long, value_name = "WORD", value_delimiter = ',')]
    only: Vec<String>,
    /// Width of the pictures in pixels, 16 to 8192, instead of what the recipes say
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..=8192))]
    width: Option<u32>,
    /// The folder for the page index.html and a folder for each recipe; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &GalleryArgs, console: &Console) -> Result<Outcome, CliError> {
    let all = match &args.recipes {
        Some(folder) => recipes_in(folder)?,
        None => unpacked(&args.output)?,
    };
    let recipes = chosen(all, &args.only)?;
    let terminal = Terminal::new(console.quiet);
    let results = side_by_side(&recipes, &terminal, &|recipe, progress| {
        let (exhibit, outputs) = exhibit(recipe, args.width, progress)?;
        Ok((exhibit, write_into(&args.output.join(&recipe.name), outputs, args.clean)))
    });
    if terminal.is_cancelled() {
        return Err(CliError::Stopped);
    }
    let (mut exhibits, mut failures): (Vec<Exhibit>, Vec<GalleryError>) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok((exhibit, written)) => {
                let (_, note) = written?;
                console.notes(note.as_slice());
                exhibits.push(exhibit);
            }
            Err(failure) => failures.push(failure),
        }
    }
    let told: Vec<String> = failures.iter().map(|f| format!("{f} ({})", f.code())).collect();
    let page = args.output.join("index.html");
    // Where every recipe fails, the folder is made for the page.
    let mut files = OutputFolder::new(&args.output);
    files.add("index.html", gallery_html(&exhibits, &told, &command_line()));
    files.commit()?;
    tell(&exhibits, &told, &page, console)?;
    let total = recipes.len();
    let count = failures.len();
    if let Some(first) = failures.into_iter().next() {
        return Err(CliError::Gallery { count, total, first: Box::new(first) });
    }
    let is_clean = exhibits.iter().all(|e| e.findings.is_empty());
    Ok(if is_clean { Outcome::Clean } else { Outcome::Findings })
}

fn tell(
    exhibits: &[Exhibit],
    failures: &[String],
    page: &Path,
    console: &Console,
) -> Result<(), CliError> {
    if console.json {
        let rows: Vec<_> = exhibits.iter().map(row).collect();
        let told = json!({
            "command": command_line(), "written": page.to_string_lossy(), "recipes": rows,
            "failures": failures,
        });
        return console.result(&format!("{told:#}\n"));
    }
    let mut text = String::new();
    for e in exhibits {
        let genus = e.model.map_or_else(|| "-".to_owned(), |m| m.genus.to_string());
        let faces = e.model.map_or_else(|| "-".to_owned(), |m| m.faces.to_string());
        let pieces = e.pieces.map_or_else(|| "-".to_owned(), |(pieces, _)| pieces.to_string());
        let verdict = if e.findings.is_empty() { "pass" } else { "findings" };
        text += &format!(
            "{:<48} faces {faces:>7}  genus {genus:>5}  pieces {pieces:>4}  {verdict}\n",
            e.name
        );
    }
    console.result(&format!("{text}wrote {}\n", page.display()))
}

fn row(e: &Exhibit) -> serde_json::Value {
    json!({
        "name": e.name, "title": e.title, "findings": e.findings,
        "model": e.model.map(|m| json!({
            "vertices": m.vertices, "edges": m.edges, "faces": m.faces, "components": m.components,
            "genus": m.genus,
            "planarity_mm": m.planarity_mm,
        })),
        "pieces": e.pieces.map(|p| p.0), "sheets": e.pieces.map(|p| p.1),
    })
}

/// The recipes of a folder, by name.
fn recipes_in(folder: &Path) -> Result<Vec<GalleryRecipe>, CliError> {
    let unreadable = |error| CliError::Unreadable { path: folder.to_owned(), error };
    let mut paths = BTreeSet::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            paths.insert(path);
        }
    }
    if paths.is_empty() {
        return Err(CliError::NoRecipes { path: folder.to_owned() });
    }
    let recipe = |path: PathBuf| {
        let bytes = std::fs::read(&path)
            .map_err(|error| CliError::Unreadable { path: path.clone(), error })?;
        let text =
            decode_text(&bytes).map_err(|at| CliError::NotText { path: path.clone(), at })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(GalleryRecipe { name, text, folder: folder.to_owned() })
    };
    paths.into_iter().map(recipe).collect()
}

/// Writes the bundled recipes, and the meshes that they read, into the gallery, where they can be
/// changed and run again.
fn unpacked(output: &Path) -> Result<Vec<GalleryRecipe>, CliError> {
    let mut folders: BTreeMap<&str, OutputFolder> = BTreeMap::new();
    let mut recipes = Vec::new();
    for file in bundled() {
        let (folder, name) = file.path.rsplit_once('/').unwrap_or(("", file.path));
        let there = output.join(folder);
        folders.entry(folder).or_insert_with(|| OutputFolder::new(&there)).add(name, file.text);
        if let Some(name) = name.strip_suffix(".toml") {
            recipes.push(GalleryRecipe {
                name: name.to_owned(),
                text: file.text.to_owned(),
                folder: there,
            });
        }
    }
    for (_, files) in folders {
        files.commit()?;
    }
    recipes.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(recipes)
}

/// The recipes whose names contain one of the words; all when there are none.
fn chosen(all: Vec<GalleryRecipe>, words: &[String]) -> Result<Vec<GalleryRecipe>, CliError> {
    for word in words {
        if !all.iter().any(|r| r.name.contains(word.as_str())) {
            let known = all.iter().map(|r| r.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(CliError::UnknownRecipe { name: word.clone(), known });
        }
    }
    let is_wanted =
        |r: &GalleryRecipe| words.is_empty() || words.iter().any(|w| r.name.contains(w.as_str()));
    Ok(all.into_iter().filter(is_wanted).collect())
}
