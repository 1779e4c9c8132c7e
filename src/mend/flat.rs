//! Which faces lie in one plane with their neighbours.

use crate::geom::{Plane, fit_plane};
use crate::measure::face_area;
use crate::mesh::{FaceId, FaceMap, HalfEdgeId, Mesh, VertexMap};

/// The plane of a region is fitted anew while it grows, this many times at most: a large region
/// that starts from a small face has found its plane long before.
const MOST_FITS: usize = 12;

/// All faces of a mesh in regions: connected, of one group, within a tolerance of one plane, with
/// no seam inside; a face that lies flat with no neighbour is a region of its own.
#[derive(Debug, Clone)]
pub struct FlatPatches {
    /// The faces of each region, ascending; regions by their lowest face.
    pub patches: Vec<Vec<FaceId>>,
}

impl FlatPatches {
    /// How many faces have a neighbour in their plane.
    pub fn faces_to_merge(&self) -> usize {
        self.patches.iter().map(Vec::len).filter(|&count| count > 1).sum()
    }

    /// How many regions have more than one face.
    pub fn regions_to_merge(&self) -> usize {
        self.patches.iter().filter(|patch| patch.len() > 1).count()
    }
}

/// Finds the flat regions; `tolerance` is how far a corner may lie from the plane of its region, in
/// mm.
///
/// A region grows from its largest face, as the plane of a large face is the best known, and
/// neighbours join as long as all their corners are near the plane and they look the same way.
pub fn flat_patches(mesh: &Mesh, tolerance: f64) -> FlatPatches {
    let mut areas: Vec<(f64, FaceId)> = mesh.faces().map(|f| (face_area(mesh, f), f)).collect();
    areas.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut growing =
        Growing { mesh, tolerance, is_taken: FaceMap::filled(mesh.face_slots(), false) };
    let mut patches = Vec::new();
    for (_, seed) in areas {
        if !growing.is_taken[seed] {
            let mut patch = growing.region(seed);
            patch.sort_unstable();
            patches.push(patch);
        }
    }
    patches.sort_unstable_by_key(|patch| patch[0]);
    FlatPatches { patches }
}

struct Growing<'a> {
    mesh: &'a Mesh,
    tolerance: f64,
    is_taken: FaceMap<bool>,
}

impl Growing<'_> {
    fn region(&mut self, seed: FaceId) -> Vec<FaceId> {
        self.is_taken[seed] = true;
        let mut region = vec![seed];
        let Some(mut plane) = self.mesh.plane(seed) else { return region };
        for _ in 0..MOST_FITS {
            let before = region.len();
            self.grow(&mut region, &plane);
            if region.len() == before {
                break;
            }
            match self.fitted(&region, &plane) {
                Some(better) => plane = better,
                None => break,
            }
        }
        region
    }

    /// Takes neighbours in until none is near the plane.
    fn grow(&mut self, region: &mut Vec<FaceId>, plane: &Plane) {
        let mesh = self.mesh;
        let mut open = region.clone();
        while let Some(f) = open.pop() {
            for h in mesh.face_half_edges(f) {
                let g = mesh.face(h.twin());
                if !self.is_taken[g] && self.may_join(h, g, plane) {
                    self.is_taken[g] = true;
                    region.push(g);
                    open.push(g);
                }
            }
        }
    }

    fn may_join(&self, h: HalfEdgeId, g: FaceId, plane: &Plane) -> bool {
        let mesh = self.mesh;
        !mesh.is_hole(g)
            && !mesh.is_seam(h.edge())
            && mesh.group(mesh.face(h)) == mesh.group(g)
            && self.is_near(g, plane)
            && mesh.plane(g).is_none_or(|own| own.normal().dot(plane.normal()) > 0.0)
    }

    fn is_near(&self, f: FaceId, plane: &Plane) -> bool {
        let mesh = self.mesh;
        mesh.face_vertices(f)
            .all(|v| plane.signed_distance(mesh.position(v)).abs() <= self.tolerance)
    }

    /// The plane that lies best in all corners of a region; `None` when it leaves one of its faces
    /// out.
    fn fitted(&self, region: &[FaceId], plane: &Plane) -> Option<Plane> {
        let mesh = self.mesh;
        let mut corners: Vec<_> = region.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
        corners.sort_unstable();
        corners.dedup();
        let places: Vec<_> = corners.into_iter().map(|v| mesh.position(v)).collect();
        let fitted = fit_plane(&places)?;
        let fitted =
            if fitted.normal().dot(plane.normal()) < 0.0 { fitted.flipped() } else { fitted };
        region.iter().all(|&f| self.is_near(f, &fitted)).then_some(fitted)
    }
}

/// Divides a region into discs, each with one ring of different corners, so that it can be one
/// face. A region without holes is one disc; one around a hole takes two or more.
///
/// A disc grows face by face: one joins when what it shares with the disc is one unbroken run of
/// sides. In the plane that never gets stuck before the disc is whole (Danaraj, Klee 1978: discs
/// are extendably shellable).
pub(super) struct Discs {
    /// The number of each face's disc; holes and faces that were not asked for have 0.
    pub of: FaceMap<u32>,
    /// The number that was given last.
    pub count: u32,
    /// The last disc that holds the vertex.
    touched: VertexMap<u32>,
}

impl Discs {
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self {
            of: FaceMap::filled(mesh.face_slots(), 0),
            count: 0,
            touched: VertexMap::filled(mesh.vertex_slots(), 0),
        }
    }

    /// Gives each face of a region its disc; returns how many the region takes.
    pub(super) fn divide(&mut self, mesh: &Mesh, patch: &[FaceId]) -> u32 {
        let before = self.count;
        for &seed in patch {
            if self.of[seed] == 0 {
                self.count += 1;
                self.grow(mesh, patch, seed);
            }
        }
        self.count - before
    }

    fn grow(&mut self, mesh: &Mesh, patch: &[FaceId], seed: FaceId) {
        let mut waiting = std::collections::VecDeque::from([seed]);
        while let Some(f) = waiting.pop_front() {
            if self.of[f] != 0 || !(f == seed || self.fits(mesh, f)) {
                continue;
            }
            self.of[f] = self.count;
            for v in mesh.face_vertices(f) {
                self.touched[v] = self.count;
            }
            // Whatever meets the face may fit now that it is in.
            for v in mesh.face_vertices(f) {
                let around = mesh.vertex_faces(v).filter(|&g| self.of[g] == 0);
                waiting.extend(around.filter(|g| patch.binary_search(g).is_ok()));
            }
        }
    }

    /// Whether a face shares one unbroken run of sides with the disc that grows, and no vertex
    /// besides.
    fn fits(&self, mesh: &Mesh, f: FaceId) -> bool {
        let is_shared = |h: HalfEdgeId| self.of[mesh.face(h.twin())] == self.count;
        // Seams stay, so none may come to lie inside a face.
        if mesh.face_half_edges(f).any(|h| is_shared(h) && mesh.is_seam(h.edge())) {
            return false;
        }
        let (mut sides, mut shared, mut runs, mut touched) = (0, 0, 0, 0);
        for h in mesh.face_half_edges(f) {
            sides += 1;
            shared += usize::from(is_shared(h));
            runs += usize::from(is_shared(h) && !is_shared(mesh.prev(h)));
            touched += usize::from(self.touched[mesh.origin(h)] == self.count);
        }
        runs == 1 && shared < sides && touched == shared + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::cube;
    use crate::shape;

    #[test]
    fn a_triangulated_cube_has_six_regions_and_a_sphere_none() {
        let mesh = cube();
        assert_eq!(flat_patches(&mesh, 1e-9).regions_to_merge(), 0);
        let sphere = shape::geodesic(4, 100.0);
        assert_eq!(flat_patches(&sphere, 1e-6).faces_to_merge(), 0);
        // A tolerance as large as the model makes regions of what looks one way.
        assert!(flat_patches(&sphere, 100.0).regions_to_merge() > 0);
    }
}
