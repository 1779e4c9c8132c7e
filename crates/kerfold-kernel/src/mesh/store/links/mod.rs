//! The fundamental operators: the only file that writes links.
//!
//! Source: Srinivasan 2004, II.5 (`CreateVertex`, `DeleteVertex`, `InsertEdge`, `DeleteEdge`),
//! after Akleman, Chen and Srinivasan 2003. Every operator here takes a sound mesh to a sound mesh,
//! whatever its arguments: that is what "manifold by construction" rests on.

use glam::DVec3;

use super::{Corner, Face, FaceKind, FaceList, HalfEdge, Link, Mesh, NONE, Vertex};
use crate::code::codes;
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, MAX_ELEMENTS, VertexId};

mod corner;
mod region;
mod renumbering;

pub use region::Region;
pub use renumbering::Renumbering;
use renumbering::renumber;

/// Why a fundamental operator refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError {
    /// Only a point sphere can be deleted as a vertex.
    #[error("vertex {0} still has edges; delete them first")]
    NotAPointSphere(VertexId),
    /// Joining two edges needs a vertex with exactly two.
    #[error("vertex {0} does not have exactly two edges, so they cannot be joined")]
    NotValenceTwo(VertexId),
    /// An edge between a vertex and itself cannot be contracted.
    #[error("edge {0} starts and ends at one vertex; delete it instead")]
    SelfLoop(EdgeId),
    /// A point sphere's corner was asked of a vertex that has edges.
    #[error("vertex {0} has edges; name one of its corners by a half-edge")]
    NotLone(VertexId),
}

codes!(error LinkError {
    NotAPointSphere = 251,
    NotValenceTwo = 252,
    SelfLoop = 253,
    NotLone = 254,
});

impl Mesh {
    // ---- fundamental operators (Srinivasan 2004, II.5) ------------------------------------------

    /// Makes a point sphere: V + 1, F + 1, one component more.
    pub fn create_vertex(&mut self, position: DVec3) -> (VertexId, FaceId) {
        let v = self.new_vertex(position);
        let f = self.new_face(FaceKind::Solid);
        self.isolate(v, f);
        (v, f)
    }

    /// Removes a point sphere: V − 1, F − 1, one component less.
    ///
    /// # Errors
    /// [`LinkError::NotAPointSphere`] when the vertex has edges.
    pub fn delete_vertex(&mut self, v: VertexId) -> Result<(), LinkError> {
        let f = self.lone_face(v).ok_or(LinkError::NotAPointSphere(v))?;
        self.free_vertex(v);
        self.free_face(f);
        Ok(())
    }

    /// Inserts an edge from corner `from` to corner `to`: E + 1.
    ///
    /// Within one face it divides the face (F + 1): the part on the left of the new edge, seen from
    /// `from` to `to`, is the new face and inherits kind, plane and group. Between two faces it
    /// merges them into the face of `from` (F − 1) and so adds a handle or joins two components.
    /// The first half-edge of the new edge leaves `from`.
    ///
    /// # Errors
    /// [`LinkError::NotLone`] when a [`Corner::Lone`] names a vertex with edges.
    pub fn insert_edge(&mut self, from: Corner, to: Corner) -> Result<EdgeId, LinkError> {
        let (f, g) = (self.corner_face(from)?, self.corner_face(to)?);
        let (u, v) = (self.corner_vertex(from), self.corner_vertex(to));
        let e = self.new_edge(u, v);
        let [h, t] = e.half_edges();
        // Around u the walk arrives (from before) and leaves into h; around v it arrives at h's end
        // and leaves (to after).
        let (a, b) = (self.corner_half_edge(from), self.corner_half_edge(to));
        if from == to {
            // A self-loop: h bounds the new one-sided face, t joins the old walk.
            let before = a.map_or(t, |a| self.prev(a));
            self.link(h, h);
            self.link(before, t);
            self.link(t, a.unwrap_or(t));
        } else {
            let before_a = a.map_or(t, |a| self.prev(a));
            let before_b = b.map_or(h, |b| self.prev(b));
            self.link(before_a, h);
            self.link(h, b.unwrap_or(t));
            self.link(before_b, t);
            self.link(t, a.unwrap_or(h));
        }
        self.vertices[u.index()].start = Link::edge(h);
        self.vertices[v.index()].start = Link::edge(t);
        if f == g {
            let new = self.new_face_like(f);
            self.half_edges[t.index()].face = f;
            self.faces[f.index()].start = Link::edge(t);
            self.assign_loop(h, new);
        } else {
            self.free_face(g);
            self.assign_loop(h, f);
        }
        Ok(e)
    }

    /// Deletes an edge: E − 1.
    ///
    /// Between two faces it merges them (F − 1); the face of the edge's first half-edge goes, so
    /// that deleting undoes [`Self::insert_edge`]. With the same face on both sides it divides that
    /// face into two (F + 1), which cuts a handle or a component apart; an end that loses its last
    /// edge becomes a point sphere.
    pub fn delete_edge(&mut self, e: EdgeId) {
        self.delete_edge_of(e.half_edge());
    }

    /// [`Self::delete_edge`], but of two faces the one on the left of `h` goes.
    pub fn delete_edge_of(&mut self, h: HalfEdgeId) {
        let (e, t) = (h.edge(), h.twin());
        let (g, f) = (self.face(h), self.face(t));
        let (u, v) = (self.origin(h), self.origin(t));
        let (before_h, after_h, before_t, after_t) =
            (self.prev(h), self.next(h), self.prev(t), self.next(t));
        self.free_edge(e);
        // The walk that came into u before h goes on with what followed t, and the same at v.
        let at_u = (before_h != h && before_h != t && after_t != h && after_t != t)
            .then_some((before_h, after_t));
        let at_v = (before_t != t && before_t != h && after_h != t && after_h != h)
            .then_some((before_t, after_h));
        // A self-loop around nothing: what came before one side goes on with what followed the same
        // side.
        let through = if after_t == t && before_h != h {
            Some((before_h, after_h))
        } else if after_h == h && before_t != t {
            Some((before_t, after_t))
        } else {
            None
        };
        let joined = [at_u, at_v, through];
        for &(before, after) in joined.iter().flatten() {
            self.link(before, after);
        }
        self.restart_after_delete(u, v, joined);
        self.faces_after_delete(f, g, u, v, joined);
    }

    /// The ends of a deleted edge get another outgoing half-edge, or wait to be made point spheres.
    fn restart_after_delete(
        &mut self,
        u: VertexId,
        v: VertexId,
        joined: [Option<(HalfEdgeId, HalfEdgeId)>; 3],
    ) {
        self.vertices[u.index()].start = Link::FREE;
        self.vertices[v.index()].start = Link::FREE;
        for (_, after) in joined.into_iter().flatten() {
            let origin = self.origin(after);
            self.vertices[origin.index()].start = Link::edge(after);
        }
    }

    fn faces_after_delete(
        &mut self,
        f: FaceId,
        g: FaceId,
        u: VertexId,
        v: VertexId,
        joined: [Option<(HalfEdgeId, HalfEdgeId)>; 3],
    ) {
        let loops: Vec<HalfEdgeId> = self.distinct_loops(joined);
        let lone: Vec<VertexId> = if u == v { vec![u] } else { vec![u, v] };
        let lone: Vec<VertexId> =
            lone.into_iter().filter(|w| self.vertices[w.index()].start == Link::FREE).collect();
        let pieces = loops.len() + lone.len();
        if f != g {
            self.free_face(g);
        }
        let faces: Vec<FaceId> =
            (0..pieces).map(|i| if i == 0 { f } else { self.new_face_like(f) }).collect();
        for (&start, &face) in loops.iter().zip(&faces) {
            self.assign_loop(start, face);
        }
        for (&w, &face) in lone.iter().zip(&faces[loops.len()..]) {
            self.isolate(w, face);
        }
    }

    /// One half-edge of each distinct loop among those through the joined links.
    fn distinct_loops(&self, joined: [Option<(HalfEdgeId, HalfEdgeId)>; 3]) -> Vec<HalfEdgeId> {
        let mut loops: Vec<HalfEdgeId> = Vec::with_capacity(2);
        for (_, after) in joined.into_iter().flatten() {
            if !loops.iter().any(|&start| self.loop_from(start).any(|h| h == after)) {
                loops.push(after);
            }
        }
        loops
    }

    // ---- built straight on the fundamentals -----------------------------------------------------

    /// Divides an edge by a new vertex at `position`: V + 1, E + 1. The edge keeps its origin; the
    /// new edge leads on to its target and inherits the seam mark. Same as `create_vertex`, two
    /// `insert_edge` and a `delete_edge`, in constant time.
    pub fn split_edge(&mut self, e: EdgeId, position: DVec3) -> (VertexId, EdgeId) {
        let [h, t] = e.half_edges();
        let end = self.origin(t);
        let m = self.new_vertex(position);
        let added = self.new_edge(m, end);
        let [h2, t2] = added.half_edges();
        let (f, g, after_h, before_t) = (self.face(h), self.face(t), self.next(h), self.prev(t));
        let (after_h2, before_t2) =
            (if after_h == t { t2 } else { after_h }, if before_t == h { h2 } else { before_t });
        self.link(h, h2);
        self.link(h2, after_h2);
        self.link(before_t2, t2);
        self.link(t2, t);
        self.half_edges[t.index()].origin = m;
        self.half_edges[h2.index()].face = f;
        self.half_edges[t2.index()].face = g;
        self.vertices[m.index()].start = Link::edge(h2);
        self.vertices[end.index()].start = Link::edge(t2);
        self.seams[added.index()] = self.seams[e.index()];
        (m, added)
    }

    /// Joins the two edges of a valence-2 vertex into one and removes the vertex: V − 1, E − 1. The
    /// inverse of [`Self::split_edge`]; the edge with the lower id stays.
    ///
    /// # Errors
    /// [`LinkError::NotValenceTwo`] when the vertex has another number of edges, or one self-loop.
    pub fn join_edge(&mut self, v: VertexId) -> Result<EdgeId, LinkError> {
        let out = self.vertex_start(v).ok_or(LinkError::NotValenceTwo(v))?;
        let other = self.next(out.twin());
        if other == out || self.next(other.twin()) != out || other.edge() == out.edge() {
            return Err(LinkError::NotValenceTwo(v));
        }
        let (stay, go) = if out.edge() < other.edge() { (out, other) } else { (other, out) };
        // stay leaves v; its twin enters v and is followed by go. After the join, stay leaves the
        // far end of go.
        let (far, back) = (self.target(go), go.twin());
        let (after_go, before_back) = (self.next(go), self.prev(back));
        if after_go == back {
            self.link(stay.twin(), stay);
        } else {
            self.link(stay.twin(), after_go);
            self.link(before_back, stay);
        }
        self.half_edges[stay.index()].origin = far;
        self.vertices[far.index()].start = Link::edge(stay);
        let (f, g) = (self.face(stay), self.face(stay.twin()));
        self.faces[f.index()].start = Link::edge(stay);
        self.faces[g.index()].start = Link::edge(stay.twin());
        self.free_edge(go.edge());
        self.free_vertex(v);
        Ok(stay.edge())
    }

    /// Contracts an edge to the origin of its first half-edge: V − 1, E − 1. Faces lose one side,
    /// so a triangle becomes a 2-gon. The constant-time core of `CollapseEdge` (Srinivasan 2004,
    /// III.6).
    ///
    /// # Errors
    /// [`LinkError::SelfLoop`] when both ends are one vertex.
    pub fn contract_edge(&mut self, e: EdgeId) -> Result<(), LinkError> {
        let [h, t] = e.half_edges();
        let (u, v) = (self.origin(h), self.origin(t));
        if u == v {
            return Err(LinkError::SelfLoop(e));
        }
        let leaving: Vec<HalfEdgeId> = self.outgoing(v).collect();
        for out in leaving {
            self.half_edges[out.index()].origin = u;
        }
        let (f, g) = (self.face(h), self.face(t));
        // One after the other: where the two follow each other, the second removal closes what the
        // first opened.
        for side in [h, t] {
            self.link(self.prev(side), self.next(side));
        }
        let rest = [self.next(h), self.next(t)].into_iter().find(|&next| next != h && next != t);
        if let Some(start) = rest {
            let at_u = if self.next(h) == t { self.next(t) } else { self.next(h) };
            self.vertices[u.index()].start = Link::edge(at_u);
            for (face, side) in [(f, h), (g, t)] {
                let next = self.next(side);
                let on_face = if next == h || next == t { start } else { next };
                self.faces[face.index()].start = Link::edge(on_face);
            }
        } else {
            self.isolate(u, f);
        }
        self.free_edge(e);
        self.free_vertex(v);
        Ok(())
    }

    /// Pulls a vertex apart between two of its corners in the same face: V + 1, F + 1.
    ///
    /// `a` and `b` leave the same vertex and lie on the same face, which touches itself there; the
    /// face becomes two faces and the half-edges from `b` up to `a`, around the vertex, get a
    /// vertex of their own. Returns the new vertex and the new face, which holds `b`. `None` when
    /// the corners do not share vertex and face, or are the same.
    pub fn split_vertex(&mut self, a: HalfEdgeId, b: HalfEdgeId) -> Option<(VertexId, FaceId)> {
        let (v, f) = (self.origin(a), self.face(a));
        if a == b || self.origin(b) != v || self.face(b) != f {
            return None;
        }
        let (before_a, before_b) = (self.prev(a), self.prev(b));
        self.link(before_a, b);
        self.link(before_b, a);
        let split_off = self.new_vertex(self.position(v));
        self.vertices[split_off.index()].is_given = self.is_given(v);
        let mut h = b;
        loop {
            self.half_edges[h.index()].origin = split_off;
            h = self.next(h.twin());
            if h == b {
                break;
            }
        }
        self.vertices[split_off.index()].start = Link::edge(b);
        self.vertices[v.index()].start = Link::edge(a);
        let new = self.new_face_like(f);
        self.assign_loop(a, f);
        self.assign_loop(b, new);
        Some((split_off, new))
    }

    /// Assembles a mesh from consistently oriented faces in one go: the bulk twin of `insert_edge`
    /// for the builder.
    ///
    /// `edges` lists each edge once as (origin, target) and `faces` the half-edges of each face and
    /// hole in order; the builder has checked that every half-edge appears exactly once.
    pub(in crate::mesh) fn assemble(
        positions: Vec<Option<DVec3>>,
        edges: Vec<(VertexId, VertexId)>,
        faces: &FaceList,
    ) -> Self {
        let absent: Vec<usize> = (0..positions.len()).filter(|&v| positions[v].is_none()).collect();
        let mut mesh = Self { seams: vec![false; edges.len()], ..Self::default() };
        mesh.assemble_edges(edges);
        mesh.assemble_vertices(positions);
        mesh.assemble_faces(faces);
        mesh.free_or_isolate_unused(absent);
        mesh
    }

    /// Half-edges in pairs, not linked yet.
    fn assemble_edges(&mut self, edges: Vec<(VertexId, VertexId)>) {
        let unset = HalfEdgeId(NONE);
        let half_edge = |origin| HalfEdge { next: unset, prev: unset, origin, face: FaceId(NONE) };
        self.half_edges = Vec::with_capacity(2 * edges.len());
        for (a, b) in edges {
            self.half_edges.extend([half_edge(a), half_edge(b)]);
        }
    }

    /// Vertices, each with the last half-edge that leaves it; in the memory of the positions, which
    /// are as large.
    fn assemble_vertices(&mut self, positions: Vec<Option<DVec3>>) {
        let vertex = |p: Option<DVec3>| Vertex {
            position: p.unwrap_or_default(),
            start: Link::FREE,
            is_given: true,
        };
        self.vertices = positions.into_iter().map(vertex).collect();
        for (h, half_edge) in self.half_edges.iter().enumerate() {
            self.vertices[half_edge.origin.index()].start = Link(h as u32);
        }
    }

    fn assemble_faces(&mut self, faces: &FaceList) {
        self.faces.reserve(faces.len());
        for (walk, kind) in faces.iter() {
            let f = self.new_face(kind);
            self.faces[f.index()].start = Link::edge(walk[0]);
            for (i, &h) in walk.iter().enumerate() {
                self.link(h, walk[(i + 1) % walk.len()]);
                self.half_edges[h.index()].face = f;
            }
        }
    }

    /// Vertices without a position are free slots; those without an edge become point spheres.
    fn free_or_isolate_unused(&mut self, absent: Vec<usize>) {
        let mut absent = absent.into_iter().peekable();
        for v in 0..self.vertices.len() {
            if absent.next_if_eq(&v).is_some() {
                self.free_vertices.push(VertexId::new(v));
            } else if self.vertices[v].start == Link::FREE {
                let f = self.new_face(FaceKind::Solid);
                self.isolate(VertexId::new(v), f);
            }
        }
    }

    /// Closes the gaps that deleted elements left, keeping the order of what lives. Returns where
    /// everything went.
    pub fn compact(&mut self) -> Renumbering {
        let has_vertex: Vec<bool> = self.vertices.iter().map(|v| v.start != Link::FREE).collect();
        let has_edge: Vec<bool> =
            self.half_edges.chunks_exact(2).map(|pair| pair[0].next.0 != NONE).collect();
        let has_face: Vec<bool> = self.faces.iter().map(|f| f.start != Link::FREE).collect();
        let map = Renumbering {
            vertices: renumber(&has_vertex),
            edges: renumber(&has_edge),
            faces: renumber(&has_face),
        };
        retain(&mut self.vertices, &has_vertex);
        retain(&mut self.faces, &has_face);
        retain(&mut self.seams, &has_edge);
        let both: Vec<bool> = has_edge.iter().flat_map(|&live| [live, live]).collect();
        retain(&mut self.half_edges, &both);
        self.relink(&map);
        self.compact_planes();
        self.free_vertices.clear();
        self.free_edges.clear();
        self.free_faces.clear();
        map
    }

    /// Gives every link the new number of what it leads to.
    fn relink(&mut self, map: &Renumbering) {
        let half_edge = |h: HalfEdgeId| HalfEdgeId(map.edges[h.edge().index()] << 1 | h.0 & 1);
        let start = |link: Link, partners: &[u32]| match link.half_edge() {
            Some(h) => Link::edge(half_edge(h)),
            None => Link::lone(partners[(link.0 & !MAX_ELEMENTS) as usize]),
        };
        for h in &mut self.half_edges {
            h.next = half_edge(h.next);
            h.prev = half_edge(h.prev);
            h.origin.0 = map.vertices[h.origin.index()];
            h.face.0 = map.faces[h.face.index()];
        }
        for v in &mut self.vertices {
            v.start = start(v.start, &map.faces);
        }
        for f in &mut self.faces {
            f.start = start(f.start, &map.vertices);
        }
    }

    /// Renumbers the carried planes in the order of their faces; several faces may share one.
    fn compact_planes(&mut self) {
        let mut new_slots = vec![NONE; self.planes.len()];
        let mut planes = Vec::new();
        for face in self.faces.iter_mut().filter(|f| f.plane != NONE) {
            let slot = &mut new_slots[face.plane as usize];
            if *slot == NONE {
                *slot = planes.len() as u32;
                planes.push(self.planes[face.plane as usize]);
            }
            face.plane = *slot;
        }
        self.planes = planes;
    }

    // ---- slots and links ------------------------------------------------------------------------

    fn loop_from(&self, start: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        std::iter::successors(Some(start), move |&h| Some(self.next(h)).filter(|&n| n != start))
    }

    #[inline]
    fn link(&mut self, before: HalfEdgeId, after: HalfEdgeId) {
        self.half_edges[before.index()].next = after;
        self.half_edges[after.index()].prev = before;
    }

    #[inline]
    fn set_origin(&mut self, h: HalfEdgeId, v: VertexId) {
        self.half_edges[h.index()].origin = v;
    }

    fn isolate(&mut self, v: VertexId, f: FaceId) {
        self.vertices[v.index()].start = Link::lone(f.0);
        self.faces[f.index()].start = Link::lone(v.0);
    }

    fn assign_loop(&mut self, start: HalfEdgeId, f: FaceId) {
        self.faces[f.index()].start = Link::edge(start);
        let mut h = start;
        loop {
            self.half_edges[h.index()].face = f;
            h = self.next(h);
            if h == start {
                break;
            }
        }
    }

    fn corner_face(&self, corner: Corner) -> Result<FaceId, LinkError> {
        match corner {
            Corner::At(h) => Ok(self.face(h)),
            Corner::Lone(v) => self.lone_face(v).ok_or(LinkError::NotLone(v)),
        }
    }

    fn corner_vertex(&self, corner: Corner) -> VertexId {
        match corner {
            Corner::At(h) => self.origin(h),
            Corner::Lone(v) => v,
        }
    }

    fn corner_half_edge(&self, corner: Corner) -> Option<HalfEdgeId> {
        match corner {
            Corner::At(h) => Some(h),
            Corner::Lone(_) => None,
        }
    }

    #[inline]
    fn new_vertex(&mut self, position: DVec3) -> VertexId {
        let vertex = Vertex { position, start: Link::FREE, is_given: false };
        if let Some(v) = self.free_vertices.pop() {
            self.vertices[v.index()] = vertex;
            return v;
        }
        self.vertices.push(vertex);
        VertexId::new(self.vertices.len() - 1)
    }

    #[inline]
    fn new_edge(&mut self, from: VertexId, to: VertexId) -> EdgeId {
        let unset = HalfEdgeId(NONE);
        let pair = [from, to].map(|origin| HalfEdge {
            next: unset,
            prev: unset,
            origin,
            face: FaceId(NONE),
        });
        if let Some(e) = self.free_edges.pop() {
            let h = e.half_edge().index();
            self.half_edges[h..h + 2].copy_from_slice(&pair);
            self.seams[e.index()] = false;
            return e;
        }
        self.half_edges.extend(pair);
        self.seams.push(false);
        EdgeId::new(self.seams.len() - 1)
    }

    #[inline]
    fn new_face(&mut self, kind: FaceKind) -> FaceId {
        let face = Face { start: Link::FREE, plane: NONE, group: NONE, kind };
        self.holes += usize::from(kind == FaceKind::Hole);
        if let Some(f) = self.free_faces.pop() {
            self.faces[f.index()] = face;
            return f;
        }
        self.faces.push(face);
        FaceId::new(self.faces.len() - 1)
    }

    /// A new face of the same kind, plane and group as `f`.
    fn new_face_like(&mut self, f: FaceId) -> FaceId {
        let Face { plane, group, kind, .. } = self.faces[f.index()];
        let new = self.new_face(kind);
        self.faces[new.index()].plane = plane;
        self.faces[new.index()].group = group;
        new
    }

    #[inline]
    fn free_vertex(&mut self, v: VertexId) {
        self.vertices[v.index()].start = Link::FREE;
        self.free_vertices.push(v);
    }

    #[inline]
    fn free_edge(&mut self, e: EdgeId) {
        for h in e.half_edges() {
            let slot = &mut self.half_edges[h.index()];
            slot.next = HalfEdgeId(NONE);
            slot.prev = HalfEdgeId(NONE);
        }
        self.free_edges.push(e);
    }

    #[inline]
    fn free_face(&mut self, f: FaceId) {
        self.set_kind(f, FaceKind::Solid);
        self.faces[f.index()].start = Link::FREE;
        self.free_faces.push(f);
    }
}

fn retain<T>(values: &mut Vec<T>, live: &[bool]) {
    let mut flags = live.iter();
    values.retain(|_| *flags.next().expect("one flag for each value"));
}
