//! Where a height field lies: over a rectangle, or over the area of a drawing.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::DVec2;
use serde::{Deserialize, Deserializer, de};

use crate::units::Length;

/// Endings of files that hold an outline.
const ENDINGS: [&str; 5] = ["svg", "dxf", "pdf", "csv", "txt"];

/// The area below a height field, and the unit of its formula.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// A rectangle about the origin.
    Rectangle {
        /// Width and depth in mm.
        size_mm: [f64; 2],
        /// The unit of the formula, in mm: that of the width.
        unit_mm: f64,
    },
    /// A drawing, which has to be read first, or an outline by name.
    Drawing {
        /// The file; without one of the endings of drawings the name of an outline.
        path: PathBuf,
        /// How large it is to be, in mm by its largest extent; its own size without.
        extent_mm: Option<f64>,
        /// The unit of the formula, in mm, and of the numbers in a list of points.
        unit_mm: f64,
    },
    /// The area inside an odd number of closed lines.
    Contours {
        /// The lines in mm, about the middle of the box around them; none repeats its first point.
        contours: Vec<Vec<DVec2>>,
        /// The unit of the formula, in mm.
        unit_mm: f64,
    },
}

impl FromStr for Domain {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (path, scale) = match text.rsplit_once('@') {
            Some((path, scale)) => (path, Some(scale)),
            None => (text, None),
        };
        let is_file = Self::is_file(Path::new(path));
        let is_name = path.starts_with(|c: char| c.is_ascii_alphabetic());
        if !is_file && !is_name {
            return rectangle(text);
        }
        let wrong = || format!("`{text}` is not like outline.svg, circle@22m or points.csv@m");
        let path = PathBuf::from(path);
        let Some(scale) = scale else {
            return Ok(Self::Drawing { path, extent_mm: None, unit_mm: 1.0 });
        };
        let unit_mm = unit_of(scale)?;
        if unit_text(scale).len() == scale.trim().len() {
            let is_unit = !scale.trim().is_empty();
            return is_unit
                .then_some(Self::Drawing { path, extent_mm: None, unit_mm })
                .ok_or_else(wrong);
        }
        let extent = scale.trim().parse::<Length>().map_err(|e| e.to_string())?.mm();
        if !(extent > 0.0 && extent.is_finite()) {
            return Err(wrong());
        }
        Ok(Self::Drawing { path, extent_mm: Some(extent), unit_mm })
    }
}

fn rectangle(text: &str) -> Result<Domain, String> {
    let wrong = || format!("`{text}` is not like 22mx18m, or the name of a drawing");
    let (width, depth) = text.split_once('x').ok_or_else(wrong)?;
    let length = |part: &str| part.trim().parse::<Length>().map_err(|e| e.to_string());
    let unit_mm = unit_of(width)?;
    let size_mm = [length(width)?.mm(), length(depth)?.mm()];
    let ratio = size_mm[0] / size_mm[1];
    if size_mm.iter().any(|s| !(*s > 0.0 && s.is_finite())) || !(0.01..=100.0).contains(&ratio) {
        return Err(wrong());
    }
    Ok(Domain::Rectangle { size_mm, unit_mm })
}

/// What stands behind the last digit.
fn unit_text(length: &str) -> &str {
    length.trim().rsplit(|c: char| c.is_ascii_digit() || c == '.').next().unwrap_or_default()
}

/// The unit of a length, in mm.
fn unit_of(length: &str) -> Result<f64, String> {
    let one = format!("1{}", unit_text(length));
    Ok(one.parse::<Length>().map_err(|e| e.to_string())?.mm())
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rectangle { size_mm: [width, depth], .. } => write!(f, "{width}mmx{depth}mm"),
            Self::Drawing { path, extent_mm: Some(mm), .. } => {
                write!(f, "{}@{mm}mm", path.display())
            }
            Self::Drawing { path, .. } => write!(f, "{}", path.display()),
            Self::Contours { contours, .. } => write!(f, "{} closed lines", contours.len()),
        }
    }
}

impl<'de> Deserialize<'de> for Domain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

impl Domain {
    /// Whether a name is that of a file: it has one of the endings of drawings.
    pub fn is_file(path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known))
    }

    /// The unit of the formula, in mm.
    pub fn unit_mm(&self) -> f64 {
        match self {
            Self::Rectangle { unit_mm, .. }
            | Self::Drawing { unit_mm, .. }
            | Self::Contours { unit_mm, .. } => *unit_mm,
        }
    }

    /// The area inside closed lines as they were drawn, in mm: brought to the size that was asked
    /// for, its middle to the origin.
    pub fn of_contours(&self, mut contours: Vec<Vec<DVec2>>) -> Self {
        let all = || contours.iter().flatten().copied();
        let low = all().reduce(DVec2::min).unwrap_or_default();
        let high = all().reduce(DVec2::max).unwrap_or_default();
        let middle = low.midpoint(high);
        let factor = match self {
            Self::Drawing { extent_mm: Some(mm), .. } => mm / (high - low).max_element(),
            _ => 1.0,
        };
        contours.iter_mut().flatten().for_each(|p| *p = (*p - middle) * factor);
        Self::Contours { contours, unit_mm: self.unit_mm() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_the_formula_is_that_of_the_width() {
        for (text, unit, width) in [
            ("22mx18m", 1000.0, 22_000.0),
            ("2e1mx18m", 1000.0, 20_000.0),
            ("22e3x18e3", 1.0, 22_000.0),
            ("24\"x18\"", 25.4, 24.0 * 25.4),
        ] {
            let domain: Domain = text.parse().expect(text);
            let Domain::Rectangle { size_mm, unit_mm } = domain else { panic!("{text}") };
            assert_eq!((unit_mm, size_mm[0]), (unit, width), "{text}");
        }
    }

    #[test]
    fn a_drawing_may_say_its_size_and_its_unit() {
        for (text, name, extent, unit) in [
            ("a/outline.svg", "a/outline.svg", None, 1.0),
            ("outline.DXF@22m", "outline.DXF", Some(22_000.0), 1000.0),
            ("points.csv@m", "points.csv", None, 1000.0),
            ("2x3.txt@180", "2x3.txt", Some(180.0), 1.0),
            ("ellipse-2x1@6m", "ellipse-2x1", Some(6000.0), 1000.0),
        ] {
            let domain: Domain = text.parse().expect(text);
            let wanted =
                Domain::Drawing { path: PathBuf::from(name), extent_mm: extent, unit_mm: unit };
            assert_eq!(domain, wanted, "{text}");
        }
    }

    #[test]
    fn what_has_no_size_is_refused() {
        for text in
            ["", "8", "8x0", "8mx-2m", "1x1000", "8mx6parsec", "a.svg@", "a.svg@0m", "a.svg@-3m"]
        {
            assert!(text.parse::<Domain>().is_err(), "{text}");
        }
    }

    #[test]
    fn contours_are_scaled_about_their_middle() {
        let domain: Domain = "a.svg@4m".parse().expect("a drawing");
        let square = [(10.0, 20.0), (12.0, 20.0), (12.0, 21.0), (10.0, 21.0)];
        let made = domain.of_contours(vec![square.map(DVec2::from).to_vec()]);
        let Domain::Contours { contours, unit_mm } = made else { panic!("contours") };
        assert_eq!((contours[0][0], unit_mm), (DVec2::new(-2000.0, -1000.0), 1000.0));
    }
}
