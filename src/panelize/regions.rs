//! From regions on the fine mesh to a mesh of polygons: regions become faces, triangles in which
//! three regions meet become corners, so that three edges meet at every inner corner by
//! construction.

use glam::DVec3;

use super::sites::{apart, region_areas, regions, relax};
use super::surface::{NONE, Surface};

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
}

/// The panels: a mesh of polygons on its way to planarity.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    pub points: Vec<DVec3>,
    pub kinds: Vec<Kind>,
    /// A vertex of the surface near each corner.
    pub hints: Vec<usize>,
    /// The corners of each panel, counter-clockwise.
    pub faces: Vec<Vec<usize>>,
    /// The vertex of the surface at the middle of each panel.
    pub sites: Vec<usize>,
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
        let labels = regions(surface, sites);
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
            let mut order = faulty;
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

/// Where a region meets the rim: the region before, the corners from there on, the region after.
struct RimRun {
    before: usize,
    corners: Vec<usize>,
    after: usize,
}

struct Extraction<'a> {
    surface: &'a Surface,
    labels: &'a [usize],
    panels: Panels,
    turns: Vec<Vec<Turn>>,
    runs: Vec<Vec<RimRun>>,
    is_faulty: Vec<bool>,
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
    };
    work.inner_corners();
    surface.rims().iter().for_each(|rim| work.rim_corners(rim));
    for f in 0..count {
        let face = work.face(f);
        let needed = match &face {
            Some(face) if face.iter().any(|&v| work.panels.kinds[v] != Kind::Inner) => 3,
            _ => 4,
        };
        work.is_faulty[f] |= face.as_ref().is_none_or(|face| face.len() < needed);
        work.panels.faces.push(face.unwrap_or_default());
    }
    let faulty = (0..count).filter(|&f| work.is_faulty[f]).collect();
    (work.panels, faulty)
}

impl Extraction<'_> {
    fn corner(&mut self, place: DVec3, kind: Kind, hint: usize) -> usize {
        self.panels.points.push(place);
        self.panels.kinds.push(kind);
        self.panels.hints.push(hint);
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

    /// Corners where the region changes along a rim, and where the rim turns.
    fn rim_corners(&mut self, rim: &[usize]) {
        let label = |i: usize| self.labels[rim[i % rim.len()]];
        let Some(start) = (0..rim.len()).find(|&i| label(i + rim.len() - 1) != label(i)) else {
            // A hole inside one region.
            self.is_faulty[self.labels[rim[0]]] = true;
            return;
        };
        let mut runs: Vec<RimRun> = Vec::new();
        for i in start..start + rim.len() {
            let (p, q) = (rim[(i + rim.len() - 1) % rim.len()], rim[i % rim.len()]);
            if self.labels[p] != self.labels[q] {
                let place = self.surface.points[p].midpoint(self.surface.points[q]);
                let corner = self.corner(place, Kind::Rim, q);
                if let Some(last) = runs.last_mut() {
                    last.corners.push(corner);
                }
                let (before, after) = (self.labels[p], NONE);
                runs.push(RimRun { before, corners: vec![corner], after });
            }
            if self.surface.is_corner[q] {
                let corner = self.corner(self.surface.points[q], Kind::Corner, q);
                runs.last_mut().expect("the first step changes the region").corners.push(corner);
            }
        }
        self.close_runs(runs);
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

    /// The corners of a region in order; `None` when its border is not one loop.
    fn face(&self, f: usize) -> Option<Vec<usize>> {
        let turns = &self.turns[f];
        let (mut corners, start, mut at) = match &self.runs[f][..] {
            [] => (Vec::new(), turns.first()?.before, turns.first()?.before),
            [run] => (run.corners.clone(), run.before, run.after),
            _ => return None,
        };
        let mut steps = 0;
        let has_run = !corners.is_empty();
        while at != start || steps == 0 && (!has_run || !turns.is_empty()) {
            let turn = turns.iter().find(|turn| turn.before == at)?;
            corners.push(turn.corner);
            at = turn.after;
            steps += 1;
            if steps > MOST_CORNERS {
                return None;
            }
        }
        (steps == turns.len()).then_some(corners)
    }
}
