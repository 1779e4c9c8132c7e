//! `kerfold studio`

use std::io;
use std::path::PathBuf;
use std::process::Command;

use super::error::CliError;
use super::{Console, Outcome};

/// Open the studio in the browser: mark, slide, cut, and see the sheet beside the model
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold studio column.toml\n\n\
    The studio is a program of its own, `kerfold-studio`, so that kerfold can be built without \
    Node.")]
pub(super) struct StudioArgs {
    /// A recipe (.toml) or a mesh to begin with
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// The port of this machine to listen to; 0 takes a free one
    #[arg(long, default_value_t = 0, value_name = "N")]
    port: u16,
    /// Open no browser; the address is printed all the same
    #[arg(long)]
    no_open: bool,
}

/// The program that is started.
const PROGRAM: &str = "kerfold-studio";

pub(super) fn run(args: &StudioArgs, _: &Console) -> Result<Outcome, CliError> {
    let mut arguments = vec!["--port".to_owned(), args.port.to_string()];
    if args.no_open {
        arguments.push("--no-open".to_owned());
    }
    for program in programs() {
        let mut command = Command::new(&program);
        command
            .args(&arguments)
            .args(args.file.as_ref().map(|file| ["--".into(), file.clone()]).into_iter().flatten());
        match command.status() {
            Ok(status) if status.success() => return Ok(Outcome::Clean),
            // Ended by a signal, most often Ctrl-C: that is how one leaves it.
            Ok(status) if status.code().is_none() => return Ok(Outcome::Clean),
            Ok(_) => return Err(CliError::StudioFailed),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(CliError::StudioNotStarted { program, error }),
        }
    }
    Err(CliError::NoStudio)
}

/// Where the program may be: beside this one, or wherever the system looks for programs.
fn programs() -> Vec<PathBuf> {
    let name = format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name(&name));
    beside.into_iter().chain([PathBuf::from(name)]).collect()
}
