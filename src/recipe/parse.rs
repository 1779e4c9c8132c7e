//! Recipes as text: TOML in, steps out, every complaint with line and column.
//!
//! The keys of a step are the fields of the parameter structs that its verb takes; the structs' own command-line definitions
//! are asked for them, so that recipe and command line cannot part.

use std::ops::Range;
use std::sync::Arc;

use clap::{Args, Command};
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Position, RecipeError};
use super::{
    DformParams, FabricateParams, NestStep, OperatorStep, PanelFiles, PlanesStep, ReadStep, Recipe, ShowParams, Step,
};
use crate::check::CheckParams;
use crate::op::{
    HandleParams, HullParams, MengerParams, Operate, PlanarizeParams, ResolveParams, RindParams, SierpinskiParams,
    SliceParams, SubdivideParams, TruncateEdge, TruncateFace, TruncateVertex,
};
use crate::panel::PanelParams;
use crate::picture::RenderParams;
use crate::shape::SolidParams;
use crate::sheet::SheetParams;
use crate::unfold::UnfoldParams;
use crate::units::nearest_word;

/// The keys that say what a step does, with the field of its parameters that the value goes to.
const VERBS: &[(&str, &str)] = &[
    ("solid", "name"),
    ("read", "path"),
    ("planes", "path"),
    ("cut", ""),
    ("hull", "dual"),
    ("resolve", "select"),
    ("planarize", "profile"),
    ("subdivide", "scheme"),
    ("sierpinski", "rounds"),
    ("handle", "from"),
    ("menger", "rounds"),
    ("rind", "thickness"),
    ("check", "profile"),
    ("unfold", "pieces"),
    ("dform", "matching"),
    ("panels", "side"),
    ("nest", "pieces"),
    ("render", "view"),
];

/// What `cut` may cut.
const CUTS: [&str; 4] = ["vertex", "edge", "face", "plane"];

impl Recipe {
    /// Reads a recipe.
    ///
    /// # Errors
    /// [`RecipeError`] with line and column, and the nearest known name for an unknown one.
    pub fn parse(text: &str) -> Result<Self, RecipeError> {
        let source = Source { text };
        let table = DeTable::parse(text).map_err(|e| source.syntax(&e))?;
        let mut recipe = Self { name: None, steps: Vec::new() };
        for (key, value) in table.get_ref().iter() {
            match (key.get_ref().as_ref(), value.get_ref()) {
                ("name", DeValue::String(name)) => recipe.name = Some(name.to_string()),
                ("name", _) => return Err(source.bad(value.span(), "the name of a recipe is a text, in quotes")),
                ("step", DeValue::Array(steps)) => {
                    for step in steps.iter() {
                        recipe.steps.push(source.step(step)?);
                    }
                }
                ("step", _) => return Err(source.bad(value.span(), "steps are written [[step]], with two brackets")),
                _ => return Err(source.unknown(key.span(), key.get_ref(), "in a recipe", &["name", "step"])),
            }
        }
        if recipe.steps.is_empty() { Err(RecipeError::NoSteps) } else { Ok(recipe) }
    }
}

struct Source<'a> {
    text: &'a str,
}

/// A key of a step with its value as it stands in the text.
struct Entry<'a> {
    key: &'a str,
    key_span: Range<usize>,
    value: &'a Spanned<DeValue<'a>>,
}

impl Source<'_> {
    fn position(&self, offset: usize) -> Position {
        let before = &self.text[..offset.min(self.text.len())];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Position { line: before.matches('\n').count() + 1, column: before[line_start..].chars().count() + 1 }
    }

    fn syntax(&self, error: &toml::de::Error) -> RecipeError {
        let at = self.position(error.span().map_or(0, |s| s.start));
        RecipeError::Syntax { at, message: error.message().to_owned() }
    }

    fn bad(&self, span: Range<usize>, message: &str) -> RecipeError {
        RecipeError::BadValue { at: self.position(span.start), message: message.to_owned() }
    }

    fn unknown(&self, span: Range<usize>, key: &str, place: &str, known: &[&str]) -> RecipeError {
        let advice = nearest_word(key, known.iter().copied())
            .map_or_else(|| format!("known are {}", known.join(", ")), |near| format!("did you mean `{near}`?"));
        RecipeError::UnknownKey { at: self.position(span.start), key: key.to_owned(), place: place.to_owned(), advice }
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
        let is_verb = |e: &&Entry<'_>| VERBS.iter().any(|v| v.0 == e.key) && !(is_unfold && e.key == "cut");
        let mut verbs = entries.iter().filter(is_verb);
        let Some(verb) = verbs.next() else {
            return Err(self.no_verb(step.span(), &entries));
        };
        if let Some(second) = verbs.next() {
            let at = self.position(second.key_span.start);
            return Err(RecipeError::TwoVerbs { at, first: verb.key.to_owned(), second: second.key.to_owned() });
        }
        self.step_of(verb, &entries, step.span())
    }

    /// A step without a verb, most often because the verb is misspelt.
    fn no_verb(&self, span: Range<usize>, entries: &[Entry<'_>]) -> RecipeError {
        let verbs: Vec<&str> = VERBS.iter().map(|v| v.0).collect();
        match entries.iter().find(|e| nearest_word(e.key, verbs.iter().copied()).is_some()) {
            Some(e) => self.unknown(e.key_span.clone(), e.key, "as a step", &verbs),
            None => RecipeError::NoVerb { at: self.position(span.start), verbs: verbs.join(", ") },
        }
    }

    fn step_of(&self, verb: &Entry<'_>, entries: &[Entry<'_>], span: Range<usize>) -> Result<Step, RecipeError> {
        let kind = match (verb.key, verb.value.get_ref()) {
            ("cut", DeValue::String(kind)) => kind.to_string(),
            ("cut", _) => {
                return Err(self.bad(verb.value.span(), "cut takes \"vertex\", \"edge\", \"face\" or \"plane\""));
            }
            _ => String::new(),
        };
        let fields = StepFields { source: self, verb, entries, span };
        Ok(match (verb.key, kind.as_str()) {
            ("solid", _) => Step::Solid(fields.read1::<SolidParams>()?),
            ("read", _) => Step::Read(fields.read1::<ReadStep>()?),
            ("planes", _) => Step::Planes(fields.read1::<PlanesStep>()?),
            ("hull", _) => Step::Hull(fields.read1::<HullParams>()?),
            ("resolve", _) => fields.operator::<ResolveParams>("resolve")?,
            ("subdivide", _) => fields.operator::<SubdivideParams>("subdivide")?,
            ("sierpinski", _) => fields.operator::<SierpinskiParams>("sierpinski")?,
            ("rind", _) => fields.operator::<RindParams>("rind")?,
            ("menger", _) => fields.operator::<MengerParams>("menger")?,
            ("handle", _) => fields.operator::<HandleParams>("handle")?,
            ("planarize", _) => fields.operator::<PlanarizeParams>("planarize")?,
            ("check", _) => Step::Check(fields.read1::<CheckParams>()?),
            ("render", _) => Step::Render(fields.read1::<RenderParams>()?),
            ("unfold", _) => fields.unfold()?,
            ("dform", _) => fields.dform()?,
            ("nest", _) => fields.nest()?,
            ("panels", _) => fields.panels()?,
            ("cut", "vertex") => fields.operator::<TruncateVertex>("cut vertex")?,
            ("cut", "edge") => fields.operator::<TruncateEdge>("cut edge")?,
            ("cut", "face") => fields.operator::<TruncateFace>("cut face")?,
            ("cut", "plane") => fields.operator::<SliceParams>("cut plane")?,
            (_, other) => return Err(self.unknown(verb.value.span(), other, "as something to cut", &CUTS)),
        })
    }
}

/// The keys and values of one step.
struct StepFields<'a> {
    source: &'a Source<'a>,
    verb: &'a Entry<'a>,
    entries: &'a [Entry<'a>],
    span: Range<usize>,
}

impl StepFields<'_> {
    fn read1<T: Args + DeserializeOwned>(&self) -> Result<T, RecipeError> {
        self.check_keys(&field_names::<T>())?;
        self.read::<T>()
    }

    fn operator<T: Args + DeserializeOwned + Operate + 'static>(
        &self,
        verb: &'static str,
    ) -> Result<Step, RecipeError> {
        Ok(Step::Operator(OperatorStep { verb, params: Arc::new(self.read1::<T>()?) }))
    }

    fn unfold(&self) -> Result<Step, RecipeError> {
        let known = [
            field_names::<UnfoldParams>(),
            field_names::<FabricateParams>(),
            field_names::<SheetParams>(),
            field_names::<ShowParams>(),
        ]
        .concat();
        self.check_keys(&known)?;
        Ok(Step::Unfold { unfold: self.read()?, fabricate: self.read()?, sheet: self.read()?, show: self.read()? })
    }

    fn dform(&self) -> Result<Step, RecipeError> {
        self.check_keys(
            &[field_names::<DformParams>(), field_names::<SheetParams>(), field_names::<ShowParams>()].concat(),
        )?;
        Ok(Step::Dform { dform: self.read()?, sheet: self.read()?, show: self.read()? })
    }

    fn panels(&self) -> Result<Step, RecipeError> {
        let known = [field_names::<PanelParams>(), field_names::<PanelFiles>(), field_names::<SheetParams>()].concat();
        self.check_keys(&known)?;
        Ok(Step::Panels { panels: self.read()?, files: self.read()?, sheet: self.read()? })
    }

    fn nest(&self) -> Result<Step, RecipeError> {
        self.check_keys(&[field_names::<NestStep>(), field_names::<SheetParams>()].concat())?;
        Ok(Step::Nest { nest: self.read()?, sheet: self.read()? })
    }

    fn check_keys(&self, known: &[String]) -> Result<(), RecipeError> {
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let field_of_verb = self.field_of_verb();
        let is_known = |e: &&Entry<'_>| e.key == self.verb.key || (known.contains(&e.key) && e.key != field_of_verb);
        match self.entries.iter().find(|e| !is_known(e)) {
            None => Ok(()),
            Some(e) => {
                let others: Vec<&str> = known.iter().copied().filter(|k| *k != field_of_verb).collect();
                let place = format!("in a step with `{}`", self.verb.key);
                Err(self.source.unknown(e.key_span.clone(), e.key, &place, &others))
            }
        }
    }

    fn field_of_verb(&self) -> &'static str {
        VERBS.iter().find(|v| v.0 == self.verb.key).map_or("", |v| v.1)
    }

    fn value_text<'t>(&'t self, entry: &Entry<'_>, span: &Range<usize>) -> &'t str {
        let text = &self.source.text[span.clone()];
        let word = HULLS.iter().find(|(word, _)| entry.key == "hull" && *word == text);
        word.map_or(text, |(_, switch)| switch)
    }

    /// Reads one parameter struct from those entries that are its fields. Each value is read from its own text, so that an
    /// error inside it can be placed.
    fn read<T: Args + DeserializeOwned>(&self) -> Result<T, RecipeError> {
        let names = field_names::<T>();
        let mut document = String::new();
        let mut places: Vec<(Range<usize>, usize)> = Vec::new();
        for entry in self.entries {
            let field = if entry.key == self.verb.key { self.field_of_verb() } else { entry.key };
            if !names.iter().any(|n| n == field) {
                continue;
            }
            let span = entry.value.span();
            let start = document.len();
            document += &format!("{field} = {}\n", self.value_text(entry, &span));
            places.push((start..document.len(), span.start));
        }
        let deserializer = toml::Deserializer::parse(&document).map_err(|e| self.source.syntax(&e))?;
        T::deserialize(deserializer).map_err(|e| {
            // What is wrong with the step as a whole, such as a missing field, spans all of its text or none of it.
            let in_value = e.span().filter(|s| !s.is_empty() && s.len() < document.trim_end().len());
            let place = in_value.and_then(|s| places.iter().find(|(range, _)| range.contains(&s.start)));
            let offset = place.map_or(self.span.start, |p| p.1);
            self.source.bad(offset..offset, e.message())
        })
    }
}

/// `hull` takes a word for what is a switch on the command line.
const HULLS: [(&str, &str); 2] = [("\"convex\"", "false"), ("\"dual\"", "true")];

/// The names of a parameter struct's fields, as its command-line definition has them.
fn field_names<T: Args>() -> Vec<String> {
    let command = T::augment_args(Command::new("step"));
    command.get_arguments().map(|a| a.get_id().to_string()).collect()
}
