//! Recipes as text: TOML in, steps out, every complaint with line and column.
//!
//! Which steps there are and which keys they take is said in [`super::keys`].

use std::borrow::Cow;
use std::ops::Range;

use clap::Args;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Position, RecipeError};
use super::keys::{StepKind, cuts, field_names, steps, verbs};
use super::parameters::{Parameters, is_name};
use super::{Recipe, Step};
use crate::units::nearest_word;

impl Recipe {
    /// Reads a recipe.
    ///
    /// # Errors
    /// [`RecipeError`] with line and column, and the nearest known name for an unknown one.
    pub fn parse(text: &str) -> Result<Self, RecipeError> {
        Self::parse_with(text, &[])
    }

    /// Reads a recipe with other values than its own for some of its parameters, as names and
    /// values (`size`, `200mm`).
    ///
    /// # Errors
    /// As [`Self::parse`]; [`RecipeError::NoSuchParameter`] for a name that the recipe does not
    /// have.
    ///
    /// # Example
    /// ```
    /// use kerfold::recipe::Recipe;
    ///
    /// let text = "[parameters]\nsize = \"80mm\"\n[[step]]\nsolid = \"cube\"\nsize = \"{size}\"\n";
    /// assert!(Recipe::parse_with(text, &[("size".into(), "200mm".into())]).is_ok());
    /// assert!(Recipe::parse_with(text, &[("sise".into(), "200mm".into())]).is_err());
    /// ```
    pub fn parse_with(text: &str, set: &[(String, String)]) -> Result<Self, RecipeError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut source = RecipeText { text, parameters: Parameters::default() };
        let table = DeTable::parse(text).map_err(|e| source.syntax(&e))?;
        source.parameters = source.read_parameters(table.get_ref())?;
        for (name, value) in set {
            if !source.parameters.set(name, value) {
                let message = source.parameters.unknown(name);
                return Err(RecipeError::NoSuchParameter { message });
            }
        }
        let mut recipe = Self { name: None, steps: Vec::new() };
        for (key, value) in table.get_ref().iter() {
            match (key.get_ref().as_ref(), value.get_ref()) {
                ("name", DeValue::String(name)) => recipe.name = Some(name.to_string()),
                ("name", _) => {
                    return Err(
                        source.bad(value.span(), "the name of a recipe is a text, in quotes")
                    );
                }
                ("parameters", _) => {}
                ("step", DeValue::Array(steps)) => {
                    for step in steps.iter() {
                        recipe.steps.push(source.step(step)?);
                    }
                }
                ("step", _) => {
                    return Err(
                        source.bad(value.span(), "steps are written [[step]], with two brackets")
                    );
                }
                _ => {
                    return Err(source.unknown(
                        key.span(),
                        key.get_ref(),
                        "in a recipe",
                        &["name", "parameters", "step"],
                    ));
                }
            }
        }
        if recipe.steps.is_empty() { Err(RecipeError::NoSteps) } else { Ok(recipe) }
    }
}

struct RecipeText<'a> {
    text: &'a str,
    parameters: Parameters,
}

/// A key of a step with its value as it stands in the text.
struct Entry<'a> {
    key: &'a str,
    key_span: Range<usize>,
    value: &'a Spanned<DeValue<'a>>,
}

impl RecipeText<'_> {
    fn position(&self, offset: usize) -> Position {
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

    fn read_parameters(&self, table: &DeTable<'_>) -> Result<Parameters, RecipeError> {
        let mut parameters = Parameters::default();
        let Some((_, value)) = table.iter().find(|(key, _)| key.get_ref() == "parameters") else {
            return Ok(parameters);
        };
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.bad(value.span(), "parameters are a table: [parameters]"));
        };
        for (key, value) in entries.iter() {
            let name = key.get_ref().as_ref();
            if !is_name(name) {
                let message = "a parameter is called by letters, digits, - and _";
                return Err(self.bad(key.span(), message));
            }
            let text = match value.get_ref() {
                DeValue::String(text) => text.to_string(),
                DeValue::Integer(_) | DeValue::Float(_) => self.text[value.span()].to_owned(),
                _ => {
                    let message = "a parameter is a number or a text, such as \"180mm\"";
                    return Err(self.bad(value.span(), message));
                }
            };
            parameters.add(name.to_owned(), text);
        }
        Ok(parameters)
    }

    fn syntax(&self, error: &toml::de::Error) -> RecipeError {
        let at = self.position(error.span().map_or(0, |s| s.start));
        RecipeError::Syntax { at, message: error.message().to_owned() }
    }

    fn bad(&self, span: Range<usize>, message: &str) -> RecipeError {
        RecipeError::BadValue { at: self.position(span.start), message: message.to_owned() }
    }

    fn unknown(&self, span: Range<usize>, key: &str, place: &str, known: &[&str]) -> RecipeError {
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

    fn step(&self, step: &Spanned<DeValue<'_>>) -> Result<Step, RecipeError> {
        let DeValue::Table(table) = step.get_ref() else {
            return Err(self.bad(step.span(), "a step is a table of keys and values"));
        };
        let mut entries: Vec<Entry<'_>> = table
            .iter()
            .map(|(key, value)| Entry { key: key.get_ref().as_ref(), key_span: key.span(), value })
            .collect();
        entries.sort_by_key(|e| e.key_span.start);
        // An unfold step has a list of edges called `cut`, which is no verb there.
        let is_unfold = entries.iter().any(|e| e.key == "unfold");
        let is_verb = |e: &&Entry<'_>| {
            steps().iter().any(|s| s.verb == e.key) && !(is_unfold && e.key == "cut")
        };
        let mut found = entries.iter().filter(is_verb);
        let Some(verb) = found.next() else {
            return Err(self.no_verb(step.span(), &entries));
        };
        if let Some(second) = found.next() {
            let at = self.position(second.key_span.start);
            return Err(RecipeError::TwoVerbs {
                at,
                first: verb.key.to_owned(),
                second: second.key.to_owned(),
            });
        }
        self.step_of(verb, &entries, step.span())
    }

    /// A step without a verb, most often because the verb is misspelt.
    fn no_verb(&self, span: Range<usize>, entries: &[Entry<'_>]) -> RecipeError {
        let verbs = verbs();
        match entries.iter().find(|e| nearest_word(e.key, verbs.iter().copied()).is_some()) {
            Some(e) => self.unknown(e.key_span.clone(), e.key, "as a step", &verbs),
            None => RecipeError::NoVerb { at: self.position(span.start), verbs: verbs.join(", ") },
        }
    }

    fn step_of(
        &self,
        verb: &Entry<'_>,
        entries: &[Entry<'_>],
        span: Range<usize>,
    ) -> Result<Step, RecipeError> {
        let kind = match (verb.key, verb.value.get_ref()) {
            ("cut", DeValue::String(kind)) => kind.to_string(),
            ("cut", _) => {
                return Err(self.bad(
                    verb.value.span(),
                    "cut takes \"vertex\", \"edge\", \"face\" or \"plane\"",
                ));
            }
            _ => String::new(),
        };
        let is_meant = |step: &&StepKind| {
            step.verb == verb.key && step.kind.is_none_or(|wanted| wanted == kind)
        };
        let Some(step) = steps().iter().find(is_meant) else {
            return Err(self.unknown(verb.value.span(), &kind, "as something to cut", &cuts()));
        };
        let fields = StepFields { source: self, step, verb, entries, span };
        fields.check_keys()?;
        (step.read)(&fields)
    }
}

/// The keys and values of one step.
pub(super) struct StepFields<'a> {
    source: &'a RecipeText<'a>,
    step: &'static StepKind,
    verb: &'a Entry<'a>,
    entries: &'a [Entry<'a>],
    span: Range<usize>,
}

impl StepFields<'_> {
    fn check_keys(&self) -> Result<(), RecipeError> {
        let known = self.step.keys();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let field_of_verb = self.step.field;
        let is_known = |e: &&Entry<'_>| {
            e.key == self.verb.key || (known.contains(&e.key) && e.key != field_of_verb)
        };
        match self.entries.iter().find(|e| !is_known(e)) {
            None => Ok(()),
            Some(e) => {
                let others: Vec<&str> =
                    known.iter().copied().filter(|k| *k != field_of_verb).collect();
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
        let words = if entry.key == self.verb.key { self.step.words } else { &[] };
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
            let field = if entry.key == self.verb.key { self.step.field } else { entry.key };
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
