//! Where the second skin lies.

use glam::DVec3;

use super::super::OpError;
use super::super::size::ask;
use crate::geom::{Plane, meet_planes_near};
use crate::mesh::{FaceMap, Mesh, VertexMap};
use crate::progress::Progress;

/// Least squares with planes that hardly differ can run far along the direction of which they say
/// nothing. With more than three planes that do not meet, a vertex moves at most so many times as
/// far as the mean of its normals would have it.
const FARTHEST: f64 = 2.0;

/// The second skin: for each vertex of the first, its place.
pub(super) struct Skin {
    pub positions: VertexMap<DVec3>,
    /// The largest distance of each vertex from one of its moved planes.
    pub residuals: VertexMap<f64>,
    /// The moved planes, as seen from the first skin.
    pub planes: FaceMap<Option<Plane>>,
}

pub(super) fn offset(
    mesh: &Mesh,
    thickness: &FaceMap<f64>,
    progress: &dyn Progress,
) -> Result<Skin, OpError> {
    let mut planes = FaceMap::filled(mesh.face_slots(), None);
    for f in mesh.faces() {
        let plane = mesh.plane(f).ok_or(OpError::NoArea(f))?;
        planes[f] = Some(plane.moved(-thickness[f]));
    }
    let mut skin = Skin {
        positions: VertexMap::filled(mesh.vertex_slots(), DVec3::ZERO),
        residuals: VertexMap::filled(mesh.vertex_slots(), 0.0),
        planes,
    };
    for (turn, v) in mesh.vertices().enumerate() {
        ask(progress, turn)?;
        let at = mesh.position(v);
        let mut around: Vec<Plane> = mesh.vertex_faces(v).filter_map(|f| skin.planes[f]).collect();
        around.dedup();
        (skin.positions[v], skin.residuals[v]) = meeting(&around, at);
    }
    Ok(skin)
}

/// Where moved planes meet that met in `at` before.
fn meeting(planes: &[Plane], at: DVec3) -> (DVec3, f64) {
    let (point, residual) = meet_planes_near(planes, at);
    let residual_at =
        |x: DVec3| planes.iter().map(|p| p.signed_distance(x).abs()).fold(0.0, f64::max);
    let normal = planes.iter().map(Plane::normal).sum::<DVec3>().normalize_or_zero();
    let far = residual_at(at);
    if planes.len() <= 3 || residual <= 1e-9 * far || normal == DVec3::ZERO {
        return (point, residual);
    }
    let (shares, ways) = planes.iter().fold((0.0, 0.0), |(shares, ways), p| {
        let share = p.normal().dot(normal);
        (shares + share * share, ways - share * p.signed_distance(at))
    });
    let plain = normal * (ways / shares);
    if point.distance(at) <= FARTHEST * plain.length() {
        (point, residual)
    } else {
        (at + plain, residual_at(at + plain))
    }
}
