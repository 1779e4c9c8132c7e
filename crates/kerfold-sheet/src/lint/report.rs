//! What was found, as data.

use crate::code::codes;
use glam::DVec2;

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
});

impl Check {
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
        }
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

/// All findings of one page, and what was not judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LintReport {
    /// In the order of the checks.
    pub findings: Vec<LintFinding>,
}

impl LintReport {
    /// Whether the drawing can be sent off.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty()
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
        let (measured, limit) = numbers.unzip();
        self.findings.push(LintFinding {
            check,
            at,
            element: element.to_owned(),
            measured,
            limit,
            words,
        });
    }
}
