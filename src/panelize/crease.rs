//! Creases: edges of the input that fold by more than a limit. The surface is cut open along them,
//! so that neither curvature nor rows nor regions of one side see the other. Both sides are joined
//! again where regions become panels (`regions`), and what holds their corners on the crease is
//! worked out here.
//!
//! What can be exact: panels that share an edge, and each have an edge on one straight line, lie in
//! one plane, since two planes through the line meet nowhere else. So a straight crease is kept to
//! the last digit where both sides are flat along it. Where one side is flat, corners lie in it
//! exactly. Where neither is, each panel has three corners on the crease, which would lie on a line
//! if they all lay in one plane: so none is asked for, and corners are as near to the curve as the
//! panels allow.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::refine::{Triangles, edge};
use super::surface::{CORNER_TURN, Creases, Held, NONE, Surface};
use crate::measure::fold_angle;
use crate::mesh::Mesh;

/// Normals along a crease differ by less on a side that is flat there.
const FLAT: f64 = 1e-4;

/// An edge of the input that folds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fold {
    /// The ranks of its vertices among those of the mesh.
    pub ends: [usize; 2],
    /// Where they are, in mm.
    pub places: [DVec3; 2],
    /// By how much it folds, in radians.
    pub angle: f64,
}

/// The edges of a mesh that fold by more than `limit` radians.
pub(super) fn folds(mesh: &Mesh, limit: f64) -> Vec<Fold> {
    let mut rank = vec![NONE; mesh.vertex_slots()];
    mesh.vertices().enumerate().for_each(|(i, v)| rank[v.index()] = i);
    let fold = |e| {
        let angle = fold_angle(mesh, e).map_or(0.0, f64::abs);
        let [u, v] = mesh.edge_vertices(e);
        let places = [mesh.position(u), mesh.position(v)];
        (angle > limit).then(|| Fold { ends: [rank[u.index()], rank[v.index()]], places, angle })
    };
    mesh.edges().filter_map(fold).collect()
}

/// Without the folds that hang together over less than `least` mm: dents and noise.
pub(super) fn without_short(folds: Vec<Fold>, least: f64) -> Vec<Fold> {
    let count = folds.iter().flat_map(|f| f.ends).max().map_or(0, |last| last + 1);
    let mut parent: Vec<usize> = (0..count).collect();
    for fold in &folds {
        let (a, b) = (root(&mut parent, fold.ends[0]), root(&mut parent, fold.ends[1]));
        parent[a.max(b)] = a.min(b);
    }
    let mut lengths = vec![0.0; count];
    for fold in &folds {
        lengths[root(&mut parent, fold.ends[0])] += fold.places[0].distance(fold.places[1]);
    }
    folds.into_iter().filter(|f| lengths[root(&mut parent, f.ends[0])] >= least).collect()
}

impl Triangles {
    /// Marks folds as edges to be kept, or none.
    pub(super) fn keep(&mut self, folds: &[Fold], keeps: bool) {
        let kept = folds.iter().filter(|_| keeps).map(|fold| edge(fold.ends[0], fold.ends[1]));
        self.creases = kept.collect();
    }
}

fn root(parent: &mut [usize], mut v: usize) -> usize {
    while parent[v] != v {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    v
}

/// The surface of fine triangles, cut open along their creases.
pub(super) fn creased(triangles: Triangles) -> Surface {
    if triangles.creases.is_empty() {
        return Surface::new(triangles);
    }
    let creases = triangles.creases.clone();
    let (cut, names) = cut_open(&triangles);
    let mut surface = Surface::new(cut);
    let on_crease: BTreeSet<usize> = creases.iter().flatten().copied().collect();
    let names: Vec<usize> =
        names.into_iter().map(|n| if on_crease.contains(&n) { n } else { NONE }).collect();
    surface.creases = Seams { surface: &surface, creases: &creases, names: &names }.look();
    for (v, _) in names.iter().enumerate().filter(|(_, name)| **name != NONE) {
        surface.is_corner[v] = surface.creases.kept[v];
    }
    surface
}

/// The triangles with a vertex for each side of each crease, and the vertex that each was.
fn cut_open(triangles: &Triangles) -> (Triangles, Vec<usize>) {
    let corners = &triangles.corners;
    let mut sides: BTreeMap<[usize; 2], [usize; 2]> = BTreeMap::new();
    for (t, c) in corners.iter().enumerate() {
        (0..3).for_each(|i| {
            sides.insert([c[i], c[(i + 1) % 3]], [3 * t + i, 3 * t + (i + 1) % 3]);
        });
    }
    let mut parent: Vec<usize> = (0..3 * corners.len()).collect();
    for (&[a, b], &[at_a, at_b]) in &sides {
        if let (Some(&[other_b, other_a]), false) =
            (sides.get(&[b, a]), triangles.creases.contains(&edge(a, b)))
        {
            for (one, other) in [(at_a, other_a), (at_b, other_b)] {
                let (r, s) = (root(&mut parent, one), root(&mut parent, other));
                parent[r.max(s)] = r.min(s);
            }
        }
    }
    let (mut number, mut points, mut names) = (vec![NONE; parent.len()], Vec::new(), Vec::new());
    let mut made = Vec::with_capacity(corners.len());
    for (t, c) in corners.iter().enumerate() {
        made.push([0, 1, 2].map(|i| {
            let r = root(&mut parent, 3 * t + i);
            if number[r] == NONE {
                number[r] = points.len();
                points.push(triangles.points[c[i]]);
                names.push(c[i]);
            }
            number[r]
        }));
    }
    (Triangles { points, corners: made, creases: BTreeSet::new() }, names)
}

/// A surface that was cut open, on the way to its [`Creases`].
struct Seams<'a> {
    surface: &'a Surface,
    creases: &'a BTreeSet<[usize; 2]>,
    names: &'a [usize],
}

/// What meets at a vertex on a crease: the directions of edges.
#[derive(Default)]
struct Around {
    creases: Vec<DVec3>,
    rims: Vec<DVec3>,
}

impl Around {
    /// Whether it stays a corner of panels: a crease meets the rim or others, or turns.
    fn stays(&self) -> bool {
        !self.rims.is_empty() || self.creases.len() > 2 || turns(&self.creases)
    }
}

/// Whether two directions are those of a line that turns sharply.
fn turns(ways: &[DVec3]) -> bool {
    matches!(ways, [a, b] if -a.dot(*b) < CORNER_TURN.to_radians().cos())
}

impl Seams<'_> {
    fn look(&self) -> Creases {
        let across = self.across();
        let around = self.around(&across);
        let at = |test: &dyn Fn(&Around) -> bool| -> Vec<bool> {
            self.names.iter().map(|name| around.get(name).is_some_and(test)).collect()
        };
        let stops = at(&|here| here.stays() || here.creases.len() == 1);
        let held = self.held(&across, &stops);
        Creases {
            kept: at(&Around::stays),
            outer: at(&|here| !here.rims.is_empty()),
            turns: at(&|here| turns(&here.rims)),
            names: self.names.to_vec(),
            parts: self.parts(),
            across,
            stops,
            held,
        }
    }

    /// Of each vertex from which the rim runs along a crease: where the same edge begins on the
    /// other side.
    fn across(&self) -> Vec<usize> {
        let next = &self.surface.rim_next;
        let mut starts: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for (v, &end) in next.iter().enumerate().filter(|(_, end)| **end != NONE) {
            let ends = [self.names[v], self.names[end]];
            if !ends.contains(&NONE) && self.creases.contains(&edge(ends[0], ends[1])) {
                starts.insert(ends, v);
            }
        }
        let mut across = vec![NONE; next.len()];
        for (&[a, b], &v) in &starts {
            across[v] = starts.get(&[b, a]).copied().unwrap_or(NONE);
        }
        across
    }

    /// What meets at each vertex on a crease, by its name.
    fn around(&self, across: &[usize]) -> BTreeMap<usize, Around> {
        let surface = self.surface;
        let mut around: BTreeMap<usize, Around> = BTreeMap::new();
        for (v, &next) in surface.rim_next.iter().enumerate() {
            if next == NONE {
                continue;
            }
            let way = (surface.points[next] - surface.points[v]).normalize_or_zero();
            for (end, way) in [(v, way), (next, -way)] {
                if self.names[end] == NONE {
                    continue;
                }
                let here = around.entry(self.names[end]).or_default();
                if across[v] == NONE {
                    here.rims.push(way);
                } else if v < across[v] {
                    here.creases.push(way);
                }
            }
        }
        around
    }

    /// What holds corners on the edge that begins at each vertex.
    fn held(&self, across: &[usize], stops: &[bool]) -> Vec<[Held; 2]> {
        let surface = self.surface;
        let count = surface.points.len();
        let mut normals = vec![DVec3::ZERO; count];
        for &[a, b, c] in &surface.triangles {
            let [p, q, r] = [a, b, c].map(|v| surface.points[v]);
            let normal = (q - p).cross(r - p).normalize_or_zero();
            for [u, v] in [[a, b], [b, c], [c, a]] {
                if surface.rim_next[u] == v {
                    normals[u] = normal;
                }
            }
        }
        let mut held = vec![[Held::default(); 2]; count];
        let on_crease = (0..count).filter(|&v| across[v] != NONE);
        for v in on_crease.clone() {
            held[v] = soft(surface, v, normals[v] + normals[across[v]]);
        }
        let mut seen = vec![false; count];
        for start in on_crease.clone().filter(|&v| stops[v]).chain(on_crease) {
            let mut chain = Vec::new();
            let mut v = start;
            while across[v] != NONE && !seen[v] && (v == start || !stops[v]) {
                seen[v] = true;
                chain.push(v);
                v = surface.rim_next[v];
            }
            let sides = [
                chain.iter().map(|&v| normals[v]).collect(),
                chain.iter().map(|&v| normals[across[v]]).collect(),
            ];
            let Some([first, second]) = exact(surface, &chain, &sides) else { continue };
            for v in chain {
                held[v][0] = first;
                // Across the flat side; along a line that is exact the same all along.
                let along = (surface.points[surface.rim_next[v]] - surface.points[v]).normalize();
                let across = along.cross(first.normal);
                let normal = if second.is_hard { second.normal } else { across };
                held[v][1] = Held { normal, ..second };
            }
        }
        held
    }

    /// The connected part that each vertex belongs to.
    fn parts(&self) -> Vec<usize> {
        let mut parts = vec![NONE; self.surface.points.len()];
        let mut count = 0;
        for start in 0..parts.len() {
            let mut open = vec![start];
            while let Some(v) = open.pop() {
                if parts[v] == NONE {
                    parts[v] = count;
                    open.extend(self.surface.links.of(v));
                }
            }
            count += usize::from(parts[start] == count);
        }
        parts
    }
}

/// Two planes through an edge, neither of them exact.
fn soft(surface: &Surface, v: usize, up: DVec3) -> [Held; 2] {
    let along = (surface.points[surface.rim_next[v]] - surface.points[v]).normalize_or_zero();
    let up = (up - along * up.dot(along)).normalize_or_zero();
    [along.cross(up), up].map(|normal| Held { normal, is_hard: false })
}

/// What is exact of a crease between two of its stops, or all around: corners lie in a side that is
/// flat, and on the line where both are. `None` when neither is.
fn exact(surface: &Surface, chain: &[usize], sides: &[Vec<DVec3>; 2]) -> Option<[Held; 2]> {
    let means = [0, 1].map(|side| sides[side].iter().sum::<DVec3>().normalize_or_zero());
    let is_flat = [0, 1].map(|side| sides[side].iter().all(|n| n.distance(means[side]) < FLAT));
    let way = |v: usize| surface.points[surface.rim_next[v]] - surface.points[v];
    let along = chain.iter().map(|&v| way(v)).sum::<DVec3>().normalize_or_zero();
    let up = match is_flat {
        [true, true] => (means[0] + means[1]).normalize_or_zero(),
        [true, false] => means[0],
        [false, true] => means[1],
        [false, false] => return None,
    };
    let is_line = is_flat == [true, true];
    let first = Held { normal: up, is_hard: true };
    Some([first, Held { normal: along.cross(up).normalize_or_zero(), is_hard: is_line }])
}
