//! The parameters of `panelize`.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

use super::{FixChoice, FixedPlane, PanelizeError, StayChoice, SymmetryChoice};
use crate::units::{Angle, Length};

/// What the rows of panels follow.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Align {
    /// The direction in which the surface bends least.
    #[default]
    Flat,
    /// The same, and the rim along it.
    Rim,
    /// Nothing: the rows run as smoothly as they can.
    None,
    /// The direction in which the surface bends least, and drawn curves, the `l` lines of this OBJ
    /// file; it has to be read before panels are made.
    File(PathBuf),
    /// The same with the curves, in mm.
    Curves(Vec<Vec<DVec3>>),
}

impl FromStr for Align {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_file = Path::new(text).extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
        match text {
            "flat" => Ok(Self::Flat),
            "rim" => Ok(Self::Rim),
            "none" => Ok(Self::None),
            _ if is_file => Ok(Self::File(PathBuf::from(text))),
            _ => Err(format!("`{text}` is not flat, rim, none, or an OBJ file of curves")),
        }
    }
}

impl fmt::Display for Align {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flat => write!(f, "flat"),
            Self::Rim => write!(f, "rim"),
            Self::None => write!(f, "none"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Curves(curves) => write!(f, "{} curves", curves.len()),
        }
    }
}

impl<'de> Deserialize<'de> for Align {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
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
    /// The same in the planes of this CSV file; it has to be read before panels are made.
    File(PathBuf),
    /// The same in these planes.
    Given(Vec<FixedPlane>),
}

impl FromStr for RimChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "free" => return Ok(Self::Free),
            "walls" => return Ok(Self::Walls),
            _ => {}
        }
        if Path::new(text).extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
            return Ok(Self::File(PathBuf::from(text)));
        }
        let wrong = || {
            format!(
                "`{text}` is not free, walls, like plane:z=0 or plane:z=0,z=8m, or a CSV file of planes"
            )
        };
        let planes = text.strip_prefix("plane:").ok_or_else(wrong)?;
        let plane = |part: &str| {
            let (axis, place) = part.split_once('=').ok_or_else(wrong)?;
            let axis = AXES.iter().position(|a| *a == axis.trim()).ok_or_else(wrong)?;
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
                let part = |(axis, place): &(usize, Length)| format!("{}={place}", AXES[*axis]);
                write!(f, "plane:{}", planes.iter().map(part).collect::<Vec<_>>().join(","))
            }
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Given(planes) => write!(f, "{} planes", planes.len()),
        }
    }
}

impl<'de> Deserialize<'de> for RimChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// How panels are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LayoutChoice {
    /// Along rows that follow the surface.
    #[default]
    Free,
    /// In staggered rings about an axis along x, y or z (0 to 2), each of congruent panels.
    Rings(usize),
}

impl FromStr for LayoutChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let axis = match text {
            "free" => return Ok(Self::Free),
            "rings" => Some(2),
            _ => text.strip_prefix("rings:axis=").and_then(|a| AXES.iter().position(|n| *n == a)),
        };
        axis.map(Self::Rings).ok_or_else(|| format!("`{text}` is not free, or like rings:axis=z"))
    }
}

impl fmt::Display for LayoutChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Free => write!(f, "free"),
            Self::Rings(axis) => write!(f, "rings:axis={}", AXES[*axis]),
        }
    }
}

impl<'de> Deserialize<'de> for LayoutChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// How to panelize. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct PanelizeParams {
    /// The size of panels: the distance between the middles of neighbours, in mm unless a unit is
    /// given. A regular hexagon of size 1 m has an area of 0.87 m².
    #[arg(long, value_name = "LENGTH")]
    #[serde(default, deserialize_with = "size_or_word")]
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
    /// How panels are laid out: free, or in staggered rings of congruent panels about an axis of a
    /// surface of revolution, such as rings:axis=z; where the axis is, is found out.
    #[arg(long, default_value_t = LayoutChoice::Free)]
    #[serde(default)]
    pub layout: LayoutChoice,
    /// What the rows of panels follow: flat (the direction in which the surface bends least), rim
    /// (the same, and the rim), none (as smooth as can be), or FILE.obj: flat, and near the curves
    /// of its `l` lines these, which are in the unit of the surface's file.
    #[arg(long, default_value_t = Align::Flat, value_name = "flat|rim|none|FILE")]
    #[serde(default)]
    pub align: Align,
    /// By how much panels may be larger or smaller than the mean so that rows run on without
    /// dislocations, 0 to 0.4.
    #[arg(long, default_value_t = 0.2, value_parser = crate::units::parse_number)]
    #[serde(default = "default_even")]
    pub even: f64,
    /// What becomes of the rim: free, walls, planes such as plane:z=0, or the planes of a CSV file with
    /// nx,ny,nz,d on each line for n·x = d, in the unit of the surface's file.
    #[arg(long, default_value_t = RimChoice::Free, value_name = "free|walls|plane:z=0|FILE")]
    #[serde(default)]
    pub rim: RimChoice,
    /// What stays: a CSV file of planes, nx,ny,nz,d on each line for n·x = d in the unit of the
    /// surface's file, each that of the panel where the surface comes nearest to it; groups (every flat
    /// part of a named group of faces is one panel), or group:NAME (of this one).
    #[arg(long, default_value_t = FixChoice::None, value_name = "none|FILE|groups|group:NAME")]
    #[serde(default)]
    pub fix: FixChoice,
    /// Points that stay, such as heads of columns: a corner of panels stands at each. A CSV or TXT file
    /// with x,y,z on each line, or the `v` lines of an OBJ file, in the unit of the surface's file.
    #[arg(long, default_value_t = StayChoice::None, value_name = "none|FILE")]
    #[serde(default)]
    pub stay: StayChoice,
    /// Panels in mirrored pairs: across the plane square to x, y or z through the middle of the surface's
    /// bounding box, or several, such as x,y. The surface has to be its own image.
    #[arg(long, default_value_t = SymmetryChoice::default(), value_name = "none|x|y|z|x,y")]
    #[serde(default)]
    pub symmetry: SymmetryChoice,
    /// Draw edges into so many families of one length each, 1 to 1000, as far as planar panels on the
    /// surface allow; how far is told.
    #[arg(long, value_name = "N")]
    #[serde(default)]
    pub families: Option<u32>,
    /// Keep edges of the surface that fold by more than this, 5 to 170 degrees: panels end there on
    /// both sides, and their corners lie on them. Without it creases are rounded.
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub crease: Option<Angle>,
    /// Even out noise and facets of the surface that are smaller than a panel, no place by more than
    /// this; how far it went is told.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub smooth: Option<Length>,
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
    /// How far a panel may leave the surface; farther ones are findings [default: a fifth of the
    /// panel size].
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub max_off: Option<Length>,
    /// From how many thicknesses plates may reach a vertex, 1 to 1000; what comes from farther is a
    /// finding. Of no meaning for card, which has none.
    #[arg(long, default_value_t = 1.5, value_name = "N", value_parser = crate::units::parse_number)]
    #[serde(default = "default_reach")]
    pub max_reach: f64,
    /// By how much neighbouring panels may fold, above 0 and up to 180 degrees; more is a finding.
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub max_fold: Option<Angle>,
    /// How deep a concave panel may be: how far a corner lies within the convex hull; deeper ones are
    /// findings. Panels of a saddle are always concave.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub max_hollow: Option<Length>,
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

/// A size, or the word `count` or `sag` where a recipe gives one of these instead.
fn size_or_word<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Length>, D::Error> {
    #[derive(Deserialize)]
    #[serde(
        untagged,
        expecting = "a length like \"1.2m\", or \"count\" or \"sag\" beside a key of that name"
    )]
    enum Typed {
        Number(f64),
        Text(String),
    }
    match Typed::deserialize(deserializer)? {
        Typed::Number(mm) => Ok(Some(Length::from_mm(mm))),
        Typed::Text(word) if ["count", "sag"].contains(&word.as_str()) => Ok(None),
        Typed::Text(text) => text.parse().map(Some).map_err(de::Error::custom),
    }
}

fn default_even() -> f64 {
    0.2
}

fn default_edge() -> f64 {
    0.18
}

fn default_reach() -> f64 {
    1.5
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
            layout: LayoutChoice::default(),
            align: Align::default(),
            even: default_even(),
            rim: RimChoice::default(),
            fix: FixChoice::default(),
            stay: StayChoice::default(),
            symmetry: SymmetryChoice::default(),
            families: None,
            crease: None,
            smooth: None,
            min_edge: default_edge(),
            min_angle: default_angle(),
            max_off: None,
            max_reach: default_reach(),
            max_fold: None,
            max_hollow: None,
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
        self.check_together()?;
        let largest = f64::MAX;
        let least = f64::MIN_POSITIVE;
        let ranges = [
            ("the size in mm", self.size.map_or(1.0, |l| l.mm()), least, largest),
            ("the sag in mm", self.sag.map_or(1.0, |l| l.mm()), least, largest),
            (
                "the distance to smooth by in mm",
                self.smooth.map_or(1.0, |l| l.mm()),
                least,
                largest,
            ),
            (
                "the distance off the surface in mm",
                self.max_off.map_or(1.0, |l| l.mm()),
                least,
                largest,
            ),
            (
                "the depth of concave panels in mm",
                self.max_hollow.map_or(1.0, |l| l.mm()),
                0.0,
                largest,
            ),
            (
                "the fold of neighbours in degrees",
                self.max_fold.map_or(1.0, |a| a.degrees()),
                least,
                180.0,
            ),
            ("the reach of plates", self.max_reach, 1.0, 1000.0),
            ("the number of families", self.families.map_or(1.0, f64::from), 1.0, 1000.0),
            ("the count", self.count.map_or(4.0, f64::from), 4.0, 100_000.0),
            ("`even`", self.even, 0.0, 0.4),
            ("the shortest edge", self.min_edge, 0.05, 0.3),
            (
                "the fold of a crease in degrees",
                self.crease.map_or(40.0, |a| a.degrees()),
                5.0,
                170.0,
            ),
            ("the smallest angle in degrees", self.min_angle.degrees(), 5.0, 60.0),
        ];
        for (name, value, low, high) in ranges {
            if !(low..=high).contains(&value) {
                return Err(PanelizeError::OutOfRange { name, value, low, high });
            }
        }
        Ok(())
    }

    /// That nothing excludes each other, and files have been read.
    fn check_together(&self) -> Result<(), PanelizeError> {
        let rings = (self.layout != LayoutChoice::Free, "--layout rings");
        let smooth = (self.smooth.is_some(), "--smooth");
        let crease = (self.crease.is_some(), "--crease");
        let fix = (self.fix != FixChoice::None, "--fix");
        let stay = (self.stay != StayChoice::None, "--stay");
        let symmetry = (!self.symmetry.0.is_empty(), "--symmetry");
        let apart = [
            (crease, rings),
            (crease, smooth),
            (fix, rings),
            (symmetry, rings),
            (symmetry, crease),
            (symmetry, smooth),
            (symmetry, fix),
            (stay, rings),
            (stay, symmetry),
            (stay, crease),
        ];
        for (one, other) in apart {
            if one.0 && other.0 {
                return Err(PanelizeError::Together { one: one.1, other: other.1 });
            }
        }
        if let FixChoice::File(path) = &self.fix {
            return Err(PanelizeError::PlanesUnread { path: path.clone() });
        }
        if let RimChoice::File(path) = &self.rim {
            return Err(PanelizeError::PlanesUnread { path: path.clone() });
        }
        if let StayChoice::File(path) = &self.stay {
            return Err(PanelizeError::PointsUnread { path: path.clone() });
        }
        Ok(())
    }

    /// The planes of the rim in units of the panel size, seen from `origin`.
    pub(super) fn rim_planes(&self, origin: DVec3, size: f64) -> Option<Vec<(DVec3, DVec3)>> {
        if let RimChoice::Given(planes) = &self.rim {
            let plane = |plane: &FixedPlane| {
                let length = plane.normal.length();
                let normal = plane.normal / length;
                (normal, normal * ((plane.offset / length - normal.dot(origin)) / size))
            };
            return Some(planes.iter().map(plane).collect());
        }
        let RimChoice::Planes(planes) = &self.rim else { return None };
        let plane = |&(axis, place): &(usize, Length)| {
            let mut through = DVec3::ZERO;
            through[axis] = (place.mm() - origin[axis]) / size;
            (DVec3::AXES[axis], through)
        };
        Some(planes.iter().map(plane).collect())
    }
}
