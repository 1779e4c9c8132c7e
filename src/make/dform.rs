//! The designer of D-forms: chooses the folds of a coarse solid and carves them into smooth strips.
//!
//! In a closed 3-valent mesh the folds are a perfect matching, and the seams are the closed cycles
//! that it leaves. Rolling the folds, or cutting them over and over, turns each into a developable
//! strip (`docs/operators.md`, sections 2 and 4).

use std::fmt;
use std::str::FromStr;

use crate::code::codes;
use crate::op::{OpError, Roll, RollOptions, RollParams};
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
    /// Rolled so far, the pieces do not lie flat, but with a smaller radius they do.
    #[error(
        "with the roll {roll} the pieces overlap themselves, so that {made} come out and not the \
        {promised} that the folds promise; take {largest} mm at most, or leave the roll open"
    )]
    RollLosesFolds {
        /// The roll that was given.
        roll: Roll,
        /// Pieces that the folds leave before carving.
        promised: usize,
        /// Pieces that lie flat after it.
        made: usize,
        /// A smaller radius that keeps the promise, in mm.
        largest: f64,
    },
    /// However little is carved, the pieces do not lie flat.
    #[error(
        "the folds promise {promised} pieces, but {made} come out, however little is carved: the \
        faces of a piece overlap when they lie flat; take another row of `kerfold seams`, or \
        another `--matching`"
    )]
    NeverFlat {
        /// Pieces that the folds leave before carving.
        promised: usize,
        /// Pieces that lie flat after it.
        made: usize,
    },
    /// The strips of a step `cut edge` come apart into other pieces than the edges promised.
    #[error(
        "the edges that were cut leave {promised} pieces, but {made} come out: cuts met each \
        other, or a piece overlaps itself; take a smaller offset, or `roll = \"max\"` in place of \
        the offset, or name the folds yourself with `folds`"
    )]
    BrokenPromise {
        /// Pieces that the edges leave before they are cut.
        promised: usize,
        /// Pieces that lie flat after it.
        made: usize,
    },
}

codes!(error DformError {
    LosesFolds = 753,
    RollLosesFolds = 754,
    NeverFlat = 755,
    BrokenPromise = 756,
});

/// How to make a D-form of a closed 3-valent mesh.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct DformParams {
    /// Folds: hamiltonian (two pieces), one (one piece; needs a handle), least (angle × length),
    /// flattest (angle), or a row of the table of `kerfold seams`, from 0
    #[arg(long, default_value = "hamiltonian", value_name = "CHOICE")]
    #[serde(default)]
    pub matching: MatchingChoice,
    /// How the folds are rolled, which they are unless they are cut.
    #[command(flatten)]
    #[serde(flatten)]
    pub rolling: RollOptions,
    /// How often the folds are cut by offset instead of rolled, 0 to 64; each round halves the steps
    /// of the strips, 0 leaves the solid as it is. 4 where an offset or a bend is given
    #[arg(long, value_name = "N")]
    #[serde(default)]
    pub rounds: Option<u32>,
    /// Cut the folds by offset instead of rolling them: how deep, in (0, 2]: 0 at the fold, 1 at the
    /// far ends of the edges beside it; up to 1/2 the cuts stay apart. With rounds alone 0.3, or the
    /// largest below it that keeps the pieces whole
    #[arg(long, value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub offset: Option<f64>,
    /// How far the planes of cuts by offset lean towards one of the two faces, -1 to 1; 0 weighs
    /// their normals alike
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

/// How folds are carved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Carving {
    /// The solid stays as it is.
    Nothing,
    /// Rolled.
    Rolled(RollParams),
    /// Cut by offset, round after round.
    Cut {
        /// How deep.
        offset: f64,
        /// How far the planes lean.
        bend: f64,
        /// How often.
        rounds: u32,
    },
}

impl DformParams {
    /// The way that was asked for.
    ///
    /// # Errors
    /// [`OpError::Exclude`] for options of both ways.
    pub(super) fn carving(&self) -> Result<Carving, OpError> {
        let cuts = [
            ("rounds", self.rounds.is_some()),
            ("offset", self.offset.is_some()),
            ("bend", self.bend != 0.0),
        ];
        let cut = cuts.into_iter().find(|cut| cut.1);
        match (self.rolling.given(), cut) {
            (Some(first), Some((second, _))) => Err(OpError::Exclude { first, second }),
            (_, None) => Ok(Carving::Rolled(self.rolling.or(Roll::Max))),
            (None, Some(_)) if self.rounds == Some(0) => Ok(Carving::Nothing),
            (None, Some(_)) => Ok(Carving::Cut {
                offset: self.offset.unwrap_or(DEFAULT_OFFSET),
                bend: self.bend,
                rounds: self.rounds.unwrap_or(DEFAULT_ROUNDS),
            }),
        }
    }

    /// Whether the depth of the carving is left to the program.
    pub(super) fn is_open(&self) -> bool {
        self.offset.is_none() && matches!(self.rolling.roll, None | Some(Roll::Max | Roll::Each))
    }
}

impl Default for DformParams {
    fn default() -> Self {
        Self {
            matching: MatchingChoice::default(),
            rolling: RollOptions::default(),
            rounds: None,
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
                let params = DformParams { rounds: Some(rounds), ..DformParams::default() };
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
        let cut = DformParams { rounds: Some(4), ..DformParams::default() };
        for name in names.into_iter().chain(["truncated-tetrahedron"]) {
            for params in [&DformParams::default(), &cut] {
                let carved = carve_dform(&named(name), params, &Silent).expect(name);
                assert_eq!(laid_flat(&carved), 2, "{name}");
                // No strip of a piece is opened, and none is made one with the other piece.
                assert_eq!(piece_count(&carved.mesh, &carved.folds), 2, "{name}");
            }
        }
    }

    /// Nine strips of one width and one angle for every fold, three edges at every vertex, and one
    /// fold.
    #[test]
    fn folds_are_rolled_at_the_defaults() {
        for name in ["dodecahedron", "truncated-tetrahedron", "prism-7"] {
            let solid = named(name);
            let carved = carve_dform(&solid, &DformParams::default(), &Silent).expect(name);
            let mesh = &carved.mesh;
            let folds = solid.vertex_count() / 2;
            assert_eq!(mesh.vertex_count(), solid.vertex_count() + 18 * folds, "{name}");
            assert_eq!(carved.folds.len(), 10 * folds, "{name}");
            assert!(mesh.vertices().all(|v| mesh.valence(v) == 3), "{name}");
            assert!(crate::seam::is_perfect_matching(mesh, &carved.folds), "{name}");
            assert!(crate::measure::convexity(mesh).is_convex(), "{name}");
            assert!(!carved.notes.iter().any(|note| note.contains("met each other")), "{name}");
        }
    }

    #[test]
    fn the_two_ways_of_carving_do_not_mix() {
        let both = DformParams {
            offset: Some(0.2),
            rolling: RollOptions::new(Roll::Max),
            ..DformParams::default()
        };
        let refused = carve_dform(&named("cube"), &both, &Silent);
        assert!(matches!(refused, Err(MakeError::Op(OpError::Exclude { first: "roll", .. }))));
        let read = |text: &str| toml::from_str::<DformParams>(text).expect(text).carving();
        assert!(matches!(
            read("strips = 4"),
            Ok(Carving::Rolled(RollParams { strips: Some(4), .. }))
        ));
        assert!(matches!(read("offset = 0.2"), Ok(Carving::Cut { rounds: DEFAULT_ROUNDS, .. })));
        assert_eq!(read("rounds = 0"), Ok(Carving::Nothing));
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
            let params = DformParams { matching, rounds: Some(2), ..DformParams::default() };
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
        let usual = DformParams { rounds: Some(2), offset: Some(0.2), ..DformParams::default() };
        let rolled = |rolling| DformParams { rolling, ..DformParams::default() };
        let other = [
            DformParams { matching: MatchingChoice::Row(2), ..usual.clone() },
            DformParams { matching: MatchingChoice::Row(1), ..usual.clone() },
            DformParams { rounds: Some(1), ..usual.clone() },
            DformParams { offset: Some(0.25), ..usual.clone() },
            DformParams { bend: 0.2, ..usual.clone() },
            DformParams { bend: -0.2, ..usual.clone() },
            rolled(RollOptions { strips: Some(3), ..RollOptions::default() }),
            rolled(RollOptions { strip: "9deg".parse().ok(), ..RollOptions::default() }),
            rolled(RollOptions::new("10mm".parse().expect("a radius"))),
            rolled(RollOptions::new("10mm,5mm".parse().expect("two radii"))),
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
