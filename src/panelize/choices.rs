//! What stays as it is, planes, flat groups of faces and points, and what is mirrored.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

/// A plane that a panel is to have: all x with normal · x = offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPlane {
    /// Of any length but zero.
    pub normal: DVec3,
    /// In mm, for a normal of length 1; else as many times more.
    pub offset: f64,
    /// The line of the file that it stands on, counted from 1.
    pub line: usize,
}

/// Planes and groups of faces that stay.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum FixChoice {
    /// Nothing.
    #[default]
    None,
    /// The planes of this CSV file; it has to be read before panels are made.
    File(PathBuf),
    /// These planes: each is that of one panel, where the surface comes nearest to it.
    Planes(Vec<FixedPlane>),
    /// Every flat part of every named group of faces is one panel.
    Groups,
    /// Every part of this group of faces is one panel, and has to be flat.
    Group(String),
}

impl FromStr for FixChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_file = Path::new(text).extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
        match (text, text.strip_prefix("group:").map(str::trim)) {
            ("none", _) => Ok(Self::None),
            ("groups", _) => Ok(Self::Groups),
            (_, Some(name)) if !name.is_empty() => Ok(Self::Group(name.to_owned())),
            _ if is_file => Ok(Self::File(PathBuf::from(text))),
            _ => Err(format!(
                "`{text}` is not none, groups, like group:NAME, or a CSV file of planes"
            )),
        }
    }
}

impl fmt::Display for FixChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => write!(f, "none"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Planes(planes) => write!(f, "{} planes", planes.len()),
            Self::Groups => write!(f, "groups"),
            Self::Group(name) => write!(f, "group:{name}"),
        }
    }
}

impl<'de> Deserialize<'de> for FixChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// Points that stay: corners of panels stand there.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum StayChoice {
    /// Nothing.
    #[default]
    None,
    /// The points of this file; it has to be read before panels are made.
    File(PathBuf),
    /// These points, in mm.
    Points(Vec<DVec3>),
}

impl FromStr for StayChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ending = Path::new(text).extension().and_then(|e| e.to_str()).unwrap_or_default();
        let is_file = ["csv", "txt", "obj"].iter().any(|e| ending.eq_ignore_ascii_case(e));
        match text {
            "none" => Ok(Self::None),
            _ if is_file => Ok(Self::File(PathBuf::from(text))),
            _ => Err(format!("`{text}` is not none, or a CSV, TXT or OBJ file of points")),
        }
    }
}

impl fmt::Display for StayChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => write!(f, "none"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Points(points) => write!(f, "{} points", points.len()),
        }
    }
}

impl<'de> Deserialize<'de> for StayChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// Planes across which panels are mirrored: square to x, y or z (0 to 2), through the middle of the
/// surface's bounding box; ascending.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SymmetryChoice(pub Vec<usize>);

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

impl FromStr for SymmetryChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self::default());
        }
        let axis = |part: &str| AXES.iter().position(|axis| *axis == part.trim());
        let axes: Option<Vec<usize>> = text.split(',').map(axis).collect();
        let mut axes =
            axes.ok_or_else(|| format!("`{text}` is not none, x, y, z, or several like x,y"))?;
        axes.sort_unstable();
        axes.dedup();
        Ok(Self(axes))
    }
}

impl fmt::Display for SymmetryChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.0.iter().map(|&axis| AXES[axis]).collect();
        write!(f, "{}", if names.is_empty() { "none".to_owned() } else { names.join(",") })
    }
}

impl<'de> Deserialize<'de> for SymmetryChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_is_read_as_it_is_written() {
        for text in ["none", "groups", "group:entrance hall", "a/planes.csv"] {
            assert_eq!(text.parse::<FixChoice>().expect(text).to_string(), text);
        }
        for text in ["", "group:", "planes.json", "all"] {
            assert!(text.parse::<FixChoice>().is_err(), "{text}");
        }
        for text in ["none", "columns.csv", "a/columns.OBJ"] {
            assert_eq!(text.parse::<StayChoice>().expect(text).to_string(), text);
        }
        for text in ["", "columns", "columns.json"] {
            assert!(text.parse::<StayChoice>().is_err(), "{text}");
        }
        for text in ["none", "y", "x,z"] {
            assert_eq!(text.parse::<SymmetryChoice>().expect(text).to_string(), text);
        }
        for text in ["", "xy", "w", "x,"] {
            assert!(text.parse::<SymmetryChoice>().is_err(), "{text}");
        }
    }
}
