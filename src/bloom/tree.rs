//! The faces of a net as a forest: each hangs on another one by the line about which it turns.

use std::collections::{HashMap, VecDeque};

use glam::{DQuat, DVec2};

use super::Pose;
use crate::net::{EdgeLabel, FlatFace, Net, Segment};

/// What a face turns about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HingeKind {
    /// A fold of its piece.
    Fold,
    /// A seam that was closed.
    Seam,
}

/// The line between a face and the one that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct Hinge {
    /// The carrier, by its place in [`FoldTree::leaves`].
    pub parent: usize,
    /// In the flat frame of the carrier's piece, with the carrier on its left.
    pub line: Segment,
    /// How far the face has turned about the line when closed, in radians; positive bends away from
    /// who looks from outside.
    pub angle: f64,
    /// The edge of the model.
    pub edge: EdgeLabel,
    /// Fold or seam.
    pub kind: HingeKind,
    /// Where the frame of the face lies in that of its carrier while both are flat.
    lay: Pose,
}

/// A face of a forest.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaf {
    /// Its piece, by its place in the net.
    pub piece: usize,
    /// Its place in the piece.
    pub face: usize,
    /// What it hangs on; none for a root.
    pub hinge: Option<Hinge>,
    /// Its root, by its place in the forest.
    pub root: usize,
    /// Number of hinges up to its root.
    pub depth: usize,
}

/// All faces of a net, carriers before what they carry.
#[derive(Debug, Clone)]
pub struct FoldTree<'a> {
    net: &'a Net,
    leaves: Vec<Leaf>,
    /// Number of a face in the mesh → its place in the forest.
    places: HashMap<usize, usize>,
}

/// One way over an edge.
struct Link {
    to: usize,
    line: Segment,
    angle: f64,
    edge: EdgeLabel,
    kind: HingeKind,
    lay: Pose,
}

impl<'a> FoldTree<'a> {
    /// The forest of all folds and of the seams in `joined`, by their places in the net. A tree for
    /// every part that is connected by them; its root is in the middle, so that the way to the
    /// farthest face is short. Where folds form rings, one fold of each ring carries nothing. What
    /// names a face that the net does not hold is left out.
    pub fn new(net: &'a Net, joined: &[usize]) -> Self {
        let flat: Vec<(usize, usize)> = net
            .pieces
            .iter()
            .enumerate()
            .flat_map(|(i, p)| (0..p.faces.len()).map(move |f| (i, f)))
            .collect();
        let numbers: HashMap<usize, usize> =
            flat.iter().enumerate().map(|(k, &(i, f))| (net.pieces[i].faces[f].face, k)).collect();
        let links = links(net, joined, &numbers, flat.len());
        let mut tree = Self { net, leaves: Vec::with_capacity(flat.len()), places: HashMap::new() };
        let mut seen = vec![false; flat.len()];
        for start in 0..flat.len() {
            if !seen[start] {
                tree.grow(&flat, &links, middle(&links, start), &mut seen);
            }
        }
        tree
    }

    fn grow(
        &mut self,
        flat: &[(usize, usize)],
        links: &[Vec<Link>],
        root: usize,
        seen: &mut [bool],
    ) {
        let first = self.leaves.len();
        let mut queue = VecDeque::from([(root, None::<Hinge>)]);
        seen[root] = true;
        while let Some((k, hinge)) = queue.pop_front() {
            let (piece, face) = flat[k];
            let place = self.leaves.len();
            let depth = hinge.as_ref().map_or(0, |h| self.leaves[h.parent].depth + 1);
            self.places.insert(self.net.pieces[piece].faces[face].face, place);
            self.leaves.push(Leaf { piece, face, hinge, root: first, depth });
            for link in &links[k] {
                if !std::mem::replace(&mut seen[link.to], true) {
                    let Link { line, angle, edge, kind, lay, .. } = *link;
                    queue.push_back((
                        link.to,
                        Some(Hinge { parent: place, line, angle, edge, kind, lay }),
                    ));
                }
            }
        }
    }

    /// The net.
    pub fn net(&self) -> &'a Net {
        self.net
    }

    /// All faces, carriers first.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    /// The flat face of a leaf.
    pub fn flat(&self, leaf: &Leaf) -> &'a FlatFace {
        &self.net.pieces[leaf.piece].faces[leaf.face]
    }

    /// Where the face with this number of the mesh stands in the forest.
    pub fn place_of(&self, face: usize) -> Option<usize> {
        self.places.get(&face).copied()
    }

    /// The leaves on the way between two of one tree whose hinges lie between them, in no order;
    /// `None` between two trees.
    pub fn way(&self, a: usize, b: usize) -> Option<Vec<usize>> {
        let (mut a, mut b) = (a, b);
        let mut way = Vec::new();
        while a != b {
            let deeper = if self.leaves[a].depth >= self.leaves[b].depth { &mut a } else { &mut b };
            way.push(*deeper);
            *deeper = self.leaves[*deeper].hinge.as_ref()?.parent;
        }
        Some(way)
    }

    /// Where every face lies, given where the roots lie and how far each hinge has turned: 0 for
    /// flat, 1 for closed.
    pub fn poses(
        &self,
        root: impl Fn(&Leaf) -> Pose,
        share: impl Fn(usize, &Hinge) -> f64,
    ) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.leaves.len());
        for (i, leaf) in self.leaves.iter().enumerate() {
            let pose = match &leaf.hinge {
                None => root(leaf),
                Some(hinge) => poses[hinge.parent].compose(&hinge.turned(share(i, hinge))),
            };
            poses.push(pose);
        }
        poses
    }
}

impl Hinge {
    /// Where the frame of the face lies in that of its carrier when a share of the whole angle is
    /// turned.
    pub fn turned(&self, share: f64) -> Pose {
        let [a, b] = self.line.map(|p| p.extend(0.0));
        let axis = (b - a).normalize_or(glam::DVec3::X);
        let turn = DQuat::from_axis_angle(axis, self.angle * share);
        Pose { rotation: turn, translation: a - turn * a }.compose(&self.lay)
    }
}

fn links(
    net: &Net,
    joined: &[usize],
    numbers: &HashMap<usize, usize>,
    count: usize,
) -> Vec<Vec<Link>> {
    let mut links: Vec<Vec<Link>> = (0..count).map(|_| Vec::new()).collect();
    let flat: HashMap<usize, &FlatFace> =
        net.pieces.iter().flat_map(|p| &p.faces).map(|f| (f.face, f)).collect();
    let side = |face: usize, edge, segment| flat.get(&face).and_then(|f| f.side(edge, segment));
    let mut add = |faces: [usize; 2],
                   lines: [Option<Segment>; 2],
                   (edge, degrees, kind): (EdgeLabel, f64, HingeKind)| {
        let [Some(&a), Some(&b)] = faces.map(|f| numbers.get(&f)) else { return };
        let [Some(own), Some(other)] = lines else { return };
        let angle = degrees.to_radians();
        links[a].push(Link { to: b, line: own, angle, edge, kind, lay: laid(own, other, kind) });
        links[b].push(Link { to: a, line: other, angle, edge, kind, lay: laid(other, own, kind) });
    };
    for fold in &net.folds {
        let lines = fold.faces.map(|f| side(f, fold.edge, fold.segment));
        add(fold.faces, lines, (fold.id, fold.fold_angle, HingeKind::Fold));
    }
    for seam in joined.iter().filter_map(|&s| net.seams.get(s)) {
        let lines = [0, 1].map(|k| side(seam.sides[k].face, seam.edge, seam.sides[k].segment));
        add([0, 1].map(|k| seam.sides[k].face), lines, (seam.id, seam.fold_angle, HingeKind::Seam));
    }
    links
}

/// The flat movement that lays the line `other` backwards onto `own`; none at a fold, whose lines
/// are one.
fn laid(own: Segment, other: Segment, kind: HingeKind) -> Pose {
    if kind == HingeKind::Fold {
        return Pose::IDENTITY;
    }
    let (to, from) = (own[0] - own[1], other[1] - other[0]);
    let rotation = DQuat::from_rotation_z(from.angle_to(to));
    let shift: DVec2 = own[0].midpoint(own[1]);
    Pose {
        rotation,
        translation: shift.extend(0.0) - rotation * other[0].midpoint(other[1]).extend(0.0),
    }
}

/// The face in the middle of a longest way through the part that holds `start`.
fn middle(links: &[Vec<Link>], start: usize) -> usize {
    let farthest = |from: usize| {
        let mut before: HashMap<usize, usize> = HashMap::from([(from, from)]);
        let mut queue = VecDeque::from([from]);
        let mut last = from;
        while let Some(k) = queue.pop_front() {
            last = k;
            for link in &links[k] {
                before.entry(link.to).or_insert_with(|| {
                    queue.push_back(link.to);
                    k
                });
            }
        }
        (last, before)
    };
    let (end, _) = farthest(start);
    let (mut other, before) = farthest(end);
    let mut way = vec![other];
    while other != end {
        other = before[&other];
        way.push(other);
    }
    way[way.len() / 2]
}
