//! Where the seams run on the body.
//!
//! Flips may have replaced a seam: where straight rims meet, the body bends along lines that cross
//! it. So every side of a piece is walked on the triangles, straight on in the direction that it
//! has at its start, until it comes to its end.

use glam::DVec2;

use super::GluingError;
use super::rims::Rims;
use super::surface::{SideDirections, Surface};

/// How near, in parts of the longest edge, a walk must come to its end.
const ARRIVED: f64 = 1e-8;
/// How far a direction may be off, in radians, to be that of an edge.
const ALONG: f64 = 1e-7;

/// A side of a piece on the body, from its start to its end.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub piece: usize,
    pub side: usize,
    /// The edge that it is, when it is one.
    pub edge: Option<usize>,
    /// What it crosses otherwise, in order.
    pub crossings: Vec<Crossing>,
    pub length: f64,
}

/// Where a side crosses an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// The half-edge of the triangle that is left.
    pub edge: usize,
    /// How far along it, 0 to 1.
    pub part: f64,
    /// How far along the side, in mm.
    pub along: f64,
}

/// Where a flat vertex lies: in the triangle of a half-edge that is laid along x, with the angle
/// that direction zero has there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Located {
    pub h: usize,
    pub at: DVec2,
    zero: f64,
}

/// All sides, each seam once, and the flat vertices.
pub(super) struct Traced {
    pub runs: Vec<Run>,
    pub located: Vec<Option<Located>>,
}

struct Tracer<'a> {
    surface: &'a Surface,
    rims: &'a Rims,
    directions: &'a SideDirections,
    first: Vec<usize>,
    located: Vec<Option<Located>>,
    near: f64,
}

pub(super) fn trace(
    surface: &Surface,
    rims: &Rims,
    directions: &SideDirections,
) -> Result<Traced, GluingError> {
    let longest = surface.edges().map(|h| surface.length[h]).fold(0.0, f64::max);
    let mut tracer = Tracer {
        surface,
        rims,
        directions,
        first: surface.first_of_vertices(),
        located: vec![None; rims.vertices],
        near: ARRIVED * longest,
    };
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (p, piece) in rims.pieces.iter().enumerate() {
        open.extend((0..piece.len()).filter(|&i| (p, i) < piece.mate[i]).map(|i| (p, i)));
    }
    let mut runs = Vec::with_capacity(open.len());
    while !open.is_empty() {
        let before = open.len();
        let mut left = Vec::new();
        for (p, i) in open {
            let mate = rims.pieces[p].mate[i];
            match [(p, i), mate].into_iter().find(|&(p, i)| tracer.is_known(p, i)) {
                Some((p, i)) => runs.push(tracer.run(p, i)?),
                None => left.push((p, i)),
            }
        }
        open = left;
        if open.len() == before {
            return Err(GluingError::NotFound {
                fault: "a seam hangs together with no corner of the body".to_owned(),
            });
        }
    }
    Ok(Traced { runs, located: tracer.located })
}

impl Tracer<'_> {
    fn is_known(&self, p: usize, i: usize) -> bool {
        let v = self.rims.pieces[p].vertex[i];
        !self.surface.is_flat[v] || self.located[v].is_some()
    }

    fn run(&mut self, p: usize, i: usize) -> Result<Run, GluingError> {
        let piece = &self.rims.pieces[p];
        let (v, w) = (piece.vertex[i], piece.vertex[(i + 1) % piece.len()]);
        let (q, j) = piece.mate[i];
        let length = (piece.side(i).length() + self.rims.pieces[q].side(j).length()) / 2.0;
        let direction = self.directions[p][i];
        let run = Run { piece: p, side: i, edge: None, crossings: Vec::new(), length };
        let lost = || GluingError::NotFound {
            fault: format!("the seam at {} was lost on the body", self.rims.place_text(v)),
        };
        let (h, from, angle) = match self.located[v] {
            Some(place) => (place.h, place.at, place.zero + direction),
            None => {
                let around = self.surface.around(self.first[v]);
                if let Some(&edge) = around.iter().find(|&&h| self.is_side(h, w, direction, length))
                {
                    return Ok(Run { edge: Some(edge), ..run });
                }
                let turned = |h: usize| {
                    (direction - self.surface.direction[h]).rem_euclid(self.surface.material[v])
                };
                let h = around.iter().copied().find(|&h| turned(h) <= self.surface.corner(h));
                let h = h.ok_or_else(lost)?;
                (h, DVec2::ZERO, turned(h))
            }
        };
        let walk = self.walk((h, from, angle), w, length).ok_or_else(lost)?;
        if let Some((h, at, back)) = walk.end {
            self.located[w] = Some(Located { h, at, zero: back - self.directions[q][j] });
        }
        Ok(Run { crossings: walk.crossings, ..run })
    }

    fn is_side(&self, h: usize, w: usize, direction: f64, length: f64) -> bool {
        let material = self.surface.material[self.surface.origin[h]];
        let off = (self.surface.direction[h] - direction).rem_euclid(material);
        self.surface.target(h) == w
            && off.min(material - off) <= ALONG
            && (self.surface.length[h] - length).abs() <= self.near
    }

    /// Walks straight on from a point of the triangle of `h`, which is laid along x, at an angle
    /// against it, to the vertex `w`.
    fn walk(
        &self,
        (start, from, angle): (usize, DVec2, f64),
        w: usize,
        length: f64,
    ) -> Option<Walk> {
        let surface = self.surface;
        let ray = DVec2::from_angle(angle);
        let goal = from + ray * length;
        let is_flat = surface.is_flat[w];
        // Sides of the triangle that can be left by, with their ends, counter-clockwise.
        let corner = |h: usize| match h {
            _ if h == start => DVec2::ZERO,
            _ if h == surface.next[start] => DVec2::new(surface.length[start], 0.0),
            _ => surface.third(start),
        };
        let sides = [start, surface.next[start], surface.previous(start)];
        if is_flat
            && sides
                .iter()
                .all(|&s| (corner(surface.next[s]) - corner(s)).perp_dot(goal - corner(s)) >= 0.0)
        {
            let back = (-ray).to_angle();
            return Some(Walk { crossings: Vec::new(), end: Some((start, goal, back)) });
        }
        let passes = |s: usize| {
            let (a, b) = (corner(s) - from, corner(surface.next[s]) - from);
            ray.perp_dot(a) < 0.0 && ray.perp_dot(b) >= 0.0 && (b - a).perp_dot(ray) < 0.0
        };
        let at_corner = from == DVec2::ZERO;
        let leaves = |s: usize| if at_corner { s == surface.next[start] } else { passes(s) };
        let mut side = sides.into_iter().find(|&s| leaves(s))?;
        let (mut p, mut q) = (corner(side), corner(surface.next[side]));
        let mut crossed = Vec::new();
        for _ in 0..4 * surface.len() {
            crossed.push((side, p, q));
            let twin = surface.twin[side];
            let third = surface.third(twin);
            let x = (p - q).normalize_or_zero();
            let m = q + x * third.x + x.perp() * third.y;
            if !is_flat
                && surface.origin[surface.previous(twin)] == w
                && m.distance(goal) <= self.near
            {
                return Some(Walk { crossings: crossings(&crossed, from, m, length), end: None });
            }
            let inside = |a: DVec2, b: DVec2| (b - a).perp_dot(goal - a) >= 0.0;
            if is_flat && inside(p, m) && inside(m, q) {
                // The same place with the twin laid along x.
                let at = DVec2::new(x.dot(goal - q), x.perp_dot(goal - q));
                let back = DVec2::new(x.dot(-ray), x.perp_dot(-ray)).to_angle();
                let end = Some((twin, at, back));
                return Some(Walk { crossings: crossings(&crossed, from, goal, length), end });
            }
            if (goal - from).length() + self.near
                < (m - from).dot(ray).min((p - from).dot(ray)).min((q - from).dot(ray))
            {
                return None;
            }
            if ray.perp_dot(m - from) > 0.0 {
                (side, q) = (surface.next[twin], m);
            } else {
                (side, p) = (surface.previous(twin), m);
            }
        }
        None
    }
}

struct Walk {
    crossings: Vec<Crossing>,
    /// Triangle, place and direction back, when it ends inside one.
    end: Option<(usize, DVec2, f64)>,
}

/// The crossings of the straight line between two points that are known exactly.
fn crossings(
    crossed: &[(usize, DVec2, DVec2)],
    from: DVec2,
    to: DVec2,
    length: f64,
) -> Vec<Crossing> {
    let d = to - from;
    crossed
        .iter()
        .map(|&(edge, p, q)| {
            let (a, b) = (d.perp_dot(p - from), d.perp_dot(q - from));
            let part = (a / (a - b)).clamp(0.0, 1.0);
            let at = p.lerp(q, part);
            Crossing {
                edge,
                part,
                along: length * ((at - from).dot(d) / d.length_squared()).clamp(0.0, 1.0),
            }
        })
        .collect()
}
