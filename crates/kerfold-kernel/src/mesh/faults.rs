//! What is wrong with a mesh: every broken invariant of the store, with ids.

use std::fmt::Debug;

use super::{FaceId, HalfEdgeId, Mesh, VertexId, VertexMap};
use crate::code::codes;

/// A broken invariant. A sound mesh has none; operators never make one, so a fault is a bug of
/// ours.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// A half-edge refers to a deleted or missing element.
    #[error("half-edge {0} refers to an element that does not exist")]
    DanglingHalfEdge(HalfEdgeId),
    /// next and prev do not undo each other.
    #[error("half-edge {0}: the previous of its next is another half-edge")]
    BrokenWalk(HalfEdgeId),
    /// The next half-edge starts elsewhere than this one ends.
    #[error("half-edge {0} ends at one vertex, but its next leaves another")]
    Jump(HalfEdgeId),
    /// Two half-edges that follow each other name different faces.
    #[error("half-edge {0} and its next lie on different faces")]
    FaceChange(HalfEdgeId),
    /// A vertex's start does not leave it.
    #[error("vertex {0} starts at a half-edge that leaves another vertex")]
    VertexStart(VertexId),
    /// A face's start does not bound it.
    #[error("face {0} starts at a half-edge of another face")]
    FaceStart(FaceId),
    /// The half-edges that leave a vertex do not form one fan.
    #[error("vertex {vertex} has {in_fan} half-edges in its fan, but {leaving} leave it")]
    SplitFan {
        /// The vertex.
        vertex: VertexId,
        /// Number of half-edges reached by walking around it.
        in_fan: usize,
        /// Number of half-edges that name it as origin.
        leaving: usize,
    },
    /// A face's half-edges form more than one walk.
    #[error("face {face} has {in_walk} half-edges in its walk, but {naming} name it")]
    SplitFace {
        /// The face.
        face: FaceId,
        /// Number of half-edges reached from its start.
        in_walk: usize,
        /// Number of half-edges that name it.
        naming: usize,
    },
    /// A point sphere whose vertex and face do not name each other.
    #[error("the point sphere of vertex {0} and its face do not belong together")]
    PointSphere(VertexId),
    /// A position with a NaN or an infinite coordinate.
    #[error("vertex {0} has a coordinate that is not finite")]
    NotFinite(VertexId),
}

codes!(error Fault {
    DanglingHalfEdge = 261,
    BrokenWalk = 262,
    Jump = 263,
    FaceChange = 264,
    VertexStart = 265,
    FaceStart = 266,
    SplitFan = 267,
    SplitFace = 268,
    PointSphere = 269,
    NotFinite = 270,
});

impl Mesh {
    /// Every fault of the mesh, with ids; empty for a sound mesh. Takes time proportional to the
    /// mesh.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = self.half_edge_faults();
        // Walking further over dangling links could run anywhere.
        if faults.is_empty() {
            self.vertex_faults(&mut faults);
            self.face_faults(&mut faults);
        }
        faults
    }

    fn half_edge_faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for h in self.half_edges() {
            let (next, prev) = (self.next(h), self.prev(h));
            let exists = |g: HalfEdgeId| self.has_edge(g.edge());
            if !exists(next)
                || !exists(prev)
                || !self.has_vertex(self.origin(h))
                || !self.has_face(self.face(h))
            {
                faults.push(Fault::DanglingHalfEdge(h));
                continue;
            }
            if self.prev(next) != h || self.next(prev) != h {
                faults.push(Fault::BrokenWalk(h));
            }
            if self.origin(next) != self.target(h) {
                faults.push(Fault::Jump(h));
            }
            if self.face(next) != self.face(h) {
                faults.push(Fault::FaceChange(h));
            }
        }
        faults
    }

    fn vertex_faults(&self, faults: &mut Vec<Fault>) {
        let mut leaving = VertexMap::filled(self.vertex_slots(), 0);
        for h in self.half_edges() {
            leaving[self.origin(h)] += 1;
        }
        for v in self.vertices() {
            if !self.position(v).is_finite() {
                faults.push(Fault::NotFinite(v));
            }
            match self.vertex_start(v) {
                None => {
                    let belongs = self
                        .lone_face(v)
                        .is_some_and(|f| self.has_face(f) && self.lone_vertex(f) == Some(v));
                    if !belongs || leaving[v] > 0 {
                        faults.push(Fault::PointSphere(v));
                    }
                }
                Some(start) if !self.has_edge(start.edge()) || self.origin(start) != v => {
                    faults.push(Fault::VertexStart(v))
                }
                Some(_) => {
                    let in_fan = self.outgoing(v).take(leaving[v] + 1).count();
                    if in_fan != leaving[v] {
                        faults.push(Fault::SplitFan { vertex: v, in_fan, leaving: leaving[v] });
                    }
                }
            }
        }
    }

    fn face_faults(&self, faults: &mut Vec<Fault>) {
        let mut naming = super::FaceMap::filled(self.face_slots(), 0);
        for h in self.half_edges() {
            naming[self.face(h)] += 1;
        }
        for f in self.faces_and_holes() {
            match self.face_start(f) {
                None => {
                    let belongs = self
                        .lone_vertex(f)
                        .is_some_and(|v| self.has_vertex(v) && self.lone_face(v) == Some(f));
                    if !belongs || naming[f] > 0 {
                        faults.push(Fault::FaceStart(f));
                    }
                }
                Some(start) if !self.has_edge(start.edge()) || self.face(start) != f => {
                    faults.push(Fault::FaceStart(f))
                }
                Some(_) => {
                    let in_walk = self.face_half_edges(f).take(naming[f] + 1).count();
                    if in_walk != naming[f] {
                        faults.push(Fault::SplitFace { face: f, in_walk, naming: naming[f] });
                    }
                }
            }
        }
    }
}

/// Panics with every fault of the mesh; for tests, after each operator call.
///
/// # Panics
/// When the mesh has a fault, or a component whose Euler characteristic is odd or above 2.
#[track_caller]
pub fn assert_sound(mesh: &Mesh) {
    let faults = mesh.faults();
    assert!(faults.is_empty(), "the mesh has {} faults: {:#?}", faults.len(), Shown(&faults));
    for c in mesh.components() {
        let faces = if c.edges == 0 { 1 } else { c.faces.len() + c.holes };
        let euler = c.vertices.len() as i64 - c.edges as i64 + faces as i64;
        assert!(
            euler <= 2 && euler % 2 == 0,
            "the component of vertex {} has Euler characteristic {euler}",
            c.vertices[0]
        );
    }
}

/// Shows the first faults in words.
struct Shown<'a>(&'a [Fault]);

impl Debug for Shown<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.0.iter().take(20).map(ToString::to_string)).finish()
    }
}
