//! Folds that are scored nearer to each other than the material can take.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::distance::distance_to_segment;
use super::drawing::{Drawing, MarkKind};
use super::layout::{Fans, NearScores};
use super::params::SheetParams;
use crate::net::{Fold, FoldKind, Net};
use crate::units::Length;

/// Least distance of scores on card, in mm.
const ON_CARD: f64 = 1.0;

/// Least distance of scores in thicknesses of the material.
const THICKNESSES: f64 = 2.0;

/// How far from a common corner two scores must keep apart, in limits: nearer to it they cannot, and
/// a short stretch tears no card. Two scores that leave a corner by less than 5.7° do not.
const FROM_CORNER: f64 = 10.0;

/// What scores must keep apart, in mm: twice the thickness, where it is known, and 1 mm at least.
fn limit(params: &SheetParams) -> (f64, bool) {
    let of_material = params.stock.made_of.as_ref().map(|m| m.thickness);
    let thickness = params.joint.thickness.or(of_material);
    ((THICKNESSES * thickness.map_or(0.0, Length::mm)).max(ON_CARD), thickness.is_some())
}

/// Pairs of folds of one face that are scored nearer than the limit, those that leave one corner
/// counted by themselves.
pub(crate) fn near_scores(
    net: &Net,
    drawings: &[Drawing],
    params: &SheetParams,
) -> Option<NearScores> {
    let (limit, is_known) = limit(params);
    let folds = [MarkKind::MountainFold, MarkKind::ValleyFold, MarkKind::Perforation];
    let marks = drawings.iter().flat_map(Drawing::marks).filter(|m| folds.contains(&m.kind));
    let scored: BTreeSet<&str> = marks.map(|m| m.id.as_str()).collect();
    let mut of_face: BTreeMap<usize, Vec<&Fold>> = BTreeMap::new();
    let is_scored =
        |f: &&Fold| f.kind != FoldKind::Flat && scored.contains(f.id.to_string().as_str());
    for fold in net.folds.iter().filter(is_scored) {
        for face in fold.faces {
            of_face.entry(face).or_default().push(fold);
        }
    }
    let mut near = NearScores {
        pairs: 0,
        least: f64::INFINITY,
        fans: Fans::default(),
        limit,
        is_known,
        pieces: Vec::new(),
    };
    for folds in of_face.values() {
        for (i, a) in folds.iter().enumerate() {
            for b in &folds[i + 1..] {
                let is_near = match corner(a, b) {
                    Some(ways) => near.fans.add(near_stretch(ways, limit), FROM_CORNER * limit),
                    None => near.add(distance(a, b)),
                };
                if is_near {
                    near.pieces.push(a.piece);
                }
            }
        }
    }
    near.pieces.sort();
    near.pieces.dedup();
    (near.pairs + near.fans.pairs > 0).then_some(near)
}

impl NearScores {
    /// Counts a pair at this distance, in mm, if it is nearer than the limit.
    fn add(&mut self, distance: f64) -> bool {
        let is_near = distance < self.limit;
        if is_near {
            self.pairs += 1;
            self.least = self.least.min(distance);
        }
        is_near
    }
}

impl Fans {
    /// Counts a pair that runs near so far from its corner, in mm, if that is beyond `reach`.
    fn add(&mut self, stretch: f64, reach: f64) -> bool {
        self.reach = reach;
        let is_near = stretch > reach;
        if is_near {
            self.pairs += 1;
            self.longest = self.longest.max(stretch);
        }
        is_near
    }
}

/// The ways from the common corner of two folds to their other ends; `None` without one.
fn corner(a: &Fold, b: &Fold) -> Option<[DVec2; 2]> {
    let (i, j) = (0..2).find_map(|i| Some((i, (0..2).find(|&j| a.edge[i] == b.edge[j])?)))?;
    Some([a.segment[1 - i] - a.segment[i], b.segment[1 - j] - b.segment[j]])
}

/// How far from their common corner two folds are nearer to each other than the limit, in mm: the
/// last point of either whose distance from the other is less. On the way out the distance grows, so
/// halving finds it.
fn near_stretch(ways: [DVec2; 2], limit: f64) -> f64 {
    let farthest = |own: DVec2, other: DVec2| {
        let is_near = |t: f64| distance_to_segment(own * t, DVec2::ZERO, other) < limit;
        let (mut near, mut far) = (0.0, 1.0);
        if is_near(far) {
            return own.length();
        }
        for _ in 0..40 {
            let middle = 0.5 * (near + far);
            if is_near(middle) { near = middle } else { far = middle }
        }
        near * own.length()
    };
    farthest(ways[0], ways[1]).max(farthest(ways[1], ways[0]))
}

/// The least distance of two folds that do not cross.
fn distance(a: &Fold, b: &Fold) -> f64 {
    let from = |p: &Fold, q: &Fold| {
        let ends = p.segment.into_iter();
        ends.map(|end| distance_to_segment(end, q.segment[0], q.segment[1]))
            .fold(f64::INFINITY, f64::min)
    };
    from(a, b).min(from(b, a))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{strips, two_pieces};
    use super::super::{ScoreParams, StockParams, lay_out};
    use super::*;

    fn found(width: f64, thickness: Option<f64>) -> Option<NearScores> {
        let mut params = SheetParams::default();
        params.joint.thickness = None;
        if let Some(thickness) = thickness {
            let mut card = material(thickness);
            card.thickness = Length::from_mm(thickness);
            params.stock = StockParams { made_of: Some(card), ..StockParams::default() };
        }
        lay_out(&strips(5, width, 80.0), &params).expect("it fits").report.near_scores
    }

    fn material(thickness: f64) -> super::super::Material {
        super::super::Material {
            title: "Card".to_owned(),
            thickness: Length::from_mm(thickness),
            rigid: false,
            density: None,
            kerf: Length::from_mm(0.1),
            web: Length::from_mm(0.1),
            speed: super::super::Speeds { cut: 1.0, score: 1.0, engrave: 1.0, travel: 1.0 },
            colours: Default::default(),
        }
    }

    #[test]
    fn scores_nearer_than_two_thicknesses_or_a_millimetre_are_counted() {
        let near = found(0.9, None).expect("less than 1 mm apart");
        assert_eq!((near.pairs, near.limit, near.pieces.len()), (3, 1.0, 1));
        assert!(!near.is_known && found(0.9, Some(0.2)).is_some_and(|n| n.is_known));
        assert!((near.least - 0.9).abs() < 1e-9, "{near:?}");
        assert_eq!(found(1.1, None), None);
        assert_eq!(found(1.1, Some(0.5)), None);
        assert_eq!(found(1.1, Some(0.6)).map(|n| n.limit), Some(1.2));
        assert_eq!(
            lay_out(&two_pieces(), &SheetParams::default()).expect("fits").report.near_scores,
            None
        );
    }

    #[test]
    fn folds_that_leave_a_corner_are_near_as_far_as_their_angle_says() {
        let fold = |degrees: f64, length: f64| DVec2::from_angle(degrees.to_radians()) * length;
        // At 5° two folds are 1 mm apart after 1 / sin 5° = 11.47 mm.
        let stretch = near_stretch([fold(0.0, 80.0), fold(5.0, 60.0)], 1.0);
        assert!((stretch - 1.0 / 5.0_f64.to_radians().sin()).abs() < 1e-6, "{stretch}");
        // Past the end of a shorter fold the longer one soon leaves it: (x - 5.977)² + 0.523² = 1.
        let stretch = near_stretch([fold(0.0, 8.0), fold(5.0, 6.0)], 1.0);
        assert!((stretch - 6.8295).abs() < 1e-3, "{stretch}");
        let stretch = 1.0 / 5.0_f64.to_radians().sin();
        assert!(near_stretch([fold(0.0, 80.0), fold(90.0, 80.0)], 1.0) <= 1.0 + 1e-9);
        let mut fans = Fans::default();
        assert!(fans.add(stretch, 10.0) && !fans.add(9.0, 10.0));
        assert_eq!((fans.pairs, fans.longest, fans.reach), (1, stretch, 10.0));
    }

    #[test]
    fn a_living_hinge_has_no_scores() {
        let hinge = ScoreParams { hinge: Some(Length::from_mm(6.0)), ..ScoreParams::default() };
        let params = SheetParams { score: hinge, ..SheetParams::default() };
        let set = lay_out(&strips(5, 0.9, 80.0), &params).expect("it fits");
        assert_eq!(set.report.near_scores, None);
    }
}
