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
    EdgeLabel, FlatFace, MeshCounts, Net, NetRim, Piece, PieceId, Proof, Seam, SeamSide,
};

/// Sides of the polygon of a round hole on a sheet; they stay within 1 % of the radius.
const ROUND: usize = 24;

/// The net of a panelled mesh: piece i is plate i. `scale` is the factor from the mesh file's unit
/// to millimetres, `splits` are the vertices that were split when it was read.
pub fn panel_net(mesh: &Mesh, plates: &Plates, scale: f64, splits: &[SplitVertex]) -> Net {
    let names = Names::new(mesh, plates, splits);
    let mut net = Net {
        scale,
        counts: MeshCounts {
            vertices: mesh.vertex_count() - splits.len(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
        },
        pieces: plates.plates.iter().enumerate().map(|(i, plate)| names.piece(i, plate)).collect(),
        folds: Vec::new(),
        seams: Vec::new(),
        rims: Vec::new(),
        proof: proof(mesh, plates),
    };
    for cut in &plates.edges {
        match cut.fold {
            Some(fold) => net.seams.push(names.seam(cut.edge, fold)),
            None => net.rims.extend(names.rim(cut.edge)),
        }
    }
    net
}

/// What vertices and plates are called in the net.
struct Names<'a> {
    mesh: &'a Mesh,
    plates: &'a Plates,
    /// The numbers of the vertices in the file.
    vertices: VertexMap<usize>,
    /// The indices of the plates.
    pieces: FaceMap<usize>,
}

impl<'a> Names<'a> {
    fn new(mesh: &'a Mesh, plates: &'a Plates, splits: &[SplitVertex]) -> Self {
        let mut vertices = VertexMap::filled(mesh.vertex_slots(), 0);
        mesh.vertices().for_each(|v| vertices[v] = v.index());
        splits.iter().for_each(|split| vertices[split.added] = split.given.index());
        let mut pieces = FaceMap::filled(mesh.face_slots(), usize::MAX);
        plates.plates.iter().enumerate().for_each(|(i, plate)| pieces[plate.face] = i);
        Self { mesh, plates, vertices, pieces }
    }

    fn piece(&self, i: usize, plate: &Plate) -> Piece {
        let face = FlatFace {
            face: plate.face.index(),
            vertices: self.mesh.face_vertices(plate.face).map(|v| self.vertices[v]).collect(),
            polygon: plate.inner.clone(),
        };
        Piece {
            id: PieceId(i),
            outline: plate.blank.clone(),
            holes: plate.holes.iter().map(|h| circle(h.centre, h.radius)).collect(),
            faces: vec![face],
        }
    }

    fn ends(&self, e: EdgeId) -> [usize; 2] {
        self.mesh.edge_vertices(e).map(|v| self.vertices[v])
    }

    /// The side of a plate along a half-edge, running with the edge.
    fn side(&self, h: HalfEdgeId) -> SeamSide {
        let piece = self.pieces[self.mesh.face(h)];
        let plate = &self.plates.plates[piece];
        let i = plate.half_edges.iter().position(|&g| g == h).unwrap_or(0);
        let mut segment = [plate.inner[i], plate.inner[(i + 1) % plate.inner.len()]];
        if h != h.edge().half_edge() {
            segment.reverse();
        }
        SeamSide { piece: PieceId(piece), face: plate.face.index(), segment }
    }

    fn seam(&self, e: EdgeId, fold: f64) -> Seam {
        Seam {
            id: EdgeLabel(e.index()),
            edge: self.ends(e),
            length: edge_length(self.mesh, e),
            fold_angle: fold.to_degrees(),
            sides: e.half_edges().map(|h| self.side(h)),
        }
    }

    /// `None` where an edge has no plate at all.
    fn rim(&self, e: EdgeId) -> Option<NetRim> {
        let h = e.half_edges().into_iter().find(|&h| !self.mesh.is_hole(self.mesh.face(h)))?;
        let SeamSide { piece, face, segment } = self.side(h);
        Some(NetRim { edge: self.ends(e), piece, face, segment })
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
