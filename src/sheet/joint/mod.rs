//! Joints: what holds the two sides of a seam together, made on the pieces before kerf and placing.
//!
//! Every joint is measured against all that its piece already carries. What would collide is made smaller, goes to the
//! partner side, or falls back to stitch holes or the bare edge, and the report says so. The net's own outlines, which
//! `pieces.json` holds, stay as they are.

mod boundary;
mod fingers;
mod flaps;
mod holes;
mod params;

use glam::DVec2;

pub(crate) use boundary::{Boundaries, directed};
pub use params::{FlapSide, Joint};
pub(crate) use params::{JointPlan, plan};

use super::error::SheetError;
use super::params::SheetParams;
use super::stretch::stretches;
use crate::net::{EdgeLabel, Net, PieceId, Segment};

/// What became of the joints, in numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JointReport {
    /// Flaps made.
    pub flaps: usize,
    /// Flaps narrower than asked for, since something was in the way.
    pub narrowed_flaps: usize,
    /// Flaps on the other side than the rule says, since something was in the way.
    pub moved_flaps: usize,
    /// Seams without a flap: there was room on neither side.
    pub bare_seams: Vec<EdgeLabel>,
    /// Seams with fingers.
    pub fingered: usize,
    /// Seams that fingers cannot hold, with the reason; they have stitch holes where there is room.
    pub fallbacks: Vec<(EdgeLabel, Fallback)>,
    /// Pairs of holes.
    pub hole_pairs: usize,
    /// Pairs of holes left out, since one of the two was in the way of something.
    pub lost_hole_pairs: usize,
}

/// Why a seam has no fingers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Fallback {
    /// The plates lie too flat: the dihedral angle is more than 140°.
    Shallow,
    /// The plates meet at less than 30°.
    Sharp,
    /// The edge is concave: the plates part instead of meeting.
    Concave,
    /// The edge is too short for two fingers.
    Short,
    /// The notches would cut into one another, or through a narrow face.
    Narrow,
}

/// The score line between a piece and its flap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FlapFold {
    pub piece: PieceId,
    pub id: EdgeLabel,
    pub segment: Segment,
}

/// A round hole of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hole {
    /// Index of the piece in the net.
    pub piece: usize,
    pub centre: DVec2,
    pub radius: f64,
}

/// A net whose pieces carry their joints.
pub(crate) struct Jointed {
    /// The same net with other outlines and more holes.
    pub net: Net,
    pub flap_folds: Vec<FlapFold>,
    pub report: JointReport,
}

/// Puts the joints of the parameters on all pieces; nothing for `joint = none`.
///
/// # Errors
/// [`SheetError::JointOption`], [`SheetError::OutOfRange`] for parameters.
pub(crate) fn join(net: &Net, params: &SheetParams) -> Result<Option<Jointed>, SheetError> {
    let plan = plan(params)?;
    if matches!(plan, JointPlan::None) {
        return Ok(None);
    }
    let mut boundaries = Boundaries::new(net);
    let mut report = JointReport::default();
    let mut flap_folds = Vec::new();
    let mut drilled = Vec::new();
    let all: Vec<usize> = (0..net.seams.len()).collect();
    let kerf = params.kerf.mm();
    match plan {
        JointPlan::None => {}
        JointPlan::Flaps(flap) => {
            let made = flaps::add_flaps(net, &mut boundaries, &flap, kerf, &mut report);
            flap_folds = made.iter().map(|m| m.fold(net)).collect();
        }
        JointPlan::Rivets(flap, holes) => {
            let made = flaps::add_flaps(net, &mut boundaries, &flap, kerf, &mut report);
            flap_folds = made.iter().map(|m| m.fold(net)).collect();
            drilled = holes::rivet(net, &boundaries, &made, &holes, &mut report);
        }
        JointPlan::Stitch(holes) => {
            drilled = holes::stitch(net, &boundaries, &stretches(net, &boundaries), &all, &holes, &mut report);
        }
        JointPlan::Fingers(fingers, holes) => {
            let fallen = fingers::add_fingers(net, &mut boundaries, &fingers, &mut report);
            drilled = holes::stitch(net, &boundaries, &stretches(net, &boundaries), &fallen, &holes, &mut report);
        }
    }
    let mut net = net.clone();
    for (i, piece) in net.pieces.iter_mut().enumerate() {
        let mut paths = boundaries.of_piece(i).map(|c| c.path());
        piece.outline = paths.next().unwrap_or_default();
        piece.holes = paths.chain(drilled.iter().filter(|h| h.piece == i).map(Hole::contour)).collect();
    }
    Ok(Some(Jointed { net, flap_folds, report }))
}

impl Hole {
    /// The circle as a clockwise polygon; its sides stay within 1 % of the radius.
    fn contour(&self) -> Vec<DVec2> {
        const SIDES: usize = 24;
        let angle = |i: usize| -(i as f64) * std::f64::consts::TAU / SIDES as f64;
        (0..SIDES).map(|i| self.centre + self.radius * DVec2::from_angle(angle(i))).collect()
    }
}
