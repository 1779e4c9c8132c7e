//! What a picture points out: elements in a signal colour, and the numbers of elements.

use glam::DVec3;

use crate::mesh::{EdgeId, FaceId, VertexId};

/// Elements of a mesh that a picture points out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Marks {
    /// Vertices, drawn as dots.
    pub vertices: Vec<VertexId>,
    /// Edges, drawn thick.
    pub edges: Vec<EdgeId>,
    /// Faces, coloured.
    pub faces: Vec<FaceId>,
}

/// To what a number belongs: it is written where that is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Owner {
    Vertex(VertexId),
    Edge([FaceId; 2]),
    Face(FaceId),
}

/// A number in the picture.
#[derive(Debug, Clone)]
pub(super) struct Tag {
    /// Its middle, in pixels, with the depth of what it stands on.
    pub place: DVec3,
    pub owner: Owner,
    pub text: String,
}
