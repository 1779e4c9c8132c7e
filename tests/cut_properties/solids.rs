//! Meshes that are not convex: prisms over stars, landscapes over a grid, solids side by side.

use std::f64::consts::TAU;

use glam::DVec3;
use kerfold::mesh::{Mesh, MeshBuilder};

use super::random::Random;

/// An upright prism over a star-shaped polygon.
pub fn star_prism(random: &mut Random) -> Mesh {
    let n = 5 + random.below(9);
    let height = random.between(0.5, 3.0);
    let base: Vec<DVec3> = (0..n)
        .map(|i| {
            let angle = TAU * (i as f64 + random.between(0.0, 0.8)) / n as f64;
            DVec3::new(angle.cos(), angle.sin(), 0.0) * random.between(0.4, 3.0)
        })
        .collect();
    let mut builder = MeshBuilder::new();
    for p in base.iter().copied().chain(base.iter().map(|&p| p + DVec3::Z * height)) {
        builder.vertex(p);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        builder.face([i, j, n + j, n + i]);
    }
    builder.face((0..n).rev());
    builder.face(n..2 * n);
    builder.build().expect("a prism").0
}

/// A landscape of triangles over a grid with heights in whole numbers, on a flat bottom: full of
/// saddles, flats and ridges at equal heights.
pub fn landscape(random: &mut Random) -> Mesh {
    let (n, m) = (2 + random.below(4), 2 + random.below(4));
    let highest = 2 + random.below(3);
    let mut builder = MeshBuilder::new();
    for y in 0..=m {
        for x in 0..=n {
            let z = 1 + random.below(highest);
            builder.vertex(DVec3::new(x as f64, y as f64, z as f64));
        }
    }
    let top = |x: usize, y: usize| y * (n + 1) + x;
    for y in 0..m {
        for x in 0..n {
            let [a, b, c, d] = [top(x, y), top(x + 1, y), top(x + 1, y + 1), top(x, y + 1)];
            let halves =
                if random.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            for half in halves {
                builder.face(half);
            }
        }
    }
    // Around the rim, counter-clockwise seen from above.
    let south = (0..n).map(|x| (x, 0));
    let east = (0..m).map(|y| (n, y));
    let north = (1..=n).rev().map(|x| (x, m));
    let west = (1..=m).rev().map(|y| (0, y));
    let rim: Vec<(usize, usize)> = south.chain(east).chain(north).chain(west).collect();
    let foot: Vec<usize> =
        rim.iter().map(|&(x, y)| builder.vertex(DVec3::new(x as f64, y as f64, 0.0))).collect();
    for (i, &(x, y)) in rim.iter().enumerate() {
        let j = (i + 1) % rim.len();
        let (u, v) = rim[j];
        builder.face([foot[i], foot[j], top(u, v), top(x, y)]);
    }
    builder.face(foot.iter().rev().copied());
    builder.build().expect("a landscape").0
}

/// Two meshes as one, the second moved beside the first.
pub fn side_by_side(first: &Mesh, second: &Mesh) -> Mesh {
    let right = first.bounds().map_or(0.0, |(_, high)| high.x);
    let left = second.bounds().map_or(0.0, |(low, _)| low.x);
    let mut builder = MeshBuilder::new();
    for (mesh, shift) in [(first, 0.0), (second, (right - left).ceil() + 1.0)] {
        let number: Vec<usize> =
            mesh.vertices().map(|v| builder.vertex(mesh.position(v) + DVec3::X * shift)).collect();
        for f in mesh.faces() {
            builder.face(mesh.face_vertices(f).map(|v| number[v.index()]));
        }
    }
    builder.build().expect("two solids").0
}
