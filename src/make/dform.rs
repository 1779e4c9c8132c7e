//! The designer of D-forms: chooses the folds of a coarse solid and carves them into smooth strips.
//!
//! In a closed 3-valent mesh the folds are a perfect matching, and the seams are the closed cycles
//! that it leaves. Cutting the folds over and over turns each into a developable strip
//! (`docs/operators.md`, sections 2 and 4).

use std::fmt;
use std::str::FromStr;

use crate::code::codes;
use serde::{Deserialize, Deserializer};

/// Which of the solid's edges become folds, one at every vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MatchingChoice {
    /// Two pieces: of the folds that leave one closed seam those with the least fold sum. Where
    /// there is no such seam, or none was found, the least matching.
    #[default]
    TwoPieces,
    /// One piece, on a mesh with handles: of the folds that leave one piece those with the least
    /// fold sum.
    OnePiece,
    /// The matching with the least fold sum, however many pieces it leaves.
    Least,
    /// The matching with the least sum of fold angles, whatever the lengths.
    Flattest,
    /// A row of the table that `seams` prints.
    Row(usize),
}

/// A choice of folds that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is no choice of folds; write hamiltonian (two pieces), one (one piece, on a mesh \
    with handles), least, flattest, or \
     a row of the table of `kerfold seams`"
)]
pub struct MatchingChoiceError {
    /// What was typed.
    pub text: String,
}

codes!(error struct MatchingChoiceError = 751);

impl FromStr for MatchingChoice {
    type Err = MatchingChoiceError;

    fn from_str(text: &str) -> Result<Self, MatchingChoiceError> {
        match text {
            "hamiltonian" => Ok(Self::TwoPieces),
            "one" => Ok(Self::OnePiece),
            "least" => Ok(Self::Least),
            // `dullest` is what recipes before 0.2 say.
            "flattest" | "dullest" => Ok(Self::Flattest),
            _ => text
                .parse()
                .map(Self::Row)
                .map_err(|_| MatchingChoiceError { text: text.to_owned() }),
        }
    }
}

impl fmt::Display for MatchingChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TwoPieces => f.write_str("hamiltonian"),
            Self::OnePiece => f.write_str("one"),
            Self::Least => f.write_str("least"),
            Self::Flattest => f.write_str("flattest"),
            Self::Row(row) => row.fmt(f),
        }
    }
}

impl<'de> Deserialize<'de> for MatchingChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "hamiltonian, one, least, flattest, or a row of the table of `kerfold seams`"
        )]
        enum Written {
            Row(usize),
            Text(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Row(row) => Ok(Self::Row(row)),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
        }
    }
}

/// Why a D-form cannot be made as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DformError {
    /// Other pieces come out than the folds promise, but with a smaller offset the same.
    #[error(
        "with the offset {offset} the cuts meet so far that {made} pieces come out and not the \
        {promised} that the folds promise; take {largest} at most, or leave the offset open"
    )]
    LosesFolds {
        /// The offset that was given.
        offset: f64,
        /// Pieces that the folds leave before carving.
        promised: usize,
        /// Pieces that lie flat after it.
        made: usize,
        /// The largest smaller offset that keeps the promise, in hundredths.
        largest: f64,
    },
}

codes!(error DformError {
    LosesFolds = 753,
});

/// How to make a D-form of a closed 3-valent mesh.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct DformParams {
    /// Folds: hamiltonian (two pieces), one (one piece; needs a handle), least (angle × length),
    /// flattest (angle), or a row of the table of `kerfold seams`, from 0
    #[arg(long, default_value = "hamiltonian", value_name = "CHOICE")]
    #[serde(default)]
    pub matching: MatchingChoice,
    /// How often the folds are cut, 0 to 64; each round halves the steps of the strips, 0 leaves
    /// the solid as it is
    #[arg(long, default_value_t = DEFAULT_ROUNDS, value_name = "N")]
    #[serde(default = "default_rounds")]
    pub rounds: u32,
    /// How deep, in (0, 2]: 0 at the fold, 1 at the far ends of the edges beside it; up to 1/2 the
    /// cuts stay apart. Unless given 0.3, or the largest below it that keeps the pieces whole
    #[arg(long, value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub offset: Option<f64>,
    /// How far the planes lean towards one of the two faces, -1 to 1; 0 weighs their normals alike
    #[arg(
        long,
        default_value_t = 0.0,
        value_parser = crate::units::parse_number,
        allow_negative_numbers = true
    )]
    #[serde(default)]
    pub bend: f64,
}

const DEFAULT_ROUNDS: u32 = 4;
const DEFAULT_OFFSET: f64 = 0.3;

fn default_rounds() -> u32 {
    DEFAULT_ROUNDS
}

impl DformParams {
    /// The offset that was given, or the usual one.
    pub(super) fn offset_or_default(&self) -> f64 {
        self.offset.unwrap_or(DEFAULT_OFFSET)
    }
}

impl Default for DformParams {
    fn default() -> Self {
        Self {
            matching: MatchingChoice::default(),
            rounds: DEFAULT_ROUNDS,
            offset: None,
            bend: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CarvedDform, MakeError, carve_dform};
    use super::*;
    use crate::mesh::Mesh;
    use crate::progress::Silent;
    use crate::seam::{SeamError, piece_count};
    use crate::shape::{SolidParams, solid};
    use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};
    use clap::{Args, FromArgMatches};

    #[test]
    fn the_three_doors_give_the_same_defaults() {
        let command = DformParams::augment_args(clap::Command::new("dform"));
        let matches = command.try_get_matches_from(["dform"]).expect("no flag is needed");
        assert_eq!(
            DformParams::from_arg_matches(&matches).expect("defaults parse"),
            DformParams::default()
        );
        assert_eq!(
            toml::from_str::<DformParams>("").expect("no key is needed"),
            DformParams::default()
        );
    }

    #[test]
    fn choices_are_words_and_rows() {
        for text in ["hamiltonian", "one", "least", "flattest", "3"] {
            assert_eq!(text.parse::<MatchingChoice>().expect(text).to_string(), text);
        }
        assert!("-1".parse::<MatchingChoice>().is_err());
        let read = |text: &str| toml::from_str::<DformParams>(text).map(|p| p.matching);
        assert_eq!(read("matching = 3"), Ok(MatchingChoice::Row(3)));
        assert_eq!(read("matching = \"least\""), Ok(MatchingChoice::Least));
        assert!(
            read("matching = \"most\"")
                .expect_err("no choice")
                .to_string()
                .contains("kerfold seams")
        );
    }

    fn named(name: &str) -> Mesh {
        let name = name.parse().expect("a name");
        solid(&SolidParams { name, edge: None, size: None }).expect("a solid")
    }

    #[test]
    fn two_pieces_of_every_3_valent_platonic_solid() {
        for name in ["tetrahedron", "cube", "dodecahedron"] {
            let solid = named(name);
            for rounds in [0, 2] {
                let params = DformParams { rounds, ..DformParams::default() };
                let carved = carve_dform(&solid, &params, &Silent).expect(name);
                assert_eq!(piece_count(&carved.mesh, &carved.made.strip), 2, "{name} {rounds}");
                // A fold becomes two after a round, four after the next.
                let folds = solid.vertex_count() / 2;
                assert_eq!(carved.made.strip.len(), folds << rounds, "{name} {rounds}");
            }
        }
    }

    /// At the defaults, and however deep the cuts: as many pieces as were promised.
    #[test]
    fn pieces_are_kept_where_cuts_meet() {
        let names =
            ["tetrahedron", "cube", "dodecahedron", "prism-3", "prism-5", "prism-9", "prism-20"];
        for name in names.into_iter().chain(["truncated-tetrahedron"]) {
            let carved = carve_dform(&named(name), &DformParams::default(), &Silent).expect(name);
            assert_eq!(laid_flat(&carved), 2, "{name}");
            // No strip of a piece is opened, and none is made one with the other piece.
            assert_eq!(piece_count(&carved.mesh, &carved.folds), 2, "{name}");
        }
    }

    fn laid_flat(carved: &CarvedDform) -> usize {
        let seams = Seams::Folds(carved.folds.clone());
        let params = UnfoldParams::default();
        let net = unfold(&carved.mesh, &seams, &params, &MeshSource::default(), &Silent);
        net.expect("a net").pieces.len()
    }

    #[test]
    fn an_offset_that_loses_folds_is_refused_with_the_largest_that_keeps_them() {
        let solid = named("truncated-tetrahedron");
        // Cut so deep, whole pieces are cut away.
        for (row, pieces) in [(1, 3), (2, 5)] {
            let matching = MatchingChoice::Row(row);
            let params = DformParams { matching, rounds: 2, ..DformParams::default() };
            let deep = DformParams { offset: Some(0.9), ..params.clone() };
            let refused = carve_dform(&solid, &deep, &Silent);
            let Err(MakeError::Dform(DformError::LosesFolds { promised, made, largest, .. })) =
                refused
            else {
                panic!("{refused:?}")
            };
            assert!(promised == pieces && made < pieces && largest < 0.9, "{row}");
            let with = |offset: f64| {
                carve_dform(
                    &solid,
                    &DformParams { offset: Some(offset), ..params.clone() },
                    &Silent,
                )
            };
            assert_eq!(laid_flat(&with(largest).expect("the offset that was named")), pieces);
            assert!(with(largest + 0.01).is_err(), "{largest} is the largest");
        }
    }

    #[test]
    fn every_option_changes_the_d_form() {
        let solid = named("truncated-tetrahedron");
        let corners = |params: DformParams| {
            let mesh = carve_dform(&solid, &params, &Silent).expect("a D-form").mesh;
            mesh.vertices().map(|v| mesh.position(v)).collect::<Vec<_>>()
        };
        let usual = DformParams { rounds: 2, offset: Some(0.2), ..DformParams::default() };
        let other = [
            DformParams { matching: MatchingChoice::Row(2), ..usual.clone() },
            DformParams { matching: MatchingChoice::Row(1), ..usual.clone() },
            DformParams { rounds: 1, ..usual.clone() },
            DformParams { offset: Some(0.25), ..usual.clone() },
            DformParams { bend: 0.2, ..usual.clone() },
            DformParams { bend: -0.2, ..usual.clone() },
        ];
        let mut seen = vec![corners(usual)];
        for params in other {
            let made = corners(params.clone());
            assert!(!seen.contains(&made), "{params:?}");
            seen.push(made);
        }
    }

    #[test]
    fn what_cannot_be_a_d_form_is_told() {
        let octahedron = carve_dform(&named("octahedron"), &DformParams::default(), &Silent);
        assert!(matches!(octahedron, Err(MakeError::Seam(SeamError::Valence { valence: 4, .. }))));
        let params = DformParams { matching: MatchingChoice::OnePiece, ..DformParams::default() };
        let one = carve_dform(&named("cube"), &params, &Silent);
        assert!(matches!(one, Err(MakeError::Seam(SeamError::NoHandle))));
        let params = DformParams { matching: MatchingChoice::Row(99), ..DformParams::default() };
        let row = carve_dform(&named("cube"), &params, &Silent);
        assert!(matches!(row, Err(MakeError::Seam(SeamError::NoSuchMatching { index: 99, .. }))));
    }
}
