//! How an edge is to be rolled, as people type it.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer};

use crate::code::codes;
use crate::units::{Angle, Length};

/// How round an edge becomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Roll {
    /// The largest radius that all chosen edges can have in common.
    Max,
    /// For each edge the largest radius that its neighbours leave it: all grow at the same rate,
    /// and those that meet a limit stop.
    Each,
    /// A cylinder of this radius, in mm.
    Radius(Length),
    /// A cone: the radius at the end with the lower vertex number, and at the other.
    Cone([Length; 2]),
}

/// A roll that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is no roll; write a radius like 40mm, one for each end like 40mm,20mm, max (the \
    largest that all edges can have), or each (the largest for each edge)"
)]
pub struct RollWordError {
    /// What was typed.
    pub text: String,
}

codes!(error struct RollWordError = 340);

impl FromStr for Roll {
    type Err = RollWordError;

    fn from_str(text: &str) -> Result<Self, RollWordError> {
        let length = |part: &str| {
            part.parse::<Length>().map_err(|_| RollWordError { text: text.to_owned() })
        };
        match (text.trim(), text.split_once(',')) {
            ("max", _) => Ok(Self::Max),
            ("each", _) => Ok(Self::Each),
            (_, Some((one, other))) => Ok(Self::Cone([length(one)?, length(other)?])),
            _ => Ok(Self::Radius(length(text)?)),
        }
    }
}

impl fmt::Display for Roll {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Max => f.write_str("max"),
            Self::Each => f.write_str("each"),
            Self::Radius(radius) => radius.fmt(f),
            Self::Cone([one, other]) => write!(f, "{one},{other}"),
        }
    }
}

impl<'de> Deserialize<'de> for Roll {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a radius like \"40mm\", two of them, \"max\" or \"each\"")]
        enum Written {
            Number(f64),
            Two([Length; 2]),
            Text(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(mm) => Ok(Self::Radius(Length::from_mm(mm))),
            Written::Two(both) => Ok(Self::Cone(both)),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
        }
    }
}

/// The largest strip that is wanted; as few strips as keep to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StripSize {
    /// At most so wide, in mm.
    Width(Length),
    /// At most so much turn between two strips.
    Angle(Angle),
}

/// A size of strips that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is no size of strips; write the largest width like 6mm, or the largest fold angle \
    like 10deg"
)]
pub struct StripWordError {
    /// What was typed.
    pub text: String,
}

codes!(error struct StripWordError = 341);

impl FromStr for StripSize {
    type Err = StripWordError;

    fn from_str(text: &str) -> Result<Self, StripWordError> {
        let width = text.parse().map(Self::Width);
        // A bare number would be read as either; it is a width, as lengths are elsewhere.
        width
            .or_else(|_| text.parse().map(Self::Angle))
            .map_err(|_| StripWordError { text: text.to_owned() })
    }
}

impl fmt::Display for StripSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Width(width) => width.fmt(f),
            Self::Angle(angle) => angle.fmt(f),
        }
    }
}

impl<'de> Deserialize<'de> for StripSize {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a width like \"6mm\" or an angle like \"10deg\"")]
        enum Written {
            Number(f64),
            Text(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(mm) => Ok(Self::Width(Length::from_mm(mm))),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
        }
    }
}

/// Whether and how to roll edges: one definition for `cut edge` and for D-forms.
#[derive(Debug, Clone, Copy, PartialEq, Default, clap::Args, Deserialize)]
pub struct RollOptions {
    /// Roll each edge into even strips that touch both faces, instead of cutting it by offset: a
    /// radius (40mm), one for each end (40mm,20mm), max for the largest that all can have, or each
    /// for the largest of every edge. Reaches only the edge itself, whatever the scope. D-forms are
    /// rolled unless they are cut: max, or the largest below it that keeps the pieces whole.
    #[arg(long, value_name = "RADIUS")]
    #[serde(default)]
    pub roll: Option<Roll>,
    /// How many strips a rolled edge gets, 1 to 1000; 9 unless given.
    #[arg(long, value_name = "N")]
    #[serde(default)]
    pub strips: Option<u32>,
    /// The largest strip of a rolled edge instead of their number: a width (6mm) or a fold angle
    /// (10deg).
    #[arg(long, value_name = "SIZE")]
    #[serde(default)]
    pub strip: Option<StripSize>,
}

impl RollOptions {
    /// Nine strips.
    pub fn new(roll: Roll) -> Self {
        Self { roll: Some(roll), ..Self::default() }
    }

    /// The first option that is given, by its name.
    pub fn given(&self) -> Option<&'static str> {
        let options = [
            ("roll", self.roll.is_some()),
            ("strips", self.strips.is_some()),
            ("strip", self.strip.is_some()),
        ];
        options.into_iter().find(|option| option.1).map(|option| option.0)
    }

    /// The same with a roll where none is given.
    pub fn or(self, roll: Roll) -> RollParams {
        let Self { strips, strip, .. } = self;
        RollParams { roll: self.roll.unwrap_or(roll), strips, strip }
    }
}

/// How edges are rolled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollParams {
    /// The radius.
    pub roll: Roll,
    /// Strips for each edge, 1 to 1000; 9 when neither this nor `strip` is given.
    pub strips: Option<u32>,
    /// The largest strip instead of their number.
    pub strip: Option<StripSize>,
}

impl RollParams {
    /// The usual number of strips.
    pub const STRIPS: u32 = 9;
    /// More strips only make each smaller than a line can be drawn.
    pub const MOST_STRIPS: u32 = 1000;
}
