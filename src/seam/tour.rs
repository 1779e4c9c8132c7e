//! Joining closed seams into one at a small cost, and making one closed seam cheaper.

use super::exchange::{Exchange, Factor};
use crate::progress::Progress;

/// Folds exchanged at once, at most, to join closed seams: short paths first, long ones for the few
/// seams left over.
const JOINED: [usize; 5] = [6, 9, 12, 15, 18];
/// Longer paths than the first are tried when there can be at most this many (two ways on from
/// every fold).
const PATHS: usize = 1 << 23;
/// Folds exchanged at once, at most, to save.
const SAVED: usize = 6;
/// Folds exchanged at once, at most, to join what a saving has split.
const REJOINED: usize = 4;
/// Vertices that may be looked at while saving, for each vertex of the mesh.
const STEPS_PER_VERTEX: usize = 10_000;

impl Factor<'_> {
    /// Joins closed seams by exchanges, the cheapest first, as long as that is possible and the
    /// user does not cancel. Says whether one is left.
    pub fn join(&mut self, progress: &dyn Progress) -> bool {
        JOINED.into_iter().any(|folds| self.join_by(folds, progress))
    }

    fn join_by(&mut self, folds: usize, progress: &dyn Progress) -> bool {
        loop {
            let (labels, count) = self.labels();
            progress.report("joining closed seams", 0, count - 1);
            if count == 1 {
                return true;
            }
            if progress.is_cancelled() {
                return false;
            }
            if folds > JOINED[0] && self.crossing(&labels).count() << (folds - 1) > PATHS {
                return false;
            }
            let mut sets = Sets((0..count as u32).collect());
            let mut joined = false;
            for exchange in self.joining(&labels, folds) {
                let mut touched: Vec<u32> = exchange
                    .path
                    .iter()
                    .map(|&e| labels[self.graph.ends[e as usize][0] as usize])
                    .collect();
                touched.iter_mut().for_each(|label| *label = sets.root(*label));
                if touched.iter().all(|&t| t == touched[0]) || !self.alternates(&exchange.path) {
                    continue;
                }
                let before = self.cycles_at(&exchange.path);
                self.flip(&exchange.path);
                if self.cycles_at(&exchange.path) < before {
                    touched.iter().for_each(|&t| sets.unite(touched[0], t));
                    joined = true;
                } else {
                    self.flip(&exchange.path);
                }
            }
            if !joined {
                return false;
            }
        }
    }

    /// The exchanges that touch several closed seams, the cheapest first. A seam edge stays on its
    /// closed seam, so one of the folds must lead from one to another.
    fn joining(&self, labels: &[u32], folds: usize) -> Vec<Exchange> {
        let mut exchanges = Vec::new();
        for e in self.crossing(labels) {
            self.paths(e, folds, false, &mut |exchange| {
                // Each path is found from all its crossing folds; the lowest counts.
                if exchange.path.iter().step_by(2).all(|&f| f >= e || !self.crosses(labels, f)) {
                    exchanges.push(exchange);
                }
            });
        }
        exchanges.sort_unstable();
        exchanges
    }

    /// The folds that lead from one closed seam to another.
    fn crossing(&self, labels: &[u32]) -> impl Iterator<Item = u32> {
        (0..self.is_fold.len() as u32)
            .filter(|&e| self.is_fold[e as usize] && self.crosses(labels, e))
    }

    fn crosses(&self, labels: &[u32], e: u32) -> bool {
        let [a, b] = self.graph.ends[e as usize];
        labels[a as usize] != labels[b as usize]
    }

    /// Makes the folds of one closed seam cheaper, as long as exchanges do that and leave one
    /// closed seam; when an exchange splits it, the cheapest way to join the parts is tried, if
    /// both together still save. Stops where it is when the user cancels.
    pub fn save(&mut self, progress: &dyn Progress) {
        let end = self.steps + STEPS_PER_VERTEX * self.graph.vertex_ids.len();
        let mut improved = true;
        while improved {
            improved = false;
            for e in 0..self.is_fold.len() as u32 {
                if progress.is_cancelled() {
                    return;
                }
                progress.report("making the seam cheaper", self.steps, end);
                while self.is_fold[e as usize] && self.steps < end && self.save_from(e) {
                    improved = true;
                }
            }
        }
    }

    fn save_from(&mut self, e: u32) -> bool {
        let mut exchanges = Vec::new();
        self.paths(e, SAVED, true, &mut |exchange| exchanges.push(exchange));
        exchanges.sort_unstable();
        exchanges.iter().any(|exchange| {
            self.flip(&exchange.path);
            let keeps = self.is_one_cycle() || self.rejoin(-exchange.cost);
            if !keeps {
                self.flip(&exchange.path);
            }
            keeps
        })
    }

    /// Joins all closed seams by one exchange that costs less than `budget`.
    fn rejoin(&mut self, budget: i64) -> bool {
        let (labels, _) = self.labels();
        let exchanges = self.joining(&labels, REJOINED);
        exchanges.iter().take_while(|exchange| exchange.cost < budget).any(|exchange| {
            self.flip(&exchange.path);
            let joins = self.is_one_cycle();
            if !joins {
                self.flip(&exchange.path);
            }
            joins
        })
    }
}

/// Disjoint sets of labels.
struct Sets(Vec<u32>);

impl Sets {
    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            self.0[i as usize] = self.0[self.0[i as usize] as usize];
            i = self.0[i as usize];
        }
        i
    }

    fn unite(&mut self, i: u32, j: u32) {
        let (i, j) = (self.root(i), self.root(j));
        self.0[j as usize] = i;
    }
}
