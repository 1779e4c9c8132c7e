//! The centres of the panels: where the lattice has its points, mended where it tears.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::surface::{NONE, PANEL_AREA, Surface};
use crate::geom::Grid;

/// Vertices hold one lattice point when theirs are nearer than this, in local panel sizes.
const SAME: f64 = 0.35;
/// Clusters with a smaller share of a panel's area are none.
const LEAST_CLUSTER: f64 = 0.3;
/// Sites nearer than this, in local panel sizes, are too near.
const TOO_NEAR: f64 = 0.62;
/// Panels with a smaller share of the area they should have are dropped.
const LEAST_AREA: f64 = 0.45;
/// A vertex farther from its site gets a site of its own, in local panel sizes.
const HOLE: f64 = 0.86;
/// Panels whose middle is nearer to a mirror plane lie across it, in local panel sizes.
const ACROSS: f64 = 0.35;
/// The most rounds of filling and thinning.
const ROUNDS: usize = 6;

/// What the layout is made on: the surface and the panel size at each vertex.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub surface: &'a Surface,
    /// The distance of neighbouring panel centres at each vertex, in units of the mean panel size.
    pub sizes: &'a [f64],
}

/// Vertices in clusters that hold one lattice point each make the first sites.
pub(super) fn sites_of_lattice(ground: Ground<'_>, held: &[DVec3]) -> Vec<usize> {
    let Ground { surface, sizes } = ground;
    let cluster = clusters(ground, held);
    let count = cluster.iter().max().map_or(0, |last| last + 1);
    let (mut areas, mut points) = (vec![0.0; count], vec![DVec3::ZERO; count]);
    let (mut means, mut is_rim) = (vec![DVec3::ZERO; count], vec![false; count]);
    for (v, &c) in cluster.iter().enumerate() {
        areas[c] += surface.areas[v];
        points[c] += held[v] * surface.areas[v];
        means[c] += surface.points[v] * surface.areas[v];
        is_rim[c] |= surface.is_outer_rim(v);
    }
    // At a rim the lattice point may lie outside; the middle of what is there does not.
    let middle = |c: usize| if is_rim[c] { means[c] / areas[c] } else { points[c] / areas[c] };
    let middles: Vec<DVec3> = (0..count).map(middle).collect();
    let mut nearest = nearest_members(surface, &cluster, &middles, |_, _| true);
    for v in nearest.iter_mut().filter(|v| **v != NONE) {
        *v = surface.snapped(*v, ACROSS * sizes[*v]);
    }
    // Of a panel across a mirror plane there is a part on either side.
    let areas: Vec<f64> = (0..count).map(|c| areas[c] / surface.share(nearest[c])).collect();
    let full = |c: usize| PANEL_AREA * sizes[nearest[c]].powi(2);
    let mut order: Vec<usize> =
        (0..count).filter(|&c| areas[c] > 0.0 && areas[c] > LEAST_CLUSTER * full(c)).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
    let candidates: Vec<usize> = order.iter().map(|&c| nearest[c]).collect();
    thinned(ground, &candidates)
}

/// Which cluster each vertex belongs to.
fn clusters(ground: Ground<'_>, held: &[DVec3]) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..held.len()).collect();
    for &[i, j] in &ground.surface.edges {
        let near = SAME * ground.sizes[i].min(ground.sizes[j]);
        if held[i].distance(held[j]) < near {
            let (a, b) = (root(&mut parent, i), root(&mut parent, j));
            parent[a.max(b)] = a.min(b);
        }
    }
    let (mut number, mut count) = (vec![NONE; held.len()], 0);
    (0..held.len())
        .map(|v| {
            let r = root(&mut parent, v);
            if number[r] == NONE {
                number[r] = count;
                count += 1;
            }
            number[r]
        })
        .collect()
}

fn root(parent: &mut [usize], mut v: usize) -> usize {
    while parent[v] != v {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    v
}

/// For each group of vertices the one nearest to a place, of those that may be.
fn nearest_members(
    surface: &Surface,
    group: &[usize],
    places: &[DVec3],
    may: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    let mut best = vec![(f64::INFINITY, NONE); places.len()];
    for (v, &g) in group.iter().enumerate() {
        if g == NONE || !may(v, g) {
            continue;
        }
        let distance = surface.points[v].distance_squared(places[g]);
        if distance < best[g].0 {
            best[g] = (distance, v);
        }
    }
    best.into_iter().map(|(_, v)| v).collect()
}

/// The pins, and the candidates that do not come too near to an earlier one on the same side of the
/// surface.
fn thinned(ground: Ground<'_>, candidates: &[usize]) -> Vec<usize> {
    let Ground { surface, sizes } = ground;
    let widest = sizes.iter().fold(0.0, |a: f64, &b| a.max(b));
    let mut grid = Grid::new([0.0; 3], widest * TOO_NEAR);
    let mut kept: Vec<usize> = Vec::new();
    for &v in &surface.pins.sites {
        grid.insert(surface.points[v].to_array());
        kept.push(v);
    }
    for &v in candidates {
        if surface.pins.is_shadow.get(v) == Some(&true) {
            continue;
        }
        let place = surface.points[v];
        let is_free = grid.around(place.to_array()).all(|k| {
            let u = kept[k as usize];
            surface.points[u].distance(place) >= TOO_NEAR * sizes[u]
                || surface.normals[u].dot(surface.normals[v]) <= 0.0
                || surface.creases.are_apart(u, v)
        });
        if is_free {
            grid.insert(place.to_array());
            kept.push(v);
        }
    }
    kept
}

/// An entry of the front of growing regions; the nearest comes first.
#[derive(PartialEq)]
struct Growing {
    distance: f64,
    vertex: usize,
    label: usize,
}

impl Eq for Growing {}

impl Ord for Growing {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let ties = (self.vertex, self.label).cmp(&(other.vertex, other.label));
        self.distance.total_cmp(&other.distance).then(ties)
    }
}

impl PartialOrd for Growing {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// The site whose region each vertex belongs to: regions grow from the sites along edges, nearest
/// vertices first, so that each is connected. [`NONE`] where no site can be reached.
pub(super) fn regions(surface: &Surface, sites: &[usize]) -> Vec<usize> {
    let mut labels = vec![NONE; surface.points.len()];
    let mut front: BinaryHeap<Reverse<Growing>> = sites
        .iter()
        .enumerate()
        .map(|(label, &vertex)| Reverse(Growing { distance: 0.0, vertex, label }))
        .collect();
    // Panels of given vertices have these and no others.
    for (vertex, label) in labels.iter_mut().enumerate() {
        *label = surface.pins.owner(vertex).unwrap_or(NONE);
    }
    while let Some(Reverse(Growing { vertex, label, .. })) = front.pop() {
        if labels[vertex] != NONE {
            continue;
        }
        labels[vertex] = label;
        let from = surface.points[sites[label]];
        for &next in surface.links.of(vertex) {
            if labels[next] == NONE {
                let distance = surface.points[next].distance_squared(from);
                front.push(Reverse(Growing { distance, vertex: next, label }));
            }
        }
    }
    labels
}

/// The area of each region.
pub(super) fn region_areas(surface: &Surface, labels: &[usize], count: usize) -> Vec<f64> {
    let mut areas = vec![0.0; count];
    for (v, &label) in labels.iter().enumerate() {
        if label != NONE {
            areas[label] += surface.areas[v];
        }
    }
    areas
}

/// Moves sites to the middle of their regions (Lloyd 1982), only those at a rim when `rim_only`.
pub(super) fn relax(surface: &Surface, sites: &mut [usize], rounds: usize, rim_only: bool) {
    let pinned = surface.pins.sites.len();
    for _ in 0..rounds {
        let labels = regions(surface, sites);
        let areas = region_areas(surface, &labels, sites.len());
        let mut means = vec![DVec3::ZERO; sites.len()];
        let mut moves = vec![!rim_only; sites.len()];
        for (v, &label) in labels.iter().enumerate() {
            if label != NONE {
                means[label] += surface.points[v] * surface.areas[v] / areas[label];
                moves[label] |= surface.is_outer_rim(v);
            }
        }
        // Panels across mirror planes stay there.
        let stays = |v: usize, k: usize| surface.mask(v) == surface.mask(sites[k]);
        let nearest = nearest_members(surface, &labels, &means, stays);
        for (k, site) in sites.iter_mut().enumerate() {
            if k >= pinned && moves[k] && nearest[k] != NONE {
                *site = nearest[k];
            }
        }
    }
}

/// Adds sites where vertices are far from all, drops those whose region is small, and relaxes the
/// ones at rims, until there is nothing to mend.
pub(super) fn fill_and_thin(ground: Ground<'_>, sites: &mut Vec<usize>) {
    for _ in 0..ROUNDS {
        let labels = regions(ground.surface, sites);
        let added = holes(ground, sites, &labels);
        let dropped = too_small(ground, sites, &labels);
        if added.is_empty() && !dropped.contains(&true) {
            return;
        }
        let mut keep = dropped.iter();
        sites.retain(|_| keep.next() == Some(&false));
        sites.extend(added);
        relax(ground.surface, sites, 1, true);
    }
}

/// Vertices that lie far from their site and from each other.
fn holes(ground: Ground<'_>, sites: &[usize], labels: &[usize]) -> Vec<usize> {
    let Ground { surface, sizes } = ground;
    let mut distances: Vec<f64> = labels
        .iter()
        .enumerate()
        .map(|(v, &label)| {
            if label == NONE {
                return f64::INFINITY;
            }
            surface.points[v].distance(surface.points[sites[label]])
        })
        .collect();
    let is_free = |v: usize| surface.pins.owner(v).is_none();
    let mut added = Vec::new();
    let mut open: Vec<usize> =
        (0..labels.len()).filter(|&v| distances[v] >= HOLE * sizes[v] && is_free(v)).collect();
    while let Some(&farthest) =
        open.iter().max_by(|&&a, &&b| distances[a].total_cmp(&distances[b]).then(b.cmp(&a)))
    {
        let reach = ACROSS * sizes[farthest];
        added.push(surface.snapped(farthest, reach));
        for &v in &open {
            let distance = surface.points[v].distance(surface.points[farthest]);
            distances[v] = distances[v].min(distance);
        }
        open.retain(|&v| distances[v] >= HOLE * sizes[v]);
    }
    added
}

/// Which sites have too small a region; of those near each other only the smallest.
fn too_small(ground: Ground<'_>, sites: &[usize], labels: &[usize]) -> Vec<bool> {
    let Ground { surface, sizes } = ground;
    let areas = region_areas(surface, labels, sites.len());
    let mut small: Vec<usize> = (surface.pins.sites.len()..sites.len())
        .filter(|&k| {
            let share = LEAST_AREA * surface.share(sites[k]);
            areas[k] < share * PANEL_AREA * sizes[sites[k]].powi(2)
        })
        .collect();
    small.sort_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
    apart(surface, sites, &small, 1.2)
}

/// Marks those of some sites, in their order, that are not within `reach` of one marked before.
pub(super) fn apart(surface: &Surface, sites: &[usize], some: &[usize], reach: f64) -> Vec<bool> {
    let mut marked = vec![false; sites.len()];
    let mut grid = Grid::new([0.0; 3], reach);
    let mut chosen: Vec<DVec3> = Vec::new();
    for &k in some {
        let place = surface.points[sites[k]];
        let mut near = grid.around(place.to_array());
        if near.all(|i| chosen[i as usize].distance(place) > reach) {
            drop(near);
            grid.insert(place.to_array());
            chosen.push(place);
            marked[k] = true;
        }
    }
    marked
}
