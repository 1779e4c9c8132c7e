//! The fuzz target: chains of cuts by planes that aim at trouble, on meshes that are full of it.
//!
//! A few hundred chains run with every `cargo test`. For longer:
//!
//! ```sh
//! KERFOLD_FUZZ_MINUTES=10 cargo test --release --test cut_properties fuzz -- --nocapture
//! ```
//!
//! A finding prints its seed; `KERFOLD_FUZZ_SEED=<seed>` begins there. What was found becomes a
//! plain test.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use kerfold::geom::Plane;
use kerfold::mesh::VertexId;
use kerfold::op::{
    CutChain, Disjoint, Reach, ResolveParams, Scope, TruncateEdgeParams, TruncateFaceParams,
    TruncateVertexParams, resolve, truncate_edges, truncate_faces, truncate_vertices,
};
use kerfold::select::Selection;

use super::*;

/// Chains that run when nobody asks for more.
const USUAL: u64 = 150;

fn number(name: &str) -> Option<f64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

#[test]
#[allow(clippy::print_stdout)] // The seeds, for those who run it with --nocapture.
fn fuzz() {
    let first = number("KERFOLD_FUZZ_SEED").map_or(0, |seed| seed as u64);
    let time =
        number("KERFOLD_FUZZ_MINUTES").map(|minutes| Duration::from_secs_f64(60.0 * minutes));
    let start = Instant::now();
    let mut seed = first;
    while time.map_or(seed < first + USUAL, |time| start.elapsed() < time) {
        let result = catch_unwind(AssertUnwindSafe(|| chain(seed)));
        assert!(result.is_ok(), "a finding: KERFOLD_FUZZ_SEED={seed}");
        seed += 1;
    }
    println!("{} chains of cuts, from seed {first}, no finding", seed - first);
}

/// Needles and thin rings, whose volume was measured wrong by some per cent or more, and what is so
/// thin, or so small and far from the origin, that the spacing of the coordinates is seen in its
/// volume.
#[test]
fn what_the_fuzz_found() {
    let seeds = [
        410, 14_213, 20_015, 23_014, 29_130, 30_180, 39_933, 54_661, 54_773, 55_996, 58_587,
        65_039, 74_717, 101_637, 104_133, 109_321, 144_115, 150_413, 152_298, 158_973, 162_559,
        174_767, 175_411, 176_788, 182_761, 210_171, 232_510, 242_767, 563_149, 563_600, 678_337,
        1_910_006,
    ];
    seeds.into_iter().for_each(chain);
}

fn some_mesh(random: &mut Random, seed: u64) -> Option<Mesh> {
    let one = |random: &mut Random| match random.below(6) {
        0 => Some(shape::random_tangent_polytope(4 + random.below(30), seed)),
        1 => Some(solids::star_prism(random)),
        2 => Some(solids::landscape(random)),
        3 => Voxels::random(random).mesh(Touch::Apart, [0, 50, 100][random.below(3)], random),
        4 => Voxels::random(random).mesh(Touch::Through, [0, 50, 100][random.below(3)], random),
        _ => Voxels::with_tunnels(1 + random.below(2) as i32).mesh(Touch::Apart, 50, random),
    };
    let mut mesh = if random.below(5) == 0 {
        solids::side_by_side(&one(random)?, &one(random)?)
    } else if random.below(6) == 0 {
        Voxels::random(random).open_mesh(5 + random.below(40), random)?
    } else {
        one(random)?
    };
    // Powers of two are exact: what lay on a plane still does, from a thousandth of a millimetre to
    // a kilometre.
    let scale = 2.0_f64.powi(random.below(41) as i32 - 20);
    mesh.clear_planes();
    let vertices: Vec<VertexId> = mesh.vertices().collect();
    for v in vertices {
        mesh.set_position(v, mesh.position(v) * scale, true);
    }
    Some(mesh)
}

fn chain(seed: u64) {
    let mut random = Random::new(seed);
    let Some(mut mesh) = some_mesh(&mut random, seed) else { return };
    for step in 0..1 + random.below(5) {
        let title = format!("fuzz {seed}, step {step}");
        let next = match random.below(5) {
            0 | 1 => slice_somewhere(&mesh, &mut random, &title),
            2 => cut_locally(&mesh, &mut random),
            3 => truncate_some(&mesh, &mut random),
            _ => resolve(&mesh, &ResolveParams::default(), &OpContext::default()).ok().map(|r| r.0),
        };
        let Some(next) = next else { continue };
        assert_sound(&next);
        if next.face_count() == 0 || next.vertex_count() > 3000 {
            return;
        }
        mesh = next;
    }
}

/// Both halves are checked; the chain goes on with one of them.
fn slice_somewhere(mesh: &Mesh, random: &mut Random, title: &str) -> Option<Mesh> {
    let plane = aimed_plane(mesh, random)?;
    let halves = cut_in_two(mesh, plane).unwrap_or_else(|error| panic!("{title}: {error}"));
    halves.iter().flatten().for_each(|(part, _)| assert_sound(part));
    if mesh.is_closed() {
        check_volume(mesh, &halves, title);
    }
    let [low, high] = halves;
    let (first, second) = if random.below(2) == 0 { (low, high) } else { (high, low) };
    first.or(second).map(|half| half.0)
}

/// A few local cuts in one chain, some through several corners at once. No cut adds volume to a
/// convex corner's side.
fn cut_locally(mesh: &Mesh, random: &mut Random) -> Option<Mesh> {
    let mut chain = CutChain::new(mesh.clone());
    for _ in 0..1 + random.below(4) {
        let vertices: Vec<VertexId> = chain.mesh().vertices().collect();
        if vertices.is_empty() {
            break;
        }
        let v = *random.pick(&vertices);
        let here = chain.mesh().position(v);
        let t = *random.pick(&[0.25, 1.0 / 3.0, 0.5, 1.0]);
        let points: Vec<DVec3> =
            chain.mesh().neighbours(v).map(|u| here.lerp(chain.mesh().position(u), t)).collect();
        let normals: Vec<DVec3> = chain
            .mesh()
            .vertex_faces(v)
            .filter_map(|f| chain.mesh().plane(f))
            .map(|p| p.normal())
            .collect();
        let Some(plane) = Plane::through_mean(&points, &normals) else { continue };
        let others = [v, *random.pick(&vertices)];
        let seeds = &others[..1 + random.below(2)];
        let is_given = random.below(3) == 0;
        if is_given {
            chain.cut_given(plane.normal(), plane.point(), Reach::Local(seeds)).expect("a plane");
        } else {
            chain.cut(&plane, Reach::Local(seeds));
        }
        assert_sound(chain.mesh());
    }
    Some(chain.finish())
}

fn truncate_some(mesh: &Mesh, random: &mut Random) -> Option<Mesh> {
    let count = |n: usize| 1 + n / 4;
    let ids = |n: usize, random: &mut Random| -> Option<Selection> {
        let chosen: Vec<String> =
            (0..count(n).min(12)).map(|_| random.below(n).to_string()).collect();
        chosen.join(",").parse().ok()
    };
    let offset = *random.pick(&[0.2, 0.25, 1.0 / 3.0, 0.5, 0.75, 1.0, 1.5]);
    let scope = *random.pick(&[Scope::Global, Scope::Local]);
    let disjoint = *random.pick(&[Disjoint::No, Disjoint::No, Disjoint::Yes]);
    let context = OpContext::default();
    let result = match random.below(3) {
        0 => {
            let select = ids(mesh.vertex_count(), random)?;
            truncate_vertices(
                mesh,
                &TruncateVertexParams {
                    scope,
                    disjoint,
                    ..TruncateVertexParams::new(select, offset)
                },
                &context,
            )
        }
        1 => {
            let select = ids(mesh.edge_count(), random)?;
            truncate_edges(
                mesh,
                &TruncateEdgeParams { scope, disjoint, ..TruncateEdgeParams::new(select, offset) },
                &context,
            )
        }
        _ => {
            let select = ids(mesh.face_count(), random)?;
            truncate_faces(
                mesh,
                &TruncateFaceParams { scope, disjoint, ..TruncateFaceParams::new(select, offset) },
                &context,
            )
        }
    };
    result.ok().map(|r| r.0)
}
