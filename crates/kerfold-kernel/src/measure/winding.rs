//! How often a surface goes around a point.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::mesh::{FaceId, Mesh};

/// How often closed surfaces made of these faces go around a point: 1 inside a solid whose faces
/// look outwards, 0 outside and in a cavity, −1 inside a body that is turned inside out. Summed
/// from solid angles (Van Oosterom and Strackee 1983), so it is near a whole number unless the
/// point lies on the surface or the surface is open.
pub fn winding_number(mesh: &Mesh, faces: impl IntoIterator<Item = FaceId>, p: DVec3) -> f64 {
    let mut sum = 0.0;
    let mut corners: Vec<DVec3> = Vec::new();
    for f in faces {
        corners.clear();
        corners.extend(mesh.face_vertices(f).map(|v| mesh.position(v) - p));
        for pair in corners.windows(2).skip(1) {
            sum += half_solid_angle(corners[0], pair[0], pair[1]);
        }
    }
    sum / TAU
}

/// Half the solid angle of a triangle as seen from the origin, with the sign of its orientation.
fn half_solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [x, y, z] = [a, b, c].map(DVec3::length);
    let volume = a.dot(b.cross(c));
    let denominator = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    volume.atan2(denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_goes_around_its_inside_once() {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let cube = Mesh::from_faces((0..8).map(corner), faces).expect("a cube");
        let around = |p: DVec3| winding_number(&cube, cube.faces(), p);
        assert!((around(DVec3::new(0.2, 0.7, 0.4)) - 1.0).abs() < 1e-12);
        assert!(around(DVec3::new(2.0, 0.7, 0.4)).abs() < 1e-12);
        assert!(around(DVec3::new(0.5, 0.5, -3.0)).abs() < 1e-12);
    }
}
