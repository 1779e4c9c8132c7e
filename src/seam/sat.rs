//! The one door to the SAT solver (batsat, a MiniSat in Rust).

use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface, SolverOpts, Var, lbool};

/// A satisfiability problem that grows: clauses can be added between calls, what was learnt is
/// kept.
pub(super) struct Sat {
    solver: Solver<Budget>,
    vars: Vec<Var>,
}

/// What a call of [`Sat::solve`] came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    /// All clauses can hold; [`Sat::value`] says how.
    Yes,
    /// They cannot.
    No,
    /// The conflicts that were granted are used up.
    Stopped,
}

/// Stops the solver after a number of conflicts, so that the same calls always do the same work.
#[derive(Default)]
struct Budget {
    conflicts: u64,
    limit: u64,
}

impl Callbacks for Budget {
    fn on_new_clause(&mut self, _: &[Lit], kind: ClauseKind) {
        if kind == ClauseKind::Learnt {
            self.conflicts += 1;
        }
    }

    fn stop(&self) -> bool {
        self.conflicts >= self.limit
    }
}

impl Sat {
    /// A problem with variables 0..n and no clauses.
    pub fn new(variables: usize) -> Self {
        let mut solver = Solver::new(SolverOpts::default(), Budget::default());
        let vars = (0..variables).map(|_| solver.new_var_default()).collect();
        Self { solver, vars }
    }

    /// Demands that at least one of the variables has the value it comes with.
    pub fn add_clause(&mut self, clause: impl IntoIterator<Item = (u32, bool)>) {
        let mut literals: Vec<Lit> =
            clause.into_iter().map(|(v, value)| self.literal(v, value)).collect();
        // `false` means that nothing can satisfy the clauses any more; the next call of solve()
        // says so too.
        self.solver.add_clause_reuse(&mut literals);
    }

    /// Looks for values that satisfy all clauses and give `true` to the assumed variables, with at
    /// most about that many conflicts. The values last tried are what the next call tries first.
    pub fn solve(&mut self, assumed: &[u32], conflicts: u64) -> Answer {
        let budget = self.solver.cb_mut();
        budget.limit = budget.conflicts.saturating_add(conflicts);
        let literals: Vec<Lit> = assumed.iter().map(|&v| self.literal(v, true)).collect();
        match self.solver.solve_limited(&literals) {
            result if result == lbool::TRUE => Answer::Yes,
            result if result == lbool::FALSE => Answer::No,
            _ => Answer::Stopped,
        }
    }

    /// The value of a variable in the last answer, when it was [`Answer::Yes`].
    pub fn value(&self, variable: u32) -> bool {
        self.solver.value_var(self.vars[variable as usize]) == lbool::TRUE
    }

    /// Number of conflicts so far.
    pub fn conflicts(&self) -> u64 {
        self.solver.cb().conflicts
    }

    fn literal(&self, variable: u32, value: bool) -> Lit {
        Lit::new(self.vars[variable as usize], value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_can_be_added_until_nothing_is_left() {
        let mut sat = Sat::new(2);
        sat.add_clause([(0, true), (1, true)]);
        assert_eq!(sat.solve(&[0, 1], 100), Answer::Yes);
        assert!(sat.value(0) && sat.value(1));
        // What was tried last is tried first.
        assert_eq!(sat.solve(&[], 100), Answer::Yes);
        assert!(sat.value(0) && sat.value(1));
        sat.add_clause([(0, false)]);
        assert_eq!(sat.solve(&[0], 100), Answer::No);
        assert_eq!(sat.solve(&[], 100), Answer::Yes);
        assert!(!sat.value(0) && sat.value(1));
        sat.add_clause([(1, false)]);
        assert_eq!(sat.solve(&[], 100), Answer::No);
        assert_eq!(sat.solve(&[], 100), Answer::No);
    }
}
