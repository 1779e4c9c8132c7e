//! `kerfold dform`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::input::read_model;
use super::output::{Clean, command_line, model_text};
use super::run::finish;
use super::terminal::Terminal;
use super::{Console, Outcome, seams};
use crate::io::{ReadMesh, ReadOptions};
use crate::make::{DformParams, ShowParams};
use crate::recipe::{Job, Recipe, Step};
use crate::shape::{SolidName, SolidParams, solid};
use crate::sheet::SheetParams;

/// Make a D-form of a solid: choose the folds, roll them into even strips, unfold, and lay the
/// pieces out
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold dform dodecahedron --size 180mm --roll max --strips 9 -o out"
)]
pub(super) struct DformArgs {
    /// A solid by name, or a closed 3-valent mesh: OBJ, PLY, STL or OFF; `-` reads OBJ from
    /// standard input
    #[arg(value_name = "SOLID")]
    solid: PathBuf,
    #[command(flatten)]
    options: ReadOptions,
    #[command(flatten)]
    dform: DformParams,
    #[command(flatten)]
    sheet: SheetParams,
    #[command(flatten)]
    show: ShowParams,
    /// Only list the choices of folds: the table of `kerfold seams`, and choices.png in the folder with
    /// the body and the pieces of each
    #[arg(long)]
    list: bool,
    /// The folder for model, picture, report, pieces and sheets; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &DformArgs, console: &Console) -> Result<Outcome, CliError> {
    if args.list {
        return list(args, console);
    }
    let stem = args.solid.file_stem().filter(|_| args.solid.as_os_str() != "-");
    let title = stem.unwrap_or_default().to_string_lossy();
    let dform = Step::Dform {
        dform: args.dform.clone(),
        sheet: args.sheet.clone().titled(&title),
        show: args.show.from_here(),
    };
    let recipe = Recipe { name: None, steps: vec![dform] };
    let job = args
        .start()?
        .carry_on(&recipe, Path::new(""), &Terminal::new(console.quiet))
        .map_err(|error| *error.cause)?;
    finish(&job, None, (&args.output, args.clean), console)
}

/// The choices as a table and as pictures.
fn list(args: &DformArgs, console: &Console) -> Result<Outcome, CliError> {
    let job = args.start()?;
    let (mesh, progress) = (job.mesh()?, Terminal::new(console.quiet));
    let (rows, why) = seams::rows(mesh, seams::LIMIT, &progress)?;
    let picture = seams::picture(mesh, &rows, &progress)?;
    let outputs = vec![("choices.png".to_owned(), picture)];
    let written = console.write_folder(&args.output, outputs, args.clean)?;
    let notes: Vec<String> = job.notes.iter().cloned().chain(why).collect();
    if console.json {
        let rows: Vec<_> = rows.iter().map(seams::row_json).collect();
        let told = json!({ "command": command_line(), "matchings": rows, "notes": notes, "written": written });
        console.result(&format!("{told:#}\n"))?;
    } else {
        console.notes(&notes);
        let wrote: String = written.iter().map(|path| format!("wrote {path}\n")).collect();
        console.result(&format!("{}\n{}{wrote}", model_text(mesh), seams::table_text(&rows)))?;
    }
    Ok(Outcome::Clean)
}

impl DformArgs {
    /// A file wins over a solid of the same name; a word without dots and slashes is meant as a
    /// name.
    fn start(&self) -> Result<Job, CliError> {
        let word =
            self.solid.to_str().filter(|text| !text.contains(['.', '/', '\\']) && *text != "-");
        match word.filter(|_| !self.solid.is_file()) {
            Some(name) => {
                let name: SolidName = name.parse()?;
                let params = SolidParams { name, edge: None, size: self.options.size };
                Ok(Job::with_mesh(solid(&params)?, Vec::new()))
            }
            None => {
                let ReadMesh { mesh, notes, .. } = read_model(&self.solid, &self.options)?;
                Ok(Job::with_mesh(mesh, notes.iter().map(ToString::to_string).collect()))
            }
        }
    }
}
