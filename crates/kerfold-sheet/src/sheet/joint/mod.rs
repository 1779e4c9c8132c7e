//! Joints: what holds the two sides of a seam together, made on the pieces before kerf and placing.
//!
//! Every joint is measured against all that its piece already carries. What would collide is made
//! smaller, goes to the partner side, or falls back to stitch holes or the bare edge, and the
//! report says so. The net's own outlines, which `pieces.json` holds, stay as they are.

mod behind;
mod fingers;
mod flaps;
mod holes;
mod params;
mod slots;
mod trim;
mod webs;

use glam::DVec2;

pub use params::{FlapSide, JointParams, Substitute};
pub(crate) use params::{JointPlan, plan};
pub(crate) use trim::on_material;

use super::boundary::Boundaries;
use super::error::SheetError;
use super::stock::StockParams;
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
    /// Seams with tabs and slots.
    pub tabbed: usize,
    /// Seams that fingers or tabs cannot hold, with the reason; they have the substitute.
    pub fallbacks: Vec<(EdgeLabel, JointFallback)>,
    /// Of these the ones to be mitred, with what to take off the square edge of either side, in
    /// degrees; negative where the edge is concave.
    pub mitred: Vec<(EdgeLabel, f64)>,
    /// Pairs of holes.
    pub hole_pairs: usize,
    /// Pairs of holes left out, since one of the two was in the way of something.
    pub lost_hole_pairs: usize,
}

/// Why a seam has no fingers or tabs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum JointFallback {
    /// The plates lie too flat: the dihedral angle is more than 140°.
    Shallow,
    /// The plates meet at less than 30°.
    Sharp,
    /// The edge is concave: the plates part instead of meeting.
    Concave,
    /// The edge is too short for two fingers, or for one tab between the plates at its ends.
    Short,
    /// Notches, tabs or slots would cut into one another, or through a narrow face.
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
pub(crate) fn join(
    net: &Net,
    params: &JointParams,
    stock: &StockParams,
) -> Result<Option<Jointed>, SheetError> {
    let plan = plan(params, stock)?;
    if matches!(plan, JointPlan::None) {
        return Ok(None);
    }
    let mut boundaries = Boundaries::new(net);
    let mut report = JointReport::default();
    let mut flap_folds = Vec::new();
    let mut drilled = Vec::new();
    let mut slots = Vec::new();
    let all: Vec<usize> = (0..net.seams.len()).collect();
    let kerf = stock.kerf.mm();
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
            drilled = holes::stitch(
                net,
                &boundaries,
                &stretches(net, &boundaries),
                &all,
                (&holes, &[]),
                &mut report,
            );
        }
        JointPlan::Fingers(fingers, holes) => {
            let fallen = fingers::add_fingers(net, &mut boundaries, &fingers, &mut report);
            drilled = substitute(net, &boundaries, &fallen, (holes.as_ref(), &[]), &mut report);
        }
        JointPlan::Tabs(tabs, holes) => {
            let (made, fallen) = slots::add_tabs(net, &mut boundaries, &tabs, &mut report);
            slots = made;
            drilled = substitute(net, &boundaries, &fallen, (holes.as_ref(), &slots), &mut report);
        }
    }
    let mut net = net.clone();
    for (i, piece) in net.pieces.iter_mut().enumerate() {
        let mut paths = boundaries.of_piece(i).map(|c| c.path());
        piece.outline = paths.next().unwrap_or_default();
        let slots = slots.iter().filter(|s| s.piece == i).map(|s| s.contour.clone());
        piece.holes = paths
            .chain(slots)
            .chain(drilled.iter().filter(|h| h.piece == i).map(Hole::contour))
            .collect();
    }
    Ok(Some(Jointed { net, flap_folds, report }))
}

/// What seams get that fingers or tabs cannot hold: stitch holes, or a mitre, which nothing on a
/// sheet shows.
fn substitute(
    net: &Net,
    boundaries: &Boundaries,
    fallen: &[usize],
    (holes, slots): (Option<&params::Holes>, &[slots::Slot]),
    report: &mut JointReport,
) -> Vec<Hole> {
    if let Some(holes) = holes {
        return holes::stitch(
            net,
            boundaries,
            &stretches(net, boundaries),
            fallen,
            (holes, slots),
            report,
        );
    }
    report.mitred =
        fallen.iter().map(|&s| (net.seams[s].id, net.seams[s].fold_angle / 2.0)).collect();
    Vec::new()
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
    use super::super::testing::{random_convex, twins, two_pieces};
    use super::super::{Joint, LetterParams, SheetParams, lay_out};
    use super::*;
    use crate::geom::polygon::{borders_meet, segments_meet};
    use crate::units::Length;
    use proptest::prelude::*;

    fn with(joint: Joint) -> SheetParams {
        SheetParams {
            joint: JointParams {
                kind: joint,
                thickness: matches!(joint, Joint::Fingers | Joint::Tabs)
                    .then(|| Length::from_mm(3.0)),
                ..JointParams::default()
            },
            ..Default::default()
        }
    }

    fn join(net: &Net, params: &SheetParams) -> Result<Option<Jointed>, SheetError> {
        super::join(net, &params.joint, &params.stock)
    }

    fn assert_simple(contour: &[DVec2]) {
        let n = contour.len();
        for i in 0..n {
            for j in 0..i {
                let (a, b, c, d) =
                    (contour[i], contour[(i + 1) % n], contour[j], contour[(j + 1) % n]);
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
        let params = SheetParams {
            joint: JointParams { flap_width: Some(Length::from_mm(5.0)), ..JointParams::default() },
            ..SheetParams::default()
        };
        let text = lay_out(&net, &params).expect_err("no flaps").to_string();
        assert_eq!(
            text,
            "joint none does not use flap-width; leave it out or choose another joint"
        );
        let params = SheetParams {
            joint: JointParams { kind: Joint::Fingers, ..JointParams::default() },
            ..SheetParams::default()
        };
        let text = lay_out(&net, &params).expect_err("no thickness").to_string();
        assert_eq!(text, "joint fingers needs the thickness; give it, for example 3mm");
    }

    #[test]
    fn every_joint_is_laid_out_and_leaves_the_net_as_it_was() {
        for joint in [Joint::Flaps, Joint::Rivets, Joint::Stitch, Joint::Fingers, Joint::Tabs] {
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

    #[test]
    fn after_the_kerf_a_tab_of_3_mm_fits_a_slot_of_3_mm() {
        let net = two_pieces();
        for kerf in [0.0, 0.2] {
            let params = SheetParams {
                stock: StockParams { kerf: Length::from_mm(kerf), ..with(Joint::Tabs).stock },
                joint: JointParams {
                    finger_width: Some(Length::from_mm(4.0)),
                    ..with(Joint::Tabs).joint
                },
                letter: LetterParams {
                    labels: super::super::Labels::None,
                    ..with(Joint::Tabs).letter
                },
                ..with(Joint::Tabs)
            };
            let set = lay_out(&net, &params).expect("two small pieces");
            assert_eq!((set.report.joints.tabbed, set.report.joints.fallbacks.len()), (1, 0));
            let marks: Vec<_> = set.drawings[0].marks().collect();
            let slots: Vec<_> =
                marks.iter().filter(|m| m.kind == super::super::MarkKind::Hole).collect();
            assert!(!slots.is_empty());
            // What is cut is the drawn line and half a kerf on both sides of it.
            for slot in &slots {
                let p = &slot.strokes[0].points;
                assert_eq!(p.len(), 4);
                let sides = [p[0].distance(p[1]), p[1].distance(p[2])];
                assert!((sides[0].min(sides[1]) + kerf - 3.0).abs() < 1e-6, "{sides:?}");
                assert!((sides[0].max(sides[1]) + kerf - 4.0).abs() < 1e-6, "{sides:?}");
            }
            // The tops of tabs are a kerf wider than what comes out, the gaps between them as much
            // narrower.
            let tops =
                marks.iter().filter(|m| m.kind == super::super::MarkKind::Outline).flat_map(|m| {
                    let p = &m.strokes[0].points;
                    let n = p.len();
                    (0..n).map(|i| p[i].distance(p[(i + 1) % n])).collect::<Vec<_>>()
                });
            let expected = if kerf > 0.0 { slots.len() } else { 2 * slots.len() - 1 };
            assert_eq!(tops.filter(|l| (l - kerf - 4.0).abs() < 1e-6).count(), expected);
        }
    }

    #[test]
    fn shallow_seams_are_stitched_or_mitred_and_the_report_says_so() {
        for joint in [Joint::Fingers, Joint::Tabs] {
            let net = twins(random_convex(3).into_iter().map(|p| 3.0 * p).collect(), 30.0);
            let stitched = join(&net, &with(joint)).expect("good numbers").expect("a joint").report;
            assert!(
                stitched.fallbacks.iter().all(|f| f.1 == JointFallback::Shallow)
                    && stitched.hole_pairs > 0
            );
            assert_eq!(stitched.fallbacks.len(), net.seams.len());
            let params = SheetParams {
                joint: JointParams { substitute: Some(Substitute::Mitre), ..with(joint).joint },
                ..with(joint)
            };
            let jointed = join(&net, &params).expect("good numbers").expect("a joint");
            assert_eq!(
                (jointed.report.mitred.len(), jointed.report.hole_pairs),
                (net.seams.len(), 0)
            );
            assert!(jointed.report.mitred.iter().all(|m| m.1 == 15.0));
            assert_eq!(jointed.net, net);
            let both = SheetParams {
                joint: JointParams { hole_spacing: Some(Length::from_mm(8.0)), ..params.joint },
                ..params
            };
            assert!(
                join(&net, &both)
                    .map(|_| ())
                    .expect_err("no holes")
                    .to_string()
                    .contains("hole-spacing")
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn flaps_overlap_nothing(radii in prop::collection::vec(15.0..80.0_f64, 4..24), kerf in 0.0..0.4_f64) {
            let net = twins(star(&radii), 60.0);
            let params = SheetParams { stock: StockParams { kerf: Length::from_mm(kerf), ..with(Joint::Flaps).stock }, ..with(Joint::Flaps) };
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
        fn tabs_leave_simple_outlines_and_slots_apart(radii in prop::collection::vec(30.0..120.0_f64, 4..12), fold in 20.0..140.0_f64) {
            let net = twins(star(&radii), fold);
            let jointed = join(&net, &with(Joint::Tabs)).expect("good numbers").expect("tabs");
            prop_assert_eq!(jointed.report.tabbed + jointed.report.fallbacks.len(), radii.len());
            for piece in &jointed.net.pieces {
                assert_simple(&piece.outline);
                for (i, hole) in piece.holes.iter().enumerate() {
                    use crate::geom::polygon::{Location, locate};
                    prop_assert!(hole.iter().all(|&p| locate(&piece.outline, p) == Location::Inside));
                    for other in piece.holes[..i].iter().chain([&piece.outline]) {
                        prop_assert!(!borders_meet(hole, other));
                    }
                }
            }
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
