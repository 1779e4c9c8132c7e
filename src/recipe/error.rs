//! What is wrong with a recipe, with line and column.

use std::fmt;

use crate::code::{Code, Coded, codes};
use crate::make::MakeError;

/// A place in a recipe file, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Why a recipe could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RecipeError {
    /// Not TOML.
    #[error("{at}: {message}")]
    Syntax {
        /// Where.
        at: Position,
        /// What the TOML reader says.
        message: String,
    },
    /// A key that nobody knows.
    #[error("{at}: `{key}` is not known {place}; {advice}")]
    UnknownKey {
        /// Where.
        at: Position,
        /// The key.
        key: String,
        /// In what.
        place: String,
        /// The nearest known key, or all of them.
        advice: String,
    },
    /// A step that does not say what to do.
    #[error("{at}: this step does not say what to do; it needs one of the keys {verbs}")]
    NoVerb {
        /// Where the step begins.
        at: Position,
        /// The known verbs.
        verbs: String,
    },
    /// A step that says two things.
    #[error("{at}: this step says both `{first}` and `{second}`; make two steps of it")]
    TwoVerbs {
        /// Where the second verb stands.
        at: Position,
        /// The first verb.
        first: String,
        /// The second verb.
        second: String,
    },
    /// A value that does not fit.
    #[error("{at}: {message}")]
    BadValue {
        /// Where.
        at: Position,
        /// What is wrong with it.
        message: String,
    },
    /// A value for a parameter that the recipe does not have.
    #[error("{message}")]
    NoSuchParameter {
        /// Which one, and what there is instead.
        message: String,
    },
    /// No step at all.
    #[error(
        "the recipe has no [[step]]; the first one names a solid or reads a file, e.g. solid = \
        \"dodecahedron\""
    )]
    NoSteps,
}

impl RecipeError {
    /// Where the fault is; `None` when the recipe as a whole is meant.
    pub fn at(&self) -> Option<Position> {
        match self {
            Self::Syntax { at, .. }
            | Self::UnknownKey { at, .. }
            | Self::NoVerb { at, .. }
            | Self::TwoVerbs { at, .. }
            | Self::BadValue { at, .. } => Some(*at),
            Self::NoSteps | Self::NoSuchParameter { .. } => None,
        }
    }

    /// The message without the place, for who knows the place already.
    pub fn without_place(&self) -> String {
        let text = self.to_string();
        let place = self.at().map(|at| format!("{at}: ")).unwrap_or_default();
        text.strip_prefix(&place).map_or(text.clone(), str::to_owned)
    }

    /// What to do about it in a few words, where there are some.
    pub fn advice(&self) -> Option<&str> {
        match self {
            Self::UnknownKey { advice, .. } => Some(advice),
            Self::TwoVerbs { .. } => Some("make two steps of it"),
            _ => None,
        }
    }
}

codes!(error RecipeError {
    Syntax = 701,
    UnknownKey = 702,
    NoVerb = 703,
    TwoVerbs = 704,
    BadValue = 705,
    NoSteps = 706,
    NoSuchParameter = 707,
});

/// Why a recipe could not be carried out. The step is counted from 1.
#[derive(Debug, thiserror::Error)]
#[error("step {step} ({verb}): {cause}")]
pub struct StepError {
    /// Which step.
    pub step: usize,
    /// What it does.
    pub verb: &'static str,
    /// Why it failed.
    pub cause: Box<MakeError>,
}

impl Coded for StepError {
    fn code(&self) -> Code {
        self.cause.code()
    }
}
