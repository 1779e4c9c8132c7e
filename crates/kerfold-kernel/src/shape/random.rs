//! Random convex solids with three edges at every vertex.

use glam::DVec3;

use crate::geom::Plane;
use crate::geom::hull::{Form, HalfSpace, Intersect, Polytope, intersect};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::random::Rng;

/// The intersection of `n` half-spaces whose planes touch the unit sphere at uniformly random
/// points.
///
/// Closed and convex, all vertices of valence 3: n faces, 3n − 6 edges, 2n − 4 vertices. Face i
/// touches the sphere at the i-th random point and carries its exact plane; the vertices are
/// computed and lie on their planes up to rounding. Vertices are numbered in the order in which the
/// faces first come to them. The same `n` and `seed` give the same mesh everywhere.
///
/// # Panics
/// When n is below 4.
pub fn random_tangent_polytope(n: usize, seed: u64) -> Mesh {
    assert!(n >= 4, "a solid has at least 4 faces, not {n}");
    let mut random = Rng::new(seed);
    let options =
        Intersect { form: Form::Simple, interior: Some(DVec3::ZERO), ..Intersect::default() };
    // The planes enclose the sphere when the hull of the touching points holds the centre: nearly
    // always but for small n.
    loop {
        let points: Vec<DVec3> = (0..n).map(|_| random.on_sphere()).collect();
        let tangent = |&p: &DVec3| HalfSpace { normal: p, offset: p.length_squared() };
        let half_spaces: Vec<HalfSpace> = points.iter().map(tangent).collect();
        let polytope =
            intersect(&half_spaces, &options).ok().filter(|polytope| polytope.faces.len() == n);
        if let Some(mesh) = polytope.and_then(|polytope| tangent_mesh(&points, &polytope)) {
            return mesh;
        }
    }
}

/// The mesh of a polytope of which every half-space has a face, with its vertices renumbered.
fn tangent_mesh(points: &[DVec3], polytope: &Polytope) -> Option<Mesh> {
    let mut number = vec![usize::MAX; polytope.vertices.len()];
    let mut positions = Vec::with_capacity(number.len());
    let mut renumbered = |&v: &u32| {
        let number = &mut number[v as usize];
        if *number == usize::MAX {
            *number = positions.len();
            positions.push(polytope.vertices[v as usize]);
        }
        *number
    };
    let faces: Vec<Vec<usize>> =
        polytope.faces.iter().map(|run| run.iter().map(&mut renumbered).collect()).collect();
    let count = positions.len();
    let mut mesh = Mesh::from_faces(positions, faces).ok()?;
    for v in (0..count).map(VertexId::new) {
        mesh.set_position(v, mesh.position(v), false);
    }
    for (i, &p) in points.iter().enumerate() {
        mesh.set_plane(
            FaceId::new(i),
            Plane::new(p, p).expect("points on the sphere are unit vectors"),
        );
    }
    Some(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    #[test]
    fn counts_valence_planarity_and_convexity_hold() {
        for (n, seed) in [(4, 1), (5, 2), (12, 3), (100, 4), (1000, 5)] {
            let mesh = random_tangent_polytope(n, seed);
            assert_sound(&mesh);
            assert_eq!(
                [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
                [2 * n - 4, 3 * n - 6, n]
            );
            assert!(mesh.is_closed() && mesh.vertices().all(|v| mesh.valence(v) == 3));
            let (low, high) = mesh.bounds().expect("vertices");
            let tolerance = 1e-15 * (high - low).length();
            for f in mesh.faces() {
                let plane = mesh.carried_plane(f).expect("a tangent plane");
                assert!((plane.offset() - 1.0).abs() < 1e-15);
                let corners = mesh.face_positions(f);
                assert!(
                    corners.iter().all(|&p| plane.signed_distance(p).abs() <= tolerance),
                    "{n}: {f:?}"
                );
                assert!(
                    plane.normal().dot(Plane::newell(&corners).expect("an area").normal()) > 0.9
                );
                let is_below = |v| plane.signed_distance(mesh.position(v)) <= tolerance;
                assert!(n > 200 || mesh.vertices().all(is_below), "{n}: {f:?}");
            }
        }
    }

    #[test]
    fn the_seed_decides_everything() {
        let positions = |seed| {
            let mesh = random_tangent_polytope(30, seed);
            mesh.vertices().map(|v| mesh.position(v)).collect::<Vec<_>>()
        };
        assert_eq!(positions(7), positions(7));
        assert_ne!(positions(7), positions(8));
    }

    #[test]
    fn the_points_are_uniform_on_the_sphere() {
        let mut random = Rng::new(42);
        let points: Vec<DVec3> = (0..10_000).map(|_| random.on_sphere()).collect();
        assert!(points.iter().all(|p| (p.length() - 1.0).abs() < 1e-15));
        let mean = points.iter().sum::<DVec3>() / 10_000.0;
        assert!(mean.abs().max_element() < 0.02, "{mean}");
        // By Archimedes' hat-box theorem every coordinate is uniform in [−1, 1].
        let squares = points.iter().map(|p| *p * *p).sum::<DVec3>() / 10_000.0;
        assert!((squares - DVec3::splat(1.0 / 3.0)).abs().max_element() < 0.02, "{squares}");
    }
}
