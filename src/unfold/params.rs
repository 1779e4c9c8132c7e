//! What the caller asks of an unfolding: how many pieces, which edges open, how long to search.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer};

use crate::code::codes;
use crate::mesh::{EdgeId, Mesh, SplitVertex};

/// How the model is to be taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PiecesMode {
    /// As few pieces as the search finds.
    #[default]
    Auto,
    /// One piece for each component, or an error.
    One,
    /// Chains of faces: every face keeps two neighbours at most.
    Strips,
    /// Every face by itself.
    Faces,
    /// Exactly so many pieces, or an error.
    Count(usize),
}

/// A piece mode that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a way to divide a model; write auto, one, strips, faces, or a number from 1"
)]
pub struct PiecesModeError {
    /// What was typed.
    pub text: String,
}

codes!(error struct PiecesModeError = 441);

impl FromStr for PiecesMode {
    type Err = PiecesModeError;

    fn from_str(text: &str) -> Result<Self, PiecesModeError> {
        match text {
            "auto" => Ok(Self::Auto),
            "one" => Ok(Self::One),
            "strips" => Ok(Self::Strips),
            "faces" => Ok(Self::Faces),
            _ => match text.parse() {
                Ok(count) if count > 0 => Ok(Self::Count(count)),
                _ => Err(PiecesModeError { text: text.to_owned() }),
            },
        }
    }
}

impl fmt::Display for PiecesMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::One => f.write_str("one"),
            Self::Strips => f.write_str("strips"),
            Self::Faces => f.write_str("faces"),
            Self::Count(count) => count.fmt(f),
        }
    }
}

impl<'de> Deserialize<'de> for PiecesMode {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "auto, one, strips, faces, or a number from 1")]
        enum Written {
            Number(u64),
            Text(String),
        }
        let text = match Written::deserialize(deserializer)? {
            Written::Number(number) => number.to_string(),
            Written::Text(text) => text,
        };
        text.parse().map_err(serde::de::Error::custom)
    }
}

/// How to unfold.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args, Deserialize)]
pub struct UnfoldParams {
    /// Pieces: auto (as few as can be found), one (for each component), strips, faces, or their
    /// exact number
    #[arg(long, default_value = "auto", value_name = "MODE")]
    #[serde(default)]
    pub pieces: PiecesMode,

    /// How long to search before a net is divided, 0 or more; each step lays every face about 150
    /// times
    #[arg(long, default_value_t = DEFAULT_EFFORT, value_name = "N")]
    #[serde(default = "default_effort")]
    pub effort: u32,

    /// Start of the random numbers; the same seed gives the same net
    #[arg(long, default_value_t = 0, value_name = "N")]
    #[serde(default)]
    pub seed: u64,
}

const DEFAULT_EFFORT: u32 = 10;

fn default_effort() -> u32 {
    DEFAULT_EFFORT
}

impl Default for UnfoldParams {
    fn default() -> Self {
        Self { pieces: PiecesMode::default(), effort: DEFAULT_EFFORT, seed: 0 }
    }
}

/// Which edges open, as far as the caller has decided it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Seams {
    /// Any edge may be opened or kept.
    #[default]
    Free,
    /// These edges open; of the others only those that keep a piece from lying flat without
    /// overlap.
    Open(Vec<EdgeId>),
    /// The unfolder chooses, but these edges stay together and those open. An edge that cannot stay
    /// is an error.
    Within {
        /// Edges that stay together.
        keep: Vec<EdgeId>,
        /// Edges that open.
        cut: Vec<EdgeId>,
    },
    /// These edges stay together where the pieces can lie flat without overlap; all others open.
    Folds(Vec<EdgeId>),
}

impl Seams {
    /// Whether the unfolder chooses, within limits or without.
    pub fn is_searched(&self) -> bool {
        matches!(self, Self::Free | Self::Within { .. })
    }

    /// The edges that carry the mesh's seam mark; [`Seams::Free`] when there are none.
    pub fn marked(mesh: &Mesh) -> Self {
        let marked: Vec<EdgeId> = mesh.edges().filter(|&e| mesh.is_seam(e)).collect();
        if marked.is_empty() { Self::Free } else { Self::Open(marked) }
    }
}

/// How the mesh in memory relates to the file that it came from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshSource<'a> {
    /// Factor from the file's unit to millimetres. The mesh is in millimetres already; the factor
    /// is only recorded.
    pub scale: f64,
    /// Vertices that reading added; the net names the vertex of the file instead.
    pub split_vertices: &'a [SplitVertex],
}

impl Default for MeshSource<'_> {
    fn default() -> Self {
        Self { scale: 1.0, split_vertices: &[] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Args, FromArgMatches};

    #[test]
    fn the_three_doors_give_the_same_defaults() {
        let command = UnfoldParams::augment_args(clap::Command::new("unfold"));
        let matches = command.try_get_matches_from(["unfold"]).expect("no flag is needed");
        let typed = UnfoldParams::from_arg_matches(&matches).expect("defaults parse");
        let read: UnfoldParams = toml::from_str("").expect("no key is needed");
        assert_eq!(typed, UnfoldParams::default());
        assert_eq!(read, UnfoldParams::default());
    }

    #[test]
    fn modes_are_read_as_words_and_numbers() {
        for text in ["auto", "one", "strips", "faces", "7"] {
            assert_eq!(text.parse::<PiecesMode>().expect(text).to_string(), text);
        }
        for text in ["", "0", "-1", "two", "Auto"] {
            assert!(text.parse::<PiecesMode>().is_err(), "{text}");
        }
        let read = |text: &str| toml::from_str::<UnfoldParams>(text);
        assert_eq!(read("pieces = 3").expect("a number").pieces, PiecesMode::Count(3));
        assert_eq!(read("pieces = \"strips\"").expect("a word").pieces, PiecesMode::Strips);
        assert!(read("pieces = 0").expect_err("no piece").to_string().contains("number from 1"));
    }
}
