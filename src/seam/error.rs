//! Why there is no such seam set.

use crate::code::codes;
use crate::mesh::{EdgeId, VertexId};
use crate::units::counted;

/// Why folds or seams of the wanted kind cannot be given.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SeamError {
    /// The mesh has no edge.
    #[error("the mesh has no edges, so there is nothing to fold; give a closed mesh")]
    Empty,
    /// The mesh is open.
    #[error(
        "the mesh is open: it has {}, one of them at edge {edge}; folds that meet every vertex \
        once need a closed mesh, close it first",
        counted(*holes, "rim", "rims")
    )]
    Open {
        /// Number of rims.
        holes: usize,
        /// The lowest edge on a rim.
        edge: EdgeId,
    },
    /// A vertex has another valence than 3.
    #[error(
        "vertex {vertex} has valence {valence}, and so {} another valence than 3; cut the vertices \
        that are `!valence=3` to make the mesh 3-valent",
        counted(*count, "vertex in all has", "vertices in all have")
    )]
    Valence {
        /// The lowest such vertex.
        vertex: VertexId,
        /// Its valence.
        valence: usize,
        /// How many such vertices there are.
        count: usize,
    },
    /// No choice of folds meets every vertex exactly once.
    #[error(
        "no folds meet every vertex exactly once: without the {} {} the mesh falls into \
        {odd_parts} parts with an odd number of vertices; change the mesh there (in a 3-valent \
        mesh: remove the bridges)",
        counted(barrier.len(), "vertex", "vertices"),
        Listed(barrier)
    )]
    NoMatching {
        /// Vertices whose removal leaves more odd parts than vertices were removed (Tutte's
        /// condition), ascending.
        barrier: Vec<VertexId>,
        /// How many odd parts are left.
        odd_parts: usize,
    },
    /// More choices of folds than the caller wants to list.
    #[error(
        "the mesh has more than {limit} choices of folds, too many to list; take `matching` (the \
        least) or `hamiltonian`, \
         or choose on a coarser mesh"
    )]
    TooMany {
        /// The most that would have been listed.
        limit: usize,
    },
    /// A row that the table of matchings does not have.
    #[error("there is no matching:{index}; up to symmetry the mesh has {count}, numbered from 0")]
    NoSuchMatching {
        /// The row asked for.
        index: usize,
        /// Number of rows.
        count: usize,
    },
    /// The mesh has several components.
    #[error(
        "the mesh has {count} components (the second begins at vertex {vertex}), and no single \
        seam runs through all; take \
         them one by one"
    )]
    SeveralComponents {
        /// How many there are.
        count: usize,
        /// The lowest vertex of the second.
        vertex: VertexId,
    },
    /// No closed seam runs through every vertex once.
    #[error(
        "no two-piece seam exists: no closed seam runs through every vertex once ({proof}); take \
        `matching` for more \
         pieces"
    )]
    NoHamiltonian {
        /// How that was shown.
        proof: NoHamiltonian,
    },
    /// One piece was asked for on a surface on which every closed seam separates.
    #[error(
        "no one-piece D-form exists of a mesh without handles: every closed seam separates it into \
        two pieces at least \
         (Jordan); take `hamiltonian`, or a mesh of genus 1 or more"
    )]
    NoHandle,
    /// All choices of folds that were looked at leave several pieces.
    #[error(
        "none of the {tried} choices of folds that were looked at leaves one piece; take \
        `hamiltonian` or `least`"
    )]
    NoOnePiece {
        /// How many were looked at.
        tried: usize,
    },
    /// The user cancelled before there was anything to return.
    #[error("stopped on request, before a choice of folds was found")]
    Cancelled,
    /// The search for a two-piece seam used up its work.
    #[error(
        "no two-piece seam was found with {conflicts} conflicts, nor was it shown that there is \
        none; take `matching`, or \
         choose the seam on a coarser mesh and cut its edges"
    )]
    SearchStopped {
        /// How many conflicts were granted.
        conflicts: u64,
    },
}

codes!(error SeamError {
    Empty = 401,
    Open = 402,
    Valence = 403,
    NoMatching = 404,
    TooMany = 405,
    NoSuchMatching = 406,
    SeveralComponents = 407,
    NoHamiltonian = 408,
    NoHandle = 409,
    NoOnePiece = 410,
    Cancelled = 411,
    SearchStopped = 412,
});

/// The first ids of a list, for messages.
pub(super) struct Listed<'a, T>(pub &'a [T]);

impl<T: std::fmt::Display> std::fmt::Display for Listed<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const SHOWN: usize = 10;
        f.write_str("[")?;
        for (i, item) in self.0.iter().take(SHOWN).enumerate() {
            write!(f, "{}{item}", if i > 0 { ", " } else { "" })?;
        }
        f.write_str(if self.0.len() > SHOWN { ", …]" } else { "]" })
    }
}

/// How it was shown that no seam runs through all vertices once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoHamiltonian {
    /// All choices of folds were listed.
    Listed {
        /// How many there are.
        matchings: usize,
        /// The fewest closed seams that any of them leaves.
        fewest_cycles: usize,
    },
    /// The clauses contradict each other: one fold a vertex, one fold a face, no seam closed too
    /// early, and what the caller forbade.
    Contradiction {
        /// How many closed seams had to be forbidden one by one.
        cycles: usize,
        /// How many sets of folds the caller forbade.
        forbidden: usize,
        /// How many conflicts the solver met.
        conflicts: u64,
    },
}

impl std::fmt::Display for NoHamiltonian {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Listed { matchings, fewest_cycles } => {
                write!(
                    f,
                    "each of the {matchings} choices of folds leaves at least {fewest_cycles} \
                    closed seams"
                )
            }
            Self::Contradiction { cycles, conflicts, .. } => {
                write!(
                    f,
                    "after forbidding {cycles} closed seams nothing is left ({conflicts} conflicts)"
                )
            }
        }
    }
}
