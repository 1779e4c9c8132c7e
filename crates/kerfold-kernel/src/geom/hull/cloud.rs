//! The points of a hull: rounded coordinates for speed, given numbers for the truth.

use glam::DVec3;

use super::determinant::sign_of_determinant;
use super::half_space::HalfSpace;
use super::scale::inverse_power_of_two;
use crate::geom::Side;
use crate::geom::predicate::orient3d;

/// Exact signs of the points behind a cloud. Points are named by their place in the order of
/// insertion.
pub(super) trait Signs: Sync {
    /// The side of `p` with respect to the plane through a, b, c: [`Side::Normal`] where they run
    /// counter-clockwise.
    fn height(&self, corners: [u32; 3], p: u32) -> Side;

    /// The side of `p` with respect to the plane through the centre, a and b: [`Side::Normal`] when
    /// a, b, p run counter-clockwise seen from outside.
    fn turn(&self, a: u32, b: u32, p: u32) -> Side;

    /// Whether the three points lie on one line.
    fn are_collinear(&self, corners: [u32; 3]) -> bool;
}

/// Points about a centre, scaled so that no coordinate exceeds 1, in the order of insertion.
pub(super) struct Cloud<S> {
    points: Vec<DVec3>,
    /// How far a rounded coordinate may be from the true one.
    noise: f64,
    /// The most that [`Self::height`]'s rounded volume can be wrong by, wherever the points lie.
    height_bound: f64,
    pub(super) signs: S,
}

impl<S: Signs> Cloud<S> {
    /// `points` carry a relative error of at most `roundings` half ulps in each coordinate. They
    /// are scaled by a power of two.
    pub(super) fn new(points: Vec<DVec3>, roundings: f64, signs: S) -> (Self, f64) {
        let scale = inverse_power_of_two(reach(&points).max_element()) * 0.5;
        (Self::scaled(points, DVec3::splat(scale), roundings, signs), scale)
    }

    /// The same with a power of two for each axis, so that the points fill the cube however flat
    /// they lie: no sign depends on that.
    pub(super) fn stretched(points: Vec<DVec3>, roundings: f64, signs: S) -> (Self, DVec3) {
        let scale = DVec3::from_array(reach(&points).to_array().map(inverse_power_of_two)) * 0.5;
        (Self::scaled(points, scale, roundings, signs), scale)
    }

    fn scaled(mut points: Vec<DVec3>, scale: DVec3, roundings: f64, signs: S) -> Self {
        if scale != DVec3::ONE {
            points.iter_mut().for_each(|p| *p *= scale);
        }
        let noise = roundings * f64::EPSILON / 2.0;
        Self { points, noise, height_bound: height_bound(2.0, noise), signs }
    }

    pub(super) fn points(&self) -> &[DVec3] {
        &self.points
    }

    pub(super) fn len(&self) -> u32 {
        self.points.len() as u32
    }

    pub(super) fn point(&self, p: u32) -> DVec3 {
        self.points[p as usize]
    }

    /// How far a coordinate may be from the true one.
    pub(super) fn noise(&self) -> f64 {
        self.noise
    }

    /// On which side of the plane through three points, counter-clockwise from its normal side, p
    /// lies; exact.
    #[inline]
    pub(super) fn height(&self, corners: [u32; 3], p: u32) -> Side {
        let o = self.point(p);
        let [a, b, c] = corners.map(|v| self.point(v) - o);
        self.settled_height(corners, p, a.dot(b.cross(c)))
    }

    /// The same for who has the rounded volume a·(b × c) of the corners seen from p, in whatever
    /// order it was computed.
    #[inline]
    pub(super) fn settled_height(&self, corners: [u32; 3], p: u32, below: f64) -> Side {
        if below.abs() > self.height_bound {
            Side::of(-below)
        } else {
            self.small_height(corners, p, below)
        }
    }

    /// The same for a volume that only a closer look can tell from zero.
    #[inline(never)]
    fn small_height(&self, corners: [u32; 3], p: u32, below: f64) -> Side {
        let o = self.point(p);
        let [a, b, c] = corners.map(|v| (self.point(v) - o).abs());
        let bound = height_bound(a.max(b).max(c).max_element(), self.noise);
        if below > bound {
            Side::Reverse
        } else if below < -bound {
            Side::Normal
        } else {
            self.signs.height(corners, p)
        }
    }

    /// The most that a·(b × c) of three points can be wrong by.
    pub(super) fn turn_bound(&self) -> f64 {
        19.0 * self.noise + 4e-15
    }
}

/// The largest coordinates along the axes, without their signs.
fn reach(points: &[DVec3]) -> DVec3 {
    points.iter().fold(DVec3::ZERO, |reach, p| reach.max(p.abs()))
}

/// The most that the rounded volume of three differences of points can be wrong by, with no entry
/// above `m`: each entry is off by at most 2·noise + ε/2·m; six products of three entries, then the
/// roundings of the sums.
fn height_bound(m: f64, noise: f64) -> f64 {
    m * m * (37.0 * noise + 6.5e-15 * m)
}

/// Points as given, seen from a centre that is a point too.
pub(super) struct PointSigns<'a> {
    pub points: &'a [DVec3],
    pub order: &'a [u32],
    pub centre: DVec3,
}

impl PointSigns<'_> {
    fn at(&self, place: u32) -> DVec3 {
        self.points[self.order[place as usize] as usize]
    }
}

impl Signs for PointSigns<'_> {
    fn height(&self, corners: [u32; 3], p: u32) -> Side {
        let [a, b, c] = corners.map(|v| self.at(v));
        Side::of(-orient3d(a, b, c, self.at(p)))
    }

    fn turn(&self, a: u32, b: u32, p: u32) -> Side {
        Side::of(orient3d(self.at(a), self.at(b), self.at(p), self.centre))
    }

    fn are_collinear(&self, corners: [u32; 3]) -> bool {
        are_collinear(corners.map(|v| self.at(v)))
    }
}

/// Whether three points lie on one line, exactly: they do when they do along all three axes.
pub(super) fn are_collinear(points: [DVec3; 3]) -> bool {
    (0..3).all(|axis| {
        let [a, b, c] = points.map(|p| glam::DVec2::new(p[axis], p[(axis + 1) % 3]));
        crate::geom::predicate::orient2d(a, b, c) == 0.0
    })
}

/// Planes as points of the dual: n·x ≤ d about a centre c is the point n / (d − n·c).
///
/// With slacks d − n·c above zero, which is checked before, the sign of four dual points is the
/// sign of the determinant of their rows (n, d): the centre drops out, so the signs are those of
/// the given numbers.
pub(super) struct PlaneSigns<'a> {
    half_spaces: &'a [HalfSpace],
    order: &'a [u32],
    /// Power of two that brings the offsets to about 1.
    offset_scale: f64,
}

impl<'a> PlaneSigns<'a> {
    pub(super) fn new(half_spaces: &'a [HalfSpace], order: &'a [u32]) -> Self {
        let most = half_spaces.iter().map(|h| h.offset.abs()).fold(0.0, f64::max);
        Self { half_spaces, order, offset_scale: inverse_power_of_two(most) }
    }

    /// The numbers of a plane, scaled by powers of two, which change no sign.
    fn row(&self, place: u32) -> [f64; 4] {
        let [x, y, z, offset] = self.half_spaces[self.order[place as usize] as usize].row();
        [x, y, z, offset * self.offset_scale]
    }
}

impl Signs for PlaneSigns<'_> {
    fn height(&self, [a, b, c]: [u32; 3], p: u32) -> Side {
        // Rows that differ by the ones in the last column: the determinant is minus the volume.
        match sign_of_determinant([a, b, c, p].map(|v| self.row(v))) {
            Side::Normal => Side::Reverse,
            Side::On => Side::On,
            Side::Reverse => Side::Normal,
        }
    }

    fn turn(&self, a: u32, b: u32, p: u32) -> Side {
        let [a, b, p] = [a, b, p].map(|v| {
            let [x, y, z, _] = self.row(v);
            DVec3::new(x, y, z)
        });
        Side::of(orient3d(a, b, p, DVec3::ZERO))
    }

    fn are_collinear(&self, corners: [u32; 3]) -> bool {
        let rows = corners.map(|v| self.row(v));
        [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].into_iter().all(|columns| {
            let [a, b, c] = rows.map(|row| DVec3::from_array(columns.map(|k| row[k])));
            orient3d(a, b, c, DVec3::ZERO) == 0.0
        })
    }
}
