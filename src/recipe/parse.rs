//! Recipes as text: TOML in, steps out, every complaint with line and column.
//!
//! Which steps there are and which keys they take is said in [`super::keys`].

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::RecipeError;
use super::fields::{Entry, RecipeText, StepFields};
use super::keys::{StepKind, cuts, steps, verbs};
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

impl RecipeText<'_> {
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
        let known = step.known_keys();
        let fields = StepFields { source: self, known, verb, entries, span };
        fields.check_keys()?;
        (step.read)(&fields)
    }
}
