//! `kerfold info`

use super::error::CliError;
use super::input::Input;
use super::output::command_line;
use super::{Console, Outcome};
use crate::io::report::json::info_json;
use crate::io::report::text::info_text;
use crate::measure::summary;

/// Tell what a mesh is: counts, parts, genus, rims, size, edge lengths, valences
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold info model.obj --units in")]
pub(super) struct InfoArgs {
    #[command(flatten)]
    input: Input,
}

pub(super) fn run(args: &InfoArgs, console: &Console) -> Result<Outcome, CliError> {
    let read = args.input.read()?;
    let notes: Vec<String> = read.notes.iter().map(ToString::to_string).collect();
    let (summary, command) = (summary(&read.mesh), command_line());
    let text = if console.json {
        info_json(&summary, &notes, &command)
    } else {
        info_text(&summary, &notes, &command)
    };
    console.result(&text)?;
    Ok(Outcome::Clean)
}
