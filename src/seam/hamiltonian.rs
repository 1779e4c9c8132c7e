//! The two-piece seam whose folds bend least, as far as a fixed amount of work finds it.

use super::SeamError;
use super::enumerate::Matchings;
use super::graph::Graph;
use super::two_piece::{NoHamiltonian, TwoPieceSearch, connected};
use super::weight::{fold_weight, quantised};
use crate::mesh::{EdgeId, EdgeMap, Mesh};

/// Up to this many vertices all matchings are listed, if they are not more than [`LISTED_MATCHINGS`].
const LISTED_VERTICES: usize = 64;
/// See [`LISTED_VERTICES`].
const LISTED_MATCHINGS: usize = 20_000;
/// Conflicts that the search for a first seam may meet.
const CONFLICTS: u64 = 1_000_000;
/// Folds exchanged at once, at most, when a seam is improved.
const EXCHANGED: usize = 7;
/// Steps along seams that the improvement may make.
const STEPS: usize = 100_000_000;

/// The folds of a two-piece seam of a closed 3-valent mesh, ascending: one closed seam that runs through every vertex once
/// (a Hamiltonian cycle). On a sphere the pieces are two; on other surfaces one or two.
///
/// Among these seams, one with a small sum of |fold angle| × length over the folds: the least of all when the mesh has at
/// most 64 vertices and 20 000 matchings (the lexicographically least of several); else the first that the search meets,
/// improved by exchanging up to 7 folds at once for as long as that helps (at most 10⁸ steps of checking). No clock takes
/// part: the same mesh gives the same folds.
///
/// # Errors
/// As [`super::least_matching`]; [`SeamError::SeveralComponents`]; [`SeamError::NoHamiltonian`] with a proof;
/// [`SeamError::SearchStopped`] when a million conflicts were not enough to tell.
pub fn hamiltonian_folds(mesh: &Mesh) -> Result<Vec<EdgeId>, SeamError> {
    let graph = connected(mesh)?;
    let weights: Vec<f64> = graph.edge_ids.iter().map(|&e| fold_weight(mesh, e)).collect();
    let weights = quantised(&weights, graph.vertex_ids.len());
    if let Some(result) = listed(mesh, &graph, &weights) {
        return result;
    }
    let mut search = TwoPieceSearch::new(mesh)?;
    match search.next_within(CONFLICTS) {
        Some(folds) => {
            let mut tour = Tour::new(&graph, &weights, mesh, &folds);
            tour.improve();
            Ok(graph.ids((0..graph.edge_ids.len() as u32).filter(|&e| tour.is_fold[e as usize])))
        }
        None if search.is_exhausted() => Err(SeamError::NoHamiltonian { proof: search.proof() }),
        None => Err(SeamError::SearchStopped { conflicts: CONFLICTS }),
    }
}

/// The exact answer of small meshes; `None` when there is too much to list.
fn listed(mesh: &Mesh, graph: &Graph, weights: &[i64]) -> Option<Result<Vec<EdgeId>, SeamError>> {
    if graph.vertex_ids.len() > LISTED_VERTICES {
        return None;
    }
    let mut number = EdgeMap::filled(mesh.edge_slots(), 0);
    graph.edge_ids.iter().enumerate().for_each(|(i, &e)| number[e] = i);
    let mut best: Option<(i64, Vec<EdgeId>)> = None;
    let (mut matchings, mut fewest_cycles) = (0, usize::MAX);
    for folds in Matchings::new(mesh).ok()? {
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
        None if matchings == 0 => super::least_matching(mesh),
        None => Err(SeamError::NoHamiltonian { proof: NoHamiltonian::Listed { matchings, fewest_cycles } }),
    })
}

/// A Hamiltonian cycle of seams that is being improved.
struct Tour<'a> {
    graph: &'a Graph,
    weights: &'a [i64],
    is_fold: Vec<bool>,
    steps: usize,
    /// The alternating path being tried: its edges, fold, seam, fold, …, and which vertices it meets.
    path: Vec<u32>,
    met: Vec<bool>,
}

impl<'a> Tour<'a> {
    fn new(graph: &'a Graph, weights: &'a [i64], mesh: &Mesh, folds: &[EdgeId]) -> Self {
        let mut chosen = EdgeMap::filled(mesh.edge_slots(), false);
        folds.iter().for_each(|&e| chosen[e] = true);
        let is_fold = graph.edge_ids.iter().map(|&e| chosen[e]).collect();
        Self { graph, weights, is_fold, steps: 0, path: Vec::new(), met: vec![false; graph.vertex_ids.len()] }
    }

    /// Exchanges folds and seams along closed paths that alternate between them, as long as the sum of the folds shrinks
    /// and the seam stays one cycle.
    fn improve(&mut self) {
        loop {
            let mut improved = false;
            for e in 0..self.graph.ends.len() as u32 {
                while self.is_fold[e as usize] && self.try_from(e) {
                    improved = true;
                }
            }
            if !improved || self.steps > STEPS {
                return;
            }
        }
    }

    /// Tries the closed paths that begin with a fold. It is enough to look at paths whose beginnings all gain: every cycle
    /// that gains has such a beginning.
    fn try_from(&mut self, e: u32) -> bool {
        let [start, end] = self.graph.ends[e as usize];
        [(start, end), (end, start)].into_iter().any(|(start, end)| {
            self.path.clear();
            self.path.push(e);
            self.met[start as usize] = true;
            self.met[end as usize] = true;
            let done = self.extend(start, end, self.weights[e as usize]);
            self.met[start as usize] = false;
            self.met[end as usize] = false;
            done
        })
    }

    /// Goes on from vertex `v`, where the last fold of the path ended; `gain` is what the path has saved so far.
    fn extend(&mut self, start: u32, v: u32, gain: i64) -> bool {
        let graph = self.graph;
        for &seam in graph.incident(v) {
            let (u, gain) = (graph.other(seam, v), gain - self.weights[seam as usize]);
            if self.is_fold[seam as usize] || gain <= 0 {
                continue;
            }
            self.path.push(seam);
            if u == start {
                if self.exchange() {
                    return true;
                }
            } else if !self.met[u as usize] && self.path.len() < 2 * EXCHANGED {
                let fold = graph.incident(u).iter().copied().find(|&f| self.is_fold[f as usize]);
                let fold = fold.expect("every vertex has its fold");
                let w = graph.other(fold, u);
                if !self.met[w as usize] {
                    self.path.push(fold);
                    (self.met[u as usize], self.met[w as usize]) = (true, true);
                    let done = self.extend(start, w, gain + self.weights[fold as usize]);
                    (self.met[u as usize], self.met[w as usize]) = (false, false);
                    if done {
                        return true;
                    }
                    self.path.pop();
                }
            }
            self.path.pop();
        }
        false
    }

    /// Exchanges folds and seams along the path if the seam stays one cycle.
    fn exchange(&mut self) -> bool {
        if self.steps > STEPS {
            return false;
        }
        self.flip_path();
        let keeps = self.is_one_cycle();
        if !keeps {
            self.flip_path();
        }
        keeps
    }

    fn flip_path(&mut self) {
        for &e in &self.path {
            self.is_fold[e as usize] ^= true;
        }
    }

    fn is_one_cycle(&mut self) -> bool {
        let graph = self.graph;
        let (mut v, mut from, mut length) = (0, u32::MAX, 0);
        loop {
            let onward = |&&e: &&u32| !self.is_fold[e as usize] && e != from;
            let Some(&e) = graph.incident(v).iter().find(onward) else { return false };
            (v, from, length) = (graph.other(e, v), e, length + 1);
            self.steps += 1;
            if v == 0 {
                return length == graph.vertex_ids.len();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MATCHING_LIMIT, fixtures, fold_sum, is_perfect_matching, least_matching, seam_cycles, table};
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
            let folds = hamiltonian_folds(&mesh).expect("two pieces");
            assert_two_pieces(&mesh, &folds);
            let rows = table(&mesh, MATCHING_LIMIT).expect("rows");
            let least = rows.iter().find(|r| r.pieces == 2).expect("two pieces come first").fold_sum;
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
            let mut search = TwoPieceSearch::new(&mesh).expect("a search");
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
        assert_eq!(hamiltonian_folds(&tutte), Err(SeamError::NoHamiltonian { proof }));
        let mut search = TwoPieceSearch::new(&tutte).expect("a search");
        assert_eq!(search.next_candidate(&Silent), None);
        let NoHamiltonian::Contradiction { cycles, forbidden: 0, .. } = search.proof() else {
            panic!("a contradiction")
        };
        assert!(cycles > 0);
        // Too large to list: every vertex cut off does not bring a Hamiltonian cycle back.
        let larger = fixtures::truncated(&tutte, 0.3);
        assert!(matches!(
            hamiltonian_folds(&larger),
            Err(SeamError::NoHamiltonian { proof: NoHamiltonian::Contradiction { .. } })
        ));
    }

    #[test]
    fn learnt_rules_hold() {
        let mesh = fixtures::random_convex(60, 4);
        let mut search = TwoPieceSearch::new(&mesh).expect("a search");
        let mut rules: Vec<Vec<EdgeId>> = Vec::new();
        for _ in 0..30 {
            let folds = search.next_candidate(&Silent).expect("a candidate");
            assert_two_pieces(&mesh, &folds);
            assert!(rules.iter().all(|rule| !rule.iter().all(|e| folds.contains(e))));
            rules.push(folds.iter().copied().step_by(9).collect());
            search.forbid_folds_together(rules.last().expect("just pushed"));
        }
        search.forbid_folds_together(&[EdgeId::new(100_000)]);
        assert!(search.next_candidate(&Silent).is_some(), "an edge that does not exist forbids nothing");
        search.forbid_folds_together(&[]);
        assert!(search.next_candidate(&Silent).is_none() && search.is_exhausted());
    }

    #[test]
    fn large_meshes_get_a_good_seam_always_the_same() {
        let mesh = fixtures::random_convex(250, 7);
        let folds = hamiltonian_folds(&mesh).expect("two pieces");
        assert_two_pieces(&mesh, &folds);
        assert_eq!(hamiltonian_folds(&mesh), Ok(folds.clone()));
        let least = fold_sum(&mesh, &least_matching(&mesh).expect("a matching"));
        let sum = fold_sum(&mesh, &folds);
        assert!(least <= sum && sum < 1.5 * least, "{sum} against the bound {least}");
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
        let mut search = TwoPieceSearch::new(&fixtures::cube()).expect("a search");
        assert!(search.next_candidate(&Cancelled).is_none() && !search.is_exhausted());
        assert!(search.next_candidate(&Silent).is_some());
    }

    #[test]
    #[ignore = "timing, run in release"]
    fn a_thousand_faces() {
        for seed in 0..5 {
            let mesh = fixtures::random_convex(1000, seed);
            let start = std::time::Instant::now();
            let first = TwoPieceSearch::new(&mesh).expect("a search").next_candidate(&Silent).expect("two pieces");
            let (time, sum) = (start.elapsed(), fold_sum(&mesh, &first));
            assert_two_pieces(&mesh, &first);
            let folds = hamiltonian_folds(&mesh).expect("two pieces");
            let least = fold_sum(&mesh, &least_matching(&mesh).expect("a matching"));
            eprintln!("{time:?} {:?} {} {}", start.elapsed(), sum / least, fold_sum(&mesh, &folds) / least);
            assert!(time.as_secs() < 1);
        }
        let tutte = fixtures::tutte();
        let start = std::time::Instant::now();
        assert!(TwoPieceSearch::new(&tutte).expect("a search").next_candidate(&Silent).is_none());
        eprintln!("{:?}", start.elapsed());
        assert!(start.elapsed().as_secs() < 1);
    }
}
