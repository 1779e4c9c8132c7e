//! Schemes whose vertices stand for corners, edges or faces: Doo–Sabin, honeycomb, truncation,
//! simplest, dual.
//!
//! Around a vertex the outgoing half-edges follow each other counter-clockwise by `prev(h).twin()`,
//! clockwise by `next(h.twin())`.

use glam::DVec3;

use super::averaging::{Cosines, centre, midpoint, ring_means};
use super::{OpError, ask, carry_groups};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, WalkBuilder};
use crate::progress::Progress;

/// Marks half-edges that were not made; walks never reach one.
fn none() -> HalfEdgeId {
    HalfEdgeId(u32::MAX)
}

/// Half-edges of solid faces, face after face in order.
fn solid_sides(mesh: &Mesh) -> impl Iterator<Item = HalfEdgeId> + '_ {
    mesh.faces().flat_map(|f| mesh.face_half_edges(f))
}

fn has_material(mesh: &Mesh, h: HalfEdgeId) -> bool {
    !mesh.is_hole(mesh.face(h))
}

/// Outgoing half-edges of a vertex, counter-clockwise.
fn counter_clockwise(mesh: &Mesh, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
    let start = mesh.vertex_start(v);
    std::iter::successors(start, move |&h| {
        Some(mesh.prev(h).twin()).filter(|&next| Some(next) != start)
    })
}

fn is_inner(mesh: &Mesh, v: VertexId) -> bool {
    mesh.vertex_start(v).is_some() && !mesh.is_rim_vertex(v)
}

/// Whether the face of one of the edge's ends will hold what crosses the edge; between two rim
/// vertices it would hang in the air.
fn joins_faces(mesh: &Mesh, e: EdgeId) -> bool {
    !mesh.is_rim(e) && mesh.edge_vertices(e).into_iter().any(|v| is_inner(mesh, v))
}

/// Doo–Sabin. On an open mesh the new surface ends at the first and last corners inside the rim, as
/// a rim without a rule of its own does.
pub(super) fn doo_sabin(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(2 * e, 4 * e, v + e + f);
    let corners = corner_points(
        mesh,
        &mut fine,
        |n| (0.25 + 1.25 / n, 0.25 / n),
        |mesh, h| mesh.position(mesh.origin(h)),
        progress,
    )?;
    let mut along = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    let mut across = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for (i, h) in solid_sides(mesh).enumerate() {
        ask(progress, i)?;
        along[h] = fine.edge(corners[h], corners[mesh.next(h)]);
        if has_material(mesh, h.twin()) {
            across[h] = fine.edge(corners[h], corners[mesh.next(h.twin())]);
        }
    }
    let pairs: Vec<(FaceId, FaceId)> =
        mesh.faces().map(|f| (f, fine.face(mesh.face_half_edges(f).map(|h| along[h])))).collect();
    for e in mesh.edges().filter(|&e| !mesh.is_rim(e)) {
        let [h, t] = e.half_edges();
        fine.face([along[h].twin(), across[h], along[t].twin(), across[t]]);
    }
    for (i, v) in mesh.vertices().filter(|&v| is_inner(mesh, v)).enumerate() {
        ask(progress, i)?;
        fine.face(counter_clockwise(mesh, v).map(|h| across[h].twin()));
    }
    // Building takes the most memory, and needs none of these.
    drop((corners, along, across));
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// Honeycomb. On an open mesh sides on the rim have points, too, and the rim runs along them.
pub(super) fn honeycomb(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let middle = |mesh: &Mesh, h: HalfEdgeId| midpoint(mesh, h.edge());
    let diagonal = |n: f64| std::f64::consts::FRAC_1_SQRT_2 - 0.25 + 1.25 / n;
    let weights = |n| (diagonal(n), (1.0 - diagonal(n)) / (3.0 * n - 5.0));
    three_valent(mesh, |fine| corner_points(mesh, fine, weights, middle, progress), progress)
}

/// Vertex truncation without planes: a corner at a share of the way along each half-edge. Rim
/// vertices are cut off like all others.
pub(super) fn truncation(
    mesh: &Mesh,
    share: f64,
    progress: &dyn Progress,
) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(2 * e, 3 * e, v + f);
    let mut points = HalfEdgeMap::filled(mesh.half_edge_slots(), VertexId::new(0));
    for h in mesh.half_edges() {
        points[h] =
            fine.vertex(mesh.position(mesh.origin(h)).lerp(mesh.position(mesh.target(h)), share));
    }
    let mut middle = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for e in mesh.edges() {
        let [h, t] = e.half_edges();
        middle[h] = fine.edge(points[h], points[t]);
        middle[t] = middle[h].twin();
    }
    let mut cut = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for (i, h) in solid_sides(mesh).enumerate() {
        ask(progress, i)?;
        cut[h] = fine.edge(points[mesh.prev(h).twin()], points[h]);
    }
    let pairs: Vec<(FaceId, FaceId)> = mesh
        .faces()
        .map(|f| (f, fine.face(mesh.face_half_edges(f).flat_map(|h| [cut[h], middle[h]]))))
        .collect();
    for (i, v) in mesh.vertices().filter(|&v| is_inner(mesh, v)).enumerate() {
        ask(progress, i)?;
        fine.face(counter_clockwise(mesh, v).map(|h| cut[h].twin()));
    }
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// The common links of honeycomb: a point for each side, joined along each face and across each
/// edge.
fn three_valent(
    mesh: &Mesh,
    place: impl FnOnce(&mut WalkBuilder) -> Result<HalfEdgeMap<VertexId>, OpError>,
    progress: &dyn Progress,
) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(2 * e, 3 * e, v + f);
    let points = place(&mut fine)?;
    let mut along = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    let mut across = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for (i, h) in solid_sides(mesh).enumerate() {
        ask(progress, i)?;
        along[h] = fine.edge(points[h], points[mesh.next(h)]);
    }
    for e in mesh.edges().filter(|&e| joins_faces(mesh, e)) {
        let [h, t] = e.half_edges();
        across[h] = fine.edge(points[h], points[t]);
        across[t] = across[h].twin();
    }
    let pairs: Vec<(FaceId, FaceId)> =
        mesh.faces().map(|f| (f, fine.face(mesh.face_half_edges(f).map(|h| along[h])))).collect();
    for (i, v) in mesh.vertices().filter(|&v| is_inner(mesh, v)).enumerate() {
        ask(progress, i)?;
        // From the side that leaves to the side that arrives in the same face, then across to the
        // next one that leaves.
        fine.face(
            counter_clockwise(mesh, v)
                .flat_map(|h| [along[mesh.prev(h)].twin(), across[mesh.prev(h)]]),
        );
    }
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// Simplest: midpoints of edges. On an open mesh the rim runs along the midpoints.
pub(super) fn simplest(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e, f) = (mesh.vertex_count(), mesh.edge_count(), mesh.face_count());
    let mut fine = WalkBuilder::with_capacity(e, 2 * e, v + f);
    let mut middles = HalfEdgeMap::filled(mesh.half_edge_slots(), VertexId::new(0));
    for e in mesh.edges() {
        let middle = fine.vertex(midpoint(mesh, e));
        e.half_edges().into_iter().for_each(|h| middles[h] = middle);
    }
    let mut turn = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for (i, h) in solid_sides(mesh).enumerate() {
        ask(progress, i)?;
        turn[h] = fine.edge(middles[mesh.prev(h)], middles[h]);
    }
    let pairs: Vec<(FaceId, FaceId)> =
        mesh.faces().map(|f| (f, fine.face(mesh.face_half_edges(f).map(|h| turn[h])))).collect();
    for (i, v) in mesh.vertices().filter(|&v| is_inner(mesh, v)).enumerate() {
        ask(progress, i)?;
        fine.face(counter_clockwise(mesh, v).map(|h| turn[h].twin()));
    }
    let mut fine = fine.build();
    carry_groups(mesh, &mut fine, pairs.into_iter());
    Ok(fine)
}

/// Dual: a vertex at the mean of each face's corners. On an open mesh rim vertices have no face.
pub(super) fn dual(mesh: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let mut fine =
        WalkBuilder::with_capacity(mesh.face_count(), mesh.edge_count(), mesh.vertex_count());
    let mut centres = vec![VertexId::new(0); mesh.face_slots()];
    mesh.faces().for_each(|f| centres[f.index()] = fine.vertex(centre(mesh, f)));
    let mut crossing = HalfEdgeMap::filled(mesh.half_edge_slots(), none());
    for e in mesh.edges() {
        let [h, t] = e.half_edges();
        if joins_faces(mesh, e) {
            crossing[h] = fine.edge(centres[mesh.face(t).index()], centres[mesh.face(h).index()]);
            crossing[t] = crossing[h].twin();
        }
    }
    for (i, v) in mesh.vertices().filter(|&v| is_inner(mesh, v)).enumerate() {
        ask(progress, i)?;
        // Crossing h counter-clockwise around its origin leads from the face on its right to the
        // one on its left.
        fine.face(counter_clockwise(mesh, v).map(|h| crossing[h]));
    }
    Ok(fine.build())
}

/// One point for each half-edge of each face: the weighted mean of `point` around the face, `own`
/// for the half-edge itself and `unit · (3 + 2 cos(2πk/n))` for the one k places on, where
/// `weights(n)` gives (own, unit).
fn corner_points(
    mesh: &Mesh,
    fine: &mut WalkBuilder,
    weights: impl Fn(f64) -> (f64, f64),
    point: impl Fn(&Mesh, HalfEdgeId) -> DVec3,
    progress: &dyn Progress,
) -> Result<HalfEdgeMap<VertexId>, OpError> {
    let mut corners = HalfEdgeMap::filled(mesh.half_edge_slots(), VertexId::new(0));
    let (mut cosines, mut points, mut means) = (Cosines::default(), Vec::new(), Vec::new());
    for (i, f) in mesh.faces().enumerate() {
        ask(progress, i)?;
        points.clear();
        means.clear();
        points.extend(mesh.face_half_edges(f).map(|h| point(mesh, h)));
        let (own, unit) = weights(points.len() as f64);
        ring_means(
            &points,
            cosines.of(points.len()),
            own,
            |cos| unit * (3.0 + 2.0 * cos),
            &mut means,
        );
        for (h, &mean) in mesh.face_half_edges(f).zip(&means) {
            corners[h] = fine.vertex(mean);
        }
    }
    Ok(corners)
}
