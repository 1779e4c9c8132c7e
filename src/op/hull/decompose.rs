//! Approximate convex decomposition: a closed model cut at its sharpest concave edges.
//!
//! The most concave piece is cut first. Its plane passes through one of its sharpest concave edges:
//! that of one of the faces there, or the one that halves the angle (Chazelle 1984, "Convex
//! partitions of polyhedra", cuts through all such edges; here few parts are wanted, so that of a
//! few planes the one is taken that leaves the hulls of the pieces smallest). Then pieces are
//! joined again until few enough are left (`merge.rs`).
//!
//! The work is bounded: [`most_cuts`] cuts, and trial cuts of [`MOST_FACES`] faces in all. The
//! pieces cover the model exactly wherever it ends, so together the parts always hold all vertices.

use std::collections::HashSet;

use glam::DVec3;

use super::super::cut::{Cutter, Reach, SlicingPlane};
use super::super::size::check_size;
use super::super::{Capping, OpError};
use super::bundle::{Bundle, PartPoint};
use super::merge::merged;
use crate::geom::Plane;
use crate::measure::{concave_edges, fold_angle, volume};
use crate::mesh::{Component, EdgeId, FaceId, Mesh, MeshBuilder, VertexId};
use crate::progress::Progress;

/// So many of the sharpest concave edges of a piece are tried.
const EDGES_TRIED: usize = 3;
/// So many faces may all trial cuts go through together.
const MOST_FACES: usize = 20_000_000;
/// A cut that loses or gains more than this share of a piece is not used.
const VOLUME_KEPT: f64 = 1e-6;
/// A cut that takes less than this share off the hulls of a piece is not used.
const LEAST_GAIN: f64 = 1e-6;

/// How many cuts there may be for so many parts.
fn most_cuts(parts: usize) -> usize {
    4 * parts + 16
}

/// Pieces beyond the number of parts that are made before some are joined again.
fn spare_pieces(parts: usize) -> usize {
    parts.min(64) + 8
}

/// Divides a closed mesh into at most `most` nearly convex parts, each given by points of which it
/// is the hull. Fewer than two parts stand for the whole.
///
/// `concavity` is the share of the model's volume by which the hull of a piece may exceed it.
///
/// # Errors
/// [`OpError::NotClosed`], [`OpError::Cancelled`].
pub(super) fn convex_parts(
    mesh: &Mesh,
    most: usize,
    concavity: f64,
    progress: &dyn Progress,
) -> Result<Vec<Vec<PartPoint>>, OpError> {
    if most < 2 {
        return Ok(Vec::new());
    }
    if !mesh.is_closed() {
        let holes = mesh.hole_count();
        return Err(OpError::NotClosed { what: "a division into convex parts", holes });
    }
    check_parts(mesh, most)?;
    let pieces = pieces(mesh, most, concavity, progress)?;
    let mut held: HashSet<[u64; 3]> = HashSet::new();
    let mut bundles = Vec::new();
    for piece in &pieces {
        let points = part_points(&piece.mesh, piece.mesh.vertices());
        held.extend(points.iter().map(|p| key(p.position)));
        bundles.push(Bundle::of(points));
    }
    // What no piece holds, such as a vertex without a face, goes to the nearest.
    let left = mesh.vertices().filter(|&v| !held.contains(&key(mesh.position(v))));
    let bundles = merged(bundles, part_points(mesh, left), most, progress)?;
    Ok(bundles.into_iter().map(Bundle::into_points).collect())
}

fn part_points(mesh: &Mesh, vertices: impl Iterator<Item = VertexId>) -> Vec<PartPoint> {
    let point = |v| PartPoint { position: mesh.position(v), is_given: mesh.is_given(v) };
    vertices.map(point).collect()
}

/// Refuses pieces that memory would not hold. A cut adds an edge for each edge that it divides, and
/// two for each face; on an even mesh it divides about 4√E of them.
fn check_parts(mesh: &Mesh, most: usize) -> Result<(), OpError> {
    let edges = mesh.edge_count() as f64;
    let of_cuts = 12.0 * edges.sqrt();
    let asked = u32::try_from(most).unwrap_or(u32::MAX);
    check_size("parts", asked, |parts| edges + of_cuts * most_cuts(parts as usize) as f64)
}

/// A position as a key; adding zero makes −0 and 0 one.
fn key(position: DVec3) -> [u64; 3] {
    position.to_array().map(|x| (x + 0.0).to_bits())
}

/// A closed piece of the model.
struct Piece {
    mesh: Mesh,
    volume: f64,
    hull_volume: f64,
    /// Whether no cut makes its hulls smaller.
    is_done: bool,
}

impl Piece {
    fn of(mesh: Mesh) -> Self {
        let hull_volume = Bundle::of(part_points(&mesh, mesh.vertices())).volume;
        Self { volume: volume(&mesh), hull_volume, is_done: false, mesh }
    }

    /// The volume of the hull that is not the piece's.
    fn excess(&self) -> f64 {
        self.hull_volume - self.volume
    }
}

/// Cuts the mesh until all pieces are convex enough, or as far as the limits allow.
fn pieces(
    mesh: &Mesh,
    most: usize,
    concavity: f64,
    progress: &dyn Progress,
) -> Result<Vec<Piece>, OpError> {
    let mut pieces: Vec<Piece> = solids(mesh).into_iter().map(Piece::of).collect();
    let allowed = concavity * pieces.iter().map(|piece| piece.volume).sum::<f64>();
    let mut faces_left = MOST_FACES;
    for cut in 0..most_cuts(most) {
        progress.report("convex parts: cuts", cut, most_cuts(most));
        let open =
            (0..pieces.len()).filter(|&i| !pieces[i].is_done && pieces[i].excess() > allowed);
        let worst = open.max_by(|&i, &j| pieces[i].excess().total_cmp(&pieces[j].excess()));
        let Some(worst) = worst.filter(|_| pieces.len() < most + spare_pieces(most)) else { break };
        match best_cut(&pieces[worst], &mut faces_left, progress)? {
            Some(divided) => {
                pieces.remove(worst);
                pieces.extend(divided);
            }
            None => pieces[worst].is_done = true,
        }
    }
    Ok(pieces)
}

/// The pieces that the best of a few cuts makes; `None` when none makes the hulls smaller.
fn best_cut(
    piece: &Piece,
    faces_left: &mut usize,
    progress: &dyn Progress,
) -> Result<Option<Vec<Piece>>, OpError> {
    let mut best: Option<(f64, Vec<Piece>)> = None;
    for plane in planes(&piece.mesh) {
        if progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        let faces = piece.mesh.face_count();
        if *faces_left < faces {
            break;
        }
        *faces_left -= faces;
        let Some(divided) = divided(piece, &plane) else { continue };
        let hulls: f64 = divided.iter().map(|part| part.hull_volume).sum();
        if hulls < best.as_ref().map_or(piece.hull_volume * (1.0 - LEAST_GAIN), |best| best.0) {
            best = Some((hulls, divided));
        }
    }
    Ok(best.map(|best| best.1))
}

/// The planes that are tried: through the sharpest concave edges, the sharpest first.
fn planes(mesh: &Mesh) -> Vec<Plane> {
    let mut concave: Vec<(f64, EdgeId)> = concave_edges(mesh)
        .into_iter()
        .filter_map(|e| fold_angle(mesh, e).map(|fold| (fold, e)))
        .collect();
    concave.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    concave.into_iter().take(EDGES_TRIED).flat_map(|(_, e)| planes_through(mesh, e)).collect()
}

/// The planes of the faces of an edge, and the one that halves the angle between them.
fn planes_through(mesh: &Mesh, e: EdgeId) -> Vec<Plane> {
    let [f, g] = mesh.edge_faces(e);
    let (Some(left), Some(right)) = (mesh.plane(f), mesh.plane(g)) else { return Vec::new() };
    let [a, b] = mesh.edge_positions(e);
    let halving = Plane::new(left.normal() - right.normal(), a.midpoint(b));
    [Some(left), Some(right), halving].into_iter().flatten().collect()
}

/// The pieces on both sides of a plane; `None` when it misses, or when the cut is not clean.
fn divided(piece: &Piece, plane: &Plane) -> Option<Vec<Piece>> {
    let mut pieces = Vec::new();
    for side in [*plane, plane.flipped()] {
        let half = half(&piece.mesh, side)?;
        pieces.extend(solids(&half).into_iter().map(Piece::of));
    }
    let kept: f64 = pieces.iter().map(|part| part.volume).sum();
    ((kept - piece.volume).abs() <= VOLUME_KEPT * piece.volume).then_some(pieces)
}

/// What lies behind a plane, closed.
fn half(mesh: &Mesh, plane: Plane) -> Option<Mesh> {
    let mut cutter = Cutter::new(mesh.clone());
    cutter.set_capping(Capping::Always);
    cutter.cut(&SlicingPlane { plane, given: None }, Reach::Global);
    let is_clean = !cutter.last_cut().is_miss && cutter.last_cut().lids == 0;
    let mesh = cutter.into_mesh();
    (is_clean && mesh.face_count() > 0 && mesh.is_closed()).then_some(mesh)
}

/// The solids of a mesh: each component that encloses a volume with the cavities in it.
fn solids(mesh: &Mesh) -> Vec<Mesh> {
    let components = mesh.components();
    let shells: Vec<Shell> =
        components.iter().filter(|c| !c.faces.is_empty()).map(|c| Shell::of(mesh, c)).collect();
    let (outer, cavities): (Vec<Shell>, Vec<Shell>) =
        shells.into_iter().partition(|shell| shell.volume > 0.0);
    let mut faces: Vec<Vec<FaceId>> = outer.iter().map(|shell| shell.faces.clone()).collect();
    for cavity in cavities {
        let around = (0..outer.len()).filter(|&i| outer[i].holds(&cavity));
        let smallest = around.min_by(|&i, &j| outer[i].volume.total_cmp(&outer[j].volume));
        if let Some(i) = smallest {
            faces[i].extend(cavity.faces);
        }
    }
    faces.iter().map(|faces| part_of(mesh, faces)).collect()
}

/// A component of a mesh.
struct Shell {
    faces: Vec<FaceId>,
    /// Below zero for a cavity.
    volume: f64,
    low: DVec3,
    high: DVec3,
}

impl Shell {
    fn of(mesh: &Mesh, component: &Component) -> Self {
        let (low, high) = component
            .vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &v| {
                (low.min(mesh.position(v)), high.max(mesh.position(v)))
            });
        let volume = volume(&part_of(mesh, &component.faces));
        Self { faces: component.faces.clone(), volume, low, high }
    }

    fn holds(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && other.high.cmple(self.high).all()
    }
}

/// Some faces of a mesh that share no edge with others, as a mesh.
fn part_of(mesh: &Mesh, faces: &[FaceId]) -> Mesh {
    if faces.len() == mesh.face_count() {
        return mesh.clone();
    }
    let mut number = vec![usize::MAX; mesh.vertex_slots()];
    let mut vertices: Vec<VertexId> = Vec::new();
    let mut builder = MeshBuilder::new();
    for &f in faces {
        let corners: Vec<usize> = mesh
            .face_vertices(f)
            .map(|v| {
                if number[v.index()] == usize::MAX {
                    number[v.index()] = vertices.len();
                    vertices.push(v);
                    // A cut may leave edges that the builder takes for faults of a file. It sees
                    // stand-ins on a parabola, of which no two are equal and no three on a line.
                    let i = (vertices.len() - 1) as f64;
                    builder.vertex(DVec3::new(i, i * i, 0.0));
                }
                number[v.index()]
            })
            .collect();
        builder.face(corners);
    }
    let Ok((mut part, _)) = builder.build() else { return mesh.clone() };
    for (i, &v) in vertices.iter().enumerate() {
        part.set_position(VertexId::new(i), mesh.position(v), mesh.is_given(v));
    }
    for (i, &f) in faces.iter().enumerate() {
        if let Some(plane) = mesh.carried_plane(f) {
            part.set_plane(FaceId::new(i), plane);
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshBuilder;
    use crate::progress::Silent;

    /// Boxes side by side as one closed mesh each.
    fn boxes(sizes: &[(DVec3, DVec3, bool)]) -> Mesh {
        let mut builder = MeshBuilder::new();
        for &(low, high, is_cavity) in sizes {
            let at = |i: usize| DVec3::from_array([0, 1, 2].map(|k| [low, high][i >> k & 1][k]));
            let first = builder.vertex(at(0));
            (1..8).for_each(|i| {
                builder.vertex(at(i));
            });
            for mut run in
                [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
            {
                if is_cavity {
                    run.reverse();
                }
                builder.face(run.map(|i| first + i));
            }
        }
        builder.build().expect("boxes").0
    }

    #[test]
    fn a_cavity_belongs_to_the_smallest_solid_around_it() {
        let cube =
            |low: f64, high: f64, is_cavity| (DVec3::splat(low), DVec3::splat(high), is_cavity);
        let mesh = boxes(&[
            cube(-9.0, 9.0, false),
            cube(-8.0, 8.0, true),
            cube(-2.0, 2.0, false),
            cube(-1.0, 1.0, true),
        ]);
        let volumes: Vec<f64> = solids(&mesh).iter().map(volume).collect();
        assert_eq!(volumes, [18.0_f64.powi(3) - 16.0_f64.powi(3), 64.0 - 8.0]);
        let parts = convex_parts(&mesh, 12, 0.01, &Silent).expect("parts");
        assert!((2..=12).contains(&parts.len()), "{}", parts.len());
    }

    #[test]
    fn scattered_solids_are_joined_to_as_many_parts_as_are_allowed() {
        let at = |i: usize| DVec3::new((i % 9) as f64, (i / 9 % 9) as f64, (i / 81) as f64) * 3.0;
        let many: Vec<(DVec3, DVec3, bool)> =
            (0..400).map(|i| (at(i), at(i) + 1.0, false)).collect();
        let mesh = boxes(&many);
        for most in [2, 7, 300] {
            let parts = convex_parts(&mesh, most, 0.01, &Silent).expect("parts");
            assert_eq!(parts.len(), most);
            let held: HashSet<[u64; 3]> =
                parts.iter().flatten().map(|point| key(point.position)).collect();
            assert!(most < 300 || held.len() > 2000, "{}", held.len());
        }
    }
}
