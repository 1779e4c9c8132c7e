//! What was rolled, and what limited it, as reports and errors tell it.

use std::fmt;

use crate::mesh::{EdgeId, FaceId};

/// An edge or a face that must stay what it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// An edge that must keep some of its length.
    Edge(EdgeId),
    /// A face with a corner that the roll would reach.
    Face(FaceId),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge(e) => write!(f, "edge {e}"),
            Self::Face(face) => write!(f, "face {face} up to one of its corners"),
        }
    }
}

/// A rolled edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RolledEdge {
    /// The edge, in the mesh before.
    pub edge: EdgeId,
    /// The radius at its end with the lower vertex number and at the other, in mm.
    pub radii: [f64; 2],
    /// How far from the edge the faces are touched at these ends, in mm.
    pub touch: [f64; 2],
    /// How many strips.
    pub strips: u32,
    /// The width of each at its narrower end, in mm.
    pub width: f64,
    /// The angle between neighbours, in degrees; of a cone a little less.
    pub fold_deg: f64,
}

/// What limits the largest radius.
#[derive(Debug, Clone, PartialEq)]
pub struct RollLimit {
    /// The place of which the least is left.
    pub place: Place,
    /// The edges whose rolls meet there.
    pub edges: Vec<EdgeId>,
    /// The radius, in mm.
    pub radius: f64,
    /// The share of the place that the rolls take.
    pub share: f64,
}
