//! From what people ask for to checked numbers; an option that would do nothing is refused.

use clap::ValueEnum;
use serde::Deserialize;

use super::super::error::SheetError;
use super::super::joint_kind::Joint;
use super::super::stock::StockParams;
use crate::units::{Angle, Length};

/// What holds the two sides of seams together.
#[derive(Debug, Clone, PartialEq, Default, clap::Args, Deserialize)]
pub struct JointParams {
    /// What joins the two sides of a seam
    #[arg(id = "joint", long = "joint", value_name = "JOINT", value_enum, default_value = "none")]
    #[serde(default, rename = "joint")]
    pub kind: Joint,
    /// Width of flaps, at least 1mm; of flaps 8mm, with rivets 12mm unless given
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub flap_width: Option<Length>,
    /// Angle at the ends of flaps, 20 to 90 degrees; 60deg unless given. Short seams get steeper
    /// flaps
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub flap_angle: Option<Angle>,
    /// Which side of a seam gets the flap or the tabs, where it has room; lower unless given
    #[arg(long, value_enum)]
    #[serde(default)]
    pub flap_side: Option<FlapSide>,
    /// Thickness of the material; needed for fingers and tabs, at least 0.1mm
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub thickness: Option<Length>,
    /// Width of a finger, about, or of a tab; three times the thickness unless given, never less
    /// than it
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub finger_width: Option<Length>,
    /// What seams get that are too shallow or too narrow for fingers or tabs; stitch unless given
    #[arg(long, value_enum)]
    #[serde(default)]
    pub substitute: Option<Substitute>,
    /// From one hole to the next along a seam; stitch holes 6mm, rivets 25mm unless given, at least
    /// twice what thick plates need
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub hole_spacing: Option<Length>,
    /// Diameter of stitch holes (1.5mm unless given) or rivet holes (3.2mm), in plates above 1mm at
    /// least 1.55 times their thickness and the kerf; more than the kerf
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub hole_diameter: Option<Length>,
    /// From a seam to the middle of its stitch holes; twice their diameter unless given
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub hole_inset: Option<Length>,
}

/// What seams get that are too shallow or too narrow for fingers or tabs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Substitute {
    /// Stitch holes where there is room.
    #[default]
    Stitch,
    /// The bare edge, to be mitred; the notes tell the angles.
    Mitre,
}

/// Which side of a seam carries the flap or the tabs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FlapSide {
    /// The piece with the lower number; within a piece the face with the lower number.
    #[default]
    Lower,
    /// The piece with the higher number.
    Higher,
    /// By turns along the seams.
    Alternate,
}

/// Checked numbers of flaps, in mm and radians.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flap {
    pub width: f64,
    pub angle: f64,
    pub side: FlapSide,
}

/// Checked numbers of holes, in mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Holes {
    pub spacing: f64,
    pub radius: f64,
    pub inset: f64,
    /// Least material between a hole and anything else.
    pub web: f64,
}

/// Checked numbers of fingers, in mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fingers {
    pub thickness: f64,
    pub width: f64,
}

/// Checked numbers of tabs, in mm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tabs {
    pub thickness: f64,
    pub width: f64,
    pub side: FlapSide,
}

/// A joint with all that it needs; holes for the seams that it cannot hold, or none where these are
/// mitred.
#[derive(Debug, Clone, Copy)]
pub(crate) enum JointPlan {
    None,
    Flaps(Flap),
    Rivets(Flap, Holes),
    Stitch(Holes),
    Fingers(Fingers, Option<Holes>),
    Tabs(Tabs, Option<Holes>),
}

impl JointPlan {
    /// How far the joint may stand out beyond an outline, in mm.
    pub fn reach(&self) -> f64 {
        match self {
            Self::None | Self::Stitch(_) | Self::Fingers(..) => 0.0,
            Self::Flaps(flap) | Self::Rivets(flap, _) => flap.width,
            Self::Tabs(tabs, _) => tabs.thickness.max(WEB) + FARTHEST_LEAN * tabs.thickness,
        }
    }
}

/// How far a lip may stand out besides its web, in thicknesses: the lean of a slot at the flattest
/// angle, 1.19.
pub(super) const FARTHEST_LEAN: f64 = 1.2;

/// Least material between a cut of a joint and any other cut, in mm: the millimetre that is wanted
/// of every web, and a little more, since files hold rounded numbers.
pub(super) const WEB: f64 = 1.01;

/// Checks the joint's options.
///
/// # Errors
/// [`SheetError::JointOption`] for an option that the joint does not use, or one that it lacks;
/// [`SheetError::OutOfRange`] for its numbers.
pub(crate) fn plan(asked: &JointParams, stock: &StockParams) -> Result<JointPlan, SheetError> {
    use Joint::{Fingers as F, Flaps, None as N, Rivets, Stitch, Tabs as T};
    let joint = asked.kind;
    let is_mitred = asked.substitute == Some(Substitute::Mitre);
    let given = [
        ("flap-width", asked.flap_width.is_some(), &[Flaps, Rivets][..]),
        ("flap-angle", asked.flap_angle.is_some(), &[Flaps, Rivets]),
        ("flap-side", asked.flap_side.is_some(), &[Flaps, Rivets, T]),
        ("thickness", asked.thickness.is_some(), &[F, T]),
        ("finger-width", asked.finger_width.is_some(), &[F, T]),
        ("substitute", asked.substitute.is_some(), &[F, T]),
        (
            "hole-spacing",
            asked.hole_spacing.is_some(),
            if is_mitred { &[][..] } else { &[Stitch, Rivets, F, T] },
        ),
        (
            "hole-diameter",
            asked.hole_diameter.is_some(),
            if is_mitred { &[] } else { &[Stitch, Rivets, F, T] },
        ),
        ("hole-inset", asked.hole_inset.is_some(), if is_mitred { &[] } else { &[Stitch, F, T] }),
    ];
    if let Some((option, ..)) =
        given.into_iter().find(|(_, given, of)| *given && !of.contains(&joint))
    {
        return Err(SheetError::JointOption { option, joint, is_missing: false });
    }
    Ok(match joint {
        N => JointPlan::None,
        Flaps => JointPlan::Flaps(flap(asked, 8.0)?),
        Rivets => JointPlan::Rivets(flap(asked, 12.0)?, holes(asked, stock, [25.0, 3.2])?),
        Stitch => JointPlan::Stitch(holes(asked, stock, [6.0, 1.5])?),
        F | T => {
            let missing = SheetError::JointOption { option: "thickness", joint, is_missing: true };
            let thickness = length("thickness", Some(asked.thickness.ok_or(missing)?), 0.0, 0.1)?;
            let width = length("finger-width", asked.finger_width, 3.0 * thickness, thickness)?;
            let holes = if is_mitred { None } else { Some(holes(asked, stock, [6.0, 1.5])?) };
            if joint == F {
                JointPlan::Fingers(Fingers { thickness, width }, holes)
            } else {
                JointPlan::Tabs(
                    Tabs { thickness, width, side: asked.flap_side.unwrap_or_default() },
                    holes,
                )
            }
        }
    })
}

fn length(
    name: &'static str,
    value: Option<Length>,
    default: f64,
    least: f64,
) -> Result<f64, SheetError> {
    let value = value.map_or(default, Length::mm);
    // Written so that NaN is out of range too.
    if value >= least && value.is_finite() {
        Ok(value)
    } else {
        Err(SheetError::OutOfRange { name, value, least })
    }
}

fn flap(asked: &JointParams, width: f64) -> Result<Flap, SheetError> {
    let width = length("flap-width", asked.flap_width, width, 1.0)?;
    let angle = asked.flap_angle.map_or(60.0, Angle::degrees);
    if !(20.0..=90.0).contains(&angle) {
        return Err(SheetError::FlapAngle { degrees: angle });
    }
    Ok(Flap { width, angle: angle.to_radians(), side: asked.flap_side.unwrap_or_default() })
}

/// Up to this thickness, in mm, card is pierced rather than cut, and holes stay small.
const THIN: f64 = 1.0;

fn holes(
    asked: &JointParams,
    stock: &StockParams,
    [spacing, diameter]: [f64; 2],
) -> Result<Holes, SheetError> {
    let kerf = stock.kerf.mm();
    let made_of = stock.made_of.as_ref();
    // What the material wants, where it is known.
    let web = made_of.map_or(WEB, |m| m.web.mm().max(WEB)) + kerf;
    // Holes narrower than one and a half times the plate burn out. A little more, since the corners
    // of a drawn circle lie on it.
    let thickness = asked.thickness.or(made_of.map(|m| m.thickness)).map_or(0.0, Length::mm);
    let least = if thickness > THIN { 1.55 * thickness + kerf } else { 0.0 };
    let (diameter, spacing) = (diameter.max(least), spacing.max(2.0 * least));
    let diameter = length("hole-diameter", asked.hole_diameter, diameter, kerf + 0.1)?;
    let spacing = length("hole-spacing", asked.hole_spacing, spacing, diameter + web)?;
    let inset = length(
        "hole-inset",
        asked.hole_inset,
        (2.0 * diameter).max(diameter / 2.0 + web),
        diameter / 2.0 + web,
    )?;
    Ok(Holes { spacing, radius: diameter / 2.0, inset, web })
}
