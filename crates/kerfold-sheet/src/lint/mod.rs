//! Judges a drawing that is to be cut, anybody's, as a shop would: what it would send back, with
//! the place and what to do.
//!
//! The room knows lines with an operation and a layer, in millimetres; no file format and no net.
//! It shares nothing with `sheet` but the geometry of `geom`, so that it can judge our own sheets.

mod artwork;
mod contours;
mod features;
mod lines;
mod order;
mod pairs;
mod params;
mod report;

pub use artwork::{ArtPath, ArtText, Artwork, Operation, UnitState};
pub use params::{LimitError, LintParams, SheetLimit};
pub use report::{Check, LintFinding, LintReport};

use contours::Contours;
use pairs::Pairs;

/// Judges a drawing.
pub fn lint(artwork: &Artwork, params: &LintParams) -> LintReport {
    let mut report = LintReport::default();
    let lines = lines::join(artwork, params.gap.mm(), params.join());
    let contours = Contours::of(&lines, params.gap.mm());
    features::units(artwork, &mut report);
    features::texts(artwork, &mut report);
    features::size(artwork, &lines, params, &mut report);
    features::stray_points(artwork, &lines, &mut report);
    features::open_contours(&lines, &contours, params, &mut report);
    let pairs = Pairs::of(&lines, params.gap.mm(), params.web() + params.kerf());
    features::doubled(&lines, &pairs, &mut report);
    features::crossings(&lines, &pairs, &mut report);
    features::small_holes(&lines, &contours, params, &mut report);
    features::thin_webs(&lines, &contours, &pairs, params, &mut report);
    order::order(artwork, &lines, &contours, &mut report);
    report
}

#[cfg(test)]
mod tests;
