//! Numbers about a mesh: lengths, areas, angles, volume; no verdicts.

mod edge;
mod extent;

pub use edge::{dihedral_angle, edge_length, fold_angle};
pub use extent::{face_area, face_centroid, face_diameter, size, surface_area, volume};
