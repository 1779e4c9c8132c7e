//! Where the new points of the schemes lie.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};

/// The mean of a face's corners; a corner that is visited twice counts twice.
pub(super) fn centre(mesh: &Mesh, f: FaceId) -> DVec3 {
    let (sum, count) = mesh
        .face_vertices(f)
        .fold((DVec3::ZERO, 0.0), |(sum, count), v| (sum + mesh.position(v), count + 1.0));
    sum / count
}

pub(super) fn midpoint(mesh: &Mesh, e: EdgeId) -> DVec3 {
    let [a, b] = mesh.edge_positions(e);
    (a + b) / 2.0
}

/// `cos(2πk/n)` for k = 0 … n − 1, for each n once.
#[derive(Default)]
pub(super) struct Cosines(Vec<Vec<f64>>);

impl Cosines {
    pub(super) fn of(&mut self, n: usize) -> &[f64] {
        if self.0.len() <= n {
            self.0.resize(n + 1, Vec::new());
        }
        if self.0[n].is_empty() {
            self.0[n] = (0..n).map(|k| (TAU * k as f64 / n as f64).cos()).collect();
        }
        &self.0[n]
    }
}

/// The weighted mean of the points around each place of a ring: `own` for the place itself,
/// `other(cos(2πk/n))` for the one k places on.
pub(super) fn ring_means(
    points: &[DVec3],
    cosines: &[f64],
    own: f64,
    other: impl Fn(f64) -> f64,
    out: &mut Vec<DVec3>,
) {
    for i in 0..points.len() {
        let mut sum = points[i] * own;
        let after = points[i + 1..].iter().chain(&points[..i]);
        for (&point, &cos) in after.zip(&cosines[1..]) {
            sum += point * other(cos);
        }
        out.push(sum);
    }
}

/// Catmull and Clark's point for a vertex, or on a rim the cubic B-spline's.
pub(super) fn smooth_vertex(mesh: &Mesh, v: VertexId, centres: &[DVec3]) -> DVec3 {
    let here = mesh.position(v);
    if let Some(rim) = rim_point(mesh, v) {
        return rim;
    }
    let (mut faces, mut edges, mut n) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for h in mesh.outgoing(v) {
        faces += centres[mesh.face(h).index()];
        edges += midpoint(mesh, h.edge());
        n += 1.0;
    }
    if n == 0.0 { here } else { (faces / n + edges * (2.0 / n) + here * (n - 3.0)) / n }
}

/// On a rim: a quarter of the mean of the two neighbours along it, three quarters of the vertex.
pub(super) fn rim_point(mesh: &Mesh, v: VertexId) -> Option<DVec3> {
    let mut rim =
        mesh.outgoing(v).filter(|h| mesh.is_rim(h.edge())).map(|h| mesh.position(mesh.target(h)));
    let (a, b) = (rim.next()?, rim.next()?);
    // Several rims at one vertex are pulled apart by the builder, so there are two neighbours.
    Some((a + b) * 0.125 + mesh.position(v) * 0.75)
}

/// Loop's point for a vertex of valence n, with his β.
pub(super) fn loop_vertex(mesh: &Mesh, v: VertexId) -> DVec3 {
    if let Some(rim) = rim_point(mesh, v) {
        return rim;
    }
    let here = mesh.position(v);
    let (sum, n) = mesh
        .neighbours(v)
        .fold((DVec3::ZERO, 0.0), |(sum, n), u| (sum + mesh.position(u), n + 1.0));
    if n == 0.0 {
        return here;
    }
    let root: f64 = 3.0 / 8.0 + (TAU / n).cos() / 4.0;
    let beta = (5.0 / 8.0 - root * root) / n;
    here * (1.0 - n * beta) + sum * beta
}

/// Loop's point for an edge: three eighths of each end, and an eighth of what each face has across.
/// Across in a triangle is the third corner; in a face with more sides it is the mean of all
/// corners but the edge's ends, and in one without others the edge's middle.
pub(super) fn loop_edge(mesh: &Mesh, e: EdgeId) -> DVec3 {
    let middle = midpoint(mesh, e);
    if mesh.is_rim(e) {
        return middle;
    }
    let across = |h: HalfEdgeId| {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        let mut out = mesh.next(mesh.next(h));
        while out != h {
            sum += mesh.position(mesh.origin(out));
            count += 1.0;
            out = mesh.next(out);
        }
        if count == 0.0 { middle } else { sum / count }
    };
    let [a, b] = e.half_edges();
    middle * 0.75 + (across(a) + across(b)) * 0.125
}
