//! Smooth shading: normals at the corners of faces, and how they run across a triangle (Phong 1975).

use glam::{DVec2, DVec3};

use crate::geom::Plane;
use crate::mesh::{FaceMap, HalfEdgeId, HalfEdgeMap, Mesh, VertexId};

/// Faces that meet at less than this, in degrees, are one bent surface.
pub(super) const CREASE: f64 = 35.0;

/// Its cosine.
const COSINE: f64 = 0.819_152_044_288_991_8;

/// A normal for every corner of every face, by the half-edge that leaves it.
pub(super) struct Normals(HalfEdgeMap<DVec3>);

impl Normals {
    /// At each corner the mean of the faces around it that bend little against its own, by area.
    pub fn new(mesh: &Mesh, place: impl Fn(VertexId) -> DVec3) -> Self {
        let mut areas = FaceMap::filled(mesh.face_slots(), DVec3::ZERO);
        let mut units = FaceMap::filled(mesh.face_slots(), DVec3::ZERO);
        for f in mesh.faces() {
            let corners: Vec<DVec3> = mesh.face_vertices(f).map(&place).collect();
            let Some(plane) = Plane::newell(&corners) else { continue };
            units[f] = plane.normal();
            let first = corners[0];
            let twice: DVec3 = corners.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum();
            areas[f] = twice;
        }
        let mut normals = HalfEdgeMap::filled(mesh.half_edge_slots(), DVec3::ZERO);
        for f in mesh.faces() {
            for h in mesh.face_half_edges(f) {
                let around = mesh.vertex_faces(mesh.origin(h));
                let near = around.filter(|&g| units[g].dot(units[f]) >= COSINE);
                let sum: DVec3 = near.map(|g| areas[g]).sum();
                normals[h] = sum.normalize_or(units[f]);
            }
        }
        Self(normals)
    }

    /// The normal at the origin of a half-edge, on its face.
    pub fn at(&self, h: HalfEdgeId) -> DVec3 {
        self.0[h]
    }
}

/// A normal that changes evenly across a triangle of the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slope {
    origin: DVec2,
    start: DVec3,
    along: [DVec3; 2],
}

impl Slope {
    /// Places in the picture with the normals there.
    pub fn new([(a, n), (b, m), (c, o)]: [(DVec3, DVec3); 3]) -> Self {
        let (u, v) = ((b - a).truncate(), (c - a).truncate());
        let area = u.perp_dot(v);
        let (dm, dn) = (m - n, o - n);
        let along = if area == 0.0 {
            [DVec3::ZERO; 2]
        } else {
            [(dm * v.y - dn * u.y) / area, (dn * u.x - dm * v.x) / area]
        };
        Self { origin: a.truncate(), start: n, along }
    }

    /// The unit normal at a point of the picture.
    pub fn at(&self, x: f64, y: f64) -> DVec3 {
        let n =
            self.start + self.along[0] * (x - self.origin.x) + self.along[1] * (y - self.origin.y);
        n.normalize_or(DVec3::Z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_has_the_normals_of_its_corners() {
        let corners = [
            (DVec3::new(1.0, 2.0, 0.0), DVec3::X),
            (DVec3::new(9.0, 3.0, 0.0), DVec3::Y),
            (DVec3::new(4.0, 8.0, 0.0), DVec3::Z),
        ];
        let slope = Slope::new(corners);
        for (place, normal) in corners {
            assert!(slope.at(place.x, place.y).distance(normal) < 1e-12);
        }
    }

    #[test]
    fn creases_stay_and_flat_bends_are_smoothed() {
        let cube = crate::shape::cube(10.0);
        let normals = Normals::new(&cube, |v| cube.position(v));
        for f in cube.faces() {
            let own = cube.plane(f).expect("a plane").normal();
            for h in cube.face_half_edges(f) {
                assert!(normals.at(h).distance(own) < 1e-12);
            }
        }
    }
}
