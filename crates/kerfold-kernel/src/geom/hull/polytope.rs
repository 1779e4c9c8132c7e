//! What the kernel hands out: polygons as runs of corner numbers, and a polytope of such faces.

use glam::DVec3;

use crate::geom::RoundingBound;

/// Closed runs of corners, one behind the other in a single vector.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Polygons {
    corners: Vec<u32>,
    ends: Vec<u32>,
}

impl Polygons {
    /// None, with room for this many.
    pub(super) fn with_capacity(polygons: usize, corners: usize) -> Self {
        Self { corners: Vec::with_capacity(corners), ends: Vec::with_capacity(polygons) }
    }

    /// Runs of corners that end where `ends` says.
    pub(super) fn from_runs(corners: Vec<u32>, ends: Vec<u32>) -> Self {
        Self { corners, ends }
    }

    pub(super) fn push(&mut self, polygon: impl IntoIterator<Item = u32>) {
        self.corners.extend(polygon);
        self.ends.push(self.corners.len() as u32);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of polygon `i`, counter-clockwise seen from outside.
    ///
    /// # Panics
    /// When there is no such polygon.
    pub fn get(&self, i: usize) -> &[u32] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.corners[start as usize..self.ends[i] as usize]
    }

    /// All polygons in order.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }

    /// The corners of all polygons, one behind the other.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }
}

/// A bounded intersection of half-spaces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polytope {
    /// The vertices, numbered in no particular but always the same order.
    pub vertices: Vec<DVec3>,
    /// For each face the number of its half-space, ascending. Half-spaces that contribute no face
    /// are missing.
    pub half_spaces: Vec<u32>,
    /// The faces as runs of vertex numbers.
    pub faces: Polygons,
    /// A point inside.
    pub interior: DVec3,
}

impl Polytope {
    /// Number of edges: half the corners.
    pub fn edge_count(&self) -> usize {
        self.faces.corners().len() / 2
    }

    /// The shortest edge, in the unit of the coordinates; infinite without any.
    pub fn shortest_edge(&self) -> f64 {
        let at = |v: u32| self.vertices[v as usize];
        let sides = |run: &'_ [u32]| {
            let next = run.iter().cycle().skip(1);
            run.iter().zip(next).map(|(&u, &v)| at(u).distance(at(v))).fold(f64::INFINITY, f64::min)
        };
        self.faces.iter().map(sides).fold(f64::INFINITY, f64::min)
    }

    /// The rounding bound of the solid, in the unit of the coordinates.
    pub fn rounding(&self) -> f64 {
        let low = self.vertices.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.vertices.iter().copied().reduce(DVec3::max).unwrap_or_default();
        RoundingBound::of_box(low, high).length()
    }
}
