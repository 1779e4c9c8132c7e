//! Plates: every face of a mesh as a panel of constant thickness, with the cuts along its edges,
//! its holes and its schedule.
//!
//! Frames and signs: a plate lies between two planes parallel to its face. Offsets are measured
//! along the outward normal, so the *front* (outside) has the larger offset; where the model's
//! surface lies between them is the reference side ([`ReferenceSide`]). In its own frame a plate is
//! seen from outside, y up, corners counter-clockwise; a flat point (x, y) of the front is put back
//! into space by [`crate::geom::Frame::lift`]. Lengths are millimetres; angles in memory are
//! radians, but numbers that leave for files are degrees.
//!
//! The way of a face: what happens at its edges is decided ([`EdgeCut`]), its two outlines follow
//! by moving every side inwards by the *inset* of its edge at front and back ([`Plate`]), corners
//! are relieved, fingers and holes added, and what collides is named with the largest thickness
//! that works ([`PanelError::Collision`]).
//!
//! Three planes in general position, each moved by any distance, still meet in one point. So with
//! three faces at every vertex the corners of all plates at a vertex meet exactly, whatever the
//! thicknesses; above that they do so only where the vertex is conical, and every [`Node`] says by
//! how much they miss each other.

mod across;
mod body;
mod build;
mod cell;
mod collision;
mod cut;
mod error;
mod finding;
mod finger;
mod hole;
mod map;
mod node;
mod outline;
mod overlap;
mod params;
mod part;
mod pieces;
mod planar;
mod plate;
mod rule;
mod schedule;
mod settle;
mod shape;
mod solid;
mod twins;

#[cfg(test)]
mod tests;

pub use across::Inset;
pub use build::plates;
pub use cut::{EdgeCut, EdgeFallback};
pub use error::{Collision, NotPlanar, Overlap, PanelError};
pub use finding::{CONICAL, PanelCheck, PanelElement, PanelFinding, panel_findings};
pub(crate) use map::label_room;
pub use map::{AssemblyMap, MapPanel, MapView, assembly_map};
pub use node::{Node, NodeCut};
pub use overlap::SHARED;
pub use params::{
    CutStyle, GroupThickness, Hardware, PanelParams, PanelRequirement, ReferenceSide, RimCut,
    Shallow,
};
pub use pieces::panel_net;
pub use plate::{Hole, Plate, Plates};
pub use rule::{EdgeKind, EdgeRules};
pub use schedule::{EdgeRow, EdgeShape, GroupRow, NodeRow, PanelRow, Schedule, Totals, schedule};
pub use solid::{Solid, SolidFace, SolidSide, solid};
pub use twins::{Twin, twins};
