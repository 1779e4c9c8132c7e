//! Folds that are scored nearer to each other than the material can take.

use std::collections::{BTreeMap, BTreeSet};

use super::distance::distance_to_segment;
use super::drawing::{Drawing, MarkKind};
use super::layout::NearScores;
use super::params::SheetParams;
use crate::net::{Fold, FoldKind, Net};
use crate::units::Length;

/// Least distance of scores on card, in mm.
const ON_CARD: f64 = 1.0;

/// Least distance of scores in thicknesses of the material.
const THICKNESSES: f64 = 2.0;

/// What scores must keep apart, in mm: twice the thickness, where it is known, and 1 mm at least.
fn limit(params: &SheetParams) -> (f64, bool) {
    let of_material = params.stock.made_of.as_ref().map(|m| m.thickness);
    let thickness = params.joint.thickness.or(of_material);
    ((THICKNESSES * thickness.map_or(0.0, Length::mm)).max(ON_CARD), thickness.is_some())
}

/// Pairs of folds of one face, without a common corner, that are scored nearer than the limit.
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
    let mut near =
        NearScores { pairs: 0, least: f64::INFINITY, limit, is_known, pieces: Vec::new() };
    for folds in of_face.values() {
        for (i, a) in folds.iter().enumerate() {
            for b in &folds[i + 1..] {
                let distance = distance(a, b);
                if a.edge.iter().any(|v| b.edge.contains(v)) || distance >= limit {
                    continue;
                }
                near.pairs += 1;
                near.least = near.least.min(distance);
                near.pieces.push(a.piece);
            }
        }
    }
    near.pieces.sort();
    near.pieces.dedup();
    (near.pairs > 0).then_some(near)
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
    fn a_living_hinge_has_no_scores() {
        let hinge = ScoreParams { hinge: Some(Length::from_mm(6.0)), ..ScoreParams::default() };
        let params = SheetParams { score: hinge, ..SheetParams::default() };
        let set = lay_out(&strips(5, 0.9, 80.0), &params).expect("it fits");
        assert_eq!(set.report.near_scores, None);
    }
}
