//! Names of solids: `cube`, `soccer-ball`, `prism-7`, `geodesic-4`, `box-60x40x20`.

use std::fmt;
use std::str::FromStr;

use super::{Archimedean, Platonic, ShapeError};
use crate::units::{Length, nearest_word};

/// Which solid. Written in kebab-case; capitals and `_` or spaces for `-` are read too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolidName {
    /// One of the five regular solids.
    Platonic(Platonic),
    /// One of the thirteen half-regular solids.
    Archimedean(Archimedean),
    /// `prism-N`: two N-gons and N squares, N from 3 to 100000.
    Prism(u32),
    /// `antiprism-N`: two N-gons and 2N triangles, N from 3 to 100000.
    Antiprism(u32),
    /// `geodesic-N`: an icosahedron whose edges are divided into N, blown up to a sphere; N from 1
    /// to 500.
    Geodesic(u32),
    /// `box-AxBxC`: a box with its extents along x, y and z.
    Box([Length; 3]),
}

impl Platonic {
    /// The name in kebab-case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tetrahedron => "tetrahedron",
            Self::Cube => "cube",
            Self::Octahedron => "octahedron",
            Self::Dodecahedron => "dodecahedron",
            Self::Icosahedron => "icosahedron",
        }
    }
}

impl Archimedean {
    /// The name in kebab-case.
    pub fn name(self) -> &'static str {
        match self {
            Self::TruncatedTetrahedron => "truncated-tetrahedron",
            Self::Cuboctahedron => "cuboctahedron",
            Self::TruncatedCube => "truncated-cube",
            Self::TruncatedOctahedron => "truncated-octahedron",
            Self::Rhombicuboctahedron => "rhombicuboctahedron",
            Self::TruncatedCuboctahedron => "truncated-cuboctahedron",
            Self::SnubCube => "snub-cube",
            Self::Icosidodecahedron => "icosidodecahedron",
            Self::TruncatedDodecahedron => "truncated-dodecahedron",
            Self::TruncatedIcosahedron => "truncated-icosahedron",
            Self::Rhombicosidodecahedron => "rhombicosidodecahedron",
            Self::TruncatedIcosidodecahedron => "truncated-icosidodecahedron",
            Self::SnubDodecahedron => "snub-dodecahedron",
        }
    }
}

/// Other names in use, and what they stand for.
const ALIASES: [(&str, &str); 18] = [
    ("soccer-ball", "truncated-icosahedron"),
    ("football", "truncated-icosahedron"),
    ("buckyball", "truncated-icosahedron"),
    ("hexahedron", "cube"),
    ("small-rhombicuboctahedron", "rhombicuboctahedron"),
    ("great-rhombicuboctahedron", "truncated-cuboctahedron"),
    ("small-rhombicosidodecahedron", "rhombicosidodecahedron"),
    ("great-rhombicosidodecahedron", "truncated-icosidodecahedron"),
    ("snub-cuboctahedron", "snub-cube"),
    ("snub-icosidodecahedron", "snub-dodecahedron"),
    ("triangular-prism", "prism-3"),
    ("pentagonal-prism", "prism-5"),
    ("hexagonal-prism", "prism-6"),
    ("octagonal-prism", "prism-8"),
    ("square-antiprism", "antiprism-4"),
    ("pentagonal-antiprism", "antiprism-5"),
    ("hexagonal-antiprism", "antiprism-6"),
    ("octagonal-antiprism", "antiprism-8"),
];

/// The names with a number: the word, the least and the greatest number, and an example.
const FAMILIES: [(&str, u32, u32, &str); 3] = [
    ("prism", 3, super::MOST_SIDES, "prism-7"),
    ("antiprism", 3, super::MOST_SIDES, "antiprism-5"),
    ("geodesic", 1, super::FINEST_GEODESIC, "geodesic-4"),
];

const BOX_EXAMPLE: &str = "box-60x40x20";

/// All fixed names, the aliases after the solids themselves, and one example of each family
/// (`prism-7`, …): for help texts, completions and suggestions.
pub fn solid_names() -> impl Iterator<Item = &'static str> {
    let platonic = Platonic::ALL.into_iter().map(Platonic::name);
    let archimedean = Archimedean::ALL.into_iter().map(Archimedean::name);
    let families = FAMILIES.iter().map(|family| family.3).chain([BOX_EXAMPLE]);
    platonic.chain(archimedean).chain(families).chain(ALIASES.iter().map(|alias| alias.0))
}

impl FromStr for SolidName {
    type Err = ShapeError;

    fn from_str(text: &str) -> Result<Self, ShapeError> {
        let name = text.trim().to_lowercase().replace(['_', ' '], "-");
        let name =
            ALIASES.iter().find(|alias| alias.0 == name).map_or(name.as_str(), |alias| alias.1);
        if let Some(solid) = fixed(name) {
            return Ok(solid);
        }
        let (word, number) = name.split_once('-').unwrap_or((name, ""));
        if word == "box" {
            return box_name(text, number);
        }
        match FAMILIES.iter().find(|family| family.0 == word) {
            Some(&(family, least, greatest, example)) => {
                let n = number.parse().ok().filter(|n| (least..=greatest).contains(n));
                let n = n.ok_or_else(|| ShapeError::Number {
                    name: text.to_owned(),
                    family,
                    least,
                    greatest,
                    example,
                })?;
                Ok(match family {
                    "prism" => Self::Prism(n),
                    "antiprism" => Self::Antiprism(n),
                    _ => Self::Geodesic(n),
                })
            }
            None => Err(ShapeError::UnknownName { name: text.to_owned(), nearest: nearest(name) }),
        }
    }
}

fn fixed(name: &str) -> Option<SolidName> {
    let platonic =
        Platonic::ALL.into_iter().find(|solid| solid.name() == name).map(SolidName::Platonic);
    let archimedean = || {
        Archimedean::ALL.into_iter().find(|solid| solid.name() == name).map(SolidName::Archimedean)
    };
    platonic.or_else(archimedean)
}

fn box_name(text: &str, extents: &str) -> Result<SolidName, ShapeError> {
    let fault = || ShapeError::BoxExtents { name: text.to_owned() };
    let lengths: Result<Vec<Length>, _> = extents.split('x').map(str::parse).collect();
    let lengths: [Length; 3] = lengths.map_err(|_| fault())?.try_into().map_err(|_| fault())?;
    if lengths.iter().all(|l| super::LENGTHS.contains(&l.mm())) {
        Ok(SolidName::Box(lengths))
    } else {
        Err(fault())
    }
}

/// The nearest name; for a mistyped family (`prizm-6`) with the number kept.
fn nearest(name: &str) -> Option<String> {
    let whole =
        nearest_word(name, solid_names().filter(|known| *known != BOX_EXAMPLE)).map(str::to_owned);
    let family = || {
        let (word, number) = name.rsplit_once('-').filter(|(_, n)| n.parse::<u32>().is_ok())?;
        nearest_word(word, FAMILIES.iter().map(|family| family.0))
            .map(|family| format!("{family}-{number}"))
    };
    family().or(whole)
}

impl fmt::Display for SolidName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Platonic(solid) => f.write_str(solid.name()),
            Self::Archimedean(solid) => f.write_str(solid.name()),
            Self::Prism(n) => write!(f, "prism-{n}"),
            Self::Antiprism(n) => write!(f, "antiprism-{n}"),
            Self::Geodesic(n) => write!(f, "geodesic-{n}"),
            Self::Box([a, b, c]) => write!(f, "box-{}x{}x{}", a.mm(), b.mm(), c.mm()),
        }
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for SolidName {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(name: &str) -> String {
        name.parse::<SolidName>().expect_err(name).to_string()
    }

    #[test]
    fn every_listed_name_is_read_and_names_survive_a_round_trip() {
        for name in solid_names() {
            let solid: SolidName = name.parse().expect(name);
            assert_eq!(solid.to_string().parse::<SolidName>(), Ok(solid), "{name}");
        }
        assert_eq!(
            "Soccer Ball".parse(),
            Ok(SolidName::Archimedean(Archimedean::TruncatedIcosahedron))
        );
        assert_eq!("snub_cube".parse(), Ok(SolidName::Archimedean(Archimedean::SnubCube)));
        let boxed = SolidName::Box([60.0, 40.0, 25.4].map(Length::from_mm));
        assert_eq!("box-60x4cmx1in".parse(), Ok(boxed));
        assert_eq!(boxed.to_string(), "box-60x40x25.4");
    }

    #[test]
    fn mistyped_names_are_answered_with_the_nearest() {
        assert_eq!(
            message("dodecahedrn"),
            "there is no solid called `dodecahedrn`; did you mean `dodecahedron`?"
        );
        assert_eq!(
            message("prizm-6"),
            "there is no solid called `prizm-6`; did you mean `prism-6`?"
        );
        assert!(
            message("teapot").starts_with(
                "there is no solid called `teapot`; the solids are tetrahedron, cube, "
            )
        );
        assert!(message("").contains("the solids are"));
        assert_eq!(
            message("prism-2"),
            "`prism-2`: the number after `prism-` goes from 3 to 100000, as in prism-7"
        );
        assert!(message("geodesic").contains("geodesic-4"));
        assert!(message("prism-99999999999999999999").contains("100000"));
        for bad in ["box", "box-1x2", "box-1x2x0", "box-1x2x-3", "box-1x2x3x4", "box-axbxc"] {
            assert!(message(bad).contains("box-60x40x20"), "{bad}");
        }
    }
}
