//! Which faces hang together: one tree of folds for each piece, by parent pointers.

use super::dual::{Dual, NONE};

/// Trees over the faces. A face hangs on its parent by one of its own sides.
#[derive(Debug, Clone)]
pub(super) struct Forest {
    /// Face → its side towards the parent, `NONE` at a root.
    pub parent_side: Vec<u32>,
    /// All faces, parents before children, every subtree in one run.
    order: Vec<u32>,
    /// Face → its place in `order`.
    rank: Vec<u32>,
    /// Face → number of faces in its subtree.
    size: Vec<u32>,
    /// Face → number of folds up to the root.
    depth: Vec<u32>,
    /// Face → the root of its tree.
    root: Vec<u32>,
}

impl Forest {
    /// The trees that these parents make.
    pub fn new(dual: &Dual, parent_side: Vec<u32>) -> Self {
        let n = parent_side.len();
        let mut forest = Self {
            parent_side,
            order: Vec::with_capacity(n),
            rank: vec![0; n],
            size: vec![0; n],
            depth: vec![0; n],
            root: vec![0; n],
        };
        forest.refresh(dual);
        forest
    }

    /// Every face by itself.
    pub fn scattered(dual: &Dual) -> Self {
        Self::new(dual, vec![NONE; dual.face_count()])
    }

    /// Brings order, sizes and depths up to date after parents have changed.
    pub fn refresh(&mut self, dual: &Dual) {
        self.order.clear();
        let mut stack = Vec::new();
        for root in self.roots() {
            stack.push(root);
            self.depth[root as usize] = 0;
            while let Some(f) = stack.pop() {
                self.rank[f as usize] = self.order.len() as u32;
                self.root[f as usize] = root;
                self.order.push(f);
                let first_child = stack.len();
                stack.extend(self.children(dual, f));
                for &child in &stack[first_child..] {
                    self.depth[child as usize] = self.depth[f as usize] + 1;
                }
            }
        }
        self.size.fill(1);
        for &f in self.order.iter().rev() {
            let s = self.parent_side[f as usize];
            if s != NONE {
                self.size[dual.neighbour(s) as usize] += self.size[f as usize];
            }
        }
    }

    /// The roots, ascending.
    pub fn roots(&self) -> Vec<u32> {
        (0..self.parent_side.len() as u32).filter(|&f| self.parent_side[f as usize] == NONE).collect()
    }

    /// The faces that hang on `f`.
    fn children(&self, dual: &Dual, f: u32) -> impl Iterator<Item = u32> {
        let below = dual.sides(f).map(|s| dual.across[s as usize]).filter(|&t| t != NONE);
        below.filter(|&t| self.parent_side[dual.owner[t as usize] as usize] == t).map(|t| dual.owner[t as usize])
    }

    /// All faces, parents before children.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The faces of the subtree of `f`, `f` first.
    pub fn subtree(&self, f: u32) -> &[u32] {
        let start = self.rank[f as usize] as usize;
        &self.order[start..start + self.size[f as usize] as usize]
    }

    /// Number of faces in the subtree of `f`.
    pub fn size(&self, f: u32) -> u32 {
        self.size[f as usize]
    }

    /// The root of the tree of `f`.
    pub fn root(&self, f: u32) -> u32 {
        self.root[f as usize]
    }

    /// The parent of `f`; `NONE` at a root.
    pub fn parent(&self, dual: &Dual, f: u32) -> u32 {
        match self.parent_side[f as usize] {
            NONE => NONE,
            s => dual.neighbour(s),
        }
    }

    /// The faces of the smaller part that cutting the fold above `c` would leave.
    pub fn smaller_part(&self, c: u32, faces: &mut Vec<u32>) {
        faces.clear();
        let (inner, tree) = (self.subtree(c), self.subtree(self.root(c)));
        if inner.len() * 2 <= tree.len() {
            faces.extend_from_slice(inner);
        } else {
            let start = (self.rank[c as usize] - self.rank[self.root(c) as usize]) as usize;
            faces.extend_from_slice(&tree[..start]);
            faces.extend_from_slice(&tree[start + inner.len()..]);
        }
    }

    /// Whether the caller wants the fold above `c` to stay.
    pub fn must_keep(&self, dual: &Dual, c: u32) -> bool {
        match self.parent_side[c as usize] {
            NONE => false,
            s => dual.hinges[dual.hinge[s as usize] as usize].is_kept,
        }
    }

    /// Number of faces of that smaller part.
    pub fn smaller_size(&self, c: u32) -> u32 {
        self.size(c).min(self.size(self.root(c)) - self.size(c))
    }

    /// The folds between two faces of one tree, each named by the face below it.
    pub fn path(&self, dual: &Dual, mut f: u32, mut g: u32, folds: &mut Vec<u32>) {
        folds.clear();
        while f != g {
            let lower = if self.depth[f as usize] >= self.depth[g as usize] { &mut f } else { &mut g };
            folds.push(*lower);
            *lower = self.parent(dual, *lower);
        }
    }

    /// The lowest face above (or equal to) two faces of one tree.
    pub fn meeting(&self, dual: &Dual, mut f: u32, mut g: u32) -> u32 {
        while f != g {
            let lower = if self.depth[f as usize] >= self.depth[g as usize] { &mut f } else { &mut g };
            *lower = self.parent(dual, *lower);
        }
        f
    }

    /// Makes `f` the root of its tree. Call [`Self::refresh`] afterwards.
    pub fn hang_from(&mut self, dual: &Dual, f: u32) {
        let mut s = std::mem::replace(&mut self.parent_side[f as usize], NONE);
        while s != NONE {
            let t = dual.across[s as usize];
            s = std::mem::replace(&mut self.parent_side[dual.owner[t as usize] as usize], t);
        }
    }

    /// Joins the tree of the face of `s` to the tree beyond `s`. Call [`Self::refresh`] afterwards.
    pub fn attach(&mut self, dual: &Dual, s: u32) {
        let f = dual.owner[s as usize];
        self.hang_from(dual, f);
        self.parent_side[f as usize] = s;
    }

    /// Whether the edge of `s` is a fold of some tree.
    pub fn is_fold(&self, dual: &Dual, s: u32) -> bool {
        let t = dual.across[s as usize];
        t != NONE
            && (self.parent_side[dual.owner[s as usize] as usize] == s
                || self.parent_side[dual.owner[t as usize] as usize] == t)
    }

    /// Hangs every tree from its middle (no branch larger than half of it), so that paths are short and lose few digits.
    pub fn hang_from_middles(&mut self, dual: &Dual) {
        for root in self.roots() {
            let half = self.size(root) / 2;
            let heavy = |f: u32| self.children(dual, f).find(|&g| self.size(g) > half);
            let mut middle = root;
            while let Some(next) = heavy(middle) {
                middle = next;
            }
            self.hang_from(dual, middle);
        }
        self.refresh(dual);
    }
}
