//! The solver's data, its clock and its queue.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::super::graph::Graph;
use super::node::{Link, NONE, Node, State};
use super::{Barrier, Unmatched};
use crate::progress::Progress;

/// An event: its time, and an edge (below the number of edges) or a blossom (the node's number on
/// top of that).
type Event = Reverse<(i64, u32)>;

/// When an edge is not in the queue.
const NEVER: i64 = i64::MAX;
/// Between two questions whether to go on, in events.
const EVENTS: usize = 4096;

/// The state of the search.
pub(super) struct Solver<'a> {
    pub graph: &'a Graph,
    /// Four times the given weights: then all event times are integers, because all roots keep even
    /// radii.
    pub weights: Vec<i64>,
    pub nodes: Vec<Node>,
    /// Numbers of blossoms that were taken apart, to be used again.
    pub free_nodes: Vec<u32>,
    /// The label of each vertex.
    pub label: Vec<u32>,
    /// What each vertex adds to its label's offset and its top node's dual to give its radius.
    pub base: Vec<i64>,
    /// The top node of each label.
    pub label_top: Vec<u32>,
    /// What is added to the radius of all vertices with the label.
    pub offset: Vec<i64>,
    /// Labels in no use.
    pub free_labels: Vec<u32>,
    /// The nodes that have ever been in each tree; trees are numbered by their root vertices.
    pub members: Vec<Vec<u32>>,
    /// For the walk to the common ancestor: the last search that came by.
    pub seen: Vec<u32>,
    pub search: u32,
    pub now: i64,
    trees: usize,
    queued: Vec<i64>,
    queue: BinaryHeap<Event>,
}

impl<'a> Solver<'a> {
    /// A solver with a first matching and duals that fit it.
    pub fn new(graph: &'a Graph, weights: &[i64]) -> Self {
        let n = graph.vertex_count();
        let mut solver = Self {
            graph,
            weights: weights.iter().map(|w| 4 * w).collect(),
            nodes: (0..n).map(Node::vertex).collect(),
            free_nodes: Vec::new(),
            label: (0..n).collect(),
            base: vec![0; n as usize],
            label_top: (0..n).collect(),
            offset: vec![0; n as usize],
            free_labels: Vec::new(),
            members: vec![Vec::new(); n as usize],
            seen: vec![0; n as usize],
            search: 0,
            now: 0,
            trees: 0,
            queued: vec![NEVER; weights.len()],
            queue: BinaryHeap::new(),
        };
        solver.start_greedily();
        solver
    }

    /// Gives every vertex half its least edge, then raises one after the other until an edge is
    /// tight, and matches along tight edges where both ends are still alone. All duals are even.
    fn start_greedily(&mut self) {
        let n = self.graph.vertex_count();
        for v in 0..n {
            let least = self.proper_edges(v).map(|e| self.weights[e as usize] / 2).min();
            self.nodes[v as usize].dual = least.unwrap_or(0);
        }
        for v in 0..n {
            if self.nodes[v as usize].mate.is_some() {
                continue;
            }
            let Some(gap) = self.proper_edges(v).map(|e| self.slack(e)).min() else { continue };
            self.nodes[v as usize].dual += gap;
            let lonely = |&e: &u32| {
                !self.nodes[self.graph.other(e, v) as usize].mate.is_some() && self.slack(e) == 0
            };
            if let Some(e) = self.proper_edges(v).find(lonely) {
                let u = self.graph.other(e, v);
                self.nodes[v as usize].mate = Link { edge: e, own: v };
                self.nodes[u as usize].mate = Link { edge: e, own: u };
            }
        }
    }

    /// The edges of a vertex that are no loops.
    fn proper_edges(&self, v: u32) -> impl Iterator<Item = u32> + use<'a> {
        let graph = self.graph;
        graph.incident(v).iter().copied().filter(move |&e| graph.other(e, v) != v)
    }

    /// Searches until every vertex is matched.
    ///
    /// # Errors
    /// The barrier when that cannot be, or that the user cancelled.
    pub fn run(&mut self, progress: &dyn Progress) -> Result<(), Unmatched> {
        let roots: Vec<u32> =
            (0..self.graph.vertex_count()).filter(|&v| !self.node(v).mate.is_some()).collect();
        self.trees = roots.len();
        for &v in &roots {
            self.join_tree(v, State::Outer, v);
        }
        for &v in &roots {
            self.watch(v);
        }
        let mut events = 0;
        while self.trees > 0 {
            if events % EVENTS == 0 {
                if progress.is_cancelled() {
                    return Err(Unmatched::Cancelled);
                }
                progress.report("matching folds", roots.len() - self.trees, roots.len());
            }
            events += 1;
            let Some(Reverse((time, what))) = self.queue.pop() else {
                return Err(Unmatched::Barrier(self.barrier()));
            };
            self.now = time;
            let edges = self.weights.len() as u32;
            if what < edges { self.edge_event(what) } else { self.blossom_event(what - edges) }
        }
        Ok(())
    }

    fn edge_event(&mut self, e: u32) {
        if self.queued[e as usize] != self.now {
            return;
        }
        self.queued[e as usize] = NEVER;
        let [u, v] = self.graph.ends[e as usize];
        let (a, b) = (self.top(u), self.top(v));
        if a == b {
            return;
        }
        // The edge was queued when it closed faster than it does now.
        if self.slack(e) > 0 {
            return self.queue_edge(e);
        }
        match (self.node(a).state, self.node(b).state) {
            (State::Outer, State::Free) => self.grow(Link { edge: e, own: u }),
            (State::Free, State::Outer) => self.grow(Link { edge: e, own: v }),
            (State::Outer, State::Outer) if self.node(a).tree == self.node(b).tree => {
                self.shrink(e)
            }
            (State::Outer, State::Outer) => {
                self.augment(e);
                self.trees -= 2;
            }
            _ => {}
        }
    }

    fn blossom_event(&mut self, b: u32) {
        let node = self.node(b);
        if node.parent == NONE && node.state == State::Inner && node.dual_at(self.now) == 0 {
            self.expand(b);
        }
    }

    /// Without the inner vertices every outer node is a part of its own, and there is one more of
    /// them in each tree.
    fn barrier(&self) -> Barrier {
        let is_inner = |&v: &u32| self.node(v).parent == NONE && self.node(v).state == State::Inner;
        let vertices: Vec<u32> = (0..self.graph.vertex_count()).filter(is_inner).collect();
        let odd_parts = vertices.len() + self.trees;
        Barrier { vertices, odd_parts }
    }

    // ---- reading --------------------------------------------------------------------------------

    pub fn node(&self, n: u32) -> &Node {
        &self.nodes[n as usize]
    }

    pub fn node_mut(&mut self, n: u32) -> &mut Node {
        &mut self.nodes[n as usize]
    }

    /// The top node that holds a vertex.
    pub fn top(&self, v: u32) -> u32 {
        self.label_top[self.label[v as usize] as usize]
    }

    /// The sum of the duals of all nodes that hold a vertex.
    fn radius(&self, v: u32) -> i64 {
        let label = self.label[v as usize] as usize;
        self.base[v as usize]
            + self.offset[label]
            + self.node(self.label_top[label]).dual_at(self.now)
    }

    /// Weight less radii; meaningful for edges between two top nodes.
    fn slack(&self, e: u32) -> i64 {
        let [u, v] = self.graph.ends[e as usize];
        self.weights[e as usize] - self.radius(u) - self.radius(v)
    }

    /// The vertex at the far end of a link.
    pub fn far(&self, link: Link) -> u32 {
        self.graph.other(link.edge, link.own)
    }

    /// The same edge seen from its other end.
    pub fn turned(&self, link: Link) -> Link {
        Link { edge: link.edge, own: self.far(link) }
    }

    /// The vertices of a node.
    pub fn leaves(&self, n: u32) -> Vec<u32> {
        if self.node(n).children.is_empty() {
            return vec![n];
        }
        let mut leaves = Vec::with_capacity(self.node(n).size as usize);
        let mut stack = vec![n];
        while let Some(m) = stack.pop() {
            let children = &self.node(m).children;
            if children.is_empty() {
                leaves.push(m)
            } else {
                stack.extend(children.iter().rev().map(|c| c.node))
            }
        }
        leaves
    }

    // ---- the queue ------------------------------------------------------------------------------

    /// Puts a top node into a tree.
    pub fn join_tree(&mut self, n: u32, state: State, tree: u32) {
        let (now, blossom) = (self.now, n >= self.graph.vertex_count());
        let node = self.node_mut(n);
        node.turn(state, now);
        node.tree = tree;
        let end = now + node.dual;
        self.members[tree as usize].push(n);
        if blossom && state == State::Inner {
            self.queue.push(Reverse((end, self.weights.len() as u32 + n)));
        }
    }

    /// Queues the edges of a node that has begun to grow or has stopped to shrink. A node that
    /// grows less than before needs nothing: its edges come up too early and are queued again.
    pub fn watch(&mut self, n: u32) {
        for v in self.leaves(n) {
            for &e in self.graph.incident(v) {
                self.queue_edge(e);
            }
        }
    }

    fn queue_edge(&mut self, e: u32) {
        let [a, b] = self.graph.ends[e as usize].map(|v| self.top(v));
        let rate = self.node(a).state.rate() + self.node(b).state.rate();
        if a == b || rate <= 0 {
            return;
        }
        let time = self.now + self.slack(e) / rate;
        if time < self.queued[e as usize] {
            self.queued[e as usize] = time;
            self.queue.push(Reverse((time, e)));
        }
    }
}
