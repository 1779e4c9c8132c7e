//! In which order seams are closed, so that every piece is attached before what it belongs to is closed around it.
//!
//! The largest piece comes first; each further piece is attached where it shares the longest stretch with those before. Only
//! then the rest is closed like a zip: always a stretch at one of whose ends nothing else is open, for as long as there is
//! one. What closes the body at last is then one stretch, at which one can still reach inside.

use std::collections::{BTreeMap, BTreeSet};

use super::stretch::Stretch;
use crate::geom::polygon::signed_area;
use crate::net::{Net, PieceId};

/// All steps, and the stretches that they name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assembly {
    /// The stretches by their number less one.
    pub stretches: Vec<Stretch>,
    /// What to do, in order.
    pub steps: Vec<Step>,
}

/// One stretch is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// The number of the stretch, as on the sheet.
    pub number: usize,
    /// The piece that this step attaches; nothing when both sides hang together already.
    pub attaches: Option<PieceId>,
}

pub(crate) fn assembly(net: &Net, stretches: Vec<Stretch>) -> Assembly {
    let mut steps = attach_all(net, &stretches);
    let mut open: BTreeMap<usize, usize> = BTreeMap::new();
    let ends: Vec<[usize; 2]> = stretches.iter().map(|s| ends(net, s)).collect();
    ends.iter().flatten().for_each(|&v| *open.entry(v).or_default() += 1);
    let mut waiting: BTreeSet<usize> = (0..stretches.len()).collect();
    let mut reached: BTreeSet<usize> = BTreeSet::new();
    let mut close = |i: usize, waiting: &mut BTreeSet<usize>, reached: &mut BTreeSet<usize>| {
        waiting.remove(&i);
        reached.extend(ends[i]);
        ends[i].iter().for_each(|v| *open.entry(*v).or_default() -= 1);
        open.clone()
    };
    let mut left = BTreeMap::new();
    for step in &steps {
        left = close(step.number - 1, &mut waiting, &mut reached);
    }
    while !waiting.is_empty() {
        // Nothing else open at an end is best, then an end where something is closed already, then the lowest number.
        let rank = |&&i: &&usize| {
            let is_last = |v: &usize| left.get(v).is_some_and(|&n| n == 1);
            let zips = ends[i].iter().any(is_last);
            (!zips, !ends[i].iter().any(|v| reached.contains(v)), i)
        };
        let Some(&next) = waiting.iter().min_by_key(rank) else { break };
        left = close(next, &mut waiting, &mut reached);
        steps.push(Step { number: next + 1, attaches: None });
    }
    Assembly { stretches, steps }
}

/// The vertices at the two ends of a stretch.
fn ends(net: &Net, stretch: &Stretch) -> [usize; 2] {
    let inner = |i: usize, j: usize| {
        let (a, b) = (net.seams[stretch.seams[i].0].edge, net.seams[stretch.seams[j].0].edge);
        if b.contains(&a[0]) { a[1] } else { a[0] }
    };
    match stretch.seams.len() {
        1 => net.seams[stretch.seams[0].0].edge,
        n => [inner(0, 1), inner(n - 1, n - 2)],
    }
}

/// One step for every piece but the first of each body.
fn attach_all(net: &Net, stretches: &[Stretch]) -> Vec<Step> {
    let mut loose: BTreeSet<PieceId> = net.pieces.iter().map(|p| p.id).collect();
    let mut steps = Vec::new();
    while !loose.is_empty() {
        let largest = net.pieces.iter().filter(|p| loose.contains(&p.id));
        let largest =
            largest.max_by(|a, b| signed_area(&a.outline).total_cmp(&signed_area(&b.outline)).then(b.id.cmp(&a.id)));
        let Some(first) = largest.map(|p| p.id) else { break };
        loose.remove(&first);
        let mut body = BTreeSet::from([first]);
        loop {
            let joins = |s: &&Stretch| body.contains(&s.pieces[0]) != body.contains(&s.pieces[1]);
            let longer =
                |a: &&Stretch, b: &&Stretch| a.length(net).total_cmp(&b.length(net)).then(b.number.cmp(&a.number));
            let Some(next) = stretches.iter().filter(joins).max_by(longer) else { break };
            let new = if body.contains(&next.pieces[0]) { next.pieces[1] } else { next.pieces[0] };
            body.insert(new);
            loose.remove(&new);
            steps.push(Step { number: next.number, attaches: Some(new) });
        }
    }
    steps
}
