//! Why a mesh could not be unfolded.

use super::ProofError;

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
    /// A face that is not flat enough to be laid flat without changing its edges.
    #[error(
        "face {face} is not planar: a corner lies {deviation:.3e} mm off its plane, {limit:.3e} mm are allowed; \
         see `check`, then `planarize` the mesh or triangulate the face"
    )]
    NotPlanar {
        /// The face.
        face: usize,
        /// Largest distance of a corner from the least-squares plane, in mm.
        deviation: f64,
        /// What is allowed, in mm.
        limit: f64,
    },
    /// A face whose sides cross or touch each other.
    #[error("the sides of face {face} cross each other; divide it into faces that are simple polygons")]
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
        "no net of {asked} piece(s) without overlap was found, only one of {found} (components: {components}); \
         raise --effort, try another --seed, or take --pieces auto"
    )]
    MorePieces {
        /// Pieces asked for.
        asked: usize,
        /// Pieces of the best net.
        found: usize,
        /// Connected parts of the mesh; no net has fewer pieces.
        components: usize,
    },
    /// More pieces were asked for than there are faces.
    #[error("{asked} pieces cannot be made of {faces} faces; ask for {faces} at most")]
    TooManyPieces {
        /// Pieces asked for.
        asked: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The net that was found did not pass its own proof. This is a fault of kerfold, not of the mesh.
    #[error("the net failed its proof, which is a fault of kerfold, please report it: {0}")]
    NotProven(#[from] ProofError),
}
