//! Directions and points as people type them: `x`, `-z`, `1,0,1`; `0,0,10mm`.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use super::{Length, UnitError, parse_number};

/// A direction, typed as `x`, `-z` or three numbers `1,0,1`; its length does not matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction(pub DVec3);

/// A point, typed as three lengths `0,0,10mm`; in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point(pub DVec3);

impl Direction {
    /// The axes by name.
    pub const AXES: [(&'static str, DVec3); 6] = [
        ("x", DVec3::X),
        ("y", DVec3::Y),
        ("z", DVec3::Z),
        ("-x", DVec3::NEG_X),
        ("-y", DVec3::NEG_Y),
        ("-z", DVec3::NEG_Z),
    ];

    /// The opposite direction.
    pub fn reversed(self) -> Self {
        Self(-self.0)
    }

    /// The unit vector; exact for an axis. Not finite for a direction of no length.
    pub fn unit(self) -> DVec3 {
        (self.0 / self.0.abs().max_element()).normalize()
    }
}

impl FromStr for Direction {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let name = text.trim();
        if let Some((_, axis)) = Self::AXES.iter().find(|(axis, _)| *axis == name) {
            return Ok(Self(*axis));
        }
        three(name, parse_number).map(Self).ok_or_else(|| UnitError {
            text: text.to_owned(),
            wanted: "a direction",
            example: "z, -x or 1,0,1",
        })
    }
}

impl FromStr for Point {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        three(text, |part| part.parse().map(Length::mm)).map(Self).ok_or_else(|| UnitError {
            text: text.to_owned(),
            wanted: "a point",
            example: "0,0,10 or 1cm,0,0",
        })
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match Self::AXES.iter().find(|(_, axis)| *axis == self.0) {
            Some((name, _)) => f.write_str(name),
            None => write!(f, "{},{},{}", self.0.x, self.0.y, self.0.z),
        }
    }
}

fn three(text: &str, number: impl Fn(&str) -> Result<f64, UnitError>) -> Option<DVec3> {
    let parts: Vec<f64> = text.split(',').map(|part| number(part).ok()).collect::<Option<_>>()?;
    <[f64; 3]>::try_from(parts).ok().map(DVec3::from_array)
}
