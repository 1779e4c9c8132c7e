//! What a user says about a handle.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

use crate::mesh::FaceId;
use crate::units::{Angle, Length, UnitError};

/// How to make a handle. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct HandleParams {
    /// The face to begin at, and, if wanted, the corner that is joined first: `0` or `0:3`.
    #[arg(long, value_name = "FACE[:VERTEX]")]
    pub from: FaceCorner,
    /// The face to end at, and, if wanted, the corner that the first one is joined to; else the
    /// twist decides.
    #[arg(long, value_name = "FACE[:VERTEX]")]
    pub to: FaceCorner,
    /// How many segments, 1 to 10000.
    #[arg(long, default_value_t = default_segments())]
    #[serde(default = "default_segments")]
    pub segments: u32,
    /// Further faces that the handle joins, with corners if wanted: a tube from each face to one
    /// hub outside the model; with negative weights, or when the faces look all ways, tunnels that
    /// meet inside.
    #[arg(long, value_name = "FACE[:VERTEX],...", value_delimiter = ',')]
    #[serde(default)]
    pub also: Vec<FaceCorner>,
    /// Points that the axis runs through on its way from face to face: a file with `x,y,z` in each
    /// line, or an OBJ file with an `l` line; in a recipe the points themselves, too, in mm.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["weights", "also"])]
    #[serde(default)]
    pub axis: Option<HandleAxis>,
    /// How far the axis keeps to the normals at its two ends; negative for a hole. When left out,
    /// the distance of the centroids, or up to sixteen times as much where the handle would cross
    /// itself.
    #[arg(long, value_name = "LENGTH,LENGTH", allow_hyphen_values = true)]
    #[serde(default)]
    pub weights: Option<Weights>,
    /// How far the tube turns around its axis, as near as the corners allow; whole turns add up.
    #[arg(long, default_value = "0deg", allow_hyphen_values = true)]
    #[serde(default)]
    pub twist: Angle,
}

fn default_segments() -> u32 {
    5
}

impl HandleParams {
    /// The faces that the handle joins.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> {
        let all = [self.from, self.to].into_iter().chain(self.also.iter().copied());
        all.map(|corner| FaceId::new(corner.face as usize))
    }
}

/// A face and perhaps one of its corners, by ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceCorner {
    /// The face.
    pub face: u32,
    /// The vertex at the corner.
    pub vertex: Option<u32>,
}

impl FromStr for FaceCorner {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error = |_| UnitError {
            text: text.to_owned(),
            wanted: "a face and a vertex",
            example: "4 or 4:7",
        };
        let (face, vertex) =
            text.split_once(':').map_or((text, None), |(face, vertex)| (face, Some(vertex)));
        let vertex = vertex.map(|v| v.trim().parse().map_err(error)).transpose()?;
        Ok(Self { face: face.trim().parse().map_err(error)?, vertex })
    }
}

impl fmt::Display for FaceCorner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.face.fmt(f)?;
        self.vertex.map_or(Ok(()), |v| write!(f, ":{v}"))
    }
}

impl<'de> Deserialize<'de> for FaceCorner {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Typed {
            Id(u32),
            Text(String),
        }
        match Typed::deserialize(deserializer)? {
            Typed::Id(face) => Ok(Self { face, vertex: None }),
            Typed::Text(text) => text.parse().map_err(de::Error::custom),
        }
    }
}

/// How far the axis keeps to the normals: `30mm,30mm`, in mm unless a unit is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights(pub [Length; 2]);

impl FromStr for Weights {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error = || UnitError {
            text: text.to_owned(),
            wanted: "a pair of lengths",
            example: "30mm,-20mm",
        };
        let (a, b) = text.split_once(',').ok_or_else(error)?;
        Ok(Self([a.parse()?, b.parse()?]))
    }
}

impl fmt::Display for Weights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.0[0], self.0[1])
    }
}

impl<'de> Deserialize<'de> for Weights {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Typed {
            Pair([Length; 2]),
            Text(String),
        }
        match Typed::deserialize(deserializer)? {
            Typed::Pair(pair) => Ok(Self(pair)),
            Typed::Text(text) => text.parse().map_err(de::Error::custom),
        }
    }
}

/// The points that the axis of a handle runs through.
#[derive(Debug, Clone, PartialEq)]
pub enum HandleAxis {
    /// A file that holds them; it has to be read before the operator is called.
    File(PathBuf),
    /// The points in order, in mm, without the centroids of the two faces.
    Points(Vec<DVec3>),
}

impl FromStr for HandleAxis {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(Self::File(PathBuf::from(text)))
    }
}

impl<'de> Deserialize<'de> for HandleAxis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "the name of a file, or a list of points like [[0, 0, 50], [30, 0, 80]]"
        )]
        enum Typed {
            File(PathBuf),
            Points(Vec<[f64; 3]>),
        }
        Ok(match Typed::deserialize(deserializer)? {
            Typed::File(path) => Self::File(path),
            Typed::Points(points) => {
                Self::Points(points.into_iter().map(DVec3::from_array).collect())
            }
        })
    }
}
