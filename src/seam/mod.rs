//! Seam sets of a mesh as graphs: matchings, 2-factors, Hamiltonian cycles.
//!
//! In a closed 3-valent mesh the folds of a D-form meet every vertex exactly once: they are a
//! *perfect matching*, and the seams, two at every vertex, are disjoint closed cycles (a
//! *2-factor*; Petersen 1891: a cubic graph without a bridge has one). On a sphere the pieces
//! number cycles + 1, and two pieces mean one Hamiltonian cycle of seams.
//!
//! - [`least_matching`] finds the folds that bend least, exactly and for large meshes;
//!   [`flattest_matching`] weighs by angle alone.
//! - [`Matchings`], [`table`] and [`matching`] list all of them for small meshes, up to symmetry.
//! - [`TwoPieceSearch`] and [`hamiltonian_folds`] look for the seam of two pieces, or prove that
//!   there is none.
//! - [`two_piece_bound`] tells how good a two-piece seam is, by branch and bound.
//! - [`one_piece_folds`] finds, on surfaces with handles, the seams that leave one piece.
//! - [`edge_symmetries`] lists the symmetries of a mesh.
//! - [`seam_cycles`], [`piece_count`], [`piece_of_faces`] and [`is_perfect_matching`] show what a
//!   choice of folds means.

mod blossom;
mod bound;
mod enumerate;
mod error;
mod exchange;
mod factor;
mod graph;
mod hamiltonian;
mod least;
mod one_piece;
mod sat;
mod symmetry;
mod tour;
mod two_piece;
mod weight;

#[cfg(test)]
mod fixtures;

pub use bound::{TwoPieceBound, two_piece_bound};
pub use enumerate::{MATCHING_LIMIT, MatchingRow, Matchings, matching, table};
pub use error::{NoHamiltonian, SeamError};
pub use factor::{is_perfect_matching, piece_count, piece_of_faces, seam_cycles};
pub use hamiltonian::hamiltonian_folds;
pub use least::{flattest_matching, least_matching, least_matching_by};
pub use one_piece::one_piece_folds;
pub use symmetry::edge_symmetries;
pub use two_piece::TwoPieceSearch;
pub use weight::{fold_sum, fold_weight};
