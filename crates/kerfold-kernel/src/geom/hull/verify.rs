//! Whether a polytope is the intersection of its half-spaces, found from its coordinates alone.
//!
//! Nothing here takes part in making a polytope: heights over planes are worked out from the given
//! numbers with compensated sums ([`HalfSpace::slack`]). Every vertex must lie on the planes of its
//! faces and inside those of all half-spaces, and around every vertex the surface must be convex.
//! For half-spaces with a face the ends of the edges at each of its corners are looked at: a closed
//! surface that is convex around every vertex is convex. For those without one the farthest vertex
//! is sought uphill along the edges.

use glam::DVec3;

use super::half_space::HalfSpace;
use super::parallel::pick;
use super::polytope::Polytope;

/// So many rounding bounds a vertex may be off: one for its own place, up to two for what lies
/// nearer together than one and was joined, one for the plane.
const BOUNDS: f64 = 4.0;

/// A vertex that is not where it should be: a fault of the kernel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misplaced {
    /// Which vertex.
    pub vertex: usize,
    /// Where it lies.
    pub position: DVec3,
    /// The half-space, by its number in the input.
    pub half_space: usize,
    /// How far outside its plane the vertex lies, below zero for inside, in the unit of the
    /// coordinates; not a number when the position is none.
    pub distance: f64,
}

impl Polytope {
    /// Compares every vertex with all half-spaces, `half_spaces` being those that the polytope was
    /// made of: those of its faces must pass through it, and it may lie outside none, both up to
    /// four times [`Self::rounding`] or, where that is more, `resolution`.
    ///
    /// Takes time in proportion to the size, and uses none of the code that made the polytope.
    ///
    /// # Errors
    /// The first vertex that does not lie where it should.
    pub fn verify(&self, half_spaces: &[HalfSpace], resolution: f64) -> Result<(), Misplaced> {
        let bound = BOUNDS * self.rounding().max(resolution);
        let stars = Stars::of(self);
        let vertices: Vec<u32> = (0..self.vertices.len() as u32).collect();
        let wrong = pick(&vertices, |&v| self.fault_at(v, &stars, half_spaces, bound).is_some());
        let at_vertex = wrong.first().and_then(|&v| self.fault_at(v, &stars, half_spaces, bound));
        let fault = at_vertex.or_else(|| {
            let mut idle = (0..half_spaces.len() as u32)
                .filter(|i| self.half_spaces.binary_search(i).is_err());
            let mut last = 0;
            idle.find_map(|i| {
                last = stars.farthest(self, half_spaces[i as usize].normal, last);
                self.fault(last, i, half_spaces, |outside| outside <= bound)
            })
        });
        fault.map_or(Ok(()), Err)
    }

    /// Those of the half-spaces `numbers` that the polytope reaches beyond by more than rounding.
    pub(super) fn beyond(
        &self,
        half_spaces: &[HalfSpace],
        numbers: &[u32],
        resolution: f64,
    ) -> Vec<u32> {
        let bound = BOUNDS * self.rounding().max(resolution);
        let stars = Stars::of(self);
        let mut last = 0;
        let mut is_beyond = |&i: &u32| {
            last = stars.farthest(self, half_spaces[i as usize].normal, last);
            self.fault(last, i, half_spaces, |outside| outside <= bound).is_some()
        };
        numbers.iter().copied().filter(|i| is_beyond(i)).collect()
    }

    /// What is wrong at a vertex: off the plane of a face there, or an edge that leaves it upwards.
    fn fault_at(
        &self,
        v: u32,
        stars: &Stars,
        half_spaces: &[HalfSpace],
        bound: f64,
    ) -> Option<Misplaced> {
        stars.corners(v).iter().find_map(|corner| {
            let i = self.half_spaces[corner.face as usize];
            let off = self.fault(v, i, half_spaces, |outside| outside.abs() <= bound);
            off.or_else(|| {
                stars.corners(v).iter().find_map(|other| {
                    self.fault(other.next, i, half_spaces, |outside| outside <= bound)
                })
            })
        })
    }

    /// The vertex as a fault unless `is_right` holds for how far outside the half-space it lies.
    fn fault(
        &self,
        v: u32,
        i: u32,
        half_spaces: &[HalfSpace],
        is_right: impl Fn(f64) -> bool,
    ) -> Option<Misplaced> {
        let (position, h) = (self.vertices[v as usize], &half_spaces[i as usize]);
        let distance = -h.slack(position) / h.normal.length();
        let fault = Misplaced { vertex: v as usize, position, half_space: i as usize, distance };
        (!is_right(distance)).then_some(fault)
    }
}

/// A corner of a face.
#[derive(Debug, Clone, Copy, Default)]
struct Corner {
    face: u32,
    /// The vertex after it in the face.
    next: u32,
}

/// The corners at each vertex.
struct Stars {
    corners: Vec<Corner>,
    /// Where the corners of each vertex end.
    ends: Vec<u32>,
}

impl Stars {
    fn of(polytope: &Polytope) -> Self {
        let mut ends = vec![0_u32; polytope.vertices.len()];
        polytope.faces.corners().iter().for_each(|&v| ends[v as usize] += 1);
        let mut begin = 0;
        for end in &mut ends {
            begin += std::mem::replace(end, begin);
        }
        let mut corners = vec![Corner::default(); polytope.faces.corners().len()];
        for (face, run) in (0..).zip(polytope.faces.iter()) {
            for (&v, &next) in run.iter().zip(run.iter().cycle().skip(1)) {
                corners[ends[v as usize] as usize] = Corner { face, next };
                ends[v as usize] += 1;
            }
        }
        Self { corners, ends }
    }

    fn corners(&self, v: u32) -> &[Corner] {
        let begin = v.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        &self.corners[begin as usize..self.ends[v as usize] as usize]
    }

    /// The vertex farthest along a direction, uphill from `start`.
    fn farthest(&self, polytope: &Polytope, direction: DVec3, start: u32) -> u32 {
        let height = |v: u32| direction.dot(polytope.vertices[v as usize]);
        let (mut top, mut most) = (start, height(start));
        loop {
            let higher = self.corners(top).iter().map(|corner| corner.next);
            let best = higher.max_by(|&u, &v| height(u).total_cmp(&height(v)));
            match best.filter(|&v| height(v) > most) {
                Some(next) => (top, most) = (next, height(next)),
                None => return top,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Random, tangent};
    use super::super::{Intersect, intersect};
    use super::*;

    fn ball() -> (Vec<HalfSpace>, Polytope) {
        let mut random = Random(3);
        let mut planes = tangent((0..200).map(|_| random.on_sphere()));
        // One far outside, which has no face.
        planes.push(HalfSpace { normal: DVec3::X, offset: 3.0 });
        let polytope = intersect(&planes, &Intersect::default()).expect("a ball");
        (planes, polytope)
    }

    #[test]
    fn a_vertex_that_is_moved_is_found() {
        let (planes, polytope) = ball();
        assert_eq!(polytope.verify(&planes, 0.0), Ok(()));
        for v in 0..polytope.vertices.len() {
            let mut wrong = polytope.clone();
            wrong.vertices[v] *= 1.0 + 1e-10;
            assert!(wrong.verify(&planes, 0.0).is_err(), "vertex {v} outwards");
            wrong.vertices[v] = polytope.vertices[v] * (1.0 - 1e-10);
            assert!(wrong.verify(&planes, 0.0).is_err(), "vertex {v} inwards");
            wrong.vertices[v].y = f64::NAN;
            assert!(wrong.verify(&planes, 0.0).is_err(), "vertex {v} is no number");
        }
    }

    #[test]
    fn a_half_space_without_a_face_is_looked_at() {
        let (mut planes, polytope) = ball();
        planes[200].offset = 0.9;
        let fault = polytope.verify(&planes, 0.0).expect_err("it cuts the ball");
        assert!(fault.half_space == 200 && fault.distance > 0.09, "{fault:?}");
        assert_eq!(polytope.beyond(&planes, &[3, 200], 0.0), [200]);
    }
}
