//! The text of a recipe and the keys and values of a step, every complaint with line and column.

use std::borrow::Cow;
use std::ops::Range;

use clap::{Args, Command};
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::DeValue;

use super::error::{Position, RecipeError};
use super::parameters::Parameters;
use crate::units::nearest_word;

pub(super) struct RecipeText<'a> {
    pub text: &'a str,
    pub parameters: Parameters,
}

impl RecipeText<'_> {
    pub fn position(&self, offset: usize) -> Position {
        let mut end = offset.min(self.text.len());
        // Not every span of the TOML reader ends between characters.
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Position {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    pub fn syntax(&self, error: &toml::de::Error) -> RecipeError {
        let at = self.position(error.span().map_or(0, |s| s.start));
        RecipeError::Syntax { at, message: error.message().to_owned() }
    }

    pub fn bad(&self, span: Range<usize>, message: &str) -> RecipeError {
        RecipeError::BadValue { at: self.position(span.start), message: message.to_owned() }
    }

    pub fn unknown(
        &self,
        span: Range<usize>,
        key: &str,
        place: &str,
        known: &[&str],
    ) -> RecipeError {
        let advice = nearest_word(key, known.iter().copied()).map_or_else(
            || format!("known are {}", known.join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        RecipeError::UnknownKey {
            at: self.position(span.start),
            key: key.to_owned(),
            place: place.to_owned(),
            advice,
        }
    }
}

/// A key of a step with its value as it stands in the text.
pub(super) struct Entry<'a> {
    pub key: &'a str,
    pub key_span: Range<usize>,
    pub value: &'a Spanned<DeValue<'a>>,
}

/// Which keys a step may have, and where the value of its verb goes.
pub(super) struct KnownKeys {
    pub all: Vec<String>,
    /// The parameter that the value of the verb's key goes to.
    pub of_verb: &'static str,
    /// Words for that value, and what they stand for.
    pub words: &'static [(&'static str, &'static str)],
}

/// The keys and values of one step.
pub(super) struct StepFields<'a> {
    pub source: &'a RecipeText<'a>,
    pub known: KnownKeys,
    pub verb: &'a Entry<'a>,
    pub entries: &'a [Entry<'a>],
    pub span: Range<usize>,
}

impl StepFields<'_> {
    /// Refuses keys that the step does not take.
    pub fn check_keys(&self) -> Result<(), RecipeError> {
        let all = self.known.all.iter().map(String::as_str);
        let others: Vec<&str> = all.filter(|key| *key != self.known.of_verb).collect();
        let is_known = |e: &&Entry<'_>| e.key == self.verb.key || others.contains(&e.key);
        match self.entries.iter().find(|e| !is_known(e)) {
            None => Ok(()),
            Some(e) => {
                let place = format!("in a step with `{}`", self.verb.key);
                Err(self.source.unknown(e.key_span.clone(), e.key, &place, &others))
            }
        }
    }

    /// The value as it stands in the text. A key with a dot and a table with a header of its own
    /// have no such place, and no step takes them.
    fn value_text<'t>(&'t self, entry: &Entry<'_>) -> Result<Cow<'t, str>, RecipeError> {
        let opening = match entry.value.get_ref() {
            DeValue::Table(_) => "{",
            DeValue::Array(_) => "[",
            _ => "",
        };
        let text = self.source.text.get(entry.value.span()).filter(|t| t.starts_with(opening));
        // `[[step.key]]` begins with a bracket, too.
        let Some(text) = text.filter(|t| !t.starts_with("[[step.")) else {
            let message = format!(
                "`{0}` takes a value, not a table; write {0} = …, without a dot after it",
                entry.key
            );
            return Err(self.source.bad(entry.key_span.clone(), &message));
        };
        let words = if entry.key == self.verb.key { self.known.words } else { &[] };
        if let Some((_, switch)) = words.iter().find(|(word, _)| *word == text) {
            return Ok(Cow::Borrowed(switch));
        }
        let filled = self.source.parameters.fill(text);
        filled.map_err(|message| self.source.bad(entry.value.span(), &message))
    }

    /// Reads one parameter struct from those entries that are its fields. Each value is read from
    /// its own text, so that an error inside it can be placed.
    pub(super) fn read<T: Args + DeserializeOwned>(&self) -> Result<T, RecipeError> {
        let names = field_names::<T>();
        let mut document = String::new();
        let mut places: Vec<(Range<usize>, usize)> = Vec::new();
        for entry in self.entries {
            let field = if entry.key == self.verb.key { self.known.of_verb } else { entry.key };
            if !names.iter().any(|n| n == field) {
                continue;
            }
            let span = entry.value.span();
            let start = document.len();
            document += &format!("{field} = {}\n", self.value_text(entry)?);
            places.push((start..document.len(), span.start));
        }
        let deserializer = toml::Deserializer::parse(&document).map_err(|e| {
            // Each value was read once; only together they can be wrong.
            self.source.bad(self.span.clone(), e.message())
        })?;
        T::deserialize(deserializer).map_err(|e| {
            // What is wrong with the step as a whole, such as a missing field, spans all of its
            // text or none of it.
            let in_value =
                e.span().filter(|s| !s.is_empty() && s.len() < document.trim_end().len());
            let place = match in_value {
                Some(span) => places.iter().find(|(range, _)| range.contains(&span.start)),
                None => places
                    .iter()
                    .find(|(range, _)| fails_alone::<T>(&document[range.clone()], e.message())),
            };
            let offset = place.map_or(self.span.start, |p| p.1);
            self.source.bad(offset..offset, e.message())
        })
    }
}

/// Whether one entry alone brings an error about. The fields of flattened structs report errors
/// without their place, so the entry is looked for. What an empty step brings about, too, is no
/// fault of an entry.
fn fails_alone<T: DeserializeOwned>(entry: &str, message: &str) -> bool {
    let fails = |text: &str| toml::from_str::<T>(text).is_err_and(|e| e.message() == message);
    fails(entry) && !fails("")
}

/// The names of a parameter struct's fields, as its command-line definition has them.
fn field_names<T: Args>() -> Vec<String> {
    let command = T::augment_args(Command::new("step"));
    command.get_arguments().map(|a| a.get_id().to_string()).collect()
}
