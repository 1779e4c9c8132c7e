//! Triangles of the body cut along the seams: the faces of the mesh, and which piece each belongs
//! to.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec2, DVec3};

use super::GluingError;
use super::rims::Rims;
use super::surface::Surface;
use super::trace::Traced;

/// A part of a side of a piece between two points of the mesh: piece, side, and how far along it
/// the part begins and ends, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SeamPart {
    pub piece: usize,
    pub side: usize,
    pub from: f64,
    pub to: f64,
}

/// The body's mesh before it is one.
pub(super) struct Overlay {
    pub places: Vec<DVec3>,
    pub faces: Vec<Vec<usize>>,
    /// Directed edge → what of a side runs along it, with the piece on its left.
    pub seams: BTreeMap<(usize, usize), SeamPart>,
}

pub(super) fn overlay(
    surface: &Surface,
    rims: &Rims,
    traced: &Traced,
    places: Vec<DVec3>,
) -> Result<Overlay, GluingError> {
    let mut build = Build {
        surface,
        overlay: Overlay { places, faces: Vec::new(), seams: BTreeMap::new() },
        on_edge: HashMap::new(),
        inside: HashMap::new(),
    };
    for (v, located) in traced.located.iter().enumerate() {
        if let Some(located) = located {
            let (x, y, origin) = build.frame(located.h);
            build.overlay.places[v] = origin + x * located.at.x + y * located.at.y;
        }
    }
    for run in &traced.runs {
        let piece = &rims.pieces[run.piece];
        let ends = [run.side, (run.side + 1) % piece.len()].map(|i| piece.vertex[i]);
        let mate = piece.mate[run.side];
        let mut nodes = vec![(ends[0], 0.0)];
        for crossing in &run.crossings {
            nodes.push((build.cross(crossing.edge, crossing.part), crossing.along));
        }
        nodes.push((ends[1], run.length));
        for (k, pair) in nodes.windows(2).enumerate() {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            let part = SeamPart { piece: run.piece, side: run.side, from, to };
            let (from, to) = (run.length - to, run.length - from);
            let back = SeamPart { piece: mate.0, side: mate.1, from, to };
            build.overlay.seams.insert((a, b), part);
            build.overlay.seams.insert((b, a), back);
            if run.edge.is_none() {
                // In the triangle before the k-th crossing, or after the last.
                let h = match (run.crossings.get(k), run.crossings.last()) {
                    (Some(next), _) => next.edge,
                    (None, Some(last)) => surface.twin[last.edge],
                    (None, None) => {
                        traced.located[ends[1]].or(traced.located[ends[0]]).map_or(0, |l| l.h)
                    }
                };
                build.inside.entry(build.triangle(h)).or_default().push([a, b]);
            }
        }
    }
    for h in surface.triangles() {
        build.divide(h)?;
    }
    Ok(build.overlay)
}

struct Build<'a> {
    surface: &'a Surface,
    overlay: Overlay,
    /// Lower half-edge of an edge → how far along it, and which point.
    on_edge: HashMap<usize, Vec<(f64, usize)>>,
    /// Lowest half-edge of a triangle → seams inside it.
    inside: HashMap<usize, Vec<[usize; 2]>>,
}

impl Build<'_> {
    fn triangle(&self, h: usize) -> usize {
        h.min(self.surface.next[h]).min(self.surface.previous(h))
    }

    /// Axes in the plane of a triangle with the half-edge along x, and its origin.
    fn frame(&self, h: usize) -> (DVec3, DVec3, DVec3) {
        let at = |h: usize| self.overlay.places[self.surface.origin[h]];
        let (a, b, c) = (at(h), at(self.surface.next[h]), at(self.surface.previous(h)));
        let x = (b - a).normalize_or_zero();
        let y = ((c - a) - (c - a).dot(x) * x).normalize_or_zero();
        (x, y, a)
    }

    fn cross(&mut self, h: usize, part: f64) -> usize {
        let t = self.surface.twin[h];
        let (edge, part) = if h < t { (h, part) } else { (t, 1.0 - part) };
        let [a, b] =
            [edge, self.surface.next[edge]].map(|h| self.overlay.places[self.surface.origin[h]]);
        let node = self.overlay.places.len();
        self.overlay.places.push(a.lerp(b, part));
        self.on_edge.entry(edge).or_default().push((part, node));
        node
    }

    /// The points along a half-edge, its end left out.
    fn along(&self, h: usize) -> Vec<usize> {
        let edge = h.min(self.surface.twin[h]);
        let mut between = self.on_edge.get(&edge).cloned().unwrap_or_default();
        between.sort_by(|a, b| a.0.total_cmp(&b.0));
        if edge != h {
            between.reverse();
        }
        std::iter::once(self.surface.origin[h]).chain(between.into_iter().map(|b| b.1)).collect()
    }

    /// The faces that the seams leave of a triangle.
    fn divide(&mut self, h: usize) -> Result<(), GluingError> {
        let sides = [h, self.surface.next[h], self.surface.previous(h)];
        let rim: Vec<usize> = sides.into_iter().flat_map(|s| self.along(s)).collect();
        let Some(seams) = self.inside.get(&h) else {
            self.overlay.faces.push(rim);
            return Ok(());
        };
        let (x, y, origin) = self.frame(h);
        let flat = |v: usize| {
            let d = self.overlay.places[v] - origin;
            DVec2::new(d.dot(x), d.dot(y))
        };
        let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut open: Vec<(usize, usize)> = Vec::new();
        for i in 0..rim.len() {
            let (a, b) = (rim[i], rim[(i + 1) % rim.len()]);
            around.entry(a).or_default().push(b);
            around.entry(b).or_default().push(a);
            open.push((a, b));
        }
        for &[a, b] in seams {
            around.entry(a).or_default().push(b);
            around.entry(b).or_default().push(a);
            open.extend([(a, b), (b, a)]);
        }
        for (&v, ends) in &mut around {
            let angle = |&w: &usize| (flat(w) - flat(v)).to_angle();
            ends.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        }
        let mut faces = Vec::new();
        let mut left: std::collections::BTreeSet<(usize, usize)> = open.iter().copied().collect();
        for start in open {
            let mut face = Vec::new();
            let mut at = start;
            while left.remove(&at) {
                face.push(at.0);
                let ends = &around[&at.1];
                let i = ends.iter().position(|&w| w == at.0).unwrap_or(0);
                at = (at.1, ends[(i + ends.len() - 1) % ends.len()]);
            }
            if !face.is_empty() {
                if at != start || face.len() < 3 {
                    return Err(GluingError::NotFound {
                        fault: "the seams could not be drawn on a face of the body".to_owned(),
                    });
                }
                faces.push(face);
            }
        }
        self.overlay.faces.extend(faces);
        Ok(())
    }
}
