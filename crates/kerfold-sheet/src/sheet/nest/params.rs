//! How pieces are nested: what a sheet looks like, how pieces may be turned, and how long to
//! search.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use glam::DVec2;
use serde::{Deserialize, Deserializer};

use super::super::stock::SheetSize;
use crate::net::PieceId;
use crate::units::{Length, UnitError, parse_number};

/// Nesting, the part of the sheet options that says where pieces may lie.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct NestParams {
    /// At which angles pieces may lie: free, 90, 180, fixed, or grain:ANGLE for a grain at that
    /// angle in the piece, which is laid along the width of the sheet either way. Pieces are never
    /// mirrored
    #[arg(long, value_name = "TURN", default_value = "free")]
    #[serde(default)]
    pub rotations: Rotation,
    /// Angles of single pieces, like P03=fixed,P05-P07=90
    #[arg(long, value_name = "LIST", default_value = "")]
    #[serde(default)]
    pub rotate: RotationList,
    /// Pieces that must lie on one sheet, groups divided by semicolons, like P01,P02;P05-P07
    #[arg(long, value_name = "GROUPS", default_value = "")]
    #[serde(default)]
    pub together: GroupList,
    /// Sheets that are used up first, in this order, before those of the usual size:
    /// 300x200*2,450x450
    #[arg(long, value_name = "LIST", default_value = "")]
    #[serde(default)]
    pub stock: StockList,
    /// True outline of the sheets of the usual size, when they are no rectangles: corners
    /// x,y:x,y:x,y… from the lower left corner of the sheet. The margin is kept from it
    #[arg(long, value_name = "CORNERS", default_value = "")]
    #[serde(default)]
    pub sheet_outline: Corners,
    /// Places on sheets that cannot be used, as x,y:x,y for the corners of a box or x,y:x,y:x,y…
    /// for a polygon, divided by semicolons. 2@ before one means the second sheet only. The spacing
    /// is kept from them
    #[arg(long, value_name = "LIST", default_value = "")]
    #[serde(default)]
    pub defects: DefectList,
    /// Whether sheets are divided by straight cuts from edge to edge only, as glass is
    #[arg(
        long,
        value_enum,
        default_value = "off",
        num_args = 0..=1,
        default_missing_value = "on",
        require_equals = true
    )]
    #[serde(default)]
    pub guillotine: Guillotine,
    /// Whether parts may lie side to side and share straight lines, which are cut once; only
    /// without kerf. Where they do not touch they keep the spacing
    #[arg(
        long,
        value_enum,
        default_value = "off",
        num_args = 0..=1,
        default_missing_value = "on",
        require_equals = true
    )]
    #[serde(default)]
    pub common_line: CommonLine,
    /// How long to search for a better layout: about tenths of a second for a hundred pieces or
    /// more, less for few. 0 does not nest: boxes in rows, for tens of thousands of pieces
    #[arg(long, value_name = "N", default_value_t = DEFAULT_EFFORT)]
    #[serde(default = "default_effort")]
    pub nest_effort: u32,
    /// Which of the many searches; the same seed gives the same layout
    #[arg(long, value_name = "N", default_value_t = 0)]
    #[serde(default)]
    pub nest_seed: u64,
}

/// Little enough that a few pieces take no noticeable time.
const DEFAULT_EFFORT: u32 = 2;

fn default_effort() -> u32 {
    DEFAULT_EFFORT
}

impl Default for NestParams {
    fn default() -> Self {
        Self {
            rotations: Rotation::default(),
            rotate: RotationList::default(),
            together: GroupList::default(),
            stock: StockList::default(),
            sheet_outline: Corners::default(),
            defects: DefectList::default(),
            guillotine: Guillotine::default(),
            common_line: CommonLine::default(),
            nest_effort: DEFAULT_EFFORT,
            nest_seed: 0,
        }
    }
}

/// Whether every cut must go from edge to edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Guillotine {
    /// Pieces lie anyhow.
    #[default]
    Off,
    /// Straight cuts from edge to edge free the bounding box of every piece.
    On,
}

/// Whether parts may share lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CommonLine {
    /// Every part has lines of its own.
    #[default]
    Off,
    /// Parts lie side to side where they can; a line that two share is cut once.
    On,
}

/// At which angles a piece may lie.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Rotation {
    /// Any.
    #[default]
    Free,
    /// Multiples of 90°.
    Quarter,
    /// 0° and 180°.
    Half,
    /// As it is.
    Fixed,
    /// With the direction at this angle, in degrees in the piece's frame, along the width of the
    /// sheet, either way.
    Grain(f64),
}

impl Rotation {
    /// The angles in degrees; nothing when all are allowed.
    pub fn angles(self) -> Option<Vec<f64>> {
        match self {
            Self::Free => None,
            Self::Quarter => Some(vec![0.0, 90.0, 180.0, 270.0]),
            Self::Half => Some(vec![0.0, 180.0]),
            Self::Fixed => Some(vec![0.0]),
            Self::Grain(angle) => Some(
                [-angle, 180.0 - angle]
                    .map(|a| super::super::bounding_box::rounded(a.rem_euclid(360.0)))
                    .to_vec(),
            ),
        }
    }

    /// Whether the piece may lie at an angle in degrees, up to rounding.
    pub fn allows(self, angle: f64) -> bool {
        let near = |a: f64| (angle - a + 180.0).rem_euclid(360.0) - 180.0;
        self.angles().is_none_or(|all| all.iter().any(|&a| near(a).abs() < 1e-8))
    }
}

/// Angles of single pieces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RotationList(pub BTreeMap<PieceId, Rotation>);

/// Groups of pieces that share a sheet.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct GroupList(pub Vec<BTreeSet<PieceId>>);

impl GroupList {
    /// Adds a group. One that shares a piece with others makes one group with them.
    pub fn add(&mut self, mut members: BTreeSet<PieceId>) {
        self.0.retain(|group| {
            let is_shared = !group.is_disjoint(&members);
            members.extend(group.iter().filter(|_| is_shared));
            !is_shared
        });
        self.0.push(members);
    }
}

/// Sheets that are used up first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StockList(pub Vec<(SheetSize, usize)>);

/// Corners of a polygon, in mm; may be none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corners(pub Vec<DVec2>);

/// Places that cannot be used: the sheet counted from 0, or all, and the corners.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DefectList(pub Vec<(Option<usize>, Vec<DVec2>)>);

fn bad(text: &str, wanted: &'static str, example: &'static str) -> UnitError {
    UnitError { text: text.to_owned(), wanted, example }
}

fn entries(text: &str, by: char) -> impl Iterator<Item = &str> {
    text.split(by).map(str::trim).filter(|t| !t.is_empty())
}

/// Reads `P03` or `P05-P07`.
fn pieces(text: &str) -> Option<impl Iterator<Item = PieceId>> {
    const MOST: usize = 1_000_000;
    let one = |t: &str| t.trim().strip_prefix(['P', 'p'])?.parse::<usize>().ok()?.checked_sub(1);
    let (first, last) = match text.split_once('-') {
        Some((first, last)) => (one(first)?, one(last)?),
        None => (one(text)?, one(text)?),
    };
    (first <= last && last < MOST).then_some((first..=last).map(PieceId))
}

impl FromStr for Rotation {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let word = text.trim().to_ascii_lowercase();
        let grain = |t: &str| parse_number(t).ok().filter(|a| a.is_finite()).map(Self::Grain);
        let read = match word.as_str() {
            "free" => Some(Self::Free),
            "90" => Some(Self::Quarter),
            "180" => Some(Self::Half),
            "fixed" | "0" => Some(Self::Fixed),
            other => other.strip_prefix("grain:").and_then(grain),
        };
        read.ok_or_else(|| {
            bad(text, "how a piece may be turned", "free, 90, 180, fixed or grain:30")
        })
    }
}

impl fmt::Display for Rotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Free => f.write_str("free"),
            Self::Quarter => f.write_str("90"),
            Self::Half => f.write_str("180"),
            Self::Fixed => f.write_str("fixed"),
            Self::Grain(angle) => write!(f, "grain:{angle}"),
        }
    }
}

impl FromStr for RotationList {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let mut list = BTreeMap::new();
        for entry in entries(text, ',') {
            let wrong = || bad(entry, "pieces and how they may be turned", "P03=fixed,P05-P07=90");
            let (names, turn) = entry.split_once('=').ok_or_else(wrong)?;
            let turn: Rotation = turn.parse()?;
            list.extend(pieces(names).ok_or_else(wrong)?.map(|p| (p, turn)));
        }
        Ok(Self(list))
    }
}

impl FromStr for GroupList {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let mut groups = Self::default();
        for group in entries(text, ';') {
            let mut members = BTreeSet::new();
            for name in entries(group, ',') {
                members.extend(
                    pieces(name)
                        .ok_or_else(|| bad(name, "pieces to keep together", "P01,P02;P05-P07"))?,
                );
            }
            groups.add(members);
        }
        Ok(groups)
    }
}

impl FromStr for StockList {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        const MOST: usize = 10_000;
        let read = |entry: &str| {
            let (size, count) = entry.split_once('*').unwrap_or((entry, "1"));
            let count = count.trim().parse::<usize>().ok().filter(|&n| n > 0 && n <= MOST);
            let size: SheetSize = size.parse()?;
            match (size, count) {
                (SheetSize::Size { .. }, Some(count)) => Ok((size, count)),
                _ => Err(bad(entry, "sheets in stock", "300x200*2,450x450")),
            }
        };
        entries(text, ',').map(read).collect::<Result<_, _>>().map(Self)
    }
}

fn corners(text: &str) -> Option<Vec<DVec2>> {
    let number =
        |t: &str| t.trim().parse::<Length>().ok().map(Length::mm).filter(|v| v.is_finite());
    text.split(':')
        .map(|p| p.split_once(',').and_then(|(x, y)| Some(DVec2::new(number(x)?, number(y)?))))
        .collect()
}

impl FromStr for Corners {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        if text.trim().is_empty() {
            return Ok(Self::default());
        }
        let wrong =
            || bad(text, "corners of a polygon, at least three", "0,0:600,0:600,250:400,400:0,400");
        corners(text).filter(|c| c.len() > 2).map(Self).ok_or_else(wrong)
    }
}

impl FromStr for DefectList {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let read = |entry: &str| {
            let (sheet, rest) = match entry.split_once('@') {
                Some((sheet, rest)) => (
                    Some(
                        sheet
                            .trim()
                            .trim_start_matches('S')
                            .parse::<usize>()
                            .ok()?
                            .checked_sub(1)?,
                    ),
                    rest,
                ),
                None => (None, entry),
            };
            let corners = corners(rest)?;
            match corners[..] {
                [] | [_] => None,
                [a, b] => {
                    let (low, high) = (a.min(b), a.max(b));
                    Some((
                        sheet,
                        vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)],
                    ))
                }
                _ => Some((sheet, corners)),
            }
        };
        let wrong = |entry| {
            bad(entry, "a place that cannot be used", "100,100:120,130 or 2@50,50:80,50:60,90")
        };
        entries(text, ';')
            .map(|e| read(e).ok_or_else(|| wrong(e)))
            .collect::<Result<_, _>>()
            .map(Self)
    }
}

macro_rules! read_from_text {
    ($($name:ident),*) => {$(
        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
            }
        }
    )*};
}

read_from_text!(Rotation, RotationList, GroupList, StockList, Corners, DefectList);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_read() {
        let turns: RotationList = "P03=fixed, P05-P07=90".parse().expect("turns");
        assert_eq!(turns.0.len(), 4);
        assert_eq!(
            (turns.0[&PieceId(2)], turns.0[&PieceId(6)]),
            (Rotation::Fixed, Rotation::Quarter)
        );
        let groups: GroupList = "P01,P02;P05-P07;P02,P09".parse().expect("groups");
        assert_eq!(groups.0.iter().map(BTreeSet::len).collect::<Vec<_>>(), [3, 3]);
        let stock: StockList = "300x200*2, A4".parse().expect("stock");
        assert_eq!(
            stock.0,
            [(SheetSize::of_mm(300.0, 200.0), 2), (SheetSize::of_mm(210.0, 297.0), 1)]
        );
        let defects: DefectList = "20,30:10,10; 2@0,0:5cm,0:0,50".parse().expect("defects");
        assert_eq!(
            (defects.0[0].0, defects.0[0].1[0], defects.0[0].1.len()),
            (None, DVec2::splat(10.0), 4)
        );
        assert_eq!((defects.0[1].0, defects.0[1].1[1]), (Some(1), DVec2::new(50.0, 0.0)));
    }

    #[test]
    fn nonsense_is_refused_with_an_example() {
        let text = [
            "P3".parse::<RotationList>().expect_err("no turn").to_string(),
            "P3=45".parse::<RotationList>().expect_err("no such turn").to_string(),
            "grain:nan".parse::<Rotation>().expect_err("no angle").to_string(),
            "P05-P02".parse::<GroupList>().expect_err("backwards").to_string(),
            "300x200*0".parse::<StockList>().expect_err("none").to_string(),
            "none".parse::<StockList>().expect_err("no size").to_string(),
            "0,0:1,1".parse::<Corners>().expect_err("two").to_string(),
            "0@0,0:1,1".parse::<DefectList>().expect_err("sheet 0").to_string(),
            "0,0".parse::<DefectList>().expect_err("a point").to_string(),
        ];
        assert!(
            text.iter()
                .all(|t| t.contains("for example") || t.contains("like") || t.contains("e.g.")),
            "{text:#?}"
        );
    }

    #[test]
    fn a_grain_lies_along_the_width_either_way() {
        assert_eq!(Rotation::Grain(30.0).angles(), Some(vec![330.0, 150.0]));
        assert!(Rotation::Grain(30.0).allows(-30.0) && !Rotation::Grain(30.0).allows(30.0));
        assert!(Rotation::Quarter.allows(359.999_999_999_9) && !Rotation::Half.allows(90.0));
    }
}
