//! The faces of a forest laid out in the plane, with all pairs that overlap, kept up to date move
//! by move.

use glam::DVec2;

use super::dual::{Dual, NONE};
use super::forest::Forest;
use super::grid::Grid;
use super::overlap::{boxes_overlap, overlap};

/// A rigid motion of the plane: turn by `rotation` (a unit complex number), then shift.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    rotation: DVec2,
    shift: DVec2,
}

impl Motion {
    fn apply(self, p: DVec2) -> DVec2 {
        self.rotation.rotate(p) + self.shift
    }
}

/// See the module documentation.
#[derive(Debug, Clone)]
pub(super) struct Layout<'a> {
    pub dual: &'a Dual,
    pub forest: Forest,
    /// Face → number of its piece. Numbers may have gaps.
    pub piece: Vec<u32>,
    /// Face → how it is turned against its own frame.
    rotation: Vec<DVec2>,
    /// Corner → where it lies.
    pub flat: Vec<DVec2>,
    /// Face → its box.
    bounds: Vec<[DVec2; 2]>,
    grid: Grid,
    /// All pairs that overlap, in no particular but a repeatable order.
    pub overlaps: Vec<(u32, u32)>,
    /// Face → the faces that it overlaps.
    partners: Vec<Vec<u32>>,
    /// Face → number of the move that it takes part in.
    moved: Vec<u32>,
    moves: u32,
    pieces: u32,
}

impl<'a> Layout<'a> {
    /// Lays out a forest. Gives up (`None`) when more than `limit` pairs overlap.
    pub fn new(dual: &'a Dual, forest: Forest, limit: usize) -> Option<Self> {
        let n = dual.face_count();
        let mut layout = Self {
            dual,
            piece: (0..n as u32).map(|f| forest.root(f)).collect(),
            forest,
            rotation: vec![DVec2::X; n],
            flat: dual.local.clone(),
            bounds: vec![[DVec2::ZERO; 2]; n],
            grid: Grid::new(&dual.diameter),
            overlaps: Vec::new(),
            partners: vec![Vec::new(); n],
            moved: vec![0; n],
            moves: 0,
            pieces: n as u32,
        };
        layout.lay_all();
        layout.find_all(limit).then_some(layout)
    }

    /// Lays every face against its parent, from the roots outwards.
    fn lay_all(&mut self) {
        for i in 0..self.forest.order().len() {
            let f = self.forest.order()[i];
            let s = self.forest.parent_side[f as usize];
            let motion = if s == NONE {
                Motion { rotation: DVec2::X, shift: DVec2::ZERO }
            } else {
                self.placement(s)
            };
            self.rotation[f as usize] = motion.rotation;
            let corners = self.dual.corners(f);
            for c in corners.clone() {
                self.flat[c] = motion.apply(self.dual.local[c]);
            }
            self.bounds[f as usize] = bounds(&self.flat[corners]);
        }
    }

    /// Where the face of `s` comes to lie when it hangs on its neighbour across `s`: directions are
    /// composed (and kept at unit length), and the middles of the two sides meet, so that nothing
    /// drifts along a chain.
    fn placement(&self, s: u32) -> Motion {
        let dual = self.dual;
        let t = dual.across[s as usize];
        let neighbour = dual.owner[t as usize] as usize;
        let [here, there] = [s, t].map(|side| dual.direction[side as usize]);
        let along = self.rotation[neighbour].rotate(there);
        let rotation = along.rotate(-DVec2::new(here.x, -here.y)).normalize();
        let middle = (self.flat[t as usize] + self.flat[dual.next(t) as usize]) / 2.0;
        let own = (dual.local[s as usize] + dual.local[dual.next(s) as usize]) / 2.0;
        Motion { rotation, shift: middle - rotation.rotate(own) }
    }

    /// Fills the grid and finds all overlaps; false when there are more than `limit`.
    fn find_all(&mut self, limit: usize) -> bool {
        let mut found = Vec::new();
        for f in 0..self.dual.face_count() as u32 {
            let (own, piece) = (self.bounds[f as usize], self.piece[f as usize]);
            let corners = &self.flat[self.dual.corners(f)];
            self.grid.visit(piece, own, &self.bounds, |g| {
                if self.meets(f, corners, own, g) {
                    found.push((g, f));
                }
                found.len() <= limit
            });
            if found.len() > limit {
                return false;
            }
            self.grid.insert(f, piece, own);
        }
        self.set_overlaps(found);
        true
    }

    /// Whether face `f` with its corners at `corners` and its box at `own` overlaps face `g` where
    /// it lies.
    fn meets(&self, f: u32, corners: &[DVec2], own: [DVec2; 2], g: u32) -> bool {
        boxes_overlap(own, self.bounds[g as usize], self.dual.bound)
            && overlap(self.dual, f, corners, g, &self.flat[self.dual.corners(g)])
    }

    fn set_overlaps(&mut self, overlaps: Vec<(u32, u32)>) {
        for (f, g) in std::mem::replace(&mut self.overlaps, overlaps) {
            [f, g].into_iter().for_each(|f| self.partners[f as usize].clear());
        }
        for &(f, g) in &self.overlaps {
            self.partners[f as usize].push(g);
            self.partners[g as usize].push(f);
        }
    }

    fn is_crossing(&self, (f, g): (u32, u32)) -> bool {
        self.is_marked(f) != self.is_marked(g)
    }

    /// Whether a face is among those last given to [`Self::mark`].
    pub fn is_marked(&self, f: u32) -> bool {
        self.moved[f as usize] == self.moves
    }

    /// Chooses the faces that the next moves are about. Returns how many overlaps they have with
    /// the rest.
    pub fn mark(&mut self, faces: &[u32]) -> usize {
        self.moves += 1;
        faces.iter().for_each(|&f| self.moved[f as usize] = self.moves);
        faces
            .iter()
            .flat_map(|&f| &self.partners[f as usize])
            .filter(|&&g| !self.is_marked(g))
            .count()
    }

    /// How the marked faces would move when the face of `s`, one of them, were hung on its
    /// neighbour across `s`.
    pub fn motion(&self, s: u32) -> Motion {
        let goal = self.placement(s);
        let f = self.dual.owner[s as usize];
        let now = self.rotation[f as usize];
        let rotation = goal.rotation.rotate(DVec2::new(now.x, -now.y)).normalize();
        let own = (self.dual.local[s as usize] + self.dual.local[self.dual.next(s) as usize]) / 2.0;
        let middle = (self.flat[s as usize] + self.flat[self.dual.next(s) as usize]) / 2.0;
        Motion { rotation, shift: goal.apply(own) - rotation.rotate(middle) }
    }

    /// The overlaps that the marked faces would have with the others of `piece` after a motion,
    /// into `found`; stops when there are more than `limit`. Returns how many faces were tried.
    pub fn try_motion(
        &self,
        faces: &[u32],
        motion: Motion,
        piece: u32,
        limit: usize,
        found: &mut Vec<(u32, u32)>,
    ) -> usize {
        found.clear();
        let mut corners = Vec::new();
        for (tried, &f) in faces.iter().enumerate() {
            corners.clear();
            corners.extend(self.flat[self.dual.corners(f)].iter().map(|&p| motion.apply(p)));
            let own = bounds(&corners);
            self.grid.visit(piece, own, &self.bounds, |g| {
                if !self.is_marked(g) && self.meets(f, &corners, own, g) {
                    found.push((f, g));
                }
                found.len() <= limit
            });
            if found.len() > limit {
                return tried + 1;
            }
        }
        faces.len()
    }

    /// Carries out a motion: the fold above `cut` opens (unless `NONE`), the marked `faces` move to
    /// `piece` and hang on by `s`, and `found` are their overlaps with the rest.
    pub fn carry_out(
        &mut self,
        faces: &[u32],
        cut: u32,
        s: u32,
        motion: Motion,
        found: &[(u32, u32)],
    ) {
        let piece = self.piece[self.dual.neighbour(s) as usize];
        let kept = self.overlaps.iter().filter(|&&pair| !self.is_crossing(pair));
        let overlaps = kept.chain(found).copied().collect();
        self.set_overlaps(overlaps);
        for &f in faces {
            self.grid.remove(f);
            for c in self.dual.corners(f) {
                self.flat[c] = motion.apply(self.flat[c]);
            }
            let turned = motion.rotation.rotate(self.rotation[f as usize]);
            self.rotation[f as usize] = turned.normalize();
            self.bounds[f as usize] = bounds(&self.flat[self.dual.corners(f)]);
            self.piece[f as usize] = piece;
            self.grid.insert(f, piece, self.bounds[f as usize]);
        }
        self.forest.rehang(self.dual, cut, s);
    }

    /// Opens the fold above `c`: the smaller part becomes a piece of its own.
    pub fn split(&mut self, c: u32) {
        let mut faces = Vec::new();
        self.forest.smaller_part(c, &mut faces);
        self.lift(&faces);
        self.forest.split(self.dual, c);
        self.drop_parted();
    }

    /// The overlapping pairs of `faces` with the rest of their piece, into `pairs`.
    pub fn pairs_parted_by(&mut self, faces: &[u32], pairs: &mut Vec<(u32, u32)>) {
        self.mark(faces);
        pairs.clear();
        for &f in faces {
            let partners = self.partners[f as usize].iter().copied();
            let is_parted =
                |&g: &u32| !self.is_marked(g) && self.piece[g as usize] == self.piece[f as usize];
            pairs.extend(partners.filter(is_parted).map(|g| (f, g)));
        }
    }

    /// Opens the fold above `c` as [`Self::split`] does, given the smaller part, but leaves the order
    /// of the forest and the list of overlaps as they were. Call [`Self::settle_opened`] after the
    /// last.
    pub fn open(&mut self, c: u32, faces: &[u32]) {
        self.lift(faces);
        self.forest.parent_side[c as usize] = NONE;
    }

    /// Brings the forest and the list of overlaps up to date after folds were opened.
    pub fn settle_opened(&mut self) {
        self.forest.refresh(self.dual);
        self.drop_parted();
    }

    /// Makes a piece of its own of faces, where they lie.
    fn lift(&mut self, faces: &[u32]) {
        let piece = self.pieces;
        self.pieces += 1;
        for &f in faces {
            self.grid.remove(f);
            self.grid.insert(f, piece, self.bounds[f as usize]);
            self.piece[f as usize] = piece;
        }
    }

    /// Forgets overlaps between faces that are no longer in one piece.
    fn drop_parted(&mut self) {
        let is_within = |&&(f, g): &&(u32, u32)| self.piece[f as usize] == self.piece[g as usize];
        let overlaps = self.overlaps.iter().filter(is_within).copied().collect();
        self.set_overlaps(overlaps);
    }

    /// The same forest laid out afresh, each piece from its middle, free of what the moves have
    /// lost to rounding.
    pub fn fresh(mut self) -> Self {
        self.forest.hang_from_middles(self.dual);
        Layout::new(self.dual, self.forest, usize::MAX).expect("no limit, no giving up")
    }
}

fn bounds(corners: &[DVec2]) -> [DVec2; 2] {
    let first = corners[0];
    corners[1..].iter().fold([first, first], |[low, high], &p| [low.min(p), high.max(p)])
}
