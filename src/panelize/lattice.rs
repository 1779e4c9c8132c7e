//! The lattice of panel centres: each vertex of the fine mesh holds the nearest point of a
//! triangular lattice that neighbours agree on.
//!
//! After Jakob, Tarini, Panozzo, Sorkine-Hornung 2015, "Instant field-aligned meshes" (position
//! fields): sweeps of Gauss and Seidel over a hierarchy of ever fewer vertices, from the coarsest
//! to the finest. Few sweeps are better than many: a field that is relaxed for long trades good
//! regions for bad ones.

use glam::DVec3;

use super::curvature::Quadric;
use super::field::RowField;
use super::surface::Surface;
use crate::random::Rng;

/// Sweeps on each level but the finest, which has twice as many.
const SWEEPS: usize = 6;
/// The coarsest level has at most so many vertices, if matching goes so far.
const FEWEST: usize = 60;

/// One level of the hierarchy.
struct Level {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    rows: Vec<DVec3>,
    areas: Vec<f64>,
    sizes: Vec<f64>,
    /// The mirror planes that each lies on.
    masks: Vec<u8>,
    /// Pairs of neighbours, the lower first, ascending, with their weights.
    pairs: Vec<([usize; 2], f64)>,
    /// The vertex of the next coarser level that each belongs to.
    parents: Vec<usize>,
}

/// The lattice point that each vertex of the surface holds. `sizes` are the distances of panel
/// centres at the vertices.
pub(super) fn lattice(
    surface: &Surface,
    quadrics: &[Quadric],
    field: &RowField,
    sizes: &[f64],
    seed: u64,
) -> Vec<DVec3> {
    let mut rng = Rng::new(seed);
    let mut levels = vec![Level::finest(surface, quadrics, field, sizes)];
    loop {
        let last = levels.last_mut().expect("the finest level is there");
        if last.points.len() <= FEWEST {
            break;
        }
        let Some(coarser) = last.coarser(&mut rng) else { break };
        levels.push(coarser);
    }
    let mut held: Vec<DVec3> = levels.last().map_or(Vec::new(), |level| level.points.clone());
    for (depth, level) in levels.iter().enumerate().rev() {
        if !level.parents.is_empty() {
            held = level.parents.iter().map(|&p| held[p]).collect();
        }
        let sweeps = if depth == 0 { 2 * SWEEPS } else { SWEEPS };
        level.relax(&mut held, sweeps, &mut rng);
    }
    // Beyond a mirror plane stand images.
    let planes = surface.masks.iter().fold(0, |all, mask| all | mask);
    for axis in (0..3).filter(|axis| planes >> axis & 1 == 1) {
        held.iter_mut().for_each(|p| p[axis] = p[axis].abs());
    }
    held
}

impl Level {
    fn finest(surface: &Surface, quadrics: &[Quadric], field: &RowField, sizes: &[f64]) -> Self {
        Self {
            points: surface.points.clone(),
            normals: quadrics.iter().map(|q| q.normal).collect(),
            rows: (0..quadrics.len()).map(|v| field.direction(quadrics, v)).collect(),
            areas: surface.areas.clone(),
            sizes: sizes.to_vec(),
            masks: (0..quadrics.len()).map(|v| surface.mask(v)).collect(),
            pairs: surface.edges.iter().map(|&e| (e, 1.0)).collect(),
            parents: Vec::new(),
        }
    }

    /// The level on which vertices are joined in pairs that face alike and are of one size; `None`
    /// when hardly any can be joined.
    fn coarser(&mut self, rng: &mut Rng) -> Option<Self> {
        let count = self.points.len();
        let mut scored: Vec<(f64, [usize; 2])> = Vec::with_capacity(self.pairs.len());
        for &([i, j], _) in &self.pairs {
            let even = (self.areas[i] / self.areas[j]).min(self.areas[j] / self.areas[i]);
            scored.push((self.normals[i].dot(self.normals[j]) * even - rng.unit() * 0.05, [i, j]));
        }
        scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let (parents, children) = matched(count, scored.iter().map(|&(_, pair)| pair));
        if children.len() as f64 > 0.95 * count as f64 {
            return None;
        }
        let made = self.joined(&parents, &children);
        self.parents = parents;
        Some(made)
    }

    fn joined(&self, parents: &[usize], children: &[[usize; 2]]) -> Self {
        let areas: Vec<f64> = children.iter().map(|c| sum_once(c, |i| self.areas[i])).collect();
        let mean = |values: &[DVec3], k: usize| -> DVec3 {
            let [a, b] = children[k];
            if a == b {
                values[a]
            } else {
                (values[a] * self.areas[a] + values[b] * self.areas[b]) / areas[k]
            }
        };
        let all = 0..children.len();
        let normals: Vec<DVec3> = all
            .clone()
            .map(|k| mean(&self.normals, k).normalize_or(self.normals[children[k][0]]))
            .collect();
        // The field is smooth: the row of one child is good for both.
        let row = |k: usize| {
            let row = self.rows[children[k][0]];
            let flat = row - normals[k] * row.dot(normals[k]);
            flat.normalize_or(normals[k].any_orthonormal_vector())
        };
        let size = |k: usize| sum_once(&children[k], |i| self.areas[i] * self.sizes[i]) / areas[k];
        Self {
            points: all.clone().map(|k| mean(&self.points, k)).collect(),
            rows: all.clone().map(row).collect(),
            sizes: all.clone().map(size).collect(),
            masks: all.map(|k| self.masks[children[k][0]] | self.masks[children[k][1]]).collect(),
            pairs: joined_pairs(&self.pairs, parents),
            normals,
            areas,
            parents: Vec::new(),
        }
    }

    /// Sweeps over the vertices in random order: each takes the mean of what its neighbours hold,
    /// moved by whole lattice steps to where it agrees best, then the lattice point nearest to it.
    fn relax(&self, held: &mut [DVec3], sweeps: usize, rng: &mut Rng) {
        for (v, place) in held.iter_mut().enumerate() {
            *place -= self.normals[v] * (*place - self.points[v]).dot(self.normals[v]);
        }
        let near = self.weighted_links();
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        rng.shuffle(&mut order);
        for _ in 0..sweeps {
            for &v in &order {
                let (mut sum, mut total) = (held[v], 0.0);
                for &(u, weight) in near.of(v) {
                    let place = held[u] + self.lattice_step(u, sum - held[u]);
                    sum = (sum * total + place * weight) / (total + weight);
                    total += weight;
                    sum -= self.normals[v] * (sum - self.points[v]).dot(self.normals[v]);
                }
                let sum = self.on_mirrors(v, sum);
                held[v] = sum + self.lattice_step(v, self.points[v] - sum);
            }
        }
    }

    /// A lattice point moved so that the lattice is its own image across the mirror planes that a
    /// vertex lies on: one of the lines of points that run along a plane lies in it.
    fn on_mirrors(&self, v: usize, mut place: DVec3) -> DVec3 {
        for axis in (0..3).filter(|axis| self.masks[v] >> axis & 1 == 1) {
            let across = self.normals[v].cross(self.rows[v]);
            let angle = self.rows[v][axis].atan2(across[axis]).to_degrees().rem_euclid(60.0);
            // Lines across a row are half a step apart, lines along one as far as rows.
            let is_across = (angle - 30.0).abs() < 15.0;
            let step = self.sizes[v] * if is_across { 0.5 } else { 0.75_f64.sqrt() };
            place[axis] = step * (place[axis] / step).round();
        }
        place
    }

    /// The vector of the lattice at a vertex that is nearest to a given one.
    fn lattice_step(&self, v: usize, way: DVec3) -> DVec3 {
        let (row, size) = (self.rows[v], self.sizes[v]);
        let across = self.normals[v].cross(row);
        let (x, y) = (way.dot(row) / size, way.dot(across) / size);
        let height = 0.75_f64.sqrt();
        let b = y / height;
        let a = x - b / 2.0;
        let (mut best, mut least) = ((0.0, 0.0), f64::INFINITY);
        for (da, db) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
            let (a, b) = (a.floor() + da, b.floor() + db);
            let (px, py) = (a + b / 2.0, b * height);
            let distance = (px - x).powi(2) + (py - y).powi(2);
            if distance < least {
                (best, least) = ((px, py), distance);
            }
        }
        (row * best.0 + across * best.1) * size
    }

    fn weighted_links(&self) -> WeightedLinks {
        let mut starts = vec![0; self.points.len() + 1];
        self.pairs.iter().flat_map(|(pair, _)| pair).for_each(|&i| starts[i + 1] += 1);
        (0..self.points.len()).for_each(|i| starts[i + 1] += starts[i]);
        let mut next = starts.clone();
        let mut links = vec![(0, 0.0); 2 * self.pairs.len()];
        for &([i, j], weight) in &self.pairs {
            for (a, b) in [(i, j), (j, i)] {
                links[next[a]] = (b, weight);
                next[a] += 1;
            }
        }
        WeightedLinks { starts, links }
    }
}

struct WeightedLinks {
    starts: Vec<usize>,
    links: Vec<(usize, f64)>,
}

impl WeightedLinks {
    fn of(&self, v: usize) -> &[(usize, f64)] {
        &self.links[self.starts[v]..self.starts[v + 1]]
    }
}

/// Joins pairs greedily in the given order: the parent of each vertex, and the children of each
/// parent (the same one twice when it stayed alone).
fn matched(count: usize, pairs: impl Iterator<Item = [usize; 2]>) -> (Vec<usize>, Vec<[usize; 2]>) {
    let mut parents = vec![usize::MAX; count];
    let mut children = Vec::new();
    for [i, j] in pairs {
        if parents[i] == usize::MAX && parents[j] == usize::MAX {
            (parents[i], parents[j]) = (children.len(), children.len());
            children.push([i, j]);
        }
    }
    for (i, parent) in parents.iter_mut().enumerate() {
        if *parent == usize::MAX {
            *parent = children.len();
            children.push([i, i]);
        }
    }
    (parents, children)
}

/// The sum over the children, one that stands alone counted once.
fn sum_once([a, b]: &[usize; 2], value: impl Fn(usize) -> f64) -> f64 {
    if a == b { value(*a) } else { value(*a) + value(*b) }
}

fn joined_pairs(pairs: &[([usize; 2], f64)], parents: &[usize]) -> Vec<([usize; 2], f64)> {
    let mut made: Vec<([usize; 2], f64)> = pairs
        .iter()
        .map(|&([i, j], weight)| ([parents[i], parents[j]], weight))
        .filter(|([i, j], _)| i != j)
        .map(|([i, j], weight)| ([i.min(j), i.max(j)], weight))
        .collect();
    made.sort_by_key(|&(pair, _)| pair);
    made.dedup_by(|next, first| {
        let is_same = next.0 == first.0;
        if is_same {
            first.1 += next.1;
        }
        is_same
    });
    made
}
