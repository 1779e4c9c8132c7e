//! Gathers the lines of a page with their colours.

use std::collections::BTreeMap;

use glam::DVec2;

use super::budget::{Budget, Cost};
use super::{ArtError, FARTHEST};
use crate::lint::{ArtPath, ArtText, Artwork, Colours, Operation, UnitState};

/// Letters of a name or text that are kept; more are of no use to anybody who looks for it.
const MOST_LETTERS: usize = 120;

/// Kinds of things that are counted apart; more count as one.
const MOST_KINDS: usize = 50;

/// See the module documentation.
pub(super) struct Collector<'a> {
    budget: &'a Budget,
    art: Artwork,
    colours: Colours,
    /// What is not judged, by kind, with how often it comes.
    unread: BTreeMap<String, usize>,
    /// Whether the file says that boxes.py made it.
    pub is_by_boxes: bool,
}

/// Where a line stands in its file.
pub(super) struct Place<'a> {
    pub layer: &'a str,
    pub name: Option<&'a str>,
    pub operation: Option<Operation>,
    pub colour: [u8; 3],
}

impl<'a> Collector<'a> {
    pub fn new(budget: &'a Budget) -> Self {
        Self {
            budget,
            art: Artwork::default(),
            colours: Colours::default(),
            unread: BTreeMap::new(),
            is_by_boxes: false,
        }
    }

    /// A line; `operation` as far as its layer says.
    pub fn path(
        &mut self,
        (points, closed): (Vec<DVec2>, bool),
        place: &Place<'_>,
    ) -> Result<(), ArtError> {
        if points.is_empty() {
            return Ok(());
        }
        self.budget.spend(Cost::Lines, 1)?;
        self.budget.spend(Cost::Kept, points.len())?;
        if !points.iter().all(|p| is_in_range(*p)) {
            let number = self.art.paths.len() + 1;
            let what = place.name.map_or_else(|| format!("line {number}"), shortened);
            return Err(ArtError::OutOfRange { what });
        }
        self.colours.paths.push(place.operation.is_none().then_some(place.colour));
        self.art.paths.push(ArtPath {
            points,
            closed,
            operation: place.operation.unwrap_or(Operation::Cut),
            layer: shortened(place.layer),
            name: place.name.map(shortened),
        });
        Ok(())
    }

    /// Live text.
    pub fn text(&mut self, text: &str, at: DVec2, place: &Place<'_>) -> Result<(), ArtError> {
        self.budget.spend(Cost::Lines, 1)?;
        if !is_in_range(at) {
            return Err(ArtError::OutOfRange { what: format!("text {:?}", shortened(text)) });
        }
        self.colours.texts.push(place.operation.is_none().then_some(place.colour));
        let operation = place.operation.unwrap_or(Operation::Engrave);
        self.art.texts.push(ArtText { text: shortened(text), at, operation });
        Ok(())
    }

    /// A line that does not lie flat was added last.
    pub fn not_flat(&mut self, at: DVec2) {
        let known = self.art.not_flat.map_or((0, at), |known| known);
        self.art.not_flat = Some((known.0 + 1, known.1));
    }

    /// Something that is not judged.
    pub fn unread(&mut self, kind: &str) {
        let kind = shortened(kind);
        let is_known = self.unread.contains_key(&kind) || self.unread.len() < MOST_KINDS;
        let kind = if is_known { kind } else { "other things".to_owned() };
        *self.unread.entry(kind).or_default() += 1;
    }

    /// What was assumed, or read in part.
    pub fn notes(&mut self, note: impl IntoIterator<Item = String>) {
        self.art.notes.extend(note);
    }

    pub fn finish(mut self, size: Option<DVec2>, unit: UnitState) -> Result<Artwork, ArtError> {
        if size.is_some_and(|s| !is_in_range(s)) {
            return Err(ArtError::OutOfRange { what: "the page".to_owned() });
        }
        self.art.size = size;
        self.art.unit = unit;
        self.art.unread = self.unread.into_iter().collect();
        self.colours.is_by_boxes = self.is_by_boxes;
        self.art.operations_by_colour(&self.colours);
        if self.art.paths.is_empty() {
            self.art.notes.push("there is no line on it".to_owned());
        }
        Ok(self.art)
    }
}

fn is_in_range(p: DVec2) -> bool {
    // Not a number is not in range.
    p.abs().cmple(DVec2::splat(FARTHEST)).all()
}

fn shortened(text: &str) -> String {
    text.chars().take(MOST_LETTERS).collect()
}
