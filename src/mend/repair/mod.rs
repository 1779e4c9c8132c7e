//! Repair: whatever faces a file has become a surface that a mesh can hold.
//!
//! Source: our own arrangement of the steps of Guéziec, Taubin, Lazarus, Horn 1998 ("Converting sets
//! of polygons to manifold surfaces by cutting and stitching"): stitch what lies together, cut where
//! more than two faces meet, orient. Faces around an edge with more than two of them are paired so
//! that the solid lies between the two of a pair.

mod clean;
mod glue;
mod holes;
mod outwards;
mod report;

use serde::Deserialize;

pub(super) use clean::on_segments;
pub use report::{Mending, Repair, Repairs};

use super::soup::Soup;
use crate::units::Length;

/// Vertices closer than this share of the model are one: a hundred roundings of the numbers of 32
/// bits that STL files hold.
pub(super) const WELD_SHARE: f64 = 1e-6;

/// How to repair. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, Default, PartialEq, clap::Args, Deserialize)]
pub struct RepairParams {
    /// Close holes of which no two corners are farther apart than this length; above 0, in mm
    /// unless a unit is given [default: none is closed]
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub close_holes: Option<Length>,
}

/// Mends a list of faces until it is a surface, and says what it did.
///
/// In this order: vertices that lie together become one (a millionth of the model); empty and
/// doubled faces go; vertices on the sides of other faces are taken into them (T-junctions); where
/// more than two faces meet at an edge, or several fans at a vertex, the surface is parted; faces
/// turn to look the same way as most of their part; small holes are closed; closed parts look
/// outwards, cavities inwards.
pub fn repair(soup: &mut Soup, params: &RepairParams) -> Repairs {
    let mut repairs = Repairs::default();
    let near = weld_distance(soup);
    clean::weld(soup, near, &mut repairs);
    clean::drop_empty(soup, near, &mut repairs);
    clean::drop_doubled(soup, &mut repairs);
    clean::take_in_junctions(soup, near, &mut repairs);
    let mut glue = glue::Glue::new(soup);
    glue.orient(soup, &mut repairs);
    glue.part(soup, &mut repairs);
    if let Some(widest) = params.close_holes {
        holes::close(soup, widest.mm(), near, &mut repairs);
    }
    outwards::turn(soup, &mut repairs);
    repairs
}

/// Turns faces until neighbours look the same way and closed parts look outwards; changes nothing
/// else.
pub fn orient(soup: &mut Soup) -> Repairs {
    let mut repairs = Repairs::default();
    glue::Glue::new(soup).orient(soup, &mut repairs);
    outwards::turn(soup, &mut repairs);
    repairs
}

fn weld_distance(soup: &Soup) -> f64 {
    soup.bounds().map_or(0.0, |(low, high)| WELD_SHARE * (high - low).max_element())
}

#[cfg(test)]
mod tests;
