//! Folds that leave one piece: a closed seam that does not separate, which only a surface with
//! handles can have.

use super::enumerate::{MATCHING_LIMIT, table};
use super::two_piece::{TwoPieceSearch, connected};
use super::{SeamError, fold_sum, piece_count};
use crate::measure::genus;
use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;

/// Seams that are looked at where there are too many matchings to list.
const SEAMS: usize = 500;
/// Up to this many vertices all matchings are listed.
const LISTED_VERTICES: usize = 64;

/// The choices of folds of a closed connected 3-valent mesh that leave one piece, least fold sum
/// first, up to the symmetry of the mesh.
///
/// On a sphere there are none: every closed curve separates it (Jordan), so with at least one
/// closed seam there are at least two pieces. With g handles a piece that is all of the surface has
/// Euler number 2 − 2g. For one handle it is therefore a ring, and its two rims are the two sides
/// of the one seam, which runs through every vertex. To lie flat, a ring opens at one more fold, so
/// the paper is one strip whose ends meet.
///
/// Meshes of up to 64 vertices and [`MATCHING_LIMIT`] matchings are searched in full. Of larger
/// ones the first 500 seams through all vertices are looked at that [`TwoPieceSearch`] meets.
///
/// # Errors
/// As [`super::hamiltonian_folds`]; [`SeamError::NoHandle`] for a sphere, [`SeamError::NoOnePiece`]
/// where all choices leave more.
pub fn one_piece_folds(
    mesh: &Mesh,
    progress: &dyn Progress,
) -> Result<Vec<Vec<EdgeId>>, SeamError> {
    connected(mesh)?;
    if genus(mesh) == 0 {
        return Err(SeamError::NoHandle);
    }
    if mesh.vertex_count() <= LISTED_VERTICES {
        match table(mesh, MATCHING_LIMIT, progress) {
            Ok(rows) => {
                let tried = rows.len();
                let found: Vec<_> =
                    rows.into_iter().filter(|r| r.pieces == 1).map(|r| r.folds).collect();
                return if found.is_empty() {
                    Err(SeamError::NoOnePiece { tried })
                } else {
                    Ok(found)
                };
            }
            Err(SeamError::TooMany { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    searched(mesh, progress)
}

fn searched(mesh: &Mesh, progress: &dyn Progress) -> Result<Vec<Vec<EdgeId>>, SeamError> {
    let mut search = TwoPieceSearch::new(mesh, progress)?;
    let mut found: Vec<(f64, Vec<EdgeId>)> = Vec::new();
    for tried in 0..SEAMS {
        let Some(folds) = search.next_candidate(progress) else {
            return if found.is_empty() && progress.is_cancelled() {
                Err(SeamError::Cancelled)
            } else if found.is_empty() {
                Err(SeamError::NoOnePiece { tried })
            } else {
                Ok(by_sum(found))
            };
        };
        if piece_count(mesh, &folds) == 1 {
            found.push((fold_sum(mesh, &folds), folds));
        }
    }
    if found.is_empty() { Err(SeamError::NoOnePiece { tried: SEAMS }) } else { Ok(by_sum(found)) }
}

fn by_sum(mut found: Vec<(f64, Vec<EdgeId>)>) -> Vec<Vec<EdgeId>> {
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    found.into_iter().map(|(_, folds)| folds).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{fixtures, is_perfect_matching, seam_cycles};
    use super::*;
    use crate::progress::Silent;

    #[test]
    fn on_a_torus_the_seam_runs_through_every_vertex_and_does_not_separate() {
        // The second has too many vertices to list.
        for mesh in [fixtures::hexagon_torus(3, 2), fixtures::hexagon_torus(8, 6)] {
            let all = one_piece_folds(&mesh, &Silent).expect("one piece");
            let sums: Vec<f64> = all.iter().map(|folds| fold_sum(&mesh, folds)).collect();
            assert!(sums.windows(2).all(|w| w[0] <= w[1] * (1.0 + 1e-9)), "{sums:?}");
            for folds in all {
                assert!(is_perfect_matching(&mesh, &folds));
                assert_eq!((piece_count(&mesh, &folds), seam_cycles(&mesh, &folds).len()), (1, 1));
            }
        }
    }

    #[test]
    fn a_sphere_has_none() {
        let refused = one_piece_folds(&fixtures::dodecahedron(), &Silent);
        assert_eq!(refused, Err(SeamError::NoHandle));
        assert!(SeamError::NoHandle.to_string().contains("separates"));
    }
}
