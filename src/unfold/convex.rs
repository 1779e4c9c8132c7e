//! Concave faces cut into triangles, so that every overlap test is one of two convex polygons.

use glam::DVec2;

use crate::geom::predicate::orient2d;

/// The convex parts of all faces: lists of corners, numbered within their face.
#[derive(Debug, Clone, Default)]
pub(super) struct Parts {
    /// Face → its first part; one entry more than there are faces (none before the first push).
    face_first: Vec<u32>,
    /// Part → its first corner; one entry more than there are parts.
    part_first: Vec<u32>,
    corners: Vec<u32>,
}

/// The polygon's sides cross.
#[derive(Debug)]
pub(super) struct NotSimple;

impl Parts {
    /// Adds the parts of the next face. Corners that stick in by less than `bound` do not make it
    /// concave.
    pub fn push(&mut self, corners: &[DVec2], bound: f64) -> Result<(), NotSimple> {
        if self.face_first.is_empty() {
            self.face_first.push(0);
            self.part_first.push(0);
        }
        if is_convex(corners, bound) {
            self.push_part(0..corners.len() as u32);
        } else {
            for triangle in triangulate(corners)? {
                self.push_part(triangle);
            }
        }
        self.face_first.push(self.part_first.len() as u32 - 1);
        Ok(())
    }

    fn push_part(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.part_first.push(self.corners.len() as u32);
    }

    /// The parts of a face.
    pub fn of(&self, face: u32) -> impl Iterator<Item = &[u32]> + Clone {
        let range =
            self.face_first[face as usize] as usize..self.face_first[face as usize + 1] as usize;
        range.map(|p| &self.corners[self.part_first[p] as usize..self.part_first[p + 1] as usize])
    }
}

/// Whether the polygon turns left everywhere, once around, up to `bound`.
fn is_convex(corners: &[DVec2], bound: f64) -> bool {
    let n = corners.len();
    let left = |a: DVec2, b: DVec2, c: DVec2| {
        let area = (b - a).perp_dot(c - a);
        area >= 0.0 || area >= -bound * (c - a).length()
    };
    let turns = (0..n).all(|i| left(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]));
    // A star polygon turns left everywhere too, but more than once around: its fan turns back.
    turns && (1..n - 1).all(|i| left(corners[0], corners[i], corners[i + 1]))
}

/// Ear clipping (Meisters 1975) with exact signs.
fn triangulate(corners: &[DVec2]) -> Result<Vec<[u32; 3]>, NotSimple> {
    let mut left: Vec<u32> = (0..corners.len() as u32).collect();
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    while left.len() > 3 {
        let n = left.len();
        let around = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        // A corner on a straight line, when no ear is left: cutting it off changes nothing.
        let straight = |i: &usize| {
            let [a, b, c] = around(*i).map(|k| corners[k as usize]);
            orient2d(a, b, c) == 0.0 && (b - a).dot(c - b) > 0.0
        };
        let ear =
            (0..n).find(|&i| is_ear(corners, &left, around(i))).or_else(|| (0..n).find(straight));
        let i = ear.ok_or(NotSimple)?;
        triangles.push(around(i));
        left.remove(i);
    }
    triangles.push([left[0], left[1], left[2]]);
    let [a, b, c] = [left[0], left[1], left[2]].map(|k| corners[k as usize]);
    if orient2d(a, b, c) < 0.0 { Err(NotSimple) } else { Ok(triangles) }
}

/// Whether the corner turns left and no other corner lies in the triangle that it cuts off.
fn is_ear(corners: &[DVec2], left: &[u32], triangle: [u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|k| corners[k as usize]);
    if orient2d(a, b, c) <= 0.0 {
        return false;
    }
    let inside =
        |p: DVec2| orient2d(a, b, p) >= 0.0 && orient2d(b, c, p) >= 0.0 && orient2d(c, a, p) >= 0.0;
    left.iter().filter(|k| !triangle.contains(k)).all(|&k| !inside(corners[k as usize]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::polygon::signed_area;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    fn parts(corners: &[DVec2]) -> Result<Vec<Vec<DVec2>>, NotSimple> {
        let mut parts = Parts::default();
        parts.push(corners, 1e-12)?;
        Ok(parts.of(0).map(|part| part.iter().map(|&k| corners[k as usize]).collect()).collect())
    }

    #[test]
    fn convex_stays_whole_and_concave_parts_sum_to_the_area() {
        let square = polygon(&[(0., 0.), (1., 0.), (2., 0.), (2., 2.), (0., 2.)]);
        assert_eq!(parts(&square).expect("simple").len(), 1);
        let ell = polygon(&[(0., 0.), (1., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)]);
        let cut = parts(&ell).expect("simple");
        assert!(cut.len() > 1);
        assert!(
            (cut.iter().map(|p| signed_area(p)).sum::<f64>() - signed_area(&ell)).abs() < 1e-15
        );
        assert!(cut.iter().all(|p| signed_area(p) >= 0.0));
    }

    #[test]
    fn crossing_sides_are_refused() {
        assert!(parts(&polygon(&[(0., 0.), (2., 2.), (2., 0.), (0., 1.)])).is_err());
        let star: Vec<DVec2> =
            (0..5).map(|i| DVec2::from_angle(f64::from(i) * 0.8 * std::f64::consts::PI)).collect();
        assert!(parts(&star).is_err());
    }
}
