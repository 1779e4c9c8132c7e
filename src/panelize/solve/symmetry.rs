//! Corners that are images of each other: one place is solved for, and all of them follow.

use glam::{DMat3, DVec3};

use super::super::surface::NONE;

/// Which corners are images of one place. All images are about axes through the origin.
#[derive(Debug, Clone)]
pub(in super::super) struct Symmetry {
    /// For each corner the first that is an image of the same place.
    pub first: Vec<usize>,
    /// For each corner what takes the first one to it. For the first it leaves out ways that are not
    /// open to it: across a mirror plane in which it stays.
    pub image: Vec<DMat3>,
    /// Whether each face is the first of its kind: terms of others would say the same again.
    pub is_first_face: Vec<bool>,
}

impl Symmetry {
    /// For each corner the face that carries its own terms; [`NONE`] when another corner's does.
    pub(super) fn owners(&self, faces: &[Vec<usize>]) -> Vec<usize> {
        let mut owners = vec![NONE; self.first.len()];
        let mut has_owner = vec![false; self.first.len()];
        for (f, face) in faces.iter().enumerate().filter(|&(f, _)| self.is_first_face[f]) {
            for &v in face {
                if !std::mem::replace(&mut has_owner[self.first[v]], true) {
                    owners[v] = f;
                }
            }
        }
        owners
    }

    /// Puts all corners where the first ones say.
    pub(in super::super) fn spread(&self, points: &mut [DVec3]) {
        let firsts = points.to_vec();
        for (v, point) in points.iter_mut().enumerate() {
            *point = self.image[v] * firsts[self.first[v]];
        }
    }
}
