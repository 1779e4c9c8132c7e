//! Do two faces of a piece share area?
//!
//! Each polygon is a sum of signed triangles from its first corner, so the area that two polygons
//! share is the signed sum of what their triangles share, and that of two triangles is found by
//! clipping one with the sides of the other (Sutherland and Hodgman 1974). No convexity is needed,
//! and nothing of the unfolder's own test is used.

use glam::DVec2;

use super::ProofError;
use crate::net::{FlatFace, Net, Piece};

/// Shared area that still counts as touching: this much of the model's size times the smaller
/// perimeter, ten times the depth that the unfolder lets through.
const TOUCHING: f64 = 1e-10;

pub(super) fn check(net: &Net, size: f64) -> Result<(), ProofError> {
    let (mut pairs, mut first) = (0, None);
    for piece in &net.pieces {
        for (a, b) in near_pairs(piece) {
            let perimeter = a.perimeter.min(b.perimeter);
            if shared_area(&a.flat.polygon, &b.flat.polygon) > TOUCHING * size * perimeter {
                pairs += 1;
                first.get_or_insert((piece.id.0 + 1, [a.flat.face, b.flat.face]));
            }
        }
    }
    match first {
        Some((piece, faces)) => Err(ProofError::Overlap { piece, faces, pairs }),
        None => Ok(()),
    }
}

struct Boxed<'a> {
    flat: &'a FlatFace,
    low: DVec2,
    high: DVec2,
    perimeter: f64,
}

impl<'a> Boxed<'a> {
    fn new(flat: &'a FlatFace) -> Self {
        let polygon = &flat.polygon;
        let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let sides =
            (0..polygon.len()).map(|i| polygon[i].distance(polygon[(i + 1) % polygon.len()]));
        Self { flat, low, high, perimeter: sides.sum() }
    }
}

/// All pairs of faces whose boxes meet, by a sweep along x.
fn near_pairs(piece: &Piece) -> Vec<(Boxed<'_>, Boxed<'_>)> {
    let mut faces: Vec<Boxed> = piece.faces.iter().map(Boxed::new).collect();
    faces.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
    let mut active: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for (i, face) in faces.iter().enumerate() {
        active.retain(|&k| faces[k].high.x > face.low.x);
        let meet = active
            .iter()
            .filter(|&&k| faces[k].low.y < face.high.y && face.low.y < faces[k].high.y);
        pairs.extend(meet.map(|&k| (k, i)));
        active.push(i);
    }
    pairs.into_iter().map(|(k, i)| (Boxed::new(faces[k].flat), Boxed::new(faces[i].flat))).collect()
}

/// The area that two simple polygons share.
fn shared_area(a: &[DVec2], b: &[DVec2]) -> f64 {
    // Seen from a corner of one of them, the products keep their digits however far out in the net
    // the faces lie.
    let origin = a[0];
    let fan = |polygon: &[DVec2]| -> Vec<[DVec2; 3]> {
        (1..polygon.len() - 1)
            .map(|i| [polygon[0] - origin, polygon[i] - origin, polygon[i + 1] - origin])
            .collect()
    };
    let others = fan(b);
    let of_triangle =
        |t: &[DVec2; 3]| others.iter().map(|u| shared_by_triangles(*t, *u)).sum::<f64>();
    fan(a).iter().map(of_triangle).sum()
}

/// The area shared by two triangles, negative when one of them runs clockwise.
fn shared_by_triangles(t: [DVec2; 3], u: [DVec2; 3]) -> f64 {
    let area = |t: [DVec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]);
    let sign = area(t).signum() * area(u).signum();
    let forward = |t: [DVec2; 3]| if area(t) < 0.0 { [t[0], t[2], t[1]] } else { t };
    let (clip, mut rest) = (forward(u), forward(t).to_vec());
    for i in 0..3 {
        rest = clipped(&rest, clip[i], clip[(i + 1) % 3]);
        if rest.len() < 3 {
            return 0.0;
        }
    }
    let doubled: f64 = (1..rest.len() - 1).map(|i| area([rest[0], rest[i], rest[i + 1]])).sum();
    sign * doubled / 2.0
}

/// The part of a convex polygon on the left of the line from `a` to `b`.
fn clipped(polygon: &[DVec2], a: DVec2, b: DVec2) -> Vec<DVec2> {
    let height = |p: DVec2| (b - a).perp_dot(p - a);
    let mut rest = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (here, there) = (height(p), height(q));
        if here >= 0.0 {
            rest.push(p);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            rest.push(p + (q - p) * (here / (here - there)));
        }
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn shared_areas_of_concave_polygons() {
        let ell = polygon(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)]);
        let in_notch = polygon(&[(1., 1.), (2., 1.), (2., 2.), (1., 2.)]);
        let across = polygon(&[(0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5)]);
        assert!(shared_area(&ell, &in_notch).abs() < 1e-15);
        assert!((shared_area(&ell, &across) - 0.75).abs() < 1e-15);
        assert!((shared_area(&across, &ell) - 0.75).abs() < 1e-15);
        assert!((shared_area(&ell, &ell) - 3.0).abs() < 1e-14);
    }
}
