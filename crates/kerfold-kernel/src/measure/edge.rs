//! Lengths of edges and angles at them.

use std::f64::consts::PI;

use crate::mesh::{EdgeId, Mesh};

/// The length of an edge, in the model's unit.
pub fn edge_length(mesh: &Mesh, e: EdgeId) -> f64 {
    let [a, b] = mesh.edge_positions(e);
    a.distance(b)
}

/// The angle by which the faces of an edge turn against each other, in radians in (−π, π]: 0 when
/// flat, positive at a convex edge (mountain), negative at a concave one (valley). `None` at a rim,
/// at a face without area, or at an edge of length zero.
pub fn fold_angle(mesh: &Mesh, e: EdgeId) -> Option<f64> {
    let [f, g] = mesh.edge_faces(e);
    if mesh.is_rim(e) {
        return None;
    }
    let (n, m) = (mesh.plane(f)?.normal(), mesh.plane(g)?.normal());
    let [a, b] = mesh.edge_positions(e);
    let along = (b - a).try_normalize()?;
    Some(along.dot(n.cross(m)).atan2(n.dot(m)))
}

/// The interior angle between the faces of an edge, in radians in [0, 2π): π when flat, less at a
/// convex edge. `None` as for [`fold_angle`].
pub fn dihedral_angle(mesh: &Mesh, e: EdgeId) -> Option<f64> {
    fold_angle(mesh, e).map(|fold| PI - fold)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Two quads along the x axis: one in the plane z = 0, the other turned up by `degrees` from
    /// its continuation.
    fn hinge(degrees: f64) -> Mesh {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let points = [
            at(0., 0., 0.),
            at(1., 0., 0.),
            at(1., -1., 0.),
            at(0., -1., 0.),
            at(1., cos, sin),
            at(0., cos, sin),
        ];
        Mesh::from_faces(points, [[0, 3, 2, 1], [0, 1, 4, 5]]).expect("a hinge")
    }

    #[test]
    fn mountains_are_positive_and_valleys_negative() {
        for degrees in [-90.0_f64, -30.0, 0.0, 45.0, 120.0] {
            let mesh = hinge(degrees);
            let e = mesh.edges().find(|&e| !mesh.is_rim(e)).expect("one inner edge");
            let fold = fold_angle(&mesh, e).expect("two faces").to_degrees();
            // Turning up towards the normal makes a valley.
            assert!((fold + degrees).abs() < 1e-12, "{degrees}: {fold}");
            assert!(
                (dihedral_angle(&mesh, e).expect("two faces").to_degrees() - 180.0 - degrees).abs()
                    < 1e-12
            );
            assert_eq!(edge_length(&mesh, e), 1.0);
        }
    }

    #[test]
    fn a_rim_has_no_fold() {
        let mesh = hinge(10.0);
        assert!(mesh.edges().filter(|&e| mesh.is_rim(e)).all(|e| fold_angle(&mesh, e).is_none()));
    }
}
