//! Every error and finding has a code, each code one page, each page two sentences. The codes are
//! read off the source, so that no list can be forgotten.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use kerfold::code::{Code, Coded};
use kerfold::explain::pages;
use kerfold::make::MakeError;
use kerfold::op::OpError;
use kerfold::recipe::StepError;

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut entries: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    let inside = |entry: PathBuf| if entry.is_dir() { source_files(&entry) } else { vec![entry] };
    entries
        .into_iter()
        .flat_map(inside)
        .filter(|file| file.extension().is_some_and(|e| e == "rs"))
        .collect()
}

/// The source outside the room of codes itself, with the path of each file.
fn source() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        "src",
        "crates/kerfold-kernel/src",
        "crates/kerfold-sheet/src",
        "crates/kerfold-studio/src",
    ];
    let files = folders.iter().flat_map(|folder| source_files(&root.join(folder)));
    let shown = |file: &Path| {
        file.strip_prefix(root)
            .expect("a file of this package")
            .to_string_lossy()
            .replace('\\', "/")
    };
    let read = |file: PathBuf| (shown(&file), fs::read_to_string(&file).expect("a source file"));
    files.map(read).filter(|(path, _)| !path.contains("/src/code/")).collect()
}

/// The codes of all `codes!(…)` tables of a text, each with the type it stands in.
fn codes_in(text: &str) -> Vec<(Code, String)> {
    let mut found = Vec::new();
    for table in text
        .split("codes!(")
        .skip(1)
        .filter_map(|rest| rest.split_once(");").map(|(table, _)| table))
    {
        let make = if table.starts_with("finding") { Code::finding } else { Code::error };
        let mut words = table.split_whitespace().skip(1).filter(|word| *word != "struct");
        let of = words.next().unwrap_or_default().to_owned();
        let digits = |part: &str| part.chars().take_while(char::is_ascii_digit).collect::<String>();
        let numbers = table.split("= ").skip(1).filter_map(|part| digits(part).parse().ok());
        found.extend(numbers.map(|number| (make(number), of.clone())));
    }
    found
}

/// The enums and structs of a text that have `#[error(…)]`, by name.
fn error_types(text: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for rest in text.split("thiserror::Error").skip(1) {
        let declared = rest.lines().find_map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let at = words.iter().position(|word| *word == "enum" || *word == "struct")?;
            let name = words.get(at + 1)?.split(|c: char| !c.is_alphanumeric()).next()?;
            Some(name.to_owned())
        });
        names.extend(declared);
    }
    names
}

/// The number of sentences of a page: ends that a blank or the end of the text follows, code in
/// backticks left out.
fn sentences(text: &str) -> usize {
    let prose: String = text.split('`').step_by(2).collect::<Vec<_>>().join("x");
    let ends = |(i, c): (usize, char)| {
        ".!?".contains(c) && prose[i + c.len_utf8()..].chars().next().is_none_or(|c| c == ' ')
    };
    prose.char_indices().filter(|&end| ends(end)).count()
}

#[test]
fn every_code_is_given_once_and_has_a_page_and_every_page_a_code() {
    let mut given: BTreeMap<Code, String> = BTreeMap::new();
    for (path, text) in source() {
        for (code, of) in codes_in(&text) {
            if let Some(other) = given.insert(code, of.clone()) {
                panic!(
                    "{path}: {code} of {of} belongs to {other} already; take the next free number \
                    of its range"
                );
            }
        }
    }
    assert!(given.len() > 250, "the tables were not found");
    let described: Vec<Code> = pages().iter().map(|page| page.code).collect();
    let known: Vec<Code> = given.keys().copied().collect();
    let without: Vec<&Code> = known.iter().filter(|code| !described.contains(code)).collect();
    let stale: Vec<&Code> = described.iter().filter(|code| !known.contains(code)).collect();
    assert!(without.is_empty(), "write pages in docs/errors.md for {without:?}");
    assert!(stale.is_empty(), "docs/errors.md has pages for {stale:?}, which nothing gives");
    assert_eq!(described, known, "docs/errors.md: each page once, in the order of the codes");
}

#[test]
fn every_error_type_has_a_table() {
    for (path, text) in source() {
        let with_codes: BTreeSet<String> = codes_in(&text).into_iter().map(|(_, of)| of).collect();
        let lacking: Vec<String> = error_types(&text)
            .into_iter()
            .filter(|name| {
                !with_codes.contains(name) && !text.contains(&format!("impl Coded for {name} "))
            })
            .collect();
        assert!(
            lacking.is_empty(),
            "{path}: give codes to {lacking:?} with codes!(…), see crates/kerfold-kernel/src/code/mod.rs"
        );
    }
}

#[test]
fn every_page_is_a_title_and_two_sentences() {
    for page in pages() {
        assert_eq!(sentences(page.text), 2, "{}: {}", page.code, page.text);
        assert!(
            page.text.ends_with('.') || page.text.ends_with("`."),
            "{}: {}",
            page.code,
            page.text
        );
        assert!(page.title.chars().count() <= 45, "{}: {}", page.code, page.title);
    }
}

#[test]
fn an_error_shows_the_code_of_its_innermost_cause() {
    let cause = Box::new(MakeError::from(OpError::OffsetOutOfRange { offset: 3.0 }));
    let error = StepError { step: 2, verb: "cut vertex", cause };
    assert_eq!(error.code().to_string(), "E301");
}

#[test]
fn planted_mistakes_are_found() {
    let text = "#[derive(Debug, thiserror::Error)]\n#[error(\"{0}\")]\npub struct \
    Alone(String);\n\n#[derive(thiserror::Error)]\n\
                pub(super) enum Some { A }\ncodes!(error Some {\n    A = 7,\n    B = 12,\n} through { C.0 });\ncodes!(finding struct Gap = 3);";
    let found: Vec<(String, String)> =
        codes_in(text).into_iter().map(|(code, of)| (code.to_string(), of)).collect();
    let expected = [("E007", "Some"), ("E012", "Some"), ("F003", "Gap")];
    assert_eq!(found, expected.map(|(code, of)| (code.to_owned(), of.to_owned())));
    assert_eq!(error_types(text), ["Alone", "Some"].map(str::to_owned).into());
    assert_eq!(sentences("One `a. b. c` of 0.5 mm. Two (see `x.y`)."), 2);
    assert_eq!(sentences("One. Two. Three."), 3);
}
