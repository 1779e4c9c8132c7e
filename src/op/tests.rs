//! Cuts on meshes made by hand; the solids are covered by `tests/`.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::measure::volume;
use crate::mesh::{Mesh, assert_sound};

fn cuboid(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let pick = |i: usize, bit: usize, l: f64, h: f64| if i >> bit & 1 == 1 { h } else { l };
    let corner = |i: usize| {
        DVec3::new(pick(i, 0, low.x, high.x), pick(i, 1, low.y, high.y), pick(i, 2, low.z, high.z))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), faces.map(|f| f.to_vec()).to_vec())
}

fn cube() -> Mesh {
    let (points, faces) = cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
    Mesh::from_faces(points, faces).expect("a cube")
}

/// An upright prism over a polygon, given counter-clockwise.
fn prism(base: &[(f64, f64)], height: f64) -> Mesh {
    let n = base.len();
    let at = |z: f64| base.iter().map(move |&(x, y)| DVec3::new(x, y, z));
    let sides = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]);
    let faces: Vec<Vec<usize>> =
        sides.chain([(0..n).rev().collect(), (n..2 * n).collect()]).collect();
    Mesh::from_faces(at(0.0).chain(at(height)), faces).expect("a prism")
}

/// A frame: a box with a square tunnel along z.
fn frame() -> Mesh {
    let ring =
        |s: f64, z: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(|(x, y)| DVec3::new(x, y, z));
    let points: Vec<DVec3> =
        [ring(2.0, 0.0), ring(1.0, 0.0), ring(2.0, 1.0), ring(1.0, 1.0)].concat();
    let mut faces = Vec::new();
    for i in 0..4 {
        let j = (i + 1) % 4;
        faces.push(vec![i, j, 8 + j, 8 + i]);
        faces.push(vec![4 + j, 4 + i, 12 + i, 12 + j]);
        faces.push(vec![i, 4 + i, 4 + j, j]);
        faces.push(vec![8 + i, 8 + j, 12 + j, 12 + i]);
    }
    Mesh::from_faces(points, faces).expect("a frame")
}

fn counts(mesh: &Mesh) -> (usize, usize, usize) {
    (mesh.vertex_count(), mesh.edge_count(), mesh.face_count())
}

fn cut(mesh: &Mesh, normal: DVec3, point: DVec3, keep: Keep) -> Result<Mesh, OpError> {
    let params = SliceParams { keep, ..SliceParams::new(normal, point) };
    slice(mesh, &params, &OpContext::default()).map(|(mesh, _)| mesh)
}

fn all() -> crate::select::Selection {
    "all".parse().expect("a selection")
}

/// Both halves of a cut, checked for soundness and conservation of volume.
#[track_caller]
fn halves(mesh: &Mesh, normal: DVec3, point: DVec3) -> [Option<Mesh>; 2] {
    let mut total = 0.0;
    let parts = [Keep::Reverse, Keep::Normal].map(|keep| match cut(mesh, normal, point, keep) {
        Ok(part) => {
            assert_sound(&part);
            total += volume(&part);
            assert!(part.faces().all(|f| part.sides(f) >= 3));
            let visits_once = |f| {
                let mut corners: Vec<_> = part.face_vertices(f).collect();
                corners.sort_unstable();
                corners.windows(2).all(|w| w[0] != w[1])
            };
            assert!(part.faces().all(visits_once), "a face visits a vertex twice");
            Some(part)
        }
        Err(OpError::NothingLeft { .. }) => None,
        Err(error) => panic!("{error}"),
    });
    let before = volume(mesh);
    assert!((total - before).abs() <= 1e-12 * before.abs(), "{total} instead of {before}");
    parts
}

#[test]
fn truncating_all_of_a_cube_gives_the_counts_of_the_thesis() {
    let context = OpContext::default();
    let (vertices, report) =
        truncate_vertices(&cube(), &TruncateVertexParams::new(all(), 0.25), &context)
            .expect("a cut");
    assert_sound(&vertices);
    assert_eq!(counts(&vertices), (24, 36, 14));
    assert_eq!(
        (report.made.faces.len(), report.overcut.len(), report.not_three_valent.len()),
        (8, 0, 0)
    );
    let (edges, report) =
        truncate_edges(&cube(), &TruncateEdgeParams::new(all(), 0.25), &context).expect("a cut");
    assert_sound(&edges);
    // Three edge planes meet at each corner's diagonal: the rhombic cuboid with 32 vertices.
    assert_eq!(counts(&edges), (32, 48, 18));
    assert_eq!(report.not_three_valent.len(), 0);
    let (faces, _) =
        truncate_faces(&cube(), &TruncateFaceParams::new(all(), 0.25), &context).expect("a cut");
    assert_sound(&faces);
    assert_eq!(counts(&faces), (8, 12, 6));
    assert!((volume(&faces) - 1.0).abs() < 1e-12);
}

#[test]
fn three_rounds_on_one_edge_of_a_cube_are_figure_10() {
    let params = TruncateEdgeParams {
        repeat: 3,
        ..TruncateEdgeParams::new("0".parse().expect("ids"), 0.25)
    };
    let (mesh, report) = truncate_edges(&cube(), &params, &OpContext::default()).expect("a cut");
    assert_sound(&mesh);
    // 1 + 2 + 4 strips, each with V + 2, E + 3, F + 1; but the last two planes beside the middle
    // strip (0.155 wide where they take 0.083 each) meet above it, so it goes, and the report says
    // so.
    assert_eq!(counts(&mesh), (8 + 14 - 2, 12 + 21 - 3, 6 + 7 - 1));
    assert_eq!((report.cuts, report.overcut.len(), report.made.faces.len()), (7, 2, 4));
    let params = TruncateEdgeParams { offset: Some(0.2), ..params };
    let (mesh, report) = truncate_edges(&cube(), &params, &OpContext::default()).expect("a cut");
    assert_eq!(counts(&mesh), (8 + 14, 12 + 21, 6 + 7));
    assert_eq!(
        (report.cuts, report.overcut.len(), report.made.strip.len(), report.made.faces.len()),
        (7, 0, 8, 4)
    );
}

#[test]
fn a_cube_halved_in_all_ways() {
    let mesh = cube();
    for (normal, point, vertices) in [
        (DVec3::Z, DVec3::ZERO, 8),
        (DVec3::new(1.0, 1.0, 1.0), DVec3::ZERO, 10),
        (DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO, 6),
        (DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, 1.0, -1.0), 7),
    ] {
        let [Some(low), Some(high)] = halves(&mesh, normal, point) else { panic!("two halves") };
        assert!(
            low.vertex_count() == vertices || high.vertex_count() == vertices,
            "{:?} {:?}",
            counts(&low),
            counts(&high)
        );
    }
    assert!(matches!(
        cut(&mesh, DVec3::Z, DVec3::splat(-1.0), Keep::Reverse),
        Err(OpError::NothingLeft { .. })
    ));
    let missed = cut(&mesh, DVec3::Z, DVec3::splat(1.0), Keep::Reverse).expect("all is left");
    assert_eq!(counts(&missed), counts(&mesh));
}

#[test]
fn an_ell_cut_at_its_step_keeps_the_tread() {
    let ell = prism(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)], 1.0);
    let [Some(low), Some(high)] = halves(&ell, DVec3::Y, DVec3::new(0.0, 1.0, 0.0)) else {
        panic!("two halves")
    };
    assert!((volume(&low) - 2.0).abs() < 1e-12);
    assert_eq!(counts(&high), (8, 12, 6));
    halves(&ell, DVec3::X, DVec3::new(1.0, 0.0, 0.0));
    halves(&ell, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
    halves(&ell, DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn nested_loops_become_caps_divided_by_the_fewest_bridges() {
    let [Some(low), Some(high)] = halves(&frame(), DVec3::Z, DVec3::new(0.0, 0.0, 0.5)) else {
        panic!("two halves")
    };
    // One hole, two bridges, two caps instead of the four faces of the other side.
    assert_eq!(counts(&low), (16, 8 + 8 + 4 + 8 + 2, 8 + 4 + 2));
    assert_eq!(low.components()[0].genus, 1);
    assert_eq!(counts(&high), counts(&low));
    let [Some(left), Some(_)] = halves(&frame(), DVec3::X, DVec3::ZERO) else {
        panic!("two halves")
    };
    assert_eq!((left.components().len(), left.components()[0].genus), (1, 0));
    let [Some(_), Some(_)] = halves(&frame(), DVec3::new(1.0, 0.0, 0.2), DVec3::new(1.0, 0.0, 0.5))
    else {
        panic!("two halves")
    };
    halves(&frame(), DVec3::X, DVec3::new(1.0, 0.0, 0.0));
    halves(&frame(), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn an_open_mesh_stays_open_along_the_cut() {
    let (points, faces) = cuboid(DVec3::ZERO, DVec3::ONE);
    let tray = Mesh::from_faces(
        points,
        faces.into_iter().enumerate().filter(|(i, _)| *i != 1).map(|(_, f)| f),
    )
    .expect("a tray");
    assert_eq!(tray.hole_count(), 1);
    for (normal, rims) in [(DVec3::Z, 1), (DVec3::X, 1), (-DVec3::X, 1), (-DVec3::Z, 2)] {
        let part = cut(&tray, normal, DVec3::splat(0.5), Keep::Reverse).expect("half a tray");
        assert_sound(&part);
        assert_eq!(part.hole_count(), rims, "{normal}");
    }
}

#[test]
fn a_local_cut_leaves_the_rest_alone() {
    // Two towers on a base; a cut around one tower's top must not take the other's.
    let base = [(0., 0.), (5., 0.), (5., 3.), (4., 3.), (4., 1.), (1., 1.), (1., 3.), (0., 3.)];
    let mesh = prism(&base, 1.0);
    let tower = mesh.faces().find(|&f| {
        mesh.plane(f).expect("a plane").normal().y > 0.9 && mesh.face_positions(f)[0].x > 3.0
    });
    let select = tower.expect("a top").index().to_string();
    let params = TruncateFaceParams {
        scope: Scope::Local,
        ..TruncateFaceParams::new(select.parse().expect("ids"), 0.5)
    };
    let (local, report) = truncate_faces(&mesh, &params, &OpContext::default()).expect("a cut");
    assert_sound(&local);
    assert_eq!((counts(&local), report.overcut.len()), (counts(&mesh), 0));
    assert!((volume(&mesh) - volume(&local) - 1.25).abs() < 1e-12);
    let params = TruncateFaceParams { scope: Scope::Global, ..params };
    let (global, report) = truncate_faces(&mesh, &params, &OpContext::default()).expect("a cut");
    assert_sound(&global);
    assert_eq!(report.overcut.len(), 1);
    assert!((volume(&mesh) - volume(&global) - 2.5).abs() < 1e-12);
}

/// Ten rounds on one corner, 27 316 cuts, at the origin and 37 m away. The last faces have a
/// diameter of a thousandth of a millimetre, so what can be asked of each is its diameter's 1e-12
/// or the spacing of the coordinates, whichever is coarser.
#[test]
fn ten_rounds_keep_every_face_planar() {
    for shift in [DVec3::ZERO, DVec3::new(37_000.0, -37_000.0, 37_000.0)] {
        let (points, faces) = cuboid(shift - 50.0, shift + 50.0);
        let mesh = Mesh::from_faces(points, faces).expect("a cube");
        let corner = "0".parse().expect("an id");
        let params = TruncateVertexParams {
            scope: Scope::Local,
            repeat: 10,
            ..TruncateVertexParams::new(corner, 0.25)
        };
        let (mesh, report) =
            truncate_vertices(&mesh, &params, &OpContext::default()).expect("a cut");
        assert_sound(&mesh);
        assert!(report.cuts > 25_000 && mesh.vertex_count() > 50_000, "{} cuts", report.cuts);
        let largest = shift.abs().max_element() + 50.0;
        let spacing = largest.next_up() - largest;
        let model = crate::measure::size(&mesh).length();
        for f in mesh.faces() {
            let corners = mesh.face_positions(f);
            let plane = crate::geom::fit_plane(&corners).expect("a plane");
            let deviation =
                corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
            assert!(deviation <= 1e-12 * model, "{f} deviates by {deviation:e} of {model}");
            let finest = (1e-12 * crate::measure::face_diameter(&mesh, f)).max(4.0 * spacing);
            assert!(deviation <= finest, "{f} deviates by {deviation:e}, at {shift}");
        }
    }
}

/// Cutting everything at once and walking there give the same shape, and so do the short way for a
/// corner and the long one.
#[test]
fn all_ways_to_cut_agree() {
    let mesh = crate::shape::random_tangent_polytope(300, 5);
    let normal = DVec3::new(0.3, -0.2, 1.0);
    for depth in [0.9, 0.5, 0.0, -0.5] {
        let point = mesh.position(crate::mesh::VertexId::new(0)) * depth;
        let all: Vec<_> = mesh.vertices().collect();
        let reaches = [Reach::Global, Reach::Local(&all)];
        let cut = |reach| {
            let mut chain = CutChain::new(mesh.clone());
            let caps = chain.cut_given(normal, point, reach).expect("a plane").len();
            let result = chain.finish();
            assert_sound(&result);
            (caps, counts(&result), volume(&result))
        };
        let [global, local] = reaches.map(cut);
        assert_eq!((global.0, global.1), (local.0, local.1));
        assert!((global.2 - local.2).abs() <= 1e-13 * volume(&mesh));
    }
    for v in mesh.vertices() {
        let around: Vec<DVec3> =
            mesh.vertex_faces(v).filter_map(|f| mesh.plane(f)).map(|p| p.normal()).collect();
        let ends: Vec<DVec3> =
            mesh.neighbours(v).map(|u| mesh.position(v).lerp(mesh.position(u), 0.2)).collect();
        let plane = crate::geom::Plane::through_mean(&ends, &around).expect("a plane");
        // A given plane takes the long way.
        let [mut short, mut long] = [(); 2].map(|()| CutChain::new(mesh.clone()));
        short.cut(&plane, Reach::Local(&[v]));
        long.cut_given(plane.normal(), plane.point(), Reach::Local(&[v])).expect("a plane");
        let (short, long) = (short.finish(), long.finish());
        assert_sound(&short);
        assert_eq!(counts(&short), counts(&long));
        assert!((volume(&short) - volume(&long)).abs() <= 1e-13 * volume(&mesh));
    }
}

#[test]
fn disjoint_cuts_shrink_only_what_meets() {
    let context = OpContext::default();
    for offset in [0.25, 0.5, 0.75, 1.0, 1.5] {
        for (mesh, v) in [
            (cube(), 8),
            (crate::shape::dodecahedron(10.0), 20),
            (crate::shape::octahedron(10.0), 6),
        ] {
            let params = TruncateVertexParams {
                disjoint: Disjoint::Yes,
                ..TruncateVertexParams::new(all(), offset)
            };
            let (cut, report) = truncate_vertices(&mesh, &params, &context).expect("a cut");
            assert_sound(&cut);
            assert_eq!(
                counts(&cut),
                (2 * mesh.edge_count(), 3 * mesh.edge_count(), v + mesh.face_count())
            );
            assert!(report.overcut.is_empty() && report.not_three_valent.is_empty());
            assert_eq!(report.shrunk.is_empty(), offset < 0.5);
            assert!(report.shrunk.iter().all(|s| s.offset < 0.5 && s.offset > 0.3));
        }
    }
    // One short edge above and below: only the vertices at its ends give way.
    let mesh = prism(&[(0., 0.), (10., 0.), (10., 10.), (0.5, 10.), (0., 9.5)], 10.0);
    let params =
        TruncateVertexParams { disjoint: Disjoint::Yes, ..TruncateVertexParams::new(all(), 0.3) };
    let (cut, report) = truncate_vertices(&mesh, &params, &context).expect("a cut");
    assert_eq!(counts(&cut), (30, 45, 17));
    let shrunk: Vec<usize> = report.shrunk.iter().map(|s| s.element).collect();
    assert_eq!(shrunk, [3, 4, 8, 9]);
}

#[test]
fn the_plane_of_the_paper_is_kept_disjoint_on_the_cube() {
    // At t = 1/3 neighbouring planes meet from the third round on.
    let free = TruncateVertexParams { repeat: 3, ..TruncateVertexParams::new(all(), 1.0 / 3.0) };
    let (_, report) = truncate_vertices(&cube(), &free, &OpContext::default()).expect("a cut");
    assert!(!report.overcut.is_empty());
    let (mesh, report) = truncate_vertices(
        &cube(),
        &TruncateVertexParams { disjoint: Disjoint::Yes, ..free },
        &OpContext::default(),
    )
    .expect("a cut");
    assert_sound(&mesh);
    assert_eq!(mesh.vertex_count(), 8 * 27);
    assert!(
        report.overcut.is_empty()
            && report.not_three_valent.is_empty()
            && !report.shrunk.is_empty()
    );
}

#[test]
fn cuts_that_share_vertices_cannot_be_disjoint() {
    let params =
        TruncateEdgeParams { disjoint: Disjoint::Yes, ..TruncateEdgeParams::new(all(), 0.25) };
    let error = truncate_edges(&cube(), &params, &OpContext::default()).expect_err("edges meet");
    assert!(matches!(&error, OpError::NotDisjoint { elements } if elements.len() == 12), "{error}");
    // A matching of the cube: four parallel edges.
    let select = "along=z".parse().expect("a selection");
    let params =
        TruncateEdgeParams { disjoint: Disjoint::Yes, ..TruncateEdgeParams::new(select, 0.75) };
    let (mesh, report) = truncate_edges(&cube(), &params, &OpContext::default()).expect("a cut");
    assert_eq!((counts(&mesh), report.shrunk.len()), ((16, 24, 10), 4));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Planes through vertices, along edges, in faces, and a few ulps off: both halves sound,
    /// volume conserved.
    #[test]
    fn planes_aimed_at_vertices_and_edges(
        which in 0_usize..3, i in any::<prop::sample::Index>(), j in any::<prop::sample::Index>(), k in any::<prop::sample::Index>(), ulps in -3_i32..=3,
    ) {
        let mesh = match which {
            0 => prism(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)], 1.0),
            1 => frame(),
            _ => prism(&[(0., 0.), (6., 0.), (6., 4.), (5., 4.), (5., 1.), (3., 3.), (1., 1.), (1., 4.), (0., 4.)], 2.0),
        };
        let points: Vec<DVec3> = mesh.vertices().map(|v| mesh.position(v)).collect();
        let (a, b, c) = (*i.get(&points), *j.get(&points), *k.get(&points));
        let normal = (b - a).cross(c - a);
        prop_assume!(normal != DVec3::ZERO);
        let mut point = a;
        for _ in 0..ulps.abs() {
            point.x = if ulps > 0 { point.x.next_up() } else { point.x.next_down() };
        }
        halves(&mesh, normal, point);
    }
}
