//! From triangles to faces: coplanar neighbours joined by exact signs, and which points are
//! corners.

use super::cloud::{Cloud, Signs};
use super::surface::{NONE, Surface};
use crate::geom::Side;

/// The faces of a hull: for each facet the number of the face that it belongs to.
pub(super) struct Faces {
    /// By slot; `NONE` for free slots. Empty when every slot is a face of its own.
    face_of: Vec<u32>,
    /// One facet of each face; empty likewise.
    first: Vec<u32>,
    count: usize,
    has_merged: bool,
}

impl Faces {
    /// Joins all neighbours that lie in one plane, by exact signs.
    pub(super) fn of<S: Signs>(surface: &Surface<'_>, cloud: &Cloud<S>) -> Self {
        let mut face_of = vec![NONE; surface.slots()];
        let mut first = Vec::with_capacity(surface.len());
        let mut has_merged = false;
        let mut stack = Vec::new();
        for seed in surface.live() {
            if face_of[seed as usize] != NONE {
                continue;
            }
            let face = first.len() as u32;
            first.push(seed);
            face_of[seed as usize] = face;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                let facet = surface.facet(f);
                for g in facet.across {
                    // A neighbour that has a face already was tested from its side.
                    if face_of[g as usize] == NONE && are_coplanar(surface, cloud, f, g) {
                        face_of[g as usize] = face;
                        has_merged = true;
                        stack.push(g);
                    }
                }
            }
        }
        Self { face_of, count: first.len(), first, has_merged }
    }

    /// Joins all neighbours whose corners lie within `bound` of one plane, that of the largest
    /// facet among them. Slivers without a plane of their own go to a neighbour.
    pub(super) fn within<S: Signs>(surface: &Surface<'_>, cloud: &Cloud<S>, bound: f64) -> Self {
        let normal = |f: u32| {
            let [a, b, c] = surface.facet(f).corners.map(|v| cloud.point(v));
            (b - a).cross(c - a)
        };
        let mut by_area: Vec<u32> = surface.live().collect();
        by_area.sort_by(|&f, &g| normal(g).length_squared().total_cmp(&normal(f).length_squared()));
        let (mut face_of, mut first, mut has_merged) =
            (vec![NONE; surface.slots()], Vec::new(), false);
        let mut stack = Vec::new();
        for seed in by_area {
            if face_of[seed as usize] != NONE {
                continue;
            }
            let (upwards, origin) =
                (normal(seed).normalize_or_zero(), cloud.point(surface.facet(seed).corners[0]));
            let is_near = |v: u32| (cloud.point(v) - origin).dot(upwards).abs() <= bound;
            face_of[seed as usize] = first.len() as u32;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                for g in surface.facet(f).across {
                    // A facet that looks the other way is the back of a solid thinner than the
                    // bound.
                    let fits = || {
                        normal(g).dot(upwards) >= -bound
                            && surface.facet(g).corners.into_iter().all(is_near)
                    };
                    if face_of[g as usize] == NONE && fits() {
                        face_of[g as usize] = first.len() as u32;
                        has_merged = true;
                        stack.push(g);
                    }
                }
            }
            first.push(seed);
        }
        Self { face_of, count: first.len(), first, has_merged }
    }

    /// Every facet a face of its own; there are no free slots.
    pub(super) fn unmerged(surface: &Surface<'_>) -> Self {
        Self { face_of: Vec::new(), first: Vec::new(), count: surface.len(), has_merged: false }
    }

    /// How many faces there are.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// One facet of a face.
    pub(super) fn first(&self, face: u32) -> u32 {
        if self.first.is_empty() { face } else { self.first[face as usize] }
    }

    /// Whether any facets were joined.
    pub(super) fn has_merged(&self) -> bool {
        self.has_merged
    }

    /// The face of a facet.
    pub(super) fn of_facet(&self, f: u32) -> u32 {
        if self.face_of.is_empty() { f } else { self.face_of[f as usize] }
    }

    /// The faces around a point, counter-clockwise from facet `first`, each once. A point is a
    /// corner of the hull when there are three or more: one face has it inside, two have it on
    /// their common edge.
    pub(super) fn around(&self, surface: &Surface<'_>, v: u32, first: u32, faces: &mut Vec<u32>) {
        faces.clear();
        for f in surface.fan_of(v, first) {
            let face = self.of_facet(f);
            if faces.last() != Some(&face) {
                faces.push(face);
            }
        }
        if faces.len() > 1 && faces.first() == faces.last() {
            faces.pop();
        }
    }

    /// The points along the rim of a face, counter-clockwise, those on straight stretches included.
    pub(super) fn rim(&self, surface: &Surface<'_>, face: u32, rim: &mut Vec<u32>) {
        rim.clear();
        let Some((mut f, mut side)) = self.rim_side(surface, face) else { return };
        let start = (f, side);
        loop {
            rim.push(surface.facet(f).corners[side]);
            side = (side + 1) % 3;
            // Turn around the end of the side to the next side that the face ends at.
            loop {
                let g = surface.facet(f).across[side];
                if self.of_facet(g) != face {
                    break;
                }
                side = (surface.side_to(g, f) + 1) % 3;
                f = g;
            }
            if (f, side) == start {
                return;
            }
        }
    }

    fn rim_side(&self, surface: &Surface<'_>, face: u32) -> Option<(u32, usize)> {
        let is_end =
            |f: u32| surface.facet(f).across.iter().position(|&g| self.of_facet(g) != face);
        let first = self.first(face);
        if let Some(side) = is_end(first) {
            return Some((first, side));
        }
        let mut stack = vec![first];
        let mut met = std::collections::HashSet::new();
        while let Some(f) = stack.pop() {
            if let Some(side) = is_end(f) {
                return Some((f, side));
            }
            if met.insert(f) {
                stack.extend(surface.facet(f).across);
            }
        }
        None
    }
}

fn are_coplanar<S: Signs>(surface: &Surface<'_>, cloud: &Cloud<S>, f: u32, g: u32) -> bool {
    let beyond = surface.facet(g);
    let opposite = beyond.corners[(surface.side_to(g, f) + 2) % 3];
    cloud.height(surface.facet(f).corners, opposite) == Side::On
}

/// For each point a facet that has it for a corner; `NONE` for points that are no corner of any.
pub(super) fn fan_starts(surface: &Surface<'_>, points: usize) -> Vec<u32> {
    let mut start = vec![NONE; points];
    for f in surface.live() {
        for v in surface.facet(f).corners {
            start[v as usize] = f;
        }
    }
    start
}
