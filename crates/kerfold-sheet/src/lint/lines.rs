//! Lines as the machine follows them: pieces that meet end to end are one line, whatever entities
//! the file made of them.

use glam::DVec2;

use super::artwork::{ArtPath, Artwork, Operation};
use super::pairs::{Cells, distance};
use crate::geom::polygon::bounds;

/// A line of one or more paths.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub points: Vec<DVec2>,
    pub closed: bool,
    pub operation: Operation,
    /// For messages.
    pub label: String,
    /// Index of its first path in the file.
    pub first: usize,
}

impl Line {
    /// Its segments.
    pub fn segments(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let closing = self
            .points
            .last()
            .zip(self.points.first())
            .filter(|_| self.closed)
            .map(|(a, b)| [*a, *b]);
        self.points.windows(2).map(|w| [w[0], w[1]]).chain(closing)
    }

    pub fn length(&self) -> f64 {
        self.segments().map(|[a, b]| a.distance(b)).sum()
    }
}

/// Finds cuts that run through a point.
pub(super) struct On<'a> {
    lines: &'a [Line],
    bounds: Vec<Option<(DVec2, DVec2)>>,
    gap: f64,
}

impl<'a> On<'a> {
    /// `gap` is how near a line must come to count.
    pub fn of(lines: &'a [Line], gap: f64) -> Self {
        let bounds = lines.iter().map(|l| bounds(&l.points).filter(|_| l.operation.is_cut()));
        Self { lines, bounds: bounds.collect(), gap }
    }

    /// Whether a cut runs through a point.
    pub fn is_cut(&self, p: DVec2) -> bool {
        (0..self.lines.len()).any(|i| self.touches(i, p, |_| true))
    }

    /// Whether both ends of an open line lie on cuts: others, or itself further along.
    pub fn is_closed_by_cuts(&self, i: usize) -> bool {
        let points = &self.lines[i].points;
        let last = points.len() - 1;
        [(points[0], 0), (points[last], last - 1)].into_iter().all(|(end, own)| {
            (0..self.lines.len()).any(|j| self.touches(j, end, |segment| j != i || segment != own))
        })
    }

    /// Whether one of the segments that are asked for, of a cut, runs through a point.
    fn touches(&self, i: usize, p: DVec2, is_asked: impl Fn(usize) -> bool) -> bool {
        let grown = DVec2::splat(self.gap);
        self.bounds[i]
            .is_some_and(|(low, high)| p.cmpge(low - grown).all() && p.cmple(high + grown).all())
            && self.lines[i]
                .segments()
                .enumerate()
                .any(|(k, s)| is_asked(k) && distance(p, s).0 <= self.gap)
    }
}

/// How a path is called in messages.
pub(super) fn label(path: &ArtPath, i: usize) -> String {
    match (&path.name, path.layer.as_str()) {
        (Some(name), _) => name.clone(),
        (None, "") => format!("path {}", i + 1),
        (None, layer) => format!("path {} on {layer}", i + 1),
    }
}

/// All lines: closed paths, and open cuts joined where exactly two ends of one layer meet, not
/// further apart than `reach`. Points that coincide within the gap are one. Paths without length
/// are left out.
pub(super) fn join(artwork: &Artwork, gap: f64, reach: f64) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut open = Vec::new();
    for (i, path) in artwork.paths.iter().enumerate() {
        let mut points = path.points.clone();
        points.dedup_by(|a, b| a.distance(*b) <= gap);
        let apart = |points: &[DVec2]| points[0].distance(points[points.len() - 1]);
        let ends_meet = points.len() > 2
            && (apart(&points) <= gap || path.operation.is_cut() && apart(&points) <= reach);
        if points.len() > 1 && apart(&points) <= gap {
            points.pop();
        }
        if points.len() < 2 {
            continue;
        }
        let closed = (path.closed || ends_meet) && points.len() > 2;
        let line =
            Line { points, closed, operation: path.operation, label: label(path, i), first: i };
        if closed || !path.operation.is_cut() { lines.push(line) } else { open.push(line) }
    }
    let chains = chains(open, &lines, artwork, (gap, reach));
    lines.extend(chains);
    lines.sort_by_key(|l| l.first);
    lines
}

/// Joins open cuts of the same layer end to end.
fn chains(
    open: Vec<Line>,
    rings: &[Line],
    artwork: &Artwork,
    (gap, reach): (f64, f64),
) -> Vec<Line> {
    let ends: Vec<[DVec2; 2]> =
        open.iter().map(|l| [l.points[0], l.points[l.points.len() - 1]]).collect();
    let partner = partners((&open, rings), &ends, artwork, (gap, reach));
    let mut used = vec![false; open.len()];
    let mut joined = Vec::new();
    // First those with a free end, then the rings that are left.
    let has_free = |i: usize| partner[2 * i].is_none() || partner[2 * i + 1].is_none();
    let order =
        (0..open.len()).filter(|&i| has_free(i)).chain((0..open.len()).filter(|&i| !has_free(i)));
    for start in order {
        if used[start] {
            continue;
        }
        let mut line = Line { points: Vec::new(), ..open[start].clone() };
        // Enter at the free end.
        let mut enter = if partner[2 * start].is_none() { 2 * start } else { 2 * start + 1 };
        loop {
            let i = enter / 2;
            used[i] = true;
            line.first = line.first.min(open[i].first);
            if enter % 2 == 0 {
                line.points.extend(&open[i].points);
            } else {
                line.points.extend(open[i].points.iter().rev());
            }
            match partner[enter ^ 1] {
                Some(next) if !used[next / 2] => enter = next,
                Some(next) => {
                    line.closed = next / 2 == start && line.points.len() > 3;
                    break;
                }
                None => break,
            }
        }
        // Where ends met within the gap, their points were two.
        line.points.dedup_by(|a, b| a.distance(*b) <= gap);
        if line.closed && line.points[0].distance(line.points[line.points.len() - 1]) <= gap {
            line.points.pop();
        }
        joined.push(line);
    }
    joined
}

/// For every end of every line (two a line) the one other end that meets it.
fn partners(
    (open, rings): (&[Line], &[Line]),
    ends: &[[DVec2; 2]],
    artwork: &Artwork,
    (gap, reach): (f64, f64),
) -> Vec<Option<usize>> {
    let flat: Vec<DVec2> = ends.iter().flatten().copied().collect();
    let boxes = flat.iter().map(|&p| (p - DVec2::splat(reach), p + DVec2::splat(reach)));
    let mut meeting: Vec<Vec<usize>> = vec![Vec::new(); flat.len()];
    Cells::of(boxes.collect()).pairs(|a, b| {
        let layer = |end: usize| &artwork.paths[open[end / 2].first].layer;
        if flat[a].distance(flat[b]) <= reach && layer(a) == layer(b) {
            meeting[a].push(b);
            meeting[b].push(a);
        }
    });
    // Where a third line passes, the two end on it and not on one another.
    let third = On::of(rings, gap);
    let is_free = |end: usize| !third.is_cut(flat[end]);
    let one = |end: usize| match meeting[end].as_slice() {
        // Where three or more ends meet nobody can tell which belong together.
        [other]
            if meeting[*other].len() == 1
                && other / 2 != end / 2
                && is_free(end)
                && is_free(*other) =>
        {
            Some(*other)
        }
        _ => None,
    };
    (0..flat.len()).map(one).collect()
}
