//! What cuts make of the mesh, and its place in the tables.

use super::side::StampedSide;
use super::{Cutter, Lineage, SlicingPlane};
use crate::geom::{Plane, Side};
use crate::mesh::{Corner, FaceId, FaceKind, HalfEdgeId, VertexId};

impl Cutter {
    /// Divides an edge where it crosses the plane; returns the new vertex.
    pub(in crate::op::cut) fn split_at_plane(
        &mut self,
        plane: &SlicingPlane,
        h: HalfEdgeId,
    ) -> VertexId {
        let point = self.crossing(plane, h);
        let end = self.mesh.origin(h);
        let (v, _) = self.mesh.split_edge(h.edge(), point);
        self.register_vertex(v, end);
        self.splits.push(v);
        v
    }

    /// Makes room in the tables for a new vertex, which is like `like` as far as rims are
    /// concerned.
    pub(in crate::op::cut) fn register_vertex(&mut self, v: VertexId, like: VertexId) {
        grow(&mut self.sides, v.index(), 0);
        grow(&mut self.born, v.index(), 0);
        self.born[v.index()] = self.cut;
        self.sides[v.index()] = StampedSide::new(self.cut, Side::On).0;
        if let Some(is_open) = &mut self.is_open {
            grow(is_open, v.index(), false);
            is_open[v.index()] = is_open[like.index()];
        }
    }

    /// Divides a face by an edge; the part in front of the plane, on the edge's left, is the new
    /// face.
    pub(in crate::op::cut) fn insert_chord(
        &mut self,
        from: HalfEdgeId,
        to: HalfEdgeId,
    ) -> HalfEdgeId {
        let parent = self.mesh.face(from);
        let e = self
            .mesh
            .insert_edge(Corner::At(from), Corner::At(to))
            .expect("half-edges are corners");
        self.register_face(self.mesh.face(e.half_edge()), self.lineage_of(parent));
        // What a line leaves of a convex face is convex; of other faces it may be anything.
        self.forget_shape_unless_convex(parent);
        self.chords.push(e);
        e.half_edge()
    }

    pub(in crate::op::cut) fn register_face(&mut self, f: FaceId, lineage: Lineage) {
        for table in [&mut self.lineage, &mut self.doomed, &mut self.decided] {
            grow(table, f.index(), 0);
            table[f.index()] = 0;
        }
        grow(&mut self.shapes, f.index(), 0);
        self.shapes[f.index()] = 0;
        self.lineage[f.index()] = lineage.0 + 1;
    }

    /// Whether the component of `v` had a rim before the command, so that a cut leaves a rim, too.
    pub(in crate::op::cut) fn is_open_at(&self, v: VertexId) -> bool {
        self.is_open
            .as_ref()
            .is_some_and(|is_open| is_open.get(v.index()).copied().unwrap_or(false))
    }

    /// Registers a face that closes a walk of the wound.
    pub(in crate::op::cut) fn register_cap(&mut self, f: FaceId, kind: FaceKind, plane: &Plane) {
        let cap = self.cap_lineage(self.cut as usize - 1);
        self.register_face(f, cap);
        self.mesh.set_kind(f, kind);
        if kind == FaceKind::Solid {
            self.mesh.set_plane(f, *plane);
        }
    }

    pub(in crate::op::cut) fn doom(&mut self, f: FaceId) {
        self.doomed[f.index()] = self.cut;
        self.region.push(f);
    }

    /// Takes back divisions of faces of which neither side was removed: parts that a local cut did
    /// not reach.
    pub(in crate::op::cut) fn undo_needless_divisions(&mut self) {
        let cap = self.cap_lineage(self.cut as usize - 1);
        for e in std::mem::take(&mut self.chords) {
            let is_needless = self.mesh.has_edge(e)
                && self
                    .mesh
                    .edge_faces(e)
                    .into_iter()
                    .all(|f| !self.mesh.is_hole(f) && self.lineage_of(f) != cap);
            if is_needless {
                self.mesh.delete_edge(e);
            }
        }
        for v in std::mem::take(&mut self.splits) {
            if self.mesh.has_vertex(v) && self.mesh.valence(v) == 2 {
                // A vertex on a rim that was really cut has valence 2 as well, but then a cap or
                // the new rim ends there.
                let ends_a_cut = self.mesh.outgoing(v).any(|h| self.was_cut(h, cap));
                if !ends_a_cut {
                    self.mesh.join_edge(v).expect("the vertex has two edges");
                }
            }
        }
    }

    fn was_cut(&self, h: HalfEdgeId, cap: Lineage) -> bool {
        self.lineage_of(self.mesh.face(h)) == cap
    }
}

fn grow<T: Clone>(table: &mut Vec<T>, index: usize, value: T) {
    if index >= table.len() {
        table.resize(index + 1, value);
    }
}
