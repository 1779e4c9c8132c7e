//! The convex hull of points on a sphere: an interim tool for the random polytopes.
//!
//! Randomised incremental insertion (Clarkson and Shor 1989). Every point that waits knows the triangle that the ray from a
//! centre inside the hull to the point goes through; inserting a point replaces the triangles that it sees. All signs are
//! exact. The points must come in random order for the O(n log n) expected time.

use glam::DVec3;

use crate::geom::predicate::orient3d;

/// A triangle of the hull, counter-clockwise seen from outside.
struct Triangle {
    vertices: [usize; 3],
    /// The triangle across the side from `vertices[i]` to `vertices[i + 1]`.
    across: [usize; 3],
    /// The points that wait outside it.
    waiting: Vec<usize>,
    is_alive: bool,
}

/// The triangles of the hull, or `None` when a point does not become a corner or the first four points are flat.
pub(super) fn triangles(points: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let mut hull = Hull::start(points)?;
    for p in 4..points.len() {
        hull.insert(p)?;
    }
    Some(hull.triangles.iter().filter(|t| t.is_alive).map(|t| t.vertices).collect())
}

struct Hull<'a> {
    points: &'a [DVec3],
    centre: DVec3,
    triangles: Vec<Triangle>,
    /// For each waiting point its triangle.
    home: Vec<usize>,
    /// For each vertex of the horizon the new triangle whose horizon side begins there.
    begins: Vec<usize>,
}

impl<'a> Hull<'a> {
    /// The tetrahedron of the first four points, with all others waiting.
    fn start(points: &'a [DVec3]) -> Option<Self> {
        let [a, b, c, d] = *points.first_chunk::<4>()?;
        let [p, q] = if orient3d(a, b, c, d) > 0.0 { [1, 2] } else { [2, 1] };
        // d lies below a, p, q: that triangle looks outwards, and the others follow from its sides.
        let tetrahedron =
            [([0, p, q], [1, 2, 3]), ([p, 0, 3], [0, 3, 2]), ([q, p, 3], [0, 1, 3]), ([0, q, 3], [0, 2, 1])];
        let triangle = |(vertices, across)| Triangle { vertices, across, waiting: Vec::new(), is_alive: true };
        let mut hull = Self {
            points,
            centre: (a + b + c + d) / 4.0,
            triangles: tetrahedron.map(triangle).into(),
            home: vec![0; points.len()],
            begins: vec![0; points.len()],
        };
        let centre = hull.centre;
        let has_room = hull.triangles.iter().all(|t| !hull.is_seen(t, centre)) && orient3d(a, b, c, d) != 0.0;
        if !has_room {
            return None;
        }
        (4..points.len()).try_for_each(|p| hull.settle(p, &[0, 1, 2, 3]))?;
        Some(hull)
    }

    fn is_seen(&self, t: &Triangle, from: DVec3) -> bool {
        let [a, b, c] = t.vertices.map(|v| self.points[v]);
        orient3d(a, b, c, from) < 0.0
    }

    /// Lets a point wait at the one of `triangles` that its ray from the centre goes through.
    fn settle(&mut self, p: usize, triangles: &[usize]) -> Option<()> {
        let on_left = |a: usize, b: usize| orient3d(self.centre, self.points[a], self.points[b], self.points[p]) <= 0.0;
        let is_through = |&&t: &&usize| {
            let [a, b, c] = self.triangles[t].vertices;
            on_left(a, b) && on_left(b, c) && on_left(c, a)
        };
        let t = *triangles.iter().find(is_through)?;
        self.home[p] = t;
        self.triangles[t].waiting.push(p);
        Some(())
    }

    /// Replaces the triangles that see `p` by a fan from the horizon to `p`.
    fn insert(&mut self, p: usize) -> Option<()> {
        let (seen, horizon) = self.seen_from(p)?;
        let first = self.triangles.len();
        for (i, &(a, b, outside)) in horizon.iter().enumerate() {
            let across = [outside, usize::MAX, usize::MAX];
            self.triangles.push(Triangle { vertices: [a, b, p], across, waiting: Vec::new(), is_alive: true });
            self.begins[a] = first + i;
            let back = self.triangles[outside].vertices.iter().position(|&v| v == b).expect("neighbours share a side");
            self.triangles[outside].across[back] = first + i;
        }
        for (i, &(_, b, _)) in horizon.iter().enumerate() {
            let next = self.begins[b];
            self.triangles[first + i].across[1] = next;
            self.triangles[next].across[2] = first + i;
        }
        let fan: Vec<usize> = (first..self.triangles.len()).collect();
        for t in seen {
            let waiting = std::mem::take(&mut self.triangles[t].waiting);
            waiting.into_iter().filter(|&q| q != p).try_for_each(|q| self.settle(q, &fan))?;
        }
        Some(())
    }

    /// The triangles that `p` sees, marked as gone, and the sides around them with the triangles beyond.
    #[expect(clippy::type_complexity, reason = "two lists that one caller takes apart at once")]
    fn seen_from(&mut self, p: usize) -> Option<(Vec<usize>, Vec<(usize, usize, usize)>)> {
        let home = self.home[p];
        if !self.is_seen(&self.triangles[home], self.points[p]) {
            return None;
        }
        self.triangles[home].is_alive = false;
        let (mut seen, mut horizon) = (vec![home], Vec::new());
        let mut i = 0;
        while i < seen.len() {
            let Triangle { vertices, across, .. } = self.triangles[seen[i]];
            for side in 0..3 {
                let neighbour = across[side];
                if !self.triangles[neighbour].is_alive {
                    continue;
                }
                if self.is_seen(&self.triangles[neighbour], self.points[p]) {
                    self.triangles[neighbour].is_alive = false;
                    seen.push(neighbour);
                } else {
                    horizon.push((vertices[side], vertices[(side + 1) % 3], neighbour));
                }
            }
            i += 1;
        }
        Some((seen, horizon))
    }
}
