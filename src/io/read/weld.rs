//! Making one vertex of those that lie together.

use super::raw::RawMesh;
use crate::mend::{remove_spikes, weld_targets};

/// What welding did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Welded {
    /// Number of vertices that went into others.
    pub vertices: usize,
    /// Number of faces that lost their area, and the first of them; they are dropped.
    pub faces: Option<(usize, usize)>,
}

/// Lets each vertex go into the nearest earlier one that stays and is at most `distance` away; 0
/// welds equal positions only. The vertices that stay are further apart than `distance`, keep their
/// numbers and do not move. The others have no face any more.
pub(super) fn weld(raw: &mut RawMesh, distance: f64) -> Welded {
    let target = weld_targets(&raw.positions, distance);
    let vertices = target.iter().enumerate().filter(|&(v, &t)| v != t as usize).count();
    // A number beyond the vertices is left for the builder to tell.
    let place = |v: u32| target.get(v as usize).copied().unwrap_or(v);
    let faces = raw.change_faces(|face| {
        let is_changed = face.iter().any(|&v| place(v) != v);
        if is_changed {
            face.iter_mut().for_each(|v| *v = place(*v));
            remove_spikes(face);
        }
    });
    for seam in &mut raw.seams {
        seam.ends = seam.ends.map(place);
    }
    raw.seams.retain(|seam| seam.ends[0] != seam.ends[1]);
    Welded { vertices, faces }
}
