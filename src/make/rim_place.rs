//! A place on a rim as it is typed: a part of the whole, or a length.

use std::str::FromStr;

use serde::{Deserialize, Deserializer};

use super::outlines_error::OutlinesError;
use crate::units::{Length, parse_number};

/// A place on a rim: a part of the whole, or a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RimPlace {
    /// A part of the rim, -1 to 1.
    Part(f64),
    /// A length from the first point.
    Length(Length),
}

impl RimPlace {
    /// In mm on a rim of that length.
    pub fn mm(self, whole: f64) -> f64 {
        match self {
            Self::Part(part) => part * whole,
            Self::Length(length) => length.mm(),
        }
    }
}

impl FromStr for RimPlace {
    type Err = OutlinesError;

    fn from_str(text: &str) -> Result<Self, OutlinesError> {
        let wrong = || OutlinesError::Place { text: text.to_owned() };
        match parse_number(text) {
            Ok(part) if part.abs() <= 1.0 => Ok(Self::Part(part)),
            Ok(_) => Err(wrong()),
            Err(_) => text.parse().map(Self::Length).map_err(|_| wrong()),
        }
    }
}

impl<'de> Deserialize<'de> for RimPlace {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a part of the rim like 0.25, or a length like \"40mm\"")]
        enum Written {
            Number(f64),
            Text(String),
        }
        let text = match Written::deserialize(deserializer)? {
            Written::Number(number) => number.to_string(),
            Written::Text(text) => text,
        };
        text.parse().map_err(serde::de::Error::custom)
    }
}
