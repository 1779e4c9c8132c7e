//! The two-piece seam whose folds bend least, as far as a fixed amount of work finds it.

use super::enumerate::Matchings;
use super::error::{NoHamiltonian, SeamError};
use super::exchange::Factor;
use super::graph::Graph;
use super::two_piece::{TwoPieceSearch, connected};
use super::weight::{fold_weight, quantised};
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::progress::Progress;

/// Up to this many vertices all matchings are listed, if they are not more than
/// [`LISTED_MATCHINGS`].
const LISTED_VERTICES: usize = 64;
/// See [`LISTED_VERTICES`].
const LISTED_MATCHINGS: usize = 20_000;
/// Matchings listed between two questions whether to go on.
const LISTED_AT_ONCE: usize = 256;
/// Conflicts that the search for a first seam may meet.
const CONFLICTS: u64 = 1_000_000;

/// The folds of a two-piece seam of a closed 3-valent mesh, ascending: one closed seam that runs
/// through every vertex once (a Hamiltonian cycle). On a sphere the pieces are two; on other
/// surfaces one or two.
///
/// Among these seams, one with a small sum of |fold angle| × length over the folds: the least of
/// all when the mesh has at most 64 vertices and 20 000 matchings (the lexicographically least of
/// several); else the first that [`TwoPieceSearch`] meets, improved by exchanges of up to 6 folds
/// (and up to 4 more where that splits the seam) for as long as that helps, within a fixed amount
/// of work. No clock takes part: the same mesh gives the same folds.
///
/// # Errors
/// As [`super::least_matching`]; [`SeamError::SeveralComponents`]; [`SeamError::NoHamiltonian`]
/// with a proof; [`SeamError::SearchStopped`] when a million conflicts were not enough to tell;
/// [`SeamError::Cancelled`] before a seam was found. Cancelled later, it returns the best so far.
pub fn hamiltonian_folds(mesh: &Mesh, progress: &dyn Progress) -> Result<Vec<EdgeId>, SeamError> {
    let graph = connected(mesh)?;
    let weights: Vec<f64> = graph.edge_ids.iter().map(|&e| fold_weight(mesh, e)).collect();
    let weights = quantised(&weights, graph.vertex_ids.len());
    if let Some(result) = listed(mesh, &graph, &weights, progress) {
        return result;
    }
    let mut search = TwoPieceSearch::new(mesh, progress)?;
    match search.next_within(CONFLICTS, progress) {
        Some(folds) => {
            let mut factor = Factor::new(&graph, &weights, search.numbers(&folds));
            factor.save(progress);
            Ok(graph.ids(factor.folds()))
        }
        None if progress.is_cancelled() => Err(SeamError::Cancelled),
        None if search.is_exhausted() => Err(SeamError::NoHamiltonian { proof: search.proof() }),
        None => Err(SeamError::SearchStopped { conflicts: CONFLICTS }),
    }
}

/// The exact answer of small meshes; `None` when there is too much to list.
fn listed(
    mesh: &Mesh,
    graph: &Graph,
    weights: &[i64],
    progress: &dyn Progress,
) -> Option<Result<Vec<EdgeId>, SeamError>> {
    if graph.vertex_ids.len() > LISTED_VERTICES {
        return None;
    }
    let mut number = EdgeMap::filled(mesh.edge_slots(), 0);
    graph.edge_ids.iter().enumerate().for_each(|(i, &e)| number[e] = i);
    let mut best: Option<(i64, Vec<EdgeId>)> = None;
    let (mut matchings, mut fewest_cycles) = (0, usize::MAX);
    for folds in Matchings::new(mesh).ok()? {
        if matchings % LISTED_AT_ONCE == 0 && progress.is_cancelled() {
            return Some(Err(SeamError::Cancelled));
        }
        matchings += 1;
        if matchings > LISTED_MATCHINGS {
            return None;
        }
        let cycles = super::seam_cycles(mesh, &folds).len();
        fewest_cycles = fewest_cycles.min(cycles);
        if cycles == 1 {
            let candidate = (folds.iter().map(|&e| weights[number[e]]).sum(), folds);
            best = Some(best.map_or(candidate.clone(), |b| b.min(candidate)));
        }
    }
    Some(match best {
        Some((_, folds)) => Ok(folds),
        None if matchings == 0 => super::least_matching(mesh, progress),
        None => Err(SeamError::NoHamiltonian {
            proof: NoHamiltonian::Listed { matchings, fewest_cycles },
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::super::{
        MATCHING_LIMIT, fixtures, fold_sum, is_perfect_matching, least_matching, seam_cycles, table,
    };
    use super::*;
    use crate::progress::{Progress, Silent};

    fn assert_two_pieces(mesh: &Mesh, folds: &[EdgeId]) {
        assert!(is_perfect_matching(mesh, folds));
        assert_eq!(seam_cycles(mesh, folds).len(), 1);
        assert_eq!(super::super::piece_count(mesh, folds), 2);
    }

    #[test]
    fn small_meshes_get_the_least_of_all() {
        for mesh in [fixtures::cube(), fixtures::dodecahedron(), fixtures::random_convex(14, 9)] {
            let folds = hamiltonian_folds(&mesh, &Silent).expect("two pieces");
            assert_two_pieces(&mesh, &folds);
            let rows = table(&mesh, MATCHING_LIMIT, &Silent).expect("rows");
            let least =
                rows.iter().find(|r| r.pieces == 2).expect("two pieces come first").fold_sum;
            assert!((fold_sum(&mesh, &folds) - least).abs() < 1e-9 * least);
        }
    }

    #[test]
    fn the_search_finds_every_two_piece_seam_and_then_stops() {
        for (mesh, count) in [
            (fixtures::tetrahedron(), 3),
            (fixtures::cube(), 6),
            (fixtures::dodecahedron(), 30),
            (fixtures::truncated(&fixtures::cube(), 0.3), 6),
            (fixtures::prism(6, 1.0), 8),
            (fixtures::tutte(), 0),
        ] {
            let mut search = TwoPieceSearch::new(&mesh, &Silent).expect("a search");
            let mut found = std::collections::BTreeSet::new();
            while let Some(folds) = search.next_candidate(&Silent) {
                assert_two_pieces(&mesh, &folds);
                assert!(found.insert(folds), "each once");
            }
            assert!(search.is_exhausted());
            assert_eq!(found.len(), count);
        }
    }

    #[test]
    fn no_two_pieces_of_tuttes_graph_and_the_proof() {
        let tutte = fixtures::tutte();
        let proof = NoHamiltonian::Listed { matchings: 960, fewest_cycles: 2 };
        assert_eq!(hamiltonian_folds(&tutte, &Silent), Err(SeamError::NoHamiltonian { proof }));
        let mut search = TwoPieceSearch::new(&tutte, &Silent).expect("a search");
        assert_eq!(search.next_candidate(&Silent), None);
        let NoHamiltonian::Contradiction { cycles, forbidden: 0, .. } = search.proof() else {
            panic!("a contradiction")
        };
        assert!(cycles > 0);
        // Too large to list: every vertex cut off does not bring a Hamiltonian cycle back.
        let larger = fixtures::truncated(&tutte, 0.3);
        assert!(matches!(
            hamiltonian_folds(&larger, &Silent),
            Err(SeamError::NoHamiltonian { proof: NoHamiltonian::Contradiction { .. } })
        ));
    }

    #[test]
    fn learnt_rules_hold() {
        let mesh = fixtures::random_convex(60, 4);
        let mut search = TwoPieceSearch::new(&mesh, &Silent).expect("a search");
        let mut rules: Vec<Vec<EdgeId>> = Vec::new();
        for _ in 0..30 {
            let folds = search.next_candidate(&Silent).expect("a candidate");
            assert_two_pieces(&mesh, &folds);
            assert!(rules.iter().all(|rule| !rule.iter().all(|e| folds.contains(e))));
            rules.push(folds.iter().copied().step_by(9).collect());
            search.forbid_folds_together(rules.last().expect("just pushed"));
        }
        search.forbid_folds_together(&[EdgeId::new(100_000)]);
        assert!(
            search.next_candidate(&Silent).is_some(),
            "an edge that does not exist forbids nothing"
        );
        search.forbid_folds_together(&[]);
        assert!(search.next_candidate(&Silent).is_none() && search.is_exhausted());
    }

    #[test]
    fn large_meshes_get_a_good_seam_always_the_same() {
        let mesh = fixtures::random_convex(250, 7);
        let folds = hamiltonian_folds(&mesh, &Silent).expect("two pieces");
        assert_two_pieces(&mesh, &folds);
        assert_eq!(hamiltonian_folds(&mesh, &Silent), Ok(folds.clone()));
        let least = fold_sum(&mesh, &least_matching(&mesh, &Silent).expect("a matching"));
        let sum = fold_sum(&mesh, &folds);
        assert!(least <= sum && sum < 1.25 * least, "{sum} against the bound {least}");
    }

    #[test]
    fn a_cancelled_search_is_not_a_proof() {
        struct Cancelled;
        impl Progress for Cancelled {
            fn report(&self, _: &str, _: usize, _: usize) {}
            fn is_cancelled(&self) -> bool {
                true
            }
        }
        let mut search = TwoPieceSearch::new(&fixtures::cube(), &Silent).expect("a search");
        assert!(search.next_candidate(&Cancelled).is_none() && !search.is_exhausted());
        assert!(search.next_candidate(&Silent).is_some());
        // Nor is any other search: small meshes are listed, large ones searched.
        for mesh in [fixtures::cube(), fixtures::random_convex(60, 4)] {
            assert_eq!(hamiltonian_folds(&mesh, &Cancelled), Err(SeamError::Cancelled));
            assert_eq!(table(&mesh, MATCHING_LIMIT, &Cancelled), Err(SeamError::Cancelled));
        }
        let large = fixtures::random_convex(250, 7);
        assert_eq!(least_matching(&large, &Cancelled), Err(SeamError::Cancelled));
        assert!(matches!(TwoPieceSearch::new(&large, &Cancelled), Err(SeamError::Cancelled)));
    }

    /// As an unfolder does: hundreds of short fold paths forbidden, five times. The bench says how
    /// fast.
    #[test]
    fn many_forbidden_paths_leave_two_pieces() {
        for seed in 0..2 {
            let mesh = fixtures::random_convex(200, seed);
            let mut search = TwoPieceSearch::new(&mesh, &Silent).expect("a search");
            let mut folds = search.next_candidate(&Silent).expect("two pieces");
            for _ in 0..5 {
                for path in folds.chunks(7).step_by(6) {
                    search.forbid_folds_together(path);
                }
                folds = search.next_candidate(&Silent).expect("two pieces");
                assert_two_pieces(&mesh, &folds);
            }
        }
    }
}
