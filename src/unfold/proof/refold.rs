//! Do the pieces fold back up into the mesh?
//!
//! One face of each piece is placed on the mesh; every other face follows from its neighbour by
//! turning about their fold through the fold angle. Only pieces, folds and angles are used; then
//! every corner is compared with its vertex.

use std::collections::{HashMap, VecDeque};

use glam::{DQuat, DVec2, DVec3};

use super::{ProofError, REFOLD, exceeds};
use crate::geom::{Plane, fit_plane};
use crate::mesh::{FaceId, Mesh};
use crate::net::{FlatFace, Fold, Net, Piece};

/// The largest distance between a refolded corner and its vertex.
pub(super) fn check(mesh: &Mesh, net: &Net, size: f64) -> Result<f64, ProofError> {
    let mut folds: HashMap<usize, Vec<&Fold>> = HashMap::new();
    for fold in &net.folds {
        fold.faces.iter().for_each(|&f| folds.entry(f).or_default().push(fold));
    }
    let mut worst: f64 = 0.0;
    for piece in &net.pieces {
        worst = worst.max(refold(mesh, piece, &folds, size)?);
    }
    Ok(worst)
}

/// How the flat frame of a piece lies in space while one of its faces is in place.
#[derive(Clone, Copy)]
struct Pose {
    turn: DQuat,
    /// A point of the flat frame and where it lies in space: rotations are about this point, so no
    /// digits are lost.
    flat: DVec2,
    space: DVec3,
}

impl Pose {
    fn place(&self, p: DVec2) -> DVec3 {
        self.space + self.turn * (p - self.flat).extend(0.0)
    }
}

fn refold(
    mesh: &Mesh,
    piece: &Piece,
    folds: &HashMap<usize, Vec<&Fold>>,
    size: f64,
) -> Result<f64, ProofError> {
    let faces: HashMap<usize, &FlatFace> =
        piece.faces.iter().map(|flat| (flat.face, flat)).collect();
    let Some(root) = piece.faces.first() else { return Ok(0.0) };
    let mut queue = VecDeque::from([(root, on_mesh(mesh, root), 0)]);
    let mut seen: HashMap<usize, ()> = HashMap::from([(root.face, ())]);
    let (mut worst, mut slope) = (0.0, 0.0);
    while let Some((flat, pose, depth)) = queue.pop_front() {
        slope = f64::max(slope, unevenness(mesh, FaceId::new(flat.face)));
        // Every fold may be off by the slope that flattening has taken out of its faces.
        let limit = size * (REFOLD + 4.0 * slope * f64::from(depth + 1));
        worst = f64::max(worst, check_face(mesh, flat, &pose, limit)?);
        for fold in folds.get(&flat.face).into_iter().flatten() {
            let other = if fold.faces[0] == flat.face { fold.faces[1] } else { fold.faces[0] };
            if let Some(&next) = faces.get(&other)
                && seen.insert(other, ()).is_none()
            {
                queue.push_back((next, turned(&pose, flat, fold), depth + 1));
            }
        }
    }
    match piece.faces.iter().find(|flat| !seen.contains_key(&flat.face)) {
        Some(loose) => Err(ProofError::Loose { piece: piece.id.0 + 1, face: loose.face }),
        None => Ok(worst),
    }
}

/// How far a face is from planar: its corners' distance from their plane, relative to its extent.
/// Zero for triangles.
pub(super) fn unevenness(mesh: &Mesh, f: FaceId) -> f64 {
    let points = mesh.face_positions(f);
    let Some(plane) = Some(&points).filter(|p| p.len() > 3).and_then(|p| fit_plane(p)) else {
        return 0.0;
    };
    let (off, extent) = points.iter().fold((0.0_f64, 0.0_f64), |(off, extent), &p| {
        (off.max(plane.signed_distance(p).abs()), extent.max(p.distance(points[0])))
    });
    off / extent
}

/// The pose that lays a face onto the mesh: its first corner, then its plane, then the direction of
/// its longest side.
fn on_mesh(mesh: &Mesh, flat: &FlatFace) -> Pose {
    let points = mesh.face_positions(FaceId::new(flat.face));
    let n = points.len();
    let length = |i: usize| flat.polygon[i].distance_squared(flat.polygon[(i + 1) % n]);
    let longest =
        (0..n).max_by(|&a, &b| length(a).total_cmp(&length(b))).expect("a face has corners");
    let next = (longest + 1) % n;
    let normal = Plane::newell(&points).map_or(DVec3::Z, |plane| plane.normal());
    let along = points[next] - points[longest];
    let x = (along - normal * along.dot(normal)).normalize_or(DVec3::X);
    let frame = glam::DMat3::from_cols(x, normal.cross(x), normal);
    let angle = (flat.polygon[next] - flat.polygon[longest]).to_angle();
    let turn = (DQuat::from_mat3(&frame) * DQuat::from_rotation_z(-angle)).normalize();
    Pose { turn, flat: flat.polygon[longest], space: points[longest] }
}

/// The pose of the face beyond a fold. A mountain bends away from the viewer: a turn about the
/// fold, with the face that is in place on its left.
fn turned(pose: &Pose, flat: &FlatFace, fold: &Fold) -> Pose {
    let n = flat.vertices.len();
    let forward = (0..n).any(|i| [flat.vertices[i], flat.vertices[(i + 1) % n]] == fold.edge);
    let [a, b] = if forward { fold.segment } else { [fold.segment[1], fold.segment[0]] };
    let axis = (b - a).normalize_or(DVec2::X).extend(0.0);
    let turn = (pose.turn * DQuat::from_axis_angle(axis, fold.fold_angle.to_radians())).normalize();
    Pose { turn, flat: a, space: pose.place(a) }
}

fn check_face(mesh: &Mesh, flat: &FlatFace, pose: &Pose, limit: f64) -> Result<f64, ProofError> {
    let mut worst = 0.0;
    let points = mesh.face_positions(FaceId::new(flat.face));
    for ((&p, &point), &vertex) in flat.polygon.iter().zip(&points).zip(&flat.vertices) {
        let by = pose.place(p).distance(point);
        if exceeds(by, limit) {
            return Err(ProofError::Refold { face: flat.face, vertex, by, limit });
        }
        worst = f64::max(worst, by);
    }
    Ok(worst)
}
