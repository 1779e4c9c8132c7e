//! Prisms, antiprisms, boxes and geodesic spheres.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::DVec3;

use super::{Platonic, Raw};

/// Two regular n-gons and n squares; the axis is z, and one side lies towards −y.
///
/// Vertices: the lower ring, then the upper one. Faces: the lower n-gon, the upper one, the sides.
pub(super) fn prism(n: usize) -> Raw {
    let half = on_circle(1, 2 * n as i64).y;
    let ring = |z: f64| {
        (0..n).map(move |k| on_circle(4 * k as i64 - n as i64 - 2, 4 * n as i64).extend(z))
    };
    let sides = (0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]);
    Raw { points: ring(-half).chain(ring(half)).collect(), faces: lids(n).chain(sides).collect() }
}

/// Two regular n-gons, turned against each other, and 2n triangles; the axis is z.
///
/// Vertices: the lower ring, then the upper one. Faces: the lower n-gon, the upper one, then the
/// triangles in turn.
pub(super) fn antiprism(n: usize) -> Raw {
    let edge = 2.0 * on_circle(1, 2 * n as i64).y;
    // The chord between a lower and an upper vertex is a side of the 2n-gon; with the height it
    // must make an edge.
    let chord = 2.0 * on_circle(1, 4 * n as i64).y;
    let half = ((edge - chord) * (edge + chord)).sqrt() / 2.0;
    let point = |k: usize, shift: i64| on_circle(4 * k as i64 - n as i64 - shift, 4 * n as i64);
    let lower = (0..n).map(|k| point(k, 2).extend(-half));
    let upper = (0..n).map(|k| point(k, 0).extend(half));
    let triangles = (0..n)
        .flat_map(|k| [vec![k, (k + 1) % n, n + k], vec![n + k, (k + 1) % n, n + (k + 1) % n]]);
    Raw { points: lower.chain(upper).collect(), faces: lids(n).chain(triangles).collect() }
}

/// The lower and the upper n-gon.
fn lids(n: usize) -> impl Iterator<Item = Vec<usize>> {
    [(0..n).rev().collect(), (n..2 * n).collect()].into_iter()
}

/// The point at `part / whole` of a turn on the unit circle, symmetric to the last bit: the angle
/// is brought into the first eighth of a turn by whole numbers before any rounding.
fn on_circle(part: i64, whole: i64) -> glam::DVec2 {
    let part = part.rem_euclid(whole);
    let (quarter, rest) = (4 * part / whole, 4 * part % whole);
    // `rest / whole` of a quarter turn; above one half its complement is used.
    let angle = |rest: i64| rest as f64 / whole as f64 * (PI / 2.0);
    let (sin, cos) = if 2 * rest == whole {
        (std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2)
    } else if 2 * rest < whole {
        angle(rest).sin_cos()
    } else {
        let (sin, cos) = angle(whole - rest).sin_cos();
        (cos, sin)
    };
    match quarter {
        0 => glam::DVec2::new(cos, sin),
        1 => glam::DVec2::new(-sin, cos),
        2 => glam::DVec2::new(-cos, -sin),
        _ => glam::DVec2::new(sin, -cos),
    }
}

/// A box with the given extents, parallel to the axes. Vertex i has its high end on x, y, z where
/// bit 0, 1, 2 of i is set.
///
/// Faces: below, above, front (−y), back, left (−x), right.
pub(super) fn cuboid(extents: DVec3) -> Raw {
    let half = extents / 2.0;
    let end = |i: usize, axis: usize| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] };
    let points = (0..8).map(|i| DVec3::new(end(i, 0), end(i, 1), end(i, 2))).collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Raw { points, faces: faces.map(Vec::from).to_vec() }
}

/// The icosahedron with each edge divided into `n` parts, blown up to the unit sphere (class I).
///
/// Vertices: the twelve of the icosahedron, then those on its edges, then those inside its faces.
/// Faces: 20 blocks of n² triangles in the order of the icosahedron's faces.
pub(super) fn geodesic(n: usize) -> Raw {
    let solid = Platonic::Icosahedron.raw();
    let mut grid = Grid::new(&solid, n);
    let mut faces = Vec::with_capacity(20 * n * n);
    for corners in &solid.faces {
        let corners = [corners[0], corners[1], corners[2]];
        let inside = grid.fill(corners);
        let at = |s: usize, t: usize| grid.vertex(corners, inside, s, t);
        for s in 0..n {
            for t in 0..=s {
                faces.push(vec![at(s, t), at(s + 1, t), at(s + 1, t + 1)]);
                if t < s {
                    faces.push(vec![at(s, t), at(s + 1, t + 1), at(s, t + 1)]);
                }
            }
        }
    }
    Raw { points: grid.points, faces }
}

/// The points of a geodesic sphere and where those on each edge begin.
struct Grid {
    n: usize,
    corners: Vec<DVec3>,
    points: Vec<DVec3>,
    edges: HashMap<[usize; 2], usize>,
}

impl Grid {
    fn new(solid: &Raw, n: usize) -> Self {
        let corners = solid.points.clone();
        let points = corners.iter().map(|p| p.normalize()).collect();
        let mut grid = Self { n, corners, points, edges: HashMap::new() };
        for face in &solid.faces {
            for i in 0..3 {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                if a < b {
                    grid.edges.insert([a, b], grid.points.len());
                    (1..n).for_each(|k| grid.push([a, b, b], [n - k, k, 0]));
                }
            }
        }
        grid
    }

    fn push(&mut self, corners: [usize; 3], weights: [usize; 3]) {
        let sum: DVec3 = (0..3).map(|i| self.corners[corners[i]] * weights[i] as f64).sum();
        self.points.push(sum.normalize());
    }

    /// Adds the points inside a face and returns the number of the first.
    fn fill(&mut self, corners: [usize; 3]) -> usize {
        let first = self.points.len();
        for s in 2..self.n {
            (1..s).for_each(|t| self.push(corners, [self.n - s, s - t, t]));
        }
        first
    }

    /// The vertex `t` along row `s` of a face, counted from its first corner; `inside` is its first
    /// inner point.
    fn vertex(&self, [a, b, c]: [usize; 3], inside: usize, s: usize, t: usize) -> usize {
        if t == 0 {
            self.on_edge(a, b, s)
        } else if t == s {
            self.on_edge(a, c, s)
        } else if s == self.n {
            self.on_edge(b, c, t)
        } else {
            // Row s holds s − 1 inner points, and the rows before it (s − 1)(s − 2) / 2.
            inside + (s - 1) * (s - 2) / 2 + t - 1
        }
    }

    /// The point after `k` of the n parts of the edge from a to b.
    fn on_edge(&self, a: usize, b: usize, k: usize) -> usize {
        match k {
            0 => a,
            k if k == self.n => b,
            k if a < b => self.edges[&[a, b]] + k - 1,
            k => self.edges[&[b, a]] + self.n - k - 1,
        }
    }
}
