//! `kerfold panelize`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::read_model;
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::io::{MeshUnit, ReadOptions};
use crate::make::operate;
use crate::mesh::Mesh;
use crate::op::{OpContext, OpError};
use crate::panelize::{Domain, HeightParams, PanelizeParams, height_field};
use crate::units::Length;

/// Make planar panels of a freeform surface, three edges at every node; exit code 1 when some do
/// not come out well
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold panelize roof.obj --size 1.2m --rim walls -o panels.obj")]
pub(super) struct PanelizeArgs {
    /// The surface: OBJ, PLY, STL or OFF of triangles or polygons; `-` reads OBJ from standard
    /// input
    #[arg(value_name = "IN", required_unless_present = "height")]
    input: Option<PathBuf>,
    /// The unit of the file's numbers: mm, cm, m or in; mm without it
    #[arg(long, value_enum, default_value = "mm", hide_default_value = true)]
    units: MeshUnit,
    /// Join vertices that are at most this far apart
    #[arg(long)]
    weld: Option<Length>,
    /// Instead of a file: the height z as a formula in x and y, from the middle of the rectangle,
    /// in the unit of its width, such as 2*sin(x/3)+cos(y/2)
    #[arg(long, value_name = "FORMULA", conflicts_with = "input", requires = "domain")]
    height: Option<String>,
    /// The rectangle of `--height`: 22mx18m
    #[arg(long, value_name = "WIDTHxDEPTH", requires = "height")]
    domain: Option<Domain>,
    #[command(flatten)]
    params: PanelizeParams,
    /// The mesh to write: OBJ, PLY, STL or OFF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &PanelizeArgs, console: &Console) -> Result<Outcome, CliError> {
    let (mesh, mut notes) = args.surface()?;
    let progress = Terminal::new(console.quiet);
    let context = OpContext { made: None, progress: &progress };
    let made = operate(&args.params, Path::new(""), &mesh, &context)?;
    notes.extend(made.notes);
    console.write_model(&args.output, &made.mesh, None, &notes)?;
    Ok(if made.is_clean { Outcome::Clean } else { Outcome::Findings })
}

impl PanelizeArgs {
    fn surface(&self) -> Result<(Mesh, Vec<String>), CliError> {
        if let (Some(height), Some(domain)) = (&self.height, self.domain) {
            let params = HeightParams { height: height.clone(), domain };
            let mesh = height_field(&params).map_err(OpError::from)?;
            return Ok((mesh, Vec::new()));
        }
        let path = self.input.as_deref().unwrap_or(Path::new("-"));
        let options = ReadOptions { units: self.units, weld: self.weld, ..ReadOptions::default() };
        let read = read_model(path, &options)?;
        Ok((read.mesh, read.notes.iter().map(ToString::to_string).collect()))
    }
}
