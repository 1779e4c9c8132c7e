//! Small holes, closed by one flat face or by triangles.

use std::collections::{HashMap, HashSet};

use glam::DVec2;

use super::super::soup::{Side, Soup, SoupFace, by_edge};
use super::{Repair, Repairs};
use crate::geom::polygon::signed_area;
use crate::geom::{Frame, Plane, triangulate};

/// Closes the holes of which no two corners are farther apart than `widest`.
pub(super) fn close(soup: &mut Soup, widest: f64, near: f64, repairs: &mut Repairs) {
    let sides = soup.sides();
    let edges = by_edge(&sides);
    let mut known: HashMap<[u32; 2], ()> =
        edges.iter().map(|e| (sides[e[0] as usize].ends(), ())).collect();
    let rims = edges.iter().filter(|e| e.len() == 1).map(|e| sides[e[0] as usize]);
    let (mut closed, mut left) = (0, 0);
    for hole in loops(rims) {
        if !is_small(soup, &hole, widest) {
            continue;
        }
        match lids(soup, &hole, near, &known) {
            Some(lids) => {
                for lid in &lids {
                    let n = lid.len();
                    for i in 0..n {
                        let (a, b) = (lid[i], lid[(i + 1) % n]);
                        known.insert([a.min(b), a.max(b)], ());
                    }
                }
                soup.faces
                    .extend(lids.into_iter().map(|corners| SoupFace { corners, source: None }));
                closed += 1;
            }
            None => left += 1,
        }
    }
    repairs.add(Repair::ClosedHoles, closed);
    repairs.add(Repair::LeftHoles, left);
}

/// The corners of each hole, in the order of a face that would close it.
fn loops(rims: impl Iterator<Item = Side>) -> Vec<Vec<u32>> {
    let rims: Vec<Side> = rims.collect();
    // A face in the hole runs against its neighbours.
    let onwards: HashMap<u32, u32> = rims.iter().map(|s| (s.to, s.from)).collect();
    let mut is_done: HashMap<u32, bool> = HashMap::new();
    let mut loops = Vec::new();
    for side in &rims {
        let mut hole = Vec::new();
        let mut v = side.to;
        while !std::mem::replace(is_done.entry(v).or_default(), true) {
            hole.push(v);
            match onwards.get(&v) {
                Some(&next) => v = next,
                None => break,
            }
        }
        if hole.len() > 2 && hole.first() == Some(&v) {
            loops.push(hole);
        }
    }
    loops
}

fn is_small(soup: &Soup, hole: &[u32], widest: f64) -> bool {
    let place = |v: &u32| soup.positions[*v as usize];
    hole.iter()
        .enumerate()
        .all(|(i, a)| hole[..i].iter().all(|b| place(a).distance(place(b)) <= widest))
}

/// The faces that close a hole: one where it is flat, else triangles that make no edge twice; `None`
/// where the hole seen from the front is no simple polygon.
fn lids(
    soup: &Soup,
    hole: &[u32],
    near: f64,
    known: &HashMap<[u32; 2], ()>,
) -> Option<Vec<Vec<u32>>> {
    let places: Vec<_> = hole.iter().map(|&v| soup.positions[v as usize]).collect();
    let plane = Plane::newell(&places)?;
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = places.iter().map(|&p| frame.flatten(p)).collect();
    let triangles = triangulate(&flat);
    let area = |t: &[usize; 3]| signed_area(&t.map(|i| flat[i]));
    // What is narrower than `near` is an empty face, which would go again.
    let is_wide = |t: &[usize; 3]| {
        let sides = [0, 1, 2].map(|i| flat[t[i]].distance(flat[t[(i + 1) % 3]]));
        2.0 * area(t) > near * sides.into_iter().fold(0.0, f64::max)
    };
    let whole = signed_area(&flat);
    let sum: f64 = triangles.iter().map(|t| area(t).abs()).sum();
    let is_simple = triangles.iter().all(is_wide) && sum <= whole * (1.0 + 1e-9);
    if !is_simple {
        return None;
    }
    if places.iter().all(|&p| plane.signed_distance(p).abs() <= near) {
        return Some(vec![hole.to_vec()]);
    }
    let lids = || triangles.iter().map(|t| t.map(|i| hole[i]).to_vec()).collect();
    fill_hole(&triangles, hole, known).then(lids)
}

/// Whether triangles fill a hole once: each of its sides belongs to one of them, and every other edge
/// is new and belongs to two that run against each other there.
fn fill_hole(triangles: &[[usize; 3]], hole: &[u32], known: &HashMap<[u32; 2], ()>) -> bool {
    let n = hole.len();
    let runs: Vec<[usize; 2]> =
        triangles.iter().flat_map(|t| [0, 1, 2].map(|i| [t[i], t[(i + 1) % 3]])).collect();
    let all: HashSet<[usize; 2]> = runs.iter().copied().collect();
    let is_side = |[a, b]: [usize; 2]| (a + 1) % n == b;
    let is_new =
        |[a, b]: [usize; 2]| !known.contains_key(&[hole[a].min(hole[b]), hole[a].max(hole[b])]);
    all.len() == runs.len()
        && runs.iter().all(|&[a, b]| match is_side([a, b]) {
            true => !all.contains(&[b, a]),
            false => all.contains(&[b, a]) && !is_side([b, a]) && is_new([a, b]),
        })
}
