//! Constructed planes: what is nearer than rounding meets in one point.

use std::collections::BTreeMap;

use glam::DVec3;

use super::half_space::HalfSpace;
use super::meeting::{exact_meeting, widest_triple};
use super::polytope::{Polygons, Polytope};

/// Contracts all edges shorter than the rounding bound of the solid, or than `resolution`. Faces
/// that lose their area go, and vertices that lie on an edge with them.
///
/// Also returns the half-spaces whose face is still there but narrower than the bound: slivers,
/// which cannot be contracted.
pub(super) fn contract(
    polytope: &Polytope,
    half_spaces: &[HalfSpace],
    resolution: f64,
) -> (Polytope, Vec<u32>) {
    let bound = polytope.rounding().max(resolution);
    let heads = short_edges_joined(polytope, bound);
    let is_unchanged = heads.iter().enumerate().all(|(v, &head)| v as u32 == head);
    let mut runs: Vec<Vec<u32>> = polytope.faces.iter().map(|run| mapped(run, &heads)).collect();
    if !is_unchanged {
        while drop_flat_parts(&mut runs, polytope.vertices.len()) {}
    }
    let is_sliver = |run: &Vec<u32>| !run.is_empty() && width(run, &polytope.vertices) <= bound;
    let pairs = || polytope.half_spaces.iter().zip(&runs);
    let slivers: Vec<u32> = pairs().filter(|(_, run)| is_sliver(run)).map(|(&i, _)| i).collect();
    if is_unchanged {
        return (polytope.clone(), slivers);
    }
    (compacted(polytope, half_spaces, &heads, &runs), slivers)
}

/// For each vertex the lowest one that short edges join it to, and which lies no farther than two
/// bounds away: a row of short edges does not carry a vertex off.
fn short_edges_joined(polytope: &Polytope, bound: f64) -> Vec<u32> {
    let at = |v: u32| polytope.vertices[v as usize];
    let mut heads: Vec<u32> = (0..polytope.vertices.len() as u32).collect();
    for run in polytope.faces.iter() {
        for (i, &v) in run.iter().enumerate() {
            let u = run[(i + 1) % run.len()];
            if at(u).distance(at(v)) > bound {
                continue;
            }
            let (a, b) = (head(&mut heads, u), head(&mut heads, v));
            if at(a).distance(at(b)) <= 2.0 * bound {
                heads[a.max(b) as usize] = a.min(b);
            }
        }
    }
    (0..heads.len() as u32).map(|v| head(&mut heads, v)).collect()
}

fn head(heads: &mut [u32], mut v: u32) -> u32 {
    while heads[v as usize] != v {
        let up = heads[heads[v as usize] as usize];
        heads[v as usize] = up;
        v = up;
    }
    v
}

/// The run with joined vertices, each once in a row; empty when fewer than three are left.
fn mapped(run: &[u32], heads: &[u32]) -> Vec<u32> {
    let mut mapped: Vec<u32> = run.iter().map(|&v| heads[v as usize]).collect();
    mapped.dedup();
    while mapped.len() > 1 && mapped.first() == mapped.last() {
        mapped.pop();
    }
    if mapped.len() < 3 { Vec::new() } else { mapped }
}

/// Takes out vertices at which only two faces are left, and then faces with fewer than three;
/// whether there was any.
fn drop_flat_parts(runs: &mut [Vec<u32>], vertices: usize) -> bool {
    let mut valence = vec![0_u32; vertices];
    runs.iter().flatten().for_each(|&v| valence[v as usize] += 1);
    let mut has_changed = false;
    for run in runs {
        let before = run.len();
        run.retain(|&v| valence[v as usize] > 2);
        if run.len() < 3 {
            run.clear();
        }
        has_changed |= run.len() != before;
    }
    has_changed
}

/// The least extent of a polygon across one of its edges.
fn width(run: &[u32], vertices: &[DVec3]) -> f64 {
    let at = |i: usize| vertices[run[i % run.len()] as usize];
    let across = |i: usize| {
        let along = (at(i + 1) - at(i)).normalize_or_zero();
        (0..run.len()).map(|j| along.cross(at(j) - at(i)).length()).fold(0.0, f64::max)
    };
    // Short polygons only: a sliver's long edge is its longest.
    let longest = (0..run.len()).max_by(|&i, &j| {
        at(i).distance_squared(at(i + 1)).total_cmp(&at(j).distance_squared(at(j + 1)))
    });
    longest.map_or(0.0, across)
}

/// The solid of the runs that are left, with joined vertices placed anew.
fn compacted(
    polytope: &Polytope,
    half_spaces: &[HalfSpace],
    heads: &[u32],
    runs: &[Vec<u32>],
) -> Polytope {
    let mut number = vec![u32::MAX; heads.len()];
    let mut heads_left = Vec::new();
    let mut faces = Polygons::with_capacity(runs.len(), runs.iter().map(Vec::len).sum());
    let mut kept = Vec::new();
    for (&i, run) in polytope.half_spaces.iter().zip(runs).filter(|(_, run)| !run.is_empty()) {
        for &v in run.iter() {
            if number[v as usize] == u32::MAX {
                number[v as usize] = heads_left.len() as u32;
                heads_left.push(v);
            }
        }
        kept.push(i);
        faces.push(run.iter().map(|&v| number[v as usize]));
    }
    let mut vertices: Vec<DVec3> =
        heads_left.iter().map(|&v| polytope.vertices[v as usize]).collect();
    for joint in joints(polytope, half_spaces, heads, runs) {
        let place = number[joint.head as usize];
        if place != u32::MAX {
            vertices[place as usize] = joint.place(polytope.interior);
        }
    }
    Polytope { vertices, half_spaces: kept, faces, interior: polytope.interior }
}

/// Vertices that become one.
struct Joint<'a> {
    head: u32,
    /// Where they lay, each right.
    members: Vec<DVec3>,
    /// The planes of the faces that are left there.
    planes: Vec<&'a HalfSpace>,
}

fn joints<'a>(
    polytope: &Polytope,
    half_spaces: &'a [HalfSpace],
    heads: &[u32],
    runs: &[Vec<u32>],
) -> Vec<Joint<'a>> {
    let mut joints: BTreeMap<u32, Joint<'a>> = BTreeMap::new();
    for (v, &head) in (0..).zip(heads).filter(|&(v, &head)| v != head) {
        let empty =
            || Joint { head, members: vec![polytope.vertices[head as usize]], planes: Vec::new() };
        joints.entry(head).or_insert_with(empty).members.push(polytope.vertices[v as usize]);
    }
    for (&i, run) in polytope.half_spaces.iter().zip(runs) {
        for v in run {
            if let Some(joint) = joints.get_mut(v) {
                joint.planes.push(&half_spaces[i as usize]);
            }
        }
    }
    joints.into_values().collect()
}

impl Joint<'_> {
    /// The meeting point of three planes that meet steeply or, where another plane passes that
    /// farther off than one of the old vertices, the best of these.
    fn place(&self, interior: DVec3) -> DVec3 {
        let off = |x: DVec3| {
            let distance = |h: &&HalfSpace| (h.slack(x) / h.normal.length()).abs();
            self.planes.iter().map(distance).fold(0.0, f64::max)
        };
        let least = self.members.iter().copied().min_by(|&x, &y| off(x).total_cmp(&off(y)));
        let best = least.unwrap_or_default();
        match self.steepest(interior) {
            Some(x) if off(x) <= off(best) || x.distance(best) <= self.extent() => x,
            _ => best,
        }
    }

    /// How far from the first of the old vertices the others lay.
    fn extent(&self) -> f64 {
        self.members.iter().map(|x| x.distance(self.members[0])).fold(0.0, f64::max)
    }

    fn steepest(&self, interior: DVec3) -> Option<DVec3> {
        let dual: Vec<DVec3> = self.planes.iter().map(|h| h.normal / h.slack(interior)).collect();
        if dual.len() < 3 {
            return None;
        }
        exact_meeting(widest_triple(&dual).map(|i| self.planes[i]))
    }
}
