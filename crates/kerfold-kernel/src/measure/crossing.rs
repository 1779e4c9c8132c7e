//! Faces that go through each other, anywhere in a mesh.
//!
//! Faces are looked at in pairs whose boxes meet. On the line in which the planes of two faces cut
//! each other, each face has stretches that lie inside it; where stretches of both have more than
//! rounding in common, the faces go through each other. A stretch counts only if the face lies on
//! both sides of the other's plane there, so faces that touch, or share a vertex or an edge, do
//! not. An edge that lies inside another face is looked at with both of its faces: one on each side
//! is a crossing, too. A face that is not planar is taken as the triangles that it is divided into.

use glam::{DVec2, DVec3};

use super::contact::{dropped_axis, flat};
use crate::geom::{AxisBox, BoxTree, Frame, Plane, RoundingBound, polygon, triangulate};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh};

/// Two faces that have more in common than vertices and edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct CrossingPair {
    /// The face with the lower number.
    pub first: FaceId,
    /// The other one.
    pub second: FaceId,
    /// How they meet.
    pub kind: CrossingKind,
}

/// How two faces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CrossingKind {
    /// They cut each other along a line.
    Through,
    /// They lie in one plane, and cover a piece of it both.
    Overlap,
}

/// Pairs of faces that go through each other or cover each other, ascending, at most `most` of
/// them. Points within rounding ([`RoundingBound`]) of a plane count as on it, so what only touches
/// is no crossing; nor are parts of one face.
///
/// Time is n log n besides the pairs whose boxes meet.
pub fn crossings(mesh: &Mesh, most: usize) -> Vec<CrossingPair> {
    crossings_while(mesh, most, &|| true).expect("nobody stops it")
}

/// So many pairs are compared between two questions whether to go on.
const STRIDE: usize = 1024;

/// As [`crossings`], for as long as `goes_on` says so; `None` when it was stopped.
pub fn crossings_while(
    mesh: &Mesh,
    most: usize,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<CrossingPair>> {
    let Some((low, high)) = mesh.bounds() else { return Some(Vec::new()) };
    let near = 8.0 * RoundingBound::of_box(low, high).length();
    let pieces = Piece::all(mesh, near);
    let boxes: Vec<AxisBox> = pieces.iter().map(|piece| piece.bounds).collect();
    let mut found = Found { pairs: Vec::new(), contacts: Vec::new() };
    if !goes_on() {
        return None;
    }
    let (mut turn, mut is_stopped) = (0_usize, false);
    BoxTree::new(&boxes).pairs(|i, j| {
        let (a, b) = (&pieces[i], &pieces[j]);
        if a.face != b.face {
            found.compare(a, b, near);
        }
        turn += 1;
        is_stopped = turn.is_multiple_of(STRIDE) && !goes_on();
        found.pairs.len() < most && !is_stopped
    });
    if is_stopped {
        return None;
    }
    found.passing_edges(mesh);
    found.pairs.sort_unstable();
    found.pairs.dedup();
    found.pairs.truncate(most);
    Some(found.pairs)
}

/// A planar face, or a triangle of one that is not.
struct Piece {
    face: FaceId,
    plane: Plane,
    corners: Vec<DVec3>,
    /// The edge from each corner to the next; `None` inside a face.
    edges: Vec<Option<EdgeId>>,
    bounds: AxisBox,
    /// In its plane along the longest side and across it: the box of a slanted strip says little
    /// of where it lies, and thousands of them side by side are the wall of a tube.
    spans: [Span; 2],
}

/// How far something reaches along a direction.
struct Span {
    along: DVec3,
    from: f64,
    to: f64,
}

impl Span {
    fn of(along: DVec3, corners: &[DVec3]) -> Self {
        let places = || corners.iter().map(|p| along.dot(*p));
        let (from, to) =
            (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
        Self { along, from, to }
    }

    /// Whether all points lie beyond one end.
    fn is_clear_of(&self, corners: &[DVec3], near: f64) -> bool {
        let other = Self::of(self.along, corners);
        other.from > self.to + near || other.to < self.from - near
    }
}

impl Piece {
    /// The pieces of all faces; what has no area has none.
    fn all(mesh: &Mesh, near: f64) -> Vec<Self> {
        let mut pieces = Vec::with_capacity(mesh.face_count());
        for f in mesh.faces() {
            let sides: Vec<HalfEdgeId> = mesh
                .face_half_edges(f)
                .filter(|&h| mesh.position(mesh.origin(h)) != mesh.position(mesh.target(h)))
                .collect();
            let corners: Vec<DVec3> =
                sides.iter().map(|&h| mesh.position(mesh.origin(h))).collect();
            let Some(plane) = Plane::newell(&corners).filter(|_| corners.len() > 2) else {
                continue;
            };
            let edges: Vec<Option<EdgeId>> = sides.iter().map(|h| Some(h.edge())).collect();
            if corners.iter().all(|&p| plane.signed_distance(p).abs() <= near) {
                pieces.extend(Self::new(f, corners, edges));
            } else {
                let triangles = divided(&corners, &plane);
                pieces.extend(triangles.into_iter().filter_map(|t| {
                    let next = |i: usize| (t[i] + 1) % corners.len() == t[(i + 1) % 3];
                    let own = (0..3).map(|i| edges[t[i]].filter(|_| next(i))).collect();
                    Self::new(f, t.map(|i| corners[i]).to_vec(), own)
                }));
            }
        }
        pieces
    }

    fn new(face: FaceId, corners: Vec<DVec3>, edges: Vec<Option<EdgeId>>) -> Option<Self> {
        let plane = Plane::newell(&corners)?;
        let bounds = AxisBox::of(corners.iter().copied())?;
        let n = corners.len();
        let sides = (0..n).map(|i| corners[(i + 1) % n] - corners[i]);
        let longest =
            sides.reduce(|a, b| if b.length_squared() > a.length_squared() { b } else { a })?;
        let along = longest.normalize_or_zero();
        let spans = [along, plane.normal().cross(along)].map(|along| Span::of(along, &corners));
        Some(Self { face, plane, corners, edges, bounds, spans })
    }

    /// Whether another piece lies apart from this one in the directions of its plane.
    fn is_apart(&self, other: &Self, near: f64) -> bool {
        self.spans.iter().any(|span| span.is_clear_of(&other.corners, near))
    }

    /// How far each corner lies in front of a plane; zero within rounding.
    fn heights(&self, plane: &Plane, near: f64) -> Vec<f64> {
        let height = |&p: &DVec3| {
            let distance = plane.signed_distance(p);
            if distance.abs() <= near { 0.0 } else { distance }
        };
        self.corners.iter().map(height).collect()
    }
}

/// Triangles of a face that is not planar, by the numbers of its corners.
fn divided(corners: &[DVec3], plane: &Plane) -> Vec<[usize; 3]> {
    if corners.len() == 3 {
        return vec![[0, 1, 2]];
    }
    let frame = Frame::on_plane(plane);
    let flat: Vec<DVec2> = corners.iter().map(|&p| frame.flatten(p)).collect();
    triangulate(&flat)
}

/// An edge of one face that lies inside another one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Contact {
    edge: EdgeId,
    /// The face that it lies in.
    within: FaceId,
    /// The face of the edge.
    of: FaceId,
    /// Whether that face lies in front of the other one.
    is_front: bool,
}

struct Found {
    pairs: Vec<CrossingPair>,
    contacts: Vec<Contact>,
}

impl Found {
    fn compare(&mut self, a: &Piece, b: &Piece, near: f64) {
        if a.is_apart(b, near) || b.is_apart(a, near) {
            return;
        }
        let on_b = a.heights(&b.plane, near);
        if is_beside(&on_b) {
            return;
        }
        let on_a = b.heights(&a.plane, near);
        if is_beside(&on_a) {
            return;
        }
        if on_b.iter().all(|&h| h == 0.0) || on_a.iter().all(|&h| h == 0.0) {
            if overlap(a, b, near) {
                self.push(a.face, b.face, CrossingKind::Overlap);
            }
            return;
        }
        let Some(line) = MeetingLine::of(a, b, near) else { return };
        let [through_a, through_b] = [line.through(a, &on_b), line.through(b, &on_a)];
        if common(&through_a, &through_b) > line.least {
            self.push(a.face, b.face, CrossingKind::Through);
            return;
        }
        self.touching_edges(a, &on_b, &line, &Within { face: b.face, stretches: &through_b });
        self.touching_edges(b, &on_a, &line, &Within { face: a.face, stretches: &through_a });
    }

    /// Remembers the edges of a piece that lie inside another one.
    fn touching_edges(
        &mut self,
        piece: &Piece,
        heights: &[f64],
        line: &MeetingLine,
        within: &Within<'_>,
    ) {
        let n = piece.corners.len();
        // A piece that lies on one side touches with all of its edges on the plane.
        let is_front = heights.iter().any(|&h| h > 0.0);
        for i in 0..n {
            let j = (i + 1) % n;
            let Some(edge) = piece.edges[i].filter(|_| heights[i] == 0.0 && heights[j] == 0.0)
            else {
                continue;
            };
            let [from, to] = [i, j].map(|k| line.at(piece.corners[k]));
            let own = [Stretch { from: from.min(to), to: from.max(to) }];
            if common(&own, within.stretches) > line.least {
                let contact = Contact { edge, within: within.face, of: piece.face, is_front };
                self.contacts.push(contact);
            }
        }
    }

    fn push(&mut self, a: FaceId, b: FaceId, kind: CrossingKind) {
        self.pairs.push(CrossingPair { first: a.min(b), second: a.max(b), kind });
    }

    /// Edges inside a face with one of their faces in front of it and one behind.
    fn passing_edges(&mut self, mesh: &Mesh) {
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.sort_unstable();
        contacts.dedup();
        for group in contacts.chunk_by(|a, b| a.edge == b.edge && a.within == b.within) {
            let [f, g] = mesh.edge_faces(group[0].edge);
            let passes = group.iter().any(|c| c.is_front) && group.iter().any(|c| !c.is_front);
            if passes && ![f, g].contains(&group[0].within) {
                group.iter().for_each(|c| self.push(c.of, c.within, CrossingKind::Through));
            }
        }
    }
}

/// Whether a piece lies on one side of a plane and does not reach it.
fn is_beside(heights: &[f64]) -> bool {
    heights.iter().all(|&h| h > 0.0) || heights.iter().all(|&h| h < 0.0)
}

/// A part of a line.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: f64,
    to: f64,
}

/// The stretches of the line of two planes that lie inside a face.
struct Within<'a> {
    face: FaceId,
    stretches: &'a [Stretch],
}

/// The line in which the planes of two pieces cut each other.
struct MeetingLine {
    origin: DVec3,
    direction: DVec3,
    /// What is no longer than this may be rounding.
    least: f64,
}

impl MeetingLine {
    /// `None` for planes that are parallel.
    fn of(a: &Piece, b: &Piece, near: f64) -> Option<Self> {
        let along = a.plane.normal().cross(b.plane.normal());
        let sine = along.length();
        // Where planes meet at a small angle, their line is known so much less well.
        (sine > 0.0).then(|| Self {
            origin: a.corners[0],
            direction: along / sine,
            least: near / sine,
        })
    }

    fn at(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.direction)
    }

    /// Where a piece goes on from one side of the other's plane to the other side.
    fn through(&self, piece: &Piece, heights: &[f64]) -> Vec<Stretch> {
        let front = self.stretches(piece, heights, |h| h > 0.0);
        let back = self.stretches(piece, heights, |h| h >= 0.0);
        let mut both = Vec::new();
        for a in &front {
            for b in &back {
                let (from, to) = (a.from.max(b.from), a.to.min(b.to));
                if from < to {
                    both.push(Stretch { from, to });
                }
            }
        }
        both
    }

    /// The stretches between the crossings of a piece's outline with the other's plane. Whether a
    /// corner on the plane counts as above it decides on which side of the plane they are seen.
    fn stretches(
        &self,
        piece: &Piece,
        heights: &[f64],
        is_above: impl Fn(f64) -> bool,
    ) -> Vec<Stretch> {
        let mut crossings: Vec<f64> = Vec::new();
        let n = piece.corners.len();
        for i in 0..n {
            let j = (i + 1) % n;
            let (here, there) = (heights[i], heights[j]);
            if is_above(here) != is_above(there) {
                let share = here / (here - there);
                crossings.push(self.at(piece.corners[i].lerp(piece.corners[j], share)));
            }
        }
        crossings.sort_unstable_by(f64::total_cmp);
        crossings.chunks_exact(2).map(|ends| Stretch { from: ends[0], to: ends[1] }).collect()
    }
}

/// The longest stretch that both have in common.
fn common(a: &[Stretch], b: &[Stretch]) -> f64 {
    let shared = |x: &Stretch, y: &Stretch| x.to.min(y.to) - x.from.max(y.from);
    a.iter().flat_map(|x| b.iter().map(move |y| shared(x, y))).fold(0.0, f64::max)
}

/// Whether two pieces in one plane cover a part of it both.
fn overlap(a: &Piece, b: &Piece, near: f64) -> bool {
    let axis = dropped_axis(a.plane.normal());
    let [first, second] = [a, b].map(|piece| {
        let mut points: Vec<DVec2> = piece.corners.iter().map(|&p| flat(p, axis)).collect();
        if polygon::signed_area(&points) < 0.0 {
            points.reverse();
        }
        points
    });
    let triangles = |points: &[DVec2]| -> Vec<[DVec2; 3]> {
        if points.len() == 3 {
            return vec![[points[0], points[1], points[2]]];
        }
        triangulate(points).into_iter().map(|t| t.map(|i| points[i])).collect()
    };
    let others = triangles(&second);
    triangles(&first).iter().any(|t| others.iter().any(|u| cover(t, u, near)))
}

/// Whether two triangles, counter-clockwise, have more in common than a strip as thin as rounding.
fn cover(t: &[DVec2; 3], u: &[DVec2; 3], near: f64) -> bool {
    let mut rest: Vec<DVec2> = t.to_vec();
    for i in 0..3 {
        let (from, along) = (u[i], u[(i + 1) % 3] - u[i]);
        let inside = |p: DVec2| along.perp_dot(p - from);
        let mut kept = Vec::with_capacity(rest.len() + 1);
        for k in 0..rest.len() {
            let (p, q) = (rest[k], rest[(k + 1) % rest.len()]);
            let (here, there) = (inside(p), inside(q));
            if here >= 0.0 {
                kept.push(p);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                kept.push(p.lerp(q, here / (here - there)));
            }
        }
        rest = kept;
        if rest.len() < 3 {
            return false;
        }
    }
    let around: f64 = (0..rest.len()).map(|i| rest[i].distance(rest[(i + 1) % rest.len()])).sum();
    polygon::signed_area(&rest).abs() > near * around
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(corners: &[(DVec3, DVec3)]) -> Mesh {
        let mut points = Vec::new();
        let mut faces: Vec<Vec<usize>> = Vec::new();
        for &(low, high) in corners {
            let start = points.len();
            let corner = |i: usize| {
                let pick = |bit: usize| if i >> bit & 1 == 1 { high[bit] } else { low[bit] };
                DVec3::new(pick(0), pick(1), pick(2))
            };
            points.extend((0..8).map(corner));
            let sides = [
                [0, 2, 3, 1],
                [4, 5, 7, 6],
                [0, 1, 5, 4],
                [2, 6, 7, 3],
                [0, 4, 6, 2],
                [1, 3, 7, 5],
            ];
            faces.extend(sides.map(|side| side.map(|i| start + i).to_vec()));
        }
        Mesh::from_faces(points, faces).expect("boxes")
    }

    fn cube_at(low: DVec3) -> (DVec3, DVec3) {
        (low, low + DVec3::ONE)
    }

    fn kinds(mesh: &Mesh) -> [usize; 2] {
        let pairs = crossings(mesh, usize::MAX);
        [CrossingKind::Through, CrossingKind::Overlap]
            .map(|kind| pairs.iter().filter(|pair| pair.kind == kind).count())
    }

    #[test]
    fn boxes_apart_or_inside_each_other_do_not_cross() {
        let outer = (DVec3::splat(-1.0), DVec3::splat(3.0));
        assert_eq!(kinds(&boxes(&[outer, cube_at(DVec3::ZERO)])), [0, 0]);
        assert_eq!(kinds(&boxes(&[cube_at(DVec3::ZERO), cube_at(DVec3::X * 1.5)])), [0, 0]);
    }

    #[test]
    fn boxes_through_each_other_cross_whatever_their_size_and_place() {
        for (scale, shift) in [(1.0, 0.0), (1e-3, 0.0), (1e5, 0.0), (1.0, 1e6)] {
            let at = |low: DVec3| {
                let (low, high) = cube_at(low);
                (low * scale + shift, high * scale + shift)
            };
            // Corner in corner: three faces of each cross two of the other.
            let mesh = boxes(&[at(DVec3::ZERO), at(DVec3::new(0.25, 0.375, 0.5))]);
            assert_eq!(kinds(&mesh), [6, 0], "{scale} {shift}");
        }
    }

    #[test]
    fn touching_is_no_crossing_but_covering_is() {
        // Edge on face, vertex on face, edge on edge.
        let on_top = (DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.75, 0.75, 2.0));
        assert_eq!(kinds(&boxes(&[cube_at(DVec3::ZERO), on_top])), [0, 1]);
        assert_eq!(
            kinds(&boxes(&[cube_at(DVec3::ZERO), cube_at(DVec3::new(1.0, 1.0, 0.0))])),
            [0, 0]
        );
        assert_eq!(kinds(&boxes(&[cube_at(DVec3::ZERO), cube_at(DVec3::ONE)])), [0, 0]);
    }

    /// Half a box on: four pairs of faces cover each other, and the end of each box passes into the
    /// other between its edges, which lie in the other's faces.
    #[test]
    fn a_box_pushed_into_its_like_covers_four_of_its_faces() {
        let mesh = boxes(&[cube_at(DVec3::ZERO), cube_at(DVec3::X * 0.5)]);
        assert_eq!(kinds(&mesh)[1], 4);
    }

    /// A ridge whose edge lies exactly in a face, with a side of the roof on either side of it.
    #[test]
    fn a_surface_that_passes_through_along_its_edge_crosses() {
        let points = [
            // A large triangle in the plane z = 0.
            [-9.0, -9.0, 0.0],
            [9.0, -9.0, 0.0],
            [0.0, 9.0, 0.0],
            // Two triangles with an edge in it.
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 2.0],
            [0.0, 0.5, -2.0],
        ];
        let points = points.map(DVec3::from_array);
        let mesh =
            Mesh::from_faces(points, [[0, 1, 2], [3, 4, 5], [4, 3, 6]]).expect("three triangles");
        assert_eq!(kinds(&mesh), [2, 0]);
        // Both on one side: the roof stands on the face.
        let mut above = points;
        above[6].z = 2.0;
        above[6].y = 1.5;
        let mesh =
            Mesh::from_faces(above, [[0, 1, 2], [3, 4, 5], [4, 3, 6]]).expect("three triangles");
        assert_eq!(kinds(&mesh), [0, 0]);
    }

    #[test]
    fn neighbours_are_no_crossing_unless_they_fold_onto_each_other() {
        let fold = |x: f64, y: f64, z: f64| {
            let points = [DVec3::ZERO, DVec3::Y * 4.0, DVec3::X * 4.0, DVec3::new(x, y, z)];
            kinds(&Mesh::from_faces(points, [[0, 2, 1], [0, 1, 3]]).expect("two triangles"))
        };
        assert_eq!(fold(-4.0, 0.0, 0.0), [0, 0]);
        assert_eq!(fold(4.0, 0.0, 1.0), [0, 0]);
        assert_eq!(fold(2.0, 1.0, 0.0), [0, 1]);
        // Two that share a vertex only, one through the other.
        let points = [
            DVec3::ZERO,
            DVec3::new(4.0, -2.0, 0.0),
            DVec3::new(4.0, 2.0, 0.0),
            DVec3::new(2.0, 0.0, -1.0),
            DVec3::new(2.0, 0.0, 1.0),
        ];
        let mesh = Mesh::from_faces(points, [[0, 1, 2], [0, 3, 4]]).expect("two triangles");
        assert_eq!(kinds(&mesh), [1, 0]);
    }

    #[test]
    fn the_list_is_as_long_as_was_asked_for() {
        let mesh = boxes(&[cube_at(DVec3::ZERO), cube_at(DVec3::splat(0.5))]);
        assert_eq!(crossings(&mesh, 2).len(), 2);
        assert_eq!(crossings(&Mesh::new(), 9), []);
    }
}
