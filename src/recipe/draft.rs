//! A recipe as its author wrote it: keys and values, which can be changed one by one and written
//! down again. Values stay as they were typed, so that `"40mm"` is not `40` afterwards.

use std::fmt::Write;

use serde::{Deserialize, Serialize};
use toml::de::{DeTable, DeValue};

use super::error::{Position, RecipeError};
use super::parameters::Parameters;
use super::{Recipe, Step};

/// A value of a key: a text, a number, a switch, or a list of these.
pub use toml::Value;

/// A step: its keys and values in the order in which they are written, the verb first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StepDraft {
    entries: Vec<(String, Value)>,
}

/// A recipe as keys and values.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RecipeDraft {
    /// What it makes.
    pub name: Option<String>,
    /// Names and values that steps use as `"{size}"`, in their order.
    #[serde(default)]
    pub parameters: Vec<(String, Value)>,
    /// The steps.
    pub steps: Vec<StepDraft>,
}

impl StepDraft {
    /// A step that begins with a verb and its value: `solid = "cube"`.
    pub fn new(verb: &str, value: impl Into<Value>) -> Self {
        Self { entries: vec![(verb.to_owned(), value.into())] }
    }

    /// The same with one key more.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.set(key, Some(value.into()));
        self
    }

    /// Keys and values in order.
    pub fn entries(&self) -> &[(String, Value)] {
        &self.entries
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// Sets a key, or takes it away so that its default counts again. A new key comes last.
    pub fn set(&mut self, key: &str, value: Option<Value>) {
        match (self.entries.iter().position(|(name, _)| name == key), value) {
            (Some(i), Some(value)) => self.entries[i].1 = value,
            (Some(i), None) => drop(self.entries.remove(i)),
            (None, Some(value)) => self.entries.push((key.to_owned(), value)),
            (None, None) => {}
        }
    }

    /// The step that the keys and values stand for in a recipe with these parameters.
    ///
    /// # Errors
    /// As [`Recipe::parse`]; the line of the place is that of [`Self::text`].
    pub fn read(&self, parameters: &[(String, Value)]) -> Result<Step, RecipeError> {
        // They come last, so that lines stay as they are.
        let mut recipe = Recipe::parse(&(self.text() + &parameters_text(parameters)))?;
        recipe.steps.pop().ok_or(RecipeError::NoSteps)
    }

    /// The same with parameters in their places, as reading it sees the values.
    ///
    /// # Errors
    /// [`RecipeError::BadValue`] for a parameter that does not exist or cannot stand there; the
    /// line of the place is that of [`Self::text`].
    pub fn filled(&self, parameters: &[(String, Value)]) -> Result<Self, RecipeError> {
        let mut known = Parameters::default();
        for (name, value) in parameters {
            let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            known.add(name.clone(), text);
        }
        let fill = |(i, (key, value)): (usize, &(String, Value))| {
            let at = Position { line: i + 2, column: 1 };
            let bad = |message| RecipeError::BadValue { at, message };
            let text = value.to_string();
            let text = known.fill(&text).map_err(bad)?;
            let mut table: toml::Table = toml::from_str(&format!("value = {text}"))
                .map_err(|error| bad(error.message().to_owned()))?;
            Ok((key.clone(), table.remove("value").unwrap_or_else(|| value.clone())))
        };
        let entries = self.entries.iter().enumerate().map(fill);
        Ok(Self { entries: entries.collect::<Result<_, RecipeError>>()? })
    }

    /// The key that stands in a line of [`Self::text`].
    pub(super) fn key_in_line(&self, line: usize) -> Option<&str> {
        self.entries.get(line.checked_sub(2)?).map(|(key, _)| key.as_str())
    }

    /// The step as TOML, one key a line.
    pub fn text(&self) -> String {
        let mut text = "[[step]]\n".to_owned();
        for (key, value) in &self.entries {
            let _ = writeln!(text, "{} = {value}", bare_key(key));
        }
        text
    }
}

/// The table of parameters; empty without any.
fn parameters_text(parameters: &[(String, Value)]) -> String {
    let head = if parameters.is_empty() { "" } else { "[parameters]\n" };
    let line = |(name, value): &(String, Value)| format!("{} = {value}\n", bare_key(name));
    head.to_owned() + &parameters.iter().map(line).collect::<String>()
}

/// A key that needs quotes gets them; no step knows such a key, and the message names it.
fn bare_key(key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(is_bare) {
        key.to_owned()
    } else {
        Value::from(key).to_string()
    }
}

impl RecipeDraft {
    /// Reads a recipe. Remarks in the text are not kept.
    ///
    /// # Errors
    /// As [`Recipe::parse`].
    pub fn parse(text: &str) -> Result<Self, RecipeError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let recipe = Recipe::parse(text)?;
        let mut draft = Self { name: recipe.name, ..Self::default() };
        // It was read once, so it is TOML.
        let Ok(table) = DeTable::parse(text) else { return Ok(draft) };
        let parameters = table.get_ref().iter().find(|(key, _)| key.get_ref() == "parameters");
        if let Some(DeValue::Table(keys)) = parameters.map(|(_, value)| value.get_ref()) {
            draft.parameters = entries(text, keys);
        }
        let steps = table.get_ref().iter().find(|(key, _)| key.get_ref().as_ref() == "step");
        let Some(DeValue::Array(steps)) = steps.map(|(_, value)| value.get_ref()) else {
            return Ok(draft);
        };
        for step in steps.iter() {
            let DeValue::Table(keys) = step.get_ref() else { continue };
            let mut entries = entries(text, keys);
            let verbs = super::keys::verbs();
            // A stable sort: only the verb moves.
            entries.sort_by_key(|(key, _)| !verbs.contains(&key.as_str()));
            draft.steps.push(StepDraft { entries });
        }
        Ok(draft)
    }

    /// The recipe as TOML.
    pub fn text(&self) -> String {
        let name = self.name.as_ref().map(|name| format!("name = {}\n", Value::from(name.clone())));
        let parameters = parameters_text(&self.parameters);
        let parameters = Some(parameters).filter(|text| !text.is_empty());
        let steps = self.steps.iter().map(StepDraft::text);
        name.into_iter().chain(parameters).chain(steps).collect::<Vec<_>>().join("\n")
    }
}

/// Keys and values of a table in the order of the text, each as it was typed.
fn entries(text: &str, keys: &DeTable<'_>) -> Vec<(String, Value)> {
    let mut entries: Vec<_> = keys.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let read = |(key, value): (&toml::Spanned<_>, &toml::Spanned<DeValue<'_>>)| {
        let line = format!("v = {}", text.get(value.span())?);
        let value = toml::from_str::<toml::Table>(&line).ok()?.remove("v")?;
        let key: &std::borrow::Cow<'_, str> = key.get_ref();
        Some((key.to_string(), value))
    };
    entries.into_iter().filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bundled_recipe_is_written_down_as_the_same_steps() {
        let mut count = 0;
        for folder in ["fixtures/recipes", "examples"] {
            for entry in std::fs::read_dir(folder).into_iter().flatten() {
                let path = entry.expect("an entry").path();
                if path.extension().is_none_or(|e| e != "toml") {
                    continue;
                }
                let text = std::fs::read_to_string(&path).expect("a recipe");
                let draft = RecipeDraft::parse(&text).expect("a recipe");
                let written = draft.text();
                let [before, after] = [&text, &written].map(|text| Recipe::parse(text));
                let [before, after] =
                    [before, after].map(|r| format!("{:?}", r.expect("a recipe")));
                assert_eq!(before, after, "{}", path.display());
                assert_eq!(RecipeDraft::parse(&written).expect("a recipe"), draft);
                count += 1;
            }
        }
        assert!(count > 5, "only {count} recipes were found");
    }

    #[test]
    fn values_stay_as_they_were_typed() {
        let text = "name = \"a \\\"b\\\"\"\n[[step]]\nsize = '40mm' # wide\nsolid = \"cube\"\n\
            [[step]]\ncut = \"plane\"\nnormal = [0, 0,\n 1]\npoint = \"0,0,1cm\"\n";
        let draft = RecipeDraft::parse(text).expect("a recipe");
        assert_eq!(
            draft.text(),
            "name = 'a \"b\"'\n\n[[step]]\nsolid = \"cube\"\nsize = \"40mm\"\n\n[[step]]\n\
            cut = \"plane\"\nnormal = [0, 0, 1]\npoint = \"0,0,1cm\"\n"
        );
    }

    #[test]
    fn parameters_are_kept_and_count() {
        let text = "name = \"x\"\n\n[parameters]\nsize = \"80mm\"\nrounds = 2\n\n[[step]]\n\
            solid = \"cube\"\nsize = \"{size}/2\"\n";
        let draft = RecipeDraft::parse(text).expect("a recipe");
        assert_eq!(draft.text(), text);
        let Ok(Step::Solid(solid)) = draft.steps[0].read(&draft.parameters) else { panic!() };
        assert_eq!(solid.size.map(crate::units::Length::mm), Some(40.0));
        assert!(draft.steps[0].read(&[]).is_err());
    }

    #[test]
    fn keys_are_set_and_taken_away() {
        let mut step = StepDraft::new("cut", "edge").with("select", "all").with("offset", 0.2);
        assert!(step.read(&[]).is_ok());
        step.set("offset", None);
        assert_eq!(step.text(), "[[step]]\ncut = \"edge\"\nselect = \"all\"\n");
        step.set("no key", Some(Value::from(1)));
        let error = step.read(&[]).expect_err("no such key").to_string();
        assert!(error.starts_with("line 4, column 1: `no key` is not known"), "{error}");
    }
}
