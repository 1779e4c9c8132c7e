//! A closed surface of flat triangles that knows lengths and no positions.
//!
//! Loops and double edges are legal. Every half-edge also knows in which direction it leaves its
//! vertex, as an angle around it that flips carry along (Sharp, Soliman, Crane 2019, "Navigating
//! intrinsic triangulations"), so the seams are found again on whatever triangulation results.

use super::GluingError;
use super::rims::{FLAT, Rims};
use super::triangle::{angle, third_corner};
use crate::geom::predicate::orient2d;
use crate::geom::{triangulate, triangulate_region};
use glam::DVec2;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The surface. Half-edges are numbers; each triangle is a cycle of three.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    pub origin: Vec<usize>,
    pub next: Vec<usize>,
    pub twin: Vec<usize>,
    pub length: Vec<f64>,
    /// Direction at the origin, in 0 to the vertex's material, counter-clockwise.
    pub direction: Vec<f64>,
    /// Half-edges that still are some.
    pub is_alive: Vec<bool>,
    /// Material at each vertex, in radians.
    pub material: Vec<f64>,
    /// Vertices that are no corner of any triangle, for they are flat.
    pub is_flat: Vec<bool>,
}

/// Sides of pieces on the surface: piece → side → direction at its start.
pub(super) type SideDirections = Vec<Vec<f64>>;

impl Surface {
    /// Triangulates the pieces and joins them. Flat points are taken out again.
    pub fn new(rims: &Rims) -> Result<(Self, SideDirections), GluingError> {
        let mut surface = Self {
            origin: Vec::new(),
            next: Vec::new(),
            twin: Vec::new(),
            length: Vec::new(),
            direction: Vec::new(),
            is_alive: Vec::new(),
            material: rims.cone_angles(),
            is_flat: vec![false; rims.vertices],
        };
        let mut sides: Vec<Vec<usize>> = Vec::new();
        for piece in &rims.pieces {
            let bad = |fault: &str| GluingError::BadOutline {
                name: piece.name.clone(),
                fault: fault.to_owned(),
            };
            let is_simple = piece.len() >= 3 && triangulate_region(&[&piece.points]).is_some();
            if !is_simple {
                return Err(bad(
                    "cut into chords, it crosses itself; draw one line that does not cross itself, \
                    or take more points",
                ));
            }
            let triangles = triangulate(&piece.points);
            let is_upright = |t: &[usize; 3]| {
                orient2d(piece.points[t[0]], piece.points[t[1]], piece.points[t[2]]) > 0.0
            };
            if triangles.len() + 2 != piece.len() || !triangles.iter().all(is_upright) {
                return Err(bad("cut into chords, it touches itself; take more points"));
            }
            sides.push(surface.add_piece(&piece.points, &piece.vertex, &triangles));
        }
        for (p, piece) in rims.pieces.iter().enumerate() {
            for (i, &(q, j)) in piece.mate.iter().enumerate() {
                let (h, t) = (sides[p][i], sides[q][j]);
                surface.twin[h] = t;
                let mean = (surface.length[h] + surface.length[t]) / 2.0;
                surface.length[h] = mean;
                surface.length[t] = mean;
            }
        }
        surface.set_directions();
        let directions = sides
            .iter()
            .map(|of_piece| of_piece.iter().map(|&h| surface.direction[h]).collect())
            .collect();
        for v in 0..rims.vertices {
            if (surface.material[v] - TAU).abs() <= FLAT {
                surface.take_out(v)?;
            }
        }
        Ok((surface, directions))
    }

    /// Adds the triangles of a piece; the half-edges of its sides in order.
    fn add_piece(
        &mut self,
        points: &[DVec2],
        vertex: &[usize],
        triangles: &[[usize; 3]],
    ) -> Vec<usize> {
        let mut inner: HashMap<(usize, usize), usize> = HashMap::new();
        let n = points.len();
        let mut sides = vec![usize::MAX; n];
        for t in triangles {
            let first = self.origin.len();
            for k in 0..3 {
                let (i, j) = (t[k], t[(k + 1) % 3]);
                let h = first + k;
                self.origin.push(vertex[i]);
                self.next.push(first + (k + 1) % 3);
                self.length.push(points[i].distance(points[j]));
                self.direction.push(0.0);
                self.is_alive.push(true);
                self.twin.push(usize::MAX);
                if j == (i + 1) % n {
                    sides[i] = h;
                } else if let Some(&t) = inner.get(&(j, i)) {
                    self.twin[h] = t;
                    self.twin[t] = h;
                } else {
                    inner.insert((i, j), h);
                }
            }
        }
        sides
    }

    pub fn len(&self) -> usize {
        self.origin.len()
    }

    pub fn previous(&self, h: usize) -> usize {
        self.next[self.next[h]]
    }

    pub fn target(&self, h: usize) -> usize {
        self.origin[self.next[h]]
    }

    /// Living half-edges.
    pub fn half_edges(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.len()).filter(|&h| self.is_alive[h])
    }

    /// One half-edge of each living edge.
    pub fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        self.half_edges().filter(|&h| h < self.twin[h])
    }

    /// One half-edge of each living triangle.
    pub fn triangles(&self) -> impl Iterator<Item = usize> + '_ {
        self.half_edges().filter(|&h| h < self.next[h] && h < self.previous(h))
    }

    /// The angle of the triangle at the origin of a half-edge.
    pub fn corner(&self, h: usize) -> f64 {
        let (n, p) = (self.next[h], self.previous(h));
        angle(self.length[h], self.length[p], self.length[n])
    }

    /// The third corner of the triangle when the half-edge lies along x.
    pub fn third(&self, h: usize) -> DVec2 {
        third_corner(self.length[h], self.length[self.previous(h)], self.length[self.next[h]])
    }

    fn set_directions(&mut self) {
        let mut is_set = vec![false; self.material.len()];
        for start in 0..self.len() {
            let v = self.origin[start];
            if std::mem::replace(&mut is_set[v], true) {
                continue;
            }
            let (mut h, mut sum) = (start, 0.0);
            loop {
                self.direction[h] = sum;
                sum += self.corner(h);
                h = self.twin[self.previous(h)];
                if h == start {
                    break;
                }
            }
            // What the triangles measure, so that directions close.
            self.material[v] = sum;
        }
    }

    /// Flips the edge to the other diagonal of the two triangles beside it. Nothing happens, and
    /// `false` comes back, when these are one, or no convex quadrilateral.
    pub fn flip(&mut self, h: usize) -> bool {
        let t = self.twin[h];
        let (h1, h2) = (self.next[h], self.previous(h));
        let (t1, t2) = (self.next[t], self.previous(t));
        if t == h1 || t == h2 {
            return false;
        }
        let base = self.length[h];
        let (above, below) = (self.third(h), self.third(t));
        let below = DVec2::new(base - below.x, -below.y);
        let height = above.y - below.y;
        let crossing = above.x + (below.x - above.x) * above.y / height;
        let inside = 1e-13 * base..base * (1.0 - 1e-13);
        if height <= 0.0 || !inside.contains(&crossing) {
            return false;
        }
        let length = above.distance(below);
        let (k, m) = (self.origin[h2], self.origin[t2]);
        let from_k = self.direction[h2] + angle(self.length[h2], length, self.length[t1]);
        let from_m = self.direction[t2] + angle(self.length[t2], length, self.length[h1]);
        (self.origin[h], self.origin[t]) = (m, k);
        (self.length[h], self.length[t]) = (length, length);
        self.direction[h] = from_m.rem_euclid(self.material[m]);
        self.direction[t] = from_k.rem_euclid(self.material[k]);
        for cycle in [[h, h2, t1], [t, t2, h1]] {
            for i in 0..3 {
                self.next[cycle[i]] = cycle[(i + 1) % 3];
            }
        }
        true
    }

    /// Half-edges that leave a vertex, counter-clockwise.
    pub fn around(&self, start: usize) -> Vec<usize> {
        let mut all = vec![start];
        loop {
            let h = self.twin[self.previous(all[all.len() - 1])];
            if h == start {
                return all;
            }
            all.push(h);
        }
    }

    /// Some half-edge that leaves each vertex, `usize::MAX` for none.
    pub fn first_of_vertices(&self) -> Vec<usize> {
        let mut first = vec![usize::MAX; self.material.len()];
        for h in self.half_edges() {
            let f = &mut first[self.origin[h]];
            *f = (*f).min(h);
        }
        first
    }

    /// Flips the edges at a flat vertex away until three are left, and makes one triangle of the
    /// three there.
    fn take_out(&mut self, v: usize) -> Result<(), GluingError> {
        let stuck = || GluingError::NotFound {
            fault: format!("the flat point {v} of the seam could not be taken out"),
        };
        let mut start = self.half_edges().find(|&h| self.origin[h] == v).ok_or_else(stuck)?;
        loop {
            let all = self.around(start);
            if all.len() == 3 {
                start = all[0];
                break;
            }
            let flipped = all.iter().position(|&h| self.target(h) != v && self.flip(h));
            let i = flipped.ok_or_else(stuck)?;
            start = all[(i + 1) % all.len()];
        }
        let spokes = self.around(start);
        let outer: Vec<usize> = spokes.iter().map(|&h| self.next[h]).collect();
        for i in 0..3 {
            self.next[outer[i]] = outer[(i + 1) % 3];
            for dead in [spokes[i], self.twin[spokes[i]]] {
                self.is_alive[dead] = false;
            }
        }
        self.is_flat[v] = true;
        Ok(())
    }
}
