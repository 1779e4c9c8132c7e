//! How plates are made: one definition for the library, the command line and the recipe.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use serde::{Deserialize, Deserializer};

use super::error::PanelError;
use super::rule::EdgeRules;
use crate::units::{Length, UnitError};

/// How the faces of a model become plates. The thickness itself comes beside it, since sheets need
/// it too.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct PanelParams {
    /// Which side of the plates the model's surface is: their inner side, their middle, or their
    /// outer side
    #[arg(long, value_enum, default_value = "out")]
    #[serde(default)]
    pub side: ReferenceSide,
    /// Gap of the joints, from plate to plate square to the cut, 0 or more; half of it is taken off
    /// each plate
    #[arg(long, value_name = "LENGTH", default_value = "0mm")]
    #[serde(default)]
    pub gap: Length,
    /// Groups of the file with a thickness of their own, like roof=12mm,wall=8mm
    #[arg(long, value_name = "GROUP=LENGTH,...", value_delimiter = ',')]
    #[serde(default)]
    pub thickness_of: Vec<GroupThickness>,
    /// How plates end where the model is open
    #[arg(long, value_enum, default_value = "square")]
    #[serde(default)]
    pub rim: RimCut,
    /// Whether edges may be cut at an angle, or only square as a laser does
    #[arg(long, value_enum, default_value = "bevel")]
    #[serde(default)]
    pub cutting: CutStyle,
    /// What the edges are: mitre, butt, finger, stitch or hinge; or by dihedral angle,
    /// 30-100:finger,100-180:stitch, where other angles are mitred. Concave edges have angles above
    /// 180
    #[arg(long, value_name = "KIND|RULES", default_value = "mitre")]
    #[serde(default)]
    pub edges: EdgeRules,
    /// What edges become that are too shallow, too sharp or too short for fingers or a butt joint
    #[arg(long, value_enum, default_value = "mitre")]
    #[serde(default)]
    pub shallow: Shallow,
    /// Cuts the corners of all panels off square to their bisector, this deep, so that a node has
    /// room; 0 or more
    #[arg(long, value_name = "LENGTH", default_value = "0mm")]
    #[serde(default)]
    pub corner_relief: Length,
    /// Density of the material in kg per cubic metre, above 0; unless given that of `material`,
    /// without one 2500, which is glass
    #[arg(long, value_name = "KG/M3", value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub density: Option<f64>,
    /// Panels whose corners differ by no more than this count as congruent; 0 or more
    #[arg(long, value_name = "LENGTH", default_value = "0.1mm")]
    #[serde(default = "default_tolerance")]
    pub tolerance: Length,
    /// What the model must be, else the exit code is 1: `valence3` (three edges at every vertex,
    /// two allowed at a rim), `conical` (the plates of every node meet to a millionth of their
    /// thickness)
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "LIST",
        hide_possible_values = true
    )]
    #[serde(default)]
    pub require: Vec<PanelRequirement>,
    /// Sizes of fingers and holes. On the command line and in recipes these are the options of the
    /// sheet with the same names.
    #[arg(skip)]
    #[serde(skip)]
    pub hardware: Hardware,
}

/// Density of float glass in kg/m³ (EN 572-1 gives 2500).
const GLASS: f64 = 2500.0;

fn default_tolerance() -> Length {
    Length::from_mm(0.1)
}

impl Default for PanelParams {
    fn default() -> Self {
        Self {
            side: ReferenceSide::default(),
            gap: Length::default(),
            thickness_of: Vec::new(),
            rim: RimCut::default(),
            cutting: CutStyle::default(),
            edges: EdgeRules::default(),
            shallow: Shallow::default(),
            corner_relief: Length::default(),
            density: None,
            tolerance: default_tolerance(),
            require: Vec::new(),
            hardware: Hardware::default(),
        }
    }
}

/// Which side of the plates the model's surface is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceSide {
    /// The inner side: plates grow outwards from the surface.
    In,
    /// The middle.
    Mid,
    /// The outer side: plates grow inwards, the model's size is that of the finished thing.
    #[default]
    Out,
}

impl ReferenceSide {
    /// The offsets of front and back from the surface along the outward normal, in thicknesses.
    pub(crate) fn offsets(self) -> [f64; 2] {
        match self {
            Self::In => [1.0, 0.0],
            Self::Mid => [0.5, -0.5],
            Self::Out => [0.0, -1.0],
        }
    }
}

/// How plates end at a rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RimCut {
    /// Square to the plate.
    #[default]
    Square,
    /// Along the vertical (z), so that the cut stands plumb; square where the edge itself stands
    /// upright.
    Plumb,
    /// Along the plane of the rim: it bisects the angle to the model mirrored there, so that halves
    /// of a model meet flush.
    Bisected,
}

/// Whether edges may be cut at an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CutStyle {
    /// At any angle.
    #[default]
    Bevel,
    /// Square only: plates end where the innermost line of their edge is, and an open V stays
    /// between them.
    Square,
}

/// What an edge becomes that cannot be what its rule says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shallow {
    /// A mitre.
    #[default]
    Mitre,
    /// A mitre with a row of holes on both sides.
    Stitch,
}

/// A property that a model must have to be panelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PanelRequirement {
    /// Every vertex has three edges; at a rim it may have two.
    #[value(name = "valence3")]
    #[serde(rename = "valence3")]
    Valence3,
    /// The plates of every node meet in a point.
    Conical,
}

/// A group of the file with a thickness of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupThickness {
    /// The name of the group.
    pub group: String,
    /// The thickness of its plates, above 0.
    pub thickness: Length,
}

impl FromStr for GroupThickness {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let wanted = || UnitError {
            text: text.to_owned(),
            wanted: "a group with its thickness",
            example: "roof=12mm",
        };
        let (group, thickness) = text.rsplit_once('=').ok_or_else(wanted)?;
        Ok(Self { group: group.trim().to_owned(), thickness: thickness.parse()? })
    }
}

impl fmt::Display for GroupThickness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.group, self.thickness)
    }
}

impl<'de> Deserialize<'de> for GroupThickness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

impl PanelParams {
    /// The density that counts, in kg/m³.
    pub fn density_kg_m3(&self) -> f64 {
        self.density.unwrap_or(GLASS)
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// [`PanelError::OutOfRange`] with the number and what it must be.
    pub(crate) fn check(&self, thickness: Length) -> Result<(), PanelError> {
        let positive = |name: &str, value: f64| match value {
            v if v > 0.0 && v.is_finite() => Ok(()),
            _ => Err(PanelError::OutOfRange { name: name.to_owned(), value, wanted: "above 0" }),
        };
        positive("thickness", thickness.mm())?;
        positive("density", self.density_kg_m3())?;
        for own in &self.thickness_of {
            positive(&format!("the thickness of group {}", own.group), own.thickness.mm())?;
        }
        for (name, value) in [
            ("gap", self.gap),
            ("corner-relief", self.corner_relief),
            ("tolerance", self.tolerance),
        ] {
            if !(value.mm() >= 0.0 && value.mm().is_finite()) {
                return Err(PanelError::OutOfRange {
                    name: name.to_owned(),
                    value: value.mm(),
                    wanted: "0 or more",
                });
            }
        }
        self.hardware.check()
    }

    /// Whether a property is required.
    pub fn requires(&self, requirement: PanelRequirement) -> bool {
        self.require.contains(&requirement)
    }
}

/// Sizes of fingers and holes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hardware {
    /// Width of a finger, about; three times the thickness unless given, never less than it.
    pub finger_width: Option<Length>,
    /// From one hole to the next; 50 mm unless given.
    pub hole_spacing: Option<Length>,
    /// Diameter of a hole; 4 mm unless given.
    pub hole_diameter: Option<Length>,
    /// From the innermost line of the cut to the middle of a hole; twice the diameter unless given.
    pub hole_inset: Option<Length>,
}

impl Hardware {
    pub(crate) fn spacing(&self) -> f64 {
        self.hole_spacing.map_or(50.0, Length::mm)
    }

    pub(crate) fn diameter(&self) -> f64 {
        self.hole_diameter.map_or(4.0, Length::mm)
    }

    pub(crate) fn inset(&self) -> f64 {
        self.hole_inset.map_or(2.0 * self.diameter(), Length::mm)
    }

    fn check(&self) -> Result<(), PanelError> {
        let given = [
            ("finger-width", self.finger_width),
            ("hole-spacing", self.hole_spacing),
            ("hole-diameter", self.hole_diameter),
            ("hole-inset", self.hole_inset),
        ];
        for (name, value) in given.into_iter().filter_map(|(name, value)| Some((name, value?.mm())))
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(PanelError::OutOfRange {
                    name: name.to_owned(),
                    value,
                    wanted: "above 0",
                });
            }
        }
        Ok(())
    }
}
