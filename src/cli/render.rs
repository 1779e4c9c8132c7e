//! `kerfold render`

use std::path::{Path, PathBuf};

use super::error::CliError;
use super::input::Input;
use super::output::command_line;
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::make::{MakeError, PointOut};
use crate::mesh::Mesh;
use crate::op::OpContext;
use crate::picture::{Marks, RenderParams, render_vector, render_with};

/// Draw a picture of a mesh: PNG, SVG or PDF, hidden parts hidden
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold render model.obj --colour planarity --view 1,-2,1 -o model.png\n\
    Example: kerfold render model.obj --ids edges --select fold>30deg -o folds.svg\n\
    Example: kerfold render model.obj --normal z --point 0,0,10 -o cut.png"
)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    render: RenderParams,
    #[command(flatten)]
    point_out: PointOut,
    /// The picture to write: .png of pixels, .svg or .pdf of areas and lines
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

/// What kind of picture is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Png,
    Svg,
    Pdf,
}

/// The kind that the ending of a path asks for.
pub(super) fn kind_of(path: &Path) -> Result<Kind, CliError> {
    let is = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    let kinds = [("png", Kind::Png), ("svg", Kind::Svg), ("pdf", Kind::Pdf)];
    let kind = kinds.into_iter().find(|(ending, _)| is(ending)).map(|(_, kind)| kind);
    kind.ok_or_else(|| CliError::NotPng { path: path.to_owned() })
}

/// A picture of a kind as bytes, and its size in pixels.
pub(super) fn drawn(
    kind: Kind,
    mesh: &Mesh,
    (render, marks): (&RenderParams, &Marks),
) -> Result<(Vec<u8>, (u32, u32)), CliError> {
    if kind == Kind::Png {
        let picture = render_with(mesh, render, marks).map_err(MakeError::from)?;
        return Ok((picture.to_png(), (picture.width(), picture.height())));
    }
    let picture = render_vector(mesh, render, marks).map_err(MakeError::from)?;
    let bytes = match kind {
        Kind::Pdf => picture.to_pdf(&command_line()),
        _ => picture.to_svg(&command_line()).into_bytes(),
    };
    Ok((bytes, picture.size()))
}

pub(super) fn run(args: &RenderArgs, console: &Console) -> Result<Outcome, CliError> {
    let kind = kind_of(&args.output)?;
    let read = args.input.read()?;
    let context = OpContext::default();
    let (mesh, marks) = args.point_out.shown(&read.mesh, None, args.render.ids, &context)?;
    let (bytes, size) = drawn(kind, &mesh, (&args.render, &marks))?;
    write_file(&args.output, &bytes)?;
    console.notes(&read.notes);
    let (width, height) = size;
    if console.json {
        let summary = serde_json::json!({
            "command": command_line(), "written": args.output.to_string_lossy(),
            "width": width, "height": height,
        });
        console.result(&format!("{summary:#}\n"))?;
    } else {
        console.result(&format!("{}: {width} × {height} pixels\n", args.output.display()))?;
    }
    Ok(Outcome::Clean)
}
