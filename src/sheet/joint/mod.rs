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

#[cfg(test)]
mod tests {
    use super::super::label::segments_meet;
    use super::super::testing::{random_convex, two_pieces};
    use super::super::{SheetParams, lay_out};
    use super::*;
    use crate::net::{Seam, SeamSide};
    use crate::units::Length;
    use proptest::prelude::*;

    fn with(joint: Joint) -> SheetParams {
        SheetParams { joint, thickness: (joint == Joint::Fingers).then(|| Length::from_mm(3.0)), ..Default::default() }
    }

    /// A polygon and its copy, joined along all edges: what two faces of a thin body would be.
    fn twins(contour: Vec<DVec2>, fold_angle: f64) -> Net {
        let mut net = two_pieces();
        let n = contour.len();
        let low = contour.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let front: Vec<DVec2> = contour.iter().map(|&p| p - low).collect();
        let back: Vec<DVec2> = (0..n).map(|i| front[(n - i) % n] * DVec2::new(-1.0, 1.0)).collect();
        let mut piece = |i: usize, polygon: &[DVec2], vertices: Vec<usize>| {
            let p = &mut net.pieces[i];
            (p.outline, p.holes) = (polygon.to_vec(), vec![]);
            p.faces.truncate(1);
            (p.faces[0].face, p.faces[0].polygon, p.faces[0].vertices) = (i, polygon.to_vec(), vertices);
        };
        piece(0, &front, (0..n).collect());
        piece(1, &back, (0..n).map(|i| (n - i) % n).collect());
        net.folds.clear();
        let side = |piece: usize, a, b| SeamSide { piece: PieceId(piece), face: piece, segment: [a, b] };
        net.seams = (0..n)
            .map(|i| {
                let j = (i + 1) % n;
                let sides = [side(0, front[i], front[j]), side(1, back[(n - i) % n], back[(n - j) % n])];
                let length = front[i].distance(front[j]);
                Seam { id: EdgeLabel(i), edge: [i, j], length, fold_angle, sides }
            })
            .collect();
        net
    }

    fn assert_simple(contour: &[DVec2]) {
        let n = contour.len();
        for i in 0..n {
            for j in 0..i {
                let (a, b, c, d) = (contour[i], contour[(i + 1) % n], contour[j], contour[(j + 1) % n]);
                let next = j + 1 == i || (j == 0 && i + 1 == n);
                assert!(next || !segments_meet(a, b, c, d), "edges {i} and {j} meet");
            }
        }
    }

    fn star(radii: &[f64]) -> Vec<DVec2> {
        let step = std::f64::consts::TAU / radii.len() as f64;
        radii.iter().enumerate().map(|(i, &r)| r * DVec2::from_angle(i as f64 * step)).collect()
    }

    #[test]
    fn options_of_another_joint_and_missing_ones_are_refused() {
        let net = two_pieces();
        let params = SheetParams { flap_width: Some(Length::from_mm(5.0)), ..SheetParams::default() };
        let text = lay_out(&net, &params).expect_err("no flaps").to_string();
        assert_eq!(text, "joint none does not use flap-width; leave it out or choose another joint");
        let params = SheetParams { joint: Joint::Fingers, ..SheetParams::default() };
        let text = lay_out(&net, &params).expect_err("no thickness").to_string();
        assert_eq!(text, "joint fingers needs the thickness; give it, for example 3mm");
    }

    #[test]
    fn every_joint_is_laid_out_and_leaves_the_net_as_it_was() {
        for joint in [Joint::Flaps, Joint::Rivets, Joint::Stitch, Joint::Fingers] {
            let net = two_pieces();
            let set = lay_out(&net, &with(joint)).expect("two small pieces");
            assert_eq!(net, two_pieces());
            assert!(set.report.joints != JointReport::default(), "{joint:?}");
        }
    }

    #[test]
    fn a_finger_joint_cuts_as_much_as_its_zones_say() {
        let net = two_pieces();
        let jointed = join(&net, &with(Joint::Fingers)).expect("good numbers").expect("fingers");
        // One seam of 30 mm at a right angle: half of a strip 3 mm deep goes on either side.
        for piece in [0, 1] {
            let area = |n: &Net| crate::geom::polygon::signed_area(&n.pieces[piece].outline);
            assert!((area(&net) - area(&jointed.net) - 45.0).abs() < 1e-9);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn flaps_overlap_nothing(radii in prop::collection::vec(15.0..80.0_f64, 4..24), kerf in 0.0..0.4_f64) {
            let net = twins(star(&radii), 60.0);
            let params = SheetParams { kerf: Length::from_mm(kerf), ..with(Joint::Flaps) };
            let jointed = join(&net, &params).expect("good numbers").expect("flaps");
            jointed.net.pieces.iter().for_each(|p| assert_simple(&p.outline));
            prop_assert_eq!(jointed.report.flaps + jointed.report.bare_seams.len(), radii.len());
            prop_assert!(lay_out(&net, &params).is_ok());
        }

        #[test]
        fn fingers_leave_simple_outlines(radii in prop::collection::vec(30.0..120.0_f64, 4..12), fold in 20.0..140.0_f64) {
            let net = twins(star(&radii), fold);
            let jointed = join(&net, &with(Joint::Fingers)).expect("good numbers").expect("fingers");
            jointed.net.pieces.iter().for_each(|p| assert_simple(&p.outline));
            prop_assert_eq!(jointed.report.fingered + jointed.report.fallbacks.len(), radii.len());
        }

        #[test]
        fn stitch_holes_mate_and_keep_clear(seed in 0..200_u64) {
            let net = twins(random_convex(seed), 60.0);
            let jointed = join(&net, &with(Joint::Stitch)).expect("good numbers").expect("holes");
            let centres = |i: usize| jointed.net.pieces[i].holes.iter().map(|h| crate::geom::polygon::centroid(h)).collect::<Vec<_>>();
            let (front, back) = (centres(0), centres(1));
            prop_assert_eq!(front.len(), jointed.report.hole_pairs);
            for (p, q) in front.iter().zip(&back) {
                prop_assert!((*p * DVec2::new(-1.0, 1.0)).distance(*q) < 1e-9, "{} {}", p, q);
            }
            for (i, p) in front.iter().enumerate() {
                prop_assert!(front[..i].iter().all(|q| p.distance(*q) > 1.5 + 0.5));
            }
        }
    }
}
