//! Rims cut into chords that are equal on both sides of every seam.
//!
//! A seam is divided at the corners of both its sides and between them into equal arc lengths. The
//! chords of a curve are shorter than its arcs, and differently so on the two sides, so polygons
//! are made whose sides are the *arcs*: each keeps the turns of the chords, all changed by nearly
//! the same tiny part so that the polygon closes. So straight parts stay straight, hollow ones
//! hollow, round ones round, outlines that are polygons stay what they are, and the sum of turns
//! across the seam keeps its sign.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::closing::with_sides;
use super::seams::{EQUAL, Gluing, Seam, Span};
use super::triangle::{STRAIGHT, turn};
use super::{GluingError, Outline};

/// The fewest and the most chords of a rim.
pub const POINTS_LIMIT: [usize; 2] = [12, 4000];
/// A point with so little missing to 360°, in radians, is flat.
pub(super) const FLAT: f64 = 1e-9;

/// Pieces as polygons, joined side by side.
#[derive(Debug, Clone)]
pub(super) struct Rims {
    pub pieces: Vec<RimPolygon>,
    /// Number of points of the surface.
    pub vertices: usize,
}

/// A piece as a polygon.
#[derive(Debug, Clone)]
pub(super) struct RimPolygon {
    pub name: String,
    /// Corners, counter-clockwise.
    pub points: Vec<DVec2>,
    /// Corner → point of the surface.
    pub vertex: Vec<usize>,
    /// Corner → its place along the rim of the outline, in mm.
    pub place: Vec<f64>,
    /// Side (that begins at the corner) → piece and side that it is joined with.
    pub mate: Vec<(usize, usize)>,
    /// How far the corners lie from the outline at most, in mm.
    pub off: f64,
}

impl RimPolygon {
    pub fn len(&self) -> usize {
        self.points.len()
    }

    pub fn side(&self, i: usize) -> DVec2 {
        self.points[(i + 1) % self.len()] - self.points[i]
    }

    /// Interior angle at a corner, in (0, 2π).
    pub fn angle(&self, i: usize) -> f64 {
        PI - self.turn(i)
    }

    /// How far the rim turns to the left at a corner.
    pub fn turn(&self, i: usize) -> f64 {
        turn(self.side((i + self.len() - 1) % self.len()), self.side(i))
    }
}

/// A chord of a seam: where it begins and ends on both sides, measured along the seam.
struct Division {
    a: Vec<f64>,
    b: Vec<f64>,
}

pub(super) fn cut(gluing: &Gluing) -> Result<Rims, GluingError> {
    let [least, most] = POINTS_LIMIT;
    if !(least..=most).contains(&gluing.points) {
        return Err(GluingError::Points { points: gluing.points, least, most });
    }
    for seam in &gluing.seams {
        let (la, lb) = (seam.a.length(), seam.b.length());
        let whole = gluing.outlines[seam.a.piece].length();
        if (la - lb).abs() > gluing.slack.max(EQUAL) * whole {
            return Err(GluingError::Lengths {
                seam: gluing.seam_text(seam),
                a: gluing.span_text(&seam.a),
                b: gluing.span_text(&seam.b),
                a_mm: la,
                b_mm: lb,
            });
        }
    }
    let longest = gluing.outlines.iter().map(Outline::length).fold(0.0, f64::max);
    let step = longest / gluing.points as f64;
    let divisions: Vec<Division> =
        gluing.seams.iter().map(|seam| divide(gluing, seam, step)).collect();
    let mut pieces = Vec::new();
    let mut chord_sides: Vec<Vec<Vec<(usize, usize)>>> =
        divisions.iter().map(|d| vec![Vec::new(); d.a.len() - 1]).collect();
    for piece in 0..gluing.outlines.len() {
        let order = spans_in_order(gluing, piece)?;
        pieces.push(polygon(gluing, piece, &order, &divisions, &mut chord_sides)?);
    }
    for sides in chord_sides.into_iter().flatten() {
        let [a, b] = [sides[0], sides[1]];
        pieces[a.0].mate[a.1] = b;
        pieces[b.0].mate[b.1] = a;
    }
    let mut rims = Rims { pieces, vertices: 0 };
    rims.name_vertices();
    rims.check_sphere()?;
    rims.check_angles()?;
    rims.drop_straight();
    Ok(rims)
}

/// The corners of both sides, and equal parts between them.
fn divide(gluing: &Gluing, seam: &Seam, step: f64) -> Division {
    let (la, lb) = (seam.a.length(), seam.b.length());
    let [a, b] = [seam.a, seam.b].map(|span| &gluing.outlines[span.piece]);
    let mut breaks = vec![(0.0, 0.0), (la, lb)];
    let along = |outline: &Outline, from: f64| {
        let whole = outline.length();
        outline.corners().map(move |c| (c - from).rem_euclid(whole)).collect::<Vec<_>>()
    };
    breaks.extend(along(a, seam.a.from).into_iter().map(|x| (x, x * lb / la)));
    breaks.extend(along(b, seam.b.from).into_iter().map(|y| ((lb - y) * la / lb, lb - y)));
    let same = 4.0 * EQUAL * a.length();
    breaks.retain(|&(x, _)| x >= 0.0 && x <= la);
    breaks.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut kept: Vec<(f64, f64)> = vec![breaks[0]];
    for &(x, y) in &breaks[1..] {
        if x - kept[kept.len() - 1].0 > same {
            kept.push((x, y));
        }
    }
    let last = kept.len() - 1;
    if last > 0 && la - kept[last].0 <= same {
        kept[last] = (la, lb);
    } else {
        kept.push((la, lb));
    }
    let mut division = Division { a: Vec::new(), b: Vec::new() };
    // A seam of one or two chords could fold onto itself.
    let fewest = match kept.len() {
        2 => 3.0,
        3 => 2.0,
        _ => 1.0,
    };
    for pair in kept.windows(2) {
        let count = ((pair[1].0 - pair[0].0) / step).round().max(fewest) as usize;
        for k in 0..count {
            let part = k as f64 / count as f64;
            division.a.push(pair[0].0 + (pair[1].0 - pair[0].0) * part);
            division.b.push(pair[0].1 + (pair[1].1 - pair[0].1) * part);
        }
    }
    division.a.push(la);
    division.b.push(lb);
    division
}

/// The sides of seams that lie on a piece, in order around its rim: seam, and whether it is side b.
fn spans_in_order(gluing: &Gluing, piece: usize) -> Result<Vec<(usize, bool)>, GluingError> {
    let outline = &gluing.outlines[piece];
    let whole = outline.length();
    let mut spans: Vec<(f64, f64, usize, bool)> = Vec::new();
    for (i, seam) in gluing.seams.iter().enumerate() {
        for (span, is_b) in [(&seam.a, false), (&seam.b, true)] {
            if span.piece == piece {
                let from = span.from.rem_euclid(whole);
                let from = if whole - from <= EQUAL * whole { 0.0 } else { from };
                spans.push((from, from + span.length(), i, is_b));
            }
        }
    }
    spans.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let rim = |from_mm: f64, to_mm: f64, twice| GluingError::Rim {
        name: outline.name().to_owned(),
        from_mm,
        to_mm,
        whole_mm: whole,
        twice,
    };
    let Some(first) = spans.first() else { return Err(rim(0.0, whole, false)) };
    let ends = spans[1..].iter().map(|s| s.0).chain([first.0 + whole]);
    for (span, next) in spans.iter().zip(ends) {
        if (span.1 - next).abs() > 2.0 * EQUAL * whole {
            return Err(rim(span.1.min(next), span.1.max(next), span.1 > next));
        }
    }
    Ok(spans.into_iter().map(|s| (s.2, s.3)).collect())
}

/// The polygon of a piece; tells every chord which side of it it is.
fn polygon(
    gluing: &Gluing,
    piece: usize,
    order: &[(usize, bool)],
    divisions: &[Division],
    chord_sides: &mut [Vec<Vec<(usize, usize)>>],
) -> Result<RimPolygon, GluingError> {
    let outline = &gluing.outlines[piece];
    let (mut place, mut sides) = (Vec::new(), Vec::new());
    for &(seam, is_b) in order {
        let Division { a, b } = &divisions[seam];
        let chords = a.len() - 1;
        for k in 0..chords {
            let chord = if is_b { chords - 1 - k } else { k };
            let Span { from, to, .. } =
                if is_b { gluing.seams[seam].b } else { gluing.seams[seam].a };
            place.push(if is_b { to - b[chord + 1] } else { from + a[chord] });
            sides.push(((a[chord + 1] - a[chord]) + (b[chord + 1] - b[chord])) / 2.0);
            chord_sides[seam][chord].push((piece, sides.len() - 1));
        }
    }
    let on_rim: Vec<DVec2> = place.iter().map(|&s| outline.at(s)).collect();
    let bad = |fault: &str| GluingError::BadOutline {
        name: outline.name().to_owned(),
        fault: fault.to_owned(),
    };
    let points = with_sides(&on_rim, &sides).ok_or_else(|| {
        bad("its chords could not be made equal to those beside them; take more points")
    })?;
    let off = points.iter().zip(&on_rim).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    let whole = outline.length();
    Ok(RimPolygon {
        name: outline.name().to_owned(),
        vertex: vec![0; points.len()],
        mate: vec![(0, 0); points.len()],
        place: place.into_iter().map(|s| s.rem_euclid(whole)).collect(),
        points,
        off,
    })
}

impl Rims {
    /// Corners that meet are one point of the surface.
    fn name_vertices(&mut self) {
        let first: Vec<usize> = self
            .pieces
            .iter()
            .scan(0, |sum, p| Some(std::mem::replace(sum, *sum + p.len())))
            .collect();
        let total: usize = self.pieces.iter().map(RimPolygon::len).sum();
        let mut parent: Vec<usize> = (0..total).collect();
        fn root(parent: &mut [usize], mut i: usize) -> usize {
            while parent[i] != i {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            i
        }
        for (p, piece) in self.pieces.iter().enumerate() {
            for (i, &(q, j)) in piece.mate.iter().enumerate() {
                let j_end = (j + 1) % self.pieces[q].len();
                let a = root(&mut parent, first[p] + i);
                let b = root(&mut parent, first[q] + j_end);
                let (low, high) = (a.min(b), a.max(b));
                parent[high] = low;
            }
        }
        let mut number = vec![usize::MAX; total];
        let mut count = 0;
        for (p, piece) in self.pieces.iter_mut().enumerate() {
            for i in 0..piece.len() {
                let r = root(&mut parent, first[p] + i);
                if number[r] == usize::MAX {
                    number[r] = count;
                    count += 1;
                }
                piece.vertex[i] = number[r];
            }
        }
        self.vertices = count;
    }

    fn check_sphere(&self) -> Result<(), GluingError> {
        if self.pieces.is_empty() {
            return Err(GluingError::NoSphere { vertices: 0, edges: 0, pieces: 0, euler: 0 });
        }
        let mut reached = vec![false; self.pieces.len()];
        let mut stack = vec![0];
        reached[0] = true;
        while let Some(p) = stack.pop() {
            for &(q, _) in &self.pieces[p].mate {
                if !std::mem::replace(&mut reached[q], true) {
                    stack.push(q);
                }
            }
        }
        if let Some(apart) = reached.iter().position(|r| !r) {
            let name = |p: usize| self.pieces[p].name.clone();
            let with: Vec<String> = (1..reached.len()).filter(|&p| reached[p]).map(name).collect();
            let with = if with.is_empty() { "itself".to_owned() } else { with.join(", ") };
            return Err(GluingError::Apart { apart: [name(0), with, name(apart)] });
        }
        let edges = self.pieces.iter().map(RimPolygon::len).sum::<usize>() / 2;
        let (vertices, pieces) = (self.vertices, self.pieces.len());
        let euler = (vertices + pieces) as i64 - edges as i64;
        if euler == 2 {
            return Ok(());
        }
        Err(GluingError::NoSphere { vertices, edges, pieces, euler })
    }

    /// Material at each point of the surface, in radians.
    pub fn cone_angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0; self.vertices];
        for piece in &self.pieces {
            for (i, &v) in piece.vertex.iter().enumerate() {
                angles[v] += piece.angle(i);
            }
        }
        angles
    }

    fn check_angles(&self) -> Result<(), GluingError> {
        let angles = self.cone_angles();
        let count = angles.iter().filter(|&&a| a > TAU + FLAT).count();
        let worst = (0..angles.len()).max_by(|&a, &b| angles[a].total_cmp(&angles[b]));
        match worst.filter(|_| count > 0) {
            None => Ok(()),
            Some(v) => Err(GluingError::Angle {
                place: self.place_text(v),
                degrees: angles[v].to_degrees(),
                count,
                mend: None,
            }),
        }
    }

    /// A point of the surface in words.
    pub fn place_text(&self, v: usize) -> String {
        let mut places = Vec::new();
        for piece in &self.pieces {
            for (i, _) in piece.vertex.iter().enumerate().filter(|&(_, &w)| w == v) {
                let (at, p) = (piece.place[i], piece.points[i]);
                places.push(format!(
                    "{} {at:.2} mm along its rim ({:.2}, {:.2})",
                    piece.name, p.x, p.y
                ));
            }
        }
        places.join(" and ")
    }

    /// Drops points where straight rims lie side by side: no more than marks on one flat sheet.
    fn drop_straight(&mut self) {
        let mut corners = vec![0; self.vertices];
        let mut straight = vec![true; self.vertices];
        for piece in &self.pieces {
            for (i, &v) in piece.vertex.iter().enumerate() {
                corners[v] += 1;
                straight[v] &= piece.turn(i).abs() < STRAIGHT;
            }
        }
        let keep = |v: usize| !(straight[v] && corners[v] == 2);
        if (0..self.vertices).all(keep) {
            return;
        }
        let old = std::mem::take(&mut self.pieces);
        // Old corner → new one, for those that stay.
        let renamed: Vec<Vec<usize>> = old
            .iter()
            .map(|piece| {
                let mut next = 0;
                let rename = |&v: &usize| {
                    next += usize::from(keep(v));
                    next - usize::from(keep(v))
                };
                piece.vertex.iter().map(rename).collect()
            })
            .collect();
        for piece in &old {
            let n = piece.len();
            let kept: Vec<usize> = (0..n).filter(|&i| keep(piece.vertex[i])).collect();
            let mate = |k: usize| {
                let last = (kept[(k + 1) % kept.len()] + n - 1) % n;
                let (q, j) = piece.mate[last];
                (q, renamed[q][j])
            };
            self.pieces.push(RimPolygon {
                name: piece.name.clone(),
                points: kept.iter().map(|&i| piece.points[i]).collect(),
                vertex: kept.iter().map(|&i| piece.vertex[i]).collect(),
                place: kept.iter().map(|&i| piece.place[i]).collect(),
                mate: (0..kept.len()).map(mate).collect(),
                off: piece.off,
            });
        }
        self.name_vertices();
    }

    /// The shape that is covered twice, where the two sides of the seam are mirror images of one
    /// another: two equal outlines without a shift, or one zipped along its axis of symmetry.
    pub fn mirrored(&self) -> Option<Vec<DVec2>> {
        let first = &self.pieces[0];
        let n = first.len();
        let half: Vec<DVec2> = match self.pieces.len() {
            1 => {
                // Where the seam ends, a side is joined with the one before it.
                let before = |i: usize| (i + n - 1) % n;
                let ends: Vec<usize> = (0..n).filter(|&i| first.mate[i].1 == before(i)).collect();
                let [from, to] = ends.try_into().ok()?;
                first.points[from..=to].to_vec()
            }
            2 if first.mate.iter().all(|m| m.0 == 1) => first.points.clone(),
            _ => return None,
        };
        let is_mirror = |i: usize| {
            let (q, j) = first.mate[i];
            let (i, j) = ((i + 1) % n, j);
            (first.angle(i) - self.pieces[q].angle(j)).abs() <= FLAT
        };
        let m = half.len();
        let is_round = |i: usize| {
            let (a, b, c) = (half[(i + m - 1) % m], half[i], half[(i + 1) % m]);
            turn(b - a, c - b) >= -FLAT
        };
        ((0..n).all(is_mirror) && (0..m).all(is_round)).then_some(half)
    }
}
