//! The place of a fault in a recipe: its line with the word underlined, as compilers show it.

use std::io::IsTerminal as _;
use std::ops::Range;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::colour::Colour;
use crate::recipe::{Position, RecipeError};

/// The line with the fault; `None` when no line is to blame.
pub(super) fn recipe_snippet(
    path: &Path,
    text: &str,
    error: &RecipeError,
    colour: Colour,
) -> Option<String> {
    let span = word_at(text, error.at()?)?;
    let path = path.to_string_lossy();
    let mark = AnnotationKind::Primary.span(span).label(error.advice());
    let snippet = Snippet::source(text).path(path).annotation(mark);
    let is_wanted = || std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    let is_coloured = match colour {
        Colour::Auto => std::io::stderr().is_terminal() && is_wanted(),
        Colour::Always => true,
        Colour::Never => false,
    };
    let renderer = if is_coloured { Renderer::styled() } else { Renderer::plain() };
    Some(renderer.render(&[Group::with_level(Level::ERROR).element(snippet)]))
}

/// The bytes of the word, quoted text or sign that begins at a place.
fn word_at(text: &str, at: Position) -> Option<Range<usize>> {
    let line_start = match at.line {
        0 | 1 => 0,
        line => text.match_indices('\n').nth(line - 2)?.0 + 1,
    };
    let line = text[line_start..].lines().next().unwrap_or_default();
    let column = line.char_indices().nth(at.column.saturating_sub(1));
    let Some((offset, first)) = column else {
        // A line that ends too early.
        let end = line_start + line.len();
        return Some(end..end);
    };
    let rest = &line[offset..];
    let length = match first {
        '"' | '\'' => rest[1..].find(first).map_or(rest.len(), |end| end + 2),
        _ => rest
            .find(|c: char| c.is_whitespace() || "=,]}#".contains(c))
            .unwrap_or(rest.len())
            .max(first.len_utf8()),
    };
    let start = line_start + offset;
    Some(start..start + length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;

    fn shown(text: &str) -> String {
        let error = Recipe::parse(text).expect_err("a fault");
        recipe_snippet(Path::new("lamp.toml"), text, &error, Colour::Never).expect("a place")
    }

    #[test]
    fn the_word_is_underlined_and_the_advice_stands_beside_it() {
        let shown = shown("[[step]]\nsolid = \"cube\"\nszie = \"3mm\"\n");
        assert!(shown.contains("lamp.toml:3:1"), "{shown}");
        assert!(shown.contains("3 | szie = \"3mm\""), "{shown}");
        assert!(shown.contains("^^^^ did you mean `size`?"), "{shown}");
    }

    #[test]
    fn texts_are_underlined_whole_and_letters_of_several_bytes_are_counted_once() {
        let shown = shown("name = \"Würfel\" # äöü\n[[step]]\nsolid = \"kübe\"\n");
        assert!(shown.contains("lamp.toml:3:9"), "{shown}");
        assert!(shown.contains("\n  |         ^^^^^^"), "{shown}");
    }

    #[test]
    fn any_place_has_a_word() {
        let text = "a = 1\n\nb=[ü";
        for line in 0..5 {
            for column in 0..9 {
                if let Some(span) = word_at(text, Position { line, column }) {
                    assert!(text.get(span).is_some(), "{line}:{column}");
                }
            }
        }
    }
}
