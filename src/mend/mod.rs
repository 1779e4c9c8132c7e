//! Surfaces mended: flat neighbours found and made one face, and faces of files made a surface.
//!
//! Below operators and files, since both need it: an operator is a step and a verb, and files are
//! mended while they are read, before there is a mesh that an operator could take.

/// How far from flat still counts as flat when nothing is said, in mm: less than any cut can show.
pub const FLAT_MM: f64 = 0.01;

mod flat;
mod junction;
mod merge;
mod repair;
mod soup;
mod weld;

pub use flat::{FlatPatches, flat_patches};
pub use junction::{Junction, junctions};
pub use merge::{Merged, merge_flat};
pub use repair::{Mending, Repair, RepairParams, Repairs, orient, repair};
pub use soup::{Soup, SoupFace};
pub use weld::{first_equal, position_key, remove_spikes, weld_targets};
