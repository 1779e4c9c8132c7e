//! Numbers about a mesh: lengths, areas, angles, planarity, valence, genus, convexity; no verdicts.

mod contact;
mod convexity;
mod crossing;
mod edge;
mod extent;
#[cfg(test)]
pub(crate) mod fixtures;
mod planarity;
mod summary;
mod topology;
mod vertex;
mod winding;

pub use contact::self_contact;
pub use convexity::convexity_of;
pub use convexity::{Convexity, concave_edges, convexity};
pub use crossing::{CrossingKind, CrossingPair, crossings, crossings_while};
pub use edge::{dihedral_angle, edge_length, fold_angle};
pub use extent::{face_area, face_centroid, face_diameter, face_width, size, surface_area, volume};
pub use planarity::{Planarity, planarity, plane_deviation, polygon_planarity};
pub use summary::{ComponentSummary, EdgeLengths, GroupSummary, Summary, edge_lengths, summary};
pub use topology::{
    Rim, euler_number, genus, other_valences, rims, sides_histogram, stray_vertices,
    valence_histogram,
};
pub use vertex::conical_residual_of;
pub use vertex::{angle_deficit, conical_residual, corner_angle};
pub use winding::winding_number;
