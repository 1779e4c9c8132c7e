//! Angles and offsets at a vertex.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::geom::{Plane, meet_planes_near};
use crate::mesh::{HalfEdgeId, Mesh, VertexId};

/// The interior angle of a face at the corner where `h` leaves its origin, in radians in [0, 2π);
/// above π at a reflex corner. `None` at an edge of length zero or a face without area.
pub fn corner_angle(mesh: &Mesh, h: HalfEdgeId) -> Option<f64> {
    let at = mesh.position(mesh.origin(h));
    let along = (mesh.position(mesh.target(h)) - at).try_normalize()?;
    let back = (mesh.position(mesh.origin(mesh.prev(h))) - at).try_normalize()?;
    let across = along.cross(back);
    if mesh.next(mesh.next(mesh.next(h))) == h {
        return Some(across.length().atan2(along.dot(back)));
    }
    let angle = mesh.plane(mesh.face(h))?.normal().dot(across).atan2(along.dot(back));
    Some(if angle < 0.0 { angle + TAU } else { angle })
}

/// 2π minus the face angles around a vertex, in radians: the curvature that sits in it. Zero where
/// the surface is flat, positive at a peak, negative at a saddle; the sum over a closed mesh is 2π
/// times its Euler number. At a rim the angle that is open counts too. `None` where a corner has no
/// angle.
pub fn angle_deficit(mesh: &Mesh, v: VertexId) -> Option<f64> {
    let corners = mesh.outgoing(v).filter(|&h| !mesh.is_hole(mesh.face(h)));
    let angles: Option<f64> = corners.map(|h| corner_angle(mesh, h)).sum();
    angles.map(|sum| TAU - sum)
}

/// The conical residual of a vertex, in mm per mm of offset (`operators.md` 11): the planes of its
/// faces are moved out by 1 mm from the vertex; how far the point that serves them best (least
/// squares) still is from one of them.
///
/// Zero up to rounding at valence 3 and wherever plates of constant thickness meet exactly; only
/// the normals matter, so a face that is not planar does not count here. `None` when a face at the
/// vertex has no area, or there is no face.
pub fn conical_residual(mesh: &Mesh, v: VertexId) -> Option<f64> {
    let normals: Option<Vec<DVec3>> =
        mesh.vertex_faces(v).map(|f| mesh.plane(f).map(|p| p.normal())).collect();
    conical_residual_of(&normals?)
}

/// The same for given unit normals.
pub fn conical_residual_of(normals: &[DVec3]) -> Option<f64> {
    let moved = normals.iter().map(|&n| Plane::new(n, n));
    let planes: Vec<Plane> = moved.collect::<Option<_>>()?;
    (!planes.is_empty()).then(|| meet_planes_near(&planes, DVec3::ZERO).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::euler_number;
    use crate::measure::fixtures::{cube, ell_prism, octahedron, open_box, torus};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn deficits_sum_to_the_euler_number() {
        for mesh in [cube(), ell_prism(), octahedron(), torus(5, 4)] {
            let total: f64 =
                mesh.vertices().map(|v| angle_deficit(&mesh, v).expect("angles")).sum();
            assert!((total - TAU * euler_number(&mesh) as f64).abs() < 1e-12, "{total}");
        }
        let reflex = ell_prism();
        assert!(
            reflex
                .vertices()
                .any(|v| angle_deficit(&reflex, v).is_some_and(|d| (d + FRAC_PI_2).abs() < 1e-12))
        );
    }

    #[test]
    fn three_planes_always_meet_and_four_do_when_the_vertex_is_conical() {
        for mesh in [cube(), ell_prism(), octahedron(), open_box()] {
            for v in mesh.vertices() {
                let residual = conical_residual(&mesh, v).expect("faces");
                assert!(residual < 1e-14, "{v}: {residual}");
            }
        }
    }

    #[test]
    fn a_lopsided_peak_is_not_conical() {
        let base =
            [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4], vec![3, 2, 1, 0]];
        let mesh = Mesh::from_faces(base.map(DVec3::from_array), faces).expect("a pyramid");
        let residual = |i: usize| conical_residual(&mesh, VertexId::new(i)).expect("faces");
        assert!(residual(4) > 0.01, "{}", residual(4));
        assert!(residual(0) < 1e-14);
    }

    #[test]
    fn flat_vertices_are_conical() {
        let points = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.4, 0.6, 0.]]
            .map(DVec3::from_array);
        let mesh = Mesh::from_faces(points, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
            .expect("a square");
        let middle = VertexId::new(4);
        assert!(conical_residual(&mesh, middle).expect("faces") < 1e-15);
        assert!(angle_deficit(&mesh, middle).expect("angles").abs() < 1e-14);
    }
}
