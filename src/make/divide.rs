//! Divides a piece that no sheet can hold: halves it by area along folds, again and again, until
//! every part fits.

use std::collections::{HashMap, HashSet, VecDeque};

use glam::DVec2;

use crate::geom::polygon::signed_area;
use crate::net::{FoldKind, Net, PieceId};
use crate::sheet::smallest_box;

/// The room that a sheet offers: the longer and the shorter side of the largest box that fits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    pub longer: f64,
    pub shorter: f64,
}

impl Room {
    fn holds(self, points: &[DVec2]) -> bool {
        let needed = smallest_box(points);
        needed.width <= self.longer && needed.height <= self.shorter
    }
}

/// The folds of a piece that is too large to open, by edge number, so that its parts fit. It is
/// halved once in any case: a piece that fits by itself may be too large with its flaps. Where the
/// folds of the piece form rings, all folds between two parts are opened. A single face is never
/// divided.
pub(super) fn folds_to_open(net: &Net, id: PieceId, room: Room) -> Vec<usize> {
    let Some(graph) = FoldGraph::new(net, id) else { return Vec::new() };
    let mut open = Vec::new();
    let count = graph.polygons.len();
    let mut parts = vec![(0..count).collect::<Vec<usize>>()];
    while let Some(part) = parts.pop() {
        let points: Vec<DVec2> =
            part.iter().flat_map(|&f| graph.polygons[f].iter().copied()).collect();
        if part.len() > 1 && (part.len() == count || !room.holds(&points)) {
            let (half, rest) = graph.halve(&part);
            open.extend(graph.folds_between(&half, &rest));
            parts.push(half);
            parts.push(rest);
        }
    }
    open
}

/// The faces of a piece with the folds that join them.
struct FoldGraph<'a> {
    polygons: Vec<&'a [DVec2]>,
    areas: Vec<f64>,
    neighbours: Vec<Vec<Neighbour>>,
}

/// A face beyond a fold.
#[derive(Clone, Copy)]
struct Neighbour {
    face: usize,
    edge: usize,
    is_flat: bool,
}

/// A half of less than this share of a part is not worth sparing a flat fold.
const LEAST_SHARE: f64 = 0.1;

impl<'a> FoldGraph<'a> {
    fn new(net: &'a Net, id: PieceId) -> Option<Self> {
        let piece = net.pieces.iter().find(|p| p.id == id)?;
        let place: HashMap<usize, usize> =
            piece.faces.iter().enumerate().map(|(i, f)| (f.face, i)).collect();
        let mut neighbours = vec![Vec::new(); piece.faces.len()];
        for fold in net.folds.iter().filter(|f| f.piece == id) {
            let [a, b] = fold.faces.map(|f| place[&f]);
            let (edge, is_flat) = (fold.id.0, fold.kind == FoldKind::Flat);
            neighbours[a].push(Neighbour { face: b, edge, is_flat });
            neighbours[b].push(Neighbour { face: a, edge, is_flat });
        }
        let polygons: Vec<&[DVec2]> = piece.faces.iter().map(|f| f.polygon.as_slice()).collect();
        let areas = polygons.iter().map(|p| signed_area(p)).collect();
        Some(Self { polygons, areas, neighbours })
    }

    /// Divides a connected part where a tree of its folds has nearly equal areas on both sides, at
    /// a fold that is flat only where the others divide too little.
    fn halve(&self, part: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let tree = self.tree(part);
        let mut below: HashMap<usize, f64> =
            tree.iter().map(|branch| (branch.face, self.areas[branch.face])).collect();
        for branch in tree.iter().skip(1).rev() {
            let area = below[&branch.face];
            *below.get_mut(&branch.parent).expect("parents were visited") += area;
        }
        let whole = below[&part[0]];
        let share = |branch: &Branch| {
            let share = below[&branch.face] / whole;
            share.min(1.0 - share)
        };
        let is_poor = |branch: &Branch| branch.is_flat || share(branch) < LEAST_SHARE;
        let best = |a: &&Branch, b: &&Branch| {
            is_poor(a).cmp(&is_poor(b)).then(share(b).total_cmp(&share(a)))
        };
        let top = tree.iter().skip(1).min_by(best).expect("two faces").face;
        let mut half = HashSet::from([top]);
        for branch in tree.iter().skip(1) {
            if half.contains(&branch.parent) {
                half.insert(branch.face);
            }
        }
        tree.into_iter().map(|branch| branch.face).partition(|f| half.contains(f))
    }

    /// A tree over the faces of a part, breadth first from the first one; but what lies in one
    /// plane is connected by flat folds.
    fn tree(&self, part: &[usize]) -> Vec<Branch> {
        let members: HashSet<usize> = part.iter().copied().collect();
        let mut seen = HashSet::new();
        let mut tree = Vec::new();
        let root = Branch { face: part[0], parent: part[0], is_flat: false };
        let mut open = VecDeque::from([root]);
        while let Some(branch) = open.pop_front() {
            if !seen.insert(branch.face) {
                continue;
            }
            tree.push(branch);
            for next in self.neighbours[branch.face].iter().filter(|n| members.contains(&n.face)) {
                let Neighbour { face, is_flat, .. } = *next;
                let further = Branch { face, parent: branch.face, is_flat };
                if is_flat { open.push_front(further) } else { open.push_back(further) }
            }
        }
        tree
    }

    fn folds_between(&self, half: &[usize], rest: &[usize]) -> Vec<usize> {
        let rest: HashSet<usize> = rest.iter().copied().collect();
        let crossing =
            half.iter().flat_map(|&f| &self.neighbours[f]).filter(|n| rest.contains(&n.face));
        crossing.map(|n| n.edge).collect()
    }
}

/// A face of a tree, with the fold by which it hangs on another; the first hangs on itself.
#[derive(Clone, Copy)]
struct Branch {
    face: usize,
    parent: usize,
    is_flat: bool,
}
