//! The one cutting operator: takes off what lies on the normal side of a plane and closes the
//! wound.
//!
//! Source: Gonen 2007, III.A, made exact and general as `docs/operators.md` says. Three steps for
//! each plane: *reach* (which vertices lie on the normal side and are connected with the chosen
//! element), *divide* (faces that lie on both sides are divided along the plane, `divide.rs`),
//! *close* (the region in front is replaced by caps, `section.rs`).
//!
//! The workspace lives through a whole chain of cuts: its tables are stamped with the number of the
//! cut instead of being cleared, so that a local cut costs time in proportion to what it removes.

mod crossing;

pub(super) use crossing::End;

use glam::DVec3;
use serde::Deserialize;

use super::corner::CornerWork;
use crate::geom::predicate::side_of_plane;
use crate::geom::{Plane, RoundingBound, Side};
use crate::mesh::{EdgeId, FaceId, FaceKind, HalfEdgeId, Mesh, VertexId};
use crate::op::OpError;

/// A slicing plane with what is known about its numbers.
#[derive(Debug, Clone, Copy)]
pub(in crate::op) struct SlicingPlane {
    /// The plane; its normal side is removed.
    pub plane: Plane,
    /// Normal and point as the user gave them, when they were given and not constructed: then signs
    /// are exact.
    pub given: Option<(DVec3, DVec3)>,
}

impl SlicingPlane {
    /// The plane of given numbers; `normal` may have any length.
    pub(in crate::op) fn given(normal: DVec3, point: DVec3) -> Result<Self, OpError> {
        if !point.is_finite() {
            return Err(OpError::BadPoint(point.x, point.y, point.z));
        }
        let plane =
            Plane::new(normal, point).ok_or(OpError::NoDirection(normal.x, normal.y, normal.z))?;
        Ok(Self { plane, given: Some((normal, point)) })
    }
}

/// How far a cut reaches.
#[derive(Debug, Clone, Copy)]
pub enum Reach<'a> {
    /// The whole mesh.
    Global,
    /// Only the part of the normal side connected with these vertices.
    Local(&'a [VertexId]),
}

/// Which walks of a section are closed by caps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Capping {
    /// Parts that were closed get caps, parts that were open stay open along the cut.
    #[default]
    Auto,
    /// Every loop of the section gets a cap, but for those that run into an old rim.
    Always,
    /// No caps: the cut leaves rims.
    Never,
}

/// What one cut did.
#[derive(Debug, Clone, Default)]
pub(in crate::op) struct Cut {
    /// The faces that close the wound; holes of open parts are not among them.
    pub caps: Vec<FaceId>,
    /// The vertices of the mesh before this command that were removed, ascending.
    pub removed: Vec<VertexId>,
    /// Whether the plane missed, or the element was gone: nothing changed.
    pub is_miss: bool,
    /// The earlier cuts of the round, by number, of which this one removed something that they had
    /// made.
    pub met: Vec<usize>,
    /// The earlier cuts of the round, by number, of which a vertex is a corner of this one's caps,
    /// too.
    pub touched: Vec<usize>,
    /// How many holes of the section could not be joined to their cap, because the mesh touches or
    /// crosses itself there: each has a face of its own, which lies on the cap and looks the other
    /// way.
    pub lids: usize,
    /// Whether a vertex from before the round is a corner of the caps.
    pub ends_at_vertex: bool,
}

impl Cut {
    fn clear(&mut self) {
        self.caps.clear();
        self.removed.clear();
        self.met.clear();
        self.touched.clear();
        self.lids = 0;
        (self.is_miss, self.ends_at_vertex) = (false, false);
    }
}

/// Where a face comes from: a face of the mesh before the command, or the cap of the n-th cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(in crate::op) struct Lineage(u32);

/// The number of a cut and a side in one word. Zero stands for "not asked yet", so that a new table
/// costs nothing until it is used; the same holds for the other tables of the workspace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct StampedSide(u32);

impl StampedSide {
    fn new(cut: u32, side: Side) -> Self {
        let code = match side {
            Side::On => 0,
            Side::Normal => 1,
            Side::Reverse => 2,
        };
        Self(cut << 2 | code)
    }

    fn of_cut(self, cut: u32) -> Option<Side> {
        (self.0 >> 2 == cut).then_some(match self.0 & 3 {
            0 => Side::On,
            1 => Side::Normal,
            _ => Side::Reverse,
        })
    }
}

/// The workspace of a chain of cuts.
#[derive(Clone)]
pub(in crate::op) struct Cutter {
    pub(super) mesh: Mesh,
    pub(super) bound: f64,
    /// The largest coordinate, by magnitude.
    largest: f64,
    pub(super) capping: Capping,
    pub(super) cut: u32,
    /// What the last cut did.
    pub(super) done: Cut,
    faces_before: u32,
    /// [`StampedSide`]s.
    sides: Vec<u32>,
    pub(super) born: Vec<u32>,
    /// Zero for a face of its own lineage, else the lineage plus one.
    lineage: Vec<u32>,
    /// What is known about the shapes of faces, see `corner.rs`.
    pub(super) shapes: Vec<u8>,
    pub(super) doomed: Vec<u32>,
    pub(super) decided: Vec<u32>,
    is_open: Option<Vec<bool>>,
    pub(super) region: Vec<FaceId>,
    pub(super) reached: Vec<VertexId>,
    pub(super) chords: Vec<EdgeId>,
    pub(super) splits: Vec<VertexId>,
    pub(super) corner: CornerWork,
    /// For tests: sides that override what the numbers say.
    #[cfg(test)]
    pub(super) pattern: Vec<Side>,
    /// For tests: how many vertices were classified.
    #[cfg(test)]
    pub(super) classified: usize,
}

/// A table of zeros with room for a sixteenth more, as a copied mesh has it; memory that no cut
/// asks for is never touched.
fn zeros<T: Copy + Default>(count: usize) -> Vec<T> {
    let mut table = vec![T::default(); count + count / 16];
    table.truncate(count);
    table
}

impl Cutter {
    pub(in crate::op) fn new(mesh: Mesh) -> Self {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let faces = mesh.face_slots();
        let is_open = (!mesh.is_closed()).then(|| open_vertices(&mesh));
        Self {
            bound: RoundingBound::of_box(low, high).length(),
            largest: low.abs().max(high.abs()).max_element(),
            capping: Capping::Auto,
            cut: 0,
            done: Cut::default(),
            faces_before: faces as u32,
            sides: zeros(mesh.vertex_slots()),
            born: zeros(mesh.vertex_slots()),
            lineage: zeros(faces),
            shapes: zeros(faces),
            doomed: zeros(faces),
            decided: zeros(faces),
            is_open,
            region: Vec::new(),
            reached: Vec::new(),
            chords: Vec::new(),
            splits: Vec::new(),
            corner: CornerWork::default(),
            #[cfg(test)]
            pattern: Vec::new(),
            #[cfg(test)]
            classified: 0,
            mesh,
        }
    }

    /// The mesh as it is by now.
    pub(in crate::op) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The mesh, to be moved or relabelled between cuts; its links are for cuts alone.
    pub(in crate::op) fn mesh_mut(&mut self) -> &mut Mesh {
        &mut self.mesh
    }

    /// The mesh, when all cuts are done.
    pub(in crate::op) fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// Which walks of a section later cuts close.
    pub(in crate::op) fn set_capping(&mut self, capping: Capping) {
        self.capping = capping;
    }

    /// How near to a plane a constructed vertex counts as on it, in mm.
    pub(in crate::op) fn bound(&self) -> f64 {
        self.bound
    }

    /// What the last cut did.
    pub(in crate::op) fn last_cut(&self) -> &Cut {
        &self.done
    }

    /// Takes the caps of the last cut out of its record.
    pub(in crate::op) fn take_caps(&mut self) -> Vec<FaceId> {
        std::mem::take(&mut self.done.caps)
    }

    /// Makes room for so many cuts of corners with three edges: two vertices, three edges and a
    /// face more for each. Slots that earlier cuts left free count; other cuts only find their room
    /// sooner.
    pub(in crate::op) fn reserve(&mut self, cuts: usize) {
        self.mesh.reserve(2 * cuts, 3 * cuts, cuts);
        for (table, room) in [
            (&mut self.sides, 2 * cuts),
            (&mut self.born, 2 * cuts),
            (&mut self.lineage, cuts),
            (&mut self.doomed, cuts),
            (&mut self.decided, cuts),
        ] {
            table.reserve(room);
        }
        self.shapes.reserve(cuts);
    }

    /// Forgets what was made so far: the mesh as it is now becomes "the mesh before the command".
    pub(in crate::op) fn start_round(&mut self) {
        self.cut = 0;
        self.faces_before = self.mesh.face_slots() as u32;
        self.lineage.clear();
        self.lineage.resize(self.mesh.face_slots(), 0);
        self.born.fill(0);
        self.sides.fill(0);
        self.doomed.fill(0);
        self.decided.fill(0);
    }

    /// The lineage of a face of the mesh before the round.
    pub(in crate::op) fn lineage_of(&self, f: FaceId) -> Lineage {
        match self.lineage[f.index()] {
            0 => Lineage(f.index() as u32),
            lineage => Lineage(lineage - 1),
        }
    }

    /// The face of the mesh before the round that a lineage names; nothing for that of a cap.
    pub(in crate::op) fn face_before(&self, lineage: Lineage) -> Option<FaceId> {
        (lineage.0 < self.faces_before).then(|| FaceId::new(lineage.0 as usize))
    }

    /// The lineage of the cap of the n-th cut of the round, counted from 0.
    pub(in crate::op) fn cap_lineage(&self, cut: usize) -> Lineage {
        Lineage(self.faces_before + cut as u32)
    }

    /// Whether the vertex was there before the round, and still is.
    pub(in crate::op) fn is_original(&self, v: VertexId) -> bool {
        self.mesh.has_vertex(v) && self.born[v.index()] == 0
    }

    /// Cuts with one plane; [`Self::done`] tells what happened. Whatever the signs and the
    /// positions are, the mesh is sound afterwards.
    pub(in crate::op) fn cut(&mut self, plane: &SlicingPlane, reach: Reach<'_>) {
        self.cut += 1;
        self.done.clear();
        if let Reach::Local(&[v]) = reach
            && self.cut_corner(plane, v)
        {
            return;
        }
        self.region.clear();
        self.reached.clear();
        self.chords.clear();
        self.splits.clear();
        if matches!(reach, Reach::Global) && self.is_all_solid() && self.cut_whole(plane) {
            return;
        }
        self.reach(plane, reach);
        if self.region.is_empty() {
            self.done.is_miss = true;
            return;
        }
        self.decide_flat_faces(plane, matches!(reach, Reach::Global));
        self.describe_removed();
        self.close(plane);
        self.describe_touches();
        self.undo_needless_divisions();
    }

    // ---- reach ----------------------------------------------------------------------------------

    /// On which side of the plane a vertex lies. Exact for given numbers; constructed ones within
    /// the bound are on it.
    pub(super) fn side(&mut self, plane: &SlicingPlane, v: VertexId) -> Side {
        if let Some(side) = StampedSide(self.sides[v.index()]).of_cut(self.cut) {
            return side;
        }
        let side = self.classify(plane, v);
        self.sides[v.index()] = StampedSide::new(self.cut, side).0;
        side
    }

    pub(super) fn classify(&mut self, plane: &SlicingPlane, v: VertexId) -> Side {
        self.unless_told(v, |cutter| cutter.classify_by_numbers(plane, v))
    }

    /// The side of a vertex for a constructed plane at a known distance.
    pub(super) fn side_at(&mut self, v: VertexId, distance: f64) -> Side {
        self.unless_told(v, |cutter| cutter.constructed_side(distance))
    }

    #[cfg(test)]
    fn unless_told(&mut self, v: VertexId, find: impl FnOnce(&Self) -> Side) -> Side {
        self.classified += 1;
        self.pattern.get(v.index()).copied().unwrap_or_else(|| find(self))
    }

    #[cfg(not(test))]
    #[inline]
    fn unless_told(&mut self, _: VertexId, find: impl FnOnce(&Self) -> Side) -> Side {
        find(self)
    }

    #[inline]
    fn constructed_side(&self, distance: f64) -> Side {
        if distance.abs() <= self.bound { Side::On } else { Side::of(distance) }
    }

    fn classify_by_numbers(&self, plane: &SlicingPlane, v: VertexId) -> Side {
        let x = self.mesh.position(v);
        let distance = plane.plane.signed_distance(x);
        match plane.given {
            Some((normal, point)) if self.mesh.is_given(v) => {
                if distance.abs() <= indistinct(x, point) {
                    Side::On
                } else {
                    side_of_plane(normal, point, x)
                }
            }
            _ => self.constructed_side(distance),
        }
    }

    /// Finds the side of every vertex, with no more than a distance for those that are clearly off
    /// the plane. Returns the vertices in front and those on the plane, ascending.
    pub(super) fn sweep_vertices(
        &mut self,
        plane: &SlicingPlane,
    ) -> (Vec<VertexId>, Vec<VertexId>) {
        let clear = self.bound + indistinct(DVec3::splat(self.largest), plane.plane.point());
        let is_by_numbers = self.goes_by_numbers();
        let (mut in_front, mut on) = (Vec::new(), Vec::new());
        for v in (0..self.mesh.vertex_slots()).map(VertexId::new) {
            if !self.mesh.has_vertex(v) {
                continue;
            }
            let distance = plane.plane.signed_distance(self.mesh.position(v));
            let is_clear = is_by_numbers && distance.abs() > clear;
            let side = if is_clear { Side::of(distance) } else { self.classify(plane, v) };
            self.sides[v.index()] = StampedSide::new(self.cut, side).0;
            match side {
                Side::Normal => in_front.push(v),
                Side::On => on.push(v),
                Side::Reverse => {}
            }
        }
        (in_front, on)
    }

    #[cfg(test)]
    fn goes_by_numbers(&self) -> bool {
        self.pattern.is_empty()
    }

    #[cfg(not(test))]
    fn goes_by_numbers(&self) -> bool {
        true
    }

    /// The side found for `v` in this cut; only for vertices that were asked before.
    pub(super) fn known_side(&self, v: VertexId) -> Side {
        let side = StampedSide(self.sides[v.index()]).of_cut(self.cut);
        side.expect("the side was asked in this cut")
    }

    /// Whether the tables of this cut know the vertex.
    pub(super) fn is_known(&self, v: VertexId) -> bool {
        self.sides
            .get(v.index())
            .is_some_and(|&stamped| StampedSide(stamped).of_cut(self.cut).is_some())
    }

    fn reach(&mut self, plane: &SlicingPlane, reach: Reach<'_>) {
        let mut queue: Vec<VertexId> = match reach {
            Reach::Global => {
                let all: Vec<VertexId> = self.mesh.vertices().collect();
                all.into_iter().filter(|&v| self.side(plane, v) == Side::Normal).collect()
            }
            Reach::Local(seeds) => {
                seeds.iter().copied().filter(|&v| self.side(plane, v) == Side::Normal).collect()
            }
        };
        let (mut corners, mut faces) = (Vec::new(), Vec::new());
        while let Some(v) = queue.pop() {
            corners.clear();
            corners.extend(self.mesh.outgoing(v));
            let is_untouched = |c: &Self, f: FaceId| c.doomed[f.index()] != c.cut;
            for &h in &corners {
                let f = self.mesh.face(h);
                if is_untouched(self, f) && !self.mesh.is_hole(f) {
                    self.divide_face_at(plane, v, h);
                }
            }
            // Dividing may have given the sectors around v new faces; they all lie in front of the
            // plane now.
            faces.clear();
            faces.extend(self.mesh.outgoing(v).map(|h| self.mesh.face(h)));
            for &f in &faces {
                if is_untouched(self, f) {
                    self.doom(f);
                    self.reach_corners(plane, f, &mut queue);
                }
            }
            if faces.is_empty() {
                self.doom_lone(v);
            }
        }
    }

    pub(super) fn doom(&mut self, f: FaceId) {
        self.doomed[f.index()] = self.cut;
        self.region.push(f);
    }

    fn doom_lone(&mut self, v: VertexId) {
        if let Some(f) = self.mesh.lone_face(v).filter(|f| self.doomed[f.index()] != self.cut) {
            self.reached.push(v);
            self.doom(f);
        }
    }

    /// Passes the walk on to the corners of a face in front. A rim is left where it leaves the
    /// front: what is connected only by a rim is not connected.
    fn reach_corners(&mut self, plane: &SlicingPlane, f: FaceId, queue: &mut Vec<VertexId>) {
        if self.mesh.is_hole(f) {
            return;
        }
        let corners: Vec<VertexId> = self.mesh.face_vertices(f).collect();
        for v in corners {
            if self.side(plane, v) == Side::Normal {
                // Asked again through every face; the stamp on the side keeps one visit each.
                self.visit(v, queue);
            }
        }
    }

    fn visit(&mut self, v: VertexId, queue: &mut Vec<VertexId>) {
        let has_unvisited_face =
            self.mesh.outgoing(v).any(|h| self.doomed[self.mesh.face(h).index()] != self.cut);
        if has_unvisited_face {
            queue.push(v);
        }
    }

    // ---- what was done --------------------------------------------------------------------------

    fn describe_removed(&mut self) {
        let mut seen = std::mem::take(&mut self.reached);
        let mut met = std::mem::take(&mut self.done.met);
        let in_front = StampedSide::new(self.cut, Side::Normal).0;
        for &f in &self.region {
            seen.extend(self.mesh.face_vertices(f).filter(|v| self.sides[v.index()] == in_front));
            met.extend(self.cut_of_cap(f));
        }
        seen.sort_unstable();
        seen.dedup();
        met.extend(seen.iter().filter_map(|&v| self.cut_of_vertex(v)));
        met.sort_unstable();
        met.dedup();
        self.done.met = met;
        self.done.removed.extend(seen.iter().filter(|v| self.born[v.index()] == 0));
        self.reached = seen;
    }

    /// The cut of this round, counted from 0, of whose cap a face is a part.
    pub(super) fn cut_of_cap(&self, f: FaceId) -> Option<usize> {
        let lineage = self.lineage[f.index()].checked_sub(1)?;
        lineage.checked_sub(self.faces_before).map(|cut| cut as usize)
    }

    /// The cut of this round, counted from 0, that made a vertex.
    pub(super) fn cut_of_vertex(&self, v: VertexId) -> Option<usize> {
        self.born[v.index()].checked_sub(1).map(|cut| cut as usize)
    }

    pub(super) fn describe_touches(&mut self) {
        for v in self.done.caps.iter().flat_map(|&f| self.mesh.face_vertices(f)) {
            match self.born[v.index()] {
                0 => self.done.ends_at_vertex = true,
                born if born != self.cut => self.done.touched.push(born as usize - 1),
                _ => {}
            }
        }
        self.done.touched.sort_unstable();
        self.done.touched.dedup();
    }

    /// Takes back divisions of faces of which neither side was removed: parts that a local cut did
    /// not reach.
    pub(super) fn undo_needless_divisions(&mut self) {
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

    // ---- elements that the steps make -----------------------------------------------------------

    /// Whether there is nothing but closed surfaces with edges.
    fn is_all_solid(&self) -> bool {
        self.mesh.is_closed() && self.is_open.is_none()
    }

    /// Divides an edge where it crosses the plane; returns the new vertex.
    pub(super) fn split_at_plane(&mut self, plane: &SlicingPlane, h: HalfEdgeId) -> VertexId {
        let point = self.crossing(plane, h);
        let end = self.mesh.origin(h);
        let (v, _) = self.mesh.split_edge(h.edge(), point);
        self.register_vertex(v, end);
        self.splits.push(v);
        v
    }

    /// Makes room in the tables for a new vertex, which is like `like` as far as rims are
    /// concerned.
    pub(super) fn register_vertex(&mut self, v: VertexId, like: VertexId) {
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
    pub(super) fn insert_chord(&mut self, from: HalfEdgeId, to: HalfEdgeId) -> HalfEdgeId {
        let parent = self.mesh.face(from);
        let e = self
            .mesh
            .insert_edge(crate::mesh::Corner::At(from), crate::mesh::Corner::At(to))
            .expect("half-edges are corners");
        self.register_face(self.mesh.face(e.half_edge()), self.lineage_of(parent));
        // What a line leaves of a convex face is convex; of other faces it may be anything.
        self.forget_shape_unless_convex(parent);
        self.chords.push(e);
        e.half_edge()
    }

    pub(super) fn register_face(&mut self, f: FaceId, lineage: Lineage) {
        for table in [&mut self.lineage, &mut self.doomed, &mut self.decided] {
            grow(table, f.index(), 0);
            table[f.index()] = 0;
        }
        grow(&mut self.shapes, f.index(), 0);
        self.shapes[f.index()] = 0;
        self.lineage[f.index()] = lineage.0 + 1;
    }

    /// Whether the component of `v` had a rim before the command, so that a cut leaves a rim, too.
    pub(super) fn is_open_at(&self, v: VertexId) -> bool {
        self.is_open
            .as_ref()
            .is_some_and(|is_open| is_open.get(v.index()).copied().unwrap_or(false))
    }

    /// Registers a face that closes a walk of the wound.
    pub(super) fn register_cap(&mut self, f: FaceId, kind: FaceKind, plane: &Plane) {
        let cap = self.cap_lineage(self.cut as usize - 1);
        self.register_face(f, cap);
        self.mesh.set_kind(f, kind);
        if kind == FaceKind::Solid {
            self.mesh.set_plane(f, *plane);
        }
    }
}

/// How near a given vertex may be to a given plane before the points where its edges cross the
/// plane can no longer be told from it: cutting there would make edges of no length, or swap points
/// that lie an ulp apart.
fn indistinct(x: DVec3, point: DVec3) -> f64 {
    64.0 * f64::EPSILON * x.abs().max(point.abs()).max_element()
}

fn grow<T: Clone>(table: &mut Vec<T>, index: usize, value: T) {
    if index >= table.len() {
        table.resize(index + 1, value);
    }
}

/// Marks the vertices of every component with a rim.
fn open_vertices(mesh: &Mesh) -> Vec<bool> {
    let mut is_open = vec![false; mesh.vertex_slots()];
    for component in mesh.components().into_iter().filter(|c| c.holes > 0) {
        for v in component.vertices {
            is_open[v.index()] = true;
        }
    }
    is_open
}
