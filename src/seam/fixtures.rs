//! Closed 3-valent meshes for the tests of this module.

use std::collections::HashMap;

use glam::DVec3;

use crate::mesh::{HalfEdgeId, Mesh};

pub(super) use super::blossom::Random;

pub(super) fn tetrahedron() -> Mesh {
    let points = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]].map(DVec3::from);
    Mesh::from_faces(points, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).expect("a tetrahedron")
}

pub(super) fn cube() -> Mesh {
    let points =
        (0..8).map(|i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64));
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::from_faces(points, faces).expect("a cube")
}

/// A right prism over a regular polygon with side 1 and the given height.
pub(super) fn prism(sides: usize, height: f64) -> Mesh {
    let radius = 0.5 / (std::f64::consts::PI / sides as f64).sin();
    let at = |i: usize, z: f64| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / sides as f64).sin_cos();
        DVec3::new(radius * cos, radius * sin, z)
    };
    let points = (0..2 * sides).map(|i| at(i % sides, if i < sides { 0.0 } else { height }));
    let mut faces: Vec<Vec<usize>> = vec![(0..sides).rev().collect(), (sides..2 * sides).collect()];
    faces.extend((0..sides).map(|i| vec![i, (i + 1) % sides, (i + 1) % sides + sides, i + sides]));
    Mesh::from_faces(points, faces).expect("a prism")
}

/// The dual of the icosahedron.
pub(super) fn dodecahedron() -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
        points.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    polar(&points)
}

/// The intersection of the half-spaces that touch the unit sphere at random points: convex,
/// 3-valent.
pub(super) fn random_convex(faces: usize, seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut unit = || random.below(1 << 40) as f64 / (1u64 << 39) as f64 - 1.0;
    let mut points = Vec::new();
    while points.len() < faces {
        let p = DVec3::new(unit(), unit(), unit());
        if p.length() <= 1.0 && p.length() > 0.1 {
            points.push(p.normalize());
        }
    }
    polar(&points)
}

/// The mesh with one face for each point, in the plane n·x = 1 of the point n (scaled to the unit
/// sphere).
fn polar(points: &[DVec3]) -> Mesh {
    let triangles = hull(points);
    let mut of_edge = HashMap::new();
    for (t, triangle) in triangles.iter().enumerate() {
        of_edge.extend(
            (0..3).map(|i| ((triangle[i], triangle[(i + 1) % 3]), (t, triangle[(i + 2) % 3]))),
        );
    }
    let vertices = triangles.iter().map(|&[a, b, c]| {
        let n = (points[b] - points[a]).cross(points[c] - points[a]);
        n / n.dot(points[a])
    });
    let mut start = vec![usize::MAX; points.len()];
    triangles.iter().for_each(|&[a, b, c]| (start[a], start[b], start[c]) = (b, c, a));
    let face = |p: usize| {
        let mut around = Vec::new();
        let mut q = start[p];
        loop {
            let (t, far) = of_edge[&(p, q)];
            around.push(t);
            q = far;
            if q == start[p] {
                return around;
            }
        }
    };
    Mesh::from_faces(vertices, (0..points.len()).map(face)).expect("a dual")
}

/// The convex hull of points in convex position, one point after the other.
fn hull(points: &[DVec3]) -> Vec<[usize; 3]> {
    let sees = |&[a, b, c]: &[usize; 3], p: usize| {
        (points[b] - points[a]).cross(points[c] - points[a]).dot(points[p] - points[a]) > 0.0
    };
    let mut triangles = if sees(&[0, 1, 2], 3) {
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    } else {
        vec![[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]]
    };
    for p in 4..points.len() {
        let (seen, mut kept): (Vec<_>, Vec<_>) = triangles.into_iter().partition(|t| sees(t, p));
        let sides = |t: &[usize; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let all: std::collections::HashSet<_> = seen.iter().flat_map(sides).collect();
        kept.extend(
            seen.iter()
                .flat_map(sides)
                .filter(|&(a, b)| !all.contains(&(b, a)))
                .map(|(a, b)| [a, b, p]),
        );
        triangles = kept;
    }
    triangles
}

/// Cuts all vertices off at the fraction `t` of their edges.
pub(super) fn truncated(mesh: &Mesh, t: f64) -> Mesh {
    let place =
        |h: HalfEdgeId| mesh.position(mesh.origin(h)).lerp(mesh.position(mesh.target(h)), t);
    // One new vertex near the origin of every half-edge.
    let points: Vec<DVec3> =
        (0..mesh.half_edge_slots()).map(|i| place(HalfEdgeId::new(i))).collect();
    let sides = mesh.faces().map(|f| {
        mesh.face_half_edges(f).flat_map(|h| [h.index(), h.twin().index()]).collect::<Vec<_>>()
    });
    let caps = mesh.vertices().map(|v| {
        let mut cap: Vec<usize> = mesh.outgoing(v).map(HalfEdgeId::index).collect();
        // outgoing() runs clockwise.
        cap.reverse();
        cap
    });
    Mesh::from_faces(points, sides.chain(caps)).expect("a truncation")
}

/// Tutte's graph (1946), planar, cubic and 3-connected, without a Hamiltonian cycle; the places of
/// the vertices mean nothing.
pub(super) fn tutte() -> Mesh {
    let faces: [&[usize]; 25] = [
        &[0, 1, 26, 25, 24, 23, 21, 20, 19, 3],
        &[0, 2, 10, 9, 8, 7, 6, 5, 4, 1],
        &[0, 3, 18, 17, 16, 15, 13, 12, 11, 2],
        &[1, 4, 33, 26],
        &[2, 11, 39, 10],
        &[3, 19, 45, 18],
        &[4, 5, 29, 30, 33],
        &[5, 6, 27, 28, 29],
        &[6, 7, 14, 13, 15, 22, 21, 23, 27],
        &[7, 8, 38, 34, 14],
        &[8, 9, 37, 38],
        &[9, 10, 39, 36, 37],
        &[11, 12, 35, 36, 39],
        &[12, 13, 14, 34, 35],
        &[15, 16, 44, 40, 22],
        &[16, 17, 43, 44],
        &[17, 18, 45, 42, 43],
        &[19, 20, 41, 42, 45],
        &[20, 21, 22, 40, 41],
        &[23, 24, 32, 28, 27],
        &[24, 25, 31, 32],
        &[25, 26, 33, 30, 31],
        &[28, 32, 31, 30, 29],
        &[34, 38, 37, 36, 35],
        &[40, 44, 43, 42, 41],
    ];
    let points = (0..46).map(|i| DVec3::new(f64::from(i), f64::from(i * i), f64::from(i * i * i)));
    Mesh::from_faces(points, faces.map(<[usize]>::to_vec)).expect("Tutte's graph")
}

/// A torus of hexagons, `w` by `h` (even) cells, closed and 3-valent.
pub(super) fn hexagon_torus(w: usize, h: usize) -> Mesh {
    let at = |x: usize, y: usize| (y % h) * 2 * w + x % (2 * w);
    let point = |i: usize| {
        let (x, y) = (i % (2 * w), i / (2 * w));
        let (a, b) = (
            std::f64::consts::PI * x as f64 / w as f64,
            std::f64::consts::TAU * y as f64 / h as f64,
        );
        let r = 3.0 + b.cos();
        DVec3::new(r * a.cos(), r * a.sin(), b.sin())
    };
    // A cell lies between the rows y and y + 1, from one upright edge to the next.
    let cell = |x: usize, y: usize| {
        [at(x, y), at(x + 1, y), at(x + 2, y), at(x + 2, y + 1), at(x + 1, y + 1), at(x, y + 1)]
    };
    let cells = (0..h).flat_map(|y| (0..w).map(move |x| (2 * x + y % 2, y)));
    Mesh::from_faces((0..2 * w * h).map(point), cells.map(|(x, y)| cell(x, y))).expect("a torus")
}
