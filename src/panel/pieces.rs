//! Panels as the pieces of a net, so that they are nested, lettered and cut like any other pieces.
//!
//! A piece's outline is the blank of its plate; its one face has the corners of the part that is
//! solid at front and back, so that lettering keeps inside. Every edge between two panels is a
//! seam, every other one a rim.

use glam::DVec2;

use super::plate::{Plate, Plates};
use crate::measure::edge_length;
use crate::mesh::{EdgeId, FaceMap, HalfEdgeId, Mesh, SplitVertex, VertexMap};
use crate::net::{
    EdgeLabel, FlatFace, MeshCounts, Net, NetRim, Piece, PieceId, Proof, Seam, SeamSide, Segment,
};

/// Sides of the polygon of a round hole on a sheet; they stay within 1 % of the radius.
const ROUND: usize = 24;

/// The net of a panelled mesh: piece i is plate i. `scale` is the factor from the mesh file's unit
/// to millimetres, `splits` are the vertices that were split when it was read.
pub fn panel_net(mesh: &Mesh, plates: &Plates, scale: f64, splits: &[SplitVertex]) -> Net {
    let mut name = VertexMap::filled(mesh.vertex_slots(), 0);
    mesh.vertices().for_each(|v| name[v] = v.index());
    splits.iter().for_each(|split| name[split.added] = split.given.index());
    let mut index = FaceMap::filled(mesh.face_slots(), usize::MAX);
    plates.plates.iter().enumerate().for_each(|(i, plate)| index[plate.face] = i);
    let side =
        |h: HalfEdgeId| Side::of(&plates.plates[index[mesh.face(h)]], index[mesh.face(h)], h);
    let ends = |e: EdgeId| mesh.edge_vertices(e).map(|v| name[v]);
    let (mut seams, mut rims) = (Vec::new(), Vec::new());
    for cut in &plates.edges {
        let [h, g] = cut.edge.half_edges();
        if let Some(fold) = cut.fold {
            let sides = [side(h), side(g).turned()].map(|s| SeamSide {
                piece: s.piece,
                face: s.face,
                segment: s.segment,
            });
            let length = edge_length(mesh, cut.edge);
            let id = EdgeLabel(cut.edge.index());
            seams.push(Seam {
                id,
                edge: ends(cut.edge),
                length,
                fold_angle: fold.to_degrees(),
                sides,
            });
        } else if let Some(first) = [h, g].into_iter().find(|&h| !mesh.is_hole(mesh.face(h))) {
            let s = if first == h { side(h) } else { side(g).turned() };
            rims.push(NetRim {
                edge: ends(cut.edge),
                piece: s.piece,
                face: s.face,
                segment: s.segment,
            });
        }
    }
    let piece = |(i, plate): (usize, &Plate)| Piece {
        id: PieceId(i),
        outline: plate.blank.clone(),
        holes: plate.holes.iter().map(|h| circle(h.centre, h.radius)).collect(),
        faces: vec![FlatFace {
            face: plate.face.index(),
            vertices: mesh.face_vertices(plate.face).map(|v| name[v]).collect(),
            polygon: plate.inner.clone(),
        }],
    };
    let counts = MeshCounts {
        vertices: mesh.vertex_count() - splits.len(),
        edges: mesh.edge_count(),
        faces: mesh.face_count(),
    };
    Net {
        scale,
        counts,
        pieces: plates.plates.iter().enumerate().map(piece).collect(),
        folds: Vec::new(),
        seams,
        rims,
        proof: proof(mesh, plates),
    }
}

struct Side {
    piece: PieceId,
    face: usize,
    segment: Segment,
}

impl Side {
    fn of(plate: &Plate, index: usize, h: HalfEdgeId) -> Self {
        let i = plate.half_edges.iter().position(|&g| g == h).unwrap_or(0);
        let segment = [plate.inner[i], plate.inner[(i + 1) % plate.inner.len()]];
        Self { piece: PieceId(index), face: plate.face.index(), segment }
    }

    fn turned(mut self) -> Self {
        self.segment.reverse();
        self
    }
}

/// A circle as a clockwise polygon.
fn circle(centre: DVec2, radius: f64) -> Vec<DVec2> {
    let angle = |i: usize| -(i as f64) * std::f64::consts::TAU / ROUND as f64;
    (0..ROUND).map(|i| centre + radius * DVec2::from_angle(angle(i))).collect()
}

/// How true the flat faces (not the plates made of them) are to the mesh.
fn proof(mesh: &Mesh, plates: &Plates) -> Proof {
    let mut proof = Proof::default();
    for plate in &plates.plates {
        let corners = mesh.face_positions(plate.face);
        let n = corners.len();
        let shift = (0..n)
            .map(|i| plate.on_front(plate.reference[i]) - corners[i])
            .map(|d| d.dot(plate.frame.normal));
        let level = shift.sum::<f64>() / n as f64;
        for i in 0..n {
            let j = (i + 1) % n;
            let difference =
                plate.reference[i].distance(plate.reference[j]) - corners[i].distance(corners[j]);
            proof.congruence_mm = proof.congruence_mm.max(difference.abs());
            let lifted = plate.on_front(plate.reference[i]) - plate.frame.normal * level;
            proof.refold_mm = proof.refold_mm.max(lifted.distance(corners[i]));
        }
    }
    proof
}
