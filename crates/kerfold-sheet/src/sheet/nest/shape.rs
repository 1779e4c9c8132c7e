//! Shapes as the search sees them: convex parts, turned once per angle, then only moved.
//!
//! The corners of a part are padded to a multiple of four with its last one, so that four dot
//! products are done at a time.

use glam::DVec2;

use super::super::layout::Turn;
use super::parts::{convex_parts, wider_parts};
use super::simplify::simplified;
use crate::geom::polygon::{bounds, centroid, convex_hull, signed_area};

/// Corners that are worked on together.
const LANES: usize = 4;

/// A shape in its own frame, moved so that `origin` is at zero.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    /// Where the piece's frame has the zero of this one.
    pub origin: DVec2,
    /// Twice the radius of the circle around the origin that holds the shape.
    pub diameter: f64,
    /// Area of the parts.
    pub area: f64,
    /// Boxes of the holes, in this frame: places for smaller shapes.
    pub holes: Vec<(DVec2, DVec2)>,
    /// The true sides of the outline that are long enough to lie against another, the longest
    /// first.
    pub sides: Vec<[DVec2; 2]>,
    parts: Vec<Vec<DVec2>>,
    /// Whether the parts cover the shape and, but for what makes it simpler, nothing else.
    pub is_exact: bool,
    /// The true hull: parts may be larger by a little, and a shape that fills a sheet must fit.
    hull: Vec<DVec2>,
}

impl Shape {
    /// Of an outline and its holes; in a slightly larger form when it has very many corners, and in
    /// a larger one when contours cross.
    pub fn new(outline: &[DVec2], holes: &[Vec<DVec2>]) -> Self {
        let mut hull = convex_hull(outline);
        let truly = outline;
        let (fewer, fewer_holes) = simplified(outline, holes);
        let origin = centroid(&fewer);
        // Contours made simpler one by one may come to cross.
        let (parts, outline, holes) = match convex_parts(&fewer, &fewer_holes) {
            Some(parts) => (Some(parts), fewer, fewer_holes),
            None => (convex_parts(outline, holes), outline.to_vec(), holes.to_vec()),
        };
        let is_exact = parts.is_some();
        let mut parts = parts.unwrap_or_else(|| wider_parts(&outline));
        parts.iter_mut().flatten().for_each(|p| *p -= origin);
        hull.iter_mut().for_each(|p| *p -= origin);
        let radius = parts.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
        let area = parts.iter().map(|p| signed_area(p)).sum();
        let free = holes.iter().filter(|_| is_exact).filter_map(bounds);
        let holes = free.map(|(low, high)| (low - origin, high - origin)).collect();
        let sides = sides(truly, origin, 2.0 * radius);
        Self { origin, diameter: 2.0 * radius, area, sides, holes, parts, is_exact, hull }
    }

    /// The greatest extents of the parts.
    pub fn extents(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().filter_map(bounds).map(|(low, high)| (high - low).max_element())
    }
}

/// The sides longer than a part of the diameter, the longest first, and not very many.
fn sides(outline: &[DVec2], origin: DVec2, diameter: f64) -> Vec<[DVec2; 2]> {
    const LEAST: f64 = 0.05;
    const MOST: usize = 24;
    let n = outline.len();
    let all = (0..n).map(|i| [outline[i] - origin, outline[(i + 1) % n] - origin]);
    let mut sides: Vec<[DVec2; 2]> =
        all.filter(|[a, b]| a.distance(*b) >= LEAST * diameter).collect();
    sides.sort_by(|a, b| b[0].distance(b[1]).total_cmp(&a[0].distance(a[1])));
    sides.truncate(MOST);
    sides
}

/// A convex part after a turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    /// Its place among the corners: the first, and the number without and with padding.
    first: usize,
    corners: usize,
    padded: usize,
    /// Its box.
    pub low: DVec2,
    pub high: DVec2,
    /// A point inside, and radii of circles around it inside and outside.
    middle: DVec2,
    inner: f64,
    outer: f64,
}

/// A shape turned by an angle.
#[derive(Debug, Clone, Default)]
pub(super) struct Posed {
    /// The angle in degrees.
    pub angle: f64,
    /// Box of all parts.
    pub low: DVec2,
    pub high: DVec2,
    pub parts: Vec<Part>,
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// Outward unit normals of the sides, and how far the sides are from the origin along them.
    normals: Vec<DVec2>,
    reach: Vec<f64>,
}

impl Posed {
    /// Turns a shape, reusing the memory.
    pub fn turn(&mut self, shape: &Shape, angle: f64) {
        self.turn_box(shape, angle);
        self.turn_parts(shape);
    }

    /// Finds the box of a turned shape, and leaves its parts for later. Returns the work, in parts
    /// measured.
    pub fn turn_box(&mut self, shape: &Shape, angle: f64) -> u64 {
        let turn = Turn::degrees(angle);
        self.angle = angle;
        self.parts.clear();
        (self.low, self.high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &p in &shape.hull {
            let p = turn.apply(p);
            (self.low, self.high) = (self.low.min(p), self.high.max(p));
        }
        shape.hull.len() as u64 / 16
    }

    /// Turns the parts by the angle that the box was found for, if that has not been done. Returns
    /// the work.
    pub fn turn_parts(&mut self, shape: &Shape) -> u64 {
        if !self.parts.is_empty() {
            return 0;
        }
        let turn = Turn::degrees(self.angle);
        self.xs.clear();
        self.ys.clear();
        self.normals.clear();
        self.reach.clear();
        for corners in &shape.parts {
            let first = self.xs.len();
            let (mut low, mut high, mut sum) = (DVec2::INFINITY, DVec2::NEG_INFINITY, DVec2::ZERO);
            for &p in corners {
                let p = turn.apply(p);
                self.xs.push(p.x);
                self.ys.push(p.y);
                (low, high, sum) = (low.min(p), high.max(p), sum + p);
            }
            let n = corners.len();
            let padded = n.next_multiple_of(LANES);
            for i in 0..padded {
                if i >= n {
                    self.xs.push(self.xs[first + n - 1]);
                    self.ys.push(self.ys[first + n - 1]);
                }
                let (a, b) = (self.corner(first + i % n), self.corner(first + (i + 1) % n));
                let normal = -(b - a).perp().normalize_or_zero();
                self.normals.push(normal);
                self.reach.push(normal.dot(a).max(normal.dot(b)));
            }
            let middle = sum / n as f64;
            let inner = (first..first + n)
                .map(|k| self.reach[k] - self.normals[k].dot(middle))
                .fold(f64::INFINITY, f64::min);
            let outer = (first..first + n)
                .map(|k| self.corner(k).distance_squared(middle))
                .fold(0.0, f64::max)
                .sqrt();
            let inner = inner.max(0.0);
            self.parts.push(Part { first, corners: n, padded, low, high, middle, inner, outer });
        }
        self.xs.len() as u64 / 16
    }

    fn corner(&self, i: usize) -> DVec2 {
        DVec2::new(self.xs[i], self.ys[i])
    }

    /// The least of the corners of a part along a direction.
    fn least(&self, part: &Part, along: DVec2) -> f64 {
        let range = part.first..part.first + part.padded;
        let mut least = [f64::INFINITY; LANES];
        for (x, y) in
            self.xs[range.clone()].chunks_exact(LANES).zip(self.ys[range].chunks_exact(LANES))
        {
            for k in 0..LANES {
                let d = along.x * x[k] + along.y * y[k];
                least[k] = if d < least[k] { d } else { least[k] };
            }
        }
        least[0].min(least[1]).min(least[2].min(least[3]))
    }

    /// How much nearer than `apart` the part `a` of this shape and the part `b` of the other are,
    /// which is moved by `by` against this one: 0 when they keep that distance; when they overlap,
    /// `apart` and the depth of the overlap.
    pub fn shortage(&self, a: &Part, other: &Self, b: &Part, by: DVec2, apart: f64) -> f64 {
        let between = b.middle + by - a.middle;
        let far = a.outer + b.outer + apart;
        if between.length_squared() >= far * far {
            return 0.0;
        }
        // Along no normal can they be further apart than their middles are, less the inner circles.
        let inner = a.inner + b.inner;
        let mut gap = f64::NEG_INFINITY;
        for k in a.first..a.first + a.corners {
            let normal = self.normals[k];
            if normal.dot(between) - inner <= gap {
                continue;
            }
            let here = other.least(b, normal) + normal.dot(by) - self.reach[k];
            if here > gap {
                if here >= apart {
                    return 0.0;
                }
                gap = here;
            }
        }
        for k in b.first..b.first + b.corners {
            let normal = other.normals[k];
            if -normal.dot(between) - inner <= gap {
                continue;
            }
            let here = self.least(a, normal) - normal.dot(by) - other.reach[k];
            if here > gap {
                if here >= apart {
                    return 0.0;
                }
                gap = here;
            }
        }
        if gap > 0.0 {
            // Apart, and perhaps further than the normals tell: corner against corner.
            gap = gap.max(self.distance(a, other, b, by));
        }
        (apart - gap).max(0.0)
    }

    /// The distance of two parts that are apart.
    fn distance(&self, a: &Part, other: &Self, b: &Part, by: DVec2) -> f64 {
        let one_way = |p: &Self, a: &Part, q: &Self, b: &Part, by: DVec2| {
            let mut least = f64::INFINITY;
            for i in 0..a.corners {
                let (s, t) = (p.corner(a.first + i), p.corner(a.first + (i + 1) % a.corners));
                let side = t - s;
                let squared = side.length_squared();
                for j in b.first..b.first + b.corners {
                    let w = q.corner(j) + by - s;
                    let along =
                        if squared > 0.0 { (w.dot(side) / squared).clamp(0.0, 1.0) } else { 0.0 };
                    least = least.min(w.distance_squared(side * along));
                }
            }
            least
        };
        one_way(self, a, other, b, by).min(one_way(other, b, self, a, -by)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::distance::{contour_distance, distance_to_contour};
    use super::super::super::testing::random_convex;
    use super::*;
    use proptest::prelude::*;

    fn posed(contour: &[DVec2], angle: f64) -> (Posed, Vec<DVec2>) {
        let shape = Shape::new(contour, &[]);
        let mut posed = Posed::default();
        posed.turn(&shape, angle);
        let turn = super::super::super::layout::Turn::degrees(angle);
        (posed, contour.iter().map(|&p| turn.apply(p - shape.origin)).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// The shortage is what the contours, measured one against the other, lack.
        #[test]
        fn the_shortage_is_what_measuring_finds(seeds in (0_u64..500, 0_u64..500), turns in (0.0..360.0_f64, 0.0..360.0_f64), by in (-80.0..80.0_f64, -80.0..80.0_f64)) {
            let ((a, first), (b, second)) = (posed(&random_convex(seeds.0), turns.0), posed(&random_convex(seeds.1), turns.1));
            let by = DVec2::from(by);
            let moved: Vec<DVec2> = second.iter().map(|&p| p + by).collect();
            let shortage = a.shortage(&a.parts[0], &b, &b.parts[0], by, 3.0);
            let distance = contour_distance(&first, &moved);
            if distance > 0.0 && distance_to_contour(by, &first) > 0.0 && shortage < 3.0 {
                prop_assert!((shortage - (3.0 - distance).max(0.0)).abs() < 1e-9, "{shortage} at \
                {distance}");
            } else {
                // Moved apart by the depth along the best direction, they no longer overlap.
                let depth = shortage - 3.0;
                let free = (0..3600).any(|i| {
                    let away = DVec2::from_angle(f64::from(i) * 0.001_745_33) * (depth * 1.001 + 0.01);
                    a.shortage(&a.parts[0], &b, &b.parts[0], by + away, 3.0) <= 3.0
                });
                prop_assert!(shortage >= 3.0 && free, "{shortage}");
            }
        }
    }
}
