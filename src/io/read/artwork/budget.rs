//! What a drawing may cost, one budget for all formats: however small or packed a file is, reading
//! it ends in bounded time and memory.

use std::cell::Cell;

use super::ArtError;

/// What can run out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    /// Uses of elements, blocks, forms and page nodes.
    Instances,
    /// Lines and texts.
    Lines,
    /// Points that curves are flattened to, and operators of paths.
    Points,
    /// Points of all lines.
    Kept,
    /// Bytes once they are unpacked.
    Bytes,
    /// Values that are kept: XML nodes, group codes, PDF objects.
    Values,
    /// Characters read and terms worked out.
    Steps,
    /// Pages.
    Pages,
}

/// Limits with their names, in the order of [`Cost`].
const LIMITS: [(usize, &str); 8] = [
    (250_000, "uses of elements, blocks or forms"),
    (500_000, "lines and texts"),
    (2_000_000, "points of curves and paths"),
    (2_000_000, "points"),
    (96 << 20, "bytes once it is unpacked"),
    (4_000_000, "values"),
    (150_000_000, "steps of reading"),
    (1000, "pages"),
];

/// What has been spent.
#[derive(Debug, Default)]
pub(super) struct Budget {
    spent: [Cell<usize>; LIMITS.len()],
    /// How far a flattened curve may be from the true one where that is not [`super::FLATNESS`].
    pub flatness: Option<f64>,
}

impl Budget {
    /// A whole budget, with curves flattened to within that, in mm.
    pub fn within(flatness: f64) -> Self {
        Self { flatness: Some(flatness), ..Self::default() }
    }

    /// Spends so much, if there is so much left.
    pub fn spend(&self, cost: Cost, count: usize) -> Result<(), ArtError> {
        self.expect(cost, count)?;
        let spent = &self.spent[cost as usize];
        spent.set(spent.get() + count);
        Ok(())
    }

    /// Whether so much is left.
    pub fn expect(&self, cost: Cost, count: usize) -> Result<(), ArtError> {
        let (limit, what) = LIMITS[cost as usize];
        if count <= self.left(cost) { Ok(()) } else { Err(ArtError::TooMuch { what, limit }) }
    }

    /// How much is left.
    pub fn left(&self, cost: Cost) -> usize {
        LIMITS[cost as usize].0 - self.spent[cost as usize].get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_may_be_spent_and_nothing_more() {
        let budget = Budget::default();
        assert!(budget.spend(Cost::Pages, 999).is_ok() && budget.spend(Cost::Pages, 1).is_ok());
        let error = budget.spend(Cost::Pages, 1).map_err(|e| e.to_string());
        assert!(error.is_err_and(|e| e.contains("1000 pages")));
        assert!(budget.spend(Cost::Lines, usize::MAX).is_err());
        assert_eq!(budget.left(Cost::Lines), 500_000);
    }
}
