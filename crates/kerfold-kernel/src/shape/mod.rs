//! Ready-made starting meshes.
//!
//! All are closed, look outwards (positive volume) and are centred at the origin; lengths in
//! millimetres. Vertices and faces come in a fixed order: solids from orbits of points
//! ([`platonic`], [`archimedean`]) have their faces in lexicographic order, each beginning at its
//! lowest vertex; the other families say theirs. The vertices of all but boxes count as computed,
//! not given ([`Mesh::is_given`]), because their coordinates are rounded from irrational numbers.

mod facade;
mod name;
mod random;
mod round;
mod uniform;

pub use facade::hexagonal_facade;
pub use name::{SolidName, solid_names};
pub use random::random_tangent_polytope;
pub use uniform::{Archimedean, Platonic};

use std::ops::RangeInclusive;

use glam::DVec3;

use crate::code::codes;
use crate::mesh::{BuildError, Mesh, VertexId};
use crate::units::Length;

/// Extent of a solid whose size nobody named, in mm.
const DEFAULT_SIZE: f64 = 100.0;
/// Lengths that can be built without overflow, in mm.
const LENGTHS: RangeInclusive<f64> = 1e-60..=1e60;
/// The largest N of prisms and antiprisms.
const MOST_SIDES: u32 = 100_000;
/// The largest N of geodesic spheres: five million triangles.
const FINEST_GEODESIC: u32 = 500;

/// How large a ready-made solid is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SolidSize {
    /// 100 mm along the axis on which it is longest; a box as large as its name says.
    #[default]
    Standard,
    /// Length of an edge, above 0; of the longest edge of a geodesic sphere. Not for boxes.
    Edge(Length),
    /// Largest extent along x, y or z, above 0. Not for boxes.
    Extent(Length),
}

impl SolidSize {
    /// The size that one of two options gives.
    ///
    /// # Errors
    /// [`ShapeError::EdgeAndSize`] when both are there.
    pub fn from_options(edge: Option<Length>, extent: Option<Length>) -> Result<Self, ShapeError> {
        match (edge, extent) {
            (Some(edge), Some(size)) => Err(ShapeError::EdgeAndSize { edge, size }),
            (Some(edge), None) => Ok(Self::Edge(edge)),
            (None, Some(extent)) => Ok(Self::Extent(extent)),
            (None, None) => Ok(Self::Standard),
        }
    }

    /// The length with the name that messages give it; none for the standard size.
    fn named_length(self) -> Option<(&'static str, Length)> {
        match self {
            Self::Standard => None,
            Self::Edge(length) => Some(("edge", length)),
            Self::Extent(length) => Some(("size", length)),
        }
    }
}

/// Why a solid cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// No such name.
    #[error("there is no solid called `{name}`; {}", hint(nearest.as_deref()))]
    UnknownName {
        /// What was typed.
        name: String,
        /// The nearest name that exists.
        nearest: Option<String>,
    },
    /// The number after the name is missing, no number, or out of range.
    #[error(
        "`{name}`: the number after `{family}-` goes from {least} to {greatest}, as in {example}"
    )]
    Number {
        /// What was typed.
        name: String,
        /// The word before the number.
        family: &'static str,
        /// The least number.
        least: u32,
        /// The greatest number.
        greatest: u32,
        /// A name to copy.
        example: &'static str,
    },
    /// The extents of a box are missing or not above zero.
    #[error("`{name}`: a box is named with its three extents, each above zero, as in box-60x40x20")]
    BoxExtents {
        /// What was typed.
        name: String,
    },
    /// Edge and size at once.
    #[error("edge ({edge}) and size ({size}) are both given; each fixes the scale, leave one out")]
    EdgeAndSize {
        /// The edge.
        edge: Length,
        /// The size.
        size: Length,
    },
    /// Edge or size for a box.
    #[error("`{name}` has its extents in its name; leave out {what}")]
    BoxIsSized {
        /// The box.
        name: SolidName,
        /// `edge` or `size`.
        what: &'static str,
    },
    /// A length that is not positive, or absurd.
    #[error(
        "the {what} is {length}; give a length above zero, like 40mm (1e-60 to 1e60 mm can be \
        built)"
    )]
    Length {
        /// `edge` or `size`.
        what: &'static str,
        /// What was given.
        length: Length,
    },
    /// The mesh could not be built.
    #[error("the solid cannot be built: {0}")]
    Build(#[from] BuildError),
}

codes!(error ShapeError {
    UnknownName = 271,
    Number = 272,
    BoxExtents = 273,
    EdgeAndSize = 274,
    BoxIsSized = 275,
    Length = 276,
} through {
    Build.0,
});

fn hint(nearest: Option<&str>) -> String {
    match nearest {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("the solids are {}", solid_names().collect::<Vec<_>>().join(", ")),
    }
}

/// Makes the ready-made solid of that name, centred at the origin and looking outwards.
///
/// # Errors
/// [`ShapeError`] when a length is not above zero, a box gets a second size, or a number in the
/// name is out of range.
///
/// ```
/// use kerfold_kernel::shape::{SolidSize, solid};
/// use kerfold_kernel::units::Length;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let ball = solid("soccer-ball".parse()?, SolidSize::Extent(Length::from_mm(300.0)))?;
/// assert_eq!((ball.vertex_count(), ball.edge_count(), ball.face_count()), (60, 90, 32));
/// # Ok(())
/// # }
/// ```
pub fn solid(name: SolidName, size: SolidSize) -> Result<Mesh, ShapeError> {
    // The reader of names knows all ranges; a name set by hand goes through it too.
    name.to_string().parse::<SolidName>()?;
    if let Some((what, length)) = size.named_length() {
        if let SolidName::Box(_) = name {
            return Err(ShapeError::BoxIsSized { name, what });
        }
        if !LENGTHS.contains(&length.mm()) {
            return Err(ShapeError::Length { what, length });
        }
    }
    if let SolidName::Box(extents) = name {
        return Ok(round::cuboid(DVec3::from_array(extents.map(Length::mm))).build(1.0, true)?);
    }
    let raw = raw(name);
    let scale = match size {
        SolidSize::Edge(edge) => edge.mm() / raw.longest_edge(),
        SolidSize::Extent(extent) => extent.mm() / raw.largest_extent(),
        SolidSize::Standard => DEFAULT_SIZE / raw.largest_extent(),
    };
    Ok(raw.build(scale, false)?)
}

fn raw(name: SolidName) -> Raw {
    match name {
        SolidName::Platonic(solid) => solid.raw(),
        SolidName::Archimedean(solid) => solid.raw(),
        SolidName::Prism(n) => round::prism(n as usize),
        SolidName::Antiprism(n) => round::antiprism(n as usize),
        SolidName::Geodesic(n) => round::geodesic(n as usize),
        SolidName::Box(extents) => round::cuboid(DVec3::from_array(extents.map(Length::mm))),
    }
}

/// A regular solid with the given edge length, in mm.
///
/// # Panics
/// When the edge is not a length above zero (1e-60 to 1e60 mm).
pub fn platonic(solid: Platonic, edge: f64) -> Mesh {
    with_edge(SolidName::Platonic(solid), edge)
}

/// A half-regular solid with the given edge length, in mm.
///
/// # Panics
/// As [`platonic`].
pub fn archimedean(solid: Archimedean, edge: f64) -> Mesh {
    with_edge(SolidName::Archimedean(solid), edge)
}

/// A tetrahedron with the given edge length, in mm. Panics as [`platonic`].
pub fn tetrahedron(edge: f64) -> Mesh {
    platonic(Platonic::Tetrahedron, edge)
}

/// A cube parallel to the axes with the given edge length, in mm. Panics as [`platonic`].
pub fn cube(edge: f64) -> Mesh {
    platonic(Platonic::Cube, edge)
}

/// An octahedron with the given edge length, in mm. Panics as [`platonic`].
pub fn octahedron(edge: f64) -> Mesh {
    platonic(Platonic::Octahedron, edge)
}

/// A dodecahedron with the given edge length, in mm. Panics as [`platonic`].
pub fn dodecahedron(edge: f64) -> Mesh {
    platonic(Platonic::Dodecahedron, edge)
}

/// An icosahedron with the given edge length, in mm. Panics as [`platonic`].
pub fn icosahedron(edge: f64) -> Mesh {
    platonic(Platonic::Icosahedron, edge)
}

/// A soccer ball, the truncated icosahedron, with the given edge length, in mm. Panics as
/// [`platonic`].
pub fn soccer_ball(edge: f64) -> Mesh {
    archimedean(Archimedean::TruncatedIcosahedron, edge)
}

/// A prism over a regular n-gon with square sides; its axis is z, one side lies towards −y. Lengths
/// in mm.
///
/// Vertices: the lower ring, then the upper one. Faces: the lower n-gon, the upper one, the sides.
///
/// # Panics
/// When n is not from 3 to 100000; and as [`platonic`].
pub fn prism(n: u32, edge: f64) -> Mesh {
    assert!((3..=MOST_SIDES).contains(&n), "a prism has 3 to {MOST_SIDES} sides, not {n}");
    with_edge(SolidName::Prism(n), edge)
}

/// An antiprism over a regular n-gon with equilateral triangles; its axis is z. Lengths in mm.
///
/// Vertices: the lower ring, then the upper one. Faces: the lower n-gon, the upper one, then the
/// triangles in turn.
///
/// # Panics
/// As [`prism`].
pub fn antiprism(n: u32, edge: f64) -> Mesh {
    assert!((3..=MOST_SIDES).contains(&n), "an antiprism has 3 to {MOST_SIDES} sides, not {n}");
    with_edge(SolidName::Antiprism(n), edge)
}

/// A class I geodesic sphere: an icosahedron whose edges are divided into `frequency` parts, its
/// points moved to the sphere of the given radius in mm. 20 · frequency² triangles in 20 blocks,
/// one for each face of the icosahedron.
///
/// # Panics
/// When the frequency is not from 1 to 500, or the radius not from 1e-60 to 1e60 mm.
pub fn geodesic(frequency: u32, radius: f64) -> Mesh {
    assert!(
        (1..=FINEST_GEODESIC).contains(&frequency),
        "a frequency goes from 1 to {FINEST_GEODESIC}, not {frequency}"
    );
    assert!(LENGTHS.contains(&radius), "a radius is a length above zero, not {radius} mm");
    raw(SolidName::Geodesic(frequency))
        .build(radius, false)
        .expect("geodesic spheres are sound at every radius")
}

/// A box with its extents along x, y and z, in mm. Vertex i has its high end on x, y, z where bit
/// 0, 1, 2 of i is set. Faces: below, above, front (−y), back, left (−x), right.
///
/// # Panics
/// When an extent is not a length above zero (1e-60 to 1e60 mm).
pub fn cuboid(extents: DVec3) -> Mesh {
    assert!(
        extents.to_array().iter().all(|l| LENGTHS.contains(l)),
        "extents are lengths above zero, not {extents} mm"
    );
    round::cuboid(extents).build(1.0, true).expect("boxes are sound at every size")
}

fn with_edge(name: SolidName, edge: f64) -> Mesh {
    solid(name, SolidSize::Edge(Length::from_mm(edge))).expect("an edge is a length above zero")
}

/// Points and faces at the scale at which they are simplest.
struct Raw {
    points: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
}

impl Raw {
    fn longest_edge(&self) -> f64 {
        let edges = self
            .faces
            .iter()
            .flat_map(|face| (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()])));
        edges
            .map(|(a, b)| self.points[a].distance_squared(self.points[b]))
            .fold(0.0, f64::max)
            .sqrt()
    }

    fn largest_extent(&self) -> f64 {
        let (low, high) = self
            .points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        (high - low).max_element()
    }

    fn build(self, scale: f64, is_given: bool) -> Result<Mesh, BuildError> {
        let mut mesh = Mesh::from_faces(self.points.iter().map(|&p| p * scale), self.faces)?;
        for v in (0..self.points.len()).map(VertexId::new) {
            mesh.set_position(v, mesh.position(v), is_given);
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests;
