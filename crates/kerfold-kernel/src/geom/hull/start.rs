//! Where the hull begins: four points of a large tetrahedron, and more until the centre lies
//! inside.

use glam::DVec3;

use super::cloud::{Cloud, Signs};
use super::surface::Surface;
use crate::geom::Side;

/// Why points have no hull with a volume, or the centre is not inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flat {
    /// All points are one.
    Point,
    /// All lie on a line along this direction.
    Line(DVec3),
    /// All lie on a plane with this normal.
    Plane(DVec3),
    /// All lie on one side of a plane that does not leave the centre behind it: its normal.
    OneSided(DVec3),
}

/// So many of the first points are looked at for the first corners.
const SAMPLE: u32 = 4096;

/// Four points that span a volume, beginning with `a`, the last below the other three: greedily as
/// far apart as can be told quickly.
pub(super) fn far_apart<S: Signs>(cloud: &Cloud<S>, a: u32) -> Result<[u32; 4], Flat> {
    let sample =
        if cloud.len() > SAMPLE { far_apart_among(cloud, a, SAMPLE) } else { Err(Flat::Point) };
    sample.or_else(|_| far_apart_among(cloud, a, cloud.len()))
}

fn far_apart_among<S: Signs>(cloud: &Cloud<S>, a: u32, count: u32) -> Result<[u32; 4], Flat> {
    let from_a = |i: u32| cloud.point(i) - cloud.point(a);
    let b = farthest(count, |i| from_a(i).length_squared());
    let along = from_a(b);
    if along == DVec3::ZERO {
        return Err(Flat::Point);
    }
    let mut c = farthest(count, |i| along.cross(from_a(i)).length_squared());
    if cloud.signs.are_collinear([a, b, c]) {
        let is_off = |&i: &u32| !cloud.signs.are_collinear([a, b, i]);
        c = (0..count).find(is_off).ok_or(Flat::Line(along))?;
    }
    let normal = along.cross(from_a(c));
    let mut d = farthest(count, |i| normal.dot(from_a(i)).abs());
    let mut side = cloud.height([a, b, c], d);
    if side == Side::On {
        let is_off = |&i: &u32| cloud.height([a, b, c], i) != Side::On;
        d = (0..count).find(is_off).ok_or(Flat::Plane(normal))?;
        side = cloud.height([a, b, c], d);
    }
    Ok(if side == Side::Reverse { [a, b, c, d] } else { [a, c, b, d] })
}

/// Inserts the farthest point above each facet that does not have the centre below it, until none
/// is left.
///
/// Returns the points that were inserted.
pub(super) fn enclose_centre<S: Signs>(
    cloud: &Cloud<S>,
    surface: &mut Surface<'_>,
) -> Result<Vec<u32>, Flat> {
    let mut inserted = Vec::new();
    let is_open = |surface: &Surface<'_>, f: u32| {
        let [a, b, c] = surface.facet(f).corners;
        cloud.signs.turn(a, b, c) != Side::Normal
    };
    loop {
        let open = surface.live().find(|&f| is_open(surface, f));
        let Some(f) = open else { return Ok(inserted) };
        let corners = surface.facet(f).corners;
        let [a, b, c] = corners.map(|v| cloud.point(v));
        let normal = (b - a).cross(c - a);
        let height = |i| normal.dot(cloud.point(i) - a);
        let mut top = farthest(cloud.len().min(SAMPLE), height);
        if cloud.height(corners, top) != Side::Normal {
            top = farthest(cloud.len(), height);
        }
        if cloud.height(corners, top) != Side::Normal {
            let is_above = |&i: &u32| cloud.height(corners, i) == Side::Normal;
            top = (0..cloud.len()).find(is_above).ok_or(Flat::OneSided(normal))?;
        }
        surface.insert_above(cloud, top, f);
        inserted.push(top);
    }
}

/// The first of the numbers below `n` with the greatest measure.
fn farthest(n: u32, measure: impl Fn(u32) -> f64) -> u32 {
    let mut best = (f64::NEG_INFINITY, 0);
    for i in 0..n {
        let m = measure(i);
        if m > best.0 {
            best = (m, i);
        }
    }
    best.1
}
