//! Flat result types: pieces, outlines, folds, seams, rims and their proof, in millimetres; knows
//! no mesh.
//!
//! Frames: every piece has its own, with y up, seen from outside the model; faces run
//! counter-clockwise and are never mirrored. Faces, vertices and edges are named by their numbers
//! in the mesh file (`formats.md`), so these types need no mesh to be read.

use std::fmt;

use glam::DVec2;

/// A whole unfolding: what `pieces.json` holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Net {
    /// Factor from the mesh file's unit to millimetres.
    pub scale: f64,
    /// Vertices, edges and faces of the mesh.
    pub counts: MeshCounts,
    /// The connected flat parts.
    pub pieces: Vec<Piece>,
    /// Edges kept between two faces of one piece, ascending by edge.
    pub folds: Vec<Fold>,
    /// Opened edges, ascending by edge.
    pub seams: Vec<Seam>,
    /// Edges with one face only, ascending by edge.
    pub rims: Vec<NetRim>,
    /// What re-measuring the net against the mesh found.
    pub proof: Proof,
}

/// Vertices, edges and faces of the mesh that was unfolded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MeshCounts {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
}

/// A piece's number, counted from 0, shown as `P01`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PieceId(pub usize);

/// An edge's number in the mesh, counted from 0, shown as `E012`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeLabel(pub usize);

impl fmt::Display for PieceId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{:02}", self.0 + 1)
    }
}

impl fmt::Display for EdgeLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "E{:03}", self.0)
    }
}

/// A connected flat part. Never overlaps itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its name.
    pub id: PieceId,
    /// The boundary, counter-clockwise, without joints or kerf.
    pub outline: Vec<DVec2>,
    /// Boundaries of holes in the piece, clockwise.
    pub holes: Vec<Vec<DVec2>>,
    /// The faces, in the order in which they were laid down.
    pub faces: Vec<FlatFace>,
}

/// A face laid flat.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatFace {
    /// Its number in the mesh.
    pub face: usize,
    /// The numbers of its vertices, counter-clockwise.
    pub vertices: Vec<usize>,
    /// Its corners in the piece's frame, in the order of `vertices`.
    pub polygon: Vec<DVec2>,
}

impl FlatFace {
    /// A side's segment in the direction in which the face runs, counter-clockwise; `segment` runs
    /// from the vertex `edge[0]` to `edge[1]`. Nothing when these are no side of the face.
    pub fn side(&self, edge: [usize; 2], segment: Segment) -> Option<Segment> {
        let n = self.vertices.len();
        let runs =
            |from, to| (0..n).any(|i| self.vertices[i] == from && self.vertices[(i + 1) % n] == to);
        if runs(edge[0], edge[1]) {
            Some(segment)
        } else if runs(edge[1], edge[0]) {
            Some([segment[1], segment[0]])
        } else {
            None
        }
    }
}

/// Two points of a piece's frame.
pub type Segment = [DVec2; 2];

/// Which way a fold bends, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FoldKind {
    /// Convex: the faces bend away from the viewer.
    Mountain,
    /// Concave: the faces bend towards the viewer.
    Valley,
    /// The two faces lie in one plane.
    Flat,
}

/// An edge that stays together.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// The edge.
    pub id: EdgeLabel,
    /// Its two vertices.
    pub edge: [usize; 2],
    /// The piece that holds it.
    pub piece: PieceId,
    /// The faces on its two sides.
    pub faces: [usize; 2],
    /// Where it lies, from `edge[0]` to `edge[1]`.
    pub segment: Segment,
    /// Degrees that the faces turn against each other: 180° − dihedral angle; positive for a
    /// mountain.
    pub fold_angle: f64,
    /// Mountain or valley.
    pub kind: FoldKind,
}

/// An edge that was opened; its two sides are partners.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// The edge.
    pub id: EdgeLabel,
    /// Its two vertices.
    pub edge: [usize; 2],
    /// Its length on the mesh, in mm.
    pub length: f64,
    /// As for a fold, in degrees.
    pub fold_angle: f64,
    /// Where its two sides lie.
    pub sides: [SeamSide; 2],
}

/// One side of a seam.
#[derive(Debug, Clone, PartialEq)]
pub struct SeamSide {
    /// The piece.
    pub piece: PieceId,
    /// The face.
    pub face: usize,
    /// From the vertex `edge[0]` of the seam to `edge[1]`.
    pub segment: Segment,
}

/// An edge that has a face on one side only.
#[derive(Debug, Clone, PartialEq)]
pub struct NetRim {
    /// Its two vertices.
    pub edge: [usize; 2],
    /// The piece.
    pub piece: PieceId,
    /// The face.
    pub face: usize,
    /// From `edge[0]` to `edge[1]`.
    pub segment: Segment,
}

/// What independent re-measuring found; all three are zero up to rounding in a good net.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Proof {
    /// Largest difference between a distance of two corners of a face on the mesh and in the net,
    /// in mm.
    pub congruence_mm: f64,
    /// Largest distance between a vertex of the mesh and the same corner after folding the net back
    /// up, in mm.
    pub refold_mm: f64,
    /// Number of pairs of faces of one piece whose interiors overlap.
    pub overlaps: usize,
}
