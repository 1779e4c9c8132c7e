//! The four steps of the search, and the matching that comes out of it.

use super::node::{Child, GONE, Link, NONE, Node, State};
use super::solver::Solver;

impl Solver<'_> {
    /// The node at the far end of a tight edge, and its mate, join the tree of the outer node at
    /// the near end.
    pub fn grow(&mut self, link: Link) {
        let tree = self.node(self.top(link.own)).tree;
        let up = self.turned(link);
        let inner = self.top(up.own);
        let outer = self.top(self.far(self.node(inner).mate));
        self.node_mut(inner).up = up;
        self.join_tree(inner, State::Inner, tree);
        self.join_tree(outer, State::Outer, tree);
        self.watch(outer);
    }

    /// A tight edge joins two trees: the path from root to root is flipped and all nodes of both
    /// become free.
    pub fn augment(&mut self, e: u32) {
        let mut thawed = Vec::new();
        for own in self.graph.ends[e as usize] {
            let top = self.top(own);
            self.flip(top, Link { edge: e, own });
            self.dissolve(self.node(top).tree, &mut thawed);
        }
        for n in thawed {
            self.watch(n);
        }
    }

    /// Matches an outer node along `link` and passes its old edge on, up to the root.
    fn flip(&mut self, mut outer: u32, mut link: Link) {
        loop {
            let old = std::mem::replace(&mut self.node_mut(outer).mate, link);
            if !old.is_some() {
                return;
            }
            let inner = self.top(self.far(old));
            let up = self.node(inner).up;
            self.node_mut(inner).mate = up;
            link = self.turned(up);
            outer = self.top(link.own);
        }
    }

    fn dissolve(&mut self, tree: u32, thawed: &mut Vec<u32>) {
        let now = self.now;
        for n in std::mem::take(&mut self.members[tree as usize]) {
            let node = self.node_mut(n);
            if node.parent != NONE || node.state == State::Free || node.tree != tree {
                continue;
            }
            if node.state == State::Inner {
                thawed.push(n);
            }
            node.turn(State::Free, now);
            node.tree = NONE;
        }
    }

    // ---- blossoms -------------------------------------------------------------------------------

    /// A tight edge between two outer nodes of a tree: the cycle that it closes becomes an outer
    /// blossom.
    pub fn shrink(&mut self, e: u32) {
        let children = self.cycle(e);
        let base = self.node(children[0].node);
        let (mate, tree) = (base.mate, base.tree);
        let thawed: Vec<u32> = children
            .iter()
            .map(|c| c.node)
            .filter(|&c| self.node(c).state == State::Inner)
            .collect();
        let blossom = self.new_blossom(children, mate);
        self.join_tree(blossom, State::Outer, tree);
        for n in thawed {
            self.watch(n);
        }
    }

    /// The cycle that an edge between two outer nodes closes, beginning at the node nearest to the
    /// root.
    fn cycle(&mut self, e: u32) -> Vec<Child> {
        let [u, v] = self.graph.ends[e as usize];
        let (a, b) = (self.top(u), self.top(v));
        let meet = self.common_ancestor(a, b);
        let down: Vec<(u32, Link)> = self.path(a, meet);
        let mut children = Vec::with_capacity(2 * down.len() + 1);
        let mut node = meet;
        for &(below, up) in down.iter().rev() {
            children.push(Child { node, link: self.turned(up) });
            node = below;
        }
        children.push(Child { node, link: Link { edge: e, own: u } });
        children.extend(self.path(b, meet).into_iter().map(|(node, link)| Child { node, link }));
        children
    }

    /// The nodes from `from` up to, but not with, `to`, each with the edge to its parent.
    fn path(&self, from: u32, to: u32) -> Vec<(u32, Link)> {
        let mut path = Vec::new();
        let mut n = from;
        while n != to {
            let link = self.parent_link(n);
            path.push((n, link));
            n = self.top(self.far(link));
        }
        path
    }

    /// The edge of a tree node to its parent; nothing at the root.
    fn parent_link(&self, n: u32) -> Link {
        let node = self.node(n);
        if node.state == State::Inner { node.up } else { node.mate }
    }

    /// Climbs from both nodes in turn, so that the work is that of the cycle and not of the tree.
    fn common_ancestor(&mut self, a: u32, b: u32) -> u32 {
        self.search += 1;
        let (mut here, mut there) = (a, b);
        loop {
            if here != NONE {
                if std::mem::replace(&mut self.seen[here as usize], self.search) == self.search {
                    return here;
                }
                let link = self.parent_link(here);
                here = if link.is_some() { self.top(self.far(link)) } else { NONE };
            }
            std::mem::swap(&mut here, &mut there);
        }
    }

    /// Makes a blossom of top nodes. Radii stay as they are: what the children's duals were goes
    /// into the offsets.
    fn new_blossom(&mut self, children: Vec<Child>, mate: Link) -> u32 {
        let id = self.free_nodes.pop().unwrap_or_else(|| {
            self.nodes.push(Node::vertex(NONE));
            self.seen.push(0);
            self.nodes.len() as u32 - 1
        });
        let now = self.now;
        for child in &children {
            let node = self.node_mut(child.node);
            node.turn(State::Free, now);
            node.parent = id;
        }
        let size_of = |c: &Child| self.node(c.node).size;
        let size = children.iter().map(size_of).sum();
        let largest = children.iter().map(size_of).max().unwrap_or(0);
        let heir =
            children.iter().position(|c| size_of(c) == largest).expect("a blossom has children");
        let Node { label, dual, .. } = *self.node(children[heir].node);
        self.offset[label as usize] += dual;
        self.label_top[label as usize] = id;
        for (i, child) in children.iter().enumerate() {
            if i != heir {
                self.relabel(child.node, label);
            }
        }
        self.nodes[id as usize] =
            Node { since: now, mate, size, heir: heir as u32, children, ..Node::vertex(label) };
        id
    }

    /// Gives the vertices of a child the label of its new blossom, and its own label back.
    fn relabel(&mut self, child: u32, label: u32) {
        let Node { label: old, dual, .. } = *self.node(child);
        let change = self.offset[old as usize] + dual - self.offset[label as usize];
        for v in self.leaves(child) {
            self.base[v as usize] += change;
            self.label[v as usize] = label;
        }
        self.free_labels.push(old);
    }

    /// Takes an inner blossom whose dual is 0 apart: the even way round between its two tree edges
    /// stays in the tree, the other children become free, matched in pairs.
    pub fn expand(&mut self, b: u32) {
        let tree = self.node(b).tree;
        let Node { mate, up, .. } = *self.node(b);
        let (entry, exit) = (self.child_of(b, up.own), self.child_of(b, mate.own));
        let children = self.release(b);
        let count = children.len();
        let forward = ((exit + count - entry) % count).is_multiple_of(2);
        let step = |solver: &Self, i: usize| {
            let j = if forward { (i + 1) % count } else { (i + count - 1) % count };
            let (here, there) = if forward {
                (children[i].link, solver.turned(children[i].link))
            } else {
                (solver.turned(children[j].link), children[j].link)
            };
            (j, here, there)
        };
        let mut grown = Vec::new();
        let (mut i, mut link_up) = (entry, up);
        loop {
            let inner = children[i].node;
            self.node_mut(inner).up = link_up;
            self.join_tree(inner, State::Inner, tree);
            if i == exit {
                self.node_mut(inner).mate = mate;
                break;
            }
            let (j, here, there) = step(self, i);
            let outer = children[j].node;
            self.node_mut(inner).mate = here;
            self.node_mut(outer).mate = there;
            self.join_tree(outer, State::Outer, tree);
            grown.push(outer);
            (i, _, link_up) = step(self, j);
        }
        (i, _, _) = step(self, exit);
        while i != entry {
            let (j, here, there) = step(self, i);
            self.node_mut(children[i].node).mate = here;
            self.node_mut(children[j].node).mate = there;
            grown.extend([children[i].node, children[j].node]);
            (i, _, _) = step(self, j);
        }
        for n in grown {
            self.watch(n);
        }
    }

    /// The place in a blossom's cycle of the child that holds a vertex.
    fn child_of(&self, blossom: u32, v: u32) -> usize {
        let mut n = v;
        while self.node(n).parent != blossom {
            n = self.node(n).parent;
        }
        self.node(blossom)
            .children
            .iter()
            .position(|c| c.node == n)
            .expect("a parent holds its child")
    }

    /// Makes the children of a blossom with dual 0 top nodes again, with labels of their own, and
    /// forgets the blossom.
    fn release(&mut self, b: u32) -> Vec<Child> {
        let children = std::mem::take(&mut self.node_mut(b).children);
        let Node { label, heir, .. } = *self.node(b);
        let offset = self.offset[label as usize];
        for (i, child) in children.iter().enumerate() {
            self.node_mut(child.node).parent = NONE;
            let dual = self.node(child.node).dual;
            self.node_mut(child.node).since = self.now;
            if i == heir as usize {
                self.node_mut(child.node).label = label;
                self.offset[label as usize] = offset - dual;
                self.label_top[label as usize] = child.node;
                continue;
            }
            let fresh = self.free_labels.pop().expect("there are as many labels as vertices");
            self.node_mut(child.node).label = fresh;
            self.offset[fresh as usize] = 0;
            self.label_top[fresh as usize] = child.node;
            for v in self.leaves(child.node) {
                self.base[v as usize] += offset - dual;
                self.label[v as usize] = fresh;
            }
        }
        self.node_mut(b).parent = GONE;
        self.free_nodes.push(b);
        children
    }

    // ---- the result -----------------------------------------------------------------------------

    /// The matched edges: in every blossom, from the outside in, the child at the matched edge
    /// takes it over and the others are matched in pairs around the cycle.
    pub fn matching(&self) -> Vec<u32> {
        let mut mates: Vec<Link> = self.nodes.iter().map(|n| n.mate).collect();
        let tops = (0..self.nodes.len() as u32).filter(|&n| self.node(n).parent == NONE);
        let mut stack: Vec<u32> = tops.collect();
        while let Some(n) = stack.pop() {
            let children = &self.node(n).children;
            if children.is_empty() {
                continue;
            }
            let mate = mates[n as usize];
            let exit = self.child_of(n, mate.own);
            mates[children[exit].node as usize] = mate;
            for i in (1..children.len()).step_by(2) {
                let [here, there] = [i, i + 1].map(|k| children[(exit + k) % children.len()]);
                mates[here.node as usize] = here.link;
                mates[there.node as usize] = self.turned(here.link);
            }
            stack.extend(children.iter().map(|c| c.node));
        }
        let vertices = 0..self.graph.vertex_count();
        vertices
            .map(|v| mates[v as usize])
            .filter(|m| m.own <= self.far(*m))
            .map(|m| m.edge)
            .collect()
    }

    /// The dual values at the end of the search.
    #[cfg(test)]
    pub fn certificate(&self) -> super::Certificate {
        let n = self.graph.vertex_count();
        let dual = |i: u32| self.node(i).dual_at(self.now);
        let is_blossom = |&i: &u32| self.node(i).parent != GONE;
        let blossoms = (n..self.nodes.len() as u32)
            .filter(is_blossom)
            .map(|b| (self.leaves(b), dual(b)))
            .collect();
        super::Certificate { vertices: (0..n).map(dual).collect(), blossoms }
    }
}
