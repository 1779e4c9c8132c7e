//! How the surface bends at the scale of a panel: a quadric for each vertex, fitted to what lies
//! around it on the surface, so that noise and facets smaller than a panel do not count.

use super::surface::Surface;
use crate::geom::{HeightSample, fit_quadric};
use glam::{DMat2, DVec2, DVec3};

/// So far the fit looks, in panel sizes.
const REACH: f64 = 0.85;
/// The standard deviation of the Gaussian by which it weighs what it sees.
const SPREAD: f64 = 0.45;
/// So many points are enough for a fit; of more, some are passed over.
const ENOUGH: f64 = 70.0;

/// The quadric at a vertex: z = (x, y) · bend · (x, y) / 2 over its tangent plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quadric {
    pub origin: DVec3,
    pub normal: DVec3,
    /// Two unit directions of the tangent plane; with the normal a right-handed frame.
    pub axes: [DVec3; 2],
    /// The second fundamental form at the vertex, in these axes.
    pub bend: DMat2,
}

/// The signed distance of a place from a quadric, to first order, and the unit normal there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub distance: f64,
    pub normal: DVec3,
}

impl Quadric {
    /// A place in the axes of the tangent plane.
    pub(super) fn flatten(&self, place: DVec3) -> DVec2 {
        let r = place - self.origin;
        DVec2::new(r.dot(self.axes[0]), r.dot(self.axes[1]))
    }

    /// The point of the quadric over a place of the tangent plane.
    pub(super) fn lift(&self, flat: DVec2) -> DVec3 {
        let height = 0.5 * flat.dot(self.bend * flat);
        self.origin + self.axes[0] * flat.x + self.axes[1] * flat.y + self.normal * height
    }

    /// How high a place lies over the quadric.
    pub(super) fn height(&self, place: DVec3) -> Height {
        let flat = self.flatten(place);
        let slope = self.bend * flat;
        let lack = (place - self.origin).dot(self.normal) - 0.5 * flat.dot(slope);
        let length = (1.0 + slope.length_squared()).sqrt();
        let normal = (self.normal - self.axes[0] * slope.x - self.axes[1] * slope.y) / length;
        Height { distance: lack / length, normal }
    }

    /// The principal curvatures, the one with the smaller absolute value first, and the angle of
    /// its direction in the axes.
    pub(super) fn principal(&self) -> ([f64; 2], f64) {
        let (a, b, c) = (self.bend.x_axis.x, self.bend.x_axis.y, self.bend.y_axis.y);
        let (mean, half) = ((a + c) / 2.0, (a - c) / 2.0);
        let radius = half.hypot(b);
        // The angle of the direction of the larger curvature (with its sign).
        let angle = 0.5 * b.atan2(half);
        let (high, low) = (mean + radius, mean - radius);
        if low.abs() <= high.abs() {
            ([low, high], angle + std::f64::consts::FRAC_PI_2)
        } else {
            ([high, low], angle)
        }
    }

    /// The ratio of the principal curvatures, from −1 to 1: 1 at umbilics, 0 where the surface is
    /// developable, negative at saddles.
    pub(super) fn ratio(&self) -> f64 {
        let ([small, large], _) = self.principal();
        if large == 0.0 { 0.0 } else { small / large }
    }

    /// The largest absolute curvature times a sixth: by how much of its size a panel of size 1 must
    /// leave the surface.
    pub(super) fn sag(&self) -> f64 {
        self.principal().0[1].abs() / 6.0
    }
}

/// The quadrics of all vertices. Looking along the surface, not through space, keeps sheets apart
/// that lie near each other.
pub(super) fn quadrics(surface: &Surface) -> Vec<Quadric> {
    first_quadrics(surface, surface.points.len())
}

/// The quadrics of so many vertices.
pub(super) fn first_quadrics(surface: &Surface, count: usize) -> Vec<Quadric> {
    of_surroundings(surface, count, |v, near| fit(surface, v, near.iter().copied()))
}

/// How high the quadric at each vertex lies above it, along its normal: small where the surface is
/// smooth at the scale of a panel.
pub(super) fn offsets(surface: &Surface) -> Vec<f64> {
    let count = surface.points.len();
    of_surroundings(surface, count, |v, near| {
        fit_quadric(samples(surface, v, near.iter().copied()))[0]
    })
}

/// What `of` makes of each of so many vertices and those around it that fits use, itself among them.
fn of_surroundings<T>(
    surface: &Surface,
    count: usize,
    of: impl Fn(usize, &[usize]) -> T,
) -> Vec<T> {
    let used = used_in_fits(surface);
    let mut seen = vec![usize::MAX; surface.points.len()];
    let mut near = Vec::new();
    (0..count)
        .map(|v| {
            around(surface, v, &mut seen, &mut near);
            near.retain(|&u| used[u] || u == v);
            of(v, &near)
        })
        .collect()
}

/// Vertices that fits use: all on rims, else every so-manieth, in a pattern without direction.
fn used_in_fits(surface: &Surface) -> Vec<bool> {
    let mean_area = surface.area() / surface.points.len() as f64;
    let expected = std::f64::consts::PI * REACH * REACH / mean_area;
    let share = (ENOUGH / expected).min(1.0);
    // Multiples of the golden ratio are spread evenly (Weyl 1916).
    let spread = |v: usize| (v as f64 * 0.618_033_988_749_894_9).fract();
    (0..surface.points.len()).map(|v| spread(v) < share || surface.is_rim(v)).collect()
}

/// Vertices within reach that are connected to one within reach.
fn around(surface: &Surface, v: usize, seen: &mut [usize], near: &mut Vec<usize>) {
    near.clear();
    near.push(v);
    seen[v] = v;
    let mut next = 0;
    while let Some(&u) = near.get(next) {
        next += 1;
        for &w in surface.links.of(u) {
            if seen[w] != v {
                seen[w] = v;
                if surface.points[w].distance_squared(surface.points[v]) < REACH * REACH {
                    near.push(w);
                }
            }
        }
    }
}

/// Some vertices around one as heights over its tangent plane, those that face the same way.
fn samples(
    surface: &Surface,
    v: usize,
    near: impl Iterator<Item = usize>,
) -> impl Iterator<Item = HeightSample> {
    let (origin, normal) = (surface.points[v], surface.normals[v]);
    let first = normal.any_orthonormal_vector();
    let second = normal.cross(first);
    let faces_alike = move |&u: &usize| surface.normals[u].dot(normal) > 0.3;
    near.filter(faces_alike).map(move |u| {
        let r = surface.points[u] - origin;
        let (x, y) = (r.dot(first) / SPREAD, r.dot(second) / SPREAD);
        let weight = (-(x * x + y * y) / 2.0).exp();
        HeightSample { x, y, height: r.dot(normal), weight }
    })
}

/// The weighted least-squares quadric of some vertices around one.
fn fit(surface: &Surface, v: usize, near: impl Iterator<Item = usize>) -> Quadric {
    let (origin, normal) = (surface.points[v], surface.normals[v]);
    let first = normal.any_orthonormal_vector();
    let second = normal.cross(first);
    let [_, x, y, xx, xy, yy] = fit_quadric(samples(surface, v, near));
    let tilted = (normal - (first * x + second * y) / SPREAD).normalize();
    let axis = (first - tilted * first.dot(tilted)).normalize();
    Quadric {
        origin,
        normal: tilted,
        axes: [axis, tilted.cross(axis)],
        bend: DMat2::from_cols_array(&[xx, xy, xy, yy]) * (1.0 / (SPREAD * SPREAD)),
    }
}
