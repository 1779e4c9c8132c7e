//! Closed paths that alternate between folds and seams: exchanging the two along one makes another
//! choice of folds.

use super::graph::Graph;

/// A choice of folds that meet every vertex once, and its closed seams.
#[derive(Debug, Clone)]
pub(super) struct Factor<'a> {
    pub graph: &'a Graph,
    /// What each edge costs as a fold.
    pub weights: &'a [i64],
    pub is_fold: Vec<bool>,
    /// Vertices looked at so far; bounds the work.
    pub steps: usize,
    /// For walks: the last one that came by each vertex.
    seen: Vec<u32>,
    walks: u32,
}

/// A closed path fold, seam, fold, …, seam; its cost is what exchanging adds to the sum of the
/// folds.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Exchange {
    pub cost: i64,
    pub path: Vec<u32>,
}

/// What [`Factor::paths`] carries along.
struct Search<'s> {
    /// Longest path, in folds.
    folds: usize,
    /// Whether to follow a path only while it saves.
    saving: bool,
    start: u32,
    /// The vertices of the path so far, in the order they came.
    vertices: Vec<u32>,
    path: Vec<u32>,
    accept: &'s mut dyn FnMut(Exchange),
}

impl<'a> Factor<'a> {
    pub fn new(graph: &'a Graph, weights: &'a [i64], folds: impl IntoIterator<Item = u32>) -> Self {
        let mut is_fold = vec![false; graph.edge_ids.len()];
        folds.into_iter().for_each(|e| is_fold[e as usize] = true);
        Self { graph, weights, is_fold, steps: 0, seen: vec![0; graph.vertex_ids.len()], walks: 0 }
    }

    /// The folds, ascending.
    pub fn folds(&self) -> Vec<u32> {
        (0..self.is_fold.len() as u32).filter(|&e| self.is_fold[e as usize]).collect()
    }

    /// Which closed seam each vertex is on, and how many there are.
    pub fn labels(&mut self) -> (Vec<u32>, usize) {
        let mut labels = vec![u32::MAX; self.seen.len()];
        let mut count = 0;
        for v in 0..self.seen.len() as u32 {
            if labels[v as usize] == u32::MAX {
                self.walk(v, |u| labels[u as usize] = count);
                count += 1;
            }
        }
        (labels, count as usize)
    }

    /// Whether there is one closed seam only.
    pub fn is_one_cycle(&mut self) -> bool {
        let mut length = 0;
        self.walk(0, |_| length += 1);
        length == self.seen.len()
    }

    /// How many closed seams run through the vertices of a path.
    pub fn cycles_at(&mut self, path: &[u32]) -> usize {
        self.walks += 1;
        let stamp = self.walks;
        let mut cycles = 0;
        for v in path.iter().flat_map(|&e| self.graph.ends[e as usize]) {
            if self.seen[v as usize] != stamp {
                cycles += 1;
                let mut met = Vec::new();
                self.walk(v, |u| met.push(u));
                met.into_iter().for_each(|u| self.seen[u as usize] = stamp);
            }
        }
        cycles
    }

    /// Visits the closed seam of a vertex.
    fn walk(&mut self, start: u32, mut visit: impl FnMut(u32)) {
        let (mut v, mut from) = (start, u32::MAX);
        loop {
            visit(v);
            self.steps += 1;
            let onward = |&&e: &&u32| !self.is_fold[e as usize] && e != from;
            // A loop is both seams of its vertex.
            let Some(&e) = self.graph.incident(v).iter().find(onward) else { return };
            (v, from) = (self.graph.other(e, v), e);
            if v == start {
                return;
            }
        }
    }

    /// Exchanges folds and seams along a path.
    pub fn flip(&mut self, path: &[u32]) {
        path.iter().for_each(|&e| self.is_fold[e as usize] ^= true);
    }

    /// Whether a path found earlier still goes fold, seam, fold, ….
    pub fn alternates(&self, path: &[u32]) -> bool {
        path.iter().enumerate().all(|(i, &e)| self.is_fold[e as usize] == (i % 2 == 0))
    }

    /// Gives `accept` all closed alternating paths of at most `folds` folds that begin with the
    /// fold `e`. With `saving` only those that save, and whose beginnings all save; each path that
    /// saves has such a beginning.
    pub fn paths(&self, e: u32, folds: usize, saving: bool, accept: &mut dyn FnMut(Exchange)) {
        let [a, b] = self.graph.ends[e as usize];
        for (start, end) in [(a, b), (b, a)].into_iter().take(if saving { 2 } else { 1 }) {
            let mut search = Search {
                folds,
                saving,
                start,
                vertices: vec![start, end],
                path: vec![e],
                accept: &mut *accept,
            };
            self.extend(&mut search, end, -self.weights[e as usize]);
        }
    }

    fn extend(&self, search: &mut Search, v: u32, cost: i64) {
        for &seam in self.graph.incident(v) {
            let (u, cost) = (self.graph.other(seam, v), cost + self.weights[seam as usize]);
            if self.is_fold[seam as usize] || (search.saving && cost >= 0) {
                continue;
            }
            search.path.push(seam);
            if u == search.start {
                (search.accept)(Exchange { cost, path: search.path.clone() });
            } else if !search.vertices.contains(&u) && search.path.len() < 2 * search.folds {
                self.extend_by_fold(search, u, cost);
            }
            search.path.pop();
        }
    }

    fn extend_by_fold(&self, search: &mut Search, u: u32, cost: i64) {
        let fold = self.graph.incident(u).iter().copied().find(|&f| self.is_fold[f as usize]);
        let fold = fold.expect("every vertex has its fold");
        let w = self.graph.other(fold, u);
        if !search.vertices.contains(&w) {
            search.path.push(fold);
            search.vertices.extend([u, w]);
            self.extend(search, w, cost - self.weights[fold as usize]);
            search.vertices.truncate(search.vertices.len() - 2);
            search.path.pop();
        }
    }
}
