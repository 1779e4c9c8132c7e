//! The vertices as nodes: where the plates meet, and by how much they miss each other.

use glam::DVec3;

use super::cut::Cutter;
use super::outline::FlatFace;
use crate::geom::{Plane, meet_planes_near, meet_three};
use crate::measure::conical_residual;
use crate::mesh::{FaceId, FaceMap, Mesh, VertexId};
use crate::net::PieceId;

/// A vertex as the node of its plates, without joint gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The vertex.
    pub vertex: VertexId,
    /// Number of edges.
    pub valence: usize,
    /// Whether it lies on a rim.
    pub is_rim: bool,
    /// Where the front planes of its plates meet; with more than three plates the point nearest to
    /// all of them, with fewer the point of their common line (or plane) nearest to the vertex.
    pub front: DVec3,
    /// The same for the back planes.
    pub back: DVec3,
    /// Unit direction from back to front: the axis of the node.
    pub axis: DVec3,
    /// Conical residual in mm per mm of offset; 0 up to rounding where the plates meet exactly.
    pub residual: f64,
    /// The largest distance of a plate's corner from the front or back point, in mm. 0 up to
    /// rounding at valence 3.
    pub miss_mm: f64,
}

/// What was cut off at a node to keep two plates apart.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeCut {
    /// The vertex.
    pub vertex: VertexId,
    /// The two plates.
    pub panels: [PieceId; 2],
    /// What they took of each other before, in mm³.
    pub overlap_mm3: f64,
    /// How far the corner of each plate is cut back along its bisector, from its outermost point,
    /// in mm; 0 where it is whole.
    pub cut_mm: [f64; 2],
}

/// All nodes, in the order of the vertices. `flat[f]` is the index of a face in `faces`.
pub(super) fn nodes(
    mesh: &Mesh,
    cutter: &Cutter<'_>,
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
) -> Vec<Node> {
    mesh.vertices()
        .filter(|&v| mesh.vertex_start(v).is_some())
        .map(|v| node(mesh, cutter, v, (faces, flat)))
        .collect()
}

fn node(
    mesh: &Mesh,
    cutter: &Cutter<'_>,
    v: VertexId,
    (faces, flat): (&[FlatFace], &FaceMap<usize>),
) -> Node {
    let around: Vec<FaceId> = mesh.vertex_faces(v).collect();
    let [front, back] = [0, 1].map(|side| {
        let moved = |&f: &FaceId| {
            let frame = &faces[flat[f]].frame;
            Plane::new(frame.normal, frame.origin).map(|p| p.moved(cutter.offsets(f, 1.0)[side]))
        };
        meeting_point(&around.iter().filter_map(moved).collect::<Vec<_>>(), mesh.position(v))
    });
    let normals: DVec3 = around.iter().map(|&f| faces[flat[f]].frame.normal).sum();
    let (is_rim, valence) = (mesh.is_rim_vertex(v), mesh.valence(v));
    let axis = (front - back).try_normalize().unwrap_or(normals.normalize_or(DVec3::Z));
    let miss = |&f: &FaceId| corner_miss(mesh, cutter, v, &faces[flat[f]], [front, back]);
    // Three planes meet: nothing to measure, unless the faces do not lie in them. With two at a rim
    // the corner depends on how the rim is cut.
    let is_bent = mesh.outgoing(v).any(|h| !mesh.is_hole(mesh.face(h)) && cutter.is_bent(h));
    let is_exact = around.len() < 3 || (around.len() == 3 && !is_bent);
    let miss_mm = if is_exact { 0.0 } else { around.iter().map(miss).fold(0.0, f64::max) };
    let residual = if around.len() <= 3 { 0.0 } else { conical_residual(mesh, v).unwrap_or(0.0) };
    Node { vertex: v, valence, is_rim, front, back, axis, residual, miss_mm }
}

fn meeting_point(planes: &[Plane], near: DVec3) -> DVec3 {
    let exact = match planes {
        [a, b, c] => meet_three([a, b, c], near),
        _ => None,
    };
    exact.unwrap_or_else(|| meet_planes_near(planes, near).0)
}

/// How far the corners of a plate, without gap, are from the node's two points.
fn corner_miss(
    mesh: &Mesh,
    cutter: &Cutter<'_>,
    v: VertexId,
    face: &FlatFace,
    points: [DVec3; 2],
) -> f64 {
    let at = (0..face.len()).filter(|&i| mesh.origin(face.half_edges[i]) == v);
    let offsets = cutter.offsets(face.face, 1.0);
    at.map(|i| {
        let [before, after] =
            [face.before(i), i].map(|i| cutter.inset_with_gap(face.half_edges[i], 1.0, 0.0));
        let miss = |b: f64, a: f64, side: usize| {
            let corner = face
                .corner(i, b, a)
                .map(|p| face.frame.lift(p) + face.frame.normal * offsets[side]);
            corner.map_or(0.0, |p| p.distance(points[side]))
        };
        miss(before.front, after.front, 0).max(miss(before.back, after.back, 1))
    })
    .fold(0.0, f64::max)
}
