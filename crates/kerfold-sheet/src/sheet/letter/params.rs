//! What is engraved.

use clap::ValueEnum;
use serde::Deserialize;

/// What is engraved on sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::Args, Deserialize)]
pub struct LetterParams {
    /// What is engraved: nothing, the names of the pieces, or these and the numbers of the seams
    #[arg(long, value_enum, default_value = "all")]
    #[serde(default)]
    pub labels: Labels,
    /// Whether the angles of folds are engraved beside them, in degrees; valleys are negative
    #[arg(long, value_enum, default_value = "off")]
    #[serde(default)]
    pub angles: Angles,
}

/// What is engraved on the pieces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Labels {
    /// Nothing.
    None,
    /// The name of every piece.
    Pieces,
    /// The name of every piece, and on both sides of every stretch of seam its number, with marks
    /// where it ends.
    #[default]
    All,
    /// The name of every piece, and on both sides of every seam edge the number of the edge in the
    /// model.
    Edges,
}

/// Whether the angles of folds are engraved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Angles {
    /// No angles.
    #[default]
    Off,
    /// The angle that the paper turns, beside every fold with room for it.
    On,
}
