//! Why a session refuses.

use super::{RecipeError, StepError};
use crate::code::codes;

/// Why a session did not do what it was asked for. Steps are counted from 1.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SessionError {
    /// There is no step of this number.
    #[error("there is no step {step}; the recipe has {steps}")]
    NoSuchStep {
        /// The number.
        step: usize,
        /// How many steps there are.
        steps: usize,
    },
    /// A step cannot be read; the recipe stays as it was.
    #[error("step {step}: {}", error.without_place())]
    Step {
        /// The number that the step has or would have.
        step: usize,
        /// The key that is at fault, where it is one.
        key: Option<String>,
        /// What is wrong with it.
        error: Box<RecipeError>,
    },
    /// A step failed.
    #[error(transparent)]
    Run(#[from] StepError),
    /// The step can be shown before it is done only if it changes a mesh.
    #[error(
        "a step with `{verb}` cannot be shown before it is done; put it to the recipe and undo it"
    )]
    NoPreview {
        /// What the step does.
        verb: &'static str,
    },
}

codes!(error SessionError {
    NoSuchStep = 761,
    NoPreview = 762,
} through {
    Step.error,
    Run.0,
});
