//! Families of lengths: panels that were solved for are solved for again, their edges drawn to few
//! lengths, weakly first and then as strongly as they stand it.
//!
//! A mesh with three edges at every vertex has three unknowns for each panel, its plane, and three
//! edges for each. So how few lengths there can be depends on the rim and on what the distance from the
//! surface leaves; how far it went is measured and said.

use std::collections::BTreeMap;

use super::kinds::ALIKE;
use super::outcomes::{FamilyReport, Place};
use super::refine::edge;
use super::solve::{Run, Weights, wanted_lengths};
use super::{Model, PanelizeFinding, Solved};
use crate::progress::Progress;

/// Rounds of drawing edges to their lengths, and of making these exact.
const ROUNDS: usize = 40;
const POLISH: usize = 12;
/// How strongly edges are drawn to the length of their family at the end: the ways that are tried.
const STRENGTHS: [f64; 4] = [0.8, 3.0, 12.0, 50.0];
/// Panels that would leave the surface by more are not taken, in panel sizes, unless they did before.
const MOST_OFF: f64 = 0.1;

impl Model {
    /// The panels with edges of few lengths: of the ways that break no panel the one with the most
    /// edges of such lengths; as they were when there is none.
    pub(super) fn with_families(
        &self,
        before: Solved,
        count: usize,
        progress: &dyn Progress,
    ) -> Solved {
        let scene = self.scene();
        let deviation =
            |solved: &Solved| solved.measured.iter().map(|m| m.deviation).fold(0.0, f64::max);
        let broken = |solved: &Solved| {
            let unsound = solved.measured.iter().filter(|m| !m.is_sound).count();
            unsound + solved.through.len() + usize::from(solved.lack > super::EXACT)
        };
        let most_off = deviation(&before).max(MOST_OFF);
        let mut best: Option<(usize, Solved)> = None;
        for (i, strength) in STRENGTHS.into_iter().enumerate() {
            if progress.is_cancelled() {
                break;
            }
            let mut state = before.state.clone();
            let weights = Weights { family: strength, ..Weights::default() };
            let families = Some(count);
            let run =
                Run { rounds: ROUNDS, from: 300.0, to: 300.0, weights, active: None, families };
            state.run(scene, run, |round| {
                let all = STRENGTHS.len() * ROUNDS;
                progress.report("drawing edges to few lengths", i * ROUNDS + round, all);
                progress.is_cancelled()
            });
            state.polish_families(scene, POLISH, count);
            let rings = before.rings.clone();
            let solved = self.finish(state, rings, before.was_stopped);
            if broken(&solved) > broken(&before) || deviation(&solved) > most_off {
                continue;
            }
            let alike = lengths(&solved, count).iter().filter(|(_, off)| **off <= ALIKE).count();
            if best.as_ref().is_none_or(|(most, _)| alike > *most) {
                best = Some((alike, solved));
            }
        }
        let off_before = lengths(&before, count).values().copied().fold(0.0, f64::max);
        let was = (before.kinds.edges, before.kinds.panels, deviation(&before), off_before);
        let mut solved = best.map_or(before, |(_, solved)| solved);
        solved.families = Some(self.family_report(&solved, count, was));
        solved
    }

    /// What was reached, beside the lengths, the kinds of panels, the deviation and the distance of an
    /// edge from its family before.
    fn family_report(
        &self,
        solved: &Solved,
        count: usize,
        (edges, panels, deviation, off): (usize, usize, f64, f64),
    ) -> FamilyReport {
        let found = lengths(solved, count);
        let now = solved.measured.iter().map(|m| m.deviation).fold(0.0, f64::max);
        let mut missed: Vec<Place> = Vec::new();
        let is_enough = solved.kinds.edges <= count;
        let points = &solved.state.panels.points;
        for (&[u, v], &off) in found.iter().filter(|(_, off)| **off > ALIKE && !is_enough) {
            missed.push(Place {
                finding: PanelizeFinding::ManyLengths,
                element: solved.state.fans[u].first().copied().unwrap_or_default(),
                measured: off * self.size,
                place: self.place(points[u].midpoint(points[v])),
            });
        }
        missed.sort_by(|a, b| b.measured.total_cmp(&a.measured).then(a.element.cmp(&b.element)));
        FamilyReport {
            asked: count,
            edges: found.len(),
            lengths: [edges, solved.kinds.edges],
            alike: found.values().filter(|off| **off <= ALIKE).count(),
            panels: [panels, solved.kinds.panels],
            deviation_mm: [deviation * self.size, now * self.size],
            off_mm: [off * self.size, found.values().copied().fold(0.0, f64::max) * self.size],
            tolerance_mm: ALIKE * self.size,
            missed,
        }
    }
}

/// How far each edge is from the length of its family, of so many that suit the edges best.
fn lengths(solved: &Solved, count: usize) -> BTreeMap<[usize; 2], f64> {
    let panels = &solved.state.panels;
    let off = |([u, v], wanted): ([usize; 2], f64)| {
        (edge(u, v), (panels.points[u].distance(panels.points[v]) - wanted).abs())
    };
    wanted_lengths(panels, count).into_iter().map(off).collect()
}
