//! `kerfold explain`, and the codes of what the command line itself refuses.

use std::error::Error;
use std::process::ExitCode;

use serde_json::{Value, json};

use super::error::CliError;
use super::output::{command_line, say};
use super::{Console, Outcome};
use crate::check::CheckError;
use crate::code::{Code, Coded};
use crate::explain::{Page, pages};
use crate::make::{AnimationFileError, MatchingChoiceError};
use crate::picture::ViewError;
use crate::select::ParseError;
use crate::sheet::FormatsError;
use crate::unfold::PiecesModeError;
use crate::units::{UnitError, nearest_word};

/// Explain the code of an error or a finding in two sentences; without a code, list all
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold explain E301\n\nThe same pages stand in docs/errors.md.")]
pub(super) struct ExplainArgs {
    /// Codes as messages show them, like E301 or F104, or names of findings, like planarity
    #[arg(value_name = "CODE|NAME")]
    words: Vec<String>,
}

/// Columns of a page in a terminal.
const COLUMNS: usize = 96;

pub(super) fn run(args: &ExplainArgs, console: &Console) -> Result<Outcome, CliError> {
    let all = pages();
    let mut chosen: Vec<&Page> = Vec::new();
    for word in &args.words {
        chosen.extend(find(&all, word)?);
    }
    let lists_all = args.words.is_empty();
    if lists_all {
        chosen.extend(&all);
    }
    let text = match (console.json, lists_all) {
        (true, _) => as_json(&chosen),
        (false, true) => {
            chosen.iter().map(|page| format!("{} {}\n", page.code, page.title)).collect()
        }
        (false, false) => chosen.iter().map(|page| as_text(page)).collect::<Vec<_>>().join("\n"),
    };
    console.result(&text)?;
    Ok(Outcome::Clean)
}

/// The pages with this code, name or title; several findings may share a name.
fn find<'a>(all: &'a [Page], word: &str) -> Result<Vec<&'a Page>, CliError> {
    let word = word.trim();
    let code = Code::read(word);
    let wanted = word.to_lowercase();
    let is_meant = |page: &&Page| {
        Some(page.code) == code || page.name() == wanted || page.title.to_lowercase() == wanted
    };
    let found: Vec<&Page> = all.iter().filter(is_meant).collect();
    if found.is_empty() {
        return Err(CliError::NoSuchCode {
            word: word.to_owned(),
            nearest: nearest(all, word, code),
        });
    }
    Ok(found)
}

/// The known code with the nearest number, or the known word with the fewest slips.
fn nearest(all: &[Page], word: &str, code: Option<Code>) -> Option<String> {
    if let Some(code) = code {
        let near = all.iter().filter_map(|page| Some((page.code.distance(code)?, page.code))).min();
        return near.map(|(_, code)| code.to_string());
    }
    let known: Vec<String> =
        all.iter().flat_map(|page| [page.code.to_string().to_lowercase(), page.name()]).collect();
    let near = nearest_word(word, known.iter().map(String::as_str))?;
    Some(if Code::read(near).is_some() { near.to_uppercase() } else { near.to_owned() })
}

fn as_text(page: &Page) -> String {
    let mut text = format!("{} {}\n", page.code, page.title);
    let mut column = 0;
    for word in page.text.split(' ') {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > COLUMNS {
            text += "\n";
            column = 0;
        }
        if column > 0 {
            text += " ";
            column += 1;
        }
        text += word;
        column += length;
    }
    text + "\n"
}

fn as_json(chosen: &[&Page]) -> String {
    let page = |page: &&Page| json!({ "code": page.code.to_string(), "title": page.title, "text": page.text });
    let told: Vec<Value> = chosen.iter().map(page).collect();
    format!("{:#}\n", json!({ "command": command_line(), "pages": told }))
}

/// Prints what clap has to say, be it help or a complaint, and the code where the complaint is one
/// of ours.
pub(super) fn refuse(refusal: &clap::Error) -> ExitCode {
    // If even standard error is closed, nobody can be told.
    let _ = refusal.print();
    if let Some(code) = refusal.source().and_then(code_of) {
        say(&format!("The code of this error is {code}; `kerfold explain {code}` says more."));
    }
    ExitCode::from(u8::try_from(refusal.exit_code()).unwrap_or(2))
}

/// The code of an error that a value on the command line was refused with.
fn code_of(error: &(dyn Error + 'static)) -> Option<Code> {
    macro_rules! first_of {
        ($($kind:ty),*) => { None$(.or_else(|| error.downcast_ref::<$kind>().map(Coded::code)))* };
    }
    first_of!(
        UnitError,
        ParseError,
        CheckError,
        ViewError,
        FormatsError,
        PiecesModeError,
        MatchingChoiceError,
        AnimationFileError
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::CheckKind;
    use crate::lint::Check;

    #[test]
    fn findings_are_called_as_reports_call_them() {
        use CheckKind as K;
        let of_check = [
            K::DegenerateFace,
            K::ZeroLengthEdge,
            K::SelfIntersection,
            K::Planarity,
            K::Valence,
            K::Closed,
            K::Convex,
            K::Manifold,
            K::OneComponent,
            K::Simple,
            K::InsideOut,
            K::Junction,
            K::Doubled,
            K::SharpCorner,
            K::ShortEdge,
            K::Mitre,
            K::OtherUnit,
        ];
        let of_lint = [
            Check::OpenContour,
            Check::Duplicate,
            Check::Overlap,
            Check::Text,
            Check::Units,
            Check::OffSheet,
            Check::SmallHole,
            Check::ThinWeb,
            Check::Order,
            Check::StrayPoint,
            Check::SelfCrossing,
            Check::Crossing,
            Check::NotFlat,
        ];
        let named = of_check.map(|kind| (kind.code().to_string(), kind.name())).into_iter();
        let named: Vec<_> =
            named.chain(of_lint.map(|check| (check.code().to_string(), check.name()))).collect();
        let all = pages();
        let in_pages = all.iter().map(|page| (page.code.to_string(), page.title));
        let in_pages: Vec<_> =
            in_pages.filter(|(code, _)| code.starts_with("F1") || code.starts_with("F2")).collect();
        assert_eq!(in_pages, named);
    }

    #[test]
    fn the_nearest_code_or_name_is_proposed() {
        let all = pages();
        for (typed, near) in [
            ("E999", Some("E913")),
            ("f150", Some("F117")),
            ("E130", Some("E131")),
            ("planarty", Some("planarity")),
            ("X301", Some("E301")),
            ("colours of the sea", None),
        ] {
            let refused = find(&all, typed).expect_err("no such code");
            let CliError::NoSuchCode { nearest, .. } = &refused else { panic!("{refused}") };
            assert_eq!(nearest.as_deref(), near, "{typed}");
        }
        for (typed, code) in [
            ("e301", "E301"),
            ("E7", "E007"),
            ("Planarity", "F104"),
            ("offset-out-of-range", "E301"),
        ] {
            let found = find(&all, typed).expect("a page");
            assert_eq!(found.iter().map(|page| page.code.to_string()).collect::<Vec<_>>(), [code]);
        }
    }
}
