//! Strips that the material is too thick for: score lines so near to one another that the second
//! opens the first.

use std::collections::BTreeMap;

use glam::DVec2;

use super::Fabrication;
use crate::code::{Coded, codes};
use crate::net::{Fold, Net};
use crate::sheet::SheetParams;

/// Two score lines need this many thicknesses between them.
const THICKNESSES: f64 = 2.0;
/// And on the thinnest card so much, in mm.
const LEAST: f64 = 1.0;

/// What is wrong with pieces that were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MakeFinding {
    /// Score lines are nearer to one another than the material allows.
    NarrowStrips,
}

codes!(finding MakeFinding {
    NarrowStrips = 507,
});

/// The strips that are too narrow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NarrowStrips {
    /// How many faces.
    count: usize,
    /// The least distance of two folds of one face, in mm.
    width: f64,
    /// What the material wants, in mm.
    limit: f64,
}

impl Fabrication {
    /// A finding on strips that are narrower than the material can be scored; `None` where there
    /// are none, or the material is not known.
    pub fn narrow_strips(&self, sheet: &SheetParams) -> Option<String> {
        let thickness = sheet.stock.made_of.as_ref()?.thickness.mm();
        let limit = LEAST.max(THICKNESSES * thickness);
        let NarrowStrips { count, width, limit } = narrow_strips(&self.net, limit)?;
        let code = MakeFinding::NarrowStrips.code();
        Some(format!(
            "{count} faces are narrower between their folds than the material can be scored: \
            {width:.2} mm, and {limit:.2} mm is the least for {thickness} mm; take fewer strips \
            ({code})"
        ))
    }
}

/// Folds that share an end are not side by side, and flat ones are not scored.
fn narrow_strips(net: &Net, limit: f64) -> Option<NarrowStrips> {
    let mut of_face: BTreeMap<usize, Vec<&Fold>> = BTreeMap::new();
    for fold in net.folds.iter().filter(|fold| fold.fold_angle.abs() > 1e-6) {
        fold.faces.iter().for_each(|&f| of_face.entry(f).or_default().push(fold));
    }
    let beside = |a: &Fold, b: &Fold| {
        let is_apart = a.edge.iter().all(|v| !b.edge.contains(v));
        is_apart.then(|| distance(ends(a), ends(b)))
    };
    let nearest = of_face.values().filter_map(|folds| {
        let pairs =
            folds.iter().enumerate().flat_map(|(i, a)| folds[..i].iter().map(move |b| (a, b)));
        pairs.filter_map(|(a, b)| beside(a, b)).min_by(f64::total_cmp)
    });
    let narrow: Vec<f64> = nearest.filter(|&width| width < limit * (1.0 - 1e-9)).collect();
    let width = narrow.iter().copied().min_by(f64::total_cmp)?;
    Some(NarrowStrips { count: narrow.len(), width, limit })
}

fn ends(fold: &Fold) -> [DVec2; 2] {
    fold.segment
}

/// The least distance of two segments that do not cross.
fn distance(a: [DVec2; 2], b: [DVec2; 2]) -> f64 {
    let from = |p: DVec2, [q, r]: [DVec2; 2]| {
        let along = r - q;
        let share = ((p - q).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p.distance(q + along * share)
    };
    [from(a[0], b), from(a[1], b), from(b[0], a), from(b[1], a)]
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
