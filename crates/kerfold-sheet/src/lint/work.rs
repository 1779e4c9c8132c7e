//! How much is looked at before a drawing is refused: no file may keep a shop waiting.

use std::ops::ControlFlow;

use crate::code::codes;

/// Comparisons of two segments, or of a point with a segment, for all pages of a file.
const MOST_COMPARISONS: u64 = 40_000_000;

/// Pairs of lines that are kept since they come near one another.
const MOST_PAIRS: usize = 500_000;

/// A drawing that would take too long to judge.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LintError {
    /// Too many lines near one another.
    #[error(
        "too many lines lie on or across one another: more than {limit} {what}; judge a part of \
        the drawing, or delete what is drawn many times"
    )]
    TooDense {
        /// What there is too much of.
        what: &'static str,
        /// The most that are looked at.
        limit: u64,
    },
}

codes!(error LintError {
    TooDense = 812,
});

/// What has been looked at so far.
#[derive(Debug, Default)]
pub(super) struct Work {
    comparisons: u64,
    pairs: usize,
}

impl Work {
    /// Counts comparisons.
    pub fn compare(&mut self, count: usize) -> Result<(), LintError> {
        self.comparisons += count as u64;
        if self.comparisons > MOST_COMPARISONS {
            return Err(LintError::TooDense {
                what: "comparisons of segments are needed",
                limit: MOST_COMPARISONS,
            });
        }
        Ok(())
    }

    /// Counts a pair of lines that is kept.
    pub fn keep_pair(&mut self) -> Result<(), LintError> {
        self.pairs += 1;
        if self.pairs > MOST_PAIRS {
            return Err(LintError::TooDense {
                what: "pairs of lines come near one another",
                limit: MOST_PAIRS as u64,
            });
        }
        Ok(())
    }

    /// How many comparisons there were.
    #[cfg(test)]
    pub fn comparisons(&self) -> u64 {
        self.comparisons
    }
}

/// For searches that break off at an error.
pub(super) fn flow(result: Result<(), LintError>) -> ControlFlow<LintError> {
    match result {
        Ok(()) => ControlFlow::Continue(()),
        Err(error) => ControlFlow::Break(error),
    }
}

/// The error that a search broke off at, if it did.
pub(super) fn ended(end: ControlFlow<LintError>) -> Result<(), LintError> {
    match end {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(error) => Err(error),
    }
}
