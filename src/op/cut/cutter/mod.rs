//! The workspace of cuts: the mesh with what each of its elements is to the cut at hand.
//!
//! It lives through a whole chain of cuts: its tables are stamped with the number of the cut
//! instead of being cleared, so that a local cut costs time in proportion to what it removes. How a
//! cut goes is said in `reach.rs`.

mod asked;
mod crossing;
mod elements;
mod record;
mod shape;
mod side;

pub(in crate::op) use asked::SlicingPlane;
pub use asked::{Capping, Reach};
pub(super) use crossing::End;
pub(in crate::op) use record::{Cut, Lineage};

use side::StampedSide;

#[cfg(test)]
use crate::geom::Side;
use crate::geom::{Plane, RoundingBound};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};

/// What a cut of one corner needs to look at, kept from cut to cut.
#[derive(Clone, Default)]
pub(in crate::op::cut) struct CornerWork {
    pub(in crate::op::cut) outgoing: Vec<HalfEdgeId>,
    pub(in crate::op::cut) planes: Vec<Option<Plane>>,
    /// The far ends of the edges.
    pub(in crate::op::cut) ends: Vec<End>,
    pub(in crate::op::cut) places: Vec<glam::DVec3>,
    pub(in crate::op::cut) corners: Vec<VertexId>,
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
    /// What is known about the shapes of faces, see `shape.rs`.
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

    /// Whether there is nothing but closed surfaces with edges.
    pub(super) fn is_all_solid(&self) -> bool {
        self.mesh.is_closed() && self.is_open.is_none()
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
