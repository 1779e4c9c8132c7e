//! Seams as D-forms have them: in a closed 3-valent mesh one edge at every vertex folds, the two
//! others are seam.
//!
//! The folds are a perfect matching of the vertices. For strips it is the flattest; for two pieces
//! it leaves one seam through all vertices (a Hamiltonian cycle). See [`crate::seam`].

use super::dual::Dual;
use super::layout::Layout;
use super::{Seams, UnfoldError, UnfoldParams, split, start};
use crate::measure::fold_angle;
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::progress::Progress;
use crate::seam::{SeamError, TwoPieceSearch, fold_sum, least_matching_by};

/// Seams of two pieces that are laid out for each step of effort before one without overlap is
/// found.
const CANDIDATES: usize = 200;
/// Overlaps of one layout from which the search learns, those with the shortest paths.
const LEARNT: usize = 500;
/// How much heavier a fold becomes that made faces overlap.
const HEAVIER: f64 = 1.5;

/// Two pieces whose seam runs through every vertex, of those found the one with the least sum of
/// fold angle × length. `None` when the mesh or the seams do not allow that kind of search, or the
/// search was given up.
pub(super) fn two_pieces<'a>(
    dual: &'a Dual,
    mesh: &Mesh,
    seams: &Seams,
    params: &UnfoldParams,
    progress: &dyn Progress,
) -> Result<Option<Layout<'a>>, UnfoldError> {
    let is_sphere = mesh.vertex_count() + mesh.face_count() == mesh.edge_count() + 2;
    if !is_cubic(mesh) || !is_sphere || !seams.is_searched() {
        return Ok(None);
    }
    let Ok(mut search) = TwoPieceSearch::new(mesh, progress) else { return Ok(None) };
    constrain(&mut search, mesh, seams);
    let effort = params.effort.max(1) as usize;
    let (mut best, mut found, mut overlapping): (Option<(f64, Layout)>, usize, usize) =
        (None, 0, 0);
    while found < effort && (found > 0 || overlapping < CANDIDATES * effort) {
        let Some(folds) = search.next_candidate(progress) else { break };
        let layout = lay(dual, mesh, &folds);
        if layout.overlaps.is_empty() {
            let sum = fold_sum(mesh, &folds);
            if best.as_ref().is_none_or(|b| sum < b.0) {
                best = Some((sum, layout));
            }
            found += 1;
        } else {
            overlapping += 1;
            // Once there is a net, every further look counts.
            found += usize::from(found > 0);
            learn(&mut search, &layout);
        }
    }
    if let Some((_, layout)) = best {
        let layout = layout.fresh();
        return Ok(layout.overlaps.is_empty().then_some(layout));
    }
    match (search.is_exhausted(), overlapping, search.proof()) {
        (false, ..) => Ok(None),
        (true, 0, proof) => Err(SeamError::NoHamiltonian { proof }.into()),
        (true, _, proof) => Err(UnfoldError::NoFlatTwoPieces { overlapping, proof }),
    }
}

/// Tells the search which edges must fold and which must not.
fn constrain(search: &mut TwoPieceSearch, mesh: &Mesh, seams: &Seams) {
    let Seams::Within { keep, cut } = seams else { return };
    for &e in cut {
        search.forbid_folds_together(&[e]);
    }
    for &e in keep {
        for v in mesh.edge_vertices(e) {
            let others = mesh.outgoing(v).map(|h| h.edge()).filter(|&other| other != e);
            others.for_each(|other| search.forbid_folds_together(&[other]));
        }
    }
}

/// The folds on the path between two faces that overlap cannot all be folds.
fn learn(search: &mut TwoPieceSearch, layout: &Layout) {
    let mut paths: Vec<Vec<EdgeId>> =
        layout.overlaps.iter().map(|&pair| path(layout, pair)).collect();
    paths.sort_by_key(Vec::len);
    paths.truncate(LEARNT);
    paths.iter().for_each(|folds| search.forbid_folds_together(folds));
}

/// The folds between two faces of one piece.
fn path(layout: &Layout, (f, g): (u32, u32)) -> Vec<EdgeId> {
    let mut folds = Vec::new();
    layout.forest.path(layout.dual, f, g, &mut folds);
    folds.into_iter().map(|c| layout.dual.edge(layout.forest.parent_side[c as usize])).collect()
}

/// The strips of a closed 3-valent mesh: the folds are the flattest choice of one at every vertex.
/// By angle alone: with the length as a factor, short sharp edges would be lighter than the long
/// flat folds of a strip (on a carved D-form, 60° × 1 mm is less than 4° × 85 mm, though a maker
/// folds the latter).
///
/// A ring of faces opens at its best fold. Where a piece overlaps itself, the sharpest fold between
/// the faces in question is made heavier and another choice is tried; in the end the one that needs
/// the fewest pieces is divided. `None` when the mesh is not closed and 3-valent, when it has no
/// such folds, or when the seams are given.
pub(super) fn strips<'a>(
    dual: &'a Dual,
    mesh: &Mesh,
    seams: &Seams,
    params: &UnfoldParams,
    progress: &dyn Progress,
) -> Option<Layout<'a>> {
    if !is_cubic(mesh) || !seams.is_searched() {
        return None;
    }
    let mut weight = strip_weights(mesh, seams);
    let mut best: Option<Layout> = None;
    for round in 0..=params.effort {
        let folds = least_matching_by(mesh, |e| weight[e], progress).ok()?;
        let mut layout = lay(dual, mesh, &folds);
        for &pair in &layout.overlaps {
            let sharpest =
                path(&layout, pair).into_iter().max_by(|&a, &b| weight[a].total_cmp(&weight[b]));
            sharpest.into_iter().for_each(|e| weight[e] *= HEAVIER);
        }
        let is_flat = layout.overlaps.is_empty();
        split::split_overlaps(&mut layout);
        let pieces = layout.forest.roots().len();
        if best.as_ref().is_none_or(|b| pieces < b.forest.roots().len()) {
            best = Some(layout);
        }
        if is_flat || progress.is_cancelled() {
            break;
        }
        progress.report("choosing strips", round as usize + 1, params.effort as usize + 1);
    }
    best
}

fn strip_weights(mesh: &Mesh, seams: &Seams) -> EdgeMap<f64> {
    let mut weight = EdgeMap::filled(mesh.edge_slots(), 0.0);
    mesh.edges().for_each(|e| weight[e] = fold_angle(mesh, e).unwrap_or(0.0).abs());
    if let Seams::Within { keep, cut } = seams {
        // More than all the other folds together.
        let decisive = std::f64::consts::PI * mesh.edge_count() as f64;
        keep.iter().for_each(|&e| weight[e] = -decisive);
        cut.iter().for_each(|&e| weight[e] = decisive);
    }
    weight
}

fn is_cubic(mesh: &Mesh) -> bool {
    mesh.is_closed() && mesh.vertices().all(|v| mesh.valence(v) == 3)
}

fn lay<'a>(dual: &'a Dual, mesh: &Mesh, folds: &[EdgeId]) -> Layout<'a> {
    let mut is_fold = EdgeMap::filled(mesh.edge_slots(), false);
    folds.iter().for_each(|&e| is_fold[e] = true);
    Layout::new(dual, start::folded(dual, &is_fold), usize::MAX).expect("no limit, no giving up")
}
