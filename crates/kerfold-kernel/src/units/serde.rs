//! Quantities in recipes and files: bare numbers, or text with units.

use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Angle, Direction, Length, Point, UnitError};

impl Serialize for Length {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for Angle {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A quantity in a recipe: a bare number, or text with a unit.
#[derive(Deserialize)]
#[serde(untagged)]
enum Typed {
    Number(f64),
    Text(String),
}

impl Typed {
    fn read<T: FromStr<Err = UnitError>, E: serde::de::Error>(
        self,
        from_number: fn(f64) -> T,
    ) -> Result<T, E> {
        match self {
            Self::Number(n) => Ok(from_number(n)),
            Self::Text(text) => text.parse().map_err(E::custom),
        }
    }
}

impl<'de> Deserialize<'de> for Length {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Typed::deserialize(deserializer)?.read(Self::from_mm)
    }
}

impl<'de> Deserialize<'de> for Angle {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Typed::deserialize(deserializer)?.read(Self::from_degrees)
    }
}

/// Directions and points: three numbers, or text.
#[derive(Deserialize)]
#[serde(untagged)]
enum TypedInSpace {
    Numbers([f64; 3]),
    Text(String),
}

impl TypedInSpace {
    fn read<T: FromStr<Err = UnitError>, E: serde::de::Error>(
        self,
        from_vector: fn(DVec3) -> T,
    ) -> Result<T, E> {
        match self {
            Self::Numbers(n) => Ok(from_vector(DVec3::from_array(n))),
            Self::Text(text) => text.parse().map_err(E::custom),
        }
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        TypedInSpace::deserialize(deserializer)?.read(Self)
    }
}

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        TypedInSpace::deserialize(deserializer)?.read(Self)
    }
}
