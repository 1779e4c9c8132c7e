//! Golden files, and the one way to accept a change of them: `KERFOLD_BLESS=1 cargo test`.

use std::path::{Path, PathBuf};

/// Whether golden files are to be written instead of compared.
pub fn is_blessing() -> bool {
    std::env::var_os("KERFOLD_BLESS").is_some()
}

/// What differs between a text and a golden file, in a sentence.
pub fn difference(found: &str, golden: &str) -> Option<String> {
    let mut lines = found.lines().zip(golden.lines()).enumerate();
    let line = lines
        .find(|(_, (a, b))| a != b)
        .map(|(i, (a, b))| format!("line {}: `{a}` instead of `{b}`", i + 1));
    line.or_else(|| {
        (found != golden).then(|| format!("{} bytes instead of {}", found.len(), golden.len()))
    })
}

/// Asserts that a text is that of a file, named from the top folder; or writes it.
#[track_caller]
pub fn assert_golden(name: impl AsRef<Path>, found: &str) {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join(&name);
    if is_blessing() {
        std::fs::write(&path, found).expect("the golden file can be written");
    }
    let name = name.as_ref().display();
    let golden = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{name}: {error}; KERFOLD_BLESS=1 writes it"));
    let difference = difference(found, &golden);
    assert_eq!(difference, None, "{name}; KERFOLD_BLESS=1 cargo test writes it anew");
}
