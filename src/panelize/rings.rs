//! Staggered rings on a surface of revolution.
//!
//! The sites stand in rings, each turned by half a step against the one before. All that is left to
//! be solved for is one panel of each ring: the others are its images, so they are congruent. There
//! are two ways to join the sites, since rows should run along the direction of smaller curvature
//! (see the module above): along rings, where each panel has two neighbours in its ring; or along
//! the curve that turns, in columns, where it has none there but two in the same column.
//!
//! Where the radius shrinks the number of panels in a ring may halve: each panel of the smaller ring
//! then meets three of the larger one, which has two types. On the axis there is a cap with as many
//! sides as the first ring has panels.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::curvature::Quadric;
use super::regions::{Kind, Panels};
use super::revolve::{Revolution, frame};
use super::ring_plan::RingPlan;
use super::solve::Symmetry;
use super::surface::PANEL_AREA;
use super::surface::{NONE, Surface};
use crate::geom::{Grid, Plane};

/// Angles that differ by less than this share of a step are the same.
const SAME: f64 = 1e-6;

/// A layout in rings.
pub(super) struct RingLayout {
    pub panels: Panels,
    pub areas: Vec<f64>,
    pub symmetry: Symmetry,
    /// The ring of each panel.
    pub rings: Vec<usize>,
}

/// A site: its ring, the angle about the axis and the share of the curve. Caps have the angle of
/// whatever they are compared with.
#[derive(Clone, Copy)]
struct Site {
    ring: usize,
    angle: Option<f64>,
    share: f64,
}

/// A corner to be: the sites of its panels, and where it starts.
struct Node {
    sites: Vec<usize>,
    angle: f64,
    share: f64,
}

struct Work<'a> {
    plan: &'a RingPlan,
    revolution: &'a Revolution,
    size: f64,
    sites: Vec<Site>,
    nodes: Vec<Node>,
    /// For each site the next site and the node behind each neighbour, around it.
    around: Vec<BTreeMap<usize, (usize, usize)>>,
}

/// Lays out the panels of a plan on a surface in panel sizes with the axis through its origin.
pub(super) fn ring_layout(
    plan: &RingPlan,
    revolution: &Revolution,
    size: f64,
    (surface, quadrics): (&Surface, &[Quadric]),
) -> RingLayout {
    let sites = sites(plan);
    let around = vec![BTreeMap::new(); sites.len()];
    let mut work = Work { plan, revolution, size, sites, nodes: Vec::new(), around };
    work.triangles();
    let faces = work.faces();
    let symmetry = work.symmetry(&faces);
    let areas = work.areas();
    let panels = work.panels(faces, surface, quadrics);
    let rings = work.sites.iter().map(|site| site.ring).collect();
    RingLayout { panels, areas, symmetry, rings }
}

fn sites(plan: &RingPlan) -> Vec<Site> {
    let mut sites = Vec::new();
    for (ring, row) in plan.rings.iter().enumerate() {
        for i in 0..row.count {
            let angle = row.offset + TAU * i as f64 / row.count as f64;
            let angle = (row.count > 1).then_some(angle);
            sites.push(Site { ring, angle, share: row.share });
        }
    }
    sites
}

/// An angle from −π to π.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Work<'_> {
    /// The number of a site by its ring and its place there.
    fn site(&self, ring: usize, i: usize) -> usize {
        let count = self.plan.rings[ring].count;
        self.plan.rings[ring].first + i % count
    }

    /// The site of a ring that is nearest to an angle.
    fn nearest(&self, ring: usize, angle: f64) -> usize {
        let row = &self.plan.rings[ring];
        let steps = ((angle - row.offset) * row.count as f64 / TAU).round();
        self.site(ring, (steps as i64).rem_euclid(row.count as i64) as usize)
    }

    /// The middle of some sites: their mean angle, and their mean share of the curve.
    fn middle(&self, sites: &[usize]) -> (f64, f64) {
        let all = sites.iter().map(|&s| self.sites[s]);
        let ways = all.clone().filter_map(|s| s.angle).map(DVec2::from_angle);
        let way: DVec2 = ways.sum();
        let from = self.sites[sites[0]].share;
        let off = all.map(|s| {
            let off = s.share - from;
            if self.revolution.is_loop { off - off.round() } else { off }
        });
        (way.to_angle(), from + off.sum::<f64>() / sites.len() as f64)
    }

    fn triangles(&mut self) {
        let count = self.plan.rings.len();
        let last = if self.revolution.is_loop { count } else { count - 1 };
        if self.plan.is_columns {
            let last = if self.revolution.is_loop { count } else { count - 2 };
            for ring in 0..last {
                let [next, over] = [(ring + 1) % count, (ring + 2) % count];
                for i in 0..self.plan.rings[ring].count {
                    let low = self.site(ring, i);
                    let angle = self.sites[low].angle.unwrap_or(0.0);
                    let high = self.nearest(over, angle);
                    let half = PI / self.plan.rings[next].count as f64;
                    let [left, right] = [half, -half].map(|by| self.nearest(next, angle + by));
                    self.triangle([low, high, left]);
                    self.triangle([low, right, high]);
                }
            }
            return;
        }
        for ring in 0..last {
            let next = (ring + 1) % count;
            for (own, other) in [(ring, next), (next, ring)] {
                let row = &self.plan.rings[own];
                for i in 0..if row.count > 1 { row.count } else { 0 } {
                    let [a, b] = [self.site(own, i), self.site(own, i + 1)];
                    let middle = self.middle(&[a, b]).0;
                    self.triangle([a, b, self.nearest(other, middle)]);
                }
            }
        }
    }

    /// Adds a node between three sites, run around counter-clockwise as seen with angles to the
    /// right and shares upwards.
    fn triangle(&mut self, [a, b, c]: [usize; 3]) {
        let (angle, share) = self.middle(&[a, b, c]);
        let flat = [a, b, c].map(|s| {
            let Site { angle: own, share: height, .. } = self.sites[s];
            let off = height - share;
            let off = if self.revolution.is_loop { off - off.round() } else { off };
            DVec2::new(wrapped(own.unwrap_or(angle) - angle), off)
        });
        let turns = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]) > 0.0;
        let sites = if turns { [a, b, c] } else { [a, c, b] };
        let node = self.nodes.len();
        self.nodes.push(Node { sites: sites.to_vec(), angle, share });
        for i in 0..3 {
            let [s, from, to] = [0, 1, 2].map(|k| sites[(i + k) % 3]);
            self.around[s].insert(from, (to, node));
        }
    }

    /// The nodes around each site; at a rim two sites share a node on it.
    fn faces(&mut self) -> Vec<Vec<usize>> {
        let mut on_rim: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut faces = Vec::new();
        for s in 0..self.sites.len() {
            let around = self.around[s].clone();
            let is_entered = |from: &usize| around.values().any(|&(to, _)| to == *from);
            let rim = around.keys().copied().find(|from| !is_entered(from));
            let start = rim.or(around.keys().copied().next()).unwrap_or(NONE);
            let mut face = Vec::new();
            if let Some(from) = rim {
                face.push(self.rim_node(s, from, &mut on_rim));
            }
            let mut at = start;
            while let Some(&(to, node)) = around.get(&at) {
                face.push(node);
                at = to;
                if at == start {
                    break;
                }
            }
            if rim.is_some() {
                face.push(self.rim_node(s, at, &mut on_rim));
            }
            faces.push(face);
        }
        faces
    }

    fn rim_node(&mut self, s: usize, t: usize, on_rim: &mut BTreeMap<[usize; 2], usize>) -> usize {
        let (angle, share) = self.middle(&[s, t]);
        let nodes = &mut self.nodes;
        *on_rim.entry([s.min(t), s.max(t)]).or_insert_with(|| {
            nodes.push(Node { sites: vec![s, t], angle, share: share.round() });
            nodes.len() - 1
        })
    }

    /// In how many steps the images of the panels of a ring go around.
    fn group(&self, ring: usize) -> usize {
        let rings = &self.plan.rings;
        let own = rings[ring].count;
        let beside = [ring.checked_sub(1), Some(ring + 1)];
        let counts = beside.into_iter().flatten().filter_map(|r| rings.get(r)).map(|r| r.count);
        counts.filter(|&count| count > 1 && count < own).fold(own, usize::min)
    }

    /// Where an angle stands among its images: the mirror plane that it is measured from, and the
    /// share of a step from there, up to a half either way.
    fn reduced(&self, angle: f64, ring: usize) -> (f64, f64) {
        let (group, offset) = (self.group(ring) as f64, self.plan.rings[ring].offset);
        let steps = (angle - offset) * group / TAU;
        (offset + steps.round() * TAU / group, steps - steps.round())
    }

    /// Whether some rings are images of those at the other end, which stand for both.
    fn is_mirrored(&self, rings: &[usize]) -> bool {
        let mut own = rings.to_vec();
        let mut images: Vec<usize> = rings.iter().map(|&r| self.image(r)).collect();
        own.sort_unstable();
        images.sort_unstable();
        self.plan.turn.is_some() && images < own
    }

    /// The ring at the other end.
    fn image(&self, ring: usize) -> usize {
        self.plan.rings.len() - 1 - ring
    }

    fn symmetry(&self, faces: &[Vec<usize>]) -> Symmetry {
        let axis = frame(self.revolution.axis);
        let mut firsts: BTreeMap<(Vec<usize>, i64), (usize, DMat3)> = BTreeMap::new();
        let (mut first, mut image) = (Vec::new(), Vec::new());
        for (v, node) in self.nodes.iter().enumerate() {
            let mut rings: Vec<usize> = node.sites.iter().map(|&s| self.sites[s].ring).collect();
            let (mut angle, mut flip) = (node.angle, DMat3::IDENTITY);
            if let (Some(by), true) = (self.plan.turn, self.is_mirrored(&rings)) {
                rings.iter_mut().for_each(|r| *r = self.image(*r));
                angle -= by;
                flip = turn(axis, by) * across(axis[0]);
            }
            let whole = |r: &usize| self.plan.rings[*r].count > 1;
            let least = rings.iter().copied().filter(whole).min_by_key(|&r| self.group(r));
            let (base, step) = self.reduced(angle, least.unwrap_or(rings[0]));
            rings.sort_unstable();
            let key = (rings, (step.abs() / SAME).round() as i64);
            let own = flip * turn(axis, base) * mirror(axis, step < 0.0);
            let &mut (of, back) = firsts.entry(key).or_insert_with(|| {
                // On a mirror plane a corner stays in it.
                let is_on_plane = step.abs() < SAME || step.abs() > 0.5 - SAME;
                let off = turn(axis, node.angle) * axis[2];
                let held = DMat3::from_cols(off * off.x, off * off.y, off * off.z);
                let hold = if is_on_plane { DMat3::IDENTITY - held } else { DMat3::IDENTITY };
                (v, own.transpose() * hold)
            });
            first.push(of);
            image.push(own * back);
        }
        let mut seen = std::collections::BTreeSet::new();
        let is_first_face = self.sites.iter().take(faces.len()).map(|site| {
            let is_mirrored = self.is_mirrored(&[site.ring]);
            let ring = if is_mirrored { self.image(site.ring) } else { site.ring };
            let by = self.plan.turn.filter(|_| is_mirrored).unwrap_or(0.0);
            let step = site.angle.map_or(0.0, |angle| self.reduced(angle - by, ring).1);
            seen.insert((ring, (step.abs() / SAME).round() as i64))
        });
        let is_first_face = is_first_face.collect();
        Symmetry { first, image, is_first_face }
    }

    /// The areas of panels over that of a regular hexagon of size 1.
    fn areas(&self) -> Vec<f64> {
        let rings = &self.plan.rings;
        let length = self.revolution.length / self.size;
        let count = rings.len();
        let middle = |i: usize, j: usize| (rings[i].share + rings[j].share) / 2.0;
        let of_ring: Vec<f64> = (0..count)
            .map(|r| {
                let (low, high) = if self.revolution.is_loop {
                    (rings[r].share - 0.5 / count as f64, rings[r].share + 0.5 / count as f64)
                } else {
                    (
                        if r == 0 { 0.0 } else { middle(r - 1, r) },
                        if r + 1 == count { 1.0 } else { middle(r, r + 1) },
                    )
                };
                let around = |share: f64| TAU * self.revolution.at(share).x / self.size;
                let height = (high - low) * length;
                let area = height * (around(low) + 4.0 * around((low + high) / 2.0) + around(high));
                area / 6.0 / rings[r].count as f64 / PANEL_AREA
            })
            .collect();
        self.sites.iter().map(|site| of_ring[site.ring]).collect()
    }

    /// A place on the surface.
    fn place(&self, angle: f64, share: f64) -> DVec3 {
        let axis = frame(self.revolution.axis);
        let flat = self.revolution.at(share) / self.size;
        turn(axis, angle) * axis[1] * flat.x + axis[0] * flat.y
    }

    fn panels(
        &self,
        mut faces: Vec<Vec<usize>>,
        surface: &Surface,
        quadrics: &[Quadric],
    ) -> Panels {
        let mut grid = Grid::new([0.0; 3], 0.5);
        let mut rim_grid = Grid::new([0.0; 3], 0.5);
        let rim: Vec<usize> = (0..surface.points.len()).filter(|&v| surface.is_rim(v)).collect();
        surface.points.iter().for_each(|p| _ = grid.insert(p.to_array()));
        rim.iter().for_each(|&v| _ = rim_grid.insert(surface.points[v].to_array()));
        let nearest = |place: DVec3, all: &mut dyn Iterator<Item = usize>| {
            let distance = |v: &usize| surface.points[*v].distance_squared(place);
            all.min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)))
        };
        let near = |place: DVec3| {
            let mut found = grid.around(place.to_array()).map(|v| v as usize);
            nearest(place, &mut found).unwrap_or_else(|| surface.nearest(place, 0))
        };
        let mut panels = Panels::default();
        for node in &self.nodes {
            let place = self.place(node.angle, node.share);
            let is_rim = node.sites.len() == 2;
            let mut on_rim = rim_grid.around(place.to_array()).map(|k| rim[k as usize]);
            let hint = is_rim.then(|| nearest(place, &mut on_rim)).flatten();
            panels.points.push(place);
            panels.hints.push(hint.unwrap_or_else(|| near(place)));
            panels.kinds.push(if hint.is_some() { Kind::Rim } else { Kind::Inner });
        }
        let at = |site: &Site| self.place(site.angle.unwrap_or(0.0), site.share);
        panels.sites = self.sites.iter().map(|site| near(at(site))).collect();
        // All run around alike; which way follows from the surface.
        let corners: Vec<DVec3> = faces[0].iter().map(|&v| panels.points[v]).collect();
        let up = quadrics[panels.sites[0]].normal;
        if Plane::newell(&corners).is_some_and(|plane| plane.normal().dot(up) < 0.0) {
            faces.iter_mut().for_each(|face| face.reverse());
        }
        panels.faces = faces;
        panels
    }
}

/// The turn about the first of three axes.
fn turn(axis: [DVec3; 3], angle: f64) -> DMat3 {
    DMat3::from_axis_angle(axis[0], angle)
}

/// The image across the plane of the first two of three axes, or nothing.
fn mirror(axis: [DVec3; 3], is_mirrored: bool) -> DMat3 {
    if !is_mirrored {
        return DMat3::IDENTITY;
    }
    across(axis[2])
}

/// The image across the plane through the origin square to a direction.
fn across(a: DVec3) -> DMat3 {
    DMat3::IDENTITY - DMat3::from_cols(a * a.x, a * a.y, a * a.z) * 2.0
}
