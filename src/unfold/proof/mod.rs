//! The proof of a net: measured against the mesh by code that shares nothing with the unfolder but
//! the types.
//!
//! Five questions, each answered by its own method: is everything there once (structure), is every
//! face and every edge as large as on the mesh (congruence), do two faces of a piece share area
//! (overlap), do the pieces fold back up into the mesh from nothing but their own folds and angles
//! (refold), and are the angles of seams and the names of folds those of the mesh (angles).

mod angles;
mod congruence;
mod overlap;
mod refold;
mod renumber;
mod structure;

pub use renumber::renumbered;

use crate::code::codes;
use crate::mesh::Mesh;
use crate::net::{Net, Proof};

/// Sides of one edge may differ by this much of their length (plus as much of the model's size, for
/// rounding).
pub const LENGTH: f64 = 1e-9;
/// Distances may differ by this much of the model's size: what flattening may cost when all faces
/// are planar.
const LENGTH_OF_SIZE: f64 = 1e-9;
/// A refolded corner may miss its vertex by this much of the model's size when all faces are
/// planar.
pub const REFOLD: f64 = 1e-6;

/// What is wrong with a net. Faces, vertices and edges are named by their numbers in the mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProofError {
    /// The net was made of another mesh.
    #[error("the net counts {net} {what}, the mesh has {mesh}; take the mesh that was unfolded")]
    Counts {
        /// What is counted.
        what: &'static str,
        /// In the net.
        net: usize,
        /// In the mesh.
        mesh: usize,
    },
    /// A face that is in no piece or in several.
    #[error("face {face} is in {times} pieces; every face of the mesh must be in exactly one")]
    FaceTimes {
        /// The face.
        face: usize,
        /// In how many pieces.
        times: usize,
    },
    /// A face whose corners are not those of the mesh.
    #[error("face {face} of the net has other corners than on the mesh")]
    Corners {
        /// The face.
        face: usize,
    },
    /// An edge that is listed wrongly.
    #[error("edge {edge} between the vertices {} and {}: {fault}", ends[0], ends[1])]
    Edge {
        /// The edge.
        edge: usize,
        /// Its ends, as the net names them.
        ends: [usize; 2],
        /// What is wrong.
        fault: EdgeFault,
    },
    /// A rim that the mesh does not have.
    #[error("there is no rim from vertex {} to vertex {} on face {face}", edge[0], edge[1])]
    NetRim {
        /// Its ends.
        edge: [usize; 2],
        /// Its face.
        face: usize,
    },
    /// A face that was laid down mirrored or without area.
    #[error(
        "face {face} of piece {piece} lies mirrored or without area ({area:.3e} mm²); corners must \
        run counter-clockwise{}",
        if *whole { ", and so do all faces of this piece: turn the piece over" } else { "" }
    )]
    Mirrored {
        /// The piece, counted from 1 as in its name.
        piece: usize,
        /// The face.
        face: usize,
        /// Its area, negative when it is mirrored.
        area: f64,
        /// Whether all faces of the piece lie so.
        whole: bool,
    },
    /// A piece whose outline and holes are not the boundary of its faces.
    #[error("the outline of piece {piece} is not the boundary of its faces near ({x}, {y})")]
    Outline {
        /// The piece, counted from 1 as in its name.
        piece: usize,
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
    /// A face that is not congruent to the face of the mesh.
    #[error(
        "face {face} is distorted: two corners are {by:.3e} mm nearer or farther than on the mesh \
        ({limit:.3e} allowed)"
    )]
    Distorted {
        /// The face.
        face: usize,
        /// By how much, in mm.
        by: f64,
        /// Allowed, in mm.
        limit: f64,
    },
    /// Two sides of one edge with different lengths.
    #[error(
        "the sides of edge {edge} between the vertices {} and {} differ from it by {by:.3e} mm \
        ({limit:.3e} allowed)",
        ends[0], ends[1]
    )]
    Partners {
        /// The edge.
        edge: usize,
        /// Its ends.
        ends: [usize; 2],
        /// By how much, in mm.
        by: f64,
        /// Allowed, in mm.
        limit: f64,
    },
    /// Two faces of a piece share area.
    #[error(
        "faces {} and {} overlap in piece {piece} ({pairs} overlapping pairs in all)",
        faces[0],
        faces[1]
    )]
    Overlap {
        /// The piece, counted from 1 as in its name.
        piece: usize,
        /// The first pair.
        faces: [usize; 2],
        /// Number of pairs.
        pairs: usize,
    },
    /// A piece whose faces are not connected by its folds.
    #[error("face {face} is not connected with the rest of piece {piece} by folds")]
    Loose {
        /// The piece, counted from 1 as in its name.
        piece: usize,
        /// The face.
        face: usize,
    },
    /// The net does not fold back into the mesh.
    #[error(
        "folded back up, face {face} misses vertex {vertex} by {by:.3e} mm ({limit:.3e} allowed)"
    )]
    Refold {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
        /// By how much, in mm.
        by: f64,
        /// Allowed, in mm.
        limit: f64,
    },
}

codes!(finding ProofError {
    Counts = 401,
    FaceTimes = 402,
    Corners = 403,
    NetRim = 404,
    Mirrored = 405,
    Outline = 406,
    Distorted = 407,
    Partners = 408,
    Overlap = 409,
    Loose = 410,
    Refold = 411,
} through {
    Edge.fault,
});

/// What is wrong with an edge of a net.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EdgeFault {
    /// The mesh does not have it.
    #[error("the mesh does not have it")]
    Unknown,
    /// Listed twice.
    #[error("it is listed twice; it must be listed exactly once among folds, seams and rims")]
    Times,
    /// Not listed.
    #[error(
        "it is neither fold nor seam nor rim; it must be listed, it parts the faces {} and {}",
        faces[0],
        faces[1]
    )]
    Missing {
        /// The faces beside it (of a rim, the hole is one).
        faces: [usize; 2],
    },
    /// Its ends or faces are not those of the mesh.
    #[error("its vertices or faces are not those of the mesh")]
    Neighbours,
    /// A fold or side names a piece that does not hold the face.
    #[error("it names a piece that does not hold its face")]
    Piece,
    /// Its segment is not a side of the face it names.
    #[error("its segment is {by:.3e} mm away from the side of face {face}")]
    Segment {
        /// The face.
        face: usize,
        /// How far an end of the segment lies from the nearest side of the face between these
        /// vertices, in mm; not a number when the face has no such side.
        by: f64,
    },
    /// Its angle is not that between the faces of the mesh.
    #[error(
        "its fold angle is {given}°, on the mesh it is {angle}°; correct it (180° less the \
        dihedral angle, positive for a mountain)"
    )]
    Angle {
        /// What the net says, in degrees.
        given: f64,
        /// On the mesh, in degrees.
        angle: f64,
    },
    /// A fold that is named against its angle.
    #[error(
        "it is called {named} and folds by {angle}°; above 0° it is a mountain, below a valley"
    )]
    Kind {
        /// What it is called.
        named: &'static str,
        /// On the mesh, in degrees.
        angle: f64,
    },
}

codes!(finding EdgeFault {
    Unknown = 421,
    Times = 422,
    Missing = 423,
    Neighbours = 424,
    Piece = 425,
    Segment = 426,
    Angle = 427,
    Kind = 428,
});

/// Measures a net against the mesh that it was made of.
///
/// # Errors
/// The first fault, in the order structure, congruence, overlap, refold, angles;
/// see [`ProofError`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(40.0);
/// let source = MeshSource { scale: 1.0, split_vertices: &[] };
/// let mut net = unfold(&cube, &Seams::Free, &UnfoldParams::default(), &source, &Silent)?;
/// assert_eq!(prove(&cube, &net)?.overlaps, 0);
/// net.pieces[0].faces[0].polygon[0].x += 1.0;
/// assert!(prove(&cube, &net).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn prove(mesh: &Mesh, net: &Net) -> Result<Proof, ProofError> {
    let size = size(mesh);
    structure::check(mesh, net, size)?;
    // Side by side; what is told first does not depend on which is done first.
    let flat = || (congruence::check(mesh, net, size), overlap::check(net, size));
    let closed = || (refold::check(mesh, net, size), angles::check(mesh, net, size));
    let ((congruence, overlap), (refold, angles)) = rayon::join(flat, closed);
    let congruence_mm = congruence?;
    overlap?;
    let refold_mm = refold?;
    angles?;
    Ok(Proof { congruence_mm, refold_mm, overlaps: 0 })
}

/// Whether a measure is beyond its limit; NaN always is.
fn exceeds(by: f64, limit: f64) -> bool {
    by > limit || by.is_nan()
}

/// The model's size: its box's diagonal, with a share of the distance from the origin, where
/// coordinates are coarser.
fn size(mesh: &Mesh) -> f64 {
    mesh.bounds().map_or(0.0, |(low, high)| {
        (high - low).length() + low.abs().max(high.abs()).max_element() / 256.0
    })
}

#[cfg(test)]
mod tests;
