//! `kerfold hull`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::read_model;
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::io::ReadOptions;
use crate::make::solid_of_planes;
use crate::mesh::Mesh;
use crate::op::{HullParams, HullReport, HullStep, OpContext, OpError, hull};
use crate::picture::{RenderParams, render_model};
use crate::progress::Progress;

/// Make the convex hull of a mesh, its dual (one plane through each corner of the hull), or the
/// solid that half-spaces bound
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold hull spot.obj --dual -o faceted.obj\n\
    Example: kerfold hull --planes planes.csv -o crystal.obj")]
pub(super) struct HullArgs {
    /// The mesh whose vertices count: OBJ, PLY, STL, OFF, GLB or 3MF; `-` reads OBJ from standard
    /// input
    #[arg(value_name = "IN", required_unless_present = "planes", conflicts_with = "planes")]
    input: Option<PathBuf>,
    #[command(flatten)]
    options: ReadOptions,
    /// Half-spaces instead of a mesh: nx,ny,nz,d on each line for n·x <= d
    #[arg(
        long,
        value_name = "FILE.csv",
        conflicts_with_all = ["dual", "no_box", "clusters", "by_group", "parts", "steps"]
    )]
    planes: Option<PathBuf>,
    #[command(flatten)]
    hull: HullParams,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output. With
    /// --steps a picture of each step is written beside it, OUT-after-20.png
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &HullArgs, console: &Console) -> Result<Outcome, CliError> {
    let has_pictures = args.hull.steps.is_some();
    if has_pictures && args.output == Path::new("-") {
        return Err(CliError::PicturesToStdout);
    }
    let (mesh, report, mut notes) = make(args, console)?;
    notes.extend(report.notes());
    // Drawn before anything is written, so that a picture that fails leaves no file.
    let stem = args.output.file_stem().unwrap_or_default().to_string_lossy();
    let progress = Terminal::new(console.quiet);
    let picture = |(i, step): (usize, &HullStep)| -> Result<(PathBuf, Vec<u8>), CliError> {
        // Thousands of steps may be asked for, and each takes a blink.
        progress.report("pictures", i, report.steps.len());
        if progress.is_cancelled() {
            return Err(OpError::Cancelled.into());
        }
        let path = args.output.with_file_name(step.file_name(&stem));
        Ok((path, render_model(&step.mesh, &RenderParams::default())?.to_png()))
    };
    let pictures: Vec<(PathBuf, Vec<u8>)> =
        report.steps.iter().enumerate().map(picture).collect::<Result<_, _>>()?;
    if pictures.is_empty() {
        console.write_model(&args.output, &mesh, None, &notes)?;
        return Ok(Outcome::Clean);
    }
    notes.extend(pictures.iter().map(|(path, _)| format!("wrote {}", path.display())));
    console.write_models(&[(args.output.clone(), mesh, notes)], pictures)?;
    Ok(Outcome::Clean)
}

fn make(args: &HullArgs, console: &Console) -> Result<(Mesh, HullReport, Vec<String>), CliError> {
    let progress = Terminal::new(console.quiet);
    if let Some(file) = &args.planes {
        let (mesh, report) = solid_of_planes(file, &args.hull, &progress)?;
        return Ok((mesh, report, Vec::new()));
    }
    let read = read_model(args.input.as_deref().unwrap_or(Path::new("-")), &args.options)?;
    let (mesh, report) =
        hull(&read.mesh, &args.hull, &OpContext { made: None, progress: &progress })?;
    Ok((mesh, report, read.notes.iter().map(ToString::to_string).collect()))
}
