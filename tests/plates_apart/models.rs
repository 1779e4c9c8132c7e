//! Models of all kinds to make plates of.

use glam::{DVec2, DVec3};
use kerfold::mesh::Mesh;
use kerfold::shape::{SolidParams, hexagonal_facade, random_tangent_polytope, solid, solid_names};
use kerfold::units::Length;

/// All ready-made solids, the families with a few of their members, 200 mm large.
pub fn solids() -> impl Iterator<Item = (&'static str, Mesh)> {
    // Five Platonic and thirteen Archimedean solids come first; aliases follow.
    let fixed = solid_names().take(18);
    let families =
        ["prism-3", "prism-7", "antiprism-4", "antiprism-5", "geodesic-2", "box-30x20x10"];
    fixed.chain(families).map(|name| {
        let params = SolidParams {
            name: name.parse().expect("a name"),
            edge: None,
            // Boxes have their size in their name.
            size: (!name.starts_with("box")).then(|| Length::from_mm(200.0)),
        };
        (name, solid(&params).expect("a solid"))
    })
}

/// The next of a row of numbers in 0..1.
fn next(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// A prism over a random star-shaped polygon: reflex corners and concave edges, three edges at
/// every corner.
pub fn star_prism(corners: usize, seed: u64) -> Mesh {
    let mut state = seed.wrapping_add(17);
    let flat: Vec<DVec2> = (0..corners)
        .map(|i| {
            let angle =
                (i as f64 + 0.4 * next(&mut state)) * std::f64::consts::TAU / corners as f64;
            let radius = if i % 2 == 0 { 100.0 } else { 45.0 } + 20.0 * next(&mut state);
            DVec2::from_angle(angle) * radius
        })
        .collect();
    let points = [0.0, 70.0].into_iter().flat_map(|z| flat.iter().map(move |p| p.extend(z)));
    let n = corners;
    let sides = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]);
    let caps = [(0..n).rev().collect(), (n..2 * n).collect()];
    Mesh::from_faces(points, caps.into_iter().chain(sides)).expect("a prism")
}

/// A random convex solid without some of its faces.
pub fn open_polytope(faces: usize, seed: u64) -> Mesh {
    let whole = random_tangent_polytope(faces, seed);
    let points: Vec<DVec3> = whole.vertices().map(|v| whole.position(v) * 100.0).collect();
    let kept = whole.faces().enumerate().filter(|(i, _)| i % 6 != 0).map(|(_, f)| f);
    let corners = kept.map(|f| whole.face_vertices(f).map(|v| v.index()).collect::<Vec<_>>());
    Mesh::from_faces(points, corners).expect("what is left")
}

/// Planar hexagons on a saddle; many have reflex corners.
pub fn saddle() -> Mesh {
    hexagonal_facade(5, 4, 100.0, [1200.0, -900.0])
}

/// Two faces at an edge that ends in a reflex corner of the rim.
pub fn reflex_rim() -> Mesh {
    let points = [
        (0., 0., 0.),
        (0., -100., 0.),
        (200., -100., 0.),
        (200., 60., 0.),
        (100., 0., 0.),
        (100., 80., -40.),
        (0., 80., -40.),
    ];
    let faces = [vec![0, 1, 2, 3, 4], vec![0, 4, 5, 6]];
    Mesh::from_faces(points.map(DVec3::from), faces).expect("two faces")
}

/// A cube of 100 mm one corner of which is moved along its diagonal.
pub fn tilted_cube(by: f64) -> Mesh {
    let corner = |i: usize| {
        let bit = |k: usize| f64::from(u8::from(i >> k & 1 == 1)) * 100.0;
        DVec3::new(bit(0), bit(1), bit(2))
            + if i == 7 { DVec3::splat(by) * DVec3::new(0.3, 1.0, 0.5) } else { DVec3::ZERO }
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
    Mesh::from_faces((0..8).map(corner), faces).expect("a cube")
}

/// Coordinates with few decimals, as files have them.
pub fn rounded(mesh: &Mesh, decimals: i32) -> Mesh {
    let scale = 10_f64.powi(decimals);
    let points: Vec<DVec3> =
        mesh.vertices().map(|v| (mesh.position(v) * scale).round() / scale).collect();
    let corners =
        mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.index()).collect::<Vec<_>>());
    Mesh::from_faces(points, corners).expect("as before")
}

/// Two open boxes, one beside the other, that leave a slot: two walls look at each other.
pub fn thin_slab(slot: f64) -> Mesh {
    let at =
        |x: f64| [(0., 0.), (40., 0.), (40., 60.), (0., 60.)].map(|(y, z)| DVec3::new(x, y, z));
    let points = [at(-50.0), at(0.0), at(slot), at(slot + 50.0)].concat();
    let boxed = |k: usize| {
        let (a, b) = (8 * k, 8 * k + 4);
        let side = move |i: usize| vec![a + i, a + (i + 1) % 4, b + (i + 1) % 4, b + i];
        let caps = [vec![a + 3, a + 2, a + 1, a], vec![b, b + 1, b + 2, b + 3]];
        caps.into_iter().chain((0..4).map(side))
    };
    Mesh::from_faces(points, boxed(0).chain(boxed(1))).expect("two boxes")
}
