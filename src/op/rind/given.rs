//! Punching a mesh that is a shell already: partners are found by geometry, since no table of them
//! was kept.
//!
//! The partner of a face looks the other way, lies behind it by no more than twice the thickness,
//! has as many sides, and of all such faces its corners are nearest to those of the face. The two
//! are joined by a pipe; peeling then deletes the two edges of every wall without thickness, and
//! one edge of every 2-gon that this leaves (Srinivasan 2004, V.2.3).

use glam::DVec3;

use super::super::OpError;
use super::{Opening, RindReport};
use crate::measure::face_centroid;
use crate::mesh::{EdgeMap, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh};
use crate::select::NewElements;

/// Two faces look at each other's back when the cosine between their normals is below this.
const LOOKS_BACK: f64 = -0.5;

/// A face with its partner: corners that belong together, in the order of the face.
struct Pair {
    corners: Vec<[HalfEdgeId; 2]>,
}

/// Opens faces of a shell. `thickness` is what it has, or more.
pub(super) fn open(
    mesh: &Mesh,
    openings: &FaceMap<Opening>,
    thickness: f64,
) -> Result<(Mesh, RindReport), OpError> {
    let pairs = pairs(mesh, openings, thickness)?;
    let mut made_mesh = mesh.clone();
    let mut was_there = EdgeMap::filled(mesh.edge_slots(), false);
    mesh.edges().for_each(|e| was_there[e] = true);
    let carried: Vec<_> =
        mesh.faces().filter_map(|f| mesh.carried_plane(f).map(|plane| (f, plane))).collect();
    made_mesh.clear_planes();
    for pair in &pairs {
        let [from, to] = pair.corners[0];
        made_mesh.create_pipe(from, to).expect("a face is not its own partner");
    }
    let walls_removed = remove_walls(&mut made_mesh, mesh, openings, &pairs);
    remove_slivers(&mut made_mesh, |e| e.index() >= mesh.edge_slots() || !was_there[e]);
    let mut is_old = FaceMap::filled(mesh.face_slots(), false);
    mesh.faces().for_each(|f| is_old[f] = true);
    for pair in &pairs {
        pair.corners[0].iter().for_each(|&h| is_old[mesh.face(h)] = false);
    }
    let stays = |f: FaceId| f.index() < mesh.face_slots() && is_old[f];
    for (f, plane) in carried {
        if stays(f) && made_mesh.has_face(f) {
            made_mesh.set_plane(f, plane);
        }
    }
    let made = NewElements {
        faces: made_mesh.faces().filter(|&f| !stays(f)).collect(),
        ..NewElements::default()
    };
    let components = made_mesh.component_count();
    let euler = made_mesh.vertex_count() as i64 - made_mesh.edge_count() as i64
        + (made_mesh.face_count() + made_mesh.hole_count()) as i64;
    let genus = usize::try_from(components as i64 - euler / 2).unwrap_or_default();
    let report = RindReport {
        made,
        openings: pairs.len(),
        walls_removed,
        components,
        genus,
        ..RindReport::default()
    };
    Ok((made_mesh, report))
}

fn pairs(mesh: &Mesh, openings: &FaceMap<Opening>, thickness: f64) -> Result<Vec<Pair>, OpError> {
    let mut is_taken = FaceMap::filled(mesh.face_slots(), false);
    let mut pairs = Vec::new();
    for f in mesh.faces().filter(|&f| openings[f] != Opening::None) {
        // A face that is the partner of another chosen one is opened with it.
        if is_taken[f] {
            continue;
        }
        let (partner, corners) = partner(mesh, f, thickness)?;
        if is_taken[partner] {
            return Err(no_partner(f));
        }
        (is_taken[f], is_taken[partner]) = (true, true);
        pairs.push(Pair { corners });
    }
    Ok(pairs)
}

fn no_partner(f: FaceId) -> OpError {
    OpError::NoSuchElement {
        what: "partner, with as many sides and behind it by at most twice the thickness, of face",
        id: f.index(),
    }
}

fn partner(
    mesh: &Mesh,
    f: FaceId,
    thickness: f64,
) -> Result<(FaceId, Vec<[HalfEdgeId; 2]>), OpError> {
    let normal = |f: FaceId| mesh.plane(f).ok_or(OpError::NoArea(f)).map(|plane| plane.normal());
    let own = normal(f)?;
    let centroid = face_centroid(mesh, f);
    let around: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
    let place = |h: &HalfEdgeId| mesh.position(mesh.origin(*h));
    let points: Vec<DVec3> = around.iter().map(place).collect();
    let mut best: Option<(f64, FaceId, Vec<[HalfEdgeId; 2]>)> = None;
    for g in mesh.faces().filter(|&g| g != f && mesh.sides(g) == around.len()) {
        let way = face_centroid(mesh, g) - centroid;
        if way.length() > 2.0 * thickness || way.dot(own) > 0.0 || normal(g)?.dot(own) > LOOKS_BACK
        {
            continue;
        }
        let mut back: Vec<HalfEdgeId> = mesh.face_half_edges(g).collect();
        back.reverse();
        for _ in 0..back.len() {
            let miss =
                back.iter().zip(&points).map(|(h, p)| place(h).distance(*p)).fold(0.0, f64::max);
            if best.as_ref().is_none_or(|b| miss < b.0) {
                best = Some((
                    miss,
                    g,
                    around.iter().copied().zip(back.iter().copied()).map(<[_; 2]>::from).collect(),
                ));
            }
            back.rotate_left(1);
        }
    }
    best.map(|(_, g, corners)| (g, corners)).ok_or_else(|| no_partner(f))
}

/// Deletes both edges of each wall between openings of which one is peeled. Returns how many walls
/// went.
fn remove_walls(
    made: &mut Mesh,
    mesh: &Mesh,
    openings: &FaceMap<Opening>,
    pairs: &[Pair],
) -> usize {
    // For each side of an opened face the side of its partner that lies below: between the
    // partner's corners, seen the other way.
    let mut below = HalfEdgeMap::filled(mesh.half_edge_slots(), None);
    let mut is_peeled = HalfEdgeMap::filled(mesh.half_edge_slots(), false);
    for pair in pairs {
        let n = pair.corners.len();
        let peeled = pair.corners[0].iter().any(|&h| openings[mesh.face(h)] == Opening::Peeled);
        for i in 0..n {
            let [outer, inner] = [pair.corners[i][0], pair.corners[(i + 1) % n][1]];
            below[outer] = Some(inner);
            below[inner] = Some(outer);
            (is_peeled[outer], is_peeled[inner]) = (peeled, peeled);
        }
    }
    let mut removed = 0;
    for e in mesh.edges() {
        let [h, t] = e.half_edges();
        let (Some(a), Some(b)) = (below[h], below[t]) else { continue };
        // Each wall is met twice, from either of its edges.
        if a.twin() == b && (is_peeled[h] || is_peeled[t]) && e < a.edge() {
            made.delete_edge(e);
            made.delete_edge(a.edge());
            removed += 1;
        }
    }
    removed
}

/// Deletes one edge of each 2-gon between new edges, and what is left of vertices in the midst of
/// peeled faces.
fn remove_slivers(made: &mut Mesh, is_new: impl Fn(crate::mesh::EdgeId) -> bool) {
    loop {
        let slivers: Vec<FaceId> = made.faces().filter(|&f| made.sides(f) == 2).collect();
        let mut is_done = true;
        for f in slivers {
            if !made.has_face(f) || made.sides(f) != 2 {
                continue;
            }
            let Some(e) = made.face_half_edges(f).map(HalfEdgeId::edge).find(|&e| is_new(e)) else {
                continue;
            };
            if made.face_half_edges(f).all(|h| is_new(h.edge())) {
                made.delete_edge_with_cleanup(e);
                is_done = false;
            }
        }
        if is_done {
            return;
        }
    }
}
