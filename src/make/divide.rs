//! Divides a piece that no sheet can hold: halves it by area along folds, again and again, until
//! every part fits.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use glam::DVec2;

use crate::geom::polygon::signed_area;
use crate::net::{Net, PieceId};
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
    neighbours: Vec<Vec<(usize, usize)>>,
}

impl<'a> FoldGraph<'a> {
    fn new(net: &'a Net, id: PieceId) -> Option<Self> {
        let piece = net.pieces.iter().find(|p| p.id == id)?;
        let place: HashMap<usize, usize> =
            piece.faces.iter().enumerate().map(|(i, f)| (f.face, i)).collect();
        let mut neighbours = vec![Vec::new(); piece.faces.len()];
        for fold in net.folds.iter().filter(|f| f.piece == id) {
            let [a, b] = fold.faces.map(|f| place[&f]);
            neighbours[a].push((b, fold.id.0));
            neighbours[b].push((a, fold.id.0));
        }
        let polygons: Vec<&[DVec2]> = piece.faces.iter().map(|f| f.polygon.as_slice()).collect();
        let areas = polygons.iter().map(|p| signed_area(p)).collect();
        Some(Self { polygons, areas, neighbours })
    }

    /// Divides a connected part where a tree of its folds has nearly equal areas on both sides.
    fn halve(&self, part: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let mut parent: HashMap<usize, usize> = HashMap::from([(part[0], part[0])]);
        let members: HashSet<usize> = part.iter().copied().collect();
        let mut order = vec![part[0]];
        let mut next = 0;
        while let Some(&f) = order.get(next) {
            next += 1;
            for &(g, _) in self.neighbours[f].iter().filter(|(g, _)| members.contains(g)) {
                if let Entry::Vacant(place) = parent.entry(g) {
                    place.insert(f);
                    order.push(g);
                }
            }
        }
        let mut below: HashMap<usize, f64> = order.iter().map(|&f| (f, self.areas[f])).collect();
        for &f in order.iter().skip(1).rev() {
            let area = below[&f];
            *below.get_mut(&parent[&f]).expect("parents were visited") += area;
        }
        let whole = below[&part[0]];
        let unevenness = |f: usize| (whole / 2.0 - below[&f]).abs();
        let top = order
            .iter()
            .copied()
            .skip(1)
            .min_by(|&a, &b| unevenness(a).total_cmp(&unevenness(b)))
            .expect("two faces");
        let mut half = HashSet::from([top]);
        for &f in order.iter().skip(1) {
            if half.contains(&parent[&f]) {
                half.insert(f);
            }
        }
        order.into_iter().partition(|f| half.contains(f))
    }

    fn folds_between(&self, half: &[usize], rest: &[usize]) -> Vec<usize> {
        let rest: HashSet<usize> = rest.iter().copied().collect();
        let crossing =
            half.iter().flat_map(|&f| &self.neighbours[f]).filter(|(g, _)| rest.contains(g));
        crossing.map(|&(_, edge)| edge).collect()
    }
}
