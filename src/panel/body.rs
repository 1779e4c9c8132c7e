//! A plate as a body in space, as what it takes of others is measured. It knows the corners of the
//! finished plate and nothing of how they came about.

use glam::{DVec2, DVec3};

use super::cell::{Cell, HalfSpace};
use super::plate::Plate;
use crate::geom::triangulate;

/// Turns and twists up to this sine are rounding.
const ROUNDING: f64 = 1e-12;

/// The body of a plate, without its round holes.
pub(super) struct Body<'a> {
    plate: &'a Plate,
    front: Vec<DVec3>,
    back: Vec<DVec3>,
    pub low: DVec3,
    pub high: DVec3,
    /// In mm³.
    pub volume: f64,
}

/// A convex part of a body: it counts as present, or as taken away where parts lie double.
pub(super) struct Part {
    pub cell: Cell,
    pub sign: f64,
    pub low: DVec3,
    pub high: DVec3,
}

impl Part {
    fn new(cell: Cell, sign: f64) -> Self {
        let (low, high) = bounds(cell.points().iter().copied());
        Self { cell, sign, low, high }
    }
}

impl<'a> Body<'a> {
    /// `about` is a point near all bodies that are compared: their corners are measured from it, so
    /// that far from the origin no digits are lost.
    pub fn new(plate: &'a Plate, about: DVec3) -> Self {
        let frame = &plate.frame;
        let origin = frame.origin - about;
        let place = |p: &DVec2| origin + frame.x * p.x + frame.y * p.y;
        let depth = frame.normal * plate.thickness;
        let front: Vec<DVec3> = plate.front.iter().map(place).collect();
        let back: Vec<DVec3> = plate.back.iter().map(|p| place(p) - depth).collect();
        let (low, high) = bounds(front.iter().chain(&back).copied());
        let whole = Plate { holes: Vec::new(), ..plate.clone() };
        Self { plate, front, back, low, high, volume: whole.volume() }
    }

    fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.front.iter().chain(&self.back).copied()
    }

    /// Whether the plane of some face of `self` has `self` on one side and `other` on the other, up
    /// to `slack`.
    pub fn is_parted_from(&self, other: &Self, slack: f64) -> bool {
        let n = self.front.len();
        let wall = |i: usize| {
            let j = (i + 1) % n;
            half_space(&[self.back[i], self.back[j], self.front[j], self.front[i]])
        };
        let normal = self.plate.frame.normal;
        let caps = [(normal, self.front[0]), (-normal, self.back[0])]
            .map(|(normal, p)| HalfSpace { normal, offset: normal.dot(p) });
        (0..n).filter_map(wall).chain(caps).any(|plane| {
            other.corners().all(|p| plane.distance(p) >= -slack)
                && self.corners().all(|p| plane.distance(p) <= slack)
        })
    }

    /// The body as convex parts. Convex plates are one part. Else the front is cut into triangles,
    /// and what lies between one of them and its image on the back is one part where its walls are
    /// flat, three tetrahedra where they are twisted.
    pub fn parts(&self) -> Vec<Part> {
        if self.is_convex() {
            return vec![Part::new(Cell::between(&self.front, &self.back), 1.0)];
        }
        let triangles = triangulate(&self.plate.front);
        triangles.into_iter().flat_map(|t| self.parts_between(t)).collect()
    }

    fn is_convex(&self) -> bool {
        let plate = self.plate;
        let n = plate.front.len();
        let side = |outline: &[DVec2], i: usize| outline[(i + 1) % n] - outline[i % n];
        let turns_left = |outline: &[DVec2], i: usize| {
            let (u, v) = (side(outline, i), side(outline, (i + 1) % n));
            u.perp_dot(v) >= -ROUNDING * u.length() * v.length()
                && u.dot(v) > -u.length() * v.length()
        };
        (0..n).all(|i| {
            turns_left(&plate.front, i) && turns_left(&plate.back, i) && self.has_flat_wall(i)
        })
    }

    fn has_flat_wall(&self, i: usize) -> bool {
        let n = self.front.len();
        let [u, v] = [&self.plate.front, &self.plate.back].map(|o| o[(i + 1) % n] - o[i]);
        u.perp_dot(v).abs() <= ROUNDING * u.length() * v.length()
    }

    fn parts_between(&self, triangle: [usize; 3]) -> Vec<Part> {
        let corners = |of: &[DVec3]| triangle.map(|i| of[i]);
        let shift = |i: usize| self.plate.front[i] - self.plate.back[i];
        let is_straight = triangle.iter().all(|&i| shift(i) == shift(triangle[0]));
        let [a, b, c] = triangle.map(|i| self.plate.front[i]);
        if is_straight {
            let (mut front, mut back) = (corners(&self.front), corners(&self.back));
            let is_positive = (b - a).perp_dot(c - a) > 0.0;
            if !is_positive {
                front.swap(0, 1);
                back.swap(0, 1);
            }
            let sign = if is_positive { 1.0 } else { -1.0 };
            return vec![Part::new(Cell::between(&front, &back), sign)];
        }
        // Every twisted wall is halved from the front of its lower corner to the back of its higher
        // one, so that neighbours halve it alike.
        let mut sorted = triangle;
        sorted.sort_unstable();
        let is_turned = (0..3).any(|k| {
            let rolled = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
            rolled == [sorted[0], sorted[2], sorted[1]]
        });
        let [i, j, k] = sorted;
        let chain = [
            [self.front[i], self.front[j], self.front[k], self.back[k]],
            [self.front[i], self.front[j], self.back[k], self.back[j]],
            [self.front[i], self.back[j], self.back[k], self.back[i]],
        ];
        let part = |corners: [DVec3; 4]| {
            // Behind the front is its inner side: what runs as the front does is negative here.
            let (cell, is_positive) = Cell::tetrahedron(corners);
            Part::new(cell, if is_positive == is_turned { 1.0 } else { -1.0 })
        };
        chain.map(part).into()
    }
}

/// Whether two boxes meet.
pub(super) fn meet(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// The half-space behind a flat quad that runs counter-clockwise from outside.
fn half_space(&[a, b, c, d]: &[DVec3; 4]) -> Option<HalfSpace> {
    let normal = (c - a).cross(d - b).try_normalize()?;
    Some(HalfSpace { normal, offset: normal.dot((a + b + c + d) / 4.0) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Frame;
    use crate::mesh::FaceId;

    fn plate(front: &[(f64, f64)], back: &[(f64, f64)]) -> Plate {
        let flat =
            |points: &[(f64, f64)]| points.iter().map(|&p| DVec2::from(p)).collect::<Vec<_>>();
        Plate {
            face: FaceId::new(0),
            thickness: 2.0,
            frame: Frame { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, normal: DVec3::Z },
            half_edges: vec![],
            reference: flat(front),
            front: flat(front),
            back: flat(back),
            blank: flat(front),
            inner: flat(front),
            begins: vec![],
            ends: vec![],
            holes: vec![],
        }
    }

    #[test]
    fn parts_add_up_to_the_plate() {
        let ell = [(0., 0.), (60., 0.), (60., 30.), (30., 30.), (30., 60.), (0., 60.)];
        let smaller = [(2., 3.), (57., 3.), (57., 26.), (26., 26.), (26., 55.), (2., 55.)];
        let square = [(0., 0.), (10., 0.), (10., 10.), (0., 10.)];
        let turned = [(1., 2.), (9., 1.), (10., 9.), (0., 8.)];
        for (front, back, count) in [
            (&ell[..], &ell[..], 4),
            (&ell[..], &smaller[..], 12),
            (&square[..], &square[..], 1),
            (&square[..], &turned[..], 6),
        ] {
            let plate = plate(front, back);
            let body = Body::new(&plate, DVec3::new(5.0, -3.0, 1.0));
            let parts = body.parts();
            let sum: f64 = parts.iter().map(|p| p.sign * p.cell.volume()).sum();
            assert_eq!(parts.len(), count);
            // Twisted walls are halved one way only, which takes or adds a part of the twist.
            let slack = if count == 6 { 10.0 } else { 1e-9 };
            assert!((sum - body.volume).abs() < slack, "{sum} instead of {}", body.volume);
        }
    }
}
