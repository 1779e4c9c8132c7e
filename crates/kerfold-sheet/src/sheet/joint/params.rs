//! From what people ask for to checked numbers; an option that would do nothing is refused.

use clap::ValueEnum;
use serde::Deserialize;

use super::super::error::SheetError;
use super::super::params::SheetParams;
use super::FARTHEST_LIP;
use crate::units::{Angle, Length};

/// What joins the two sides of a seam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Joint {
    /// The bare edges, for tape or glue.
    #[default]
    None,
    /// A trapezoid to glue on one side of every seam.
    Flaps,
    /// Flaps with holes, and holes in the partner that lie under them.
    Rivets,
    /// Holes at equal places on both sides.
    Stitch,
    /// Interlocking fingers for plates of the given thickness.
    Fingers,
    /// Tabs on one side, and slots for them in the partner, for plates of the given thickness.
    Tabs,
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
            Self::Tabs(tabs, _) => FARTHEST_LIP * tabs.thickness,
        }
    }
}

/// Least material around a hole, in mm.
const WEB: f64 = 0.6;

/// Checks the joint's options.
///
/// # Errors
/// [`SheetError::JointOption`] for an option that the joint does not use, or one that it lacks;
/// [`SheetError::OutOfRange`] for its numbers.
pub(crate) fn plan(params: &SheetParams) -> Result<JointPlan, SheetError> {
    use Joint::{Fingers as F, Flaps, None as N, Rivets, Stitch, Tabs as T};
    let joint = params.joint;
    let is_mitred = params.substitute == Some(Substitute::Mitre);
    let given = [
        ("flap-width", params.flap_width.is_some(), &[Flaps, Rivets][..]),
        ("flap-angle", params.flap_angle.is_some(), &[Flaps, Rivets]),
        ("flap-side", params.flap_side.is_some(), &[Flaps, Rivets, T]),
        ("thickness", params.thickness.is_some(), &[F, T]),
        ("finger-width", params.finger_width.is_some(), &[F, T]),
        ("substitute", params.substitute.is_some(), &[F, T]),
        (
            "hole-spacing",
            params.hole_spacing.is_some(),
            if is_mitred { &[][..] } else { &[Stitch, Rivets, F, T] },
        ),
        (
            "hole-diameter",
            params.hole_diameter.is_some(),
            if is_mitred { &[] } else { &[Stitch, Rivets, F, T] },
        ),
        ("hole-inset", params.hole_inset.is_some(), if is_mitred { &[] } else { &[Stitch, F, T] }),
    ];
    if let Some((option, ..)) =
        given.into_iter().find(|(_, given, of)| *given && !of.contains(&joint))
    {
        return Err(SheetError::JointOption { option, joint, is_missing: false });
    }
    Ok(match joint {
        N => JointPlan::None,
        Flaps => JointPlan::Flaps(flap(params, 8.0)?),
        Rivets => JointPlan::Rivets(flap(params, 12.0)?, holes(params, [25.0, 3.2])?),
        Stitch => JointPlan::Stitch(holes(params, [6.0, 1.5])?),
        F | T => {
            let missing = SheetError::JointOption { option: "thickness", joint, is_missing: true };
            let thickness = length("thickness", Some(params.thickness.ok_or(missing)?), 0.0, 0.1)?;
            let width = length("finger-width", params.finger_width, 3.0 * thickness, thickness)?;
            let holes = if is_mitred { None } else { Some(holes(params, [6.0, 1.5])?) };
            if joint == F {
                JointPlan::Fingers(Fingers { thickness, width }, holes)
            } else {
                JointPlan::Tabs(
                    Tabs { thickness, width, side: params.flap_side.unwrap_or_default() },
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

fn flap(params: &SheetParams, width: f64) -> Result<Flap, SheetError> {
    let width = length("flap-width", params.flap_width, width, 1.0)?;
    let angle = params.flap_angle.map_or(60.0, Angle::degrees);
    if !(20.0..=90.0).contains(&angle) {
        return Err(SheetError::FlapAngle { degrees: angle });
    }
    Ok(Flap { width, angle: angle.to_radians(), side: params.flap_side.unwrap_or_default() })
}

/// Up to this thickness, in mm, card is pierced rather than cut, and holes stay small.
const THIN: f64 = 1.0;

fn holes(params: &SheetParams, [spacing, diameter]: [f64; 2]) -> Result<Holes, SheetError> {
    let kerf = params.kerf.mm();
    // What the material wants, where it is known.
    let web = params.made_of.as_ref().map_or(WEB, |m| m.web.mm().max(WEB)) + kerf;
    // Holes narrower than one and a half times the plate burn out. A little more, since the corners
    // of a drawn circle lie on it.
    let thickness =
        params.thickness.or(params.made_of.as_ref().map(|m| m.thickness)).map_or(0.0, Length::mm);
    let least = if thickness > THIN { 1.55 * thickness + kerf } else { 0.0 };
    let (diameter, spacing) = (diameter.max(least), spacing.max(2.0 * least));
    let diameter = length("hole-diameter", params.hole_diameter, diameter, kerf + 0.1)?;
    let spacing = length("hole-spacing", params.hole_spacing, spacing, diameter + web)?;
    let inset = length(
        "hole-inset",
        params.hole_inset,
        (2.0 * diameter).max(diameter / 2.0 + web),
        diameter / 2.0 + web,
    )?;
    Ok(Holes { spacing, radius: diameter / 2.0, inset, web })
}
