//! Is everything there exactly once, and where it says it is?

use std::collections::HashMap;

use glam::DVec2;

use super::{EdgeFault, ProofError};
use crate::mesh::{EdgeId, FaceId, Mesh, VertexId};
use crate::net::{FlatFace, Net, Piece, PieceId, Segment};

/// How far coordinates of one corner on two faces may lie apart, relative to the model's size.
const SAME_PLACE: f64 = 1e-9;

pub(super) fn check(mesh: &Mesh, net: &Net, size: f64) -> Result<(), ProofError> {
    check_counts(mesh, net)?;
    let faces = faces_once(mesh, net)?;
    let place = SAME_PLACE * size;
    check_edges(mesh, net, &faces, place)?;
    net.pieces.iter().try_for_each(|piece| check_outline(net, piece, &faces, place))
}

fn check_counts(mesh: &Mesh, net: &Net) -> Result<(), ProofError> {
    let counts = [
        ("faces", net.counts.faces, mesh.face_count()),
        ("edges", net.counts.edges, mesh.edge_count()),
    ];
    match counts.into_iter().find(|&(_, net, mesh)| net != mesh) {
        Some((what, net, mesh)) => Err(ProofError::Counts { what, net, mesh }),
        None => Ok(()),
    }
}

type Faces<'a> = HashMap<usize, (PieceId, &'a FlatFace)>;

/// Every face of the mesh in one piece, with its corners in order.
fn faces_once<'a>(mesh: &Mesh, net: &'a Net) -> Result<Faces<'a>, ProofError> {
    let mut faces = Faces::new();
    for piece in &net.pieces {
        for flat in &piece.faces {
            if faces.insert(flat.face, (piece.id, flat)).is_some() {
                return Err(ProofError::FaceTimes { face: flat.face, times: 2 });
            }
        }
    }
    for f in mesh.faces() {
        let face = f.index();
        let (piece, flat) = faces.get(&face).ok_or(ProofError::FaceTimes { face, times: 0 })?;
        let corners: Vec<VertexId> = mesh.face_vertices(f).collect();
        let same = |(&named, &v): (&usize, &VertexId)| is_vertex(mesh, named, v);
        if flat.vertices.len() != corners.len()
            || flat.polygon.len() != corners.len()
            || !flat.vertices.iter().zip(&corners).all(same)
        {
            return Err(ProofError::Corners { face });
        }
        let is_wrong = |area: f64| area <= 0.0 || area.is_nan();
        let area = doubled_area(&flat.polygon) / 2.0;
        if is_wrong(area) {
            let of_piece = net.pieces.iter().filter(|p| p.id == *piece).flat_map(|p| &p.faces);
            let whole = of_piece.clone().count() > 1
                && of_piece
                    .clone()
                    .all(|f| f.polygon.len() > 2 && is_wrong(doubled_area(&f.polygon)));
            return Err(ProofError::Mirrored { piece: piece.0 + 1, face, area, whole });
        }
    }
    if faces.len() == mesh.face_count() {
        return Ok(faces);
    }
    let strange = faces
        .keys()
        .copied()
        .filter(|&f| f >= mesh.face_slots() || !is_face(mesh, FaceId::new(f)))
        .min();
    Err(ProofError::FaceTimes { face: strange.unwrap_or(0), times: 1 })
}

pub(super) fn is_face(mesh: &Mesh, f: FaceId) -> bool {
    mesh.has_face(f) && !mesh.is_hole(f)
}

/// Whether `named` is `v`, or the file's vertex at the same point that `v` was split from.
pub(super) fn is_vertex(mesh: &Mesh, named: usize, v: VertexId) -> bool {
    named == v.index()
        || (named < mesh.vertex_slots()
            && mesh.has_vertex(VertexId::new(named))
            && mesh.position(VertexId::new(named)) == mesh.position(v))
}

fn doubled_area(polygon: &[DVec2]) -> f64 {
    (1..polygon.len() - 1)
        .map(|i| (polygon[i] - polygon[0]).perp_dot(polygon[i + 1] - polygon[0]))
        .sum()
}

/// One listed side of an edge: where, on which face of which piece.
struct Listed {
    ends: [usize; 2],
    piece: PieceId,
    face: usize,
    segment: Segment,
}

fn check_edges(mesh: &Mesh, net: &Net, faces: &Faces, place: f64) -> Result<(), ProofError> {
    let mut seen = vec![false; mesh.edge_slots()];
    for fold in &net.folds {
        let e = known(mesh, fold.id.0, fold.edge, &mut seen)?;
        check_faces(mesh, e, fold.edge, fold.faces)?;
        for face in fold.faces {
            let listed = Listed { ends: fold.edge, piece: fold.piece, face, segment: fold.segment };
            check_side(faces, e.index(), &listed, place)?;
        }
    }
    for seam in &net.seams {
        let e = known(mesh, seam.id.0, seam.edge, &mut seen)?;
        check_faces(mesh, e, seam.edge, [seam.sides[0].face, seam.sides[1].face])?;
        for side in &seam.sides {
            let listed = Listed {
                ends: seam.edge,
                piece: side.piece,
                face: side.face,
                segment: side.segment,
            };
            check_side(faces, e.index(), &listed, place)?;
        }
    }
    check_rims(mesh, net, faces, &mut seen, place)?;
    let Some(missing) = mesh.edges().find(|e| !seen[e.index()]) else { return Ok(()) };
    let fault = EdgeFault::Missing { faces: mesh.edge_faces(missing).map(FaceId::index) };
    Err(ProofError::Edge {
        edge: missing.index(),
        ends: mesh.edge_vertices(missing).map(VertexId::index),
        fault,
    })
}

fn known(
    mesh: &Mesh,
    edge: usize,
    ends: [usize; 2],
    seen: &mut [bool],
) -> Result<EdgeId, ProofError> {
    if edge >= mesh.edge_slots() || !mesh.has_edge(EdgeId::new(edge)) {
        return Err(ProofError::Edge { edge, ends, fault: EdgeFault::Unknown });
    }
    if std::mem::replace(&mut seen[edge], true) {
        return Err(ProofError::Edge { edge, ends, fault: EdgeFault::Times });
    }
    Ok(EdgeId::new(edge))
}

fn check_faces(
    mesh: &Mesh,
    e: EdgeId,
    ends: [usize; 2],
    named: [usize; 2],
) -> Result<(), ProofError> {
    let vertices = mesh.edge_vertices(e);
    let right_ends = (0..2).all(|i| is_vertex(mesh, ends[i], vertices[i]));
    if right_ends && mesh.edge_faces(e).map(FaceId::index) == named {
        return Ok(());
    }
    Err(ProofError::Edge { edge: e.index(), ends, fault: EdgeFault::Neighbours })
}

/// Rims carry no edge number: the edge is the one of the face that leads from one end to the other
/// beside a hole.
fn check_rims(
    mesh: &Mesh,
    net: &Net,
    faces: &Faces,
    seen: &mut [bool],
    place: f64,
) -> Result<(), ProofError> {
    for rim in &net.rims {
        let missing = ProofError::NetRim { edge: rim.edge, face: rim.face };
        if !faces.contains_key(&rim.face) {
            return Err(missing);
        }
        let is_rim = |e: &EdgeId| {
            let vertices = mesh.edge_vertices(*e);
            mesh.is_rim(*e)
                && !seen[e.index()]
                && (0..2).all(|i| is_vertex(mesh, rim.edge[i], vertices[i]))
        };
        let e = mesh
            .face_half_edges(FaceId::new(rim.face))
            .map(|h| h.edge())
            .find(is_rim)
            .ok_or(missing)?;
        seen[e.index()] = true;
        let listed =
            Listed { ends: rim.edge, piece: rim.piece, face: rim.face, segment: rim.segment };
        check_side(faces, e.index(), &listed, place)?;
    }
    Ok(())
}

/// Whether the face lies in the piece and has the segment as its side between the two ends.
fn check_side(faces: &Faces, edge: usize, listed: &Listed, place: f64) -> Result<(), ProofError> {
    let (piece, flat) = faces[&listed.face];
    if piece != listed.piece {
        return Err(ProofError::Edge { edge, ends: listed.ends, fault: EdgeFault::Piece });
    }
    let corner = |i: usize| flat.polygon[i % flat.polygon.len()];
    let name = |i: usize| flat.vertices[i % flat.vertices.len()];
    let [a, b] = listed.segment;
    let lies = |from: usize, to: usize| {
        a.distance(corner(from)) <= place && b.distance(corner(to)) <= place
    };
    let is_side = |i: usize| {
        ([name(i), name(i + 1)] == listed.ends && lies(i, i + 1))
            || ([name(i + 1), name(i)] == listed.ends && lies(i + 1, i))
    };
    if (0..flat.polygon.len()).any(is_side) {
        return Ok(());
    }
    let joins =
        |i: usize| [name(i), name(i + 1)] == listed.ends || [name(i + 1), name(i)] == listed.ends;
    let off = |i: usize| {
        let (from, to) = if name(i) == listed.ends[0] { (i, i + 1) } else { (i + 1, i) };
        a.distance(corner(from)).max(b.distance(corner(to)))
    };
    let by = (0..flat.polygon.len())
        .filter(|&i| joins(i))
        .map(off)
        .min_by(f64::total_cmp)
        .unwrap_or(f64::NAN);
    Err(ProofError::Edge {
        edge,
        ends: listed.ends,
        fault: EdgeFault::Segment { face: listed.face, by },
    })
}

/// Whether outline and holes consist of the sides that are no folds, each once, and the outline
/// runs around them all.
fn check_outline(net: &Net, piece: &Piece, faces: &Faces, place: f64) -> Result<(), ProofError> {
    let mut open = open_sides(net, piece, faces);
    open.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
    let mut used = vec![false; open.len()];
    let fault = |p: DVec2| ProofError::Outline { piece: piece.id.0 + 1, x: p.x, y: p.y };
    for corners in std::iter::once(&piece.outline).chain(&piece.holes) {
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let first = open.partition_point(|side| side[0].x < a.x - place);
            let near = (first..open.len()).take_while(|&k| open[k][0].x <= a.x + place);
            let lies =
                |k: &usize| open[*k][0].distance(a) <= place && open[*k][1].distance(b) <= place;
            let same = near.filter(|&k| !used[k]).find(lies).ok_or_else(|| fault(a))?;
            used[same] = true;
        }
    }
    match used.iter().position(|&used| !used) {
        Some(k) => Err(fault(open[k][0])),
        None if piece.outline.len() < 3 || doubled_area(&piece.outline) <= 0.0 => {
            Err(fault(open[0][0]))
        }
        None => Ok(()),
    }
}

/// The sides of a piece's faces that seams and rims open, with the material on their left.
fn open_sides(net: &Net, piece: &Piece, faces: &Faces) -> Vec<Segment> {
    let sides = net
        .seams
        .iter()
        .flat_map(|seam| seam.sides.iter().map(|s| (s.piece, seam.edge, s.face, s.segment)));
    let rims = net.rims.iter().map(|rim| (rim.piece, rim.edge, rim.face, rim.segment));
    let turned = |(_, ends, face, [a, b]): (PieceId, [usize; 2], usize, Segment)| {
        let vertices = &faces[&face].1.vertices;
        let n = vertices.len();
        let forward = (0..n).any(|i| [vertices[i], vertices[(i + 1) % n]] == ends);
        if forward { [a, b] } else { [b, a] }
    };
    sides.chain(rims).filter(|side| side.0 == piece.id).map(turned).collect()
}
