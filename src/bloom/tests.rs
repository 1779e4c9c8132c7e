use glam::{DVec2, DVec3};

use super::*;
use crate::mesh::{FaceId, Mesh, assert_sound};
use crate::net::Net;
use crate::progress::Silent;
use crate::shape::{SolidParams, solid};
use crate::unfold::{MeshSource, PiecesMode, Seams, UnfoldParams, unfold};

fn model(name: &str) -> Mesh {
    let name = name.parse().expect("a known solid");
    solid(&SolidParams { name, edge: None, size: None }).expect("a solid")
}

fn net_of(mesh: &Mesh, pieces: PiecesMode) -> Net {
    let source = MeshSource { scale: 1.0, split_vertices: &[] };
    let params = UnfoldParams { pieces, ..UnfoldParams::default() };
    unfold(mesh, &Seams::Free, &params, &source, &Silent).expect("a solid unfolds")
}

fn corners(mesh: &Mesh) -> impl Fn(usize) -> Option<Vec<DVec3>> {
    |face| Some(mesh.face_positions(FaceId::new(face)))
}

/// The largest distance between a corner in its pose and on the mesh.
fn off(tree: &FoldTree<'_>, poses: &[Pose], mesh: &Mesh) -> f64 {
    let mut worst: f64 = 0.0;
    for (leaf, pose) in tree.leaves().iter().zip(poses) {
        let face = tree.flat(leaf);
        for (&p, q) in face.polygon.iter().zip(mesh.face_positions(FaceId::new(face.face))) {
            worst = worst.max(pose.lift(p).distance(q));
        }
    }
    worst
}

#[test]
fn at_the_end_every_corner_is_at_its_vertex() {
    for (name, pieces) in [
        ("cube", PiecesMode::One),
        ("snub-cube", PiecesMode::One),
        ("soccer-ball", PiecesMode::Count(3)),
        ("prism-9", PiecesMode::Faces),
    ] {
        let mesh = model(name);
        let net = net_of(&mesh, pieces);
        let bloom = Bloom::new(&net, &[], corners(&mesh));
        assert!(off(bloom.tree(), &bloom.at(END), &mesh) < 1e-10 * 100.0, "{name}");
        assert!(off(bloom.tree(), &bloom.at(0.0), &mesh) > 1.0, "{name}");
        // Twice the same.
        assert_eq!(bloom.at(2.0), Bloom::new(&net, &[], corners(&mesh)).at(2.0));
    }
}

#[test]
fn at_the_beginning_every_piece_lies_where_it_was_put_with_its_outside_up() {
    let mesh = model("dodecahedron");
    let net = net_of(&mesh, PiecesMode::Count(2));
    let places =
        [FlatPlace { piece: net.pieces[0].id, rotation: 0.5, shift: DVec2::new(300.0, 20.0) }];
    let bloom = Bloom::new(&net, &places, corners(&mesh));
    let poses = bloom.at(0.0);
    let placed: Vec<Vec<DVec2>> = bloom
        .tree()
        .leaves()
        .iter()
        .zip(&poses)
        .map(|(leaf, pose)| {
            assert!((pose.rotation * DVec3::Z).distance(DVec3::Z) < 1e-12);
            bloom.tree().flat(leaf).polygon.iter().map(|&p| pose.lift(p).truncate()).collect()
        })
        .collect();
    // The piece that nothing was said about lies beside the other.
    let boxes: Vec<_> = placed.iter().filter_map(crate::geom::polygon::bounds).collect();
    for (a, la) in boxes.iter().zip(bloom.tree().leaves()) {
        for (b, lb) in boxes.iter().zip(bloom.tree().leaves()) {
            assert!(la.piece == lb.piece || a.1.x < b.0.x || b.1.x < a.0.x);
        }
    }
    let turned = bloom.flat().iter().zip(bloom.tree().leaves()).filter(|(_, l)| l.piece == 0);
    for (pose, _) in turned {
        assert!((pose.rotation * DVec3::X).truncate().distance(DVec2::from_angle(0.5)) < 1e-12);
    }
}

#[test]
fn without_a_model_the_seams_say_where_pieces_go() {
    let mesh = model("truncated-octahedron");
    let net = net_of(&mesh, PiecesMode::Count(3));
    let bloom = Bloom::new(&net, &[], |_| None);
    let poses = bloom.at(END);
    let state = state_mesh(bloom.tree(), &poses, |_| true, &["all".to_owned()], |_| Some(0))
        .expect("a closed model");
    assert_sound(&state);
    assert!(state.is_closed());
    assert_eq!(
        (state.vertex_count(), state.face_count()),
        (mesh.vertex_count(), mesh.face_count())
    );
    // The same shape: all distances between corners of the mean positions are those of the model.
    let (volume, expected) = (crate::measure::volume(&state), crate::measure::volume(&mesh));
    assert!((volume - expected).abs() < 1e-9 * expected.abs(), "{volume} {expected}");
}

#[test]
fn a_flat_state_is_a_mesh_with_rims_where_seams_are_open() {
    let mesh = model("cube");
    let net = net_of(&mesh, PiecesMode::One);
    let tree = FoldTree::new(&net, &[]);
    let poses = tree.poses(|_| Pose::IDENTITY, |_, _| 0.0);
    let state = state_mesh(
        &tree,
        &poses,
        |_| false,
        &["near".to_owned()],
        |leaf| (leaf.depth < 2).then_some(0),
    )
    .expect("a mesh");
    assert_sound(&state);
    assert!(!state.is_closed() && state.face_count() < 6);
    assert!(state_mesh(&tree, &poses, |_| false, &[], |_| None).is_err());
}

#[test]
fn the_way_between_two_faces_is_all_the_hinges_between_them() {
    let mesh = model("dodecahedron");
    let net = net_of(&mesh, PiecesMode::One);
    let tree = FoldTree::new(&net, &[]);
    for seam in &net.seams {
        let [a, b] =
            [0, 1].map(|k| tree.place_of(seam.sides[k].face).expect("all faces are in the tree"));
        let way = tree.way(a, b).expect("one tree");
        // Closed along the way alone, the two sides of the seam meet.
        let poses = tree.poses(|_| Pose::IDENTITY, |i, _| if way.contains(&i) { 1.0 } else { 0.2 });
        for end in [0, 1] {
            let [p, q] =
                [(a, 0), (b, 1)].map(|(leaf, k)| poses[leaf].lift(seam.sides[k].segment[end]));
            assert!(p.distance(q) < 1e-9, "{p} {q}");
        }
    }
    let two = net_of(&mesh, PiecesMode::Count(2));
    let tree = FoldTree::new(&two, &[]);
    let roots: Vec<usize> = (0..12).filter(|&i| tree.leaves()[i].hinge.is_none()).collect();
    assert_eq!(tree.way(roots[0], roots[1]), None);
}
