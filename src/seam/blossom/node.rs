//! What the solver knows about a vertex or a blossom.

/// No node, no edge, no label.
pub(super) const NONE: u32 = u32::MAX;
/// The parent of a blossom that was taken apart.
pub(super) const GONE: u32 = u32::MAX - 1;

/// An edge as seen from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Link {
    /// The edge, or [`NONE`].
    pub edge: u32,
    /// The vertex at this end.
    pub own: u32,
}

impl Link {
    pub const NOTHING: Self = Self { edge: NONE, own: NONE };

    pub fn is_some(self) -> bool {
        self.edge != NONE
    }
}

/// What a top node does as time goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// Matched and in no tree: it stays as it is. Nodes inside a blossom are free too.
    Free,
    /// At an even distance from its root: it grows.
    Outer,
    /// At an odd distance from its root: it shrinks.
    Inner,
}

impl State {
    /// The change of the dual value per unit of time.
    pub fn rate(self) -> i64 {
        match self {
            Self::Free => 0,
            Self::Outer => 1,
            Self::Inner => -1,
        }
    }
}

/// A node of a blossom's cycle, with the edge to the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Child {
    /// The node.
    pub node: u32,
    /// The edge to the next child, seen from this one.
    pub link: Link,
}

/// A vertex (number below the number of vertices) or a blossom.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// What it does.
    pub state: State,
    /// The dual value at the time `since`.
    pub dual: i64,
    /// When `dual` was noted.
    pub since: i64,
    /// The blossom that holds it, [`NONE`] for a top node, [`GONE`] for a blossom that no longer
    /// is.
    pub parent: u32,
    /// The matched edge of a top node; nothing at a root.
    pub mate: Link,
    /// The edge from an inner node to its outer parent in the tree.
    pub up: Link,
    /// The tree of a node that is not free.
    pub tree: u32,
    /// The label of a top node.
    pub label: u32,
    /// Number of vertices.
    pub size: u32,
    /// Which child's label the blossom took over.
    pub heir: u32,
    /// The odd cycle; empty for a vertex.
    pub children: Vec<Child>,
}

impl Node {
    /// A matched or unmatched vertex with nothing around it.
    pub fn vertex(label: u32) -> Self {
        Self {
            state: State::Free,
            dual: 0,
            since: 0,
            parent: NONE,
            mate: Link::NOTHING,
            up: Link::NOTHING,
            tree: NONE,
            label,
            size: 1,
            heir: 0,
            children: Vec::new(),
        }
    }

    /// The dual value at a time.
    pub fn dual_at(&self, now: i64) -> i64 {
        self.dual + self.state.rate() * (now - self.since)
    }

    /// Changes the state at a time.
    pub fn turn(&mut self, state: State, now: i64) {
        self.dual = self.dual_at(now);
        self.since = now;
        self.state = state;
    }
}
