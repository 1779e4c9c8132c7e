//! `kerfold render`

use std::path::PathBuf;

use super::error::CliError;
use super::input::Input;
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::picture::{RenderParams, render_model};

/// Draw a picture of a mesh: PNG, hidden parts hidden
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: kerfold render model.obj --colour planarity --view 1,-2,1 -o model.png"
)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    render: RenderParams,
    /// The picture to write, a .png
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &RenderArgs, console: &Console) -> Result<Outcome, CliError> {
    if !args.output.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Err(CliError::NotPng { path: args.output.clone() });
    }
    let read = args.input.read()?;
    let picture = render_model(&read.mesh, &args.render)?;
    write_file(&args.output, &picture.to_png())?;
    console.notes(&read.notes);
    let (width, height) = (picture.width(), picture.height());
    if console.json {
        let summary = serde_json::json!({
            "command": super::output::command_line(), "written": args.output.to_string_lossy(),
            "width": width, "height": height,
        });
        console.result(&format!("{summary:#}\n"))?;
    } else {
        console.result(&format!("{}: {width} × {height} pixels\n", args.output.display()))?;
    }
    Ok(Outcome::Clean)
}
