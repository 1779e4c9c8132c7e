//! From flat to closed in time.

use std::collections::HashMap;

use glam::{DQuat, DVec2, DVec3};

use super::{FoldTree, Leaf, Pose};
use crate::geom::polygon::centroid;
use crate::net::{Net, PieceId};

/// When the folds begin and end to turn, in seconds.
pub const FOLDING: [f64; 2] = [0.5, 4.0];
/// When the pieces, folded, begin and end to move to their places.
pub const MOVING: [f64; 2] = [4.0, 6.0];
/// When the animation ends: a second to look at the closed model.
pub const END: f64 = 7.0;

/// Where a piece lies before anything is folded: a point p of the piece at R(`rotation`) · p +
/// `shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPlace {
    /// The piece.
    pub piece: PieceId,
    /// In radians, counter-clockwise.
    pub rotation: f64,
    /// In mm.
    pub shift: DVec2,
}

/// A net on its way from flat to closed.
///
/// First all folds turn at once, each evenly; then the folded pieces move to their places. Pieces
/// are bodies without thickness, which may pass through one another on the way.
#[derive(Debug, Clone)]
pub struct Bloom<'a> {
    tree: FoldTree<'a>,
    /// Leaf → where it lies when all is flat.
    flat: Vec<Pose>,
    /// Leaf → where it lies when all is closed.
    closed: Vec<Pose>,
}

impl<'a> Bloom<'a> {
    /// The way of a net. Pieces begin where `places` says, with their outsides up; those that it
    /// leaves out are put in a row beside the others. They end where `corners` says that the
    /// corners of their faces are, by the face's number; when it does not know, parts that hang
    /// together by seams close around one of their faces where it lies.
    pub fn new(
        net: &'a Net,
        places: &[FlatPlace],
        corners: impl Fn(usize) -> Option<Vec<DVec3>>,
    ) -> Self {
        let tree = FoldTree::new(net, &[]);
        let flat = flat_poses(net, places);
        let by_seams = closed_by_seams(net, &flat);
        let end = |root: &Leaf| {
            let face = tree.flat(root);
            let known = corners(face.face).and_then(|points| Pose::fit(&face.polygon, &points));
            known.or_else(|| by_seams.get(&face.face).copied()).unwrap_or(flat[root.piece])
        };
        let closed = tree.poses(end, |_, _| 1.0);
        let shift = under(net, &tree, &closed, &flat);
        let flat = tree.leaves().iter().map(|l| shift.compose(&flat[l.piece])).collect();
        Self { tree, flat, closed }
    }

    /// The faces and their hinges.
    pub fn tree(&self) -> &FoldTree<'a> {
        &self.tree
    }

    /// Leaf → its pose before anything is folded.
    pub fn flat(&self) -> &[Pose] {
        &self.flat
    }

    /// Leaf → its pose when all is closed.
    pub fn closed(&self) -> &[Pose] {
        &self.closed
    }

    /// Leaf → its pose after so many seconds.
    pub fn at(&self, seconds: f64) -> Vec<Pose> {
        let share = |[from, to]: [f64; 2]| ((seconds - from) / (to - from)).clamp(0.0, 1.0);
        let (folded, moved) = (share(FOLDING), share(MOVING));
        let root = |leaf: &Leaf| {
            let middle = centroid(&self.tree.flat(leaf).polygon).extend(0.0);
            Pose::interpolate(&self.flat[leaf.root], &self.closed[leaf.root], middle, moved)
        };
        self.tree.poses(root, |_, _| folded)
    }
}

/// Piece → how it lies flat.
fn flat_poses(net: &Net, places: &[FlatPlace]) -> Vec<Pose> {
    let given: Vec<Option<Pose>> = net
        .pieces
        .iter()
        .map(|piece| {
            let place = places.iter().find(|p| p.piece == piece.id)?;
            Some(Pose {
                rotation: DQuat::from_rotation_z(place.rotation),
                translation: place.shift.extend(0.0),
            })
        })
        .collect();
    let laid = |i: usize, pose: &Pose| {
        net.pieces[i].outline.iter().map(|&p| pose.lift(p)).collect::<Vec<_>>()
    };
    let known = given.iter().enumerate().filter_map(|(i, pose)| Some(laid(i, pose.as_ref()?)));
    let mut right = known.flatten().map(|p| p.x).fold(0.0, f64::max);
    let mut poses = Vec::with_capacity(given.len());
    for (i, pose) in given.into_iter().enumerate() {
        let row = || {
            let points = laid(i, &Pose::IDENTITY);
            let low = points.iter().copied().reduce(DVec3::min).unwrap_or_default();
            let width = points.iter().map(|p| p.x).fold(low.x, f64::max) - low.x;
            let pose = Pose {
                translation: DVec3::new(right + 0.1 * width, 0.0, 0.0) - low,
                ..Pose::IDENTITY
            };
            right += 1.2 * width;
            pose
        };
        poses.push(pose.unwrap_or_else(row));
    }
    poses
}

/// Number of a face → where it lies when its part is closed around the face that carries all
/// others, which stays.
fn closed_by_seams(net: &Net, flat: &[Pose]) -> HashMap<usize, Pose> {
    let all: Vec<usize> = (0..net.seams.len()).collect();
    let whole = FoldTree::new(net, &all);
    let poses = whole.poses(|root| flat[root.piece], |_, _| 1.0);
    whole.leaves().iter().zip(poses).map(|(leaf, pose)| (whole.flat(leaf).face, pose)).collect()
}

/// The shift that brings the flat pieces around the closed model, level with its highest point:
/// what is folded bends down.
fn under(net: &Net, tree: &FoldTree<'_>, closed: &[Pose], flat: &[Pose]) -> Pose {
    let bounds = |points: &mut dyn Iterator<Item = DVec3>| {
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        })
    };
    let corners = |(leaf, pose): (&Leaf, &Pose)| {
        let (pose, face) = (*pose, tree.flat(leaf));
        face.polygon.iter().map(move |&p| pose.lift(p))
    };
    let (low, high) = bounds(&mut tree.leaves().iter().zip(closed).flat_map(corners));
    let (flat_low, flat_high) = bounds(
        &mut net
            .pieces
            .iter()
            .zip(flat)
            .flat_map(|(p, pose)| p.outline.iter().map(|&q| pose.lift(q))),
    );
    let shift = low.midpoint(high).truncate() - flat_low.midpoint(flat_high).truncate();
    let shift = shift.extend(high.z);
    Pose { translation: if shift.is_finite() { shift } else { DVec3::ZERO }, ..Pose::IDENTITY }
}
