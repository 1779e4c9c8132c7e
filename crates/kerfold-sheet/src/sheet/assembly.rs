//! In which order seams are closed, so that every piece is attached before what it belongs to is
//! closed around it.
//!
//! The largest piece comes first; each further piece is attached where it shares the longest
//! stretch with those before. Only then the rest is closed like a zip: always a stretch at one of
//! whose ends nothing else is open, for as long as there is one. What closes the body at last is
//! then one stretch, at which one can still reach inside.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use super::boundary::Boundaries;
use super::stretch::{Stretch, stretches};
use crate::geom::polygon::signed_area;
use crate::net::{Net, PieceId};

/// All steps, and the stretches that they name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assembly {
    /// The stretches by their number less one.
    pub stretches: Vec<Stretch>,
    /// What to do, in order.
    pub steps: Vec<AssemblyStep>,
}

/// One stretch is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AssemblyStep {
    /// The number of the stretch, as on the sheet.
    pub number: usize,
    /// The piece that this step attaches; nothing when both sides are connected already.
    pub attaches: Option<PieceId>,
}

/// Stretches that are closed in one step at most.
const TOGETHER: usize = 6;

impl Assembly {
    /// The steps as they are told: a piece is attached in a step of its own, stretches that are
    /// closed one after the other are put together, up to six.
    pub fn together(&self) -> Vec<&[AssemblyStep]> {
        let mut steps = self.steps.as_slice();
        let mut all = Vec::new();
        while let Some(first) = steps.first() {
            let closing = steps.iter().take(TOGETHER).take_while(|s| s.attaches.is_none()).count();
            let count = if first.attaches.is_some() { 1 } else { closing };
            let (group, rest) = steps.split_at(count);
            all.push(group);
            steps = rest;
        }
        all
    }
}

/// In which order the seams of a net are closed.
pub fn assembly_of(net: &Net) -> Assembly {
    assembly(net, stretches(net, &Boundaries::new(net)))
}

pub(crate) fn assembly(net: &Net, stretches: Vec<Stretch>) -> Assembly {
    let mut steps = attach_all(net, &stretches);
    let mut zip = Zip::new(stretches.iter().map(|s| ends(net, s)).collect());
    steps.iter().for_each(|step| zip.close(step.number - 1));
    while let Some(next) = zip.best() {
        zip.close(next);
        steps.push(AssemblyStep { number: next + 1, attaches: None });
    }
    Assembly { stretches, steps }
}

/// How soon a stretch is closed, the least first: nothing else open at an end is best, then an end
/// where something is closed already, then the lowest number.
type Rank = (bool, bool, usize);

/// The stretches that are still open, in the order in which they would be closed.
struct Zip {
    ends: Vec<[usize; 2]>,
    /// The stretches that end at a vertex.
    at: BTreeMap<usize, Vec<usize>>,
    /// How many open ends there are at a vertex.
    open: BTreeMap<usize, usize>,
    reached: BTreeSet<usize>,
    ranks: Vec<Option<Rank>>,
    waiting: BTreeSet<Rank>,
}

impl Zip {
    fn new(ends: Vec<[usize; 2]>) -> Self {
        let (mut at, mut open) = (BTreeMap::<usize, Vec<usize>>::new(), BTreeMap::new());
        for (i, v) in ends.iter().enumerate().flat_map(|(i, both)| both.map(|v| (i, v))) {
            at.entry(v).or_default().push(i);
            *open.entry(v).or_default() += 1;
        }
        // A net of one piece begins at a tip of its seams, too.
        let is_tip = |both: &[usize; 2]| both.iter().any(|v| open[v] == 1);
        let ranks: Vec<Option<Rank>> =
            ends.iter().enumerate().map(|(i, both)| Some((!is_tip(both), true, i))).collect();
        let waiting = ranks.iter().flatten().copied().collect();
        Self { ends, at, open, reached: BTreeSet::new(), ranks, waiting }
    }

    fn best(&self) -> Option<usize> {
        self.waiting.first().map(|rank| rank.2)
    }

    fn close(&mut self, i: usize) {
        if let Some(rank) = self.ranks[i].take() {
            self.waiting.remove(&rank);
        }
        for v in self.ends[i] {
            self.reached.insert(v);
            *self.open.entry(v).or_default() -= 1;
        }
        let changed: Vec<usize> = self.ends[i].iter().flat_map(|v| &self.at[v]).copied().collect();
        for j in changed {
            if let Some(old) = self.ranks[j] {
                let ends = &self.ends[j];
                let zips = ends.iter().any(|v| self.open[v] == 1);
                let rank = (!zips, !ends.iter().any(|v| self.reached.contains(v)), j);
                self.waiting.remove(&old);
                self.waiting.insert(rank);
                self.ranks[j] = Some(rank);
            }
        }
    }
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

/// A stretch that could attach a piece: the longest comes first, of equal ones that with the lowest
/// number.
#[derive(Debug, PartialEq)]
struct Reach {
    length: f64,
    number: usize,
}

impl Eq for Reach {}

impl Ord for Reach {
    fn cmp(&self, other: &Self) -> Ordering {
        self.length.total_cmp(&other.length).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Reach {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// One step for every piece but the first of each body.
fn attach_all(net: &Net, stretches: &[Stretch]) -> Vec<AssemblyStep> {
    let mut of_piece: BTreeMap<PieceId, Vec<usize>> = BTreeMap::new();
    for (i, piece) in stretches.iter().enumerate().flat_map(|(i, s)| s.pieces.map(|p| (i, p))) {
        of_piece.entry(piece).or_default().push(i);
    }
    let reaches = |piece: PieceId| {
        let own = of_piece.get(&piece).into_iter().flatten();
        own.map(|&i| Reach { length: stretches[i].length(net), number: stretches[i].number })
    };
    let mut by_size: Vec<(f64, PieceId)> =
        net.pieces.iter().map(|p| (signed_area(&p.outline), p.id)).collect();
    by_size.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut placed: BTreeSet<PieceId> = BTreeSet::new();
    let mut steps = Vec::new();
    for (_, first) in by_size {
        if !placed.insert(first) {
            continue;
        }
        let mut waiting: BinaryHeap<Reach> = reaches(first).collect();
        while let Some(Reach { number, .. }) = waiting.pop() {
            let new = stretches[number - 1].pieces.into_iter().find(|p| !placed.contains(p));
            if let Some(new) = new {
                placed.insert(new);
                waiting.extend(reaches(new));
                steps.push(AssemblyStep { number, attaches: Some(new) });
            }
        }
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::super::testing::{net_of, random_convex, square, twins, two_pieces};
    use super::*;

    #[test]
    fn the_other_piece_is_attached_once() {
        let assembly = assembly_of(&two_pieces());
        assert_eq!(assembly.steps, [AssemblyStep { number: 1, attaches: Some(PieceId(1)) }]);
        let assembly = assembly_of(&twins(square(40.0), 60.0));
        assert_eq!(assembly.steps.iter().filter(|s| s.attaches.is_some()).count(), 1);
        assert_eq!(assembly.steps.len(), assembly.stretches.len());
    }

    #[test]
    fn closing_steps_are_put_together_and_attaching_ones_stand_alone() {
        let assembly = assembly_of(&twins(random_convex(7), 60.0));
        let groups = assembly.together();
        assert_eq!(groups.concat(), assembly.steps);
        assert_eq!((groups[0].len(), groups[0][0].attaches.is_some()), (1, true));
        assert_eq!(groups.len(), 1 + (assembly.steps.len() - 1).div_ceil(TOGETHER));
    }

    #[test]
    fn two_bodies_are_assembled_one_after_the_other() {
        let (one, mut two) = (twins(square(40.0), 60.0), twins(square(30.0), 60.0));
        let (pieces, faces, vertices) = (one.pieces.len(), 2, 4);
        for piece in &mut two.pieces {
            piece.id.0 += pieces;
            for face in &mut piece.faces {
                face.face += faces;
                face.vertices.iter_mut().for_each(|v| *v += vertices);
            }
        }
        for seam in &mut two.seams {
            seam.id.0 += one.seams.len();
            seam.edge = seam.edge.map(|v| v + vertices);
            seam.sides
                .iter_mut()
                .for_each(|s| (s.piece.0, s.face) = (s.piece.0 + pieces, s.face + faces));
        }
        let mut both = one;
        both.pieces.extend(two.pieces);
        both.seams.extend(two.seams);
        let assembly = assembly_of(&both);
        assert_eq!(assembly.stretches.len(), 8);
        assert_eq!(assembly.steps.iter().filter(|s| s.attaches.is_some()).count(), 2);
        assert_eq!(assembly_of(&net_of(vec![square(3.0)])), Assembly::default());
    }
}
