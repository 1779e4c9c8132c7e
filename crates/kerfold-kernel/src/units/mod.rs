//! Lengths, angles, directions and points as people type them (`3mm`, `1/8in`, `30deg`, `-z`) and
//! as files show them.

mod count;
mod nearest;
#[cfg(feature = "serde")]
mod serde;
mod space;

pub use count::counted;
pub use nearest::nearest_word;
pub use space::{Direction, Point};

use std::fmt;
use std::str::FromStr;

use crate::code::codes;

/// A length in millimetres. Typed as `3`, `3mm`, `0.5cm`, `1m`, `1/8in`, `2ft`, `0.2um`; without a
/// unit it is millimetres.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Length {
    mm: f64,
}

/// An angle. Typed as `30`, `30deg`, `0.5rad` or `1/12turn`; without a unit it is degrees.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Angle {
    degrees: f64,
}

/// A number or quantity that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is not {wanted}; write it like {example}")]
pub struct UnitError {
    /// What was typed.
    pub text: String,
    /// What it should have been.
    pub wanted: &'static str,
    /// An example to copy.
    pub example: &'static str,
}

codes!(error struct UnitError = 201);

impl Length {
    /// A length of `mm` millimetres.
    pub const fn from_mm(mm: f64) -> Self {
        Self { mm }
    }

    /// The length in millimetres.
    pub const fn mm(self) -> f64 {
        self.mm
    }
}

impl Angle {
    /// An angle of `degrees`.
    pub const fn from_degrees(degrees: f64) -> Self {
        Self { degrees }
    }

    /// The angle in degrees.
    pub const fn degrees(self) -> f64 {
        self.degrees
    }

    /// The angle in radians.
    pub fn radians(self) -> f64 {
        self.degrees.to_radians()
    }
}

/// Length units with their size in millimetres.
const LENGTH_UNITS: [(&str, f64); 9] = [
    ("mm", 1.0),
    ("cm", 10.0),
    ("dm", 100.0),
    ("m", 1000.0),
    ("um", 1e-3),
    ("µm", 1e-3),
    ("in", 25.4),
    ("\"", 25.4),
    ("ft", 304.8),
];

/// Angle units with their size in degrees.
const ANGLE_UNITS: [(&str, f64); 4] =
    [("deg", 1.0), ("°", 1.0), ("rad", 180.0 / std::f64::consts::PI), ("turn", 360.0)];

impl FromStr for Length {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        quantity(text, &LENGTH_UNITS).map(Self::from_mm).ok_or_else(|| UnitError {
            text: text.to_owned(),
            wanted: "a length",
            example: "3mm, 0.5cm or 1/8in",
        })
    }
}

impl FromStr for Angle {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        quantity(text, &ANGLE_UNITS).map(Self::from_degrees).ok_or_else(|| UnitError {
            text: text.to_owned(),
            wanted: "an angle",
            example: "30deg or 0.5rad",
        })
    }
}

/// Reads a finite number or fraction: `0.25`, `1/3`, `-2e-3`.
///
/// # Errors
/// [`UnitError`] when the text is anything else.
pub fn parse_number(text: &str) -> Result<f64, UnitError> {
    fraction(text.trim()).ok_or_else(|| UnitError {
        text: text.to_owned(),
        wanted: "a number",
        example: "0.25 or 1/3",
    })
}

fn quantity(text: &str, units: &[(&str, f64)]) -> Option<f64> {
    let text = text.trim();
    // The longest unit that fits wins, so that `3mm` is not 3m of metres.
    let unit =
        units.iter().filter(|(name, _)| text.ends_with(name)).max_by_key(|(name, _)| name.len());
    let (number, size) =
        unit.map_or((text, 1.0), |&(name, size)| (&text[..text.len() - name.len()], size));
    fraction(number.trim()).map(|n| n * size).filter(|n| n.is_finite())
}

fn fraction(text: &str) -> Option<f64> {
    let is_numeric = |t: &str| t.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    let number = |t: &str| {
        Some(t.trim()).filter(|t| is_numeric(t))?.parse::<f64>().ok().filter(|n| n.is_finite())
    };
    match text.split_once('/') {
        Some((above, below)) => Some(number(above)? / number(below).filter(|&d| d != 0.0)?),
        None => number(text),
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}mm", self.mm)
    }
}

impl fmt::Display for Angle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}deg", self.degrees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_with_their_units() {
        let mm = |text: &str| text.parse::<Length>().map(Length::mm);
        for (text, expected) in [
            ("3", 3.0),
            ("3mm", 3.0),
            (" 0.5 cm ", 5.0),
            ("1m", 1000.0),
            ("1/8in", 3.175),
            ("2ft", 609.6),
            ("-1e-3m", -1.0),
        ] {
            assert_eq!(mm(text), Ok(expected), "{text}");
        }
        for bad in ["", "mm", "3 apples", "1/0in", "nan", "inf", "1e999", "3mm5"] {
            assert!(mm(bad).is_err(), "{bad}");
        }
        let error = mm("3 apples").expect_err("no length");
        assert_eq!(
            error.to_string(),
            "`3 apples` is not a length; write it like 3mm, 0.5cm or 1/8in"
        );
    }

    #[test]
    fn angles_are_degrees_unless_said_otherwise() {
        let degrees = |text: &str| text.parse::<Angle>().map(Angle::degrees);
        assert_eq!(degrees("30"), Ok(30.0));
        assert_eq!(degrees("30°"), Ok(30.0));
        assert_eq!(degrees("1/4turn"), Ok(90.0));
        assert!((degrees("3.141592653589793rad").expect("an angle") - 180.0).abs() < 1e-12);
    }
}
