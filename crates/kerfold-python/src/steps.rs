//! Which steps there are, as plain data; how one is typed in a shell.

use kerfold::code::Code;
use kerfold::explain::pages;
use kerfold::recipe::{self, KeySchema, StepGroup, StepKind, StepSchema, ValueKind};
use kerfold::units::nearest_word;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::trouble::fault;
use crate::values::{Fields, fields};

/// The kind of step of a verb, and of what it cuts.
pub(crate) fn kind_of(verb: &str, kind: Option<&str>) -> PyResult<&'static StepKind> {
    let found = recipe::steps().iter().find(|step| step.verb == verb && step.kind == kind);
    found.ok_or_else(|| fault(&format!("there is no step `{verb}`")))
}

/// All kinds of steps with their keys, each a dictionary.
#[pyfunction]
pub(crate) fn steps(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    recipe::schema().iter().map(|step| of_step(py, step)).collect()
}

fn of_step<'py>(py: Python<'py>, step: &StepSchema) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    let group = match step.group {
        StepGroup::Begin => "begin",
        StepGroup::Shape => "shape",
        StepGroup::Look => "look",
        StepGroup::Make => "make",
    };
    told.set_item("verb", step.verb)?;
    told.set_item("kind", step.value)?;
    told.set_item("group", group)?;
    told.set_item("help", step.help)?;
    // The key that only says which kind of cut it is is no parameter.
    let keys = step.keys.iter().filter(|key| !(key.is_verb && step.value.is_some()));
    let keys = keys.map(|key| of_key(py, step, key)).collect::<PyResult<Vec<_>>>()?;
    told.set_item("keys", keys)?;
    Ok(told)
}

fn of_key<'py>(
    py: Python<'py>,
    step: &StepSchema,
    key: &KeySchema,
) -> PyResult<Bound<'py, PyDict>> {
    let kind = match key.kind {
        ValueKind::Number => "number",
        ValueKind::Integer => "integer",
        ValueKind::Length => "length",
        ValueKind::Angle => "angle",
        ValueKind::Switch => "switch",
        ValueKind::Choice => "choice",
        ValueKind::Selection => "selection",
        ValueKind::File => "file",
        ValueKind::Direction => "direction",
        ValueKind::Point => "point",
        ValueKind::Text => "text",
    };
    // Where words of a recipe stand for a switch, the parameter is called as the verb is.
    let of_verb = recipe::steps().iter().find(|kind| kind.verb == step.verb && key.is_verb);
    let name = match of_verb {
        Some(kind) if kind.words.is_empty() || key.kind != ValueKind::Choice => step.field,
        _ => key.key.as_str(),
    };
    // A recipe must have the key of a verb, a function may leave its parameter out.
    let must = |kind: &StepKind| {
        let command = kind.command();
        command.get_arguments().any(|arg| arg.get_id().as_str() == name && arg.is_required_set())
    };
    let told = PyDict::new(py);
    told.set_item("key", name)?;
    told.set_item("help", &key.help)?;
    told.set_item("kind", kind)?;
    told.set_item("value_name", &key.value_name)?;
    told.set_item("required", of_verb.map_or(key.is_required, must))?;
    told.set_item("list", key.is_list)?;
    told.set_item("default", key.default.as_deref())?;
    told.set_item("range", key.range)?;
    told.set_item("first", key.is_verb)?;
    let words = key.choices.iter().map(|choice| (choice.word.as_str(), choice.help.as_str()));
    told.set_item("choices", words.collect::<Vec<_>>())?;
    Ok(told)
}

/// The names of ready-made solids.
#[pyfunction]
pub(crate) fn solid_names() -> Vec<String> {
    kerfold::shape::solid_names().map(str::to_owned).collect()
}

/// The known word nearest to a mistyped one, or None when none is near.
#[pyfunction]
pub(crate) fn nearest(typed: &str, known: Vec<String>) -> Option<String> {
    nearest_word(typed, known.iter().map(String::as_str)).map(str::to_owned)
}

/// The command line that does what a step does.
#[pyfunction]
#[pyo3(signature = (verb, kind, given, input, output))]
pub(crate) fn shell_line(
    verb: &str,
    kind: Option<&str>,
    given: Fields<'_>,
    input: Option<&str>,
    output: Option<&str>,
) -> PyResult<String> {
    Ok(recipe::shell_line(kind_of(verb, kind)?, &fields(&given)?, input, output))
}

/// Words as they are typed in a shell, in quotes where it would need them.
#[pyfunction]
pub(crate) fn shell_text(words: Vec<String>) -> String {
    recipe::shell_text(&words)
}

/// What a code means and what to do about it: its title and its two sentences; None for a code that
/// nothing has.
#[pyfunction]
pub(crate) fn explain(code: &str) -> Option<(String, String)> {
    let code = Code::read(code)?;
    let page = pages().into_iter().find(|page| page.code == code)?;
    Some((page.title.to_owned(), page.text.to_owned()))
}
