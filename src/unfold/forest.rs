//! Which faces are connected: one tree of folds for each piece, by parent pointers.

use super::dual::{Dual, FLAT, NONE};

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
    /// Face → number of folds up to the root, up to a constant of its tree.
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
        (0..self.parent_side.len() as u32)
            .filter(|&f| self.parent_side[f as usize] == NONE)
            .collect()
    }

    /// The faces that hang on `f`.
    fn children(&self, dual: &Dual, f: u32) -> impl Iterator<Item = u32> {
        let below = dual.sides(f).map(|s| dual.across[s as usize]).filter(|&t| t != NONE);
        below
            .filter(|&t| self.parent_side[dual.owner[t as usize] as usize] == t)
            .map(|t| dual.owner[t as usize])
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

    /// The same, where the order is out of date: walks both parts in turns until one ends.
    pub fn smaller_part_by_walk(&self, dual: &Dual, c: u32) -> Vec<u32> {
        // Each entry is a face and the face that the walk came from.
        let above = self.parent(dual, c);
        let mut parts = [vec![(c, above)], vec![(above, c)]];
        let mut done = 0;
        loop {
            for part in &mut parts {
                let Some(&(f, from)) = part.get(done) else {
                    return part.iter().map(|&(f, _)| f).collect();
                };
                let next = self.children(dual, f).chain([self.parent(dual, f)]);
                part.extend(next.filter(|&g| g != NONE && g != from).map(|g| (g, f)));
            }
            done += 1;
        }
    }

    /// Opens the fold above `c`: its subtree becomes a tree of its own. Touches that tree only.
    pub fn split(&mut self, dual: &Dual, c: u32) {
        let (mut at, _) = self.tree_run(c);
        let root = self.root[c as usize];
        self.parent_side[c as usize] = NONE;
        for root in [root, c] {
            for f in self.laid_order(dual, root, root, 0) {
                self.order[at] = f;
                self.rank[f as usize] = at as u32;
                at += 1;
            }
        }
    }

    /// Whether the fold above `c` opens only where nothing else helps: the caller wants it to stay,
    /// or it is flat, and a seam through a plane face would show for nothing.
    pub fn must_keep(&self, dual: &Dual, c: u32) -> bool {
        match self.parent_side[c as usize] {
            NONE => false,
            s => {
                let hinge = dual.hinges[dual.hinge[s as usize] as usize];
                hinge.is_kept || (dual.keeps_flat && hinge.fold <= FLAT)
            }
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
            let lower =
                if self.depth[f as usize] >= self.depth[g as usize] { &mut f } else { &mut g };
            folds.push(*lower);
            *lower = self.parent(dual, *lower);
        }
    }

    /// The lowest face above (or equal to) two faces of one tree.
    pub fn meeting(&self, dual: &Dual, mut f: u32, mut g: u32) -> u32 {
        while f != g {
            let lower =
                if self.depth[f as usize] >= self.depth[g as usize] { &mut f } else { &mut g };
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

    /// Opens the fold above `cut` (unless `NONE`) and joins the part with the face of `s` to the
    /// tree beyond `s`. The part is the smaller one of the cut, or the whole tree of that face.
    /// Touches little more than the part and what lies between its old and its new place in the
    /// order.
    pub fn rehang(&mut self, dual: &Dual, cut: u32, s: u32) {
        let (f, g) = (dual.owner[s as usize], dual.neighbour(s));
        let (first, tree_end) = self.tree_run(f);
        let start = if cut == NONE { first } else { self.rank[cut as usize] as usize };
        let end = if cut == NONE { tree_end } else { start + self.size[cut as usize] as usize };
        let is_inner = (start..end).contains(&(self.rank[f as usize] as usize));
        // The part is one run of the order, or what a tree has before and after the run that stays.
        let runs = if is_inner { [start..end, end..end] } else { [first..start, end..tree_end] };
        let count = (runs[0].len() + runs[1].len()) as u32;
        if cut != NONE {
            if is_inner {
                let above = self.parent(dual, cut);
                self.grow_above(dual, above, count.wrapping_neg());
            } else {
                (start..end).for_each(|i| self.root[self.order[i] as usize] = cut);
            }
            self.parent_side[cut as usize] = NONE;
        }
        self.hang_from(dual, f);
        self.parent_side[f as usize] = s;
        let (root, depth) = (self.root[g as usize], self.depth[g as usize] + 1);
        let part = self.laid_order(dual, f, root, depth);
        self.grow_above(dual, g, count);
        self.splice(&part, runs, self.rank[g as usize] as usize + 1);
    }

    /// Where the tree of `f` stands in the order.
    fn tree_run(&self, f: u32) -> (usize, usize) {
        let root = self.root[f as usize] as usize;
        (self.rank[root] as usize, (self.rank[root] + self.size[root]) as usize)
    }

    /// Adds to the sizes of `f` and all above it.
    fn grow_above(&mut self, dual: &Dual, mut f: u32, by: u32) {
        while f != NONE {
            self.size[f as usize] = self.size[f as usize].wrapping_add(by);
            f = self.parent(dual, f);
        }
    }

    /// The faces that hang on `f`, `f` first, with new roots, depths and sizes.
    fn laid_order(&mut self, dual: &Dual, f: u32, root: u32, depth: u32) -> Vec<u32> {
        let (mut part, mut stack) = (Vec::new(), vec![f]);
        self.depth[f as usize] = depth;
        while let Some(f) = stack.pop() {
            part.push(f);
            (self.root[f as usize], self.size[f as usize]) = (root, 1);
            let first_child = stack.len();
            stack.extend(self.children(dual, f));
            for &child in &stack[first_child..] {
                self.depth[child as usize] = self.depth[f as usize] + 1;
            }
        }
        for &f in part[1..].iter().rev() {
            let above = self.parent(dual, f);
            self.size[above as usize] += self.size[f as usize];
        }
        part
    }

    /// Takes `runs` out of the order and puts `part`, which are the same faces, in before the place
    /// `to`.
    fn splice(&mut self, part: &[u32], runs: [std::ops::Range<usize>; 2], to: usize) {
        let low = runs[0].start.min(runs[1].start).min(to);
        let high = runs[0].end.max(runs[1].end).max(to);
        let stays = |range: std::ops::Range<usize>| {
            range.filter(|i| !runs.iter().any(|run| run.contains(i)))
        };
        let mut window = Vec::with_capacity(high - low);
        window.extend(stays(low..to).map(|i| self.order[i]));
        window.extend_from_slice(part);
        window.extend(stays(to..high).map(|i| self.order[i]));
        for (i, &f) in window.iter().enumerate() {
            self.rank[f as usize] = (low + i) as u32;
        }
        self.order[low..high].copy_from_slice(&window);
    }

    /// Whether the edge of `s` is a fold of some tree.
    pub fn is_fold(&self, dual: &Dual, s: u32) -> bool {
        let t = dual.across[s as usize];
        t != NONE
            && (self.parent_side[dual.owner[s as usize] as usize] == s
                || self.parent_side[dual.owner[t as usize] as usize] == t)
    }

    /// Hangs every tree from its middle (no branch larger than half of it), so that paths are short
    /// and lose few digits.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use crate::unfold::Seams;

    #[test]
    fn rehanging_keeps_order_sizes_and_roots_as_a_refresh_would() {
        let mesh = crate::shape::random_tangent_polytope(60, 3);
        let dual = Dual::new(&mesh, &Seams::Free).expect("planar faces");
        let mut forest = Forest::scattered(&dual);
        let mut rng = Rng::new(5);
        let mut part = Vec::new();
        for turn in 0..2000 {
            let c = rng.below(dual.face_count()) as u32;
            let cut = if forest.parent_side[c as usize] == NONE { NONE } else { c };
            if cut == NONE {
                part.clear();
                part.extend_from_slice(forest.subtree(c));
            } else {
                forest.smaller_part(cut, &mut part);
            }
            let leads_out =
                |&s: &u32| dual.across[s as usize] != NONE && !part.contains(&dual.neighbour(s));
            let sides: Vec<u32> =
                part.iter().flat_map(|&f| dual.sides(f)).filter(leads_out).collect();
            if sides.is_empty() {
                continue;
            }
            forest.rehang(&dual, cut, sides[rng.below(sides.len())]);
            let fresh = Forest::new(&dual, forest.parent_side.clone());
            assert_eq!((&forest.size, &forest.root), (&fresh.size, &fresh.root), "{turn}");
            for f in 0..dual.face_count() as u32 {
                let sorted = |forest: &Forest| {
                    let mut faces = forest.subtree(f).to_vec();
                    faces.sort_unstable();
                    faces
                };
                assert_eq!(forest.subtree(f)[0], f);
                assert_eq!(sorted(&forest), sorted(&fresh), "{turn}");
                let above = forest.parent(&dual, f);
                assert!(
                    above == NONE || forest.depth[f as usize] == forest.depth[above as usize] + 1
                );
            }
        }
        assert_eq!(forest.roots().len(), 1);
    }

    #[test]
    fn splitting_keeps_order_sizes_and_roots_as_a_refresh_would() {
        let mesh = crate::shape::random_tangent_polytope(60, 3);
        let dual = Dual::new(&mesh, &Seams::Free).expect("planar faces");
        let mut rng = Rng::new(7);
        let rule = crate::unfold::start::Rule::Longest;
        let mut forest = crate::unfold::start::forest(&dual, &mesh, rule, &mut rng);
        let mut part = Vec::new();
        while forest.roots().len() < dual.face_count() {
            let c = rng.below(dual.face_count()) as u32;
            if forest.parent_side[c as usize] == NONE {
                continue;
            }
            forest.smaller_part(c, &mut part);
            part.sort_unstable();
            let mut walked = forest.smaller_part_by_walk(&dual, c);
            walked.sort_unstable();
            assert_eq!(part, walked);
            forest.split(&dual, c);
            let fresh = Forest::new(&dual, forest.parent_side.clone());
            assert_eq!((&forest.size, &forest.root), (&fresh.size, &fresh.root));
            for f in 0..dual.face_count() as u32 {
                let above = forest.parent(&dual, f);
                assert_eq!(forest.subtree(f)[0], f);
                assert!(above == NONE || forest.subtree(above).contains(&f));
            }
        }
    }
}
