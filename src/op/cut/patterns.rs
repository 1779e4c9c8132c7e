//! Any pattern of the three sides, drawn at random and whatever the positions say, must lead to a
//! sound mesh.

use glam::DVec3;
use proptest::prelude::*;

use super::{Cutter, Reach, SlicingPlane};
use crate::geom::{Plane, Side};
use crate::mesh::{Corner, FaceKind, Mesh, VertexId, assert_sound};
use crate::op::*;
use crate::select::Selection;

const CAPPINGS: [Capping; 3] = [Capping::Auto, Capping::Always, Capping::Never];

fn prism(n: usize) -> Mesh {
    let ring = |z: f64| {
        (0..n).map(move |i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            DVec3::new(angle.cos(), angle.sin(), z)
        })
    };
    let sides = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]);
    let faces: Vec<Vec<usize>> =
        sides.chain([(0..n).rev().collect(), (n..2 * n).collect()]).collect();
    Mesh::from_faces(ring(0.0).chain(ring(1.0)), faces).expect("a prism")
}

/// A frame of 4 × 4 quads: genus 1.
fn torus() -> Mesh {
    let at = |i: usize, j: usize| 4 * (i % 4) + j % 4;
    let position = |k: usize| {
        let (a, b) = ((k / 4) as f64 * 1.6, (k % 4) as f64 * 1.6);
        DVec3::new((3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin())
    };
    let quad = |k: usize| {
        let (i, j) = (k / 4, k % 4);
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    Mesh::from_faces((0..16).map(position), (0..16).map(quad)).expect("a torus")
}

/// Self-loops, 2-gons, valence-1 vertices and point spheres on a cube, wherever `choices` say.
fn oddity(choices: &[usize]) -> Mesh {
    let mut mesh = prism(4);
    mesh.create_vertex(DVec3::splat(3.0));
    for &choice in choices {
        let corners: Vec<_> = mesh.half_edges().collect();
        let h = corners[choice / 8 % corners.len()];
        let other = corners[choice / 512 % corners.len()];
        match choice % 8 {
            0 => drop(mesh.insert_edge(Corner::At(h), Corner::At(h)).expect("a corner")),
            1 => drop(mesh.insert_edge(Corner::At(h), Corner::At(mesh.next(h))).expect("corners")),
            2 => {
                let (v, _) = mesh.create_vertex(DVec3::new(0.3, 0.4, 2.0));
                mesh.insert_edge(Corner::At(h), Corner::Lone(v)).expect("corners");
            }
            3 => drop(mesh.collapse_edge(h.edge())),
            4 => mesh.delete_edge_with_cleanup(h.edge()),
            5 => drop(mesh.insert_edge(Corner::At(h), Corner::At(other)).expect("corners")),
            6 => mesh.set_kind(mesh.face(h), FaceKind::Hole),
            _ => drop(mesh.subdivide_edge(h.edge())),
        }
        if mesh.half_edges().next().is_none() {
            return prism(3);
        }
    }
    mesh
}

fn mesh_of(which: usize, choices: &[usize]) -> Mesh {
    let mut mesh = match which {
        0 => prism(4),
        1 => prism(9),
        2 => torus(),
        3 => oddity(choices),
        _ => [prism(5), torus()][choices[0] % 2].clone(),
    };
    if which == 4 {
        for &choice in &choices[..choices[1] % 3] {
            let faces: Vec<_> = mesh.faces().collect();
            mesh.set_kind(faces[choice % faces.len()], FaceKind::Hole);
        }
    }
    mesh
}

/// Nothing is refused: whatever the signs and positions, the mesh is sound afterwards.
fn cut_by_pattern(mesh: Mesh, pattern: &[u8], capping: Capping, seed: Option<usize>) {
    let vertices: Vec<VertexId> = mesh.vertices().collect();
    let seeds: Vec<VertexId> = seed.map(|s| vertices[s % vertices.len()]).into_iter().collect();
    let mut cutter = Cutter::new(mesh);
    cutter.set_capping(capping);
    let sides = [Side::Reverse, Side::On, Side::Normal];
    cutter.pattern = pattern.iter().map(|&p| sides[usize::from(p) % 3]).collect();
    let plane = SlicingPlane {
        plane: Plane::new(DVec3::Z, DVec3::splat(0.5)).expect("a plane"),
        given: None,
    };
    let reach = if seeds.is_empty() { Reach::Global } else { Reach::Local(&seeds) };
    cutter.cut(&plane, reach);
    assert!(
        cutter
            .last_cut()
            .caps
            .iter()
            .all(|&f| cutter.mesh().has_face(f) && !cutter.mesh().is_hole(f))
    );
    assert_sound(cutter.mesh());
    // The chain goes on by numbers.
    cutter.pattern.clear();
    let plane = SlicingPlane {
        plane: Plane::new(DVec3::X, DVec3::splat(0.1)).expect("a plane"),
        given: None,
    };
    cutter.cut(&plane, Reach::Global);
    assert_sound(cutter.mesh());
    cutter.mesh_mut().compact();
    assert_sound(cutter.mesh());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn every_pattern_leads_to_a_sound_mesh(
        which in 0_usize..5, choices in prop::collection::vec(any::<u16>().prop_map(usize::from), 8),
        pattern in prop::collection::vec(0_u8..3, 60), capping in 0_usize..3, seed in prop::option::of(0_usize..64),
    ) {
        cut_by_pattern(mesh_of(which, &choices), &pattern, CAPPINGS[capping], seed);
    }

    #[test]
    fn with_random_positions_too(
        which in 0_usize..5, choices in prop::collection::vec(any::<u16>().prop_map(usize::from), 8),
        pattern in prop::collection::vec(0_u8..3, 60), capping in 0_usize..3, seed in prop::option::of(0_usize..64),
        positions in prop::collection::vec(prop::array::uniform3(-3_i8..=3), 60), is_given in any::<bool>(),
    ) {
        let mut mesh = mesh_of(which, &choices);
        let vertices: Vec<VertexId> = mesh.vertices().collect();
        for (v, p) in vertices.into_iter().zip(positions) {
            mesh.set_position(v, DVec3::from_array(p.map(f64::from)), is_given);
        }
        cut_by_pattern(mesh, &pattern, CAPPINGS[capping], seed);
    }

    #[test]
    fn operators_on_odd_meshes_refuse_or_stay_sound(
        which in 0_usize..5, choices in prop::collection::vec(any::<u16>().prop_map(usize::from), 8),
        operator in 0_usize..5, offset in 0.05_f64..1.9, local in any::<bool>(), repeat in 1_u32..3, disjoint in any::<bool>(),
    ) {
        let mesh = mesh_of(which, &choices);
        let scope = if local { Scope::Local } else { Scope::Global };
        let disjoint = if disjoint { Disjoint::Yes } else { Disjoint::No };
        let (select, context) = (Selection::all(), OpContext::default());
        let result = match operator {
            0 => {
                let params = TruncateVertexParams { scope, repeat, disjoint, ..TruncateVertexParams::new(select, offset) };
                truncate_vertices(&mesh, &params, &context).map(|r| r.0)
            }
            1 => {
                let params = TruncateEdgeParams { scope, repeat, disjoint, bend: offset - 1.0, ..TruncateEdgeParams::new(select, offset) };
                truncate_edges(&mesh, &params, &context).map(|r| r.0)
            }
            2 => {
                let params = TruncateFaceParams { scope, repeat, disjoint, ..TruncateFaceParams::new(select, offset) };
                truncate_faces(&mesh, &params, &context).map(|r| r.0)
            }
            3 => resolve(&mesh, &ResolveParams::default(), &context).map(|r| r.0),
            _ => slice(&mesh, &SliceParams::new(DVec3::new(0.1, 0.2, 1.0), DVec3::splat(offset - 0.7)), &context).map(|r| r.0),
        };
        if let Ok(mesh) = result {
            assert_sound(&mesh);
        }
    }
}

/// A local cut costs what it removes: the vertices classified do not grow with the mesh.
#[test]
fn the_work_of_a_local_cut_does_not_grow_with_the_mesh() {
    let work = |faces: usize| {
        let mesh = crate::shape::random_tangent_polytope(faces, 7);
        let v = VertexId::new(faces / 2);
        let around: Vec<DVec3> =
            mesh.vertex_faces(v).filter_map(|f| mesh.plane(f)).map(|p| p.normal()).collect();
        let normal = around.iter().sum::<DVec3>().normalize();
        let mut cutter = Cutter::new(mesh);
        let fall = |u| normal.dot(cutter.mesh().position(v) - cutter.mesh().position(u));
        let depth = 0.5 * cutter.mesh().neighbours(v).map(fall).fold(f64::INFINITY, f64::min);
        let point = cutter.mesh().position(v) - normal * depth;
        let plane =
            SlicingPlane { plane: Plane::new(normal, point).expect("a plane"), given: None };
        cutter.cut(&plane, Reach::Local(&[v]));
        let cut = cutter.last_cut();
        assert_eq!((cut.removed.len(), cut.caps.len()), (1, 1));
        // The vertex and the corners of its three faces.
        let corners: usize = cutter.mesh().face_vertices(cut.caps[0]).count();
        (cutter.classified, corners)
    };
    for faces in [100, 1000, 10_000] {
        let (classified, corners) = work(faces);
        assert_eq!(corners, 3);
        assert!(classified <= 60, "{classified} vertices classified in a mesh of {faces} faces");
    }
}
