//! What chains of steps have made, so that it need not be made again.

use std::sync::Arc;

use super::replay::Reached;
use super::{Entry, Job};

/// States that are remembered at most, and the edges of their meshes together: at some hundred
/// bytes each the meshes stay below half a gigabyte.
const MOST_STATES: usize = 128;
const MOST_EDGES: usize = 3_000_000;

/// States by the steps that led to them; those used last come last.
#[derive(Default)]
pub(super) struct Cache {
    states: Vec<Reached>,
}

impl Cache {
    /// How many of these steps are known to have been done, and what they made.
    pub fn longest(&mut self, steps: &[Arc<Entry>]) -> (usize, Arc<Job>) {
        let leads_here = |state: &Reached| {
            let known = &state.steps;
            known.len() <= steps.len() && known.iter().zip(steps).all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let fitting = self.states.iter().enumerate().filter(|(_, state)| leads_here(state));
        let Some((at, _)) = fitting.max_by_key(|(_, state)| state.steps.len()) else {
            return (0, Arc::new(Job::default()));
        };
        let state = self.states.remove(at);
        let found = (state.steps.len(), state.job.clone());
        self.states.push(state);
        found
    }

    /// Remembers a state, and forgets what was not used for long.
    pub fn keep(&mut self, state: Reached) {
        let is_same = |other: &Reached| {
            other.steps.len() == state.steps.len()
                && other.steps.iter().zip(&state.steps).all(|(a, b)| Arc::ptr_eq(a, b))
        };
        self.states.retain(|other| !is_same(other));
        self.states.push(state);
        let edges = |state: &Reached| state.job.mesh().map_or(0, crate::mesh::Mesh::edge_count);
        let mut total: usize = self.states.iter().map(edges).sum();
        while self.states.len() > 1 && (self.states.len() > MOST_STATES || total > MOST_EDGES) {
            total -= edges(&self.states.remove(0));
        }
    }

    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.states.len()
    }
}
