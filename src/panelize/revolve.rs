//! Surfaces of revolution: where the axis is, and the curve that turns about it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::PanelizeError;
use super::refine::{Triangles, edge};

/// Half planes through the axis in which the curve is looked at.
const SECTIONS: usize = 12;
/// Where the first of them stands, so that none goes through vertices of regular meshes.
const FIRST: f64 = 0.123_456_7;
/// Points on the curve.
const POINTS: usize = 400;
/// Points nearer to the axis than this share of the farthest one lie on it.
const AXIS: f64 = 1e-9;
/// A surface of revolution is off its curve by at most this, in panel sizes.
const MOST_OFF: f64 = 0.05;
/// A curve that is its own mirror image is off that by at most this, in panel sizes.
const MIRRORED: f64 = 0.01;

/// A surface of revolution. Lengths in those of the mesh.
#[derive(Debug, Clone)]
pub(super) struct Revolution {
    /// Which of x, y and z the axis runs along.
    pub axis: usize,
    /// A point on the axis.
    pub origin: DVec3,
    /// The curve by distance from the axis and height along it, seen from the origin; evenly spaced.
    pub curve: Vec<DVec2>,
    /// Whether the curve is a loop.
    pub is_loop: bool,
    /// Whether its first and last point lie on the axis.
    pub is_pole: [bool; 2],
    /// Its length.
    pub length: f64,
    /// Whether the curve is its own image across the plane square to the axis through the origin.
    pub is_mirrored: bool,
}

/// One section: points by distance from the axis and height.
struct Section {
    points: Vec<DVec2>,
    is_loop: bool,
    is_pole: [bool; 2],
}

impl Revolution {
    /// The axis along a coordinate axis and the curve of a surface.
    ///
    /// # Errors
    /// Where it is none: parts of the surface lie beside the curve that turns about the axis, or it
    /// does not go all around.
    pub(super) fn find(given: &Triangles, axis: usize, size: f64) -> Result<Self, PanelizeError> {
        let origin = place_of_axis(given, axis);
        let sections: Vec<Section> = (0..SECTIONS)
            .map(|k| {
                let angle = FIRST + std::f64::consts::TAU * k as f64 / SECTIONS as f64;
                let found = sections(given, axis, origin, angle);
                let count = found.len();
                match <[Section; 1]>::try_from(found) {
                    Ok([section]) => Ok(section),
                    Err(_) => {
                        let degrees = angle.to_degrees().rem_euclid(360.0);
                        Err(PanelizeError::NoTurn { axis: NAMES[axis], degrees, count })
                    }
                }
            })
            .collect::<Result<_, _>>()?;
        let first = &sections[0];
        let lined: Vec<Vec<DVec2>> =
            sections.iter().map(|section| resampled(&section.lined_up(first))).collect();
        let curve: Vec<DVec2> = (0..POINTS)
            .map(|i| lined.iter().map(|points| points[i]).sum::<DVec2>() / SECTIONS as f64)
            .collect();
        let (is_loop, is_pole) = (first.is_loop, first.is_pole);
        let (length, is_mirrored) = (0.0, false);
        let mut made = Self { axis, origin, curve, is_loop, is_pole, length, is_mirrored };
        for (end, point) in [(0, 0), (1, POINTS - 1)] {
            if is_pole[end] {
                made.curve[point].x = 0.0;
            }
        }
        made.mirror(MIRRORED * size);
        made.length = made.steps().map(|(a, b)| a.distance(b)).sum();
        made.check(given, size)?;
        Ok(made)
    }

    fn steps(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let last = if self.is_loop { POINTS } else { POINTS - 1 };
        (0..last).map(|i| (self.curve[i], self.curve[(i + 1) % POINTS]))
    }

    /// Looks whether the curve is its own mirror image; then the origin is put in the middle of it, and
    /// the curve made even.
    fn mirror(&mut self, most: f64) {
        if self.is_loop || self.is_pole[0] != self.is_pole[1] {
            return;
        }
        let back = |i: usize| self.curve[POINTS - 1 - i];
        let heights = (0..POINTS).map(|i| (self.curve[i].y + back(i).y) / 2.0);
        let middle = heights.sum::<f64>() / POINTS as f64;
        let image = |i: usize| DVec2::new(back(i).x, 2.0 * middle - back(i).y);
        let off = |i: usize| self.curve[i].distance(image(i));
        if (0..POINTS).map(off).fold(0.0, f64::max) > most {
            return;
        }
        let low = DVec2::new(0.0, middle);
        self.curve = (0..POINTS).map(|i| self.curve[i].midpoint(image(i)) - low).collect();
        self.origin += frame(self.axis)[0] * middle;
        self.is_mirrored = true;
    }

    /// That all vertices lie near the curve.
    fn check(&self, given: &Triangles, size: f64) -> Result<(), PanelizeError> {
        let mut worst = (0.0, DVec3::ZERO);
        for &place in &given.points {
            let flat = self.flatten(place);
            let off = |(a, b): (DVec2, DVec2)| {
                let way = b - a;
                let share = (flat - a).dot(way) / way.length_squared();
                flat.distance(a + way * if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) })
            };
            let off = self.steps().map(off).fold(f64::INFINITY, f64::min);
            if off > worst.0 {
                worst = (off, place);
            }
        }
        let (off, place) = worst;
        let most = MOST_OFF * size;
        if off > most {
            return Err(PanelizeError::NotRound { axis: NAMES[self.axis], off, most, place });
        }
        Ok(())
    }

    /// The distance of a place from the axis, and its height.
    pub(super) fn flatten(&self, place: DVec3) -> DVec2 {
        let [along, first, second] = frame(self.axis);
        let way = place - self.origin;
        DVec2::new(way.dot(first).hypot(way.dot(second)), way.dot(along))
    }

    /// The point of the curve at a share of its length, from 0 to 1.
    pub(super) fn at(&self, share: f64) -> DVec2 {
        let count = if self.is_loop { POINTS } else { POINTS - 1 } as f64;
        let x = if self.is_loop { share.rem_euclid(1.0) } else { share.clamp(0.0, 1.0) } * count;
        let i = (x.floor() as usize).min(count as usize - 1);
        self.curve[i].lerp(self.curve[(i + 1) % POINTS], x - i as f64)
    }
}

/// The names of the axes.
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The axis and two directions across it, right-handed.
pub(super) fn frame(axis: usize) -> [DVec3; 3] {
    [0, 1, 2].map(|k| DVec3::AXES[(axis + k) % 3])
}

/// The axis about which normals turn: n · (e × (p − c)) = 0 for all places p with their normals n,
/// by least squares for c. Where that does not settle it, the surface is flat, and its middle is
/// taken.
fn place_of_axis(given: &Triangles, axis: usize) -> DVec3 {
    let [along, first, second] = frame(axis);
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    let (mut middle, mut total) = (DVec3::ZERO, 0.0);
    for t in &given.corners {
        let [a, b, c] = t.map(|i| given.points[i]);
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        if area == 0.0 {
            continue;
        }
        let (normal, centre) = (normal / area, (a + b + c) / 3.0);
        let turned = normal.cross(along);
        let row = DVec2::new(turned.dot(first), turned.dot(second));
        let wanted = normal.dot(along.cross(centre));
        xx += area * row.x * row.x;
        xy += area * row.x * row.y;
        yy += area * row.y * row.y;
        right += row * (area * wanted);
        middle += centre * area;
        total += area;
    }
    middle /= total;
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-8 * total * total {
        return middle;
    }
    let x = (right.x * yy - right.y * xy) / determinant;
    let y = (right.y * xx - right.x * xy) / determinant;
    along * middle.dot(along) + first * x + second * y
}

/// What a half plane that ends on the axis cuts out of a surface.
fn sections(given: &Triangles, axis: usize, origin: DVec3, angle: f64) -> Vec<Section> {
    let [along, first, second] = frame(axis);
    let out = first * angle.cos() + second * angle.sin();
    let across = along.cross(out);
    let side = |i: usize| (given.points[i] - origin).dot(across);
    let mut near: BTreeMap<[usize; 2], Vec<[usize; 2]>> = BTreeMap::new();
    for t in &given.corners {
        let cut = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
            .into_iter()
            .filter(|&[a, b]| (side(a) >= 0.0) != (side(b) >= 0.0))
            .map(|[a, b]| edge(a, b));
        if let [from, to] = cut.collect::<Vec<_>>()[..] {
            near.entry(from).or_default().push(to);
            near.entry(to).or_default().push(from);
        }
    }
    let place = |e: &[usize; 2]| {
        let [a, b] = e.map(|i| given.points[i] - origin);
        let (s, t) = (side(e[0]), side(e[1]));
        let place = a.lerp(b, s / (s - t));
        DVec2::new(place.dot(out), place.dot(along))
    };
    let chains = chains(&near);
    chains
        .into_iter()
        .flat_map(|(keys, is_loop)| outer_parts(keys.iter().map(place).collect(), is_loop))
        .collect()
}

/// Lines through keys that are neighbours, and whether each is a loop.
fn chains(near: &BTreeMap<[usize; 2], Vec<[usize; 2]>>) -> Vec<(Vec<[usize; 2]>, bool)> {
    let mut seen = std::collections::BTreeSet::new();
    let ends = near.iter().filter(|(_, others)| others.len() == 1);
    let mut found = Vec::new();
    for (&start, _) in ends.chain(near.iter()) {
        if seen.contains(&start) {
            continue;
        }
        let mut chain = vec![start];
        seen.insert(start);
        let mut at = start;
        while let Some(&next) = near[&at].iter().find(|key| !seen.contains(*key)) {
            seen.insert(next);
            chain.push(next);
            at = next;
        }
        let is_loop = chain.len() > 2 && near[&at].contains(&start);
        found.push((chain, is_loop));
    }
    found
}

/// The parts of a line on the side where the first coordinate is positive.
fn outer_parts(mut line: Vec<DVec2>, is_loop: bool) -> Vec<Section> {
    // Rounding puts points near the axis on either side of it.
    let reach = line.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    let is_out = |p: &DVec2| p.x > AXIS * reach;
    if line.iter().all(is_out) {
        return vec![Section { points: line, is_loop, is_pole: [false; 2] }];
    }
    if is_loop {
        let start = line.iter().position(|p| !is_out(p)).unwrap_or(0);
        line.rotate_left(start);
        line.push(line[0]);
    }
    let mut parts = Vec::new();
    let mut open: Option<Section> = None;
    let on_axis = |a: DVec2, b: DVec2| DVec2::new(0.0, a.lerp(b, a.x / (a.x - b.x)).y);
    for (i, &p) in line.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| line[i]);
        if is_out(&p) {
            let section = open.get_or_insert_with(|| {
                let pole = before.map(|b| on_axis(b, p));
                let is_pole = [pole.is_some(), false];
                Section { points: pole.into_iter().collect(), is_loop: false, is_pole }
            });
            section.points.push(p);
        } else if let (Some(mut section), Some(before)) = (open.take(), before) {
            section.points.push(on_axis(before, p));
            section.is_pole[1] = true;
            parts.push(section);
        }
    }
    parts.extend(open);
    parts
}

impl Section {
    /// The same line run through as another one is.
    fn lined_up(&self, other: &Self) -> Vec<DVec2> {
        let mut points = self.points.clone();
        if self.is_loop {
            let area = |points: &[DVec2]| -> f64 {
                let next = |i: usize| points[(i + 1) % points.len()];
                (0..points.len()).map(|i| points[i].perp_dot(next(i))).sum()
            };
            if area(&points) < 0.0 {
                points.reverse();
            }
            // The outermost point is where a loop begins.
            let outermost = (0..points.len()).max_by(|&a, &b| points[a].x.total_cmp(&points[b].x));
            points.rotate_left(outermost.unwrap_or(0));
            points.push(points[0]);
            return points;
        }
        let ends = |points: &[DVec2]| [points[0], points[points.len() - 1]];
        let ([a, b], [c, d]) = (ends(&points), ends(&other.points));
        if a.distance(d) + b.distance(c) < a.distance(c) + b.distance(d) {
            points.reverse();
        }
        points
    }
}

/// Points evenly along a line; of a line that ends where it begins, the last is left out.
fn resampled(line: &[DVec2]) -> Vec<DVec2> {
    let mut lengths = vec![0.0];
    for pair in line.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = lengths[lengths.len() - 1];
    let is_loop = line.first() == line.last();
    let steps = if is_loop { POINTS } else { POINTS - 1 } as f64;
    let mut i = 0;
    (0..POINTS)
        .map(|k| {
            let wanted = total * k as f64 / steps;
            while i + 2 < lengths.len() && lengths[i + 1] < wanted {
                i += 1;
            }
            let step = lengths[i + 1] - lengths[i];
            let share =
                if step > 0.0 { ((wanted - lengths[i]) / step).clamp(0.0, 1.0) } else { 0.0 };
            line[i].lerp(line[i + 1], share)
        })
        .collect()
}
