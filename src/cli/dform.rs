//! `kerfold dform`

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::CliError;
use super::input::read_model;
use super::output::{Clean, command_line, model_text};
use super::run::finish;
use super::terminal::Terminal;
use super::{Console, Outcome, seams};
use crate::io::{MeshUnit, ReadMesh, ReadOptions};
use crate::make::{DformParams, MakeError, OutlineParams, OutlinesError, ShowParams, outline_list};
use crate::picture::RenderParams;
use crate::recipe::{Job, Recipe, Step};
use crate::shape::{SolidName, SolidParams, solid};
use crate::sheet::SheetParams;

/// Make a D-form of a solid (choose the folds, roll them into even strips) or of flat outlines (the
/// one convex body that their rims close to), unfold it, and lay the pieces out
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold dform dodecahedron --size 180mm --roll max --strips 9 -o out\n\
        Example: kerfold dform --outlines ellipse-2x1@180mm ellipse-2x1@180mm --start 0.125 -o out\n\
        Example: kerfold dform --outlines ellipse-2x1@180mm --zip 0.12 -o out"
)]
pub(super) struct DformArgs {
    /// A solid by name, or a closed 3-valent mesh: OBJ, PLY, STL, OFF, GLB or 3MF; `-` reads OBJ
    /// from standard input
    #[arg(
        value_name = "SOLID",
        required_unless_present_any = ["outlines", "glue"],
        conflicts_with_all = ["outlines", "glue"]
    )]
    solid: Option<PathBuf>,
    #[command(flatten)]
    options: ReadOptions,
    #[command(flatten)]
    dform: DformParams,
    #[command(flatten)]
    outlines: OutlineParams,
    #[command(flatten)]
    sheet: SheetParams,
    #[command(flatten)]
    show: ShowParams,
    /// Only show what there is to choose from. Of a solid: the table of `kerfold seams`, and
    /// choices.png with the body and the pieces of each choice of folds; of outlines: list.png with
    /// the bodies for starts all around the rim
    #[arg(long, conflicts_with_all = ["glue", "planar"])]
    list: bool,
    /// The folder for model, picture, report, pieces and sheets; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    clean: Clean,
}

pub(super) fn run(args: &DformArgs, console: &Console) -> Result<Outcome, CliError> {
    args.check_options()?;
    if args.list && args.solid.is_some() {
        return list(args, console);
    } else if args.list {
        return list_outlines(args, console);
    }
    let dform = Step::Dform {
        dform: args.dform.clone(),
        outlines: args.outlines(),
        sheet: args.sheet.clone().titled(&args.title()),
        show: args.show.from_here(),
    };
    let recipe = Recipe { name: None, steps: vec![dform] };
    let job = args
        .start()?
        .carry_on(&recipe, Path::new(""), &Terminal::new(console.quiet))
        .map_err(|error| *error.cause)?;
    finish(&job, None, (&args.output, args.clean, None), console)
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

/// The bodies for starts all around the rim.
fn list_outlines(args: &DformArgs, console: &Console) -> Result<Outcome, CliError> {
    let progress = Terminal::new(console.quiet);
    let (picture, lines) =
        outline_list(&args.outlines(), Path::new(""), &RenderParams::default(), &progress)?;
    let written = console.write_folder(&args.output, vec![picture], args.clean)?;
    if console.json {
        let command = command_line();
        let told = json!({ "command": command, "written": written, "places": lines });
        console.result(&format!("{told:#}\n"))?;
    } else {
        let paths: String = written.iter().map(|path| format!("wrote {path}\n")).collect();
        console.result(&format!("{}\n{paths}", lines.join("\n")))?;
    }
    Ok(Outcome::Clean)
}

impl DformArgs {
    /// The project's name on sheets, unless there is another: that of the solid's file.
    fn title(&self) -> String {
        let file = self.solid.as_ref().filter(|file| file.as_os_str() != "-");
        let stem = file.and_then(|file| file.file_stem());
        stem.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Refuses options that would do nothing.
    fn check_options(&self) -> Result<(), CliError> {
        let refused = |what: &str, advice| {
            let what = what.to_owned();
            Err(MakeError::from(OutlinesError::Options { what, advice }).into())
        };
        let ReadOptions { units, size, weld, flip, orient, mend, merge_flat } = &self.options;
        let reads = *units != MeshUnit::default()
            || weld.is_some()
            || *flip
            || *orient
            || *mend
            || merge_flat.is_some();
        if self.solid.is_none() && reads {
            let advice = "leave out --units, --weld, --mend and their like: outlines are no mesh";
            return refused("options that read a mesh are given with outlines", advice);
        }
        let is_sized = self.outlines.outlines.iter().all(|text| text.contains('@'));
        if self.solid.is_none() && size.is_some() && is_sized {
            let advice = "name sizes after @, in a gluing file in the file";
            return refused("--size is given, and no outline without a size", advice);
        }
        if self.list && self.dform != DformParams::default() {
            return refused("options of carving are given with --list", "leave them out");
        }
        match self.outlines.without_outlines() {
            Some(option) => {
                let advice = "name outlines or a gluing file, or leave it out";
                refused(&format!("--{option} is given without outlines"), advice)
            }
            None => Ok(()),
        }
    }

    /// The outlines; `--size` is that of the first which names none.
    fn outlines(&self) -> OutlineParams {
        let mut outlines = self.outlines.clone();
        let bare = outlines.outlines.iter_mut().find(|text| !text.contains('@'));
        if let (Some(size), Some(bare)) = (self.options.size, bare) {
            *bare += &format!("@{}mm", size.mm());
        }
        outlines
    }

    /// A file wins over a solid of the same name; a word without dots and slashes is meant as a
    /// name. Outlines begin with nothing.
    fn start(&self) -> Result<Job, CliError> {
        let Some(file) = &self.solid else { return Ok(Job::default()) };
        let word = file.to_str().filter(|text| !text.contains(['.', '/', '\\']) && *text != "-");
        match word.filter(|_| !file.is_file()) {
            Some(name) => {
                let name: SolidName = name.parse()?;
                let params = SolidParams { name, edge: None, size: self.options.size };
                Ok(Job::with_mesh(solid(&params)?, Vec::new()))
            }
            None => {
                let ReadMesh { mesh, notes, .. } = read_model(file, &self.options)?;
                Ok(Job::with_mesh(mesh, notes.iter().map(ToString::to_string).collect()))
            }
        }
    }
}
