//! The proof finds what is wrong: every test damages a good net in one place.

use glam::{DVec2, DVec3};

use super::*;
use crate::net::{FoldKind, PieceId};
use crate::progress::Silent;
use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};

/// An open box without lid and front: rims, seams and folds.
fn box_and_net() -> (Mesh, Net) {
    let corner =
        |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64 * 0.5) * 100.0;
    let faces = [vec![0, 2, 3, 1], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]];
    let mesh = Mesh::from_faces((0..8).map(corner), faces).expect("a box");
    let net =
        unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &MeshSource::default(), &Silent)
            .expect("a net");
    assert_eq!((net.pieces.len(), net.folds.len(), net.seams.len()), (1, 3, 2));
    (mesh, net)
}

fn fault_of(damage: impl Fn(&mut Net)) -> ProofError {
    let (mesh, mut net) = box_and_net();
    prove(&mesh, &net).expect("the net is good");
    damage(&mut net);
    prove(&mesh, &net).expect_err("the net is damaged")
}

fn edge_fault(error: ProofError) -> EdgeFault {
    match error {
        ProofError::Edge { fault, .. } => fault,
        other => panic!("{other}"),
    }
}

#[test]
fn structure() {
    assert!(matches!(
        fault_of(|net| net.counts.faces = 5),
        ProofError::Counts { what: "faces", net: 5, mesh: 4 }
    ));
    let missing = edge_fault(fault_of(|net| net.rims.truncate(2)));
    assert!(matches!(missing, EdgeFault::Missing { .. }), "{missing}");
    let gone = fault_of(|net| net.seams.truncate(1));
    assert!(gone.to_string().contains("neither fold nor seam nor rim"), "{gone}");
    let fault = fault_of(|net| {
        let twice = net.pieces[0].faces[0].clone();
        net.pieces[0].faces.push(twice);
    });
    assert!(matches!(fault, ProofError::FaceTimes { times: 2, .. }));
    assert!(matches!(
        fault_of(|net| net.pieces[0].faces.truncate(3)),
        ProofError::FaceTimes { times: 0, .. }
    ));
    assert!(matches!(
        fault_of(|net| net.pieces[0].faces[1].vertices.swap(0, 1)),
        ProofError::Corners { .. }
    ));
    let mirrored =
        fault_of(|net| net.pieces[0].faces[1].polygon.iter_mut().for_each(|p| p.x = -p.x));
    assert!(matches!(mirrored, ProofError::Mirrored { piece: 1, whole: false, .. }));
    let turned_over = fault_of(|net| points(net).into_iter().for_each(|p| p.x = -p.x));
    assert!(
        matches!(turned_over, ProofError::Mirrored { whole: true, area, .. } if area < 0.0),
        "{turned_over}"
    );
    assert!(matches!(
        fault_of(|net| net.pieces[0].outline[2].x += 1e-3),
        ProofError::Outline { piece: 1, .. }
    ));
    assert!(matches!(
        fault_of(|net| net.pieces[0].outline.truncate(5)),
        ProofError::Outline { .. }
    ));
    assert!(matches!(
        fault_of(|net| net.rims[0].edge = [0, 7]),
        ProofError::NetRim { edge: [0, 7], .. }
    ));
}

#[test]
fn edges() {
    assert_eq!(edge_fault(fault_of(|net| net.folds[1].id = net.folds[0].id)), EdgeFault::Times);
    assert_eq!(edge_fault(fault_of(|net| net.folds[1].id.0 = 999)), EdgeFault::Unknown);
    assert_eq!(edge_fault(fault_of(|net| net.folds[1].faces.reverse())), EdgeFault::Neighbours);
    assert_eq!(
        edge_fault(fault_of(|net| net.seams[1].sides[0].piece = PieceId(7))),
        EdgeFault::Piece
    );
    let moved =
        edge_fault(fault_of(|net| net.folds[0].segment.iter_mut().for_each(|p| p.x += 0.25)));
    assert!(matches!(moved, EdgeFault::Segment { by, .. } if (by - 0.25).abs() < 1e-12), "{moved}");
    let turned = edge_fault(fault_of(|net| net.folds[0].segment.swap(0, 1)));
    assert!(matches!(turned, EdgeFault::Segment { by, .. } if by > 10.0), "{turned}");
}

#[test]
fn distances_and_angles() {
    let stretched = fault_of(|net| scale(net, 1.0 + 1e-7));
    assert!(matches!(stretched, ProofError::Partners { .. }), "{stretched}");
    let longer = fault_of(|net| net.seams[0].length += 1e-6);
    assert!(matches!(longer, ProofError::Partners { .. }));
    let bent = fault_of(|net| net.folds[0].fold_angle += 1e-3);
    assert!(matches!(bent, ProofError::Refold { .. }));
    let valley = fault_of(|net| net.folds[2].fold_angle *= -1.0);
    assert!(matches!(valley, ProofError::Refold { .. }));
    assert!(matches!(
        fault_of(|net| net.folds[0].fold_angle = f64::NAN),
        ProofError::Refold { .. }
    ));
}

#[test]
fn angles_of_seams_and_names_of_folds() {
    let bent = edge_fault(fault_of(|net| net.seams[0].fold_angle += 1e-3));
    assert!(matches!(bent, EdgeFault::Angle { .. }), "{bent}");
    let turned = edge_fault(fault_of(|net| net.seams[1].fold_angle *= -1.0));
    assert!(matches!(turned, EdgeFault::Angle { .. }), "{turned}");
    let none = edge_fault(fault_of(|net| net.seams[0].fold_angle = f64::NAN));
    assert!(matches!(none, EdgeFault::Angle { .. }), "{none}");
    for kind in [FoldKind::Flat, FoldKind::Mountain, FoldKind::Valley] {
        let (mesh, mut net) = box_and_net();
        if net.folds[0].kind != kind {
            net.folds[0].kind = kind;
            let fault = edge_fault(prove(&mesh, &net).expect_err("named wrongly"));
            assert!(matches!(fault, EdgeFault::Kind { .. }), "{fault}");
        }
    }
}

fn points(net: &mut Net) -> Vec<&mut DVec2> {
    let Net { pieces, folds, seams, rims, .. } = net;
    let of_pieces = pieces.iter_mut().flat_map(|p| {
        let faces = p.faces.iter_mut().flat_map(|f| f.polygon.iter_mut());
        p.outline.iter_mut().chain(p.holes.iter_mut().flatten()).chain(faces).collect::<Vec<_>>()
    });
    let of_edges = folds.iter_mut().flat_map(|f| f.segment.iter_mut());
    let of_seams =
        seams.iter_mut().flat_map(|s| s.sides.iter_mut().flat_map(|s| s.segment.iter_mut()));
    of_pieces
        .chain(of_edges)
        .chain(of_seams)
        .chain(rims.iter_mut().flat_map(|r| r.segment.iter_mut()))
        .collect()
}

fn scale(net: &mut Net, factor: f64) {
    points(net).into_iter().for_each(|p| *p *= factor);
}

#[test]
fn one_face_on_top_of_another() {
    // A band of three squares whose last is said to lie on the first: two pieces pushed into one
    // frame.
    let points = (0..8).map(|i| DVec3::new((i / 2) as f64, (i % 2) as f64, (i / 2 % 2) as f64));
    let mesh = Mesh::from_faces(points, (0..3).map(|i| [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]))
        .expect("a band");
    let faces =
        UnfoldParams { pieces: crate::unfold::PiecesMode::Faces, ..UnfoldParams::default() };
    let mut net =
        unfold(&mesh, &Seams::Free, &faces, &MeshSource::default(), &Silent).expect("three pieces");
    let moved = net.pieces.remove(2);
    net.pieces[0].faces.extend(moved.faces);
    assert_eq!(
        overlap::check(&net, 1.0).expect_err("an overlap"),
        ProofError::Overlap { piece: 1, faces: [0, 2], pairs: 1 }
    );
    assert!(matches!(
        refold::check(&mesh, &net, 1.0).expect_err("loose"),
        ProofError::Loose { piece: 1, face: 2 }
    ));
}
