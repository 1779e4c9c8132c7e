//! Convex bodies that can be cut by planes: how much two of them share is measured without any
//! tolerance.
//!
//! A body is a closed surface of corners and faces that refer to them by number. A cut keeps it
//! closed whatever the signs of rounded distances are: every edge that it crosses gets one new
//! corner, which is where one face is left and its neighbour is entered, so the new corners form
//! rings by their links alone. A wrong sign moves a corner by rounding and the volume with it,
//! never by more.

use glam::DVec3;

/// A half-space: points with `normal · p` up to `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HalfSpace {
    pub normal: DVec3,
    pub offset: f64,
}

impl HalfSpace {
    /// How far a point lies outside.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// A convex body.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Cell {
    points: Vec<DVec3>,
    /// Counter-clockwise from outside.
    faces: Vec<Vec<u32>>,
}

impl Cell {
    /// The body between two polygons with as many corners each, that in front counter-clockwise
    /// from outside.
    pub fn between(front: &[DVec3], back: &[DVec3]) -> Self {
        let n = front.len() as u32;
        let wall = |i: u32| vec![n + i, n + (i + 1) % n, (i + 1) % n, i];
        let caps = [(0..n).collect(), (n..2 * n).rev().collect()];
        Self {
            points: [front, back].concat(),
            faces: caps.into_iter().chain((0..n).map(wall)).collect(),
        }
    }

    /// A tetrahedron and whether its corners run as those of a positive one; turned if they do not.
    pub fn tetrahedron(corners: [DVec3; 4]) -> (Self, bool) {
        let [a, b, c, d] = corners;
        let is_positive = (b - a).cross(c - a).dot(d - a) > 0.0;
        let points = if is_positive { vec![a, b, c, d] } else { vec![b, a, c, d] };
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|f| f.to_vec()).to_vec();
        (Self { points, faces }, is_positive)
    }

    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The half-spaces of its faces; those without area have none.
    pub fn half_spaces(&self) -> Vec<HalfSpace> {
        let of = |face: &Vec<u32>| {
            let normal = self.doubled_area(face).try_normalize()?;
            let corners = face.iter().map(|&i| self.points[i as usize]);
            let offset = corners.map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
            Some(HalfSpace { normal, offset })
        };
        self.faces.iter().filter_map(of).collect()
    }

    fn doubled_area(&self, face: &[u32]) -> DVec3 {
        let p = |i: usize| self.points[face[i] as usize];
        (2..face.len()).map(|i| (p(i - 1) - p(0)).cross(p(i) - p(0))).sum()
    }

    /// What it encloses, in cubes of the unit of its corners.
    pub fn volume(&self) -> f64 {
        let Some(&about) = self.points.first() else { return 0.0 };
        let cone = |face: &Vec<u32>| {
            let p = |i: usize| self.points[face[i] as usize] - about;
            (2..face.len()).map(|i| p(0).dot(p(i - 1).cross(p(i)))).sum::<f64>()
        };
        self.faces.iter().map(cone).sum::<f64>() / 6.0
    }

    /// Keeps what lies inside of all of some half-spaces; `None` when nothing does.
    pub fn within(&self, half_spaces: &[HalfSpace]) -> Option<Self> {
        let mut left = self.clone();
        for half_space in half_spaces {
            if !left.keep(half_space) {
                return None;
            }
        }
        Some(left)
    }

    /// Cuts off what lies outside of a half-space; whether anything is left.
    fn keep(&mut self, half_space: &HalfSpace) -> bool {
        let distances: Vec<f64> = self.points.iter().map(|&p| half_space.distance(p)).collect();
        if distances.iter().all(|&d| d <= 0.0) {
            return true;
        }
        if distances.iter().all(|&d| d >= 0.0) {
            return false;
        }
        let mut cut = Cut::new(&self.points, &distances);
        self.faces = self.faces.iter().map(|face| cut.face(face)).collect();
        self.faces.retain(|face| face.len() > 2);
        self.faces.extend(cut.caps());
        self.points = cut.made;
        true
    }
}

/// One cut through a body.
struct Cut<'a> {
    points: &'a [DVec3],
    distances: &'a [f64],
    /// The corners of the new body.
    made: Vec<DVec3>,
    /// For each old corner its new number.
    kept: Vec<Option<u32>>,
    /// The crossed edges (lower corner first) with their new corners.
    crossed: Vec<([u32; 2], u32)>,
    /// For each new corner at which a face is entered, that at which the same face is left.
    links: Vec<(u32, u32)>,
}

impl<'a> Cut<'a> {
    fn new(points: &'a [DVec3], distances: &'a [f64]) -> Self {
        let mut made = Vec::with_capacity(points.len() + 4);
        let mut keep = |i: usize| {
            (distances[i] <= 0.0).then(|| {
                made.push(points[i]);
                made.len() as u32 - 1
            })
        };
        let kept = (0..points.len()).map(&mut keep).collect();
        Self { points, distances, made, kept, crossed: Vec::new(), links: Vec::new() }
    }

    /// What is left of a face.
    fn face(&mut self, face: &[u32]) -> Vec<u32> {
        let mut left = Vec::with_capacity(face.len() + 1);
        let (mut entries, mut exits) = (Vec::new(), Vec::new());
        for (k, &i) in face.iter().enumerate() {
            let j = face[(k + 1) % face.len()];
            left.extend(self.kept[i as usize]);
            let is_kept = [i, j].map(|c| self.kept[c as usize].is_some());
            if is_kept[0] != is_kept[1] {
                let corner = self.crossing(i, j);
                left.push(corner);
                if is_kept[0] { &mut exits } else { &mut entries }.push(corner);
            }
        }
        // Exits and entries alternate; what begins inside is left before it is entered again.
        let begins_inside = face.first().is_some_and(|&i| self.kept[i as usize].is_some());
        if !begins_inside && !entries.is_empty() {
            entries.rotate_left(1);
        }
        self.links.extend(entries.into_iter().zip(exits));
        left
    }

    /// The new corner of an edge that the cut crosses.
    fn crossing(&mut self, i: u32, j: u32) -> u32 {
        let edge = [i.min(j), i.max(j)];
        if let Some(&(_, corner)) = self.crossed.iter().find(|(known, _)| *known == edge) {
            return corner;
        }
        let [(p, d), (q, e)] = edge.map(|c| (self.points[c as usize], self.distances[c as usize]));
        self.made.push(p + (q - p) * (d / (d - e)));
        let corner = self.made.len() as u32 - 1;
        self.crossed.push((edge, corner));
        corner
    }

    /// The faces that close the body again.
    fn caps(&self) -> Vec<Vec<u32>> {
        let next = |corner: u32| self.links.iter().find(|l| l.0 == corner).map(|l| l.1);
        let mut is_done = vec![false; self.made.len()];
        let mut caps = Vec::new();
        for &(start, _) in &self.links {
            let mut cap = Vec::new();
            let mut at = Some(start);
            while let Some(corner) = at.filter(|&c| !is_done[c as usize]) {
                is_done[corner as usize] = true;
                cap.push(corner);
                at = next(corner);
            }
            if cap.len() > 2 {
                caps.push(cap);
            }
        }
        caps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: f64, high: f64) -> Cell {
        let ring = |z: f64| {
            [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| DVec3::new(x, y, z))
        };
        Cell::between(&ring(high), &ring(low))
    }

    fn half_space(normal: DVec3, offset: f64) -> HalfSpace {
        let length = normal.length();
        HalfSpace { normal: normal / length, offset: offset / length }
    }

    #[test]
    fn cuts_keep_the_volume_that_they_should() {
        let unit = cube(0.0, 1.0);
        assert_eq!((unit.volume(), unit.half_spaces().len()), (1.0, 6));
        for (normal, offset, volume) in [
            (DVec3::X, 0.25, 0.25),
            (DVec3::ONE, 1.0, 1.0 / 6.0),
            (DVec3::ONE, 1.5, 0.5),
            (DVec3::new(1.0, 1.0, 0.0), 1.0, 0.5),
            (DVec3::NEG_Z, 0.0, 1.0),
        ] {
            let left = unit.within(&[half_space(normal, offset)]).expect("something is left");
            assert!((left.volume() - volume).abs() < 1e-15, "{normal} {}", left.volume());
        }
        assert_eq!(unit.within(&[half_space(DVec3::NEG_X, -1.0)]), None);
    }

    #[test]
    fn cuts_through_corners_and_along_faces_stay_closed() {
        let unit = cube(0.0, 1.0);
        for ulp in [-1e-16, 0.0, 1e-16] {
            for normal in [DVec3::X, DVec3::new(1.0, -1.0, ulp), DVec3::new(1.0, 1.0, 1.0 + ulp)] {
                for offset in [0.0, 1.0, 2.0, 1.0 + ulp, ulp] {
                    let Some(left) = unit.within(&[half_space(normal, offset)]) else { continue };
                    let mut edges = std::collections::BTreeMap::new();
                    for face in &left.faces {
                        for (k, &i) in face.iter().enumerate() {
                            *edges.entry((i, face[(k + 1) % face.len()])).or_insert(0) += 1;
                        }
                    }
                    let is_closed =
                        edges.iter().all(|(&(a, b), &n)| n == 1 && edges.get(&(b, a)) == Some(&1));
                    assert!(is_closed, "{normal} {offset}");
                }
            }
        }
    }

    #[test]
    fn what_two_cubes_share_is_a_cube() {
        let shared = cube(0.0, 2.0).within(&cube(1.25, 3.0).half_spaces()).expect("they meet");
        assert!((shared.volume() - 0.75_f64.powi(3)).abs() < 1e-15);
        let touching = cube(0.0, 1.0).within(&cube(1.0, 2.0).half_spaces());
        assert!(touching.is_none_or(|cell| cell.volume().abs() < 1e-15));
    }

    #[test]
    fn a_tetrahedron_is_turned_to_be_positive() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let (cell, is_positive) = Cell::tetrahedron(corners);
        assert!(is_positive && (cell.volume() - 1.0 / 6.0).abs() < 1e-16);
        let (cell, is_positive) = Cell::tetrahedron([DVec3::X, DVec3::ZERO, DVec3::Y, DVec3::Z]);
        assert!(!is_positive && (cell.volume() - 1.0 / 6.0).abs() < 1e-16);
    }
}
