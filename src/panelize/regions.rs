//! From regions on the fine mesh to a mesh of polygons: regions become faces, triangles in which
//! three regions meet become corners, so that three edges meet at every inner corner by
//! construction.

use std::collections::BTreeMap;

use glam::DVec3;

use super::refine::edge;
use super::sites::{apart, region_areas, regions, relax};
use super::surface::{Creases, NONE, Surface};

/// Rounds of mending regions that are no discs; the last two only relax.
const TRIES: usize = 10;
/// No face has more corners.
const MOST_CORNERS: usize = 60;

/// Where a corner of a panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Three panels meet there.
    Inner,
    /// Two panels meet at the rim.
    Rim,
    /// The rim turns there, and there is one panel.
    Corner,
    /// Three panels meet on a crease.
    Crease,
    /// Creases meet there or turn, or end at the rim.
    Kept,
}

impl Kind {
    /// Whether panels of both sides of a crease meet there.
    pub(super) fn is_on_crease(self) -> bool {
        matches!(self, Self::Crease | Self::Kept)
    }
}

/// The panels: a mesh of polygons on its way to planarity.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    pub points: Vec<DVec3>,
    pub kinds: Vec<Kind>,
    /// The mirror planes that each corner of one part of a surface lies on, a bit for each axis; empty
    /// for others.
    pub mirrors: Vec<u8>,
    /// A vertex of the surface near each corner.
    pub hints: Vec<usize>,
    /// The corners of each panel, counter-clockwise.
    pub faces: Vec<Vec<usize>>,
    /// The vertex of the surface at the middle of each panel.
    pub sites: Vec<usize>,
    /// Corners that stay, each with the number of the point that it stands at.
    pub held: BTreeMap<usize, usize>,
}

impl Panels {
    /// The faces at each corner, in the order of their numbers.
    pub(super) fn fans(&self) -> Vec<Vec<usize>> {
        let mut fans = vec![Vec::new(); self.points.len()];
        for (f, face) in self.faces.iter().enumerate() {
            face.iter().for_each(|&v| fans[v].push(f));
        }
        fans
    }

    /// Whether a face lies at the rim.
    pub(super) fn is_rim_face(&self, f: usize) -> bool {
        self.faces[f].iter().any(|&v| self.kinds[v] != Kind::Inner)
    }

    /// A vertex of the surface near a face and on its side of all creases.
    pub(super) fn hint(&self, f: usize) -> usize {
        let own = self.faces[f].iter().find(|&&v| !self.kinds[v].is_on_crease());
        own.map_or(self.sites[f], |&v| self.hints[v])
    }

    /// The mean of a face's corners.
    pub(super) fn centre(&self, f: usize) -> DVec3 {
        let face = &self.faces[f];
        face.iter().map(|&v| self.points[v]).sum::<DVec3>() / face.len() as f64
    }
}

/// The panels of some sites, mended until every region is a disc and two regions have one border at
/// most: sites of regions that are not are dropped, the smallest first, and the others relaxed.
///
/// # Errors
/// The sites of the regions that could not be mended.
pub(super) fn panels_of_sites(
    surface: &Surface,
    sites: &mut Vec<usize>,
) -> Result<Panels, Vec<usize>> {
    let mut bad = Vec::new();
    for round in 0..TRIES {
        let mut labels = regions(surface, sites);
        // A facet between creases may be one panel, however small.
        while let (false, Some(v)) =
            (surface.creases.names.is_empty(), labels.iter().position(|&label| label == NONE))
        {
            sites.push(v);
            labels = regions(surface, sites);
        }
        // A part of the surface has lost all its sites: it is too small for panels.
        if let Some(v) = labels.iter().position(|&label| label == NONE) {
            return Err(vec![v]);
        }
        let (panels, faulty) = extract(surface, &labels, sites);
        if faulty.is_empty() {
            return Ok(panels);
        }
        bad = faulty.iter().map(|&k| sites[k]).collect();
        if round + 2 < TRIES {
            let areas = region_areas(surface, &labels, sites.len());
            let is_pinned = |k: usize| k < surface.pins.sites.len();
            let mut order: Vec<usize> = faulty.into_iter().filter(|&k| !is_pinned(k)).collect();
            order.sort_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
            let dropped = apart(surface, sites, &order, 1.5);
            let mut keep = dropped.iter();
            sites.retain(|_| keep.next() == Some(&false));
        }
        relax(surface, sites, 2, false);
    }
    Err(bad)
}

/// Around a region: behind the border with a neighbour comes a corner, then the border with the
/// next neighbour.
struct Turn {
    before: usize,
    corner: usize,
    after: usize,
}

/// Where a region meets the rim: the region before, the corners from there on, the region after;
/// neither when the rim is all its own.
struct RimRun {
    before: usize,
    corners: Vec<usize>,
    after: usize,
    /// Whether it is not a crease all along.
    is_outer: bool,
}

/// A step along a rim: a corner, or the edge of a rim that is no crease.
enum Step {
    /// A corner; with the regions before and after where these change.
    Corner(usize, Option<[usize; 2]>),
    Outer,
}

struct Extraction<'a> {
    surface: &'a Surface,
    labels: &'a [usize],
    panels: Panels,
    turns: Vec<Vec<Turn>>,
    runs: Vec<Vec<RimRun>>,
    is_faulty: Vec<bool>,
    /// The corners on each edge of a crease, by the vertex where it begins on either side.
    on_edges: BTreeMap<usize, Vec<usize>>,
    /// The corners at vertices that stay, by their name.
    kept: BTreeMap<usize, usize>,
}

/// The panels, and the regions that make no proper panel, ascending.
fn extract(surface: &Surface, labels: &[usize], sites: &[usize]) -> (Panels, Vec<usize>) {
    let count = sites.len();
    let mut work = Extraction {
        surface,
        labels,
        panels: Panels { sites: sites.to_vec(), ..Panels::default() },
        turns: (0..count).map(|_| Vec::new()).collect(),
        runs: (0..count).map(|_| Vec::new()).collect(),
        is_faulty: vec![false; count],
        on_edges: BTreeMap::new(),
        kept: BTreeMap::new(),
    };
    work.inner_corners();
    work.crease_corners();
    surface.rims().iter().for_each(|rim| work.rim_corners(rim));
    for f in 0..count {
        let face = work.face(f);
        work.is_faulty[f] |= face.is_none();
        work.panels.faces.push(face.unwrap_or_default());
    }
    if !surface.creases.names.is_empty() {
        work.panels.join_at_creases(&surface.creases);
        work.panels.share_two_edges().into_iter().for_each(|f| work.is_faulty[f] = true);
    }
    for (f, face) in work.panels.faces.iter().enumerate() {
        let is_inner = face.iter().all(|&v| work.panels.kinds[v] == Kind::Inner);
        work.is_faulty[f] |= face.len() < if is_inner { 4 } else { 3 };
    }
    let faulty = (0..count).filter(|&f| work.is_faulty[f]).collect();
    (work.panels, faulty)
}

impl Extraction<'_> {
    fn corner(&mut self, place: DVec3, kind: Kind, hint: usize) -> usize {
        self.panels.points.push(place);
        self.panels.kinds.push(kind);
        self.panels.hints.push(hint);
        self.panels.mirrors.push(0);
        self.panels.points.len() - 1
    }

    fn inner_corners(&mut self) {
        for t in &self.surface.triangles {
            let [a, b, c] = t.map(|v| self.labels[v]);
            if a == b || b == c || c == a {
                continue;
            }
            let place = t.iter().map(|&v| self.surface.points[v]).sum::<DVec3>() / 3.0;
            let corner = self.corner(place, Kind::Inner, t[0]);
            for (face, before, after) in [(a, b, c), (b, c, a), (c, a, b)] {
                self.is_faulty[face] |= self.turns[face].iter().any(|t| t.before == before);
                self.turns[face].push(Turn { before, corner, after });
            }
        }
    }

    /// Corners on creases: where the region changes on either side.
    fn crease_corners(&mut self) {
        let Surface { creases, rim_next, points, .. } = self.surface;
        for (v, &w) in creases.across.iter().enumerate() {
            if w == NONE || w < v {
                continue;
            }
            let ends = [v, rim_next[v], rim_next[w], w].map(|u| self.labels[u]);
            let [a, b, c, d] = ends;
            let (from, to) = (points[v], points[rim_next[v]]);
            let mut corners = Vec::new();
            match (a != b, c != d) {
                (true, true) => {
                    corners.push(self.corner(from.lerp(to, 1.0 / 3.0), Kind::Crease, v));
                    corners.push(self.corner(from.lerp(to, 2.0 / 3.0), Kind::Crease, v));
                }
                (true, false) | (false, true) => {
                    corners.push(self.corner(from.midpoint(to), Kind::Crease, v));
                }
                (false, false) => {}
            }
            self.on_edges.insert(w, corners.iter().rev().copied().collect());
            self.on_edges.insert(v, corners);
        }
    }

    /// Which of the corners on an edge of a crease is the one where the side changes that begins at
    /// a vertex: where both sides do, each comes to its own corner first.
    fn own_corner(&self, v: usize) -> Option<usize> {
        let changes = self.labels[v] != self.labels[self.surface.rim_next[v]];
        self.on_edges[&v].first().copied().filter(|_| changes)
    }

    /// The corners along a rim: where the region changes, and where the rim turns.
    fn steps(&mut self, rim: &[usize]) -> Vec<Step> {
        let surface = self.surface;
        let mut steps = Vec::new();
        for (i, &p) in rim.iter().enumerate() {
            let q = rim[(i + 1) % rim.len()];
            let change = [self.labels[p], self.labels[q]];
            if surface.creases.has_edge(p) {
                let own = self.own_corner(p);
                let corners = self.on_edges[&p].iter();
                steps.extend(corners.map(|&c| Step::Corner(c, (own == Some(c)).then_some(change))));
            } else {
                // Across a mirror plane the surface goes on.
                let mirrors = surface.mask(p) & surface.mask(q);
                if mirrors == 0 {
                    steps.push(Step::Outer);
                }
                if change[0] != change[1] {
                    let place = surface.points[p].midpoint(surface.points[q]);
                    let corner = self.corner(place, Kind::Rim, q);
                    self.panels.mirrors[corner] = mirrors;
                    steps.push(Step::Corner(corner, Some(change)));
                }
            }
            if surface.is_corner[q] {
                let corner = match surface.creases.name(q) {
                    None => self.corner(surface.points[q], Kind::Corner, q),
                    Some(name) => match self.kept.get(&name) {
                        Some(&corner) => corner,
                        None => {
                            let corner = self.corner(surface.points[q], Kind::Kept, q);
                            self.kept.insert(name, corner);
                            corner
                        }
                    },
                };
                self.panels.mirrors[corner] = surface.mask(q);
                steps.push(Step::Corner(corner, None));
            }
        }
        steps
    }

    /// Divides a rim into the runs of its regions.
    fn rim_corners(&mut self, rim: &[usize]) {
        let mut steps = self.steps(rim);
        let is_change = |step: &Step| matches!(step, Step::Corner(_, Some(_)));
        let Some(start) = steps.iter().position(is_change) else {
            self.whole_rim(rim, &steps);
            return;
        };
        steps.rotate_left(start);
        let mut runs: Vec<RimRun> = Vec::new();
        for step in steps {
            match (step, runs.last_mut()) {
                (Step::Corner(corner, Some([before, _])), last) => {
                    if let Some(last) = last {
                        last.corners.push(corner);
                    }
                    let corners = vec![corner];
                    runs.push(RimRun { before, corners, after: NONE, is_outer: false });
                }
                (Step::Corner(corner, None), Some(last)) => last.corners.push(corner),
                (Step::Outer, Some(last)) => last.is_outer = true,
                (_, None) => unreachable!("the first step changes the region"),
            }
        }
        self.close_runs(runs);
    }

    /// A rim along which there is one region only.
    fn whole_rim(&mut self, rim: &[usize], steps: &[Step]) {
        let label = self.labels[rim[0]];
        let creases = &self.surface.creases;
        let other = |&v: &usize| creases.has_edge(v).then(|| self.labels[creases.across[v]]);
        if rim.iter().all(|v| other(v) == Some(label)) {
            // A crease that begins and ends within one region.
            return;
        }
        if !rim.iter().any(|&v| creases.has_edge(v)) {
            // A hole inside one region.
            self.is_faulty[label] = true;
            return;
        }
        let corner = |step: &Step| match step {
            Step::Corner(corner, _) => Some(*corner),
            Step::Outer => None,
        };
        let is_outer = steps.iter().any(|step| matches!(step, Step::Outer));
        let corners = steps.iter().filter_map(corner).collect();
        self.runs[label].push(RimRun { before: NONE, corners, after: NONE, is_outer });
    }

    /// Each run ends where the next begins.
    fn close_runs(&mut self, mut runs: Vec<RimRun>) {
        let count = runs.len();
        let first = runs[0].corners[0];
        runs[count - 1].corners.push(first);
        let owners: Vec<usize> = (0..count).map(|i| runs[(i + 1) % count].before).collect();
        for (i, mut run) in runs.into_iter().enumerate() {
            run.after = owners[(i + 1) % count];
            self.runs[owners[i]].push(run);
        }
    }

    /// The corners of a region in order; `None` when its border is not one loop, or meets the outer
    /// rim more than once.
    fn face(&self, f: usize) -> Option<Vec<usize>> {
        let (turns, runs) = (&self.turns[f], &self.runs[f]);
        if runs.iter().filter(|run| run.is_outer).count() > 1 {
            return None;
        }
        if let ([run], true) = (&runs[..], turns.is_empty()) {
            // What it borders on beside the rim, if anything, is one other region.
            return (run.before == run.after).then(|| run.corners.clone());
        }
        let start = runs.first().map(|run| run.before).or(turns.first().map(|t| t.before))?;
        let (mut corners, mut at, mut steps) = (Vec::new(), start, 0);
        while steps == 0 || at != start {
            if let Some(run) = runs.iter().find(|run| run.before == at) {
                corners.extend(&run.corners);
                at = run.after;
            } else {
                let turn = turns.iter().find(|turn| turn.before == at)?;
                corners.push(turn.corner);
                at = turn.after;
            }
            steps += 1;
            if steps > MOST_CORNERS {
                return None;
            }
        }
        (steps == turns.len() + runs.len()).then_some(corners)
    }
}

impl Panels {
    /// Leaves out corners on creases at which no three panels meet. Where a crease turns at one, the
    /// nearest corner on the crease takes its place.
    fn join_at_creases(&mut self, creases: &Creases) {
        for face in &mut self.faces {
            face.dedup();
            if face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
        }
        let mut fans = self.fans();
        fans.iter_mut().for_each(|fan| fan.dedup());
        let kinds = self.kinds.clone();
        let few = |v: usize, kind: Kind, least: usize| {
            kinds[v] == kind && (1..least).contains(&fans[v].len())
        };
        let count = self.points.len();
        let mut left_out: Vec<bool> = (0..count).map(|v| few(v, Kind::Crease, 3)).collect();
        for v in 0..count {
            let hint = self.hints[v];
            if !few(v, Kind::Kept, 3) || creases.outer.get(hint) == Some(&true) {
                left_out[v] |= few(v, Kind::Kept, 2) && !creases.turns[hint];
                continue;
            }
            left_out[v] = true;
            if let (2, Some(u)) = (fans[v].len(), self.next_on_crease(v, &fans[v], &left_out)) {
                (self.points[u], self.kinds[u]) = (self.points[v], Kind::Kept);
                self.hints[u] = hint;
            }
        }
        for face in &mut self.faces {
            face.retain(|&v| !left_out[v]);
        }
    }

    /// The nearest corner beside another one along a crease.
    fn next_on_crease(&self, v: usize, fan: &[usize], left_out: &[bool]) -> Option<usize> {
        let beside = |&f: &usize| {
            let face = &self.faces[f];
            let i = face.iter().position(|&c| c == v)?;
            Some([face[(i + 1) % face.len()], face[(i + face.len() - 1) % face.len()]])
        };
        let near = fan.iter().filter_map(beside).flatten();
        let distance = |u: usize| self.points[u].distance_squared(self.points[v]);
        near.filter(|&u| self.kinds[u] == Kind::Crease && !left_out[u])
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)))
    }

    /// Faces that share more than one edge with another one: the one with fewer corners of each
    /// pair.
    pub(super) fn share_two_edges(&self) -> Vec<usize> {
        let mut sides: Vec<([usize; 2], usize)> = Vec::new();
        for (f, face) in self.faces.iter().enumerate() {
            let side = |i: usize| (edge(face[i], face[(i + 1) % face.len()]), f);
            sides.extend((0..face.len()).map(side));
        }
        sides.sort_unstable();
        let mut pairs: Vec<[usize; 2]> = sides
            .windows(2)
            .filter(|pair| pair[0].0 == pair[1].0)
            .map(|pair| [pair[0].1, pair[1].1])
            .collect();
        pairs.sort_unstable();
        let twice = pairs.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
        twice.map(|[a, b]| if self.faces[a].len() < self.faces[b].len() { a } else { b }).collect()
    }
}
