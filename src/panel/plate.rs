//! Plates and everything about a panelled model, as data.

use glam::{DVec2, DVec3};

use super::cut::EdgeCut;
use super::node::{Node, NodeCut};
use crate::geom::Frame;
use crate::geom::polygon::signed_area;
use crate::mesh::{EdgeId, FaceId, HalfEdgeId};

/// Sines of turns up to this are straight corners, not reflex ones.
const FLAT: f64 = 1e-9;

/// A face as a plate.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// The face.
    pub face: FaceId,
    /// In mm.
    pub thickness: f64,
    /// On the front: a flat point p of the front lies at `frame.lift(p)`, one of the back at that
    /// minus the thickness along the normal.
    pub frame: Frame,
    /// The sides, counter-clockwise from outside; side i lies along this half-edge.
    pub half_edges: Vec<HalfEdgeId>,
    /// The face itself in the frame.
    pub reference: Vec<DVec2>,
    /// The front outline, with relieved corners and fingers.
    pub front: Vec<DVec2>,
    /// The back outline; corner i of the back belongs to corner i of the front.
    pub back: Vec<DVec2>,
    /// The outline of the blank: every side where it is outermost (the long point). What is cut out
    /// of the sheet before bevelling; for square cuts the same as front and back.
    pub blank: Vec<DVec2>,
    /// For every side, where it begins in the outlines.
    pub begins: Vec<usize>,
    /// For every side, where it ends in the outlines.
    pub ends: Vec<usize>,
    /// The part of the face that lies inside of every side at front and back, with a corner for
    /// each vertex: where there is room for lettering.
    pub inner: Vec<DVec2>,
    /// Round holes through the plate, square to it.
    pub holes: Vec<Hole>,
}

/// A round hole in the frame of its plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hole {
    /// The middle.
    pub centre: DVec2,
    /// In mm.
    pub radius: f64,
    /// The edge that it belongs to.
    pub edge: EdgeId,
}

/// A panelled model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plates {
    /// One plate for each face, in the order of the faces.
    pub plates: Vec<Plate>,
    /// One cut for each edge, in the order of the edges.
    pub edges: Vec<EdgeCut>,
    /// One node for each vertex with edges, in their order.
    pub nodes: Vec<Node>,
    /// Corners in a straight line between edges that ask for different insets, as (face, corner):
    /// both sides have the larger one.
    pub straight_corners: Vec<(FaceId, usize)>,
    /// What was cut off at nodes to keep plates apart.
    pub node_cuts: Vec<NodeCut>,
    /// Corners too near to their neighbours to be relieved.
    pub unrelieved_corners: usize,
    /// Pairs of holes made.
    pub hole_pairs: usize,
    /// Pairs of holes left out, since they would come too near to a side of one of their plates.
    pub lost_hole_pairs: usize,
}

impl Plate {
    /// A flat point of the front in space.
    pub fn on_front(&self, p: DVec2) -> DVec3 {
        self.frame.lift(p)
    }

    /// A flat point of the back in space.
    pub fn on_back(&self, p: DVec2) -> DVec3 {
        self.frame.lift(p) - self.frame.normal * self.thickness
    }

    /// The two ends of a side in the front outline.
    pub fn front_side(&self, i: usize) -> [DVec2; 2] {
        [self.front[self.begins[i]], self.front[self.ends[i]]]
    }

    /// Whether the face has a reflex corner.
    pub fn is_concave(&self) -> bool {
        let n = self.reference.len();
        let side = |i: usize| self.reference[(i + 1) % n] - self.reference[i % n];
        (0..n).any(|i| {
            side(i).perp_dot(side(i + 1)) < -FLAT * side(i).length() * side(i + 1).length()
        })
    }

    /// Area of the front, holes taken off, in mm².
    pub fn front_area(&self) -> f64 {
        signed_area(&self.front) - self.hole_area()
    }

    fn hole_area(&self) -> f64 {
        self.holes.iter().map(|h| std::f64::consts::PI * h.radius * h.radius).sum()
    }

    /// Volume in mm³. Exact: every cross-section has its corners on straight lines from back to
    /// front (the prismatoid formula).
    pub fn volume(&self) -> f64 {
        let middle: Vec<DVec2> =
            self.front.iter().zip(&self.back).map(|(&a, &b)| a.midpoint(b)).collect();
        let sum = signed_area(&self.front) + 4.0 * signed_area(&middle) + signed_area(&self.back);
        self.thickness * (sum / 6.0 - self.hole_area())
    }
}
