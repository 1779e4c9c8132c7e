//! The parsed form of a selection, and how it is written.

use std::cmp::Ordering;
use std::fmt;

use super::seams::Folds;
use crate::units::{Angle, Direction, Length};

/// An expression. Chains of `&` and `|` are flat, so that only brackets and `!` nest.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Expr {
    Atom(Atom),
    Not(Box<Expr>),
    And(Vec<Expr>),
    Or(Vec<Expr>),
}

/// One condition.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Atom {
    All,
    /// Runs of ids, both ends included.
    Ids(Vec<(u32, u32)>),
    Valence(Compare, u32),
    Sides(Compare, u32),
    Fold(Compare, Angle),
    Along(Direction, Angle),
    Above(Direction, Length),
    Below(Direction, Length),
    Normal(Direction, Angle),
    Group(String),
    Made,
    Strip,
    Folds(Folds),
}

/// How two numbers compare.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Compare {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Compare {
    /// All signs, the longer ones first, so that the first that fits is the one that was meant.
    pub(super) const SIGNS: [(&str, Self); 6] = [
        ("!=", Self::NotEqual),
        ("<=", Self::LessOrEqual),
        (">=", Self::GreaterOrEqual),
        ("=", Self::Equal),
        ("<", Self::Less),
        (">", Self::Greater),
    ];

    /// Whether the comparison holds, when the measured number stands to the given one as `ordering`
    /// says.
    pub(super) fn holds(self, ordering: Ordering) -> bool {
        match self {
            Self::Equal => ordering.is_eq(),
            Self::NotEqual => ordering.is_ne(),
            Self::Less => ordering.is_lt(),
            Self::LessOrEqual => ordering.is_le(),
            Self::Greater => ordering.is_gt(),
            Self::GreaterOrEqual => ordering.is_ge(),
        }
    }
}

impl fmt::Display for Compare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = Self::SIGNS.iter().find(|(_, compare)| compare == self);
        f.write_str(sign.expect("every comparison has a sign").0)
    }
}

impl fmt::Display for Atom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Ids(runs) => write_runs(f, runs),
            Self::Valence(compare, n) => write!(f, "valence{compare}{n}"),
            Self::Sides(compare, n) => write!(f, "sides{compare}{n}"),
            Self::Fold(compare, angle) => write!(f, "fold{compare}{angle}"),
            Self::Along(direction, angle) => write!(f, "along={direction}:{angle}"),
            Self::Above(direction, length) => write!(f, "above={direction}:{length}"),
            Self::Below(direction, length) => write!(f, "below={direction}:{length}"),
            Self::Normal(direction, angle) => write!(f, "normal={direction}:{angle}"),
            Self::Group(name) => write_group(f, name),
            Self::Made => f.write_str("made"),
            Self::Strip => f.write_str("strip"),
            Self::Folds(Folds::Least) => f.write_str("matching"),
            Self::Folds(Folds::Flattest) => f.write_str("flattest"),
            Self::Folds(Folds::Number(k)) => write!(f, "matching:{k}"),
            Self::Folds(Folds::TwoPieces) => f.write_str("hamiltonian"),
        }
    }
}

fn write_runs(f: &mut fmt::Formatter<'_>, runs: &[(u32, u32)]) -> fmt::Result {
    for (i, (first, last)) in runs.iter().enumerate() {
        f.write_str(if i == 0 { "" } else { "," })?;
        if first == last { write!(f, "{first}")? } else { write!(f, "{first}-{last}")? }
    }
    Ok(())
}

/// Quotes a name that would end early or lose its blanks.
fn write_group(f: &mut fmt::Formatter<'_>, name: &str) -> fmt::Result {
    let is_plain =
        name.trim() == name && !name.is_empty() && !name.contains(['&', '|', '(', ')', '"', '\'']);
    match name.contains('"') {
        _ if is_plain => write!(f, "group={name}"),
        true => write!(f, "group='{name}'"),
        false => write!(f, "group=\"{name}\""),
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Atom(atom) => atom.fmt(f),
            Self::Not(inner) => {
                write!(f, "!{}", Bracketed(inner, matches!(**inner, Self::And(_) | Self::Or(_))))
            }
            Self::And(parts) => {
                write_chain(f, parts, " & ", |part| matches!(part, Self::And(_) | Self::Or(_)))
            }
            Self::Or(parts) => write_chain(f, parts, " | ", |part| matches!(part, Self::Or(_))),
        }
    }
}

fn write_chain(
    f: &mut fmt::Formatter<'_>,
    parts: &[Expr],
    sign: &str,
    bracketed: fn(&Expr) -> bool,
) -> fmt::Result {
    for (i, part) in parts.iter().enumerate() {
        write!(f, "{}{}", if i == 0 { "" } else { sign }, Bracketed(part, bracketed(part)))?;
    }
    Ok(())
}

/// An expression, in brackets or not.
struct Bracketed<'a>(&'a Expr, bool);

impl fmt::Display for Bracketed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.1 { write!(f, "({})", self.0) } else { self.0.fmt(f) }
    }
}
