//! Mirror symmetry: a surface is cut at its mirror planes, one part of it laid out, and panels that
//! lie across a plane are joined from their halves. All corners follow those of the one part, so
//! panels come in pairs to the last digit.
//!
//! Where two panels meet at a mirror plane without one of them lying across it, four would meet
//! there. Such places are faults of a layout: one of the panels is moved onto the plane.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use super::PanelizeError;
use super::curvature::{Quadric, first_quadrics};
use super::refine::{Triangles, edge};
use super::regions::{Kind, Panels};
use super::solve::Symmetry;
use super::surface::{NONE, SPACING, Surface};
use crate::geom::{AxisBox, BoxTree, nearest_on_triangle};

/// A surface is mirror symmetric when no place of its image is farther from it, in panel sizes.
const MOST_OFF: f64 = 0.05;
/// Vertices of the file this near to a mirror plane are moved onto it, in panel sizes.
const SNAP: f64 = SPACING / 50.0;
const NAMES: [&str; 3] = ["x", "y", "z"];

/// A surface in parts that are images of each other.
pub(super) struct Mirror {
    /// The part that is laid out.
    pub part: Surface,
    /// Ways to the other parts: a bit for each axis along which they are mirrored. The first is 0.
    ways: Vec<u8>,
    /// For each way the image of each vertex of the part in the whole surface.
    images: BTreeMap<u8, Vec<usize>>,
}

/// What is wrong with a layout of the part, by its panels.
#[derive(Debug, Default)]
pub(super) struct Faults {
    /// Panels beside a mirror plane that should lie across it, and the axis.
    pub beside: Vec<(usize, usize)>,
    /// Panels that make none with their images.
    pub bad: Vec<usize>,
}

/// Signs of the coordinates under a way.
fn signs(way: u8) -> DVec3 {
    let sign = |axis: u8| if way >> axis & 1 == 1 { -1.0 } else { 1.0 };
    DVec3::new(sign(0), sign(1), sign(2))
}

/// That a surface is its own image across planes through a place, square to some axes.
///
/// # Errors
/// [`PanelizeError::NotMirrored`] with the place that is farthest off.
pub(super) fn check_mirrored(
    given: &Triangles,
    axes: &[usize],
    (size, origin): (f64, DVec3),
) -> Result<(), PanelizeError> {
    let corners: Vec<[DVec3; 3]> =
        given.corners.iter().map(|t| t.map(|v| given.points[v])).collect();
    let boxes: Vec<AxisBox> = corners.iter().filter_map(|t| AxisBox::of(*t)).collect();
    let tree = BoxTree::new(&boxes);
    for &axis in axes {
        let mut worst = (0.0, DVec3::ZERO);
        for &p in &given.points {
            let mut image = p;
            image[axis] = 2.0 * origin[axis] - p[axis];
            let off = |i: usize| nearest_on_triangle(image, corners[i]).distance(image);
            let found = tree.nearest(image, off).map_or(0.0, |(_, off)| off);
            if found > worst.0 {
                worst = (found, p);
            }
        }
        if worst.0 > MOST_OFF * size {
            let (axis, at, most) = (NAMES[axis], origin[axis], MOST_OFF * size);
            return Err(PanelizeError::NotMirrored {
                axis,
                at,
                off: worst.0,
                most,
                place: worst.1,
            });
        }
    }
    Ok(())
}

impl Triangles {
    /// The part on the positive side of planes through the origin, square to some axes.
    pub(super) fn one_side(mut self, axes: &[usize]) -> Self {
        for &axis in axes {
            self = self.cut_at(axis);
        }
        self
    }

    fn cut_at(mut self, axis: usize) -> Self {
        for p in self.points.iter_mut().filter(|p| p[axis].abs() < SNAP) {
            p[axis] = 0.0;
        }
        let mut met: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut made = Vec::new();
        for t in &self.corners {
            let mut kept = Vec::new();
            for i in 0..3 {
                let (u, v) = (t[i], t[(i + 1) % 3]);
                let (a, b) = (self.points[u], self.points[v]);
                if a[axis] >= 0.0 {
                    kept.push(u);
                }
                if a[axis] * b[axis] < 0.0 {
                    let points = &mut self.points;
                    kept.push(*met.entry(edge(u, v)).or_insert_with(|| {
                        let [a, b] = edge(u, v).map(|v| points[v]);
                        let mut p = a.lerp(b, a[axis] / (a[axis] - b[axis]));
                        p[axis] = 0.0;
                        points.push(p);
                        points.len() - 1
                    }));
                }
            }
            // What only touches the plane is none of this side.
            let is_inside = kept.iter().any(|&v| self.points[v][axis] > 0.0);
            if kept.len() >= 3 && is_inside {
                made.extend((1..kept.len() - 1).map(|i| [kept[0], kept[i], kept[i + 1]]));
            }
        }
        self.corners = made;
        self
    }
}

impl Mirror {
    /// The whole surface of a part on the positive side of planes through the origin, square to some
    /// axes. The first vertices are those of the part.
    pub(super) fn whole(mut part: Surface, axes: &[usize]) -> (Surface, Self) {
        let all = axes.iter().fold(0_u8, |all, &axis| all | 1 << axis);
        let mask = |p: DVec3| {
            let on = |&&axis: &&usize| p[axis] == 0.0;
            axes.iter().filter(on).fold(0_u8, |mask, &axis| mask | 1 << axis)
        };
        part.masks = part.points.iter().map(|&p| mask(p)).collect();
        // The rim of the whole begins at such vertices, however it runs.
        let begins = |&v: &usize| {
            let beside = [part.rim_before[v], part.rim_next[v]];
            part.masks[v] != 0
                && part.is_rim(v)
                && beside.iter().any(|&u| part.masks[u] & part.masks[v] == 0)
        };
        let begin: Vec<usize> = (0..part.points.len()).filter(begins).collect();
        begin.into_iter().for_each(|v| part.is_corner[v] = true);
        let ways: Vec<u8> = (0..8).filter(|way| way & !all == 0).collect();
        let mut points = part.points.clone();
        let mut images: BTreeMap<u8, Vec<usize>> = BTreeMap::new();
        images.insert(0, (0..points.len()).collect());
        let mut corners = part.triangles.clone();
        for &way in &ways[1..] {
            let image = |(v, &p): (usize, &DVec3)| match way & !part.masks[v] {
                own if own == way => {
                    points.push(p * signs(way));
                    points.len() - 1
                }
                // On a plane the image is that of a shorter way.
                own => images[&own][v],
            };
            let image: Vec<usize> = part.points.iter().enumerate().map(image).collect();
            corners.extend(part.triangles.iter().map(|t| {
                let [a, b, c] = t.map(|v| image[v]);
                if way.count_ones() % 2 == 1 { [a, c, b] } else { [a, b, c] }
            }));
            images.insert(way, image);
        }
        let whole = Surface::new(Triangles { points, corners, ..Triangles::default() });
        (whole, Self { part, ways, images })
    }

    /// The quadrics of the whole surface, those of images being images.
    pub(super) fn quadrics(&self, whole: &Surface) -> Vec<Quadric> {
        let own = first_quadrics(whole, self.part.points.len());
        let mut made = own.clone();
        for &way in &self.ways[1..] {
            let sign = signs(way);
            let turn = if way.count_ones() % 2 == 1 { -1.0 } else { 1.0 };
            for (v, quadric) in own.iter().enumerate() {
                if way & !self.part.masks[v] != way {
                    continue;
                }
                // The frame stays right-handed, so one axis is turned about.
                let axes = [quadric.axes[0] * sign, quadric.axes[1] * sign * turn];
                let mut bend = quadric.bend;
                bend.x_axis.y *= turn;
                bend.y_axis.x *= turn;
                let (origin, normal) = (quadric.origin * sign, quadric.normal * sign);
                made.push(Quadric { origin, normal, axes, bend });
            }
        }
        made
    }

    /// The panels of the whole surface, those of the part first, and which corners are images.
    ///
    /// # Errors
    /// What is wrong with the panels of the part.
    pub(super) fn panels(
        &self,
        half: &Panels,
        whole: &Surface,
    ) -> Result<(Panels, Symmetry), Faults> {
        let mut made = self.corners(half);
        let own = |f: usize| self.part.masks[half.sites[f]];
        let (mut faults, mut firsts) = (Faults::default(), Vec::new());
        let mut owners = Vec::new();
        for &way in &self.ways {
            for f in (0..half.faces.len()).filter(|&f| way & own(f) == 0) {
                match self.joined(half, f, way, &made.numbers) {
                    Some(face) => made.panels.faces.push(face),
                    None => faults.bad.push(f),
                }
                made.panels.sites.push(self.images[&way][half.sites[f]]);
                firsts.push(way == 0);
                owners.push(f);
            }
        }
        if faults.bad.is_empty() {
            self.tidy(half, whole, &mut made, &mut faults);
            let too_few = |(_, face): &(usize, &Vec<usize>)| {
                let is_inner = face.iter().all(|&v| made.panels.kinds[v] == Kind::Inner);
                face.len() < if is_inner { 4 } else { 3 }
            };
            let faces = made.panels.faces.iter().enumerate();
            faults.bad.extend(faces.filter(too_few).map(|(f, _)| owners[f]));
            faults.bad.extend(made.panels.share_two_edges().into_iter().map(|f| owners[f]));
        }
        faults.bad.sort_unstable();
        faults.bad.dedup();
        if !faults.bad.is_empty() || !faults.beside.is_empty() {
            return Err(faults);
        }
        let Made { panels, first, image, .. } = made;
        Ok((panels, Symmetry { first, image, is_first_face: firsts }))
    }

    /// All images of the corners of the part.
    fn corners(&self, half: &Panels) -> Made {
        let mut made = Made::default();
        for &way in &self.ways {
            for (v, &mask) in half.mirrors.iter().enumerate() {
                if way & mask != 0 {
                    continue;
                }
                made.numbers.insert((v, way), made.panels.points.len());
                // A corner on a mirror plane stays in it.
                let on = |axis: u8| if mask >> axis & 1 == 1 { 0.0 } else { 1.0 };
                let image = signs(way) * DVec3::new(on(0), on(1), on(2));
                made.first.push(v);
                made.image.push(DMat3::from_diagonal(image));
                made.panels.points.push(image * half.points[v]);
                made.panels.kinds.push(half.kinds[v]);
                made.panels.hints.push(self.images[&way][half.hints[v]]);
            }
        }
        made
    }

    /// The image of a panel: joined with those across the planes that it lies on. `None` when the
    /// outline is not one loop.
    fn joined(
        &self,
        half: &Panels,
        f: usize,
        way: u8,
        numbers: &BTreeMap<(usize, u8), usize>,
    ) -> Option<Vec<usize>> {
        let own = self.part.masks[half.sites[f]];
        let face = &half.faces[f];
        let mut next: BTreeMap<usize, usize> = BTreeMap::new();
        for &by in self.ways.iter().filter(|&&by| by & !own == 0) {
            let by = way ^ by;
            let id = |v: usize| numbers[&(v, by & !half.mirrors[v])];
            for i in 0..face.len() {
                let (mut a, mut b) = (id(face[i]), id(face[(i + 1) % face.len()]));
                if by.count_ones() % 2 == 1 {
                    std::mem::swap(&mut a, &mut b);
                }
                // Sides along a plane that it lies across meet their images and vanish.
                if next.get(&b) == Some(&a) {
                    next.remove(&b);
                } else if next.insert(a, b).is_some() {
                    return None;
                }
            }
        }
        let start = *next.keys().next()?;
        let (mut outline, mut at) = (vec![start], *next.get(&start)?);
        while at != start {
            outline.push(at);
            at = *next.get(&at)?;
            if outline.len() > next.len() {
                return None;
            }
        }
        (outline.len() == next.len()).then_some(outline)
    }

    /// Leaves out corners on mirror planes at which no three panels meet, and finds those at which
    /// four would.
    fn tidy(&self, half: &Panels, whole: &Surface, made: &mut Made, faults: &mut Faults) {
        let fans = made.panels.fans();
        let mut left_out = vec![false; fans.len()];
        for (v, fan) in fans.iter().enumerate() {
            let mask = half.mirrors[made.first[v]];
            if mask == 0 {
                continue;
            }
            let hint = made.panels.hints[v];
            // In the middle of an edge of the part's rim a corner is none of the whole's.
            let is_outer = whole.is_rim(hint) && half.kinds[made.first[v]] == Kind::Corner;
            let least = if is_outer { 2 } else { 3 };
            let turns = is_outer && whole.is_corner[hint];
            left_out[v] = fan.len() < least && !turns;
            made.panels.kinds[v] = match (is_outer, turns) {
                (false, _) => Kind::Inner,
                (true, false) => Kind::Rim,
                (true, true) => Kind::Corner,
            };
            // The corners of the part itself come first.
            if fan.len() > 3 && v == made.first[v] {
                self.beside(half, made.first[v], mask, faults);
            }
        }
        for face in &mut made.panels.faces {
            face.retain(|&v| !left_out[v]);
        }
    }

    /// Of the panels at a corner on a plane the one that is nearest to it.
    fn beside(&self, half: &Panels, corner: usize, mask: u8, faults: &mut Faults) {
        let axis = mask.trailing_zeros() as usize;
        let off = |f: usize| self.part.points[half.sites[f]][axis];
        let here = (0..half.faces.len()).filter(|&f| half.faces[f].contains(&corner));
        let nearest = here.min_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)));
        if let Some(f) = nearest.filter(|f| faults.beside.iter().all(|(g, _)| g != f)) {
            faults.beside.push((f, axis));
        }
    }
}

/// The panels of the whole on their way.
#[derive(Default)]
struct Made {
    panels: Panels,
    first: Vec<usize>,
    image: Vec<DMat3>,
    /// The number of the image of each corner of the part by each way that moves it.
    numbers: BTreeMap<(usize, u8), usize>,
}

/// What was reached: panels that are images of others, by their corners alone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Paired {
    /// Pairs of panels that are images of each other.
    pub pairs: usize,
    /// Panels that are images of themselves.
    pub across: usize,
    /// The first panel that is neither, and how many there are.
    pub alone: usize,
    pub first_alone: usize,
}

/// Pairs the panels across the plane through the origin that is square to an axis. Corners count as
/// images within `tolerance`.
pub(super) fn paired(panels: &Panels, axis: usize, tolerance: f64) -> Paired {
    let mut grid = crate::geom::Grid::new([0.0; 3], 0.1);
    panels.points.iter().for_each(|p| _ = grid.insert(p.to_array()));
    let mut used = vec![false; panels.points.len()];
    panels.faces.iter().flatten().for_each(|&v| used[v] = true);
    let image = |v: usize| {
        let mut p = panels.points[v];
        p[axis] = -p[axis];
        let near = grid.around(p.to_array()).map(|k| k as usize).filter(|&u| used[u]);
        let off = |u: usize| panels.points[u].distance(p);
        let nearest = near.min_by(|&a, &b| off(a).total_cmp(&off(b)));
        nearest.filter(|&u| off(u) <= tolerance).unwrap_or(NONE)
    };
    let images: Vec<usize> =
        (0..used.len()).map(|v| if used[v] { image(v) } else { NONE }).collect();
    let key = |face: &Vec<usize>| {
        let mut own = face.clone();
        own.sort_unstable();
        own
    };
    let faces: BTreeMap<Vec<usize>, usize> =
        panels.faces.iter().enumerate().map(|(f, face)| (key(face), f)).collect();
    let mut found = Paired { first_alone: NONE, ..Paired::default() };
    for (f, face) in panels.faces.iter().enumerate() {
        let other = faces.get(&key(&face.iter().map(|&v| images[v]).collect()));
        match other {
            Some(&g) if g == f => found.across += 1,
            Some(&g) => found.pairs += usize::from(f < g),
            None => {
                found.alone += 1;
                found.first_alone = found.first_alone.min(f);
            }
        }
    }
    found
}
