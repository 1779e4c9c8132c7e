//! The parameters of `panelize`.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

use super::PanelizeError;
use crate::units::{Angle, Length};

/// What the rows of panels follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Align {
    /// The direction in which the surface bends least.
    #[default]
    Flat,
    /// The same, and the rim along it.
    Rim,
    /// Nothing: the rows run as smoothly as they can.
    None,
}

/// What becomes of the rim.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum RimChoice {
    /// Corners slide along the rim, and may leave a curved one a little.
    #[default]
    Free,
    /// Straight stretches stay in their upright walls, exactly.
    Walls,
    /// Stretches in these planes, square to an axis, stay in them, exactly: the axis 0 to 2 and
    /// the place on it.
    Planes(Vec<(usize, Length)>),
}

impl FromStr for RimChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "free" => return Ok(Self::Free),
            "walls" => return Ok(Self::Walls),
            _ => {}
        }
        let wrong = || format!("`{text}` is not free, walls, or like plane:z=0 or plane:z=0,z=8m");
        let planes = text.strip_prefix("plane:").ok_or_else(wrong)?;
        let plane = |part: &str| {
            let (axis, place) = part.split_once('=').ok_or_else(wrong)?;
            let axis = ["x", "y", "z"].iter().position(|a| *a == axis.trim()).ok_or_else(wrong)?;
            let place = place.trim().parse().map_err(|e: crate::units::UnitError| e.to_string())?;
            Ok((axis, place))
        };
        planes.split(',').map(plane).collect::<Result<_, String>>().map(Self::Planes)
    }
}

impl fmt::Display for RimChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Free => write!(f, "free"),
            Self::Walls => write!(f, "walls"),
            Self::Planes(planes) => {
                let part =
                    |(axis, place): &(usize, Length)| format!("{}={place}", ["x", "y", "z"][*axis]);
                write!(f, "plane:{}", planes.iter().map(part).collect::<Vec<_>>().join(","))
            }
        }
    }
}

impl<'de> Deserialize<'de> for RimChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// How to panelize. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct PanelizeParams {
    /// The size of panels: the distance between the middles of neighbours, in mm unless a unit is
    /// given. A regular hexagon of size 1 m has an area of 0.87 m².
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub size: Option<Length>,
    /// About how many panels there should be, within 10 %; instead of a size.
    #[arg(long, value_name = "N")]
    #[serde(default)]
    pub count: Option<u32>,
    /// How far a flat panel must leave the surface where that bends most: the size follows from it;
    /// instead of a size. Corners and middles balance, so what is reached is often less.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub sag: Option<Length>,
    /// What the rows of panels follow.
    #[arg(long, value_enum, default_value_t = Align::Flat)]
    #[serde(default)]
    pub align: Align,
    /// By how much panels may be larger or smaller than the mean so that rows run on without
    /// dislocations, 0 to 0.4.
    #[arg(long, default_value_t = 0.2, value_parser = crate::units::parse_number)]
    #[serde(default = "default_even")]
    pub even: f64,
    /// What becomes of the rim: free, walls, or planes such as plane:z=0.
    #[arg(long, default_value_t = RimChoice::Free)]
    #[serde(default)]
    pub rim: RimChoice,
    /// The shortest edge that is aimed at, over the panel size, 0.05 to 0.3; shorter ones are
    /// findings below half of it.
    #[arg(long, default_value_t = 0.18, value_parser = crate::units::parse_number)]
    #[serde(default = "default_edge")]
    pub min_edge: f64,
    /// The smallest angle that is aimed at, 5 to 60 degrees; sharper ones are findings below half
    /// of it.
    #[arg(long, default_value_t = default_angle(), value_name = "ANGLE")]
    #[serde(default = "default_angle")]
    pub min_angle: Angle,
    /// The sheet that every panel must fit, in mm: 3210x6000.
    #[arg(long, value_name = "WIDTHxHEIGHT")]
    #[serde(default)]
    pub max_panel: Option<SheetSize>,
    /// Another seed gives another layout, the same one the same bytes.
    #[arg(long, default_value_t = 1)]
    #[serde(default = "default_seed")]
    pub seed: u64,
}

/// A sheet by its sides in mm, the shorter first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetSize(pub [f64; 2]);

impl FromStr for SheetSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not like 3210x6000 or 3.21mx6m");
        let (width, height) = text.split_once('x').ok_or_else(wrong)?;
        let side = |part: &str| part.parse::<Length>().map(|l| l.mm()).map_err(|e| e.to_string());
        let (a, b) = (side(width)?, side(height)?);
        if !(a > 0.0 && b > 0.0) {
            return Err(wrong());
        }
        Ok(Self([a.min(b), a.max(b)]))
    }
}

impl<'de> Deserialize<'de> for SheetSize {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

fn default_even() -> f64 {
    0.2
}

fn default_edge() -> f64 {
    0.18
}

fn default_angle() -> Angle {
    Angle::from_degrees(25.0)
}

fn default_seed() -> u64 {
    1
}

impl Default for PanelizeParams {
    fn default() -> Self {
        Self {
            size: None,
            count: None,
            sag: None,
            align: Align::default(),
            even: default_even(),
            rim: RimChoice::default(),
            min_edge: default_edge(),
            min_angle: default_angle(),
            max_panel: None,
            seed: default_seed(),
        }
    }
}

impl PanelizeParams {
    /// That all numbers are in their ranges.
    pub(super) fn check(&self) -> Result<(), PanelizeError> {
        let given = [self.size.is_some(), self.count.is_some(), self.sag.is_some()];
        let given = given.into_iter().filter(|&is| is).count();
        if given != 1 {
            return Err(PanelizeError::NoSize { given });
        }
        let largest = f64::MAX;
        let least = f64::MIN_POSITIVE;
        let ranges = [
            ("the size in mm", self.size.map_or(1.0, |l| l.mm()), least, largest),
            ("the sag in mm", self.sag.map_or(1.0, |l| l.mm()), least, largest),
            ("the count", self.count.map_or(4.0, f64::from), 4.0, 100_000.0),
            ("`even`", self.even, 0.0, 0.4),
            ("the shortest edge", self.min_edge, 0.05, 0.3),
            ("the smallest angle in degrees", self.min_angle.degrees(), 5.0, 60.0),
        ];
        for (name, value, low, high) in ranges {
            if !(low..=high).contains(&value) {
                return Err(PanelizeError::OutOfRange { name, value, low, high });
            }
        }
        Ok(())
    }

    /// The planes of the rim in units of the panel size, seen from `origin`.
    pub(super) fn rim_planes(&self, origin: DVec3, size: f64) -> Option<Vec<(DVec3, DVec3)>> {
        let RimChoice::Planes(planes) = &self.rim else { return None };
        let plane = |&(axis, place): &(usize, Length)| {
            let mut through = DVec3::ZERO;
            through[axis] = (place.mm() - origin[axis]) / size;
            (DVec3::AXES[axis], through)
        };
        Some(planes.iter().map(plane).collect())
    }
}
