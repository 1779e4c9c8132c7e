//! The faces of a mesh laid flat one by one, and how they meet, in flat arrays for the search.
//!
//! Faces are numbered densely from 0. Their sides are numbered through: the sides of face f are
//! `first[f]..first[f + 1]`, and side s starts at the corner with the same number. Seen from
//! outside, sides run counter-clockwise.

use glam::DVec2;

use super::convex::Parts;
use super::flat_polygon::FlatPolygon;
use super::sets::Sets;
use super::{Seams, UnfoldError};
use crate::geom::RoundingBound;
use crate::measure;
use crate::mesh::{EdgeId, EdgeMap, FaceId, HalfEdgeId, HalfEdgeMap, Mesh};

/// No face, no side.
pub(super) const NONE: u32 = u32::MAX;

/// Folds flatter than this are flat, in radians: a micrometre on a metre. No tool bends that.
pub const FLAT: f64 = 1e-6;

/// How deep an overlap must be to be one, in units of the rounding bound of constructed points; see
/// [`super::overlap`].
const OVERLAP_BOUND: f64 = 10.0;

/// An edge between two faces that may stay together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hinge {
    /// Its two sides.
    pub sides: [u32; 2],
    /// Its length.
    pub length: f64,
    /// How far the faces turn against each other, in radians, without sign.
    pub fold: f64,
    /// Whether the caller wants it to stay together.
    pub is_kept: bool,
}

/// See the module documentation.
#[derive(Debug, Clone)]
pub(super) struct Dual {
    pub faces: Vec<FaceId>,
    pub first: Vec<u32>,
    pub half_edges: Vec<HalfEdgeId>,
    /// Side → its face.
    pub owner: Vec<u32>,
    /// Side → the same edge's side on the neighbour, or `NONE` at a rim.
    pub across: Vec<u32>,
    /// Side → its edge among the hinges, `NONE` when the edge must open.
    pub hinge: Vec<u32>,
    /// Corner → its place in the face's own frame.
    pub local: Vec<DVec2>,
    /// Side → its unit direction in the face's own frame.
    pub direction: Vec<DVec2>,
    /// Face → convex parts.
    pub parts: Parts,
    /// Face → an upper bound of its diameter.
    pub diameter: Vec<f64>,
    /// The edges that may stay together, ascending.
    pub hinges: Vec<Hinge>,
    /// Whether flat edges open only where nothing else helps.
    pub keeps_flat: bool,
    /// How deep two faces may sink into each other and still count as touching; see
    /// [`super::overlap`].
    pub bound: f64,
}

impl Dual {
    /// Flattens every face and links the sides.
    pub fn new(mesh: &Mesh, seams: &Seams) -> Result<Self, UnfoldError> {
        let faces: Vec<FaceId> = mesh.faces().collect();
        if faces.is_empty() {
            return Err(UnfoldError::NoFaces);
        }
        let (low, high) = mesh.bounds().expect("a mesh with faces has vertices");
        let rounding = RoundingBound::of_box(low, high).length();
        let mut dual = Self::empty(faces, OVERLAP_BOUND * rounding);
        for f in dual.faces.clone() {
            let flat = FlatPolygon::new(&mesh.face_positions(f), f.index(), rounding)?;
            dual.push_face(mesh, f, flat)?;
        }
        dual.link(mesh, seams)?;
        Ok(dual)
    }

    fn empty(faces: Vec<FaceId>, bound: f64) -> Self {
        Self {
            faces,
            first: vec![0],
            half_edges: Vec::new(),
            owner: Vec::new(),
            across: Vec::new(),
            hinge: Vec::new(),
            local: Vec::new(),
            direction: Vec::new(),
            parts: Parts::default(),
            diameter: Vec::new(),
            hinges: Vec::new(),
            keeps_flat: true,
            bound,
        }
    }

    fn push_face(&mut self, mesh: &Mesh, f: FaceId, flat: FlatPolygon) -> Result<(), UnfoldError> {
        let face = (self.first.len() - 1) as u32;
        self.half_edges.extend(mesh.face_half_edges(f));
        self.owner.resize(self.half_edges.len(), face);
        self.first.push(self.half_edges.len() as u32);
        self.parts
            .push(&flat.corners, self.bound)
            .map_err(|_| UnfoldError::FaceNotSimple { face: f.index() })?;
        self.diameter.push(flat.diameter);
        self.local.extend(flat.corners);
        self.direction.extend(flat.directions);
        Ok(())
    }

    fn link(&mut self, mesh: &Mesh, seams: &Seams) -> Result<(), UnfoldError> {
        let (may_fold, must_fold) = (may_fold(mesh, seams)?, must_fold(mesh, seams)?);
        let mut side_of = HalfEdgeMap::filled(mesh.half_edge_slots(), NONE);
        for (s, &h) in self.half_edges.iter().enumerate() {
            side_of[h] = s as u32;
        }
        self.across = self.half_edges.iter().map(|h| side_of[h.twin()]).collect();
        self.hinge = vec![NONE; self.across.len()];
        for e in mesh.edges() {
            let sides = e.half_edges().map(|h| side_of[h]);
            if sides.contains(&NONE) {
                continue;
            }
            let [f, g] = sides.map(|s| self.owner[s as usize]);
            if f == g {
                return Err(UnfoldError::FaceMeetsItself {
                    face: self.faces[f as usize].index(),
                    edge: e.index(),
                });
            }
            if may_fold[e] {
                let fold = measure::fold_angle(mesh, e).map_or(0.0, f64::abs);
                sides.into_iter().for_each(|s| self.hinge[s as usize] = self.hinges.len() as u32);
                self.hinges.push(Hinge {
                    sides,
                    length: measure::edge_length(mesh, e),
                    fold,
                    is_kept: must_fold[e],
                });
            }
        }
        Ok(())
    }

    /// The same, but flat edges open like others; nothing where there are none.
    pub fn with_loose_flat_edges(&self) -> Option<Self> {
        let has_flat = self.hinges.iter().any(|hinge| hinge.fold <= FLAT);
        has_flat.then(|| Self { keeps_flat: false, ..self.clone() })
    }

    /// The edge of a side.
    pub fn edge(&self, s: u32) -> EdgeId {
        self.half_edges[s as usize].edge()
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The sides of a face.
    pub fn sides(&self, face: u32) -> std::ops::Range<u32> {
        self.first[face as usize]..self.first[face as usize + 1]
    }

    /// The sides of a face, as a range of the corner arrays.
    pub fn corners(&self, face: u32) -> std::ops::Range<usize> {
        self.first[face as usize] as usize..self.first[face as usize + 1] as usize
    }

    /// The side after `s` around its face.
    pub fn next(&self, s: u32) -> u32 {
        let range = self.sides(self.owner[s as usize]);
        if s + 1 == range.end { range.start } else { s + 1 }
    }

    /// The face on the other side of `s`; `NONE` at a rim.
    pub fn neighbour(&self, s: u32) -> u32 {
        match self.across[s as usize] {
            NONE => NONE,
            t => self.owner[t as usize],
        }
    }

    /// Number of parts of the mesh that are connected through any edge.
    pub fn component_count(&self) -> usize {
        self.part_count(|s| self.across[s as usize] != NONE)
    }

    /// Number of parts that are connected through edges that may stay together: no net has fewer
    /// pieces.
    pub fn least_pieces(&self) -> usize {
        self.part_count(|s| self.hinge[s as usize] != NONE)
    }

    fn part_count(&self, is_joined: impl Fn(u32) -> bool) -> usize {
        let mut sets = Sets::new(self.face_count());
        let joined = (0..self.across.len() as u32)
            .filter(|&s| is_joined(s))
            .filter(|&s| sets.join(self.owner[s as usize], self.neighbour(s)))
            .count();
        self.face_count() - joined
    }
}

/// Which edges may stay together.
fn may_fold(mesh: &Mesh, seams: &Seams) -> Result<EdgeMap<bool>, UnfoldError> {
    let (listed, value): (&[EdgeId], bool) = match seams {
        Seams::Free => (&[], false),
        Seams::Open(edges) => (edges, false),
        Seams::Folds(edges) => (edges, true),
        Seams::Within { cut, .. } => (cut, false),
    };
    marked(mesh, listed, value)
}

/// Which edges have to stay together.
fn must_fold(mesh: &Mesh, seams: &Seams) -> Result<EdgeMap<bool>, UnfoldError> {
    let Seams::Within { keep, cut } = seams else { return marked(mesh, &[], true) };
    let both: Vec<usize> = keep.iter().filter(|e| cut.contains(e)).map(|e| e.index()).collect();
    if !both.is_empty() {
        return Err(UnfoldError::KeptAndCut { edges: both });
    }
    marked(mesh, keep, true)
}

/// A table with a value at the listed edges and its opposite elsewhere.
fn marked(mesh: &Mesh, listed: &[EdgeId], value: bool) -> Result<EdgeMap<bool>, UnfoldError> {
    let mut table = EdgeMap::filled(mesh.edge_slots(), !value);
    for &e in listed {
        if !mesh.has_edge(e) {
            return Err(UnfoldError::UnknownEdge { edge: e.index(), count: mesh.edge_count() });
        }
        table[e] = value;
    }
    Ok(table)
}
