//! Lettering: single-stroke glyphs, where labels have room, and which seams share a number.

mod glyph;
mod label;
mod stretch;

pub use glyph::{CAPITAL, Lettering, glyph, lettering};
pub use stretch::Stretch;

#[cfg(test)]
pub(super) use label::borders_meet;
pub(super) use label::{
    Label, Taken, is_clear, name_label, number_across, number_label, segments_meet,
};
pub(super) use stretch::stretches;
