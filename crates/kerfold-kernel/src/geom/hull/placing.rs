//! Where the vertices of the solid lie: quickly where that is certain, else from the given numbers
//! to the last digit.
//!
//! Which planes meet is known by exact signs, so the true meeting point of the planes of a vertex
//! lies inside all half-spaces. What is left to see to is that the rounded one is near it. Its own
//! residuals bound how far it may be off ([`uncertainty`]). Where that is more than the rounding of
//! coordinates, the planes meet flat, and the vertex may be off along them, where it does no harm
//! unless another vertex is near: then it is solved anew from the given numbers. Planes that are
//! the same but for the last digits end in such vertices.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::cloud::{Cloud, PlaneSigns};
use super::half_space::HalfSpace;
use super::meeting::{SETTLED, exact_meeting, meeting_point, uncertainty, widest_triple};
use super::merge::Faces;
use super::parallel::{pick, update_and_pick};
use super::surface::Surface;

/// A vertex that may be off by no more than this share of its distance from the centre is right.
const CERTAIN: f64 = 1.0 / (1_u64 << 40) as f64;
/// A vertex that may be off is solved anew when that is more than this share of the way to the next
/// vertex.
const FAR_FROM_NEXT: f64 = 1.0 / 64.0;

/// A vertex that may be off, and by how much in the unit of the coordinates, rounded up.
#[derive(Debug, Clone, Copy)]
struct Doubtful {
    vertex: u32,
    most_off: f32,
}

/// From dual points to places.
pub(super) struct Placing<'a> {
    /// As given.
    pub half_spaces: &'a [HalfSpace],
    /// The numbers of the dual points' half-spaces.
    pub order: &'a [u32],
    /// The dual points.
    pub cloud: &'a Cloud<PlaneSigns<'a>>,
    /// The point inside from which they are seen.
    pub centre: DVec3,
    /// What they were stretched by.
    pub scale: DVec3,
    /// Whether no vertex is taken for right because its facet has a good pole.
    pub is_thorough: bool,
}

/// The vertices, placed for a first time, and what they are made of.
trait Vertices: Sync {
    fn position(&self, vertex: u32) -> DVec3;

    /// Dual points of the vertex, three by three: first those that lie far apart, last those of a
    /// facet, which certainly span a plane.
    fn triples(&self, vertex: u32) -> [[u32; 3]; 2];

    /// The vertices at the other ends of the edges; `None` when there are not just three.
    fn next(&self, vertex: u32) -> Option<[u32; 3]>;
}

impl Placing<'_> {
    /// Turns the poles of a surface without merged facets and free slots into the vertices of the
    /// solid. Unless asked to be thorough, takes a pole that is good enough to tell sides by
    /// (`pole`), which holds to 2⁻²⁸ of the distance to any plane.
    pub(super) fn place_poles(&self, surface: &mut Surface<'_>) {
        let doubtful = surface.update_poles(|facet, corners, pole| {
            let triple = corners.map(|v| self.cloud.point(v));
            let pole = DVec3::from_array(pole);
            // A pole that is no number lies on nothing.
            let lies_on = |q: DVec3| (1.0 - q.dot(pole)).abs() <= SETTLED;
            let is_settled = lies_on(triple[0]) & lies_on(triple[1]) & lies_on(triple[2]);
            if is_settled & !self.is_thorough {
                return (self.place(pole).to_array(), None);
            }
            let y = if is_settled { pole } else { meeting_point(triple) };
            (self.place(y).to_array(), self.doubt(facet, triple, y))
        });
        let exact = self.solved_anew(&Facets(surface), &doubtful);
        exact.into_iter().for_each(|(f, position)| surface.replace_pole(f, position.to_array()));
    }

    /// The meeting point of the planes of each face of the dual hull.
    pub(super) fn vertices(&self, surface: &Surface<'_>, faces: &Faces) -> Vec<DVec3> {
        let mut positions = vec![DVec3::ZERO; faces.len()];
        let net = Merged { placing: self, surface, faces, positions: &[] };
        let doubtful = update_and_pick(&mut positions, |face, _| {
            let triple = net.triples(face as u32)[0].map(|v| self.cloud.point(v));
            let y = meeting_point(triple);
            (self.place(y), self.doubt(face as u32, triple, y))
        });
        let exact = self.solved_anew(&Merged { positions: &positions, ..net }, &doubtful);
        exact.into_iter().for_each(|(face, position)| positions[face as usize] = position);
        positions
    }

    fn place(&self, y: DVec3) -> DVec3 {
        self.centre + y * self.scale
    }

    /// The doubt about a vertex that was solved from dual points, if there is any.
    #[inline(always)]
    fn doubt(&self, vertex: u32, triple: [DVec3; 3], y: DVec3) -> Option<Doubtful> {
        // The length of three coordinates is at most √3 times one.
        let off = uncertainty(triple, y, self.cloud.noise()) * self.scale.max_element();
        let most_off = 1.75 * off;
        // A bound that is no number holds nothing.
        let is_certain = most_off <= CERTAIN * (y * self.scale).length();
        (!is_certain).then_some(Doubtful { vertex, most_off: most_off as f32 })
    }

    /// The doubtful vertices that may do harm, with the places that their given numbers have.
    fn solved_anew(&self, vertices: &impl Vertices, doubtful: &[Doubtful]) -> HashMap<u32, DVec3> {
        let mut exact = HashMap::new();
        let mut tried = HashSet::new();
        let mut harmful = pick(doubtful, |d| self.may_harm(vertices, d, &exact));
        // A vertex that has moved may be nearer to others than it was: these are looked at again.
        while !harmful.is_empty() {
            let mut around = Vec::new();
            for d in harmful.drain(..).filter(|d| tried.insert(d.vertex)) {
                if let Some(position) = self.exact(vertices, d.vertex) {
                    exact.insert(d.vertex, position);
                    around.extend(vertices.next(d.vertex).into_iter().flatten());
                }
            }
            around.sort_unstable();
            around.dedup();
            let still_doubtful =
                around.into_iter().filter(|v| !tried.contains(v)).filter_map(|v| {
                    doubtful.binary_search_by_key(&v, |d| d.vertex).ok().map(|i| doubtful[i])
                });
            harmful = still_doubtful.filter(|d| self.may_harm(vertices, d, &exact)).collect();
        }
        exact
    }

    /// Whether a doubtful vertex may lie outside a half-space.
    ///
    /// Let it be off by e, nearly along its planes, and the next vertex be at a distance l. A plane
    /// that passes it within e has the next vertex behind it, so towards there it falls by no more
    /// than e/l, and the vertex is outside by at most e·e/l.
    fn may_harm(
        &self,
        vertices: &impl Vertices,
        doubtful: &Doubtful,
        exact: &HashMap<u32, DVec3>,
    ) -> bool {
        let Some(next) = vertices.next(doubtful.vertex) else { return true };
        let position = |v: u32| exact.get(&v).copied().unwrap_or_else(|| vertices.position(v));
        let own = vertices.position(doubtful.vertex);
        let nearest = next.map(|v| position(v).distance(own)).into_iter().fold(f64::MAX, f64::min);
        let off = f64::from(doubtful.most_off);
        let distance = own.distance(self.centre);
        let is_harmless =
            off <= FAR_FROM_NEXT * nearest && off * off <= CERTAIN * distance * nearest;
        !is_harmless
    }

    fn exact(&self, vertices: &impl Vertices, vertex: u32) -> Option<DVec3> {
        let plane = |v: u32| &self.half_spaces[self.order[v as usize] as usize];
        vertices.triples(vertex).into_iter().find_map(|triple| exact_meeting(triple.map(plane)))
    }
}

/// Each facet of a surface a vertex; its pole is the place.
struct Facets<'a>(&'a Surface<'a>);

impl Vertices for Facets<'_> {
    fn position(&self, facet: u32) -> DVec3 {
        DVec3::from_array(self.0.pole(facet))
    }

    fn triples(&self, facet: u32) -> [[u32; 3]; 2] {
        [self.0.facet(facet).corners; 2]
    }

    fn next(&self, facet: u32) -> Option<[u32; 3]> {
        Some(self.0.facet(facet).across)
    }
}

/// Each face of the dual hull a vertex.
#[derive(Clone, Copy)]
struct Merged<'a> {
    placing: &'a Placing<'a>,
    surface: &'a Surface<'a>,
    faces: &'a Faces,
    positions: &'a [DVec3],
}

impl Vertices for Merged<'_> {
    fn position(&self, face: u32) -> DVec3 {
        self.positions[face as usize]
    }

    fn triples(&self, face: u32) -> [[u32; 3]; 2] {
        let corners = self.surface.facet(self.faces.first(face)).corners;
        if self.next(face).is_some() {
            return [corners; 2];
        }
        let mut rim = Vec::new();
        self.faces.rim(self.surface, face, &mut rim);
        let points: Vec<DVec3> = rim.iter().map(|&v| self.placing.cloud.point(v)).collect();
        if points.is_empty() {
            return [corners; 2];
        }
        [widest_triple(&points).map(|i| rim[i]), corners]
    }

    fn next(&self, face: u32) -> Option<[u32; 3]> {
        let across = self.surface.facet(self.faces.first(face)).across;
        let next = across.map(|g| self.faces.of_facet(g));
        next.iter().all(|&g| g != face).then_some(next)
    }
}
