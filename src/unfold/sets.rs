//! Which faces are connected, while more and more are joined.

/// Sets of connected faces (union-find).
#[derive(Debug)]
pub(super) struct Sets(Vec<u32>);

impl Sets {
    /// Every face alone.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn leader(&mut self, mut f: u32) -> u32 {
        while self.0[f as usize] != f {
            let above = self.0[self.0[f as usize] as usize];
            self.0[f as usize] = above;
            f = above;
        }
        f
    }

    /// Joins the sets of two faces; false when they were one already.
    pub fn join(&mut self, f: u32, g: u32) -> bool {
        let (f, g) = (self.leader(f), self.leader(g));
        self.0[f as usize] = g;
        f != g
    }
}
