//! Closes the wound of a cut: walks of section edges become caps, or rims where the mesh was open.
//!
//! Where several walks meet at a vertex, the flat picture of the section decides how they go on:
//! material lies on the left of every section edge, so each leaving edge belongs with the next
//! arriving one counter-clockwise. Walks inside others are holes of a cap; caps with holes are
//! divided by the fewest bridges into faces without holes (`bridge.rs`).

use glam::DVec2;

use super::cutter::{Capping, Cutter, SlicingPlane};
use crate::geom::polygon::{Location, locate, signed_area};
use crate::geom::{Frame, Plane};
use crate::mesh::{FaceId, FaceKind, HalfEdgeId, Mesh, VertexId};

/// A closed walk of the section that visits no vertex twice, flattened; the material is on its
/// left.
pub(super) struct SectionWalk {
    /// The cap that the walk bounds, alone or together with others that it touches.
    pub face: FaceId,
    pub half_edges: Vec<HalfEdgeId>,
    pub vertices: Vec<VertexId>,
    pub corners: Vec<DVec2>,
    pub area: f64,
}

impl Cutter {
    /// Replaces the region in front of the plane by caps, which [`Self::done`] then lists.
    pub(super) fn close(&mut self, plane: &SlicingPlane) {
        let region = std::mem::take(&mut self.region);
        let old_rims = self.rims_of(&region);
        let frame = Frame::on_plane(&plane.plane);
        let mut touches_itself = false;
        let starts = self.mesh.replace_region(&region, |mesh, passes| {
            touches_itself = true;
            pair_by_material(mesh, &frame, passes);
        });
        self.region = region;
        self.cap_walks(plane, &starts, &old_rims, touches_itself);
    }

    /// Makes the new faces, one for each of `starts`, caps or rims.
    pub(super) fn cap_walks(
        &mut self,
        plane: &SlicingPlane,
        starts: &[HalfEdgeId],
        old_rims: &[HalfEdgeId],
        touches_itself: bool,
    ) {
        let mut caps = std::mem::take(&mut self.done.caps);
        for &start in starts {
            let was_open = self.register_walk(start);
            let f = self.mesh.face(start);
            let kind = if self.stays_open(f, was_open, old_rims) {
                FaceKind::Hole
            } else {
                FaceKind::Solid
            };
            self.register_cap(f, kind, &plane.plane);
            if kind == FaceKind::Solid && self.tidy(f) {
                caps.push(f);
            }
        }
        let has_more_walks = caps.len() > 1 || (touches_itself && !caps.is_empty());
        self.done.caps = if has_more_walks { self.nest(&plane.plane, caps) } else { caps };
    }

    /// The half-edges of the holes in a region, ascending.
    fn rims_of(&self, region: &[FaceId]) -> Vec<HalfEdgeId> {
        let holes = region.iter().filter(|&&f| self.mesh.is_hole(f));
        let mut rims: Vec<HalfEdgeId> = holes.flat_map(|&f| self.mesh.face_half_edges(f)).collect();
        rims.sort_unstable();
        rims
    }

    fn stays_open(&self, walk: FaceId, was_open: bool, old_rims: &[HalfEdgeId]) -> bool {
        match self.capping {
            Capping::Auto => was_open,
            Capping::Always => {
                self.mesh.face_half_edges(walk).any(|h| old_rims.binary_search(&h).is_ok())
            }
            Capping::Never => true,
        }
    }

    /// Vertices that were pulled apart are new to the tables. Returns whether the walk's component
    /// is open.
    fn register_walk(&mut self, start: HalfEdgeId) -> bool {
        let vertices: Vec<_> = self.mesh.face_vertices(self.mesh.face(start)).collect();
        let known = vertices.iter().copied().find(|&v| self.is_known(v)).unwrap_or(vertices[0]);
        for &v in vertices.iter().filter(|&&v| v != known) {
            if !self.is_known(v) {
                self.register_vertex(v, known);
            }
        }
        self.is_open_at(known)
    }

    /// Removes edges of a new cap whose ends fell together, and the cap itself if no three corners
    /// are left of it. Returns whether the cap is still there.
    fn tidy(&mut self, cap: FaceId) -> bool {
        loop {
            let shrunk = self.mesh.face_half_edges(cap).find(|&h| self.has_no_length(h));
            let Some(h) = shrunk else { break };
            let other = self.mesh.face(h.twin());
            self.mesh.contract_edge(h.edge()).expect("the ends differ");
            self.drop_two_gon(other);
            if !self.mesh.has_face(cap) || self.mesh.sides(cap) <= 2 {
                break;
            }
        }
        !self.mesh.has_face(cap) || !self.drop_two_gon(cap)
    }

    fn has_no_length(&self, h: HalfEdgeId) -> bool {
        let (u, v) = (self.mesh.origin(h), self.mesh.target(h));
        u != v && self.mesh.position(u) == self.mesh.position(v)
    }

    /// Merges a face with two sides into a neighbour. Returns whether it did.
    fn drop_two_gon(&mut self, f: FaceId) -> bool {
        let is_two_gon = self.mesh.has_face(f) && self.mesh.sides(f) == 2;
        if let Some(h) = self.mesh.face_start(f).filter(|_| is_two_gon) {
            self.mesh.delete_edge_of(h);
        }
        is_two_gon
    }

    /// Finds out which walks are holes in which caps and divides those caps.
    fn nest(&mut self, plane: &Plane, caps: Vec<FaceId>) -> Vec<FaceId> {
        let near =
            self.mesh.position(self.mesh.face_vertices(caps[0]).next().expect("a cap has corners"));
        let frame = Frame { origin: near, ..Frame::on_plane(plane) };
        let walks: Vec<SectionWalk> =
            caps.iter().flat_map(|&f| self.simple_walks(&frame, f)).collect();
        let (outers, holes): (Vec<SectionWalk>, Vec<SectionWalk>) =
            walks.into_iter().partition(|w| w.area >= 0.0);
        let mut holes_of: Vec<Vec<SectionWalk>> = outers.iter().map(|_| Vec::new()).collect();
        let mut result: Vec<FaceId> = Vec::with_capacity(caps.len());
        for hole in holes {
            match innermost(&outers, &hole) {
                Some(i) => holes_of[i].push(hole),
                // A walk around nothing: the mesh is turned inside out there, and so is its cap.
                None => result.push(hole.face),
            }
        }
        for (outer, holes) in outers.into_iter().zip(holes_of) {
            if holes.is_empty() {
                result.push(outer.face);
            } else {
                let (faces, lids) = self.bridge(&frame, outer, holes);
                result.extend(faces);
                self.done.lids += lids;
            }
        }
        result.sort_unstable();
        result.dedup();
        result
    }

    /// The walk of a cap, divided where it visits a vertex a second time.
    fn simple_walks(&self, frame: &Frame, face: FaceId) -> Vec<SectionWalk> {
        let mut walks = Vec::new();
        let mut open: Vec<(VertexId, HalfEdgeId)> = Vec::new();
        for h in self.mesh.face_half_edges(face) {
            let v = self.mesh.origin(h);
            if let Some(i) = open.iter().position(|&(u, _)| u == v) {
                walks.push(self.flatten_walk(frame, face, open.drain(i..)));
            }
            open.push((v, h));
        }
        walks.push(self.flatten_walk(frame, face, open.drain(..)));
        walks
    }

    fn flatten_walk(
        &self,
        frame: &Frame,
        face: FaceId,
        walk: impl Iterator<Item = (VertexId, HalfEdgeId)>,
    ) -> SectionWalk {
        let (vertices, half_edges): (Vec<VertexId>, Vec<HalfEdgeId>) = walk.unzip();
        let corners: Vec<DVec2> =
            vertices.iter().map(|&v| frame.flatten(self.mesh.position(v))).collect();
        let area = signed_area(&corners);
        SectionWalk { face, half_edges, vertices, corners, area }
    }
}

/// The smallest outer walk around a hole.
fn innermost(outers: &[SectionWalk], hole: &SectionWalk) -> Option<usize> {
    let next = hole.corners.iter().cycle().skip(1);
    let middles: Vec<DVec2> = hole.corners.iter().zip(next).map(|(a, &b)| a.midpoint(b)).collect();
    let is_around = |outer: &SectionWalk| {
        let places = hole.corners.iter().chain(&middles).map(|&p| locate(&outer.corners, p));
        // A hole may touch its outer walk: the first place that is clearly inside or outside
        // decides.
        outer.area > -hole.area
            && places.into_iter().find(|&l| l != Location::Boundary) == Some(Location::Inside)
    };
    // A hole that touches its outer walk shares its face.
    if let Some(i) = outers.iter().position(|outer| outer.face == hole.face) {
        return Some(i);
    }
    (0..outers.len())
        .filter(|&i| is_around(&outers[i]))
        .min_by(|&a, &b| outers[a].area.total_cmp(&outers[b].area))
}

/// Pairs the section edges at a vertex so that each corner of a cap holds material; leaves the
/// pairs as they are where the flat picture is not clear (edges on top of each other).
pub(super) fn pair_by_material(
    mesh: &Mesh,
    frame: &Frame,
    passes: &mut [(HalfEdgeId, HalfEdgeId)],
) {
    let vertex = mesh.position(mesh.target(passes[0].0));
    let angle = |h: HalfEdgeId, is_arriving: bool| {
        let other = if is_arriving { mesh.origin(h) } else { mesh.target(h) };
        let ray = mesh.position(other) - vertex;
        ray.dot(frame.y).atan2(ray.dot(frame.x))
    };
    let mut rays: Vec<(f64, bool, HalfEdgeId)> = passes
        .iter()
        .flat_map(|&(arriving, leaving)| {
            [(angle(arriving, true), true, arriving), (angle(leaving, false), false, leaving)]
        })
        .collect();
    rays.sort_by(|a, b| a.0.total_cmp(&b.0));
    let alternate = (0..rays.len()).all(|i| rays[i].1 != rays[(i + 1) % rays.len()].1);
    let distinct = rays.windows(2).all(|w| w[0].0 < w[1].0);
    if !alternate || !distinct {
        return;
    }
    for (arriving, leaving) in passes {
        let i = rays.iter().position(|r| r.2 == *arriving && r.1).expect("every pass has its rays");
        // The leaving edge just clockwise of the arriving one opens the corner that the arriving
        // one closes.
        *leaving = rays[(i + rays.len() - 1) % rays.len()].2;
    }
}
