//! From a layout to a [`Net`]: pieces with outlines, folds, seams and rims, named as in the file.

use glam::DVec2;

use super::MeshSource;
use super::dual::{Dual, FLAT, NONE};
use super::layout::Layout;
use crate::geom::polygon::signed_area;
use crate::measure;
use crate::mesh::{EdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap};
use crate::net::{
    EdgeLabel, FlatFace, Fold, FoldKind, MeshCounts, Net, NetRim, Piece, PieceId, Proof, Seam,
    SeamSide, Segment,
};

/// The net of a layout without overlaps; its proof is still empty.
pub(super) fn net(mesh: &Mesh, layout: &Layout, source: &MeshSource) -> Net {
    let writer = Writer::new(mesh, layout, source);
    let (folds, seams, rims) = writer.edges();
    Net {
        scale: source.scale,
        counts: MeshCounts {
            vertices: mesh.vertex_count() - source.split_vertices.len(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
        },
        pieces: (0..writer.trees.len()).map(|i| writer.piece(i)).collect(),
        folds,
        seams,
        rims,
        proof: Proof::default(),
    }
}

struct Writer<'a> {
    mesh: &'a Mesh,
    dual: &'a Dual,
    /// Piece → its faces in the order in which they were laid.
    trees: Vec<&'a [u32]>,
    /// Face → its piece.
    piece: Vec<PieceId>,
    /// Corner → where it lies in its piece's frame.
    flat: Vec<DVec2>,
    /// Side → whether the edge folds.
    folds: Vec<bool>,
    side_of: HalfEdgeMap<u32>,
    /// Vertex → its number in the file.
    name: VertexMap<usize>,
}

impl<'a> Writer<'a> {
    fn new(mesh: &'a Mesh, layout: &'a Layout, source: &MeshSource) -> Self {
        let (dual, forest) = (layout.dual, &layout.forest);
        let mut trees: Vec<&[u32]> =
            forest.roots().into_iter().map(|root| forest.subtree(root)).collect();
        trees.sort_by_cached_key(|faces| {
            (std::cmp::Reverse(faces.len()), faces.iter().min().copied())
        });
        let mut piece = vec![PieceId(0); dual.face_count()];
        let mut flat = layout.flat.clone();
        for (i, faces) in trees.iter().enumerate() {
            faces.iter().for_each(|&f| piece[f as usize] = PieceId(i));
            let corners = || faces.iter().flat_map(|&f| dual.corners(f));
            let low = corners().map(|c| flat[c]).fold(DVec2::INFINITY, DVec2::min);
            corners().for_each(|c| flat[c] -= low);
        }
        let mut name = VertexMap::filled(mesh.vertex_slots(), 0);
        mesh.vertices().for_each(|v| name[v] = v.index());
        source.split_vertices.iter().for_each(|split| name[split.added] = split.given.index());
        let mut side_of = HalfEdgeMap::filled(mesh.half_edge_slots(), NONE);
        dual.half_edges.iter().enumerate().for_each(|(s, &h)| side_of[h] = s as u32);
        let folds = (0..dual.across.len() as u32)
            .map(|s| forest.is_fold(dual, s) || closes(layout, s))
            .collect();
        Self { mesh, dual, trees, piece, flat, folds, side_of, name }
    }

    fn piece(&self, index: usize) -> Piece {
        let faces = self.trees[index];
        let mut loops = self.boundary(faces);
        let outer = (0..loops.len())
            .max_by(|&a, &b| signed_area(&loops[a]).total_cmp(&signed_area(&loops[b])));
        let outline = loops.swap_remove(outer.expect("a flat piece has a boundary"));
        Piece {
            id: PieceId(index),
            outline,
            holes: loops,
            faces: faces.iter().map(|&f| self.face(f)).collect(),
        }
    }

    fn face(&self, f: u32) -> FlatFace {
        let id = self.dual.faces[f as usize];
        FlatFace {
            face: id.index(),
            vertices: self.mesh.face_vertices(id).map(|v| self.name(v)).collect(),
            polygon: self.flat[self.dual.corners(f)].to_vec(),
        }
    }

    fn name(&self, v: VertexId) -> usize {
        self.name[v]
    }

    /// The boundaries of a piece, with the material on their left.
    fn boundary(&self, faces: &[u32]) -> Vec<Vec<DVec2>> {
        let mut open: Vec<u32> = faces
            .iter()
            .flat_map(|&f| self.dual.sides(f))
            .filter(|&s| !self.folds[s as usize])
            .collect();
        open.sort_unstable();
        let mut seen = vec![false; open.len()];
        let mut loops = Vec::new();
        for start in 0..open.len() {
            let mut corners = Vec::new();
            let mut at = start;
            while !std::mem::replace(&mut seen[at], true) {
                corners.push(self.flat[open[at] as usize]);
                at = open
                    .binary_search(&self.next_open(open[at]))
                    .expect("the boundary stays in its piece");
            }
            if !corners.is_empty() {
                loops.push(corners);
            }
        }
        loops
    }

    /// The boundary side after `s`: around the corner at its end, across the folds.
    fn next_open(&self, s: u32) -> u32 {
        let mut next = self.dual.next(s);
        while self.folds[next as usize] {
            next = self.dual.next(self.dual.across[next as usize]);
        }
        next
    }

    /// Where an edge lies on the face of one of its sides, from the edge's first vertex to its
    /// second.
    fn segment(&self, s: u32) -> Segment {
        let ends = [s, self.dual.next(s)].map(|c| self.flat[c as usize]);
        let is_first =
            self.dual.half_edges[s as usize].edge().half_edge() == self.dual.half_edges[s as usize];
        if is_first { ends } else { [ends[1], ends[0]] }
    }

    fn edges(&self) -> (Vec<Fold>, Vec<Seam>, Vec<NetRim>) {
        let (mut folds, mut seams, mut rims) = (Vec::new(), Vec::new(), Vec::new());
        for e in self.mesh.edges() {
            match e.half_edges().map(|h| self.side_of[h]) {
                [NONE, NONE] => {}
                [NONE, s] | [s, NONE] => rims.push(self.rim(e, s)),
                [s, _] if self.folds[s as usize] => folds.push(self.fold(e, s)),
                sides => seams.push(self.seam(e, sides)),
            }
        }
        (folds, seams, rims)
    }

    fn ends(&self, e: EdgeId) -> [usize; 2] {
        self.mesh.edge_vertices(e).map(|v| self.name(v))
    }

    fn face_number(&self, s: u32) -> usize {
        self.dual.faces[self.dual.owner[s as usize] as usize].index()
    }

    fn piece_of(&self, s: u32) -> PieceId {
        self.piece[self.dual.owner[s as usize] as usize]
    }

    fn fold(&self, e: EdgeId, s: u32) -> Fold {
        let angle = measure::fold_angle(self.mesh, e).unwrap_or(0.0);
        let kind = match angle {
            a if a.abs() <= FLAT => FoldKind::Flat,
            a if a > 0.0 => FoldKind::Mountain,
            _ => FoldKind::Valley,
        };
        Fold {
            id: EdgeLabel(e.index()),
            edge: self.ends(e),
            piece: self.piece_of(s),
            faces: [s, self.dual.across[s as usize]].map(|s| self.face_number(s)),
            segment: self.segment(s),
            fold_angle: angle.to_degrees(),
            kind,
        }
    }

    fn seam(&self, e: EdgeId, sides: [u32; 2]) -> Seam {
        let side = |s| SeamSide {
            piece: self.piece_of(s),
            face: self.face_number(s),
            segment: self.segment(s),
        };
        Seam {
            id: EdgeLabel(e.index()),
            edge: self.ends(e),
            length: measure::edge_length(self.mesh, e),
            fold_angle: measure::fold_angle(self.mesh, e).unwrap_or(0.0).to_degrees(),
            sides: sides.map(side),
        }
    }

    fn rim(&self, e: EdgeId, s: u32) -> NetRim {
        NetRim {
            edge: self.ends(e),
            piece: self.piece_of(s),
            face: self.face_number(s),
            segment: self.segment(s),
        }
    }
}

/// Whether the two sides of an edge that may fold lie on each other without being a fold of the
/// forest.
fn closes(layout: &Layout, s: u32) -> bool {
    let dual = layout.dual;
    let t = dual.across[s as usize];
    if dual.hinge[s as usize] == NONE
        || layout.piece[dual.owner[s as usize] as usize]
            != layout.piece[dual.owner[t as usize] as usize]
    {
        return false;
    }
    let near =
        |a: u32, b: u32| layout.flat[a as usize].distance(layout.flat[b as usize]) <= dual.bound;
    near(s, dual.next(t)) && near(dual.next(s), t)
}
