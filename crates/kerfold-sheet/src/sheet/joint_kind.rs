//! What can join the two sides of a seam.

use clap::ValueEnum;
use serde::Deserialize;

/// What joins the two sides of a seam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Joint {
    /// The bare edges, for tape or glue.
    #[default]
    None,
    /// A trapezoid to glue on one side of every seam.
    #[value(alias = "flap")]
    #[serde(alias = "flap")]
    Flaps,
    /// Flaps with holes, and holes in the partner that lie under them.
    #[value(alias = "rivet")]
    #[serde(alias = "rivet")]
    Rivets,
    /// Holes at equal places on both sides.
    #[value(alias = "stitches")]
    #[serde(alias = "stitches")]
    Stitch,
    /// Interlocking fingers for plates of the given thickness.
    #[value(alias = "finger")]
    #[serde(alias = "finger")]
    Fingers,
    /// Tabs on one side, and slots for them in the partner, for plates of the given thickness.
    #[value(alias = "tab")]
    #[serde(alias = "tab")]
    Tabs,
}
