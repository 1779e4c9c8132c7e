//! Small meshes made by hand, for the tests of the layers that measure and check.

use glam::DVec3;

use crate::mesh::Mesh;

/// The eight corners of a cube of side 2 around the origin; bit 0 is x, bit 1 y, bit 2 z.
pub(crate) fn cube_corners() -> Vec<DVec3> {
    (0..8)
        .map(|i| {
            DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE
        })
        .collect()
}

pub(crate) const CUBE_FACES: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// A cube of side 2.
pub(crate) fn cube() -> Mesh {
    Mesh::from_faces(cube_corners(), CUBE_FACES).expect("a cube")
}

/// A cube of side 2 without its top.
pub(crate) fn open_box() -> Mesh {
    Mesh::from_faces(cube_corners(), CUBE_FACES.into_iter().filter(|f| f[0] != 4 || f[1] != 5))
        .expect("a box")
}

/// An octahedron with corners at distance 1.
pub(crate) fn octahedron() -> Mesh {
    let points = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let faces = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
    Mesh::from_faces(points, faces).expect("an octahedron")
}

/// A prism of height 1 over an L: concave.
pub(crate) fn ell_prism() -> Mesh {
    prism(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]])
}

/// A prism of height 1 over a polygon that runs counter-clockwise.
pub(crate) fn prism(base: &[[f64; 2]]) -> Mesh {
    let n = base.len();
    let points =
        [0.0, 1.0].into_iter().flat_map(|z| base.iter().map(move |p| DVec3::new(p[0], p[1], z)));
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    Mesh::from_faces(points, faces).expect("a prism")
}

/// A torus of `around` × `across` quads.
pub(crate) fn torus(around: usize, across: usize) -> Mesh {
    let turn = |i: usize, n: usize| (i as f64 / n as f64 * std::f64::consts::TAU).sin_cos();
    let points = (0..around * across).map(|k| {
        let ((s, c), (t, d)) = (turn(k / across, around), turn(k % across, across));
        DVec3::new((3.0 + d) * c, (3.0 + d) * s, t)
    });
    let at = move |i: usize, j: usize| i % around * across + j % across;
    let faces = (0..around * across).map(|k| {
        let (i, j) = (k / across, k % across);
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    });
    Mesh::from_faces(points, faces).expect("a torus")
}
