//! `kerfold panelize`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::read_model;
use super::render::{drawn, kind_of};
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::io::{MeshUnit, ReadOptions};
use crate::make::{height_mesh, operate, worst_in_red};
use crate::mesh::Mesh;
use crate::op::OpContext;
use crate::panelize::{Domain, HeightParams, PanelizeParams};
use crate::picture::RenderParams;
use crate::units::Length;

/// Make planar panels of a freeform surface, three edges at every node; exit code 1 when some do
/// not come out well
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold panelize roof.obj --size 1.2m --rim walls -o panels.obj\n\
        Example: kerfold panelize heights.csv --units m --size 1.2m -o panels.obj\n\
        Example: kerfold panelize --height \"x*y/9\" --domain outline.svg@22m --size 1.2m -o panels.obj"
)]
pub(super) struct PanelizeArgs {
    /// The surface: OBJ, PLY, STL, OFF, GLB or 3MF of triangles or polygons, or a grid of heights as CSV (a
    /// table whose first row is x and first column y, or rows x,y,z); `-` reads OBJ from standard
    /// input
    #[arg(value_name = "IN", required_unless_present = "height")]
    input: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Instead of a file: the height z as a formula in x and y, from the middle of the domain,
    /// in its unit, such as 2*sin(x/3)+cos(y/2)
    #[arg(long, value_name = "FORMULA", conflicts_with = "input", requires = "domain")]
    height: Option<String>,
    /// What `--height` lies over: a rectangle, 22mx18m, an outline by name, circle@22m, or the closed
    /// lines of a drawing (SVG, DXF, PDF, or .csv with x,y on each line), those inside others being
    /// holes; outline.svg@22m is 22 m in its largest extent, and the formula is in m
    #[arg(long, value_name = "WIDTHxDEPTH|OUTLINE", requires = "height")]
    domain: Option<Domain>,
    /// Steps of the mesh of `--height` along the longer side, 10 to 1000; eight for each panel are
    /// enough, and fewer take less time [default: 160]
    #[arg(long, value_name = "N", requires = "height")]
    steps: Option<u32>,
    #[command(flatten)]
    params: PanelizeParams,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Also draw the panels (PNG, SVG or PDF), in red and with their numbers those with findings, the
    /// worst of each kind, or without any those farthest off the surface
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

/// How the file is read: as other verbs do, but `--size` is that of the panels.
#[derive(Debug, clap::Args)]
struct Reading {
    /// The unit of the file's numbers: mm, cm, m or in; mm without it
    #[arg(long, value_enum, default_value = "mm", hide_default_value = true)]
    units: MeshUnit,
    /// Scale the surface so that its largest extent is this length, whatever its unit, e.g. 300mm;
    /// above 0 [default: not scaled]
    #[arg(long, value_name = "LENGTH", conflicts_with = "height")]
    extent: Option<Length>,
    /// Join vertices that are at most this far apart
    #[arg(long, conflicts_with = "height")]
    weld: Option<Length>,
    /// Turn all faces around, so that those that look inwards look outwards
    #[arg(long, conflicts_with = "height")]
    flip: bool,
    /// Turn faces until neighbours look the same way and closed parts look outwards
    #[arg(long, conflicts_with = "height")]
    orient: bool,
    /// Mend what is no surface as `kerfold repair` does, which closes no holes unless asked to
    #[arg(long, conflicts_with = "height")]
    mend: bool,
    /// Make one face of those that lie flat beside each other, as `kerfold merge` does; how far
    /// from flat is flat, 0 or more [default: none are merged; 0.01mm when nothing is said]
    #[arg(
        long,
        value_name = "TOLERANCE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "0.01mm",
        conflicts_with = "height"
    )]
    merge_flat: Option<Length>,
}

pub(super) fn run(args: &PanelizeArgs, console: &Console) -> Result<Outcome, CliError> {
    let kind = args.picture.as_deref().map(kind_of).transpose()?;
    let (mesh, scale, mut notes) = args.surface()?;
    let progress = Terminal::new(console.quiet);
    let context = OpContext { made: None, progress: &progress };
    let made = operate(&args.params, (Path::new(""), scale), &mesh, &context)?;
    notes.extend(made.notes);
    let outcome = if made.is_clean { Outcome::Clean } else { Outcome::Findings };
    if let (Some(path), Some(kind)) = (&args.picture, kind) {
        let (render, marks) = worst_in_red(&made.worst, &RenderParams::default());
        let (bytes, _) = drawn(kind, &made.mesh, (&render, &marks))?;
        if args.output != Path::new("-") {
            let model = (args.output.clone(), made.mesh, notes);
            console.write_models(&[model], vec![(path.clone(), bytes)])?;
            return Ok(outcome);
        }
        write_file(path, &bytes)?;
    }
    console.write_model(&args.output, &made.mesh, None, &notes)?;
    Ok(outcome)
}

impl PanelizeArgs {
    /// The surface, the factor from its numbers to millimetres, and what is to be known of it.
    fn surface(&self) -> Result<(Mesh, f64, Vec<String>), CliError> {
        if let (Some(height), Some(domain)) = (&self.height, &self.domain) {
            let usual = HeightParams::new(height, domain.clone());
            let params = HeightParams { steps: self.steps.unwrap_or(usual.steps), ..usual };
            let (mesh, notes) = height_mesh(&params, Path::new(""))?;
            return Ok((mesh, domain.unit_mm(), notes));
        }
        let path = self.input.as_deref().unwrap_or(Path::new("-"));
        let Reading { units, extent, weld, flip, orient, mend, merge_flat } = self.reading;
        let options = ReadOptions { units, size: extent, weld, flip, orient, mend, merge_flat };
        let read = read_model(path, &options)?;
        let notes = read.notes.iter().map(ToString::to_string).collect();
        Ok((read.mesh, read.scale, notes))
    }
}
