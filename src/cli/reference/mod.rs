//! `docs/reference.md`: verbs, recipe steps, selections and files, made from what the program
//! itself reads.

mod files;

use std::fmt::Write;

use clap::{Arg, Args, Command};

use super::input::Input;
use crate::recipe::{StepKind, steps};
use crate::select::CONDITIONS;
use crate::sheet::SheetParams;

const HEAD: &str = "\
# Reference

What every verb, every step of a recipe and every selection takes, and which files there are. This
page is made from the program itself; a test compares the two, and `KERFOLD_BLESS=1 cargo test
--test reference` writes it anew. What the operators mean is explained in
[operators.md](operators.md), the form of the files in [formats.md](formats.md), every message in
[errors.md](errors.md).
";

/// The text of `docs/reference.md`, the same on every terminal.
pub fn reference() -> String {
    let mut page = HEAD.to_owned();
    let mut command = super::command().term_width(0);
    command.build();
    verbs(&mut page, &command);
    recipes(&mut page);
    selections(&mut page);
    files::written(&mut page);
    page
}

/// Arguments that several verbs or steps have: listed once, under a heading of their own.
struct Shared {
    title: &'static str,
    link: &'static str,
    args: Vec<Arg>,
}

impl Shared {
    fn of<T: Args>(title: &'static str, link: &'static str) -> Self {
        let command = T::augment_args(Command::new("shared"));
        Self {
            title,
            link,
            args: command.get_arguments().filter(|arg| !arg.is_positional()).cloned().collect(),
        }
    }

    fn all() -> [Self; 2] {
        [
            Self::of::<Input>("Options of meshes", "[options of meshes](#options-of-meshes)"),
            Self::of::<SheetParams>("Options of sheets", "[options of sheets](#options-of-sheets)"),
        ]
    }

    /// Whether a verb has all of them.
    fn is_in(&self, args: &[&Arg]) -> bool {
        self.args.iter().all(|own| args.iter().any(|arg| arg.get_id() == own.get_id()))
    }

    /// Whether an argument says the same here.
    fn tells(&self, arg: &Arg) -> bool {
        self.args.iter().any(|own| own.get_id() == arg.get_id() && row(own) == row(arg))
    }
}

/// Arguments that every verb has.
const EVERYWHERE: [&str; 5] = ["json", "quiet", "color", "help", "version"];

fn verbs(page: &mut String, command: &Command) {
    *page += "\n## Verbs\n\nEvery verb takes these:\n";
    let is_global = |arg: &&Arg| EVERYWHERE.contains(&arg.get_id().as_str());
    table(page, "option", command.get_arguments().filter(is_global).map(row));
    let shared = Shared::all();
    for verb in command.get_subcommands() {
        describe(page, verb, &format!("kerfold {}", verb.get_name()), &shared);
    }
    for group in &shared {
        let _ = write!(page, "\n### {}\n", group.title);
        table(page, "option", group.args.iter().map(row));
    }
}

fn describe(page: &mut String, command: &Command, name: &str, shared: &[Shared]) {
    if command.has_subcommands() {
        for inner in command.get_subcommands() {
            describe(page, inner, &format!("{name} {}", inner.get_name()), shared);
        }
        return;
    }
    let about = command.get_about().map(|about| sentence(&about.to_string())).unwrap_or_default();
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage:").split_whitespace().collect::<Vec<_>>().join(" ");
    let _ = write!(page, "\n### {name}\n\n{about}\n\n```text\n{usage}\n```\n");
    let args: Vec<&Arg> = command
        .get_arguments()
        .filter(|arg| !EVERYWHERE.contains(&arg.get_id().as_str()))
        .collect();
    let groups: Vec<&Shared> = shared.iter().filter(|group| group.is_in(&args)).collect();
    let own: Vec<&Arg> =
        args.into_iter().filter(|arg| !groups.iter().any(|group| group.tells(arg))).collect();
    table(page, "option", own.into_iter().map(row));
    links(page, &groups);
    if let Some(after) = command.get_after_help() {
        after_help(page, &after.to_string());
    }
}

fn links(page: &mut String, groups: &[&Shared]) {
    if !groups.is_empty() {
        let links: Vec<&str> = groups.iter().map(|group| group.link).collect();
        let _ = write!(page, "\nAnd the {}.\n", links.join(" and the "));
    }
}

/// The example of a verb as code, what is said besides as a paragraph.
fn after_help(page: &mut String, text: &str) {
    for paragraph in text.split("\n\n") {
        let paragraph = paragraph.trim();
        match paragraph.strip_prefix("Example: ") {
            Some(example) => *page += &format!("\n```sh\n{example}\n```\n"),
            None => *page += &format!("\n{}\n", one_line(paragraph)),
        }
    }
}

fn recipes(page: &mut String) {
    *page += "\n## Recipes\n\nA recipe is TOML: `name`, and steps that are carried out in order. \
    Each `[[step]]` has one key that says what it does, \
              and keys for the rest; lengths, angles and selections go in quotes.\n";
    let sheets = Shared::of::<SheetParams>(
        "",
        "keys of sheets, which are the [options of sheets](#options-of-sheets) with `_` for `-`",
    );
    for step in steps() {
        describe_step(page, step, &sheets);
    }
}

fn describe_step(page: &mut String, step: &StepKind, sheets: &Shared) {
    let (heading, first) = match step.kind {
        Some(kind) => (format!("{} = \"{kind}\"", step.verb), None),
        None => (step.verb.to_owned(), Some(step.field)),
    };
    let _ = write!(page, "\n### Step `{heading}`\n");
    let command = step.command();
    let args: Vec<&Arg> = command.get_arguments().collect();
    let has_sheets = sheets.is_in(&args);
    let is_of_verb = |arg: &&&Arg| Some(arg.get_id().as_str()) == first;
    let verb = args.iter().filter(is_of_verb).map(|arg| key_row(step.verb, arg, step.words));
    let others = args.iter().filter(|arg| !(is_of_verb(arg) || has_sheets && sheets.tells(arg)));
    table(page, "key", verb.chain(others.map(|arg| key_row(arg.get_id().as_str(), arg, &[]))));
    if has_sheets {
        links(page, &[sheets]);
    }
}

fn selections(page: &mut String) {
    *page += "\n## Selections\n\n| condition | vertices | edges | faces |\n|---|---|---|---|\n";
    for row in &CONDITIONS {
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {} |",
            row.example, row.vertices, row.edges, row.faces
        );
    }
    *page += "\nWhere it says –, the condition is an error. Conditions are joined by `!` (not), \
    `&` (and), `|` (or), binding in this order, and \
              brackets. `valence`, `sides` and `fold` take `=`, `!=`, `<`, `<=`, `>`, `>=`. Directions are `x`, `-z`, … or three numbers as in \
              `along=1,1,0:5deg`; the angle of `along` and `normal` is 1deg when left out. Names with signs go in quotes: `group=\"top (left)\"`.\n";
}

/// A table of two columns.
fn table(page: &mut String, first: &str, rows: impl Iterator<Item = [String; 2]>) {
    let rows: Vec<[String; 2]> = rows.collect();
    if rows.is_empty() {
        return;
    }
    let _ = write!(page, "\n| {first} | meaning |\n|---|---|\n");
    for [name, meaning] in rows {
        let _ = writeln!(page, "| {} | {} |", cell(&name), cell(&meaning));
    }
}

/// A text that stays in its cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// An argument as it is typed, and what it means.
fn row(arg: &Arg) -> [String; 2] {
    let short = arg.get_short().map(|short| format!("-{short}, ")).unwrap_or_default();
    let values = values(arg);
    let typed = match arg.get_long() {
        None => values,
        Some(long) if !takes_values(arg) => format!("{short}--{long}"),
        Some(long) if is_value_optional(arg) => format!("{short}--{long}[={values}]"),
        Some(long) => format!("{short}--{long} {values}"),
    };
    let aliases = arg.get_visible_aliases().unwrap_or_default();
    let alias = if aliases.is_empty() {
        String::new()
    } else {
        format!(" Also `--{}`.", aliases.join("`, `--"))
    };
    [format!("`{typed}`"), meaning(arg) + &alias]
}

/// A key of a recipe, and what it means.
fn key_row(key: &str, arg: &Arg, words: &[(&str, &str)]) -> [String; 2] {
    let word = |(word, stands_for): &(&str, &str)| format!("`{word}` ({stands_for})");
    let values = match (words.is_empty(), takes_values(arg)) {
        (true, true) => String::new(),
        (true, false) => " `true` or `false`.".to_owned(),
        (false, _) => format!(" One of {}.", words.iter().map(word).collect::<Vec<_>>().join(", ")),
    };
    [format!("`{key}`"), meaning(arg) + &values]
}

fn takes_values(arg: &Arg) -> bool {
    arg.get_action().takes_values()
}

fn is_value_optional(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|range| range.min_values() == 0)
}

fn values(arg: &Arg) -> String {
    let names: Vec<String> = match arg.get_value_names() {
        Some(names) => names.iter().map(|name| format!("<{name}>")).collect(),
        None => vec![format!("<{}>", arg.get_id().as_str().to_uppercase())],
    };
    let several = arg.get_num_args().is_some_and(|range| range.max_values() > names.len());
    names.join(" ") + if several && !is_value_optional(arg) { "..." } else { "" }
}

/// The help of an argument with its values and its default.
fn meaning(arg: &Arg) -> String {
    let help =
        arg.get_long_help().or_else(|| arg.get_help()).map(ToString::to_string).unwrap_or_default();
    let mut text = sentence(&help);
    if arg.is_required_set() {
        text += " Required.";
    }
    if !takes_values(arg) {
        return text;
    }
    let possible = arg.get_possible_values();
    if !possible.is_empty() && !arg.is_hide_possible_values_set() {
        let told = possible.iter().filter(|value| !value.is_hide_set()).map(|value| {
            match value.get_help() {
                Some(help) => format!("`{}` ({})", value.get_name(), one_line(&help.to_string())),
                None => format!("`{}`", value.get_name()),
            }
        });
        text += &format!(" One of {}.", told.collect::<Vec<_>>().join(", "));
    }
    let defaults: Vec<String> =
        arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    if !arg.is_hide_default_value_set() && defaults.iter().any(|value| !value.is_empty()) {
        text += &format!(" Default: `{}`.", defaults.join(" "));
    }
    text
}

/// A help text on one line, with a full stop.
fn sentence(text: &str) -> String {
    let text = one_line(text);
    if text.is_empty() || text.ends_with(['.', '!', '?']) { text } else { text + "." }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_and_its_verb_are_told_in_the_same_words() {
        let command = super::super::command();
        let mut told = 0;
        // A recipe begins with a solid that the verb writes.
        for step in steps().iter().filter(|step| step.verb != "solid") {
            let verb = command.find_subcommand(step.verb);
            let verb = match step.kind {
                Some(kind) => verb.and_then(|verb| verb.find_subcommand(kind)),
                None => verb,
            };
            let Some(about) = verb.and_then(Command::get_about) else { continue };
            let about = one_line(&about.to_string());
            let words = about.split([';', ',', ':', '(']).next().unwrap_or_default().trim();
            assert!(step.help.starts_with(words), "{}: {} and {about}", step.verb, step.help);
            told += 1;
        }
        assert!(told > 17, "only {told} steps are verbs");
    }
}
