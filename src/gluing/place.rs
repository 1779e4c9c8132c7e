//! From distances to positions, and positions mended until every edge has its length.

use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use super::GluingError;
use super::pyramid::apex;
use super::surface::Surface;
use crate::geom::ldl::solve_symmetric;
use crate::geom::polygon::{convex_hull, signed_area, smallest_rectangle};
use crate::geom::predicate::orient3d;
use crate::geom::{RoundingBound, fit_plane, sparse};
use crate::progress::Progress;

/// Newton steps on positions, at most, and rounds of flips between them.
const NEWTON: usize = 40;
const ROUNDS: usize = 60;
/// Edges are true when they differ by less than that part of the size.
pub(super) const TRUE: f64 = 1e-13;
/// A surface thinner than that part of its size may fold flat.
const NEARLY_FLAT: f64 = 0.1;
/// Steps of least squares until it lies flat.
const FLAT_STEPS: usize = 12;

/// Positions of the vertices, with all edges true and none hollow; and how far an edge differs at
/// most, in parts of the size.
pub(super) fn place(
    surface: &mut Surface,
    r: &[f64],
    progress: &dyn Progress,
) -> Result<(Vec<DVec3>, f64), GluingError> {
    let mut places = around_apex(surface, r);
    let size = extent(&places);
    for round in 0..ROUNDS {
        progress.report("placing corners", round, 0);
        if progress.is_cancelled() {
            return Err(GluingError::Cancelled);
        }
        let error = polish(surface, &mut places);
        if let Some(flat) = flat_shape(surface, &places) {
            return Err(flat);
        }
        if error > 10.0 * TRUE * size || error.is_nan() {
            return Err(GluingError::NotFound {
                fault: format!("an edge stays {:.1e} of the size too long or short", error / size),
            });
        }
        let hollow: Vec<usize> =
            surface.edges().filter(|&h| depth(surface, &places, h) > 0.0).collect();
        if hollow.is_empty() {
            return Ok((places, error / size));
        }
        let flipped = hollow.into_iter().filter(|&h| surface.flip(h)).count();
        if flipped == 0 {
            return Err(GluingError::NotFound {
                fault: "an edge bends inwards and cannot be flipped".to_owned(),
            });
        }
    }
    Err(GluingError::NotFound { fault: "edges kept bending inwards".to_owned() })
}

/// Whether pyramids that nearly close belong to a shape that folds flat.
pub(super) fn flat_of_apex(surface: &Surface, r: &[f64]) -> Option<GluingError> {
    flat_shape(surface, &around_apex(surface, r))
}

/// A surface near a plane folds flat when its triangles can be laid into that plane, all edges
/// true: found by least squares from where they are.
fn flat_shape(surface: &Surface, places: &[DVec3]) -> Option<GluingError> {
    let size = extent(places);
    let normal = fit_plane(places)?.normal();
    let heights = places.iter().map(|p| p.dot(normal));
    let thickness =
        heights.clone().fold(f64::NEG_INFINITY, f64::max) - heights.fold(f64::INFINITY, f64::min);
    if thickness > NEARLY_FLAT * size {
        return None;
    }
    let (x, y) = normal.any_orthonormal_pair();
    let mut flat: Vec<DVec2> = places.iter().map(|p| DVec2::new(p.dot(x), p.dot(y))).collect();
    let edges: Vec<usize> = surface.edges().collect();
    let ends = |h: usize| [surface.origin[h], surface.target(h)];
    let error = |flat: &[DVec2], h: usize| {
        let [i, j] = ends(h);
        surface.length[h] - flat[i].distance(flat[j])
    };
    for _ in 0..FLAT_STEPS {
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 2 * flat.len()];
        let mut right = vec![0.0; 2 * flat.len()];
        for &h in &edges {
            let [i, j] = ends(h);
            let d = (flat[i] - flat[j]).normalize_or_zero();
            let miss = error(&flat, h);
            let row: [(usize, f64); 4] =
                [(2 * i, d.x), (2 * i + 1, d.y), (2 * j, -d.x), (2 * j + 1, -d.y)];
            for (a, u) in row {
                right[a] += u * miss;
                rows[a].extend(row.map(|(b, v)| (b, u * v)));
            }
        }
        // Turning and sliding the shape costs nothing; that it stays is as good as any.
        rows.iter_mut().enumerate().for_each(|(a, row)| row.push((a, 1e-9)));
        let d = solve_symmetric(&rows, &right)?;
        flat.iter_mut().enumerate().for_each(|(v, p)| *p += DVec2::new(d[2 * v], d[2 * v + 1]));
    }
    let worst = edges.iter().map(|&h| error(&flat, h).abs()).fold(0.0, f64::max);
    // Folded once more, it would cover its outline more than twice.
    let surface_area: f64 =
        surface.triangles().map(|h| surface.length[h] * surface.third(h).y / 2.0).sum();
    let covered = 2.0 * signed_area(&convex_hull(&flat)).abs();
    if worst > 1e-9 * size || (surface_area - covered).abs() > 1e-6 * covered {
        return None;
    }
    Some(GluingError::FoldsFlat { size: smallest_rectangle(&flat) })
}

/// Diagonal of the box.
pub(super) fn extent(places: &[DVec3]) -> f64 {
    let low = places.iter().fold(DVec3::INFINITY, |a, &b| a.min(b));
    let high = places.iter().fold(DVec3::NEG_INFINITY, |a, &b| a.max(b));
    (high - low).length()
}

/// How far an edge bends inwards beyond rounding, in mm; 0 when it does not.
pub(super) fn depth(surface: &Surface, places: &[DVec3], h: usize) -> f64 {
    let t = surface.twin[h];
    let at = |s: usize| places[surface.origin[s]];
    let (a, b) = (at(h), at(t));
    let (c, d) = (at(surface.previous(h)), at(surface.previous(t)));
    let bound = 1e-3 * RoundingBound::of_box(-DVec3::splat(1.0), DVec3::splat(1.0)).length();
    let volume = -orient3d(a, b, c, d);
    if volume <= 0.0 {
        return 0.0;
    }
    let area = (b - a).cross(c - a).length().min((b - a).cross(d - a).length());
    let depth = volume / area.max(f64::MIN_POSITIVE);
    if depth <= bound * extent(&[a, b, c, d]) { 0.0 } else { depth }
}

/// Vertices around the apex at the origin, triangle by triangle, large ones first.
fn around_apex(surface: &Surface, r: &[f64]) -> Vec<DVec3> {
    let mut places = vec![DVec3::NAN; r.len()];
    let mut reached = vec![false; surface.len()];
    let area = |h: usize| surface.length[h] * surface.third(h).y;
    let Some(start) = surface.triangles().max_by(|&a, &b| area(a).total_cmp(&area(b))) else {
        return places;
    };
    let (i, j) = (surface.origin[start], surface.target(start));
    let (foot, squared) = apex(surface, r, start);
    // The base line along x, below the apex by as much as the apex lies off it.
    let off = foot.y.hypot(squared.max(0.0).sqrt());
    places[i] = DVec3::new(-foot.x, -off, 0.0);
    places[j] = DVec3::new(surface.length[start] - foot.x, -off, 0.0);
    let mut queue = BinaryHeap::from([(Ordered(area(start)), start)]);
    while let Some((_, h)) = queue.pop() {
        let (n, p) = (surface.next[h], surface.previous(h));
        if reached[h] {
            continue;
        }
        [h, n, p].iter().for_each(|&s| reached[s] = true);
        let k = surface.origin[p];
        if places[k].is_nan() {
            places[k] = third_place(surface, r, &places, h);
        }
        queue.extend([h, n, p].map(|s| surface.twin[s]).map(|t| (Ordered(area(t)), t)));
    }
    // A vertex that is no corner lies nowhere yet.
    places.iter_mut().filter(|p| p.is_nan()).for_each(|p| *p = DVec3::ZERO);
    places
}

/// A number with the total order of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// The third corner of a triangle of which two have their places: the triangle leans towards the
/// apex as its pyramid says. Where the apex is too near to the line of the two to tell directions
/// apart, it leans against the triangle on the other side.
fn third_place(surface: &Surface, r: &[f64], places: &[DVec3], h: usize) -> DVec3 {
    let (a, b) = (places[surface.origin[h]], places[surface.target(h)]);
    let third = surface.third(h);
    let x = (b - a).normalize_or_zero();
    let lean = |h: usize| {
        let (foot, squared) = apex(surface, r, h);
        DVec2::new(foot.y, squared.max(0.0).sqrt()).normalize_or(DVec2::X)
    };
    let across = |p: DVec3| (p - a) - (p - a).dot(x) * x;
    let twin = surface.twin[h];
    let (to_apex, to_other) =
        (across(DVec3::ZERO), across(places[surface.origin[surface.previous(twin)]]));
    let (from, turned) = if to_other.is_nan() || to_apex.length() >= to_other.length() {
        (to_apex, lean(h))
    } else {
        (to_other, lean(h).rotate(lean(twin)))
    };
    let from = from.normalize_or_zero();
    a + x * third.x + (from * turned.x + x.cross(from) * turned.y) * third.y
}

/// Newton's method with the lengths of all edges as equations, each step the shortest that solves
/// them, or a part of it. The largest error of an edge afterwards, in mm.
fn polish(surface: &Surface, places: &mut [DVec3]) -> f64 {
    let edges: Vec<usize> = surface.edges().collect();
    let ends: Vec<[usize; 2]> =
        edges.iter().map(|&h| [surface.origin[h], surface.target(h)]).collect();
    let order = elimination_order(&ends, places);
    let error = |places: &[DVec3]| -> Vec<f64> {
        let length = |[i, j]: [usize; 2]| places[i].distance(places[j]);
        ends.iter().zip(&edges).map(|(&e, &h)| surface.length[h] - length(e)).collect()
    };
    let worst = |e: &[f64]| e.iter().fold(0.0_f64, |w, x| w.max(x.abs()));
    let squares = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>();
    let size = extent(places);
    let mut miss = error(places);
    let mut shift = 0.0;
    for _ in 0..NEWTON {
        let before = worst(&miss);
        if before <= 1e-2 * TRUE * size {
            break;
        }
        let Some(step) = step(&ends, places, &miss, &order, shift) else {
            shift = f64::max(10.0 * shift, 1e-14);
            if shift > 1e-2 {
                break;
            }
            continue;
        };
        let better = [1.0, 0.5, 0.25, 0.1, 0.03].into_iter().find_map(|part| {
            let moved: Vec<DVec3> = places.iter().zip(&step).map(|(p, d)| *p + part * *d).collect();
            let missed = error(&moved);
            (squares(&missed) < squares(&miss)).then_some((moved, missed))
        });
        match better {
            Some((moved, missed)) => {
                places.copy_from_slice(&moved);
                let is_done = worst(&missed) > 0.5 * before && before <= TRUE * size;
                miss = missed;
                shift = if shift < 1e-15 { 0.0 } else { shift / 10.0 };
                if is_done {
                    break;
                }
            }
            None if before <= TRUE * size => break,
            None => {
                shift = f64::max(100.0 * shift, 1e-14);
                if shift > 1e-2 {
                    break;
                }
            }
        }
    }
    worst(&miss)
}

/// How the vertices move in one step; a larger shift makes it shorter.
fn step(
    ends: &[[usize; 2]],
    places: &[DVec3],
    miss: &[f64],
    order: &[usize],
    shift: f64,
) -> Option<Vec<DVec3>> {
    let rows: Vec<sparse::SparseRow> = ends
        .iter()
        .map(|&[i, j]| {
            let d = (places[i] - places[j]).normalize_or_zero();
            let at = |v: usize, d: DVec3| (0..3).map(move |k| (3 * v + k, d[k]));
            at(i, d).chain(at(j, -d)).collect()
        })
        .collect();
    let weights = vec![1.0; 3 * places.len()];
    let y = sparse::solve_normal(&rows, &weights, shift, order, miss)?;
    let mut step = vec![DVec3::ZERO; places.len()];
    for (row, y) in rows.iter().zip(&y) {
        row.iter().for_each(|&(c, value)| step[c / 3][c % 3] += value * y);
    }
    Some(step)
}

fn elimination_order(ends: &[[usize; 2]], places: &[DVec3]) -> Vec<usize> {
    let mut of_vertex: Vec<Vec<usize>> = vec![Vec::new(); places.len()];
    for (e, &[i, j]) in ends.iter().enumerate() {
        of_vertex[i].push(e);
        of_vertex[j].push(e);
    }
    let neighbours: Vec<Vec<usize>> = ends
        .iter()
        .map(|e| e.iter().flat_map(|&v| of_vertex[v].iter().copied()).collect())
        .collect();
    let middles: Vec<DVec3> = ends.iter().map(|&[i, j]| (places[i] + places[j]) / 2.0).collect();
    sparse::nested_dissection(&middles, &neighbours)
}
