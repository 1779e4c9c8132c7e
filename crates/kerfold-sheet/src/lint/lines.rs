//! Lines as the machine follows them: pieces that meet end to end are one line, whatever entities
//! the file made of them.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;

use glam::DVec2;

use super::artwork::{ArtPath, Artwork, Operation};
use super::distance::distance;
use super::work::{LintError, Work};
use crate::geom::Grid;
use crate::geom::segments::{Segment, SegmentTree};

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

/// The segments of lines in a tree, each with where it belongs.
pub(super) struct Strokes {
    pub tree: SegmentTree,
    /// For every segment its line and its number there.
    owners: Vec<[u32; 2]>,
}

impl Strokes {
    /// Of the lines that `reach_and_kind` gives a reach and a kind.
    pub fn of(lines: &[Line], reach_and_kind: impl Fn(&Line) -> Option<(f64, u8)>) -> Self {
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        for (i, line) in lines.iter().enumerate() {
            let Some((reach, kind)) = reach_and_kind(line) else { continue };
            segments.extend(line.segments().map(|ends| Segment { ends, reach, kind }));
            let added = segments.len() - owners.len();
            owners.extend((0..added).map(|k| [i as u32, k as u32]));
        }
        Self { tree: SegmentTree::new(segments), owners }
    }

    /// Line and number there of a segment.
    pub fn owner(&self, segment: usize) -> (usize, usize) {
        let [line, index] = self.owners[segment];
        (line as usize, index as usize)
    }
}

/// Finds cuts that run through a point.
pub(super) struct On {
    strokes: Strokes,
    gap: f64,
}

impl On {
    /// `gap` is how near a line must come to count.
    pub fn of(lines: &[Line], gap: f64) -> Self {
        let strokes = Strokes::of(lines, |line| line.operation.is_cut().then_some((0.0, 0)));
        Self { strokes, gap }
    }

    /// Whether a cut runs through a point.
    pub fn is_cut(&self, p: DVec2) -> bool {
        self.touches(p, |_| true)
    }

    /// Whether both ends of an open line lie on cuts: others, or itself further along.
    pub fn is_closed_by_cuts(&self, i: usize, line: &Line) -> bool {
        let last = line.points.len() - 1;
        let ends = [(line.points[0], 0), (line.points[last], last - 1)];
        ends.into_iter().all(|(end, own)| self.touches(end, |owner| owner != (i, own)))
    }

    /// Whether one of the segments that are asked for runs through a point.
    fn touches(&self, p: DVec2, is_asked: impl Fn((usize, usize)) -> bool) -> bool {
        let grown = DVec2::splat(self.gap);
        let segments = self.strokes.tree.segments();
        let end = self.strokes.tree.in_box(p - grown, p + grown, |s| {
            let is_on = distance(p, segments[s].ends).0 <= self.gap;
            if is_on && is_asked(self.strokes.owner(s)) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        end.is_break()
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
pub(super) fn join(
    artwork: &Artwork,
    gap: f64,
    reach: f64,
    work: &mut Work,
) -> Result<Vec<Line>, LintError> {
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
    let ends = Ends::of(&open, artwork, reach);
    let partner = ends.partners(&On::of(&lines, gap), work)?;
    lines.extend(chains(&open, &partner, gap));
    lines.sort_by_key(|l| l.first);
    Ok(lines)
}

/// Joins open cuts end to end as their partners say.
fn chains(open: &[Line], partner: &[Option<usize>], gap: f64) -> Vec<Line> {
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

/// The ends of open lines, two a line, in a grid; those of different layers far apart in a third
/// direction.
struct Ends {
    places: Vec<DVec2>,
    layers: Vec<u32>,
    grid: Grid<3>,
    reach: f64,
}

impl Ends {
    fn of(open: &[Line], artwork: &Artwork, reach: f64) -> Self {
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        let mut ends = Self {
            places: Vec::with_capacity(2 * open.len()),
            layers: Vec::with_capacity(2 * open.len()),
            grid: Grid::new([0.0; 3], reach),
            reach,
        };
        for line in open {
            let next = numbers.len() as u32;
            let layer = *numbers.entry(&artwork.paths[line.first].layer).or_insert(next);
            for place in [line.points[0], line.points[line.points.len() - 1]] {
                ends.places.push(place);
                ends.layers.push(layer);
                ends.grid.insert(ends.key(ends.places.len() - 1));
            }
        }
        ends
    }

    fn key(&self, end: usize) -> [f64; 3] {
        // Three cells from layer to layer, so that neighbours never mix.
        let DVec2 { x, y } = self.places[end];
        [x, y, 3.0 * self.reach * f64::from(self.layers[end])]
    }

    /// The one end that meets another; none where several do, since nobody can tell which belong
    /// together.
    fn only_neighbour(&self, end: usize, work: &mut Work) -> Result<Option<usize>, LintError> {
        let mut only = None;
        for other in self.grid.around(self.key(end)).map(|number| number as usize) {
            work.compare(1)?;
            let meets = other != end && self.places[end].distance(self.places[other]) <= self.reach;
            if meets && only.replace(other).is_some() {
                return Ok(None);
            }
        }
        Ok(only)
    }

    /// For every end the end of another line that it is joined to.
    fn partners(&self, rings: &On, work: &mut Work) -> Result<Vec<Option<usize>>, LintError> {
        let only = (0..self.places.len()).map(|end| self.only_neighbour(end, work));
        let only: Vec<Option<usize>> = only.collect::<Result<_, _>>()?;
        // Where a third line passes, the two end on it and not on one another.
        let is_free = |end: usize| !rings.is_cut(self.places[end]);
        let is_pair = |end: usize, other: usize| {
            only[other] == Some(end) && other / 2 != end / 2 && is_free(end) && is_free(other)
        };
        let one = |(end, other): (usize, &Option<usize>)| other.filter(|&o| is_pair(end, o));
        Ok(only.iter().enumerate().map(one).collect())
    }
}

/// A line that is drawn again, point by point.
pub(super) struct Twin {
    pub label: String,
    /// The middle of its first segment.
    pub at: DVec2,
    /// The line that it repeats.
    pub of: usize,
}

/// The lines without those that repeat another, and these. Lines that are never machined, and
/// engraved ones that lie on cuts, repeat nothing.
pub(super) fn without_twins(joined: Vec<Line>) -> (Vec<Line>, Vec<Twin>) {
    let mut lines: Vec<Line> = Vec::with_capacity(joined.len());
    let mut twins = Vec::new();
    let mut known: HashMap<(bool, Vec<[u64; 2]>), usize> = HashMap::new();
    for line in joined {
        if line.operation == Operation::Info {
            lines.push(line);
            continue;
        }
        let key = (line.operation == Operation::Engrave, shape_key(&line));
        match known.get(&key) {
            Some(&of) => {
                let at = line.points[0].midpoint(line.points[1]);
                twins.push(Twin { label: line.label, at, of });
            }
            None => {
                known.insert(key, lines.len());
                lines.push(line);
            }
        }
    }
    (lines, twins)
}

/// The points of a line, the same wherever it begins and whichever way it runs.
fn shape_key(line: &Line) -> Vec<[u64; 2]> {
    let mut key: Vec<[u64; 2]> =
        line.points.iter().map(|p| (*p + DVec2::ZERO).to_array().map(f64::to_bits)).collect();
    let n = key.len();
    if line.closed {
        let least = (0..n).min_by_key(|&i| key[i]).unwrap_or(0);
        key.rotate_left(least);
        if key[1] > key[n - 1] {
            key[1..].reverse();
        }
    } else if key[0] > key[n - 1] {
        key.reverse();
    }
    key.push([u64::from(line.closed); 2]);
    key
}
