//! Schemes that keep the old vertices and divide edges and faces: Catmull–Clark, Loop,
//! triangulation.

use std::collections::BTreeMap;

use glam::DVec3;

use super::averaging::{centre, loop_edge, loop_vertex, midpoint, smooth_vertex};
use super::{OpError, ask, carry_groups};
use crate::geom::{Frame, Plane, triangulate};
use crate::mesh::{
    Corner, EdgeId, FaceId, FileFault, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap,
    WalkBuilder,
};
use crate::progress::Progress;

/// The halves of all edges: `first[h]` runs from the origin of h to the middle of its edge.
struct Halves {
    first: HalfEdgeMap<HalfEdgeId>,
    middle: HalfEdgeMap<VertexId>,
}

impl Halves {
    fn new(
        mesh: &Mesh,
        fine: &mut WalkBuilder,
        vertex_point: impl Fn(VertexId) -> DVec3,
        edge_point: impl Fn(EdgeId) -> DVec3,
    ) -> Self {
        let mut vertices = VertexMap::filled(mesh.vertex_slots(), VertexId::new(0));
        mesh.vertices().for_each(|v| vertices[v] = fine.vertex(vertex_point(v)));
        let mut middle = HalfEdgeMap::filled(mesh.half_edge_slots(), VertexId::new(0));
        let mut first = HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId::new(0));
        for e in mesh.edges() {
            let at = fine.vertex(edge_point(e));
            for h in e.half_edges() {
                middle[h] = at;
                first[h] = fine.edge(vertices[mesh.origin(h)], at);
            }
        }
        Self { first, middle }
    }

    /// From the middle of the half-edge's edge to its target.
    fn second(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.first[h.twin()].twin()
    }
}

/// Catmull–Clark; a rim follows the cubic B-spline of its own vertices.
pub(super) fn catmull_clark(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(v + e + f, 4 * e, 2 * e);
    let mut centres = vec![DVec3::ZERO; mesh.face_slots()];
    mesh.faces().for_each(|f| centres[f.index()] = centre(mesh, f));
    let edge_point = |e| {
        let middle = midpoint(mesh, e);
        if mesh.is_rim(e) {
            return middle;
        }
        let [left, right] = mesh.edge_faces(e);
        (middle * 2.0 + centres[left.index()] + centres[right.index()]) / 4.0
    };
    let halves = Halves::new(mesh, &mut fine, |v| smooth_vertex(mesh, v, &centres), edge_point);
    let mut pairs = Vec::new();
    let mut spokes: Vec<HalfEdgeId> = Vec::new();
    for (turn, f) in mesh.faces().enumerate() {
        ask(progress, turn)?;
        let at = fine.vertex(centres[f.index()]);
        spokes.clear();
        spokes.extend(mesh.face_half_edges(f).map(|h| fine.edge(halves.middle[h], at)));
        let mut before = spokes[spokes.len() - 1];
        for (h, &spoke) in mesh.face_half_edges(f).zip(&spokes) {
            let made =
                fine.face([halves.first[h], spoke, before.twin(), halves.second(mesh.prev(h))]);
            pairs.push((f, made));
            before = spoke;
        }
    }
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// Loop, extended: each corner is cut off by a triangle, what is left of the face is a polygon
/// between the middles of its sides. A rim follows the cubic B-spline of its own vertices.
pub(super) fn loop_scheme(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(v + e, 4 * e, f + 2 * e);
    let halves = Halves::new(mesh, &mut fine, |v| loop_vertex(mesh, v), |e| loop_edge(mesh, e));
    let mut pairs = Vec::new();
    let mut turns: Vec<HalfEdgeId> = Vec::new();
    for (turn, f) in mesh.faces().enumerate() {
        ask(progress, turn)?;
        turns.clear();
        turns.extend(
            mesh.face_half_edges(f)
                .map(|h| fine.edge(halves.middle[mesh.prev(h)], halves.middle[h])),
        );
        pairs.push((f, fine.face(turns.iter().copied())));
        for (h, turn) in mesh.face_half_edges(f).zip(&turns) {
            let made = fine.face([halves.second(mesh.prev(h)), halves.first[h], turn.twin()]);
            pairs.push((f, made));
        }
    }
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// Triangles between the corners of each face; new faces have the group of the old one, vertices
/// and edges that were there keep their order, and positions stay as given.
pub(super) fn triangulated(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e) = (mesh.vertex_count(), mesh.edge_count());
    let mut fine = WalkBuilder::with_capacity(v, 3 * v, 2 * v);
    let mut vertices = VertexMap::filled(mesh.vertex_slots(), VertexId::new(0));
    mesh.vertices().for_each(|v| vertices[v] = fine.vertex(mesh.position(v)));
    let mut sides = HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId::new(0));
    for e in mesh.edges() {
        let [h, t] = e.half_edges();
        sides[h] = fine.edge(vertices[mesh.origin(h)], vertices[mesh.origin(t)]);
        sides[t] = sides[h].twin();
    }
    let mut pairs = Vec::with_capacity(2 * e);
    for (turn, f) in mesh.faces().enumerate() {
        ask(progress, turn)?;
        for walk in triangle_walks(mesh, f, &mut fine, &vertices, &sides) {
            pairs.push((f, fine.face(walk)));
        }
    }
    let mut fine = fine.build();
    mesh.vertices()
        .for_each(|v| fine.set_position(vertices[v], mesh.position(v), mesh.is_given(v)));
    mesh.edges()
        .filter(|&e| mesh.is_seam(e))
        .for_each(|e| fine.set_seam(sides[e.half_edge()].edge(), true));
    carry_groups(mesh, &mut fine, pairs.into_iter());
    part_diagonals(&mut fine, e);
    Ok(fine)
}

/// Where a diagonal joins two vertices that something else joins already, as it does in two faces
/// beside a 2-valent vertex, takes the other diagonal of its two triangles; where that will not do,
/// divides it, and the triangles with it. Edges before number `old` are those of the mesh before.
fn part_diagonals(fine: &mut Mesh, old: usize) {
    for fault in fine.file_faults() {
        let FileFault::ParallelEdges(_, e) = fault else { continue };
        let [h, t] = e.half_edges();
        let is_between = e.index() >= old
            && [h, t].iter().all(|&s| !fine.is_hole(fine.face(s)) && fine.sides(fine.face(s)) == 3);
        if is_between && !flip(fine, e) {
            divide(fine, e);
        }
    }
}

/// Turns a diagonal between two triangles in one plane, if both are a convex quad with area left
/// on either side.
fn flip(fine: &mut Mesh, e: EdgeId) -> bool {
    let [h, t] = e.half_edges();
    let apexes = [h, t].map(|s| fine.origin(fine.prev(s)));
    let [c, d] = apexes.map(|v| fine.position(v));
    let [a, b] = fine.edge_positions(e);
    // From the new diagonal the old ends must lie on either side.
    let normals = [(a - c).cross(d - c), (d - c).cross(b - c)];
    let is_convex = normals[0].dot(normals[1]) > 0.0;
    if apexes[0] == apexes[1] || !is_convex || fine.edge_between(apexes[0], apexes[1]).is_some() {
        return false;
    }
    let corners = [fine.prev(h), fine.prev(t)];
    fine.delete_edge(e);
    fine.insert_edge(Corner::At(corners[0]), Corner::At(corners[1])).is_ok()
}

/// Puts a vertex on an edge between two triangles and joins it to their third corners.
fn divide(fine: &mut Mesh, e: EdgeId) {
    let [h, t] = e.half_edges();
    let apexes = [h, t].map(|s| fine.prev(s));
    let [a, b] = fine.edge_positions(e);
    let (middle, _) = fine.split_edge(e, a.midpoint(b));
    for apex in apexes {
        let face = fine.face(apex);
        let from = fine.face_half_edges(face).find(|&s| fine.origin(s) == middle);
        let from = from.expect("the vertex lies on a side of both");
        fine.insert_edge(Corner::At(from), Corner::At(apex)).expect("two corners of one face");
    }
}

/// The half-edges of a face's triangles; diagonals are made on the way.
fn triangle_walks(
    mesh: &Mesh,
    f: FaceId,
    fine: &mut WalkBuilder,
    vertices: &VertexMap<VertexId>,
    sides: &HalfEdgeMap<HalfEdgeId>,
) -> Vec<Vec<HalfEdgeId>> {
    let corners: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
    let n = corners.len();
    if n <= 3 {
        return vec![corners.iter().map(|&h| sides[h]).collect()];
    }
    let points = mesh.face_positions(f);
    let normal = Plane::newell(&points).map_or(DVec3::Z, |plane| plane.normal());
    let frame =
        Frame::on_plane(&Plane::new(normal, points[0]).expect("a unit normal and a finite point"));
    let flat: Vec<_> = points.iter().map(|&p| frame.flatten(p)).collect();
    let mut diagonals: BTreeMap<(usize, usize), HalfEdgeId> = BTreeMap::new();
    let mut side = |a: usize, b: usize| {
        if (a + 1) % n == b {
            return sides[corners[a]];
        }
        let [u, v] = [a, b].map(|i| vertices[mesh.origin(corners[i])]);
        // The second triangle at a diagonal runs along it the other way.
        match diagonals.get(&(b, a)) {
            Some(first) => first.twin(),
            None => *diagonals.entry((a, b)).or_insert_with(|| fine.edge(u, v)),
        }
    };
    let mut walks: Vec<Vec<HalfEdgeId>> = Vec::with_capacity(n - 2);
    for [a, b, c] in triangulate(&flat) {
        walks.push(vec![side(a, b), side(b, c), side(c, a)]);
    }
    walks
}
