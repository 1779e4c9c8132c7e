//! One round of the general sponge. The words are those of the thesis: thirds on the edges, a
//! remeshing face in each face, an offset face below it, links between offset faces across edges.

use std::f64::consts::PI;

use glam::DVec3;

use super::super::OpError;
use super::super::size::ask;
use super::{MengerParams, Thickness};
use crate::geom::{Plane, RoundingBound, meet_planes_near};
use crate::measure::dihedral_angle;
use crate::mesh::{
    EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap,
    WalkBuilder,
};
use crate::progress::Progress;

/// Angles that differ by no more than this are equal: sides whose directions are opposite, faces at
/// the angle of collapse.
const SAME_ANGLE: f64 = 1e-9;
/// Around an edge so sharp that a bend would reach farther than this times the thickness, it
/// reaches so far.
const FARTHEST_BEND: f64 = 8.0;

/// The links across an edge at the origin of a half-edge, from its face's offset face to that of
/// its twin.
#[derive(Clone, Copy, PartialEq)]
enum Link {
    /// Both are one vertex.
    Missing,
    /// One edge.
    Straight(HalfEdgeId),
    /// Two edges around a concave edge, with the vertex between them.
    Bent(HalfEdgeId, VertexId, HalfEdgeId),
}

impl Link {
    /// The vertex between its two edges.
    fn bend(self) -> Option<VertexId> {
        if let Self::Bent(_, bend, _) = self { Some(bend) } else { None }
    }
}

/// Points of the new mesh by half-edges of the old one.
struct Places {
    /// On the edge, near the origin.
    thirds: HalfEdgeMap<DVec3>,
    /// In the face, at the corner at the origin.
    frames: HalfEdgeMap<DVec3>,
    /// Below that.
    depths: HalfEdgeMap<DVec3>,
}

pub(super) fn round(
    mesh: &Mesh,
    params: &MengerParams,
    progress: &dyn Progress,
) -> Result<(Mesh, Vec<usize>), OpError> {
    let mut planes = FaceMap::filled(mesh.face_slots(), None);
    for (turn, f) in mesh.faces().enumerate() {
        ask(progress, turn)?;
        planes[f] = Some(mesh.plane(f).ok_or(OpError::NoArea(f))?);
    }
    let mut places = Places::of(mesh, &planes, params.thickness);
    ask(progress, 0)?;
    let angles = angles(mesh);
    let joins = Joins::of(mesh, &angles, params.collapse.radians());
    joins.merge(mesh, &planes, &mut places.depths);
    ask(progress, 0)?;
    let crossing = crossing(mesh, &planes, &places, &joins, &angles);
    ask(progress, 0)?;
    let mut digger = Digger {
        mesh,
        planes: &planes,
        places: &places,
        joins: &joins,
        angles: &angles,
        same_place: mesh
            .bounds()
            .map_or(0.0, |(low, high)| RoundingBound::of_box(low, high).length()),
        walks: WalkBuilder::with_capacity(
            mesh.vertex_count() + 6 * mesh.edge_count(),
            15 * mesh.edge_count(),
            7 * mesh.edge_count() + mesh.vertex_count(),
        ),
    };
    let frames = digger.dig();
    ask(progress, 0)?;
    let mut sponge = digger.walks.build();
    for (f, made) in frames {
        if let Some(name) = mesh.group(f) {
            made.for_each(|i| sponge.set_group(FaceId::new(i), name));
        }
    }
    Ok((sponge, crossing))
}

/// Interior angles; an edge of length zero counts as flat.
fn angles(mesh: &Mesh) -> EdgeMap<f64> {
    let mut angles = EdgeMap::filled(mesh.edge_slots(), PI);
    mesh.edges().for_each(|e| angles[e] = dihedral_angle(mesh, e).unwrap_or(PI));
    angles
}

impl Places {
    fn of(mesh: &Mesh, planes: &FaceMap<Option<Plane>>, thickness: Thickness) -> Self {
        let none = || HalfEdgeMap::filled(mesh.half_edge_slots(), DVec3::ZERO);
        let mut places = Self { thirds: none(), frames: none(), depths: none() };
        for f in mesh.faces() {
            let normal = planes[f].expect("every face has a plane").normal();
            let length = |h: HalfEdgeId| {
                mesh.position(mesh.origin(h)).distance(mesh.position(mesh.target(h)))
            };
            let is_straight = |h: &HalfEdgeId| length(*h) > 0.0;
            let shortest = mesh
                .face_half_edges(f)
                .filter(is_straight)
                .map(length)
                .fold(f64::INFINITY, f64::min);
            // A face may be one point: then no side leads out of it.
            let is_point = shortest == f64::INFINITY;
            let shortest = if is_point { 0.0 } else { shortest };
            let depth = match thickness {
                Thickness::Share(share) => share * shortest,
                Thickness::Length(length) => length.mm(),
            };
            for h in mesh.face_half_edges(f) {
                let at = mesh.position(mesh.origin(h));
                let way = |to: VertexId| {
                    let side = mesh.position(to) - at;
                    match thickness {
                        Thickness::Share(share) => side * share,
                        Thickness::Length(length) => side.normalize_or_zero() * length.mm(),
                    }
                };
                // A self-loop has no direction: both its ends get the corner between the sides
                // before and after it.
                let (mut after, mut before) = (h, mesh.prev(h));
                while !is_point && !is_straight(&after) {
                    after = mesh.next(after);
                }
                while !is_point && !is_straight(&before) {
                    before = mesh.prev(before);
                }
                let (on, back) = (way(mesh.target(after)), way(mesh.origin(before)));
                places.thirds[h] = if after == h { at + on } else { at };
                places.frames[h] = at + inwards(on, back, normal);
                places.depths[h] = places.frames[h] - normal * depth;
            }
        }
        places
    }
}

/// The way from a corner into its face, from the ways along its two sides.
fn inwards(on: DVec3, back: DVec3, normal: DVec3) -> DVec3 {
    let turn = normal.dot(on.cross(back));
    let scale = on.length() * back.length();
    if turn.abs() <= SAME_ANGLE * scale && on.dot(back) < 0.0 {
        // A winged corner.
        return normal.cross(on - back).normalize_or_zero() * on.length().min(back.length());
    }
    if turn < 0.0 { -(on + back) } else { on + back }
}

/// Which corners of offset faces are one vertex, and how the others are linked.
struct Joins {
    /// Edges without a strip.
    closed: EdgeMap<bool>,
    /// For each corner the first corner at its vertex that it is one with.
    class: HalfEdgeMap<HalfEdgeId>,
    /// How many strips end at a vertex.
    strips: VertexMap<usize>,
}

impl Joins {
    fn of(mesh: &Mesh, angles: &EdgeMap<f64>, collapse: f64) -> Self {
        let mut joins = Self {
            closed: EdgeMap::filled(mesh.edge_slots(), false),
            class: HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId(u32::MAX)),
            strips: VertexMap::filled(mesh.vertex_slots(), 0),
        };
        mesh.edges().for_each(|e| joins.closed[e] = angles[e] <= collapse + SAME_ANGLE);
        loop {
            for v in mesh.vertices() {
                joins.strips[v] = mesh.outgoing(v).filter(|h| !joins.closed[h.edge()]).count();
            }
            // Where a strip is the only one at both of its ends, they are one vertex each, and it
            // is left out, too.
            let lonely =
                |e| !joins.closed[e] && mesh.edge_vertices(e).iter().all(|&v| joins.strips[v] == 1);
            let more: Vec<_> = mesh.edges().filter(|&e| lonely(e)).collect();
            if more.is_empty() {
                break;
            }
            more.into_iter().for_each(|e| joins.closed[e] = true);
        }
        for v in mesh.vertices() {
            joins.classify(mesh, v);
        }
        joins
    }

    /// Corners follow each other around the vertex by `next(twin)`, and are one where no strip lies
    /// between them.
    fn classify(&mut self, mesh: &Mesh, v: VertexId) {
        let around: Vec<HalfEdgeId> = mesh.outgoing(v).collect();
        let is_one = self.strips[v] < 2;
        for &start in &around {
            let opens = !self.closed[mesh.prev(start).edge()];
            let begins = if is_one { start == around[0] } else { opens };
            if !begins {
                continue;
            }
            let mut h = start;
            loop {
                self.class[h] = start;
                let goes_on = is_one || self.closed[h.edge()];
                h = mesh.next(h.twin());
                if !goes_on || h == start {
                    break;
                }
            }
        }
    }

    /// Moves corners that are one vertex to where their offset faces' planes meet.
    fn merge(&self, mesh: &Mesh, planes: &FaceMap<Option<Plane>>, depths: &mut HalfEdgeMap<DVec3>) {
        for v in mesh.vertices() {
            let around: Vec<HalfEdgeId> = mesh.outgoing(v).collect();
            let meeting = |&h: &HalfEdgeId| {
                let own: Vec<HalfEdgeId> =
                    around.iter().copied().filter(|&o| self.class[o] == self.class[h]).collect();
                if own.len() == 1 {
                    return depths[h];
                }
                let floors: Vec<Plane> = own
                    .iter()
                    .filter_map(|&o| Plane::new(planes[mesh.face(o)]?.normal(), depths[o]))
                    .collect();
                let mean = depths[h]
                    + own.iter().map(|&o| depths[o] - depths[h]).sum::<DVec3>() / own.len() as f64;
                meet_planes_near(&floors, mean).0
            };
            let places: Vec<DVec3> = around.iter().map(meeting).collect();
            around.iter().zip(places).for_each(|(&h, place)| depths[h] = place);
        }
    }
}

/// Faces whose frame turns inside out, or whose tunnel runs into another.
fn crossing(
    mesh: &Mesh,
    planes: &FaceMap<Option<Plane>>,
    places: &Places,
    joins: &Joins,
    angles: &EdgeMap<f64>,
) -> Vec<usize> {
    let is_odd = |h: HalfEdgeId| {
        let (next, across) = (mesh.next(h), mesh.next(h.twin()));
        let side = mesh.position(mesh.target(h)) - mesh.position(mesh.origin(h));
        if side == DVec3::ZERO {
            return false;
        }
        let least = SAME_ANGLE * side.length_squared();
        let turns =
            [&places.frames, &places.depths].iter().any(|p| (p[next] - p[h]).dot(side) <= least);
        let too_long = (places.thirds[h.twin()] - places.thirds[h]).dot(side) <= least;
        let beyond = planes[mesh.face(h.twin())]
            .expect("every face has a plane")
            .signed_distance(places.depths[h]);
        let leaves = angles[h.edge()] < PI - SAME_ANGLE && beyond >= 0.0;
        let (wide, narrow) =
            (places.frames[across] - places.frames[h], places.depths[across] - places.depths[h]);
        let crosses = !joins.closed[h.edge()]
            && joins.class[h] != joins.class[across]
            && wide.dot(narrow) <= 0.0;
        turns || too_long || leaves || crosses
    };
    mesh.faces().filter(|&f| mesh.face_half_edges(f).any(is_odd)).map(FaceId::index).collect()
}

struct Digger<'a> {
    mesh: &'a Mesh,
    planes: &'a FaceMap<Option<Plane>>,
    places: &'a Places,
    joins: &'a Joins,
    angles: &'a EdgeMap<f64>,
    /// Constructed points that are no farther apart are one.
    same_place: f64,
    walks: WalkBuilder,
}

/// Half-edges of the new mesh by half-edges of the old one.
struct Sides {
    /// From the origin to the third.
    ends: HalfEdgeMap<HalfEdgeId>,
    /// From the third near the origin to the other.
    middles: HalfEdgeMap<HalfEdgeId>,
    /// From the third near the origin to the corner of the frame there, and from the third near the
    /// target to the corner there.
    spokes: HalfEdgeMap<[HalfEdgeId; 2]>,
    /// Along the inside of the frame.
    frames: HalfEdgeMap<HalfEdgeId>,
    /// From the frame down to the offset face, at the origin.
    shafts: HalfEdgeMap<HalfEdgeId>,
    /// Along the offset face.
    floors: HalfEdgeMap<HalfEdgeId>,
    /// The vertex of the offset face at the origin.
    depths: HalfEdgeMap<VertexId>,
}

impl Digger<'_> {
    /// Adds everything; returns the numbers of each face's frame.
    fn dig(&mut self) -> Vec<(FaceId, std::ops::Range<usize>)> {
        let sides = self.sides();
        let links = self.links(&sides);
        let mesh = self.mesh;
        let mut frames = Vec::with_capacity(mesh.face_count());
        let mut made = 0;
        for f in mesh.faces() {
            let start = made;
            for h in mesh.face_half_edges(f) {
                let prev = mesh.prev(h);
                self.walks.face([
                    sides.middles[h],
                    sides.spokes[h][1],
                    sides.frames[h].twin(),
                    sides.spokes[h][0].twin(),
                ]);
                let back = sides.ends[prev.twin()].twin();
                self.walks.face([
                    sides.ends[h],
                    sides.spokes[h][0],
                    sides.spokes[prev][1].twin(),
                    back,
                ]);
                made += 2;
            }
            frames.push((f, start..made));
        }
        for h in mesh.faces().flat_map(|f| mesh.face_half_edges(f)) {
            let next = mesh.next(h);
            self.walks.face([
                sides.frames[h],
                sides.shafts[next],
                sides.floors[h].twin(),
                sides.shafts[h].twin(),
            ]);
        }
        self.inner_skin(&sides, &links);
        frames
    }

    fn sides(&mut self) -> Sides {
        let mesh = self.mesh;
        let none = || HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId(u32::MAX));
        let points = || HalfEdgeMap::filled(mesh.half_edge_slots(), VertexId::new(0));
        let mut corners = VertexMap::filled(mesh.vertex_slots(), VertexId::new(0));
        mesh.vertices().for_each(|v| corners[v] = self.walks.vertex(mesh.position(v)));
        let (mut thirds, mut inner, mut depths) = (points(), points(), points());
        for h in mesh.half_edges() {
            thirds[h] = self.walks.vertex(self.places.thirds[h]);
            inner[h] = self.walks.vertex(self.places.frames[h]);
            if self.joins.class[h] == h {
                depths[h] = self.walks.vertex(self.places.depths[h]);
            }
        }
        mesh.half_edges().for_each(|h| depths[h] = depths[self.joins.class[h]]);
        let spokes = HalfEdgeMap::filled(mesh.half_edge_slots(), [HalfEdgeId(u32::MAX); 2]);
        let mut sides = Sides {
            ends: none(),
            middles: none(),
            spokes,
            frames: none(),
            shafts: none(),
            floors: none(),
            depths,
        };
        for h in mesh.half_edges() {
            let next = mesh.next(h);
            sides.ends[h] = self.walks.edge(corners[mesh.origin(h)], thirds[h]);
            sides.spokes[h] = [
                self.walks.edge(thirds[h], inner[h]),
                self.walks.edge(thirds[h.twin()], inner[next]),
            ];
            sides.frames[h] = self.walks.edge(inner[h], inner[next]);
            sides.shafts[h] = self.walks.edge(inner[h], sides.depths[h]);
        }
        for e in mesh.edges() {
            let [h, t] = e.half_edges();
            sides.middles[h] = self.walks.edge(thirds[h], thirds[t]);
            sides.middles[t] = sides.middles[h].twin();
            sides.floors[h] = self.walks.edge(sides.depths[h], sides.depths[mesh.next(h)]);
            sides.floors[t] = if self.joins.closed[e] {
                sides.floors[h].twin()
            } else {
                self.walks.edge(sides.depths[t], sides.depths[mesh.next(t)])
            };
        }
        sides
    }

    /// Links across edges, at the origin of each half-edge that has a strip.
    fn links(&mut self, sides: &Sides) -> HalfEdgeMap<Link> {
        let mesh = self.mesh;
        let mut links = HalfEdgeMap::filled(mesh.half_edge_slots(), Link::Missing);
        for v in mesh.vertices() {
            let open: Vec<HalfEdgeId> =
                mesh.outgoing(v).filter(|h| !self.joins.closed[h.edge()]).collect();
            let is_bent = |h: &HalfEdgeId| self.angles[h.edge()] > PI + SAME_ANGLE;
            match open[..] {
                [] | [_] => {}
                // Two strips that go on into each other, without a face between them.
                [a, b] if !is_bent(&a) && !is_bent(&b) => {
                    let edge = self.walks.edge(sides.depths[a], sides.depths[mesh.next(a.twin())]);
                    links[a] = Link::Straight(edge);
                    links[b] = Link::Straight(edge.twin());
                }
                _ => {
                    let (bent, straight): (Vec<HalfEdgeId>, Vec<HalfEdgeId>) =
                        open.into_iter().partition(is_bent);
                    for &h in &straight {
                        let (from, to) = (sides.depths[h], sides.depths[mesh.next(h.twin())]);
                        links[h] = Link::Straight(self.walks.edge(from, to));
                    }
                    if straight.is_empty() && self.is_one_place(&bent) {
                        self.star(&bent, sides, &mut links);
                        continue;
                    }
                    for &h in &bent {
                        let (from, to) = (sides.depths[h], sides.depths[mesh.next(h.twin())]);
                        let bend = self.bend(h);
                        links[h] = self
                            .way_around(&straight, (from, to), (bend, sides), &links)
                            .unwrap_or_else(|| {
                                let bend = self.walks.vertex(bend);
                                Link::Bent(
                                    self.walks.edge(from, bend),
                                    bend,
                                    self.walks.edge(bend, to),
                                )
                            });
                    }
                }
            }
        }
        links
    }

    fn is_one_place(&self, bent: &[HalfEdgeId]) -> bool {
        let first = self.bend(bent[0]);
        bent.iter().all(|&h| self.bend(h).distance(first) <= self.same_place)
    }

    /// Bent links that all turn at one place share it, and the edges to it, so that no face without
    /// area is left between them.
    fn star(&mut self, bent: &[HalfEdgeId], sides: &Sides, links: &mut HalfEdgeMap<Link>) {
        let middle = self.walks.vertex(self.bend(bent[0]));
        let rays: Vec<HalfEdgeId> =
            bent.iter().map(|&h| self.walks.edge(sides.depths[h], middle)).collect();
        for (i, &h) in bent.iter().enumerate() {
            links[h] = Link::Bent(rays[i], middle, rays[(i + 1) % rays.len()].twin());
        }
    }

    /// The two straight links that lead the other way around a vertex, when they turn at the very
    /// place of a bend: it would leave a slit without area between them, so it takes them instead
    /// of edges of its own.
    fn way_around(
        &self,
        straight: &[HalfEdgeId],
        (from, to): (VertexId, VertexId),
        (bend, sides): (DVec3, &Sides),
        links: &HalfEdgeMap<Link>,
    ) -> Option<Link> {
        let &[a, b] = straight else { return None };
        // In the order of the walk around the vertex: from the end of the bent link on to its
        // start.
        for (first, second) in [(a, b), (b, a)] {
            let (Link::Straight(on), Link::Straight(back)) = (links[first], links[second]) else {
                continue;
            };
            let corner = second;
            let turn = sides.depths[corner];
            let is_there = self.places.depths[corner].distance(bend) <= self.same_place;
            if sides.depths[first] == to
                && sides.depths[self.mesh.next(second.twin())] == from
                && is_there
            {
                return Some(Link::Bent(back.twin(), turn, on.twin()));
            }
        }
        None
    }

    /// Below a concave edge, near the origin of `h`, on the planes of both offset faces.
    fn bend(&self, h: HalfEdgeId) -> DVec3 {
        let mesh = self.mesh;
        let [n, m] = [h, h.twin()]
            .map(|h| self.planes[mesh.face(h)].expect("every face has a plane").normal());
        let corners = [h, mesh.next(h.twin())];
        let depth = corners.map(|c| self.places.frames[c].distance(self.places.depths[c]));
        let reach = (1.0 / (1.0 + n.dot(m))).min(FARTHEST_BEND);
        self.places.thirds[h] - (n + m) * (reach * depth[0].midpoint(depth[1]))
    }

    /// Strips between offset faces, and what is left open around vertices.
    fn inner_skin(&mut self, sides: &Sides, links: &HalfEdgeMap<Link>) {
        let mesh = self.mesh;
        for e in mesh.edges().filter(|&e| !self.joins.closed[e]) {
            self.strip(e, sides, links);
        }
        for v in mesh.vertices() {
            let mut walk = Vec::new();
            for h in mesh.outgoing(v) {
                match links[h] {
                    Link::Missing => {}
                    Link::Straight(edge) => walk.push(edge),
                    Link::Bent(first, _, second) => walk.extend([first, second]),
                }
            }
            // What goes there and back again has no face between.
            let is_slit = walk.iter().all(|&h: &HalfEdgeId| walk.contains(&h.twin()));
            if walk.len() > 2 && !is_slit {
                self.walks.face(walk);
            }
        }
    }

    /// The strip across an edge: one face, or two with a ridge between them where a link is bent.
    fn strip(&mut self, e: EdgeId, sides: &Sides, links: &HalfEdgeMap<Link>) {
        let [h, t] = e.half_edges();
        let (here, there) = (links[h], links[t]);
        if here.bend().is_none() && there.bend().is_none() {
            let ends = [there, here].map(|link| match link {
                Link::Straight(edge) => Some(edge.twin()),
                _ => None,
            });
            let around = [Some(sides.floors[h]), ends[0], Some(sides.floors[t]), ends[1]];
            self.walks.face(around.into_iter().flatten());
            return;
        }
        // From the bend at the origin of h to that at the origin of t; a bend that is not there is
        // the vertex that both sides share.
        let [a, b] =
            [(here, h), (there, t)].map(|(link, h)| link.bend().unwrap_or(sides.depths[h]));
        let ridge = self.walks.edge(a, b);
        for (side, ridge, near, far) in [(h, ridge, here, there), (t, ridge.twin(), there, here)] {
            // Around the strip: along the floor, to the far bend, along the ridge, to the floor.
            let out = if let Link::Bent(_, _, edge) = far { Some(edge.twin()) } else { None };
            let back = if let Link::Bent(edge, _, _) = near { Some(edge.twin()) } else { None };
            let around = [Some(sides.floors[side]), out, Some(ridge.twin()), back];
            self.walks.face(around.into_iter().flatten());
        }
    }
}
