//! What a material asks of cutter and drawing: thickness, kerf, least web, speeds, colours.

use serde::Deserialize;

use super::drawing::{Drawing, LayerKind};
use super::error::SheetError;
use super::files::Rgb;
use crate::units::Length;

/// A material on a machine. In files every length may have a unit; speeds are millimetres per
/// second.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// What it is, for people.
    pub title: String,
    /// How thick it is.
    pub thickness: Length,
    /// Kilograms in a cubic metre, where it is known.
    #[serde(default)]
    pub density: Option<f64>,
    /// Full width of the cut.
    pub kerf: Length,
    /// Least width of material that survives between two cuts.
    pub web: Length,
    /// How fast it is machined.
    pub speed: Speeds,
    /// Whether it breaks rather than folds along a scored line, as plywood, acrylic and glass do.
    #[serde(default)]
    pub rigid: bool,
    /// Colours that take the place of the preset's, as `#RRGGBB`.
    #[serde(default)]
    pub colours: MaterialColours,
}

/// Speeds in mm/s, all above 0.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Speeds {
    /// Along cuts.
    pub cut: f64,
    /// Along folds.
    pub score: f64,
    /// Along lettering.
    pub engrave: f64,
    /// Between lines.
    pub travel: f64,
}

/// Colours as text.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MaterialColours {
    /// Outlines.
    pub cut_outer: Option<Hex>,
    /// Holes, perforations and living hinges.
    pub cut_inner: Option<Hex>,
    /// Folds.
    pub score: Option<Hex>,
    /// Lettering.
    pub engrave: Option<Hex>,
}

/// A colour written `#RRGGBB`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hex(pub Rgb);

impl<'de> Deserialize<'de> for Hex {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii());
        let channel =
            |i: usize| digits.and_then(|d| u8::from_str_radix(&d[2 * i..2 * i + 2], 16).ok());
        match (channel(0), channel(1), channel(2)) {
            (Some(r), Some(g), Some(b)) => Ok(Self([r, g, b])),
            _ => Err(serde::de::Error::custom(format!(
                "`{text}` is no colour; write it like #FF0000"
            ))),
        }
    }
}

impl Speeds {
    /// The speed of an operation; nothing for what is never machined.
    pub const fn of(&self, layer: LayerKind) -> Option<f64> {
        match layer {
            LayerKind::Engrave => Some(self.engrave),
            LayerKind::Score => Some(self.score),
            LayerKind::CutInner | LayerKind::CutOuter => Some(self.cut),
            LayerKind::Info => None,
        }
    }

    /// Estimated seconds on the machine: all lines at their speeds, and the travel moves between
    /// them; without acceleration.
    pub fn seconds(&self, drawing: &Drawing) -> f64 {
        let layers = drawing.layers.iter().filter_map(|l| self.of(l.kind).map(|speed| (l, speed)));
        let lines: f64 = layers.map(|(l, speed)| l.length() / speed).sum();
        lines + drawing.travel_length() / self.travel
    }
}

impl Material {
    /// Checks all numbers.
    ///
    /// # Errors
    /// [`SheetError::OutOfRange`] for the first that is out of its range.
    pub fn check(&self) -> Result<(), SheetError> {
        let lengths =
            [("thickness", self.thickness, 0.01), ("kerf", self.kerf, 0.0), ("web", self.web, 0.0)];
        for (name, value, least) in lengths.map(|(n, v, l)| (n, v.mm(), l)) {
            if !(value >= least && value.is_finite()) {
                return Err(SheetError::OutOfRange { name, value, least });
            }
        }
        if let Some(value) = self.density.filter(|&d| !(d > 0.0 && d.is_finite())) {
            return Err(SheetError::OutOfRange { name: "density", value, least: 0.0 });
        }
        let Speeds { cut, score, engrave, travel } = self.speed;
        for (name, value) in
            [("cut", cut), ("score", score), ("engrave", engrave), ("travel", travel)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SheetError::BadSpeed { name, value });
            }
        }
        Ok(())
    }
}
