//! What was found, as data.

use std::collections::BTreeMap;

use glam::DVec2;
use serde::Deserialize;

use crate::code::codes;
use crate::units::nearest_word;

/// What is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Check {
    /// A cut that does not come back to its beginning.
    OpenContour,
    /// A line that lies on another from end to end.
    Duplicate,
    /// Lines that run along one another for a stretch.
    Overlap,
    /// Live text.
    Text,
    /// A unit that is not said, or a file that contradicts itself, or a size that cannot be meant.
    Units,
    /// Lines off the sheet.
    OffSheet,
    /// A hole narrower than 1.5 times the thickness.
    SmallHole,
    /// Too little material between two cuts.
    ThinWeb,
    /// An operation or a contour that comes too early.
    Order,
    /// A point or a line without length.
    StrayPoint,
    /// A line that crosses itself.
    SelfCrossing,
    /// Two lines that cross.
    Crossing,
    /// Lines at a slope, whose lengths are not true.
    NotFlat,
}

codes!(finding Check {
    OpenContour = 201,
    Duplicate = 202,
    Overlap = 203,
    Text = 204,
    Units = 205,
    OffSheet = 206,
    SmallHole = 207,
    ThinWeb = 208,
    Order = 209,
    StrayPoint = 210,
    SelfCrossing = 211,
    Crossing = 212,
    NotFlat = 213,
});

impl Check {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::OpenContour,
        Self::Duplicate,
        Self::Overlap,
        Self::Text,
        Self::Units,
        Self::OffSheet,
        Self::SmallHole,
        Self::ThinWeb,
        Self::Order,
        Self::StrayPoint,
        Self::SelfCrossing,
        Self::Crossing,
        Self::NotFlat,
    ];

    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::OpenContour => "open-contour",
            Self::Duplicate => "duplicate",
            Self::Overlap => "overlap",
            Self::Text => "text",
            Self::Units => "units",
            Self::OffSheet => "off-sheet",
            Self::SmallHole => "small-hole",
            Self::ThinWeb => "thin-web",
            Self::Order => "order",
            Self::StrayPoint => "stray-point",
            Self::SelfCrossing => "self-crossing",
            Self::Crossing => "crossing",
            Self::NotFlat => "not-flat",
        }
    }

    /// What to do about it.
    pub const fn advice(self) -> &'static str {
        match self {
            Self::OpenContour => {
                "join its ends; if it is a fold or lettering, put it on a layer named score or \
                engrave"
            }
            Self::Duplicate => "delete one of the two, or the machine cuts twice",
            Self::Overlap => "keep the common stretch in one of them only",
            Self::Text => "turn text into single lines (stroke font) or paths",
            Self::Units => {
                "save with millimetres: SVG width=\"..mm\" with a viewBox, DXF $INSUNITS 4"
            }
            Self::OffSheet => "move it onto the sheet, or take a larger one",
            Self::SmallHole => "widen the hole, or take thinner material",
            Self::ThinWeb => "move the cuts apart, or it burns or breaks",
            Self::Order => {
                "order layers engrave, score, inner cuts, outer cuts, and what lies inside first"
            }
            Self::StrayPoint => "delete it",
            Self::SelfCrossing => "draw it without the crossing; a crossed contour bounds no part",
            Self::Crossing => "move one of them, or cut it where it crosses",
            Self::NotFlat => "lay the part flat in the drawing program, all at one height",
        }
    }
}

/// A word that names no check.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{name}` is no check{}; the checks are {}", nearest(.name), names().join(", "))]
pub struct UnknownCheck {
    /// The word.
    pub name: String,
}

codes!(error struct UnknownCheck = 813);

fn names() -> [&'static str; 13] {
    Check::ALL.map(Check::name)
}

fn nearest(name: &str) -> String {
    nearest_word(name, names()).map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

impl std::str::FromStr for Check {
    type Err = UnknownCheck;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let name = text.trim().to_ascii_lowercase();
        let found = Self::ALL.into_iter().find(|check| check.name() == name);
        found.ok_or(UnknownCheck { name })
    }
}

impl<'de> Deserialize<'de> for Check {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// One thing that a shop would send back.
#[derive(Debug, Clone, PartialEq)]
pub struct LintFinding {
    /// What it is.
    pub check: Check,
    /// Where, in mm from the lower left corner, where it has a place.
    pub at: Option<DVec2>,
    /// Which line, by name or layer and number; empty for the file as a whole.
    pub element: String,
    /// What was measured, in mm, where something was.
    pub measured: Option<f64>,
    /// The limit for it.
    pub limit: Option<f64>,
    /// In a few words.
    pub words: String,
}

/// All findings of one page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LintReport {
    /// In the order of the checks.
    pub findings: Vec<LintFinding>,
    /// Checks that were not made since nobody wanted them.
    pub skipped: Vec<Check>,
}

impl LintReport {
    pub(super) fn new(skipped: &[Check]) -> Self {
        Self { findings: Vec::new(), skipped: skipped.to_vec() }
    }

    /// Whether the drawing can be sent off.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty()
    }

    /// How many findings of each check there are.
    pub fn counts(&self) -> BTreeMap<Check, usize> {
        let mut counts = BTreeMap::new();
        self.findings.iter().for_each(|f| *counts.entry(f.check).or_default() += 1);
        counts
    }

    /// The findings, but of each check no more than the given number.
    pub fn at_most(&self, most: usize) -> impl Iterator<Item = &LintFinding> {
        let mut counts: BTreeMap<Check, usize> = BTreeMap::new();
        self.findings.iter().filter(move |finding| {
            let count = counts.entry(finding.check).or_default();
            *count += 1;
            *count <= most
        })
    }

    /// Whether one of these checks is to be made.
    pub(super) fn wants_any(&self, checks: &[Check]) -> bool {
        checks.iter().any(|check| !self.skipped.contains(check))
    }

    pub(super) fn add(&mut self, check: Check, at: Option<DVec2>, element: &str, words: String) {
        self.measured(check, at, element, words, None);
    }

    /// With a pair of what was measured and what it is compared with.
    pub(super) fn measured(
        &mut self,
        check: Check,
        at: Option<DVec2>,
        element: &str,
        words: String,
        numbers: Option<(f64, f64)>,
    ) {
        if !self.wants_any(&[check]) {
            return;
        }
        let (measured, limit) = numbers.unzip();
        let element = element.to_owned();
        self.findings.push(LintFinding { check, at, element, measured, limit, words });
    }
}
