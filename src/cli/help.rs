//! `kerfold help`: what `--help` says, for those who ask in words.

use super::error::CliError;
use super::output::command_line;
use super::{Console, Outcome, command};
use crate::units::nearest_word;

/// Show the help of kerfold, or of a verb
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold help cut edge")]
pub(super) struct HelpArgs {
    /// The verb, and what it cuts where it is `cut`; nothing for all verbs
    #[arg(value_name = "VERB")]
    verb: Vec<String>,
}

pub(super) fn run(args: &HelpArgs, console: &Console) -> Result<Outcome, CliError> {
    let mut all = command();
    all.build();
    let mut found = &mut all;
    for word in &args.verb {
        let names: Vec<String> =
            found.get_subcommands().map(|verb| verb.get_name().to_owned()).collect();
        if !names.contains(word) {
            let near = nearest_word(word, names.iter().map(String::as_str));
            return Err(CliError::NoSuchVerb {
                word: word.clone(),
                nearest: near.map(str::to_owned),
            });
        }
        found = found.find_subcommand_mut(word).expect("a verb that was just listed");
    }
    let text = found.render_long_help().to_string();
    if console.json {
        let told = serde_json::json!({ "command": command_line(), "help": text });
        console.result(&format!("{told:#}\n"))?;
    } else {
        console.result(&text)?;
    }
    Ok(Outcome::Clean)
}
