//! Lettering: single-stroke glyphs, where labels have room, and which seams share a number.

mod glyph;
mod label;
mod obstacle;
mod params;
mod piece;
mod stretch;

pub use glyph::{CAPITAL, Lettering, glyph, lettering};
pub use params::{Angles, Labels, LetterParams};
pub(super) use piece::PieceLettering;
pub use stretch::Stretch;
pub(super) use stretch::stretches;
