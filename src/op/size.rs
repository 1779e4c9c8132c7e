//! The size of a result, worked out before the work begins, and Ctrl-C within a round.

use super::OpError;
use crate::memory::Memory;
use crate::mesh::Mesh;
use crate::progress::Progress;

/// What an edge of a result takes at the worst moment, with its share of vertices and faces: the
/// store, the tables while it is built, the mesh that it is made of, and the text of its file.
const BYTES_PER_EDGE: f64 = 250.0;
/// More edges than this no mesh can hold.
const MOST_EDGES: f64 = (1_u64 << 29) as f64;
/// So often long loops ask whether they shall stop.
const STRIDE: usize = 4096;

/// Numbers of elements as they grow, beyond all integers too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counts {
    pub vertices: f64,
    pub edges: f64,
    pub faces: f64,
}

impl Counts {
    pub(super) fn of(mesh: &Mesh) -> Self {
        Self {
            vertices: mesh.vertex_count() as f64,
            edges: mesh.edge_count() as f64,
            faces: (mesh.face_count() + mesh.hole_count()) as f64,
        }
    }

    /// After so many steps.
    pub(super) fn after(self, rounds: u32, step: impl Fn(Self) -> Self) -> Self {
        (0..rounds).fold(self, |counts, _| step(counts))
    }
}

/// Refuses what the memory of the machine does not hold, or no mesh: `edges` is the number of edges
/// after so many `what`.
pub(super) fn check_size(
    what: &'static str,
    asked: u32,
    edges: impl Fn(u32) -> f64,
) -> Result<(), OpError> {
    check_size_within(Memory::of_machine(), what, asked, edges)
}

fn check_size_within(
    memory: Memory,
    what: &'static str,
    asked: u32,
    edges: impl Fn(u32) -> f64,
) -> Result<(), OpError> {
    let bytes = |count: u32| match edges(count) {
        edges if edges <= MOST_EDGES => BYTES_PER_EDGE * edges,
        _ => f64::INFINITY,
    };
    memory.check(asked, bytes).map_err(|refused| OpError::DoesNotFit {
        what,
        asked,
        most: refused.most,
        edges: edges(asked),
        bytes: BYTES_PER_EDGE * edges(asked),
        budget: refused.budget,
    })
}

/// Asks for Ctrl-C now and then: to be called in each turn of a long loop.
pub(super) fn ask(progress: &dyn Progress, turn: usize) -> Result<(), OpError> {
    if turn.is_multiple_of(STRIDE) && progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_neither_memory_nor_mesh_is_refused() {
        let grow = |rounds: u32| 12.0 * 4.0_f64.powi(rounds as i32);
        let check =
            |bytes, rounds| check_size_within(Memory::of_bytes(bytes), "rounds", rounds, grow);
        assert_eq!(check(1e9, 8), Ok(()));
        let OpError::DoesNotFit { most, edges, .. } = check(1e9, 16).expect_err("too much") else {
            panic!("another error");
        };
        assert_eq!((most, edges), (9, grow(16)));
        // Without limit of memory the store has one.
        let OpError::DoesNotFit { most, .. } =
            check(f64::INFINITY, 32).expect_err("more than a mesh can hold")
        else {
            panic!("another error");
        };
        assert_eq!(most, 12);
    }
}
