//! Plates that fit: where something does not, fingers and butt joints are taken away and corners
//! cut off, until no plate runs into itself or into another.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::collision::{collisions, crossing};
use super::cut::{Cutter, EdgeFallback};
use super::error::{Collision, Overlap, PanelError};
use super::finger::{Comb, combs};
use super::node::NodeCut;
use super::outline::FlatFace;
use super::overlap::{Shared, overlaps};
use super::part::part;
use super::plate::Plate;
use super::shape::{Shaped, shape};
use crate::mesh::{EdgeId, EdgeMap, FaceMap, VertexId};
use crate::net::PieceId;
use crate::progress::Progress;

/// Faces that are shaped between two looks at whether to stop.
const STRIDE: usize = 1024;

/// How often corners are cut off before plates that still overlap are refused. Once is the rule;
/// a second time comes where two partners need the same corner.
const ROUNDS: usize = 16;

/// All plates, and what was cut off so that they keep out of each other.
pub(super) struct Settled {
    pub shaped: Vec<Shaped>,
    pub cuts: Vec<NodeCut>,
}

/// Shapes all plates.
///
/// # Errors
/// [`PanelError::Collision`] and [`PanelError::Overlap`] where nothing is left to take away.
pub(super) fn settle(
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &mut Cutter<'_>,
    progress: &dyn Progress,
) -> Result<Settled, PanelError> {
    let mut cuts = NodeCuts::new();
    let mut rounds = 0;
    loop {
        let shaped = match try_shapes(faces, flat, cutter, progress)? {
            Ok(shaped) => shaped,
            Err(fallen) => {
                cuts.clear();
                fallen.into_iter().for_each(|(e, why)| cutter.fall_back(e, why));
                continue;
            }
        };
        let plates: Vec<&Plate> = shaped.iter().map(|s| &s.plate).collect();
        progress.report("overlaps", 0, 0);
        let found = overlaps(&plates, progress).ok_or(PanelError::Cancelled)?;
        if found.is_empty() {
            return Ok(Settled { shaped, cuts: cuts.into_values().collect() });
        }
        if rounds == ROUNDS {
            return Err(still_overlapping(&found, faces));
        }
        let parted = part(&found, faces, cutter)?;
        if parted.fallen.is_empty() {
            rounds += 1;
            parted.cuts.into_iter().for_each(|cut| add(&mut cuts, cut));
        } else {
            cuts.clear();
            parted.fallen.into_iter().for_each(|e| cutter.fall_back(e, EdgeFallback::Overlap));
        }
    }
}

/// Cuts at nodes, one for each vertex and pair of plates.
type NodeCuts = BTreeMap<(VertexId, [PieceId; 2]), NodeCut>;

fn add(cuts: &mut NodeCuts, cut: NodeCut) {
    let known = cuts.entry((cut.vertex, cut.panels)).or_insert_with(|| cut.clone());
    known.cut_mm = [0, 1].map(|k| known.cut_mm[k].max(cut.cut_mm[k]));
}

fn still_overlapping(found: &[Shared], faces: &[FlatFace]) -> PanelError {
    let overlap = |shared: &Shared| Overlap {
        faces: shared.plates.map(|i| faces[i].face),
        vertex: None,
        mm3: shared.volume,
    };
    PanelError::Overlap { found: found.iter().map(overlap).collect() }
}

/// What was tried: the plates, or the edges that must give way and why.
type Tried = Result<Vec<Shaped>, Vec<(EdgeId, EdgeFallback)>>;

/// Shapes all plates with the joints as they stand.
fn try_shapes(
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &Cutter<'_>,
    progress: &dyn Progress,
) -> Result<Tried, PanelError> {
    let found = of_all(faces, progress, |face| collisions(face, cutter))?.concat();
    if !found.is_empty() {
        return give_way(found, faces, flat, cutter).map(Err);
    }
    let combs = match combs(faces, flat, cutter) {
        Ok(combs) => combs,
        Err(short) => return Ok(Err(with_reason(short, EdgeFallback::Short))),
    };
    let shaped = of_all(faces, progress, |face| shape(face, cutter, &combs))?;
    let crossed = |(face, s): (&FlatFace, &Shaped)| crossed_fingers(face, &s.plate, &combs);
    let narrow: BTreeSet<EdgeId> = faces.iter().zip(&shaped).flat_map(crossed).collect();
    if narrow.is_empty() {
        return Ok(Ok(shaped));
    }
    Ok(Err(with_reason(narrow, EdgeFallback::Narrow)))
}

/// The same asked of all faces, on all cores; the answers in the order of the faces.
fn of_all<T: Send>(
    faces: &[FlatFace],
    progress: &dyn Progress,
    ask: impl Fn(&FlatFace) -> T + Sync,
) -> Result<Vec<T>, PanelError> {
    let done = AtomicUsize::new(0);
    let one = |face: &FlatFace| {
        let before = done.fetch_add(1, Ordering::Relaxed);
        if before.is_multiple_of(STRIDE) {
            progress.report("plates", before, faces.len());
            if progress.is_cancelled() {
                return Err(PanelError::Cancelled);
            }
        }
        Ok(ask(face))
    };
    faces.par_iter().map(one).collect()
}

fn with_reason(
    edges: impl IntoIterator<Item = EdgeId>,
    why: EdgeFallback,
) -> Vec<(EdgeId, EdgeFallback)> {
    edges.into_iter().map(|e| (e, why)).collect()
}

/// The edges that can give way where plates run into themselves.
fn give_way(
    mut found: Vec<Collision>,
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &Cutter<'_>,
) -> Result<Vec<(EdgeId, EdgeFallback)>, PanelError> {
    let special = |c: &Collision| special_edges(&faces[flat[c.face]], cutter, c.edge);
    let fallen: BTreeSet<EdgeId> = found.iter().flat_map(special).collect();
    if fallen.is_empty() {
        let share = |c: &Collision| c.largest / c.thickness;
        found.sort_by(|a, b| share(a).total_cmp(&share(b)));
        return Err(PanelError::Collision { found });
    }
    Ok(with_reason(fallen, EdgeFallback::Narrow))
}

/// The edges beside a collision that could be something else: those with fingers or butt joints.
fn special_edges(face: &FlatFace, cutter: &Cutter<'_>, at: Option<EdgeId>) -> Vec<EdgeId> {
    let edge = |i: usize| face.half_edges[i % face.len()].edge();
    let here = (0..face.len()).find(|&i| at == Some(edge(i)));
    let near: Vec<EdgeId> = match here {
        Some(i) => vec![edge(face.before(i)), edge(i), edge(i + 1)],
        None => (0..face.len()).map(edge).collect(),
    };
    near.into_iter().filter(|&e| cutter.is_special(e)).collect()
}

/// The fingered edges of a plate whose outline crosses itself.
fn crossed_fingers(face: &FlatFace, plate: &Plate, combs: &EdgeMap<Option<Comb>>) -> Vec<EdgeId> {
    let fingered: Vec<EdgeId> =
        face.half_edges.iter().map(|h| h.edge()).filter(|&e| combs[e].is_some()).collect();
    if fingered.is_empty() {
        return fingered;
    }
    let crossings: Vec<usize> = [&plate.front, &plate.back]
        .into_iter()
        .filter_map(|outline| crossing(outline))
        .flat_map(|(a, b)| [a, b])
        .collect();
    let side = |at: usize| {
        plate.begins.partition_point(|&b| b <= at).checked_sub(1).unwrap_or(face.len() - 1)
    };
    let near: Vec<EdgeId> = crossings
        .iter()
        .map(|&at| face.half_edges[side(at)].edge())
        .filter(|e| fingered.contains(e))
        .collect();
    // Where sides without fingers cross, something else must give: then all of them.
    if !crossings.is_empty() && near.is_empty() { fingered } else { near }
}
