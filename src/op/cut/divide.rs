//! Divides a face along the slicing plane, so that every part lies on one side.
//!
//! The edges that cross the plane are divided first, so that a face has corners of three kinds
//! only: in front, on the plane, behind. Then chords are inserted between corners on the plane.
//! Where they go is read off the face: along the line in which face and plane meet, two corners
//! that follow each other are joined when the face lies between them. Whether it does is decided
//! from signs alone ([`Sector`]). Should the signs contradict each other, as they may when rounding
//! or a face that is not planar stands behind them, parts that still lie on both sides are divided
//! by the rule that never fails: the corners before and after a run in front are joined. So any
//! pattern of signs leads to a sound mesh.

use glam::DVec3;

use super::cutter::{Cutter, SlicingPlane};
use crate::geom::Side;
use crate::mesh::{FaceId, HalfEdgeId, VertexId};

/// A corner on the plane: the half-edge that leaves it in its face, its place along the line, and
/// on which sides along the line the face begins.
#[derive(Debug, Clone)]
struct OnCorner {
    corners: Vec<HalfEdgeId>,
    place: f64,
    is_inside_before: bool,
    is_inside_after: bool,
}

/// Where a run of corners in front of the plane ends.
#[derive(Debug, Clone, Copy)]
enum RunEnd {
    /// At a corner on the plane, given by the half-edge that leaves it.
    At(HalfEdgeId),
    /// Within an edge.
    Crossing(HalfEdgeId),
}

/// The four directions around a corner on the plane, counter-clockwise seen from outside the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    Ahead = 0,
    Front = 1,
    Back = 2,
    Behind = 3,
}

/// The interior angle of a face at a corner, from the leaving to the arriving edge, in terms of
/// [`Direction`].
#[derive(Debug, Clone, Copy)]
struct Sector {
    from: Direction,
    to: Direction,
    is_reflex: bool,
}

impl Sector {
    /// Whether the direction lies strictly inside the sector.
    fn holds(self, direction: Direction) -> bool {
        let turn = |d: Direction| (4 + d as u8 - self.from as u8) % 4;
        match turn(self.to) {
            0 => self.is_reflex && direction != self.from,
            end => (1..end).contains(&turn(direction)),
        }
    }
}

impl Cutter {
    /// Divides the face of `h`, which left `v` in front before edges were split, along the plane if
    /// it lies on both sides. Where the face is known to be convex only the corners in front are
    /// visited: a local cut near a corner of a large face stays local.
    pub(super) fn divide_face_at(&mut self, plane: &SlicingPlane, v: VertexId, h: HalfEdgeId) {
        let f = self.mesh.face(h);
        // The division of a neighbour may have split the edge of `h`, whose far half it is then.
        let h = if self.mesh.origin(h) == v { h } else { self.mesh.prev(h) };
        let is_near = plane.given.is_none() && self.mesh.origin(h) == v && self.is_convex(f);
        match if is_near { self.ends_of_run(plane, h) } else { None } {
            Some(ends) => {
                self.ensure_plane(f);
                let [after, before] = ends.map(|end| self.corner_at(plane, end));
                self.insert_chord(after, before);
            }
            None => self.divide_face(plane, f),
        }
    }

    /// Where the run of corners in front that begins with `h` ends in its face, forwards and
    /// backwards. `None` unless a corner behind the plane follows on both sides.
    fn ends_of_run(&mut self, plane: &SlicingPlane, h: HalfEdgeId) -> Option<[RunEnd; 2]> {
        let mut last = h;
        let after = loop {
            let out = self.mesh.next(last);
            match self.side(plane, self.mesh.target(last)) {
                Side::Reverse => break RunEnd::Crossing(last),
                Side::Normal if out != h => last = out,
                Side::On if self.side(plane, self.mesh.target(out)) == Side::Reverse => {
                    break RunEnd::At(out);
                }
                _ => return None,
            }
        };
        let mut first = h;
        let before = loop {
            let into = self.mesh.prev(first);
            match self.side(plane, self.mesh.origin(into)) {
                Side::Reverse => break RunEnd::Crossing(into),
                Side::Normal if into != h => first = into,
                Side::On
                    if self.side(plane, self.mesh.origin(self.mesh.prev(into)))
                        == Side::Reverse =>
                {
                    break RunEnd::At(into);
                }
                _ => return None,
            }
        };
        Some([after, before])
    }

    /// The corner on the plane at the end of a run, made when it is not there yet.
    fn corner_at(&mut self, plane: &SlicingPlane, end: RunEnd) -> HalfEdgeId {
        match end {
            RunEnd::At(corner) => corner,
            RunEnd::Crossing(h) => {
                self.ensure_plane(self.mesh.face(h.twin()));
                let corner = self.split_at_plane(plane, h);
                if self.mesh.origin(h) == corner { h } else { self.mesh.next(h) }
            }
        }
    }

    /// Divides `f` along the plane if it lies on both sides.
    pub(super) fn divide_face(&mut self, plane: &SlicingPlane, f: FaceId) {
        if !self.lies_on_both_sides(plane, f) {
            return;
        }
        self.split_crossing_edges(plane, f);
        let walk: Vec<HalfEdgeId> = self.mesh.face_half_edges(f).collect();
        let sides: Vec<Side> = walk.iter().map(|&h| self.known_side(self.mesh.origin(h))).collect();
        match single_chord(&sides) {
            Some((from, to)) => {
                self.insert_chord(walk[from], walk[to]);
            }
            None => self.divide_by_line(plane, f, &walk, &sides),
        }
    }

    fn lies_on_both_sides(&mut self, plane: &SlicingPlane, f: FaceId) -> bool {
        let (mut is_front, mut is_behind) = (false, false);
        let start = self.mesh.face_start(f);
        let mut next = start;
        while let Some(h) = next {
            match self.side(plane, self.mesh.origin(h)) {
                Side::Normal => is_front = true,
                Side::Reverse => is_behind = true,
                Side::On => {}
            }
            next = Some(self.mesh.next(h)).filter(|&n| Some(n) != start);
        }
        is_front && is_behind
    }

    fn split_crossing_edges(&mut self, plane: &SlicingPlane, f: FaceId) {
        let crossing: Vec<HalfEdgeId> =
            self.mesh.face_half_edges(f).filter(|&h| self.crosses(h)).collect();
        self.ensure_plane(f);
        for h in crossing {
            // An edge with this face on both sides comes twice; the first time divided it.
            if !self.crosses(h) {
                continue;
            }
            let other = self.mesh.face(h.twin());
            self.ensure_plane(other);
            self.split_at_plane(plane, h);
        }
    }

    fn crosses(&self, h: HalfEdgeId) -> bool {
        let ends = [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.known_side(v));
        matches!(ends, [Side::Normal, Side::Reverse] | [Side::Reverse, Side::Normal])
    }

    fn divide_by_line(
        &mut self,
        plane: &SlicingPlane,
        f: FaceId,
        walk: &[HalfEdgeId],
        sides: &[Side],
    ) {
        let mut parts = vec![f];
        if let Some(mut on) = self.corners_along_line(plane, f, walk, sides) {
            for i in 1..on.len() {
                if on[i - 1].is_inside_after && on[i].is_inside_before {
                    self.join_neighbours(&mut on, i, &mut parts);
                }
            }
        }
        for part in parts {
            self.divide_by_runs(part);
        }
    }

    /// The corners on the plane in their order along the line of face and plane; `None` when there
    /// is no such line or the signs contradict each other.
    fn corners_along_line(
        &mut self,
        plane: &SlicingPlane,
        f: FaceId,
        walk: &[HalfEdgeId],
        sides: &[Side],
    ) -> Option<Vec<OnCorner>> {
        let normal = self.mesh.plane(f)?.normal();
        let front =
            (plane.plane.normal() - normal * plane.plane.normal().dot(normal)).try_normalize()?;
        let ahead = front.cross(normal);
        let origin = self.mesh.position(self.mesh.origin(walk[0]));
        let n = walk.len();
        let place =
            |c: &Self, i: usize| ahead.dot(c.mesh.position(c.mesh.origin(walk[i % n])) - origin);
        let mut on = Vec::new();
        for i in (0..n).filter(|&i| sides[i] == Side::On) {
            let direction = |j: usize| match sides[j % n] {
                Side::Normal => Direction::Front,
                Side::Reverse => Direction::Behind,
                Side::On if place(self, j) > place(self, i) => Direction::Ahead,
                Side::On => Direction::Back,
            };
            let (from, to) = (direction(i + 1), direction(i + n - 1));
            let is_reflex = from == to && self.is_reflex(walk[i], normal);
            let sector = Sector { from, to, is_reflex };
            on.push(OnCorner {
                corners: vec![walk[i]],
                place: place(self, i),
                is_inside_before: sector.holds(Direction::Back),
                is_inside_after: sector.holds(Direction::Ahead),
            });
        }
        // Where a face touches itself in a point, what ends there comes before what begins.
        on.sort_by(|a, b| {
            a.place.total_cmp(&b.place).then(b.is_inside_before.cmp(&a.is_inside_before))
        });
        let agree = on.windows(2).all(|w| w[0].is_inside_after == w[1].is_inside_before);
        let ends_outside = !on.first()?.is_inside_before && !on.last()?.is_inside_after;
        (agree && ends_outside).then_some(on)
    }

    fn is_reflex(&self, h: HalfEdgeId, normal: DVec3) -> bool {
        let at = |v: VertexId| self.mesh.position(v);
        let here = at(self.mesh.origin(h));
        let (next, before) = (at(self.mesh.target(h)), at(self.mesh.origin(self.mesh.prev(h))));
        normal.dot((next - here).cross(before - here)) < 0.0
    }

    /// Joins the corners `i − 1` and `i` along the line, in whatever part of the face both lie.
    fn join_neighbours(&mut self, on: &mut [OnCorner], i: usize, parts: &mut Vec<FaceId>) {
        let in_one_part =
            on[i - 1].corners.iter().flat_map(|&a| on[i].corners.iter().map(move |&b| (a, b)));
        let pair = in_one_part
            .into_iter()
            .find(|&(a, b)| a != b && self.mesh.face(a) == self.mesh.face(b));
        if let Some((a, b)) = pair {
            let chord = self.insert_chord(a, b);
            parts.push(self.mesh.face(chord));
            on[i - 1].corners.push(chord);
            on[i].corners.push(chord.twin());
        }
    }

    /// Divides a part that still lies on both sides: each run of corners in front is cut off by the
    /// chord between the corners on the plane before and after it.
    fn divide_by_runs(&mut self, part: FaceId) {
        loop {
            let walk: Vec<HalfEdgeId> = self.mesh.face_half_edges(part).collect();
            let sides: Vec<Side> =
                walk.iter().map(|&h| self.known_side(self.mesh.origin(h))).collect();
            let both = sides.contains(&Side::Normal) && sides.contains(&Side::Reverse);
            let Some((after, before)) = first_run(&sides).filter(|_| both) else { return };
            self.insert_chord(walk[after], walk[before]);
        }
    }
}

/// The only chord of a face with one run in front and one behind, divided by single corners: (first
/// corner after the run in front, last corner before it).
fn single_chord(sides: &[Side]) -> Option<(usize, usize)> {
    let on = sides.iter().filter(|&&s| s == Side::On).count();
    if on == 2 { first_run(sides) } else { None }
}

/// The corners on the plane after and before the first run in front; `None` without a run or
/// without such corners.
fn first_run(sides: &[Side]) -> Option<(usize, usize)> {
    let n = sides.len();
    let start =
        (0..n).find(|&i| sides[i] == Side::Normal && sides[(i + n - 1) % n] != Side::Normal)?;
    let length = (1..n).find(|&k| sides[(start + k) % n] != Side::Normal)?;
    Some(((start + length) % n, (start + n - 1) % n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sector_holds_what_lies_strictly_between_its_edges() {
        let sector = |from, to, is_reflex| Sector { from, to, is_reflex };
        use Direction::{Ahead, Back, Behind, Front};
        let crossing = sector(Front, Behind, false);
        assert!(crossing.holds(Back) && !crossing.holds(Ahead) && !crossing.holds(Front));
        let other_way = sector(Behind, Front, false);
        assert!(other_way.holds(Ahead) && !other_way.holds(Back));
        let spike = sector(Front, Front, false);
        assert!(!spike.holds(Ahead) && !spike.holds(Back));
        let notch = sector(Front, Front, true);
        assert!(notch.holds(Ahead) && notch.holds(Back) && notch.holds(Behind));
        let along = sector(Ahead, Behind, false);
        assert!(along.holds(Back) && along.holds(Front) && !along.holds(Ahead));
    }

    #[test]
    fn the_first_run_may_wrap_around() {
        use Side::{Normal as N, On as O, Reverse as R};
        assert_eq!(first_run(&[N, O, R, O, N]), Some((1, 3)));
        assert_eq!(first_run(&[O, N, O, R]), Some((2, 0)));
        assert_eq!(first_run(&[R, R]), None);
        assert_eq!(first_run(&[N, N]), None);
        assert_eq!(single_chord(&[O, N, O, R]), Some((2, 0)));
        assert_eq!(single_chord(&[O, O, N, O, R]), None);
    }
}
