//! Reads Rust source far enough for the house rules: words and signs, without comments, strings and
//! test items.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::Fault;

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All source files but those that hold only tests.
pub fn sources() -> Vec<Source> {
    let mut files = Vec::new();
    for (_, home) in super::CRATES {
        collect(&root().join(home), &mut files);
    }
    let read_one = |file: &PathBuf| {
        let path = file
            .strip_prefix(root())
            .expect("a file of this package")
            .to_string_lossy()
            .replace('\\', "/");
        let text = read(file);
        (test_only_files(&path, &text), Source::new(&path, &text))
    };
    let (test_only, sources): (Vec<Vec<String>>, Vec<Source>) = files.iter().map(read_one).unzip();
    let test_only: BTreeSet<String> = test_only.into_iter().flatten().collect();
    let is_test = |path: &str| {
        path.ends_with("/tests.rs")
            || test_only.contains(path)
            || path.rsplit('/').skip(1).any(|dir| dir == "tests")
    };
    sources.into_iter().filter(|source| !is_test(&source.path)).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries =
        fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut entries: Vec<PathBuf> =
        entries.map(|entry| entry.expect("a readable entry").path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            collect(&entry, files);
        } else if entry.extension().is_some_and(|ending| ending == "rs") {
            files.push(entry);
        }
    }
}

/// The files that a file declares as modules for tests: `#[cfg(test)] mod fixtures;`.
fn test_only_files(path: &str, text: &str) -> Vec<String> {
    let stem = path.trim_end_matches(".rs");
    let folder = stem.trim_end_matches("/mod").trim_end_matches("/lib").to_owned();
    let tokens = tokenize(text);
    let mut names = Vec::new();
    for i in (0..tokens.len()).filter(|&i| reads(&tokens, i, CFG_TEST)) {
        let end = end_of_item(&tokens, i + CFG_TEST.len());
        let item = &tokens[i + CFG_TEST.len()..end];
        if item.len() >= 3 && item[item.len() - 3].text == "mod" && item[item.len() - 1].text == ";"
        {
            names.push(format!("{folder}/{}.rs", item[item.len() - 2].text));
        }
    }
    names
}

const CFG_TEST: &[&str] = &["#", "[", "cfg", "(", "test", ")", "]"];

/// A word or sign of a source file.
#[derive(Debug, Clone)]
pub struct Token {
    pub line: usize,
    pub text: String,
}

/// A path such as `crate::mesh::Mesh`, groups of a `use` spread out.
pub struct UsedPath {
    pub line: usize,
    pub segments: Vec<String>,
    /// The name that a `use` brings in, `*` for all; none for a path in code.
    pub name: Option<String>,
}

/// A source file without comments, strings and test items.
pub struct Source {
    pub path: String,
    pub tokens: Vec<Token>,
}

impl Source {
    pub fn new(path: &str, text: &str) -> Self {
        let all = tokenize(text);
        let mut tokens = Vec::with_capacity(all.len());
        let mut i = 0;
        while i < all.len() {
            if reads(&all, i, CFG_TEST) {
                i = end_of_item(&all, i + CFG_TEST.len());
            } else {
                tokens.push(all[i].clone());
                i += 1;
            }
        }
        Self { path: path.to_owned(), tokens }
    }

    pub fn reads(&self, at: usize, wanted: &[&str]) -> bool {
        reads(&self.tokens, at, wanted)
    }

    pub fn fault(&self, line: usize, advice: String) -> Fault {
        Fault { path: self.path.clone(), line, advice }
    }

    /// The path below the folder of its crate.
    fn inner_path(&self) -> Option<&str> {
        super::CRATES.iter().find_map(|(_, home)| self.path.strip_prefix(home))
    }

    /// The module of the crate to which the file belongs; none for the roots of library and binary.
    pub fn module(&self) -> Option<&str> {
        let first = self.inner_path()?.split('/').next()?;
        let name = first.trim_end_matches(".rs");
        (!["lib", "main"].contains(&name)).then_some(name)
    }

    /// The name of the crate and the modules down to this file; none for the program.
    pub fn module_path(&self) -> Option<Vec<String>> {
        let (name, home) = super::CRATES.iter().find(|(_, home)| self.path.starts_with(home))?;
        let inner = self.path[home.len()..].trim_end_matches(".rs").trim_end_matches("/mod");
        let modules = inner.split('/').filter(|module| *module != "lib");
        let path = std::iter::once(*name).chain(modules).map(str::to_owned).collect();
        (inner != "main").then_some(path)
    }

    /// How many modules deep the file stands: 1 for `src/mesh/mod.rs`, 2 for `src/mesh/walk.rs`.
    fn depth(&self) -> usize {
        let path = self.inner_path().unwrap_or_default();
        path.trim_end_matches(".rs").trim_end_matches("/mod").split('/').count()
    }

    /// The module of the house that a path begins with, be it by `crate::`, by the name of one of
    /// our crates, or by climbing up with `super::`.
    pub fn inner_module(&self, path: &UsedPath) -> Option<String> {
        let first = path.segments.first()?;
        let climbs = path.segments.iter().take_while(|s| *s == "super").count();
        let steps = match first.as_str() {
            "crate" => 1,
            "super" if climbs == self.depth() => climbs,
            name if super::CRATES.iter().any(|(ours, _)| *ours == name) => 1,
            _ => return None,
        };
        path.segments.get(steps).filter(|s| *s != "self").cloned()
    }

    pub fn declares(&self, module: &str) -> bool {
        (0..self.tokens.len()).any(|i| self.reads(i, &["mod", module]))
    }

    pub fn paths(&self) -> Vec<UsedPath> {
        let mut paths = Vec::new();
        let mut i = 0;
        while i < self.tokens.len() {
            // `impl Trait + use<'_>` names lifetimes, not modules.
            if self.tokens[i].text == "use" && !self.reads(i + 1, &["<"]) {
                i = self.spread(i + 1, &[], &mut paths);
            } else if self.is_word(i)
                && self.reads(i + 1, &["::"])
                && (i == 0 || !self.reads(i - 1, &["::"]))
            {
                i = self.plain_path(i, &mut paths);
            } else {
                i += 1;
            }
        }
        paths
    }

    pub fn is_word(&self, i: usize) -> bool {
        self.tokens
            .get(i)
            .is_some_and(|t| t.text.starts_with(|c: char| c.is_alphabetic() || c == '_'))
    }

    fn plain_path(&self, start: usize, paths: &mut Vec<UsedPath>) -> usize {
        let mut segments = vec![self.tokens[start].text.clone()];
        let mut i = start + 1;
        while self.reads(i, &["::"]) && self.is_word(i + 1) {
            segments.push(self.tokens[i + 1].text.clone());
            i += 2;
        }
        paths.push(UsedPath { line: self.tokens[start].line, segments, name: None });
        i
    }

    /// Reads one branch of a `use` tree and returns the place after it.
    fn spread(&self, start: usize, before: &[String], paths: &mut Vec<UsedPath>) -> usize {
        let mut segments = before.to_vec();
        let mut alias = None;
        let mut i = start;
        while let Some(token) = self.tokens.get(i) {
            match token.text.as_str() {
                "{" => {
                    i += 1;
                    // A semicolon cannot stand in a group; stopping there keeps text that is no
                    // Rust from going on for ever.
                    while i < self.tokens.len() && !self.reads(i, &["}"]) && !self.reads(i, &[";"])
                    {
                        i = self.spread(i, &segments, paths);
                        i += usize::from(self.reads(i, &[","]));
                    }
                    return i + 1;
                }
                "," | "}" | ";" => break,
                "::" => i += 1,
                "as" => {
                    alias = self.tokens.get(i + 1).map(|t| t.text.clone());
                    i += 2;
                }
                word => {
                    segments.push(word.to_owned());
                    i += 1;
                }
            }
        }
        let line = self.tokens.get(start).map_or(0, |t| t.line);
        if segments.len() > 1 {
            segments.pop_if(|last| last == "self");
        }
        if let Some(last) = segments.last() {
            let name = Some(alias.unwrap_or_else(|| last.clone()));
            paths.push(UsedPath { line, segments, name });
        }
        i
    }
}

fn reads(tokens: &[Token], at: usize, wanted: &[&str]) -> bool {
    tokens
        .get(at..at + wanted.len())
        .is_some_and(|found| found.iter().zip(wanted).all(|(t, w)| t.text == *w))
}

/// The place after the item that begins at `start`: after its closing brace, or after its
/// semicolon; of a field after its comma, or before the brace that closes the others in.
fn end_of_item(tokens: &[Token], start: usize) -> usize {
    let is_field = is_field(tokens, start);
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().skip(start) {
        match token.text.as_str() {
            "}" if is_field && depth == 0 => return i,
            "," if is_field && depth == 0 => return i + 1,
            "{" | "(" | "[" | "<" if is_field => depth += 1,
            "}" | ")" | "]" | ">" if is_field => depth -= 1,
            "{" | "(" | "[" => depth += 1,
            "}" if depth <= 1 => return i + 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            ";" if depth == 0 => return i + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// Whether a field begins at `start`, of a struct or of a value: a word and a colon.
fn is_field(tokens: &[Token], start: usize) -> bool {
    let mut i = start;
    if reads(tokens, i, &["pub"]) {
        i += 1;
        if reads(tokens, i, &["("]) {
            i += tokens[i..].iter().take_while(|token| token.text != ")").count() + 1;
        }
    }
    reads(tokens, i + 1, &[":"])
}

/// Divides a text into words, `::` and single signs; comments, strings, characters and lifetimes
/// are dropped.
fn tokenize(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let (mut i, mut line) = (0, 1);
    while i < chars.len() {
        let start = i;
        let mut word = String::new();
        match chars[i] {
            '/' if chars.get(i + 1) == Some(&'/') => i = line_end(&chars, i),
            '/' if chars.get(i + 1) == Some(&'*') => i = comment_end(&chars, i),
            '"' => i = string_end(&chars, i),
            '\'' => i = character_end(&chars, i),
            'r' | 'b' if raw_string_end(&chars, i).is_some() => {
                i = raw_string_end(&chars, i).unwrap_or(i + 1)
            }
            c if c.is_alphanumeric() || c == '_' => {
                i += chars[i..].iter().take_while(|c| c.is_alphanumeric() || **c == '_').count();
                word = chars[start..i].iter().collect();
            }
            ':' if chars.get(i + 1) == Some(&':') => {
                word = "::".to_owned();
                i += 2;
            }
            c => {
                if !c.is_whitespace() {
                    word.push(c);
                }
                i += 1;
            }
        }
        if !word.is_empty() {
            tokens.push(Token { line, text: word });
        }
        line += chars[start..i.min(chars.len())].iter().filter(|c| **c == '\n').count();
    }
    tokens
}

fn line_end(chars: &[char], start: usize) -> usize {
    chars[start..].iter().position(|c| *c == '\n').map_or(chars.len(), |n| start + n)
}

/// Block comments nest.
fn comment_end(chars: &[char], start: usize) -> usize {
    let (mut depth, mut i) = (0, start);
    while i < chars.len() {
        match (chars[i], chars.get(i + 1)) {
            ('/', Some('*')) => (depth, i) = (depth + 1, i + 2),
            ('*', Some('/')) => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    chars.len()
}

fn string_end(chars: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < chars.len() {
        match chars[i] {
            '\\' => i += 2,
            '"' => return i + 1,
            _ => i += 1,
        }
    }
    chars.len()
}

/// The end of `r"…"`, `r#"…"#`, `b"…"` or `br"…"`; none when this is an ordinary word.
fn raw_string_end(chars: &[char], start: usize) -> Option<usize> {
    if start > 0 && (chars[start - 1].is_alphanumeric() || chars[start - 1] == '_') {
        return None;
    }
    let mut i = start;
    i += usize::from(chars.get(i) == Some(&'b'));
    let is_raw = chars.get(i) == Some(&'r');
    i += usize::from(is_raw);
    let hashes = chars[i..].iter().take_while(|c| is_raw && **c == '#').count();
    if chars.get(i + hashes) != Some(&'"') {
        return None;
    }
    if !is_raw {
        return Some(string_end(chars, i));
    }
    let body = i + hashes + 1;
    let closes = |n: usize| {
        chars[n] == '"'
            && chars[n + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes
    };
    Some((body..chars.len()).find(|&n| closes(n)).map_or(chars.len(), |n| n + 1 + hashes))
}

/// The end of a character; of a lifetime only its apostrophe.
fn character_end(chars: &[char], start: usize) -> usize {
    if chars.get(start + 1) == Some(&'\\') {
        let close = chars[start + 3..].iter().position(|c| *c == '\'');
        return close.map_or(chars.len(), |n| start + 3 + n + 1);
    }
    if chars.get(start + 2) == Some(&'\'') { start + 3 } else { start + 1 }
}
