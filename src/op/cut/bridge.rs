//! Divides a cap with holes into faces without holes by the fewest bridges.
//!
//! A face that visits no vertex twice needs at least two ways at every hole, so h holes need at
//! least h + 1 bridges: one closed chain from the outer walk through all holes and back. Where
//! walks touch at a vertex, the touch is a way that costs no bridge. Candidates are the edges of
//! the constrained Delaunay triangulation of the walks that join different walks; they never cross.
//! Chains ("ears") are searched depth first, the longest wins, until every hole is joined; each ear
//! after the first costs one bridge more.

use std::collections::{HashMap, HashSet};

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation, mitigate_underflow};

use super::cutter::Cutter;
use super::section::SectionWalk;
use crate::geom::Frame;
use crate::geom::polygon::signed_area;
use crate::geom::predicate::orient2d;
use crate::mesh::{Corner, FaceId, HalfEdgeId, VertexId};

/// How many steps the search for the longest ear may take before the best one found is used.
const SEARCH_STEPS: usize = 20_000;

/// An ear has at most this many bridges, so that the search does not go arbitrarily deep.
const LONGEST_EAR: usize = 400;

/// How many times the usual steps the search goes on while it has found nothing at all.
const PATIENCE: usize = 50;

type Triangles = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A corner of the section: which walk, and which corner of it.
type Site = (usize, usize);

/// Two corners of different walks that see each other, or that are one vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Bridge {
    /// A touch needs no edge. Sorts first.
    needs_edge: bool,
    from: Site,
    to: Site,
}

/// The walks of one cap, the outer one first, with the corners of the mesh that belong to each site
/// by now.
struct CapWalks {
    walks: Vec<SectionWalk>,
    corners: HashMap<VertexId, Vec<HalfEdgeId>>,
    /// Vertices at whose point another vertex of the cap lies.
    doubled: HashSet<VertexId>,
}

impl Cutter {
    /// Joins the holes to the outer walk and each other. Returns the faces of the divided cap,
    /// ascending, and how many holes could not be joined: each keeps a face of its own, a lid that
    /// looks the other way, so that the mesh is sound and its volume right all the same.
    pub(super) fn bridge(
        &mut self,
        frame: &Frame,
        outer: SectionWalk,
        holes: Vec<SectionWalk>,
    ) -> (Vec<FaceId>, usize) {
        let mut faces: Vec<FaceId> =
            std::iter::once(&outer).chain(&holes).map(|walk| walk.face).collect();
        let mut cap = CapWalks::new(std::iter::once(outer).chain(holes).collect());
        let mut lids = self.lay_ears(frame, &mut cap, &mut faces);
        faces.sort_unstable();
        faces.dedup();
        faces.retain(|&f| self.mesh.has_face(f));
        // Walks on top of each other may have led a bridge astray.
        let is_astray = |&&f: &&FaceId| {
            let corners: Vec<DVec2> =
                self.mesh.face_positions(f).into_iter().map(|p| frame.flatten(p)).collect();
            let mut vertices: Vec<VertexId> = self.mesh.face_vertices(f).collect();
            vertices.sort_unstable();
            signed_area(&corners) <= 0.0 || vertices.windows(2).any(|w| w[0] == w[1])
        };
        if lids == 0 && !cap.doubled.is_empty() {
            lids = faces.iter().filter(is_astray).count();
        }
        (faces, lids)
    }

    /// Lays ear after ear until every hole is joined; returns how many could not be.
    fn lay_ears(&mut self, frame: &Frame, cap: &mut CapWalks, faces: &mut Vec<FaceId>) -> usize {
        let Some(candidates) = cap.candidates() else { return cap.walks.len() - 1 };
        // Where walks lie on top of each other without being joined, the flat picture does not tell
        // which bridge passes on which side of which; such bridges are a last resort.
        let is_clear = |s: Site| !cap.doubled.contains(&cap.vertex(s));
        let clear: Vec<Bridge> = candidates
            .iter()
            .copied()
            .filter(|b| !b.needs_edge || (is_clear(b.from) && is_clear(b.to)))
            .collect();
        let mut is_joined = vec![false; cap.walks.len()];
        is_joined[0] = true;
        while is_joined.contains(&false) {
            let ear = longest_ear(cap, &clear, &is_joined)
                .or_else(|| longest_ear(cap, &candidates, &is_joined));
            let Some(ear) = ear else { break };
            for bridge in ear {
                let closes = is_joined[bridge.from.0] && is_joined[bridge.to.0];
                if bridge.needs_edge && !self.lay_bridge(frame, cap, faces, bridge, closes) {
                    return 1 + is_joined.iter().filter(|joined| !**joined).count();
                }
                (is_joined[bridge.from.0], is_joined[bridge.to.0]) = (true, true);
            }
        }
        is_joined.iter().filter(|joined| !**joined).count()
    }

    /// Lays one bridge. `closes` says that both its walks are connected already: then it must
    /// divide their face. Returns `false`, with nothing done, if it would not.
    fn lay_bridge(
        &mut self,
        frame: &Frame,
        cap: &mut CapWalks,
        faces: &mut Vec<FaceId>,
        bridge: Bridge,
        closes: bool,
    ) -> bool {
        let (p, q) = (cap.point(bridge.from), cap.point(bridge.to));
        let from = self.corner_towards(frame, cap.corners_at(bridge.from), p, q);
        let to = self.corner_towards(frame, cap.corners_at(bridge.to), q, p);
        let lineage = self.lineage_of(self.mesh.face(from));
        let is_one_face = self.mesh.face(from) == self.mesh.face(to);
        if closes && !is_one_face {
            return false;
        }
        let e = self
            .mesh
            .insert_edge(Corner::At(from), Corner::At(to))
            .expect("half-edges are corners");
        let h = e.half_edge();
        if is_one_face {
            let f = self.mesh.face(h);
            self.register_face(f, lineage);
            faces.push(f);
        }
        cap.add_corner(bridge.from, h);
        cap.add_corner(bridge.to, h.twin());
        true
    }

    /// Of the corners at a site the one whose angle holds the direction to the other site.
    fn corner_towards(
        &self,
        frame: &Frame,
        corners: &[HalfEdgeId],
        here: DVec2,
        there: DVec2,
    ) -> HalfEdgeId {
        let flat = |v| frame.flatten(self.mesh.position(v));
        let holds = |h: HalfEdgeId| {
            let (next, before) =
                (flat(self.mesh.target(h)), flat(self.mesh.origin(self.mesh.prev(h))));
            is_in_angle(here, next, before, there)
        };
        corners.iter().copied().find(|&h| holds(h)).unwrap_or(corners[0])
    }
}

impl CapWalks {
    fn new(walks: Vec<SectionWalk>) -> Self {
        let mut corners: HashMap<VertexId, Vec<HalfEdgeId>> = HashMap::new();
        for walk in &walks {
            for (&v, &h) in walk.vertices.iter().zip(&walk.half_edges) {
                corners.entry(v).or_default().push(h);
            }
        }
        Self { walks, corners, doubled: HashSet::new() }
    }

    fn vertex(&self, site: Site) -> VertexId {
        self.walks[site.0].vertices[site.1]
    }

    fn point(&self, site: Site) -> DVec2 {
        self.walks[site.0].corners[site.1]
    }

    fn is_one_vertex(&self, a: Site, b: Site) -> bool {
        self.vertex(a) == self.vertex(b)
    }

    fn corners_at(&self, site: Site) -> &[HalfEdgeId] {
        &self.corners[&self.vertex(site)]
    }

    fn add_corner(&mut self, site: Site, h: HalfEdgeId) {
        let v = self.vertex(site);
        self.corners.entry(v).or_default().push(h);
    }

    /// Whether the way from one site to the other begins in material: in the angle of the site's
    /// own walk, and in an angle of every other walk that comes to the same point.
    fn holds(&self, at_point: &[Site], from: Site, to: Site) -> bool {
        let there = self.point(to);
        let opens = |(w, i): Site| {
            let corners = &self.walks[w].corners;
            let n = corners.len();
            is_in_angle(corners[i], corners[(i + 1) % n], corners[(i + n - 1) % n], there)
        };
        let others = at_point.iter().filter(|s| s.0 != from.0);
        let opens_any = |w: usize| at_point.iter().any(|&s| s.0 == w && opens(s));
        opens(from) && others.into_iter().all(|s| opens_any(s.0))
    }

    /// All touches, and all pairs of corners of different walks that a constrained Delaunay
    /// triangulation joins, in a stable order. `None` when the walks cross each other.
    fn candidates(&mut self) -> Option<Vec<Bridge>> {
        let (cdt, sites_of) = self.triangulate()?;
        let is_doubled =
            |sites: &&Vec<Site>| sites.iter().any(|&s| !self.is_one_vertex(s, sites[0]));
        self.doubled =
            sites_of.iter().filter(is_doubled).flatten().map(|&s| self.vertex(s)).collect();
        let seen = cdt
            .undirected_edges()
            .filter(|e| !e.is_constraint_edge())
            .map(|e| e.vertices().map(|v| &sites_of[v.index()]));
        let between = |[a, b]: [&Vec<Site>; 2]| {
            pairs(a, b, true).into_iter().filter(|p| self.joins(a, b, p)).collect::<Vec<_>>()
        };
        let mut bridges: Vec<Bridge> = seen.flat_map(between).collect();
        for sites in &sites_of {
            let touches = pairs(sites, sites, false)
                .into_iter()
                .filter(|t| t.from.0 < t.to.0 && self.is_one_vertex(t.from, t.to));
            bridges.extend(touches);
        }
        bridges.sort_unstable();
        Some(bridges)
    }

    /// The triangulation with the sides of all walks as constraints, and the sites at each of its
    /// points.
    fn triangulate(&self) -> Option<(Triangles, Vec<Vec<Site>>)> {
        let mut cdt = Triangles::new();
        let mut sites_of: Vec<Vec<Site>> = Vec::new();
        for (w, walk) in self.walks.iter().enumerate() {
            let mut of_walk = Vec::with_capacity(walk.corners.len());
            for (i, p) in walk.corners.iter().enumerate() {
                let point = mitigate_underflow(Point2::new(p.x, p.y));
                let handle = cdt.insert(point).ok()?;
                if handle.index() == sites_of.len() {
                    sites_of.push(Vec::new());
                }
                sites_of[handle.index()].push((w, i));
                of_walk.push(handle);
            }
            for (i, &a) in of_walk.iter().enumerate() {
                let b = of_walk[(i + 1) % of_walk.len()];
                if a != b && !cdt.can_add_constraint(a, b) {
                    return None;
                }
                if a != b {
                    cdt.add_constraint(a, b);
                }
            }
        }
        Some((cdt, sites_of))
    }

    /// Whether a bridge joins walks that are not connected at its ends, through material. What
    /// touches at a vertex is joined as it is; what only lies at one point is not.
    fn joins(&self, a: &[Site], b: &[Site], bridge: &Bridge) -> bool {
        let of_vertex = |sites: &[Site], s: Site| -> Vec<Site> {
            sites.iter().copied().filter(|&t| self.is_one_vertex(s, t)).collect()
        };
        share_no_walk(&of_vertex(a, bridge.from), &of_vertex(b, bridge.to))
            && self.holds(a, bridge.from, bridge.to)
            && self.holds(b, bridge.to, bridge.from)
    }
}

fn share_no_walk(a: &[Site], b: &[Site]) -> bool {
    a.iter().all(|s| b.iter().all(|t| s.0 != t.0))
}

fn pairs(a: &[Site], b: &[Site], needs_edge: bool) -> Vec<Bridge> {
    a.iter().flat_map(|&from| b.iter().map(move |&to| Bridge { needs_edge, from, to })).collect()
}

/// Whether `w` lies inside the angle at `v` from `next` counter-clockwise to `before`.
fn is_in_angle(v: DVec2, next: DVec2, before: DVec2, w: DVec2) -> bool {
    let (after_next, before_before) = (orient2d(v, next, w) > 0.0, orient2d(v, before, w) < 0.0);
    if orient2d(v, next, before) > 0.0 {
        after_next && before_before
    } else {
        after_next || before_before
    }
}

/// The longest chain found from a joined walk through walks that are not joined yet and back to a
/// joined one, entering and leaving every walk at different corners, its two ends at different
/// corners, too.
fn longest_ear(cap: &CapWalks, candidates: &[Bridge], is_joined: &[bool]) -> Option<Vec<Bridge>> {
    let mut by_walk = vec![Vec::new(); cap.walks.len()];
    for &bridge in candidates {
        by_walk[bridge.from.0].push(bridge);
        by_walk[bridge.to.0].push(Bridge { from: bridge.to, to: bridge.from, ..bridge });
    }
    let wanted = is_joined.iter().filter(|joined| !**joined).count();
    let mut search = EarSearch {
        cap,
        by_walk,
        is_joined,
        is_used: is_joined.to_vec(),
        best: None,
        steps: 0,
        wanted,
    };
    for w in (0..cap.walks.len()).filter(|&w| is_joined[w]) {
        for i in 0..search.by_walk[w].len() {
            let first = search.by_walk[w][i];
            if !is_joined[first.to.0] {
                search.extend(&mut vec![first]);
            }
        }
    }
    search.best
}

struct EarSearch<'a> {
    cap: &'a CapWalks,
    by_walk: Vec<Vec<Bridge>>,
    is_joined: &'a [bool],
    is_used: Vec<bool>,
    best: Option<Vec<Bridge>>,
    steps: usize,
    wanted: usize,
}

impl EarSearch<'_> {
    fn is_done(&self) -> bool {
        match &self.best {
            Some(best) => best.len() == self.wanted + 1 || self.steps >= SEARCH_STEPS,
            None => self.steps >= PATIENCE * SEARCH_STEPS,
        }
    }

    fn extend(&mut self, ear: &mut Vec<Bridge>) {
        if self.is_done() {
            return;
        }
        self.steps += 1;
        let (start, at) = (ear[0].from, ear[ear.len() - 1].to);
        self.is_used[at.0] = true;
        for i in 0..self.by_walk[at.0].len() {
            let bridge = self.by_walk[at.0][i];
            if bridge.from == at {
                continue;
            }
            if self.is_joined[bridge.to.0] {
                if !self.cap.is_one_vertex(bridge.to, start)
                    && self.best.as_ref().is_none_or(|best| best.len() <= ear.len())
                {
                    self.best = Some(ear.iter().copied().chain([bridge]).collect());
                }
            } else if !self.is_used[bridge.to.0] && ear.len() < LONGEST_EAR {
                ear.push(bridge);
                self.extend(ear);
                ear.pop();
            }
        }
        self.is_used[at.0] = false;
    }
}
