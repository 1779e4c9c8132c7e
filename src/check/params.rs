//! What the user asks of a model.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use serde::{Deserialize, Deserializer};

use super::{Limits, Profile};
use crate::code::codes;
use crate::units::{Angle, Length};

/// What to check, and how strictly.
///
/// The default profile is `glass`: of those that a shop can use it is the strictest, and it works
/// at every size, since it limits the deviation in mm and relative to the face. `exact` would fail
/// every file with seven digits, and `plywood` would pass anything that is drawn in metres.
#[derive(Debug, Clone, PartialEq, Default, clap::Args, Deserialize)]
pub struct CheckParams {
    /// How planar faces must be: `exact` (1e-9 of the face's diameter), `glass` (2 per mille and 1
    /// mm), `plywood` (1 mm) or `paper` (0.5 degrees). `glazier` and `joiner` hold to `glass` and
    /// `plywood`, and limit corners, edges and mitres as such shops do. These are kerfold's
    /// defaults, not norms.
    #[arg(long, value_enum, default_value = "glass")]
    #[serde(default)]
    pub profile: Profile,

    /// What else the model must be, separated by commas: `planar` (always checked), `valence3`,
    /// `closed`, `convex`, `manifold`, `one-component`, `simple` (no face goes through another).
    /// What is broken becomes a finding.
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "LIST",
        hide_possible_values = true
    )]
    #[serde(default, deserialize_with = "list")]
    pub require: Vec<Requirement>,

    /// Largest distance of a corner from its face's plane, instead of the profile's; 0 or more.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub max_mm: Option<Length>,

    /// The same in per mille of the face's diameter, instead of the profile's; 0 or more.
    #[arg(long, value_name = "NUMBER", value_parser = crate::units::parse_number)]
    #[serde(default)]
    pub max_permille: Option<f64>,

    /// Largest angle between a face's normal and that of a corner, instead of the profile's; 0 or
    /// more.
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub max_degrees: Option<Angle>,

    /// Smallest angle at a corner of a face, instead of the profile's; 0 or more.
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub min_angle: Option<Angle>,

    /// Shortest edge, instead of the profile's; 0 or more.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub min_edge: Option<Length>,

    /// Largest mitre, half of the angle by which two faces fold, instead of the profile's; 0 or
    /// more.
    #[arg(long, value_name = "ANGLE")]
    #[serde(default)]
    pub max_mitre: Option<Angle>,
}

/// A property that a model must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum)]
#[non_exhaustive]
pub enum Requirement {
    /// Faces are planar within the profile. Always checked.
    Planar,
    /// Every vertex has three edges; at a rim it may have two.
    #[value(name = "valence3")]
    Valence3,
    /// The surface has no rim.
    Closed,
    /// The model bounds a convex solid.
    Convex,
    /// No two vertices share a place: the surface does not touch itself at a vertex or along an
    /// edge.
    Manifold,
    /// Everything is connected.
    OneComponent,
    /// No face goes through another or covers it.
    Simple,
}

/// Why a model cannot be checked as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// A name that is not known.
    #[error("`{text}` is not a {what}; did you mean `{nearest}`? Known: {known}")]
    UnknownName {
        /// What was typed.
        text: String,
        /// What it should have named.
        what: &'static str,
        /// The most similar name.
        nearest: String,
        /// All names.
        known: String,
    },
    /// A limit that no face can be held to.
    #[error("{name} is {value}; a limit must be a number of 0 or more")]
    BadLimit {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

codes!(error CheckError {
    UnknownName = 801,
    BadLimit = 802,
});

impl CheckParams {
    /// The profile's limits with the user's in their place.
    ///
    /// # Errors
    /// [`CheckError::BadLimit`] when one of the user's is negative or not finite.
    pub fn limits(&self) -> Result<Limits, CheckError> {
        let profile = self.profile.limits();
        Ok(Limits {
            mm: limit("max_mm", self.max_mm.map(Length::mm))?.or(profile.mm),
            permille: limit("max_permille", self.max_permille)?.or(profile.permille),
            degrees: limit("max_degrees", self.max_degrees.map(Angle::degrees))?
                .or(profile.degrees),
            min_angle_degrees: limit("min_angle", self.min_angle.map(Angle::degrees))?
                .or(profile.min_angle_degrees),
            min_edge_mm: limit("min_edge", self.min_edge.map(Length::mm))?.or(profile.min_edge_mm),
            max_mitre_degrees: limit("max_mitre", self.max_mitre.map(Angle::degrees))?
                .or(profile.max_mitre_degrees),
        })
    }

    /// Whether a property is required.
    pub fn requires(&self, requirement: Requirement) -> bool {
        self.require.contains(&requirement)
    }
}

fn limit(name: &'static str, value: Option<f64>) -> Result<Option<f64>, CheckError> {
    match value {
        Some(value) if !value.is_finite() || value < 0.0 => {
            Err(CheckError::BadLimit { name, value })
        }
        fine => Ok(fine),
    }
}

impl FromStr for Requirement {
    type Err = CheckError;
    fn from_str(text: &str) -> Result<Self, CheckError> {
        named(text, "requirement")
    }
}

impl FromStr for Profile {
    type Err = CheckError;
    fn from_str(text: &str) -> Result<Self, CheckError> {
        named(text, "planarity profile")
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&name_of(self))
    }
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Requirements in a recipe: a list, or one text with commas as on the command line.
fn list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Requirement>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Typed {
        List(Vec<String>),
        Text(String),
    }
    let names = match Typed::deserialize(deserializer)? {
        Typed::List(names) => names,
        Typed::Text(text) => text.split(',').map(str::to_owned).collect(),
    };
    names.iter().map(|name| name.parse().map_err(serde::de::Error::custom)).collect()
}

fn named<T: ValueEnum>(text: &str, what: &'static str) -> Result<T, CheckError> {
    let names: Vec<String> = T::value_variants().iter().map(name_of).collect();
    T::from_str(text.trim(), false).map_err(|_| CheckError::UnknownName {
        text: text.to_owned(),
        what,
        nearest: names.iter().min_by_key(|name| edits(text, name)).cloned().unwrap_or_default(),
        known: names.join(", "),
    })
}

fn name_of<T: ValueEnum>(value: &T) -> String {
    value.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default()
}

/// Number of characters to insert, remove or replace to make one word of the other (Levenshtein
/// 1966).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, c) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, &d) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(c != d);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Args, FromArgMatches};

    fn typed(words: &[&str]) -> Result<CheckParams, clap::Error> {
        let command = CheckParams::augment_args(clap::Command::new("check").no_binary_name(true));
        CheckParams::from_arg_matches(&command.try_get_matches_from(words)?)
    }

    #[test]
    fn the_three_doors_have_the_same_defaults() {
        assert_eq!(typed(&[]).expect("no words"), CheckParams::default());
        assert_eq!(toml::from_str::<CheckParams>("").expect("no keys"), CheckParams::default());
        assert_eq!(CheckParams::default().limits(), Ok(Profile::Glass.limits()));
    }

    #[test]
    fn the_three_doors_read_the_same() {
        let words =
            ["--profile", "paper", "--require", "valence3,one-component", "--max-mm", "1/8in"];
        let wanted = CheckParams {
            profile: Profile::Paper,
            require: vec![Requirement::Valence3, Requirement::OneComponent],
            max_mm: Some(Length::from_mm(3.175)),
            ..CheckParams::default()
        };
        assert_eq!(typed(&words).expect("good words"), wanted);
        let list = "profile = 'paper'\nrequire = ['valence3', 'one-component']\nmax_mm = '1/8in'";
        assert_eq!(toml::from_str::<CheckParams>(list).expect("good keys"), wanted);
        let text = "profile = 'paper'\nrequire = 'valence3, one-component'\nmax_mm = 3.175";
        assert_eq!(toml::from_str::<CheckParams>(text).expect("good keys"), wanted);
        assert_eq!(
            wanted.limits().expect("good limits"),
            Limits { mm: Some(3.175), degrees: Some(0.5), ..Limits::default() }
        );
    }

    #[test]
    fn a_wrong_name_is_answered_with_the_nearest() {
        let error = "planer".parse::<Requirement>().expect_err("no such name");
        assert_eq!(
            error.to_string(),
            "`planer` is not a requirement; did you mean `planar`? Known: planar, valence3, \
            closed, convex, manifold, one-component, simple"
        );
        assert!(
            typed(&["--require", "planar,clozed"])
                .expect_err("no such name")
                .to_string()
                .contains("'closed'")
        );
        let recipe = toml::from_str::<CheckParams>("profile = 'gloss'").expect_err("no such name");
        assert!(recipe.to_string().contains("did you mean `glass`?"), "{recipe}");
    }

    #[test]
    fn bad_limits_are_refused() {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let params = CheckParams { max_permille: Some(bad), ..CheckParams::default() };
            assert!(matches!(
                params.limits(),
                Err(CheckError::BadLimit { name: "max_permille", .. })
            ));
        }
        assert!(typed(&["--max-permille", "nan"]).is_err());
    }
}
