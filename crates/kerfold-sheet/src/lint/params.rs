//! Limits: one definition for the library and the command line.

use serde::Deserialize;

use super::report::Check;
use crate::code::codes;
use crate::units::Length;

/// What a drawing is measured against.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct LintParams {
    /// Width and height of the sheet that must hold the drawing, as in 600x400; else the page of
    /// the file
    #[arg(long, value_name = "SIZE")]
    #[serde(default)]
    pub sheet: Option<SheetLimit>,
    /// Thickness of the material: holes narrower than 1.5 times it are findings, but
    /// for the slots of tabs; not judged without it
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub thickness: Option<Length>,
    /// Width of the cut: drawn holes come out wider by it, webs thinner; 0 or more, 0 unless given
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub kerf: Option<Length>,
    /// Least width of material between two cuts of one part; 0 or more, 1mm unless given
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub web: Option<Length>,
    /// Gaps in outlines up to this are holding tabs; none unless given
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub tabs: Option<Length>,
    /// How far apart ends may be and still meet, and how near lines count as one; more than 0
    #[arg(long, value_name = "LENGTH", default_value = "0.005mm")]
    #[serde(default = "default_gap")]
    pub gap: Length,
    /// Checks that are not made, by their names, as in text,order
    #[arg(long, value_name = "CHECKS", value_delimiter = ',')]
    #[serde(default)]
    pub skip: Vec<Check>,
}

/// Width and height, both positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetLimit {
    /// Along x, in mm.
    pub width: f64,
    /// Along y, in mm.
    pub height: f64,
}

/// Least web unless another is given, in mm.
const WEB: f64 = 1.0;

fn default_gap() -> Length {
    Length::from_mm(0.005)
}

impl Default for LintParams {
    fn default() -> Self {
        Self {
            sheet: None,
            thickness: None,
            kerf: None,
            web: None,
            tabs: None,
            gap: default_gap(),
            skip: Vec::new(),
        }
    }
}

/// A limit outside its range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} is {value} mm, but must be {wanted}")]
pub struct LimitError {
    /// Which one.
    pub name: &'static str,
    /// What it was.
    pub value: f64,
    /// What it may be.
    pub wanted: &'static str,
}

codes!(error struct LimitError = 811);

impl LintParams {
    /// The width of the cut in mm.
    pub(super) fn kerf(&self) -> f64 {
        self.kerf.map_or(0.0, Length::mm)
    }

    /// The least width of material in mm.
    pub(super) fn web(&self) -> f64 {
        self.web.map_or(WEB, Length::mm)
    }

    /// How far apart the ends of one contour may be in mm.
    pub(super) fn join(&self) -> f64 {
        self.tabs.map_or(0.0, Length::mm).max(self.gap.mm())
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// [`LimitError`] for the first that is out of its range.
    pub fn check(&self) -> Result<(), LimitError> {
        let optional = |name, length: Option<Length>| length.map(|l| (name, l));
        let thickness = optional("thickness", self.thickness);
        for (name, length) in thickness.into_iter().chain([("gap", self.gap)]) {
            if !(length.mm() > 0.0 && length.mm().is_finite()) {
                return Err(LimitError {
                    name,
                    value: length.mm(),
                    wanted: "more than 0 and finite",
                });
            }
        }
        let others =
            [optional("kerf", self.kerf), optional("web", self.web), optional("tabs", self.tabs)];
        for (name, length) in others.into_iter().flatten() {
            if !(length.mm() >= 0.0 && length.mm().is_finite()) {
                return Err(LimitError {
                    name,
                    value: length.mm(),
                    wanted: "0 or more and finite",
                });
            }
        }
        Ok(())
    }
}

impl std::str::FromStr for SheetLimit {
    type Err = crate::units::UnitError;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || crate::units::UnitError {
            text: text.to_owned(),
            wanted: "a sheet size",
            example: "600x400 or 24inx12in",
        };
        let (width, height) = text.split_once(['x', '×']).ok_or_else(wrong)?;
        let mm = |t: &str| {
            t.parse::<Length>().map(Length::mm).ok().filter(|&mm| mm > 0.0).ok_or_else(wrong)
        };
        Ok(Self { width: mm(width)?, height: mm(height)? })
    }
}

impl<'de> Deserialize<'de> for SheetLimit {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}
