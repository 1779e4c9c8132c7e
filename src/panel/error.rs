//! What can go wrong between faces and plates.

use std::fmt;

use crate::check::short;
use crate::code::codes;
use crate::mesh::{EdgeId, FaceId, VertexId};

/// Why a mesh cannot be made of plates.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PanelError {
    /// A parameter outside its range.
    #[error("{name} is {value}, but must be {wanted} and finite")]
    OutOfRange {
        /// Which parameter.
        name: String,
        /// What it was.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A thickness for a group that the model does not have.
    #[error("there is no group `{group}` in the model; {}", groups(known))]
    UnknownGroup {
        /// What was asked for.
        group: String,
        /// The groups that there are.
        known: Vec<String>,
    },
    /// A face without a plane.
    #[error(
        "face {face} has no area, so it has no plane and no plate; remove it or weld its \
        neighbours over it"
    )]
    NoPlane {
        /// The face.
        face: FaceId,
    },
    /// Two faces that lie on each other.
    #[error(
        "the faces of edge {edge} lie on each other (dihedral angle {degrees:.3}°), so no plate of \
        any thickness fits between \
         them; move a vertex, or give the edge a butt joint (as `0-10:butt`)"
    )]
    KnifeEdge {
        /// The edge.
        edge: EdgeId,
        /// The dihedral angle.
        degrees: f64,
    },
    /// A face that runs back on itself.
    #[error(
        "face {face} turns back on itself at vertex {vertex}, so its plate has no corner there; \
        move the vertex"
    )]
    Spike {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Sides of a plate that run past each other.
    #[error("{}", collisions(found))]
    Collision {
        /// All of them, those with the least thickness first.
        found: Vec<Collision>,
    },
    /// Plates that take the same place.
    #[error("{}", overlaps(found))]
    Overlap {
        /// All of them.
        found: Vec<Overlap>,
    },
    /// Faces that are far from planar.
    #[error("{}", not_planar(found))]
    NotPlanar {
        /// All of them.
        found: Vec<NotPlanar>,
    },
    /// A body that is not closed.
    #[error(
        "the body of the plate of face {face} is not closed ({edges} of its edges have no \
        partner), so no file was written; this is a fault of kerfold, please report it with the \
        model"
    )]
    OpenBody {
        /// The face.
        face: FaceId,
        /// How many.
        edges: usize,
    },
    /// The user asked to stop.
    #[error("stopped before all plates were made; nothing was written")]
    Cancelled,
}

codes!(error PanelError {
    OutOfRange = 601,
    UnknownGroup = 602,
    NoPlane = 603,
    KnifeEdge = 604,
    Spike = 605,
    Collision = 606,
    Cancelled = 607,
    Overlap = 608,
    NotPlanar = 609,
    OpenBody = 610,
});

/// A place where the sides of one plate run past each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Collision {
    /// The face.
    pub face: FaceId,
    /// The edge that shrinks to nothing; `None` where sides cross that are no neighbours.
    pub edge: Option<EdgeId>,
    /// The thickness that was asked for, in mm.
    pub thickness: f64,
    /// The largest thickness of this plate that works, all others growing in proportion, in mm; 0
    /// when the gap alone is too wide.
    pub largest: f64,
}

/// Two plates that take the same place, and cannot be parted by cutting off corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Their faces.
    pub faces: [FaceId; 2],
    /// The vertex near which they do; `None` when they have none in common.
    pub vertex: Option<VertexId>,
    /// How much they share, in mm³.
    pub mm3: f64,
}

/// A face that is not planar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotPlanar {
    /// The face.
    pub face: FaceId,
    /// Largest distance of a corner from the face's best plane, in mm.
    pub mm: f64,
    /// What is allowed, in mm.
    pub limit: f64,
}

/// How many collisions a message lists before it only counts.
const LISTED: usize = 10;

fn collisions(found: &[Collision]) -> String {
    let text = listed(found);
    let share = found.iter().map(|c| c.largest / c.thickness).fold(f64::INFINITY, f64::min);
    let thickness =
        found.iter().find(|c| c.largest / c.thickness == share).map_or(0.0, |c| c.largest);
    let advice = if share <= 0.0 {
        "make the gap narrower, or merge short edges".to_owned()
    } else {
        format!(
            "the largest thickness that works everywhere is {} mm ({:.1} % of what was asked)",
            floor(thickness),
            100.0 * share
        )
    };
    format!("plates run into themselves: {text}; {advice}")
}

/// A few of many things, the rest counted.
fn listed<T: fmt::Display>(things: &[T]) -> String {
    let mut text: Vec<String> = things.iter().take(LISTED).map(T::to_string).collect();
    if things.len() > LISTED {
        text.push(format!("and {} more", things.len() - LISTED));
    }
    text.join("; ")
}

fn overlaps(found: &[Overlap]) -> String {
    format!(
        "plates run into each other and no corner can be cut off far enough: {}; make them \
        thinner, lay them on the other side of the model, or move its parts apart",
        listed(found)
    )
}

fn not_planar(found: &[NotPlanar]) -> String {
    format!(
        "faces are too far from planar for flat plates: {}; planarize the mesh or divide these \
        faces",
        listed(found)
    )
}

impl fmt::Display for Overlap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.faces;
        write!(f, "those of faces {a} and {b} share {} mm³", short(self.mm3))?;
        self.vertex.map_or(Ok(()), |v| write!(f, " at vertex {v}"))
    }
}

impl fmt::Display for NotPlanar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mm, limit) = (short(self.mm), short(self.limit));
        write!(
            f,
            "a corner of face {} lies {mm} mm off its plane, {limit} mm are allowed",
            self.face
        )
    }
}

impl fmt::Display for Collision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.edge {
            Some(edge) => write!(f, "edge {edge} of face {} vanishes", self.face)?,
            None => write!(f, "sides of face {} cross", self.face)?,
        }
        if self.largest > 0.0 {
            write!(f, " (at most {} mm)", floor(self.largest))
        } else {
            write!(f, " (the gap is too wide)")
        }
    }
}

/// Share of a solved thickness that may be rounding.
const ROUNDING: f64 = 1e-9;

/// Four significant digits, always less than the value, at which a side is nothing: what is advised
/// must work.
fn floor(value: f64) -> String {
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 12);
    let scale = 10f64.powi(digits);
    format!("{}", ((value * (1.0 - ROUNDING) * scale).ceil() - 1.0) / scale)
}

fn groups(known: &[String]) -> String {
    match known {
        [] => "it has no groups".to_owned(),
        _ => format!("its groups are {}", known.join(", ")),
    }
}
