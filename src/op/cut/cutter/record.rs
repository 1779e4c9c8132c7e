//! What the last cut did, and where faces and vertices come from.

use super::{Cutter, StampedSide};
use crate::geom::Side;
use crate::mesh::{FaceId, VertexId};

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
    pub(in crate::op::cut) fn clear(&mut self) {
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
pub(in crate::op) struct Lineage(pub(super) u32);

impl Cutter {
    /// What the last cut did.
    pub(in crate::op) fn last_cut(&self) -> &Cut {
        &self.done
    }

    /// Takes the caps of the last cut out of its record.
    pub(in crate::op) fn take_caps(&mut self) -> Vec<FaceId> {
        std::mem::take(&mut self.done.caps)
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

    pub(in crate::op::cut) fn describe_removed(&mut self) {
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
    pub(in crate::op::cut) fn cut_of_cap(&self, f: FaceId) -> Option<usize> {
        let lineage = self.lineage[f.index()].checked_sub(1)?;
        lineage.checked_sub(self.faces_before).map(|cut| cut as usize)
    }

    /// The cut of this round, counted from 0, that made a vertex.
    pub(in crate::op::cut) fn cut_of_vertex(&self, v: VertexId) -> Option<usize> {
        self.born[v.index()].checked_sub(1).map(|cut| cut as usize)
    }

    pub(in crate::op::cut) fn describe_touches(&mut self) {
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
}
