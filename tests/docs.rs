//! The pages say nothing that is not there: links lead to files, names in the glossary are in the
//! source.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The files below a folder with an ending, in a stable order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut entries: Vec<PathBuf> =
        entries.map(|entry| entry.expect("a readable entry").path()).collect();
    entries.sort();
    let inside = |entry: PathBuf| if entry.is_dir() { files(&entry, ending) } else { vec![entry] };
    entries
        .into_iter()
        .flat_map(inside)
        .filter(|file| file.extension().is_some_and(|e| e == ending))
        .collect()
}

/// The pages: everything in `docs`, and those at the top that exist.
fn pages() -> Vec<PathBuf> {
    let top = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name));
    files(&root().join("docs"), "md")
        .into_iter()
        .chain(top.into_iter().filter(|page| page.exists()))
        .collect()
}

/// The targets of all links `[…](target)` and pictures of a page with their lines; code blocks and
/// code in backticks left out.
fn links(page: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut is_code = false;
    for (number, line) in page.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        }
        if is_code {
            continue;
        }
        let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        for part in prose.split("](").skip(1) {
            if let Some((target, _)) = part.split_once(')') {
                found.push((
                    number + 1,
                    target.split_whitespace().next().unwrap_or_default().to_owned(),
                ));
            }
        }
    }
    found
}

/// The links of a page that lead to no file: (line, target).
fn broken(page: &str, folder: &Path) -> Vec<(usize, String)> {
    let is_outside = |target: &str| target.contains("://") || target.starts_with("mailto:");
    let leads_nowhere = |target: &str| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        if file.is_empty() {
            return !headings(page).contains(anchor);
        }
        let path = folder.join(file);
        !path.exists()
            || (!anchor.is_empty()
                && file.ends_with(".md")
                && !headings(&read(&path)).contains(anchor))
    };
    links(page)
        .into_iter()
        .filter(|(_, target)| !is_outside(target) && leads_nowhere(target))
        .collect()
}

/// The anchors of a page's headings, as they are commonly made: small letters, digits and hyphens.
fn headings(page: &str) -> BTreeSet<String> {
    let titles = page
        .lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| line.trim_start_matches('#').trim());
    let anchor = |title: &str| -> String {
        let kept = title.to_lowercase().replace(' ', "-");
        kept.chars().filter(|c| c.is_alphanumeric() || *c == '-' || *c == '_').collect()
    };
    titles.map(anchor).collect()
}

/// The identifiers that a page shows as `**`name`**`, without arguments and paths: `Mesh::plane()`
/// gives `Mesh` and `plane`.
fn bold_names(page: &str) -> BTreeSet<String> {
    let marked =
        page.split("**`").skip(1).filter_map(|part| part.split_once("`**")).map(|(name, _)| name);
    let words = marked.flat_map(|name| name.split(|c: char| !c.is_alphanumeric() && c != '_'));
    words.filter(|word| word.starts_with(|c: char| c.is_alphabetic())).map(str::to_owned).collect()
}

/// The words of `names` that the text does not hold as a whole word.
fn missing(names: BTreeSet<String>, words: &BTreeSet<String>) -> Vec<String> {
    names.into_iter().filter(|name| !words.contains(name)).collect()
}

fn words_of(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
}

#[test]
fn every_link_leads_to_a_file() {
    let pages = pages();
    assert!(pages.len() > 5, "the pages were not found");
    let mut faults = Vec::new();
    for page in pages {
        let folder = page.parent().expect("a page lies in a folder").to_owned();
        let lost = broken(&read(&page), &folder);
        faults.extend(
            lost.iter().map(|(line, target)| {
                format!("{}:{line}: {target} does not exist", page.display())
            }),
        );
    }
    assert!(faults.is_empty(), "correct these links:\n{}", faults.join("\n"));
}

/// The paths of source files and folders that a page names in backticks and that do not exist.
fn lost_paths(page: &str) -> Vec<&str> {
    let prose = page.split("```").step_by(2);
    let code = prose.flat_map(|part| part.split('`').skip(1).step_by(2));
    let is_path = |name: &&str| {
        ["src/", "crates/", "tests/", "fixtures/"].iter().any(|folder| name.starts_with(folder))
            && !name.contains(|c: char| c.is_whitespace() || "…*{".contains(c))
    };
    code.filter(is_path).filter(|name| !root().join(name).exists()).collect()
}

#[test]
fn every_path_that_a_page_names_exists() {
    let mut faults = Vec::new();
    for page in pages() {
        let text = read(&page);
        let lost = lost_paths(&text);
        faults.extend(lost.iter().map(|name| format!("{}: {name}", page.display())));
    }
    assert!(faults.is_empty(), "correct these paths:\n{}", faults.join("\n"));
}

#[test]
fn every_name_of_the_glossary_is_in_the_source() {
    let names = bold_names(&read(&root().join("docs/glossary.md")));
    assert!(names.len() > 20, "the names of the glossary were not found");
    let folders = ["src", "crates/kerfold-kernel/src", "crates/kerfold-sheet/src"];
    let files = folders.iter().flat_map(|folder| files(&root().join(folder), "rs"));
    let source: Vec<String> = files.map(|file| read(&file)).collect();
    let words: BTreeSet<String> = source.iter().flat_map(|text| words_of(text)).collect();
    let lost = missing(names, &words);
    assert!(
        lost.is_empty(),
        "docs/glossary.md names what src does not have (any more): {}",
        lost.join(", ")
    );
}

#[test]
fn planted_mistakes_are_found() {
    let page = "# A page\n[good](Cargo.toml) \
    [bad](no/such.md)\n```\n[code](nowhere)\n```\n`[code](nowhere)` [web](https://x.y) \
                [there](#a-page) [gone](#not-here)";
    assert_eq!(broken(page, &root()), [(2, "no/such.md".to_owned()), (6, "#not-here".to_owned())]);
    assert_eq!(
        lost_paths("`src/lib.rs` `src/no.rs`\n```\n`src/code.rs`\n```\n`crates/none/src`"),
        ["src/no.rs", "crates/none/src"]
    );
    let names = bold_names("**`Mesh::plane()`**, **bold**, `code`, **`no_such_name`**");
    assert_eq!(
        names.iter().map(String::as_str).collect::<Vec<_>>(),
        ["Mesh", "no_such_name", "plane"]
    );
    let words = words_of("pub fn plane(mesh: &Mesh)").collect();
    assert_eq!(missing(names, &words), ["no_such_name"]);
}
