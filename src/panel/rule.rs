//! Which kind of joint an edge gets, by its dihedral angle.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use serde::{Deserialize, Deserializer};

use crate::units::{UnitError, nearest_word, parse_number};

/// What the two plates of an edge do there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, ValueEnum)]
pub enum EdgeKind {
    /// Both end in the plane that bisects them.
    #[default]
    Mitre,
    /// The plate with the lower number runs through, the other one ends at its inner side.
    Butt,
    /// Both have fingers that reach through the other one; cut square.
    Finger,
    /// A mitre with a row of holes in both plates, opposite each other.
    Stitch,
    /// Cut square at the line where the plates touch, so that they can turn there, with a row of
    /// holes for the hinge.
    Hinge,
}

impl EdgeKind {
    /// Its name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mitre => "mitre",
            Self::Butt => "butt",
            Self::Finger => "finger",
            Self::Stitch => "stitch",
            Self::Hinge => "hinge",
        }
    }
}

/// Kinds of joints by ranges of the dihedral angle; outside of all ranges edges are mitred.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeRules {
    rules: Vec<Rule>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Rule {
    from: f64,
    to: f64,
    kind: EdgeKind,
}

impl EdgeRules {
    /// The same kind for all edges.
    pub fn all(kind: EdgeKind) -> Self {
        Self { rules: vec![Rule { from: 0.0, to: 360.0, kind }] }
    }

    /// The kind of an edge with a dihedral angle in degrees: of the first range that holds it, ends
    /// included.
    pub fn kind(&self, dihedral: f64) -> EdgeKind {
        let rule = self.rules.iter().find(|r| r.from <= dihedral && dihedral <= r.to);
        rule.map_or(EdgeKind::Mitre, |r| r.kind)
    }

    /// Whether some edge may be of this kind.
    pub fn has(&self, kind: EdgeKind) -> bool {
        self.rules.iter().any(|r| r.kind == kind)
    }
}

impl From<EdgeKind> for EdgeRules {
    fn from(kind: EdgeKind) -> Self {
        Self::all(kind)
    }
}

impl FromStr for EdgeRules {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        if let Ok(kind) = kind(text) {
            return Ok(Self::all(kind));
        }
        let rules = text.split(',').map(rule).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { rules })
    }
}

fn kind(text: &str) -> Result<EdgeKind, UnitError> {
    let names = EdgeKind::value_variants();
    let word = text.trim();
    // Joints of sheets are called in the plural (`--joint fingers`); both words mean the same.
    let is_called = |k: &EdgeKind| {
        let ending = word.strip_prefix(k.name());
        matches!(ending, Some("" | "s" | "es"))
    };
    names.iter().copied().find(is_called).ok_or_else(|| UnitError {
        text: text.to_owned(),
        wanted: "a kind of edge (mitre, butt, finger, stitch, hinge)",
        example: nearest_word(word, names.iter().map(|k| k.name()))
            .unwrap_or("mitre or 30-100:finger,100-180:stitch"),
    })
}

fn rule(text: &str) -> Result<Rule, UnitError> {
    let wrong = || UnitError {
        text: text.to_owned(),
        wanted: "a kind of edge (mitre, butt, finger, stitch, hinge), or a range of dihedral \
        angles with its kind",
        example: "mitre or 30-100:finger,100-180:stitch",
    };
    let (range, word) =
        text.split_once(':').ok_or_else(|| kind(text).map_or_else(|e| e, |_| wrong()))?;
    let (from, to) = range.split_once('-').ok_or_else(wrong)?;
    let degrees = |text: &str| {
        parse_number(text.trim().trim_end_matches("deg")).ok().filter(|d| (0.0..=360.0).contains(d))
    };
    let (from, to) =
        degrees(from).zip(degrees(to)).filter(|(from, to)| from < to).ok_or_else(wrong)?;
    Ok(Rule { from, to, kind: kind(word)? })
}

impl fmt::Display for EdgeRules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.rules.is_empty() {
            return f.write_str("mitre");
        }
        for (i, rule) in self.rules.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{}-{}:{}", rule.from, rule.to, rule.kind.name())?;
        }
        Ok(())
    }
}

impl<'de> Deserialize<'de> for EdgeRules {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_decide_and_everything_else_is_mitred() {
        let rules: EdgeRules = "30-100:finger, 100deg-180deg:stitch".parse().expect("rules");
        let kinds = [20.0, 30.0, 100.0, 100.1, 190.0].map(|d| rules.kind(d));
        assert_eq!(
            kinds,
            [
                EdgeKind::Mitre,
                EdgeKind::Finger,
                EdgeKind::Finger,
                EdgeKind::Stitch,
                EdgeKind::Mitre
            ]
        );
        assert!(rules.has(EdgeKind::Stitch) && !rules.has(EdgeKind::Butt));
        assert_eq!(rules.to_string().parse::<EdgeRules>().as_ref(), Ok(&rules));
        for (many, one) in [("fingers", "finger"), ("stitches", "stitch"), ("mitres", "mitre")] {
            let rules = |word: &str| word.parse::<EdgeRules>().expect("a kind");
            assert_eq!(rules(many), rules(one));
        }
        assert_eq!("butt".parse::<EdgeRules>().expect("a kind").kind(300.0), EdgeKind::Butt);
        assert_eq!(
            EdgeRules::default(),
            "mitre".parse::<EdgeRules>().map(|_| EdgeRules::default()).expect("a kind")
        );
    }

    #[test]
    fn mistakes_are_told_with_the_nearest_word() {
        let told = |text: &str| text.parse::<EdgeRules>().expect_err(text).to_string();
        assert!(told("fingr").contains("write it like finger"), "{}", told("fingr"));
        assert!(told("30-100:fingr").contains("finger"));
        for bad in ["", "30:finger", "100-30:finger", "30-400:finger", "a-b:butt", "30-100"] {
            assert!(!told(bad).is_empty());
        }
    }
}
