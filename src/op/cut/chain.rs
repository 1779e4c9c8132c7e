//! A chain of cuts on one mesh, in place: for callers who choose every plane themselves.
//!
//! The workspace of the cutting operator lives through the whole chain, so a local cut costs time
//! in proportion to what it removes, however large the mesh is. Ids of what is not cut stay as they
//! are until [`CutChain::finish`].

use glam::DVec3;

use super::cutter::{Cutter, Reach, SlicingPlane};
use crate::geom::Plane;
use crate::mesh::{FaceId, Mesh};
use crate::op::{Capping, OpError};

/// A mesh that is cut by one plane after the other.
///
/// ```
/// use glam::DVec3;
/// use kerfold::op::{CutChain, Reach};
///
/// let mut chain = CutChain::new(kerfold::shape::cube(10.0));
/// let cap = chain.cut_given(DVec3::X, DVec3::ZERO, Reach::Global)?[0];
/// assert_eq!(chain.mesh().sides(cap), 4);
/// let half = chain.finish();
/// assert_eq!(half.face_count(), 6);
/// # Ok::<(), kerfold::op::OpError>(())
/// ```
pub struct CutChain {
    cutter: Cutter,
}

impl CutChain {
    /// Begins a chain. Takes the mesh as it is, so nothing is copied.
    pub fn new(mesh: Mesh) -> Self {
        Self::with_capping(mesh, Capping::Auto)
    }

    /// Begins a chain whose cuts close their wounds as `capping` says.
    pub fn with_capping(mesh: Mesh, capping: Capping) -> Self {
        let mut cutter = Cutter::new(mesh);
        cutter.capping = capping;
        Self { cutter }
    }

    /// Makes room for so many cuts to come, where they take off corners with three edges. Optional:
    /// it saves moving growing tables.
    pub fn reserve(&mut self, cuts: usize) {
        self.cutter.reserve(cuts);
    }

    /// The mesh as it is now. Slots of what was removed are free until [`Self::finish`].
    pub fn mesh(&self) -> &Mesh {
        &self.cutter.mesh
    }

    /// Cuts with a constructed plane: what lies within the rounding bound counts as on it. Returns
    /// the caps, none if the plane missed. A cut may remove everything.
    pub fn cut(&mut self, plane: &Plane, reach: Reach<'_>) -> &[FaceId] {
        self.cutter.cut(&SlicingPlane { plane: *plane, given: None }, reach);
        &self.cutter.done.caps
    }

    /// Cuts with a plane whose numbers are given, not computed: on which side given vertices lie is
    /// exact.
    ///
    /// # Errors
    /// [`OpError::NoDirection`] and [`OpError::BadPoint`] for numbers that are no plane.
    pub fn cut_given(
        &mut self,
        normal: DVec3,
        point: DVec3,
        reach: Reach<'_>,
    ) -> Result<&[FaceId], OpError> {
        let plane = SlicingPlane::given(normal, point)?;
        self.cutter.cut(&plane, reach);
        Ok(&self.cutter.done.caps)
    }

    /// How many holes of the last cut's section could not be joined to their cap, because the mesh
    /// touches or crosses itself there; each has a face of its own that lies on the cap and looks
    /// the other way.
    pub fn lids(&self) -> usize {
        self.cutter.done.lids
    }

    /// Closes the gaps that the cuts left and hands the mesh out.
    pub fn finish(self) -> Mesh {
        let mut mesh = self.cutter.mesh;
        mesh.compact();
        mesh
    }
}
