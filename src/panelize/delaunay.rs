//! Edges of a triangle mesh turned until it is Delaunay on itself, so that slivers of a file do not
//! stand in the way of steps that walk along edges.
//!
//! Lawson's flips (1977) by the sum of opposite angles (Bobenko, Springborn 2007). An edge across
//! which the surface folds is only turned when that hardly moves the surface.

use std::collections::BTreeSet;

use glam::DVec3;

use super::refine::{Triangles, edge};
use super::surface::NONE;

/// Turning an edge may move the surface by at most this, in panel sizes.
const MOST_MOVE: f64 = 0.03;
/// So many turns for each edge are enough for any mesh that comes to an end.
const TURNS_PER_EDGE: usize = 20;

/// Half-edges: the i-th of triangle t runs from its i-th corner and has the number 3 t + i.
struct Flips<'a> {
    points: &'a [DVec3],
    corners: &'a mut [[usize; 3]],
    creases: &'a BTreeSet<[usize; 2]>,
    twins: Vec<usize>,
}

impl Triangles {
    /// Turns edges until none has opposite angles of more than a half turn together, as far as the
    /// surface stays where it is.
    pub(super) fn make_delaunay(&mut self) {
        let twins = twins(&self.corners);
        let Self { points, corners, creases } = self;
        let mut flips = Flips { points, corners, creases, twins };
        let mut open: Vec<usize> = (0..flips.twins.len()).collect();
        let mut left = TURNS_PER_EDGE * open.len();
        while let Some(h) = open.pop() {
            if flips.is_worth(h) && left > 0 {
                left -= 1;
                open.extend(flips.turn(h));
            }
        }
    }
}

/// The half-edge on the other side of each; [`NONE`] at a rim.
fn twins(corners: &[[usize; 3]]) -> Vec<usize> {
    let mut sides: Vec<([usize; 2], usize)> = Vec::with_capacity(3 * corners.len());
    for (t, c) in corners.iter().enumerate() {
        sides.extend((0..3).map(|i| ([c[i], c[(i + 1) % 3]], 3 * t + i)));
    }
    sides.sort_unstable();
    let mut twins = vec![NONE; sides.len()];
    for &([a, b], h) in &sides {
        if let Ok(found) = sides.binary_search_by_key(&[b, a], |&(ends, _)| ends) {
            twins[h] = sides[found].1;
        }
    }
    twins
}

/// The next half-edge around a triangle.
fn next(h: usize) -> usize {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

impl Flips<'_> {
    fn origin(&self, h: usize) -> usize {
        self.corners[h / 3][h % 3]
    }

    /// The corner across a half-edge.
    fn apex(&self, h: usize) -> usize {
        self.origin(next(next(h)))
    }

    fn is_worth(&self, h: usize) -> bool {
        let twin = self.twins[h];
        if twin == NONE {
            return false;
        }
        let ids = [self.origin(h), self.origin(next(h)), self.apex(h), self.apex(twin)];
        if self.creases.contains(&edge(ids[0], ids[1])) {
            return false;
        }
        let [a, b, c, d] = ids.map(|v| self.points[v]);
        let (x, y) = ((a - c).cross(b - c), (b - d).cross(a - d));
        let cot = |p: DVec3, q: DVec3| p.dot(q) / p.cross(q).length();
        let sum = cot(a - c, b - c) + cot(b - d, a - d);
        // Triangles without area count as slivers.
        if !(sum < -1e-6 || sum.is_nan()) {
            return false;
        }
        let up = x + y;
        let made = [(d - a).cross(c - a), (b - d).cross(c - d)];
        let stands = made.iter().all(|n| n.dot(up) > 1e-3 * n.length() * up.length());
        let across = (b - a).cross(d - c);
        let gap = (c - a).dot(across).abs() / across.length().max(f64::MIN_POSITIVE);
        stands && gap < MOST_MOVE && !self.are_linked(next(next(h)), ids[3])
    }

    /// Whether a vertex is a neighbour of the origin of a half-edge.
    fn are_linked(&self, from: usize, other: usize) -> bool {
        let mut h = from;
        loop {
            if self.origin(next(h)) == other || self.apex(h) == other {
                return true;
            }
            h = self.twins[next(next(h))];
            if h == from {
                return false;
            }
            if h == NONE {
                break;
            }
        }
        // There is a rim: the other way around.
        h = from;
        while self.twins[h] != NONE {
            h = next(self.twins[h]);
            if self.origin(next(h)) == other || self.apex(h) == other {
                return true;
            }
        }
        false
    }

    /// Turns the edge of a half-edge; the four half-edges around it.
    fn turn(&mut self, h: usize) -> [usize; 4] {
        let g = self.twins[h];
        let [a, b, c, d] = [self.origin(h), self.origin(g), self.apex(h), self.apex(g)];
        let outer = [next(g), next(next(h)), next(next(g)), next(h)].map(|h| self.twins[h]);
        let (t, s) = (h / 3, g / 3);
        self.corners[t] = [a, d, c];
        self.corners[s] = [d, b, c];
        let places = [3 * t, 3 * t + 2, 3 * s, 3 * s + 1];
        for (place, twin) in places.into_iter().zip(outer) {
            self.twins[place] = twin;
            if twin != NONE {
                self.twins[twin] = place;
            }
        }
        (self.twins[3 * t + 1], self.twins[3 * s + 2]) = (3 * s + 2, 3 * t + 1);
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needles_of_a_fan_become_good_triangles_of_the_same_area() {
        let count = 60;
        let rim = (0..count).map(|i| {
            let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        });
        let corners = (1..count as usize - 1).map(|i| [0, i, i + 1]).collect();
        let mut mesh = Triangles { points: rim.collect(), corners, ..Triangles::default() };
        let area = |mesh: &Triangles| -> f64 {
            let places = mesh.corners.iter().map(|t| t.map(|i| mesh.points[i]));
            places.map(|[a, b, c]| (b - a).cross(c - a).z / 2.0).sum()
        };
        let before = area(&mesh);
        assert!(mesh.refine(0.12, 100_000));
        assert!((area(&mesh) - before).abs() < 1e-12);
        let least = |mesh: &Triangles| {
            let places = mesh.corners.iter().map(|t| t.map(|i| mesh.points[i]));
            let height = |[a, b, c]: [DVec3; 3]| {
                let sides = [a.distance(b), b.distance(c), c.distance(a)];
                (b - a).cross(c - a).z / sides.iter().fold(0.0, |m: f64, &s| m.max(s)).powi(2)
            };
            places.map(height).fold(f64::INFINITY, f64::min)
        };
        assert!(least(&mesh) > 0.03, "{}", least(&mesh));
        assert!(mesh.points.len() < 3000, "{}", mesh.points.len());
    }
}
