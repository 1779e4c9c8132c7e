//! `kerfold completions` and `kerfold man`

use std::path::PathBuf;

use clap_complete::Shell;

use super::error::CliError;
use super::output::{Clean, command_line, print};
use super::{Console, Outcome};

/// Print a completion script for a shell
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold completions bash > \
    ~/.local/share/bash-completion/completions/kerfold")]
pub(super) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Write the manual pages, one for each verb
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold man -o man1")]
pub(super) struct ManArgs {
    /// The folder for kerfold.1, kerfold-cut.1, …; made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

pub(super) fn completions(args: &CompletionsArgs) -> Result<Outcome, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut super::command(), "kerfold", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(Outcome::Clean)
}

pub(super) fn man(args: &ManArgs, console: &Console) -> Result<Outcome, CliError> {
    let mut pages = Vec::new();
    collect(&super::command(), "kerfold", &mut pages)?;
    let written = console.write_folder(&args.output, pages, Clean { clean: false })?;
    if console.json {
        let summary = serde_json::json!({ "command": command_line(), "written": written });
        console.result(&format!("{summary:#}\n"))?;
        return Ok(Outcome::Clean);
    }
    for path in &written {
        console.result(&format!("wrote {}\n", path))?;
    }
    Ok(Outcome::Clean)
}

fn collect(
    command: &clap::Command,
    name: &str,
    pages: &mut Vec<(String, Vec<u8>)>,
) -> Result<(), CliError> {
    let mut page = Vec::new();
    let named = command.clone().name(name.to_owned());
    clap_mangen::Man::new(named).render(&mut page).map_err(CliError::Stdout)?;
    pages.push((format!("{name}.1"), page));
    for verb in command.get_subcommands() {
        collect(verb, &format!("{name}-{}", verb.get_name()), pages)?;
    }
    Ok(())
}
