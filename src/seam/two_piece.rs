//! Seams of two pieces: Hamiltonian cycles of seam edges, found one after the other.

use super::error::{NoHamiltonian, SeamError};
use super::exchange::Factor;
use super::graph::Graph;
use super::least::least_folds;
use super::sat::{Answer, Sat};
use super::weight::{fold_weight, quantised};
use crate::mesh::{EdgeId, EdgeMap, Mesh};
use crate::progress::Progress;

/// After so many conflicts the search asks whether it should go on.
const CHUNK: u64 = 2_000;
/// What the user is told that the search does.
const SEARCH: &str = "looking for a seam of two pieces";
/// How far around a closed seam folds are chosen anew at first, in edges.
const NEAR: usize = 2;
/// How far at most.
const FAR: usize = 64;
/// How many answers of the solver with several seams are joined by exchanges, for each candidate.
const JOINS: usize = 20;
/// How many choices are tried before the neighbourhood grows.
const TRIES: usize = 100;

/// A search for folds whose seam is one cycle through all vertices of a closed 3-valent mesh. On a
/// sphere such a seam leaves two pieces; on other surfaces one or two.
///
/// One variable for each edge (fold or seam), exactly one fold for each vertex, at least one fold
/// for each face. A seam that closes too early is forbidden when it comes up: of the edges that
/// leave its vertices, at least one must be seam. What the caller learns about a candidate
/// (overlaps) is added with [`Self::forbid_folds_together`]. The search starts at the least
/// matching, its seams joined as cheaply as exchanges of up to 6 folds can, and stays near what it
/// tried last, so flat edges tend to be folds. The same calls always give the same answers.
///
/// ```no_run
/// # use kerfold::{progress::Silent, seam::TwoPieceSearch};
/// # fn overlapping(_: &[kerfold::mesh::EdgeId]) -> Option<Vec<kerfold::mesh::EdgeId>> { None }
/// # fn run(mesh: &kerfold::mesh::Mesh) -> Result<(), kerfold::seam::SeamError> {
/// let mut search = TwoPieceSearch::new(mesh, &Silent)?;
/// while let Some(folds) = search.next_candidate(&Silent) {
///     // The folds between two faces that overlap cannot all be folds.
///     let Some(path) = overlapping(&folds) else { break };
///     search.forbid_folds_together(&path);
/// }
/// # Ok(())
/// # }
/// ```
pub struct TwoPieceSearch {
    graph: Graph,
    weights: Vec<i64>,
    /// The number of each edge in the graph.
    number: EdgeMap<Option<u32>>,
    sat: Sat,
    /// The last candidate, unless something forbids it already.
    last: Option<Vec<u32>>,
    is_exhausted: bool,
    proof: NoHamiltonian,
}

impl TwoPieceSearch {
    /// Sets the search up at the least matching.
    ///
    /// # Errors
    /// As [`super::least_matching`], and [`SeamError::SeveralComponents`].
    pub fn new(mesh: &Mesh, progress: &dyn Progress) -> Result<Self, SeamError> {
        let graph = connected(mesh)?;
        let weights: Vec<f64> = graph.edge_ids.iter().map(|&e| fold_weight(mesh, e)).collect();
        let weights = quantised(&weights, graph.vertex_ids.len());
        let mut factor = Factor::new(&graph, &weights, least_folds(&graph, &weights, progress)?);
        factor.join(progress);
        let start = factor.is_fold;
        let mut number = EdgeMap::filled(mesh.edge_slots(), None);
        (0u32..).zip(&graph.edge_ids).for_each(|(i, &e)| number[e] = Some(i));
        let mut sat = Sat::new(graph.edge_ids.len());
        for v in 0..graph.vertex_count() {
            let edges = graph.incident(v);
            sat.add_clause(edges.iter().map(|&e| (e, true)));
            for (i, &e) in edges.iter().enumerate() {
                // A loop comes twice here, and can never be a fold.
                edges[..i].iter().for_each(|&d| sat.add_clause([(d, false), (e, false)]));
            }
        }
        let proof = NoHamiltonian::Contradiction { cycles: 0, forbidden: 0, conflicts: 0 };
        let mut search =
            Self { graph, weights, number, sat, last: None, is_exhausted: false, proof };
        search.approach(start, progress);
        search.forbid_seams_around_faces(mesh);
        Ok(search)
    }

    /// Sets the solver on its way: what it tries first is a choice of folds near the given one with
    /// as few closed seams as can be had cheaply. Seam after seam is joined with others by choosing
    /// folds anew around it, in a growing neighbourhood, while all other folds stay.
    fn approach(&mut self, mut is_fold: Vec<bool>, progress: &dyn Progress) {
        let mut radius = NEAR;
        while radius <= FAR {
            let (component, count) = self.seam_components(&is_fold);
            progress.report("joining closed seams", 0, count - 1);
            if count == 1 || progress.is_cancelled() {
                break;
            }
            let near = self.neighbourhood(&component, count, radius);
            let stays = |&e: &u32| {
                is_fold[e as usize]
                    && self.graph.ends[e as usize].iter().all(|&v| !near[v as usize])
            };
            let assumed: Vec<u32> = (0..is_fold.len() as u32).filter(stays).collect();
            match self.fewer_seams(&assumed, count) {
                Some(joined) => (is_fold, radius) = (joined, NEAR),
                None => radius *= 2,
            }
        }
        let folds: Vec<u32> = (0..is_fold.len() as u32).filter(|&e| is_fold[e as usize]).collect();
        self.sat.solve(&folds, CHUNK);
    }

    /// Folds with the assumed ones among them that leave fewer than `count` closed seams.
    fn fewer_seams(&mut self, assumed: &[u32], count: usize) -> Option<Vec<bool>> {
        for _ in 0..TRIES {
            if self.sat.solve(assumed, CHUNK / 4) != Answer::Yes {
                return None;
            }
            let is_fold = self.answer();
            let (component, fewer) = self.seam_components(&is_fold);
            if fewer < count {
                return Some(is_fold);
            }
            self.forbid_short_seams(&component, fewer);
        }
        None
    }

    /// The vertices within a number of edges from the shortest closed seam.
    fn neighbourhood(&self, component: &[u32], count: usize, radius: usize) -> Vec<bool> {
        let mut sizes = vec![0usize; count];
        component.iter().for_each(|&c| sizes[c as usize] += 1);
        let shortest = (0..count).min_by_key(|&c| sizes[c]).map_or(0, |c| c as u32);
        let mut near: Vec<bool> = component.iter().map(|&c| c == shortest).collect();
        let mut front: Vec<u32> =
            (0..self.graph.vertex_count()).filter(|&v| near[v as usize]).collect();
        for _ in 0..radius {
            for v in std::mem::take(&mut front) {
                for &e in self.graph.incident(v) {
                    let u = self.graph.other(e, v);
                    if !std::mem::replace(&mut near[u as usize], true) {
                        front.push(u);
                    }
                }
            }
        }
        near
    }

    /// The solver's answer: which edges are folds.
    fn answer(&self) -> Vec<bool> {
        (0..self.graph.edge_ids.len() as u32).map(|e| self.sat.value(e)).collect()
    }

    /// A seam around a face that visits each of its vertices once is closed too early, unless these
    /// are all.
    fn forbid_seams_around_faces(&mut self, mesh: &Mesh) {
        for f in mesh.faces() {
            let mut vertices: Vec<_> = mesh.face_vertices(f).collect();
            let sides = vertices.len();
            vertices.sort_unstable();
            vertices.dedup();
            if vertices.len() == sides && sides < mesh.vertex_count() {
                let number = &self.number;
                self.sat.add_clause(
                    mesh.face_half_edges(f).filter_map(|h| number[h.edge()]).map(|e| (e, true)),
                );
            }
        }
    }

    /// The next folds, ascending, whose seam is one cycle and that break none of the learnt rules;
    /// never the same twice. `None` when there are no more ([`Self::is_exhausted`]) or when the
    /// user cancelled.
    pub fn next_candidate(&mut self, progress: &dyn Progress) -> Option<Vec<EdgeId>> {
        while !self.is_exhausted && !progress.is_cancelled() {
            progress.report(SEARCH, self.sat.conflicts() as usize, 0);
            if let Some(folds) = self.next_within(CHUNK, progress) {
                return Some(folds);
            }
        }
        None
    }

    /// As [`Self::next_candidate`], but gives up after about that many more conflicts.
    pub(super) fn next_within(
        &mut self,
        conflicts: u64,
        progress: &dyn Progress,
    ) -> Option<Vec<EdgeId>> {
        if let Some(last) = self.last.take() {
            self.sat.add_clause(last.into_iter().map(|e| (e, false)));
        }
        let end = self.sat.conflicts().saturating_add(conflicts);
        let mut joins = 0;
        while !self.is_exhausted && self.sat.conflicts() < end && !progress.is_cancelled() {
            match self.sat.solve(&[], CHUNK.min(end - self.sat.conflicts())) {
                Answer::Stopped => progress.report(SEARCH, self.sat.conflicts() as usize, 0),
                Answer::No => self.is_exhausted = true,
                Answer::Yes => {
                    let is_fold = self.answer();
                    let (component, count) = self.seam_components(&is_fold);
                    if count == 1 {
                        return Some(self.found(is_fold));
                    }
                    self.forbid_short_seams(&component, count);
                    if joins < JOINS {
                        joins += 1;
                        if let Some(joined) = self.joined(&is_fold, progress) {
                            return Some(self.found(joined));
                        }
                    }
                }
            }
        }
        None
    }

    /// Joins the closed seams of an answer by exchanges. The rules of the caller are not known
    /// there, so the solver has to agree; it also begins there the next time.
    fn joined(&mut self, is_fold: &[bool], progress: &dyn Progress) -> Option<Vec<bool>> {
        let edges = 0..is_fold.len() as u32;
        let mut factor =
            Factor::new(&self.graph, &self.weights, edges.filter(|&e| is_fold[e as usize]));
        if !factor.join(progress) {
            return None;
        }
        let folds = factor.folds();
        (self.sat.solve(&folds, CHUNK) == Answer::Yes).then(|| self.answer())
    }

    fn found(&mut self, is_fold: Vec<bool>) -> Vec<EdgeId> {
        let folds: Vec<u32> = (0..is_fold.len() as u32).filter(|&e| is_fold[e as usize]).collect();
        let ids = self.graph.ids(folds.iter().copied());
        self.last = Some(folds);
        ids
    }

    /// Which closed seam each vertex is on, and how many there are.
    fn seam_components(&self, is_fold: &[bool]) -> (Vec<u32>, usize) {
        const UNSEEN: u32 = u32::MAX;
        let mut component = vec![UNSEEN; self.graph.vertex_ids.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for seed in 0..self.graph.vertex_count() {
            if component[seed as usize] != UNSEEN {
                continue;
            }
            component[seed as usize] = count;
            stack.push(seed);
            while let Some(v) = stack.pop() {
                for &e in self.graph.incident(v) {
                    let u = self.graph.other(e, v);
                    if !is_fold[e as usize] && component[u as usize] == UNSEEN {
                        component[u as usize] = count;
                        stack.push(u);
                    }
                }
            }
            count += 1;
        }
        (component, count as usize)
    }

    /// Of the edges that leave the vertices of a closed seam, at least one must be seam.
    fn forbid_short_seams(&mut self, component: &[u32], count: usize) {
        let mut leaving = vec![Vec::new(); count];
        for (e, ends) in (0u32..).zip(&self.graph.ends) {
            let [a, b] = ends.map(|v| component[v as usize] as usize);
            if a != b {
                leaving[a].push((e, false));
                leaving[b].push((e, false));
            }
        }
        // Of two seams both are left by the same edges.
        leaving.truncate(if count == 2 { 1 } else { count });
        if let NoHamiltonian::Contradiction { cycles, .. } = &mut self.proof {
            *cycles += leaving.len();
        }
        leaving.into_iter().for_each(|clause| self.sat.add_clause(clause));
    }

    /// Learns that these edges cannot all be folds. An edge that the mesh does not have can never
    /// be a fold, so naming one forbids nothing; an empty list forbids everything.
    pub fn forbid_folds_together(&mut self, folds: &[EdgeId]) {
        let Some(clause) = folds
            .iter()
            .map(|&e| self.number.get(e).copied().flatten())
            .collect::<Option<Vec<u32>>>()
        else {
            return;
        };
        if let NoHamiltonian::Contradiction { forbidden, .. } = &mut self.proof {
            *forbidden += 1;
        }
        // A candidate that this forbids need not be forbidden as a whole.
        self.last =
            self.last.take().filter(|last| !clause.iter().all(|e| last.binary_search(e).is_ok()));
        self.sat.add_clause(clause.into_iter().map(|e| (e, false)));
    }

    /// Whether it is proven that no further candidate exists.
    pub fn is_exhausted(&self) -> bool {
        self.is_exhausted
    }

    /// The numbers of some edges in the graph.
    pub(super) fn numbers(&self, edges: &[EdgeId]) -> Vec<u32> {
        edges.iter().filter_map(|&e| self.number[e]).collect()
    }

    /// How much work there was so far; the proof once [`Self::is_exhausted`].
    pub fn proof(&self) -> NoHamiltonian {
        match self.proof {
            NoHamiltonian::Contradiction { cycles, forbidden, .. } => {
                NoHamiltonian::Contradiction { cycles, forbidden, conflicts: self.sat.conflicts() }
            }
            listed => listed,
        }
    }
}

/// The graph of a connected closed 3-valent mesh.
pub(super) fn connected(mesh: &Mesh) -> Result<Graph, SeamError> {
    let graph = Graph::cubic(mesh)?;
    let components = mesh.components();
    match components.as_slice() {
        [_, second, ..] => Err(SeamError::SeveralComponents {
            count: components.len(),
            vertex: second.vertices[0],
        }),
        _ => Ok(graph),
    }
}
