//! What the steps take, as data: enough for a program to make forms of its own, so that a new
//! operator shows up in them without more work. Read off the parameter structs' command-line
//! definitions, as the reference is.

use std::any::TypeId;
use std::path::PathBuf;

use clap::Arg;
use serde::Serialize;

use super::keys::{StepKind, steps};
use crate::select::Selection;
use crate::units::{Angle, Direction, Length, Point};

/// What a step is for; forms are listed by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StepGroup {
    /// Makes or reads the first mesh.
    Begin,
    /// Changes the mesh.
    Shape,
    /// Judges or shows it.
    Look,
    /// Makes pieces, plates and sheets.
    Make,
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ValueKind {
    /// A number.
    Number,
    /// A whole number.
    Integer,
    /// A length; a bare number is in millimetres.
    Length,
    /// An angle; a bare number is in degrees.
    Angle,
    /// `true` or `false`.
    Switch,
    /// One of [`KeySchema::choices`].
    Choice,
    /// A text in the selection language.
    Selection,
    /// The name of a file in the recipe's folder.
    File,
    /// `x`, `-z` or three numbers.
    Direction,
    /// Three lengths.
    Point,
    /// Another text; [`KeySchema::value_name`] says which.
    Text,
}

/// A word that a key may have as its value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ChoiceSchema {
    /// The word.
    pub word: String,
    /// What it means; may be empty.
    pub help: String,
}

/// A key of a step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeySchema {
    /// The key.
    pub key: String,
    /// What it means.
    pub help: String,
    /// What its value is.
    pub kind: ValueKind,
    /// What stands for the value in help texts, e.g. `SELECTION|FILE`.
    pub value_name: String,
    /// Whether the step cannot do without.
    pub is_required: bool,
    /// Whether the value is a list.
    pub is_list: bool,
    /// What counts where the key is left out, as it is typed; `None` where that is nothing.
    pub default: Option<String>,
    /// The words that it may be; with [`ValueKind::Choice`] only these.
    pub choices: Vec<ChoiceSchema>,
    /// The least and the largest number that its help promises.
    pub range: Option<[f64; 2]>,
    /// Whether it is the key that says what the step does.
    pub is_verb: bool,
}

/// A kind of step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepSchema {
    /// The key that says what the step does.
    pub verb: &'static str,
    /// What that key must be, where the verb has several kinds of step.
    pub value: Option<&'static str>,
    /// What the step is for.
    pub group: StepGroup,
    /// What it does, in a line.
    pub help: &'static str,
    /// The parameter that the value of the verb's key goes to; empty where the verb has kinds.
    pub field: &'static str,
    /// Its keys, that of the verb first.
    pub keys: Vec<KeySchema>,
}

/// All kinds of steps with all that they take.
pub fn schema() -> Vec<StepSchema> {
    steps().iter().map(of_step).collect()
}

fn of_step(step: &StepKind) -> StepSchema {
    let command = step.command();
    let (mut first, mut others) = (Vec::new(), Vec::new());
    if let Some(kind) = step.kind {
        first.push(fixed_key(step.verb, kind));
    }
    for arg in command.get_arguments() {
        if step.kind.is_none() && arg.get_id().as_str() == step.field {
            first.push(verb_key(step, arg));
        } else {
            others.push(key(arg));
        }
    }
    first.append(&mut others);
    StepSchema {
        verb: step.verb,
        value: step.kind,
        group: group(step.verb),
        help: step.help,
        field: step.field,
        keys: first,
    }
}

fn group(verb: &str) -> StepGroup {
    match verb {
        "solid" | "read" | "height" | "planes" => StepGroup::Begin,
        "check" | "render" => StepGroup::Look,
        "unfold" | "dform" | "panels" | "nest" => StepGroup::Make,
        _ => StepGroup::Shape,
    }
}

/// `cut = "edge"`.
fn fixed_key(verb: &str, kind: &str) -> KeySchema {
    KeySchema {
        key: verb.to_owned(),
        help: String::new(),
        kind: ValueKind::Choice,
        value_name: String::new(),
        is_required: true,
        is_list: false,
        default: None,
        choices: vec![ChoiceSchema { word: kind.to_owned(), help: String::new() }],
        range: None,
        is_verb: true,
    }
}

fn verb_key(step: &StepKind, arg: &Arg) -> KeySchema {
    let mut key =
        KeySchema { key: step.verb.to_owned(), is_verb: true, is_required: true, ..key(arg) };
    if !step.words.is_empty() {
        let choice = |(word, _): &(&str, &str)| ChoiceSchema {
            word: word.trim_matches('"').to_owned(),
            help: String::new(),
        };
        key.choices.extend(step.words.iter().map(choice));
        // A switch of the command line is one of the words; another value may be one of them.
        if key.kind == ValueKind::Switch {
            key.kind = ValueKind::Choice;
            key.default = key.choices.first().map(|choice| choice.word.clone());
        }
    }
    key
}

fn key(arg: &Arg) -> KeySchema {
    let help = arg.get_long_help().or_else(|| arg.get_help());
    let help = one_line(&help.map(ToString::to_string).unwrap_or_default());
    let choices: Vec<ChoiceSchema> = arg
        .get_possible_values()
        .iter()
        .filter(|value| !value.is_hide_set() && arg.get_action().takes_values())
        .map(|value| ChoiceSchema {
            word: value.get_name().to_owned(),
            help: one_line(&value.get_help().map(ToString::to_string).unwrap_or_default()),
        })
        .collect();
    let kind = kind(arg, &choices);
    let is_numeric = matches!(kind, ValueKind::Number | ValueKind::Integer | ValueKind::Angle);
    let names = arg.get_value_names().unwrap_or_default();
    let defaults: Vec<String> =
        arg.get_default_values().iter().map(|v| v.to_string_lossy().into_owned()).collect();
    KeySchema {
        key: arg.get_id().to_string(),
        range: is_numeric.then(|| range(&help)).flatten(),
        kind,
        value_name: names.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),
        is_required: arg.is_required_set(),
        is_list: arg.get_value_delimiter().is_some()
            || arg.get_num_args().is_some_and(|n| n.max_values() > 1),
        default: (kind != ValueKind::Switch && defaults.iter().any(|d| !d.is_empty()))
            .then(|| defaults.join(",")),
        choices,
        is_verb: false,
        help,
    }
}

fn kind(arg: &Arg, choices: &[ChoiceSchema]) -> ValueKind {
    if !arg.get_action().takes_values() {
        return ValueKind::Switch;
    }
    let types = [
        (TypeId::of::<f64>(), ValueKind::Number),
        (TypeId::of::<u32>(), ValueKind::Integer),
        (TypeId::of::<u64>(), ValueKind::Integer),
        (TypeId::of::<usize>(), ValueKind::Integer),
        (TypeId::of::<Length>(), ValueKind::Length),
        (TypeId::of::<Angle>(), ValueKind::Angle),
        (TypeId::of::<Selection>(), ValueKind::Selection),
        (TypeId::of::<PathBuf>(), ValueKind::File),
        (TypeId::of::<Direction>(), ValueKind::Direction),
        (TypeId::of::<Point>(), ValueKind::Point),
    ];
    let parsed = arg.get_value_parser().type_id();
    match types.iter().find(|(of, _)| parsed == *of) {
        Some((_, kind)) => *kind,
        None if !choices.is_empty() => ValueKind::Choice,
        None => ValueKind::Text,
    }
}

/// The range that a help text promises: `1 to 64`, `In (0, 2]`, `from -1 to 1`.
fn range(help: &str) -> Option<[f64; 2]> {
    let number = |word: &str| {
        let digits = word.trim_matches(|c: char| !(c.is_ascii_digit() || c == '-' || c == '.'));
        digits.trim_end_matches('.').parse::<f64>().ok()
    };
    let words: Vec<&str> = help.split_whitespace().collect();
    let interval = words.windows(2).find_map(|pair| {
        let opens = pair[0].starts_with(['(', '[']) && pair[0].ends_with(',');
        let closes = pair[1].trim_end_matches(['.', ',', ';']).ends_with([')', ']']);
        (opens && closes).then(|| Some([number(pair[0])?, number(pair[1])?])).flatten()
    });
    let span = || {
        words.windows(3).find_map(|three| {
            (three[1] == "to").then(|| Some([number(three[0])?, number(three[2])?])).flatten()
        })
    };
    interval.or_else(span).filter(|[low, high]| low < high)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(verb: &str, value: Option<&str>) -> StepSchema {
        schema().into_iter().find(|s| s.verb == verb && s.value == value).expect("a step")
    }

    #[test]
    fn the_keys_of_an_edge_cut_have_kinds_ranges_and_defaults() {
        let cut = step("cut", Some("edge"));
        assert_eq!(cut.group, StepGroup::Shape);
        let key = |name: &str| cut.keys.iter().find(|k| k.key == name).expect("a key").clone();
        assert!(key("cut").is_verb && cut.keys[0].key == "cut");
        assert_eq!((key("select").kind, key("select").is_required), (ValueKind::Selection, true));
        let offset = key("offset");
        assert_eq!((offset.kind, offset.range), (ValueKind::Number, Some([0.0, 2.0])));
        assert_eq!(key("bend").range, Some([-1.0, 1.0]));
        assert_eq!(
            (key("repeat").kind, key("repeat").range),
            (ValueKind::Integer, Some([1.0, 64.0]))
        );
        let scope = key("scope");
        assert_eq!(scope.kind, ValueKind::Choice);
        assert_eq!(scope.default.as_deref(), Some("global"));
        assert_eq!(scope.choices.len(), 2);
        assert!(scope.choices.iter().all(|c| !c.help.is_empty()));
    }

    #[test]
    fn verbs_values_come_first_and_words_are_choices() {
        let hull = step("hull", None);
        let words: Vec<&str> = hull.keys[0].choices.iter().map(|c| c.word.as_str()).collect();
        assert_eq!((hull.keys[0].key.as_str(), words), ("hull", vec!["convex", "dual"]));
        assert_eq!(hull.keys[0].kind, ValueKind::Choice);
        // A word among other values.
        let dform = step("dform", None);
        assert_eq!(dform.keys[0].kind, ValueKind::Text);
        assert_eq!(dform.keys[0].choices[0].word, "outlines");
        let solid = step("solid", None);
        assert_eq!((solid.keys[0].key.as_str(), solid.group), ("solid", StepGroup::Begin));
        let size = solid.keys.iter().find(|k| k.key == "size").expect("a size");
        assert_eq!(size.kind, ValueKind::Length);
        let unfold = step("unfold", None);
        assert!(unfold.keys.iter().any(|k| k.kind == ValueKind::Angle));
        assert!(unfold.keys.iter().any(|k| k.kind == ValueKind::File));
    }

    #[test]
    fn every_key_of_every_step_is_told_once_and_with_help() {
        for (step, kind) in schema().iter().zip(steps()) {
            let mut keys: Vec<&str> = step.keys.iter().map(|k| k.key.as_str()).collect();
            keys.sort_unstable();
            let many = keys.len();
            keys.dedup();
            assert_eq!(keys.len(), many, "{}", step.verb);
            assert_eq!(step.keys.iter().filter(|k| k.is_verb).count(), 1, "{}", step.verb);
            assert!(step.keys.iter().all(|k| k.is_verb || !k.help.is_empty()), "{}", step.verb);
            assert_eq!(many, kind.known_keys().all.len() + usize::from(kind.kind.is_some()));
        }
    }

    #[test]
    fn ranges_are_read_from_help() {
        for (help, expected) in [
            ("How many rounds, 1 to 64; every round", Some([1.0, 64.0])),
            ("In (0, 2], warned above 1.", Some([0.0, 2.0])),
            ("towards one of the faces, -1 to 1; 0 weighs", Some([-1.0, 1.0])),
            ("goes to the end", None),
            ("5 to 2", None),
        ] {
            assert_eq!(range(help), expected, "{help}");
        }
    }
}
