//! Constructed planes: what is nearer than rounding meets in one point.

use glam::DVec3;

use super::half_space::HalfSpace;
use super::meeting::{meeting_point, widest_triple};
use super::polytope::{Polygons, Polytope};
use crate::geom::RoundingBound;

/// Contracts all edges shorter than the rounding bound of the solid. Faces that lose their area go,
/// and vertices that lie on an edge with them.
///
/// Also returns the half-spaces whose face is still there but narrower than the bound: slivers,
/// which cannot be contracted.
pub(super) fn contract(polytope: &Polytope, half_spaces: &[HalfSpace]) -> (Polytope, Vec<u32>) {
    let bound = bound(&polytope.vertices);
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

fn bound(vertices: &[DVec3]) -> f64 {
    let low = vertices.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let high = vertices.iter().copied().reduce(DVec3::max).unwrap_or_default();
    RoundingBound::of_box(low, high).length()
}

/// For each vertex the lowest one that short edges join it to.
fn short_edges_joined(polytope: &Polytope, bound: f64) -> Vec<u32> {
    let mut heads: Vec<u32> = (0..polytope.vertices.len() as u32).collect();
    for run in polytope.faces.iter() {
        for (i, &v) in run.iter().enumerate() {
            let u = run[(i + 1) % run.len()];
            if polytope.vertices[u as usize].distance(polytope.vertices[v as usize]) <= bound {
                let (a, b) = (head(&mut heads, u), head(&mut heads, v));
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

/// The solid of the runs that are left, with the positions of joined vertices solved from planes
/// that meet there steeply.
fn compacted(
    polytope: &Polytope,
    half_spaces: &[HalfSpace],
    heads: &[u32],
    runs: &[Vec<u32>],
) -> Polytope {
    let mut is_joined = vec![false; heads.len()];
    for (v, &head) in heads.iter().enumerate() {
        is_joined[head as usize] |= head as usize != v;
    }
    let mut number = vec![u32::MAX; heads.len()];
    let mut vertices = Vec::new();
    let mut planes: Vec<Vec<DVec3>> = Vec::new();
    let mut faces = Polygons::with_capacity(runs.len(), runs.iter().map(Vec::len).sum());
    let mut kept = Vec::new();
    for (&i, run) in polytope.half_spaces.iter().zip(runs).filter(|(_, run)| !run.is_empty()) {
        let h = &half_spaces[i as usize];
        let dual = h.normal / (h.offset - h.normal.dot(polytope.interior));
        for &v in run {
            if number[v as usize] == u32::MAX {
                number[v as usize] = vertices.len() as u32;
                vertices.push(polytope.vertices[v as usize]);
                planes.push(Vec::new());
            }
            if is_joined[v as usize] {
                planes[number[v as usize] as usize].push(dual);
            }
        }
        kept.push(i);
        faces.push(run.iter().map(|&v| number[v as usize]));
    }
    for (position, planes) in
        vertices.iter_mut().zip(&planes).filter(|(_, planes)| planes.len() > 2)
    {
        let solved = polytope.interior + meeting_point(widest_triple(planes));
        if solved.is_finite() {
            *position = solved;
        }
    }
    Polytope { vertices, half_spaces: kept, faces, interior: polytope.interior }
}
