//! The parameters of hulls.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, de};

use super::super::OpError;
use crate::units::UnitError;

/// How to make a hull. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct HullParams {
    /// Make the dual convex hull: one plane through each corner of the hull, with the mean normal
    /// of its faces there.
    #[arg(long)]
    #[serde(default)]
    pub dual: bool,
    /// Divide vertices where more than three planes meet, so that exactly three edges meet in each;
    /// planes there move inwards by at most 1/32768 of the size.
    #[arg(long)]
    #[serde(default)]
    pub simple: bool,
    /// Leave out the bounding box that a dual hull is intersected with; an open direction is then
    /// an error.
    #[arg(long, requires = "dual")]
    #[serde(default)]
    pub no_box: bool,
    /// Divide the points into this many slabs of equal height, each with its own hull; 1 to 10000.
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["by_group", "parts"])]
    #[serde(default)]
    pub clusters: Option<u32>,
    /// The axis across which the slabs lie.
    #[arg(long, value_enum, default_value_t = Axis::Y)]
    #[serde(default)]
    pub axis: Axis,
    /// Make one hull of each face group.
    #[arg(long, conflicts_with = "parts")]
    #[serde(default)]
    pub by_group: bool,
    /// Divide a concave closed model into at most this many nearly convex parts, each with its own
    /// hull; 1 to 1024.
    #[arg(long, value_name = "NUMBER")]
    #[serde(default)]
    pub parts: Option<u32>,
    /// How much the hull of a part may exceed the part before it is divided, as a share of the
    /// model's volume; in (0, 1].
    #[arg(long, default_value_t = default_concavity(), value_parser = crate::units::parse_number)]
    #[serde(default = "default_concavity")]
    pub concavity: f64,
    /// Also hand out the dual hull after its first planes, as in `1,20,all`; needs the box.
    #[arg(long, value_name = "LIST", requires = "dual", conflicts_with = "no_box")]
    #[serde(default)]
    pub steps: Option<HullStepList>,
}

fn default_concavity() -> f64 {
    0.01
}

impl Default for HullParams {
    /// The plain convex hull of all points.
    fn default() -> Self {
        Self {
            dual: false,
            simple: false,
            no_box: false,
            clusters: None,
            axis: Axis::default(),
            by_group: false,
            parts: None,
            concavity: default_concavity(),
            steps: None,
        }
    }
}

impl HullParams {
    /// The ranges, and what excludes each other; a recipe or a library call does not go through the
    /// command line's checks.
    pub(super) fn check(&self) -> Result<(), OpError> {
        let ways = [
            ("clusters", self.clusters.is_some()),
            ("by_group", self.by_group),
            ("parts", self.parts.is_some()),
        ];
        let given: Vec<&'static str> =
            ways.into_iter().filter(|way| way.1).map(|way| way.0).collect();
        if let [first, second, ..] = given[..] {
            return Err(OpError::Exclude { first, second });
        }
        for (what, count, limit) in
            [("clusters", self.clusters, 10_000), ("parts", self.parts, 1024)]
        {
            if let Some(count) = count.filter(|count| !(1..=limit).contains(count)) {
                return Err(OpError::CountOutOfRange { what, count, limit });
            }
        }
        if !(self.concavity > 0.0 && self.concavity <= 1.0) {
            return Err(OpError::ConcavityOutOfRange { concavity: self.concavity });
        }
        match (self.dual, self.no_box, &self.steps) {
            (false, _, Some(_)) => Err(OpError::Requires { what: "steps", needed: "dual" }),
            (false, true, _) => Err(OpError::Requires { what: "no_box", needed: "dual" }),
            (true, true, Some(_)) => Err(OpError::Exclude { first: "steps", second: "no_box" }),
            _ => Ok(()),
        }
    }
}

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    #[default]
    Y,
    /// The third coordinate.
    Z,
}

/// After how many planes the dual hull is to be handed out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HullStepChoice {
    /// After the first so many; 0 is the box.
    After(usize),
    /// After all.
    All,
}

impl HullStepChoice {
    /// The number of planes, without limit for all.
    pub fn planes(self) -> usize {
        match self {
            Self::After(planes) => planes,
            Self::All => usize::MAX,
        }
    }
}

/// Several steps, typed as `1,20,all`; in a recipe also a list.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct HullStepList(pub Vec<HullStepChoice>);

impl FromStr for HullStepChoice {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error =
            || UnitError { text: text.to_owned(), wanted: "a list of steps", example: "1,20,all" };
        match text.trim() {
            "all" => Ok(Self::All),
            number => number.parse().map(Self::After).map_err(|_| error()),
        }
    }
}

impl FromStr for HullStepList {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        text.split(',').map(str::parse).collect::<Result<_, _>>().map(Self)
    }
}

impl fmt::Display for HullStepChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::After(planes) => planes.fmt(f),
            Self::All => f.write_str("all"),
        }
    }
}

impl<'de> Deserialize<'de> for HullStepList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

/// Reads steps from a text, a number, or a list of both.
struct Reader;

impl<'de> de::Visitor<'de> for Reader {
    type Value = HullStepList;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("steps like \"1,20,all\", a number, or a list of both")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<HullStepList, E> {
        text.parse().map_err(E::custom)
    }

    fn visit_u64<E: de::Error>(self, planes: u64) -> Result<HullStepList, E> {
        Ok(HullStepList(vec![HullStepChoice::After(usize::try_from(planes).map_err(E::custom)?)]))
    }

    fn visit_i64<E: de::Error>(self, planes: i64) -> Result<HullStepList, E> {
        match u64::try_from(planes) {
            Ok(planes) => self.visit_u64(planes),
            Err(_) => Err(E::invalid_value(de::Unexpected::Signed(planes), &self)),
        }
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, mut list: A) -> Result<HullStepList, A::Error> {
        let mut steps = Vec::new();
        while let Some(HullStepList(more)) = list.next_element()? {
            steps.extend(more);
        }
        Ok(HullStepList(steps))
    }
}
