//! Lettering: single-stroke glyphs, where labels have room, and which seams share a number.

mod glyph;
mod label;
mod obstacle;
mod params;
mod piece;

pub use glyph::{CAPITAL, Lettering, glyph, lettering, plain_lettering};
pub(super) use label::sheet_letter;
pub use params::{Angles, Labels, LetterParams};
pub(super) use piece::PieceLettering;
