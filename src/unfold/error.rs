//! Why a mesh could not be unfolded.

use super::ProofError;
use crate::check::{Breach, Profile};
use crate::code::codes;
use crate::seam::{NoHamiltonian, SeamError};

/// Why a mesh could not be unfolded. Faces and edges are named by their numbers in the mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UnfoldError {
    /// There is nothing to unfold.
    #[error("the mesh has no faces; there is nothing to unfold")]
    NoFaces,
    /// A face whose corners all lie on a line.
    #[error("face {face} has no area; remove it or weld its neighbours over it")]
    FaceWithoutArea {
        /// The face.
        face: usize,
    },
    /// A face that `check` does not call planar.
    #[error(
        "face {face} is not planar: {:.3} {unit} off, the profile {profile} allows {} {unit}; see \
        `check`, then `planarize` the mesh or triangulate the face",
        breach.measured, breach.limit, unit = breach.unit
    )]
    NotPlanar {
        /// The face.
        face: usize,
        /// Whose limits were broken.
        profile: Profile,
        /// By how much.
        breach: Breach,
    },
    /// A face whose sides cross or touch each other.
    #[error(
        "the sides of face {face} cross each other; divide it into faces that are simple polygons"
    )]
    FaceNotSimple {
        /// The face.
        face: usize,
    },
    /// A face that lies on both sides of an edge.
    #[error("face {face} lies on both sides of edge {edge}; delete the edge or divide the face")]
    FaceMeetsItself {
        /// The face.
        face: usize,
        /// The edge.
        edge: usize,
    },
    /// A seam or fold was asked for at an edge that the mesh does not have.
    #[error("there is no edge {edge} to open or to fold; the mesh has {count} edges")]
    UnknownEdge {
        /// The number asked for.
        edge: usize,
        /// Number of edges.
        count: usize,
    },
    /// The search ended with more pieces than asked for.
    #[error(
        "no net of {asked} piece(s) without overlap was found, only one of {found} (components: \
        {components}); tried were \
         {starts} first nets, {moves} moves of branches and {joins} joins of pieces; raise the \
         effort, try another seed, or let the number of pieces be automatic"
    )]
    MorePieces {
        /// Pieces asked for.
        asked: usize,
        /// Pieces of the best net.
        found: usize,
        /// Connected parts of the mesh; no net has fewer pieces.
        components: usize,
        /// Spanning forests that were laid to start from.
        starts: usize,
        /// Moves of branches that were looked for.
        moves: u64,
        /// Joins of pieces that were tried.
        joins: usize,
    },
    /// No choice of seams makes two pieces.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// Seams of two pieces exist, but with each of them a piece overlaps itself.
    #[error(
        "no two-piece seam lies flat without overlap: {overlapping} seams were laid out and \
        overlap, and what was learnt \
         from them leaves no other ({proof}); let the number of pieces be automatic"
    )]
    NoFlatTwoPieces {
        /// Seams that were laid out.
        overlapping: usize,
        /// How it was shown that there is no other.
        proof: NoHamiltonian,
    },
    /// Edges to keep that had to open.
    #[error(
        "edges {edges:?} cannot all stay together: their faces would overlap or surround a vertex \
        that is not flat; keep fewer"
    )]
    NotKept {
        /// The edges that opened, ascending.
        edges: Vec<usize>,
    },
    /// Edges to keep and to cut at once.
    #[error(
        "edges {edges:?} are both to be kept and to be cut; leave them out of one of the two lists"
    )]
    KeptAndCut {
        /// The edges.
        edges: Vec<usize>,
    },
    /// Vertices that no given seam reaches though the faces around them cannot lie flat.
    #[error(
        "too few seams: the faces around vertices {vertices:?} cannot lie flat together; lead a \
        seam to each of them, or \
         leave the seams to the unfolder"
    )]
    ConePoints {
        /// The vertices, ascending.
        vertices: Vec<usize>,
    },
    /// More pieces were asked for than there are faces.
    #[error("{asked} pieces cannot be made of {faces} faces; ask for {faces} at most")]
    TooManyPieces {
        /// Pieces asked for.
        asked: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The net that was found did not pass its own proof. This is a fault of kerfold, not of the
    /// mesh.
    #[error("the net failed its proof, which is a fault of kerfold, please report it: {0}")]
    NotProven(#[from] ProofError),
}

codes!(error UnfoldError {
    NoFaces = 421,
    FaceWithoutArea = 422,
    NotPlanar = 423,
    FaceNotSimple = 424,
    FaceMeetsItself = 425,
    UnknownEdge = 426,
    MorePieces = 427,
    NoFlatTwoPieces = 428,
    NotKept = 429,
    KeptAndCut = 430,
    ConePoints = 431,
    TooManyPieces = 432,
    NotProven = 433,
} through {
    Seam.0,
});
