//! What a picture points out: elements in a signal colour, and the numbers of elements.

use glam::DVec3;

use super::paint;
use crate::mesh::{EdgeId, FaceId, FaceMap, Mesh, VertexId};

/// Elements of a mesh that a picture points out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Marks {
    /// Vertices, drawn as dots.
    pub vertices: Vec<VertexId>,
    /// Edges, drawn thick.
    pub edges: Vec<EdgeId>,
    /// Faces, coloured.
    pub faces: Vec<FaceId>,
    /// Faces that stand for slicing planes, in blue.
    pub planes: Vec<FaceId>,
    /// Faces that stand for the sections of slicing planes, in a deeper blue.
    pub sections: Vec<FaceId>,
}

impl Marks {
    /// Gives what is pointed out its colours.
    pub(super) fn paint(&self, colours: &mut FaceMap<[u8; 3]>) {
        self.planes.iter().for_each(|&f| colours[f] = paint::PLANE);
        self.sections.iter().for_each(|&f| colours[f] = paint::SECTION);
        self.faces.iter().for_each(|&f| colours[f] = paint::MARKED);
    }

    /// How much each face is pointed out.
    pub(super) fn ranks(&self, mesh: &Mesh) -> FaceMap<Rank> {
        let mut ranks = FaceMap::filled(mesh.face_slots(), Rank::Plain);
        self.planes.iter().for_each(|&f| ranks[f] = Rank::Plane);
        self.sections.iter().for_each(|&f| ranks[f] = Rank::Section);
        self.faces.iter().for_each(|&f| ranks[f] = Rank::Marked);
        ranks
    }
}

/// How much a face is pointed out: in x-rays what is more so lies on what is less.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    Plain,
    Plane,
    Section,
    Marked,
}

impl Rank {
    /// How much of what lies behind it a face of an x-ray hides.
    pub fn cover(self) -> f32 {
        match self {
            Self::Plain => 0.0,
            Self::Plane => 0.35,
            Self::Section => 0.7,
            Self::Marked => 0.8,
        }
    }
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
