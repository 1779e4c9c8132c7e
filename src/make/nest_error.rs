//! Why files of pieces could not be nested.

use std::path::PathBuf;

use crate::code::codes;
use crate::io::artwork::ArtError;
use crate::io::order_json::OrderError;

/// A file of pieces that could not be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NestError {
    /// The file could not be read.
    #[error("{}: cannot be read: {error}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: std::io::Error,
    },
    /// What it says is not right.
    #[error("{}: {error}", path.display())]
    Order {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: OrderError,
    },
    /// A drawing that could not be read.
    #[error("{}: {error}", path.display())]
    Drawing {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: ArtError,
    },
    /// A drawing without outlines of pieces.
    #[error("{}: {why}", path.display())]
    NoOutlines {
        /// The file.
        path: PathBuf,
        /// Why not.
        why: String,
    },
    /// A number of copies out of range.
    #[error("quantity is {quantity}, but must be 1 to 10000")]
    Quantity {
        /// What it was.
        quantity: u32,
    },
}

codes!(error NestError {
    Unreadable = 721,
    Quantity = 722,
    NoOutlines = 723,
} through {
    Order.error,
    Drawing.error,
});
