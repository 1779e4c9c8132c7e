//! Unfolding small solids whose nets are known.

mod hard;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::*;
use crate::mesh::{EdgeId, FaceId, MeshBuilder};
use crate::net::{FoldKind, Net};
use crate::progress::Silent;

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn cube(size: f64, at: DVec3) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let corner =
        |i: usize| at + DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * size;
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), faces.map(Vec::from).to_vec())
}

fn build((points, faces): (Vec<DVec3>, Vec<Vec<usize>>)) -> Mesh {
    Mesh::from_faces(points, faces).expect("a sound mesh")
}

fn tetrahedron() -> Mesh {
    let points = [at(1., 1., 1.), at(1., -1., -1.), at(-1., 1., -1.), at(-1., -1., 1.)];
    build((points.to_vec(), vec![vec![0, 1, 2], vec![0, 2, 3], vec![0, 3, 1], vec![1, 3, 2]]))
}

/// A prism over a flat polygon, counter-clockwise, from z = 0 to 1.
fn prism(corners: &[(f64, f64)]) -> Mesh {
    let n = corners.len();
    let level = |z: f64| corners.iter().map(move |&(x, y)| at(x, y, z));
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    build((level(0.0).chain(level(1.0)).collect(), faces))
}

/// A ring of `around` × `across` quads; they are planar since it is a surface of revolution.
fn torus(around: usize, across: usize) -> Mesh {
    let point = |i: usize, j: usize| {
        let (u, v) = (i as f64 * TAU / around as f64, j as f64 * TAU / across as f64);
        let r = 3.0 + v.cos();
        at(r * u.cos(), r * u.sin(), v.sin())
    };
    let id = |i: usize, j: usize| i % around * across + j % across;
    let points = (0..around * across).map(|k| point(k / across, k % across)).collect();
    let cells = (0..around * across).map(|k| (k / across, k % across));
    build((
        points,
        cells.map(|(i, j)| vec![id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)]).collect(),
    ))
}

/// The dodecahedron: a cube's corners and three golden rectangles, faces found as the corners
/// farthest along a direction.
fn dodecahedron() -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let signs = [1.0, -1.0];
    let pairs = || signs.into_iter().flat_map(move |a| signs.map(|b| (a, b)));
    let mut points: Vec<DVec3> = pairs().flat_map(|(a, b)| signs.map(|c| at(a, b, c))).collect();
    let cyclic = |x: f64, y: f64| [at(0., x, y), at(x, y, 0.), at(y, 0., x)];
    points.extend(pairs().flat_map(|(a, b)| cyclic(a / g, b * g)));
    let normals = pairs().flat_map(|(a, b)| cyclic(a * g, b));
    let face = |normal: DVec3| {
        let most = points.iter().map(|p| p.dot(normal)).fold(f64::MIN, f64::max);
        let mut corners: Vec<usize> =
            (0..20).filter(|&i| points[i].dot(normal) > most - 1e-9).collect();
        let x = normal.any_orthogonal_vector().normalize();
        let y = normal.normalize().cross(x);
        corners.sort_by(|&a, &b| {
            let angle = |i: usize| points[i].dot(y).atan2(points[i].dot(x));
            angle(a).total_cmp(&angle(b))
        });
        corners
    };
    let faces = normals.map(face).collect();
    build((points, faces))
}

fn params(pieces: PiecesMode) -> UnfoldParams {
    UnfoldParams { pieces, ..UnfoldParams::default() }
}

fn try_unfold(mesh: &Mesh, seams: &Seams, pieces: PiecesMode) -> Result<Net, UnfoldError> {
    unfold(mesh, seams, &params(pieces), &MeshSource::default(), &Silent)
}

/// Unfolds, and checks what every net promises beyond its proof.
fn net(mesh: &Mesh, seams: &Seams, pieces: PiecesMode) -> Net {
    let net = try_unfold(mesh, seams, pieces).expect("a net");
    let size = crate::measure::size(mesh).length();
    assert!(net.proof.congruence_mm <= 1e-12 * size, "{:?}", net.proof);
    assert!(net.proof.refold_mm <= 1e-11 * size, "{:?}", net.proof);
    assert_eq!(net.folds.len() + net.seams.len() + net.rims.len(), mesh.edge_count());
    for seam in &net.seams {
        let [a, b] = [0, 1].map(|i| seam.sides[i].segment[0].distance(seam.sides[i].segment[1]));
        assert!((a - b).abs() <= 1e-9 * seam.length, "{}: {a} and {b}", seam.id);
    }
    for (i, piece) in net.pieces.iter().enumerate() {
        assert_eq!(piece.id.0, i);
        let sides: usize = piece.holes.iter().map(Vec::len).sum::<usize>() + piece.outline.len();
        let listed =
            net.seams.iter().flat_map(|s| &s.sides).filter(|s| s.piece == piece.id).count()
                + net.rims.iter().filter(|r| r.piece == piece.id).count();
        assert_eq!(sides, listed);
    }
    net
}

fn free(mesh: &Mesh) -> Net {
    net(mesh, &Seams::Free, PiecesMode::One)
}

fn edges(mesh: &Mesh, ends: &[[usize; 2]]) -> Vec<EdgeId> {
    let vertex = crate::mesh::VertexId::new;
    ends.iter().map(|&[a, b]| mesh.edge_between(vertex(a), vertex(b)).expect("an edge")).collect()
}

#[test]
fn platonic_solids_come_apart_in_one_piece() {
    for (mesh, fold, faces) in [
        (tetrahedron(), PI - (1.0 / 3.0_f64).acos(), 4),
        (build(cube(40.0, DVec3::ZERO)), PI / 2.0, 6),
        (dodecahedron(), PI - (-1.0 / 5f64.sqrt()).acos(), 12),
    ] {
        let net = free(&mesh);
        assert_eq!((net.pieces.len(), net.folds.len()), (1, faces - 1));
        assert_eq!(net.pieces[0].outline.len(), 2 * net.seams.len());
        assert!(net.folds.iter().all(
            |f| f.kind == FoldKind::Mountain && (f.fold_angle - fold.to_degrees()).abs() < 1e-9
        ));
        let low = net.pieces[0].outline.iter().fold(glam::DVec2::INFINITY, |low, &p| low.min(p));
        assert_eq!(low, glam::DVec2::ZERO);
    }
}

#[test]
fn far_away_and_tiny_and_huge_are_the_same() {
    for (size, place) in [(1e-3, DVec3::ZERO), (1e5, DVec3::ZERO), (1.0, at(1e5, -1e5, 3e4))] {
        let mesh = build(cube(size, place));
        let net = try_unfold(&mesh, &Seams::Free, PiecesMode::One).expect("a net");
        assert_eq!((net.pieces.len(), net.folds.len()), (1, 5));
    }
}

#[test]
fn rims_are_cuts() {
    let (points, mut faces) = cube(1.0, DVec3::ZERO);
    faces.pop();
    let net = free(&build((points, faces)));
    assert_eq!((net.pieces.len(), net.folds.len(), net.seams.len(), net.rims.len()), (1, 4, 4, 4));
}

#[test]
fn a_flat_sheet_stays_whole_and_a_flat_frame_has_a_hole() {
    let id = |x: usize, y: usize| y * 4 + x;
    let points: Vec<DVec3> = (0..16).map(|i| at((i % 4) as f64, (i / 4) as f64, 0.0)).collect();
    let cell = |x: usize, y: usize| vec![id(x, y), id(x + 1, y), id(x + 1, y + 1), id(x, y + 1)];
    let mut faces: Vec<Vec<usize>> = (0..9).map(|i| cell(i % 3, i / 3)).collect();
    let sheet = free(&build((points.clone(), faces.clone())));
    assert_eq!((sheet.folds.len(), sheet.seams.len(), sheet.pieces[0].holes.len()), (12, 0, 0));
    assert!(sheet.folds.iter().all(|f| f.kind == FoldKind::Flat));
    faces.remove(4);
    let frame = free(&build((points, faces)));
    assert_eq!((frame.folds.len(), frame.seams.len(), frame.pieces[0].holes.len()), (8, 0, 1));
    assert_eq!(crate::geom::polygon::signed_area(&frame.pieces[0].holes[0]), -1.0);
}

#[test]
fn components_come_apart_by_themselves() {
    let (mut points, mut faces) = cube(1.0, DVec3::ZERO);
    let (more, others) = cube(1.0, at(0.2, 0.2, 0.2));
    points.extend(more);
    faces.extend(others.iter().map(|f| f.iter().map(|v| v + 8).collect()));
    let mesh = build((points, faces));
    assert_eq!(free(&mesh).pieces.len(), 2);
    let error = try_unfold(&mesh, &Seams::Free, PiecesMode::Count(1)).expect_err("two components");
    assert!(
        matches!(error, UnfoldError::MorePieces { asked: 1, found: 2, components: 2, .. }),
        "{error}"
    );
}

#[test]
fn concave_faces_and_valleys() {
    let ell = prism(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)]);
    let net = free(&ell);
    assert_eq!(net.pieces.len(), 1);
    let valley: Vec<_> =
        net.folds.iter().filter(|f| f.kind == FoldKind::Valley).map(|f| f.fold_angle).collect();
    let open: Vec<_> =
        net.seams.iter().filter(|s| s.fold_angle < 0.0).map(|s| s.fold_angle).collect();
    assert_eq!(valley.len() + open.len(), 1);
    assert!((valley.iter().chain(&open).sum::<f64>() + 90.0).abs() < 1e-9);
    // A comb whose teeth are too narrow for what folds out between them.
    let comb = prism(&[
        (0., 0.),
        (5., 0.),
        (5., 3.),
        (4., 3.),
        (4., 1.),
        (3., 1.),
        (3., 3.),
        (2., 3.),
        (2., 1.),
        (1., 1.),
        (1., 3.),
        (0., 3.),
    ]);
    free(&comb);
}

#[test]
fn a_torus_opens_both_ways_around() {
    let mesh = torus(12, 7);
    let bent = net(&mesh, &Seams::Free, PiecesMode::One);
    assert_eq!(bent.folds.len(), 84 - 1);
    // With eight sides the vertices on top and at the bottom are flat though their faces are not:
    // rings close around some.
    let mesh = torus(12, 8);
    let flat = net(&mesh, &Seams::Free, PiecesMode::One);
    assert!(flat.folds.len() > 96 - 1);
}

#[test]
fn given_seams_open_and_a_ring_opens_once_more() {
    let mesh = build(cube(1.0, DVec3::ZERO));
    // Around the bottom and around the top: two squares and a ring of four.
    let lids = edges(&mesh, &[[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4]]);
    let ring = net(&mesh, &Seams::Open(lids), PiecesMode::Auto);
    assert_eq!(ring.pieces.iter().map(|p| p.faces.len()).collect::<Vec<_>>(), [4, 1, 1]);
    assert_eq!((ring.folds.len(), ring.seams.len()), (3, 9));
    let folds = edges(&mesh, &[[0, 4], [1, 5], [3, 7], [2, 6]]);
    let same = net(&mesh, &Seams::Folds(folds), PiecesMode::Auto);
    assert_eq!((same.pieces.len(), same.folds.len()), (3, 3));
    // A Hamiltonian seam: two pieces of three squares, nothing more opens.
    let cycle = edges(&mesh, &[[0, 1], [1, 3], [3, 2], [2, 6], [6, 7], [7, 5], [5, 4], [4, 0]]);
    let halves = net(&mesh, &Seams::Open(cycle.clone()), PiecesMode::Auto);
    assert_eq!((halves.pieces.len(), halves.folds.len(), halves.seams.len()), (2, 4, 8));
    assert!(halves.seams.iter().map(|s| s.id.0).eq(sorted(&cycle)));
}

fn sorted(edges: &[EdgeId]) -> Vec<usize> {
    let mut edges: Vec<usize> = edges.iter().map(|e| e.index()).collect();
    edges.sort_unstable();
    edges
}

#[test]
fn the_ring_opens_at_its_least_fold_but_not_across_a_plane() {
    // Six sides of a flat hexagon, one of them halved: 0° there, 40° and 80° at the others; the
    // lids are seams.
    let corners = [(0., 0.), (2., 0.), (4., 0.), (5., 1.), (4., 2.), (0., 2.)];
    let mesh = prism(&corners);
    let lids: Vec<EdgeId> = mesh
        .edges()
        .filter(|&e| {
            mesh.edge_faces(e).iter().any(|f| *f == FaceId::new(0) || *f == FaceId::new(1))
        })
        .collect();
    let net = net(&mesh, &Seams::Open(lids.clone()), PiecesMode::Auto);
    let more: Vec<_> = net.seams.iter().filter(|s| !lids.contains(&EdgeId::new(s.id.0))).collect();
    assert_eq!(more.len(), 1);
    assert!((more[0].fold_angle - 45.0).abs() < 1e-9);
    assert_eq!(net.folds.iter().filter(|f| f.kind == FoldKind::Flat).count(), 1);
}

#[test]
fn strips_faces_and_counts() {
    let mesh = dodecahedron();
    let faces = net(&mesh, &Seams::Free, PiecesMode::Faces);
    assert_eq!((faces.pieces.len(), faces.folds.len()), (12, 0));
    assert!(faces.pieces.iter().enumerate().all(|(i, p)| p.faces[0].face == i));
    let strips = net(&mesh, &Seams::Free, PiecesMode::Strips);
    for f in 0..12 {
        assert!(strips.folds.iter().filter(|fold| fold.faces.contains(&f)).count() <= 2);
    }
    let four = net(&mesh, &Seams::Free, PiecesMode::Count(4));
    assert_eq!(four.pieces.len(), 4);
    let error = try_unfold(&mesh, &Seams::Free, PiecesMode::Count(13)).expect_err("12 faces");
    assert_eq!(error, UnfoldError::TooManyPieces { asked: 13, faces: 12 });
}

#[test]
fn given_folds_that_overlap_are_opened() {
    // A staircase of a screw: 20 wedges around an axis, more than a full turn once they lie flat.
    let n = 20;
    let mut builder = MeshBuilder::new();
    for i in 0..=n {
        let (y, x) = (f64::from(i) * 0.7).sin_cos();
        builder.vertex(at(0.05 * x, 0.05 * y, f64::from(i) * 0.01));
        builder.vertex(at(x, y, f64::from(i) * 0.01));
    }
    for i in 0..n as usize {
        builder.face([2 * i, 2 * i + 1, 2 * i + 3]);
        builder.face([2 * i, 2 * i + 3, 2 * i + 2]);
    }
    let (mesh, _) = builder.build().expect("a screw");
    let net = net(&mesh, &Seams::Free, PiecesMode::Auto);
    assert_eq!(net.pieces.len(), 3, "a full turn and a bit takes 2.2 turns' worth of pieces");
    assert_eq!(net.folds.len(), 2 * n as usize - 3);
}

/// A square plate with a square hole, all of triangles.
fn plate_with_hole() -> Mesh {
    let corner = |k: usize, by: f64| {
        let (x, y) = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)][k];
        (x * by, y * by)
    };
    let mut builder = MeshBuilder::new();
    for z in [0.0, 5.0] {
        for by in [30.0, 10.0] {
            for k in 0..4 {
                let (x, y) = corner(k, by);
                builder.vertex(at(x, y, z));
            }
        }
    }
    // Outer and inner corners of the bottom, then of the top.
    let name = |layer: usize, ring: usize, k: usize| 8 * layer + 4 * ring + k % 4;
    for k in 0..4 {
        let quad = |corners: [[usize; 3]; 4]| corners.map(|[l, r, k]| name(l, r, k));
        let quads = [
            quad([[1, 0, k], [1, 0, k + 1], [1, 1, k + 1], [1, 1, k]]),
            quad([[0, 1, k], [0, 1, k + 1], [0, 0, k + 1], [0, 0, k]]),
            quad([[0, 0, k], [0, 0, k + 1], [1, 0, k + 1], [1, 0, k]]),
            quad([[1, 1, k], [1, 1, k + 1], [0, 1, k + 1], [0, 1, k]]),
        ];
        for [a, b, c, d] in quads {
            builder.face([a, b, c]);
            builder.face([a, c, d]);
        }
    }
    builder.build().expect("a plate").0
}

#[test]
fn flat_edges_are_opened_last() {
    let mesh = plate_with_hole();
    for seed in 0..6 {
        let params = UnfoldParams { seed, ..UnfoldParams::default() };
        let net =
            unfold(&mesh, &Seams::Free, &params, &MeshSource::default(), &Silent).expect("a net");
        let flat = net.seams.iter().filter(|s| s.fold_angle.abs() < 1e-6).count();
        assert_eq!(flat, 0, "seed {seed}");
        assert_eq!(net.folds.iter().filter(|f| f.kind == FoldKind::Flat).count(), 24);
    }
}

#[test]
fn faults_are_named() {
    let (mut points, faces) = cube(40.0, DVec3::ZERO);
    points[7].x += 1.0;
    let error = try_unfold(&build((points.clone(), faces.clone())), &Seams::Free, PiecesMode::Auto)
        .expect_err("bent");
    match error {
        UnfoldError::NotPlanar { face, breach, .. } => {
            assert_eq!((face, breach.limit), (5, 2.0));
            assert!((breach.measured - 4.4).abs() < 0.1, "{breach:?}");
        }
        other => panic!("{other}"),
    }
    // What `check` lets through unfolds, with sides that meet.
    points[7].x += 0.1 - 1.0;
    let net = try_unfold(&build((points.clone(), faces.clone())), &Seams::Free, PiecesMode::One)
        .expect("planar to the profile");
    let ([first, second], mut worst) = ([0, 1], 0.0_f64);
    for seam in &net.seams {
        let lengths = [first, second]
            .map(|i: usize| seam.sides[i].segment[0].distance(seam.sides[i].segment[1]));
        worst = worst.max((lengths[0] - lengths[1]).abs());
    }
    assert!(worst < 1e-12, "{worst}");
    // What single precision does to a plane is let through, and the net still passes its proof.
    points[7].x += 1e-6 - 0.1;
    try_unfold(&build((points, faces)), &Seams::Free, PiecesMode::One).expect("nearly planar");
    let bow_tie = [at(0., 0., 0.), at(2., 2., 0.), at(2., 0., 0.), at(0., 1., 0.)];
    let mesh = build((bow_tie.to_vec(), vec![vec![0, 1, 2, 3]]));
    let error = try_unfold(&mesh, &Seams::Free, PiecesMode::Auto).expect_err("crossing");
    assert_eq!(error, UnfoldError::FaceNotSimple { face: 0 });
    let missing = Seams::Open(vec![EdgeId::new(99)]);
    let error = try_unfold(&tetrahedron(), &missing, PiecesMode::Auto).expect_err("no such edge");
    assert_eq!(error, UnfoldError::UnknownEdge { edge: 99, count: 6 });
    let error = try_unfold(&Mesh::new(), &Seams::Free, PiecesMode::Auto).expect_err("empty");
    assert_eq!(error, UnfoldError::NoFaces);
}

#[test]
fn split_vertices_go_by_their_number_in_the_file() {
    let (points, mut faces) = cube(1.0, DVec3::ZERO);
    let mut builder = MeshBuilder::new();
    for &p in &points {
        builder.vertex(p);
    }
    let far = [at(2., 1., 1.), at(1., 2., 1.), at(1., 1., 2.)].map(|p| builder.vertex(p));
    // A tetrahedron that touches the cube in corner 7 only.
    faces.extend([
        vec![7, far[1], far[0]],
        vec![7, far[0], far[2]],
        vec![7, far[2], far[1]],
        far.to_vec(),
    ]);
    for face in faces {
        builder.face(face);
    }
    let (mesh, split_vertices) = builder.build().expect("two solids at a point");
    assert_eq!(split_vertices.len(), 1);
    let source = MeshSource { scale: 25.4, split_vertices: &split_vertices };
    let net =
        unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &source, &Silent).expect("a net");
    assert_eq!((net.scale, net.counts.vertices, net.pieces.len()), (25.4, 11, 2));
    let flat = net.pieces[1].faces.iter().chain(&net.pieces[0].faces).flat_map(|f| &f.vertices);
    assert_eq!(flat.filter(|&&v| v == 7).count(), 6);
    assert!(
        net.seams
            .iter()
            .flat_map(|s| s.edge)
            .chain(net.folds.iter().flat_map(|f| f.edge))
            .all(|v| v < 11)
    );
}

/// A ball of triangles whose points lie nearer to or farther from the middle by chance.
fn rough_ball(seed: u64, around: usize, rings: usize) -> Mesh {
    let mut rng = Rng::new(seed);
    let mut radius = || 1.0 + 0.5 * rng.unit();
    let mut points = vec![at(0., 0., 1.0), at(0., 0., -1.0)];
    for k in 0..rings * around {
        let height = ((k / around + 1) as f64 * PI / (rings + 1) as f64).cos();
        points
            .push(start::unit_vector(height, (k % around) as f64 * TAU / around as f64) * radius());
    }
    let id = |ring: usize, i: usize| 2 + ring * around + i % around;
    let mut faces = Vec::new();
    for i in 0..around {
        faces.extend([
            vec![0, id(0, i), id(0, i + 1)],
            vec![1, id(rings - 1, i + 1), id(rings - 1, i)],
        ]);
        for ring in 1..rings {
            faces.push(vec![id(ring - 1, i), id(ring, i), id(ring, i + 1)]);
            faces.push(vec![id(ring - 1, i), id(ring, i + 1), id(ring - 1, i + 1)]);
        }
    }
    build((points, faces))
}

proptest::proptest! {
    #![proptest_config(proptest::test_runner::Config::with_cases(12))]

    #[test]
    fn rough_balls_come_apart_in_one_piece(seed: u64, around in 5..14_usize, rings in 2..9_usize) {
        let mesh = rough_ball(seed, around, rings);
        net(&mesh, &Seams::Free, PiecesMode::One);
    }

    #[test]
    fn without_effort_the_net_is_divided_but_still_valid(seed: u64) {
        let mesh = rough_ball(seed, 20, 12);
        let params = UnfoldParams { effort: 0, ..UnfoldParams::default() };
        let net = unfold(&mesh, &Seams::Free, &params, &MeshSource::default(), &Silent).expect("a net");
        assert_eq!(net.folds.len(), mesh.face_count() - net.pieces.len());
    }
}

#[test]
fn a_cancelled_search_still_returns_a_net() {
    struct Stopped;
    impl Progress for Stopped {
        fn report(&self, _: &str, _: usize, _: usize) {}
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let mesh = rough_ball(1, 20, 12);
    unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &MeshSource::default(), &Stopped)
        .expect("a net");
}

#[test]
fn the_same_seed_gives_the_same_net() {
    let mesh = torus(16, 10);
    let again = || {
        unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &MeshSource::default(), &Silent)
            .expect("a net")
    };
    assert_eq!(again(), again());
}

#[test]
fn long_chains_do_not_drift() {
    // A zigzag strip of 2000 rectangles of odd sizes; unfolded it is one long straight band.
    let n = 2000_usize;
    let mut builder = MeshBuilder::new();
    let (mut x, mut z, mut length) = (0.0, 0.0, 0.0);
    for i in 0..=n {
        builder.vertex(at(x, 0.0, z));
        builder.vertex(at(x, 3.3, z));
        let (step, angle) =
            (0.37 + 0.1 * (i as f64).sin(), if i % 2 == 0 { 1.1 } else { -0.7_f64 });
        (x, z) = (x + step * angle.cos(), z + step * angle.sin());
        length += if i < n { step } else { 0.0 };
    }
    for i in 0..n {
        builder.face([2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]);
    }
    let (mesh, _) = builder.build().expect("a strip");
    let net = try_unfold(&mesh, &Seams::Free, PiecesMode::One).expect("a net");
    let (low, high) = crate::geom::polygon::bounds(&net.pieces[0].outline).expect("corners");
    let mut extent = [high.x - low.x, high.y - low.y];
    extent.sort_by(f64::total_cmp);
    assert!((extent[0] - 3.3).abs() <= 1e-12 * length, "{extent:?}");
    assert!((extent[1] - length).abs() <= 1e-12 * length, "{extent:?} {length}");
}

fn polytope(n: usize, seed: u64) -> Mesh {
    crate::shape::random_tangent_polytope(n, seed)
}

#[test]
fn two_pieces_share_one_seam_through_every_vertex() {
    for seed in 0..3 {
        let mesh = polytope(60, seed);
        let net = net(&mesh, &Seams::Free, PiecesMode::Count(2));
        assert_eq!((net.pieces.len(), net.seams.len()), (2, mesh.vertex_count()));
        assert!(crate::seam::is_perfect_matching(&mesh, &folded(&net)));
    }
}

fn folded(net: &Net) -> Vec<EdgeId> {
    net.folds.iter().map(|f| EdgeId::new(f.id.0)).collect()
}

#[test]
fn strips_of_a_3_valent_mesh_fold_once_at_a_vertex() {
    let mesh = polytope(60, 1);
    let net = net(&mesh, &Seams::Free, PiecesMode::Strips);
    let mut met = vec![0; mesh.vertex_count()];
    net.folds.iter().flat_map(|f| f.edge).for_each(|v| met[v] += 1);
    assert!(met.iter().all(|&folds| folds <= 1));
}

#[test]
fn edges_to_keep_and_to_cut_are_obeyed_or_named() {
    let mesh = polytope(60, 2);
    let all: Vec<EdgeId> = mesh.edges().collect();
    let within = Seams::Within { keep: vec![all[0], all[40]], cut: vec![all[20], all[90]] };
    for pieces in [PiecesMode::One, PiecesMode::Auto] {
        let folds = folded(&net(&mesh, &within, pieces));
        assert!([0, 40].iter().all(|&i| folds.contains(&all[i])));
        assert!([20, 90].iter().all(|&i| !folds.contains(&all[i])));
    }
    let both = Seams::Within { keep: vec![all[3]], cut: vec![all[3]] };
    let error = try_unfold(&mesh, &both, PiecesMode::Auto).expect_err("kept and cut");
    assert_eq!(error, UnfoldError::KeptAndCut { edges: vec![3] });
    let around: Vec<EdgeId> =
        mesh.outgoing(crate::mesh::VertexId::new(0)).map(|h| h.edge()).collect();
    let ring = Seams::Within { keep: around.clone(), cut: Vec::new() };
    let error = try_unfold(&mesh, &ring, PiecesMode::Auto).expect_err("a cone point");
    assert!(matches!(&error, UnfoldError::NotKept { edges } if edges.len() == 1), "{error}");
}

#[test]
fn too_few_seams_name_the_vertices() {
    let mesh = build(cube(1.0, DVec3::ZERO));
    let lid = edges(&mesh, &[[0, 1], [1, 3], [3, 2], [2, 0]]);
    let error = check_seams(&mesh, &Seams::Open(lid)).expect_err("four corners");
    assert_eq!(error, UnfoldError::ConePoints { vertices: vec![4, 5, 6, 7] });
    check_seams(&mesh, &Seams::Folds(edges(&mesh, &[[0, 4]]))).expect("every corner has a seam");
}

/// The bar of the unfolder; all sizes and twenty seeds, which take minutes in the dev profile, with
/// KERFOLD_FULL=1.
#[test]
fn two_pieces_for_every_random_convex_mesh() {
    let is_full = std::env::var_os("KERFOLD_FULL").is_some();
    let (sizes, seeds) = if is_full { (&[100, 200, 500, 1000][..], 20) } else { (&[100][..], 3) };
    for &n in sizes {
        for seed in 0..seeds {
            assert_eq!(
                net(&polytope(n, seed), &Seams::Free, PiecesMode::Count(2)).pieces.len(),
                2,
                "{n} {seed}"
            );
        }
    }
}
