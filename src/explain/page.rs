//! The pages of `docs/errors.md`, one for each code.

use crate::code::Code;

const TEXT: &str = include_str!("../../docs/errors.md");

/// What a code means and what to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Page {
    /// The code.
    pub code: Code,
    /// A few words; of findings that reports name, the name.
    pub title: &'static str,
    /// Two sentences on one line, code in backticks.
    pub text: &'static str,
}

impl Page {
    /// The title as one types it: small letters with hyphens.
    pub fn name(&self) -> String {
        let spelt: String = self
            .title
            .to_lowercase()
            .chars()
            .map(|c| if c.is_alphanumeric() { c } else { '-' })
            .collect();
        spelt.split('-').filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
    }
}

/// All pages, as they stand in the file: errors first, numbers ascending.
pub fn pages() -> Vec<Page> {
    read(TEXT)
}

/// Pages are `## CODE Title`, a blank line, the text on one line. Other headings and texts are for
/// readers of the file.
fn read(text: &'static str) -> Vec<Page> {
    let mut lines = text.lines().filter(|line| !line.is_empty()).peekable();
    let mut pages = Vec::new();
    while let Some(line) = lines.next() {
        let heading = line.strip_prefix("## ").and_then(|heading| heading.split_once(' '));
        let page = heading.and_then(|(code, title)| Some((Code::read(code)?, title)));
        if let Some((code, title)) = page {
            let text = lines.next_if(|line| !line.starts_with('#')).unwrap_or_default();
            pages.push(Page { code, title, text });
        }
    }
    pages
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_headings_with_the_line_below() {
        let found = read(
            "# Errors\n\nHow to read.\n\n## E001 First of all\n\nA. B.\n\n# Files\n\n## F002 \
            thin-web\n## Not one\n\nC.",
        );
        let (first, second) = (Code::error(1), Code::finding(2));
        let expected = [
            Page { code: first, title: "First of all", text: "A. B." },
            Page { code: second, title: "thin-web", text: "" },
        ];
        assert_eq!(found, expected);
        assert_eq!(found[0].name(), "first-of-all");
    }
}
