//! The choices of folds of a D-form, in the order in which they are carved.

use super::dform::MatchingChoice;
use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;
use crate::seam::{
    MATCHING_LIMIT, SeamError, flattest_matching, fold_sum, hamiltonian_folds, is_perfect_matching,
    least_matching, matching, one_piece_folds, piece_count, table, two_piece_bound,
};
use crate::unfold::{MeshSource, PiecesMode, Seams, UnfoldParams, unfold};

/// Up to this many vertices all two-piece seams are candidates; of larger meshes only the best one
/// found, and one whose pieces lie flat.
const LISTED_VERTICES: usize = 64;

/// Choices of folds in the order in which they are tried.
pub(super) struct Candidates {
    pub folds: Vec<Vec<EdgeId>>,
    pub notes: Vec<String>,
}

/// The folds that a choice means.
pub(super) fn candidates(
    mesh: &Mesh,
    choice: MatchingChoice,
    progress: &dyn Progress,
) -> Result<Candidates, SeamError> {
    let one = |folds| Candidates { folds: vec![folds], notes: Vec::new() };
    match choice {
        MatchingChoice::Least => least_matching(mesh, progress).map(one),
        MatchingChoice::Flattest => flattest_matching(mesh, progress).map(one),
        MatchingChoice::Row(row) => matching(mesh, row, progress).map(one),
        MatchingChoice::OnePiece => {
            Ok(Candidates { folds: one_piece_folds(mesh, progress)?, notes: Vec::new() })
        }
        MatchingChoice::TwoPieces => match hamiltonian_folds(mesh, progress) {
            Ok(folds) => {
                let (folds, note) = judged(mesh, folds, progress)?;
                Ok(Candidates { notes: vec![note], ..two_pieces(mesh, folds, progress) })
            }
            Err(
                why @ (SeamError::NoHamiltonian { .. }
                | SeamError::SearchStopped { .. }
                | SeamError::SeveralComponents { .. }),
            ) => {
                let notes = vec![format!("the least matching was taken: {why}")];
                Ok(Candidates { notes, ..one(least_matching(mesh, progress)?) })
            }
            Err(error) => Err(error),
        },
    }
}

/// The folds of a two-piece seam, or better ones, and how good they are in words.
fn judged(
    mesh: &Mesh,
    folds: Vec<EdgeId>,
    progress: &dyn Progress,
) -> Result<(Vec<EdgeId>, String), SeamError> {
    let bound = two_piece_bound(mesh, &folds, progress)?;
    if let Some(best) = bound.best {
        let is_known = fold_sum(mesh, &best) >= fold_sum(mesh, &folds) * (1.0 - 1e-9);
        let folds = if is_known { folds } else { best };
        return Ok((
            folds,
            format!(
                "no two-piece seam has a fold sum below {:.2} rad·mm, and one has it",
                bound.lower
            ),
        ));
    }
    let above = 100.0 * (fold_sum(mesh, &folds) / bound.lower - 1.0);
    let note = format!(
        "no two-piece seam has a fold sum below {:.2} rad·mm: the best that was found is at \
        most {above:.1} % above the least",
        bound.lower
    );
    Ok((folds, note))
}

/// The best two-piece seam first, then all others of a small mesh; of a large one another that the
/// unfolder has laid out without overlap.
fn two_pieces(mesh: &Mesh, best: Vec<EdgeId>, progress: &dyn Progress) -> Candidates {
    let pieces = piece_count(mesh, &best);
    let mut folds = vec![best];
    if mesh.vertex_count() <= LISTED_VERTICES
        && let Ok(rows) = table(mesh, MATCHING_LIMIT, progress)
    {
        let others = rows
            .into_iter()
            .filter(|r| r.pieces == pieces && r.seam_cycles == 1 && r.folds != folds[0]);
        let others: Vec<_> = others.map(|r| r.folds).collect();
        folds.extend(others);
    } else {
        folds.extend(laid_flat(mesh, pieces, progress).filter(|found| *found != folds[0]));
    }
    Candidates { folds, notes: Vec::new() }
}

/// Folds whose pieces lie flat before they are carved, and so while little is carved off.
fn laid_flat(mesh: &Mesh, pieces: usize, progress: &dyn Progress) -> Option<Vec<EdgeId>> {
    let params = UnfoldParams { pieces: PiecesMode::Count(pieces), ..UnfoldParams::default() };
    let net = unfold(mesh, &Seams::Free, &params, &MeshSource::default(), progress).ok()?;
    let mut folds: Vec<EdgeId> = net.folds.iter().map(|fold| EdgeId::new(fold.id.0)).collect();
    folds.sort_unstable();
    is_perfect_matching(mesh, &folds).then_some(folds)
}
