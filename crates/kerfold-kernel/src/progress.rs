//! How long work says how far it is and learns that it should stop; layer 0, knows nothing but
//! itself.

/// What a long computation reports to and asks. The command line shows it on a terminal and stops
/// on Ctrl-C.
pub trait Progress: Sync {
    /// Called now and then with the name of the work, the steps done, and the steps in all (0 when
    /// unknown).
    fn report(&self, work: &str, done: usize, total: usize);

    /// Whether the user asked to stop. Work that has a best result so far returns it.
    fn is_cancelled(&self) -> bool;
}

/// Shows nothing and never stops; for library calls and tests.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _work: &str, _done: usize, _total: usize) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}
